//! Algorithms 4 and 5: from the evidence to the next move.

use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::exp4::{COMPARISON, MEMBERSHIP};
use super::experts::{Losses, PosteriorAdvice, Round};
use super::outlook::Weighed;
use super::selection::{CONCEPTS, Candidates, Compare, Judge, select};
use super::{Learner, Question, Step, Strategy};
use crate::concept::{ConceptClass, Failure};
use crate::evidence::{Budget, Stop};

/// How many consistent concepts stand for all of them. The share that an answer
/// leaves (Eq. 5.3) is then known to at most `√(1/(4·32))`, nine in a hundred,
/// well below the experts' temperature.
const SAMPLE: usize = 32;

/// A step, and the simplest concept known to be consistent.
pub(super) type Move<C> = (
    Step<<C as ConceptClass>::Atom, <C as ConceptClass>::Concept>,
    Option<<C as ConceptClass>::Concept>,
);

/// A question of a concept class.
type Asked<C> = Question<<C as ConceptClass>::Atom, <C as ConceptClass>::Concept>;

/// A question, and the bandit's round in which it was chosen.
pub(super) type Chosen<C> = (Asked<C>, Option<Round>);

/// A question that the bandit may choose, and the losses of its answers.
pub(super) type Arm<C> = (Asked<C>, Losses);

impl<C: ConceptClass> Learner<C> {
    /// The next move, by Algorithm 4.
    pub(super) fn choose(&mut self, stop: &Stop) -> Move<C> {
        if let Some(conflict) = self.evidence.order.conflict() {
            return (Step::Conflict(conflict), None);
        }
        if let Some(hypothesis) = self.agreed() {
            let step = match self.unjudged(&hypothesis) {
                Some(atom) => ask(Question::Membership { atom }, None, false),
                None => Step::Done {
                    hypothesis: hypothesis.clone(),
                },
            };
            self.look_back(&hypothesis);
            return (step, Some(hypothesis));
        }
        if self.config.strategy.has_posterior() {
            return self.weigh(stop);
        }
        self.learn_by_elimination(stop)
    }

    /// The next move by Algorithm 4: concepts are eliminated until one is left.
    pub(super) fn learn_by_elimination(&mut self, stop: &Stop) -> Move<C> {
        let mut random = self.generator();
        let mut budget = Budget::until(self.config.budget, stop);
        let sample = match self.class.sample(SAMPLE, random.random(), &mut budget) {
            Ok(sample) => sample,
            Err(Failure::Contradiction(conflict)) => return (Step::Conflict(conflict), None),
            Err(Failure::OverBudget { .. }) => return self.without_candidates(random.random()),
        };
        let simplest = sample.concepts.first().cloned();
        let hurried = !sample.complete && sample.concepts.len() < SAMPLE;
        let step = match (&sample.concepts[..], sample.complete) {
            ([only], true) => ask(equivalence(only), None, false),
            ([only], false) => self.with_one_candidate(only),
            (concepts, _) => {
                let (question, round) = self.question(concepts, &mut random).unwrap_or_else(|| {
                    // All that could tell them apart was skipped.
                    (equivalence(&concepts[0]), None)
                });
                ask(question, round, hurried)
            }
        };
        if let Step::Ask { question, .. } = &step {
            let count = sample.concepts.len();
            let weighed = Weighed {
                concepts: &sample.concepts,
                weights: &vec![1.0 / count as f64; count],
                exact: sample.complete,
            };
            self.outlook = Some(self.outlook_on(question, &weighed));
        }
        (step, simplest)
    }

    /// The generator of this step. A stream of its own for every number of
    /// entries: what was drawn earlier has no say in it.
    pub(super) fn generator(&self) -> ChaCha8Rng {
        let mut random = ChaCha8Rng::seed_from_u64(self.config.seed);
        random.set_stream(self.entries.len() as u64);
        random
    }

    /// A question that tells two concepts of the sample apart: two drawn
    /// uniformly, or, where nothing can be asked about these, any two.
    fn question(&self, concepts: &[C::Concept], random: &mut ChaCha8Rng) -> Option<Chosen<C>> {
        let mut places: Vec<usize> = (0..concepts.len()).collect();
        places.shuffle(random);
        let pairs = places
            .iter()
            .enumerate()
            .flat_map(|(index, &one)| places[index + 1..].iter().map(move |&other| [one, other]));
        for psi in pairs {
            let candidates = self.candidates(concepts, psi);
            if candidates.membership.is_some() || candidates.comparison.is_some() {
                return self.bet(candidates, random);
            }
        }
        None
    }

    fn candidates(&self, concepts: &[C::Concept], psi: [usize; CONCEPTS]) -> Candidates<C::Atom> {
        let comparisons = self.compares();
        select(&self.class, &self.evidence, concepts, psi, comparisons)
    }

    /// Whether comparisons are asked at all.
    pub(super) fn compares(&self) -> bool {
        self.config.strategy != Strategy::Membership && self.config.comparison_cost.is_finite()
    }

    /// Algorithm 5: lets the bandit choose between the candidates.
    fn bet(&self, candidates: Candidates<C::Atom>, random: &mut ChaCha8Rng) -> Option<Chosen<C>> {
        let config = &self.config;
        // Which of two atoms is shown first is drawn, so that the place says
        // nothing and a habit of choosing the first does no harm.
        let membership = candidates.membership.map(
            |Judge {
                 atom,
                 accept,
                 reject,
             }| {
                let losses = Losses::of_membership(config, accept, reject);
                (Question::Membership { atom }, losses)
            },
        );
        let comparison = candidates.comparison.map(|compare| {
            let Compare {
                left,
                right,
                left_better,
                right_better,
                equal,
            } = if random.random() {
                compare
            } else {
                compare.mirrored()
            };
            // What cannot be compared refutes nothing.
            let shares = [left_better, right_better, equal, 1.0];
            let losses = Losses::of_comparison(config, shares);
            let (first, second) = (left, right);
            (Question::Comparison { first, second }, losses)
        });
        self.pull([membership, comparison], None, random)
    }

    /// Lets the bandit choose between a membership query and a comparison; where
    /// no comparisons are asked, there is nothing to choose.
    pub(super) fn pull(
        &self,
        mut arms: [Option<Arm<C>>; 2],
        posterior: Option<PosteriorAdvice>,
        random: &mut ChaCha8Rng,
    ) -> Option<Chosen<C>> {
        if !self.compares() {
            let membership = arms[MEMBERSHIP].take();
            return membership.map(|(question, _)| (question, None));
        }
        let losses = [&arms[MEMBERSHIP], &arms[COMPARISON]].map(|arm| Some(arm.as_ref()?.1));
        let round = self.bandit.pull(losses, posterior, random.random())?;
        let (question, _) = arms[round.losses.arm()].take()?;
        Some((question, Some(round)))
    }

    /// The budget showed no consistent concept: the simplest atom of which
    /// nothing is known makes the next search easier, whatever it is.
    pub(super) fn without_candidates(&mut self, seed: u64) -> Move<C> {
        if let Some(atom) = self.unknown_atom() {
            return (ask(Question::Membership { atom }, None, true), None);
        }
        // Everything is known or skipped, so the universe is finite, and so is
        // the search for a concept.
        match self.class.sample(1, seed, &mut Budget::unlimited()) {
            Ok(sample) => {
                let concept = sample.concepts.into_iter().next();
                let step = concept.as_ref().map(equivalence);
                let step = step.expect("a sample has at least one concept");
                (ask(step, None, true), concept)
            }
            Err(Failure::Contradiction(conflict)) => (Step::Conflict(conflict), None),
            Err(Failure::OverBudget { .. }) => unreachable!("an unlimited budget never ends"),
        }
    }

    /// The budget showed one concept and not whether there are others. It is put
    /// to the teacher, whose counterexample would say the most; but not twice in
    /// a row, as a counterexample is the dearest answer to give.
    fn with_one_candidate(&self, only: &C::Concept) -> Step<C::Atom, C::Concept> {
        let shown = self
            .entries
            .last()
            .is_some_and(|entry| matches!(entry.question, Question::Equivalence { .. }));
        let question = match self.unknown_atom() {
            Some(atom) if shown => Question::Membership { atom },
            _ => equivalence(only),
        };
        ask(question, None, true)
    }

    /// The simplest atom that is neither labelled nor skipped.
    fn unknown_atom(&self) -> Option<C::Atom> {
        self.class
            .atoms()
            .find(|atom| self.evidence.may_judge(atom))
    }
}

pub(super) fn equivalence<A, C: Clone>(hypothesis: &C) -> Question<A, C> {
    Question::Equivalence {
        hypothesis: hypothesis.clone(),
    }
}

pub(super) fn ask<A, C>(
    question: Question<A, C>,
    round: Option<Round>,
    hurried: bool,
) -> Step<A, C> {
    Step::Ask {
        question,
        round,
        hurried,
    }
}
