//! `triad import`: a URDF as a scene.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;
use triad_urdf::{self as urdf, SideCar};

use crate::cli::output::{Form, apart, write};
use crate::cli::terminal::{Outcome, print_json, print_line, tell};
use crate::problem::Problem;
use crate::scenes;

#[derive(Debug, Args)]
pub(in crate::cli) struct Import {
    /// The robot's description.
    urdf: PathBuf,
    /// A side-car in JSON: joints that close loops, positions at the start, drivers, loads, settings.
    #[arg(long, value_name = "SIDE.json")]
    with: Option<PathBuf>,
    /// Write the scene here; without it, to standard output.
    #[arg(long, value_name = "SCENE.json")]
    out: Option<PathBuf>,
}

/// Reads, converts, writes, and tells what was left out.
pub(in crate::cli) fn import(options: &Import, json: bool) -> Result<Outcome, Problem> {
    let files = [
        ("the URDF", Some(options.urdf.as_path()), Form::Read),
        ("--with", options.with.as_deref(), Form::Read),
        ("--out", options.out.as_deref(), Form::Text),
    ];
    apart(&files, json)?;
    let text = scenes::read(&options.urdf, urdf::MAX_TEXT as u64)?;
    let side_car = match &options.with {
        None => SideCar::default(),
        Some(path) => {
            let text = scenes::read(path, urdf::MAX_TEXT as u64)?;
            let hint = "`triad import --help` shows a side-car; joints, drivers, loads and settings are those of a scene";
            crate::api::parse_as("the side-car", hint, text.as_bytes())?
        }
    };
    let imported = urdf::import(&text, &side_car)?;
    let written = imported.scene.to_json();
    // A robot that cannot be assembled is reported now rather than at its first run.
    let report = triad_engine::analysis::check::check(&imported.scene)?;
    if json {
        print_json(&json!({ "scene": imported.scene, "left_out": imported.left_out, "check": report }));
    }
    match &options.out {
        Some(path) => write(path, written + "\n")?,
        None if json => {}
        None => print_line(&written),
    }
    if !json {
        tell(&format!(
            "{}: {} bodies, {} joints, {} degrees of freedom",
            imported.scene.name,
            imported.scene.bodies.len(),
            imported.scene.joints.len(),
            report.degrees_of_freedom
        ));
        for left in &imported.left_out {
            tell(&format!("  line {}, {}: left out: {}", left.line, left.of, left.what));
        }
    }
    Ok(Outcome::Done)
}
