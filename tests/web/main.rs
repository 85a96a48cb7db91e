//! The server from its store to its pages, through public doors.
#![cfg(feature = "server")]

mod ahead;
mod api;
mod bounds;
mod check;
mod classes;
mod clicks;
mod conflicts;
mod desk;
mod door;
mod escape;
#[cfg(unix)]
mod floods;
mod health;
mod invariants;
mod openapi;
mod pages;
mod parts;
#[cfg(unix)]
mod password;
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
#[cfg(unix)]
mod told;
mod unreliable;
mod upload_faults;
mod upload_limits;
mod uploads;
mod visits;
mod worlds;
