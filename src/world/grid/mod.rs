//! A grid of cells with coloured tiles and walls: what can happen there is what
//! somebody who walks it can step on.
//!
//! A trajectory begins on a start cell and makes at most so many steps; a step is
//! one of four moves, or to stay. A step gives the symbol of the tile it ends on,
//! or nothing on a blank cell ([`Labelling`]); the start itself gives nothing. So
//! the shortest trajectory with a word ends on its last symbol.

mod cells;
mod list;
mod map;
mod outline;
mod path;
mod search;
mod tour;

use automata::{Alphabet, Symbol};
use serde::Serialize;

use self::cells::Cells;
pub use self::map::GridMap;
pub use self::path::{Move, Step};
pub(super) use self::tour::ATTEMPTS;

/// The most rows, and the most columns.
pub const LONGEST_SIDE: usize = 50;
/// The most steps that a trajectory may be allowed.
pub const MOST_STEPS: usize = 1000;

/// What a cell is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tile {
    /// Nothing steps on it.
    Wall,
    /// It gives nothing.
    Blank,
    /// It gives this symbol.
    Coloured(Symbol),
}

/// When a tile gives its symbol.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Labelling {
    /// When it is entered. To stay gives nothing.
    #[default]
    Entry,
    /// With every step that ends on it, also with one that stays.
    EveryStep,
}

/// A place in a grid, both numbers from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Cell {
    /// The row, from the top.
    pub row: usize,
    /// The column, from the left.
    pub column: usize,
}

impl std::fmt::Display for Cell {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "row {}, column {}", self.row + 1, self.column + 1)
    }
}

/// Why there is no such grid. Rows and columns are told from 1.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GridError {
    /// There is no cell.
    #[error("the grid has no cell: give at least one row with one cell")]
    Empty,
    /// A row is longer or shorter than the first.
    #[error("row {row} has {cells} cells and the first row {expected}: give all rows the same")]
    Ragged {
        /// The row, from 1.
        row: usize,
        /// Its cells.
        cells: usize,
        /// The cells of the first row.
        expected: usize,
    },
    /// One side is too long.
    #[error("the grid has {rows} rows and {columns} columns: at most {LONGEST_SIDE} of each")]
    TooLarge {
        /// The rows.
        rows: usize,
        /// The columns.
        columns: usize,
    },
    /// Nowhere to begin.
    #[error("the grid has no start: mark at least one cell as one")]
    NoStart,
    /// A start is a wall or not in the grid.
    #[error("the start at {0} is no cell that can be stepped on: move it, or remove the wall")]
    BadStart(Cell),
    /// A trajectory may make no step, or too many.
    #[error("a trajectory may make {0} steps: allow 1 to {MOST_STEPS}")]
    Steps(usize),
    /// A tile has a colour that stands for no symbol.
    #[error("the tile `{mark}` at {at} has no symbol: give its colour one, or use {known}")]
    NoSymbol {
        /// The mark.
        mark: char,
        /// Where it is.
        at: Cell,
        /// The marks that there are, for people.
        known: String,
    },
    /// One mark stands for two things.
    #[error("`{0}` stands for two things in this grid: give every symbol its own mark")]
    Mark(char),
    /// A symbol of another alphabet.
    #[error("the tile at {at} has symbol number {symbol}, and the alphabet has {symbols}")]
    Foreign {
        /// Where it is.
        at: Cell,
        /// The symbol's number, from 0.
        symbol: usize,
        /// The size of the alphabet.
        symbols: usize,
    },
    /// A tile that no trajectory steps on.
    #[error(
        "the tile `{symbol}` at {at} cannot be reached from a start in {steps} steps: open a way to it, allow more steps, or make it a wall"
    )]
    Unreachable {
        /// Its symbol's name.
        symbol: String,
        /// Where it is.
        at: Cell,
        /// The steps that a trajectory may make.
        steps: usize,
    },
}

/// A grid world; see the [module](self) for what its trajectories are.
#[derive(Clone, Debug)]
pub struct Grid {
    alphabet: Alphabet,
    rows: usize,
    columns: usize,
    tiles: Vec<Tile>,
    /// In the order in which they were given; the first is preferred.
    starts: Vec<usize>,
    labelling: Labelling,
    steps: usize,
    /// The blank cells, and those of each symbol, as bits.
    blank: Cells,
    coloured: Vec<Cells>,
}

impl Grid {
    /// The grid of these rows, in which a trajectory makes up to `steps` steps.
    ///
    /// # Errors
    ///
    /// If it is no rectangle of a possible size, has no start, or a coloured
    /// tile of it cannot be reached.
    pub fn new(
        alphabet: Alphabet,
        rows: &[Vec<Tile>],
        starts: &[Cell],
        labelling: Labelling,
        steps: usize,
    ) -> Result<Self, GridError> {
        let columns = rows.first().map_or(0, Vec::len);
        if columns == 0 {
            return Err(GridError::Empty);
        }
        if let Some(row) = rows.iter().position(|row| row.len() != columns) {
            return Err(GridError::Ragged {
                row: row + 1,
                cells: rows[row].len(),
                expected: columns,
            });
        }
        if rows.len().max(columns) > LONGEST_SIDE {
            return Err(GridError::TooLarge {
                rows: rows.len(),
                columns,
            });
        }
        if steps == 0 || steps > MOST_STEPS {
            return Err(GridError::Steps(steps));
        }
        let none = Cells::none(rows.len() * (columns + 1));
        let mut grid = Self {
            coloured: vec![none.clone(); alphabet.len()],
            blank: none,
            rows: rows.len(),
            columns,
            tiles: rows.concat(),
            starts: Vec::new(),
            labelling,
            steps,
            alphabet,
        };
        grid.place_tiles()?;
        grid.place_starts(starts)?;
        grid.check_reach()?;
        Ok(grid)
    }

    fn place_tiles(&mut self) -> Result<(), GridError> {
        for place in 0..self.tiles.len() {
            let at = Cell {
                row: place / self.columns,
                column: place % self.columns,
            };
            let bit = self.bit(at);
            match self.tiles[place] {
                Tile::Wall => {}
                Tile::Blank => self.blank.insert(bit),
                Tile::Coloured(symbol) => {
                    let symbols = self.alphabet.len();
                    let symbol = symbol.index();
                    let cells = self.coloured.get_mut(symbol);
                    let cells = cells.ok_or(GridError::Foreign {
                        at,
                        symbol,
                        symbols,
                    })?;
                    cells.insert(bit);
                }
            }
        }
        Ok(())
    }

    fn place_starts(&mut self, starts: &[Cell]) -> Result<(), GridError> {
        for &at in starts {
            if at.row >= self.rows || at.column >= self.columns || self.tile(at) == Tile::Wall {
                return Err(GridError::BadStart(at));
            }
            let bit = self.bit(at);
            if !self.starts.contains(&bit) {
                self.starts.push(bit);
            }
        }
        if self.starts.is_empty() {
            return Err(GridError::NoStart);
        }
        Ok(())
    }

    /// Whether every coloured tile can be stepped on.
    fn check_reach(&self) -> Result<(), GridError> {
        let mut free = self.blank.clone();
        for cells in &self.coloured {
            free.add(cells);
        }
        // A start has not been stepped on yet.
        let mut stepped = Cells::none(self.bits());
        let mut front = self.start_cells();
        for _ in 0..self.steps {
            if front.is_empty() {
                break;
            }
            front = front.moved(self.stride());
            front.keep(&free);
            front.remove(&stepped);
            stepped.add(&front);
        }
        if self.labelling == Labelling::EveryStep {
            stepped.add(&self.start_cells());
        }
        for symbol in self.alphabet.symbols() {
            let missed = self.coloured[symbol.index()].iter();
            if let Some(bit) = missed.into_iter().find(|&bit| !stepped.contains(bit)) {
                return Err(GridError::Unreachable {
                    symbol: self.alphabet.name(symbol).to_owned(),
                    at: self.cell(bit),
                    steps: self.steps,
                });
            }
        }
        Ok(())
    }

    /// The symbols of the tiles; some may have none.
    pub fn alphabet(&self) -> &Alphabet {
        &self.alphabet
    }

    /// The number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// All cells, row by row.
    pub fn cells(&self) -> impl Iterator<Item = Cell> + use<> {
        let columns = self.columns;
        (0..self.rows).flat_map(move |row| (0..columns).map(move |column| Cell { row, column }))
    }

    /// What a cell is.
    ///
    /// # Panics
    ///
    /// If it is not in the grid.
    pub fn tile(&self, at: Cell) -> Tile {
        assert!(at.column < self.columns, "{at} is not in the grid");
        self.tiles[at.row * self.columns + at.column]
    }

    /// Where a trajectory may begin.
    pub fn starts(&self) -> impl ExactSizeIterator<Item = Cell> + '_ {
        self.starts.iter().map(|&bit| self.cell(bit))
    }

    /// When a tile gives its symbol.
    pub fn labelling(&self) -> Labelling {
        self.labelling
    }

    /// The most steps of a trajectory.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// The same grid with walks of any length.
    pub(super) fn tireless(&self) -> Self {
        Self {
            steps: usize::MAX,
            ..self.clone()
        }
    }

    fn stride(&self) -> usize {
        self.columns + 1
    }

    fn bits(&self) -> usize {
        self.rows * self.stride()
    }

    fn bit(&self, at: Cell) -> usize {
        at.row * self.stride() + at.column
    }

    fn cell(&self, bit: usize) -> Cell {
        Cell {
            row: bit / self.stride(),
            column: bit % self.stride(),
        }
    }

    fn start_cells(&self) -> Cells {
        let mut cells = Cells::none(self.bits());
        for &start in &self.starts {
            cells.insert(start);
        }
        cells
    }

    /// The symbol that a step to this cell gives.
    fn given(&self, bit: usize) -> Option<Symbol> {
        match self.tile(self.cell(bit)) {
            Tile::Coloured(symbol) => Some(symbol),
            Tile::Blank | Tile::Wall => None,
        }
    }

    /// Where a move leads from a cell; none into a wall, over an edge, and where
    /// to stay would be pointless.
    fn step(&self, from: usize, by: Move) -> Option<usize> {
        let to = match by {
            Move::Up => from.checked_sub(self.stride())?,
            Move::Right => from + 1,
            Move::Down => from + self.stride(),
            Move::Left => from.checked_sub(1)?,
            Move::Stay => {
                let gives = self.labelling == Labelling::EveryStep && self.given(from).is_some();
                return gives.then_some(from);
            }
        };
        let at = self.cell(to);
        let is_free = at.row < self.rows && at.column < self.columns && self.tile(at) != Tile::Wall;
        is_free.then_some(to)
    }
}
