//! Scripted teaching runs, and the tables and figures made of them: chapter 5's
//! experiments, and drawn targets.
//!
//! An [`Experiment`] with its [`Plan`] says what is run, [`run`] does it, and
//! [`Results`] are told by a page, a table for programs and a figure.

mod beside;
mod case;
mod chart;
mod clock;
mod contender;
mod experiment;
mod figure;
mod markdown;
mod noise_page;
mod page;
pub mod passive;
pub mod passive_page;
mod published;
mod results;
mod rivals;
mod run;
#[cfg(feature = "server")]
pub mod serve;
mod subject;
mod summary;
mod table;
mod times;
mod trial;

pub use case::Case;
pub use chart::ChartError;
pub use clock::{process_cpu, thread_cpu};
pub use contender::{BASE, CONTENDERS, Contender, KV, RIVALS, Rival};
pub use experiment::{COSTS, Experiment, Plan};
pub use figure::figure;
pub use page::markdown;
pub use results::{Cell, Group, Measure, Results};
pub use rivals::{RivalsError, find as find_rivals, run as run_rivals};
pub use run::{Run, RunError, run, size};
pub use subject::Subject;
pub use summary::{Pairs, Ratio, Spread, Uncertainty, ratio, spread};
pub use table::csv;
pub use trial::{Asked, Dropped, Report, TrialError, percentile, teach};
