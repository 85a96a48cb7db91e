//! memrep learns a formal task specification from a person's answers: which of
//! two behaviours is better, and whether one is acceptable.
//!
//! The rooms of the house, from the ground up (`docs/architecture.md` is the
//! map with its invariants):

/// What a teacher's answers say, whatever is being learned.
pub mod evidence;

/// The smallest automata consistent with evidence: search and SAT.
pub mod identify;

/// What can be learned: classes of concepts, smallest first.
pub mod concept;

/// Who can answer without a person: scripted teachers and their targets.
pub mod oracle;

/// Which question to ask next.
pub mod learner;

/// Scripted teaching runs and the tables made of them.
pub mod bench;

/// Pictures of automata.
pub mod draw;

/// One teaching session: a fold over its log.
pub mod session;

/// Where the logs of sessions last.
#[cfg(feature = "server")]
pub mod store;

/// Pages and API over sessions.
#[cfg(feature = "server")]
pub mod server;

/// The commands of the `memrep` binary.
pub mod cli;
