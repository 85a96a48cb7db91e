//! Grids beside a twin that walks every way there is.

use std::collections::BTreeMap;

use automata::{Dfa, Symbol, Word};
use memrep::world::grid::{Cell, Grid, GridError, GridMap, Labelling, Move, Step, Tile};
use memrep::world::{Trajectory, World};

use crate::draw::{self, Sort, alphabet, automaton, everything, grid_of};

/// Where a move leads.
fn go(grid: &Grid, from: Cell, by: Move) -> Option<Cell> {
    let (row, column) = match by {
        Move::Up => (from.row.checked_sub(1)?, from.column),
        Move::Right => (from.row, from.column + 1),
        Move::Down => (from.row + 1, from.column),
        Move::Left => (from.row, from.column.checked_sub(1)?),
        Move::Stay => (from.row, from.column),
    };
    let inside = row < grid.rows() && column < grid.columns();
    let to = Cell { row, column };
    (inside && grid.tile(to) != Tile::Wall).then_some(to)
}

/// What a step that ends on this cell gives.
fn gives(grid: &Grid, by: Move, to: Cell) -> Option<Symbol> {
    match grid.tile(to) {
        Tile::Coloured(_) if by == Move::Stay && grid.labelling() == Labelling::Entry => None,
        Tile::Coloured(symbol) => Some(symbol),
        _ => None,
    }
}

/// Quarter turns of a walk.
fn turns(moves: &[Move]) -> u32 {
    let headings: Vec<u32> = moves
        .iter()
        .filter(|by| **by != Move::Stay)
        .map(|by| *by as u32)
        .collect();
    let turn = |pair: &[u32]| {
        let apart = pair[0].abs_diff(pair[1]);
        apart.min(4 - apart)
    };
    headings.windows(2).map(turn).sum()
}

/// By word the fewest steps, and then turns, of all walks up to the limit.
fn all_walks(grid: &Grid) -> BTreeMap<Word, (usize, u32)> {
    let mut found = BTreeMap::new();
    let mut open: Vec<(Cell, Vec<Move>, Word)> = grid
        .starts()
        .map(|start| (start, Vec::new(), Word::empty()))
        .collect();
    while let Some((at, moves, word)) = open.pop() {
        let effort = (moves.len(), turns(&moves));
        let known = found.entry(word.clone()).or_insert(effort);
        *known = effort.min(*known);
        if moves.len() == grid.steps() {
            continue;
        }
        for by in Move::ALL {
            if let Some(to) = go(grid, at, by) {
                let mut longer = moves.clone();
                longer.push(by);
                let word = match gives(grid, by, to) {
                    Some(symbol) => word.with(symbol),
                    None => word.clone(),
                };
                open.push((to, longer, word));
            }
        }
    }
    found
}

fn small(number: u64) -> Grid {
    let mut random = draw::random(number);
    let sort = Sort {
        rows: 1 + (number % 3) as usize,
        columns: 2 + (number % 2) as usize,
        letters: 2 + (number % 2) as usize,
        silent: 0,
        coloured: 40,
        walls: 10,
        labelling: if number.is_multiple_of(3) {
            Labelling::EveryStep
        } else {
            Labelling::Entry
        },
        steps: 6,
    };
    draw::grid(&sort, &mut random)
}

/// The words of a twin's table that an automaton accepts, simplest first.
fn in_order(walks: &BTreeMap<Word, (usize, u32)>, language: &Dfa) -> Vec<Word> {
    let mut words: Vec<(&(usize, u32), &Word)> = walks
        .iter()
        .filter(|(word, _)| language.accepts(word))
        .map(|(word, effort)| (effort, word))
        .collect();
    words.sort();
    words.into_iter().map(|(_, word)| word.clone()).collect()
}

#[test]
fn words_come_in_the_order_of_all_walks() {
    for number in 0..60 {
        let grid = small(number);
        let walks = all_walks(&grid);
        let symbols = grid.alphabet().clone();
        let world = World::Grid(grid);
        let mut random = draw::random(1000 + number);
        for language in [
            everything(&symbols),
            automaton(&symbols, 4, &mut random),
            automaton(&symbols, 4, &mut random),
        ] {
            let expected = in_order(&walks, &language);
            let listing = world.list(&language, 100_000);
            assert!(listing.complete);
            assert_eq!(listing.words, expected, "grid {number}");
            let first = world.simplest(&language, 12);
            assert_eq!(first, expected[..expected.len().min(12)], "grid {number}");
            assert_eq!(world.has_word(&language), !expected.is_empty());
            let few = world.list(&language, 5);
            assert_eq!(few.words, expected[..few.words.len()]);
            assert!(few.complete || few.words.len() >= 5);
            let outline = world.outline().unwrap();
            assert!(expected.iter().all(|word| outline.accepts(word)));
        }
    }
}

#[test]
fn what_is_shown_is_exactly_the_word_and_wanders_least() {
    for number in 0..40 {
        let grid = small(number);
        let walks = all_walks(&grid);
        let world = World::Grid(grid);
        let grid = grid_of(&world);
        for word in grid.alphabet().words_up_to(5) {
            let shown = world.trajectory(&word);
            assert_eq!(world.is_feasible(&word), walks.contains_key(&word));
            assert_eq!(world.effort(&word), walks.get(&word).map(|effort| effort.0));
            let Some(Trajectory::Walk { from, steps }) = shown else {
                assert!(shown.is_none() && !walks.contains_key(&word));
                continue;
            };
            assert!(grid.starts().any(|start| start == from));
            let mut at = from;
            let mut given = Word::empty();
            for step in &steps {
                let to = go(grid, at, step.by).expect("nobody walks through walls");
                let symbol = gives(grid, step.by, to);
                let shown = Step {
                    by: step.by,
                    to,
                    gives: symbol,
                };
                assert_eq!(*step, shown);
                if let Some(symbol) = symbol {
                    given.push(symbol);
                }
                at = to;
            }
            assert_eq!(given, word);
            let moves: Vec<Move> = steps.iter().map(|step| step.by).collect();
            assert_eq!((steps.len(), turns(&moves)), walks[&word], "grid {number}");
        }
    }
}

#[test]
fn draws_can_happen_and_are_in_the_language() {
    for number in 0..20 {
        let grid = small(number);
        let symbols = grid.alphabet().clone();
        let world = World::Grid(grid);
        let mut random = draw::random(number);
        let language = automaton(&symbols, 3, &mut random);
        let drawn = world.draw(&language, 6, 30, &mut random);
        let expected = if world.has_word(&language) { 30 } else { 0 };
        assert_eq!(drawn.len(), expected);
        for word in drawn {
            assert!(world.is_feasible(&word) && language.accepts(&word));
        }
    }
}

fn drawn(text: &str, steps: usize) -> Result<Grid, GridError> {
    let symbols = alphabet(3);
    GridMap::new(&symbols, text).grid(symbols, Labelling::Entry, steps)
}

#[test]
fn a_grid_that_makes_no_sense_is_named_with_its_place() {
    let check = |text: &str, steps: usize, expected: &str| {
        assert_eq!(drawn(text, steps).unwrap_err().to_string(), expected);
    };
    check(
        "..a",
        9,
        "the grid has no start: mark at least one cell as one",
    );
    check(
        "S.a\n.x.",
        9,
        "the tile `x` at row 2, column 2 has no symbol: give its colour one, or use `#`, `.`, `S`, `a`, `b`, `c`",
    );
    check(
        "S.a\n..#\n.#b",
        9,
        "the tile `b` at row 3, column 3 cannot be reached from a start in 9 steps: open a way to it, allow more steps, or make it a wall",
    );
    check(
        "S..a",
        2,
        "the tile `a` at row 1, column 4 cannot be reached from a start in 2 steps: open a way to it, allow more steps, or make it a wall",
    );
    check(
        "S.a\n..",
        9,
        "row 2 has 2 cells and the first row 3: give all rows the same",
    );
    check(
        "",
        9,
        "the grid has no cell: give at least one row with one cell",
    );
    check("S.a", 0, "a trajectory may make 0 steps: allow 1 to 1000");
    let wide = format!("S{}", "a".repeat(50));
    check(
        &wide,
        99,
        "the grid has 1 rows and 51 columns: at most 50 of each",
    );
    let symbols = automata::Alphabet::new(["S"]).unwrap();
    let error = GridMap::new(&symbols, "S.S").grid(symbols, Labelling::Entry, 5);
    assert_eq!(error.unwrap_err(), GridError::Mark('S'));
    let wall = Grid::new(
        alphabet(1),
        &[vec![Tile::Wall, Tile::Blank]],
        &[Cell { row: 0, column: 0 }],
        Labelling::Entry,
        5,
    );
    assert_eq!(
        wall.unwrap_err().to_string(),
        "the start at row 1, column 1 is no cell that can be stepped on: move it, or remove the wall"
    );
}

#[test]
fn a_symbol_without_a_tile_is_no_mistake_and_never_happens() {
    let grid = drawn("S.a\n.b.", 9).unwrap();
    let symbols = grid.alphabet().clone();
    let world = World::Grid(grid);
    let c = symbols.symbol("c").unwrap();
    assert!(!world.is_feasible(&Word::from(vec![c])));
    let listed = world.list(&everything(&symbols), 1000).words;
    assert!(listed.iter().all(|word| word.iter().all(|a| a != c)));
}
