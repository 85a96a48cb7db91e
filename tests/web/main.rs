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
mod health;
mod invariants;
mod openapi;
mod pages;
mod parts;
mod people;
mod random;
mod routes;
#[cfg(unix)]
mod serve;
mod site;
#[cfg(unix)]
mod stop;
mod store;
mod stuck;
mod studio;
mod together;
mod unreliable;
mod upload_faults;
mod upload_limits;
mod uploads;
mod worlds;
