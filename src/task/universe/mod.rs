//! What a task is about: its behaviours and the rules that can be learned of them,
//! as they are written in logs, requests and files.
//!
//! A [`Universe`] knows the names of things; it must not know what was answered.

mod axes;
mod rewards;
mod saved;
mod text;

use automata::{Alphabet, Dfa, Word};
use serde_json::Value;

pub use self::axes::{Axes, Axis, OffGrid, Picture};
pub use self::rewards::{BehaviourText, Rewards};
pub use self::saved::Saved;
pub(crate) use self::text::Bare;
pub use self::text::{AtomText, ConceptText};

use super::examples::read_word;
use super::reader::Malformed;
use super::situation::Situation;
use super::{Automaton, Unreadable};
use crate::concept::{
    Behaviour, ConceptClass, Failure, FiniteAtom, FiniteConcept, FiniteTable, Point,
};
use crate::evidence::{Budget, Fact};

/// The work that looking for a rule of the examples may do.
const WORK: u64 = 2_000_000;

/// One behaviour.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Atom {
    /// What happens, in order.
    Word(Word),
    /// What is measured, on axes from the best (0) to the worst (1).
    Point(Point),
    /// A row of a table, or one of the behaviours that were given, from 0.
    Item(u32),
}

/// One rule: what behaviours are acceptable.
#[derive(Clone, Debug, PartialEq)]
pub enum Concept {
    /// Of words.
    Automaton(Dfa),
    /// Of a monotone family: what a behaviour may ask at most.
    Parameter(Point),
    /// A column of a table.
    Named(FiniteConcept),
}

impl Concept {
    /// The automaton; none if it is none.
    pub fn automaton(&self) -> Option<&Dfa> {
        match self {
            Self::Automaton(dfa) => Some(dfa),
            Self::Parameter(_) | Self::Named(_) => None,
        }
    }
}

/// What went into an [`Atom`] or a [`Concept`], and comes out of it again.
macro_rules! wraps {
    ($outer:ident: $($inner:ty => $wrap:expr, $pattern:pat => $out:expr;)*) => {$(
        impl From<$inner> for $outer {
            fn from(inner: $inner) -> Self {
                $wrap(inner)
            }
        }

        impl TryFrom<$outer> for $inner {
            type Error = $outer;

            fn try_from(outer: $outer) -> Result<Self, $outer> {
                match outer {
                    $pattern => Ok($out),
                    other => Err(other),
                }
            }
        }
    )*};
}

wraps! { Atom:
    Word => Atom::Word, Atom::Word(word) => word;
    Point => Atom::Point, Atom::Point(point) => point;
    FiniteAtom => |atom: FiniteAtom| Atom::Item(atom.0), Atom::Item(place) => FiniteAtom(place);
    Behaviour => |atom: Behaviour| Atom::Item(atom.0), Atom::Item(place) => Behaviour(place);
}

wraps! { Concept:
    Dfa => Concept::Automaton, Concept::Automaton(dfa) => dfa;
    Point => Concept::Parameter, Concept::Parameter(point) => point;
    FiniteConcept => Concept::Named, Concept::Named(concept) => concept;
}

/// The behaviours of a task, and the rules that can be learned of them.
#[derive(Clone, Debug)]
pub enum Universe {
    /// Words, and automata.
    Words {
        /// Over these symbols.
        alphabet: Alphabet,
        /// None where all words are asked about, and nothing is known beforehand.
        situation: Option<Situation>,
    },
    /// What is measured, and limits on it.
    Monotone(Axes),
    /// The rows and the columns of a table.
    Finite(FiniteTable),
    /// Behaviours with features, and rewards that weigh these (Eq. 5.7).
    Linear(Rewards),
}

impl Universe {
    /// The key under which a behaviour is told: `word`, `point` or `item`.
    pub fn key(&self) -> &'static str {
        match self {
            Self::Words { .. } => "word",
            Self::Monotone(_) => "point",
            Self::Finite(_) | Self::Linear(_) => "item",
        }
    }

    /// The alphabet of its words; none if it has no words.
    pub fn alphabet(&self) -> Option<&Alphabet> {
        match self {
            Self::Words { alphabet, .. } => Some(alphabet),
            Self::Monotone(_) | Self::Finite(_) | Self::Linear(_) => None,
        }
    }

    /// The world of its words and what is known beforehand; none if there is neither.
    pub fn situation(&self) -> Option<&Situation> {
        match self {
            Self::Words { situation, .. } => situation.as_ref(),
            Self::Monotone(_) | Self::Finite(_) | Self::Linear(_) => None,
        }
    }

    /// Whether the rule accepts the behaviour. What is of another universe is not
    /// accepted.
    pub fn accepts(&self, concept: &Concept, atom: &Atom) -> bool {
        match (self, concept, atom) {
            (Self::Words { .. }, Concept::Automaton(dfa), Atom::Word(word)) => dfa.accepts(word),
            (Self::Monotone(axes), Concept::Parameter(most), Atom::Point(point)) => {
                axes.accepts(most, point)
            }
            (Self::Finite(table), Concept::Named(concept), Atom::Item(place)) => {
                table.accepts(*concept, FiniteAtom(*place))
            }
            (Self::Linear(rewards), Concept::Parameter(parameter), Atom::Item(place)) => {
                rewards.accepts(parameter, Behaviour(*place))
            }
            _ => false,
        }
    }

    /// The size of a rule: its states, the points per axis of its grid, or what its
    /// table says.
    pub fn size(&self, concept: &Concept) -> usize {
        match (self, concept) {
            (_, Concept::Automaton(dfa)) => dfa.size(),
            (_, Concept::Parameter(point)) => point.size(),
            (Self::Finite(table), Concept::Named(concept)) => table.class().size(*concept),
            (_, Concept::Named(_)) => 0,
        }
    }

    /// The names of all behaviours, where they have names.
    pub fn items(&self) -> Vec<&str> {
        match self {
            Self::Finite(table) => table.atoms().collect(),
            Self::Linear(rewards) => rewards.names().collect(),
            Self::Words { .. } | Self::Monotone(_) => Vec::new(),
        }
    }

    /// Whether some rule labels these behaviours so. Of automata there always is one
    /// that is large enough.
    pub(super) fn has_rule(&self, labels: Vec<(Atom, bool)>) -> bool {
        match self {
            Self::Words { .. } => true,
            Self::Monotone(axes) => has_concept(axes.class(), labels),
            Self::Finite(table) => has_concept(table.class().clone(), labels),
            Self::Linear(rewards) => has_concept(rewards.class(), labels),
        }
    }

    /// Reads a behaviour that stands at `path`.
    ///
    /// # Errors
    ///
    /// Says what there is instead of one, and what is expected.
    pub fn read(&self, value: &Value, path: &str) -> Result<Atom, Malformed> {
        match self {
            Self::Words { alphabet, .. } => read_word(value, path, alphabet).map(Atom::Word),
            Self::Monotone(axes) => {
                let values: Option<Vec<f64>> = (value.as_array())
                    .and_then(|values| values.iter().map(Value::as_f64).collect());
                let Some(values) = values else {
                    return Err(Malformed::new(path, axes.expected()));
                };
                let fault = |error: OffGrid| match error.axis() {
                    Some(axis) => Malformed::new(format!("{path}[{axis}]"), error.to_string()),
                    None => Malformed::new(path, error.to_string()),
                };
                axes.point(&values).map(Atom::Point).map_err(fault)
            }
            Self::Finite(_) | Self::Linear(_) => {
                let name = value.as_str().unwrap_or_default();
                let items = self.items();
                let place = items.iter().position(|item| *item == name);
                place.map(|place| Atom::Item(place as u32)).ok_or_else(|| {
                    Malformed::new(
                        path,
                        format!(
                            "`{name}` is no behaviour of this task: give one of {}",
                            items.join(", ")
                        ),
                    )
                })
            }
        }
    }

    /// A behaviour as it is written.
    pub fn text(&self, atom: &Atom) -> AtomText {
        match (self, atom) {
            (Self::Words { alphabet, .. }, Atom::Word(word)) => {
                AtomText::Word(alphabet.spell(word).map(str::to_owned).collect())
            }
            (Self::Monotone(axes), Atom::Point(point)) => AtomText::Point(axes.values(point)),
            (Self::Finite(table), Atom::Item(place)) => {
                AtomText::Item(table.atom(FiniteAtom(*place)).to_owned())
            }
            (Self::Linear(rewards), Atom::Item(place)) => {
                AtomText::Item(rewards.name(Behaviour(*place)).to_owned())
            }
            (_, other) => unreachable!("{other:?} is of another universe"),
        }
    }

    /// A behaviour in a line, for people.
    pub fn spell(&self, atom: &Atom) -> String {
        match (self, atom) {
            (Self::Monotone(axes), Atom::Point(point)) => axes.spell(point),
            _ => match self.text(atom) {
                AtomText::Word(names) => format!("[{}]", names.join(", ")),
                AtomText::Item(name) => format!("`{name}`"),
                AtomText::Point(values) => format!("{values:?}"),
            },
        }
    }

    /// The behaviour that was written.
    ///
    /// # Errors
    ///
    /// If there is no such behaviour here.
    pub fn parse(&self, text: &AtomText) -> Result<Atom, Unreadable> {
        let (key, value) = match text {
            AtomText::Word(names) => ("word", Value::from(names.as_slice())),
            AtomText::Point(values) => ("point", Value::from(values.as_slice())),
            AtomText::Item(name) => ("item", Value::from(name.as_str())),
        };
        if key != self.key() {
            let message = format!(
                "a `{key}` is no behaviour of this task: give a `{}`",
                self.key()
            );
            return Err(Unreadable(message));
        }
        self.read(&value, key)
            .map_err(|error| Unreadable(error.to_string()))
    }

    /// A rule as it is written.
    pub fn rule(&self, concept: &Concept) -> ConceptText {
        match (self, concept) {
            (_, Concept::Automaton(dfa)) => ConceptText::Automaton(Automaton::of(dfa)),
            (Self::Monotone(axes), Concept::Parameter(most)) => ConceptText::Limits {
                limits: axes.values(most),
            },
            (Self::Linear(rewards), Concept::Parameter(parameter)) => {
                let reward = rewards.reward(parameter);
                ConceptText::Reward {
                    weights: reward.weights,
                    threshold: reward.threshold,
                }
            }
            (Self::Finite(table), Concept::Named(concept)) => ConceptText::Named {
                concept: table.concept(*concept).to_owned(),
            },
            (_, other) => unreachable!("{other:?} is of another universe"),
        }
    }

    /// The rule that was written.
    ///
    /// # Errors
    ///
    /// If there is no such rule here.
    pub fn parse_rule(&self, text: &ConceptText) -> Result<Concept, Unreadable> {
        let read = match (self, text) {
            (Self::Words { alphabet, .. }, ConceptText::Automaton(automaton)) => {
                return automaton.read(alphabet).map(Concept::Automaton);
            }
            (Self::Monotone(axes), ConceptText::Limits { limits }) => axes
                .point(limits)
                .map(Concept::Parameter)
                .map_err(|error| error.to_string()),
            (Self::Linear(rewards), ConceptText::Reward { weights, threshold }) => rewards
                .parameter(weights, *threshold)
                .map(Concept::Parameter),
            (Self::Finite(table), ConceptText::Named { concept }) => table
                .named(concept)
                .map(Concept::Named)
                .ok_or_else(|| format!("there is no concept `{concept}` in the table")),
            _ => Err("this is no rule of the kind that the task learns".to_owned()),
        };
        read.map_err(Unreadable)
    }
}

fn has_concept<C>(mut class: C, labels: Vec<(Atom, bool)>) -> bool
where
    C: ConceptClass,
    C::Atom: TryFrom<Atom>,
{
    for (atom, accepted) in labels {
        if let Ok(atom) = C::Atom::try_from(atom) {
            class.add(None, Fact::Label { atom, accepted });
        }
    }
    // Where that takes too long, the first question will tell.
    !matches!(
        class.sample(1, 0, &mut Budget::new(WORK)),
        Err(Failure::Contradiction(_))
    )
}
