//! What need not be asked: what the evidence implies, and what was skipped.

use std::collections::BTreeSet;
use std::hash::Hash;

use super::Question;
use crate::concept::Preorder;
use crate::evidence::{AnswerId, Fact};

/// The order known so far and the questions that nobody wants to answer.
#[derive(Clone, Debug)]
pub(super) struct Known<A> {
    /// Everything that answers imply.
    pub(super) order: Preorder<A>,
    skipped: BTreeSet<A>,
    /// Each pair with its lesser atom first.
    skipped_pairs: BTreeSet<(A, A)>,
    /// Atoms that were judged and may have been misjudged.
    judged: BTreeSet<A>,
}

impl<A> Default for Known<A> {
    fn default() -> Self {
        Self {
            order: Preorder::default(),
            skipped: BTreeSet::new(),
            skipped_pairs: BTreeSet::new(),
            judged: BTreeSet::new(),
        }
    }
}

impl<A: Clone + Ord + Hash> Known<A> {
    /// Takes note of a fact.
    pub(super) fn add(&mut self, answer: Option<AnswerId>, fact: &Fact<A>) {
        self.order.add(answer, fact);
    }

    /// The teacher will not judge this atom.
    pub(super) fn skip(&mut self, atom: A) {
        self.skipped.insert(atom);
    }

    /// The teacher will not compare these two, in either order.
    pub(super) fn skip_pair(&mut self, first: A, second: A) {
        self.skipped_pairs.insert(sorted(first, second));
    }

    /// The question was answered, and the answer may be wrong. A comparison is
    /// not repeated: were it the truth about two atoms of one label, the same
    /// answer once more would say nothing.
    pub(super) fn ask<C>(&mut self, question: &Question<A, C>) {
        match question {
            Question::Membership { atom } => {
                self.judged.insert(atom.clone());
            }
            Question::Comparison { first, second } => {
                self.skip_pair(first.clone(), second.clone());
            }
            Question::Equivalence { .. } => {}
        }
    }

    /// Whether the very same membership query was answered before.
    pub(super) fn was_judged(&self, atom: &A) -> bool {
        self.judged.contains(atom)
    }

    /// The number of atoms that the teacher will not judge.
    pub(super) fn skips(&self) -> usize {
        self.skipped.len()
    }

    /// Whether a membership query on this atom may teach something.
    pub(super) fn may_judge(&self, atom: &A) -> bool {
        !self.skipped.contains(atom) && self.order.label(atom).is_none()
    }

    /// Whether a comparison of these two may teach something. Where the labels of
    /// both are known, every answer that does not contradict them says nothing
    /// about any label.
    pub(super) fn may_compare(&self, first: &A, second: &A) -> bool {
        let labelled = |atom| self.order.label(atom).is_some();
        self.order.comparison(first, second).is_none()
            && !(labelled(first) && labelled(second))
            && !self
                .skipped_pairs
                .contains(&sorted(first.clone(), second.clone()))
    }
}

fn sorted<A: Ord>(first: A, second: A) -> (A, A) {
    if first <= second {
        (first, second)
    } else {
        (second, first)
    }
}
