//! The options of `triad run`.

use std::path::{Path, PathBuf};

use clap::Args;
use triad_engine::scene::{ConstraintMethod, IntegratorKind, Output};

use super::source::Source;
use crate::cli::choice;
use crate::cli::output::Form;

#[derive(Debug, Args)]
pub(in crate::cli) struct Run {
    #[command(flatten)]
    pub(super) source: Source,
    /// End of the run in seconds, instead of the scene's.
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub(super) until: Option<f64>,
    /// Time between outputs in seconds, instead of the scene's.
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub(super) every: Option<f64>,
    /// Tolerance of the integrator, instead of the scene's.
    #[arg(long, value_name = "TOL", allow_negative_numbers = true)]
    pub(super) tolerance: Option<f64>,
    /// Leave nothing out of this kind, though nothing depends on it; `all` for every kind.
    #[arg(long, value_name = "WORD,…", value_delimiter = ',', value_parser = choice::skip_words())]
    pub(super) no_skip: Vec<String>,
    /// Tell what was left out because nothing depends on it, and what that saved.
    #[arg(long)]
    pub(super) explain: bool,
    /// Integrator, instead of the scene's: auto, taylor, dop853, dopri5, ode45, radau, rattle; trapezoidal comes with
    /// the treatment augmented-lagrangian.
    #[arg(long, value_name = "NAME", value_parser = choice::integrator)]
    pub(super) integrator: Option<IntegratorKind>,
    /// What keeps the constraints, instead of the scene's: projection, baumgarte, partitioning, penalty,
    /// augmented-lagrangian; each with its usual strength.
    #[arg(long, value_name = "NAME", value_parser = choice::treatment)]
    pub(super) treatment: Option<ConstraintMethod>,
    /// Steps of one size, in seconds, instead of steps by the tolerance.
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub(super) step: Option<f64>,
    /// Carry no estimate of the error along: docs/ACCURACY.md says what it costs.
    #[arg(long)]
    pub(super) no_estimate: bool,
    /// Estimate the error by a second solution, by another method or at a tighter tolerance.
    #[arg(long)]
    pub(super) verify: bool,
    /// Stop after so many integrator steps; what was reached is kept.
    #[arg(long, value_name = "N")]
    pub(super) most_steps: Option<u64>,
    /// Stop after so many seconds of computing; what was reached is kept.
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = choice::seconds)]
    pub(super) most_seconds: Option<f64>,
    /// Write a table: CSV (`-` for standard output), or Arrow (Feather) if the file ends in .arrow or .feather.
    #[arg(long, value_name = "FILE.csv")]
    pub(super) out: Option<PathBuf>,
    /// What the table holds, instead of the scene's choice: bodies, frames, accelerations, reactions, drivers, joints,
    /// loads, markers, energy, balance, violations, errors; of one element with its name behind a colon, like reactions:pin.
    #[arg(long, value_name = "WORD,…", value_delimiter = ',', value_parser = choice::output)]
    pub(super) outputs: Vec<Output>,
    /// Write a recording for the rerun viewer.
    #[arg(long, value_name = "FILE.rrd")]
    pub(super) rrd: Option<PathBuf>,
    /// Draw the mechanism as an SVG that moves by itself; `-` for standard output, here and wherever a text is written.
    #[arg(long, value_name = "FILE.svg")]
    pub(super) svg: Option<PathBuf>,
    /// Write a page that plays the run by itself, without a server and without a network: 60 kB for a
    /// short one to some 300 kB, more for hundreds of bodies.
    #[arg(long, value_name = "FILE.html")]
    pub(super) html: Option<PathBuf>,
    /// Show the run in a native rerun viewer that listens at this address.
    #[arg(long, value_name = "URL", num_args = 0..=1, default_missing_value = "rerun+http://127.0.0.1:9876/proxy")]
    pub(super) rerun: Option<String>,
}

impl Run {
    /// What is read and written.
    pub(super) fn files(&self) -> [(&'static str, Option<&Path>, Form); 5] {
        [
            ("the scene", self.source.file(), Form::Read),
            ("--out", self.out.as_deref(), Form::Text),
            ("--rrd", self.rrd.as_deref(), Form::Other),
            ("--svg", self.svg.as_deref(), Form::Text),
            ("--html", self.html.as_deref(), Form::Text),
        ]
    }

    /// Whether anything is written at the times of outputs.
    pub(super) fn writes(&self) -> bool {
        [&self.out, &self.rrd, &self.svg, &self.html].iter().any(|file| file.is_some())
            || self.rerun.is_some()
    }

    /// Options that change nothing, in sentences.
    pub(super) fn idle(&self) -> Vec<String> {
        let mut notes = Vec::new();
        let mut note = |idle: bool, text: &str| {
            if idle {
                notes.push(text.to_owned());
            }
        };
        note(
            !self.outputs.is_empty() && self.out.is_none(),
            "--outputs chooses what a table holds: without --out it changes nothing",
        );
        note(
            self.every.is_some() && !self.writes() && !self.verify,
            "--every is the time between outputs: where nothing is written it changes nothing",
        );
        notes
    }
}
