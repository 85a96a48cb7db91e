//! What the two kinds of partial automata have in common, so that one walk goes
//! through either.

use super::completion::Leaf;
use super::instance::Instance;
use super::merged::{self, Merged};
use super::partial::{self, Partial};

/// A partial automaton that grows edge by edge and can be undone.
pub(crate) trait Growing<'a> {
    /// A point to which it can be undone.
    type Mark: Copy;

    /// The automaton of the start state alone, that may grow to `limit` states.
    fn start(instance: &'a Instance, limit: usize) -> Self;

    /// The present point.
    fn mark(&self) -> Self::Mark;

    /// Forgets everything since `mark`.
    fn undo(&mut self, mark: Self::Mark);

    /// The edge to define next, with the states it may lead to appended to
    /// `targets`, perhaps none. None if there is no edge to define.
    fn choose(&mut self, targets: &mut Vec<u32>) -> Option<u32>;

    /// Defines the edge; `false` if a fact is violated, and then it must be
    /// undone.
    fn define(&mut self, edge: u32, target: u32) -> bool;

    /// The units of work since the last call, at least 1.
    fn take_work(&mut self) -> u64;

    /// What this stands for when no edge is to be defined.
    fn leaf(&self) -> Leaf;
}

impl<'a> Growing<'a> for Partial<'a> {
    type Mark = partial::Mark;

    fn start(instance: &'a Instance, limit: usize) -> Self {
        Self::new(instance, limit)
    }

    fn mark(&self) -> Self::Mark {
        self.mark()
    }

    fn undo(&mut self, mark: Self::Mark) {
        self.undo(mark);
    }

    fn choose(&mut self, targets: &mut Vec<u32>) -> Option<u32> {
        let edge = self.tightest()?;
        let used = self.used();
        targets.extend((0..used).filter(|&target| self.may_lead(edge, target)));
        if used < self.limit() {
            targets.push(used);
        }
        Some(edge)
    }

    fn define(&mut self, edge: u32, target: u32) -> bool {
        self.define(edge, target)
    }

    fn take_work(&mut self) -> u64 {
        1
    }

    fn leaf(&self) -> Leaf {
        Leaf::new(
            self.delta().into(),
            (0..self.used()).map(|state| self.output(state)).collect(),
            self.open_implications().collect(),
        )
    }
}

impl<'a> Growing<'a> for Merged<'a> {
    type Mark = merged::Mark;

    fn start(instance: &'a Instance, limit: usize) -> Self {
        Self::new(instance, limit)
    }

    fn mark(&self) -> Self::Mark {
        self.mark()
    }

    fn undo(&mut self, mark: Self::Mark) {
        self.undo(mark);
    }

    fn choose(&mut self, targets: &mut Vec<u32>) -> Option<u32> {
        self.tightest(targets)
    }

    fn define(&mut self, edge: u32, target: u32) -> bool {
        self.define(edge, target)
    }

    fn take_work(&mut self) -> u64 {
        self.take_work()
    }

    fn leaf(&self) -> Leaf {
        Leaf::new(
            self.delta().into(),
            (0..self.used()).map(|state| self.output(state)).collect(),
            self.open_implications(),
        )
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use automata::{Alphabet, Dfa, Symbol, Word};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::super::completion::canonical;
    use super::super::engine::{Engine, Query, Verdict};
    use super::super::enumerate::Enumerator;
    use super::super::problem::{FactId, Problem};
    use super::*;
    use crate::evidence::{Budget, Fact};

    fn word(rng: &mut ChaCha8Rng, symbols: usize, longest: usize) -> Word {
        let length = rng.random_range(0..=longest);
        (0..length)
            .map(|_| Symbol::new(rng.random_range(0..symbols)))
            .collect()
    }

    fn dfa(rng: &mut ChaCha8Rng, symbols: usize, states: usize) -> Dfa {
        let rows: Vec<Vec<usize>> = (0..states)
            .map(|_| (0..symbols).map(|_| rng.random_range(0..states)).collect())
            .collect();
        let accepting = (0..states).map(|_| rng.random()).collect();
        let names = (0..symbols).map(|symbol| format!("s{symbol}"));
        Dfa::new(Alphabet::new(names).unwrap(), 0, accepting, &rows).unwrap()
    }

    /// Facts that are true of the automaton, `preferences` of them no labels.
    fn problem(rng: &mut ChaCha8Rng, dfa: &Dfa, labels: usize, preferences: usize) -> Problem {
        let symbols = dfa.alphabet().len();
        let mut problem = Problem::new(dfa.alphabet().clone());
        for _ in 0..labels {
            let atom = word(rng, symbols, 6);
            let accepted = dfa.accepts(&atom);
            problem.add(None, &Fact::Label { atom, accepted });
        }
        for _ in 0..preferences {
            let (first, second) = (word(rng, symbols, 6), word(rng, symbols, 6));
            let fact = match (dfa.accepts(&first), dfa.accepts(&second)) {
                (one, two) if one == two && rng.random() => Fact::Equal { first, second },
                (true, false) => Fact::Below {
                    worse: second,
                    better: first,
                },
                _ => Fact::Below {
                    worse: first,
                    better: second,
                },
            };
            problem.add(None, &fact);
        }
        problem
    }

    fn facts(problem: &Problem) -> Vec<FactId> {
        (0..problem.facts().len() as u32).map(FactId).collect()
    }

    /// Everything below the present point, as tables numbered breadth first.
    fn list<'a, G: Growing<'a>>(
        partial: &mut G,
        alphabet: &Alphabet,
        found: &mut BTreeSet<Vec<usize>>,
        leaves: &mut usize,
    ) {
        let mut targets = Vec::new();
        let Some(edge) = partial.choose(&mut targets) else {
            let mut tables = Vec::new();
            partial.leaf().all(&mut tables);
            for table in tables {
                let dfa = canonical(alphabet, &table);
                let row = |state| {
                    let nexts = alphabet.symbols().map(|symbol| dfa.next(state, symbol));
                    let accepting = usize::from(dfa.is_accepting(state));
                    nexts
                        .map(|next| next.index())
                        .collect::<Vec<_>>()
                        .into_iter()
                        .chain([accepting])
                };
                found.insert(dfa.states().flat_map(row).collect());
            }
            *leaves += 1;
            return;
        };
        for target in targets {
            let mark = partial.mark();
            if partial.define(edge, target) {
                list(partial, alphabet, found, leaves);
            }
            partial.undo(mark);
        }
    }

    #[test]
    fn placing_and_folding_reach_the_same_automata() {
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let mut most = 0;
        for round in 0..150 {
            let symbols = rng.random_range(1..=3);
            let target = dfa(&mut rng, symbols, 4);
            let labels = rng.random_range(0..14);
            let preferences = if round % 4 == 0 {
                0
            } else {
                rng.random_range(0..10)
            };
            let problem = problem(&mut rng, &target, labels, preferences);
            let instance = Instance::new(&problem, &facts(&problem)).unwrap();
            // Without facts the many edges would be free.
            let largest = if labels + preferences < 8 || symbols == 3 {
                2
            } else {
                4
            };
            for states in 1..=largest {
                let (mut placed, mut folded) = (BTreeSet::new(), BTreeSet::new());
                let (mut one, mut two) = (0, 0);
                let alphabet = problem.alphabet();
                list(
                    &mut Partial::start(&instance, states),
                    alphabet,
                    &mut placed,
                    &mut one,
                );
                list(
                    &mut Merged::start(&instance, states),
                    alphabet,
                    &mut folded,
                    &mut two,
                );
                assert_eq!(placed, folded, "{states} states");
                assert_eq!(one, two, "every leaf is reached once");
                most = most.max(placed.len());
            }
        }
        assert!(most > 100, "the version spaces were all tiny: {most}");
    }

    /// What used to take minutes: 20 states from 500 words. Peers take 5 to 23
    /// seconds on such samples.
    #[test]
    fn a_dense_sample_of_twenty_states_takes_little_work() {
        for seed in 0..3 {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let target = dfa(&mut rng, 2, 20);
            let mut problem = Problem::new(target.alphabet().clone());
            let mut seen = BTreeSet::new();
            while seen.len() < 500 {
                let atom = word(&mut rng, 2, 14);
                if seen.insert(atom.clone()) {
                    let accepted = target.accepts(&atom);
                    problem.add(None, &Fact::Label { atom, accepted });
                }
            }
            let standing = facts(&problem);
            let mut budget = Budget::new(300_000);
            let found = (1..=20).find_map(|states| {
                let query = Query {
                    problem: &problem,
                    standing: &standing,
                    states,
                    count: 1,
                    seed: 0,
                };
                match Enumerator.search(&query, &mut budget) {
                    Verdict::Found { automata, .. } => Some(automata),
                    Verdict::None { .. } => None,
                    Verdict::OverBudget => panic!("{states} states take too long"),
                }
            });
            let automata = found.expect("the target has 20 states");
            for word in seen {
                assert_eq!(automata[0].accepts(&word), target.accepts(&word));
            }
        }
    }
}
