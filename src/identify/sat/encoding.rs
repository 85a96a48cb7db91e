//! The formula whose models are the automata of one size that are consistent
//! with facts: the colouring of Heule and Verwer, grown as facts arrive.
//!
//! For `k` states and alphabet `Σ`: `target[i, a, j]`, edge `a` of state `i`
//! leads to `j`; `accepting[i]`; `state[v, i]`, the prefix `v` ends in state
//! `i`; and `output[v]`, the word `v` is accepted, for words that facts speak
//! of. Every fact has a selector: it is demanded when its selector is assumed.
//!
//! States are numbered in the order in which the edges `(0, a), (0, b), …,
//! (1, a), …` first use them, which is the canonical breadth-first numbering of
//! [`Dfa`], and all are reachable: different models are different tables, and
//! at the smallest consistent size different languages.

use automata::{Dfa, Symbol};

use super::solver::{Lit, Model, Solver};
use crate::identify::problem::{Constraint, FactId, Problem};
use crate::identify::tree::NodeId;

/// The formula for one number of states, in a solver of its own.
pub(super) struct Encoding<S> {
    pub(super) solver: S,
    states: usize,
    symbols: usize,
    /// `target[(i * symbols + a) * states + j]`.
    target: Vec<Lit>,
    accepting: Vec<Lit>,
    /// By node: where its `states` literals begin in `state`; none while no
    /// fact has spoken of a word that it begins.
    rows: Vec<Option<usize>>,
    state: Vec<Lit>,
    /// By node.
    output: Vec<Option<Lit>>,
    /// By fact.
    selectors: Vec<Option<Lit>>,
    /// By variable: the fact that it selects.
    selected: Vec<Option<FactId>>,
}

impl<S: Solver> Encoding<S> {
    /// All reachable automata of this size, without a fact.
    pub(super) fn new(solver: S, states: usize, symbols: usize) -> Self {
        let mut encoding = Self {
            solver,
            states,
            symbols,
            target: Vec::new(),
            accepting: Vec::new(),
            rows: Vec::new(),
            state: Vec::new(),
            output: Vec::new(),
            selectors: Vec::new(),
            selected: Vec::new(),
        };
        encoding.target = encoding.new_vars(states * symbols * states);
        encoding.accepting = encoding.new_vars(states);
        for edge in 0..states * symbols {
            let row = encoding.target[edge * states..][..states].to_vec();
            encoding.exactly_one(&row);
        }
        encoding.number_by_first_use();
        encoding
    }

    /// The number of states.
    pub(super) fn states(&self) -> usize {
        self.states
    }

    /// The number of edges; `edge / symbols` is where it starts.
    pub(super) fn edges(&self) -> usize {
        self.states * self.symbols
    }

    /// Edge `edge` leads to state `j`.
    pub(super) fn target(&self, edge: usize, j: usize) -> Lit {
        self.target[edge * self.states + j]
    }

    /// State `i` is accepting.
    pub(super) fn accepting(&self, i: usize) -> Lit {
        self.accepting[i]
    }

    /// The literal whose assumption demands the fact.
    pub(super) fn selector(&mut self, problem: &Problem, fact: FactId) -> Lit {
        if let Some(&Some(selector)) = self.selectors.get(fact.index()) {
            return selector;
        }
        let selector = self.solver.new_var();
        match problem.facts()[fact.index()].constraint {
            Constraint::Label(node, accepted) => {
                let output = self.output(problem, node);
                self.solver.add_clause(&[!selector, output.when(accepted)]);
            }
            Constraint::AtMost(worse, better) => {
                let worse = self.output(problem, worse);
                let better = self.output(problem, better);
                self.solver.add_clause(&[!selector, !worse, better]);
            }
            Constraint::Same(first, second) => {
                let first = self.output(problem, first);
                let second = self.output(problem, second);
                self.solver.add_clause(&[!selector, !first, second]);
                self.solver.add_clause(&[!selector, first, !second]);
            }
        }
        grow(&mut self.selectors, fact.index())[fact.index()] = Some(selector);
        grow(&mut self.selected, selector.index())[selector.index()] = Some(fact);
        selector
    }

    /// The fact that this literal selects, if it does.
    pub(super) fn selected(&self, selector: Lit) -> Option<FactId> {
        self.selected.get(selector.index()).copied().flatten()
    }

    /// The table of a model: where the edges lead, and what accepts.
    pub(super) fn table(&self, model: &Model) -> Option<Table> {
        let edges = (0..self.edges())
            .map(|edge| (0..self.states).position(|j| model.holds(self.target(edge, j))));
        Some(Table {
            targets: edges.collect::<Option<_>>()?,
            accepting: self.accepting.iter().map(|&z| model.holds(z)).collect(),
        })
    }

    fn new_vars(&mut self, count: usize) -> Vec<Lit> {
        (0..count).map(|_| self.solver.new_var()).collect()
    }

    fn exactly_one(&mut self, lits: &[Lit]) {
        self.solver.add_clause(lits);
        for (i, &first) in lits.iter().enumerate() {
            for &second in &lits[i + 1..] {
                self.solver.add_clause(&[!first, !second]);
            }
        }
    }

    /// State `j` is first used before `j + 1` is, and before its own edges.
    fn number_by_first_use(&mut self) {
        let mut used_before: Vec<Option<Lit>> = vec![None; self.states];
        for edge in 0..self.edges() {
            let mut used = used_before.clone();
            for j in 1..self.states {
                // `j` edges are needed to use the states 1 to `j` in turn.
                if edge + 1 < j {
                    let target = self.target(edge, j);
                    self.solver.add_clause(&[!target]);
                    continue;
                }
                // From its own edges on, the state has been used.
                if edge >= j * self.symbols {
                    used[j] = None;
                    continue;
                }
                let target = self.target(edge, j);
                if j > 1 && edge < (j - 1) * self.symbols {
                    match used_before[j - 1] {
                        Some(before) => self.solver.add_clause(&[!target, before]),
                        None => self.solver.add_clause(&[!target]),
                    }
                }
                let now = match used_before[j] {
                    Some(before) => {
                        let now = self.solver.new_var();
                        self.solver.add_clause(&[!before, now]);
                        self.solver.add_clause(&[!target, now]);
                        self.solver.add_clause(&[!now, before, target]);
                        now
                    }
                    None => target,
                };
                used[j] = Some(now);
                if edge + 1 == j * self.symbols {
                    self.solver.add_clause(&[now]);
                }
            }
            used_before = used;
        }
    }

    /// The literals of the node's states, with those of its prefixes.
    fn row(&mut self, problem: &Problem, node: NodeId) -> usize {
        if let Some(&Some(row)) = self.rows.get(node.index()) {
            return row;
        }
        // Prefixes first, without recursion: words may be long.
        let mut path = vec![node];
        let tree = problem.tree();
        while let Some((parent, _)) = tree.parent(path[path.len() - 1]) {
            if self.rows.get(parent.index()).copied().flatten().is_some() {
                break;
            }
            path.push(parent);
        }
        for &node in path.iter().rev() {
            let parent = tree.parent(node).and_then(|(parent, symbol)| {
                Some((self.rows.get(parent.index()).copied().flatten()?, symbol))
            });
            let row = self.new_row(parent);
            grow(&mut self.rows, node.index())[node.index()] = Some(row);
        }
        self.state.len() - self.states
    }

    /// The literals of a node's states, `symbol` after the node of row `parent`.
    fn new_row(&mut self, parent: Option<(usize, Symbol)>) -> usize {
        let row = self.state.len();
        let state = self.new_vars(self.states);
        self.state.extend_from_slice(&state);
        let Some((parent, symbol)) = parent else {
            self.solver.add_clause(&[state[0]]);
            for &other in &state[1..] {
                self.solver.add_clause(&[!other]);
            }
            return row;
        };
        self.exactly_one(&state);
        for i in 0..self.states {
            let before = self.state[parent + i];
            for (j, &after) in state.iter().enumerate() {
                let target = self.target(i * self.symbols + symbol.index(), j);
                self.solver.add_clause(&[!before, !target, after]);
                self.solver.add_clause(&[!before, !after, target]);
            }
        }
        row
    }

    /// The literal that is true when the node's word is accepted.
    fn output(&mut self, problem: &Problem, node: NodeId) -> Lit {
        if let Some(&Some(output)) = self.output.get(node.index()) {
            return output;
        }
        let row = self.row(problem, node);
        let output = self.solver.new_var();
        for i in 0..self.states {
            let (state, accepting) = (self.state[row + i], self.accepting[i]);
            self.solver.add_clause(&[!state, !output, accepting]);
            self.solver.add_clause(&[!state, output, !accepting]);
        }
        grow(&mut self.output, node.index())[node.index()] = Some(output);
        output
    }
}

/// The values that a model gives to edges and states.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Table {
    /// By edge.
    pub(super) targets: Vec<usize>,
    pub(super) accepting: Vec<bool>,
}

impl Table {
    /// The automaton with this table over the problem's alphabet.
    pub(super) fn dfa(&self, problem: &Problem) -> Option<Dfa> {
        let alphabet = problem.alphabet();
        let rows: Vec<Vec<usize>> = self
            .targets
            .chunks(alphabet.len())
            .map(<[usize]>::to_vec)
            .collect();
        Dfa::new(alphabet.clone(), 0, self.accepting.clone(), &rows).ok()
    }
}

/// The vector, long enough to have this place.
fn grow<T: Clone>(vector: &mut Vec<Option<T>>, place: usize) -> &mut Vec<Option<T>> {
    if vector.len() <= place {
        vector.resize(place + 1, None);
    }
    vector
}
