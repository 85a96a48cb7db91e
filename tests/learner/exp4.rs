//! The bandit over the posterior's best questions: it ends with the target, and
//! its rounds are those of EXP4, which a twin plays along.

use automata::{Dfa, Word};
use memrep::bench::{process_cpu, teach};
use memrep::concept::{
    ConceptClass, DfaClass, Failure, FiniteAtom, FiniteClass, FiniteConcept, Sample, Spread, Wish,
};
use memrep::evidence::{AnswerId, Budget, Comparison, Fact};
use memrep::identify::{EngineChoice, Settings};
use memrep::learner::{Config, Learner, Losses, Question, Reply, Round, Step, Strategy};
use memrep::oracle::{Counterexamples, Order, ScriptedTeacher, Target, Teacher, TeacherSettings};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::json;

use crate::finite::config;
use crate::implied::{some_class, some_order};
use crate::teacher::{TableTeacher, reply};

fn automata(target: &Target) -> DfaClass {
    let settings = Settings {
        engine: EngineChoice::Auto,
        max_states: 16,
    };
    DfaClass::new(target.dfa().alphabet().clone(), settings)
}

fn costing(membership_cost: f64, seed: u64) -> Config {
    Config {
        membership_cost,
        equivalence_cost: 4.0 * membership_cost,
        ..config(Strategy::Exp4Plus, seed)
    }
}

#[test]
fn every_target_is_learned() {
    for number in 1..=7 {
        let target = Target::named(&format!("tomita:{number}")).unwrap();
        for (membership_cost, order) in [(1.0, Order::Random), (8.0, Order::Ordered)] {
            let config = costing(membership_cost, number);
            let mut learner = Learner::new(automata(&target), config, target.known().to_vec());
            let settings = TeacherSettings {
                order,
                counterexamples: Counterexamples::Random,
                error_rate: 0.0,
                seed: number,
            };
            let mut teacher = ScriptedTeacher::new(&target, settings);
            let report = teach(&mut learner, &mut teacher, 200, process_cpu, |_| ())
                .expect("the setup is sound");
            let learned = report
                .learned
                .unwrap_or_else(|| panic!("{number}, {order:?}"));
            assert_eq!(learned, target.dfa().canonical(), "{number}");
            assert_eq!(report.dropped, 0, "the teacher does not err");
            assert_eq!(report.hurried, 0, "the budget is ample");
        }
    }
}

/// A teacher who after some comparisons finds no two words comparable.
struct Silenced {
    teacher: ScriptedTeacher,
    willing: u32,
}

impl Teacher for Silenced {
    type Atom = Word;
    type Concept = Dfa;

    fn membership(&mut self, atom: &Word) -> bool {
        self.teacher.membership(atom)
    }

    fn comparison(&mut self, first: &Word, second: &Word) -> Comparison {
        if self.willing == 0 {
            return Comparison::Incomparable;
        }
        self.willing -= 1;
        self.teacher.comparison(first, second)
    }

    fn counterexample(&mut self, hypothesis: &Dfa) -> Option<(Word, bool)> {
        self.teacher.counterexample(hypothesis)
    }
}

/// Comparisons that worked and then teach nothing do not keep it from asking for
/// membership, however cheap they are (Proposition 1).
#[test]
fn comparisons_that_fall_silent_are_given_up() {
    let target = Target::named("tomita:6").unwrap();
    for seed in 0..2 {
        let known = target.known().to_vec();
        let mut learner = Learner::new(automata(&target), costing(8.0, seed), known);
        let mut teacher = Silenced {
            teacher: ScriptedTeacher::new(&target, TeacherSettings::default()),
            willing: 3,
        };
        let report = teach(&mut learner, &mut teacher, 100, process_cpu, |_| ()).unwrap();
        assert_eq!(report.learned, Some(target.dfa().canonical()));
        assert!(report.counts.comparison > 3, "{:?}", report.counts);
    }
}

/// EXP4 with four experts as section 7 of its paper has it, written down once
/// more: Algorithm 5 draws an expert and then an arm, so the arms have the
/// mixture's chances.
struct Twin {
    weights: [f64; 4],
}

impl Twin {
    const GAMMA: f64 = 0.158_783_562_1;

    fn new() -> Self {
        Self { weights: [1.0; 4] }
    }

    fn trust(&self) -> [f64; 4] {
        let sum: f64 = self.weights.iter().sum();
        self.weights.map(|weight| weight / sum)
    }

    /// Panics unless the round has the chances that the twin gives its arms, and
    /// learns what came of it.
    fn play(&mut self, round: &Round, reply: &Reply<impl Sized>) {
        let mut experts = vec![round.pessimistic, round.historical];
        if let Some(posterior) = round.posterior {
            experts.extend([posterior.informed, posterior.steadfast]);
            let better = usize::from(posterior.steadfast[1] > 0.5);
            assert!(posterior.informed[better] >= 0.5, "{round:?}");
        }
        for advice in &experts {
            assert!((advice[0] + advice[1] - 1.0).abs() < 1e-9, "{round:?}");
        }
        let offered = round.pessimistic.map(|chance| chance > 0.0);
        let arms = offered.iter().filter(|offered| **offered).count() as f64;
        let awake: f64 = self.weights[..experts.len()].iter().sum();
        for arm in 0..2 {
            let said = self.weights.iter().zip(&experts);
            let mixed = said.map(|(weight, e)| weight * e[arm]).sum::<f64>() / awake;
            let chance = if offered[arm] {
                (1.0 - Self::GAMMA) * mixed + Self::GAMMA / arms
            } else {
                0.0
            };
            assert!(
                (round.probabilities[arm] - chance).abs() < 1e-6,
                "{chance} {round:?}"
            );
        }
        let Some(loss) = round.losses.of(reply) else {
            return;
        };
        assert!((0.0..=1.0).contains(&loss), "{round:?}");
        let arm = usize::from(matches!(round.losses, Losses::Comparison { .. }));
        for (place, weight) in self.weights.iter_mut().enumerate() {
            // Who slept is taken to have advised what was done.
            let advice = experts.get(place).unwrap_or(&round.probabilities);
            let gain = advice[arm] * (1.0 - loss) / round.probabilities[arm];
            *weight *= (Self::GAMMA / 2.0 * gain).exp();
        }
    }
}

/// A session's rounds are EXP4's, its experts do not stay equally trusted (though
/// nearly: a session is short for a bandit), and a learner that reads the same
/// rounds from a log asks the same.
#[test]
fn trust_moves_and_is_a_fold() {
    let target = Target::named("tomita:4").unwrap();
    let config = costing(4.0, 3);
    let mut teacher = ScriptedTeacher::new(&target, TeacherSettings::default());
    let mut learner = Learner::new(automata(&target), config.clone(), target.known().to_vec());
    let mut twin = Twin::new();
    let mut arms = [0, 0];
    for number in 0..100 {
        let step = learner.next();
        if number % 5 == 0 {
            let mut fresh =
                Learner::new(automata(&target), config.clone(), target.known().to_vec());
            for entry in learner.entries() {
                let text = serde_json::to_string(&entry.round).unwrap();
                let round: Option<Round> = serde_json::from_str(&text).unwrap();
                assert_eq!(round, entry.round);
                let (question, reply) = (entry.question.clone(), entry.reply.clone());
                fresh.record(entry.answer, question, round, reply).unwrap();
            }
            assert_eq!(fresh.next(), step, "question {number}");
        }
        let (question, round) = match step {
            Step::Ask {
                question, round, ..
            } => (question, round),
            Step::Done { .. } => {
                let trust = twin.trust();
                assert!(arms[0] > 0 && arms[1] > 0, "{arms:?}");
                let moved = trust.map(|trust| (trust - 0.25).abs());
                assert!(moved.iter().any(|moved| *moved > 0.002), "{trust:?}");
                return;
            }
            Step::Conflict(conflict) => panic!("{conflict:?}"),
        };
        let reply = reply(&mut teacher, &question);
        match (&round, &question) {
            (None, Question::Equivalence { .. }) => {}
            (Some(round), Question::Membership { .. } | Question::Comparison { .. }) => {
                assert!(round.posterior.is_some(), "it is no hurry");
                arms[usize::from(matches!(question, Question::Comparison { .. }))] += 1;
                twin.play(round, &reply);
            }
            _ => panic!("{question:?} with {round:?}"),
        }
        learner
            .record(AnswerId(number), question, round, reply)
            .unwrap();
    }
    panic!("it does not end");
}

/// Rounds of the dissertation's two experts are written as they always were.
#[test]
fn old_rounds_read() {
    let old = json!({
        "pessimistic": [0.25, 0.75],
        "historical": [0.5, 0.5],
        "probabilities": [0.375, 0.625],
        "losses": {"kind": "membership", "accept": 0.5, "reject": 0.25},
    });
    let round: Round = serde_json::from_value(old.clone()).unwrap();
    assert_eq!(round.posterior, None);
    assert_eq!(serde_json::to_value(&round).unwrap(), old);
    assert_eq!(serde_json::to_value(Strategy::Exp4Plus).unwrap(), "exp4+");
    assert_eq!(
        serde_json::from_value::<Strategy>(json!("exp4+")).unwrap(),
        Strategy::Exp4Plus
    );
}

/// A table of which nothing likely is known in every other step.
struct Rushed(FiniteClass);

impl ConceptClass for Rushed {
    type Concept = FiniteConcept;
    type Atom = FiniteAtom;

    fn add(&mut self, answer: Option<AnswerId>, fact: Fact<FiniteAtom>) {
        self.0.add(answer, fact);
    }

    fn retract(&mut self, answer: AnswerId) {
        self.0.retract(answer);
    }

    fn contains(&self, concept: &FiniteConcept, atom: &FiniteAtom) -> bool {
        self.0.contains(concept, atom)
    }

    fn sample(
        &mut self,
        count: usize,
        seed: u64,
        budget: &mut Budget,
    ) -> Result<Sample<FiniteConcept>, Failure> {
        self.0.sample(count, seed, budget)
    }

    fn spread(
        &mut self,
        wish: &Wish<'_, FiniteAtom>,
        budget: &mut Budget,
    ) -> Result<Spread<FiniteConcept>, Failure> {
        let mut spread = self.0.spread(wish, budget)?;
        spread.hurried = wish.heard.len().is_multiple_of(2);
        Ok(spread)
    }

    fn witnesses(
        &self,
        inside: &FiniteConcept,
        outside: &FiniteConcept,
        count: usize,
    ) -> Vec<FiniteAtom> {
        self.0.witnesses(inside, outside, count)
    }

    fn atoms(&self) -> Box<dyn Iterator<Item = FiniteAtom> + '_> {
        self.0.atoms()
    }
}

/// Teaches by this teacher and plays every round along. Returns what was learned,
/// and how many rounds there were with two experts and with four.
fn played<C: ConceptClass>(
    class: C,
    teacher: &mut impl Teacher<Atom = C::Atom, Concept = C::Concept>,
    config: Config,
) -> (C::Concept, [u32; 2]) {
    let mut learner = Learner::new(class, config, Vec::new());
    let mut twin = Twin::new();
    let mut rounds = [0, 0];
    for number in 0..100 {
        let (question, round) = match learner.next() {
            Step::Ask {
                question, round, ..
            } => (question, round),
            Step::Done { hypothesis } => return (hypothesis, rounds),
            Step::Conflict(conflict) => panic!("{conflict:?}"),
        };
        let reply = reply(teacher, &question);
        if let Some(round) = &round {
            rounds[usize::from(round.posterior.is_some())] += 1;
            twin.play(round, &reply);
        }
        learner
            .record(AnswerId(number), question, round, reply)
            .expect("it fits");
    }
    panic!("it does not end: {:?}", learner.entries());
}

/// On tables of ten atoms it ends with the target and every round is EXP4's, also
/// where every other round two experts have nothing to say.
#[test]
fn two_experts_may_sleep() {
    let (mut awake, mut rushed) = ([0, 0], [0, 0]);
    for seed in 0..150 {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let class = some_class(&mut random);
        let concepts: Vec<FiniteConcept> = class.concepts().collect();
        let target = concepts[random.random_range(0..concepts.len())];
        let order = some_order(&class, target, &mut random);
        let mut teacher = TableTeacher {
            class: &class,
            target,
            order,
        };
        let config = costing([0.5, 1.0, 8.0][random.random_range(0..3)], seed);
        let add = |rounds: &mut [u32; 2], (learned, more): (FiniteConcept, [u32; 2])| {
            assert_eq!(learned, target, "seed {seed}");
            *rounds = std::array::from_fn(|kind| rounds[kind] + more[kind]);
        };
        add(
            &mut awake,
            played(class.clone(), &mut teacher, config.clone()),
        );
        add(
            &mut rushed,
            played(Rushed(class.clone()), &mut teacher, config),
        );
    }
    assert!(awake[0] == 0 && awake[1] > 300, "{awake:?}");
    assert!(rushed.iter().all(|rounds| *rounds > 100), "{rushed:?}");
}
