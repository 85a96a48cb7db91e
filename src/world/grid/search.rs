//! The shortest trajectory whose word a machine accepts: breadth first, all cells
//! of a state of the machine in one go; among the shortest the one that wanders
//! least.
//!
//! Grids of 50 × 50 cells and machines of 150 states take a few milliseconds:
//! a step of 2500 cells is some 40 numbers shifted five ways, so to skip over
//! blank cells by distances worked out before would not pay.

use std::collections::BTreeMap;

use automata::{Dfa, Word};

use super::super::machine::Machine;
use super::path::{Move, Path};
use super::{Cells, Grid, Labelling};

/// By state of the machine the cells in which a trajectory is that has just come
/// there for the first time.
type Front = BTreeMap<u32, Cells>;

impl Grid {
    /// The shortest way whose word is accepted; of the shortest the one whose
    /// [`Path::key`] is least.
    pub(in crate::world) fn find(&self, machine: &Machine) -> Option<Path> {
        let fronts = self.advance(machine)?;
        Some(self.least(machine, &self.backwards(machine, &fronts)))
    }

    /// The words of the language, simplest first: each is found by a search for the
    /// simplest that was not found before.
    pub(in crate::world) fn words_in(
        &self,
        language: &Dfa,
    ) -> impl Iterator<Item = Word> + use<'_> {
        let mut rest = language.clone();
        std::iter::from_fn(move || {
            let word = self.find(&Machine::new(&rest))?.word;
            rest = without(&rest, &word);
            Some(word)
        })
    }

    /// Whether any word is accepted.
    pub(in crate::world) fn has_word(&self, machine: &Machine) -> bool {
        self.advance(machine).is_some()
    }

    /// The fronts after every step, up to the first in which a word is accepted;
    /// none if no word is.
    fn advance(&self, machine: &Machine) -> Option<Vec<Front>> {
        let is_goal = |front: &Front| front.keys().any(|&state| machine.is_accepting(state));
        let mut seen = vec![Cells::none(self.bits()); machine.size()];
        let mut front = Front::new();
        let start = machine.start()?;
        seen[start as usize] = self.start_cells();
        front.insert(start, self.start_cells());
        let mut fronts = vec![front];
        while !is_goal(fronts.last()?) {
            if fronts.len() > self.steps {
                return None;
            }
            let next = self.next_front(machine, fronts.last()?, &mut seen);
            if next.is_empty() {
                return None;
            }
            fronts.push(next);
        }
        Some(fronts)
    }

    fn next_front(&self, machine: &Machine, front: &Front, seen: &mut [Cells]) -> Front {
        let mut next = Front::new();
        let mut arrive = |state: u32, mut cells: Cells| {
            let known = &mut seen[state as usize];
            cells.remove(known);
            if !cells.is_empty() {
                known.add(&cells);
                next.entry(state)
                    .and_modify(|others| others.add(&cells))
                    .or_insert(cells);
            }
        };
        for (&state, cells) in front {
            let mut moved = cells.moved(self.stride());
            arrive(state, moved.and(&self.blank));
            if self.labelling == Labelling::EveryStep {
                // To stay on a blank cell leads nowhere new.
                moved.add(cells);
            }
            for symbol in self.alphabet.symbols() {
                let entered = &self.coloured[symbol.index()];
                if moved.meets(entered)
                    && let Some(then) = machine.next(state, symbol)
                {
                    arrive(then, moved.and(entered));
                }
            }
        }
        next
    }

    /// Of every front, what lies on a shortest way to a goal.
    fn backwards(&self, machine: &Machine, fronts: &[Front]) -> Vec<Front> {
        let mut useful: Vec<Front> = Vec::with_capacity(fronts.len());
        let mut goals = fronts.last().cloned().unwrap_or_default();
        goals.retain(|&state, _| machine.is_accepting(state));
        useful.push(goals);
        for front in fronts.iter().rev().skip(1) {
            let mut before = Front::new();
            for (&state, cells) in useful.last().into_iter().flatten() {
                let mut leave = |from: u32, cells: &Cells, stays: bool| {
                    let Some(there) = front.get(&from) else {
                        return;
                    };
                    let mut sources = cells.moved(self.stride());
                    if stays {
                        sources.add(cells);
                    }
                    sources.keep(there);
                    if !sources.is_empty() {
                        before
                            .entry(from)
                            .and_modify(|others| others.add(&sources))
                            .or_insert(sources);
                    }
                };
                leave(state, &cells.and(&self.blank), false);
                for symbol in self.alphabet.symbols() {
                    let entered = cells.and(&self.coloured[symbol.index()]);
                    if !entered.is_empty() {
                        for from in machine.before(state, symbol) {
                            leave(from, &entered, self.labelling == Labelling::EveryStep);
                        }
                    }
                }
            }
            useful.push(before);
        }
        useful.reverse();
        useful
    }

    /// The least way through these cells. Two ways to one place in one heading go
    /// on alike, so only the lesser is kept.
    fn least(&self, machine: &Machine, useful: &[Front]) -> Path {
        let mut ways: BTreeMap<(u32, usize, Option<Move>), Path> = BTreeMap::new();
        let keep = |ways: &mut BTreeMap<_, Path>, place, path: Path| match ways.get_mut(&place) {
            Some(known) if known.key() <= path.key() => {}
            Some(known) => *known = path,
            None => {
                ways.insert(place, path);
            }
        };
        for (&state, cells) in useful.first().into_iter().flatten() {
            for (place, &start) in self.starts.iter().enumerate() {
                if cells.contains(start) {
                    keep(&mut ways, (state, start, None), Path::from(place));
                }
            }
        }
        for front in useful.iter().skip(1) {
            let mut longer = BTreeMap::new();
            for (&(state, at, heading), path) in &ways {
                for by in Move::ALL {
                    let Some(to) = self.step(at, by) else {
                        continue;
                    };
                    let gives = self.given(to);
                    let then = match gives {
                        Some(symbol) => machine.next(state, symbol),
                        None => Some(state),
                    };
                    let Some(then) = then else {
                        continue;
                    };
                    if front.get(&then).is_some_and(|cells| cells.contains(to)) {
                        let place = (then, to, by.heading(heading));
                        keep(&mut longer, place, path.with(heading, by, gives));
                    }
                }
            }
            ways = longer;
        }
        let least = ways
            .into_values()
            .min_by(|one, other| one.key().cmp(&other.key()));
        least.expect("every useful cell lies on a way from a start to a goal")
    }
}

/// The language without one word. It has no more states than the language and the
/// word together.
fn without(language: &Dfa, word: &Word) -> Dfa {
    let alphabet = language.alphabet().clone();
    let other = word.len() + 1;
    let rows: Vec<Vec<usize>> = (0..=other)
        .map(|state| {
            let wanted = word.symbols().get(state);
            let next = |symbol| {
                if wanted == Some(&symbol) {
                    state + 1
                } else {
                    other
                }
            };
            alphabet.symbols().map(next).collect()
        })
        .collect();
    let accepting = (0..=other).map(|state| state != word.len()).collect();
    let others = Dfa::new(alphabet, 0, accepting, &rows)
        .expect("every state has a row, and every entry is a state");
    language
        .and(&others)
        .expect("the word is over the alphabet of the language")
}
