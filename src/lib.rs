//! memrep learns a formal task specification from a person's answers: which of
//! two behaviours is better, and whether one is acceptable.
//!
//! The rooms of the house, from the ground up (`docs/architecture.md` is the
//! map with its invariants):
//!
//! - [`evidence`]: what a teacher's answers say, whatever is being learned.
//! - [`belief`]: how a teacher is believed to answer, and what answers are worth
//!   as evidence.
//! - [`identify`]: the smallest automata consistent with evidence.
//! - [`world`]: where behaviours come from, and how they look.
//! - [`concept`]: what can be learned: classes of concepts, smallest first.
//! - [`oracle`]: who can answer without a person.
//! - [`learner`]: which question to ask next.
//! - [`draw`]: pictures of automata.
//! - [`task`]: what is taught, and the files that say so.
//! - [`session`]: one teaching session, a fold over its log.
//! - `store` and `server` (feature `server`): where logs last; pages and API.
//! - [`mod@bench`]: scripted runs and the tables made of them.
//! - [`cli`]: the commands of the `memrep` binary.

// They panic where nobody reads: `cli::output` prints.
#![cfg_attr(not(test), warn(clippy::print_stdout, clippy::print_stderr))]

pub mod belief;
pub mod bench;
pub mod cli;
pub mod concept;
pub mod draw;
pub mod evidence;
pub mod identify;
pub mod learner;
pub mod oracle;
#[cfg(feature = "server")]
pub mod server;
pub mod session;
#[cfg(feature = "server")]
pub mod store;
pub mod task;
pub mod world;
