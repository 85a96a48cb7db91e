//! The smallest DFAs consistent with labelled words and preferences.
//!
//! Knows words and facts; it must not know who asks, or why.

mod completion;
mod contradiction;
mod engine;
mod enumerate;
mod grow;
mod growing;
mod growth;
mod identifier;
mod instance;
mod labels;
mod merged;
mod partial;
mod particles;
mod problem;
mod sat;
mod spread;
mod tree;

use automata::{Dfa, StateId, Word};

use self::particles::Step;
use crate::belief::End;
use crate::evidence::AnswerId;
pub use identifier::Identifier;
pub use spread::{Spread, Weighted, Wish};

/// Which engine answers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EngineChoice {
    /// The enumerator where it reaches, `varisat` beyond.
    #[default]
    Auto,
    /// The plain enumerator of canonically numbered DFAs.
    Enumerate,
    /// SAT by `varisat`.
    Varisat,
    /// SAT by `batsat`.
    Batsat,
}

/// How an [`Identifier`] works.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The engine.
    pub engine: EngineChoice,
    /// The largest number of states to consider, at least 1.
    pub max_states: usize,
}

/// Facts that cannot stand together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Contradiction {
    /// A minimal set of answers: without any one of them its rest can stand (with
    /// more states than the bound, unless the bound is the cause).
    /// In ascending order. Empty if the facts known at the start (those without
    /// an answer) are contradictory by themselves.
    pub answers: Vec<AnswerId>,
    /// Why they cannot stand.
    pub cause: Cause,
    /// Whether it is proved that no answer can be left out. If not, the budget
    /// ended on the way; the answers cannot all stand in any case.
    pub minimal: bool,
}

/// Why facts cannot stand together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cause {
    /// A cycle of strict preferences: no preorder at all agrees. It is found by
    /// [`crate::concept::Preorder`]; an identifier, which reads `≺` as Eq. 5.4
    /// does, reports neither this nor [`Self::Equality`].
    Order,
    /// Atoms that are equally good, of which a strict preference sets one above
    /// the other, directly or by way of others.
    Equality,
    /// An accepted word below a rejected one (or a word with two labels): no
    /// language at all is consistent.
    MemRep,
    /// Some automaton is consistent, but none with this many states or fewer.
    States {
        /// The bound, [`Settings::max_states`].
        bound: usize,
    },
}

/// Why there is no automaton to return.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Failure {
    /// The facts contradict each other.
    Contradiction(Contradiction),
    /// The budget ended first.
    OverBudget {
        /// No automaton with fewer states is consistent.
        at_least: usize,
    },
}

/// Different automata of the smallest consistent size.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Minimal and numbered breadth first; each of another language; at least
    /// one. Simplest first: most self-loops, then by the table.
    pub automata: Vec<Dfa>,
    /// Whether there are no others of this size.
    pub complete: bool,
}

/// How words end in an automaton.
#[derive(Clone, Debug)]
pub struct Ends<'a> {
    dfa: &'a Dfa,
    /// By state, whether it is a rejecting sink.
    sunk: Vec<bool>,
    /// By state, how many words of two symbols lead on to acceptance (section 5.3,
    /// "Tomita languages").
    room: Vec<u32>,
}

impl<'a> Ends<'a> {
    /// In this automaton.
    pub fn new(dfa: &'a Dfa) -> Self {
        let next = |state| dfa.alphabet().symbols().map(move |a| dfa.next(state, a));
        let stays = |state| next(state).all(|to| to == state);
        let room = |state| {
            next(state)
                .flat_map(next)
                .filter(|&end| dfa.is_accepting(end))
        };
        Self {
            dfa,
            sunk: (dfa.states())
                .map(|state| !dfa.is_accepting(state) && stays(state))
                .collect(),
            room: dfa
                .states()
                .map(|state| room(state).count() as u32)
                .collect(),
        }
    }

    /// How a word over its alphabet ends.
    pub fn of(&self, word: &Word) -> End {
        let step = |state: StateId, depth: usize| Step {
            depth: depth as u32,
            accepting: self.dfa.is_accepting(state),
            sunk: self.sunk[state.index()],
        };
        let mut state = self.dfa.start();
        let mut progress = step(state, 0).progress(None);
        for (read, symbol) in word.iter().enumerate() {
            state = self.dfa.next(state, symbol);
            progress = step(state, read + 1).progress(Some(progress));
        }
        let inside = self.dfa.is_accepting(state);
        let merit = if inside {
            self.room[state.index()]
        } else {
            progress
        };
        End::new(inside, Some(state.index() as u32), merit)
    }
}

/// How a word ends in an automaton.
pub fn end(dfa: &Dfa, word: &Word) -> End {
    Ends::new(dfa).of(word)
}
