//! How automata look before anything is known: the prior over numbered tables
//! whose states are all reachable.

use std::sync::{Arc, OnceLock};

use crate::identify::growth::{Growth, Manner, add_logs};

/// The logarithms of the shares of tables drawn evenly, of those whose edges
/// mostly stay, and of those in which every symbol permutes the states (as
/// where things are counted).
const SHARES: [f64; 3] = [0.4, 0.4, 0.2];

/// The share of the two languages of one state, where two and three states have
/// 1 each.
const TRIVIAL: f64 = 0.05;

/// The prior of all sizes up to a bound. Clones share what was worked out.
#[derive(Clone, Debug)]
pub(crate) struct Shape {
    sizes: Arc<[Size]>,
}

/// The logarithms of the parts of one size's prior.
#[derive(Debug)]
struct Size {
    even: f64,
    staying: f64,
    stay: f64,
    permuting: f64,
    /// The whole, by how many edges stay, and by whether every symbol permutes the
    /// states: chains ask for it at every step.
    whole: OnceLock<Box<[[f64; 2]]>>,
}

impl Size {
    /// The whole for tables with so many edges.
    fn whole(&self, edges: usize) -> &[[f64; 2]] {
        self.whole.get_or_init(|| {
            let loops = 0..=edges;
            let whole = loops.map(|loops| {
                let plain = add_logs(self.even, self.staying + loops as f64 * self.stay);
                [plain, add_logs(plain, self.permuting)]
            });
            whole.collect()
        })
    }
}

impl Shape {
    /// Automata with up to `most` states; one of a size is `decay` times as
    /// likely as one state less.
    pub(crate) fn new(symbols: usize, most: usize, decay: f64) -> Self {
        let mut transitive: Vec<f64> = Vec::new();
        let size = |states: usize| {
            let edges = (states * symbols) as f64;
            let outputs = -(states as f64) * std::f64::consts::LN_2;
            let size = outputs + size_prior(states, decay);
            let growth = Manner::ALL.map(|manner| Growth::new(manner, states, symbols));
            let reached = growth.each_ref().map(|g| g.completion(1, symbols));
            let leave = growth.each_ref().map(|g| g.old(false));
            let stay = growth.each_ref().map(|g| g.old(true));
            let moved = |manner: usize| {
                if states == 1 {
                    edges * stay[manner]
                } else {
                    edges * leave[manner]
                }
            };
            transitive.push(transitive_share(&transitive, symbols));
            let factorial: f64 = (1..=states).map(|n| (n as f64).ln()).sum();
            let shares = SHARES.map(f64::ln);
            Size {
                even: shares[0] + size + moved(0) - reached[0],
                staying: shares[1] + size + moved(1) - reached[1],
                stay: if states == 1 { 0.0 } else { stay[1] - leave[1] },
                permuting: shares[2] + size
                    - symbols as f64 * factorial
                    - transitive[states - 1].ln(),
                whole: OnceLock::new(),
            }
        };
        Self {
            sizes: (1..=most).map(size).collect(),
        }
    }

    /// The number of states of the largest.
    pub(crate) fn most(&self) -> usize {
        self.sizes.len()
    }

    /// The logarithm of the prior of one numbered table (its states but the
    /// first may be numbered in any way), all of whose states are reachable.
    pub(crate) fn log_prior(&self, delta: &[u8], states: usize) -> f64 {
        let symbols = delta.len() / states;
        let mut loops = 0;
        let mut permuting = true;
        for symbol in 0..symbols {
            let mut seen: u64 = 0;
            for state in 0..states {
                let target = usize::from(delta[state * symbols + symbol]);
                loops += usize::from(target == state);
                let bit = 1 << target;
                permuting &= seen & bit == 0;
                seen |= bit;
            }
        }
        self.sizes[states - 1].whole(delta.len())[loops][usize::from(permuting)]
    }
}

/// The logarithm of the share of a size: hardly anybody teaches that all is
/// accepted, or nothing.
fn size_prior(states: usize, decay: f64) -> f64 {
    let rank = states.saturating_sub(3) as f64;
    rank * decay.ln() + if states == 1 { TRIVIAL.ln() } else { 0.0 }
}

/// The share of all tuples of permutations, one a symbol, of one point more than
/// `smaller` knows that lead from any point to any other:
/// `1 = Σₖ pₖ · k/n · C(n, k)^(1−symbols)`, by the size `k` of what is reached.
fn transitive_share(smaller: &[f64], symbols: usize) -> f64 {
    let n = smaller.len() + 1;
    let mut share = 1.0;
    let mut log_binomial = 0.0;
    for (index, known) in smaller.iter().enumerate() {
        let k = index + 1;
        log_binomial += ((n - index) as f64 / k as f64).ln();
        let power = (1.0 - symbols as f64) * log_binomial;
        share -= known * k as f64 / n as f64 * power.exp();
    }
    share
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The chances of all numbered tables that use every state, with all outputs,
    /// sum to the share of their size.
    #[test]
    fn tables_sum_to_the_share_of_their_size() {
        for (states, symbols, share) in [(1, 2, TRIVIAL), (2, 3, 1.0), (3, 2, 1.0), (4, 1, 0.5)] {
            let shape = Shape::new(symbols, 5, 0.5);
            let edges = states * symbols;
            let mut sum = 0.0;
            for code in 0..states.pow(edges as u32) {
                let delta: Vec<u8> = (0..edges as u32)
                    .map(|edge| (code / states.pow(edge) % states) as u8)
                    .collect();
                let mut reached = vec![false; states];
                reached[0] = true;
                for _ in 0..states {
                    for (edge, &target) in delta.iter().enumerate() {
                        reached[usize::from(target)] |= reached[edge / symbols];
                    }
                }
                if reached.iter().all(|reached| *reached) {
                    sum += shape.log_prior(&delta, states).exp() * 2_f64.powf(states as f64);
                }
            }
            assert!((sum - share).abs() < 1e-9, "{states} states: {sum}");
        }
    }
}
