//! What was acknowledged is kept: the real server is killed, its disk is full, its
//! log is torn, its database is copied while it writes.
#![cfg(all(feature = "server", unix))]

mod backups;
mod disk;
mod kills;
mod people;
mod server;
mod torn;
