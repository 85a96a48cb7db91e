//! EXP4: which of two arms to pull on the advice of some experts (Auer,
//! Cesa-Bianchi, Freund, Schapire: The nonstochastic multiarmed bandit problem,
//! 2002, section 7), with losses in place of rewards.
//!
//! Experts are known by their order. In a round in which only the first of them
//! have something to say, the others sleep: nobody asks how far they are to be
//! trusted, and they are taken to have advised what was done.
//!
//! Its guarantee is against the best of the experts, and its regret grows with
//! the square root of the rounds: a learner that ends within thirty questions
//! leaves the weights nearly where they began.

/// A number for each arm: membership query, comparison.
pub(super) type Arms = [f64; 2];

/// The arm of membership queries.
pub(super) const MEMBERSHIP: usize = 0;

/// The arm of comparisons.
pub(super) const COMPARISON: usize = 1;

/// The number of arms, `K` in the paper.
const ARMS: f64 = 2.0;

/// The rounds for which the exploration below is tuned: the tables of the
/// dissertation show runs from five to a hundred questions.
const HORIZON: f64 = 64.0;

/// The share `γ` of pulls that heed none of `N` experts, at least two:
/// Corollary 3.2 of the paper with the experts in place of `K` arms in the
/// logarithm, that is `√(K ln N / ((e − 1) T))`, which minimises the regret bound
/// of `T` rounds: 0.11 for two experts and 0.16 for four. It is above 0, so that
/// every arm on offer keeps a probability of at least `γ/K`; Proposition 1 needs
/// that of the membership query.
pub(super) fn exploration(experts: usize) -> f64 {
    let experts = experts as f64;
    (ARMS * experts.ln() / ((std::f64::consts::E - 1.0) * HORIZON)).sqrt()
}

/// The weights of the experts.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Exp4 {
    /// Natural logarithms, up to a common summand.
    weights: Vec<f64>,
}

impl Exp4 {
    /// So many experts, none of them better trusted than another.
    pub(super) fn new(experts: usize) -> Self {
        Self {
            weights: vec![0.0; experts],
        }
    }

    /// How much each of the first experts is heeded if only these are awake;
    /// sums to 1.
    pub(super) fn trust(&self, awake: usize) -> Vec<f64> {
        softmax(self.weights[..awake.min(self.weights.len())].to_vec())
    }

    /// The probabilities with which the arms are pulled. To draw an expert by
    /// [`Self::trust`] and then an arm by its advice, as Algorithm 5 has it, is
    /// to draw from this mixture, but for the exploration.
    ///
    /// `advice` has of each expert that is awake the probabilities with which it
    /// would pull the arms.
    pub(super) fn probabilities(&self, advice: &[Arms], offered: [bool; 2]) -> Arms {
        let trust = self.trust(advice.len());
        let arms = offered.iter().filter(|o| **o).count() as f64;
        let gamma = exploration(self.weights.len());
        std::array::from_fn(|arm| {
            if !offered[arm] {
                return 0.0;
            }
            let mixture: f64 = trust.iter().zip(advice).map(|(t, a)| t * a[arm]).sum();
            (1.0 - gamma) * mixture + gamma / arms
        })
    }

    /// Learns that `arm`, pulled with these probabilities on this advice, lost
    /// `loss` in `[0, 1]`. Its reward `1 − loss` is weighted by the inverse of
    /// the arm's probability, which makes the estimate of every expert's reward
    /// unbiased; the step is `η = γ/K`, the one the paper's bound is proved for.
    pub(super) fn update(&mut self, advice: &[Arms], probabilities: Arms, arm: usize, loss: f64) {
        let step = exploration(self.weights.len()) / ARMS;
        let reward = (1.0 - loss) / probabilities[arm];
        let asleep = std::iter::repeat(&probabilities);
        for (weight, advice) in self.weights.iter_mut().zip(advice.iter().chain(asleep)) {
            *weight += step * advice[arm] * reward;
        }
    }
}

/// Probabilities proportional to `exp` of the numbers.
pub(super) fn softmax<N: AsMut<[f64]>>(mut numbers: N) -> N {
    let powers = numbers.as_mut();
    let largest = powers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    for power in powers.iter_mut() {
        *power = (*power - largest).exp();
    }
    let sum: f64 = powers.iter().sum();
    for power in powers.iter_mut() {
        *power /= sum;
    }
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(left: f64, right: f64) -> bool {
        (left - right).abs() < 1e-12
    }

    /// One round by hand, with γ = √(2 ln 2 / ((e−1)·64)).
    #[test]
    fn one_round_by_hand() {
        let gamma = exploration(2);
        assert!((gamma - 0.112_277).abs() < 1e-6, "{gamma}");

        let mut exp4 = Exp4::new(2);
        let advice = [[0.8, 0.2], [0.5, 0.5]];
        let p = exp4.probabilities(&advice, [true, true]);
        // Equal trust: the mixture is 0.65 and 0.35.
        assert!(close(p[0], (1.0 - gamma) * 0.65 + gamma / 2.0));
        assert!(close(p[1], (1.0 - gamma) * 0.35 + gamma / 2.0));

        // The comparison is pulled and loses 0.25: reward 0.75, weighted 0.75/p.
        exp4.update(&advice, p, COMPARISON, 0.25);
        let weighted = 0.75 / p[1];
        let first = (gamma / 2.0 * 0.2 * weighted).exp();
        let second = (gamma / 2.0 * 0.5 * weighted).exp();
        let trust = exp4.trust(2);
        assert!(close(trust[0], first / (first + second)));
        assert!(close(trust[1], second / (first + second)));
    }

    #[test]
    fn an_arm_that_is_not_offered_is_never_pulled() {
        let exp4 = Exp4::new(2);
        let p = exp4.probabilities(&[[1.0, 0.0], [1.0, 0.0]], [true, false]);
        assert!(close(p[0], 1.0) && p[1] == 0.0, "{p:?}");
    }

    /// Losing everything teaches nothing: the reward is 0.
    #[test]
    fn a_full_loss_moves_no_weight() {
        let mut exp4 = Exp4::new(2);
        let advice = [[0.9, 0.1], [0.1, 0.9]];
        let p = exp4.probabilities(&advice, [true, true]);
        exp4.update(&advice, p, MEMBERSHIP, 1.0);
        assert_eq!(exp4, Exp4::new(2));
    }

    #[test]
    fn the_better_expert_wins_in_the_long_run() {
        let mut exp4 = Exp4::new(2);
        let advice = [[0.9, 0.1], [0.1, 0.9]];
        for round in 0..2000 {
            let p = exp4.probabilities(&advice, [true, true]);
            let arm = usize::from(f64::from(round % 100) / 100.0 > p[0]);
            let loss = if arm == MEMBERSHIP { 0.2 } else { 0.8 };
            exp4.update(&advice, p, arm, loss);
        }
        assert!(exp4.trust(2)[0] > 0.95, "{:?}", exp4.trust(2));
    }

    /// The same round with two more experts, who sleep: the first two are heeded
    /// as if they were alone, but for the exploration, and the sleepers gain
    /// what the mixture gained.
    #[test]
    fn sleepers_gain_what_was_gained() {
        let gamma = exploration(4);
        assert!((gamma - 0.158_783).abs() < 1e-6, "{gamma}");

        let mut exp4 = Exp4::new(4);
        let advice = [[0.8, 0.2], [0.5, 0.5]];
        let p = exp4.probabilities(&advice, [true, true]);
        assert!(close(p[0], (1.0 - gamma) * 0.65 + gamma / 2.0));
        exp4.update(&advice, p, COMPARISON, 0.25);
        let gains = [0.2 / p[1], 0.5 / p[1], 1.0, 1.0].map(|gain| gamma / 2.0 * gain * 0.75);
        let trust = exp4.trust(4);
        let sum: f64 = gains.iter().map(|gain| gain.exp()).sum();
        for (trust, gain) in trust.iter().zip(gains) {
            assert!(close(*trust, gain.exp() / sum), "{trust} {gain}");
        }
        // Who is asleep takes no trust from those awake.
        assert!(close(exp4.trust(2)[0], trust[0] / (trust[0] + trust[1])));
    }

    /// Four experts who advise alike are as good as one.
    #[test]
    fn the_same_advice_moves_no_trust() {
        let mut exp4 = Exp4::new(4);
        let advice = [[0.7, 0.3]; 4];
        for _ in 0..50 {
            let p = exp4.probabilities(&advice, [true, true]);
            exp4.update(&advice, p, MEMBERSHIP, 0.5);
        }
        assert!(exp4.trust(4).iter().all(|trust| close(*trust, 0.25)));
    }
}
