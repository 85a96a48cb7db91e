//! A walk through a grid as it is drawn, or recorded cells: tiles with their
//! letters, and the way
//! from the start to the token, numbered where it touches a tile.

use std::collections::BTreeMap;
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
    pub(crate) at: Place,
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
            start,
            token: start,
            steps: strides.len(),
        };
        let mut before = None;
        for stride in strides {
            let mut to = passes.point(stride.to);
            to.angle = stride.angle.unwrap_or(scene.token.angle);
            // Writing to a string never fails.
            let _ = write!(way, " L{} {}", to.x, to.y);
            if stride.angle.is_some() && before != Some(stride.angle) {
                scene.headings.push(Place {
                    x: i32::midpoint(scene.token.x, to.x),
                    y: i32::midpoint(scene.token.y, to.y),
                    angle: to.angle,
                });
            }
            if stride.touches {
                let number = scene.touches.len() + 1;
                scene.touches.push(TouchView { number, at: to });
            }
            scene.token = to;
            before = Some(stride.angle);
        }
        scene.way = way;
        scene
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
            x: units(cell.column) + SIDE / 2 + x,
            y: units(cell.row) + SIDE / 2 + y,
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
    let cells = (0..grid.rows())
        .flat_map(|row| (0..grid.columns()).map(move |column| Cell { row, column }));
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
    cells.filter_map(view).collect()
}
