//! How automata of a given size are spread before anything is known: the
//! chance that a table, begun with some states and edges, comes to use all of
//! its states.

/// How edges are drawn, independently of each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Manner {
    /// Every target is as likely as any other.
    Even,
    /// An edge stays in its state with probability one half, as in most tasks:
    /// a symbol that does not matter changes nothing.
    Staying,
}

impl Manner {
    /// Both.
    pub(crate) const ALL: [Self; 2] = [Self::Even, Self::Staying];
}

/// The distribution over tables of one size whose states are numbered in the
/// order of their first use.
///
/// Choosing every edge by [`Self::old`] times [`Self::completion`] and by
/// [`Self::born`] draws exactly from it.
#[derive(Clone, Debug)]
pub(crate) struct Growth {
    states: usize,
    symbols: usize,
    /// Of an edge to its own state, and to each other one.
    stay: f64,
    leave: f64,
    /// `completion[used * (edges + 1) + open]`, natural logarithms.
    completion: Vec<f64>,
}

impl Growth {
    /// Tables with this many states.
    pub(crate) fn new(manner: Manner, states: usize, symbols: usize) -> Self {
        let k = states as f64;
        let (stay, leave) = match manner {
            Manner::Even => (1.0 / k, 1.0 / k),
            Manner::Staying if states == 1 => (1.0, 0.0),
            Manner::Staying => (0.5, 0.5 / (k - 1.0)),
        };
        let edges = states * symbols;
        let mut growth = Self {
            states,
            symbols,
            stay,
            leave,
            completion: vec![f64::NEG_INFINITY; (states + 1) * (edges + 1)],
        };
        for used in (1..=states).rev() {
            let old = growth.stay + (used - 1) as f64 * growth.leave;
            for open in 0..=used * symbols {
                let value = if open == 0 {
                    if used == states {
                        0.0
                    } else {
                        f64::NEG_INFINITY
                    }
                } else {
                    let without = old.ln() + growth.completion(used, open - 1);
                    add_logs(without, growth.born(used, open))
                };
                growth.completion[used * (edges + 1) + open] = value;
            }
        }
        growth
    }

    /// The logarithm of the chance that a table with so many used states and
    /// undefined edges of theirs comes to use all states.
    pub(crate) fn completion(&self, used: usize, open: usize) -> f64 {
        self.completion[used * (self.states * self.symbols + 1) + open]
    }

    /// The logarithm of the chance that one of these edges leads to a new state
    /// and that all states come to be used then.
    pub(crate) fn born(&self, used: usize, open: usize) -> f64 {
        if used == self.states {
            return f64::NEG_INFINITY;
        }
        let new = (self.states - used) as f64 * self.leave;
        new.ln() + self.completion(used + 1, open - 1 + self.symbols)
    }

    /// The logarithm of the chance of an edge to a used state.
    pub(crate) fn old(&self, stays: bool) -> f64 {
        if stays { self.stay } else { self.leave }.ln()
    }
}

/// `ln(exp a + exp b)`.
pub(crate) fn add_logs(a: f64, b: f64) -> f64 {
    let (small, large) = if a < b { (a, b) } else { (b, a) };
    if small == f64::NEG_INFINITY {
        large
    } else {
        large + (small - large).exp().ln_1p()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Accessible tables of 2 and 3 states over two letters: 12 and 432
    /// labelled ones (Liskovets), so 12 and 216 up to numbering.
    #[test]
    fn even_tables_are_counted() {
        for (states, tables) in [(1, 1.0), (2, 12.0), (3, 216.0)] {
            let growth = Growth::new(Manner::Even, states, 2);
            let all = (states as f64).powf(states as f64 * 2.0);
            let numberings: f64 = (1..states).map(|n| n as f64).product();
            let counted = growth.completion(1, 2).exp() * all / numberings;
            assert!((counted - tables).abs() < 1e-6, "{states}: {counted}");
        }
    }
}
