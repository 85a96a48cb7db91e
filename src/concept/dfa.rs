//! The languages of deterministic finite automata, by their number of states.

use automata::{Alphabet, Dfa, Word};
use rand::RngExt;
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;

use super::{ConceptClass, End, Failure, Sample, Spread, Wish};
use crate::evidence::{AnswerId, Budget, Fact};
use crate::identify::{self, Identifier, Settings};

/// Words up to this length are drawn to check even the smallest hypothesis.
const LONGEST: usize = 10;

/// As many shorter words are listed at most.
const SHORTER: usize = 1000;

/// All regular languages over an alphabet: the concepts are minimal automata,
/// the atoms words, and the size is the number of states.
#[derive(Clone)]
pub struct DfaClass {
    alphabet: Alphabet,
    identifier: Identifier,
}

impl DfaClass {
    /// The languages over this alphabet, with at most `settings.max_states`
    /// states.
    pub fn new(alphabet: Alphabet, settings: Settings) -> Self {
        Self {
            identifier: Identifier::new(alphabet.clone(), settings),
            alphabet,
        }
    }

    /// The alphabet of the words.
    pub fn alphabet(&self) -> &Alphabet {
        &self.alphabet
    }
}

impl ConceptClass for DfaClass {
    type Concept = Dfa;
    type Atom = Word;

    fn add(&mut self, answer: Option<AnswerId>, fact: Fact<Word>) {
        self.identifier.add(answer, fact);
    }

    fn retract(&mut self, answer: AnswerId) {
        self.identifier.retract(answer);
    }

    fn forget(&mut self) {
        self.identifier.forget();
    }

    fn contains(&self, concept: &Dfa, atom: &Word) -> bool {
        concept.accepts(atom)
    }

    fn sample(
        &mut self,
        count: usize,
        seed: u64,
        budget: &mut Budget,
    ) -> Result<Sample<Dfa>, Failure> {
        let sample = self.identifier.smallest(count, seed, budget)?;
        Ok(Sample {
            concepts: sample.automata,
            complete: sample.complete,
        })
    }

    fn spread(
        &mut self,
        wish: &Wish<'_, Word>,
        budget: &mut Budget,
    ) -> Result<Spread<Dfa>, Failure> {
        self.identifier.spread(wish, budget)
    }

    fn end(&self, concept: &Dfa, atom: &Word) -> End {
        identify::end(concept, atom)
    }

    fn ends(&self, concepts: &[&Dfa], atoms: &[Word]) -> Vec<Vec<End>> {
        identify::ends(concepts, atoms)
    }

    fn witnesses(&self, inside: &Dfa, outside: &Dfa, count: usize) -> Vec<Word> {
        // Two automata over different alphabets have no common words to differ
        // on; all automata of this class are over its own.
        inside
            .product(outside, |inside, outside| inside && !outside)
            .map(|difference| difference.accepted_words().take(count).collect())
            .unwrap_or_default()
    }

    /// The shorter words: of two words of one length neither is simpler.
    fn simpler(&self, atom: &Word) -> Vec<Word> {
        let shorter = self.alphabet.words().take(SHORTER);
        shorter.take_while(|word| word.len() < atom.len()).collect()
    }

    fn atoms(&self) -> Box<dyn Iterator<Item = Word> + '_> {
        Box::new(self.alphabet.words())
    }

    /// Half of the words are drawn from those that the hypothesis accepts and
    /// half from those it rejects: of all words, many a task accepts next to
    /// none, and to judge one rejected word after another would bear out little.
    fn draw(&self, hypothesis: &Dfa, count: usize, random: &mut ChaCha8Rng) -> Vec<Word> {
        let complement = hypothesis.complement();
        let sides = [hypothesis, &complement].map(|side| {
            let words = side.word_counts(longest(hypothesis));
            let lengths: Vec<usize> = (0..=words.longest())
                .filter(|&length| words.of_length(length).bits() > 0)
                .collect();
            (words, lengths)
        });
        let draw = |_| {
            let drawn = usize::from(random.random::<bool>());
            let side = if sides[drawn].1.is_empty() {
                1 - drawn
            } else {
                drawn
            };
            let (words, lengths) = &sides[side];
            let &length = lengths.choose(random)?;
            words.sample_of_length(length, random)
        };
        (0..count).filter_map(draw).collect()
    }

    fn drawn_from(&self, hypothesis: &Dfa) -> String {
        let longest = longest(hypothesis);
        format!(
            "words of up to {longest} symbols, half of them accepted by it and half rejected, \
             every length and every word of a length equally likely"
        )
    }
}

/// The longest word by which a hypothesis is checked. Another language with as
/// many states differs from it on a word shorter than twice their number.
fn longest(hypothesis: &Dfa) -> usize {
    LONGEST.max(2 * hypothesis.size())
}
