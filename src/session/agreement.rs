//! How far several people agree: percent, Cohen's κ and Krippendorff's α. Knows
//! no sessions: an answer is a number, a question a row.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

/// How far people agree on the questions that two of them or more answered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Agreement {
    /// The questions that count.
    pub questions: usize,
    /// Of all pairs of answers to the same question, the share that are the same,
    /// from 0 to 1; none where there is no pair.
    pub same: Option<f64>,
    /// Cohen's κ, where exactly two people answered: 1 is full agreement, 0 what
    /// chance would bring. None where chance alone would agree always.
    pub kappa: Option<f64>,
    /// Krippendorff's α for nominal answers, as κ for any number of people, not
    /// all of whom need have answered everything.
    pub alpha: Option<f64>,
}

impl Agreement {
    /// Of these questions, each given as what people answered, by person.
    pub fn of<P: Copy + Ord, A: Copy + Ord>(questions: &[BTreeMap<P, A>]) -> Self {
        let shared: Vec<&BTreeMap<P, A>> = questions
            .iter()
            .filter(|answers| answers.len() > 1)
            .collect();
        let people: BTreeSet<P> = shared.iter().flat_map(|row| row.keys().copied()).collect();
        let pair: Vec<P> = people.into_iter().collect();
        Self {
            questions: shared.len(),
            same: same(&shared),
            kappa: match pair[..] {
                [one, other] => kappa(&shared, one, other),
                _ => None,
            },
            alpha: alpha(&shared),
        }
    }
}

fn pairs(count: usize) -> usize {
    count * count.saturating_sub(1)
}

/// How often every answer was given to the question.
fn counts<P, A: Copy + Ord>(row: &BTreeMap<P, A>) -> BTreeMap<A, usize> {
    let mut counts = BTreeMap::new();
    for &answer in row.values() {
        *counts.entry(answer).or_default() += 1;
    }
    counts
}

fn same<P, A: Copy + Ord>(rows: &[&BTreeMap<P, A>]) -> Option<f64> {
    let all: usize = rows.iter().map(|row| pairs(row.len())).sum();
    let same: usize = (rows.iter())
        .flat_map(|row| counts(row).into_values())
        .map(pairs)
        .sum();
    (all > 0).then(|| same as f64 / all as f64)
}

/// J. Cohen, "A coefficient of agreement for nominal scales", 1960.
fn kappa<P: Copy + Ord, A: Copy + Ord>(rows: &[&BTreeMap<P, A>], one: P, other: P) -> Option<f64> {
    let all = rows.len() as f64;
    let observed = rows.iter().filter(|row| row[&one] == row[&other]).count() as f64 / all;
    let share = |person: P, answer: A| {
        rows.iter().filter(|row| row[&person] == answer).count() as f64 / all
    };
    let answers: BTreeSet<A> = rows.iter().flat_map(|row| row.values().copied()).collect();
    let chance: f64 = (answers.into_iter())
        .map(|answer| share(one, answer) * share(other, answer))
        .sum();
    corrected(1.0 - observed, 1.0 - chance)
}

/// K. Krippendorff, "Content Analysis", chapter on reliability: the coincidences of
/// answers, where a question with `m` answers counts `1 / (m − 1)` a pair.
fn alpha<P, A: Copy + Ord>(rows: &[&BTreeMap<P, A>]) -> Option<f64> {
    let mut totals: BTreeMap<A, usize> = BTreeMap::new();
    let mut differing = 0.0;
    for row in rows {
        let counts = counts(row);
        let alike: usize = counts.values().map(|&count| pairs(count)).sum();
        differing += (pairs(row.len()) - alike) as f64 / (row.len() - 1) as f64;
        for (answer, count) in counts {
            *totals.entry(answer).or_default() += count;
        }
    }
    let all: usize = totals.values().sum();
    let alike: usize = totals.values().map(|&count| pairs(count)).sum();
    if all < 2 {
        return None;
    }
    let expected = (pairs(all) - alike) as f64 / (all - 1) as f64;
    corrected(differing, expected)
}

/// One less the disagreement over what chance would bring; none where chance
/// brings none.
fn corrected(observed: f64, by_chance: f64) -> Option<f64> {
    (by_chance > 1e-12).then(|| 1.0 - observed / by_chance)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(people: &[&[Option<u8>]]) -> Vec<BTreeMap<usize, u8>> {
        let answers = |question: usize| {
            let said = people.iter().map(move |answers| answers[question]);
            let said = said.enumerate();
            said.filter_map(|(person, answer)| Some((person, answer?)))
                .collect()
        };
        (0..people[0].len()).map(answers).collect()
    }

    fn close(found: Option<f64>, expected: f64) {
        let found = found.unwrap();
        assert!((found - expected).abs() < 5e-4, "{found}, not {expected}");
    }

    /// The worked example of K. Krippendorff, "Computing Krippendorff's
    /// Alpha-Reliability", 2011: four observers, twelve units, some not observed.
    #[test]
    fn alpha_is_as_published() {
        let read = |text: &str| -> Vec<Option<u8>> {
            let digit = |c: char| c.to_digit(10).map(|digit| digit as u8);
            text.chars().map(digit).collect()
        };
        let observers = [
            "123321412...",
            "1233224125.3",
            ".3332342251.",
            "12332441251.",
        ]
        .map(read);
        let observers: Vec<&[Option<u8>]> = observers.iter().map(Vec::as_slice).collect();
        let agreement = Agreement::of(&rows(&observers));
        close(agreement.alpha, 0.743);
        assert_eq!(agreement.kappa, None, "there are more than two");
        assert_eq!(agreement.questions, 11, "one was answered once");
    }

    /// The table of fifty grants that two readers judged, 20, 5, 10 and 15: κ = 0.4.
    #[test]
    fn kappa_is_as_published() {
        let mut people = [Vec::new(), Vec::new()];
        for (count, one, other) in [(20, 1, 1), (5, 1, 0), (10, 0, 1), (15, 0, 0)] {
            for _ in 0..count {
                people[0].push(Some(one));
                people[1].push(Some(other));
            }
        }
        let agreement = Agreement::of(&rows(&[&people[0], &people[1]]));
        close(agreement.kappa, 0.4);
        close(agreement.same, 0.7);
        assert_eq!(agreement.questions, 50);
    }

    #[test]
    fn little_is_claimed_of_little() {
        let none = Agreement::of::<u8, u8>(&[]);
        assert_eq!(none, Agreement::default());
        let alone = BTreeMap::from([(1, 1)]);
        assert_eq!(Agreement::of(&[alone]).questions, 0);
        // All said the same: chance would have brought that too.
        let alike = BTreeMap::from([(1, 1), (2, 1)]);
        let agreement = Agreement::of(&[alike]);
        assert_eq!(agreement.same, Some(1.0));
        assert_eq!(agreement.kappa, None);
        assert_eq!(agreement.alpha, None);
    }
}
