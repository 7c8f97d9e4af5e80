//! Bodies with little or no inertia about an axis: wires, and shafts that joints turn.

#![allow(clippy::unwrap_used)]

use nalgebra::{Rotation3, Vector3};
use serde_json::{Value, json};
use triad_engine::run::{Frame, Simulation};
use triad_engine::scene::{Coordinates, IntegratorKind, Scene};

const WAYS: [IntegratorKind; 3] = [IntegratorKind::Taylor, IntegratorKind::Dop853, IntegratorKind::Radau];

fn run(value: &Value, way: IntegratorKind) -> Simulation {
    let scene = Scene::from_json(&value.to_string()).unwrap().integrator(way);
    let mut run = Simulation::new(&scene).unwrap();
    run.advance_to(1.0).unwrap();
    run
}

/// A wire in a hinge, about which it has hardly any inertia, turned by a motor: ω = M t / I, however thin it is. In space beside a
/// pendulum that does not move.
#[test]
fn a_wire_turns_by_its_own_inertia() {
    for (inertia, turned) in [(1e-5, 1.0), (2e-8, 1.0), (6e-9, 10.0)] {
        for way in WAYS {
            let value = json!({
                "name": "wire", "gravity": [0, 0, 0],
                "bodies": [
                    {"name": "A", "mass": 1, "inertia": {"principal": [0.01, 0.1, 0.1]}, "center_of_mass": [0.5, 0, 0]},
                    {"name": "B", "mass": 1, "inertia": {"principal": [inertia, 1.0 / 12.0, 1.0 / 12.0]}, "position": [1.5, 0, 0]}
                ],
                "joints": [
                    {"name": "p", "type": "revolute", "body_i": "ground", "body_j": "A", "point": [0, 0, 0], "axis": [0, 1, 0]},
                    {"name": "q", "type": "revolute", "body_i": "A", "body_j": "B", "point": [1, 0, 0], "axis": [1, 0, 0]}
                ],
                "loads": [{"name": "m", "type": "torsion", "joint": "q", "torque": turned * inertia}],
                "simulation": {"duration": 1}
            });
            let run = run(&value, way);
            let omega = run.frame().bodies[1].angular_velocity[0];
            assert!((omega.abs() - turned).abs() < 1e-6 * turned, "{inertia:e}, {way}: {omega}");
        }
    }
}

/// A torque turns two wheels that a slender shaft connects by universal joints, bent alike: the shaft has no inertia about its axis, the
/// wheels have some, and little: α = M / 2J.
#[test]
fn a_shaft_without_inertia_about_its_axis_turns_small_wheels() {
    let (sine, cosine) = (libm::sin(0.2), libm::cos(0.2));
    for wheel in [1e-2, 1e-5, 1e-6] {
        for way in WAYS {
            let body = |name: &str, at: f64| json!({"name": name, "mass": 0.1, "inertia": {"principal": [wheel, wheel, wheel]}, "position": [at * cosine, at * sine, 0]});
            let value = json!({
                "name": "cardan", "gravity": [0, 0, 0],
                "bodies": [
                    body("W1", 0.0),
                    {"name": "R", "mass": 1, "inertia": {"principal": [0, 1.0 / 12.0, 1.0 / 12.0]}, "position": [0.5 * cosine, 0.5 * sine, 0],
                     "orientation": {"u": [cosine, sine, 0], "v": [-sine, cosine, 0]}},
                    body("W2", 1.0)
                ],
                "joints": [
                    {"name": "b1", "type": "revolute", "body_i": "ground", "body_j": "W1", "point": [0, 0, 0], "axis": [1, 0, 0]},
                    {"name": "u1", "type": "universal", "body_i": "W1", "body_j": "R", "point": [0, 0, 0], "axes": [[0, 1, 0], [0, 0, 1]]},
                    {"name": "u2", "type": "universal", "body_i": "R", "body_j": "W2", "point": [cosine, sine, 0], "axes": [[0, 0, 1], [0, 1, 0]]},
                    {"name": "b2", "type": "revolute", "body_i": "ground", "body_j": "W2", "point": [cosine, sine, 0], "axis": [1, 0, 0]}
                ],
                "loads": [{"name": "m", "type": "moment", "body": "W1", "moment": [10.0 * wheel, 0, 0]}],
                "simulation": {"duration": 1}
            });
            let run = run(&value, way);
            let omega = run.frame().bodies[0].angular_velocity[0];
            assert!((omega - 5.0).abs() < 1e-7, "{wheel:e}, {way}: {omega}");
        }
    }
}

/// A tensor in numbers has no exact zero: a slender rod that flies keeps turning.
#[test]
fn a_free_rod_whose_tensor_is_rounded_turns() {
    for k in 0..40 {
        let (a, b) = (0.37 * f64::from(k), 0.71 * f64::from(k));
        let axis = [libm::cos(a) * libm::cos(b), libm::sin(a) * libm::cos(b), libm::sin(b)];
        let tensor: Vec<Vec<f64>> = (0..3)
            .map(|i| (0..3).map(|j| 4.5e-5 * (f64::from(u8::from(i == j)) - axis[i] * axis[j])).collect())
            .collect();
        let across = [-axis[1], axis[0], 0.0];
        let value = json!({
            "name": "rod", "gravity": [0, 0, -9.81],
            "bodies": [{"name": "A", "mass": 1, "inertia": {"tensor": tensor}, "angular_velocity": across}],
            "simulation": {"duration": 1}
        });
        for way in WAYS {
            let run = run(&value, way);
            let omega = Vector3::from(run.frame().bodies[0].angular_velocity);
            // About its own axis nothing says how it turns.
            let (axis, across) = (Vector3::from(axis), Vector3::from(across));
            let turned = Rotation3::new(across) * axis;
            let off = (omega - turned * turned.dot(&omega) - across).norm();
            assert!(off < 1e-6, "{k}, {way}: {off:e}");
        }
    }
}

/// A scene to 5 s by rows of 0.25 s, each looked at with the largest error of angular velocities that has been told.
fn rows(value: &Value, way: IntegratorKind, look: impl Fn(f64, &Frame, f64)) {
    for coordinates in [Coordinates::Full, Coordinates::Reduced] {
        let mut scene = Scene::from_json(&value.to_string()).unwrap().integrator(way);
        scene.coordinates = coordinates;
        rows_of(&scene, way, &look);
    }
}

fn rows_of(scene: &Scene, way: IntegratorKind, look: impl Fn(f64, &Frame, f64)) {
    let mut run = Simulation::new(scene).unwrap();
    let mut told = 0.0f64;
    for row in 0..=20 {
        let time = 0.25 * f64::from(row);
        run.advance_to(time).unwrap();
        told = told.max(run.error_estimate().unwrap().angular_velocity);
        assert!(told < 1e-5, "{way} at {time}: {told:e}");
        look(time, &run.frame(), told);
    }
}

/// A slender rod that flies turns about its angular momentum, and its spin about its own axis, which has no inertia, stays what it is: the
/// series lost it after a second.
#[test]
fn a_thrown_rod_keeps_its_spin() {
    let value = json!({
        "name": "rod", "gravity": [0, -9.81, 0],
        "bodies": [{"name": "rod", "mass": 1, "inertia": {"principal": [0, 1.0 / 12.0, 1.0 / 12.0]}, "velocity": [1, 5, 0], "angular_velocity": [3, 2, 1]}],
        "simulation": {"duration": 5}
    });
    for way in WAYS {
        rows(&value, way, |time, frame, told| {
            let (u, omega) =
                (Vector3::from(frame.bodies[0].u), Vector3::from(frame.bodies[0].angular_velocity));
            let turned = Rotation3::new(Vector3::new(0.0, 2.0, 1.0) * time) * Vector3::x();
            assert!((u - turned).norm() < 1e-7, "{way} at {time}: {u}");
            let off = (omega.dot(&u) - 3.0).abs();
            assert!(off < 5.0 * told + 1e-9, "{way} at {time}: off by {off:e}, told {told:e}");
        });
    }
}

/// A point mass on a ball joint, on a cone: Ω² = g / (l cos θ), the angular velocity along the cone's axis, part of which is about the
/// string, where the mass has no inertia.
#[test]
fn a_conical_pendulum_stays_on_its_cone() {
    let omega = (9.81f64 / 0.8).sqrt();
    let value = json!({
        "name": "cone",
        "bodies": [{"name": "bob", "mass": 1, "center_of_mass": [0.6, 0, -0.8], "angular_velocity": [0, 0, omega]}],
        "joints": [{"name": "string", "type": "spherical", "body_i": "ground", "body_j": "bob", "point": [0, 0, 0]}],
        "simulation": {"duration": 5}
    });
    for way in WAYS {
        rows(&value, way, |time, frame, told| {
            let turned = Rotation3::new(Vector3::z() * (omega * time)) * Vector3::new(0.6, 0.0, -0.8);
            let (place, turns) =
                (Vector3::from(frame.bodies[0].position), Vector3::from(frame.bodies[0].angular_velocity));
            assert!((place - turned).norm() < 1e-6, "{way} at {time}: {place}");
            let off = (turns - Vector3::z() * omega).norm();
            assert!(off < 5.0 * told + 1e-7, "{way} at {time}: off by {off:e}, told {told:e}");
        });
    }
}

/// The same in a plane: a point mass that spins on a pin at the end of a pendulum.
#[test]
fn a_point_mass_spins_on_at_the_end_of_a_pendulum() {
    let pin = |name: &str, i: &str, j: &str, x: f64| json!({"name": name, "type": "revolute", "body_i": i, "body_j": j, "point": [x, 0, 0], "axis": [0, 0, 1]});
    let value = json!({
        "name": "spins", "gravity": [0, -9.81, 0],
        "bodies": [
            {"name": "arm", "mass": 1, "inertia": {"principal": [0.02, 0.09, 0.1]}, "position": [0.4, 0, 0]},
            {"name": "bob", "mass": 2, "position": [1, 0, 0], "angular_velocity": [0, 0, 5]}
        ],
        "joints": [pin("hinge", "ground", "arm", 0.0), pin("pin", "arm", "bob", 1.0)],
        "simulation": {"duration": 5}
    });
    for way in WAYS {
        rows(&value, way, |time, frame, told| {
            let off = (frame.bodies[1].angular_velocity[2] - 5.0).abs();
            assert!(off < 5.0 * told + 1e-9, "{way} at {time}: off by {off:e}, told {told:e}");
        });
    }
}

/// What a moment does to a body without inertia about its axis is not determined, or by next to nothing: the run is refused, or ends where the
/// moment begins.
#[test]
fn a_moment_that_nothing_answers_to_is_refused() {
    let rod = |inertia: f64, moment: Value| {
        json!({
            "name": "rod", "gravity": [0, 0, 0],
            "bodies": [{"name": "rod", "mass": 1, "inertia": {"principal": [inertia, 1.0 / 12.0, 1.0 / 12.0]}, "position": [0.5, 0, 0]}],
            "joints": [{"name": "ball", "type": "spherical", "body_i": "ground", "body_j": "rod", "point": [0, 0, 0]}],
            "loads": [{"name": "twist", "type": "moment", "body": "rod", "frame": "body", "moment": moment}],
            "simulation": {"duration": 1}
        })
    };
    let about_axis = json!([0.1, 0, 0]);
    let later = json!({"kind": "components", "x": {"kind": "smooth-step", "from": 0, "to": 0.1, "start": 0.2, "end": 0.4}, "y": 0, "z": 0});
    let across = json!([0, 0.1, 0.05]);
    for way in WAYS {
        let run = |inertia: f64, moment: &Value| {
            let scene = Scene::from_json(&rod(inertia, moment.clone()).to_string()).unwrap().integrator(way);
            Simulation::new(&scene).and_then(|mut run| run.advance_to(1.0).map(|()| run))
        };
        for inertia in [0.0, 1e-12] {
            assert_eq!(run(inertia, &about_axis).unwrap_err().code(), "nothing-holds", "{inertia:e}, {way}");
            assert_eq!(run(inertia, &later).unwrap_err().code(), "nothing-holds", "{inertia:e}, {way}");
            assert!(run(inertia, &across).is_ok(), "{inertia:e}, {way}");
        }
        let turned = run(1e-3, &about_axis).unwrap().frame().bodies[0].angular_velocity;
        assert!((turned[0] - 100.0).abs() < 1e-4, "{way}: {turned:?}");
    }
}

/// A slender rod and a body on a universal joint at its end, whose common spin nothing determines; the rod's other end is free, held, or
/// carried about. Both have arms of half a metre, so that they are lent as much, and `inertia` besides about every axis.
fn on_a_universal_joint(held: &str, second: [f64; 3], inertia: f64) -> Value {
    let with = |principal: [f64; 3]| principal.map(|own| own + inertia);
    let (sine, cosine) = (libm::sin(0.5), libm::cos(0.5));
    let ball =
        json!({"name": "ball", "type": "spherical", "body_i": "ground", "body_j": "a", "point": [0, 0, 0]});
    let carried = json!({"name": "ball", "type": "point", "body": "a", "point": [-0.5, 0, 0], "motion": {
        "kind": "components", "x": {"kind": "harmonic", "mean": 0, "amplitude": 0.1, "frequency": 2.0}, "y": 0, "z": 0}});
    let universal = json!({"name": "cross", "type": "universal", "body_i": "a", "body_j": "b", "point": [1, 0, 0], "axes": [[0, 1, 0], [sine, 0, cosine]]});
    json!({
        "name": "shared",
        "bodies": [
            {"name": "a", "mass": 1, "inertia": {"principal": with([0.0, 1.0 / 12.0, 1.0 / 12.0])}, "position": [0.5, 0, 0], "angular_velocity": [4, 0, 1]},
            {"name": "b", "mass": 1, "inertia": {"principal": with(second)}, "center_of_mass": [0.5, 0, 0], "position": [1, 0, 0],
             "orientation": {"axis": [0, 1, 0], "angle": 0.5}, "angular_velocity": [2, 1, -1]}
        ],
        "joints": if held == "held" { json!([ball, universal]) } else { json!([universal]) },
        "drivers": if held == "carried" { json!([carried]) } else { json!([]) },
        "simulation": {"duration": 1.5}
    })
}

/// Where bodies without inertia about their axes turn together, and the direction of that turns in them, all integrators find the motion of
/// ever smaller inertia, and the series tell their error: they were off by 0.05 and told 1e-4.
#[test]
fn a_motion_that_bodies_share_is_that_of_ever_smaller_inertia() {
    let end = |value: &Value, way: IntegratorKind, tolerance: f64| {
        let scene = Scene::from_json(&value.to_string()).unwrap().integrator(way).tolerance(tolerance);
        let mut run = Simulation::new(&scene).unwrap();
        run.advance_to(1.5).unwrap();
        let told = run.error_estimate().unwrap();
        assert_eq!(run.summary().doubts, Vec::<String>::new());
        (run.q().to_vec(), told)
    };
    let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
    for held in ["free", "held", "carried"] {
        for second in [[0.0, 1.0 / 12.0, 1.0 / 12.0], [0.0; 3]] {
            let without = on_a_universal_joint(held, second, 0.0);
            let (exact, _) = end(&without, IntegratorKind::Dop853, 1e-12);
            for tolerance in [1e-6, 1e-9] {
                let (found, told) = end(&without, IntegratorKind::Taylor, tolerance);
                let off = apart(&found, &exact);
                assert!(
                    off < 5.0 * told.turn.max(told.position) + 1e-9,
                    "{held} {second:?}: off by {off:e}, told {told:?}"
                );
                assert!(off < 300.0 * tolerance, "{held} {second:?}: off by {off:e}");
            }
            let (radau, _) = end(&without, IntegratorKind::Radau, 1e-11);
            assert!(apart(&radau, &exact) < 1e-7, "{held} {second:?}");
            let [more, less] = [1e-5, 1e-6].map(|inertia| {
                let with = on_a_universal_joint(held, second, inertia);
                apart(&end(&with, IntegratorKind::Taylor, 1e-10).0, &exact)
            });
            assert!(
                less < 2e-3 && (5.0..20.0).contains(&(more / less)),
                "{held} {second:?}: {more:e}, {less:e}"
            );
        }
    }
}

/// A slender rod that flies on a spring at its middle: its angular momentum is a constant vector. Bodies that nothing joins to others ended
/// the iteration that returns their lent inertia after three steps: off by 2e-7 with dop853.
#[test]
fn a_rod_on_a_spring_at_its_middle_keeps_its_angular_momentum() {
    let value = json!({
        "name": "rod", "gravity": [0, -9.81, 0],
        "bodies": [{"name": "rod", "mass": 0.9, "inertia": {"principal": [0, 0.04, 0.04]}, "position": [0.3, 0, 0], "angular_velocity": [-3, 4, 1.5]}],
        "loads": [{"name": "s", "type": "spring", "body_i": "ground", "body_j": "rod", "point_i": [-1.95, 0.13, 1.62], "point_j": [0, 0, 0],
                   "stiffness": 50, "damping": 2, "free_length": 0.1}],
        "simulation": {"duration": 5, "tolerance": 1e-11}
    });
    for way in WAYS {
        rows(&value, way, |time, frame, _| {
            let (u, omega) =
                (Vector3::from(frame.bodies[0].u), Vector3::from(frame.bodies[0].angular_velocity));
            let across = omega - u * omega.dot(&u);
            let off = (across - Vector3::new(0.0, 4.0, 1.5)).norm();
            assert!(off < 1e-9, "{way} at {time}: off by {off:e}");
        });
    }
}

/// Two slender rods on an oblique hinge, which come to where a turn about the hinge and their own axes moves no mass: what they do there
/// depends on inertia that the scene leaves out. The run says so, or why it ends.
#[test]
fn a_motion_without_inertia_is_told() {
    let rod = |name: &str, inertia: f64, more: Value| {
        let mut body = json!({"name": name, "inertia": {"principal": [0, inertia, inertia]}});
        body.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        body
    };
    let value = json!({
        "name": "oblique", "gravity": [0, 0, 0],
        "bodies": [
            rod("a", 0.096, json!({"mass": 1.38, "orientation": {"u": [0.3414, -0.256, -0.9044], "v": [-0.4623, -0.8835, 0.0756]},
                "center_of_mass": [0.457, 0, 0], "angular_velocity": [-0.13, -4.97, -4.61]})),
            rod("b", 0.0226, json!({"mass": 1.57, "position": [0.3118, -0.2338, -0.826], "orientation": {"u": [-0.7727, -0.4006, 0.4924], "v": [0.3885, -0.9119, -0.1324]},
                "center_of_mass": [0.207, 0, 0], "angular_velocity": [1.34, 3.01, 0.56]}))
        ],
        "joints": [{"name": "hinge", "type": "revolute", "body_i": "a", "body_j": "b", "point": [0.3118, -0.2338, -0.826], "axis": [0.6285, 0.0502, -0.7762]}],
        "simulation": {"duration": 0.1}
    });
    for way in WAYS {
        let scene = Scene::from_json(&value.to_string()).unwrap().integrator(way);
        let mut run = Simulation::new(&scene).unwrap();
        let told = match run.advance_to(0.1) {
            Ok(()) => run.summary().doubts.concat(),
            Err(error) => format!("{error} {}", error.hint()),
        };
        assert!(told.contains("joints lend \"a\", \"b\" next to no inertia"), "{way}: {told}");
        assert!(
            told.contains("inertia about every axis") || told.contains("some about every axis"),
            "{way}: {told}"
        );
    }
}
