//! Knowing when to stop: how many random atoms must be judged after the last
//! agreement, and what may then be claimed.
//!
//! A concept that is wrong about more than a share `ε` of the atoms, as they are
//! drawn, is right about `n` independent draws with probability at most
//! `(1 − ε)ⁿ` (Angluin's sampling oracle, Learning regular sets from queries and
//! counterexamples, 1987). So after `n ≥ ln(1/δ) / −ln(1 − ε)` draws about which
//! it is right, "wrong about at most a share `ε`" is false with probability at
//! most `δ`. What keeps that true here:
//!
//! - Draws must not depend on how the concept was found: every check draws from
//!   a stream of the seed that is used for nothing else. Draws whose labels are
//!   known already count as judged: a label is as good from before.
//! - One may stop after any number of draws and claim what that number gives.
//!   A concept wrong about a share `p` makes the claims after `k` draws false
//!   from some `k` on, and to get there it must be right about `k` draws; so no
//!   further share of `δ` is needed.
//! - A judgement against the concept is a counterexample; learning goes on and
//!   the next concept agreed on is checked anew. The `i`-th check has the share
//!   `δ / (i (i + 1))`, and these sum to `δ` (the union bound), so that the claim
//!   holds for whichever concept passes.
//! - Draws that the teacher skips are passed over; the claim is then about the
//!   atoms that the teacher can judge.
//! - The claim takes judgements for true. Where one may be wrong, a concept that
//!   is right can fail: once the wrong judgement is retracted and the agreement
//!   stands again, the same check goes on where it was.

use std::collections::VecDeque;
use std::fmt;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::{Entry, Learner, Question, Reply};
use crate::concept::ConceptClass;
use crate::evidence::AnswerId;

/// After so many draws the claim that holds already is told.
pub const BATCH: u32 = 10;

/// The most judgements that a first check may need: more than anybody gives.
const MOST: f64 = 100_000.0;

/// A check ends without its claim once it has drawn so many times more atoms
/// than it needs, because most of them are skipped.
const PATIENCE: u32 = 10;

/// What is to be claimed at the end: "wrong about at most a share `epsilon` of
/// all atoms, with confidence `1 − delta`".
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Claimed")]
pub struct Conformance {
    epsilon: f64,
    delta: f64,
}

/// A [`Conformance`] as it is written.
#[derive(Deserialize)]
struct Claimed {
    epsilon: f64,
    delta: f64,
}

impl TryFrom<Claimed> for Conformance {
    type Error = ConformanceError;

    fn try_from(claimed: Claimed) -> Result<Self, ConformanceError> {
        Self::new(claimed.epsilon, claimed.delta)
    }
}

/// Why nothing of the kind can be claimed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ConformanceError {
    /// The share of wrong atoms is no share, or all or none.
    #[error("the share of errors must be between 0 and 1, such as 0.05: it is {0}")]
    Epsilon(f64),
    /// The risk is no probability, or impossible or certain.
    #[error("the risk must be between 0 and 1, such as 0.05 for 95 % confidence: it is {0}")]
    Delta(f64),
    /// Nobody judges so many atoms.
    #[error(
        "this takes {needed:.0} judgements, and at most {MOST} are asked for: allow a larger share of errors"
    )]
    TooMany {
        /// How many it would be.
        needed: f64,
    },
}

impl Conformance {
    /// A claim of at most a share `epsilon` of errors with confidence
    /// `1 − delta`.
    ///
    /// # Errors
    ///
    /// If one of them is not between 0 and 1, both excluded, or more judgements
    /// are needed than anybody gives.
    pub fn new(epsilon: f64, delta: f64) -> Result<Self, ConformanceError> {
        let is_share = |share: f64| share > 0.0 && share < 1.0;
        if !is_share(epsilon) {
            return Err(ConformanceError::Epsilon(epsilon));
        }
        if !is_share(delta) {
            return Err(ConformanceError::Delta(delta));
        }
        let conformance = Self { epsilon, delta };
        let needed = conformance.draws(1);
        if needed > MOST {
            return Err(ConformanceError::TooMany { needed });
        }
        Ok(conformance)
    }

    /// The share of errors `ε` to be claimed.
    pub fn epsilon(&self) -> f64 {
        self.epsilon
    }

    /// The risk `δ` that the claim is false, over all checks together.
    pub fn delta(&self) -> f64 {
        self.delta
    }

    /// How many draws the concept must be right about in the check of this
    /// number, from 1.
    #[expect(
        clippy::cast_sign_loss,
        reason = "at least 1; and far below 2³², as the first is small and later ones grow by a logarithm"
    )]
    pub fn needed(&self, round: u32) -> u32 {
        self.draws(round) as u32
    }

    fn draws(&self, round: u32) -> f64 {
        (self.log_risk(round) / f64::ln_1p(-self.epsilon))
            .ceil()
            .max(1.0)
    }

    /// The logarithm of this check's share of the risk.
    fn log_risk(&self, round: u32) -> f64 {
        let round = f64::from(round.max(1));
        self.delta.ln() - (round * (round + 1.0)).ln()
    }
}

/// How far a check has come.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// What is to be claimed.
    pub conformance: Conformance,
    /// The number of the check, from 1: one more than there were concepts that
    /// the teacher agreed with before this one.
    pub round: u32,
    /// The draws about which the concept must be right.
    pub needed: u32,
    /// Those about which it is, in the order of drawing; labels known before
    /// they were drawn are among them.
    pub judged: u32,
    /// The draws that were passed over because the teacher skipped them.
    pub skipped: u32,
    /// What is drawn from: a phrase for people.
    pub atoms: String,
}

impl Progress {
    /// Whether all that was to be claimed may be.
    pub fn is_complete(&self) -> bool {
        self.judged >= self.needed
    }

    /// The batch that is being judged, from 1, and how many there are.
    pub fn batch(&self) -> (u32, u32) {
        let batches = self.needed.div_ceil(BATCH);
        ((self.judged / BATCH + 1).min(batches), batches)
    }

    /// What may be claimed after the batches judged so far; nothing before the
    /// first.
    pub fn claim(&self) -> Option<Claim<'_>> {
        let judged = if self.is_complete() {
            self.judged
        } else {
            self.judged / BATCH * BATCH
        };
        let log_risk = self.conformance.log_risk(self.round);
        (judged > 0).then(|| Claim {
            progress: self,
            judged,
            share: -f64::exp_m1(log_risk / f64::from(judged)),
        })
    }
}

/// What may be claimed about the concept; its text is the whole sentence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Claim<'a> {
    progress: &'a Progress,
    /// The draws that it rests on.
    pub judged: u32,
    /// The largest share of errors.
    pub share: f64,
}

impl fmt::Display for Claim<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Progress {
            conformance,
            skipped,
            atoms,
            ..
        } = self.progress;
        // Rounded so that less is claimed, never more.
        let places = if self.share < 0.01 { 1e5 } else { 1e3 };
        let share = (self.share * places - 1e-6).ceil() / (places / 100.0);
        let confidence = ((1.0 - conformance.delta) * 1e6 + 1e-3).floor() / 1e4;
        let judged = self.judged;
        write!(
            f,
            "wrong about at most {share} % of random behaviours, with {confidence} % confidence, \
             if no answer is wrong: it was right about all {judged} that were drawn ({atoms})"
        )?;
        match skipped {
            0 => Ok(()),
            1 => write!(f, ", of those that can be judged: 1 was skipped"),
            _ => write!(f, ", of those that can be judged: {skipped} were skipped"),
        }
    }
}

/// A check on its way.
#[derive(Clone)]
pub(super) struct Check<A> {
    /// The first agreement with the concept.
    opened: AnswerId,
    progress: Progress,
    /// Draws that were not looked at yet; the first is the one to be judged.
    drawn: VecDeque<A>,
    random: ChaCha8Rng,
}

impl<C: ConceptClass> Learner<C> {
    /// How far the check of the concept agreed on has come, as the last
    /// [`Self::next`] found it; none while something is still to be learned, and
    /// where nothing is to be claimed.
    pub fn conformance(&self) -> Option<&Progress> {
        let check = self.check.as_ref()?;
        self.checking.then_some(&check.progress)
    }

    /// The next atom to be judged before the hypothesis, with which the teacher
    /// agreed, is believed; none once enough were.
    pub(super) fn unjudged(&mut self, hypothesis: &C::Concept) -> Option<C::Atom> {
        let conformance = self.config.conformance?;
        let (opened, round) = self.opening(hypothesis)?;
        let mut check = match self.check.take() {
            Some(check) if check.opened == opened => check,
            _ => self.open(conformance, opened, round, hypothesis),
        };
        let mut found = None;
        let progress = &mut check.progress;
        while progress.judged < progress.needed
            && progress.skipped / PATIENCE < progress.needed.max(BATCH)
        {
            let Some(atom) = check.drawn.front() else {
                let batch = self
                    .class
                    .draw(hypothesis, BATCH as usize, &mut check.random);
                check.drawn.extend(batch);
                if check.drawn.is_empty() {
                    break;
                }
                continue;
            };
            if self.evidence.order.label(atom).is_some() {
                progress.judged += 1;
            } else if self.evidence.may_judge(atom) {
                found = Some(atom.clone());
                break;
            } else {
                progress.skipped += 1;
            }
            check.drawn.pop_front();
        }
        self.check = Some(check);
        self.checking = true;
        found
    }

    fn open(
        &self,
        conformance: Conformance,
        opened: AnswerId,
        round: u32,
        hypothesis: &C::Concept,
    ) -> Check<C::Atom> {
        // A number is given to one answer only, so no other check, also none
        // that was retracted, had these draws. Questions are chosen from the
        // streams without the highest bit.
        let mut random = ChaCha8Rng::seed_from_u64(self.config.seed);
        random.set_stream(u64::from(opened.0) | 1 << 63);
        Check {
            opened,
            progress: Progress {
                conformance,
                round,
                needed: conformance.needed(round),
                judged: 0,
                skipped: 0,
                atoms: self.class.drawn_from(hypothesis),
            },
            drawn: VecDeque::new(),
            random,
        }
    }

    /// The first agreement with this hypothesis, and how many different ones had
    /// been agreed on by then.
    fn opening(&self, hypothesis: &C::Concept) -> Option<(AnswerId, u32)> {
        let mut seen: Vec<&C::Concept> = Vec::new();
        for entry in &self.entries {
            if let (Question::Equivalence { hypothesis: agreed }, Reply::Correct) =
                (&entry.question, &entry.reply)
                && !seen.contains(&agreed)
            {
                seen.push(agreed);
                if agreed == hypothesis {
                    return Some((entry.answer, seen.len() as u32));
                }
            }
        }
        None
    }

    /// For every standing answer whether it judges an atom for a check: it came
    /// after an agreement that still stood.
    pub(super) fn checks(&self) -> impl Iterator<Item = (&Entry<C::Atom, C::Concept>, bool)> {
        let mut agreed: Option<&C::Concept> = None;
        self.entries.iter().map(move |entry| {
            let membership = matches!(entry.question, Question::Membership { .. });
            let checks = self.config.conformance.is_some() && membership && agreed.is_some();
            if let (Question::Equivalence { hypothesis }, Reply::Correct) =
                (&entry.question, &entry.reply)
            {
                agreed = Some(hypothesis);
            } else if let Some(fact) = entry.fact() {
                agreed =
                    agreed.filter(|concept| fact.holds(|atom| self.class.contains(concept, atom)));
            }
            (entry, checks)
        })
    }
}
