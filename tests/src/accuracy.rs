//! The table of accuracy and work, `tests/data/accuracy.toml`: what README shows and the benchmarks hold.

use crate::root;
use serde::{Deserialize, Serialize};
use std::fmt::Write;
use std::fs;
use std::sync::{Mutex, PoisonError};
use triad_engine::run::Summary;
use triad_engine::scene::{Coordinates, IntegratorKind};

/// A run may be this many times less exact than the table says: another C library rounds otherwise.
const WORSE: f64 = 3.0;
/// Errors below this are rounding.
const ROUNDING: f64 = 1e-14;
/// Part by which the work of an integrator other than the default one may differ from the table.
const OTHER_WORK: f64 = 0.01;
/// README's table stands after this line and ends with an empty one.
const MARK: &str = "<!-- from tests/data/accuracy.toml -->\n";

/// One benchmark, solved in one way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AccuracyEntry {
    /// The benchmark, with its duration.
    pub benchmark: String,
    /// Unit of the error; empty for a relative one.
    pub unit: String,
    /// Coordinates of the bodies.
    pub coordinates: Coordinates,
    /// As the scene names it: `auto` is the default.
    pub integrator: IntegratorKind,
    /// Largest error over the whole run.
    pub error: f64,
    /// Evaluations of the accelerations.
    pub evaluations: u64,
    /// Factorizations.
    pub factorizations: u64,
    /// Accepted steps.
    pub steps: u64,
}

/// The whole table.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AccuracyTable {
    /// Its entries, in README's order.
    pub run: Vec<AccuracyEntry>,
}

impl AccuracyTable {
    /// Reads the kept table.
    pub fn read() -> Self {
        toml::from_str(&fs::read_to_string(root().join("tests/data/accuracy.toml")).unwrap()).unwrap()
    }

    fn place(&self, new: &AccuracyEntry) -> Option<usize> {
        self.run.iter().position(|kept| {
            (&kept.benchmark, kept.coordinates, kept.integrator)
                == (&new.benchmark, new.coordinates, new.integrator)
        })
    }

    /// The table as README shows it: each kind of coordinates beside the others.
    pub fn markdown(&self) -> String {
        let mut text = String::from(
            "| benchmark | default integrator: error | evaluations | DOP853: error | evaluations |\n|---|---|---|---|---|\n",
        );
        let mut shown: Vec<&str> = Vec::new();
        for entry in &self.run {
            if shown.contains(&&*entry.benchmark) {
                continue;
            }
            shown.push(&entry.benchmark);
            let unit = if entry.unit.is_empty() { "relative" } else { &entry.unit };
            write!(text, "| {} |", entry.benchmark).unwrap();
            for integrator in [IntegratorKind::Auto, IntegratorKind::Dop853] {
                let alike = |e: &&AccuracyEntry| e.benchmark == entry.benchmark && e.integrator == integrator;
                let cells = |cell: &dyn Fn(&AccuracyEntry) -> String| {
                    self.run.iter().filter(alike).map(cell).collect::<Vec<_>>().join(" / ")
                };
                let (errors, work) =
                    (cells(&|e| format!("{:.0e}", e.error)), cells(&|e| e.evaluations.to_string()));
                write!(text, " {errors} {unit} | {work} |").unwrap();
            }
            text.push('\n');
        }
        text
    }
}

/// Holds a run against its entry, or renews that and README's table where `TRIAD_WRITE_GOLDEN` is set.
pub fn hold(
    benchmark: &str,
    unit: &str,
    scene: (Coordinates, IntegratorKind),
    error: f64,
    summary: &Summary,
) {
    let new = AccuracyEntry {
        benchmark: benchmark.to_owned(),
        unit: unit.to_owned(),
        coordinates: scene.0,
        integrator: scene.1,
        // Two digits: more would change with each C library.
        error: format!("{error:.1e}").parse().unwrap(),
        evaluations: summary.evaluations,
        factorizations: summary.factorizations,
        steps: summary.steps,
    };
    if std::env::var_os("TRIAD_WRITE_GOLDEN").is_some() {
        renew(new);
        return;
    }
    let table = AccuracyTable::read();
    let place =
        table.place(&new).unwrap_or_else(|| panic!("tests/data/accuracy.toml has no entry for {new:?}"));
    let kept = &table.run[place];
    assert!(
        error <= WORSE * kept.error.max(ROUNDING),
        "{benchmark}: error {error:e}, the table says {:e}: {kept:?}",
        kept.error
    );
    let work = |e: &AccuracyEntry| [e.evaluations, e.factorizations, e.steps];
    for (found, known) in work(&new).into_iter().zip(work(kept)) {
        let allowed = if scene.1 == IntegratorKind::Auto { 0.0 } else { OTHER_WORK * known as f64 };
        assert!(
            found.abs_diff(known) as f64 <= allowed,
            "{benchmark}: the work was {kept:?}, and is {new:?}"
        );
    }
}

/// Puts an entry into the table, and the table into README.
fn renew(new: AccuracyEntry) {
    static TURN: Mutex<()> = Mutex::new(());
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    let mut table = AccuracyTable::read();
    match table.place(&new) {
        Some(place) => table.run[place] = new,
        None => table.run.push(new),
    }
    table.run.sort_by(|a, b| a.benchmark.cmp(&b.benchmark));
    let head = "# Accuracy and work of the benchmarks, renewed by\n\
                # TRIAD_WRITE_GOLDEN=1 cargo test --release -p triad-tests --test benchmarks\n\n";
    let body = toml::to_string(&table).unwrap();
    let lines = body.lines().map(|line| match line.strip_prefix("error = ") {
        Some(error) => format!("error = {:e}\n", error.parse::<f64>().unwrap()),
        None => format!("{line}\n"),
    });
    let text = format!("{head}{}", lines.collect::<String>());
    fs::write(root().join("tests/data/accuracy.toml"), text).unwrap();
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    let (before, rest) = readme.split_once(MARK).unwrap();
    let (_, after) = rest.split_once("\n\n").unwrap();
    fs::write(root().join("README.md"), format!("{before}{MARK}{}\n{after}", table.markdown())).unwrap();
}

/// The table that README shows.
pub fn in_readme() -> String {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    let (_, rest) = readme.split_once(MARK).unwrap();
    format!("{}\n", rest.split_once("\n\n").unwrap().0)
}
