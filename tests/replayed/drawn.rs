//! Tasks and setups of every kind, drawn.

use std::fmt::Write as _;

use memrep::learner::Strategy;
use memrep::session::{Setup, Task, ready};
use rand::RngExt;
use rand::seq::IndexedRandom;
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};

pub(crate) fn some_task(random: &mut ChaCha8Rng) -> Task {
    const READY: [&str; 14] = [
        "tomita:1",
        "tomita:2",
        "tomita:3",
        "tomita:4",
        "tomita:5",
        "tomita:6",
        "tomita:7",
        "modulo:3",
        "zeros:2",
        "robot",
        "car",
        "repairs",
        "four-buttons",
        "robot-recharge",
    ];
    let of = |content: Value| {
        Task::from_json(&content).unwrap_or_else(|error| panic!("{content}: {error}"))
    };
    match random.random_range(0..10) {
        0..5 => ready(READY.choose(random).unwrap()).unwrap(),
        5..8 => {
            let symbols: Vec<&str> = ["a", "b", "c"][..random.random_range(1..=3)].to_vec();
            let mut task = json!({
                "symbols": symbols,
                "max_states": random.random_range(2..6),
                "examples": [{"word": [], "label": random.random::<bool>()}],
            });
            if symbols.len() > 1 && random.random_range(0..3) == 0 {
                task["prior"] = json!({"holds": ["avoid b"]});
                task["examples"] = json!([]);
            }
            if random.random_range(0..3) == 0 {
                task["world"] = json!({"kind": "words", "longest": random.random_range(3..9)});
            }
            of(task)
        }
        8 => {
            let rows = random.random_range(2..6_u32);
            let columns = random.random_range(3..7_u32);
            let mut table = String::from("is");
            for column in 0..columns {
                let _ = write!(table, ",c{column}");
            }
            for row in 0..rows {
                let _ = write!(table, "\nr{row}");
                // No two columns are alike: their numbers in binary, and noise below.
                for column in 0..columns {
                    let bit = if row < 3 {
                        column >> row & 1 == 1
                    } else {
                        random.random()
                    };
                    table += if bit { ",1" } else { ",0" };
                }
            }
            match Task::from_json(&json!({"class": {"kind": "finite", "table": table}})) {
                Ok(task) => task,
                // Two rows do not tell so many columns apart.
                Err(_) => ready("tomita:1").unwrap(),
            }
        }
        _ => of(
            json!({"class": {"kind": "monotone", "ticks": random.random_range(3..12), "axes": [
                {"name": "wait", "unit": "s", "best": 0, "worst": 10},
                {"name": "gap", "unit": "m", "best": 2, "worst": 0.5},
            ]}}),
        ),
    }
}

pub(crate) fn some_setup(random: &mut ChaCha8Rng) -> Setup {
    let strategies = [
        Strategy::Bayes,
        Strategy::Exp4Plus,
        Strategy::Thesis,
        Strategy::Membership,
    ];
    Setup {
        strategy: *strategies.choose(random).unwrap(),
        membership_cost: *[1.0, 4.0, 0.25].choose(random).unwrap(),
        comparison_cost: *[1.0, 1.0, 3.5, f64::INFINITY].choose(random).unwrap(),
        seed: random.random_range(0..1000),
        // Where little may be done, what was done before must not show.
        budget: *[300, 300, 3000, 3000, 20_000, 20_000, 200_000]
            .choose(random)
            .unwrap(),
    }
}
