//! How the concepts of a class and their atoms are told, to people and programs.

use automata::{Alphabet, Dfa, Word};
use serde::Serialize;

use crate::cli::output::{self, Nouns, counted};
use crate::concept::{Behaviour, FiniteAtom, FiniteConcept, FiniteTable, Point};
use crate::task::{Axes, Rewards};
use crate::world::{Shown, World};

/// Tells of the atoms and concepts of one class.
pub(super) trait Teller {
    /// One element of the universe.
    type Atom;
    /// One concept.
    type Concept;
    /// An atom for programs.
    type AtomLine<'a>: Serialize
    where
        Self: 'a;
    /// A concept for programs.
    type ConceptLine<'a>: Serialize
    where
        Self: 'a;
    /// What they are called.
    const NOUNS: Nouns;

    fn atom_line<'a>(&'a self, atom: &'a Self::Atom) -> Self::AtomLine<'a>;

    fn concept_line<'a>(&'a self, concept: &'a Self::Concept) -> Self::ConceptLine<'a>;

    /// An atom for people.
    fn spelled(&self, atom: &Self::Atom) -> String;

    /// A concept for people, as the object of "is it …?".
    fn described(&self, concept: &Self::Concept) -> String;

    /// What was learned, as the end of "learned: NAME …".
    fn learned(&self, concept: &Self::Concept) -> String;

    /// The size of a concept.
    fn size(&self, concept: &Self::Concept) -> usize;

    /// What shows an atom; none where atoms are shown as they are.
    fn shown<'a>(&'a self, atom: &Self::Atom) -> Option<Shown<'a>> {
        let _ = atom;
        None
    }
}

/// Words and automata, in a world.
pub(super) struct Words<'w> {
    pub(super) alphabet: Alphabet,
    pub(super) world: Option<&'w World>,
}

impl Teller for Words<'_> {
    type Atom = Word;
    type Concept = Dfa;
    type AtomLine<'a>
        = Vec<&'a str>
    where
        Self: 'a;
    type ConceptLine<'a>
        = &'a Dfa
    where
        Self: 'a;
    const NOUNS: Nouns = output::AUTOMATA;

    fn atom_line<'a>(&'a self, atom: &'a Word) -> Vec<&'a str> {
        self.alphabet.spell(atom).collect()
    }

    fn concept_line<'a>(&'a self, concept: &'a Dfa) -> &'a Dfa {
        concept
    }

    fn spelled(&self, atom: &Word) -> String {
        output::spelled(&self.alphabet, atom)
    }

    fn described(&self, concept: &Dfa) -> String {
        let states = counted(concept.size(), "state", "states");
        format!("this automaton with {states}")
    }

    fn learned(&self, concept: &Dfa) -> String {
        format!("with {}", counted(concept.size(), "state", "states"))
    }

    fn size(&self, concept: &Dfa) -> usize {
        concept.size()
    }

    fn shown<'a>(&'a self, atom: &Word) -> Option<Shown<'a>> {
        self.world?.shown(atom)
    }
}

/// Points, and the parameters of which they are at most.
pub(super) struct Points;

/// A parameter for programs.
#[derive(Serialize)]
pub(super) struct PointLine<'a> {
    /// The points per axis of the coarsest grid that has it.
    size: usize,
    parameter: &'a Point,
}

impl Teller for Points {
    type Atom = Point;
    type Concept = Point;
    type AtomLine<'a> = &'a Point;
    type ConceptLine<'a> = PointLine<'a>;
    const NOUNS: Nouns = Nouns {
        atom: "point",
        atoms: "points",
        ..output::CONCEPTS
    };

    fn atom_line<'a>(&'a self, atom: &'a Point) -> &'a Point {
        atom
    }

    fn concept_line<'a>(&'a self, concept: &'a Point) -> PointLine<'a> {
        PointLine {
            size: concept.size(),
            parameter: concept,
        }
    }

    fn spelled(&self, atom: &Point) -> String {
        atom.to_string()
    }

    fn described(&self, concept: &Point) -> String {
        format!("exactly what is at most {concept} in every dimension")
    }

    fn learned(&self, concept: &Point) -> String {
        format!(
            "as what is at most {concept}, on the grid with {} per axis",
            counted(concept.size(), "point", "points")
        )
    }

    fn size(&self, concept: &Point) -> usize {
        concept.size()
    }
}

/// A limit on every axis, for programs.
#[derive(Serialize)]
pub(super) struct LimitsLine<'a> {
    #[serde(flatten)]
    point: PointLine<'a>,
    /// The parameter in the units of the axes.
    limits: Vec<f64>,
}

/// Points in the units of the axes, and limits on them.
impl Teller for Axes {
    type Atom = Point;
    type Concept = Point;
    type AtomLine<'a> = Vec<f64>;
    type ConceptLine<'a> = LimitsLine<'a>;
    const NOUNS: Nouns = Points::NOUNS;

    fn atom_line<'a>(&'a self, atom: &'a Point) -> Vec<f64> {
        self.values(atom)
    }

    fn concept_line<'a>(&'a self, concept: &'a Point) -> LimitsLine<'a> {
        LimitsLine {
            point: Points.concept_line(concept),
            limits: self.values(concept),
        }
    }

    fn spelled(&self, atom: &Point) -> String {
        self.spell(atom)
    }

    fn described(&self, concept: &Point) -> String {
        format!("exactly {}", Axes::described(self, concept).join(" and "))
    }

    fn learned(&self, concept: &Point) -> String {
        format!("as {}", Axes::described(self, concept).join(" and "))
    }

    fn size(&self, concept: &Point) -> usize {
        concept.size()
    }
}

/// The rows and columns of a table.
impl Teller for FiniteTable {
    type Atom = FiniteAtom;
    type Concept = FiniteConcept;
    type AtomLine<'a> = &'a str;
    type ConceptLine<'a> = &'a str;
    const NOUNS: Nouns = output::CONCEPTS;

    fn atom_line<'a>(&'a self, atom: &'a FiniteAtom) -> &'a str {
        self.atom(*atom)
    }

    fn concept_line<'a>(&'a self, concept: &'a FiniteConcept) -> &'a str {
        self.concept(*concept)
    }

    fn spelled(&self, atom: &FiniteAtom) -> String {
        format!("`{}`", self.atom(*atom))
    }

    fn described(&self, concept: &FiniteConcept) -> String {
        format!("`{}`", self.concept(*concept))
    }

    fn learned(&self, concept: &FiniteConcept) -> String {
        format!(
            "as `{}` of size {}",
            self.concept(*concept),
            self.size(concept)
        )
    }

    fn size(&self, concept: &FiniteConcept) -> usize {
        self.class().size(*concept)
    }
}

/// A reward for programs.
#[derive(Serialize)]
pub(super) struct RewardLine {
    /// The points per axis of the coarsest grid that has its parameter.
    size: usize,
    weights: Vec<f64>,
    threshold: f64,
}

impl Teller for Rewards {
    type Atom = Behaviour;
    type Concept = Point;
    type AtomLine<'a> = &'a str;
    type ConceptLine<'a> = RewardLine;
    const NOUNS: Nouns = output::CONCEPTS;

    fn atom_line<'a>(&'a self, atom: &'a Behaviour) -> &'a str {
        self.name(*atom)
    }

    fn concept_line<'a>(&'a self, concept: &'a Point) -> RewardLine {
        let reward = self.reward(concept);
        RewardLine {
            size: concept.size(),
            weights: reward.weights,
            threshold: reward.threshold,
        }
    }

    fn spelled(&self, atom: &Behaviour) -> String {
        format!("`{}`", self.name(*atom))
    }

    fn described(&self, concept: &Point) -> String {
        let reward = self.reward(concept);
        let weights: Vec<String> = (reward.weights.iter())
            .map(|weight| format!("{weight:.3}"))
            .collect();
        format!(
            "a reward above {:.3} by the weights {}",
            reward.threshold,
            weights.join(", ")
        )
    }

    fn learned(&self, concept: &Point) -> String {
        let size = counted(concept.size(), "point", "points");
        format!(
            "as {}, on the grid with {size} per axis",
            self.described(concept)
        )
    }

    fn size(&self, concept: &Point) -> usize {
        concept.size()
    }
}
