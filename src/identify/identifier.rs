//! The [`Identifier`]: keeps the facts that stand, goes through the sizes, and
//! believes no engine's automaton before it has run it.

use std::collections::BTreeMap;

use automata::{Alphabet, Dfa, Word};

use super::contradiction::{self, Finding, Ledger};
use super::engine::{Engine, Query, Verdict};
use super::enumerate::Enumerator;
use super::particles::Particles;
use super::problem::{FactId, Problem};
use super::spread::{self, Spread, Wish};
use super::{Cause, Contradiction, EngineChoice, Failure, Sample, Settings, sat};
use crate::evidence::{AnswerId, Budget, Fact};

/// The units of work that [`EngineChoice::Auto`] gives the enumerator for one
/// size: about a minute. No sample was met on which SAT is faster (measured with 5
/// to 20 states), so it has its turn only when all else failed, or with the
/// second half of a smaller budget.
const ENUMERATED_UNITS: u64 = 100_000_000;

/// The smallest automata that a spread has by search, where chains fail.
const SEARCHED: usize = 64;

/// An incremental search for the smallest consistent automata: facts come and
/// go, and what was learned from the others is kept.
#[derive(Clone)]
pub struct Identifier {
    settings: Settings,
    problem: Problem,
    /// The facts that stand, ascending.
    standing: Vec<FactId>,
    by_answer: BTreeMap<AnswerId, Vec<FactId>>,
    /// No automaton with fewer states is consistent.
    at_least: usize,
    engines: Engines,
    /// What [`Self::spread`] drew last.
    particles: Option<Particles>,
}

impl Identifier {
    /// A search over all DFAs with this alphabet.
    pub fn new(alphabet: Alphabet, settings: Settings) -> Self {
        Self {
            settings,
            problem: Problem::new(alphabet),
            standing: Vec::new(),
            by_answer: BTreeMap::new(),
            at_least: 1,
            engines: Engines::default(),
            particles: None,
        }
    }

    /// Adds a fact. `None` for one that is known from the start and can never
    /// be retracted; several facts may carry the same answer.
    ///
    /// # Panics
    ///
    /// If a word has a symbol that the alphabet does not have.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "a fact is handed over, whatever is kept of it"
    )]
    pub fn add(&mut self, answer: Option<AnswerId>, fact: Fact<Word>) {
        let Some(id) = self.problem.add(answer, &fact) else {
            return;
        };
        self.standing.push(id);
        if let Some(answer) = answer {
            self.by_answer.entry(answer).or_default().push(id);
        }
    }

    /// Takes back all facts of an answer.
    pub fn retract(&mut self, answer: AnswerId) {
        if let Some(gone) = self.by_answer.remove(&answer) {
            self.standing.retain(|fact| !gone.contains(fact));
            // Without these facts smaller automata may be consistent again.
            self.at_least = 1;
        }
    }

    /// Drops what was proved so far, which only makes the next search quicker.
    pub fn forget(&mut self) {
        self.at_least = 1;
        self.engines = Engines::default();
    }

    /// Up to `count` different automata of the smallest consistent size.
    ///
    /// If there are more, it is a random sample, and a function of the standing
    /// facts and `seed` alone: not of the order in which facts came, of what
    /// was retracted, or of what was asked before. Only the budget, where it
    /// ends the search, can make a difference.
    ///
    /// # Errors
    ///
    /// If no automaton within the bound is consistent, or the budget ends.
    pub fn smallest(
        &mut self,
        count: usize,
        seed: u64,
        budget: &mut Budget,
    ) -> Result<Sample, Failure> {
        self.smallest_watched(count, seed, budget, &mut |_| {})
    }

    /// The same as [`Self::smallest`], and tells `trying` every number of states
    /// before it is tried.
    ///
    /// # Errors
    ///
    /// As [`Self::smallest`].
    pub fn smallest_watched(
        &mut self,
        count: usize,
        seed: u64,
        budget: &mut Budget,
        trying: &mut dyn FnMut(usize),
    ) -> Result<Sample, Failure> {
        if let Some(answers) = contradiction::memrep(&self.problem, &self.standing) {
            return Err(Failure::Contradiction(Contradiction {
                answers: answers.into_iter().collect(),
                cause: Cause::MemRep,
                minimal: true,
            }));
        }
        let bound = self.settings.max_states.max(1);
        let mut core = self.standing.clone();
        while self.at_least <= bound {
            trying(self.at_least);
            let query = Query {
                problem: &self.problem,
                standing: &self.standing,
                states: self.at_least,
                count: count.max(1),
                seed,
            };
            match self.engines.search(self.settings.engine, &query, budget) {
                Verdict::Found {
                    mut automata,
                    complete,
                } => {
                    automata.sort_by_cached_key(simplicity);
                    return Ok(Sample { automata, complete });
                }
                Verdict::None { core: claim } => {
                    core = claim;
                    self.at_least += 1;
                }
                Verdict::OverBudget => {
                    return Err(Failure::OverBudget {
                        at_least: self.at_least,
                    });
                }
            }
        }
        let contradiction = self.no_automaton(&core, budget);
        if self.is_disproved(&contradiction, budget) {
            // Nothing that this engine learned is to be used again.
            self.engines = Engines::default();
            self.at_least = 1;
            return Err(Failure::OverBudget { at_least: 1 });
        }
        Err(Failure::Contradiction(contradiction))
    }

    /// Consistent automata of several sizes with their chances after what was
    /// heard: a function of the standing facts and the wish alone.
    ///
    /// # Errors
    ///
    /// If no automaton within the bound is consistent, or the budget ends before
    /// one is known.
    pub fn spread(
        &mut self,
        wish: &Wish<'_, Word>,
        budget: &mut Budget,
    ) -> Result<Spread<Dfa>, Failure> {
        let bound = self.settings.max_states;
        let known = self.particles.take().filter(|known| known.serve(wish));
        let mut particles = known.unwrap_or_else(|| {
            Particles::new(self.problem.alphabet(), bound, wish.decay, wish.seed)
        });
        if !particles.hear(wish.heard, budget.stop()) {
            self.particles = Some(particles);
            return Err(Failure::OverBudget {
                at_least: self.at_least,
            });
        }
        let particles = self.particles.insert(particles);
        if let Some(listed) = spread::list(&self.problem, &self.standing, bound, wish) {
            return Ok(listed);
        }
        let astray = wish.heard.iter().flatten().all(|heard| heard.sure) && particles.are_astray();
        if !particles.met().is_empty() && !astray {
            return Ok(spread::met(self.problem.alphabet(), particles.met()));
        }
        // Whether anything is consistent, only a search can tell; and what was met
        // by chains that are astray says little of what is.
        let smallest = self.smallest(SEARCHED, wish.seed, budget)?;
        Ok(spread::found(&smallest, bound, wish))
    }

    /// Whether engines that have seen nothing yet find an automaton where others found
    /// none. Only SAT solvers keep what may have misled them.
    fn is_disproved(&self, contradiction: &Contradiction, budget: &mut Budget) -> bool {
        if !self.engines.have_solved() {
            return false;
        }
        let ledger = Ledger::new(&self.problem, &self.standing);
        let answers = contradiction.answers.iter().copied().collect();
        let query = Query {
            problem: &self.problem,
            standing: &ledger.facts(&answers),
            states: self.settings.max_states.max(1),
            count: 1,
            seed: 0,
        };
        let verdict = Engines::default().search(self.settings.engine, &query, budget);
        matches!(verdict, Verdict::Found { .. })
    }

    /// Why no automaton within the bound is consistent.
    fn no_automaton(&mut self, core: &[FactId], budget: &mut Budget) -> Contradiction {
        let bound = self.settings.max_states.max(1);
        let (problem, engines) = (&self.problem, &mut self.engines);
        let choice = self.settings.engine;
        let (answers, minimal) =
            contradiction::minimise(problem, &self.standing, core, |standing| {
                let query = Query {
                    problem,
                    standing,
                    states: bound,
                    count: 1,
                    seed: 0,
                };
                match engines.search(choice, &query, budget) {
                    Verdict::Found { automata, .. } => Finding::Consistent(automata),
                    Verdict::None { core } => Finding::Contradictory(core),
                    Verdict::OverBudget => Finding::Unknown,
                }
            });
        Contradiction {
            answers: answers.into_iter().collect(),
            cause: Cause::States { bound },
            minimal,
        }
    }
}

/// Simplest first: most self-loops, then by the table.
fn simplicity(dfa: &Dfa) -> (usize, Vec<usize>) {
    let mut changes = 0;
    let mut table = Vec::with_capacity(dfa.size() * (dfa.alphabet().len() + 1));
    for state in dfa.states() {
        for symbol in dfa.alphabet().symbols() {
            let next = dfa.next(state, symbol);
            changes += usize::from(next != state);
            table.push(next.index());
        }
    }
    table.extend(
        dfa.states()
            .map(|state| usize::from(dfa.is_accepting(state))),
    );
    (changes, table)
}

/// The engines, each made when it is first needed.
#[derive(Default)]
struct Engines {
    enumerator: Enumerator,
    varisat: Option<Box<dyn Engine + Send>>,
    batsat: Option<Box<dyn Engine + Send>>,
}

impl Clone for Engines {
    /// None made: an engine keeps nothing that shows in what it finds.
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Engines {
    /// Answers a query by the chosen engine. What it finds is consistent.
    fn search(&mut self, choice: EngineChoice, query: &Query<'_>, budget: &mut Budget) -> Verdict {
        match choice {
            EngineChoice::Enumerate => trusted(&mut self.enumerator, query, budget),
            EngineChoice::Varisat => trusted(self.varisat(), query, budget),
            EngineChoice::Batsat => trusted(self.batsat(), query, budget),
            EngineChoice::Auto => {
                let given = enumerator_share(query, budget);
                let mut nodes = Budget::until(given, budget.stop());
                let verdict = trusted(&mut self.enumerator, query, &mut nodes);
                let enough = budget.spend(given - nodes.left());
                if !matches!(verdict, Verdict::OverBudget) || !enough || budget.is_spent() {
                    return verdict;
                }
                let verdict = trusted(self.varisat(), query, budget);
                if !matches!(verdict, Verdict::OverBudget) || budget.is_spent() {
                    return verdict;
                }
                // Budget is left, so the engine failed rather than the budget.
                let verdict = trusted(self.batsat(), query, budget);
                if !matches!(verdict, Verdict::OverBudget) || budget.is_spent() {
                    return verdict;
                }
                trusted(&mut self.enumerator, query, budget)
            }
        }
    }

    /// Whether a SAT solver was asked.
    fn have_solved(&self) -> bool {
        self.varisat.is_some() || self.batsat.is_some()
    }

    fn varisat(&mut self) -> &mut dyn Engine {
        self.varisat
            .get_or_insert_with(sat::varisat_engine)
            .as_mut()
    }

    fn batsat(&mut self) -> &mut dyn Engine {
        self.batsat.get_or_insert_with(sat::batsat_engine).as_mut()
    }
}

/// The units the enumerator may take before SAT has its turn: a function of the
/// query and the budget, so that earlier searches leave no trace.
fn enumerator_share(query: &Query<'_>, budget: &Budget) -> u64 {
    if query.problem.alphabet().len() == 1 {
        // One path that closes somewhere: a search as long as the automaton.
        budget.left()
    } else {
        ENUMERATED_UNITS.min(budget.left() / 2)
    }
}

/// Lets an engine search, and runs all facts on whatever it found. An engine
/// that is wrong has failed: its answer counts as none.
fn trusted(engine: &mut dyn Engine, query: &Query<'_>, budget: &mut Budget) -> Verdict {
    let verdict = engine.search(query, budget);
    if let Verdict::Found { automata, .. } = &verdict {
        let right = |dfa: &Dfa| {
            dfa.size() <= query.states
                && dfa.alphabet() == query.problem.alphabet()
                && contradiction::agrees(query.problem, dfa, query.standing)
        };
        let good = !automata.is_empty() && automata.iter().all(right);
        debug_assert!(
            good,
            "an engine returned an automaton that is not consistent"
        );
        if !good {
            return Verdict::OverBudget;
        }
    }
    verdict
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A solver gone wrong: nothing is ever consistent.
    struct Liar;

    impl Engine for Liar {
        fn search(&mut self, query: &Query<'_>, _: &mut Budget) -> Verdict {
            Verdict::None {
                core: query.standing.to_vec(),
            }
        }
    }

    #[test]
    fn a_contradiction_that_is_none_is_never_shown() {
        let alphabet = Alphabet::new(["a", "b"]).unwrap();
        let settings = Settings {
            engine: EngineChoice::Varisat,
            max_states: 3,
        };
        let mut identifier = Identifier::new(alphabet.clone(), settings);
        for (place, (word, accepted)) in [("a", true), ("b", false)].into_iter().enumerate() {
            let atom = alphabet.word([word]).unwrap();
            identifier.add(Some(AnswerId(place as u32)), Fact::Label { atom, accepted });
        }
        identifier.engines.varisat = Some(Box::new(Liar));
        let mut smallest = || identifier.smallest(1, 0, &mut Budget::new(1_000_000));
        assert_eq!(smallest().err(), Some(Failure::OverBudget { at_least: 1 }));
        // It is not asked again.
        assert_eq!(smallest().unwrap().automata[0].size(), 2);
    }
}
