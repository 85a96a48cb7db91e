//! Reads an automaton from DOT.

use std::collections::HashMap;

use super::lexer::{Place, Token, Tokens};
use crate::format::ReadError;
use crate::{Alphabet, Dfa};

/// Reads an automaton from DOT.
///
/// States come in the order in which the text names them first, symbols in the
/// order in which edges do. A node whose name begins with `__start` is no state
/// and marks the start by its edge; a state is accepting if its `shape` is
/// `doublecircle`.
///
/// # Errors
///
/// With line and column, if the text is not DOT, or the graph no complete
/// deterministic automaton.
pub fn read(text: &str) -> Result<Dfa, ReadError> {
    let mut tokens = Tokens::of(text);
    let mut parser = Parser {
        next: tokens.next()?,
        tokens,
        fault: None,
        graph: Graph::default(),
    };
    let read = parser.graph();
    // What is no token looks like the end to what comes after.
    parser.fault.map_or(read, Err)?;
    parser.graph.automaton()
}

/// The attributes that matter: the last `label` and the last `shape`.
#[derive(Default)]
struct Attributes {
    label: Option<(String, Place)>,
    shape: Option<String>,
}

struct Parser<'a> {
    tokens: Tokens<'a>,
    next: (Token, Place),
    /// The first that is no token, which ends the reading.
    fault: Option<ReadError>,
    graph: Graph,
}

impl Parser<'_> {
    fn peek(&self) -> (&Token, Place) {
        let (token, place) = &self.next;
        (token, *place)
    }

    fn advance(&mut self) -> (Token, Place) {
        let place = self.next.1;
        let next = match (&self.fault, self.tokens.next()) {
            (None, Ok(next)) => next,
            (None, Err(fault)) => {
                self.fault = Some(fault);
                (Token::End, place)
            }
            (Some(_), _) => (Token::End, place),
        };
        std::mem::replace(&mut self.next, next)
    }

    fn skips(&mut self, mark: char) -> bool {
        let there = *self.peek().0 == Token::Mark(mark);
        if there {
            self.advance();
        }
        there
    }

    fn expect(&mut self, mark: char, why: &str) -> Result<(), ReadError> {
        if self.skips(mark) {
            return Ok(());
        }
        let (token, place) = self.peek();
        let found = token.describe();
        Err(place.error(format!("expected `{mark}` {why}, found {found}")))
    }

    fn name(&mut self, what: &str) -> Result<(String, Place), ReadError> {
        match self.advance() {
            (Token::Name { text, .. }, place) => Ok((text, place)),
            (token, place) => {
                let found = token.describe();
                Err(place.error(format!("expected {what}, found {found}")))
            }
        }
    }

    /// Whether the next token is this bare word, in any case.
    fn is_keyword(&self, keyword: &str) -> bool {
        matches!(self.peek().0, Token::Name { text, quoted: false } if text.eq_ignore_ascii_case(keyword))
    }

    /// `[strict] digraph [name] { statements }`.
    fn graph(&mut self) -> Result<(), ReadError> {
        if self.is_keyword("strict") {
            self.advance();
        }
        if !self.is_keyword("digraph") {
            let (token, place) = self.peek();
            let found = token.describe();
            let why = if self.is_keyword("graph") {
                ": an automaton's edges have a direction"
            } else {
                ""
            };
            return Err(place.error(format!("expected `digraph`, found {found}{why}")));
        }
        self.advance();
        if matches!(self.peek().0, Token::Name { .. }) {
            self.advance();
        }
        self.expect('{', "after `digraph`")?;
        while !self.skips('}') {
            if *self.peek().0 == Token::End {
                self.expect('}', "at the end of the graph")?;
            }
            self.statement()?;
            self.skips(';');
        }
        match self.peek() {
            (Token::End, _) => Ok(()),
            (token, place) => {
                let found = token.describe();
                Err(place.error(format!("expected the end of the file, found {found}")))
            }
        }
    }

    /// A node, an edge, or something that only matters to a drawing.
    fn statement(&mut self) -> Result<(), ReadError> {
        let (_, place) = self.peek();
        if self.is_keyword("subgraph") || *self.peek().0 == Token::Mark('{') {
            return Err(place.error(
                "expected a node or an edge, found a subgraph: write its statements without it",
            ));
        }
        for keyword in ["graph", "edge", "node"] {
            if self.is_keyword(keyword) {
                self.advance();
                let attributes = self.attributes()?;
                if keyword == "node" && attributes.shape.is_some() {
                    self.graph.default_shape = attributes.shape;
                }
                return Ok(());
            }
        }
        let first = self.name("a node, an edge or `}`")?;
        if self.skips('=') {
            self.name("a value after `=`")?;
            return Ok(());
        }
        self.port()?;
        let mut nodes = vec![first];
        while *self.peek().0 == Token::Arrow {
            self.advance();
            nodes.push(self.name("a node after `->`")?);
            self.port()?;
        }
        let attributes = self.attributes()?;
        if nodes.len() == 1 {
            let (name, place) = nodes.swap_remove(0);
            self.graph.node(&name, place, attributes.shape);
            return Ok(());
        }
        for pair in nodes.windows(2) {
            self.graph.edge(&pair[0], &pair[1], &attributes)?;
        }
        Ok(())
    }

    /// `:port`, where an arrow ends on a node's picture.
    fn port(&mut self) -> Result<(), ReadError> {
        while self.skips(':') {
            self.name("a port after `:`")?;
        }
        Ok(())
    }

    /// `[name=value, …]`, any number of times.
    fn attributes(&mut self) -> Result<Attributes, ReadError> {
        let mut attributes = Attributes::default();
        while self.skips('[') {
            while !self.skips(']') {
                let (name, _) = self.name("an attribute or `]`")?;
                self.expect('=', "after the attribute's name")?;
                let (value, place) = self.name("the attribute's value")?;
                match name.as_str() {
                    "label" => attributes.label = Some((value, place)),
                    "shape" => attributes.shape = Some(value),
                    _ => {}
                }
                if !self.skips(',') {
                    self.skips(';');
                }
            }
        }
        Ok(attributes)
    }
}

/// What the text says, before it is known to be an automaton.
#[derive(Default)]
struct Graph {
    numbers: HashMap<String, u32>,
    states: Vec<State>,
    letters: Vec<String>,
    letter_numbers: HashMap<String, u32>,
    /// The next state by state and letter, as far as edges were read.
    next: HashMap<(u32, u32), u32>,
    start: Option<u32>,
    default_shape: Option<String>,
}

struct State {
    /// Where it stands first.
    place: Place,
    accepting: bool,
}

/// Whether a node is no state but the arrow that points to the start.
fn is_start_mark(name: &str) -> bool {
    name.starts_with("__start")
}

impl Graph {
    fn node(&mut self, name: &str, place: Place, shape: Option<String>) {
        if is_start_mark(name) {
            return;
        }
        let state = self.state(name, place);
        if let Some(shape) = shape {
            self.states[state as usize].accepting = shape == "doublecircle";
        }
    }

    /// The state of this name, new or not.
    fn state(&mut self, name: &str, place: Place) -> u32 {
        if let Some(&state) = self.numbers.get(name) {
            return state;
        }
        let state = self.states.len() as u32;
        self.numbers.insert(name.to_owned(), state);
        self.states.push(State {
            place,
            accepting: self.default_shape.as_deref() == Some("doublecircle"),
        });
        state
    }

    fn edge(
        &mut self,
        (from, place): &(String, Place),
        (to, to_place): &(String, Place),
        attributes: &Attributes,
    ) -> Result<(), ReadError> {
        if is_start_mark(to) {
            return Err(to_place.error(format!(
                "expected a state, found `{to}`: it marks the start and no edge leads to it"
            )));
        }
        if is_start_mark(from) {
            let start = self.state(to, *to_place);
            if self.start.is_some_and(|other| other != start) {
                return Err(place.error(
                    "there is a second start state: a deterministic automaton has one, remove the others' edges from `__start0`",
                ));
            }
            self.start = Some(start);
            return Ok(());
        }
        let Some((letter, label_place)) = &attributes.label else {
            return Err(place.error(format!(
                "the edge `{from} -> {to}` has no letter: give it one, [label=\"a\"]"
            )));
        };
        let letter = self.letter(letter, *label_place)?;
        let source = self.state(from, *place);
        let target = self.state(to, *to_place);
        if self.next.insert((source, letter), target).is_some() {
            let letter = &self.letters[letter as usize];
            return Err(place.error(format!(
                "state `{from}` has a second edge for `{letter}`: a deterministic automaton has one, remove the other"
            )));
        }
        Ok(())
    }

    /// The number of an edge's letter, new or not.
    fn letter(&mut self, name: &str, place: Place) -> Result<u32, ReadError> {
        let name = name.trim();
        if let Some(&number) = self.letter_numbers.get(name) {
            return Ok(number);
        }
        if Alphabet::new([name]).is_err() {
            let remedy = if name.contains('/') {
                "this looks like input and output of a Mealy machine, of which there is no language"
            } else if name.contains(',') {
                "write one edge for each letter"
            } else {
                "use letters, digits and `_` only"
            };
            return Err(place.error(format!("expected one letter, found \"{name}\": {remedy}")));
        }
        if self.letters.len() == Alphabet::MAX_SYMBOLS {
            let max = Alphabet::MAX_SYMBOLS;
            return Err(place.error(format!(
                "there are more than {max} different letters: no alphabet is larger"
            )));
        }
        let number = self.letters.len() as u32;
        self.letters.push(name.to_owned());
        self.letter_numbers.insert(name.to_owned(), number);
        Ok(number)
    }

    fn automaton(self) -> Result<Dfa, ReadError> {
        let top = Place { line: 1, column: 1 };
        let start = self.start.ok_or_else(|| {
            top.error("there is no start state: mark it by an edge `__start0 -> s0`")
        })?;
        let mut delta = Vec::with_capacity(self.states.len());
        for (number, state) in (0..).zip(&self.states) {
            let mut row = Vec::with_capacity(self.letters.len());
            for (letter, name) in (0..).zip(&self.letters) {
                let target = self.next.get(&(number, letter)).ok_or_else(|| {
                    let mut names = self.numbers.iter();
                    let from = names.find(|(_, known)| **known == number);
                    let from = from.map_or("", |(name, _)| name.as_str());
                    state.place.error(format!(
                        "state `{from}` has no edge for `{name}`, and the automaton must be complete: add `{from} -> … [label=\"{name}\"]`, to a rejecting sink if need be"
                    ))
                })?;
                row.push(*target as usize);
            }
            delta.push(row);
        }
        let accepting = self.states.iter().map(|state| state.accepting).collect();
        let alphabet = Alphabet::new(self.letters).map_err(|_| {
            top.error(
                "there is no edge with a letter: add `s0 -> s0 [label=\"a\"]` for every letter",
            )
        })?;
        // States and letters were numbered above and every row is full.
        Dfa::new(alphabet, start as usize, accepting, &delta)
            .map_err(|error| top.error(error.to_string()))
    }
}
