//! The outputs of states, and what one implies about another.

use super::{ACCEPT, NONE, OPEN, Partial, REJECT};

impl Partial<'_> {
    /// The output of a used state, where it is decided.
    pub(crate) fn output(&self, state: u32) -> Option<bool> {
        match self.output[state as usize] {
            REJECT => Some(false),
            ACCEPT => Some(true),
            _ => None,
        }
    }

    /// Decides the output of a used state; `false` if a fact is violated, and
    /// then it must be undone.
    pub(crate) fn assume(&mut self, state: u32, accepting: bool) -> bool {
        let consistent = self.decide(state, u8::from(accepting));
        self.flips.clear();
        consistent
    }

    /// The implications between outputs that are not decided: if the first
    /// accepts, so does the second.
    pub(crate) fn open_implications(&self) -> impl Iterator<Item = (u32, u32)> + '_ {
        let open = |state: u32| self.output[state as usize] == OPEN;
        (self.implied.iter().copied()).filter(move |&(source, target)| open(source) && open(target))
    }

    /// Sets a state's output and what it implies.
    pub(super) fn decide(&mut self, state: u32, output: u8) -> bool {
        let known = self.output[state as usize];
        if known != OPEN {
            return known == output;
        }
        self.output[state as usize] = output;
        self.outputs.push(state);
        self.flips.push(state);
        while let Some(state) = self.flips.pop() {
            let mut link = if output == ACCEPT {
                self.newest[state as usize].0
            } else {
                self.newest[state as usize].1
            };
            while link != NONE {
                let (source, target) = self.implied[link as usize];
                let (same_source, same_target) = self.before[link as usize];
                let reached = if output == ACCEPT {
                    link = same_source;
                    target
                } else {
                    link = same_target;
                    source
                };
                match self.output[reached as usize] {
                    OPEN => {
                        self.output[reached as usize] = output;
                        self.outputs.push(reached);
                        self.flips.push(reached);
                    }
                    known if known == output => {}
                    _ => return false,
                }
            }
        }
        true
    }

    /// Adds that `source`'s acceptance implies `target`'s.
    pub(super) fn imply(&mut self, source: u32, target: u32) -> bool {
        match (self.output[source as usize], self.output[target as usize]) {
            (REJECT, _) | (_, ACCEPT) => true,
            (ACCEPT, _) => self.decide(target, ACCEPT),
            (_, REJECT) => self.decide(source, REJECT),
            _ => {
                let link = self.implied.len() as u32;
                self.implied.push((source, target));
                self.before.push((
                    self.newest[source as usize].0,
                    self.newest[target as usize].1,
                ));
                self.newest[source as usize].0 = link;
                self.newest[target as usize].1 = link;
                true
            }
        }
    }
}
