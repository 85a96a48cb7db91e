//! Grids and automata drawn at random, and time.

use std::time::Duration;

use automata::{Alphabet, Dfa, Symbol};
use memrep::bench::process_cpu;
use memrep::world::World;
use memrep::world::grid::{Cell, Grid, GridError, Labelling, Tile};
use rand::seq::IndexedRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The generator of this number.
pub(crate) fn random(number: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(number)
}

/// The first so many letters.
pub(crate) fn alphabet(letters: usize) -> Alphabet {
    let names = ["a", "b", "c", "d", "e", "f", "g", "h", "i"];
    Alphabet::new(names.into_iter().take(letters)).unwrap()
}

/// What a drawn grid is like.
pub(crate) struct Sort {
    pub(crate) rows: usize,
    pub(crate) columns: usize,
    pub(crate) letters: usize,
    /// Of the letters so many have no tile.
    pub(crate) silent: usize,
    /// Of a hundred cells, so many are coloured, and so many walls.
    pub(crate) coloured: u32,
    pub(crate) walls: u32,
    pub(crate) labelling: Labelling,
    pub(crate) steps: usize,
}

/// A grid of this sort: coloured tiles that cannot be reached become walls.
pub(crate) fn grid(sort: &Sort, random: &mut ChaCha8Rng) -> Grid {
    let alphabet = alphabet(sort.letters);
    loop {
        let symbols: Vec<Symbol> = alphabet
            .symbols()
            .take(sort.letters - sort.silent)
            .collect();
        let mut tile = |_: usize| match random.random_range(0..100_u32) {
            drawn if drawn < sort.coloured => Tile::Coloured(*symbols.choose(random).unwrap()),
            drawn if drawn < sort.coloured + sort.walls => Tile::Wall,
            _ => Tile::Blank,
        };
        let mut rows: Vec<Vec<Tile>> = (0..sort.rows)
            .map(|_| (0..sort.columns).map(&mut tile).collect())
            .collect();
        let starts: Vec<Cell> = (0..random.random_range(1..=2))
            .map(|_| Cell {
                row: random.random_range(0..sort.rows),
                column: random.random_range(0..sort.columns),
            })
            .collect();
        loop {
            let drawn = Grid::new(alphabet.clone(), &rows, &starts, sort.labelling, sort.steps);
            match drawn {
                Ok(grid) => return grid,
                Err(GridError::Unreachable { at, .. }) => rows[at.row][at.column] = Tile::Wall,
                // A start became a wall, or was one: draw again.
                Err(_) => break,
            }
        }
    }
}

/// Any automaton with up to so many states.
pub(crate) fn automaton(alphabet: &Alphabet, states: usize, random: &mut ChaCha8Rng) -> Dfa {
    let states = random.random_range(1..=states);
    let rows: Vec<Vec<usize>> = (0..states)
        .map(|_| {
            let mut entry = |_| random.random_range(0..states);
            alphabet.symbols().map(&mut entry).collect()
        })
        .collect();
    let accepting = (0..states).map(|_| random.random()).collect();
    Dfa::new(alphabet.clone(), 0, accepting, &rows).unwrap()
}

/// All words.
pub(crate) fn everything(alphabet: &Alphabet) -> Dfa {
    Dfa::new(alphabet.clone(), 0, vec![true], &[vec![0; alphabet.len()]]).unwrap()
}

/// The grid of a world.
pub(crate) fn grid_of(world: &World) -> &Grid {
    match world {
        World::Grid(grid) => grid,
        _ => panic!("this world is no grid"),
    }
}

/// The CPU time since then.
pub(crate) fn since(start: Duration) -> Duration {
    process_cpu().saturating_sub(start)
}
