//! Targets drawn at random: minimal automata of a shape, the same for the same
//! number everywhere.

use automata::{Alphabet, Dfa};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// What drawn targets have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// 3 to 8 states over 2 to 4 letters; every edge and every label even.
    Random,
    /// A task's: 3 to 8 states over 3 or 4 letters, of which one is a rejecting
    /// sink. Two thirds of the edges stay where they are, the others lead
    /// anywhere.
    Task,
}

/// Targets are drawn from these seeds on; a target's number is added.
const SEEDS: u64 = 1000;

const LETTERS: [&str; 4] = ["a", "b", "c", "d"];

impl Shape {
    /// The automaton of this shape and number, minimal.
    pub fn draw(self, number: u64) -> Dfa {
        let mut random = ChaCha8Rng::seed_from_u64(SEEDS.wrapping_add(number));
        let states: u32 = random.random_range(3..=8);
        let fewest: u32 = if self == Self::Task { 3 } else { 2 };
        let letters = random.random_range(fewest..=4) as usize;
        let alphabet = alphabet(letters);
        let sink = states as usize - 1;
        minimal(&alphabet, states as usize, || {
            let mut edge = |from: usize| {
                let to = random.random_range(0..states) as usize;
                let stays = random.random_range(0..3_u32) < 2;
                if self == Self::Task && (stays || from == sink) {
                    from
                } else {
                    to
                }
            };
            let rows = (0..states as usize)
                .map(|from| (0..letters).map(|_| edge(from)).collect())
                .collect();
            let mut accepting: Vec<bool> = (0..states).map(|_| random.random()).collect();
            if self == Self::Task {
                accepting[sink] = false;
            }
            (rows, accepting)
        })
    }
}

/// The first letters, up to four.
fn alphabet(letters: usize) -> Alphabet {
    Alphabet::new(LETTERS.into_iter().take(letters)).expect("different letters are an alphabet")
}

/// The first table drawn that is a minimal automaton of so many states: where to
/// go from each state by each symbol, and which states accept. State 0 is the
/// start.
///
/// # Panics
///
/// If a table that is drawn has other than so many rows, or leads out of them.
pub(crate) fn minimal(
    alphabet: &Alphabet,
    states: usize,
    mut draw: impl FnMut() -> (Vec<Vec<usize>>, Vec<bool>),
) -> Dfa {
    loop {
        let (rows, accepting) = draw();
        let dfa = Dfa::new(alphabet.clone(), 0, accepting, &rows)
            .expect("every entry of the table was drawn among its states");
        let minimal = dfa.minimise();
        if minimal.size() == states {
            return minimal;
        }
    }
}
