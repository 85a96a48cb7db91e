//! A teacher that knows its target, and may err.

use std::fmt::Debug;

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

/// What a scripted teacher has in mind: a concept and a preference order that
/// respects membership in it.
pub trait Goal: Debug {
    /// One element of the universe.
    type Atom;
    /// One concept.
    type Concept;

    /// Whether the concept contains the atom.
    fn contains(&self, atom: &Self::Atom) -> bool;

    /// Which of the two is better.
    fn compare(&self, first: &Self::Atom, second: &Self::Atom) -> Comparison;

    /// An atom about which the hypothesis is wrong; none if it is right about all.
    fn refute(
        &self,
        hypothesis: &Self::Concept,
        counterexamples: Counterexamples,
        random: &mut ChaCha8Rng,
    ) -> Option<Self::Atom>;
}

/// The language of an automaton as a goal.
#[derive(Clone, Debug)]
pub struct Language {
    target: Dfa,
    order: PreferenceOrder,
}

impl Goal for Language {
    type Atom = Word;
    type Concept = Dfa;

    fn contains(&self, atom: &Word) -> bool {
        self.target.accepts(atom)
    }

    fn compare(&self, first: &Word, second: &Word) -> Comparison {
        self.order.compare(first, second)
    }

    /// # Panics
    ///
    /// If the hypothesis reads another alphabet than the target.
    fn refute(
        &self,
        hypothesis: &Dfa,
        counterexamples: Counterexamples,
        random: &mut ChaCha8Rng,
    ) -> Option<Word> {
        counterexamples
            .find(&self.target, hypothesis, random)
            .expect("a hypothesis reads the alphabet of the target")
    }
}

/// Answers for a goal. Equivalence queries are always answered truly; other
/// answers are wrong at the error rate.
///
/// Errors are drawn anew for every question asked, also for one asked before: a
/// person who slipped may get it right the second time, and a learner that drops
/// a wrong answer and asks again would otherwise be told the same for ever. A
/// wrong membership answer is the other one; a wrong comparison names the worse
/// atom, or either at random where neither is better.
#[derive(Clone, Debug)]
pub struct ScriptedTeacher<G = Language> {
    goal: G,
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
        let goal = Language {
            target: target.dfa().clone(),
            order: PreferenceOrder::new(settings.order, target.dfa(), settings.seed),
        };
        Self::of(goal, settings)
    }
}

impl<G: Goal> ScriptedTeacher<G> {
    /// A teacher of this goal, who has its own order.
    pub fn of(goal: G, settings: TeacherSettings) -> Self {
        let stream = |number| {
            let mut random = ChaCha8Rng::seed_from_u64(settings.seed);
            random.set_stream(number);
            random
        };
        Self {
            goal,
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

impl<G: Goal> Teacher for ScriptedTeacher<G> {
    type Atom = G::Atom;
    type Concept = G::Concept;

    fn may_err(&self) -> bool {
        self.error_rate > 0.0
    }

    fn membership(&mut self, atom: &G::Atom) -> bool {
        self.goal.contains(atom) != self.errs()
    }

    fn comparison(&mut self, first: &G::Atom, second: &G::Atom) -> Comparison {
        let answer = self.goal.compare(first, second);
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

    fn counterexample(&mut self, hypothesis: &G::Concept) -> Option<(G::Atom, bool)> {
        let goal = &self.goal;
        let found = goal.refute(hypothesis, self.counterexamples, &mut self.draws)?;
        let label = goal.contains(&found);
        Some((found, label))
    }
}
