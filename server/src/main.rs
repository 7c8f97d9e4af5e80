//! The `triad` command.
fn main() {}
