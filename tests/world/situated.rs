//! Automata learned in a world, beside what the world and the prior say of
//! themselves.

use std::collections::BTreeSet;
use std::sync::Arc;

use automata::{Dfa, Word};
use memrep::bench::{process_cpu, teach};
use memrep::concept::{ConceptClass, DfaClass, Prior, Situated, Template, Wish};
use memrep::evidence::{Budget, Fact};
use memrep::learner::{Config, Learner, Strategy};
use memrep::oracle::{ScriptedTeacher, Target, TeacherSettings};
use memrep::world::grid::{GridMap, Labelling};
use memrep::world::{Words, World};

use crate::draw::{self, Sort, automaton};
use crate::learn::settings;

/// A small grid, and something known of it that leaves something open.
fn drawn(number: u64) -> (Arc<World>, Prior) {
    let mut random = draw::random(900 + number);
    loop {
        let sort = Sort {
            rows: 3,
            columns: 3,
            letters: 2,
            silent: 0,
            coloured: 40,
            walls: 10,
            labelling: Labelling::Entry,
            steps: 7,
        };
        let world = World::Grid(draw::grid(&sort, &mut random));
        let symbols = world.alphabet();
        let holding = vec![automaton(symbols, 3, &mut random)];
        let sufficing = vec![automaton(symbols, 2, &mut random)];
        if let Ok(prior) = Prior::new(symbols, holding, sufficing)
            && world.has_word(prior.open())
        {
            return (Arc::new(world), prior);
        }
    }
}

fn class(world: &Arc<World>, prior: &Prior) -> Situated {
    Situated::new(Arc::clone(world), prior.clone(), settings()).unwrap()
}

/// All that is feasible and open, simplest first.
fn open_words(world: &World, prior: &Prior) -> Vec<Word> {
    let listing = world.list(prior.open(), 100_000);
    assert!(listing.complete);
    listing.words
}

#[test]
fn atoms_witnesses_and_draws_are_open_and_can_happen() {
    let mut drawn_words = 0;
    for number in 0..30 {
        let (world, prior) = drawn(number);
        let class = class(&world, &prior);
        let words = open_words(&world, &prior);
        assert_eq!(class.atoms().collect::<Vec<_>>(), words);
        let mut random = draw::random(number);
        let [one, other] = [0; 2].map(|_| automaton(world.alphabet(), 4, &mut random));
        let separates = |word: &&Word| one.accepts(word) && !other.accepts(word);
        for count in [1, 3, 100_000] {
            let expected: Vec<Word> = words
                .iter()
                .filter(separates)
                .take(count)
                .cloned()
                .collect();
            assert_eq!(class.witnesses(&one, &other, count), expected);
        }
        for word in words.iter().step_by(7) {
            let effort = world.effort(word);
            let expected: Vec<Word> = words
                .iter()
                .take_while(|other| world.effort(other) < effort)
                .cloned()
                .collect();
            assert_eq!(class.simpler(word), expected);
        }
        let drawn = class.draw(&one, 40, &mut random);
        assert_eq!(drawn.len(), 40);
        assert!(drawn.iter().all(|word| words.contains(word)));
        let accepted = drawn.iter().filter(|word| one.accepts(word)).count();
        if [true, false].map(|l| words.iter().any(|w| one.accepts(w) == l)) == [true; 2] {
            assert!((5..=35).contains(&accepted), "{accepted} of 40");
            drawn_words += 1;
        }
    }
    assert!(drawn_words > 5);
}

/// All words beyond the simplest thousand come, and in order.
#[test]
fn atoms_do_not_end_with_the_catalogue() {
    let symbols = draw::alphabet(2);
    let world = Arc::new(World::Words(Words::new(symbols.clone(), 10)));
    let rule = Template::parse("reach b", &symbols).unwrap().dfa(&symbols);
    let prior = Prior::new(&symbols, vec![rule.clone()], Vec::new()).unwrap();
    let class = class(&world, &prior);
    let expected = symbols.words_up_to(10).filter(|word| rule.accepts(word));
    assert!(class.atoms().eq(expected));
}

/// The labels of all that is feasible and open.
fn labels(dfa: &Dfa, words: &[Word]) -> Vec<bool> {
    words.iter().map(|word| dfa.accepts(word)).collect()
}

/// No two concepts have the same labels, and none that was merged is lost: every
/// labelling that some small automaton has, and that the facts allow, is there.
#[test]
fn concepts_that_nothing_separates_are_one() {
    let mut merged = 0;
    for number in 0..30 {
        let (world, prior) = drawn(number);
        let words = open_words(&world, &prior);
        let symbols = world.alphabet().clone();
        let mut class = class(&world, &prior);
        let mut plain = DfaClass::new(symbols.clone(), settings());
        let target = automaton(&symbols, 3, &mut draw::random(number));
        for atom in words.iter().take(3) {
            let fact = Fact::Label {
                atom: atom.clone(),
                accepted: target.accepts(atom),
            };
            class.add(None, fact.clone());
            plain.add(None, fact);
        }
        let wish = Wish {
            sizes: 2,
            decay: 0.5,
            listed: 1000,
            heard: &[],
            seed: 0,
        };
        let all = plain.spread(&wish, &mut Budget::unlimited()).unwrap();
        let ours = class.spread(&wish, &mut Budget::unlimited()).unwrap();
        let different: BTreeSet<Vec<bool>> = ours
            .concepts
            .iter()
            .map(|c| labels(&c.concept, &words))
            .collect();
        assert_eq!(different.len(), ours.concepts.len(), "two are one");
        if all.exact && ours.exact {
            let expected: BTreeSet<Vec<bool>> = all
                .concepts
                .iter()
                .map(|c| labels(&c.concept, &words))
                .collect();
            assert_eq!(different, expected);
            merged += all.concepts.len() - different.len();
        }
        let sample = class.sample(32, 0, &mut Budget::unlimited()).unwrap();
        let sampled: BTreeSet<Vec<bool>> =
            sample.concepts.iter().map(|c| labels(c, &words)).collect();
        assert_eq!(sampled.len(), sample.concepts.len(), "two are one");
    }
    assert!(merged > 100, "{merged}");
}

/// Where everything can happen and nothing is known, the questions are those of
/// plain automata.
#[test]
fn without_world_and_prior_the_questions_are_the_same() {
    for strategy in [Strategy::Bayes, Strategy::Thesis] {
        let target = Target::named("tomita:4").unwrap();
        let config = Config {
            strategy,
            ..Config::default()
        };
        let symbols = target.dfa().alphabet().clone();
        let world = Arc::new(World::Words(Words::new(symbols.clone(), 1000)));
        let run = |learner: &mut dyn FnMut(&mut Vec<String>)| {
            let mut asked = Vec::new();
            learner(&mut asked);
            asked
        };
        let known = target.known().to_vec();
        let mut teacher = ScriptedTeacher::new(&target, TeacherSettings::default());
        let situated = run(&mut |asked| {
            let class = class(&world, &Prior::none(&symbols));
            let mut learner = Learner::new(class, config.clone(), known.clone());
            teach(&mut learner, &mut teacher, 100, process_cpu, |question| {
                asked.push(format!("{:?}", question.question));
            })
            .unwrap();
        });
        let mut teacher = ScriptedTeacher::new(&target, TeacherSettings::default());
        let plain = run(&mut |asked| {
            let class = DfaClass::new(symbols.clone(), settings());
            let mut learner = Learner::new(class, config.clone(), known.clone());
            teach(&mut learner, &mut teacher, 100, process_cpu, |question| {
                asked.push(format!("{:?}", question.question));
            })
            .unwrap();
        });
        assert_eq!(situated, plain);
    }
}

#[test]
fn a_learner_in_a_world_can_be_sent() {
    fn is_send<T: Send>() {}
    is_send::<Learner<Situated>>();
}

/// What tells concepts apart may be far: thousands of other behaviours take less.
#[test]
fn what_only_a_far_tile_tells_apart_is_not_one() {
    let symbols = draw::alphabet(3);
    let text = format!("aSb{}c", ".".repeat(36));
    let grid = GridMap::new(&symbols, &text).grid(symbols.clone(), Labelling::Entry, 60);
    let world = Arc::new(World::Grid(grid.unwrap()));
    let mut class = class(&world, &Prior::none(&symbols));
    let far = symbols.word(["b", "c"]).unwrap();
    let known = |atom: &Word| Fact::Label {
        atom: atom.clone(),
        accepted: true,
    };
    // Nothing without a `c` is rejected.
    for word in class.atoms().take(300).collect::<Vec<_>>() {
        assert!(word.iter().all(|symbol| symbol != far.symbols()[1]));
        class.add(None, known(&word));
    }
    let wish = Wish {
        sizes: 2,
        decay: 0.5,
        listed: 1000,
        heard: &[],
        seed: 0,
    };
    let spread = class.spread(&wish, &mut Budget::unlimited()).unwrap();
    let rejects = |dfa: &&Dfa| !dfa.accepts(&far);
    let concepts: Vec<&Dfa> = spread.concepts.iter().map(|c| &c.concept).collect();
    let lost = concepts.iter().copied().find(rejects).expect("it is apart");
    let all = concepts.iter().find(|dfa| dfa.size() == 1).unwrap();
    let only_all = all.and(&lost.complement()).unwrap();
    let expected: Vec<Word> = world.words_in(&only_all).take(2).collect();
    assert_eq!(class.witnesses(all, lost, 2), expected);
    assert!(!expected.is_empty() && world.is_feasible(&far));
}
