//! Sessions in `PostgreSQL`: the store, and several servers that share it. Every test
//! has a cluster of its own in a temporary folder.
//!
//! `cargo nextest run --features postgres --test postgres`; needs Debian's
//! `postgresql`, or its programs on the PATH.
#![cfg(all(feature = "postgres", unix))]

mod cluster;
mod encrypted;
#[path = "../durability/people.rs"]
mod people;
#[path = "../durability/server.rs"]
#[allow(dead_code)] // Shared with the tests of one server.
mod server;
mod servers;
mod store;
