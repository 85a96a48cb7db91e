//! What a world leaves undecided: where a hypothesis could be another, and nothing
//! that can be shown would tell.

use automata::{Dfa, Word};

use super::{Situated, product};

impl Situated {
    /// What the world lacks: the simplest open word, feasible or not, about which
    /// nothing that can be shown tells. Another transition or output would change
    /// it in the hypothesis, and nothing that can be shown; or it has a symbol that
    /// nothing shows. None if there is no such word.
    pub fn beyond(&self, hypothesis: &Dfa) -> Option<Word> {
        let untold = neighbours(hypothesis).filter_map(|other| {
            let word = self
                .open_difference(hypothesis, &other)
                .shortest_accepted()?;
            self.separate(hypothesis, &other).is_none().then_some(word)
        });
        let never_shown = self.learned.ignored();
        let unseen = product(&never_shown, self.prior.open(), |ignored, open| {
            ignored && open
        });
        untold.chain(unseen.shortest_accepted()).min()
    }
}

/// The automata that differ from this one in one output or one transition.
fn neighbours(dfa: &Dfa) -> impl Iterator<Item = Dfa> {
    let outputs: Vec<bool> = dfa.states().map(|state| dfa.is_accepting(state)).collect();
    let row = |state| {
        let symbols = dfa.alphabet().symbols();
        symbols
            .map(|symbol| dfa.next(state, symbol).index())
            .collect()
    };
    let rows: Vec<Vec<usize>> = dfa.states().map(row).collect();
    let letters = dfa.alphabet().len();
    // The last choice of every state is its output, the others are transitions.
    let size = dfa.size();
    let places = (0..size).flat_map(move |state| (0..=letters).map(move |choice| (state, choice)));
    places.flat_map(move |(state, choice)| {
        let changed = |target: usize| {
            let (mut outputs, mut rows) = (outputs.clone(), rows.clone());
            match rows[state].get_mut(choice) {
                Some(edge) => *edge = target,
                None => outputs[state] = !outputs[state],
            }
            Dfa::new(dfa.alphabet().clone(), dfa.start().index(), outputs, &rows)
                .expect("every state has a row, and every entry is a state")
        };
        let targets = if choice < letters { 0..size } else { 0..1 };
        targets.map(changed).collect::<Vec<_>>()
    })
}
