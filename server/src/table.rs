//! Tables of a run as text: a remark that states the conventions, a row of names, a row of units, and a row for each state.

use std::io::{self, Write};

use axum::http::StatusCode;
use triad_engine::run::{Column, Outputs, Simulation, append_row};
use triad_engine::scene::Settings;
use triad_lab::csv::quoted;

use crate::problem::Problem;

/// Refuses to write errors that are not estimated, be it that a command or, where it has not `asked`, the scene chooses them; `hint`
/// says what lets them be.
pub fn with_errors(settings: &Settings, asked: bool, hint: &str) -> Result<(), Problem> {
    let lost = asked && !settings.error_estimate && settings.tells_errors();
    if !lost && !settings.misses_errors() {
        return Ok(());
    }
    let detail = "the outputs hold errors, but the run carries no estimate of them along";
    Err(Problem::new(StatusCode::UNPROCESSABLE_ENTITY, "no-errors", detail, hint))
}

/// The time, then what was chosen.
pub fn all_columns(outputs: &Outputs) -> impl Iterator<Item = Column> {
    let time = Column { name: "time".to_owned(), unit: "s" };
    std::iter::once(time).chain(outputs.columns().iter().cloned())
}

/// What a table says before its columns.
pub fn head(scene: &str) -> String {
    let version = env!("CARGO_PKG_VERSION");
    format!("triad {version}, scene {scene}. All components in the world frame.")
}

/// A table that is being written.
pub struct TextTable<W> {
    out: W,
    line: Vec<u8>,
}

impl<W: Write> TextTable<W> {
    /// Writes all that stands before the numbers.
    pub fn new(mut out: W, run: &Simulation, outputs: &Outputs) -> io::Result<Self> {
        writeln!(out, "# {}", head(&run.model().name))?;
        for sentence in outputs.conventions() {
            writeln!(out, "# {sentence}")?;
        }
        let names: Vec<String> = all_columns(outputs).map(|column| quoted(&column.name)).collect();
        let units: Vec<&str> = all_columns(outputs).map(|column| column.unit).collect();
        writeln!(out, "{}", names.join(","))?;
        writeln!(out, "{}", units.join(","))?;
        Ok(Self { out, line: Vec::new() })
    }

    /// Writes a row: as few digits as give each number back exactly.
    pub fn row(&mut self, row: &[f64]) -> io::Result<()> {
        self.line.clear();
        append_row(&mut self.line, row);
        self.out.write_all(&self.line)
    }

    /// Writes rows that [`append_row`] has put together.
    pub fn rows(&mut self, text: &[u8]) -> io::Result<()> {
        self.out.write_all(text)
    }

    /// Writes what is still held back, and returns what was written to.
    pub fn finish(mut self) -> io::Result<W> {
        self.out.flush()?;
        Ok(self.out)
    }
}
