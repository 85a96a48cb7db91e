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
        0 => String::new(),
        1 => format!(": number {}", answers[0]),
        _ => format!(": most of all numbers {}", answers.join(", ")),
    };
    let percent = (doubts.error_rate * 100.0).round();
    output::line(format!(
        "doubted: about {percent} % of the answers seem wrong{which}"
    ))
}
