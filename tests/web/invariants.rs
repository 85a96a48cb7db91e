//! What must always hold of a session, seen through its public doors: its question,
//! its state and its log; by a fold of the log that the server has no part in, and by
//! brute force.

use std::collections::{BTreeMap, BTreeSet};

use axum::http::StatusCode;
use memrep::evidence::{Budget, Comparison, Fact};
use memrep::identify::{EngineChoice, Failure, Identifier, Settings};
use memrep::learner::{Question, Reply};
use memrep::session::{Atom, Conflict, ConflictCause, Event, Position, Session, Standing};
use serde_json::{Value, json};

use crate::site::Site;

/// The entries of a session's log, which have no gap and read the same twice.
async fn log(site: &Site, session: &str) -> Vec<Event> {
    let path = format!("/api/v1/sessions/{session}/log");
    let text = site.get(&path).await.text;
    let mut events = Vec::new();
    for (place, line) in text.lines().enumerate() {
        let mut entry: Value = serde_json::from_str(line).unwrap();
        assert_eq!(entry["seq"], place, "{line}");
        let entry = entry.as_object_mut().unwrap();
        entry.remove("seq");
        entry.remove("at").unwrap();
        let entry = Value::Object(std::mem::take(entry));
        events.push(serde_json::from_value(entry).unwrap());
    }
    events
}

/// A session that was checked.
pub(crate) struct Checked {
    /// The entries of its log.
    pub(crate) entries: usize,
    /// Whether its answers contradict each other.
    pub(crate) is_conflict: bool,
}

/// Checks a session.
pub(crate) async fn check(site: &Site, id: &str) -> Checked {
    let path = format!("/api/v1/sessions/{id}");
    let question = site.get(&format!("{path}/question")).await;
    assert_eq!(question.status, StatusCode::OK, "{}", question.text);
    let again = site.get(&format!("{path}/question")).await;
    assert_eq!(
        question.text, again.text,
        "a second look shows something else"
    );
    let state = site.get(&path).await.json();
    let events = log(site, id).await;
    let twin = Session::replay(&events).unwrap();
    assert_eq!(question.json(), twin.describe(twin.position()));
    assert_eq!(state["counts"], json!(twin.counts()));
    let standing: Vec<u32> = twin.standing().iter().map(|s| s.number).collect();
    assert_eq!(state["answers"], json!(standing));
    check_sound(&twin);
    for number in twin.open() {
        check_not_known(&twin, number);
    }
    if let Position::Conflict(conflict) = twin.position() {
        check_conflict(&twin, conflict);
    }
    Checked {
        entries: events.len(),
        is_conflict: matches!(twin.position(), Position::Conflict(_)),
    }
}

/// What a standing answer says.
fn fact(session: &Session, standing: &Standing) -> Option<Fact<Atom>> {
    let question = &session.asked(standing.number).unwrap().question;
    Some(match (question, &standing.reply) {
        (Question::Membership { atom }, Reply::Accept | Reply::Reject) => Fact::Label {
            atom: atom.clone(),
            accepted: standing.reply == Reply::Accept,
        },
        (_, Reply::Counterexample { atom, label }) => Fact::Label {
            atom: atom.clone(),
            accepted: *label,
        },
        (Question::Comparison { first, second }, Reply::Compared(answer))
            if *answer != Comparison::Incomparable =>
        {
            Fact::compared(first.clone(), second.clone(), *answer)
        }
        _ => return None,
    })
}

fn facts(session: &Session) -> BTreeMap<u32, Fact<Atom>> {
    let standing = session.standing().iter();
    standing
        .filter_map(|s| Some((s.number, fact(session, s)?)))
        .collect()
}

/// The rule on show agrees with every standing answer and with every example.
fn check_sound(session: &Session) {
    let Some(rule) = session.hypothesis() else {
        return;
    };
    let says = |atom: &Atom| session.universe().accepts(&rule, atom);
    let given: Vec<Fact<Atom>> = session.task().known(session.universe());
    for fact in facts(session).values().chain(&given) {
        assert!(fact.holds(says), "{fact:?} is broken by {rule:?}");
    }
}

/// What answers say of the order of behaviours: who is no better than whom.
#[derive(Default)]
struct Order {
    /// From worse to better or as good; whether it is better.
    steps: BTreeMap<Atom, Vec<(Atom, bool)>>,
    labels: Vec<(Atom, bool)>,
}

impl Order {
    fn of<'a>(facts: impl Iterator<Item = &'a Fact<Atom>>) -> Self {
        let mut order = Self::default();
        let mut step = |from: &Atom, to: &Atom, strict| {
            let steps = order.steps.entry(from.clone()).or_default();
            steps.push((to.clone(), strict));
        };
        for fact in facts {
            match fact {
                Fact::Label { atom, accepted } => order.labels.push((atom.clone(), *accepted)),
                Fact::Below { worse, better } => step(worse, better, true),
                Fact::Equal { first, second } => {
                    step(first, second, false);
                    step(second, first, false);
                }
                Fact::Incomparable { .. } => {}
            }
        }
        order
    }

    /// All that is no worse than this.
    fn above(&self, atom: &Atom) -> BTreeSet<Atom> {
        let mut found = BTreeSet::from([atom.clone()]);
        let mut ahead = vec![atom.clone()];
        while let Some(atom) = ahead.pop() {
            for (next, _) in self.steps.get(&atom).into_iter().flatten() {
                if found.insert(next.clone()) {
                    ahead.push(next.clone());
                }
            }
        }
        found
    }

    /// Whether something would be better than itself, or acceptable and no better
    /// than what is not.
    fn is_impossible(&self) -> bool {
        let circles = self.steps.iter().any(|(from, steps)| {
            let strict = steps.iter().filter(|(_, strict)| *strict);
            strict
                .into_iter()
                .any(|(to, _)| self.above(to).contains(from))
        });
        circles
            || self.labels.iter().any(|(atom, accepted)| {
                let above = self.above(atom);
                *accepted
                    && self
                        .labels
                        .iter()
                        .any(|(other, label)| !label && above.contains(other))
            })
    }

    /// The label that follows for this, if one does.
    fn follows(&self, atom: &Atom) -> Option<bool> {
        let above = self.above(atom);
        for (other, accepted) in &self.labels {
            if *accepted && self.above(other).contains(atom) {
                return Some(true);
            }
            if !accepted && above.contains(other) {
                return Some(false);
            }
        }
        None
    }
}

/// Nothing is asked that the answers say already.
fn check_not_known(session: &Session, number: u32) {
    let facts = facts(session);
    let given: Vec<Fact<Atom>> = session.task().known(session.universe());
    let order = Order::of(facts.values().chain(&given));
    let question = &session.asked(number).unwrap().question;
    match question {
        Question::Membership { atom } => {
            assert_eq!(order.follows(atom), None, "{question:?} is known");
        }
        Question::Comparison { first, second } => {
            for standing in session.standing() {
                let other = &session.asked(standing.number).unwrap().question;
                let Question::Comparison {
                    first: one,
                    second: two,
                } = other
                else {
                    continue;
                };
                let same = (one, two) == (first, second) || (two, one) == (first, second);
                assert!(!same, "{question:?} was answered as {}", standing.number);
            }
            assert_ne!(first, second);
        }
        Question::Equivalence { .. } => {}
    }
}

/// The answers that are told cannot all be true; and where that is said, any of them
/// left out would do.
fn check_conflict(session: &Session, conflict: &Conflict) {
    let facts = facts(session);
    let given: Vec<Fact<Atom>> = session.task().known(session.universe());
    let told: BTreeMap<u32, &Fact<Atom>> = conflict
        .answers
        .iter()
        .map(|number| {
            (
                *number,
                facts.get(number).expect("it stands and says something"),
            )
        })
        .collect();
    let by_size = conflict.cause == ConflictCause::States;
    let impossible = |without: Option<u32>| {
        let kept = told.iter().filter(|(number, _)| Some(**number) != without);
        let kept: Vec<&Fact<Atom>> = kept.map(|(_, fact)| *fact).chain(&given).collect();
        let order = Order::of(kept.iter().copied());
        order.is_impossible() || by_size && no_automaton(session, &kept)
    };
    // Other classes than automata have sizes of their own.
    if by_size && (session.universe().alphabet().is_none() || session.has_prior()) {
        return;
    }
    assert!(impossible(None), "{conflict:?} is none");
    if conflict.minimal {
        for number in &conflict.answers {
            assert!(
                !impossible(Some(*number)),
                "{conflict:?} without {number} is one"
            );
        }
    }
}

/// Whether no automaton within the bound fits, by an engine that saw nothing before,
/// and no SAT solver.
fn no_automaton(session: &Session, facts: &[&Fact<Atom>]) -> bool {
    let alphabet = session.universe().alphabet().unwrap().clone();
    let settings = Settings {
        engine: EngineChoice::Enumerate,
        max_states: session.task().max_states,
    };
    let word = |atom: &Atom| match atom {
        Atom::Word(word) => word.clone(),
        other => panic!("{other:?} is no word"),
    };
    let mut fresh = Identifier::new(alphabet, settings);
    for fact in facts {
        let fact = match fact {
            Fact::Label { atom, accepted } => Fact::Label {
                atom: word(atom),
                accepted: *accepted,
            },
            Fact::Below { worse, better } => Fact::Below {
                worse: word(worse),
                better: word(better),
            },
            Fact::Equal { first, second } => Fact::Equal {
                first: word(first),
                second: word(second),
            },
            Fact::Incomparable { .. } => continue,
        };
        fresh.add(None, fact);
    }
    match fresh.smallest(1, 0, &mut Budget::new(u64::MAX)) {
        Ok(_) => false,
        Err(Failure::Contradiction(_)) => true,
        Err(other) => panic!("{other:?} without a limit"),
    }
}
