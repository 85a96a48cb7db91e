//! The server from its store to its pages, through public doors.
#![cfg(feature = "server")]

mod api;
mod classes;
mod conflicts;
mod pages;
#[cfg(unix)]
mod serve;
mod site;
mod store;
mod uploads;
mod worlds;
