//! What others measured: the dissertation's tables, and runs of its authors'
//! public code.
//!
//! The authors' code (`memreps`, branches `generalize` of 2022 and `main` of 2021)
//! was run with the same preference order and starting knowledge as here, but
//! random counterexamples, 1 to 40 trials a cell, fewest in the slow cells.

/// Mean counts for one target at one cost, as far as anybody published or
/// measured them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Published {
    /// The target's name.
    pub(super) target: &'static str,
    /// The cost of a membership query where a comparison costs 1; none where
    /// comparisons are never asked.
    pub(super) cost: Option<u32>,
    /// Membership queries and comparisons: Tables 5.1 and 5.3 (Tomita), 5.4
    /// (`modulo`) and 5.5 (`zeros`).
    pub(super) thesis: [f64; 2],
    /// The variance of membership queries, Table 5.2, and the `σ` of
    /// comparisons, Table 5.3, as printed.
    pub(super) spread: Option<[f64; 2]>,
    /// Equivalence queries, the same at all costs (section 5.3, "Scalability
    /// Experiments").
    pub(super) equivalence: Option<f64>,
    /// Membership queries, comparisons and equivalence queries of branch
    /// `generalize`.
    pub(super) generalize: Option<[f64; 3]>,
    /// The same of branch `main`.
    pub(super) main: Option<[f64; 3]>,
}

/// What was published on a target at a cost.
pub(super) fn on(target: &str, cost: Option<u32>) -> Option<&'static Published> {
    let mut all = PUBLISHED.iter();
    all.find(|published| published.target == target && published.cost == cost)
}

const fn row(
    target: &'static str,
    cost: Option<u32>,
    thesis: [f64; 2],
    spread: Option<[f64; 2]>,
    equivalence: Option<f64>,
    generalize: Option<[f64; 3]>,
    main: Option<[f64; 3]>,
) -> Published {
    Published {
        target,
        cost,
        thesis,
        spread,
        equivalence,
        generalize,
        main,
    }
}

#[rustfmt::skip] // A line a cell, as in the tables.
const PUBLISHED: &[Published] = &[
    row("tomita:1", Some(1), [3.1, 1.4], Some([0.13, 0.75]), None, Some([2.5, 1.2, 2.0]), Some([1.9, 1.8, 2.0])),
    row("tomita:1", Some(2), [3.1, 2.6], Some([0.43, 0.88]), None, Some([2.5, 1.2, 2.0]), Some([1.8, 2.1, 2.0])),
    row("tomita:1", Some(4), [3.0, 3.1], Some([0.22, 0.79]), None, Some([2.5, 1.3, 2.0]), Some([1.4, 2.5, 2.0])),
    row("tomita:1", Some(8), [3.0, 3.8], Some([0.41, 0.83]), None, Some([2.5, 1.2, 2.0]), Some([1.0, 4.0, 2.0])),
    row("tomita:1", None, [3.6, 0.0], Some([0.23, 0.0]), None, Some([3.0, 0.0, 2.0]), Some([2.7, 0.0, 2.0])),
    row("tomita:2", Some(1), [6.6, 4.7], Some([0.74, 1.1]), None, Some([5.1, 2.9, 3.0]), Some([4.6, 3.9, 3.0])),
    row("tomita:2", Some(2), [6.2, 5.2], Some([1.0, 0.92]), None, Some([5.1, 3.3, 3.0]), Some([4.2, 5.2, 3.0])),
    row("tomita:2", Some(4), [5.3, 6.3], Some([0.78, 0.83]), None, Some([4.7, 3.1, 3.0]), Some([1.8, 7.2, 3.0])),
    row("tomita:2", Some(8), [3.5, 8.1], Some([0.67, 0.77]), None, Some([5.0, 3.8, 3.0]), Some([1.4, 8.9, 3.0])),
    row("tomita:2", None, [7.0, 0.0], Some([0.0, 0.0]), None, Some([6.9, 0.0, 3.0]), Some([8.2, 0.0, 3.0])),
    row("tomita:3", Some(1), [5.1, 4.6], Some([0.66, 2.7]), None, Some([12.2, 7.2, 5.0]), Some([10.0, 9.5, 5.0])),
    row("tomita:3", Some(2), [4.7, 5.0], Some([0.61, 1.7]), None, Some([11.5, 9.0, 5.0]), None),
    row("tomita:3", Some(4), [3.8, 9.7], Some([0.87, 2.1]), None, Some([11.0, 10.5, 5.0]), None),
    row("tomita:3", Some(8), [2.7, 15.9], Some([0.64, 2.3]), None, Some([10.0, 12.5, 5.0]), Some([3.7, 22.3, 5.0])),
    row("tomita:3", None, [7.3, 0.0], Some([0.49, 0.0]), None, Some([17.0, 0.0, 5.0]), Some([17.0, 0.0, 5.0])),
    row("tomita:4", Some(1), [12.5, 10.5], Some([1.6, 6.4]), None, Some([8.7, 6.6, 4.0]), Some([9.1, 6.7, 4.0])),
    row("tomita:4", Some(2), [11.2, 25.1], Some([1.6, 11.1]), None, Some([8.6, 7.2, 3.8]), None),
    row("tomita:4", Some(4), [11.4, 41.3], Some([1.6, 12.7]), None, Some([8.0, 5.0, 4.0]), None),
    row("tomita:4", Some(8), [6.8, 84.3], Some([0.97, 17.2]), None, Some([7.0, 8.8, 4.0]), Some([3.4, 25.8, 4.0])),
    row("tomita:4", None, [16.6, 0.0], Some([1.6, 0.0]), None, Some([12.7, 0.0, 4.0]), Some([13.1, 0.0, 4.0])),
    row("tomita:5", Some(1), [8.4, 5.1], Some([1.3, 2.1]), None, Some([8.1, 4.9, 4.0]), Some([7.9, 6.8, 4.0])),
    row("tomita:5", Some(2), [6.6, 7.0], Some([1.2, 1.8]), None, Some([7.7, 5.8, 3.7]), None),
    row("tomita:5", Some(4), [5.6, 8.1], Some([0.64, 3.0]), None, Some([7.1, 6.3, 4.0]), None),
    row("tomita:5", Some(8), [4.2, 9.1], Some([1.1, 5.1]), None, Some([6.9, 7.4, 3.9]), Some([3.0, 21.0, 4.0])),
    row("tomita:5", None, [11.4, 0.0], Some([1.0, 0.0]), None, Some([10.8, 0.0, 4.0]), Some([12.0, 0.0, 4.0])),
    row("tomita:6", Some(1), [5.7, 3.3], Some([0.67, 1.1]), None, Some([4.2, 3.4, 3.0]), Some([4.9, 3.2, 3.0])),
    row("tomita:6", Some(2), [5.5, 3.3], Some([0.92, 2.3]), None, Some([4.5, 2.9, 3.0]), Some([4.0, 5.5, 3.0])),
    row("tomita:6", Some(4), [5.5, 3.7], Some([0.81, 1.4]), None, Some([4.2, 3.3, 3.0]), None),
    row("tomita:6", Some(8), [5.4, 4.1], Some([0.49, 1.3]), None, Some([4.0, 4.1, 3.0]), Some([0.8, 9.0, 3.0])),
    row("tomita:6", None, [6.7, 0.0], Some([0.5, 0.0]), None, Some([6.3, 0.0, 3.0]), None),
    row("tomita:7", Some(1), [17.3, 11.5], Some([2.0, 4.2]), None, Some([13.5, 10.0, 5.0]), Some([15.0, 6.0, 5.0])),
    row("tomita:7", Some(2), [16.1, 22.0], Some([0.87, 9.3]), None, Some([10.0, 12.0, 5.0]), None),
    row("tomita:7", Some(4), [14.9, 44.3], Some([2.2, 8.2]), None, Some([10.0, 12.0, 5.0]), None),
    row("tomita:7", Some(8), [12.2, 78.7], Some([1.3, 16.7]), None, Some([14.0, 13.0, 5.0]), Some([5.0, 39.0, 5.0])),
    row("tomita:7", None, [18.7, 0.0], Some([1.8, 0.0]), None, Some([19.0, 0.0, 5.0]), Some([17.8, 0.0, 5.0])),
    row("modulo:5", Some(1), [2.2, 1.2], None, Some(6.4), None, None),
    row("modulo:5", Some(2), [2.0, 1.5], None, Some(6.4), None, None),
    row("modulo:5", Some(4), [1.4, 2.6], None, Some(6.4), None, None),
    row("modulo:5", Some(8), [1.0, 2.9], None, Some(6.4), None, None),
    row("modulo:10", Some(1), [5.7, 3.6], None, Some(9.1), None, None),
    row("modulo:10", Some(2), [4.7, 5.6], None, Some(9.1), None, None),
    row("modulo:10", Some(4), [4.6, 6.6], None, Some(9.1), None, None),
    row("modulo:10", Some(8), [3.9, 10.9], None, Some(9.1), None, None),
    row("modulo:20", Some(1), [9.4, 7.4], None, Some(9.9), None, None),
    row("modulo:20", Some(2), [8.1, 8.4], None, Some(9.9), None, None),
    row("modulo:20", Some(4), [6.2, 12.2], None, Some(9.9), None, None),
    row("modulo:20", Some(8), [3.7, 17.8], None, Some(9.9), None, None),
    row("modulo:40", Some(1), [18.7, 7.8], None, Some(22.6), None, None),
    row("modulo:40", Some(2), [17.9, 9.9], None, Some(22.6), None, None),
    row("modulo:40", Some(4), [15.4, 19.5], None, Some(22.6), None, None),
    row("modulo:40", Some(8), [11.3, 31.4], None, Some(22.6), None, None),
    row("zeros:1", Some(1), [7.3, 3.1], None, None, None, None),
    row("zeros:1", Some(2), [6.5, 6.3], None, None, None, None),
    row("zeros:1", Some(4), [5.6, 17.7], None, None, None, None),
    row("zeros:1", Some(8), [5.1, 34.1], None, None, None, None),
    row("zeros:2", Some(1), [12.5, 10.5], None, None, None, None),
    row("zeros:2", Some(2), [11.2, 25.1], None, None, None, None),
    row("zeros:2", Some(4), [11.4, 41.3], None, None, None, None),
    row("zeros:2", Some(8), [6.8, 84.3], None, None, None, None),
    row("zeros:3", Some(1), [23.3, 14.3], None, None, None, None),
    row("zeros:3", Some(2), [20.3, 26.9], None, None, None, None),
    row("zeros:3", Some(4), [19.1, 71.7], None, None, None, None),
    row("zeros:3", Some(8), [17.9, 147.2], None, None, None, None),
    row("zeros:4", Some(1), [32.4, 34.6], None, None, None, None),
    row("zeros:4", Some(2), [28.6, 59.0], None, None, None, None),
    row("zeros:4", Some(4), [25.8, 143.6], None, None, None, None),
    row("zeros:4", Some(8), [23.6, 218.6], None, None, None, None),
];
