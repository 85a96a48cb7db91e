//! Labelled words and preferences, one JSON object a line.
//!
//! ```json
//! {"word":["a","b"],"label":true}
//! {"word":["b"],"label":null}
//! {"worse":["a"],"better":["b"]}
//! {"equal":[["a"],["b"]]}
//! ```
//!
//! A `label` is `true`, `false`, or `null` where it is unknown. The alphabet has
//! the symbols in the order in which they appear. Where that is not the whole
//! alphabet in its order, the first line says so: `{"alphabet":["b","a"]}`.

mod reader;

use serde::{Deserialize, Deserializer, Serialize};

use crate::Word;
use crate::sample::{Item, Sample};

pub use reader::{read, read_over};

/// One line as it stands: some of these keys, of which the reader knows which
/// go together.
#[derive(Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Line {
    #[serde(skip_serializing_if = "Option::is_none")]
    alphabet: Option<Vec<String>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    word: Option<Vec<String>>,
    #[serde(
        skip_serializing_if = "Option::is_none",
        deserialize_with = "Label::present"
    )]
    label: Option<Label>,
    #[serde(skip_serializing_if = "Option::is_none")]
    worse: Option<Vec<String>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    better: Option<Vec<String>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    equal: Option<Vec<Vec<String>>>,
}

/// The value of the key `label`; `None` for `null`.
#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(transparent)]
struct Label(Option<bool>);

impl Label {
    /// Keeps a `null` that is there apart from a key that is not.
    fn present<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Self>, D::Error> {
        Self::deserialize(deserializer).map(Some)
    }
}

/// Writes a sample, and its alphabet before it where the words do not show it.
#[expect(clippy::missing_panics_doc, reason = "strings can always be written")]
pub fn write(sample: &Sample) -> String {
    let alphabet = sample.alphabet();
    let spell = |word: &Word| Some(alphabet.spell(word).map(str::to_owned).collect());
    let mut text = String::new();
    let mut write = |line: &Line| {
        text.push_str(&serde_json::to_string(line).expect("strings can always be written"));
        text.push('\n');
    };
    if !shows_alphabet(sample) {
        write(&Line {
            alphabet: Some(alphabet.names().map(str::to_owned).collect()),
            ..Line::default()
        });
    }
    for item in sample.items() {
        write(&match item {
            Item::Label { word, accepted } => Line {
                word: spell(word),
                label: Some(Label(Some(*accepted))),
                ..Line::default()
            },
            Item::Unknown { word } => Line {
                word: spell(word),
                label: Some(Label(None)),
                ..Line::default()
            },
            Item::Below { worse, better } => Line {
                worse: spell(worse),
                better: spell(better),
                ..Line::default()
            },
            Item::Equal { first, second } => Line {
                equal: [spell(first), spell(second)].into_iter().collect(),
                ..Line::default()
            },
        });
    }
    text
}

/// Whether the words of a sample name all symbols, in the alphabet's order.
fn shows_alphabet(sample: &Sample) -> bool {
    let words = sample.items().iter().flat_map(Item::words);
    let mut shown = 0;
    for symbol in words.flat_map(Word::iter) {
        if symbol.index() > shown {
            return false;
        }
        if symbol.index() == shown {
            shown += 1;
        }
    }
    shown == sample.alphabet().len()
}
