//! What is known of a language before the first question: automata that hold, and
//! automata that suffice.

use automata::{Alphabet, Dfa, Word};

use crate::evidence::Fact;

/// What is known beforehand. The whole concept is
/// `(learned ∧ all that hold) ∨ any that suffices`.
#[derive(Clone, Debug)]
pub struct Prior {
    holding: Vec<Dfa>,
    sufficing: Vec<Dfa>,
    /// All that hold, any that suffices, and what these leave open.
    holds: Dfa,
    suffices: Dfa,
    open: Dfa,
}

/// Why nothing can be known beforehand like this. Automata and examples are
/// numbered from 1.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PriorError {
    /// An automaton reads other symbols.
    #[error(
        "automaton {number} of those that {role} reads {found}, and the task has {expected}: give it the same symbols in the same order"
    )]
    Alphabet {
        /// The place of the automaton among those of its role.
        number: usize,
        /// `hold` or `suffice`.
        role: &'static str,
        /// Its symbols, for people.
        found: String,
        /// The symbols of the task.
        expected: String,
    },
    /// Nothing satisfies all that holds.
    #[error(
        "the automata that hold exclude each other, so nothing could be acceptable: leave one of them out"
    )]
    Excluded,
    /// Everything is settled.
    #[error(
        "what is known beforehand settles every behaviour, so there is nothing to learn: leave something out"
    )]
    NothingOpen,
    /// Everything that can happen is settled.
    #[error(
        "what is known beforehand settles every behaviour that can happen in this world, so there is nothing to learn: leave something out, or allow longer behaviours"
    )]
    NothingOpenHere,
    /// An example cannot be.
    #[error("example {example}, {word}, is {given}, and {reason}: correct one of them")]
    Example {
        /// The example's place.
        example: usize,
        /// Its word, for people.
        word: String,
        /// `accepted` or `rejected`.
        given: &'static str,
        /// The automaton that says otherwise, in words.
        reason: String,
    },
    /// A preference between examples cannot be.
    #[error(
        "example {example} sets {word} below or equal to another that is settled otherwise by what is known beforehand: correct one of them"
    )]
    Preference {
        /// The example's place.
        example: usize,
        /// The word that is worse, or one of two equal ones, for people.
        word: String,
    },
    /// An example cannot happen in the world.
    #[error(
        "example {example}, {word}, cannot happen in this world: leave it out, or change the world"
    )]
    Infeasible {
        /// The example's place.
        example: usize,
        /// Its word, for people.
        word: String,
    },
}

/// What a fact says of what is open.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Applied {
    /// This, about open words alone.
    Says(Fact<Word>),
    /// Nothing.
    Nothing,
    /// It contradicts what is known beforehand.
    Contradicts,
}

impl Prior {
    /// Nothing is known of the words over this alphabet.
    #[expect(clippy::missing_panics_doc, reason = "two automata of one state")]
    pub fn none(alphabet: &Alphabet) -> Self {
        Self::new(alphabet, Vec::new(), Vec::new()).expect("all words are open")
    }

    /// All of `holding` hold, and each of `sufficing` suffices.
    ///
    /// # Errors
    ///
    /// If one of them reads other symbols, or together they leave nothing open.
    pub fn new(
        alphabet: &Alphabet,
        holding: Vec<Dfa>,
        sufficing: Vec<Dfa>,
    ) -> Result<Self, PriorError> {
        let mut holds = constant(alphabet, true);
        for (place, dfa) in holding.iter().enumerate() {
            let both = holds.and(dfa);
            let both = both.map_err(|_| foreign(place, "hold", dfa, alphabet))?;
            holds = both.minimise();
        }
        let mut suffices = constant(alphabet, false);
        for (place, dfa) in sufficing.iter().enumerate() {
            let either = suffices.or(dfa);
            let either = either.map_err(|_| foreign(place, "suffice", dfa, alphabet))?;
            suffices = either.minimise();
        }
        if holds.is_empty() {
            return Err(PriorError::Excluded);
        }
        let open = product(&holds, &suffices, |holds, suffices| holds && !suffices).minimise();
        if open.is_empty() {
            return Err(PriorError::NothingOpen);
        }
        Ok(Self {
            holding,
            sufficing,
            holds,
            suffices,
            open,
        })
    }

    /// The symbols of the words.
    pub fn alphabet(&self) -> &Alphabet {
        self.open.alphabet()
    }

    /// The automata that hold.
    pub fn holding(&self) -> &[Dfa] {
        &self.holding
    }

    /// The automata that suffice.
    pub fn sufficing(&self) -> &[Dfa] {
        &self.sufficing
    }

    /// The words whose label is not settled; there is one.
    pub fn open(&self) -> &Dfa {
        &self.open
    }

    /// The label of the word, if it is settled whatever is learned.
    pub fn settled(&self, word: &Word) -> Option<bool> {
        if self.suffices.accepts(word) {
            Some(true)
        } else if self.holds.accepts(word) {
            None
        } else {
            Some(false)
        }
    }

    /// The whole concept, of which this is the part that was learned; minimal.
    ///
    /// # Panics
    ///
    /// If it reads other symbols.
    #[must_use]
    pub fn whole(&self, learned: &Dfa) -> Dfa {
        let held = product(learned, &self.holds, |learned, holds| learned && holds);
        product(&held, &self.suffices, |held, suffices| held || suffices).minimise()
    }

    /// What a fact about the whole concept says of the open words.
    pub fn apply(&self, fact: &Fact<Word>) -> Applied {
        let label = |atom: &Word, accepted| {
            Applied::Says(Fact::Label {
                atom: atom.clone(),
                accepted,
            })
        };
        let settled = |holds: bool| {
            if holds {
                Applied::Nothing
            } else {
                Applied::Contradicts
            }
        };
        match fact {
            Fact::Label { atom, accepted } => match self.settled(atom) {
                Some(label) => settled(label == *accepted),
                None => Applied::Says(fact.clone()),
            },
            Fact::Below { worse, better } => match (self.settled(worse), self.settled(better)) {
                (None, None) => Applied::Says(fact.clone()),
                (Some(true), None) => label(better, true),
                (None, Some(false)) => label(worse, false),
                (Some(false), None) | (None, Some(true)) => Applied::Nothing,
                (Some(worse), Some(better)) => settled(worse <= better),
            },
            Fact::Equal { first, second } => match (self.settled(first), self.settled(second)) {
                (None, None) => Applied::Says(fact.clone()),
                (Some(known), None) => label(second, known),
                (None, Some(known)) => label(first, known),
                (Some(first), Some(second)) => settled(first == second),
            },
            Fact::Incomparable { first, second } => {
                if self.settled(first).or(self.settled(second)).is_none() {
                    Applied::Says(fact.clone())
                } else {
                    Applied::Nothing
                }
            }
        }
    }

    /// What examples say of the open words, those that say something.
    ///
    /// # Errors
    ///
    /// Names the first example that contradicts what is known beforehand.
    pub fn examples(&self, known: &[Fact<Word>]) -> Result<Vec<Fact<Word>>, PriorError> {
        let mut says = Vec::new();
        for (place, fact) in known.iter().enumerate() {
            match self.apply(fact) {
                Applied::Says(fact) => says.push(fact),
                Applied::Nothing => {}
                Applied::Contradicts => return Err(self.refused(place + 1, fact)),
            }
        }
        Ok(says)
    }

    /// Why an example cannot be.
    fn refused(&self, example: usize, fact: &Fact<Word>) -> PriorError {
        let spell = |word: &Word| spelled(self.alphabet(), word);
        match fact {
            Fact::Label { atom, accepted } => {
                let rejects = self.holding.iter().position(|dfa| !dfa.accepts(atom));
                let accepts = self.sufficing.iter().position(|dfa| dfa.accepts(atom));
                let reason = match (accepted, rejects, accepts) {
                    (true, Some(number), _) => {
                        format!("automaton {} of those that hold rejects it", number + 1)
                    }
                    (false, _, Some(number)) => {
                        format!("automaton {} of those that suffice accepts it", number + 1)
                    }
                    _ => "what is known beforehand says otherwise".to_owned(),
                };
                PriorError::Example {
                    example,
                    word: spell(atom),
                    given: if *accepted { "accepted" } else { "rejected" },
                    reason,
                }
            }
            Fact::Below { worse: word, .. }
            | Fact::Equal { first: word, .. }
            | Fact::Incomparable { first: word, .. } => PriorError::Preference {
                example,
                word: spell(word),
            },
        }
    }
}

/// A word for people.
pub(super) fn spelled(alphabet: &Alphabet, word: &Word) -> String {
    let names: Vec<&str> = alphabet.spell(word).collect();
    format!("[{}]", names.join(", "))
}

fn foreign(place: usize, role: &'static str, dfa: &Dfa, alphabet: &Alphabet) -> PriorError {
    PriorError::Alphabet {
        number: place + 1,
        role,
        found: dfa.alphabet().to_string(),
        expected: alphabet.to_string(),
    }
}

/// All words or none.
fn constant(alphabet: &Alphabet, accepted: bool) -> Dfa {
    Dfa::new(
        alphabet.clone(),
        0,
        vec![accepted],
        &[vec![0; alphabet.len()]],
    )
    .expect("the table has one state")
}

/// The product of two automata over the alphabet of this concept.
pub(super) fn product(one: &Dfa, other: &Dfa, keep: impl Fn(bool, bool) -> bool) -> Dfa {
    one.product(other, keep)
        .expect("all automata of a task read the same symbols")
}
