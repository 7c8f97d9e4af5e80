//! `triad stress`: tries to break the engine, and says what became of each attempt.

mod page;
mod picture;

use std::collections::BTreeMap;
use std::path::PathBuf;

use axum::http::StatusCode;
use clap::Args;
use serde::Serialize;
use triad_engine::VERSION;
use triad_engine::scene::Scene;
use triad_lab::stress::{self, CaseReport, StressCase, StressVerdict, TrialMethod};

use crate::cli::output::{Form, apart, make_room, write};
use crate::cli::terminal::{Outcome, print_json, print_line, progress, tell};
use crate::problem::Problem;

/// Random mechanisms of the quick and of the full form.
const SEEDS: (u64, u64) = (100, 2000);

/// What `triad stress` is asked.
#[derive(Debug, Args)]
pub(in crate::cli) struct Stress {
    /// Smaller and shorter cases, and 100 random mechanisms: about a minute.
    #[arg(long)]
    quick: bool,
    /// Only the cases whose name or family contains this; `random` means the random mechanisms.
    #[arg(long, value_name = "NAME")]
    case: Option<String>,
    /// Random mechanisms, each from its own seed: 2000, or 100 with --quick.
    #[arg(long, value_name = "N")]
    seeds: Option<u64>,
    /// First seed.
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    from: u64,
    /// Run each case with every integrator and every stabilization, to see which survives what.
    #[arg(long)]
    compare: bool,
    /// Only compare treatments: every integrator, and Baumgarte's stabilization from weak to strong, penalties,
    /// augmented Lagrangian and partitioning, on the cases that tell them apart; about a minute.
    #[arg(long)]
    treatments: bool,
    /// With --treatments: draw the comparison.
    #[arg(long, value_name = "FILE.svg", requires = "treatments")]
    svg: Option<PathBuf>,
    /// With --treatments: write the comparison as a table with reasons.
    #[arg(long, value_name = "FILE.md", requires = "treatments")]
    markdown: Option<PathBuf>,
    /// Write the report as a page.
    #[arg(long, value_name = "FILE.html")]
    html: Option<PathBuf>,
}

/// Everything that the suite found, and what is needed to repeat it.
#[derive(Debug, Serialize)]
struct Report {
    engine: &'static str,
    quick: bool,
    /// First and last seed of the random mechanisms.
    seeds: Option<(u64, u64)>,
    counts: BTreeMap<String, usize>,
    /// Cases that did not go as they have to.
    unexpected: Vec<String>,
    entries: Vec<CaseReport>,
    /// Which method survives what.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    comparison: Vec<Column>,
}

/// All cases under one method.
#[derive(Debug, Serialize)]
struct Column {
    #[serde(rename = "treatment")]
    method: String,
    entries: Vec<CaseReport>,
}

/// Runs the suite.
pub(in crate::cli) fn stress(options: &Stress, json: bool) -> Result<Outcome, Problem> {
    let (html, svg, markdown) = (&options.html, &options.svg, &options.markdown);
    let files = [("--html", html), ("--svg", svg), ("--markdown", markdown)];
    apart(&files.map(|(option, file)| (option, file.as_deref(), Form::Text)), json)?;
    for (_, file) in files {
        file.as_deref().map_or(Ok(()), make_room)?;
    }
    if options.treatments {
        return treatments(options, json);
    }
    let cases = chosen(options)?;
    let seeds = seeds(options);
    let bar = progress("stress", (cases.len() as u64 + seeds.1 - seeds.0) as f64, json);
    let mut entries = Vec::new();
    let method = TrialMethod::default();
    for case in &cases {
        let entry = stress::run(case, &method, options.quick);
        add(&mut entries, entry, json);
        bar.reached(entries.len() as f64);
    }
    for seed in seeds.0..seeds.1 {
        let entry = stress::random::run(seed, &method);
        add(&mut entries, entry, json);
        bar.reached(entries.len() as f64);
    }
    drop(bar);
    let report = Report {
        engine: VERSION,
        quick: options.quick,
        seeds: (seeds.1 > seeds.0).then_some((seeds.0, seeds.1 - 1)),
        counts: counts(&entries),
        unexpected: entries.iter().filter(|e| !e.as_expected()).map(|e| e.case.clone()).collect(),
        entries,
        comparison: if options.compare { compare(&cases, json) } else { Vec::new() },
    };
    if let Some(file) = &options.html {
        write(file, page::render(&report))?;
    }
    print_report(&report, options, json);
    Ok(if report.unexpected.is_empty() { Outcome::Done } else { Outcome::No })
}

/// Compares treatments alone.
fn treatments(options: &Stress, json: bool) -> Result<Outcome, Problem> {
    let cases: Vec<StressCase> = stress::compared()
        .into_iter()
        .filter(|case| options.case.as_deref().is_none_or(|wanted| case.name.contains(wanted)))
        .collect();
    let columns = compare(&cases, json);
    if let Some(file) = &options.svg {
        write(file, picture::svg(&columns))?;
    }
    if let Some(file) = &options.markdown {
        let name = options.svg.as_deref().and_then(|svg| svg.file_name()).unwrap_or_default();
        write(file, picture::markdown(&columns, &name.to_string_lossy()))?;
    }
    if json {
        print_json(&columns);
        return Ok(Outcome::Done);
    }
    for column in &columns {
        for entry in &column.entries {
            let outcome = &entry.outcome;
            let error =
                outcome.error.or(outcome.energy_drift).map_or_else(String::new, |e| format!("{e:.1e}"));
            let verdict = outcome.verdict;
            print_line(&format!(
                "{verdict:9} {:30} {:22} {error:>8} {:>7} steps  {}",
                column.method, entry.case, outcome.steps, outcome.reason
            ));
        }
    }
    Ok(Outcome::Done)
}

fn chosen(options: &Stress) -> Result<Vec<StressCase>, Problem> {
    let all = stress::cases().into_iter().filter(|case| case.quick || !options.quick);
    let Some(wanted) = options.case.as_deref() else { return Ok(all.collect()) };
    let cases: Vec<StressCase> =
        all.filter(|case| case.name.contains(wanted) || case.family.contains(wanted)).collect();
    if cases.is_empty() && wanted != "random" {
        let names: Vec<&str> = stress::cases().iter().map(|case| case.name).collect();
        return Err(Problem::new(
            StatusCode::NOT_FOUND,
            "unknown-case",
            format!("there is no case \"{wanted}\""),
            format!("cases: {}, random", names.join(", ")),
        ));
    }
    Ok(cases)
}

/// Seeds, the last one excluded.
fn seeds(options: &Stress) -> (u64, u64) {
    let by_default = match (options.case.as_deref(), options.quick) {
        (None | Some("random"), true) => SEEDS.0,
        (None | Some("random"), false) => SEEDS.1,
        _ => 0,
    };
    (options.from, options.from + options.seeds.unwrap_or(by_default))
}

/// Keeps an entry; one that went wrong is printed at once, a random one as a small scene that can be kept.
fn add(entries: &mut Vec<CaseReport>, entry: CaseReport, json: bool) {
    if !json && !entry.as_expected() {
        tell(&format!("{}: {}: {}", entry.case, entry.outcome.verdict, entry.outcome.reason));
    }
    entries.push(entry);
}

/// The smallest scene that still goes as wrong as that of a seed.
pub(in crate::cli) fn smallest(seed: u64) -> Scene {
    let method = TrialMethod::default();
    let wrong = |scene: &Scene| stress::random::judge(scene, &method).verdict == StressVerdict::Wrong;
    stress::shrink::shrink(&stress::random::scene(seed), &wrong)
}

fn compare(cases: &[StressCase], json: bool) -> Vec<Column> {
    let treatments = stress::comparison();
    let bar = progress("compare", (cases.len() * treatments.len()) as f64, json);
    let mut done = 0.0;
    let mut columns = Vec::new();
    for (method, how) in treatments {
        let mut entries = Vec::new();
        for case in cases {
            entries.push(stress::run(case, &how, true));
            done += 1.0;
            bar.reached(done);
        }
        columns.push(Column { method, entries });
    }
    columns
}

fn counts(entries: &[CaseReport]) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    for entry in entries {
        *counts.entry(entry.outcome.verdict.to_string()).or_insert(0) += 1;
    }
    counts
}

fn print_report(report: &Report, options: &Stress, json: bool) {
    if json {
        print_json(report);
        return;
    }
    for entry in report.entries.iter().filter(|e| e.family != "random" || !e.as_expected()) {
        let error = entry.outcome.error.map_or_else(String::new, |e| format!("{e:.1e}"));
        let verdict = entry.outcome.verdict;
        print_line(&format!("{verdict:9} {:26} {error:>8}  {}", entry.case, entry.outcome.reason));
    }
    let counts: Vec<String> = report.counts.iter().map(|(word, count)| format!("{count} {word}")).collect();
    print_line(&format!("{} cases: {}", report.entries.len(), counts.join(", ")));
    for name in &report.unexpected {
        print_line(&format!("not as it has to be: {name}"));
    }
    // The first random failure is worth a scene of its own.
    let failed = report.unexpected.iter().find_map(|name| name.strip_prefix("seed-")?.parse().ok());
    if let Some(seed) = failed {
        print_line(&format!("the smallest scene that fails like seed {seed}:"));
        print_line(&smallest(seed).to_json());
    }
    if let Some(file) = &options.html {
        print_line(&format!("report: {}", file.display()));
    }
}
