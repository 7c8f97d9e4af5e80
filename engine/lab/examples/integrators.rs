//! Time of each integrator to a given error, on built-in scenes and on scenes with loads and drivers:
//! `cargo run --release -p triad-lab --example integrators [scene …]`.
//!
//! Integration alone, without estimates of errors, in processor time, because the machine may be shared; mean of many repeats.
//! The error is the largest distance of centres of mass and tips of directors, every tenth of a second, from the tightest run.

use std::time::Instant;
use triad_engine::EngineError;
use triad_engine::catalogue;
use triad_engine::constraints::mechanism::Mechanism;
use triad_engine::constraints::rank;
use triad_engine::integrate::Integrator;
use triad_engine::model::Model;
use triad_engine::run::Simulation;
use triad_engine::scene::{IntegratorKind, Scene};
use triad_engine::system::System;

/// Built-in scenes that are measured.
const BUILT_IN: [&str; 11] = [
    "simple-pendulum",
    "n-four-bar:1",
    "n-four-bar:2",
    "n-four-bar:40",
    "spatial-chain:10",
    "spatial-double-pendulum",
    "free-body",
    "free-body-flip",
    "free-fall",
    "bricard",
    "spatial-slider-crank",
];
/// Integrators beside the automatic choice.
const KINDS: [(&str, IntegratorKind); 4] = [
    ("taylor", IntegratorKind::Taylor),
    ("dop853", IntegratorKind::Dop853),
    ("dopri5", IntegratorKind::Dopri5),
    ("radau", IntegratorKind::Radau),
];
/// Errors, m, at which times are compared.
const ERRORS: [f64; 3] = [1e-4, 1e-6, 1e-9];
/// Runs are repeated until they have taken this long together, s.
const MEASURED_TIME: f64 = 0.06;
/// A run that takes longer, s, does not count.
const TOO_LONG: f64 = 2.0;
/// Steps after which a run is given up.
const MAX_STEPS: usize = 200_000;

/// Loads and drivers for the chain of three rods on oblique hinges that [`acted`] makes.
fn actions() -> Vec<(&'static str, serde_json::Value)> {
    use serde_json::json;
    let table = |knots: u32| {
        let step = 4.0 / f64::from(knots);
        let (times, values): (Vec<f64>, Vec<f64>) =
            (0..=knots).map(|k| (f64::from(k) * step, libm::sin(f64::from(k) * step * 9.0))).unzip();
        json!({ "torque": { "kind": "table", "times": times, "values": values } })
    };
    let torsion = |more: serde_json::Value| {
        let mut load = json!({ "type": "torsion", "name": "t", "joint": "h1" });
        for (key, value) in more.as_object().into_iter().flatten() {
            load[key] = value.clone();
        }
        json!({ "loads": [load] })
    };
    vec![
        ("no load", json!({})),
        ("torsion spring and damper", torsion(json!({ "stiffness": 8, "damping": 0.4 }))),
        (
            "motor, harmonic",
            torsion(json!({ "torque": { "kind": "harmonic", "amplitude": 6, "frequency": 5 } })),
        ),
        ("motor, table of 40 knots", torsion(table(40))),
        ("motor, table of 400 knots", torsion(table(400))),
        ("motor, table of 4000 knots", torsion(table(4000))),
        (
            "friction, smoothing 0.1",
            torsion(json!({ "friction": { "viscous": 0.1, "coulomb": 1.5, "smoothing": 0.1 } })),
        ),
        ("friction, smoothing 0.001", torsion(json!({ "friction": { "coulomb": 0.5, "smoothing": 1e-3 } }))),
        (
            "spring between points",
            json!({ "loads": [{ "type": "spring", "name": "s", "body_i": "ground",
            "point_i": [0.5, 1, 0.3], "body_j": "b2", "point_j": [0.3, 0, 0.1], "stiffness": 40, "damping": 1 }] }),
        ),
        (
            "force turning with a body",
            json!({ "loads": [{ "type": "force", "name": "f", "body": "b2", "point": [0.4, 0, 0],
            "force": { "kind": "fixed", "vector": [0, 3, 1] }, "frame": "body" }] }),
        ),
        (
            "driven angle, many turns",
            json!({ "drivers": [{ "type": "angle", "name": "d", "joint": "h0",
            "motion": { "kind": "polynomial", "coefficients": [0, 0, 2] } }] }),
        ),
        (
            "driven angle, smooth step",
            json!({ "drivers": [{ "type": "angle", "name": "d", "joint": "h0",
            "motion": { "kind": "smooth-step", "from": 0, "to": 3, "start": 0.5, "end": 1.5 } }] }),
        ),
    ]
}

/// Three rods on hinges that are parallel to nothing, with the keys of `action`.
fn acted(action: &serde_json::Value) -> Result<Scene, EngineError> {
    let axes = [[0.0, 1.0, 1.0], [0.3, 1.0, -0.4], [0.1, -0.6, 1.0]];
    let bodies: Vec<_> = (0..3)
        .map(|k| serde_json::json!({ "name": format!("b{k}"), "mass": 1, "inertia": { "principal": [0.02, 0.09, 0.08] },
            "position": [f64::from(k) + 0.5, 0, 0] }))
        .collect();
    let joints: Vec<_> = (0..3u8)
        .map(|k| serde_json::json!({ "name": format!("h{k}"), "type": "revolute", "point": [k, 0, 0],
            "axis": axes[usize::from(k)], "body_i": if k == 0 { "ground".into() } else { format!("b{}", k - 1) },
            "body_j": format!("b{k}") }))
        .collect();
    let mut scene = serde_json::json!({ "name": "acted", "gravity": [0, 0, -9.81], "bodies": bodies, "joints": joints,
        "simulation": { "duration": 4 } });
    for (key, value) in action.as_object().into_iter().flatten() {
        scene[key] = value.clone();
    }
    Ok(Scene::from_json(&scene.to_string())?)
}

/// Processor time of this thread where the system tells it, else time.
struct Clock {
    processor: Option<f64>,
    start: Instant,
}

impl Clock {
    fn start() -> Self {
        Self { processor: Self::processor(), start: Instant::now() }
    }

    fn processor() -> Option<f64> {
        // Giving way once makes the system bring its count up to date, which otherwise goes by ticks of 4 ms.
        std::thread::yield_now();
        let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
        text.split(' ').next()?.parse::<f64>().ok().map(|nanoseconds| 1e-9 * nanoseconds)
    }

    fn seconds(&self) -> f64 {
        let processor = self.processor.and_then(|start| Some(Self::processor()? - start));
        processor.unwrap_or_else(|| self.start.elapsed().as_secs_f64())
    }
}

/// Time of a run, s, and its places, or nothing if it stops or takes too long.
fn run(scene: &Scene, kind: IntegratorKind, tolerance: f64, sample: bool) -> Option<(f64, Vec<f64>)> {
    let mut scene = scene.clone();
    scene.simulation.tolerance = tolerance;
    // The series alone would carry it here.
    scene.simulation.error_estimate = false;
    let mut mechanism = Mechanism::new(System::new(Model::new(&scene).ok()?));
    let n = mechanism.system.coordinates;
    let mut y = vec![0.0; 2 * n];
    let (q, q_dot) = y.split_at_mut(n);
    mechanism.system.start(q, q_dot);
    mechanism.assemble(&mut y).ok()?;
    let rank = rank::analyze(&mechanism.system, &mut mechanism.state, &y[..n]);
    mechanism.elimination.set_redundant(!rank.dependent.is_empty());
    mechanism.set_state(0.0, &y);
    let mut integrator = Integrator::start(kind, &mut mechanism, 0.0, &y);
    let (end, mut places, mut next) = (scene.simulation.duration.min(5.0), Vec::new(), 1);
    let clock = Clock::start();
    for _ in 0..MAX_STEPS {
        integrator.step(&mut mechanism, end).ok()?;
        while sample && 0.1 * f64::from(next) <= integrator.last().t {
            integrator.interpolate(&mut mechanism, 0.1 * f64::from(next), &mut y);
            for body in &mechanism.system.bodies {
                let place = body.layout.position(&y[..n]);
                for point in [place.r, place.r + place.e[0], place.r + place.e[1]] {
                    places.extend(point.iter());
                }
            }
            next += 1;
        }
        if integrator.last().t >= end {
            return Some((clock.seconds(), places));
        }
        if !places.is_empty() && clock.seconds() > TOO_LONG && kind != IntegratorKind::Taylor {
            return None;
        }
    }
    None
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    let chunks = a.chunks_exact(3).zip(b.chunks_exact(3));
    chunks.map(|(a, b)| (0..3).map(|c| a[c] - b[c]).map(|d| d * d).sum::<f64>().sqrt()).fold(0.0, f64::max)
}

/// Least time of each integrator to reach each error, in microseconds.
fn measure(name: &str, scene: &Scene) {
    let Some((_, exact)) = run(scene, IntegratorKind::Taylor, 1e-13, true) else {
        println!("{name}: no reference");
        return;
    };
    let mut best = [[f64::INFINITY; KINDS.len()]; ERRORS.len()];
    for (k, (_, kind)) in KINDS.iter().enumerate() {
        for exponent in 3..=12 {
            let tolerance = libm::pow(10.0, f64::from(-exponent));
            let Some((_, places)) = run(scene, *kind, tolerance, true) else { continue };
            let error = distance(&places, &exact);
            let (mut total, mut count) = (0.0, 0);
            while count < 1000 && total < MEASURED_TIME {
                let Some((time, _)) = run(scene, *kind, tolerance, false) else { break };
                total += time;
                count += 1;
            }
            let mean = 1e6 * total / f64::from(count);
            for (best, _) in best.iter_mut().zip(ERRORS).filter(|(_, bound)| error <= *bound) {
                best[k] = best[k].min(mean);
            }
        }
    }
    print!("{name:<28}");
    for (best, bound) in best.iter().zip(ERRORS) {
        let mut scene = scene.clone();
        scene.simulation.tolerance = bound;
        let chosen = Simulation::new(&scene).map(|run| run.summary().integrator);
        let fastest = best.iter().copied().fold(f64::INFINITY, f64::min);
        let own = KINDS
            .iter()
            .position(|(_, kind)| chosen.as_ref().is_ok_and(|c| c == kind))
            .map_or(f64::NAN, |k| best[k]);
        let [taylor, dop853, dopri5, radau] = *best;
        print!(" | {taylor:>8.0} {dop853:>8.0} {dopri5:>8.0} {radau:>8.0} auto {:>4.2}", own / fastest);
    }
    println!();
}

fn main() -> Result<(), EngineError> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    println!(
        "microseconds to reach 1e-4 | 1e-6 | 1e-9 with taylor, dop853, dopri5, radau; auto: slower than the fastest by"
    );
    if arguments.is_empty() {
        for name in BUILT_IN {
            measure(name, &catalogue::scene(name)?);
        }
        for (name, action) in actions() {
            measure(name, &acted(&action)?);
        }
    }
    if arguments.is_empty() || arguments == ["stiff"] {
        for damping in [1e1, 1e2, 1e3, 1e4, 1e5] {
            let load =
                serde_json::json!({ "type": "torsion", "name": "t", "joint": "h1", "damping": damping });
            measure(
                &format!("damper of {damping:.0e} N m s"),
                &acted(&serde_json::json!({ "loads": [load] }))?,
            );
        }
        for stiffness in [1e3, 1e5, 1e7, 1e9] {
            let load =
                serde_json::json!({ "type": "torsion", "name": "t", "joint": "h1", "stiffness": stiffness });
            measure(
                &format!("spring of {stiffness:.0e} N m"),
                &acted(&serde_json::json!({ "loads": [load] }))?,
            );
        }
    }
    for name in arguments.iter().filter(|name| *name != "stiff") {
        measure(name, &catalogue::scene(name)?);
    }
    Ok(())
}
