//! What the cards of the conflict page say, and whether it can be true.

use fantoccini::Client;
use serde::Deserialize;

use crate::page::script;

/// An answer on a card.
#[derive(Clone, Debug, Deserialize)]
pub struct Card {
    /// The number of its question.
    pub number: String,
    words: Vec<String>,
    said: String,
}

const READ: &str = r#"
    return [...document.querySelectorAll("main li[data-question]")].map((card) => ({
        number: card.dataset.question,
        words: [...card.querySelectorAll("ol[data-word]")].map((word) => word.dataset.word),
        said: card.querySelector(".said strong").textContent,
    }));
"#;

/// The cards on the page.
pub async fn cards(client: &Client) -> Vec<Card> {
    serde_json::from_value(script(client, READ).await).unwrap()
}

/// Whether some preference that respects membership agrees with all these
/// answers, if the empty word is acceptable.
///
/// By the definition alone: the answers give weak and strict steps from worse to
/// better words and labels; they fail if a strict step lies on a cycle, or if an
/// accepted word leads to a rejected one.
pub fn can_be_true(cards: &[Card]) -> bool {
    let mut words: Vec<&str> = vec![""];
    words.extend(cards.iter().flat_map(|c| &c.words).map(String::as_str));
    words.sort_unstable();
    words.dedup();
    let place = |word: &str| words.iter().position(|w| *w == word).unwrap();
    let count = words.len();
    let mut reaches = vec![vec![false; count]; count];
    let mut strict = Vec::new();
    let mut labels = vec![(place(""), true)];
    for card in cards {
        let at: Vec<usize> = card.words.iter().map(|word| place(word)).collect();
        match card.said.as_str() {
            "A is better" => strict.push((at[1], at[0])),
            "B is better" => strict.push((at[0], at[1])),
            "equally good or bad" => {
                reaches[at[0]][at[1]] = true;
                reaches[at[1]][at[0]] = true;
            }
            "acceptable" | "no, this should be accepted" => labels.push((at[0], true)),
            "not acceptable" | "no, this should not be accepted" => labels.push((at[0], false)),
            other => panic!("“{other}” cannot be part of a contradiction"),
        }
    }
    for &(worse, better) in &strict {
        reaches[worse][better] = true;
    }
    for word in 0..count {
        reaches[word][word] = true;
    }
    for middle in 0..count {
        for from in 0..count {
            for to in 0..count {
                reaches[from][to] |= reaches[from][middle] && reaches[middle][to];
            }
        }
    }
    let circular = strict.iter().any(|&(worse, better)| reaches[better][worse]);
    let labelled = |wanted: bool| labels.iter().filter(move |l| l.1 == wanted).map(|l| l.0);
    let crossed = labelled(true).any(|good| labelled(false).any(|bad| reaches[good][bad]));
    !circular && !crossed
}
