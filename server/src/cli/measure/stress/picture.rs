//! Which treatment survives what: as a picture and as a table for the documentation.

use std::fmt::Write;

use triad_lab::stress::StressVerdict;

use super::Column;

/// Room for the names of cases, px.
const LEFT: usize = 190;
/// Room for the slanted names of methods, px.
const TOP: usize = 170;
/// Width and height of a cell, px.
const CELL: (usize, usize) = (46, 30);

/// Fill of a cell, and its mark: the picture must also be readable without colours.
fn look(verdict: StressVerdict) -> (&'static str, &'static str) {
    match verdict {
        StressVerdict::Survived => ("#cfe8d5", "✓"),
        StressVerdict::Degraded => ("#fbe7b2", "~"),
        StressVerdict::Refused => ("#d6e4f7", "–"),
        StressVerdict::Warned => ("#f6d3b0", "!"),
        StressVerdict::Wrong => ("#f3c1bd", "✗"),
    }
}

/// Power of ten of an error, as it is shown in a cell.
fn size(error: Option<f64>) -> String {
    match error {
        Some(error) if error > 0.0 && error.is_finite() => {
            format!("1e{:.0}", libm::log10(error).ceil().max(-16.0))
        }
        _ => String::new(),
    }
}

/// One column a treatment, one row a case.
pub(super) fn svg(columns: &[Column]) -> String {
    let rows = columns.first().map_or(0, |column| column.entries.len());
    let width = LEFT + CELL.0 * columns.len() + 90;
    let height = TOP + CELL.1 * rows + 50;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"Which \
         treatment of the constraints survives what\" font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    for (k, column) in columns.iter().enumerate() {
        write_column(&mut out, k, column);
    }
    if let Some(column) = columns.first() {
        for (row, entry) in column.entries.iter().enumerate() {
            let y = TOP + CELL.1 * row + 19;
            let _ =
                writeln!(out, "<text x=\"{}\" y=\"{y}\" text-anchor=\"end\">{}</text>", LEFT - 8, entry.case);
        }
    }
    let verdicts = [
        StressVerdict::Survived,
        StressVerdict::Degraded,
        StressVerdict::Refused,
        StressVerdict::Warned,
        StressVerdict::Wrong,
    ];
    let words = verdicts.map(|verdict| {
        let (_, mark) = look(verdict);
        format!("{mark} {verdict}")
    });
    let _ = writeln!(
        out,
        "<text x=\"{LEFT}\" y=\"{}\">{} · below: largest error, relative</text>\n</svg>",
        height - 18,
        words.join("   ")
    );
    out
}

/// Column k: the name of the treatment, and a cell for each case.
fn write_column(out: &mut String, k: usize, column: &Column) {
    let x = LEFT + CELL.0 * k + CELL.0 / 2;
    let y = TOP - 8;
    let _ = writeln!(
        out,
        "<text x=\"{x}\" y=\"{y}\" transform=\"rotate(-50 {x} {y})\">{}</text>",
        super::page::escaped(&column.method)
    );
    for (row, entry) in column.entries.iter().enumerate() {
        let (fill, mark) = look(entry.outcome.verdict);
        let (left, top) = (LEFT + CELL.0 * k, TOP + CELL.1 * row);
        let error = size(entry.outcome.error.or(entry.outcome.energy_drift));
        let _ = writeln!(
            out,
            "<g><title>{}: {}</title><rect x=\"{left}\" y=\"{top}\" width=\"{}\" height=\"{}\" fill=\"{fill}\" \
             stroke=\"white\"/><text x=\"{x}\" y=\"{}\" text-anchor=\"middle\">{mark}</text><text x=\"{x}\" y=\"{}\" \
             text-anchor=\"middle\" font-size=\"9\">{error}</text></g>",
            super::page::escaped(&entry.case),
            super::page::escaped(&entry.outcome.reason),
            CELL.0,
            CELL.1,
            top + 14,
            top + 26,
        );
    }
}

/// The same as a table in Markdown, treatments in rows, with the largest error and the number of steps.
pub(super) fn markdown(columns: &[Column], picture: &str) -> String {
    let mut out = String::from(
        "# Which treatment survives what\n\nWritten by `triad stress --treatments`; do not edit. Every case has a \
         reference of its own or an invariant: ✓ it is met within what the tolerance of 1e-9 promises, ~ less \
         precisely, – the engine refused or stopped, and said why, ! the result is wrong, and the run says that it is \
         to be doubted, ✗ it is wrong, and nothing says so. Below the mark are the largest error (or energy drift), \
         relative, and the accepted steps. Runs are stopped at 60 000 steps, penalties at 12 000. Energies without an exact solution only tell that nothing was lost: see `triad stress`.\n\n",
    );
    if !picture.is_empty() {
        let _ = write!(out, "![Which treatment survives what]({picture})\n\n");
    }
    let Some(first) = columns.first() else { return out };
    let cases: Vec<&str> = first.entries.iter().map(|entry| entry.case.as_str()).collect();
    let _ = writeln!(out, "| treatment | {} |\n|---|{}", cases.join(" | "), "---|".repeat(cases.len()));
    for column in columns {
        let cells = column.entries.iter().map(|entry| {
            let outcome = &entry.outcome;
            let error = outcome.error.or(outcome.energy_drift);
            let error = error.map_or_else(String::new, |error| format!(" {error:.0e},"));
            format!("{}{error} {}", look(outcome.verdict).1, outcome.steps)
        });
        let _ = writeln!(out, "| {} | {} |", column.method, cells.collect::<Vec<_>>().join(" | "));
    }
    out.push_str("\n## Why\n\n");
    for column in columns {
        for entry in column.entries.iter().filter(|entry| entry.outcome.verdict >= StressVerdict::Refused) {
            let _ = writeln!(out, "- {}, {}: {}", column.method, entry.case, entry.outcome.reason);
        }
    }
    out.push_str("\n## The cases\n\n");
    for entry in &first.entries {
        let _ = writeln!(
            out,
            "- `{}`: {}. Compared with: {}.",
            entry.case, entry.summary, entry.outcome.reference
        );
    }
    out
}
