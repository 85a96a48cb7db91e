//! Runs strategies against scripted teachers and prints one line of CSV a run:
//! `ratio STRATEGY[,STRATEGY] TARGETS COSTS SEEDS [random]`, for example
//! `ratio bayes,thesis tomita 1,8 20`. Targets are `tomita`, `random:N` (drawn:
//! 3 to 8 states, 2 to 4 letters), `task:N` (the same with mostly self-loops and
//! a sink), `small:N` (3 to 5 states, 2 letters), or a name.

use automata::{Alphabet, Dfa};
use memrep::bench::{percentile, process_cpu, teach};
use memrep::concept::DfaClass;
use memrep::identify::{EngineChoice, Settings};
use memrep::learner::{Config, Learner, Strategy};
use memrep::oracle::{Counterexamples, Order, ScriptedTeacher, Target, TeacherSettings};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

fn main() -> anyhow::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [strategies, targets, costs, seeds, rest @ ..] = &arguments[..] else {
        anyhow::bail!("give STRATEGIES TARGETS COSTS SEEDS");
    };
    let order = if rest.iter().any(|word| word == "random") {
        Order::Random
    } else {
        Order::Ordered
    };
    let first: u64 = std::env::var("FIRST")
        .ok()
        .and_then(|v| v.parse().ok())
        .unwrap_or(0);
    let seeds: u64 = seeds.parse()?;
    let mut drawn = Vec::new();
    for name in targets.split(',') {
        drawn.extend(named(name)?);
    }
    for target in &drawn {
        for cost in costs.split(',') {
            let cost: f64 = cost.parse()?;
            for strategy in strategies.split(',') {
                for seed in first..first + seeds {
                    run(strategy, target, cost, seed, order)?;
                }
            }
        }
    }
    Ok(())
}

fn run(strategy: &str, target: &Target, cost: f64, seed: u64, order: Order) -> anyhow::Result<()> {
    let chosen = match strategy {
        "bayes" => Strategy::Bayes,
        "thesis" => Strategy::Thesis,
        "membership" => Strategy::Membership,
        other => anyhow::bail!("no strategy {other}"),
    };
    let config = Config {
        strategy: chosen,
        membership_cost: cost,
        comparison_cost: 1.0,
        equivalence_cost: env("EQ", 4.0) * cost,
        shortest_counterexamples: env("SX", 0.0) > 0.0,
        seed,
        budget: 1_000_000,
        ..Config::default()
    };
    let settings = Settings {
        engine: EngineChoice::Auto,
        max_states: 15,
    };
    let class = DfaClass::new(target.dfa().alphabet().clone(), settings);
    let mut learner = Learner::new(class, config, target.known().to_vec());
    let settings = TeacherSettings {
        order,
        counterexamples: Counterexamples::Random,
        error_rate: 0.0,
        seed,
    };
    let mut teacher = ScriptedTeacher::new(target, settings);
    let most = std::env::var("MOST")
        .ok()
        .and_then(|v| v.parse().ok())
        .unwrap_or(300);
    let report = teach(&mut learner, &mut teacher, most, process_cpu, |asked| {
        if std::env::var("SHOW").is_ok() {
            eprintln!("{asked:?}");
        }
    })?;
    let counts = report.counts;
    let ms = |percent| percentile(&report.question_times, percent).as_secs_f64() * 1000.0;
    println!(
        "{strategy},{},{},{cost},{seed},{},{},{},{},{:.1},{:.1},{:.1},{}",
        target.name(),
        target.dfa().size(),
        counts.membership,
        counts.comparison,
        counts.equivalence,
        u8::from(
            report
                .learned
                .is_some_and(|dfa| dfa.is_equivalent(target.dfa()) == Ok(true))
        ),
        ms(50),
        ms(95),
        ms(100),
        report.hurried,
    );
    Ok(())
}

fn env(name: &str, default: f64) -> f64 {
    std::env::var(name)
        .ok()
        .and_then(|v| v.parse().ok())
        .unwrap_or(default)
}

fn named(name: &str) -> anyhow::Result<Vec<Target>> {
    let number = |text: &str| text.parse::<u64>();
    Ok(match name.split_once(':') {
        Some(("random", n)) => (0..number(n)?)
            .map(|seed| drawn("random", seed, (3, 8), (2, 4)))
            .collect(),
        Some(("task", n)) => (0..number(n)?)
            .map(|seed| drawn("task", seed, (3, 8), (3, 4)))
            .collect(),
        Some(("small", n)) => (0..number(n)?)
            .map(|seed| drawn("small", seed, (3, 5), (2, 2)))
            .collect(),
        _ if name == "tomita" => (1..=7)
            .map(|n| Target::named(&format!("tomita:{n}")))
            .collect::<Result<_, _>>()?,
        _ => vec![Target::named(name)?],
    })
}

/// A minimal automaton; of a task's shape, two thirds of the edges stay and the
/// last state is a sink.
fn drawn(shape: &str, seed: u64, states: (u32, u32), letters: (u32, u32)) -> Target {
    let mut random = ChaCha8Rng::seed_from_u64(1000 + seed);
    let size = random.random_range(states.0..=states.1) as usize;
    let symbols = random.random_range(letters.0..=letters.1) as usize;
    let names = ["a", "b", "c", "d"];
    let alphabet = Alphabet::new(names.into_iter().take(symbols)).expect("good names");
    loop {
        let mut delta = vec![vec![0; symbols]; size];
        for (state, row) in delta.iter_mut().enumerate() {
            for target in row {
                *target = random.random_range(0..size as u32) as usize;
                let stays = random.random_range(0..3_u32) < 2;
                if shape == "task" && (stays || state == size - 1) {
                    *target = state;
                }
            }
        }
        let mut accepting: Vec<bool> = (0..size).map(|_| random.random()).collect();
        if shape == "task" {
            accepting[size - 1] = false;
        }
        let dfa = Dfa::new(alphabet.clone(), 0, accepting, &delta).expect("in range");
        if dfa.minimise().size() == size {
            return Target::automaton(format!("{shape}:{seed}"), &dfa);
        }
    }
}
