//! Scripted teaching runs and the tables made of them.

mod clock;
pub mod passive;
pub mod passive_page;
mod published;
pub mod thesis;
pub mod thesis_page;
mod trial;

pub use clock::process_cpu;
pub use trial::{Asked, Dropped, Report, TrialError, percentile, teach};
