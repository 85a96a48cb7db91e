//! Who takes part in the experiments: ways to set up the learner, and rivals.
//!
//! To let another strategy take part, add a line to [`CONTENDERS`].

use crate::learner::{Config, EQUIVALENCE_COST, Strategy};

/// A way to set up the learner.
#[derive(Debug)]
pub struct Contender {
    /// What it is called on the command line and in tables for programs.
    pub key: &'static str,
    /// What it is called on pages.
    pub name: &'static str,
    /// What it does, as half a sentence.
    pub about: &'static str,
    /// Whether it takes part where answers are right.
    pub clean: bool,
    /// Whether it takes part where some answers are wrong.
    pub noisy: bool,
    set: fn(&mut Config),
}

/// All of them, in the order of the tables.
pub const CONTENDERS: &[Contender] = &[
    Contender {
        key: "bayes",
        name: "bayes",
        about: "a posterior over concepts, and the question worth most for its cost; an equivalence query costs it 4C",
        clean: true,
        noisy: true,
        set: |config| config.strategy = Strategy::Bayes,
    },
    Contender {
        key: "bayes-eager",
        name: "bayes, eager",
        about: "the same, told that an equivalence query costs hardly more than a membership query (C + 0.35), for costs that leave it out",
        clean: true,
        noisy: false,
        set: |config| {
            config.strategy = Strategy::Bayes;
            config.equivalence_cost = config.membership_cost + EAGER;
        },
    },
    Contender {
        key: "bayes-robust",
        name: "bayes, robust",
        about: "the same as `bayes`, told that answers may be wrong",
        clean: false,
        noisy: true,
        set: |config| {
            config.strategy = Strategy::Bayes;
            config.robust = true;
        },
    },
    Contender {
        key: "exp4+",
        name: "exp4+",
        about: "the posterior of `bayes`, and EXP4 with four experts over its best question of each kind",
        clean: true,
        noisy: false,
        set: |config| config.strategy = Strategy::Exp4Plus,
    },
    Contender {
        key: BASE,
        name: "thesis",
        about: "Algorithms 4 to 6 of the dissertation as written",
        clean: true,
        noisy: true,
        set: |config| config.strategy = Strategy::Thesis,
    },
    Contender {
        key: "membership",
        name: "membership",
        about: "the same without comparisons, whatever they cost",
        clean: true,
        noisy: false,
        set: |config| config.strategy = Strategy::Membership,
    },
];

/// What an equivalence query costs the eager contender beyond a membership query.
/// At the same cost it would show one automaton after the other.
const EAGER: f64 = 0.35;

/// The contender by which all others are measured.
pub const BASE: &str = "thesis";

/// The work that one question may do.
const BUDGET: u64 = 2_000_000;

impl Contender {
    /// The contender of this key.
    pub fn of(key: &str) -> Option<&'static Self> {
        CONTENDERS.iter().find(|contender| contender.key == key)
    }

    /// The contender of the same strategy that is not told of wrong answers.
    pub fn plain(&self) -> Option<&'static Self> {
        let told = |contender: &Self| contender.config(None, 0);
        CONTENDERS.iter().find(|other| {
            let config = told(other);
            config.strategy == told(self).strategy && other.noisy && !config.robust
        })
    }

    /// What its learner is told: a membership query costs `cost` where a
    /// comparison costs 1; without a cost it is 1, and comparisons are never
    /// asked.
    pub fn config(&self, cost: Option<u32>, seed: u64) -> Config {
        let membership_cost = cost.map_or(1.0, f64::from);
        let mut config = Config {
            membership_cost,
            comparison_cost: if cost.is_some() { 1.0 } else { f64::INFINITY },
            equivalence_cost: EQUIVALENCE_COST * membership_cost,
            seed,
            budget: BUDGET,
            ..Config::default()
        };
        (self.set)(&mut config);
        config
    }
}

/// An algorithm of another library, which asks no comparisons.
#[derive(Debug)]
pub struct Rival {
    /// What it is called in tables for programs and by its script.
    pub key: &'static str,
    /// What it is called on pages.
    pub name: &'static str,
}

/// Those of `AALpy`.
pub const RIVALS: &[Rival] = &[
    Rival {
        key: "lstar",
        name: "L* (AALpy)",
    },
    Rival {
        key: KV,
        name: "KV (AALpy)",
    },
    Rival {
        key: "lsharp",
        name: "L# (AALpy)",
    },
];

/// The rival that asks the fewest membership queries.
pub const KV: &str = "kv";

/// What a contender or rival of this key is called on pages.
pub(super) fn name(key: &str) -> &str {
    let rival = RIVALS.iter().find(|rival| rival.key == key);
    Contender::of(key)
        .map(|contender| contender.name)
        .or(rival.map(|rival| rival.name))
        .unwrap_or(key)
}
