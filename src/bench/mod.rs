//! Scripted teaching runs and the tables made of them.

mod clock;
mod published;
pub mod thesis;
pub mod thesis_page;
mod trial;

pub use clock::process_cpu;
pub use trial::{Asked, Report, TrialError, percentile, teach};
