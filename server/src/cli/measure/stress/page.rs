//! The report as one page without scripts or other files: a table, a plot, and the comparison of treatments.

use std::fmt::Write;

use triad_lab::stress::{CaseReport, StressVerdict};

use super::Report;

/// Style sheet of the report, which is one file.
const STYLE: &str = "body{font:15px/1.5 system-ui,sans-serif;margin:2rem auto;max-width:75rem;padding:0 1rem;\
color:#1b1f24;background:#fff}h1{font-size:1.5rem}h2{font-size:1.15rem;margin-top:2rem}\
table{border-collapse:collapse;width:100%;font-size:.9rem}th,td{text-align:left;padding:.3rem .6rem;\
border-bottom:1px solid #d8dee4;vertical-align:top}td.n{text-align:right;font-variant-numeric:tabular-nums;\
white-space:nowrap}.survived{color:#116329}.degraded{color:#7d4e00}.refused{color:#0550ae}.warned{color:#953800}\
.wrong{color:#a40e26;font-weight:600}svg text{font:12px system-ui,sans-serif;fill:currentColor}.scroll{overflow-x:auto}\
@media(prefers-color-scheme:dark){body{background:#0d1117;color:#e6edf3}th,td{border-color:#30363d}\
.survived{color:#56d364}.degraded{color:#e3b341}.refused{color:#79c0ff}.warned{color:#f0883e}.wrong{color:#ff7b72}}";

/// The page.
pub(super) fn render(report: &Report) -> String {
    let mut page = String::new();
    let counts: Vec<String> = report.counts.iter().map(|(word, n)| format!("{n} {word}")).collect();
    let form = if report.quick { "quick" } else { "full" };
    let seeds = report.seeds.map_or_else(String::new, |(first, last)| {
        format!(", random mechanisms of the seeds {first} to {last}")
    });
    // Writing to a string cannot fail.
    let _ = write!(
        page,
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" \
         content=\"width=device-width\"><title>Stress report</title><style>{STYLE}</style><h1>Stress report</h1>\
         <p>Engine {}, {form} form{seeds}. {} cases: {}.</p><p>A case is <b class=survived>survived</b> only if it \
         agrees with its reference or keeps its invariant, <b class=degraded>degraded</b> if it does so less \
         precisely than its tolerance promises, <b class=refused>refused</b> if the engine says why it cannot be \
         run (on), <b class=warned>warned</b> if the result is wrong but the run says that it is to be doubted, and \
         <b class=wrong>wrong</b> otherwise.</p>",
        report.engine,
        report.entries.len(),
        counts.join(", "),
    );
    page.push_str("<h2>Deviation from the reference</h2>");
    page.push_str(&plot(&report.entries));
    page.push_str(
        "<h2>Cases</h2><div class=scroll><table><tr><th>StressCase<th>StressVerdict<th>Error<th>Energy drift\
                   <th>Violation<th>Steps<th>Rejected<th>Evaluations<th>Compared with, and why</tr>",
    );
    for entry in report.entries.iter().filter(|e| shown(e)) {
        row(&mut page, entry);
    }
    page.push_str("</table></div>");
    comparison(&mut page, report);
    page
}

/// Random mechanisms that went well are only counted.
fn shown(entry: &CaseReport) -> bool {
    entry.family != "random" || entry.outcome.verdict != StressVerdict::Survived
}

fn row(page: &mut String, entry: &CaseReport) {
    let outcome = &entry.outcome;
    let number = |x: Option<f64>| x.map_or_else(|| "–".to_owned(), |x| format!("{x:.1e}"));
    let verdict = outcome.verdict;
    let _ = write!(
        page,
        "<tr><td><b>{}</b><br>{}<td class={verdict}>{verdict}<td class=n>{}<td class=n>{}<td class=n>{}<td class=n>{}\
         <td class=n>{}<td class=n>{}<td>{}: {}</tr>",
        escaped(&entry.case),
        escaped(&entry.summary),
        number(outcome.error),
        number(outcome.energy_drift),
        number(outcome.violation),
        outcome.steps,
        outcome.rejected,
        outcome.evaluations,
        escaped(&outcome.reference),
        escaped(&outcome.reason),
    );
}

/// Error of each case on a scale of powers of ten from 1e-16 to 1.
fn plot(entries: &[CaseReport]) -> String {
    let place = |x: f64| 220.0 + 40.0 * (libm::log10(x.max(1e-16)) + 16.0).min(16.0);
    let list: Vec<&CaseReport> = entries
        .iter()
        .filter(|e| shown(e))
        .filter(|e| e.outcome.error.or(e.outcome.energy_drift).is_some())
        .collect();
    let height = 20 * list.len() + 30;
    let mut svg = format!(
        "<div class=scroll><svg width=900 height={height} role=img aria-label=\"error of each case\">"
    );
    for power in (-16..=0).step_by(4) {
        let x = place(libm::pow(10.0, f64::from(power)));
        let _ = write!(
            svg,
            "<line x1={x} x2={x} y1=20 y2={height} stroke=\"#8888\"/><text x={x} y=14 text-anchor=middle>1e{power}</text>"
        );
    }
    for (i, entry) in list.iter().enumerate() {
        let y = 36 + 20 * i;
        let error = entry.outcome.error.or(entry.outcome.energy_drift).unwrap_or(0.0);
        let verdict = entry.outcome.verdict;
        let _ = write!(
            svg,
            "<text x=210 y={y} text-anchor=end>{}</text><circle class={verdict} fill=currentColor cx={:.1} cy={} r=5>\
             <title>{error:.2e}, {verdict}</title></circle>",
            escaped(&entry.case),
            place(error),
            y - 4,
        );
    }
    svg.push_str("</svg></div>");
    svg
}

fn comparison(page: &mut String, report: &Report) {
    let Some(first) = report.comparison.first() else { return };
    page.push_str("<h2>Which treatment survives what</h2><div class=scroll><table><tr><th>Case");
    for column in &report.comparison {
        let _ = write!(page, "<th>{}", escaped(&column.method));
    }
    for (index, entry) in first.entries.iter().enumerate() {
        let _ = write!(page, "<tr><td>{}", escaped(&entry.case));
        for column in &report.comparison {
            let Some(entry) = column.entries.get(index) else { continue };
            let verdict = entry.outcome.verdict;
            let error = entry.outcome.error.map_or_else(String::new, |e| format!("<br>{e:.0e}"));
            let reason = escaped(&entry.outcome.reason);
            let _ = write!(page, "<td class={verdict} title=\"{reason}\">{verdict}{error}");
        }
    }
    page.push_str("</table></div>");
}

pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
