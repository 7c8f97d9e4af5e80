//! The `triad` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    triad::cli::main()
}
