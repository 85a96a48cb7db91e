//! What a question is worth: the information about the concept that its answer
//! is expected to bring, for its cost.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::atoms::Table;
use super::entropy;
use crate::belief::{Column, End, LANES, Tally};
use crate::concept::{ConceptClass, Ending};
use crate::learner::exp4::{COMPARISON, MEMBERSHIP};
use crate::learner::{Learner, Question};

/// A question's information in bits, and its cost.
#[derive(Clone, Copy, Debug)]
pub(super) struct Worth {
    pub(super) bits: f64,
    pub(super) cost: f64,
}

impl Worth {
    /// Bits for a unit of cost.
    pub(super) fn rate(self) -> f64 {
        self.bits / self.cost
    }
}

/// What the very same membership query is worth once more, where answers may be
/// wrong: a person may have a reason to err that has not gone away.
const REPEATED: f64 = 0.7;

/// Less information than this is none.
const NOTHING: f64 = 1e-9;

/// A question, and what it is worth.
pub(super) type Best<C> = (
    Question<<C as ConceptClass>::Atom, <C as ConceptClass>::Concept>,
    Worth,
);

/// The arm whose question is worth more for its cost, a membership query where
/// both are worth the same; none if neither arm has a question.
pub(super) fn better<C: ConceptClass>(best: &[Option<Best<C>>; 2]) -> Option<usize> {
    let rate = |arm: usize| best[arm].as_ref().map(|(_, worth)| worth.rate());
    match (rate(MEMBERSHIP), rate(COMPARISON)) {
        (Some(judging), Some(comparing)) if !is_more(comparing, judging) => Some(MEMBERSHIP),
        (_, Some(_)) => Some(COMPARISON),
        (judging, None) => judging.map(|_| MEMBERSHIP),
    }
}

/// Whether one worth is more than another, and not only by the last digits.
fn is_more(one: f64, other: f64) -> bool {
    one > other * (1.0 + 1e-9)
}

/// By arm, the question that is worth most for its cost, where one is worth
/// something.
pub(super) fn best<C: ConceptClass>(
    learner: &Learner<C>,
    table: &Table<C::Atom>,
    wrong: f64,
) -> [Option<Best<C>>; 2] {
    let config = &learner.config;
    let beats = |best: &Option<Best<C>>, worth: Worth| {
        let known = best.as_ref().map(|(_, worth)| worth.rate());
        worth.bits > NOTHING && known.is_none_or(|known| is_more(worth.rate(), known))
    };
    let [mut membership, mut comparison] = [None, None];
    let accepts: Vec<f64> = (table.ends.iter())
        .map(|ends| mass(ends, &table.weights))
        .collect();
    for (atom, &accept) in table.atoms.iter().zip(&accepts) {
        let mut worth = Worth {
            bits: judgement(accept, wrong),
            cost: config.membership_cost,
        };
        if learner.evidence.was_judged(atom) {
            worth.bits *= REPEATED;
        }
        if beats(&membership, worth) && learner.evidence.may_judge(atom) {
            membership = Some((Question::Membership { atom: atom.clone() }, worth));
        }
    }
    if !learner.compares() {
        return [membership, None];
    }
    let outlook = Outlook::new(table, wrong);
    let mut pairs = rough_looks(table, &outlook, &accepts);
    let may_ask = |pair: &Pair| {
        let (first, second) = (&table.atoms[pair.first], &table.atoms[pair.second]);
        learner.evidence.may_compare(first, second)
    };
    let taught = 1.0 + HABITS / (1.0 + f64::from(learner.counts().comparison) / FAMILIAR);
    let ends = columns(table, 1);
    let likeliest_first = std::iter::from_fn(|| pairs.pop());
    for pair in likeliest_first.filter(may_ask).take(CLOSELY) {
        let bits = outlook.bits(&ends[pair.first], &ends[pair.second]);
        let worth = Worth {
            bits: taught * f64::from(bits),
            cost: config.comparison_cost,
        };
        if beats(&comparison, worth) {
            let [first, second] = [pair.first, pair.second].map(|atom| table.atoms[atom].clone());
            comparison = Some((Question::Comparison { first, second }, worth));
        }
    }
    [membership, comparison]
}

/// A comparison also tells how this teacher compares, which makes later ones tell
/// more: to the first one this adds so many times what it tells of the concept,
/// and to one after this many others half as much.
const HABITS: f64 = 1.0;
const FAMILIAR: f64 = 3.3;

/// The concepts by which pairs are looked at first, and the pairs that are
/// looked at more closely then.
const ROUGHLY: usize = 48;
const CLOSELY: usize = 256;

/// The places of two atoms in the table, and the bits that comparing them seems to
/// bring.
struct Pair {
    bits: f32,
    first: usize,
    second: usize,
}

/// What seems to bring more comes later; of the same, what comes first in the table.
impl Ord for Pair {
    fn cmp(&self, other: &Self) -> Ordering {
        let place = |pair: &Self| (pair.second, pair.first);
        let bits = self.bits.total_cmp(&other.bits);
        bits.then_with(|| place(other).cmp(&place(self)))
    }
}

impl PartialOrd for Pair {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Pair {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Pair {}

/// All pairs of atoms whose comparison could tell something, by a few of the
/// concepts.
fn rough_looks<A>(table: &Table<A>, outlook: &Outlook, accepts: &[f64]) -> BinaryHeap<Pair> {
    let stride = table.weights.len().div_ceil(ROUGHLY);
    let rough = outlook.every(stride);
    let ends = columns(table, stride);
    // Labels that are sure on both sides cannot be told apart.
    let open: Vec<bool> = (accepts.iter())
        .map(|&accept| accept > NOTHING && accept < 1.0 - NOTHING)
        .collect();
    let mut pairs = Vec::with_capacity(ends.len() * ends.len() / 2);
    for second in 0..ends.len() {
        for first in 0..second {
            if open[first] || open[second] {
                let bits = rough.bits(&ends[first], &ends[second]);
                pairs.push(Pair {
                    bits,
                    first,
                    second,
                });
            }
        }
    }
    pairs.into()
}

/// How every atom ends in every `stride`-th concept.
fn columns<A>(table: &Table<A>, stride: usize) -> Vec<Column> {
    let column = |ends: &Vec<End>| ends.iter().copied().step_by(stride).collect();
    table.ends.iter().map(column).collect()
}

/// What the concepts expect of comparisons.
struct Outlook {
    /// By concept and by the ending of two atoms: the chances of the four
    /// answers and what these leave open in bits, times the concept's chance.
    /// Eight numbers fill a register.
    parts: Vec<[[f32; 8]; Ending::ALL.len()]>,
}

impl Outlook {
    fn new<A>(table: &Table<A>, wrong: f64) -> Self {
        let part = |(tally, &weight): (&Tally, &f64)| {
            Ending::ALL.map(|ending| {
                let odds = tally.odds(ending, wrong);
                let mut part = [0.0; 8];
                for (part, chance) in part.iter_mut().zip(odds) {
                    *part = (chance * weight) as f32;
                }
                part[4] = (entropy(&odds) * weight) as f32;
                part[5] = weight as f32;
                part
            })
        };
        Self {
            parts: table.tallies.iter().zip(&table.weights).map(part).collect(),
        }
    }

    /// The same by every `stride`-th concept.
    fn every(&self, stride: usize) -> Self {
        Self {
            parts: self.parts.iter().copied().step_by(stride).collect(),
        }
    }

    /// The bits about the concept that the answer to a comparison of atoms that end
    /// like this is expected to bring.
    fn bits(&self, first: &Column, second: &Column) -> f32 {
        let mut sums = [0.0_f32; 8];
        for (endings, parts) in first.endings(second).zip(self.parts.chunks(LANES)) {
            for (part, ending) in parts.iter().zip(endings) {
                for (sum, part) in sums.iter_mut().zip(&part[ending as usize]) {
                    *sum += part;
                }
            }
        }
        let all = sums[5].max(f32::MIN_POSITIVE);
        let entropy: f32 = (sums[..4].iter())
            .map(|sum| sum / all)
            .filter(|chance| *chance > 0.0)
            .map(|chance| -chance * chance.log2())
            .sum();
        entropy - sums[4] / all
    }
}

/// The bits that an answer which is wrong at the rate `wrong` tells of an atom
/// that is accepted with this chance.
fn judgement(accept: f64, wrong: f64) -> f64 {
    let heard = accept * (1.0 - wrong) + (1.0 - accept) * wrong;
    entropy(&[heard, 1.0 - heard]) - entropy(&[wrong, 1.0 - wrong])
}

fn mass(ends: &[End], weights: &[f64]) -> f64 {
    (ends.iter().zip(weights))
        .filter(|(end, _)| end.is_inside())
        .map(|(_, weight)| weight)
        .sum()
}
