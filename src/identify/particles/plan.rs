//! What was heard, laid out so that many tables are judged by it fast. Must not know
//! where the tables come from.

use super::LARGEST;
use super::script::{Compared, Labelled, Node};
use crate::belief::{Ending, Place, Tally};

/// The nodes of a [`super::script::Script`] by depth: those of a depth do not wait for
/// each other, and a processor steps on several at once.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    symbols: usize,
    nodes: Vec<Node>,
    labels: Vec<Labelled>,
    comparisons: Vec<Compared>,
}

/// The words of a plan on a table, and what they meet there.
#[derive(Clone, Debug, Default)]
pub(crate) struct Run {
    /// By node.
    at: Vec<At>,
    /// By state.
    paces: Vec<Pace>,
    /// By state, what ends of words there have in common: in acceptance, how many words
    /// of two symbols lead on to it.
    places: Vec<Place>,
}

/// A node of a [`Run`]: its state, and above that how long its word did well.
#[derive(Clone, Copy, Debug, Default)]
struct At(u32);

impl At {
    fn new(state: u8, progress: u32) -> Self {
        Self(progress << u8::BITS | u32::from(state))
    }

    fn state(self) -> usize {
        usize::from(self.0 as u8)
    }

    fn progress(self) -> u32 {
        self.0 >> u8::BITS
    }
}

impl Plan {
    /// Of nodes in any order in which parents come first.
    pub(super) fn new(
        symbols: usize,
        nodes: &[Node],
        labels: &[Labelled],
        comparisons: &[Compared],
    ) -> Self {
        let mut order: Vec<u32> = (0..nodes.len() as u32).collect();
        order.sort_by_key(|&node| nodes[node as usize].depth);
        let mut number = vec![0; nodes.len()];
        for (new, &node) in (0..).zip(&order) {
            number[node as usize] = new;
        }
        let number = |node: u32| number[node as usize];
        let ordered = order.iter().map(|&node| {
            let node = nodes[node as usize];
            Node {
                parent: number(node.parent),
                ..node
            }
        });
        let labels = labels.iter().map(|&label| Labelled {
            node: number(label.node),
            ..label
        });
        let comparisons = comparisons.iter().map(|&comparison| Compared {
            first: number(comparison.first),
            second: number(comparison.second),
            ..comparison
        });
        Self {
            symbols,
            nodes: ordered.collect(),
            labels: labels.collect(),
            comparisons: comparisons.collect(),
        }
    }

    /// The number of different beginnings of words heard.
    pub(crate) fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// What was heard, as a table sees it.
    pub(crate) fn tally(&self, delta: &[u8], output: &[bool], run: &mut Run) -> Tally {
        run.survey(self.symbols, delta, output);
        run.read(self.symbols, &self.nodes, delta);
        let (at, places) = (&run.at[..], &run.places[..]);
        let mut tally = Tally::default();
        for label in &self.labels {
            let accepts = output[at[label.node as usize].state()];
            tally.label(accepts == label.accepted, label.sure);
        }
        let end = |node: u32| {
            let at = at[node as usize];
            places[at.state()].end(at.progress())
        };
        for comparison in &self.comparisons {
            let ending = Ending::of(end(comparison.first), end(comparison.second));
            tally.comparison(ending, comparison.verdict, comparison.sure);
        }
        tally
    }
}

impl Run {
    /// Looks at every state of a table.
    fn survey(&mut self, symbols: usize, delta: &[u8], output: &[bool]) {
        let rows = || delta.chunks_exact(symbols);
        let mut ways = [0_u32; LARGEST];
        for (ways, row) in ways.iter_mut().zip(rows()) {
            *ways = row
                .iter()
                .map(|&to| u32::from(output[usize::from(to)]))
                .sum();
        }
        self.places.clear();
        self.paces.clear();
        // Tables that are not minimal may have several rejecting sinks; the first is
        // taken for one.
        let mut sunk = false;
        for (state, (row, &accepting)) in (0..).zip(rows().zip(output)) {
            let sinks = !accepting && !sunk && row.iter().all(|&to| u32::from(to) == state);
            sunk |= sinks;
            self.paces.push(Pace::new(accepting, sinks));
            self.places.push(if accepting {
                Place::inside(state, row.iter().map(|&to| ways[usize::from(to)]).sum())
            } else {
                Place::outside(state)
            });
        }
    }

    /// Reads every word: where it ends, and how long it did well.
    fn read(&mut self, symbols: usize, nodes: &[Node], delta: &[u8]) {
        let Self { at, paces, .. } = self;
        at.resize(nodes.len(), At::default());
        // Slices stay in registers, where vectors would be looked up at every node.
        let (at, paces) = (&mut at[..], &paces[..]);
        at[0] = At::new(0, paces[0].start());
        for (number, node) in nodes.iter().enumerate().skip(1) {
            let parent = at[node.parent as usize];
            let state = delta[parent.state() * symbols + node.symbol as usize];
            let progress = paces[usize::from(state)].progress(node.depth, parent.progress());
            at[number] = At::new(state, progress);
        }
    }
}

/// What it does for a word to come to a state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace {
    /// All bits but in a rejecting sink.
    afloat: u32,
    /// All bits in acceptance.
    accepting: u32,
}

/// More than the length of any word; what comes after it fits beside a state.
const AFLOAT: u32 = 1 << 16;

impl Pace {
    /// Of a state that accepts or not, and is a rejecting sink or not.
    pub(crate) fn new(accepting: bool, sunk: bool) -> Self {
        let all_if = |is: bool| if is { u32::MAX } else { 0 };
        Self {
            afloat: all_if(!sunk),
            accepting: all_if(accepting),
        }
    }

    /// How long the empty word does well, if this is the first state.
    pub(crate) fn start(self) -> u32 {
        self.progress(0, AFLOAT)
    }

    /// How long a word of this length did well (section 5.3, "Tomita languages"):
    /// until it fell into a rejecting sink; what never did comes after all that did,
    /// by its longest accepted prefix.
    #[inline]
    pub(crate) fn progress(self, length: u32, before: u32) -> u32 {
        // No branches: this is what chains spend most of their time on.
        let limit = length | self.afloat;
        let least = (AFLOAT + length + 1) & self.accepting;
        before.min(limit).max(least)
    }
}

#[cfg(test)]
mod tests {
    use automata::{Alphabet, Word};

    use super::*;
    use crate::belief::{Heard, Verdict};
    use crate::evidence::Fact;
    use crate::identify::completion::automaton;
    use crate::identify::end;
    use crate::identify::particles::script::Script;

    /// All words of up to three symbols are labelled, and compared with each other.
    #[test]
    fn a_plan_sees_what_words_come_to_one_by_one() {
        let alphabet = Alphabet::new(["a", "b"]).expect("two symbols");
        let words: Vec<Word> = alphabet.words().take(15).collect();
        let mut script = Script::new(alphabet.len());
        for (number, atom) in words.iter().rev().enumerate() {
            script.add(&Heard {
                fact: Fact::Label {
                    atom: atom.clone(),
                    accepted: number % 3 == 0,
                },
                sure: number % 2 == 0,
            });
            for better in &words {
                script.add(&Heard {
                    fact: Fact::Below {
                        worse: atom.clone(),
                        better: better.clone(),
                    },
                    sure: number % 2 == 0,
                });
            }
        }
        // The last one has a rejecting sink.
        let tables: [(&[u8], &[bool]); 3] = [
            (&[0, 0], &[true]),
            (&[1, 0, 2, 1, 0, 2], &[true, false, true]),
            (&[0, 1, 2, 1, 2, 2], &[false, true, false]),
        ];
        let mut run = Run::default();
        for (delta, output) in tables {
            let targets = delta.iter().map(|&to| u32::from(to)).collect();
            let dfa = automaton(&alphabet, (targets, output.into()));
            let mut expected = Tally::default();
            for (number, atom) in words.iter().rev().enumerate() {
                let agrees = end(&dfa, atom).is_inside() == (number % 3 == 0);
                expected.label(agrees, number % 2 == 0);
                for better in &words {
                    let ending = Ending::of(end(&dfa, atom), end(&dfa, better));
                    expected.comparison(ending, Verdict::Worse, number % 2 == 0);
                }
            }
            let seen = script.plan().tally(delta, output, &mut run);
            assert_eq!(format!("{seen:?}"), format!("{expected:?}"));
        }
    }
}
