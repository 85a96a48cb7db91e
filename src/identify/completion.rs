//! All the automata that a finished search leaf stands for: edges that no word
//! uses may lead anywhere, outputs that no label decides may be either.

use automata::{Alphabet, Dfa};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use smallvec::{SmallVec, smallvec};

use super::partial::NONE;

/// As many assignments of tied outputs as are listed; beyond, they are counted
/// as this many and drawn one state at a time.
const LISTED_OUTPUTS: usize = 4096;

/// A partial automaton in which every word runs, and so every way to complete
/// it is consistent.
#[derive(Clone, Debug)]
pub(crate) struct Leaf {
    delta: Box<[u32]>,
    output: Box<[Option<bool>]>,
    /// States whose output is open and in no implication.
    loose: Vec<u32>,
    /// The other states whose output is open.
    tied: Vec<u32>,
    implications: Vec<(u32, u32)>,
    /// The assignments of [`Self::tied`], at most [`LISTED_OUTPUTS`].
    outputs: usize,
}

/// A complete table in some numbering, and the outputs of its states.
pub(crate) type Table = (Vec<u32>, Vec<bool>);

/// A number for every state: most tables have few, and there are many tables.
pub(crate) type Small = SmallVec<[u32; 16]>;

impl Leaf {
    /// The leaf at which a search stands: its table with [`NONE`] for free
    /// edges, its outputs where they are decided, and the implications between
    /// those that are not.
    pub(crate) fn new(
        delta: Box<[u32]>,
        output: Box<[Option<bool>]>,
        mut implications: Vec<(u32, u32)>,
    ) -> Self {
        implications.sort_unstable();
        implications.dedup();
        let is_tied = |state: u32| {
            (implications.iter()).any(|&(source, target)| source == state || target == state)
        };
        let (tied, loose) = (0..output.len() as u32)
            .filter(|&state| output[state as usize].is_none())
            .partition(|&state| is_tied(state));
        let mut leaf = Self {
            delta,
            output,
            loose,
            tied,
            implications,
            outputs: 1,
        };
        if !leaf.tied.is_empty() {
            leaf.outputs = leaf.tied_outputs().len();
        }
        leaf
    }

    /// The number of states.
    pub(crate) fn states(&self) -> usize {
        self.output.len()
    }

    /// The number of edges that may lead anywhere.
    pub(crate) fn free_edges(&self) -> u32 {
        self.delta.iter().filter(|&&target| target == NONE).count() as u32
    }

    /// The number of ways to decide the outputs, saturating.
    pub(crate) fn output_count(&self) -> u128 {
        let loose = self.loose.len() as u32;
        (1_u128.checked_shl(loose).unwrap_or(u128::MAX)).saturating_mul(self.outputs as u128)
    }

    /// The number of automata this stands for, saturating.
    pub(crate) fn count(&self) -> u128 {
        (self.states() as u128)
            .saturating_pow(self.free_edges())
            .saturating_mul(self.output_count())
    }

    /// All automata this stands for. Call only where [`Self::count`] is small.
    pub(crate) fn all(&self, found: &mut Vec<Table>) {
        let free: Vec<usize> = (0..self.delta.len())
            .filter(|&edge| self.delta[edge] == NONE)
            .collect();
        let states = self.states() as u32;
        let outputs = self.all_outputs();
        let mut delta = self.delta.to_vec();
        for &edge in &free {
            delta[edge] = 0;
        }
        loop {
            found.extend(outputs.iter().map(|output| (delta.clone(), output.clone())));
            // Count up, the last free edge fastest.
            let Some(&edge) = free.iter().rfind(|&&edge| delta[edge] + 1 < states) else {
                return;
            };
            delta[edge] += 1;
            for &later in free.iter().rev().take_while(|&&later| later > edge) {
                delta[later] = 0;
            }
        }
    }

    /// One of the automata this stands for, each as likely as any other (unless
    /// there are very many ways to decide tied outputs).
    pub(crate) fn draw(&self, rng: &mut ChaCha8Rng) -> Table {
        let states = self.states() as u32;
        let mut delta = self.delta.to_vec();
        for target in delta.iter_mut().filter(|target| **target == NONE) {
            *target = rng.random_range(0..states);
        }
        let mut output: Vec<_> = self.output.to_vec();
        for &state in &self.loose {
            output[state as usize] = Some(rng.random());
        }
        if !self.tied.is_empty() {
            if self.outputs < LISTED_OUTPUTS {
                let mut choices = self.tied_outputs();
                let choice = rng.random_range(0..choices.len() as u32) as usize;
                for (&state, output_of) in self.tied.iter().zip(choices.swap_remove(choice)) {
                    output[state as usize] = Some(output_of);
                }
            } else {
                let mut open = self.tied.clone();
                while !open.is_empty() {
                    let state = open.swap_remove(rng.random_range(0..open.len() as u32) as usize);
                    if output[state as usize].is_none() {
                        self.force(&mut output, state, rng.random());
                    }
                }
            }
        }
        let output = output.into_iter().map(|o| o == Some(true)).collect();
        (delta, output)
    }

    fn all_outputs(&self) -> Vec<Vec<bool>> {
        let mut all = Vec::new();
        for tied in self.tied_outputs() {
            let mut output: Vec<bool> = self.output.iter().map(|&o| o == Some(true)).collect();
            for (&state, output_of) in self.tied.iter().zip(tied) {
                output[state as usize] = output_of;
            }
            for choice in 0..1_u64 << self.loose.len() {
                for (bit, &state) in self.loose.iter().enumerate() {
                    output[state as usize] = choice >> bit & 1 == 1;
                }
                all.push(output.clone());
            }
        }
        all
    }

    /// The ways to decide [`Self::tied`], as many as are listed at most.
    fn tied_outputs(&self) -> Vec<Vec<bool>> {
        let mut found = Vec::new();
        let mut open = vec![self.output.to_vec()];
        while let Some(output) = open.pop() {
            let undecided = (self.tied.iter()).find(|&&state| output[state as usize].is_none());
            if let Some(&state) = undecided {
                // Rejection is tried first, so it goes on the stack last. Both
                // can be completed: implications are closed under each.
                for value in [true, false] {
                    let mut output = output.clone();
                    self.force(&mut output, state, value);
                    open.push(output);
                }
            } else {
                let decided = |&state: &u32| output[state as usize] == Some(true);
                found.push(self.tied.iter().map(decided).collect());
                if found.len() == LISTED_OUTPUTS {
                    break;
                }
            }
        }
        found
    }

    /// Decides an output and what it implies.
    fn force(&self, output: &mut [Option<bool>], state: u32, value: bool) {
        output[state as usize] = Some(value);
        let mut changed = true;
        while std::mem::take(&mut changed) {
            for &(source, target) in &self.implications {
                let (source, target) = (source as usize, target as usize);
                if output[source] == Some(true) && output[target].is_none() {
                    output[target] = Some(true);
                    changed = true;
                }
                if output[target] == Some(false) && output[source].is_none() {
                    output[source] = Some(false);
                    changed = true;
                }
            }
        }
    }
}

/// The automaton of a table whose start state is 0 and all of whose states are
/// reachable, numbered breadth first.
pub(crate) fn canonical(alphabet: &Alphabet, table: &Table) -> Dfa {
    automaton(alphabet, breadth_first(table))
}

/// The automaton of a table whose start state is 0.
pub(crate) fn automaton(alphabet: &Alphabet, (delta, output): Table) -> Dfa {
    let targets = delta.into_iter().map(|target| target as usize);
    Dfa::from_targets(alphabet.clone(), 0, output, targets)
        .expect("a table has a target for every state and symbol")
}

/// The same table with its states numbered breadth first.
pub(crate) fn breadth_first((delta, output): &Table) -> Table {
    let symbols = delta.len() / output.len();
    let mut order: Small = smallvec![0];
    let mut number: Small = smallvec![NONE; output.len()];
    number[0] = 0;
    let mut next = 0;
    while let Some(&state) = order.get(next) {
        next += 1;
        let row = state as usize * symbols;
        for &target in &delta[row..row + symbols] {
            if number[target as usize] == NONE {
                number[target as usize] = order.len() as u32;
                order.push(target);
            }
        }
    }
    let mut table = (
        Vec::with_capacity(delta.len()),
        Vec::with_capacity(output.len()),
    );
    for &state in &order {
        let row = state as usize * symbols;
        let targets = delta[row..row + symbols].iter();
        table
            .0
            .extend(targets.map(|&target| number[target as usize]));
        table.1.push(output[state as usize]);
    }
    table
}
