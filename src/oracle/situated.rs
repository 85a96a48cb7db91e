//! A scripted teacher who has seen the world: what it shows can happen there, and
//! is not settled beforehand.

use std::sync::Arc;

use automata::{Dfa, Word};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::{Counterexamples, ScriptedTeacher, Target, Teacher, TeacherSettings};
use crate::evidence::Comparison;
use crate::world::World;

/// Counterexamples are drawn among words of about this length.
const LONGEST: usize = 10;
/// The stream of the seed's generator for counterexamples.
const DRAWS: u64 = 3;

/// Answers as a [`ScriptedTeacher`] of the whole concept does, and refutes a
/// learned part by open words that can be shown. Where there is none, it agrees.
#[derive(Clone, Debug)]
pub struct SituatedTeacher {
    world: Arc<World>,
    open: Dfa,
    target: Dfa,
    counterexamples: Counterexamples,
    teacher: ScriptedTeacher,
    draws: ChaCha8Rng,
}

impl SituatedTeacher {
    /// A teacher of this target, who is asked about the words of `open`.
    pub fn new(world: Arc<World>, open: Dfa, target: &Target, settings: TeacherSettings) -> Self {
        let mut draws = ChaCha8Rng::seed_from_u64(settings.seed);
        draws.set_stream(DRAWS);
        Self {
            target: target.dfa().clone(),
            teacher: ScriptedTeacher::new(target, settings),
            counterexamples: settings.counterexamples,
            world,
            open,
            draws,
        }
    }
}

impl Teacher for SituatedTeacher {
    type Atom = Word;
    type Concept = Dfa;

    fn may_err(&self) -> bool {
        self.teacher.may_err()
    }

    fn membership(&mut self, atom: &Word) -> bool {
        self.teacher.membership(atom)
    }

    fn comparison(&mut self, first: &Word, second: &Word) -> Comparison {
        self.teacher.comparison(first, second)
    }

    /// # Panics
    ///
    /// If the hypothesis reads another alphabet than the target.
    fn counterexample(&mut self, hypothesis: &Dfa) -> Option<(Word, bool)> {
        let differ = self.target.xor(hypothesis);
        let differ = differ.and_then(|differ| differ.and(&self.open));
        let differ = differ.expect("a hypothesis reads the alphabet of the target");
        let word = match self.counterexamples {
            Counterexamples::Shortest => self.world.simplest(&differ, 1).pop(),
            Counterexamples::Random if self.world.has_word(&differ) => {
                (self.world.draw(&differ, LONGEST, 1, &mut self.draws)).pop()
            }
            Counterexamples::Random => None,
        }?;
        let label = self.target.accepts(&word);
        Some((word, label))
    }
}
