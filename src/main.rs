//! The `memrep` command: parses its arguments and hands over to [`memrep::cli`].

use std::process::ExitCode;

fn main() -> ExitCode {
    memrep::cli::main()
}
