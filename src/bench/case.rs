//! What a run of an experiment is about: a target, alone or in a situation.

use std::sync::Arc;

use crate::concept::{Prior, Template};
use crate::oracle::{Target, TargetError};
use crate::task::Situation;
use crate::world::grid::{GridMap, Labelling};
use crate::world::{Words, World};

/// The robot's room: lava, recharge tiles, water and dryers around the start.
const ROOM: &str = "\
..........
.RR..B..Y.
.R...BB...
.....B..O.
..S....RR.
.......R..
.YY..O....
..R.....B.
..R...BBB.
O......Y..
";
/// The steps that a walk through it may have.
const STEPS: usize = 40;
/// Without a room, the symbols that a behaviour may have.
const LONGEST: usize = 40;

/// A target, alone or in a situation.
#[derive(Clone, Debug)]
pub struct Case {
    name: String,
    target: Target,
    situation: Option<Situation>,
}

impl From<Target> for Case {
    fn from(target: Target) -> Self {
        Self {
            name: target.name().to_owned(),
            target,
            situation: None,
        }
    }
}

impl Case {
    /// The robot's task: with nothing known but its examples; with RY known, on all
    /// words; and the same in a room.
    ///
    /// # Errors
    ///
    /// If the target cannot be made, which does not happen.
    #[expect(clippy::missing_panics_doc, reason = "the situation is a constant")]
    pub fn robot() -> Result<Vec<Self>, TargetError> {
        let target = Target::named("robot")?;
        let alphabet = target.dfa().alphabet();
        let rule = |text: &str| {
            let template = Template::parse(text, alphabet).expect("a rule that is known by name");
            template.dfa(alphabet)
        };
        let rules = vec![rule("avoid R"), rule("reach Y")];
        let prior = Prior::new(alphabet, rules, Vec::new()).expect("the rules leave much open");
        let room = GridMap::new(alphabet, ROOM).grid(alphabet.clone(), Labelling::Entry, STEPS);
        let worlds = [
            World::Words(Words::new(alphabet.clone(), LONGEST)),
            World::Grid(room.expect("the room is a grid with a start")),
        ];
        let names = ["robot, RY known", "robot, RY known, in a room"];
        let situated = worlds.into_iter().zip(names).map(|(world, name)| Self {
            name: name.to_owned(),
            target: target.clone(),
            situation: Some(Situation {
                world: Arc::new(world),
                prior: prior.clone(),
            }),
        });
        let situated: Vec<Self> = situated.collect();
        Ok(std::iter::once(Self::from(target))
            .chain(situated)
            .collect())
    }

    /// What it is called.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What is taught.
    pub fn target(&self) -> &Target {
        &self.target
    }

    /// Where and beside what it is taught; none: all words can be shown, and
    /// nothing is known but the target's examples.
    pub fn situation(&self) -> Option<&Situation> {
        self.situation.as_ref()
    }
}
