//! Learning in grids: what was learned agrees with the target on everything that
//! can happen.

use std::sync::Arc;
use std::time::Duration;

use automata::{Dfa, Word};
use memrep::bench::{Report, process_cpu, teach};
use memrep::concept::{Prior, Situated, Template};
use memrep::identify::{EngineChoice, Settings};
use memrep::learner::{Config, Learner, Question, Strategy};
use memrep::oracle::{Counterexamples, Order, SituatedTeacher, Target, TeacherSettings};
use memrep::world::World;
use memrep::world::grid::Labelling;
use rand::RngExt;

use crate::draw::{self, Sort, automaton};

pub(crate) fn settings() -> Settings {
    Settings {
        engine: EngineChoice::Auto,
        max_states: 24,
    }
}

/// The atoms of a question.
pub(crate) fn atoms(question: &Question<Word, Dfa>) -> Vec<Word> {
    match question {
        Question::Membership { atom } => vec![atom.clone()],
        Question::Comparison { first, second } => vec![first.clone(), second.clone()],
        Question::Equivalence { .. } => Vec::new(),
    }
}

/// Teaches a target in a world, and sees to it that every question can happen and
/// is open.
pub(crate) fn learn(
    world: &Arc<World>,
    prior: &Prior,
    target: &Target,
    config: Config,
    teacher: TeacherSettings,
) -> Report<Dfa> {
    let class = Situated::new(Arc::clone(world), prior.clone(), settings()).unwrap();
    let known = class.examples(target.known()).unwrap();
    let open = prior.open().clone();
    let mut teacher = SituatedTeacher::new(Arc::clone(world), open, target, teacher);
    let mut learner = Learner::new(class, config, known);
    teach(&mut learner, &mut teacher, 500, process_cpu, |asked| {
        for atom in atoms(asked.question) {
            assert!(world.is_feasible(&atom), "it cannot happen");
            assert_eq!(prior.settled(&atom), None, "it is settled");
        }
    })
    .expect("the setup is sound")
}

/// Whether two languages agree on everything that can happen and is open.
pub(crate) fn agree(world: &World, prior: &Prior, one: &Dfa, other: &Dfa) -> bool {
    let differ = one.xor(other).unwrap().and(prior.open()).unwrap();
    !world.has_word(&differ)
}

/// What is known beforehand in every third run, and a target that keeps it.
fn drawn_task(
    world: &World,
    number: u64,
    random: &mut rand_chacha::ChaCha8Rng,
) -> Option<(Prior, Target)> {
    let symbols = world.alphabet();
    let mut target = automaton(symbols, 4, random);
    let [a, b] = [0, 1].map(automata::Symbol::new);
    let template = match number % 6 {
        1 => Some((Template::Avoid(a), true)),
        3 => Some((Template::Reach(b), true)),
        5 => Some((Template::NeverAfter(a, b), false)),
        _ => None,
    };
    let prior = match template {
        None => Prior::none(symbols),
        Some((template, holds)) => {
            let known = template.dfa(symbols);
            target = if holds {
                target.and(&known)
            } else {
                target.or(&known)
            }
            .unwrap();
            let (holding, sufficing) = if holds {
                (vec![known], Vec::new())
            } else {
                (Vec::new(), vec![known])
            };
            Prior::new(symbols, holding, sufficing).unwrap()
        }
    };
    let is_open = world.has_word(prior.open());
    is_open.then(|| (prior, Target::automaton("drawn", &target)))
}

/// Teaches random targets in the random grids of these numbers.
fn learn_in_grids(numbers: std::ops::Range<u64>, strategy: Strategy) {
    let mut taught = 0;
    let mut times: Vec<Duration> = Vec::new();
    let mut questions = 0;
    for number in numbers.clone() {
        let mut random = draw::random(5000 + number);
        let sort = Sort {
            rows: random.random_range(2..=6),
            columns: random.random_range(2..=6),
            letters: random.random_range(2..=3),
            silent: 0,
            coloured: random.random_range(10..=60),
            walls: random.random_range(0..=20),
            labelling: if number.is_multiple_of(4) {
                Labelling::EveryStep
            } else {
                Labelling::Entry
            },
            steps: random.random_range(4..=30),
        };
        let world = Arc::new(World::Grid(draw::grid(&sort, &mut random)));
        let Some((prior, target)) = drawn_task(&world, number, &mut random) else {
            continue;
        };
        let config = Config {
            strategy,
            seed: number,
            ..Config::default()
        };
        let teacher = TeacherSettings {
            order: if number.is_multiple_of(2) {
                Order::Ordered
            } else {
                Order::Random
            },
            counterexamples: if number.is_multiple_of(3) {
                Counterexamples::Random
            } else {
                Counterexamples::Shortest
            },
            error_rate: 0.0,
            seed: number,
        };
        let report = learn(&world, &prior, &target, config, teacher);
        let learned = report
            .learned
            .unwrap_or_else(|| panic!("grid {number}: nothing was learned"));
        assert!(
            agree(&world, &prior, &learned, target.dfa()),
            "grid {number}"
        );
        let whole = prior.whole(&learned);
        assert!(
            !world.has_word(&whole.xor(target.dfa()).unwrap()),
            "grid {number}"
        );
        taught += 1;
        questions += report.question_times.len();
        times.extend(report.question_times);
    }
    times.sort_unstable();
    let at = |share: usize| times[(times.len() - 1) * share / 100];
    println!(
        "{strategy:?} in {taught} grids: {questions} questions, median {:?}, 95 of 100 {:?}, at most {:?}",
        at(50),
        at(95),
        at(100)
    );
    assert!(taught * 10 > numbers.count() * 7, "few grids were left");
}

#[test]
fn random_targets_are_learned_in_random_grids_by_posterior() {
    learn_in_grids(0..40, Strategy::Bayes);
}

#[test]
fn random_targets_are_learned_in_random_grids_by_elimination() {
    learn_in_grids(40..280, Strategy::Thesis);
}
