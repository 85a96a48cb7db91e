//! What was found of tables that chains come to again and again. Must not know what
//! that is.

use std::ops::{BitOr, Shl};

/// What was found of tables lately: each has a place of its own, of `1 << BITS`, until
/// another takes it.
pub(super) struct Memo<T, const BITS: u32> {
    places: Vec<Option<(u128, T)>>,
    /// A few bits of the number of what is there: most of what is asked for is not, and
    /// that shows without a look at what does not fit near the processor.
    tags: Vec<u8>,
}

impl<T: Copy, const BITS: u32> Default for Memo<T, BITS> {
    fn default() -> Self {
        Self {
            places: vec![None; 1 << BITS],
            tags: vec![0; 1 << BITS],
        }
    }
}

impl<T: Copy, const BITS: u32> Memo<T, BITS> {
    /// What was found of the table with this [`key`], if that is remembered.
    pub(super) fn get(&self, key: u128) -> Option<T> {
        let (place, tag) = Self::place(key);
        if self.tags[place] != tag {
            return None;
        }
        let known = self.places[place].filter(|(known, _)| *known == key);
        known.map(|(_, found)| found)
    }

    /// Takes note of what was found.
    pub(super) fn keep(&mut self, key: u128, found: T) {
        let (place, tag) = Self::place(key);
        self.tags[place] = tag;
        self.places[place] = Some((key, found));
    }

    /// Its place, and its tag.
    fn place(key: u128) -> (usize, u8) {
        // Fibonacci hashing of both halves.
        const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;
        let folded = (key as u64).wrapping_mul(GOLDEN) ^ (key >> 64) as u64;
        let hash = folded.wrapping_mul(GOLDEN) >> (u64::BITS - BITS - u8::BITS);
        ((hash >> u8::BITS) as usize, hash as u8)
    }
}

/// A number that no other table over the same symbols has; none for a table too
/// large for that.
pub(super) fn key(delta: &[u8], output: &[bool]) -> Option<u128> {
    let states = output.len();
    let width = usize::BITS - (states - 1).leading_zeros();
    // The one before all tells how many states there are.
    let bits = 1 + delta.len() * width as usize + states;
    if bits > u128::BITS as usize {
        return None;
    }
    // Most tables fit into a word, which is shifted faster.
    let fits = bits <= u64::BITS as usize;
    Some(if fits {
        packed::<u64>(delta, output, width).into()
    } else {
        packed::<u128>(delta, output, width)
    })
}

fn packed<N>(delta: &[u8], output: &[bool], width: u32) -> N
where
    N: From<u8> + From<bool> + Shl<u32, Output = N> + BitOr<Output = N>,
{
    let targets = delta
        .iter()
        .fold(N::from(1_u8), |key, &to| key << width | to.into());
    (output.iter()).fold(targets, |key, &accepting| key << 1 | accepting.into())
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::key;

    /// All tables of up to three states over two symbols, and no two of one number.
    #[test]
    fn no_two_tables_have_one_key() {
        let mut keys = HashSet::new();
        let mut tables = 0;
        for states in 1..=3_usize {
            for code in 0..states.pow(2 * states as u32) {
                let edges = (0..2 * states as u32).map(|edge| code / states.pow(edge) % states);
                let delta: Vec<u8> = edges.map(|target| target as u8).collect();
                for outputs in 0..1 << states {
                    let output: Vec<bool> = (0..states).map(|s| outputs >> s & 1 == 1).collect();
                    tables += 1;
                    assert!(keys.insert(key(&delta, &output).unwrap()));
                }
            }
        }
        assert_eq!(keys.len(), tables);
        assert_eq!(key(&[0; 80], &[false; 40]), None, "too large");
    }
}
