//! The languages of automata as they are learned in a world, beside what is known
//! beforehand: only what can be shown and is open is asked, and what that does not
//! tell apart is one.

mod beyond;
mod catalogue;
mod classes;
mod merge;
mod reduced;

use std::sync::Arc;

use automata::{Alphabet, Dfa, Word};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use self::catalogue::Catalogue;
use self::classes::Classes;
use self::reduced::Reduced;
use super::prior::{Applied, Prior, PriorError, product, spelled};
use super::{Cause, ConceptClass, Contradiction, End, Failure, Heard, Sample, Spread, Wish};
use crate::evidence::{AnswerId, Budget, Fact};
use crate::identify::{self, Settings};
use crate::world::World;

/// Words about this long are drawn to check even the smallest hypothesis.
const LONGEST: usize = 10;

/// Automata whose atoms are the words that a world can show and a prior leaves
/// open.
///
/// A concept is the learned part alone; [`Self::whole`] is what it comes to. Facts
/// about settled words say of it what [`Prior::apply`] tells. Whoever hands facts
/// over sees to it that their words are feasible.
#[derive(Clone)]
pub struct Situated {
    world: Arc<World>,
    prior: Prior,
    /// Has every word that is feasible and open, and few others.
    frame: Dfa,
    catalogue: Arc<Catalogue>,
    classes: Classes,
    learned: Reduced,
    /// The answers that contradict what is known beforehand, and none for what was
    /// known from the start.
    refuted: Vec<Option<AnswerId>>,
}

impl Situated {
    /// The automata of up to `settings.max_states` states in this world, of which
    /// this is known.
    ///
    /// # Errors
    ///
    /// If the two are over different alphabets, or nothing is open that can be
    /// shown.
    pub fn new(world: Arc<World>, prior: Prior, settings: Settings) -> Result<Self, PriorError> {
        let alphabet = world.alphabet();
        if prior.alphabet() != alphabet {
            return Err(PriorError::Alphabet {
                number: 1,
                role: "are known",
                found: prior.alphabet().to_string(),
                expected: alphabet.to_string(),
            });
        }
        let frame = match world.outline() {
            Some(outline) => product(&outline, prior.open(), |can, open| can && open).minimise(),
            None => prior.open().clone(),
        };
        let catalogue = Arc::new(Catalogue::new(&world, prior.open()));
        if catalogue.words().is_empty() {
            return Err(PriorError::NothingOpenHere);
        }
        Ok(Self {
            learned: Reduced::new(&frame, settings),
            classes: Classes::default(),
            refuted: Vec::new(),
            frame,
            catalogue,
            prior,
            world,
        })
    }

    /// What examples say that is worth telling a learner: those about settled words
    /// say nothing.
    ///
    /// # Errors
    ///
    /// Names the first example that contradicts what is known beforehand, or cannot
    /// happen.
    pub fn examples(&self, known: &[Fact<Word>]) -> Result<Vec<Fact<Word>>, PriorError> {
        for (place, fact) in known.iter().enumerate() {
            for word in words_of(fact) {
                if !self.world.is_feasible(word) {
                    return Err(PriorError::Infeasible {
                        example: place + 1,
                        word: spelled(self.alphabet(), word),
                    });
                }
            }
        }
        self.prior.examples(known)
    }

    /// The symbols.
    pub fn alphabet(&self) -> &Alphabet {
        self.world.alphabet()
    }

    /// Where the words come from.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// What is known beforehand.
    pub fn prior(&self) -> &Prior {
        &self.prior
    }

    /// The whole concept, of which this part was learned.
    #[must_use]
    pub fn whole(&self, learned: &Dfa) -> Dfa {
        self.prior.whole(learned)
    }

    /// Whether a word may be asked about: it is feasible and open.
    pub fn is_open(&self, word: &Word) -> bool {
        self.prior.settled(word).is_none() && self.world.is_feasible(word)
    }

    /// The open words on which two concepts differ.
    fn open_difference(&self, one: &Dfa, other: &Dfa) -> Dfa {
        let differ = product(one, other, |one, other| one != other);
        product(&differ, self.prior.open(), |differ, open| differ && open)
    }

    /// The open words that `inside` accepts and `outside` rejects, if they can be
    /// told to be none without a search.
    fn open_witnesses(&self, inside: &Dfa, outside: &Dfa) -> Option<Dfa> {
        let own = product(inside, outside, |inside, outside| inside && !outside);
        let framed = product(&own, &self.frame, |own, frame| own && frame);
        if framed.is_empty() {
            return None;
        }
        let open = self.prior.open();
        Some(product(&own, open, |own, open| own && open))
    }

    /// The facts of the learned part that follow from one about the whole.
    fn learn(&mut self, answer: Option<AnswerId>, fact: &Fact<Word>) {
        match self.prior.apply(fact) {
            Applied::Says(fact) => self.learned.add(answer, fact),
            Applied::Nothing => {}
            Applied::Contradicts => self.refuted.push(answer),
        }
    }

    /// An answer that cannot stand beside what is known beforehand.
    fn against_prior(&self) -> Result<(), Failure> {
        let Some(first) = self.refuted.iter().min() else {
            return Ok(());
        };
        Err(Failure::Contradiction(Contradiction {
            answers: first.iter().copied().collect(),
            cause: Cause::MemRep,
            minimal: true,
        }))
    }

    /// What was heard, as far as it says something of the learned part.
    fn heard(&self, heard: &[Vec<Heard<Word>>]) -> Vec<Vec<Heard<Word>>> {
        let applied = |said: &Heard<Word>| match self.prior.apply(&said.fact) {
            Applied::Says(fact) => Some(Heard {
                fact,
                sure: said.sure,
            }),
            Applied::Nothing | Applied::Contradicts => None,
        };
        let answers = heard.iter();
        answers
            .map(|answer| answer.iter().filter_map(applied).collect())
            .collect()
    }
}

/// The words that a fact is about.
fn words_of(fact: &Fact<Word>) -> impl Iterator<Item = &Word> {
    let (first, second) = match fact {
        Fact::Label { atom, .. } => (atom, None),
        Fact::Below { worse, better } => (worse, Some(better)),
        Fact::Equal { first, second } | Fact::Incomparable { first, second } => {
            (first, Some(second))
        }
    };
    std::iter::once(first).chain(second)
}

impl ConceptClass for Situated {
    type Concept = Dfa;
    type Atom = Word;

    fn add(&mut self, answer: Option<AnswerId>, fact: Fact<Word>) {
        self.learn(answer, &fact);
    }

    fn retract(&mut self, answer: AnswerId) {
        self.refuted.retain(|refuted| *refuted != Some(answer));
        self.learned.retract(answer);
    }

    fn forget(&mut self) {
        self.learned.forget();
    }

    /// Whether the whole concept has the word.
    fn contains(&self, concept: &Dfa, atom: &Word) -> bool {
        let settled = self.prior.settled(atom);
        settled.unwrap_or_else(|| concept.accepts(atom))
    }

    fn sample(
        &mut self,
        count: usize,
        seed: u64,
        budget: &mut Budget,
    ) -> Result<Sample<Dfa>, Failure> {
        self.against_prior()?;
        self.sample_merged(count, seed, budget)
    }

    fn spread(
        &mut self,
        wish: &Wish<'_, Word>,
        budget: &mut Budget,
    ) -> Result<Spread<Dfa>, Failure> {
        self.against_prior()?;
        let heard = self.heard(wish.heard);
        let spread = self.learned.spread(wish, &heard, budget)?;
        Ok(self.merge_spread(spread))
    }

    fn end(&self, concept: &Dfa, atom: &Word) -> End {
        match self.prior.settled(atom) {
            None => identify::end(concept, atom),
            Some(inside) => End::new(inside, None, 0),
        }
    }

    fn ends(&self, concepts: &[&Dfa], atoms: &[Word]) -> Vec<Vec<End>> {
        let mut ends = identify::ends(concepts, atoms);
        for (ends, atom) in ends.iter_mut().zip(atoms) {
            if let Some(inside) = self.prior.settled(atom) {
                ends.fill(End::new(inside, None, 0));
            }
        }
        ends
    }

    fn witnesses(&self, inside: &Dfa, outside: &Dfa, count: usize) -> Vec<Word> {
        let listed = self.catalogue.witnesses(inside, outside);
        let listed: Vec<Word> = listed.take(count).cloned().collect();
        if listed.len() == count || self.catalogue.is_complete() {
            return listed;
        }
        match self.open_witnesses(inside, outside) {
            Some(language) => self.world.simplest(&language, count),
            None => listed,
        }
    }

    /// The words that take less to be shown, if they are among the simplest.
    fn simpler(&self, atom: &Word) -> Vec<Word> {
        let Some(effort) = self.world.effort(atom) else {
            return Vec::new();
        };
        let words = self.catalogue.words();
        let takes_less = |word: &Word| self.world.effort(word).is_some_and(|less| less < effort);
        words[..words.partition_point(takes_less)].to_vec()
    }

    fn atoms(&self) -> Box<dyn Iterator<Item = Word> + '_> {
        let listed = self.catalogue.words().iter().cloned();
        if self.catalogue.is_complete() {
            return Box::new(listed);
        }
        let more = || {
            let words = self.world.words_in(self.prior.open());
            words.skip(self.catalogue.words().len())
        };
        Box::new(listed.chain(std::iter::once_with(more).flatten()))
    }

    /// Half of the words are drawn from those that the hypothesis accepts and half
    /// from those it rejects.
    fn draw(&self, hypothesis: &Dfa, count: usize, random: &mut ChaCha8Rng) -> Vec<Word> {
        let open = self.prior.open();
        let sides = [true, false]
            .map(|label| product(hypothesis, open, |accepted, open| open && accepted == label));
        let first: Vec<bool> = (0..count).map(|_| random.random()).collect();
        let wanted = first.iter().filter(|first| **first).count();
        let longest = longest(hypothesis);
        let mut drawn = [wanted, count - wanted];
        let words = [0, 1].map(|side| {
            self.world
                .draw(&sides[side], longest, drawn[side], random)
                .into_iter()
        });
        let [mut accepted, mut rejected] = words;
        drawn = [accepted.len(), rejected.len()];
        let missing = count - drawn[0] - drawn[1];
        let side = usize::from(drawn[0] == 0 && wanted > 0);
        let mut more = self
            .world
            .draw(&sides[side], longest, missing, random)
            .into_iter();
        let of = |side: bool| {
            let own = if side {
                accepted.next()
            } else {
                rejected.next()
            };
            own.or_else(|| more.next())
        };
        first.into_iter().filter_map(of).collect()
    }

    fn beyond(&self, hypothesis: &Dfa) -> Option<Word> {
        Self::beyond(self, hypothesis)
    }

    fn drawn_from(&self, hypothesis: &Dfa) -> String {
        let world = self.world.drawn_from(longest(hypothesis));
        format!("half of them accepted by it and half rejected, {world}")
    }
}

/// The longest word by which a hypothesis is checked.
fn longest(hypothesis: &Dfa) -> usize {
    LONGEST.max(2 * hypothesis.size())
}
