//! `triad bench`: run time against error of scenes.

use std::path::{Path, PathBuf};

use axum::http::StatusCode;
use clap::Args;
use serde_json::{Value, json};
use triad_engine::scene::{ConstraintMethod, Coordinates, IntegratorKind};
use triad_lab::bench::{
    BenchCase, BenchPlan, LeftOut, Measured, Wish, by_scene, csv, html, measure, svg, table,
};

use super::raster::{RasterError, png};
use crate::cli::choice;
use crate::cli::clock::Clock;
use crate::cli::output::{make_folder, not_standard, write};
use crate::cli::terminal::{Outcome, print_json, print_line, progress};
use crate::problem::Problem;
use crate::{reports, scenes};

#[derive(Debug, Args)]
pub(in crate::cli) struct Bench {
    /// Files with scenes, or names of built-in ones, over their own durations; without them the benchmark's own.
    #[arg(value_name = "SCENE", conflicts_with = "scenes")]
    given: Vec<String>,
    /// Fewer scenes, tolerances and repeats: less than a minute.
    #[arg(long)]
    quick: bool,
    /// Only scenes whose names contain one of these.
    #[arg(long, value_name = "SCENES", value_delimiter = ',')]
    scenes: Vec<String>,
    /// Integrators, by the scene format's words.
    #[arg(long, value_name = "WORDS", value_delimiter = ',', value_parser = choice::integrator)]
    integrators: Vec<IntegratorKind>,
    /// A constraint treatment, as in a scene: a word, or `{"kind": "baumgarte", "alpha": 5, "beta": 5}`; may be
    /// given more than once.
    #[arg(long, value_name = "TREATMENT", value_parser = treatment)]
    treatment: Vec<ConstraintMethod>,
    /// Kinds of bodies: full, reduced, shared.
    #[arg(long, value_name = "WORDS", value_delimiter = ',')]
    coordinates: Vec<Coordinates>,
    /// Tolerances.
    #[arg(long, value_name = "NUMBERS", value_delimiter = ',', value_parser = tolerance)]
    tolerances: Vec<f64>,
    /// The folder for bench.csv, bench.html and the plots as SVG and PNG; made if it is not there. The workbench
    /// shows what is in its own folder at /bench.
    #[arg(long, default_value = crate::app::REPORTS, value_name = "DIR")]
    out: PathBuf,
}

/// Reads a tolerance as scenes may have it.
fn tolerance(text: &str) -> Result<f64, String> {
    let tolerance: f64 = text.trim().parse().map_err(|_| "not a number".to_owned())?;
    if (1e-14..=1e-1).contains(&tolerance) {
        Ok(tolerance)
    } else {
        Err("not between 1e-14 and 0.1".to_owned())
    }
}

/// Reads a treatment: a word that needs no numbers, or JSON.
fn treatment(text: &str) -> Result<ConstraintMethod, String> {
    let value = if text.trim_start().starts_with('{') {
        serde_json::from_str(text).map_err(|error| error.to_string())?
    } else {
        serde_json::json!({ "kind": text })
    };
    serde_json::from_value(value).map_err(|error| error.to_string())
}

/// Measures, prints the times to reach three errors, and writes tables and plots into a folder.
pub(in crate::cli) fn bench(options: Bench, json: bool) -> Result<Outcome, Problem> {
    let Bench { given, quick, scenes: parts, integrators, treatment, coordinates, tolerances, out: folder } =
        options;
    // What a scene of somebody else's takes is not known before: it is measured by the methods of the quick plan.
    let mut plan = if quick || !given.is_empty() { BenchPlan::quick() } else { BenchPlan::full() };
    if !given.is_empty() {
        let read = |name: &String| Ok(BenchCase::given(case_name(name), scenes::named_or_in_file(name)?));
        plan.cases = given.iter().map(read).collect::<Result<_, Problem>>()?;
    }
    let plan = plan.with(Wish {
        scenes: parts,
        integrators,
        constraint_methods: treatment,
        coordinates,
        tolerances,
    });
    if plan.cases.is_empty() {
        return Err(Problem::new(
            StatusCode::BAD_REQUEST,
            "no-such-scene",
            "no scene of the benchmark has such a name",
            "leave --scenes out to see all of them",
        ));
    }
    not_standard("--out", &folder)?;
    make_folder(&folder)?;
    let mut clock = Clock::start();
    let bar = progress("bench", 1.0, json);
    let (runs, left_out) = measure(&plan, |part, _| bar.reached(part))?;
    drop(bar);
    clock.lap("measure");
    if !json {
        print_line(&table(&runs));
        for LeftOut { scene, method, why } in &left_out {
            print_line(&format!("left out: {scene} by {method}: {why}"));
        }
    }
    if runs.is_empty() {
        return Err(nothing(&left_out));
    }
    let write = |name: &str, bytes: &[u8]| write(&folder.join(name), bytes);
    write(reports::BENCH, html(&runs).as_bytes())?;
    write("bench.csv", csv(&runs).as_bytes())?;
    for (scene, runs) in by_scene(&runs) {
        let (name, drawing) = (scene.replace(':', "-"), svg(scene, &runs));
        write(&format!("bench-{name}.svg"), drawing.as_bytes())?;
        let picture = png(&drawing).map_err(|error| undrawable(scene, &error))?;
        write(&format!("bench-{name}.png"), &picture)?;
    }
    clock.lap("write");
    if json {
        let runs: Vec<Value> = runs.iter().map(told).collect();
        let left_out: Vec<Value> = left_out.iter().map(told_left_out).collect();
        print_json(&json!({ "runs": runs, "left_out": left_out, "seconds": clock }));
        return Ok(Outcome::Done);
    }
    print_line(&format!("written: bench.html, bench.csv and the plots, in {}", folder.display()));
    Ok(Outcome::Done)
}

/// What a scene is called: a built-in one by its name, a file without its folder and ending.
fn case_name(given: &str) -> String {
    let path = Path::new(given);
    let name = if path.is_file() { path.file_stem() } else { None };
    name.map_or_else(|| given.to_owned(), |stem| stem.to_string_lossy().into_owned())
}

/// One run, for machines.
fn told(run: &Measured) -> Value {
    json!({
        "scene": run.scene,
        "integrator": run.method.integrator,
        "treatment": run.method.treatment(),
        "coordinates": run.method.coordinates,
        "tolerance": run.tolerance,
        "error": run.error,
        "median": run.median(),
        "repeats": run.times.len(),
        "evaluations": run.work.evaluations,
        "steps": run.work.steps,
    })
}

fn told_left_out(left: &LeftOut) -> Value {
    json!({ "scene": left.scene, "method": left.method, "why": left.why })
}

fn nothing(left_out: &[LeftOut]) -> Problem {
    let why = left_out
        .first()
        .map_or_else(String::new, |left| format!(": {} by {}: {}", left.scene, left.method, left.why));
    Problem::new(
        StatusCode::UNPROCESSABLE_ENTITY,
        "nothing-to-measure",
        format!("there is nothing to measure{why}"),
        "choose other integrators, treatments or tolerances",
    )
}

fn undrawable(scene: &str, error: &RasterError) -> Problem {
    Problem::new(
        StatusCode::INTERNAL_SERVER_ERROR,
        "undrawable-plot",
        format!("the plot of {scene} cannot be made: {error}"),
        "the plot as SVG and the tables are there; please report this",
    )
}
