//! The learner of a session, whatever class it learns.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::Setup;
use crate::concept::{ConceptClass, DfaClass};
use crate::evidence::{AnswerId, Stop};
use crate::identify::{EngineChoice, Settings};
use crate::learner::{Counts, Learner, Outlook, Question, Reply, Round, Step};
use crate::task::{Atom, Concept, Task, Universe};

/// A learner that is told and asks in the words of every class.
pub(super) trait Pupil: Send {
    /// The next move; none, and soon, once it is to stop.
    fn next_until(&mut self, stop: &Stop) -> Option<Step<Atom, Concept>>;

    /// Says why where the answer makes no sense.
    fn record(
        &mut self,
        answer: AnswerId,
        question: Question<Atom, Concept>,
        round: Option<Round>,
        reply: Reply<Atom>,
    ) -> Result<(), String>;

    fn counts(&self) -> Counts;

    /// Whether the answer to this question may still teach something; never to an
    /// equivalence query, since what was said last may have changed the hypothesis.
    fn wants(&self, question: &Question<Atom, Concept>) -> bool;

    /// What was left as the last question was put, if it was by `next`.
    fn outlook(&self) -> Option<Outlook<Concept>>;

    /// Another learner that was told the same.
    fn fork(&self) -> Box<dyn Pupil>;

    /// What nothing that can be shown tells about this hypothesis.
    fn beyond(&self, hypothesis: &Concept) -> Option<Atom>;

    /// Independent draws by which this hypothesis can be checked, and from what;
    /// from a stream of the seed that is this question's alone.
    fn draw(
        &self,
        hypothesis: &Concept,
        count: usize,
        seed: u64,
        question: u64,
    ) -> Option<(Vec<Atom>, String)>;
}

/// A learner that was told no answer yet.
///
/// # Errors
///
/// If what is known at the start does not fit the situation, of a task that was not
/// read but put together.
pub(super) fn new(
    task: &Task,
    universe: &Universe,
    setup: &Setup,
) -> Result<Box<dyn Pupil>, String> {
    let settings = Settings {
        engine: EngineChoice::Auto,
        max_states: task.max_states,
    };
    let config = setup.config();
    Ok(match universe {
        Universe::Words {
            alphabet,
            situation: None,
        } => {
            let class = DfaClass::new(alphabet.clone(), settings);
            Box::new(Learner::new(class, config, task.known(universe)))
        }
        Universe::Words {
            situation: Some(situation),
            ..
        } => {
            let class = situation.class(settings);
            let class = class.map_err(|error| error.to_string())?;
            let known = class.examples(&task.known(universe));
            let known = known.map_err(|error| error.to_string())?;
            Box::new(Learner::new(class, config, known))
        }
        Universe::Monotone(axes) => {
            Box::new(Learner::new(axes.class(), config, task.known(universe)))
        }
        Universe::Finite(table) => {
            let class = table.class().clone();
            Box::new(Learner::new(class, config, task.known(universe)))
        }
        Universe::Linear(rewards) => {
            Box::new(Learner::new(rewards.class(), config, task.known(universe)))
        }
    })
}

impl<C> Pupil for Learner<C>
where
    C: ConceptClass + Clone + Send + 'static,
    C::Atom: TryFrom<Atom> + Send,
    C::Concept: TryFrom<Concept> + Send,
    Atom: From<C::Atom>,
    Concept: From<C::Concept>,
{
    fn next_until(&mut self, stop: &Stop) -> Option<Step<Atom, Concept>> {
        Some(match Learner::next_until(self, stop)? {
            Step::Ask {
                question,
                round,
                hurried,
            } => Step::Ask {
                question: outward(question),
                round,
                hurried,
            },
            Step::Conflict(contradiction) => Step::Conflict(contradiction),
            Step::Done { hypothesis } => Step::Done {
                hypothesis: hypothesis.into(),
            },
        })
    }

    fn record(
        &mut self,
        answer: AnswerId,
        question: Question<Atom, Concept>,
        round: Option<Round>,
        reply: Reply<Atom>,
    ) -> Result<(), String> {
        let foreign = || "it is about another class than the task's".to_owned();
        let question = inward(question).ok_or_else(foreign)?;
        let reply = told(reply).ok_or_else(foreign)?;
        Learner::record(self, answer, question, round, reply).map_err(|error| error.to_string())
    }

    fn counts(&self) -> Counts {
        Learner::counts(self)
    }

    fn wants(&self, question: &Question<Atom, Concept>) -> bool {
        inward(question.clone()).is_some_and(|question| Learner::wants(self, &question))
    }

    fn outlook(&self) -> Option<Outlook<Concept>> {
        let outlook = Learner::outlook(self)?.clone();
        Some(Outlook {
            left: outlook.left,
            removed: outlook.removed,
            rivals: outlook.rivals.map(|rivals| rivals.map(Concept::from)),
        })
    }

    fn fork(&self) -> Box<dyn Pupil> {
        Box::new(self.clone())
    }

    fn beyond(&self, hypothesis: &Concept) -> Option<Atom> {
        let hypothesis = C::Concept::try_from(hypothesis.clone()).ok()?;
        self.class().beyond(&hypothesis).map(Atom::from)
    }

    fn draw(
        &self,
        hypothesis: &Concept,
        count: usize,
        seed: u64,
        question: u64,
    ) -> Option<(Vec<Atom>, String)> {
        let hypothesis = C::Concept::try_from(hypothesis.clone()).ok()?;
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        // The learner draws from streams that lack one of the two highest bits.
        random.set_stream(question | 0b11 << 62);
        let drawn = self.class().draw(&hypothesis, count, &mut random);
        let atoms = drawn.into_iter().map(Atom::from).collect();
        Some((atoms, self.class().drawn_from(&hypothesis)))
    }
}

fn outward<A: Into<Atom>, C: Into<Concept>>(question: Question<A, C>) -> Question<Atom, Concept> {
    match question {
        Question::Membership { atom } => Question::Membership { atom: atom.into() },
        Question::Comparison { first, second } => Question::Comparison {
            first: first.into(),
            second: second.into(),
        },
        Question::Equivalence { hypothesis } => Question::Equivalence {
            hypothesis: hypothesis.into(),
        },
    }
}

/// None if it is about another class.
fn inward<A: TryFrom<Atom>, C: TryFrom<Concept>>(
    question: Question<Atom, Concept>,
) -> Option<Question<A, C>> {
    Some(match question {
        Question::Membership { atom } => Question::Membership {
            atom: A::try_from(atom).ok()?,
        },
        Question::Comparison { first, second } => Question::Comparison {
            first: A::try_from(first).ok()?,
            second: A::try_from(second).ok()?,
        },
        Question::Equivalence { hypothesis } => Question::Equivalence {
            hypothesis: C::try_from(hypothesis).ok()?,
        },
    })
}

/// None if it is about another class.
fn told<A: TryFrom<Atom>>(reply: Reply<Atom>) -> Option<Reply<A>> {
    Some(match reply {
        Reply::Accept => Reply::Accept,
        Reply::Reject => Reply::Reject,
        Reply::Compared(comparison) => Reply::Compared(comparison),
        Reply::Correct => Reply::Correct,
        Reply::Skip => Reply::Skip,
        Reply::Counterexample { atom, label } => Reply::Counterexample {
            atom: A::try_from(atom).ok()?,
            label,
        },
    })
}
