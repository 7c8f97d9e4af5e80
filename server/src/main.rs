//! The `triad` command.

use std::process::ExitCode;

/// Gives back to the system what ended sessions held, which that of glibc keeps; of numbers it changes nothing.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    triad::cli::main()
}
