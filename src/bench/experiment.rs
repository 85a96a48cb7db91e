//! The experiments: which targets, which teacher, how many runs.

use super::case::Case;
use super::contender::{CONTENDERS, Contender};
use super::subject::Subject;
use crate::oracle::{Counterexamples, MonotoneTarget, Order, Shape, Target, TargetError};

/// An experiment of the suite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Experiment {
    /// Tomita's seven languages: Tables 5.1 to 5.3 and Fig. 5.4.
    Tomita,
    /// Languages over one letter: Table 5.4.
    Modulo,
    /// Tomita 4 generalised: Table 5.5.
    Zeros,
    /// The robot's task: Fig. 5.3, left.
    Robot,
    /// Wrong answers: Fig. 5.5.
    Noise,
    /// Targets drawn at random.
    Random,
    /// Targets drawn at random that look like tasks.
    Tasks,
    /// Monotone predicates: Fig. 5.3, right.
    Monotone,
}

/// The costs of a membership query where a comparison costs 1; none: comparisons
/// are never asked.
pub const COSTS: [Option<u32>; 5] = [Some(1), Some(2), Some(4), Some(8), None];

/// The grid of [`Experiment::Monotone`].
const DIMENSIONS: usize = 2;
const POINTS: usize = 10;

/// The cost of a membership query in [`Experiment::Noise`].
const NOISE_COST: u32 = 4;

/// The shares of wrong answers in [`Experiment::Noise`], in percent.
const ERRORS: [u32; 5] = [0, 2, 5, 10, 20];
const QUICK_ERRORS: [u32; 2] = [0, 5];

impl Experiment {
    /// Its name, and that of its files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tomita => "tomita",
            Self::Modulo => "modulo",
            Self::Zeros => "zeros",
            Self::Robot => "robot",
            Self::Noise => "noise",
            Self::Random => "random",
            Self::Tasks => "tasks",
            Self::Monotone => "monotone",
        }
    }

    /// The heading of its page.
    pub fn title(self) -> &'static str {
        match self {
            Self::Tomita => "Tomita's seven languages (Tables 5.1 to 5.3, Fig. 5.4)",
            Self::Modulo => "Lengths divisible by a number (Table 5.4)",
            Self::Zeros => "Tomita's fourth language, generalised (Table 5.5)",
            Self::Robot => "The robot's task (Fig. 5.3, left)",
            Self::Noise => "Wrong answers (Fig. 5.5)",
            Self::Random => "Targets drawn at random",
            Self::Tasks => "Targets drawn at random in the shape of tasks",
            Self::Monotone => "Monotone predicates (Fig. 5.3, right)",
        }
    }

    /// What its targets are, for people.
    pub fn targets_in_words(self) -> &'static str {
        match self {
            Self::Tomita | Self::Noise => {
                "The targets are Tomita's seven languages; of each it is known at the start that it accepts the empty word. The third is the usual five-state language, where the dissertation most likely has the three-state one that is called `tomita:3t` here."
            }
            Self::Modulo => {
                "The targets are the words over one letter whose length is divisible by 5, 10, 20 and 40; that the empty word is accepted is known at the start."
            }
            Self::Zeros => {
                "The targets are the words without a run of more than 1, 2, 3 and 4 zeros; that the empty word is accepted is known at the start."
            }
            Self::Robot => {
                "The target is the task of Fig. 5.2: reach the recharge tile, never touch lava, and after water be dried first. The labels of eleven words are known at the start; in the second and third row also RY (`avoid R` and `reach Y`), so that BBY is learned, and in the third only what a walk of up to 40 steps through a room can show is asked about. That no question there is about a behaviour that is settled or cannot happen was checked in every run."
            }
            Self::Random => {
                "The targets are minimal automata with 3 to 8 states over 2 to 4 letters, with edges and labels drawn evenly; nothing is known at the start. `memrep learn --target random:N` teaches the one of number N."
            }
            Self::Tasks => {
                "The targets are minimal automata with 3 to 8 states over 3 or 4 letters in the shape of tasks: two thirds of the edges stay where they are, and one state is a rejecting sink; nothing is known at the start. `memrep learn --target task:N` teaches the one of number N."
            }
            Self::Monotone => {
                "The targets are parameters drawn evenly from the uniform grid with 10 points per axis in two dimensions; the class has the grids with 1 to 10 points per axis, a coarser one before a finer one, and nothing is known at the start. What is asked about are points, acceptable if they are at most the parameter in both dimensions (Example 9). The dissertation has two dimensions and 100 concepts and does not tell its grids. `memrep learn --target monotone:2:10:N` teaches the one of number N."
            }
        }
    }

    /// Whether its targets are drawn.
    pub fn is_drawn(self) -> bool {
        self == Self::Monotone || self.drawn().is_some()
    }

    /// The shape of its targets, where they are automata that are drawn.
    pub fn drawn(self) -> Option<Shape> {
        match self {
            Self::Random => Some(Shape::Random),
            Self::Tasks => Some(Shape::Task),
            _ => None,
        }
    }

    /// Its targets; the first `drawn` of them where they are drawn.
    ///
    /// # Errors
    ///
    /// If a target cannot be made; no target of the suite does that.
    pub fn targets(self, drawn: u64) -> Result<Vec<Subject>, TargetError> {
        if let Some(shape) = self.drawn() {
            return Ok((0..drawn).map(|n| Target::drawn(shape, n).into()).collect());
        }
        if self == Self::Monotone {
            let draw = |n| MonotoneTarget::draw(DIMENSIONS, POINTS, n).into();
            return Ok((0..drawn).map(draw).collect());
        }
        let (family, numbers) = match self {
            Self::Modulo => ("modulo", &[5, 10, 20, 40][..]),
            Self::Zeros => ("zeros", &[1, 2, 3, 4][..]),
            Self::Robot => {
                let cases = Case::robot()?;
                return Ok(cases.into_iter().map(Subject::from).collect());
            }
            _ => ("tomita", &[1, 2, 3, 4, 5, 6, 7][..]),
        };
        numbers
            .iter()
            .map(|number| Ok(Target::named(&format!("{family}:{number}"))?.into()))
            .collect()
    }

    /// The teacher's preference order, unless another is asked for.
    pub fn order(self) -> Order {
        match self {
            Self::Robot | Self::Monotone => Order::Random,
            _ => Order::Ordered,
        }
    }

    /// Who takes part.
    pub fn contenders(self) -> Vec<&'static Contender> {
        let takes_part = |contender: &&Contender| match self {
            Self::Noise => contender.noisy,
            _ => contender.clean,
        };
        CONTENDERS.iter().filter(takes_part).collect()
    }

    /// The costs of a membership query.
    pub fn costs(self) -> Vec<Option<u32>> {
        match self {
            Self::Noise => vec![Some(NOISE_COST)],
            _ => COSTS.to_vec(),
        }
    }

    /// The shares of wrong answers, in percent.
    pub fn errors(self, quick: bool) -> Vec<u32> {
        match self {
            Self::Noise if quick => QUICK_ERRORS.to_vec(),
            Self::Noise => ERRORS.to_vec(),
            _ => vec![0],
        }
    }

    /// The runs of a cell where nothing else is asked for.
    pub fn trials(self, quick: bool) -> u64 {
        match (self, quick) {
            (Self::Random | Self::Tasks | Self::Noise | Self::Monotone, true) => 1,
            (_, true) => 2,
            (Self::Random | Self::Tasks | Self::Monotone, false) => 5,
            (_, false) => 20,
        }
    }

    /// The number of drawn targets where nothing else is asked for.
    pub fn drawn_targets(self, quick: bool) -> u64 {
        match (self, quick) {
            (Self::Monotone, true) => 20,
            (Self::Monotone, false) => 100,
            (_, true) => 3,
            (_, false) => 30,
        }
    }
}

/// An experiment with everything that decides its outcome.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Which experiment.
    pub experiment: Experiment,
    /// The targets.
    pub targets: Vec<Subject>,
    /// Who takes part.
    pub contenders: Vec<&'static Contender>,
    /// The costs of a membership query; none: comparisons are never asked.
    pub costs: Vec<Option<u32>>,
    /// The shares of wrong answers, in percent.
    pub errors: Vec<u32>,
    /// The seed of the first run of a cell; the others follow.
    pub seed: u64,
    /// The runs of a cell.
    pub trials: u64,
    /// The teacher's preference order.
    pub order: Order,
    /// The teacher's counterexamples.
    pub counterexamples: Counterexamples,
}

impl Plan {
    /// The seeds of a cell's runs.
    pub fn seeds(&self) -> impl Iterator<Item = u64> + Clone + use<> {
        let first = self.seed;
        (0..self.trials).map(move |trial| first.wrapping_add(trial))
    }
}
