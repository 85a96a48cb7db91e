//! The grid on which a person draws a way, for the script that follows it.

use serde_json::json;

use super::behaviour::chips;
use super::scene::{Look, Scene};
use crate::session::{Session, SymbolText};
use crate::world::World;
use crate::world::grid::{Cell, Grid, Tile};

/// A grid to walk on.
pub(crate) struct WalkView {
    /// Its picture, before the first step.
    pub(crate) scene: Scene,
    /// What the script must know, as JSON.
    pub(crate) grid: String,
    /// The most steps.
    pub(crate) steps: usize,
}

impl WalkView {
    /// The world of a session; none where it is no grid.
    pub(crate) fn of(session: &Session) -> Option<Self> {
        let Some(World::Grid(grid)) = session.world() else {
            return None;
        };
        let looks: Vec<Look> = chips(session.task())
            .into_iter()
            .map(|chip| Look {
                letter: chip.letter,
                tone: chip.tone,
                colour: chip.colour,
            })
            .collect();
        let texts: Vec<&str> = (session.task().symbols.iter())
            .map(SymbolText::text)
            .collect();
        let start = grid.starts().next()?;
        Some(Self {
            scene: Scene::of(grid, start, &[], &looks),
            grid: describe(grid, &texts),
            steps: grid.steps(),
        })
    }
}

fn describe(grid: &Grid, texts: &[&str]) -> String {
    let cell = |row, column| match grid.tile(Cell { row, column }) {
        Tile::Wall => json!("wall"),
        Tile::Blank => json!(null),
        Tile::Coloured(symbol) => json!(symbol.index()),
    };
    let row = |row| -> Vec<_> {
        (0..grid.columns())
            .map(|column| cell(row, column))
            .collect()
    };
    let rows: Vec<_> = (0..grid.rows()).map(row).collect();
    let starts: Vec<_> = grid.starts().map(|at| [at.row, at.column]).collect();
    json!({
        "tiles": rows,
        "starts": starts,
        "labelling": grid.labelling(),
        "steps": grid.steps(),
        "texts": texts,
        "names": grid.alphabet().names().collect::<Vec<_>>(),
    })
    .to_string()
}
