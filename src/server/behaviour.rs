//! A behaviour as a card shows it: what there is to see of it, and what it is in
//! words or numbers.

use automata::Word;

use super::drive::Drive;
use super::recording::RecordingView;
use super::scene::{Look, Scene};
use crate::concept::{Behaviour, Point};
use crate::session::{Atom, Session, Task, Universe};
use crate::task::{Axes, BehaviourText, Picture};
use crate::world::grid::Tile;
use crate::world::{Trajectory, World};

/// A symbol as a chip.
#[derive(Clone)]
pub(crate) struct Chip {
    pub(crate) name: String,
    pub(crate) text: String,
    /// What its tile shows.
    pub(crate) letter: String,
    pub(crate) tone: usize,
    /// A colour of the task's own, in place of the tone.
    pub(crate) colour: Option<String>,
    /// Part of the beginning that both words share.
    pub(crate) shared: bool,
    /// Where the two words part.
    pub(crate) parts: bool,
}

impl Chip {
    /// Whether its tile says all.
    pub(crate) fn is_bare(&self) -> bool {
        self.text == self.letter
    }

    pub(crate) fn look(&self) -> Look {
        Look {
            letter: self.letter.clone(),
            tone: self.tone,
            colour: self.colour.clone(),
        }
    }
}

/// What there is to see of a behaviour, and what it is.
pub(crate) struct BehaviourView {
    pub(crate) scene: Option<Scene>,
    pub(crate) recording: Option<RecordingView>,
    pub(crate) drive: Option<Drive>,
    pub(crate) content: Content,
}

/// What a behaviour is.
pub(crate) enum Content {
    /// A word as a row of chips.
    Word {
        /// The names of its symbols.
        data: String,
        chips: Vec<Chip>,
        /// What it is called if it has none.
        empty: String,
    },
    /// A number an axis.
    Values(Vec<ValueView>),
    /// Something with a name, and its features step by step.
    Item {
        name: String,
        features: Vec<FeatureView>,
    },
}

/// What was measured on an axis.
pub(crate) struct ValueView {
    pub(crate) name: String,
    /// With its unit.
    pub(crate) value: String,
    /// Whether the other behaviour has another.
    pub(crate) parts: bool,
}

/// A feature's numbers, a step each.
pub(crate) struct FeatureView {
    pub(crate) name: String,
    pub(crate) steps: Vec<String>,
}

/// A behaviour in a line.
pub(crate) enum Brief {
    /// A word by the tiles of its symbols.
    Word { names: String, chips: Vec<Chip> },
    /// Anything else by its name or its numbers.
    Text(String),
}

impl Brief {
    pub(crate) fn of(atom: &Atom, session: &Session) -> Self {
        let Atom::Word(word) = atom else {
            return Self::Text(session.universe().spell(atom));
        };
        if word.is_empty() {
            return Self::Text(session.task().empty.clone());
        }
        let symbols = chips(session.task());
        let chips: Vec<Chip> = word
            .iter()
            .map(|symbol| symbols[symbol.index()].clone())
            .collect();
        let texts: Vec<&str> = chips.iter().map(|chip| chip.text.as_str()).collect();
        Self::Word {
            names: texts.join(", "),
            chips,
        }
    }
}

/// What the tiles of a world mean; nothing where no world is drawn.
#[derive(Default)]
pub(crate) struct Legend {
    pub(crate) chips: Vec<Chip>,
    /// Whether there is a wall anywhere.
    pub(crate) walls: bool,
}

impl Legend {
    pub(crate) fn of(session: &Session) -> Self {
        match session.world() {
            Some(World::Grid(grid)) => Self {
                chips: chips(session.task()),
                walls: grid.cells().any(|at| grid.tile(at) == Tile::Wall),
            },
            _ => Self::default(),
        }
    }
}

/// The number of tones that the style sheet has.
const TONES: usize = 8;

/// The task's symbols as chips.
pub(crate) fn chips(task: &Task) -> Vec<Chip> {
    let worded = task.symbols.iter().any(|symbol| symbol.word.is_some());
    task.symbols
        .iter()
        .enumerate()
        .map(|(i, symbol)| Chip {
            name: symbol.name.clone(),
            text: symbol.text().to_owned(),
            letter: match (symbol.letter, &symbol.colour) {
                (Some(letter), _) => letter.to_string(),
                // A tile of a colour of its own is as wide as one letter.
                (None, Some(_)) => symbol.name.chars().take(1).collect(),
                (None, None) => symbol.name.clone(),
            },
            colour: symbol.colour.as_ref().map(|colour| colour.hex().to_owned()),
            // The tones begin with the ones for danger and reward; bare letters
            // begin further on, so that they do not look like either.
            tone: (if worded { i } else { i + 2 }) % TONES,
            shared: false,
            parts: false,
        })
        .collect()
}

impl BehaviourView {
    pub(crate) fn of(atom: &Atom, session: &Session) -> Self {
        Self::beside(atom, None, session)
    }

    /// Both, with what they do not share marked.
    pub(crate) fn pair(first: &Atom, second: &Atom, session: &Session) -> (Self, Self) {
        let mut first_view = Self::beside(first, Some(second), session);
        let mut second_view = Self::beside(second, Some(first), session);
        if let (Some(first), Some(second)) = (first_view.drawn(), second_view.drawn()) {
            Scene::part(first, second);
        }
        (first_view, second_view)
    }

    /// What is drawn of it cell by cell.
    fn drawn(&mut self) -> Option<&mut Scene> {
        let recorded = self.recording.as_mut().and_then(|r| r.cells.as_mut());
        self.scene.as_mut().or(recorded)
    }

    fn beside(atom: &Atom, other: Option<&Atom>, session: &Session) -> Self {
        match (session.universe(), atom) {
            (Universe::Monotone(axes), Atom::Point(point)) => {
                let other = match other {
                    Some(Atom::Point(other)) => Some(other),
                    _ => None,
                };
                Self::measured(axes, point, other)
            }
            (Universe::Finite(table), Atom::Item(place)) => {
                let name = table.atoms().nth(*place as usize).unwrap_or_default();
                Self::named(name.to_owned(), Vec::new())
            }
            (Universe::Linear(rewards), Atom::Item(place)) => {
                let name = rewards.name(Behaviour(*place)).to_owned();
                let behaviour = &rewards.behaviours()[*place as usize];
                Self::named(name, features(rewards.features(), behaviour))
            }
            (_, Atom::Word(word)) => {
                let other = match other {
                    Some(Atom::Word(other)) => Some(other),
                    _ => None,
                };
                Self::word(word, other, session)
            }
            (_, Atom::Point(_) | Atom::Item(_)) => {
                Self::named(session.universe().spell(atom), Vec::new())
            }
        }
    }

    fn named(name: String, features: Vec<FeatureView>) -> Self {
        Self {
            scene: None,
            recording: None,
            drive: None,
            content: Content::Item { name, features },
        }
    }

    fn measured(axes: &Axes, point: &Point, other: Option<&Point>) -> Self {
        let values = axes.values(point);
        let others = other.map(|other| axes.values(other));
        let numbered = axes.axes().iter().zip(&values).enumerate();
        let view = |(place, (axis, value)): (usize, (&crate::task::Axis, &f64))| ValueView {
            name: axis.name.clone(),
            value: axis.spell(*value),
            parts: (others.as_ref())
                .is_some_and(|others| axis.spell(others[place]) != axis.spell(*value)),
        };
        Self {
            scene: None,
            recording: None,
            drive: (axes.picture() == Some(Picture::Passing)).then(|| Drive::of(axes, point)),
            content: Content::Values(numbered.map(view).collect()),
        }
    }

    /// The word with what it shares with `other` marked.
    fn word(word: &Word, other: Option<&Word>, session: &Session) -> Self {
        let common = other.map_or(0, |other| {
            word.iter()
                .zip(other.iter())
                .take_while(|(a, b)| a == b)
                .count()
        });
        let symbols = chips(session.task());
        let scene = match session.world().map(|world| (world, world.trajectory(word))) {
            Some((World::Grid(grid), Some(Trajectory::Walk { from, steps }))) => {
                let looks: Vec<Look> = symbols.iter().map(Chip::look).collect();
                Some(Scene::of(grid, from, &steps, &looks))
            }
            _ => None,
        };
        let chips: Vec<Chip> = word
            .iter()
            .enumerate()
            .map(|(i, symbol)| {
                let chip = &symbols[symbol.index()];
                Chip {
                    name: chip.name.clone(),
                    text: chip.text.clone(),
                    letter: chip.letter.clone(),
                    tone: chip.tone,
                    colour: chip.colour.clone(),
                    shared: i < common,
                    parts: common > 0 && i == common,
                }
            })
            .collect();
        let names: Vec<&str> = chips.iter().map(|chip| chip.name.as_str()).collect();
        Self {
            scene,
            recording: RecordingView::shown(word, session),
            drive: None,
            content: Content::Word {
                data: names.join(" "),
                chips,
                empty: session.task().empty.clone(),
            },
        }
    }
}

fn features(names: &[String], behaviour: &BehaviourText) -> Vec<FeatureView> {
    let steps = |place: usize| {
        behaviour
            .features
            .iter()
            .map(move |step| step[place].to_string())
    };
    let named = names.iter().enumerate();
    named
        .map(|(place, name)| FeatureView {
            name: name.clone(),
            steps: steps(place).collect(),
        })
        .collect()
}
