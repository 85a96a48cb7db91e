//! Where all chains are, in little room: every session keeps that for each of its
//! answers. Must not know how chains move.

/// A table by its targets and outputs.
pub(super) type Bare = (Vec<u8>, Vec<bool>);

/// Tables over the same symbols, in order.
pub(super) struct Places {
    symbols: usize,
    /// One after the other: the number of states, the targets, the outputs.
    bytes: Box<[u8]>,
}

impl Places {
    /// These tables, each of 255 states at most.
    pub(super) fn new(symbols: usize, tables: impl Iterator<Item = Bare>) -> Self {
        let mut bytes = Vec::new();
        for (delta, output) in tables {
            bytes.push(output.len() as u8);
            bytes.extend(delta);
            bytes.extend(output.into_iter().map(u8::from));
        }
        Self {
            symbols,
            bytes: bytes.into(),
        }
    }

    /// The tables.
    pub(super) fn tables(&self) -> impl Iterator<Item = Bare> {
        let mut rest = &*self.bytes;
        std::iter::from_fn(move || {
            let (states, after) = rest.split_first()?;
            let states = usize::from(*states);
            let (delta, after) = after.split_at(states * self.symbols);
            let (output, after) = after.split_at(states);
            rest = after;
            let output = output.iter().map(|&accepting| accepting == 1).collect();
            Some((delta.to_vec(), output))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_come_out_as_they_went_in() {
        let tables: Vec<Bare> = vec![
            (vec![0, 0], vec![true]),
            (vec![1, 0, 2, 2, 0, 1], vec![false, true, false]),
            (vec![0, 0], vec![false]),
        ];
        let places = Places::new(2, tables.iter().cloned());
        assert_eq!(places.tables().collect::<Vec<_>>(), tables);
    }
}
