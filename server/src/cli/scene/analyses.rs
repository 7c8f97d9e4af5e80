//! `triad reactions`, `equilibrium`, `modes`, `kinematics` and `assemble`.

use clap::{Args, ValueEnum};
use serde::Serialize;
use triad_engine::EngineError;
use triad_engine::Scene;
use triad_engine::analysis::{self, AnalysisError};
use triad_engine::reactions::report::{Convention, ExpressedIn, MomentReference, Side};
use triad_engine::run::Simulation;
use triad_engine::scene::text::short;

use super::numbers::{LEAST, Scale, digits, largest, triple};
use super::source::Source;
use super::worth::{Judged, Worth};
use crate::cli::clock::{Clock, Timed};
use crate::cli::terminal::{Outcome, print_json, print_line};
use crate::problem::Problem;

/// How reactions are wanted.
#[derive(Debug, Clone, Args)]
pub(in crate::cli) struct Words {
    /// The body that the reaction acts on.
    #[arg(long, value_enum, default_value_t = OnWord::J)]
    on: OnWord,
    /// The point about which moments are taken.
    #[arg(long, value_enum, default_value_t = AboutWord::JointPoint)]
    about: AboutWord,
    /// The frame of the components.
    #[arg(long = "in", value_enum, default_value_t = FrameWord::World)]
    frame: FrameWord,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum OnWord {
    /// Body i of each joint.
    I,
    /// Body j of each joint.
    J,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum AboutWord {
    /// The joint's point on that body.
    JointPoint,
    /// The body's centre of mass.
    CenterOfMass,
    /// The world's origin.
    Origin,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum FrameWord {
    /// The world's axes.
    World,
    /// x along the joint's axis.
    Joint,
    /// The frame of the body that the reaction acts on.
    Body,
}

impl Words {
    fn convention(&self) -> Convention {
        Convention {
            on: match self.on {
                OnWord::I => Side::I,
                OnWord::J => Side::J,
            },
            about: match self.about {
                AboutWord::JointPoint => MomentReference::JointPoint,
                AboutWord::CenterOfMass => MomentReference::CenterOfMass,
                AboutWord::Origin => MomentReference::WorldPoint([0.0; 3]),
            },
            expressed_in: match self.frame {
                FrameWord::World => ExpressedIn::World,
                FrameWord::Joint => ExpressedIn::Joint,
                FrameWord::Body => ExpressedIn::Body,
            },
        }
    }
}

/// Reads a scene and prints what an analysis finds: for machines, or for people by `print`.
fn answer<T: Serialize>(
    source: &Source,
    json: bool,
    analyze: impl FnOnce(&Scene) -> Result<T, AnalysisError>,
    print: impl FnOnce(&Scene, &T),
) -> Result<Outcome, Problem> {
    let mut clock = Clock::start();
    let scene = source.read()?;
    clock.lap("read");
    let found = analyze(&scene)?;
    clock.lap("solve");
    if json {
        print_json(&Timed { answer: &found, seconds: &clock });
    } else {
        print(&scene, &found);
    }
    Ok(Outcome::Done)
}

fn print_notes(notes: &[String]) {
    for note in notes {
        print_line(&format!("  note: {note}"));
    }
}

/// Reactions of a scene at a time.
pub(in crate::cli) fn reactions(
    source: &Source,
    at: f64,
    words: &Words,
    json: bool,
) -> Result<Outcome, Problem> {
    let mut clock = Clock::start();
    let scene = source.read()?;
    clock.lap("read");
    let mut simulation = Simulation::new(&scene)?;
    clock.lap("assemble");
    if !(0.0..=simulation.duration()).contains(&at) {
        return Err(EngineError::TimeOutside { time: at, from: 0.0, to: simulation.duration() }.into());
    }
    simulation.advance_to(at)?;
    clock.lap("integrate");
    if simulation.time() < at {
        return Err(EngineError::TimeOutside { time: at, from: 0.0, to: simulation.time() }.into());
    }
    let report = simulation.reactions(words.convention())?;
    let worth = Worth::of(&simulation, &report, words.convention())?;
    clock.lap("solve");
    if json {
        print_json(&Timed { answer: &Judged { report: &report, worth }, seconds: &clock });
    } else {
        print_line(&format!("{}: reactions at t = {} s", scene.name, short(report.time)));
        Scale::of(&simulation.frame().bodies, &report).print_reactions(&report);
        worth.print();
    }
    Ok(Outcome::Done)
}

/// Static equilibrium near the start.
pub(in crate::cli) fn equilibrium(source: &Source, json: bool) -> Result<Outcome, Problem> {
    answer(source, json, analysis::equilibrium, print_equilibrium)
}

fn print_equilibrium(scene: &Scene, found: &analysis::Equilibrium) {
    let verdict = match found.stable {
        Some(true) => "stable",
        Some(false) => "unstable: the least touch leaves it",
        None => "whether it is stable is undecided",
    };
    print_line(&format!("{}: equilibrium after {} steps, {verdict}", scene.name, found.iterations));
    print_line(&match found.error {
        Some(error) => format!("  error: positions right to about {:.0e} m", error.max(f64::EPSILON)),
        None => "  error: positions are not known along motions that meet no stiffness".to_owned(),
    });
    let scale = Scale::of(&found.bodies, &found.reactions);
    scale.print_bodies(scene, &found.bodies);
    scale.print_reactions(&found.reactions);
    print_notes(&found.notes);
}

/// Eigenfrequencies and mode shapes.
pub(in crate::cli) fn modes(
    source: &Source,
    about: analysis::ModesAbout,
    json: bool,
) -> Result<Outcome, Problem> {
    answer(source, json, |scene| analysis::modes(scene, about), print_modes)
}

fn print_modes(scene: &Scene, found: &analysis::Modes) {
    print_line(&format!("{}: {} degrees of freedom", scene.name, found.freedoms));
    if let Some(steady) = &found.steady {
        print_line(&format!(
            "  in a frame that turns at {} rad/s and slides at {} m/s",
            triple(steady.turning, largest(&[steady.turning])),
            triple(steady.sliding, largest(&[steady.sliding]))
        ));
        for spin in &steady.spins {
            print_line(&format!("    {} spins in it at {} rad/s", spin.body, digits(spin.rate)));
        }
        // A start that is not steady may be far from the motion that is found.
        print_line("  where the bodies stand in it:");
        Scale::of_places(&found.bodies).print_bodies(scene, &found.bodies);
    }
    print_shapes(scene, found);
    if found.left_out > 0 {
        print_line(&format!("  motions left out because they have no inertia: {}", found.left_out));
        for turns in &found.without_inertia {
            let axes: Vec<String> = turns.axes.iter().map(|axis| triple(*axis, 1.0)).collect();
            print_line(&format!("    {} turns about {}", turns.body, axes.join(" and ")));
        }
    }
    print_notes(&found.notes);
}

/// Each mode with its shape; of one whose bodies do not move in phase also the shape a quarter of a period later.
fn print_shapes(scene: &Scene, found: &analysis::Modes) {
    for (index, mode) in found.modes.iter().enumerate() {
        print_line(&format!(
            "  mode {}: {:<10} {:>12} Hz, growth {:>12} 1/s, damping ratio {}{}",
            index + 1,
            mode.kind,
            digits(mode.frequency),
            digits(mode.growth),
            digits(mode.damping_ratio),
            mode.error.map_or_else(String::new, |error| format!("; λ right to about {error:.0e} 1/s"))
        ));
        let decayed = if mode.growth == 0.0 { "" } else { ", but for growth and decay," };
        for (body, motion) in scene.bodies.iter().zip(&mode.shape) {
            let later = [motion.translation_later, motion.rotation_later];
            let later = if later.as_flattened().iter().all(|x| x.abs() < LEAST) {
                String::new()
            } else {
                format!(
                    "; a quarter of a period later{decayed} {} m, {} rad",
                    triple(later[0], 1.0),
                    triple(later[1], 1.0)
                )
            };
            print_line(&format!(
                "    {}: moves {} m, turns {} rad{later}",
                body.name,
                triple(motion.translation, 1.0),
                triple(motion.rotation, 1.0)
            ));
        }
    }
    if !found.modes.is_empty() {
        print_line(
            "  shapes: the largest component (m, or rad times the mechanism's length) is one; what moves is the centre of mass",
        );
    }
}

/// Kinematic analysis and inverse dynamics of a driven scene.
pub(in crate::cli) fn kinematics(source: &Source, words: &Words, json: bool) -> Result<Outcome, Problem> {
    answer(source, json, |scene| analysis::kinematics(scene, words.convention()), print_kinematics)
}

fn print_kinematics(scene: &Scene, found: &analysis::Kinematics) {
    print_line(&format!(
        "{}: {} positions, {} steps between them",
        scene.name,
        found.states.len(),
        found.steps
    ));
    print_line(&format!(
        "  error: positions right to about {:.1e} m, axes to that part of their length: Newton-Raphson moved none by more",
        found.correction.max(f64::EPSILON)
    ));
    for passed in &found.singularities {
        print_line(&format!(
            "  passes a singular position of {} at t = {:.6} s",
            passed.joints.join(", "),
            passed.time
        ));
    }
    for event in &found.events {
        let end = if event.stop { "; the motion ends there" } else { "" };
        let error = event.error.map_or_else(String::new, |error| format!(" (to {error:.0e} s)"));
        print_line(&format!(
            "  event {} at t = {:.9} s{error}, rate {}{end}",
            event.name,
            event.time,
            digits(event.rate)
        ));
    }
    print_notes(&found.notes);
    for state in &found.states {
        print_line(&format!("t = {:.6} s", state.time));
        let scale = Scale::of(&state.bodies, &state.reactions);
        scale.print_moving(scene, &state.bodies);
        for driver in state.reactions.reactions.iter().filter(|r| r.driver) {
            scale.print_reaction(driver);
        }
    }
}

/// Assembly from a rough start.
pub(in crate::cli) fn assemble(source: &Source, keep: &[String], json: bool) -> Result<Outcome, Problem> {
    answer(source, json, |scene| analysis::assemble(scene, keep), print_assembly)
}

fn print_assembly(scene: &Scene, found: &analysis::Assembly) {
    print_line(&format!(
        "{}: closed after {} steps; open by {:.3e} at the start, {:.3e} now",
        scene.name, found.iterations, found.violation, found.left
    ));
    let reach = largest(&found.bodies.iter().map(|body| body.position).collect::<Vec<_>>());
    for body in &found.bodies {
        let q = body.quaternion;
        print_line(&format!(
            "  {}: position {} m, quaternion ({:.6}, {:.6}, {:.6}, {:.6}); moved {:.3e} m, turned {:.3e} rad",
            body.body,
            triple(body.position, reach),
            q[0],
            q[1],
            q[2],
            q[3],
            body.moved,
            body.turned
        ));
    }
    print_notes(&found.notes);
}
