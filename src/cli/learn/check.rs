//! `--conformance`: how its two numbers are read, and what the check allows to
//! say.

use serde::Serialize;

use crate::bench::Asked;
use crate::cli::output::{self, Output};
use crate::learner::{BATCH, Conformance, Progress};

/// Reads `EPS,DELTA`.
pub(super) fn read(text: &str) -> Result<Conformance, String> {
    let number = |text: &str| text.trim().parse::<f64>().ok();
    let shares = text.split_once(',');
    let Some((epsilon, delta)) =
        shares.and_then(|(epsilon, delta)| Some((number(epsilon)?, number(delta)?)))
    else {
        return Err("give two numbers between 0 and 1, as in `0.05,0.05`".to_owned());
    };
    Conformance::new(epsilon, delta).map_err(|error| error.to_string())
}

/// What came of the check.
#[derive(Serialize)]
pub(super) struct Checked {
    epsilon: f64,
    delta: f64,
    /// The number of the check, from 1.
    round: u32,
    needed: u32,
    /// The draws about which the concept is right; their labels were asked for
    /// or known.
    judged: u32,
    /// The judgements that were asked for, in all checks.
    asked: u32,
    skipped: u32,
    complete: bool,
    /// The share of errors that may be claimed now.
    share: Option<f64>,
    claim: Option<String>,
}

impl Checked {
    pub(super) fn of(check: &Progress, asked: u32) -> Self {
        let claim = check.claim();
        Self {
            epsilon: check.conformance.epsilon(),
            delta: check.conformance.delta(),
            round: check.round,
            needed: check.needed,
            judged: check.judged,
            asked,
            skipped: check.skipped,
            complete: check.is_complete(),
            share: claim.map(|claim| claim.share),
            claim: claim.map(|claim| claim.to_string()),
        }
    }
}

/// What the check allows to say.
pub(super) fn tell(check: &Progress, max_questions: u32, atoms: &str) -> anyhow::Result<()> {
    match check.claim() {
        Some(claim) => output::line(format!("checked: {claim}"))?,
        None => output::line("checked: too little for a claim")?,
    }
    if check.is_complete() {
        return Ok(());
    }
    output::line(format!(
        "the check has come to {} of {} random {atoms} within {}; allow more by `--max-questions`",
        check.judged,
        check.needed,
        output::counted(max_questions, "question", "questions")
    ))
}

/// Tells people what may be claimed once a batch of the check is judged.
pub(super) fn batch<A, C>(
    format: Output,
    asked: &Asked<'_, A, C>,
    atoms: &str,
    told: &mut (u32, u32),
) -> anyhow::Result<()> {
    let Some(check) = asked.check.filter(|_| format == Output::Text) else {
        return Ok(());
    };
    let at = (check.round, check.judged / BATCH);
    if at <= *told {
        return Ok(());
    }
    *told = at;
    let Some(claim) = check.claim() else {
        return Ok(());
    };
    output::line(format!(
        "   {} of {} random {atoms} judged: {claim}",
        check.judged, check.needed
    ))
}
