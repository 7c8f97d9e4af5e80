//! What `triad run` tells when it is done.

use std::fmt::Write as _;

use serde_json::json;
use triad_engine::VERSION;
use triad_engine::run::{EventOccurrence, ReactionErrors, Simulation, SkippedItem, Summary};
use triad_engine::scene::text::short;
use triad_engine::scene::{IntegratorKind, Scene};
use triad_lab::verify::Verification;

use super::options::Run;
use crate::cli::clock::Clock;
use crate::cli::output::{Form, is_standard};
use crate::cli::terminal::{error_label, print_json, print_line, tell};
use crate::problem::Problem;

/// Most joints that are named at singular positions.
const NAMES: usize = 8;
/// The error of directions is told where it means so many times that of positions over the length of the mechanism.
const TURNING: f64 = 10.0;

/// What is known of a run besides its own state.
pub(super) struct Found<'a> {
    /// Why it ended early.
    pub stopped: Option<&'a Problem>,
    /// What a second solution says.
    pub verified: Option<&'a Verification>,
    /// What its pictures do not show, in sentences.
    pub pictured: &'a [String],
    /// What it took.
    pub clock: &'a Clock,
}

/// Prints what a run has come to.
pub(super) fn report(
    scene: &Scene,
    simulation: &Simulation,
    options: &Run,
    &Found { stopped, verified, pictured, clock }: &Found,
    json: bool,
) {
    let mut summary = simulation.summary();
    summary.doubts.extend(verified.into_iter().flat_map(|verified| verified.doubts(simulation)));
    let reactions = simulation.reaction_errors();
    let mut notes = simulation.notes().to_vec();
    notes.extend(options.source.notes(scene, summary.integrator == IntegratorKind::Taylor));
    notes.extend(options.idle());
    notes.extend_from_slice(pictured);
    let left_out = options.explain.then(|| simulation.left_out());
    if json {
        let mut document = json!({
            "scene": scene.name,
            "settings": scene.simulation,
            "summary": summary,
            "events": simulation.events(),
            "notes": notes,
            "left_out": left_out,
            "verified": verified,
            "seconds": clock,
            "repeat": { "engine": VERSION, "fingerprint": scene.fingerprint() },
            "stopped": stopped.map(Problem::document),
        });
        if let Some(reactions) = reactions {
            document["reaction_errors"] = json!(reactions);
        }
        print_json(&document);
        return;
    }
    let [time, end] = [summary.time, scene.simulation.duration].map(short);
    print_line(&format!("{}: {time} s of {end} s", scene.name));
    // Without a step that holds the figures would be those of the start.
    if stopped.is_none() || summary.time > 0.0 {
        print_line(&accuracy(&summary, reactions, simulation.system().length));
        for line in figures(&summary, verified) {
            print_line(&line);
        }
    }
    for note in &notes {
        print_line(&format!("  note                   {note}"));
    }
    print_line(&clock.line());
    for event in simulation.events() {
        print_line(&occurrence(event));
    }
    for line in left_out.iter().flatten().map(explanation) {
        print_line(&line);
    }
    let files = options.files().into_iter().filter(|(.., form)| *form != Form::Read);
    for file in files.filter_map(|(_, file, _)| file).filter(|file| !is_standard(file)) {
        print_line(&format!("  written                {}", file.display()));
    }
    if let Some(problem) = stopped {
        tell(&format!("{} {problem}", error_label()));
    }
}

/// An event with its time and rate.
fn occurrence(event: &EventOccurrence) -> String {
    let end = if event.stop { "; the run ends there" } else { "" };
    let EventOccurrence { name, time, .. } = event;
    let error = event.error.map_or_else(String::new, |error| format!(" (to {error:.0e} s)"));
    format!("  event                  {name} at {time:.15} s{error}, rate {}{end}", nine(event.rate))
}

/// The first of many names; all are in the JSON.
fn shortened(names: &[String]) -> String {
    let left = names.len().saturating_sub(NAMES);
    let shown = names[..names.len() - left].join(", ");
    if left > 0 { format!("{shown} and {left} more") } else { shown }
}

fn explanation(left: &SkippedItem) -> String {
    let switch = if left.on { "on " } else { "off" };
    format!("  left out: {:<10} {switch}  {}", left.word, left.what)
}

/// What the numbers at the end are worth.
fn accuracy(s: &Summary, reactions: Option<ReactionErrors>, length: f64) -> String {
    let Some(error) = s.error else {
        let why = match s.error_unknown_from {
            Some(time) => format!("from t = {time:.6} s on unknown"),
            None => "switched off".to_owned(),
        };
        return format!("  error                  {why}");
    };
    // No number is exact.
    let position = if error.position == 0.0 { f64::EPSILON * length } else { error.position };
    let mut line = format!("  error                  positions right to about {position:.0e} m at the end");
    let turning = |turn: f64, way: f64| turn * length > TURNING * way;
    for (what, off, unit, told) in [
        ("directions", error.turn, "rad", turning(error.turn, position)),
        ("velocities", error.velocity, "m/s", error.velocity > 0.0),
        (
            "angular velocities",
            error.angular_velocity,
            "rad/s",
            turning(error.angular_velocity, error.velocity),
        ),
    ] {
        if told {
            let _ = write!(line, ", {what} to {off:.0e} {unit}");
        }
    }
    if let Some(reactions) = reactions.filter(|reactions| reactions.largest_force > 0.0) {
        line.extend([", reactions to ", &format!("{:.0e}", reactions.relative()), " of the largest"]);
    }
    if let Some(method) = &s.error_method {
        line.extend(["; by a second solution, ", method]);
    }
    line
}

/// Nine places, or nine digits of what would be lost in them.
fn nine(x: f64) -> String {
    if x == 0.0 || x.abs() >= 1e-3 { format!("{:.9}", x + 0.0) } else { format!("{x:.9e}") }
}

/// The energy, of which there is none where it is but its error.
fn energy(s: &Summary) -> String {
    let error = s.error.map_or(0.0, |error| error.energy);
    nine(if s.energy.abs() <= error { 0.0 } else { s.energy })
}

fn figures(s: &Summary, verified: Option<&Verification>) -> Vec<String> {
    let mut lines = vec![
        format!("  energy                 {} J, drift {:.2e} J", energy(s), s.energy_drift),
        format!(
            "  constraint violation   {:.2e} position, {:.2e} velocity",
            s.position_violation, s.velocity_violation
        ),
        format!(
            "  steps                  {} accepted, {} rejected, last {:.3e} s",
            s.steps, s.rejected, s.step_size
        ),
        format!(
            "  work                   {} evaluations, {} factorizations, {} solves, {} projections",
            s.evaluations, s.factorizations, s.solves, s.projections
        ),
    ];
    lines.push(format!("  integrator             {}: {}", s.integrator, s.reason));
    if let Some((first, last)) = s.singularities.first().zip(s.singularities.last()) {
        let (count, joints) = (s.singularities.len(), shortened(&first.joints));
        let times = if count == 1 {
            format!("at {:.6} s", first.time)
        } else {
            format!("{count} times, first at {:.6} s, last at {:.6} s", first.time, last.time)
        };
        lines.push(format!("  singular positions     passed {times}, at {joints}"));
    }
    lines.extend(s.doubts.iter().map(|doubt| format!("  doubt                  {doubt}")));
    if let Some(v) = verified {
        let (by, tolerance) = (v.integrator, v.tolerance);
        lines.push(format!(
            "  verified               within {:.2e} m, {:.2e} rad ({by} at {tolerance:.0e}, {} times compared)",
            v.position, v.turn, v.compared
        ));
        let bodies =
            v.bodies.iter().map(|b| format!("    {:<20} {:.2e} m, {:.2e} rad", b.body, b.position, b.turn));
        lines.extend(bodies);
    }
    lines
}
