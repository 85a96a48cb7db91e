//! EXP4: which of two arms to pull on the advice of two experts (Auer,
//! Cesa-Bianchi, Freund, Schapire: The nonstochastic multiarmed bandit problem,
//! 2002, section 7), with losses in place of rewards.
//!
//! Its guarantee is against the better of the experts, and its regret grows with
//! the square root of the rounds: a learner that ends within thirty questions
//! leaves the weights nearly where they began.

/// A number for each arm: membership query, comparison.
pub(super) type Arms = [f64; 2];

/// The arm of membership queries.
pub(super) const MEMBERSHIP: usize = 0;

/// The arm of comparisons.
pub(super) const COMPARISON: usize = 1;

/// The number of experts.
const EXPERTS: usize = 2;

/// The number of arms, `K` in the paper.
const ARMS: f64 = 2.0;

/// The rounds for which the exploration below is tuned: the tables of the
/// dissertation show runs from five to a hundred questions.
const HORIZON: f64 = 64.0;

/// Of each expert the probabilities with which it would pull the arms.
pub(super) type Advice = [Arms; EXPERTS];

/// The share `γ` of pulls that heed no expert: Corollary 3.2 of the paper with
/// `N` experts in place of `K` arms in the logarithm, that is
/// `√(K ln N / ((e − 1) T))`, which minimises the regret bound of `T` rounds.
/// It is above 0, so that every arm on offer keeps a probability of at least
/// `γ/K`; Proposition 1 needs that of the membership query.
pub(super) fn exploration() -> f64 {
    let experts = EXPERTS as f64;
    (ARMS * experts.ln() / ((std::f64::consts::E - 1.0) * HORIZON)).sqrt()
}

/// The weights of the experts.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Exp4 {
    /// Natural logarithms, up to a common summand.
    weights: [f64; EXPERTS],
}

impl Exp4 {
    /// How much each expert is heeded; sums to 1.
    pub(super) fn trust(&self) -> [f64; EXPERTS] {
        softmax(self.weights)
    }

    /// The probabilities with which the arms are pulled. To draw an expert by
    /// [`Self::trust`] and then an arm by its advice, as Algorithm 5 has it, is
    /// to draw from this mixture, but for the exploration.
    pub(super) fn probabilities(&self, advice: &Advice, offered: [bool; 2]) -> Arms {
        let trust = self.trust();
        let arms = offered.iter().filter(|o| **o).count() as f64;
        let gamma = exploration();
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
    pub(super) fn update(&mut self, advice: &Advice, probabilities: Arms, arm: usize, loss: f64) {
        let step = exploration() / ARMS;
        let reward = (1.0 - loss) / probabilities[arm];
        for (weight, advice) in self.weights.iter_mut().zip(advice) {
            *weight += step * advice[arm] * reward;
        }
    }
}

/// Probabilities proportional to `exp` of the numbers.
pub(super) fn softmax<const N: usize>(numbers: [f64; N]) -> [f64; N] {
    let largest = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let powers = numbers.map(|number| (number - largest).exp());
    let sum: f64 = powers.iter().sum();
    powers.map(|power| power / sum)
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
        let gamma = exploration();
        assert!((gamma - 0.112_277).abs() < 1e-6, "{gamma}");

        let mut exp4 = Exp4::default();
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
        let trust = exp4.trust();
        assert!(close(trust[0], first / (first + second)));
        assert!(close(trust[1], second / (first + second)));
    }

    #[test]
    fn an_arm_that_is_not_offered_is_never_pulled() {
        let exp4 = Exp4::default();
        let p = exp4.probabilities(&[[1.0, 0.0], [1.0, 0.0]], [true, false]);
        assert!(close(p[0], 1.0) && p[1] == 0.0, "{p:?}");
    }

    /// Losing everything teaches nothing: the reward is 0.
    #[test]
    fn a_full_loss_moves_no_weight() {
        let mut exp4 = Exp4::default();
        let advice = [[0.9, 0.1], [0.1, 0.9]];
        let p = exp4.probabilities(&advice, [true, true]);
        exp4.update(&advice, p, MEMBERSHIP, 1.0);
        assert_eq!(exp4, Exp4::default());
    }

    #[test]
    fn the_better_expert_wins_in_the_long_run() {
        let mut exp4 = Exp4::default();
        let advice = [[0.9, 0.1], [0.1, 0.9]];
        for round in 0..2000 {
            let p = exp4.probabilities(&advice, [true, true]);
            let arm = usize::from(f64::from(round % 100) / 100.0 > p[0]);
            let loss = if arm == MEMBERSHIP { 0.2 } else { 0.8 };
            exp4.update(&advice, p, arm, loss);
        }
        assert!(exp4.trust()[0] > 0.95, "{:?}", exp4.trust());
    }
}
