//! The sheet of sample behaviours beside a rule on show, and what may be claimed
//! once a person has looked at all of them.
//!
//! The claim is that of [`Conformance`](crate::learner::Conformance), for a number
//! of draws that is fixed beforehand. Every rule that is shown gets a sheet of its
//! own, drawn after the rule was found from a stream of the seed that is used for
//! nothing else; a person who finds fault with one is shown another rule with
//! another sheet. The `i`-th sheet has the share `δ / (i (i + 1))` of the risk, so
//! that the claim is false with probability at most `δ` whichever sheet passes.

use super::{Decision, Event, Position, Refusal, ReplyText, Session};
use crate::learner::{Question, Reply};
use crate::task::{Atom, Concept};

/// The behaviours on a sheet, unless the class has none.
pub const SHEET: usize = 12;

/// The risk that a claim is false.
pub const RISK: f64 = 0.05;

/// Behaviours drawn to check a rule by.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    /// Independent draws, in the order of drawing; some may be the same.
    pub atoms: Vec<Atom>,
    /// What they are drawn from: a phrase.
    pub drawn_from: String,
    /// How many rules had been shown by then, this one included.
    pub sheet: u32,
}

/// What may be claimed of the rule agreed on.
#[derive(Clone, Debug, PartialEq)]
pub struct Claim {
    /// The behaviours that were looked at.
    pub looked: u32,
    /// What they were drawn from.
    pub drawn_from: String,
    /// The largest share of behaviours treated wrongly.
    pub share: f64,
}

impl Samples {
    /// What may be claimed once the rule is right about all of them.
    ///
    /// It is none where there is nothing to look at.
    pub fn claim(&self) -> Option<Claim> {
        let looked = self.atoms.len() as u32;
        (looked > 0).then(|| Claim {
            looked,
            drawn_from: self.drawn_from.clone(),
            share: share(looked, self.sheet),
        })
    }
}

impl Claim {
    /// The share in percent, rounded so that less is claimed, never more.
    pub fn percent(&self) -> u32 {
        #[expect(clippy::cast_sign_loss, reason = "a share is from 0 to 1")]
        let percent = (self.share * 100.0 - 1e-9).ceil() as u32;
        percent
    }
}

/// The largest share of errors with which one is right about so many independent
/// draws with a probability above this sheet's share of the risk.
fn share(looked: u32, sheet: u32) -> f64 {
    let sheet = f64::from(sheet.max(1));
    let log_risk = RISK.ln() - (sheet * (sheet + 1.0)).ln();
    -f64::exp_m1(log_risk / f64::from(looked))
}

impl Session {
    /// The sheet of the rule that the question of this number shows; none if it
    /// shows none. The same each time.
    pub fn samples(&self, number: u32) -> Option<Samples> {
        let Question::Equivalence { hypothesis } = &self.asked(number)?.question else {
            return None;
        };
        let shown = self.asked.range(..=number);
        let sheet = shown
            .filter(|(_, asked)| matches!(asked.question, Question::Equivalence { .. }))
            .count() as u32;
        let (atoms, drawn_from) =
            (self.learner).draw(hypothesis, SHEET, self.setup.seed, u64::from(number))?;
        Some(Samples {
            atoms,
            drawn_from,
            sheet,
        })
    }

    /// The rule that was on show before the one of this question.
    pub fn shown_before(&self, number: u32) -> Option<&Concept> {
        let mut shown = self.asked.range(..number).rev();
        shown.find_map(|(_, asked)| match &asked.question {
            Question::Equivalence { hypothesis } => Some(hypothesis),
            _ => None,
        })
    }

    /// Somebody agrees with the rule of this question, having looked at so many
    /// behaviours of its sheet: all of them, or nothing is said of it.
    ///
    /// # Errors
    ///
    /// If the question is not open or shows no rule, or its sheet has another
    /// number of behaviours.
    pub fn agree(&self, number: u32, looked: Option<u32>) -> Result<Decision, Refusal> {
        let mut decision = self.answer(number, &Reply::Correct)?;
        let Some(given) = looked else {
            return Ok(decision);
        };
        if let Decision::Append(Event::Answered {
            reply: ReplyText::Correct { looked },
            ..
        }) = &mut decision
        {
            let drawn = self.samples(number).map_or(0, |s| s.atoms.len() as u32);
            if given != drawn {
                return Err(Refusal::Looked { drawn });
            }
            *looked = Some(given);
        }
        Ok(decision)
    }

    /// What may be claimed of the rule agreed on: something only if the person has
    /// looked at its whole sheet.
    pub fn claim(&self) -> Option<Claim> {
        let Position::Done(_) = self.position() else {
            return None;
        };
        let agreed = (self.standing().iter().rev()).find(|s| s.reply == Reply::Correct)?;
        agreed.looked?;
        self.samples(agreed.number)?.claim()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_claim_is_what_the_draws_bear_out() {
        for (looked, sheet) in [(1, 1), (12, 1), (12, 2), (100, 5)] {
            let share = share(looked, sheet);
            let risk = (1.0 - share).powf(f64::from(looked));
            let allowed = RISK / f64::from(sheet * (sheet + 1));
            assert!((risk - allowed).abs() < 1e-12, "{looked} {sheet}");
        }
        let claim = |share| Claim {
            looked: 12,
            drawn_from: String::new(),
            share,
        };
        assert_eq!(claim(0.2646).percent(), 27);
        assert_eq!(claim(0.27).percent(), 27);
    }
}
