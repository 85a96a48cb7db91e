//! The learner through its public door, on classes small enough for a
//! brute-force twin to check every question, and on automata.

mod bayes;
mod brute;
mod claims;
mod conflicts;
mod conformance;
mod exp4;
mod finite;
mod fold;
mod hurried;
mod implied;
mod monotone;
mod order;
mod outlook;
mod refusals;
mod robust;
mod stopped;
mod teacher;
mod tomita;
