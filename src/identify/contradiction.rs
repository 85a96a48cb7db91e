//! Minimal sets of answers that cannot stand together.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use automata::Dfa;

use super::labels::Forced;
use super::problem::{Constraint, FactId, Problem};
use crate::evidence::AnswerId;

/// The facts behind a set of answers, and those known from the start.
pub(crate) struct Ledger {
    known: Vec<FactId>,
    answers: BTreeMap<AnswerId, Vec<FactId>>,
}

impl Ledger {
    /// Sorts the standing facts by their answers.
    pub(crate) fn new(problem: &Problem, standing: &[FactId]) -> Self {
        let mut ledger = Self {
            known: Vec::new(),
            answers: BTreeMap::new(),
        };
        for &fact in standing {
            match problem.facts()[fact.index()].answer {
                None => ledger.known.push(fact),
                Some(answer) => ledger.answers.entry(answer).or_default().push(fact),
            }
        }
        ledger
    }

    /// All answers.
    pub(crate) fn answers(&self) -> BTreeSet<AnswerId> {
        self.answers.keys().copied().collect()
    }

    /// The facts known from the start and those of these answers, ascending.
    pub(crate) fn facts(&self, answers: &BTreeSet<AnswerId>) -> Vec<FactId> {
        let mut facts = self.known.clone();
        facts.extend((answers.iter()).flat_map(|answer| self.answers[answer].iter().copied()));
        facts.sort_unstable();
        facts
    }
}

/// A minimal set of answers after which no language at all is consistent; none
/// if there is one.
pub(crate) fn memrep(problem: &Problem, standing: &[FactId]) -> Option<BTreeSet<AnswerId>> {
    if !Forced::new(problem, standing).clash() {
        return None;
    }
    let ledger = Ledger::new(problem, standing);
    // The shortest way leaves little to leave out; but an answer with several
    // facts may still make another needless.
    let mut answers = shortest_way(problem, standing).unwrap_or_else(|| ledger.answers());
    for answer in answers.clone() {
        answers.remove(&answer);
        if !Forced::new(problem, &ledger.facts(&answers)).clash() {
            answers.insert(answer);
        }
    }
    Some(answers)
}

/// The answers on a way along preferences from an accepted word to a rejected
/// one that takes as few facts with an answer as possible.
fn shortest_way(problem: &Problem, standing: &[FactId]) -> Option<BTreeSet<AnswerId>> {
    let size = problem.tree().size();
    let mut above: Vec<Vec<(usize, FactId)>> = vec![Vec::new(); size];
    let cost = |fact: FactId| usize::from(problem.facts()[fact.index()].answer.is_some());
    // The least cost at which a node is known to be accepted, and by which fact
    // from which node.
    let mut reached: Vec<Option<(usize, FactId, Option<usize>)>> = vec![None; size];
    let mut rejected: Vec<Option<FactId>> = vec![None; size];
    let mut queue = VecDeque::new();
    for &fact in standing {
        match problem.facts()[fact.index()].constraint {
            Constraint::Label(node, true) => {
                let node = node.index();
                if reached[node].is_none_or(|(least, ..)| cost(fact) < least) {
                    reached[node] = Some((cost(fact), fact, None));
                }
            }
            Constraint::Label(node, false) => {
                let rejected = &mut rejected[node.index()];
                if rejected.is_none_or(|other| cost(fact) < cost(other)) {
                    *rejected = Some(fact);
                }
            }
            Constraint::AtMost(low, high) => above[low.index()].push((high.index(), fact)),
            Constraint::Same(one, other) => {
                above[one.index()].push((other.index(), fact));
                above[other.index()].push((one.index(), fact));
            }
        }
    }
    // Costs are 0 and 1, so a queue with two ends keeps the order of Dijkstra.
    for (node, start) in reached.iter().enumerate() {
        match start {
            Some((0, ..)) => queue.push_front((0, node)),
            Some((least, ..)) => queue.push_back((*least, node)),
            None => {}
        }
    }
    while let Some((least, node)) = queue.pop_front() {
        if reached[node].is_some_and(|(best, ..)| best < least) {
            continue;
        }
        for &(next, fact) in &above[node] {
            let total = least + cost(fact);
            if reached[next].is_none_or(|(best, ..)| total < best) {
                reached[next] = Some((total, fact, Some(node)));
                if total == least {
                    queue.push_front((total, next));
                } else {
                    queue.push_back((total, next));
                }
            }
        }
    }
    let ends = (0..size).filter_map(|node| {
        let (least, ..) = reached[node]?;
        Some((least + cost(rejected[node]?), node))
    });
    let (_, end) = ends.min()?;
    let mut facts: Vec<FactId> = rejected[end].into_iter().collect();
    let mut at = Some(end);
    while let Some(node) = at {
        let (_, fact, from) = reached[node]?;
        facts.push(fact);
        at = from;
    }
    let answer = |fact: FactId| problem.facts()[fact.index()].answer;
    Some(facts.into_iter().filter_map(answer).collect())
}

/// What a search over a set of facts came to.
pub(crate) enum Finding {
    /// Automata that are consistent with them.
    Consistent(Vec<Dfa>),
    /// None is, and by the engine's word already these facts suffice.
    Contradictory(Vec<FactId>),
    /// The budget ended.
    Unknown,
}

/// Makes a contradictory set of answers smaller until no answer can be left
/// out. `facts` is the contradictory set, `core` what the engine claims to
/// suffice, and `search` tells of any other set whether it is consistent.
///
/// Returns the smallest set that was verified and whether it is minimal, which
/// fails only if a search did.
pub(crate) fn minimise(
    problem: &Problem,
    standing: &[FactId],
    core: &[FactId],
    mut search: impl FnMut(&[FactId]) -> Finding,
) -> (BTreeSet<AnswerId>, bool) {
    let ledger = Ledger::new(problem, standing);
    let mut answers = ledger.answers();
    let mut witnesses: Vec<Dfa> = Vec::new();
    let mut unknown: BTreeSet<AnswerId> = BTreeSet::new();

    // The first reduction is the engine's claim; then blocks of answers, ever
    // smaller, down to single ones.
    let claimed: BTreeSet<AnswerId> = (core.iter())
        .filter_map(|fact| problem.facts()[fact.index()].answer)
        .collect();
    let mut necessary: BTreeSet<AnswerId> = BTreeSet::new();
    let mut attempts: VecDeque<BTreeSet<AnswerId>> = VecDeque::new();
    if claimed.len() < answers.len() {
        attempts.push_back(answers.difference(&claimed).copied().collect());
    }
    attempts.extend(blocks(&answers, answers.len().div_ceil(4)));
    while let Some(block) = attempts.pop_front() {
        let block: BTreeSet<AnswerId> = (block.intersection(&answers).copied())
            .filter(|answer| !necessary.contains(answer))
            .collect();
        if block.is_empty() {
            continue;
        }
        let rest: BTreeSet<AnswerId> = answers.difference(&block).copied().collect();
        let facts = ledger.facts(&rest);
        let finding = if let Some(dfa) = (witnesses.iter()).find(|dfa| agrees(problem, dfa, &facts))
        {
            Finding::Consistent(vec![dfa.clone()])
        } else {
            search(&facts)
        };
        match finding {
            Finding::Contradictory(core) => {
                // Shrinks at once to the engine's smaller claim, if it holds.
                answers = rest;
                let claimed: BTreeSet<AnswerId> = (core.iter())
                    .filter_map(|fact| problem.facts()[fact.index()].answer)
                    .collect();
                let needless: BTreeSet<AnswerId> = answers.difference(&claimed).copied().collect();
                if needless.len() > 1 {
                    attempts.push_front(needless);
                }
            }
            Finding::Consistent(found) => {
                witnesses.extend(found);
                if block.len() == 1 {
                    necessary.extend(block);
                } else {
                    let half = block.len().div_ceil(2);
                    for part in blocks(&block, half).into_iter().rev() {
                        attempts.push_front(part);
                    }
                }
            }
            Finding::Unknown if block.len() == 1 => unknown.extend(block),
            Finding::Unknown => {
                for part in blocks(&block, 1).into_iter().rev() {
                    attempts.push_front(part);
                }
            }
        }
    }
    let minimal = answers.is_disjoint(&unknown);
    (answers, minimal)
}

/// The answers in ascending order, so many in each block.
fn blocks(answers: &BTreeSet<AnswerId>, size: usize) -> Vec<BTreeSet<AnswerId>> {
    let all: Vec<AnswerId> = answers.iter().copied().collect();
    (all.chunks(size.max(1)))
        .map(|block| block.iter().copied().collect())
        .collect()
}

/// Whether an automaton is consistent with facts.
pub(crate) fn agrees(problem: &Problem, dfa: &Dfa, facts: &[FactId]) -> bool {
    let tree = problem.tree();
    let mut states = Vec::with_capacity(tree.size());
    for node in tree.nodes() {
        states.push(match tree.parent(node) {
            None => dfa.start(),
            Some((parent, symbol)) => {
                let before: automata::StateId = states[parent.index()];
                dfa.next(before, symbol)
            }
        });
    }
    let accepts = |node: super::tree::NodeId| dfa.is_accepting(states[node.index()]);
    (facts.iter()).all(|fact| match problem.facts()[fact.index()].constraint {
        Constraint::Label(node, label) => accepts(node) == label,
        Constraint::AtMost(low, high) => !accepts(low) || accepts(high),
        Constraint::Same(one, other) => accepts(one) == accepts(other),
    })
}
