//! Published and closed-form solutions, held over their whole duration at the tightest useful tolerance.
//!
//! `cargo test --release -p triad-tests --test benchmarks -- --nocapture` prints the table of README.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use nalgebra::Vector3;
use std::time::Instant;
use triad_engine::catalogue;
use triad_engine::run::{Simulation, Summary};
use triad_engine::scene::{Coordinates, IntegratorKind, Scene};
use triad_engine::state::BodyFrame;
use triad_tests::reference::{Reference, distance};

const ALL: [Coordinates; 3] = [Coordinates::Full, Coordinates::Reduced, Coordinates::Shared];

/// Runs `scene` through the times of `reference` and returns the largest of `error`, with what the run cost.
fn compare(
    scene: &Scene,
    tolerance: f64,
    reference: &Reference,
    until: f64,
    mut error: impl FnMut(&mut Simulation, &[f64]) -> f64,
) -> (f64, Summary) {
    let mut scene = scene.clone();
    scene.simulation.integrator = IntegratorKind::Dop853;
    scene.simulation.tolerance = tolerance;
    scene.simulation.duration = until;
    let mut simulation = Simulation::new(&scene).unwrap();
    let began = Instant::now();
    let mut worst = 0.0f64;
    for row in reference.rows.iter().filter(|row| row[0] <= until) {
        simulation.advance_to(row[0]).unwrap();
        let error = error(&mut simulation, row);
        assert!(error.is_finite());
        worst = worst.max(error);
    }
    let time = began.elapsed();
    let s = simulation.summary();
    println!(
        "{:<28} {:>8} s  error {worst:.1e}  energy drift {:.1e} J  |Φ| {:.1e}  |Φ̇| {:.1e}  {} + {} steps  \
         {} evaluations  {:.1} ms",
        scene.name,
        s.time,
        s.energy_drift,
        s.position_violation,
        s.velocity_violation,
        s.steps,
        s.rejected,
        s.evaluations,
        time.as_secs_f64() * 1e3
    );
    (worst, s)
}

fn with(name: &str, coordinates: Coordinates) -> Scene {
    let mut scene = catalogue::scene(name).unwrap();
    scene.coordinates = coordinates;
    scene
}

/// Work must not grow unnoticed. A twentieth is left for arithmetic that differs between machines.
fn costs(summary: &Summary, evaluations: u64) {
    let ratio = summary.evaluations as f64 / evaluations as f64;
    assert!((0.95..1.05).contains(&ratio), "{} evaluations, known are {evaluations}", summary.evaluations);
}

/// Energy and constraints as every run reports them.
fn trusts(summary: &Summary, energy: f64) {
    assert!(summary.energy_drift.abs() < energy, "energy drift {:e} J", summary.energy_drift);
    assert!(summary.position_violation < 1e-12, "|Φ| = {:e}", summary.position_violation);
    assert!(summary.velocity_violation < 1e-11, "|Φ̇| = {:e}", summary.velocity_violation);
}

/// The point that is `local` away from the centre of mass along u, v, w.
fn point(frame: &BodyFrame, local: [f64; 3]) -> [f64; 3] {
    let at = Vector3::from(frame.position)
        + Vector3::from(frame.u) * local[0]
        + Vector3::from(frame.v) * local[1]
        + Vector3::from(frame.w) * local[2];
    at.into()
}

/// Angular velocity in the body's own frame.
fn body_rates(frame: &BodyFrame) -> [f64; 3] {
    let omega = Vector3::from(frame.angular_velocity);
    [frame.u, frame.v, frame.w].map(|e| omega.dot(&Vector3::from(e)))
}

#[test]
fn a01_simple_pendulum() {
    let reference = Reference::read("a01-simple-pendulum");
    let [x, y, vx, vy, fx, fy] = reference.columns(["x", "y", "vx", "vy", "Rx_ground", "Ry_ground"]);
    for (coordinates, known) in ALL.into_iter().zip([5935, 5996, 5935]) {
        let scene = with("simple-pendulum", coordinates);
        let mut force = 0.0f64;
        let (error, summary) = compare(&scene, 1e-13, &reference, 10.0, |simulation, row| {
            let bob = simulation.frame().bodies[0];
            let pin = &simulation.multipliers()[0];
            assert_eq!(pin.on, "bob");
            force = force.max(distance(&pin.force, &[row[fx], row[fy], 0.0]));
            let speed = distance(&bob.velocity, &[row[vx], row[vy], 0.0]);
            distance(&bob.position, &[row[x], row[y], 0.0]).max(0.1 * speed)
        });
        assert!(error < 1e-8, "position {error:e} m");
        assert!(force < 1e-7, "force of the pin {force:e} N");
        trusts(&summary, 1e-8);
        costs(&summary, known);
    }
}

#[test]
fn a02_double_four_bar_through_its_ten_singular_positions() {
    let reference = Reference::read("a02-four-bar-2");
    let [x, y] = reference.columns(["B0x", "B0y"]);
    let crossings = reference.rows.windows(2).filter(|w| w[0][y] * w[1][y] < 0.0).count();
    assert_eq!(crossings, 10);
    for coordinates in ALL {
        let scene = with("n-four-bar:2", coordinates);
        let (error, summary) = compare(&scene, 1e-12, &reference, 10.0, |simulation, row| {
            let upright = simulation.frame().bodies[0];
            distance(&point(&upright, [0.5, 0.0, 0.0]), &[row[x], row[y], 0.0])
        });
        assert!(error < 1e-6, "B0 {error:e} m");
        trusts(&summary, 1e-6);
    }
}

#[test]
fn a02_pins_hold_with_the_forces_of_newton_and_euler() {
    let reference = Reference::read("a02-four-bar-2-pins");
    let [phi] = reference.columns(["phi_from_up"]);
    let columns = reference.columns(["A0_Fx", "A0_Fy", "A1_Fx", "A1_Fy", "A2_Fx", "A2_Fy"]);
    let (error, _) =
        compare(&with("n-four-bar:2", Coordinates::Full), 1e-12, &reference, 10.0, |simulation, row| {
            // The forces have a pole where the links are horizontal.
            if row[phi].cos().abs() < 0.1 {
                return 0.0;
            }
            let pins = simulation.multipliers();
            let forces = ["A0", "A1", "A2"].map(|name| {
                let pin = pins.iter().find(|pin| pin.joint == name).unwrap();
                assert!(pin.on.starts_with("upright-"));
                pin.force
            });
            let expected = columns.map(|column| row[column]);
            (0..3)
                .map(|k| distance(&forces[k][..2], &expected[2 * k..2 * k + 2]) + forces[k][2].abs())
                .fold(0.0, f64::max)
        });
    assert!(error < 1e-5, "{error:e} N");
}

#[test]
fn c01_free_body() {
    for (name, data, allowed, evaluations) in [
        ("free-body", "c01-free-body", 1e-9, [7377, 7359, 7377]),
        // The flip multiplies whatever rounding there is by thousands.
        ("free-body-flip", "c01-free-body-flip", 1e-8, [6604, 6267, 6604]),
    ] {
        let reference = Reference::read(data);
        let rates = reference.columns(["w1_body", "w2_body", "w3_body"]);
        let attitude = reference.columns(["q0", "q1", "q2", "q3"]);
        for (coordinates, known) in ALL.into_iter().zip(evaluations) {
            let mut turned = 0.0f64;
            let (error, summary) =
                compare(&with(name, coordinates), 1e-14, &reference, 10.0, |simulation, row| {
                    let body = simulation.frame().bodies[0];
                    let expected = rates.map(|column| row[column]);
                    let [w, x, y, z] = attitude.map(|column| row[column]);
                    let q = nalgebra::Quaternion::new(w, x, y, z);
                    let frame =
                        nalgebra::UnitQuaternion::from_quaternion(q).to_rotation_matrix().into_inner();
                    turned = turned.max(distance(&[body.u, body.v, body.w].concat(), frame.as_slice()));
                    distance(&body_rates(&body), &expected) / distance(&expected, &[0.0; 3])
                });
            assert!(error < allowed, "{name}: rates {error:e} relative");
            assert!(turned < 10.0 * allowed, "{name}: attitude {turned:e}");
            trusts(&summary, 1e-9);
            costs(&summary, known);
        }
    }
}

#[test]
fn c03_free_fall_of_a_tumbling_body() {
    let reference = Reference::read("c03-free-fall");
    let centre = reference.columns(["x", "y", "z"]);
    let path = reference.columns(["px", "py", "pz"]);
    // The same body, once given by its centre of mass, once by another reference point and turned axes.
    let plain = serde_json::json!({
        "mass": 2, "inertia": { "principal": [1, 2, 3] },
        "position": [0, 0, 10], "velocity": [1, 2, 3], "angular_velocity": [1, 2, 3]
    });
    // Reference point p = c + (0.3, -0.2, 0.5): its velocity is v + ω × that. Axes turned by 90° about z.
    let shifted = serde_json::json!({
        "mass": 2, "inertia": { "tensor": [[2, 0, 0], [0, 1, 0], [0, 0, 3]] },
        "center_of_mass": [0.2, 0.3, -0.5], "position": [0.3, -0.2, 10.5],
        "orientation": { "axis": [0, 0, 1], "angle": std::f64::consts::FRAC_PI_2 },
        "velocity": [1.0 + 2.0 * 0.5 + 3.0 * 0.2, 2.0 + 3.0 * 0.3 - 0.5, 3.0 - 0.2 - 2.0 * 0.3],
        "angular_velocity": [1, 2, 3]
    });
    for (mut body, coordinates, local) in
        [(plain, "full", [0.3, -0.2, 0.5]), (shifted, "reduced", [-0.2, -0.3, 0.5])]
    {
        body["name"] = "body".into();
        let scene = serde_json::json!({
            "name": "free-fall", "coordinates": coordinates, "bodies": [body],
            "simulation": { "duration": 2 }
        });
        let scene = Scene::from_json(&scene.to_string()).unwrap();
        let (error, summary) = compare(&scene, 1e-13, &reference, 2.0, |simulation, row| {
            let body = simulation.frame().bodies[0];
            distance(&body.position, &centre.map(|column| row[column]))
                .max(distance(&point(&body, local), &path.map(|column| row[column])))
        });
        assert!(error < 1e-11, "{error:e} m");
        trusts(&summary, 1e-10);
    }
}

#[test]
fn c04_spatial_double_pendulum() {
    let reference = Reference::read("c04-spatial-double-pendulum");
    let upper = reference.columns(["COM1x", "COM1y", "COM1z"]);
    let lower = reference.columns(["COM2x", "COM2y", "COM2z"]);
    let ground = reference.columns(["F_O_x", "F_O_y", "F_O_z"]);
    let between = reference.columns(["F_A_x", "F_A_y", "F_A_z"]);
    for (coordinates, known) in ALL.into_iter().zip([6420, 6368, 6420]) {
        let scene = with("spatial-double-pendulum", coordinates);
        let mut force = 0.0f64;
        let (error, summary) = compare(&scene, 1e-13, &reference, 5.0, |simulation, row| {
            let joints = simulation.multipliers();
            assert_eq!([&joints[0].on, &joints[1].on], ["upper", "lower"]);
            force = force.max(distance(&joints[0].force, &ground.map(|column| row[column])));
            force = force.max(distance(&joints[1].force, &between.map(|column| row[column])));
            let bodies = simulation.frame().bodies;
            distance(&bodies[0].position, &upper.map(|column| row[column]))
                .max(distance(&bodies[1].position, &lower.map(|column| row[column])))
        });
        assert!(error < 1e-8, "{error:e} m");
        assert!(force < 1e-6, "{force:e} N");
        trusts(&summary, 1e-9);
        costs(&summary, known);
    }
}
