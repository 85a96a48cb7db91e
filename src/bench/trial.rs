//! One scripted run: a learner asks a teacher until it has learned the concept.

use std::time::Duration;

use crate::concept::{Cause, ConceptClass, Contradiction};
use crate::evidence::AnswerId;
use crate::learner::{
    Counts, EQUIVALENCE_COST, Learner, Left, Progress, Question, Reply, ReplyError, Step,
};
use crate::oracle::Teacher;

/// A question with the reply it got, as soon as it is there.
#[derive(Debug)]
pub struct Asked<'a, A, C> {
    /// Its number, from 1.
    pub number: u32,
    /// What was asked.
    pub question: &'a Question<A, C>,
    /// What the teacher replied.
    pub reply: &'a Reply<A>,
    /// How far the check has come before this question, if it belongs to one.
    pub check: Option<&'a Progress>,
    /// What was left to be learned, where that is known.
    pub left: Option<Left>,
    /// The contradictions met since the question before.
    pub conflicts: &'a [Dropped],
}

/// Answers that contradicted each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Dropped {
    /// Which, and why.
    pub contradiction: Contradiction,
    /// Those of them that were dropped.
    pub answers: Vec<AnswerId>,
}

/// What came of a run.
#[derive(Clone, Debug)]
pub struct Report<C> {
    /// The concept the teacher agreed with; none if the questions ran out before.
    pub learned: Option<C>,
    /// How far its check has come, where one was asked for.
    pub check: Option<Progress>,
    /// All questions asked, also those whose answers were dropped later.
    pub counts: Counts,
    /// The cost of membership queries and comparisons (Eq. 5.2); a check costs
    /// nothing here.
    pub cost: f64,
    /// The same with every equivalence query as [`EQUIVALENCE_COST`] membership
    /// queries.
    pub all_in: f64,
    /// The number of answers that were dropped because they could not stand
    /// with others.
    pub dropped: u32,
    /// The contradictions met after the last question.
    pub conflicts: Vec<Dropped>,
    /// The number of questions for which the budget ended.
    pub hurried: u32,
    /// The CPU time that choosing each question took, in the order asked; what
    /// conflicts took is part of the next question's.
    pub question_times: Vec<Duration>,
    /// The CPU time of the whole run.
    pub cpu: Duration,
}

/// Why a run cannot go on.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TrialError {
    /// Without any answer, there is no concept.
    #[error(
        "no concept is consistent with what is known at the start: check it, or allow larger concepts"
    )]
    Contradiction,
    /// What is true of the target fits nothing that is considered.
    #[error(
        "{} true, and nothing of size {bound} or less fits: allow larger ones",
        these(answers)
    )]
    Bound {
        /// The largest size that is considered.
        bound: usize,
        /// The answers that need more, as in a [`Contradiction`].
        answers: Vec<AnswerId>,
    },
    /// The teacher's reply was refused.
    #[error("the teacher's reply was refused: {0}")]
    Reply(#[from] ReplyError),
}

/// Runs `learner` against `teacher` until they agree, and the check after it (if
/// one is asked for) is passed, or `max_questions` have been asked. `clock` tells CPU time, and `observe` hears of every question.
///
/// Answers that contradict each other are treated as section 5.2 of the
/// dissertation has it: the minimal set is dropped, and learning goes on.
/// Counterexamples in it stay, unless there is nothing else to drop. In a check
/// a judgement against the concept is put once more, and a third time if the two
/// differ, before it is believed.
///
/// # Errors
///
/// If the learner or the teacher was set up wrongly.
pub fn teach<C, T>(
    learner: &mut Learner<C>,
    teacher: &mut T,
    max_questions: u32,
    clock: fn() -> Duration,
    mut observe: impl FnMut(&Asked<'_, C::Atom, C::Concept>),
) -> Result<Report<C::Concept>, TrialError>
where
    C: ConceptClass,
    T: Teacher<Atom = C::Atom, Concept = C::Concept>,
{
    let start = clock();
    let mut report = Report {
        learned: None,
        check: None,
        counts: Counts::default(),
        cost: 0.0,
        all_in: 0.0,
        dropped: 0,
        conflicts: Vec::new(),
        hurried: 0,
        question_times: Vec::new(),
        cpu: Duration::ZERO,
    };
    let mut number = 0;
    let mut since = clock();
    loop {
        match learner.next() {
            Step::Done { hypothesis } => {
                report.learned = Some(hypothesis);
                report.check = learner.conformance().cloned();
                break;
            }
            Step::Conflict(conflict) => {
                if conflict.answers.is_empty() {
                    return Err(TrialError::Contradiction);
                }
                let answers = doubted(learner, conflict.answers.clone());
                let is_true = |answer| !teacher.may_err() || is_counterexample(learner, answer);
                if let Cause::States { bound } = conflict.cause
                    && conflict.answers.iter().all(|&answer| is_true(answer))
                {
                    let answers = conflict.answers;
                    return Err(TrialError::Bound { bound, answers });
                }
                for &answer in &answers {
                    report.dropped += u32::from(learner.retract(answer));
                }
                report.conflicts.push(Dropped {
                    contradiction: conflict,
                    answers,
                });
            }
            Step::Ask {
                question,
                round,
                hurried,
            } => {
                let check = learner.conformance();
                let left = learner.outlook().map(|outlook| outlook.left);
                if number == max_questions {
                    // In a check, it is the check that ends too early.
                    report.check = check.cloned();
                    report.learned = check.and(learner.hypothesis()).cloned();
                    break;
                }
                report.question_times.push(clock().saturating_sub(since));
                report.hurried += u32::from(hurried);
                let mut put = || {
                    number += 1;
                    let reply = ask(teacher, &question);
                    report.counts.add(&question, check.is_some());
                    observe(&Asked {
                        number,
                        question: &question,
                        reply: &reply,
                        check,
                        left,
                        conflicts: &std::mem::take(&mut report.conflicts),
                    });
                    (reply, number < max_questions)
                };
                let (mut reply, mut more) = put();
                if check.is_some() && refutes(learner, &question, &reply) {
                    // One slip must not overturn what the teacher agreed with:
                    // two judgements of at most three do.
                    for _ in 0..2 {
                        if !more {
                            break;
                        }
                        let first = reply;
                        (reply, more) = put();
                        if reply == first {
                            break;
                        }
                    }
                }
                learner.record(AnswerId(number), question, round, reply)?;
                since = clock();
            }
        }
    }
    report.cost = cost(learner, report.counts);
    let equivalence = EQUIVALENCE_COST * learner.config().membership_cost;
    report.all_in = report.cost + equivalence * f64::from(report.counts.equivalence);
    report.cpu = clock().saturating_sub(start);
    Ok(report)
}

/// Those of the answers that are dropped: all but the counterexamples, and these
/// only if there is nothing else to drop. Who shows a counterexample has looked
/// at the hypothesis, and to drop it would bring the same hypothesis again.
fn doubted<C: ConceptClass>(learner: &Learner<C>, answers: Vec<AnswerId>) -> Vec<AnswerId> {
    let (counterexamples, doubted): (Vec<_>, Vec<_>) = answers
        .into_iter()
        .partition(|&answer| is_counterexample(learner, answer));
    if doubted.is_empty() {
        counterexamples
    } else {
        doubted
    }
}

/// Whether the answer is a counterexample.
fn is_counterexample<C: ConceptClass>(learner: &Learner<C>, answer: AnswerId) -> bool {
    learner.entries().iter().any(|entry| {
        entry.answer == answer && matches!(entry.question, Question::Equivalence { .. })
    })
}

/// Answers as the subject of a sentence, with its verb.
fn these(answers: &[AnswerId]) -> String {
    let numbers: Vec<String> = answers.iter().map(|answer| answer.0.to_string()).collect();
    match &numbers[..] {
        [] => "what is known at the start is".to_owned(),
        [one] => format!("answer {one} is"),
        [most @ .., last] => format!("answers {} and {last} are", most.join(", ")),
    }
}

/// Whether this judgement is none that the hypothesis gives.
fn refutes<C: ConceptClass>(
    learner: &Learner<C>,
    question: &Question<C::Atom, C::Concept>,
    reply: &Reply<C::Atom>,
) -> bool {
    let (Question::Membership { atom }, Some(hypothesis)) = (question, learner.hypothesis()) else {
        return false;
    };
    let contained = learner.class().contains(hypothesis, atom);
    matches!(
        (reply, contained),
        (Reply::Accept, false) | (Reply::Reject, true)
    )
}

/// Eq. 5.2. No comparisons cost nothing, also where one would be infinite.
fn cost<C: ConceptClass>(learner: &Learner<C>, counts: Counts) -> f64 {
    let config = learner.config();
    let of = |count: u32, cost: f64| {
        if count == 0 {
            0.0
        } else {
            f64::from(count) * cost
        }
    };
    of(counts.membership, config.membership_cost) + of(counts.comparison, config.comparison_cost)
}

fn ask<T: Teacher>(teacher: &mut T, question: &Question<T::Atom, T::Concept>) -> Reply<T::Atom> {
    match question {
        Question::Membership { atom } => {
            if teacher.membership(atom) {
                Reply::Accept
            } else {
                Reply::Reject
            }
        }
        Question::Comparison { first, second } => {
            Reply::Compared(teacher.comparison(first, second))
        }
        Question::Equivalence { hypothesis } => match teacher.counterexample(hypothesis) {
            Some((atom, label)) => Reply::Counterexample { atom, label },
            None => Reply::Correct,
        },
    }
}

/// The smallest of the times that at least `percent` in a hundred of them do
/// not exceed (the nearest rank); zero for none.
pub fn percentile(times: &[Duration], percent: usize) -> Duration {
    let mut sorted = times.to_vec();
    sorted.sort_unstable();
    let rank = (sorted.len() * percent).div_ceil(100);
    sorted
        .get(rank.saturating_sub(1))
        .copied()
        .unwrap_or_default()
}
