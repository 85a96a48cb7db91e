//! What scripted teachers teach: the languages of the dissertation's chapter 5
//! by name, and any automaton.

use automata::{Alphabet, Dfa, StateId, Word};

use super::drawn::Shape;
use crate::evidence::Fact;

/// A language to be taught, with what a learner is told of it at the start.
#[derive(Clone, Debug)]
pub struct Target {
    name: String,
    dfa: Dfa,
    known: Vec<Fact<Word>>,
}

/// Why a name is no target.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TargetError {
    /// No target is called so.
    #[error(
        "there is no target `{0}`: give tomita:1 to tomita:7, tomita:3t, modulo:K, zeros:N, robot, random:N, task:N, or the path of an automaton file"
    )]
    Unknown(String),
    /// The number after the colon does not fit.
    #[error("target `{name}`: {expected}")]
    Parameter {
        /// The name as given.
        name: String,
        /// What may stand after the colon.
        expected: &'static str,
    },
}

/// The largest parameter of `modulo` and `zeros`; automata that large are far
/// beyond what any learner here reaches.
const LARGEST: usize = 1000;

impl Target {
    /// The target of this name (docs of `memrep learn` list them).
    ///
    /// # Errors
    ///
    /// If there is none.
    pub fn named(name: &str) -> Result<Self, TargetError> {
        let parameter = |expected| TargetError::Parameter {
            name: name.to_owned(),
            expected,
        };
        let (dfa, known) = match name.split_once(':') {
            Some(("tomita", which)) => {
                let dfa =
                    tomita(which).ok_or_else(|| parameter("give a number from 1 to 7, or 3t"))?;
                (dfa, None)
            }
            Some(("modulo", k)) => {
                let k = number(k, 1).ok_or_else(|| parameter("give a number from 1 to 1000"))?;
                (modulo(k), None)
            }
            Some(("zeros", n)) => {
                let n = number(n, 0).ok_or_else(|| parameter("give a number from 0 to 1000"))?;
                (zeros(n), None)
            }
            Some((shape @ ("random" | "task"), n)) => {
                let n = n
                    .parse()
                    .map_err(|_| parameter("give the number of a drawn target, from 0"))?;
                return Ok(Self::drawn(
                    if shape == "task" {
                        Shape::Task
                    } else {
                        Shape::Random
                    },
                    n,
                ));
            }
            None if name == "robot" => {
                let robot = robot();
                let known = robot_known(robot.alphabet());
                (robot, Some(known))
            }
            _ => return Err(TargetError::Unknown(name.to_owned())),
        };
        // All but the robot accept the empty word, and as in the authors' own
        // tests the learner is told so.
        let known = known.unwrap_or_else(|| {
            vec![Fact::Label {
                atom: Word::empty(),
                accepted: dfa.accepts(&Word::empty()),
            }]
        });
        Ok(Self {
            name: name.to_owned(),
            dfa: dfa.minimise(),
            known,
        })
    }

    /// The drawn target of this shape and number, of which nothing is known at
    /// the start.
    pub fn drawn(shape: Shape, number: u64) -> Self {
        let name = match shape {
            Shape::Random => "random",
            Shape::Task => "task",
        };
        Self::automaton(format!("{name}:{number}"), &shape.draw(number))
    }

    /// The language of an automaton, of which nothing is known at the start.
    pub fn automaton(name: impl Into<String>, dfa: &Dfa) -> Self {
        Self {
            name: name.into(),
            dfa: dfa.minimise(),
            known: Vec::new(),
        }
    }

    /// What it is called.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its minimal automaton.
    pub fn dfa(&self) -> &Dfa {
        &self.dfa
    }

    /// What a learner is told at the start.
    pub fn known(&self) -> &[Fact<Word>] {
        &self.known
    }

    /// The same target with this known at the start.
    #[must_use]
    pub fn with_known(self, known: Vec<Fact<Word>>) -> Self {
        Self { known, ..self }
    }

    /// The same target with nothing known at the start.
    #[must_use]
    pub fn without_known(mut self) -> Self {
        self.known.clear();
        self
    }
}

fn number(text: &str, least: usize) -> Option<usize> {
    let number = text.parse().ok()?;
    (least..=LARGEST).contains(&number).then_some(number)
}

/// Tomita's seven languages (Dynamic construction of finite automata from
/// examples using hill-climbing, 1982), and `3t`, which the authors' public code
/// has for the third: there an odd run of 1s followed by any 0 is the end.
fn tomita(which: &str) -> Option<Dfa> {
    let binary = |accepting: &[usize], delta: &[[usize; 2]]| {
        table(&["0", "1"], 0, accepting, delta.iter().map(Vec::from))
    };
    Some(match which {
        "1" => binary(&[0], &[[1, 0], [1, 1]]),
        "2" => binary(&[0], &[[2, 1], [0, 2], [2, 2]]),
        // After an even run of 1s, an odd run, an odd run and then an odd run of
        // 0s, the same with an even run of 0s, and for ever lost.
        "3" => binary(&[0, 1, 3], &[[0, 1], [2, 0], [3, 4], [2, 1], [4, 4]]),
        "3t" => binary(&[0, 1], &[[0, 1], [2, 0], [2, 2]]),
        "4" => zeros(2),
        "5" => binary(&[0], &[[1, 2], [0, 3], [3, 0], [2, 1]]),
        "6" => binary(&[0], &[[2, 1], [0, 2], [1, 0]]),
        "7" => binary(&[0, 1, 2, 3], &[[0, 1], [2, 1], [2, 3], [4, 3], [4, 4]]),
        _ => return None,
    })
}

/// Words over one symbol whose length is divisible by `k`.
fn modulo(k: usize) -> Dfa {
    table(&["a"], 0, &[0], (0..k).map(|state| vec![(state + 1) % k]))
}

/// No run of more than `n` zeros.
fn zeros(n: usize) -> Dfa {
    let accepting: Vec<usize> = (0..=n).collect();
    let lost = n + 1;
    let runs = (0..=n).map(|run| vec![run + 1, 0]);
    table(&["0", "1"], 0, &accepting, runs.chain([vec![lost, lost]]))
}

/// Fig. 5.2: reach the recharge tile, never touch lava, and after water be dried
/// before recharging. States: failed, wet, dry (the start), recharged.
fn robot() -> Dfa {
    let delta = [[0, 0, 0, 0], [0, 0, 1, 2], [0, 3, 1, 2], [0, 3, 1, 3]];
    table(&["R", "Y", "B", "O"], 2, &[3], delta.iter().map(Vec::from))
}

/// The words whose labels the robot's teacher gives at the start.
fn robot_known(alphabet: &Alphabet) -> Vec<Fact<Word>> {
    let accepted = ["Y", "YY", "OY"].map(|word| (word, true));
    let rejected = ["", "R", "RY", "YR", "BR", "RB", "OR", "RO"].map(|word| (word, false));
    accepted
        .into_iter()
        .chain(rejected)
        .map(|(word, accepted)| {
            let symbols = word.chars().map(String::from);
            let atom = alphabet
                .word(symbols)
                .expect("the robot's known words are over its alphabet");
            Fact::Label { atom, accepted }
        })
        .collect()
}

fn table(
    symbols: &[&str],
    start: usize,
    accepting: &[usize],
    delta: impl IntoIterator<Item = Vec<usize>>,
) -> Dfa {
    let alphabet = Alphabet::new(symbols.iter().copied()).expect("the names are in order");
    let delta: Vec<Vec<usize>> = delta.into_iter().collect();
    let accepting = (0..delta.len()).map(|q| accepting.contains(&q)).collect();
    Dfa::new(alphabet, start, accepting, &delta).expect("the tables in this file are complete")
}

/// The state of a minimal automaton from which no word is accepted.
pub(super) fn sink(dfa: &Dfa) -> Option<StateId> {
    let mut states = dfa.states();
    states.find(|&state| {
        let mut symbols = dfa.alphabet().symbols();
        !dfa.is_accepting(state) && symbols.all(|symbol| dfa.next(state, symbol) == state)
    })
}
