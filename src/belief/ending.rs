//! How atoms end in concepts, and pairs of them.

use std::fmt;

/// How an atom ends in a concept, in the eight bytes that let millions of them be
/// compared for a question.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct End(u64);

/// Below the bit for what is inside, the merit; below that the place.
const PLACE_BITS: u32 = 31;
const NO_PLACE: u64 = 0;

impl End {
    /// `place` is a number for the place in which the atom ends, below 2³¹ − 1 (for
    /// automata: the state), none where nothing finer is known than inside and
    /// outside. Atoms of one place have one label.
    ///
    /// `merit` is, of an atom outside, how long it did well: more is longer. Teachers
    /// often prefer the failure that came later. Of an atom inside it is how much room
    /// it leaves: more is more ways to go on well. Teachers often prefer it to one
    /// after which little is allowed.
    #[inline]
    pub fn new(inside: bool, place: Option<u32>, merit: u32) -> Self {
        let place = place.map_or(NO_PLACE, |place| u64::from(place) + 1);
        debug_assert!(place >> PLACE_BITS == 0, "places are few");
        Self(u64::from(inside) << 63 | u64::from(merit) << PLACE_BITS | place)
    }

    /// Whether the concept contains the atom.
    #[inline]
    pub fn is_inside(self) -> bool {
        self.0 >> 63 == 1
    }

    /// How well it did, as [`Self::new`] was told.
    #[inline]
    pub fn merit(self) -> u32 {
        (self.0 >> PLACE_BITS) as u32
    }

    fn place(self) -> u64 {
        self.0 & ((1 << PLACE_BITS) - 1)
    }
}

/// A place in which atoms end, as a concept has it: what their ends have in common, for
/// those who ask for many of them.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    common: u64,
    /// Where the merit goes that not all have in common.
    merit: u64,
}

impl Place {
    /// The place of this number, as [`End::new`] is told it, outside.
    pub fn outside(number: u32) -> Self {
        Self {
            common: End::new(false, Some(number), 0).0,
            merit: u64::from(u32::MAX) << PLACE_BITS,
        }
    }

    /// The same inside, where it leaves so much room.
    pub fn inside(number: u32, room: u32) -> Self {
        Self {
            common: End::new(true, Some(number), room).0,
            merit: 0,
        }
    }

    /// The end of an atom there, which did well for so long if it is outside.
    #[inline]
    pub fn end(self, progress: u32) -> End {
        End(self.common | u64::from(progress) << PLACE_BITS & self.merit)
    }
}

/// So many ends are compared at once.
pub const LANES: usize = 16;

/// How an atom ends in one concept after another: what many pairs of atoms are compared
/// by, [`LANES`] at a time.
#[derive(Clone, Debug)]
pub struct Column {
    /// The last one is filled up.
    lanes: Vec<Lanes>,
}

#[derive(Clone, Copy, Debug)]
struct Lanes {
    /// In the order of merit.
    merits: [i32; LANES],
    /// Above the number of the place the bit for what is inside.
    places: [u32; LANES],
}

impl FromIterator<End> for Column {
    fn from_iter<I: IntoIterator<Item = End>>(ends: I) -> Self {
        let mut lanes = Vec::new();
        for (lane, end) in (0..LANES).cycle().zip(ends) {
            if lane == 0 {
                lanes.push(Lanes {
                    merits: [0; LANES],
                    places: [0; LANES],
                });
            }
            if let Some(last) = lanes.last_mut() {
                // Processors compare what has a sign.
                last.merits[lane] = (end.merit() ^ 1 << 31).cast_signed();
                last.places[lane] = end.place() as u32 | u32::from(end.is_inside()) << PLACE_BITS;
            }
        }
        Self { lanes }
    }
}

impl Column {
    /// How pairs of atoms end, from concept to concept: what comes after the last of
    /// these says nothing.
    #[inline]
    pub fn endings<'a>(&'a self, second: &'a Self) -> impl Iterator<Item = [Ending; LANES]> + 'a {
        let pairs = self.lanes.iter().zip(&second.lanes);
        pairs.map(|(first, second)| {
            let numbers: [u32; LANES] = std::array::from_fn(|lane| {
                let merits = [first.merits[lane], second.merits[lane]];
                let places = [first.places[lane], second.places[lane]];
                let same = u32::from(places[0] == places[1]) & u32::from(places[0] << 1 != 0);
                same | u32::from(merits[0] > merits[1]) << 1
                    | u32::from(merits[0] < merits[1]) << 2
                    | places[1] >> PLACE_BITS << 3
                    | places[0] >> PLACE_BITS << 4
            });
            numbers.map(|number| ENDINGS[number as usize % ENDINGS.len()])
        })
    }
}

impl fmt::Debug for End {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let place = self.place().checked_sub(1);
        (formatter.debug_struct("End"))
            .field("inside", &self.is_inside())
            .field("place", &place)
            .field("merit", &self.merit())
            .finish()
    }
}

/// How two atoms end, as a concept has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// Only the first is in the concept.
    FirstOnly,
    /// Only the second is.
    SecondOnly,
    /// Both end in the same place.
    SamePlace,
    /// Both are in the concept, in different places of equal merit.
    Inside,
    /// Neither is in the concept, in different places of equal merit.
    Outside,
    /// Neither is in the concept, and the first did well for longer.
    FirstFurther,
    /// Neither is in the concept, and the second did well for longer.
    SecondFurther,
    /// Both are in the concept, and the first leaves more room.
    FirstFreer,
    /// Both are in the concept, and the second leaves more room.
    SecondFreer,
}

impl Ending {
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; 9] = [
        Self::FirstOnly,
        Self::SecondOnly,
        Self::SamePlace,
        Self::Inside,
        Self::Outside,
        Self::FirstFurther,
        Self::SecondFurther,
        Self::FirstFreer,
        Self::SecondFreer,
    ];

    /// Of two atoms that end like this.
    #[inline]
    pub fn of(first: End, second: End) -> Self {
        // No branches: nobody can guess them, and all that is believed asks this.
        let order = usize::from(first.merit() > second.merit())
            | usize::from(first.merit() < second.merit()) << 1;
        let same =
            usize::from(first.place() != NO_PLACE) & usize::from(first.place() == second.place());
        let inside = usize::from(first.is_inside()) << 1 | usize::from(second.is_inside());
        ENDINGS[inside << 3 | order << 1 | same]
    }

    /// Of two atoms in the concept or not, of which the first has more merit, or the
    /// second, or neither, and which end in the same place or not.
    const fn told([first, second]: [bool; 2], more: [bool; 2], same: bool) -> Self {
        match ((first, second), more) {
            ((true, false), _) => Self::FirstOnly,
            ((false, true), _) => Self::SecondOnly,
            ((false, false), [true, _]) => Self::FirstFurther,
            ((false, false), [_, true]) => Self::SecondFurther,
            ((true, true), [true, _]) => Self::FirstFreer,
            ((true, true), [_, true]) => Self::SecondFreer,
            _ if same => Self::SamePlace,
            ((true, true), _) => Self::Inside,
            ((false, false), _) => Self::Outside,
        }
    }
}

/// By the bits of whether the first is in the concept, whether the second is, whether
/// the second has more merit, whether the first has, and whether they end in the same
/// place.
const ENDINGS: [Ending; 32] = {
    let mut endings = [Ending::SamePlace; 32];
    let mut number = 0;
    while number < 32 {
        endings[number] = Ending::told(
            [number >> 4 == 1, number >> 3 & 1 == 1],
            [number >> 1 & 1 == 1, number >> 2 & 1 == 1],
            number & 1 == 1,
        );
        number += 1;
    }
    endings
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_compared_by_what_they_were_told() {
        let merits = [0, 1, 40_000, u32::MAX];
        let places = [None, Some(0), Some(1), Some((1 << PLACE_BITS) - 2)];
        let ends = || {
            let inside = [false, true].into_iter();
            let merits = inside.flat_map(|inside| merits.map(|merit| (inside, merit)));
            merits.flat_map(|(inside, merit)| places.map(|place| (inside, place, merit)))
        };
        for first in ends() {
            for second in ends() {
                let [one, other] = [first, second].map(|(i, p, m)| End::new(i, p, m));
                let same = first.1.is_some() && first.1 == second.1;
                let more = [first.2 > second.2, first.2 < second.2];
                let expected = Ending::told([first.0, second.0], more, same);
                assert_eq!(Ending::of(one, other), expected, "{one:?} {other:?}");
                assert_eq!(one == other, first == second);
                let [one, other] = [one, other].map(|end| Column::from_iter([end; LANES + 1]));
                assert!(
                    one.endings(&other)
                        .flatten()
                        .take(LANES + 1)
                        .all(|e| e == expected)
                );
            }
        }
    }
}
