//! Grids as large as they get: 50 × 50 cells, 8 colours. Times are told, and what
//! must hold is asserted.

use std::sync::Arc;
use std::time::Duration;

use automata::Dfa;
use memrep::bench::{process_cpu, teach};
use memrep::concept::{ConceptClass, Prior, Situated};
use memrep::learner::{Config, Learner, Strategy};
use memrep::oracle::{SituatedTeacher, Target, TeacherSettings};
use memrep::world::World;
use memrep::world::grid::Labelling;
use rand_chacha::ChaCha8Rng;

use crate::draw::{self, Sort, automaton, since};
use crate::learn::{agree, atoms, settings};

/// Of a hundred cells so many coloured and walls, and the steps.
const SORTS: [(u32, u32, usize); 4] = [(1, 30, 300), (2, 5, 150), (20, 10, 150), (100, 0, 60)];

/// A large grid of this sort; the ninth symbol has no tile.
fn large((coloured, walls, steps): (u32, u32, usize)) -> Arc<World> {
    let sort = Sort {
        rows: 50,
        columns: 50,
        letters: 9,
        silent: 1,
        coloured,
        walls,
        labelling: Labelling::Entry,
        steps,
    };
    Arc::new(World::Grid(draw::grid(&sort, &mut draw::random(1))))
}

fn show(what: &str, times: &mut [Duration]) {
    times.sort_unstable();
    let at = |share: usize| times[(times.len() - 1) * share / 100];
    let (median, most) = (at(50), at(100));
    println!(
        "{what}: median {median:?}, 95 of 100 {:?}, at most {most:?} of {}",
        at(95),
        times.len()
    );
}

/// A minimal automaton of exactly so many states.
fn of_size(world: &World, states: usize, random: &mut ChaCha8Rng) -> Dfa {
    loop {
        let dfa = automaton(world.alphabet(), states, random).minimise();
        if dfa.size() == states {
            return dfa;
        }
    }
}

/// Accepts what the ninth symbol ends, wherever the automaton is: nothing of that
/// can be shown, and no state is useless.
fn ended_by_the_ninth(dfa: &Dfa) -> Dfa {
    let end = dfa.size();
    let mut rows: Vec<Vec<usize>> = dfa
        .states()
        .map(|q| {
            dfa.alphabet()
                .symbols()
                .map(move |a| dfa.next(q, a).index())
        })
        .map(|row| row.take(8).chain([end]).collect())
        .collect();
    rows.push(vec![end; 9]);
    let accepting = (0..=end).map(|state| state == end).collect();
    Dfa::new(
        dfa.alphabet().clone(),
        dfa.start().index(),
        accepting,
        &rows,
    )
    .unwrap()
}

#[test]
fn witnesses_in_large_grids() {
    for sort in SORTS {
        let start = process_cpu();
        let world = large(sort);
        let prior = Prior::none(world.alphabet());
        let class = Situated::new(Arc::clone(&world), prior, settings()).unwrap();
        let states = world.outline().map_or(0, |outline| outline.size());
        println!("{sort:?}: made in {:?}, outline of {states}", since(start));
        for states in [6, 12] {
            let mut random = draw::random(states as u64);
            let (mut found, mut searched, mut none) = (Vec::new(), Vec::new(), Vec::new());
            for _ in 0..20 {
                let one = of_size(&world, states, &mut random);
                let other = of_size(&world, states, &mut random);
                let only_one = one.product(&other, |one, other| one && !other).unwrap();
                let start = process_cpu();
                let witness = class.witnesses(&one, &other, 1);
                found.push(since(start));
                let start = process_cpu();
                assert_eq!(world.simplest(&only_one, 1), witness);
                searched.push(since(start));
                for word in witness {
                    assert!(world.is_feasible(&word));
                    assert!(one.accepts(&word) && !other.accepts(&word));
                }
                let silent = ended_by_the_ninth(&only_one);
                let start = process_cpu();
                assert!(!world.has_word(&silent));
                none.push(since(start));
            }
            show(
                &format!("  {states} states, asked of the class"),
                &mut found,
            );
            show(&format!("  {states} states, searched"), &mut searched);
            show(&format!("  {states} states, none to be found"), &mut none);
        }
    }
}

/// Asks up to so many questions about a drawn target.
fn ask(world: &Arc<World>, states: usize, strategy: Strategy, most: u32) -> Vec<Duration> {
    let prior = Prior::none(world.alphabet());
    let target = of_size(world, states, &mut draw::random(states as u64));
    let target = Target::automaton("drawn", &target);
    let class = Situated::new(Arc::clone(world), prior.clone(), settings()).unwrap();
    let open = prior.open().clone();
    let mut teacher =
        SituatedTeacher::new(Arc::clone(world), open, &target, TeacherSettings::default());
    let config = Config {
        strategy,
        ..Config::default()
    };
    let mut learner = Learner::new(class, config, Vec::new());
    let report = teach(&mut learner, &mut teacher, most, process_cpu, |asked| {
        for atom in atoms(asked.question) {
            assert!(world.is_feasible(&atom));
        }
    });
    let report = report.expect("the teacher does not err");
    if let Some(learned) = report.learned {
        assert!(agree(world, &prior, &learned, target.dfa()));
    }
    report.question_times
}

#[test]
fn questions_in_large_grids() {
    for sort in SORTS {
        let world = large(sort);
        for states in [4, 6] {
            for (strategy, most) in [(Strategy::Bayes, 10), (Strategy::Thesis, 40)] {
                let mut times = ask(&world, states, strategy, most);
                show(
                    &format!("{sort:?} {states} states {strategy:?}"),
                    &mut times,
                );
            }
        }
    }
}
