//! A walk through a grid as it is drawn, or recorded cells: tiles with their
//! letters, and the way
//! from the start to the token, numbered where it touches a tile.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use automata::Symbol;

use crate::world::grid::{Cell, Grid, Move, Step, Tile};
use crate::world::pool::extent;

/// The side of a cell. Lengths are in units of the drawing.
const SIDE: i32 = 32;
/// How far from the middle of a cell the way passes it for the first time, the
/// second, and so on, so that no pass hides another.
const PASSES: [(i32, i32); 7] = [
    (0, 0),
    (6, 6),
    (-6, -6),
    (6, -6),
    (-6, 6),
    (10, 0),
    (-10, 0),
];

/// Where the numbers of the touches of one tile stand, from its middle: none hides
/// another, nor the tile's letter.
const BADGES: [(i32, i32); 8] = [
    (11, 11),
    (11, 0),
    (11, -11),
    (0, 11),
    (-11, 11),
    (-11, 0),
    (0, -11),
    (0, 0),
];

/// A drawing.
pub(crate) struct Scene {
    pub(crate) width: i32,
    pub(crate) height: i32,
    /// The lines between cells, as path data.
    pub(crate) lines: String,
    /// Walls and coloured tiles.
    pub(crate) tiles: Vec<TileView>,
    /// The way, as path data: one point a cell, within the cell.
    pub(crate) way: String,
    /// Which way it goes.
    pub(crate) headings: Vec<Place>,
    /// Where it touches tiles.
    pub(crate) touches: Vec<TouchView>,
    /// Where it is after each step, as `x,y,angle` with spaces between.
    pub(crate) points: String,
    /// The cells that it passes.
    cells: Vec<Cell>,
    /// Where the other of a pair goes another way: the number of the last step that
    /// both share, and the place.
    pub(crate) parting: Option<(usize, Place)>,
    pub(crate) start: Place,
    pub(crate) token: Place,
    pub(crate) steps: usize,
}

/// A cell that is not blank; its corner.
pub(crate) struct TileView {
    pub(crate) x: i32,
    pub(crate) y: i32,
    /// None for a wall.
    pub(crate) look: Option<Look>,
}

/// How the tiles of a symbol look.
#[derive(Clone)]
pub(crate) struct Look {
    pub(crate) letter: String,
    /// A tone of the style sheet, where there is no colour.
    pub(crate) tone: usize,
    /// A colour of the task's own.
    pub(crate) colour: Option<String>,
}

/// A touched tile, with its number on the way.
pub(crate) struct TouchView {
    pub(crate) number: usize,
    /// The step that touches it.
    pub(crate) step: usize,
    /// Where the number stands.
    pub(crate) at: Place,
    /// What stands there.
    pub(crate) text: String,
}

/// A point, and the angle of what is there, clockwise from the right.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    pub(crate) x: i32,
    pub(crate) y: i32,
    pub(crate) angle: i32,
}

impl Scene {
    /// The walk in its grid, with these looks by symbol.
    pub(crate) fn of(grid: &Grid, from: Cell, steps: &[Step], looks: &[Look]) -> Self {
        let strides = steps.iter().map(|step| Stride {
            to: step.to,
            angle: angle(step.by),
            touches: step.gives.is_some(),
        });
        Self {
            tiles: tiles(grid, looks),
            ..Self::way(grid.rows(), grid.columns(), from, strides)
        }
    }

    /// Recorded cells, each as row and column, in the smallest grid that has them.
    pub(crate) fn of_cells(cells: &[[u16; 2]]) -> Self {
        let [(top, rows), (left, columns)] = [0, 1].map(|side| extent(cells, side));
        let mut places = cells.iter().map(|[row, column]| Cell {
            row: usize::from(row - top),
            column: usize::from(column - left),
        });
        let from = places.next().unwrap_or(Cell { row: 0, column: 0 });
        let mut before = from;
        let strides = places.map(|to| {
            let angle = bearing(before, to);
            before = to;
            Stride {
                to,
                angle,
                touches: false,
            }
        });
        Self::way(rows as usize, columns as usize, from, strides)
    }

    /// A way through a blank grid.
    fn way(
        rows: usize,
        columns: usize,
        from: Cell,
        strides: impl ExactSizeIterator<Item = Stride>,
    ) -> Self {
        let mut passes = Passes::default();
        let start = passes.point(from);
        let mut way = format!("M{} {}", start.x, start.y);
        let mut scene = Self {
            width: units(columns),
            height: units(rows),
            lines: lines(rows, columns),
            tiles: Vec::new(),
            way: String::new(),
            headings: Vec::new(),
            touches: Vec::new(),
            points: format!("{},{},0", start.x, start.y),
            cells: vec![from],
            parting: None,
            start,
            token: start,
            steps: strides.len(),
        };
        let mut before = None;
        let mut badges = Badges::default();
        for (step, stride) in strides.enumerate() {
            let mut to = passes.point(stride.to);
            to.angle = stride.angle.unwrap_or(scene.token.angle);
            // Writing to a string never fails.
            let _ = write!(way, " L{} {}", to.x, to.y);
            let _ = write!(scene.points, " {},{},{}", to.x, to.y, to.angle);
            scene.cells.push(stride.to);
            if stride.angle.is_some() && before != Some(stride.angle) {
                scene.headings.push(Place {
                    x: i32::midpoint(scene.token.x, to.x),
                    y: i32::midpoint(scene.token.y, to.y),
                    angle: to.angle,
                });
            }
            if stride.touches {
                let number = scene.touches.len() + 1;
                scene.touches.push(TouchView {
                    number,
                    step: step + 1,
                    at: badges.place(stride.to),
                    text: number.to_string(),
                });
            }
            scene.token = to;
            before = Some(stride.angle);
        }
        scene.way = way;
        badges.tell(&mut scene.touches);
        scene
    }

    /// Marks where the two go different ways, if they do after a common beginning.
    pub(crate) fn part(first: &mut Self, second: &mut Self) {
        let cells = first.cells.iter().zip(&second.cells);
        let shared = cells.take_while(|(a, b)| a == b).count();
        if shared == 0 || shared == first.cells.len().max(second.cells.len()) {
            return;
        }
        let last = shared - 1;
        for scene in [first, second] {
            let place = Place {
                x: middle(scene.cells[last].column),
                y: middle(scene.cells[last].row),
                angle: 0,
            };
            scene.parting = Some((last, place));
        }
    }
}

/// The middle of the cells of a row or a column.
fn middle(place: usize) -> i32 {
    units(place) + SIDE / 2
}

/// How many numbers each cell has.
#[derive(Default)]
struct Badges(BTreeMap<Cell, usize>);

impl Badges {
    /// Where the next number of the cell stands.
    fn place(&mut self, cell: Cell) -> Place {
        let count = self.0.entry(cell).or_default();
        let (x, y) = BADGES[(*count).min(BADGES.len() - 1)];
        *count += 1;
        Place {
            x: middle(cell.column) + x,
            y: middle(cell.row) + y,
            angle: 0,
        }
    }

    /// Where a cell has more numbers than places, the last place says from which on.
    fn tell(&self, touches: &mut Vec<TouchView>) {
        if self.0.values().all(|count| *count <= BADGES.len()) {
            return;
        }
        let mut seen = BTreeSet::new();
        touches.retain(|touch| seen.insert((touch.at.x, touch.at.y)));
        for (cell, count) in &self.0 {
            if *count <= BADGES.len() {
                continue;
            }
            let (x, y) = BADGES[BADGES.len() - 1];
            let at = (middle(cell.column) + x, middle(cell.row) + y);
            for touch in touches.iter_mut().filter(|t| (t.at.x, t.at.y) == at) {
                touch.text = format!("{}+", touch.number);
            }
        }
    }
}

/// A step as it is drawn.
struct Stride {
    to: Cell,
    /// Which way, clockwise from the right; none where it stays.
    angle: Option<i32>,
    /// Whether there is a tile.
    touches: bool,
}

/// The angle from one cell to another, which need not be its neighbour.
fn bearing(from: Cell, to: Cell) -> Option<i32> {
    let side = |from: usize, to: usize| units(to) - units(from);
    let (x, y) = (side(from.column, to.column), side(from.row, to.row));
    let angle = f64::from(y).atan2(f64::from(x)).to_degrees().round() as i32;
    (from != to).then(|| angle.rem_euclid(360))
}

/// How often each cell was passed.
#[derive(Default)]
struct Passes(BTreeMap<Cell, usize>);

impl Passes {
    /// Where the way passes the cell this time.
    fn point(&mut self, cell: Cell) -> Place {
        let pass = self.0.entry(cell).or_default();
        let (x, y) = PASSES[*pass % PASSES.len()];
        *pass += 1;
        Place {
            x: middle(cell.column) + x,
            y: middle(cell.row) + y,
            angle: 0,
        }
    }
}

/// So many cells, in units; a grid has few.
fn units(cells: usize) -> i32 {
    i32::try_from(cells).unwrap_or(i32::MAX / SIDE) * SIDE
}

fn angle(by: Move) -> Option<i32> {
    match by {
        Move::Right => Some(0),
        Move::Down => Some(90),
        Move::Left => Some(180),
        Move::Up => Some(270),
        Move::Stay => None,
    }
}

fn lines(rows: usize, columns: usize) -> String {
    let mut lines = String::new();
    let (width, height) = (units(columns), units(rows));
    for column in 0..=columns {
        let _ = write!(lines, "M{} 0V{height}", units(column));
    }
    for row in 0..=rows {
        let _ = write!(lines, "M0 {}H{width}", units(row));
    }
    lines
}

fn tiles(grid: &Grid, looks: &[Look]) -> Vec<TileView> {
    let view = |at: Cell| {
        let look = match grid.tile(at) {
            Tile::Blank => return None,
            Tile::Wall => None,
            Tile::Coloured(symbol) => looks.get(Symbol::index(symbol)).cloned(),
        };
        Some(TileView {
            x: units(at.column),
            y: units(at.row),
            look,
        })
    };
    grid.cells().filter_map(view).collect()
}
