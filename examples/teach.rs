//! Teaches a rule that exists only as code: a door is never opened twice and is
//! closed at the end.
//!
//! Your own teacher goes where `acceptable` and `faults` are: a simulator, a
//! test suite, a person at a terminal.
//!
//! ```sh
//! cargo run --release --example teach
//! ```

use automata::{Alphabet, Dfa, Word};
use memrep::concept::DfaClass;
use memrep::evidence::{AnswerId, Comparison};
use memrep::identify::{EngineChoice, Settings};
use memrep::learner::{Config, Learner, Question, Reply, Step, Strategy};

fn main() -> anyhow::Result<()> {
    let alphabet = Alphabet::new(["open", "close", "wait"])?;
    let settings = Settings {
        engine: EngineChoice::Auto,
        max_states: 10,
    };
    let config = Config {
        strategy: Strategy::Thesis,
        ..Config::default()
    };
    let class = DfaClass::new(alphabet.clone(), settings);
    let mut learner = Learner::new(class, config, Vec::new());

    let mut number = 0;
    loop {
        number += 1;
        match learner.next() {
            Step::Ask {
                question, round, ..
            } => {
                let reply = answer(&alphabet, &question);
                println!("{number:3}. {}", told(&alphabet, &question, &reply));
                learner.record(AnswerId(number), question, round, reply)?;
            }
            Step::Conflict(conflict) => {
                anyhow::bail!("these answers cannot all stand: {:?}", conflict.answers)
            }
            Step::Done { hypothesis } => {
                println!("\nlearned with {:?}", learner.counts());
                print!("{}", automata::format::dot::write(&hypothesis)?);
                return Ok(());
            }
        }
    }
}

/// How often the rule is broken: openings of an open door, closings of a closed
/// one, and a door that is left open.
fn faults(alphabet: &Alphabet, word: &Word) -> usize {
    let (mut open, mut faults) = (false, 0);
    for event in alphabet.spell(word) {
        if event != "wait" {
            let opens = event == "open";
            faults += usize::from(opens == open);
            open = opens;
        }
    }
    faults + usize::from(open)
}

fn acceptable(alphabet: &Alphabet, word: &Word) -> bool {
    faults(alphabet, word) == 0
}

/// The teacher. Fewer faults are better: an order that respects membership,
/// since what is acceptable has none.
fn answer(alphabet: &Alphabet, question: &Question<Word, Dfa>) -> Reply<Word> {
    match question {
        Question::Membership { atom } if acceptable(alphabet, atom) => Reply::Accept,
        Question::Membership { .. } => Reply::Reject,
        Question::Comparison { first, second } => {
            let difference = faults(alphabet, first).cmp(&faults(alphabet, second));
            Reply::Compared(match difference {
                std::cmp::Ordering::Less => Comparison::First,
                std::cmp::Ordering::Greater => Comparison::Second,
                std::cmp::Ordering::Equal => Comparison::Equal,
            })
        }
        // A rule given as code can be tried, not proved: here on all words of
        // up to eight events.
        Question::Equivalence { hypothesis } => (alphabet.words_up_to(8))
            .map(|atom| (acceptable(alphabet, &atom), atom))
            .find(|(label, atom)| hypothesis.accepts(atom) != *label)
            .map_or(Reply::Correct, |(label, atom)| Reply::Counterexample {
                atom,
                label,
            }),
    }
}

/// One line about a question and its answer.
fn told(alphabet: &Alphabet, question: &Question<Word, Dfa>, reply: &Reply<Word>) -> String {
    let spell = |word: &Word| {
        let events: Vec<&str> = alphabet.spell(word).collect();
        format!("[{}]", events.join(" "))
    };
    let question = match question {
        Question::Membership { atom } => format!("is {} acceptable?", spell(atom)),
        Question::Comparison { first, second } => {
            format!("which is better, {} or {}?", spell(first), spell(second))
        }
        Question::Equivalence { hypothesis } => {
            format!("is it this automaton of {} states?", hypothesis.size())
        }
    };
    let reply = match reply {
        Reply::Accept | Reply::Correct => "yes".to_owned(),
        Reply::Reject => "no".to_owned(),
        Reply::Compared(Comparison::First) => "the first".to_owned(),
        Reply::Compared(Comparison::Second) => "the second".to_owned(),
        Reply::Compared(Comparison::Equal) => "neither".to_owned(),
        Reply::Compared(Comparison::Incomparable) => "I cannot say".to_owned(),
        Reply::Counterexample { atom, label: true } => format!("no, {} is fine", spell(atom)),
        Reply::Counterexample { atom, .. } => format!("no, {} is not fine", spell(atom)),
        Reply::Skip => "skip".to_owned(),
    };
    format!("{question} {reply}")
}
