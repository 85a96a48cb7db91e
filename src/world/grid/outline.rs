//! A simple automaton around the words that can be shown: which symbols can come
//! next, whatever the steps. What two concepts agree on there, no search through
//! the grid need look for.

use std::collections::HashMap;

use automata::Dfa;

use super::{Cells, Grid, Labelling};

/// The most states of an outline that knows on which tiles one may be.
const MOST: usize = 32;

impl Grid {
    /// A language with every feasible word: exactly those that could be shown if
    /// there were no end to the steps, where that is simple enough.
    pub(in crate::world) fn outline(&self) -> Option<Dfa> {
        self.by_tiles(false).or_else(|| self.by_tiles(true))
    }

    /// The automaton of the sets of tiles on which one may be after a word; where
    /// `coarse`, as if one could be on any tile of the last symbol.
    fn by_tiles(&self, coarse: bool) -> Option<Dfa> {
        let mut sets = vec![self.start_cells()];
        let mut numbers: HashMap<Cells, usize> = HashMap::new();
        // A start is no tile that was stepped on: it is a state of its own.
        let mut rows: Vec<Vec<usize>> = Vec::new();
        while let Some(cells) = sets.get(rows.len()) {
            let entered = self.next_tiles(cells);
            let mut row = Vec::with_capacity(entered.len());
            for (symbol, tiles) in entered.into_iter().enumerate() {
                if tiles.is_empty() {
                    row.push(usize::MAX);
                    continue;
                }
                let set = if coarse {
                    self.coloured[symbol].clone()
                } else {
                    tiles
                };
                let number = *numbers.entry(set.clone()).or_insert_with(|| {
                    sets.push(set);
                    sets.len() - 1
                });
                row.push(number);
            }
            rows.push(row);
            if sets.len() > MOST && !coarse {
                return None;
            }
        }
        let nowhere = rows.len();
        for next in rows.iter_mut().flatten() {
            *next = (*next).min(nowhere);
        }
        rows.push(vec![nowhere; self.alphabet.len()]);
        let accepting = (0..=nowhere).map(|state| state != nowhere).collect();
        Dfa::new(self.alphabet.clone(), 0, accepting, &rows).ok()
    }

    /// By symbol the tiles that can be the next to give one.
    fn next_tiles(&self, cells: &Cells) -> Vec<Cells> {
        let mut reached = Cells::none(self.bits());
        let mut front = cells.clone();
        let mut entered = Cells::none(self.bits());
        if self.labelling == Labelling::EveryStep {
            entered.add(cells);
        }
        while !front.is_empty() {
            front = front.moved(self.stride());
            entered.add(&front);
            front.keep(&self.blank);
            front.remove(&reached);
            reached.add(&front);
        }
        self.coloured
            .iter()
            .map(|tiles| tiles.and(&entered))
            .collect()
    }
}
