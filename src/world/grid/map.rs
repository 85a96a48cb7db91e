//! A grid as people draw it: one character a cell.

use automata::{Alphabet, Symbol};

use super::{Cell, Grid, GridError, Labelling, Tile};

/// The marks that always mean the same.
const WALL: char = '#';
const START: char = 'S';
const BLANK: [char; 2] = ['.', ' '];

/// A drawn grid: `#` is a wall, `.` or a space a blank cell, `S` a blank cell to
/// start from, and every symbol has a mark of its own.
#[derive(Clone, Debug)]
pub struct GridMap<'a> {
    /// One line a row.
    pub rows: Vec<&'a str>,
    /// What stands for each symbol.
    pub marks: Vec<(char, Symbol)>,
}

impl<'a> GridMap<'a> {
    /// The map with these lines, in which a symbol of one character stands for
    /// itself.
    pub fn new(alphabet: &Alphabet, text: &'a str) -> Self {
        let own = |symbol: Symbol| {
            let mut name = alphabet.name(symbol).chars();
            let mark = name.next()?;
            name.next().is_none().then_some((mark, symbol))
        };
        Self {
            rows: text.lines().collect(),
            marks: alphabet.symbols().filter_map(own).collect(),
        }
    }

    /// The grid that is drawn.
    ///
    /// # Errors
    ///
    /// If a character has no meaning, or two, or there is no such grid
    /// ([`Grid::new`]).
    pub fn grid(
        &self,
        alphabet: Alphabet,
        labelling: Labelling,
        steps: usize,
    ) -> Result<Grid, GridError> {
        for (place, &(mark, _)) in self.marks.iter().enumerate() {
            let taken = self.marks[..place].iter().any(|(other, _)| *other == mark);
            if taken || mark == WALL || mark == START || BLANK.contains(&mark) {
                return Err(GridError::Mark(mark));
            }
        }
        let mut starts = Vec::new();
        let mut rows = Vec::with_capacity(self.rows.len());
        for (row, line) in self.rows.iter().enumerate() {
            let mut tiles = Vec::new();
            for (column, mark) in line.chars().enumerate() {
                let at = Cell { row, column };
                if mark == START {
                    starts.push(at);
                }
                tiles.push(self.tile(mark, at)?);
            }
            rows.push(tiles);
        }
        Grid::new(alphabet, &rows, &starts, labelling, steps)
    }

    fn tile(&self, mark: char, at: Cell) -> Result<Tile, GridError> {
        if mark == WALL {
            return Ok(Tile::Wall);
        }
        if mark == START || BLANK.contains(&mark) {
            return Ok(Tile::Blank);
        }
        let known = self.marks.iter().find(|(known, _)| *known == mark);
        known
            .map(|&(_, symbol)| Tile::Coloured(symbol))
            .ok_or_else(|| {
                let marks = self.marks.iter().map(|(mark, _)| *mark);
                let all = [WALL, BLANK[0], START].into_iter().chain(marks);
                let known: Vec<String> = all.map(|mark| format!("`{mark}`")).collect();
                GridError::NoSymbol {
                    mark,
                    at,
                    known: known.join(", "),
                }
            })
    }
}
