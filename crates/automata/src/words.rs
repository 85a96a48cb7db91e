//! Words in length-lexicographic order: all of an alphabet, or those that an
//! automaton accepts.

use crate::explore::Extent;
use crate::{Alphabet, Dfa, StateId, Symbol, Word};

/// All words over an alphabet in length-lexicographic order, without end.
#[derive(Clone, Debug)]
pub struct Words {
    symbols: usize,
    next: Vec<Symbol>,
}

impl Alphabet {
    /// All words over this alphabet in length-lexicographic order, the empty
    /// word first. The iterator never ends.
    pub fn words(&self) -> Words {
        Words {
            symbols: self.len(),
            next: Vec::new(),
        }
    }

    /// The words of at most `length` symbols in length-lexicographic order.
    pub fn words_up_to(&self, length: usize) -> impl Iterator<Item = Word> + use<> {
        self.words().take_while(move |word| word.len() <= length)
    }
}

impl Iterator for Words {
    type Item = Word;

    fn next(&mut self) -> Option<Word> {
        let word = Word::from(self.next.as_slice());
        // Counts up: the last symbol that is not the alphabet's last goes one
        // further and all behind it begin anew.
        let last = self.symbols - 1;
        let mut place = self.next.len();
        loop {
            if place == 0 {
                self.next.push(Symbol::new(0));
                break;
            }
            place -= 1;
            let index = self.next[place].index();
            if index < last {
                self.next[place] = Symbol::new(index + 1);
                break;
            }
            self.next[place] = Symbol::new(0);
        }
        Some(word)
    }
}

/// The words that an automaton accepts, in length-lexicographic order.
///
/// Ends after the last word of a finite language. It never follows a symbol from
/// which no word of the current length is left, so the next word of that length
/// takes at most `2 · length · |Σ|` steps. Holds one bit a state for every
/// length that it has reached.
#[derive(Clone, Debug)]
pub struct AcceptedWords<'a> {
    dfa: &'a Dfa,
    /// The length of the longest word, where there is one.
    longest: Option<usize>,
    /// `hits[k][q]`: whether some word of `k` symbols is accepted from `q`.
    hits: Vec<Vec<bool>>,
    /// The length of the words that come now.
    length: usize,
    /// The word that came last, and the states it passes; without states if no
    /// word of this length came yet.
    word: Vec<Symbol>,
    path: Vec<StateId>,
    done: bool,
}

impl Dfa {
    /// The accepted words in length-lexicographic order. The iterator ends
    /// exactly if the language is finite.
    ///
    /// ```
    /// use automata::{Alphabet, Dfa};
    ///
    /// let alphabet = Alphabet::new(["a", "b"])?;
    /// let odd = Dfa::new(alphabet.clone(), 0, vec![false, true], &[vec![1, 0], vec![0, 1]])?;
    /// let words: Vec<String> = odd
    ///     .accepted_words()
    ///     .take(4)
    ///     .map(|word| alphabet.spell(&word).collect())
    ///     .collect();
    /// assert_eq!(words, ["a", "ab", "ba", "aaa"]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn accepted_words(&self) -> AcceptedWords<'_> {
        let extent = self.extent();
        AcceptedWords {
            dfa: self,
            longest: match extent {
                Extent::Longest(length) => Some(length),
                Extent::NoWord | Extent::Unbounded => None,
            },
            hits: vec![self.states().map(|q| self.is_accepting(q)).collect()],
            length: 0,
            word: Vec::new(),
            path: Vec::new(),
            done: extent == Extent::NoWord,
        }
    }
}

impl AcceptedWords<'_> {
    /// Goes on to words that are one symbol longer.
    fn lengthen(&mut self) {
        self.length += 1;
        self.word.clear();
        self.path.clear();
        let shorter = self.hits.last().expect("there is a row for every length");
        let row = self
            .dfa
            .states()
            .map(|q| {
                let mut symbols = self.dfa.alphabet().symbols();
                symbols.any(|a| shorter[self.dfa.next(q, a).index()])
            })
            .collect();
        self.hits.push(row);
    }

    /// Finds the next word of the current length: `false` if there is none.
    fn advance(&mut self) -> bool {
        let symbols = self.dfa.alphabet().len();
        // The least symbol that may stand at the place that is filled next.
        let mut least = 0;
        if self.path.is_empty() {
            let start = self.dfa.start();
            if !self.hits[self.length][start.index()] {
                return false;
            }
            self.path.push(start);
        } else {
            let Some(last) = self.word.pop() else {
                return false;
            };
            self.path.pop();
            least = last.index() + 1;
        }
        while self.word.len() < self.length {
            let state = *self
                .path
                .last()
                .expect("the start state is never taken off");
            let left = self.length - self.word.len() - 1;
            let step = (least..symbols)
                .map(Symbol::new)
                .map(|symbol| (symbol, self.dfa.next(state, symbol)))
                .find(|(_, next)| self.hits[left][next.index()]);
            if let Some((symbol, next)) = step {
                self.word.push(symbol);
                self.path.push(next);
                least = 0;
            } else {
                let Some(last) = self.word.pop() else {
                    return false;
                };
                self.path.pop();
                least = last.index() + 1;
            }
        }
        true
    }
}

impl Iterator for AcceptedWords<'_> {
    type Item = Word;

    fn next(&mut self) -> Option<Word> {
        while !self.done {
            if self.advance() {
                return Some(Word::from(self.word.as_slice()));
            }
            if self.longest.is_some_and(|longest| self.length >= longest) {
                self.done = true;
            } else {
                self.lengthen();
            }
        }
        None
    }
}

impl std::iter::FusedIterator for AcceptedWords<'_> {}
