//! Published and closed-form solutions, held over their whole duration at the tightest useful tolerance, by the default
//! integrator and by DOP853. Error and work of each are those of `tests/data/accuracy.toml`.
//!
//! `TRIAD_WRITE_GOLDEN=1 cargo test --release -p triad-tests --test benchmarks` renews that file and README's table.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use nalgebra::Vector3;
use std::time::Instant;
use triad_engine::catalogue;
use triad_engine::run::{Simulation, Summary};
use triad_engine::scene::{Coordinates, IntegratorKind, Scene};
use triad_engine::state::BodyFrame;
use triad_tests::accuracy::{self, AccuracyTable};
use triad_tests::reference::{Reference, distance};

/// The ways in which each benchmark is solved.
const WAYS: [(Coordinates, IntegratorKind); 6] = [
    (Coordinates::Full, IntegratorKind::Auto),
    (Coordinates::Reduced, IntegratorKind::Auto),
    (Coordinates::Shared, IntegratorKind::Auto),
    (Coordinates::Full, IntegratorKind::Dop853),
    (Coordinates::Reduced, IntegratorKind::Dop853),
    (Coordinates::Shared, IntegratorKind::Dop853),
];

/// Runs `scene` through the times of `reference` and returns the largest of `error`, with what the run cost.
fn compare(
    scene: &Scene,
    tolerance: f64,
    reference: &Reference,
    until: f64,
    mut error: impl FnMut(&Simulation, &[f64]) -> f64,
) -> (f64, Summary) {
    let mut scene = scene.clone();
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

fn with(name: &str, way: (Coordinates, IntegratorKind)) -> Scene {
    let mut scene = catalogue::scene(name).unwrap();
    (scene.coordinates, scene.simulation.integrator) = way;
    scene
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
    for way in WAYS {
        let scene = with("simple-pendulum", way);
        let mut force = 0.0f64;
        let (error, summary) = compare(&scene, 1e-13, &reference, 10.0, |simulation, row| {
            let bob = simulation.frame().bodies[0];
            let pin = &simulation.multipliers()[0];
            assert_eq!(pin.on, "bob");
            force = force.max(distance(&pin.force, &[row[fx], row[fy], 0.0]));
            let speed = distance(&bob.velocity, &[row[vx], row[vy], 0.0]);
            distance(&bob.position, &[row[x], row[y], 0.0]).max(0.1 * speed)
        });
        accuracy::hold("A01 simple pendulum, 10 s", "m", way, error, &summary);
        assert!(force < 1e-7, "force of the pin {force:e} N");
        trusts(&summary, 1e-8);
    }
}

#[test]
fn a02_double_four_bar_through_its_ten_singular_positions() {
    let reference = Reference::read("a02-four-bar-2");
    let [x, y] = reference.columns(["B0x", "B0y"]);
    let crossings = reference.rows.windows(2).filter(|w| w[0][y] * w[1][y] < 0.0).count();
    assert_eq!(crossings, 10);
    for way in WAYS {
        let scene = with("n-four-bar:2", way);
        let (error, summary) = compare(&scene, 1e-12, &reference, 10.0, |simulation, row| {
            let upright = simulation.frame().bodies[0];
            distance(&point(&upright, [0.5, 0.0, 0.0]), &[row[x], row[y], 0.0])
        });
        let name = "A02 N-four-bar, N = 2, 10 s, ten singular positions";
        accuracy::hold(name, "m", way, error, &summary);
        trusts(&summary, 1e-6);
    }
}

#[test]
fn a02_pins_hold_with_the_forces_of_newton_and_euler() {
    let reference = Reference::read("a02-four-bar-2-pins");
    let [phi] = reference.columns(["phi_from_up"]);
    let columns = reference.columns(["A0_Fx", "A0_Fy", "A1_Fx", "A1_Fy", "A2_Fx", "A2_Fy"]);
    let (error, _) = compare(&with("n-four-bar:2", WAYS[3]), 1e-12, &reference, 10.0, |simulation, row| {
        // The forces have a pole where the links are horizontal.
        if libm::cos(row[phi]).abs() < 0.1 {
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
    for (name, data, allowed, title) in [
        ("free-body", "c01-free-body", 1e-9, "C01 free body, 10 s, rates"),
        // The flip multiplies whatever rounding there is by thousands.
        ("free-body-flip", "c01-free-body-flip", 1e-8, "C01 flip about the middle axis, 10 s, rates"),
    ] {
        let reference = Reference::read(data);
        let rates = reference.columns(["w1_body", "w2_body", "w3_body"]);
        let attitude = reference.columns(["q0", "q1", "q2", "q3"]);
        for way in WAYS {
            let mut turned = 0.0f64;
            let (error, summary) = compare(&with(name, way), 1e-14, &reference, 10.0, |simulation, row| {
                let body = simulation.frame().bodies[0];
                let expected = rates.map(|column| row[column]);
                let [w, x, y, z] = attitude.map(|column| row[column]);
                let q = nalgebra::Quaternion::new(w, x, y, z);
                let frame = nalgebra::UnitQuaternion::from_quaternion(q).to_rotation_matrix().into_inner();
                turned = turned.max(distance(&[body.u, body.v, body.w].concat(), frame.as_slice()));
                distance(&body_rates(&body), &expected) / distance(&expected, &[0.0; 3])
            });
            accuracy::hold(title, "", way, error, &summary);
            assert!(turned < 10.0 * allowed, "{name}: attitude {turned:e}");
            trusts(&summary, 1e-9);
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
    for way in WAYS.into_iter().filter(|way| way.0 != Coordinates::Shared) {
        let (mut body, local) = match way.0 {
            Coordinates::Full => (plain.clone(), [0.3, -0.2, 0.5]),
            _ => (shifted.clone(), [-0.2, -0.3, 0.5]),
        };
        body["name"] = "body".into();
        let scene = serde_json::json!({
            "name": "free-fall", "coordinates": way.0, "bodies": [body],
            "simulation": { "duration": 2, "integrator": way.1 }
        });
        let scene = Scene::from_json(&scene.to_string()).unwrap();
        let (error, summary) = compare(&scene, 1e-13, &reference, 2.0, |simulation, row| {
            let body = simulation.frame().bodies[0];
            distance(&body.position, &centre.map(|column| row[column]))
                .max(distance(&point(&body, local), &path.map(|column| row[column])))
        });
        accuracy::hold("C03 free fall of a tumbling body, 2 s", "m", way, error, &summary);
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
    for way in WAYS {
        let scene = with("spatial-double-pendulum", way);
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
        accuracy::hold("C04 spatial double pendulum, 5 s", "m", way, error, &summary);
        assert!(force < 1e-6, "{force:e} N");
        trusts(&summary, 1e-9);
    }
}

#[test]
fn a04_bricard() {
    let reference = Reference::read("a04-bricard");
    let third = reference.columns(["P3x[m]", "P3y[m]", "P3z[m]"]);
    let fourth = reference.columns(["P4x[m]", "P4y[m]", "P4z[m]"]);
    for way in WAYS {
        let (error, summary) = compare(&with("bricard", way), 1e-11, &reference, 10.0, |simulation, row| {
            // P3 and P4 are the ends of the third bar, which lies along its u.
            let bar = simulation.frame().bodies[2];
            let off = |side: f64, columns: [usize; 3]| {
                distance(&point(&bar, [side, 0.0, 0.0]), &columns.map(|column| row[column]))
            };
            off(-0.5, third).max(off(0.5, fourth))
        });
        accuracy::hold("A04 Bricard, 10 s", "m", way, error, &summary);
    }
}

#[test]
fn b01_spatial_slider_crank_in_three_variants() {
    for (variant, data) in [
        ("file", "b01-slider-crank"),
        ("slender", "b01-slider-crank-slender"),
        ("mbdyn", "b01-slider-crank-mbdyn"),
    ] {
        let reference = Reference::read(data);
        let [s, ds] = reference.columns(["s[m]", "ds[m/s]"]);
        let centre = reference.columns(["rodx[m]", "rody[m]", "rodz[m]"]);
        for way in WAYS {
            let scene = with(&format!("spatial-slider-crank:{variant}"), way);
            let (error, summary) = compare(&scene, 1e-11, &reference, 5.0, |simulation, row| {
                let bodies = simulation.frame().bodies;
                let block =
                    (bodies[2].position[0] - row[s]).abs().max((bodies[2].velocity[0] - row[ds]).abs());
                distance(&bodies[1].position, &centre.map(|column| row[column])).max(block)
            });
            let name = format!("B01 spatial slider-crank \"{variant}\", 5 s");
            accuracy::hold(&name, "m", way, error, &summary);
        }
    }
}

#[test]
fn readme_shows_the_table() {
    if std::env::var_os("TRIAD_WRITE_GOLDEN").is_none() {
        assert_eq!(accuracy::in_readme(), AccuracyTable::read().markdown());
    }
}
