//! Degrees of freedom and redundant rows, which every command must count alike, whatever the bodies weigh.

#![allow(clippy::unwrap_used, reason = "tests may panic, and write numbers as they were computed elsewhere")]

use serde_json::json;
use triad_engine::analysis::check::check;
use triad_engine::analysis::{ModesAbout, modes};
use triad_engine::reactions::report::Convention;
use triad_engine::run::Simulation;
use triad_engine::scene::{ConstraintMethod, Coordinates, IntegratorKind, Scene};

/// Links of 1, 1.5 and 1 m on a ground of 2 m, of rods of 1 kg/m with a moment about their own axis, the crank at an angle.
fn four_bar(crank: f64, axial: f64, coordinates: Coordinates) -> Scene {
    with_coupler(1.5, crank, axial, coordinates)
}

fn with_coupler(coupler: f64, crank: f64, axial: f64, coordinates: Coordinates) -> Scene {
    let (a, d) = ([libm::cos(crank), libm::sin(crank)], [2.0, 0.0]);
    // B is the length of the coupler away from A, and 1 m from D.
    let between = [d[0] - a[0], d[1] - a[1]];
    let distance = libm::hypot(between[0], between[1]);
    let along = (coupler * coupler - 1.0 + distance * distance) / (2.0 * distance);
    let across = (coupler * coupler - along * along).max(0.0).sqrt();
    let unit = between.map(|x| x / distance);
    let b = [a[0] + along * unit[0] - across * unit[1], a[1] + along * unit[1] + across * unit[0]];
    let link = |name: &str, from: [f64; 2], to: [f64; 2]| {
        let length = libm::hypot(to[0] - from[0], to[1] - from[1]);
        let [x, y] = [0, 1].map(|k| (to[k] - from[k]) / length);
        let (half, moment) = (length / 2.0, length * length * length / 12.0);
        format!(
            r#"{{"name": "{name}", "mass": {length}, "inertia": {{"principal": [{axial}, {moment}, {moment}]}},
              "position": [{}, {}, 0], "orientation": {{"u": [{x}, {y}, 0], "v": [{}, {x}, 0]}}, "center_of_mass": [{half}, 0, 0]}}"#,
            from[0], from[1], -y
        )
    };
    let pin = |name: &str, i: &str, j: &str, at: [f64; 2]| {
        format!(
            r#"{{"name": "{name}", "type": "revolute", "body_i": "{i}", "body_j": "{j}", "point": [{}, {}, 0], "axis": [0, 0, 1]}}"#,
            at[0], at[1]
        )
    };
    let (bodies, joints) = (
        [link("crank", [0.0; 2], a), link("coupler", a, b), link("rocker", d, b)].join(","),
        [
            pin("O", "ground", "crank", [0.0; 2]),
            pin("A", "crank", "coupler", a),
            pin("B", "coupler", "rocker", b),
            pin("D", "ground", "rocker", d),
        ]
        .join(","),
    );
    let text = format!(
        r#"{{"name": "four-bar", "gravity": [0, -9.81, 0], "bodies": [{bodies}], "joints": [{joints}],
            "simulation": {{"duration": 0.02, "every": 0.01}}}}"#
    );
    let mut scene = Scene::from_json(&text).unwrap();
    scene.coordinates = coordinates;
    scene
}

const AXIAL: [f64; 6] = [0.0, 1e-12, 1e-9, 1e-6, 1e-4, 1e-2];

/// Start angles all around the part that the crank reaches.
fn angles(count: usize) -> impl Iterator<Item = f64> {
    (0..count).map(move |k| 1.85 * (2.0 * (k as f64 + 0.5) / count as f64 - 1.0))
}

#[test]
fn a_four_bar_of_thin_rods_has_one_freedom_and_three_redundant_rows() {
    for axial in AXIAL {
        for coordinates in [Coordinates::Full, Coordinates::Reduced, Coordinates::Shared] {
            for crank in angles(24) {
                let scene = four_bar(crank, axial, coordinates);
                let at = format!("{axial} {coordinates:?} {crank}");
                let found = check(&scene).unwrap();
                assert_eq!(found.degrees_of_freedom, 1, "{at}");
                assert!(found.notes.iter().all(|note| !note.contains("singular")), "{at} {:?}", found.notes);
                let run = Simulation::new(&scene).unwrap();
                assert_eq!(
                    (run.rank().rank, run.rank().lost_at_start(), run.rank().dependent.len()),
                    (17, 0, 3),
                    "{at}"
                );
            }
        }
    }
}

#[test]
fn reactions_and_modes_count_as_the_check_does() {
    for axial in AXIAL {
        for crank in angles(4) {
            let scene = four_bar(crank, axial, Coordinates::Full);
            let report = Simulation::new(&scene).unwrap().reactions(Convention::default()).unwrap();
            let rows: usize = report.redundancies.iter().map(|set| set.rows).sum();
            assert_eq!(rows, 3, "{axial} {crank}");
            let found = modes(&scene, ModesAbout::Start).unwrap();
            assert_eq!((found.freedoms, found.left_out, found.modes.len()), (1, 0, 1), "{axial} {crank}");
        }
    }
}

#[test]
fn methods_in_independent_coordinates_start_on_thin_rods() {
    for axial in AXIAL {
        for crank in angles(6) {
            let mut scene = four_bar(crank, axial, Coordinates::Full);
            for partitioning in [false, true] {
                if partitioning {
                    scene.simulation.integrator = IntegratorKind::Auto;
                    scene.simulation.constraint_method = ConstraintMethod::Partitioning;
                } else {
                    scene.simulation.integrator = IntegratorKind::Radau;
                }
                let mut run = Simulation::new(&scene).unwrap();
                run.advance_to(0.02)
                    .unwrap_or_else(|error| panic!("{axial} {crank} {partitioning}: {error}"));
            }
            scene.simulation.constraint_method = ConstraintMethod::Projection;
        }
    }
}

/// A parallelogram that lies flat can leave this position as an antiparallelogram as well.
#[test]
fn singular_starts_stay_found() {
    for axial in AXIAL {
        let scene = with_coupler(2.0, 0.0, axial, Coordinates::Full);
        let found = check(&scene).unwrap();
        assert_eq!(found.degrees_of_freedom, 1, "{axial}");
        assert!(found.notes.iter().any(|note| note.contains("singular")), "{axial} {:?}", found.notes);
    }
}

/// A door on two hinges, the axis of the second off that of the first by an angle.
fn door(off: f64) -> Scene {
    let text = format!(
        r#"{{"name": "door", "gravity": [0, -9.81, 0], "simulation": {{"duration": 1}},
            "bodies": [{{"name": "leaf", "mass": 1, "inertia": {{"principal": [0.1, 0.2, 0.15]}}, "center_of_mass": [0.5, 0, 0.4]}}],
            "joints": [
              {{"name": "lower", "type": "revolute", "body_i": "ground", "body_j": "leaf", "point": [0, 0, 0], "axis": [0, 0, 1]}},
              {{"name": "upper", "type": "revolute", "body_i": "ground", "body_j": "leaf", "point": [0, 0, 1], "axis": [0, {off:e}, 1]}}]}}"#
    );
    Scene::from_json(&text).unwrap()
}

const INTEGRATORS: [IntegratorKind; 3] =
    [IntegratorKind::Taylor, IntegratorKind::Dop853, IntegratorKind::Radau];

/// What the check counts as free moves, by every integrator alike, and what is taken for rounding is told.
#[test]
fn a_door_swings_on_hinges_that_are_hardly_misaligned() {
    let angle = |off: f64, integrator: IntegratorKind| {
        let mut scene = door(off);
        scene.simulation.integrator = integrator;
        let mut run = Simulation::new(&scene).unwrap();
        run.advance_to(1.0).unwrap();
        let told = run.notes().iter().any(|note| note.contains("holds what others hold, but not exactly"));
        assert_eq!(told, off > 1e-11, "{off} {integrator} {:?}", run.notes());
        let u = run.frame().bodies[0].u;
        libm::atan2(u[1], u[0])
    };
    let exact = angle(0.0, IntegratorKind::Taylor);
    assert!(exact.abs() > 1.0, "{exact}");
    for off in [1e-13, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7] {
        assert_eq!(check(&door(off)).unwrap().degrees_of_freedom, 1, "{off}");
        for integrator in INTEGRATORS {
            let found = angle(off, integrator);
            assert!((found - exact).abs() < 1e-7 + off * off * 1e11, "{off} {integrator}: {found} {exact}");
        }
    }
}

/// Where nothing moves, velocities are rounding, and what their energies differ by says nothing.
#[test]
fn a_mechanism_at_rest_raises_no_doubt() {
    for integrator in [IntegratorKind::Radau, IntegratorKind::Dop853] {
        let mut scene = four_bar(0.7, 1e-3, Coordinates::Full);
        scene.gravity = [0.0; 3];
        scene.simulation.integrator = integrator;
        let mut run = Simulation::new(&scene).unwrap();
        run.advance_to(0.02).unwrap();
        assert_eq!(run.summary().doubts, [""; 0], "{integrator}");
    }
}

/// A door whose hinges are misaligned so much that it is locked: rows that hold by a small gradient let velocities of rounding through, whose
/// energy came from nowhere, 1e4 times the largest.
#[test]
fn a_locked_door_raises_no_doubt() {
    for integrator in [IntegratorKind::Taylor, IntegratorKind::Radau, IntegratorKind::Dop853] {
        let hinge = |name: &str, height: f64, lean: f64| json!({"name": name, "type": "revolute", "body_i": "ground", "body_j": "leaf", "point": [0, 0, height], "axis": [0, lean, 1]});
        let value = json!({
            "name": "door",
            "gravity": [0, -9.81, 0],
            "bodies": [{"name": "leaf", "mass": 1, "inertia": {"principal": [0.1, 0.2, 0.15]}, "center_of_mass": [0.5, 0, 0.4]}],
            "joints": [hinge("lower", 0.0, 0.0), hinge("upper", 1.0, 1e-4)],
            "simulation": {"duration": 1, "tolerance": 1e-8}
        });
        let scene = Scene::from_json(&value.to_string()).unwrap().integrator(integrator);
        let mut run = Simulation::new(&scene).unwrap();
        run.advance_to(1.0).unwrap();
        assert_eq!(run.summary().doubts, [""; 0], "{integrator}");
    }
}
