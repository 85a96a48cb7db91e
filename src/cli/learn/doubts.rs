//! What `memrep learn --robust` tells of answers that seem wrong.

use crate::cli::output;
use crate::learner::Doubts;

/// So many answers are named as doubtful.
const SHOWN: usize = 8;

/// The answers that are rather wrong than right, the most doubtful first.
pub(super) fn doubted(doubts: &Doubts) -> impl Iterator<Item = u32> {
    let likely = doubts.answers.iter().filter(|doubt| doubt.chance > 0.5);
    likely.map(|doubt| doubt.answer.0)
}

/// Tells people.
pub(super) fn tell(doubts: &Doubts) -> anyhow::Result<()> {
    let answers: Vec<String> = (doubted(doubts).take(SHOWN))
        .map(|number| number.to_string())
        .collect();
    let which = match answers.len() {
        0 => "no answer".to_owned(),
        1 => format!("answer {}", answers[0]),
        _ => format!("answers {}", answers.join(", ")),
    };
    let percent = (doubts.error_rate * 100.0).round();
    output::line(format!(
        "doubted: {which} (about {percent} % of all are expected to be wrong)"
    ))
}
