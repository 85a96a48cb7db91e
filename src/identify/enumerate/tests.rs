//! The two ways to grow automata against each other, at every size.

use std::collections::BTreeSet;

use automata::{Alphabet, Dfa, Symbol, Word};

use super::*;
use crate::evidence::Fact;
use crate::identify::problem::{FactId, Problem};

/// As many automata as are compared one by one.
const ALL: usize = 200;

struct Draw(ChaCha8Rng);

impl Draw {
    fn number(&mut self, below: usize) -> usize {
        self.0.random_range(0..below as u32) as usize
    }

    fn word(&mut self, symbols: usize, longest: usize) -> Word {
        let length = self.number(longest + 1);
        let symbol = |_| Symbol::new(self.number(symbols));
        (0..length).map(symbol).collect()
    }

    /// Labels, preferences and equalities that hold of a random automaton.
    fn problem(&mut self, symbols: usize, states: usize, facts: usize) -> Problem {
        let alphabet = Alphabet::new((0..symbols).map(|i| i.to_string())).expect("good names");
        let row = |draw: &mut Self| (0..symbols).map(|_| draw.number(states)).collect();
        let delta: Vec<Vec<usize>> = (0..states).map(|_| row(self)).collect();
        let accepting = (0..states).map(|_| self.0.random()).collect();
        let target = Dfa::new(alphabet.clone(), 0, accepting, &delta).expect("a complete table");
        let mut problem = Problem::new(alphabet);
        for _ in 0..facts {
            let (one, other) = (self.word(symbols, 7), self.word(symbols, 7));
            let fact = match (self.number(6), target.accepts(&one), target.accepts(&other)) {
                (0..3, accepted, _) => Fact::Label {
                    atom: one,
                    accepted,
                },
                (3, same, too) if same == too => Fact::Equal {
                    first: one,
                    second: other,
                },
                (_, true, false) => Fact::Below {
                    worse: other,
                    better: one,
                },
                _ => Fact::Below {
                    worse: one,
                    better: other,
                },
            };
            problem.add(None, &fact);
        }
        problem
    }
}

/// All automata of this size if they are few, and whether they are.
fn list<'a, G: Growing<'a>>(instance: &'a Instance, query: &Query<'_>) -> (BTreeSet<Table>, bool) {
    match search::<G>(instance, query, &mut Budget::new(3_000_000)) {
        Verdict::Found { automata, complete } => {
            let tables: BTreeSet<Table> = automata.iter().map(table).collect();
            assert_eq!(tables.len(), automata.len(), "an automaton came twice");
            (tables, complete)
        }
        Verdict::None { .. } => (BTreeSet::new(), true),
        Verdict::OverBudget => panic!("such an instance takes less"),
    }
}

fn table(dfa: &Dfa) -> Table {
    let edges = (dfa.states()).flat_map(|state| {
        (dfa.alphabet().symbols()).map(move |symbol| dfa.next(state, symbol).index() as u32)
    });
    let outputs = dfa.states().map(|state| dfa.is_accepting(state));
    (edges.collect(), outputs.collect())
}

#[test]
fn placing_words_and_folding_the_tree_find_the_same_automata() {
    let mut draw = Draw(ChaCha8Rng::seed_from_u64(12));
    let (mut few, mut with_outputs_to_choose) = (0, 0);
    for number in 0..1_500 {
        let symbols = 1 + draw.number(3);
        let states = 1 + draw.number(6);
        let most = if draw.number(2) == 0 { 15 } else { 70 };
        let facts = draw.number(most);
        let problem = draw.problem(symbols, states, facts);
        let standing: Vec<FactId> = (0..problem.facts().len() as u32).map(FactId).collect();
        let instance = Instance::new(&problem, &standing).expect("it holds of the target");
        for states in 1..=states {
            let query = Query {
                problem: &problem,
                standing: &standing,
                states,
                count: ALL,
                seed: number,
            };
            let (placed, all) = list::<Partial<'_>>(&instance, &query);
            let (folded, all_folded) = list::<Merged<'_>>(&instance, &query);
            assert_eq!(all, all_folded, "instance {number}, {states} states");
            if all {
                assert_eq!(placed, folded, "instance {number}, {states} states");
            } else {
                assert_eq!((placed.len(), folded.len()), (ALL, ALL));
            }
            if !placed.is_empty() {
                few += usize::from(all);
                let outputs: BTreeSet<_> = placed.iter().map(|table| &table.1).collect();
                with_outputs_to_choose += usize::from(outputs.len() > 1);
                break;
            }
        }
    }
    assert!(
        few > 500 && with_outputs_to_choose > 100,
        "{few} {with_outputs_to_choose}"
    );
}
