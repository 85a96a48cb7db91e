//! Numbers states canonically, and puts symbols into another order.

use crate::{Alphabet, AlphabetMismatch, Dfa, StateId};

impl Dfa {
    /// The same language by the same automaton, its states numbered
    /// breadth-first from the start with symbols in declared order.
    ///
    /// Unreachable states are dropped. Two automata have equal canonical forms
    /// exactly if their reachable parts are isomorphic; for minimal automata
    /// over one alphabet, exactly if they accept the same language.
    #[must_use]
    pub fn canonical(&self) -> Self {
        let order = self.reachable();
        let mut number = vec![StateId::new(0); self.size()];
        for (new, &old) in order.iter().enumerate() {
            number[old.index()] = StateId::new(new);
        }
        let accepting = order.iter().map(|&q| self.is_accepting(q)).collect();
        let mut delta = Vec::with_capacity(order.len() * self.alphabet().len());
        for &state in &order {
            for symbol in self.alphabet().symbols() {
                delta.push(number[self.next(state, symbol).index()]);
            }
        }
        Self::from_table(self.alphabet().clone(), StateId::new(0), accepting, delta)
    }

    /// The same automaton over `alphabet`, which has the same names in some
    /// other order.
    ///
    /// # Errors
    ///
    /// If the two alphabets do not have the same names.
    pub fn reordered(&self, alphabet: &Alphabet) -> Result<Self, AlphabetMismatch> {
        let mismatch = || AlphabetMismatch::new(self.alphabet(), alphabet);
        if alphabet.len() != self.alphabet().len() {
            return Err(mismatch());
        }
        let columns = alphabet
            .names()
            .map(|name| self.alphabet().symbol(name).ok_or_else(mismatch))
            .collect::<Result<Vec<_>, _>>()?;
        let mut delta = Vec::with_capacity(self.size() * columns.len());
        for state in self.states() {
            delta.extend(columns.iter().map(|&symbol| self.next(state, symbol)));
        }
        let accepting = self.states().map(|q| self.is_accepting(q)).collect();
        Ok(Self::from_table(
            alphabet.clone(),
            self.start(),
            accepting,
            delta,
        ))
    }
}
