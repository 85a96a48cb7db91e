//! The server from its store to its pages, through public doors.
#![cfg(feature = "server")]

mod ahead;
mod api;
mod check;
mod classes;
mod clicks;
mod conflicts;
mod desk;
mod door;
mod pages;
mod parts;
mod people;
mod routes;
#[cfg(unix)]
mod serve;
mod site;
mod store;
mod stuck;
mod studio;
mod unreliable;
mod upload_faults;
mod upload_limits;
mod uploads;
mod worlds;
