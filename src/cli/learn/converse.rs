//! Lets a scripted teacher teach a learner of any class, and tells of it what is
//! asked to be told.

use std::time::Duration;

use indicatif::ProgressBar;

use super::teller::Teller;
use super::{Args, check, trace};
use crate::bench::{Report, TrialError, process_cpu, teach};
use crate::cli::output::counted;
use crate::concept::ConceptClass;
use crate::learner::Learner;
use crate::oracle::Teacher;

/// The report of the run.
pub(super) fn converse<C, T, L>(
    args: &Args,
    learner: &mut Learner<C>,
    teacher: &mut T,
    teller: &L,
) -> anyhow::Result<Report<C::Concept>>
where
    C: ConceptClass,
    T: Teacher<Concept = C::Concept, Atom = C::Atom>,
    L: Teller<Concept = C::Concept, Atom = C::Atom>,
{
    // Drawn only on a terminal, and only where the trace does not tell anyway.
    let progress = if args.trace {
        ProgressBar::hidden()
    } else {
        ProgressBar::new_spinner()
    };
    progress.enable_steady_tick(Duration::from_millis(200));
    let mut printed = Ok(());
    // The check and the batch of the last claim told.
    let mut told = (0, 0);
    let report = teach(learner, teacher, args.max_questions, process_cpu, |asked| {
        let questions = |number| counted(number, "question", "questions");
        progress.set_message(match asked.check {
            None => format!("{} asked", questions(asked.number)),
            Some(check) => format!(
                "{} asked; {} of {} random {} judged",
                questions(asked.number),
                check.judged,
                check.needed,
                L::NOUNS.atoms
            ),
        });
        if args.trace && printed.is_ok() {
            printed = check::batch(args.format, asked, L::NOUNS.atoms, &mut told)
                .and_then(|()| trace::line(args.format, teller, asked));
        }
    });
    progress.finish_and_clear();
    printed?;
    let report = report.map_err(|error| match error {
        TrialError::Bound { .. } => {
            anyhow::Error::from(error).context("`--max-states` is too small")
        }
        _ => error.into(),
    })?;
    if args.trace {
        let mut conflicts = report.conflicts.iter();
        conflicts.try_for_each(|dropped| trace::conflict(args.format, &L::NOUNS, dropped))?;
    }
    Ok(report)
}
