//! A teacher that knows a target automaton, and may err.

use automata::{Dfa, Word};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::counterexample::Counterexamples;
use super::order::{Order, PreferenceOrder};
use super::{Target, Teacher};
use crate::evidence::Comparison;

/// How a scripted teacher answers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TeacherSettings {
    /// The preference order.
    pub order: Order,
    /// The counterexamples.
    pub counterexamples: Counterexamples,
    /// The probability, in `[0, 1]`, with which an answer to a membership query
    /// or a comparison is wrong.
    pub error_rate: f64,
    /// Decides all that is random.
    pub seed: u64,
}

/// Answers for a target. Equivalence queries are always answered truly; other
/// answers are wrong at the error rate.
///
/// Errors are drawn anew for every question asked, also for one asked before: a
/// person who slipped may get it right the second time, and a learner that drops
/// a wrong answer and asks again would otherwise be told the same for ever. A
/// wrong membership answer is the other one; a wrong comparison names the worse
/// word, or either word at random where neither is better.
#[derive(Clone, Debug)]
pub struct ScriptedTeacher {
    target: Dfa,
    order: PreferenceOrder,
    counterexamples: Counterexamples,
    error_rate: f64,
    errors: ChaCha8Rng,
    draws: ChaCha8Rng,
}

/// The streams of the seed's generator that are used for different things.
const ERRORS: u64 = 1;
const DRAWS: u64 = 2;

impl ScriptedTeacher {
    /// A teacher of this target.
    pub fn new(target: &Target, settings: TeacherSettings) -> Self {
        let stream = |number| {
            let mut random = ChaCha8Rng::seed_from_u64(settings.seed);
            random.set_stream(number);
            random
        };
        Self {
            target: target.dfa().clone(),
            order: PreferenceOrder::new(settings.order, target.dfa(), settings.seed),
            counterexamples: settings.counterexamples,
            error_rate: settings.error_rate.clamp(0.0, 1.0),
            errors: stream(ERRORS),
            draws: stream(DRAWS),
        }
    }

    fn errs(&mut self) -> bool {
        self.errors.random_bool(self.error_rate)
    }
}

impl Teacher for ScriptedTeacher {
    type Atom = Word;
    type Concept = Dfa;

    fn membership(&mut self, atom: &Word) -> bool {
        self.target.accepts(atom) != self.errs()
    }

    fn comparison(&mut self, first: &Word, second: &Word) -> Comparison {
        let answer = self.order.compare(first, second);
        if !self.errs() {
            return answer;
        }
        match answer {
            Comparison::First | Comparison::Second => answer.mirrored(),
            Comparison::Equal | Comparison::Incomparable => {
                if self.errors.random() {
                    Comparison::First
                } else {
                    Comparison::Second
                }
            }
        }
    }

    /// # Panics
    ///
    /// If the hypothesis reads another alphabet than the target.
    fn counterexample(&mut self, hypothesis: &Dfa) -> Option<(Word, bool)> {
        let found = self
            .counterexamples
            .find(&self.target, hypothesis, &mut self.draws)
            .expect("a hypothesis reads the alphabet of the target");
        found.map(|word| {
            let label = self.target.accepts(&word);
            (word, label)
        })
    }
}
