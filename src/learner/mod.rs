//! Which question to ask next: Algorithms 4, 5 and 6 of chapter 5, whatever the
//! concept class.
//!
//! A [`Learner`] is a fold over answered questions. It is pure: what it asks
//! next depends on its [`Config`] and on the answers that stand, and on nothing
//! else. It must not know async, clocks, files, SQL or HTML.

mod bayes;
mod choose;
mod config;
mod conformance;
mod dialogue;
mod exp4;
mod experts;
mod known;
mod outlook;
mod selection;

use std::hash::Hash;

pub use self::bayes::{Doubt, Doubts};
pub use self::config::{Config, EQUIVALENCE_COST, Strategy};
use self::conformance::Check;
pub use self::conformance::{BATCH, Claim, Conformance, ConformanceError, Progress};
pub use self::dialogue::{Counts, Entry, Question, Reply, ReplyError, Step};
use self::experts::Bandit;
pub use self::experts::{Losses, PosteriorAdvice, Round};
use self::known::Known;
pub use self::outlook::{Answer, Expected, Left, Outlook, Removed};
use crate::concept::ConceptClass;
use crate::evidence::{AnswerId, Fact, Stop};

/// The learner: evidence in, question out.
#[derive(Clone)]
pub struct Learner<C: ConceptClass> {
    class: C,
    config: Config,
    /// What is known from the start.
    given: Vec<Fact<C::Atom>>,
    /// The answers that stand, in the order in which they were recorded.
    entries: Vec<Entry<C::Atom, C::Concept>>,
    /// Folded from `given` and `entries`.
    evidence: Known<C::Atom>,
    /// Folded from `entries`.
    bandit: Bandit,
    /// The move that follows from all this, once it was asked for.
    next: Option<Step<C::Atom, C::Concept>>,
    simplest: Option<C::Concept>,
    /// What seems wrong, where answers may be.
    doubts: Option<Doubts>,
    /// What was left when the last question was put.
    outlook: Option<Outlook<C::Concept>>,
    check: Option<Check<C::Atom>>,
    /// Whether the last step was made by the check.
    checking: bool,
}

impl<C: ConceptClass> Learner<C> {
    /// A learner that knows `known` from the start.
    pub fn new(mut class: C, config: Config, known: Vec<Fact<C::Atom>>) -> Self {
        for fact in &known {
            class.add(None, fact.clone());
        }
        let mut learner = Self {
            class,
            bandit: Bandit::new(config.strategy),
            config,
            given: known,
            entries: Vec::new(),
            evidence: Known::default(),
            next: None,
            simplest: None,
            doubts: None,
            outlook: None,
            check: None,
            checking: false,
        };
        learner.fold();
        learner
    }

    /// Folds in an answered question. `answer` is a number not used before.
    ///
    /// # Errors
    ///
    /// If the reply does not fit the question; nothing has changed then.
    pub fn record(
        &mut self,
        answer: AnswerId,
        question: Question<C::Atom, C::Concept>,
        round: Option<Round>,
        reply: Reply<C::Atom>,
    ) -> Result<(), ReplyError> {
        self.check(answer, &question, &reply)?;
        let entry = Entry {
            answer,
            question,
            round,
            reply,
        };
        if let Some(fact) = self.certain(&entry) {
            self.class.add(Some(answer), fact);
        }
        for fact in self.promised(&entry) {
            self.evidence.add(Some(answer), &fact);
            self.class.add(Some(answer), fact);
        }
        let doubting = self.doubts_answers();
        absorb(&mut self.evidence, &mut self.bandit, &entry, doubting);
        self.entries.push(entry);
        self.next = None;
        self.simplest = None;
        self.checking = false;
        Ok(())
    }

    /// Takes an answer back, as if its question had never been asked; `false`
    /// if no such answer stands.
    pub fn retract(&mut self, answer: AnswerId) -> bool {
        let before = self.entries.len();
        self.entries.retain(|entry| entry.answer != answer);
        if self.entries.len() == before {
            return false;
        }
        self.class.retract(answer);
        self.fold();
        true
    }

    /// The next move: a function of the configuration and the answers that
    /// stand (in the order in which they were recorded).
    #[expect(
        clippy::should_implement_trait,
        reason = "it is no iterator: the same move comes until it is answered"
    )]
    pub fn next(&mut self) -> Step<C::Atom, C::Concept> {
        self.seek(&Stop::default())
    }

    /// The same; none, and soon, once `stop` is set. Even where the budget ends the
    /// search, nothing shows of what was thought before.
    pub fn next_until(&mut self, stop: &Stop) -> Option<Step<C::Atom, C::Concept>> {
        if self.next.is_none() {
            self.class.forget();
        }
        let step = self.seek(stop);
        if stop.is_set() {
            // It may be a guess, and so may all that came with it.
            self.fold();
            return None;
        }
        Some(step)
    }

    fn seek(&mut self, stop: &Stop) -> Step<C::Atom, C::Concept> {
        if let Some(step) = &self.next {
            return step.clone();
        }
        self.doubts = None;
        self.outlook = None;
        self.checking = false;
        let (step, simplest) = self.choose(stop);
        self.next = Some(step.clone());
        self.simplest = simplest;
        step
    }

    /// The standing answers, by kind. Skipped questions are not answered.
    pub fn counts(&self) -> Counts {
        let mut counts = Counts::default();
        for (entry, checks) in self.checks() {
            if entry.reply != Reply::Skip {
                counts.add(&entry.question, checks);
            }
        }
        counts
    }

    /// The answers that stand, in the order in which they were recorded.
    pub fn entries(&self) -> &[Entry<C::Atom, C::Concept>] {
        &self.entries
    }

    /// The simplest concept of the smallest consistent size that the last
    /// [`Self::next`] met; none before it, after a change, and where the budget
    /// ended before any was found.
    pub fn hypothesis(&self) -> Option<&C::Concept> {
        self.simplest.as_ref()
    }

    /// How often the answers that stand seem to be wrong, and which of them, as
    /// of the last [`Self::next`]; none where answers count as facts.
    pub fn doubts(&self) -> Option<&Doubts> {
        self.doubts.as_ref()
    }

    /// Whether the answer to a question that was put some time ago may still teach
    /// something. Equivalence queries are put anew after every answer.
    pub fn wants(&self, question: &Question<C::Atom, C::Concept>) -> bool {
        match question {
            Question::Membership { atom } => self.evidence.may_judge(atom),
            Question::Comparison { first, second } => self.evidence.may_compare(first, second),
            Question::Equivalence { .. } => false,
        }
    }

    /// What was left, and what the answers would tell, when the last
    /// [`Self::next`] put its question; none where it put none, and where its
    /// budget ended before the concepts were known.
    pub fn outlook(&self) -> Option<&Outlook<C::Concept>> {
        self.outlook.as_ref()
    }

    /// What can be learned.
    pub fn class(&self) -> &C {
        &self.class
    }

    /// What the learner was told at its start.
    pub fn config(&self) -> &Config {
        &self.config
    }

    /// Whether the reply may be given to the question.
    fn check(
        &self,
        answer: AnswerId,
        question: &Question<C::Atom, C::Concept>,
        reply: &Reply<C::Atom>,
    ) -> Result<(), ReplyError> {
        if self.entries.iter().any(|entry| entry.answer == answer) {
            return Err(ReplyError::UsedNumber(answer.0));
        }
        let (question, expected) = match (question, reply) {
            (Question::Membership { .. }, Reply::Accept | Reply::Reject | Reply::Skip)
            | (Question::Comparison { .. }, Reply::Compared(_) | Reply::Skip)
            | (Question::Equivalence { .. }, Reply::Correct) => return Ok(()),
            (Question::Equivalence { hypothesis }, Reply::Counterexample { atom, label }) => {
                return if self.class.contains(hypothesis, atom) == *label {
                    Err(ReplyError::NoCounterexample)
                } else {
                    Ok(())
                };
            }
            (Question::Membership { .. }, _) => ("membership", "accept, reject or skip"),
            (Question::Comparison { .. }, _) => {
                ("comparison", "first, second, equal, incomparable or skip")
            }
            (Question::Equivalence { .. }, _) => ("equivalence", "correct or a counterexample"),
        };
        Err(ReplyError::WrongKind { question, expected })
    }

    /// Folds all entries anew.
    fn fold(&mut self) {
        let doubting = self.doubts_answers();
        self.evidence = Known::default();
        self.bandit = Bandit::new(self.config.strategy);
        for fact in &self.given {
            self.evidence.add(None, fact);
        }
        for entry in &self.entries {
            for fact in self.promised(entry) {
                self.evidence.add(Some(entry.answer), &fact);
            }
            absorb(&mut self.evidence, &mut self.bandit, entry, doubting);
        }
        self.next = None;
        self.simplest = None;
        self.check = None;
        self.checking = false;
    }

    /// What a counterexample says beyond itself, if the teacher promised that no
    /// simpler atom would have been one.
    fn promised(&self, entry: &Entry<C::Atom, C::Concept>) -> Vec<Fact<C::Atom>> {
        match (&entry.question, &entry.reply) {
            (Question::Equivalence { hypothesis }, Reply::Counterexample { atom, .. })
                if self.config.shortest_counterexamples =>
            {
                let simpler = self.class.simpler(atom).into_iter();
                let label = |atom| Fact::Label {
                    accepted: self.class.contains(hypothesis, &atom),
                    atom,
                };
                simpler.map(label).collect()
            }
            _ => Vec::new(),
        }
    }

    /// The concept that the teacher agreed with last, unless later answers
    /// speak against it.
    fn agreed(&self) -> Option<C::Concept> {
        let hypothesis =
            self.entries
                .iter()
                .rev()
                .find_map(|entry| match (&entry.question, &entry.reply) {
                    (Question::Equivalence { hypothesis }, Reply::Correct) => Some(hypothesis),
                    _ => None,
                })?;
        let answers = self.entries.iter().filter_map(|entry| self.certain(entry));
        let mut facts = self.given.iter().cloned().chain(answers);
        let stands = facts.all(|fact| fact.holds(|atom| self.class.contains(hypothesis, atom)));
        stands.then(|| hypothesis.clone())
    }
}

/// Folds one entry into what is known and into the bandit. Answers that are
/// doubted are known to have been given, no more.
fn absorb<A: Clone + Ord + Hash, C>(
    evidence: &mut Known<A>,
    bandit: &mut Bandit,
    entry: &Entry<A, C>,
    doubting: bool,
) {
    if doubting && entry.is_doubtful() {
        evidence.ask(&entry.question);
    } else if let Some(fact) = entry.fact() {
        evidence.add(Some(entry.answer), &fact);
    }
    if entry.reply == Reply::Skip {
        match &entry.question {
            Question::Membership { atom } => evidence.skip(atom.clone()),
            Question::Comparison { first, second } => {
                evidence.skip_pair(first.clone(), second.clone());
            }
            Question::Equivalence { .. } => {}
        }
    }
    if let Some(round) = &entry.round {
        bandit.learn(round, &entry.reply);
    }
}
