//! How a teacher refutes a hypothesis.

use automata::{AlphabetMismatch, Dfa, Word};
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

/// Which counterexample a teacher gives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Counterexamples {
    /// The least one in the length-lexicographic order.
    #[default]
    Shortest,
    /// Of the lengths up to 10 (or that of the shortest, if it is longer) that
    /// some counterexample has, one drawn uniformly; of that length a
    /// counterexample drawn uniformly.
    Random,
}

/// Random counterexamples are no longer than this where a shorter one exists.
const LONGEST: usize = 10;

impl Counterexamples {
    /// A word on which the two differ; none if they accept the same language.
    ///
    /// # Errors
    ///
    /// If they read different alphabets.
    pub fn find(
        self,
        target: &Dfa,
        hypothesis: &Dfa,
        random: &mut ChaCha8Rng,
    ) -> Result<Option<Word>, AlphabetMismatch> {
        let difference = target.xor(hypothesis)?;
        let Some(shortest) = difference.shortest_accepted() else {
            return Ok(None);
        };
        if self == Self::Shortest {
            return Ok(Some(shortest));
        }
        let counts = difference.word_counts(LONGEST.max(shortest.len()));
        let mut lengths: Vec<usize> = (0..=counts.longest()).collect();
        lengths.shuffle(random);
        let drawn = lengths
            .into_iter()
            .find_map(|length| counts.sample_of_length(length, random));
        Ok(Some(drawn.unwrap_or(shortest)))
    }
}
