//! Licences, sources and known weaknesses of all packages.

use crate::{cargo, must};
use std::path::Path;
use std::process::{Command, Stdio};

/// Holds the packages against `deny.toml`, with the list of weaknesses if it can be fetched.
pub fn run(root: &Path) -> Result<(), String> {
    if !installed() {
        // Into cargo's own folder of programs, once.
        must(Command::new("cargo").args(["install", "--locked", "cargo-deny"]))?;
    }
    cargo(root, "deny --log-level warn check licenses sources bans")?;
    if cargo(root, "deny --log-level error fetch db").is_err() {
        println!(
            "verify: NOT CHECKED: advisories. The list of known weaknesses cannot be fetched from github.com; run this \
             step again with a network."
        );
        return Ok(());
    }
    cargo(root, "deny --log-level warn check --disable-fetch advisories")
}

fn installed() -> bool {
    let mut command = Command::new("cargo");
    let tried = command.args(["deny", "--version"]).stdout(Stdio::null()).stderr(Stdio::null()).status();
    tried.is_ok_and(|status| status.success())
}
