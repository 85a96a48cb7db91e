//! Nothing that is already known is asked: a thousand sessions, every question
//! of which is held against all that the answers before it imply.

use std::fmt::Debug;

use automata::{Alphabet, Dfa, Word};
use memrep::concept::{ConceptClass, DfaClass, FiniteAtom, FiniteClass, FiniteConcept};
use memrep::evidence::{AnswerId, Comparison, Fact};
use memrep::identify::{EngineChoice, Settings};
use memrep::learner::{Config, Conformance, Entry, Learner, Question, Reply, Step, Strategy};
use memrep::oracle::{Counterexamples, Order, ScriptedTeacher, Target, TeacherSettings};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::finite::config;
use crate::teacher::{TableTeacher, reply};

/// Whether any preorder and any set of atoms agree with the facts: the least
/// preorder does if one does. Knows nothing of how the learner finds out.
pub(crate) fn is_possible<A: PartialEq>(facts: &[Fact<A>]) -> bool {
    let mut atoms: Vec<&A> = Vec::new();
    let mut number = |atom| {
        atoms
            .iter()
            .position(|known| *known == atom)
            .unwrap_or_else(|| {
                atoms.push(atom);
                atoms.len() - 1
            })
    };
    let (mut edges, mut strict, mut apart) = (Vec::new(), Vec::new(), Vec::new());
    let mut labels = [Vec::new(), Vec::new()];
    for fact in facts {
        match fact {
            Fact::Label { atom, accepted } => labels[usize::from(*accepted)].push(number(atom)),
            Fact::Below { worse, better } => {
                let (low, high) = (number(worse), number(better));
                edges.push((low, high));
                strict.push((low, high));
            }
            Fact::Equal { first, second } => {
                let (one, other) = (number(first), number(second));
                edges.extend([(one, other), (other, one)]);
            }
            Fact::Incomparable { first, second } => apart.push((number(first), number(second))),
        }
    }
    let count = atoms.len();
    assert!(count <= 128, "the rows are too short for {count} atoms");
    let mut above: Vec<u128> = (0..count).map(|atom| 1 << atom).collect();
    for (low, high) in edges {
        above[low] |= 1 << high;
    }
    // Warshall's closure.
    for through in 0..count {
        for low in 0..count {
            if above[low] >> through & 1 == 1 {
                above[low] |= above[through];
            }
        }
    }
    let at_most = |low: usize, high: usize| above[low] >> high & 1 == 1;
    let [rejected, accepted] = labels;
    !strict.iter().any(|&(low, high)| at_most(high, low))
        && !apart
            .iter()
            .any(|&(one, other)| at_most(one, other) || at_most(other, one))
        && !accepted
            .iter()
            .any(|&low| rejected.iter().any(|&high| at_most(low, high)))
}

fn possible<A: Clone + PartialEq>(facts: &[Fact<A>], outcomes: &[Fact<A>]) -> usize {
    let allows = |outcome: &&Fact<A>| {
        let mut more = facts.to_vec();
        more.push((*outcome).clone());
        is_possible(&more)
    };
    outcomes.iter().filter(allows).count()
}

fn labels<A: Clone>(atom: &A) -> [Fact<A>; 2] {
    [true, false].map(|accepted| Fact::Label {
        atom: atom.clone(),
        accepted,
    })
}

/// Panics if the question need not be asked.
fn check<C: ConceptClass>(
    learner: &Learner<C>,
    facts: &[Fact<C::Atom>],
    question: &Question<C::Atom, C::Concept>,
) {
    for entry in learner.entries() {
        let again = match (&entry.question, question) {
            (
                Question::Comparison { first, second },
                Question::Comparison {
                    first: one,
                    second: other,
                },
            ) => (first, second) == (one, other) || (second, first) == (one, other),
            (asked, question) => asked == question,
        };
        assert!(!again, "{question:?} again after {:?}", learner.entries());
    }
    match question {
        Question::Membership { atom } => {
            let open = possible(facts, &labels(atom)) == 2;
            assert!(open, "{question:?} is implied by {facts:?}");
        }
        Question::Comparison { first, second } => {
            let answers = [
                Comparison::First,
                Comparison::Second,
                Comparison::Equal,
                Comparison::Incomparable,
            ];
            let outcomes =
                answers.map(|answer| Fact::compared(first.clone(), second.clone(), answer));
            let open = possible(facts, &outcomes) > 1;
            assert!(open, "{question:?} is implied by {facts:?}");
            // Between two atoms whose labels are known no answer says anything
            // about any label.
            let known = [first, second].map(|atom| possible(facts, &labels(atom)) < 2);
            assert!(
                known != [true, true],
                "{question:?} says nothing after {facts:?}"
            );
        }
        Question::Equivalence { hypothesis } => {
            let contains = |atom: &C::Atom| learner.class().contains(hypothesis, atom);
            let refuted = facts.iter().find(|fact| !fact.holds(contains));
            assert_eq!(refuted, None, "{question:?} is refuted by {facts:?}");
        }
    }
}

/// One session with random skips and a few answers taken back; every question is
/// checked. Returns how many were asked.
fn session<C: ConceptClass>(
    class: C,
    config: &Config,
    given: &[Fact<C::Atom>],
    mut answer: impl FnMut(&Question<C::Atom, C::Concept>) -> Reply<C::Atom>,
    is_target: impl Fn(&C::Concept) -> bool,
    random: &mut ChaCha8Rng,
) -> u32
where
    C::Atom: Debug,
{
    let mut learner = Learner::new(class, config.clone(), given.to_vec());
    let mut withdrawn = 0;
    for number in 0..400 {
        let (question, round) = match learner.next() {
            Step::Ask {
                question, round, ..
            } => (question, round),
            Step::Done { hypothesis } => {
                assert!(is_target(&hypothesis), "{hypothesis:?}");
                return number;
            }
            Step::Conflict(conflict) => panic!("{conflict:?} of {:?}", learner.entries()),
        };
        let mut facts = given.to_vec();
        facts.extend(learner.entries().iter().filter_map(Entry::fact));
        check(&learner, &facts, &question);
        let shown = matches!(question, Question::Equivalence { .. });
        let reply = if !shown && random.random_ratio(1, 12) {
            Reply::Skip
        } else {
            answer(&question)
        };
        learner
            .record(AnswerId(number), question, round, reply)
            .expect("it fits");
        if withdrawn < 2 && random.random_ratio(1, 25) {
            let place = random.random_range(0..learner.entries().len());
            let answer = learner.entries()[place].answer;
            assert!(learner.retract(answer));
            withdrawn += 1;
        }
    }
    panic!("not learned with {config:?}: {:?}", learner.entries());
}

fn some_config(strategy: Strategy, random: &mut ChaCha8Rng) -> Config {
    let conformance = Conformance::new(0.2, 0.2).expect("both are shares");
    Config {
        membership_cost: [1.0, 4.0, 8.0][random.random_range(0..3)],
        conformance: random.random_ratio(1, 3).then_some(conformance),
        ..config(strategy, random.random())
    }
}

/// An automaton with at most so many states, drawn at random.
fn some_automaton(states: usize, random: &mut ChaCha8Rng) -> Dfa {
    let symbols = random.random_range(2..=3);
    let alphabet = Alphabet::new(["a", "b", "c"][..symbols].iter().copied()).unwrap();
    let states = random.random_range(1..=states);
    let delta: Vec<Vec<usize>> = (0..states)
        .map(|_| {
            (0..symbols)
                .map(|_| random.random_range(0..states))
                .collect()
        })
        .collect();
    let accepting = (0..states).map(|_| random.random()).collect();
    Dfa::new(alphabet, 0, accepting, &delta).unwrap().minimise()
}

fn over_automata(strategy: Strategy, sessions: u64, states: usize) {
    let mut asked = 0;
    for seed in 0..sessions {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let target = Target::automaton("random", &some_automaton(states, &mut random));
        let settings = TeacherSettings {
            order: [Order::Ordered, Order::Random][random.random_range(0..2)],
            counterexamples: [Counterexamples::Shortest, Counterexamples::Random]
                [random.random_range(0..2)],
            error_rate: 0.0,
            seed,
        };
        let mut teacher = ScriptedTeacher::new(&target, settings);
        let bound = Settings {
            engine: EngineChoice::Auto,
            max_states: 12,
        };
        let class = DfaClass::new(target.dfa().alphabet().clone(), bound);
        // At times a label is known.
        let empty = Word::empty();
        let given = match random.random_range(0..3) {
            0 => vec![Fact::Label {
                accepted: target.dfa().accepts(&empty),
                atom: empty,
            }],
            _ => Vec::new(),
        };
        let config = some_config(strategy, &mut random);
        let answer = |question: &Question<Word, Dfa>| reply(&mut teacher, question);
        let is_target = |learned: &Dfa| learned.is_equivalent(target.dfa()) == Ok(true);
        asked += session(class, &config, &given, answer, is_target, &mut random);
    }
    assert!(u64::from(asked) > 5 * sessions, "only {asked} questions");
}

/// Up to thirty sets of ten atoms, with sizes from 1 to 4.
pub(crate) fn some_class(random: &mut ChaCha8Rng) -> FiniteClass {
    let count = random.random_range(2..30);
    let mut sets: Vec<u16> = (0..count)
        .map(|_| random.random_range(0..1 << 10))
        .collect();
    sets.sort_unstable();
    sets.dedup();
    let columns = sets.into_iter().map(|set| {
        let contains = (0..10).map(|atom| set >> atom & 1 == 1).collect();
        (random.random_range(1..=4), contains)
    });
    FiniteClass::new(10, columns).unwrap()
}

/// One chain, or two between which nothing can be compared; in each the accepted
/// atoms are on top.
pub(crate) fn some_order(
    class: &FiniteClass,
    target: FiniteConcept,
    random: &mut ChaCha8Rng,
) -> impl Fn(FiniteAtom, FiniteAtom) -> Comparison + use<> {
    let strands = random.random_range(1..=2u32);
    let places: Vec<(u32, bool, u32)> = (class.atoms())
        .map(|atom| {
            (
                random.random_range(0..strands),
                class.contains(&target, &atom),
                random.random_range(0..3),
            )
        })
        .collect();
    move |first, second| {
        let [one, other] = [first, second].map(|atom| places[atom.0 as usize]);
        if one.0 != other.0 {
            Comparison::Incomparable
        } else if one == other {
            Comparison::Equal
        } else if one > other {
            Comparison::First
        } else {
            Comparison::Second
        }
    }
}

fn over_tables(strategy: Strategy, sessions: u64) {
    let mut asked = 0;
    for seed in 0..sessions {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let class = some_class(&mut random);
        let concepts: Vec<FiniteConcept> = class.concepts().collect();
        let target = concepts[random.random_range(0..concepts.len())];
        let order = some_order(&class, target, &mut random);
        let config = some_config(strategy, &mut random);
        let mut teacher = TableTeacher {
            class: &class,
            target,
            order,
        };
        let answer = |question: &Question<FiniteAtom, FiniteConcept>| reply(&mut teacher, question);
        let is_target = |learned: &FiniteConcept| *learned == target;
        asked += session(class.clone(), &config, &[], answer, is_target, &mut random);
    }
    assert!(u64::from(asked) > 3 * sessions, "only {asked} questions");
}

#[test]
fn four_hundred_and_forty_sessions_over_automata() {
    over_automata(Strategy::Thesis, 290, 4);
    over_automata(Strategy::Membership, 150, 4);
}

#[test]
fn two_dozen_sessions_over_automata_by_the_posterior() {
    over_automata(Strategy::Bayes, 12, 3);
    over_automata(Strategy::Exp4Plus, 12, 3);
}

#[test]
fn seven_hundred_and_fifty_sessions_over_tables() {
    over_tables(Strategy::Thesis, 250);
    over_tables(Strategy::Membership, 100);
    over_tables(Strategy::Bayes, 200);
    over_tables(Strategy::Exp4Plus, 200);
}
