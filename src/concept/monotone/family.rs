//! What a monotone family is: atoms that are monotone in a parameter.

use std::fmt::Debug;
use std::hash::Hash;

use rand_chacha::ChaCha8Rng;

use super::point::{Place, Point};

/// Concepts `φ_θ` with a parameter `θ ∈ [0, 1]^d`, of which a greater one contains
/// more: `θ ≤ θ'` implies `φ_θ ⊆ φ_θ'`. An atom `x` is what its monotone
/// bi-partition `Θ⁺ = {θ | x ∈ φ_θ}` is (Eq. 5.5 and 5.6).
pub trait Family {
    /// One element of the universe; simpler ones are less.
    type Atom: Clone + Ord + Hash + Debug;
    /// What a concept contains: parameters with equal keys have one concept.
    type Key: Ord;

    /// `d`, the number of dimensions of the parameter.
    fn dimensions(&self) -> usize;

    /// Whether the parameter is in the atom's `Θ⁺`. Once it is, it is for every
    /// greater one.
    fn contains(&self, parameter: Place<'_>, atom: &Self::Atom) -> bool;

    /// How far the parameter is inside the atom's `Θ⁺`, from −1 to 1: at least 0
    /// inside, at most 0 outside.
    fn slack(&self, parameter: &Point, atom: &Self::Atom) -> f64;

    /// What the concept of this parameter contains.
    fn key(&self, parameter: &Point) -> Self::Key;

    /// Up to `count` of the simplest atoms that the first concept contains and
    /// the second does not, simplest first; none exactly if there is none.
    fn witnesses(&self, inside: &Point, outside: &Point, count: usize) -> Vec<Self::Atom>;

    /// All atoms, simplest first.
    fn atoms(&self) -> Box<dyn Iterator<Item = Self::Atom> + '_>;

    /// `count` independent draws from the atoms by which a hypothesis is checked.
    fn draw(&self, hypothesis: &Point, count: usize, random: &mut ChaCha8Rng) -> Vec<Self::Atom>;

    /// The distribution of [`Self::draw`], as a phrase that can stand in
    /// brackets.
    fn drawn_from(&self) -> String;
}
