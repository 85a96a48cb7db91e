//! SAT engines: the smallest automata as models of a formula.

mod batsat;
mod canonical;
mod encoding;
mod incremental;
mod solver;
mod varisat;

#[cfg(test)]
mod cores;
#[cfg(test)]
mod tests;

use super::engine::Engine;
use incremental::SatEngine;

/// An engine over the solver `varisat`.
pub(crate) fn varisat_engine() -> Box<dyn Engine + Send> {
    Box::new(SatEngine::new(varisat::Varisat::new))
}

/// An engine over the solver `batsat`.
pub(crate) fn batsat_engine() -> Box<dyn Engine + Send> {
    Box::new(SatEngine::new(batsat::Batsat::new))
}
