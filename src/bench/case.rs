//! What a run of an experiment is about: a target, alone or in a setting.

use std::sync::Arc;

use automata::{Dfa, Word};

use crate::concept::{Prior, PriorError, Situated, Template};
use crate::identify::Settings;
use crate::oracle::{Target, TargetError};
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

/// A target, alone or in a setting.
#[derive(Clone, Debug)]
pub struct Case {
    name: String,
    target: Target,
    setting: Option<Setting>,
}

/// Where behaviours come from, and what is known beforehand.
#[derive(Clone, Debug)]
pub struct Setting {
    /// Where behaviours come from.
    pub world: Arc<World>,
    /// What is known beforehand.
    pub prior: Prior,
}

impl From<Target> for Case {
    fn from(target: Target) -> Self {
        Self {
            name: target.name().to_owned(),
            target,
            setting: None,
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
    #[expect(clippy::missing_panics_doc, reason = "the setting is a constant")]
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
        let settings = worlds.into_iter().zip(names).map(|(world, name)| Self {
            name: name.to_owned(),
            target: target.clone(),
            setting: Some(Setting {
                world: Arc::new(world),
                prior: prior.clone(),
            }),
        });
        let settings: Vec<Self> = settings.collect();
        Ok(std::iter::once(Self::from(target))
            .chain(settings)
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
    pub fn setting(&self) -> Option<&Setting> {
        self.setting.as_ref()
    }
}

impl Setting {
    /// The class of what can be learned here.
    ///
    /// # Errors
    ///
    /// As [`Situated::new`].
    pub fn class(&self, settings: Settings) -> Result<Situated, PriorError> {
        Situated::new(Arc::clone(&self.world), self.prior.clone(), settings)
    }

    /// Whether it shows words as they are, however they go on.
    pub fn is_boundless(&self) -> bool {
        matches!(*self.world, World::Words(_))
    }

    /// A behaviour that tells what was learned from the target; none if they are
    /// one in this setting.
    ///
    /// # Panics
    ///
    /// If the three are over different alphabets.
    pub fn difference(&self, learned: &Dfa, target: &Dfa) -> Option<Word> {
        let differ = self.prior.whole(learned).xor(target);
        let open = differ.and_then(|differ| differ.and(self.prior.open()));
        let open = open.expect("all are over one alphabet");
        self.world.simplest(&open, 1).pop()
    }
}
