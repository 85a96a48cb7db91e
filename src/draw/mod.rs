//! Pictures of automata as SVG, for a page or for a file.
//!
//! What is drawn is chosen so that a person who has never seen an automaton
//! can follow it with a finger: the start at the left, accepting states with a
//! double ring, one arrow a pair of states, loops on top, and the state from
//! which nothing can be accepted any more left out, with a note that says so.
//! States have breadth-first numbers, and the same automaton gives the same
//! bytes, so that a picture does not jump between two answers. What is new or in
//! dispute is [marked](Marks), and states can be told [in words](phrases).
//!
//! # Layout
//!
//! - `order`: the numbers of states.
//! - `marks`: what is otherwise in another automaton.
//! - `phrase`: states in words.
//! - `sketch`: which states and arrows are drawn, and what stands on them.
//! - `layout`: where they stand; the only file that knows the layout crate.
//! - `curve`: how an arrow runs between two circles.
//! - `ports`: where arrows touch the circles.
//! - `text`: how wide words are, and how they are escaped.
//! - `write`: the markup.

mod curve;
mod layout;
mod marks;
mod order;
mod phrase;
mod ports;
mod sketch;
mod text;
mod write;

use std::collections::BTreeMap;

use automata::Dfa;

pub use marks::Marks;
pub use order::numbered;
pub use phrase::phrases;

/// The largest number of states that is drawn; a table serves better above it.
pub const MAX_STATES: usize = 24;

/// The largest number of arrows that is drawn, loops included.
pub const MAX_ARROWS: usize = 120;

/// The words of a picture. [`Captions::default`] has none of its own: symbols
/// stand under their names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Captions {
    /// What the picture shows, for readers of screens; by default the number
    /// of states.
    pub title: Option<String>,
    /// The word that people use for a symbol, by the symbol's name.
    pub words: BTreeMap<String, String>,
    /// Whether states are told [in words](phrases) below their circles.
    pub phrases: bool,
}

/// An automaton that would make an unreadable picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "a picture of {states} states and {arrows} arrows cannot be read \
     (at most {MAX_STATES} and {MAX_ARROWS} are drawn): use the table"
)]
pub struct TooLarge {
    /// The states that would be drawn.
    pub states: usize,
    /// The arrows that would be drawn, loops included.
    pub arrows: usize,
}

/// The picture as an `<svg>` element to be put into a page.
///
/// It has no ground of its own, takes its ink from the `color` around it, and
/// has neither `style` attributes nor a `<style>` element, so that a strict
/// content security policy lets it through. Its hooks are the classes
/// `automaton`, `state`, `accepting`, `arrow`, `label`, `phrase`, `note`, `new`
/// and `disputed`, and `data-state`, `data-from` and `data-to`, the states by
/// their places in [`numbered`].
///
/// # Errors
///
/// If the automaton is larger than [`MAX_STATES`] and [`MAX_ARROWS`] allow.
pub fn svg(dfa: &Dfa, captions: &Captions, marks: &Marks) -> Result<String, TooLarge> {
    draw(dfa, captions, marks, write::Form::Element)
}

/// The picture as a file of its own: with a ground, and with light and dark
/// ink by the reader's preference.
///
/// # Errors
///
/// As [`svg`].
pub fn document(dfa: &Dfa, captions: &Captions) -> Result<String, TooLarge> {
    draw(dfa, captions, &Marks::default(), write::Form::Document)
}

fn draw(
    dfa: &Dfa,
    captions: &Captions,
    marks: &Marks,
    form: write::Form,
) -> Result<String, TooLarge> {
    let sketch = sketch::Sketch::of(dfa, captions, marks)?;
    let plan = layout::arrange(&sketch);
    Ok(write::markup(&sketch, &plan, form))
}
