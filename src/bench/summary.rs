//! What many runs come to: means, spreads, and ratios with their uncertainty.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A mean and the standard deviation of the sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// The mean.
    pub mean: f64,
    /// The standard deviation, with one degree of freedom less than values; 0
    /// for a single value.
    pub deviation: f64,
}

/// The spread of some values; none for no values.
pub fn spread(values: &[f64]) -> Option<Spread> {
    if values.is_empty() {
        return None;
    }
    let mean = mean(values.iter().copied());
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    let degrees = values.len().saturating_sub(1).max(1) as f64;
    Some(Spread {
        mean,
        deviation: (squares / degrees).sqrt(),
    })
}

/// The costs of one target's runs and of those it is measured by, seed by seed.
pub type Pairs = Vec<(f64, f64)>;

/// A geometric mean over targets of the ratio of mean costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ratio {
    /// The ratio.
    pub ratio: f64,
    /// Between these, 95 of 100 resampled ratios lie.
    pub interval: (f64, f64),
}

/// From what the uncertainty of a ratio comes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Uncertainty {
    /// The targets are all that there are; only the runs are chance.
    Runs,
    /// The targets were drawn too.
    TargetsAndRuns,
}

const RESAMPLES: usize = 1000;

/// The geometric mean over `targets` of the ratio of mean costs, with the
/// interval of the percentile bootstrap; none where some target has no runs, or
/// nothing was paid in the runs it is measured by.
pub fn ratio(targets: &[Pairs], uncertainty: Uncertainty) -> Option<Ratio> {
    let middle = geometric_mean(targets.iter().map(|pairs| of_means(pairs.iter())))?;
    let mut random = ChaCha8Rng::seed_from_u64(0);
    let mut ratios: Vec<f64> = (0..RESAMPLES)
        .filter_map(|_| {
            let drawn: Vec<usize> = match uncertainty {
                Uncertainty::Runs => (0..targets.len()).collect(),
                Uncertainty::TargetsAndRuns => (0..targets.len())
                    .map(|_| random.random_range(0..targets.len()))
                    .collect(),
            };
            geometric_mean(drawn.into_iter().map(|target| {
                let pairs = &targets[target];
                let seeds: Vec<usize> = (0..pairs.len())
                    .map(|_| random.random_range(0..pairs.len()))
                    .collect();
                of_means(seeds.iter().map(|&seed| &pairs[seed]))
            }))
        })
        .collect();
    ratios.sort_by(f64::total_cmp);
    let last = ratios.len().checked_sub(1)?;
    let at = |thousandths: usize| ratios[(last * thousandths + 500) / 1000];
    Some(Ratio {
        ratio: middle,
        interval: (at(25), at(975)),
    })
}

/// The ratio of the means; not a number, or infinite, where it has none.
fn of_means<'a>(pairs: impl Iterator<Item = &'a (f64, f64)>) -> f64 {
    let (ours, theirs) = pairs.fold((0.0, 0.0), |sum, pair| (sum.0 + pair.0, sum.1 + pair.1));
    ours / theirs
}

/// The geometric mean of numbers from 0; none for no numbers, or if one of them
/// is none or infinite.
fn geometric_mean(ratios: impl Iterator<Item = f64>) -> Option<f64> {
    let logarithms: Vec<f64> = ratios.map(f64::ln).collect();
    let well = !logarithms.is_empty() && logarithms.iter().all(|log| *log < f64::INFINITY);
    well.then(|| mean(logarithms.into_iter()).exp())
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}
