//! The `memrep` command: parses its arguments and hands over to [`memrep::cli`].

use std::process::ExitCode;

/// A server runs for months, and what sessions leave behind is in pieces: with the
/// usual allocator of Linux its memory goes on growing.
#[cfg(feature = "server")]
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    memrep::cli::main()
}
