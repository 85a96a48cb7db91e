//! How teachers reply, whoever they are.

use memrep::concept::{ConceptClass, FiniteAtom, FiniteClass, FiniteConcept};
use memrep::evidence::Comparison;
use memrep::learner::{Question, Reply};
use memrep::oracle::Teacher;

use crate::brute::Relation;

/// What this teacher replies to the question.
pub(crate) fn reply<T: Teacher>(
    teacher: &mut T,
    question: &Question<T::Atom, T::Concept>,
) -> Reply<T::Atom> {
    match question {
        Question::Membership { atom } if teacher.membership(atom) => Reply::Accept,
        Question::Membership { .. } => Reply::Reject,
        Question::Comparison { first, second } => {
            Reply::Compared(teacher.comparison(first, second))
        }
        Question::Equivalence { hypothesis } => match teacher.counterexample(hypothesis) {
            Some((atom, label)) => Reply::Counterexample { atom, label },
            None => Reply::Correct,
        },
    }
}

/// A teacher of a concept in a table, whose counterexamples are the simplest.
pub(crate) struct TableTeacher<'a, O> {
    pub(crate) class: &'a FiniteClass,
    pub(crate) target: FiniteConcept,
    /// Compares two atoms.
    pub(crate) order: O,
}

impl<'a> TableTeacher<'a, ()> {
    /// One who answers under this order.
    pub(crate) fn new(
        class: &'a FiniteClass,
        target: FiniteConcept,
        order: Relation,
    ) -> TableTeacher<'a, impl Fn(FiniteAtom, FiniteAtom) -> Comparison> {
        TableTeacher {
            class,
            target,
            order: move |first, second| order.compare(first, second),
        }
    }
}

impl<O: Fn(FiniteAtom, FiniteAtom) -> Comparison> Teacher for TableTeacher<'_, O> {
    type Atom = FiniteAtom;
    type Concept = FiniteConcept;

    fn membership(&mut self, atom: &FiniteAtom) -> bool {
        self.class.contains(&self.target, atom)
    }

    fn comparison(&mut self, first: &FiniteAtom, second: &FiniteAtom) -> Comparison {
        (self.order)(*first, *second)
    }

    fn counterexample(&mut self, hypothesis: &FiniteConcept) -> Option<(FiniteAtom, bool)> {
        let label = |atom: &FiniteAtom| self.class.contains(&self.target, atom);
        let wrong = |atom: &FiniteAtom| self.class.contains(hypothesis, atom) != label(atom);
        let atom = self.class.atoms().find(wrong)?;
        Some((atom, label(&atom)))
    }
}
