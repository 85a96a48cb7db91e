//! Which answers are to blame where no concept of a class is consistent, found by
//! leaving them out one by one.

use std::hash::Hash;

use super::{Cause, Contradiction, Preorder};
use crate::evidence::{AnswerId, Fact};

/// Why nothing is consistent with all of the facts: answers are dropped one by one
/// as long as nothing is, latest first, so that early answers are blamed last.
/// `satisfiable` tells whether something is consistent with some of the facts; none
/// where that is not known. `bound` is the largest size of the class.
pub(super) fn blame<A: Clone + Ord + Hash>(
    facts: &[(Option<AnswerId>, Fact<A>)],
    bound: usize,
    mut satisfiable: impl FnMut(&[&Fact<A>]) -> Option<bool>,
) -> Contradiction {
    let part = |answers: &[AnswerId]| -> Vec<&Fact<A>> {
        let kept = |answer: &Option<AnswerId>| answer.is_none_or(|a| answers.contains(&a));
        let facts = facts.iter().filter(|(answer, _)| kept(answer));
        facts.map(|(_, fact)| fact).collect()
    };
    let mut answers: Vec<AnswerId> = facts.iter().filter_map(|(answer, _)| *answer).collect();
    answers.sort_unstable();
    answers.dedup();
    let mut minimal = true;
    for index in (0..answers.len()).rev() {
        let mut rest = answers.clone();
        rest.remove(index);
        match satisfiable(&part(&rest)) {
            Some(true) => {}
            Some(false) => answers = rest,
            None => minimal = false,
        }
    }
    let mut order = Preorder::default();
    for fact in part(&answers) {
        order.add(None, fact);
    }
    Contradiction {
        cause: if order.misplaces_membership() {
            Cause::MemRep
        } else {
            Cause::States { bound }
        },
        answers,
        minimal,
    }
}
