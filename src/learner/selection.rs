//! Algorithm 6: two candidate questions that tell two concepts apart.

use super::known::Known;
use crate::concept::ConceptClass;

/// `α`: the number of concepts to be told apart.
pub(super) const CONCEPTS: usize = 2;

/// At most this many atoms are taken from each concept, so that `β = 2α`.
const ATOMS_PER_CONCEPT: usize = 2;

/// `β`: the most atoms that questions are made of.
const ATOMS: usize = ATOMS_PER_CONCEPT * CONCEPTS;

/// A membership query that tells the two concepts apart.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Judge<A> {
    pub(super) atom: A,
    /// The share of the sample that is consistent if the atom is accepted.
    pub(super) accept: f64,
    /// The same if it is rejected.
    pub(super) reject: f64,
}

/// A comparison of which some answer refutes some concept of the sample.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Compare<A> {
    pub(super) left: A,
    pub(super) right: A,
    /// The share of the sample that is consistent if the left is better.
    pub(super) left_better: f64,
    /// The same if the right is.
    pub(super) right_better: f64,
    /// The same if both are equal.
    pub(super) equal: f64,
}

impl<A> Compare<A> {
    /// The same comparison with its atoms in the other order.
    pub(super) fn mirrored(self) -> Self {
        Self {
            left: self.right,
            right: self.left,
            left_better: self.right_better,
            right_better: self.left_better,
            equal: self.equal,
        }
    }
}

/// The candidates of one round; none where nothing of the kind can be asked.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Candidates<A> {
    pub(super) membership: Option<Judge<A>>,
    pub(super) comparison: Option<Compare<A>>,
}

/// An atom of the set `X`, with the concepts that contain it.
struct Column<A> {
    atom: A,
    /// For every concept of the sample.
    contained: Vec<bool>,
}

/// The best questions about the concepts `psi`, given by their places in the
/// sample.
///
/// The set `X` holds up to two atoms that only the one concept contains and up
/// to two that only the other does, the simplest ones, so that it separates the
/// concepts whenever anything does. Where it has room (one concept may contain
/// the other), it is filled with the simplest atom accepted so far and the
/// simplest rejected: two atoms on the same side of a difference say nothing
/// about the two concepts, but one of them beside an atom whose label is known
/// does.
pub(super) fn select<C: ConceptClass>(
    class: &C,
    known: &Known<C::Atom>,
    sample: &[C::Concept],
    psi: [usize; CONCEPTS],
    comparisons: bool,
) -> Candidates<C::Atom> {
    let [left, right] = psi.map(|place| &sample[place]);
    let mut atoms = own_atoms(class, known, left, right);
    atoms.extend(own_atoms(class, known, right, left));
    if comparisons {
        for accepted in [true, false] {
            if atoms.len() < ATOMS {
                let fits = |anchor: &C::Atom| {
                    let comparable = |atom| known.may_compare(atom, anchor);
                    !atoms.contains(anchor) && atoms.iter().any(comparable)
                };
                let anchor = known.order.simplest_labelled(accepted, fits).cloned();
                atoms.extend(anchor);
            }
        }
    }
    let columns: Vec<Column<C::Atom>> = atoms
        .into_iter()
        .map(|atom| Column {
            contained: sample.iter().map(|c| class.contains(c, &atom)).collect(),
            atom,
        })
        .collect();
    Candidates {
        membership: best_membership(known, &columns, psi),
        comparison: comparisons
            .then(|| best_comparison(known, &columns, psi))
            .flatten(),
    }
}

/// The simplest atoms that `inside` contains and `outside` does not; those that
/// the teacher would not judge only if there are no others.
fn own_atoms<C: ConceptClass>(
    class: &C,
    known: &Known<C::Atom>,
    inside: &C::Concept,
    outside: &C::Concept,
) -> Vec<C::Atom> {
    let mut atoms = class.witnesses(inside, outside, ATOMS_PER_CONCEPT + known.skips());
    atoms.sort_by_key(|atom| !known.may_judge(atom));
    atoms.truncate(ATOMS_PER_CONCEPT);
    atoms
}

/// The query after whose worse answer the fewest concepts of `psi` are left.
///
/// Every atom that separates two concepts leaves one, so ties are the rule; they
/// go to the atom that leaves less of the sample (which is what the loss counts),
/// then to the simpler.
fn best_membership<A: Clone + Ord + std::hash::Hash>(
    known: &Known<A>,
    columns: &[Column<A>],
    psi: [usize; CONCEPTS],
) -> Option<Judge<A>> {
    columns
        .iter()
        .filter(|column| {
            column.contained[psi[0]] != column.contained[psi[1]] && known.may_judge(&column.atom)
        })
        .min_by_key(|column| (worse_label(column), &column.atom))
        .map(|column| {
            let accept = share(&column.contained, |contained| *contained);
            Judge {
                atom: column.atom.clone(),
                accept,
                reject: 1.0 - accept,
            }
        })
}

/// The number of concepts left by the less fortunate of the two labels.
fn worse_label<A>(column: &Column<A>) -> usize {
    let inside = column.contained.iter().filter(|c| **c).count();
    inside.max(column.contained.len() - inside)
}

/// The comparison after whose worst answer, incomparability aside, the fewest
/// concepts of `psi` are left; ties go to the worst answer's share of the sample,
/// then the average share, then the simpler atoms.
fn best_comparison<A: Clone + Ord + std::hash::Hash>(
    known: &Known<A>,
    columns: &[Column<A>],
    psi: [usize; CONCEPTS],
) -> Option<Compare<A>> {
    let pairs = columns.iter().enumerate().flat_map(|(place, left)| {
        let rest = &columns[place + 1..];
        rest.iter().map(move |right| (left, right))
    });
    pairs
        .filter(|(left, right)| known.may_compare(&left.atom, &right.atom))
        .filter_map(|(left, right)| {
            let all = left.contained.len();
            let of_sample = outcomes(left, right, 0..all);
            let useful = of_sample.iter().any(|&count| count < all);
            useful.then(|| {
                let of_psi = outcomes(left, right, psi.into_iter());
                let worst = |counts: [usize; 3]| counts.into_iter().max();
                let rank = (
                    worst(of_psi),
                    worst(of_sample),
                    of_sample.iter().sum::<usize>(),
                );
                let simplicity = (&left.atom).max(&right.atom);
                ((rank, simplicity, &left.atom), left, right, of_sample)
            })
        })
        .min_by(|(one, ..), (other, ..)| one.cmp(other))
        .map(|(_, left, right, counts)| {
            let all = left.contained.len() as f64;
            let [left_better, right_better, equal] = counts.map(|count| count as f64 / all);
            Compare {
                left: left.atom.clone(),
                right: right.atom.clone(),
                left_better,
                right_better,
                equal,
            }
        })
}

/// How many of these concepts stay consistent if the left atom is better, if the
/// right is, and if both are equal (Definition 5.1.1).
fn outcomes<A>(
    left: &Column<A>,
    right: &Column<A>,
    concepts: impl Iterator<Item = usize>,
) -> [usize; 3] {
    let mut counts = [0; 3];
    for concept in concepts {
        let (left, right) = (left.contained[concept], right.contained[concept]);
        counts[0] += usize::from(right <= left);
        counts[1] += usize::from(left <= right);
        counts[2] += usize::from(left == right);
    }
    counts
}

fn share<T>(items: &[T], holds: impl Fn(&T) -> bool) -> f64 {
    items.iter().filter(|item| holds(item)).count() as f64 / items.len() as f64
}
