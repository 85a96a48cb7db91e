//! What of one automaton is otherwise in another: new arrows, arrows in dispute.
//!
//! Every state of the one that is drawn has a *counterpart* in the other: the
//! state to which the other comes by the shortest word that leads to it, the
//! least of several. A state is the *home* of its counterpart if no state before
//! it, breadth-first, has the same one. Then
//!
//! - an arrow differs unless it leads to the home of the state to which the
//!   other goes from the counterpart of where the arrow begins;
//! - a state differs if it is not the home of its counterpart, so that the other
//!   does not tell it apart, or if one of the two accepts and the other does not.
//!
//! Nothing differs exactly if the reachable parts are the same up to the names
//! of states; for minimal automata, which are what is meant here, exactly if
//! they accept the same words.

use std::collections::BTreeSet;

use automata::{Dfa, StateId, Symbol};

use super::order::breadth_first;

/// What is to be seen at once in a picture; [`Marks::default`] is nothing.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Marks {
    new: Difference,
    disputed: Difference,
}

/// Why something is marked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Mark {
    /// It was not so before.
    New,
    /// Another automaton has it otherwise.
    Disputed,
}

impl Mark {
    /// Both, in the order in which they are told.
    pub(super) const ALL: [Self; 2] = [Self::New, Self::Disputed];

    /// The word beside what is marked.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::New => "new",
            Self::Disputed => "in dispute",
        }
    }

    /// The class of what is marked.
    pub(super) fn class(self) -> &'static str {
        match self {
            Self::New => "new",
            Self::Disputed => "disputed",
        }
    }
}

/// Where two automata differ, in the states of the first.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Difference {
    states: BTreeSet<StateId>,
    arrows: BTreeSet<(StateId, Symbol)>,
}

impl Marks {
    /// What is new in `shown` to somebody who has seen `before`.
    ///
    /// # Panics
    ///
    /// Here and below, if the alphabets differ in size.
    pub fn new_since(shown: &Dfa, before: &Dfa) -> Self {
        Self {
            new: Difference::of(shown, before),
            ..Self::default()
        }
    }

    /// What of `one` is otherwise in `other`; for a picture of `other` they
    /// change places.
    pub fn in_dispute(one: &Dfa, other: &Dfa) -> Self {
        Self {
            disputed: Difference::of(one, other),
            ..Self::default()
        }
    }

    /// These and those.
    #[must_use]
    pub fn and(mut self, other: Self) -> Self {
        self.new.join(other.new);
        self.disputed.join(other.disputed);
        self
    }

    /// Whether nothing is marked.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// The marked arrows: the state that is left, and by what.
    pub fn arrows(&self) -> impl Iterator<Item = (StateId, Symbol)> + '_ {
        self.new.arrows.union(&self.disputed.arrows).copied()
    }

    /// The marked states.
    pub fn states(&self) -> impl Iterator<Item = StateId> + '_ {
        self.new.states.union(&self.disputed.states).copied()
    }

    fn part(&self, mark: Mark) -> &Difference {
        match mark {
            Mark::New => &self.new,
            Mark::Disputed => &self.disputed,
        }
    }

    /// Whether this arrow has this mark.
    pub(super) fn has_arrow(&self, mark: Mark, from: StateId, by: Symbol) -> bool {
        self.part(mark).arrows.contains(&(from, by))
    }

    /// Whether this state has this mark.
    pub(super) fn has_state(&self, mark: Mark, state: StateId) -> bool {
        self.part(mark).states.contains(&state)
    }
}

impl Difference {
    fn of(one: &Dfa, other: &Dfa) -> Self {
        assert_eq!(
            one.alphabet().len(),
            other.alphabet().len(),
            "automata over different alphabets cannot be compared"
        );
        let visits = breadth_first(one);
        let mut counterpart = vec![other.start(); one.size()];
        let mut home = vec![None; other.size()];
        for visit in &visits {
            if let Some((from, by)) = visit.by {
                counterpart[visit.state.index()] = other.next(counterpart[from.index()], by);
            }
            home[counterpart[visit.state.index()].index()].get_or_insert(visit.state);
        }
        let mut difference = Self::default();
        for &super::order::Visit { state, .. } in &visits {
            let there = counterpart[state.index()];
            if home[there.index()] != Some(state)
                || one.is_accepting(state) != other.is_accepting(there)
            {
                difference.states.insert(state);
            }
            for symbol in one.alphabet().symbols() {
                let goal = other.next(there, symbol);
                if home[goal.index()] != Some(one.next(state, symbol)) {
                    difference.arrows.insert((state, symbol));
                }
            }
        }
        difference
    }

    fn join(&mut self, other: Self) {
        self.states.extend(other.states);
        self.arrows.extend(other.arrows);
    }
}
