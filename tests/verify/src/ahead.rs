//! Builds of later steps, made while tests wait for browsers and clocks: with the lowest priority, so that no test waits for them.

use std::process::{Command, Stdio};

/// Begins the builds, one after another. Nobody has to wait for them: the step that needs one asks for the same, finds it made, or is
/// held up by Cargo until it is; and is told what went wrong.
pub fn begin(builds: Vec<Command>) {
    std::thread::spawn(move || {
        for build in builds {
            // Without `nice` none is made ahead.
            drop(patient(&build).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).status());
        }
    });
}

/// The same command with the lowest priority.
fn patient(command: &Command) -> Command {
    let mut patient = Command::new("nice");
    patient.args(["-n", "19"]).arg(command.get_program()).args(command.get_args());
    if let Some(folder) = command.get_current_dir() {
        patient.current_dir(folder);
    }
    for (name, value) in command.get_envs() {
        match value {
            Some(value) => patient.env(name, value),
            None => patient.env_remove(name),
        };
    }
    patient
}
