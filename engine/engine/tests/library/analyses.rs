//! Equilibrium, modes, kinematics, inverse dynamics and assembly against closed forms.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests may panic")]

use nalgebra::{Matrix2, Vector3};
use serde_json::json;
use triad_engine::analysis::check::{check, check_while};
use triad_engine::analysis::{
    AnalysisError, ModesAbout, Wanted, assemble_while, equilibrium, equilibrium_while, kinematics,
    kinematics_while, modes, modes_while,
};
use triad_engine::catalogue;
use triad_engine::reactions::report::{Convention, ExpressedIn};
use triad_engine::run::Simulation;
use triad_engine::scene::{Coordinates, Driver, Motion, Scene};

pub fn near(a: f64, b: f64, tolerance: f64, what: &str) {
    assert!((a - b).abs() <= tolerance * b.abs().max(1.0), "{what}: {a} instead of {b}");
}

#[test]
fn a_pendulum_comes_to_rest_below_its_pin() {
    for coordinates in [Coordinates::Full, Coordinates::Reduced] {
        let mut scene = catalogue::scene("simple-pendulum").unwrap();
        scene.coordinates = coordinates;
        let found = equilibrium(&scene).unwrap();
        let [x, y, z] = found.bodies[0].position;
        assert!(x.abs() < 1e-9 && (y + 1.0).abs() < 1e-9 && z.abs() < 1e-9, "{x} {y} {z}");
        assert_eq!(found.stable, Some(true));
        // m g / L of a point on a circle; the turn of 1 rad for each metre counts as much as the metre.
        near(found.least_stiffness, 9.81 / 2.0, 1e-6, "stiffness");
        near(found.reactions.reactions[0].force[1].value, 9.81, 1e-9, "pull of the pin");
        let found = modes(&scene, ModesAbout::Equilibrium).unwrap();
        assert_eq!((found.freedoms, found.modes.len()), (1, 1));
        near(found.modes[0].frequency, 9.81f64.sqrt() / std::f64::consts::TAU, 1e-8, "frequency");
        assert_eq!(found.modes[0].kind, "oscillates");
        assert!((found.modes[0].shape[0].translation[0].abs() - 1.0).abs() < 1e-9);
    }
}

#[test]
fn what_nobody_waits_for_any_more_ends_before_its_next_step() {
    let (pendulum, driven) =
        ["simple-pendulum", "crank-rocker"].map(|name| catalogue::scene(name).unwrap()).into();
    let wanted = Wanted::default();
    assert!(equilibrium_while(&pendulum, &wanted).is_ok());
    // A crank that is told to stand elsewhere than its coupler takes it up again.
    let mut open = driven.clone();
    open.bodies[0].position[1] += 0.05;
    assert!(assemble_while(&open, &[], &wanted).unwrap().iterations > 0);
    assert_eq!(check_while(&open, &wanted).unwrap(), check(&open).unwrap());
    wanted.no_longer();
    let ended = [
        equilibrium_while(&pendulum, &wanted).unwrap_err(),
        modes_while(&pendulum, ModesAbout::Equilibrium, &wanted).unwrap_err(),
        modes_while(&pendulum, ModesAbout::Steady, &wanted).unwrap_err(),
        kinematics_while(&driven, Convention::default(), &wanted).unwrap_err(),
        assemble_while(&open, &[], &wanted).unwrap_err(),
        check_while(&open, &wanted).unwrap_err(),
    ];
    assert!(ended.iter().all(|error| *error == AnalysisError::NoLongerWanted), "{ended:?}");
}

/// A free body has no equilibrium, and is refused with the reason.
#[test]
fn a_falling_body_has_no_equilibrium() {
    let error = equilibrium(&catalogue::scene("free-fall").unwrap()).unwrap_err();
    assert!(matches!(&error, AnalysisError::NoEquilibrium { body, .. } if body == "body"), "{error}");
}

/// The generalized eigenvalues of two rods hanging from each other, found by hand; each swings in two planes, and each
/// cylinder can spin freely about its own axis.
#[test]
fn a_double_pendulum_swings_in_its_two_modes() {
    let scene = catalogue::scene("spatial-double-pendulum").unwrap();
    let found = modes(&scene, ModesAbout::Equilibrium).unwrap();
    let (m, l, i, g) = (1.0, 1.0, 0.083_958_333_333_333_33, 9.81);
    let mass =
        Matrix2::new(i + m * l * l / 4.0 + m * l * l, m * l * l / 2.0, m * l * l / 2.0, i + m * l * l / 4.0);
    let stiffness = Matrix2::new(g * (m * l / 2.0 + m * l), 0.0, 0.0, g * m * l / 2.0);
    let a = mass.try_inverse().unwrap() * stiffness;
    let (half, det): (f64, f64) = (a.trace() / 2.0, a.determinant());
    let squares = [half - (half * half - det).sqrt(), half + (half * half - det).sqrt()];
    let frequencies: Vec<f64> = found.modes.iter().map(|m| m.frequency).collect();
    let expected = [0.0, 0.0, squares[0], squares[0], squares[1], squares[1]];
    for (f, square) in frequencies.iter().zip(expected) {
        near(*f, square.sqrt() / std::f64::consts::TAU, 1e-7, "frequency");
    }
    assert_eq!(found.modes[0].kind, "drifts");
}

/// Ziegler's column, masses 2 and 1 kg at the ends of two rods of 1 m with springs of 1 N m, pressed by a force that follows the second:
/// it flutters from P = 3.5 − √2 N on, though its stiffness is not positive from P = 2 on, and of other masses flutters where it is.
#[test]
fn a_position_that_is_pressed_by_a_follower_is_judged_by_the_growth_of_its_motions() {
    let column = |masses: [f64; 2], force: f64, damping: f64| {
        let value = json!({
            "name": "column",
            "gravity": [0, 0, 0],
            "bodies": [
                {"name": "a", "mass": masses[0], "center_of_mass": [1, 0, 0], "position": [0, 0, 0]},
                {"name": "b", "mass": masses[1], "center_of_mass": [1, 0, 0], "position": [1, 0, 0]}
            ],
            "joints": [
                {"name": "O", "type": "revolute", "body_i": "ground", "body_j": "a", "point": [0, 0, 0], "axis": [0, 0, 1]},
                {"name": "A", "type": "revolute", "body_i": "a", "body_j": "b", "point": [1, 0, 0], "axis": [0, 0, 1]}
            ],
            "loads": [
                {"type": "torsion", "name": "k1", "joint": "O", "stiffness": 1, "damping": damping},
                {"type": "torsion", "name": "k2", "joint": "A", "stiffness": 1},
                {"type": "force", "name": "P", "body": "b", "point": [1, 0, 0], "force": [-force, 0, 0], "frame": "body"}
            ]
        });
        let scene = Scene::from_json(&value.to_string()).unwrap();
        let found = equilibrium(&scene).unwrap();
        let grows = modes(&scene, ModesAbout::Start).unwrap().modes.iter().any(|mode| mode.kind == "grows");
        (found.stable, grows, found.notes)
    };
    let flutter = 3.5 - f64::sqrt(2.0);
    for (force, stable) in
        [(1.0, true), (2.05, true), (0.999 * flutter, true), (1.001 * flutter, false), (3.0, false)]
    {
        let (told, grows, notes) = column([2.0, 1.0], force, 0.0);
        assert_eq!((told, grows), (Some(stable), !stable), "{force} N");
        assert!(notes.iter().any(|note| note.contains("no potential")), "{notes:?}");
    }
    // Damping may make it grow before: that is for the modes to tell.
    assert_eq!(column([2.0, 1.0], 1.9, 0.1).0, None);
}

/// A bob of 1 g below a crane of 100 t on its rail, held by a spring: its weight is nothing beside the crane's, but all that moves it.
#[test]
fn a_light_body_below_a_heavy_one_comes_to_rest_as_well() {
    for (crane, bob) in [(1e5, 1e-3), (1e6, 1e-6)] {
        let value = json!({
            "name": "crane",
            "gravity": [0, -9.81, 0],
            "bodies": [
                {"name": "crane", "mass": crane, "position": [0, 0, 0]},
                {"name": "bob", "mass": bob, "position": [0, -1, 0]}
            ],
            "joints": [
                {"name": "rail", "type": "prismatic", "body_i": "ground", "body_j": "crane", "point": [0, 0, 0], "axis": [1, 0, 0]},
                {"name": "pin", "type": "revolute", "body_i": "crane", "body_j": "bob", "point": [0, 0, 0], "axis": [0, 0, 1],
                 "start": {"angle": 0.3}}
            ],
            "loads": [{"type": "slider", "name": "k", "joint": "rail", "stiffness": 1000}]
        });
        let found = equilibrium(&Scene::from_json(&value.to_string()).unwrap()).unwrap();
        let [x, y, _] = found.bodies[1].position;
        assert!(x.abs() < 1e-9 / bob && (y + 1.0).abs() < 1e-6, "{bob} kg: {x} {y}");
        assert_eq!(found.stable, Some(true), "{bob} kg: {:?}", found.notes);
    }
}

/// Upright, the N-four-bar leaves its position at √κ; the equilibrium there is found and called unstable.
#[test]
fn the_upright_four_bar_falls_at_its_known_rate() {
    let scene = catalogue::scene("n-four-bar:2").unwrap();
    let found = modes(&scene, ModesAbout::Start).unwrap();
    assert_eq!((found.freedoms, found.modes[0].kind), (1, "grows"));
    near(found.modes[0].growth, 11.445f64.sqrt(), 1e-7, "rate");
    assert_eq!(found.notes.len(), 1);
    assert_eq!(equilibrium(&scene).unwrap().stable, Some(false));
}

/// Bricard's loop comes to rest where a run with the same start keeps still.
#[test]
fn the_bricard_loop_rests_in_its_equilibrium() {
    let found = equilibrium(&catalogue::scene("bricard").unwrap()).unwrap();
    assert_eq!(found.stable, Some(true));
    let mut scene = catalogue::scene("bricard").unwrap();
    scene.simulation.duration = 1.25;
    let mut run = Simulation::new(&scene).unwrap();
    let lowest =
        |bodies: &[triad_engine::state::BodyFrame]| -> f64 { bodies.iter().map(|b| b.position[1]).sum() };
    let rest = lowest(&found.bodies);
    for k in 0..=50 {
        run.advance_to(f64::from(k) * 0.025).unwrap();
        assert!(lowest(&run.frame().bodies) > rest - 1e-9, "a run gets lower than the equilibrium");
    }
    let mut scale: f64 = 0.0;
    for reaction in &found.reactions.reactions {
        scale = scale.max(reaction.force.iter().fold(0.0, |a, c| a.max(c.value.abs())));
    }
    assert!(found.residual < 1e-8 * scale, "{}", found.residual);
}

/// I θ̈ + c θ̇ + (k + m g l) θ = 0.
#[test]
fn a_damped_pendulum_has_its_known_eigenvalue() {
    let text = |damping: f64| {
        format!(
            r#"{{"name": "damped", "gravity": [0, -9.81, 0],
             "bodies": [{{"name": "bar", "mass": 2, "inertia": {{"principal": [0.1, 0.2, 0.2]}}, "position": [0.1, -0.7, 0]}}],
             "joints": [{{"name": "pin", "type": "revolute", "body_i": "ground", "body_j": "bar", "point_i": [0, 0, 0], "point_j": [0, 0.75, 0], "axis": [0, 0, 1]}}],
             "loads": [{{"type": "torsion", "name": "damper", "joint": "pin", "damping": {damping}}}]}}"#
        )
    };
    let (inertia, weight) = (0.2 + 2.0 * 0.75 * 0.75, 2.0 * 9.81 * 0.75);
    let natural = f64::sqrt(weight / inertia);
    for damping in [0.9, 30.0] {
        let found = modes(&Scene::from_json(&text(damping)).unwrap(), ModesAbout::Equilibrium).unwrap();
        let half = damping / (2.0 * inertia);
        if half < natural {
            let [mode] = found.modes.as_slice() else { panic!("{:?}", found.modes) };
            assert_eq!(mode.kind, "oscillates");
            near(mode.growth, -half, 1e-7, "decay");
            near(
                mode.frequency * std::f64::consts::TAU,
                (natural * natural - half * half).sqrt(),
                1e-7,
                "turning",
            );
            near(mode.damping_ratio, half / natural, 1e-7, "ratio");
        } else {
            let mut rates: Vec<f64> = found.modes.iter().map(|m| m.growth).collect();
            rates.sort_by(f64::total_cmp);
            let root = (half * half - natural * natural).sqrt();
            near(rates[0], -half - root, 1e-7, "fast decay");
            near(rates[1], -half + root, 1e-7, "slow decay");
        }
    }
}

fn driven(scene: &str, joint: &str, motion: Motion) -> Scene {
    let mut scene = catalogue::scene(scene).unwrap();
    scene.drivers.push(Driver::Angle { name: "motor".to_owned(), joint: joint.to_owned(), motion });
    scene
}

/// The crank driven through several turns: the block's place, velocity and acceleration are geometry, and the motor's
/// power is the change of energy.
#[test]
fn the_driven_slider_crank_is_geometry_and_its_motor_pays_for_the_energy() {
    let mut scene = driven("spatial-slider-crank", "A", Motion::Ramp { start: 0.0, rate: 6.0 });
    scene.simulation.duration = 2.0;
    scene.simulation.every = 0.005;
    let convention = Convention { expressed_in: ExpressedIn::Joint, ..Convention::default() };
    let found = kinematics(&scene, convention).unwrap();
    assert_eq!(found.states.len(), 401);
    let slide = |t: f64| {
        let (y, z) = (0.1 - 0.08 * libm::sin(6.0 * t), 0.12 + 0.08 * libm::cos(6.0 * t));
        (0.09 - y * y - z * z).sqrt()
    };
    let energy = |state: &triad_engine::analysis::KinematicState| -> f64 {
        let system = triad_engine::model::Model::new(&scene).unwrap();
        state
            .bodies
            .iter()
            .zip(&system.bodies)
            .map(|(at, body)| {
                let omega = Vector3::from(at.angular_velocity);
                let spin: f64 = [at.u, at.v, at.w]
                    .iter()
                    .zip(body.principal.iter())
                    .map(|(e, i)| i * libm::pow(Vector3::from(*e).dot(&omega), 2.0))
                    .sum();
                0.5 * (body.mass * Vector3::from(at.velocity).norm_squared() + spin)
                    + 9.81 * body.mass * at.position[2]
            })
            .sum()
    };
    for k in 2..found.states.len() - 2 {
        let state = &found.states[k];
        let h = 1e-4;
        let (ahead, here, behind) = (slide(state.time + h), slide(state.time), slide(state.time - h));
        near(state.bodies[2].position[0], here, 1e-12, "place");
        near(state.bodies[2].velocity[0], (ahead - behind) / (2.0 * h), 1e-6, "velocity");
        near(state.accelerations[2][0], (ahead - 2.0 * here + behind) / (h * h), 1e-5, "acceleration");
        // Fourth-order difference of the energy.
        let e = |offset: usize| energy(&found.states[k + offset - 2]);
        let power = (8.0 * (e(3) - e(1)) - (e(4) - e(0))) / (12.0 * scene.simulation.every);
        let motor = state.reactions.reactions.iter().find(|r| r.joint == "motor").unwrap();
        assert!(motor.driver && motor.moment[0].unique);
        assert!(
            (motor.moment[0].value * 6.0 - power).abs() < 2e-4,
            "{} {power}",
            motor.moment[0].value * 6.0
        );
    }
}

/// Redundant rows do not stop the search, singular positions included (the links lie level at a quarter turn).
#[test]
fn a_driven_mechanism_with_redundant_rows_is_followed() {
    let mut scene = driven("n-four-bar:1", "A0", Motion::Ramp { start: 0.0, rate: -2.0 });
    scene.simulation.duration = 0.75;
    let found = kinematics(&scene, Convention::default()).unwrap();
    for state in &found.states {
        let angle = 2.0 * state.time;
        near(state.bodies[0].position[0], 0.5 * libm::sin(angle), 1e-10, "x");
        near(state.bodies[2].position[1], libm::cos(angle), 1e-10, "y");
    }
}

#[test]
fn what_is_free_or_out_of_reach_is_told() {
    let free = kinematics(&catalogue::scene("n-four-bar:1").unwrap(), Convention::default()).unwrap_err();
    assert!(matches!(free, AnalysisError::Free { freedoms: 1, .. }), "{free}");
    // The block cannot go farther than rod and crank are long.
    let mut scene = catalogue::scene("spatial-slider-crank").unwrap();
    scene.drivers.push(Driver::Slide {
        name: "pull".to_owned(),
        joint: "D".to_owned(),
        motion: Motion::Ramp { start: 0.2, rate: 0.1 },
    });
    scene.simulation.duration = 2.0;
    let far = kinematics(&scene, Convention::default()).unwrap_err();
    let AnalysisError::Unreachable { time, .. } = far else { panic!("{far}") };
    // s = √(0.09 − (|OA| − 0.08)²) at its farthest, |OA| = √(0.1² + 0.12²).
    let farthest = (0.09 - libm::pow(0.0244f64.sqrt() - 0.08, 2.0)).sqrt();
    assert!((time - (farthest - 0.2) / 0.1).abs() < 1e-9, "{time}");
}

#[test]
fn a_mechanism_that_its_drivers_hold_rests_where_it_is_and_has_no_modes() {
    let scene = driven("spatial-slider-crank", "A", Motion::Ramp { start: 0.0, rate: 0.0 });
    let rest = equilibrium(&scene).unwrap();
    assert_eq!((rest.iterations, rest.stable), (0, Some(true)));
    let held = modes(&scene, ModesAbout::Equilibrium).unwrap();
    assert_eq!((held.freedoms, held.modes.len()), (0, 0));
    assert!(held.notes.iter().any(|note| note.contains("nothing can vibrate")), "{:?}", held.notes);
}

#[test]
fn a_screw_starts_after_more_than_half_a_turn() {
    for angle in [0.5, 3.5, -4.0, 20.0] {
        let text = format!(
            r#"{{"name": "nut", "gravity": [0, 0, 0], "bodies": [{{"name": "nut", "mass": 1, "inertia": {{"principal": [0.01, 0.02, 0.02]}}}}],
                "joints": [{{"name": "thread", "type": "screw", "body_i": "ground", "body_j": "nut", "point": [0, 0, 0], "axis": [1, 0, 0],
                "pitch": 0.3, "start": {{"angle": {angle}, "rate": 1}}}}]}}"#
        );
        let run = Simulation::new(&Scene::from_json(&text).unwrap()).unwrap();
        near(
            run.frame().bodies[0].position[0],
            0.3 * angle / std::f64::consts::TAU,
            1e-9,
            "way along the thread",
        );
    }
}

/// The follower of a gear is closed to −1.5 rad at the start and is beyond −π after the first step: its turns go on from there.
#[test]
fn turns_are_counted_from_where_joints_were_closed() {
    let wheel = |name: &str, x: f64| {
        format!(
            r#"{{"name": "{name}", "mass": 1, "position": [{x}, 0, 0], "inertia": {{"principal": [0.1, 0.1, 0.2]}}}}"#
        )
    };
    let pin = |name: &str, body: &str, x: f64, start: &str| {
        format!(
            r#"{{"name": "{name}", "type": "revolute", "body_i": "ground", "body_j": "{body}", "point": [{x}, 0, 0], "axis": [0, 0, 1]{start}}}"#
        )
    };
    let text = format!(
        r#"{{"name": "gears", "gravity": [0, 0, 0], "bodies": [{}, {}], "joints": [{}, {}, {{"name": "mesh", "type": "gear",
            "joints": ["L", "F"], "ratio": -3}}], "events": [{{"name": "far", "of": {{"type": "angle", "joint": "F"}}, "value": -6}}],
            "simulation": {{"duration": 2}}}}"#,
        wheel("a", 0.0),
        wheel("b", 1.0),
        pin("L", "a", 0.0, r#", "start": {"angle": 0.5, "rate": 1.5}"#),
        pin("F", "b", 1.0, "")
    );
    let mut run = Simulation::new(&Scene::from_json(&text).unwrap()).unwrap();
    for _ in 0..2 {
        run.advance_to(2.0).unwrap();
        let times: Vec<f64> = run.events().iter().map(|event| event.time).collect();
        assert!(times.len() == 1 && (times[0] - 1.0).abs() < 1e-9, "{times:?}");
        run.reset();
    }
}

/// Where a spring is so stiff that rounding of its force would move what another holds, that is told.
#[test]
fn an_equilibrium_that_rounding_of_a_stiff_spring_hides_is_told() {
    let sag = |stiffness: f64| {
        let body = |name: &str, z: f64| json!({"name": name, "mass": 1, "position": [1, 0, z]});
        let rail = |name: &str, body: &str, z: f64| json!({"name": name, "type": "prismatic", "body_i": "ground", "body_j": body, "point": [0, 0, z], "axis": [1, 0, 0]});
        let text = json!({
            "name": "springs", "gravity": [1, 0, 0], "bodies": [body("a", 0.0), body("b", 1.0)],
            "joints": [rail("first", "a", 0.0), rail("second", "b", 1.0)],
            "loads": [
                {"name": "stiff", "type": "slider", "joint": "first", "stiffness": stiffness},
                {"name": "soft", "type": "slider", "joint": "second", "stiffness": 1}
            ]
        });
        let found = match equilibrium(&Scene::from_json(&text.to_string()).unwrap()) {
            Ok(found) => found,
            Err(error) => return (f64::NAN, error.hint().contains("differ by more than 1e8")),
        };
        let told = found.notes.iter().any(|note| note.contains("springs are too different"));
        (found.bodies[1].position[0] - 1.0, told)
    };
    for stiffness in [1.0, 1e3, 1e6, 1e8] {
        let (found, told) = sag(stiffness);
        assert!((found - 1.0).abs() < 1e-6 && !told, "{stiffness:e}: {found}, {told}");
    }
    for stiffness in [1e10, 1e12, 1e14] {
        let (found, told) = sag(stiffness);
        assert!((found - 1.0).abs() < 1e-6 || told, "{stiffness:e}: {found}");
    }
}

/// A position of rest knows nothing of how drivers go on: what they accelerate at the start is no load of it.
#[test]
fn drivers_that_accelerate_at_the_start_are_at_rest_in_equilibrium_and_modes() {
    let scene = |amplitude: f64| {
        let scene = json!({
            "name": "shaker", "bodies": [
                {"name": "table", "mass": 1, "inertia": {"principal": [0.1, 0.12, 0.2]}},
                {"name": "bob", "mass": 1, "position": [0, 0, -1]}],
            "joints": [
                {"name": "guide", "type": "prismatic", "body_i": "ground", "body_j": "table", "point": [0, 0, 0], "axis": [0, 0, 1]},
                {"name": "pin", "type": "revolute", "body_i": "table", "body_j": "bob", "point": [0, 0, 0], "axis": [0, 1, 0]}],
            "drivers": [{"name": "shake", "type": "slide", "joint": "guide",
                "motion": {"kind": "expression", "value": format!("{amplitude}*(cos(5*t)-1)")}}]
        });
        Scene::from_json(&scene.to_string()).unwrap()
    };
    for amplitude in [0.0, 0.2, 0.5] {
        let found = equilibrium(&scene(amplitude)).unwrap();
        let force = |name: &str| {
            let reaction = found.reactions.reactions.iter().find(|reaction| reaction.joint == name).unwrap();
            reaction.force[2].value
        };
        assert!((force("pin") - 9.81).abs() < 1e-9 && (force("shake") - 19.62).abs() < 1e-9, "{amplitude}");
        assert_eq!(found.stable, Some(true));
        for about in [ModesAbout::Equilibrium, ModesAbout::Start] {
            let found = modes(&scene(amplitude), about).unwrap();
            let exact = libm::sqrt(9.81) / std::f64::consts::TAU;
            assert!((found.modes[0].frequency - exact).abs() < 1e-7, "{amplitude}: {:?}", found.modes[0]);
        }
    }
}

/// A position of rest is told with how far it may be off: most where its stiffness is least.
#[test]
fn the_error_of_an_equilibrium_is_told() {
    // A pendulum with a torsion spring that its weight all but cancels: k − m g l.
    for part in [1.0, 0.5, 1e-3, 0.0] {
        let scene = json!({
            "name": "upright", "gravity": [0, 0, -9.81],
            "bodies": [{"name": "a", "mass": 1, "position": [0, 0, 0.5], "inertia": {"principal": [0.1, 0.1, 0.1]}}],
            "joints": [{"name": "pin", "type": "revolute", "body_i": "ground", "body_j": "a", "point": [0, 0, 0], "axis": [0, 1, 0],
                "start": {"angle": 0.3}}],
            "loads": [{"name": "spring", "type": "torsion", "joint": "pin", "stiffness": 9.81 * 0.5 * (1.0 + part)}]
        });
        let found = equilibrium(&Scene::from_json(&scene.to_string()).unwrap()).unwrap();
        let [x, y, z] = found.bodies[0].position;
        let off = Vector3::new(x, y, z - 0.5).norm();
        match found.error {
            Some(error) => assert!(off < 10.0 * error, "{part}: {off:e}, told {error:e}"),
            None => assert_eq!((part, found.stable), (0.0, None)),
        }
    }
}

/// Two branches of a parallelogram meet where it is flat: the linear equations there are told to be those of no single one.
#[test]
fn modes_at_a_singular_position_say_so() {
    let rod = |name: &str, at: [f64; 3], axis: usize| {
        let mut moments = [0.1; 3];
        moments[axis] = 0.01;
        json!({"name": name, "mass": 1, "position": at, "inertia": {"principal": moments}})
    };
    let hinge = |name: &str, i: &str, j: &str, at: [f64; 3]| json!({"name": name, "type": "revolute", "body_i": i, "body_j": j, "point": at, "axis": [0, 0, 1]});
    let scene = |width: f64| {
        let scene = json!({
            "name": "flat", "gravity": [9.81, 0, 0],
            "bodies": [rod("a", [0.5, 0.0, 0.0], 0), rod("b", [1.0, 0.5 * width, 0.0], 0), rod("c", [0.5, width, 0.0], 0)],
            "joints": [hinge("A", "ground", "a", [0.0; 3]), hinge("B", "a", "b", [1.0, 0.0, 0.0]),
                hinge("C", "b", "c", [1.0, width, 0.0]), hinge("D", "c", "ground", [0.0, width, 0.0])]
        });
        Scene::from_json(&scene.to_string()).unwrap()
    };
    let told = |scene: &Scene| {
        let found = modes(scene, ModesAbout::Start).unwrap();
        (
            found.freedoms,
            found.notes.iter().any(|note| note.starts_with("the position is singular: 1 rows lose")),
        )
    };
    assert_eq!(told(&scene(0.5)), (1, false));
    // All hinges on one line.
    let mut flat: serde_json::Value = serde_json::from_str(&scene(0.5).to_json()).unwrap();
    for (body, x) in [("0", 0.5), ("1", 1.25), ("2", 1.0)] {
        flat["bodies"][body.parse::<usize>().unwrap()]["position"] = json!([x, 0, 0]);
    }
    for (joint, x) in [(0, 0.0), (1, 1.0), (2, 1.5), (3, 0.5)] {
        flat["joints"][joint]["point"] = json!([x, 0, 0]);
    }
    assert_eq!(told(&Scene::from_json(&flat.to_string()).unwrap()), (2, true));
}

/// A parallelogram that is let go comes to rest where it is flat, where the other branch begins.
#[test]
fn an_equilibrium_in_a_singular_position_is_found() {
    let (sine, cosine) = libm::sincos(0.3);
    let link = |name: &str, position: [f64; 3], angle: f64| {
        json!({"name": name, "mass": 1, "inertia": {"principal": [0.001, 0.02, 0.02]}, "center_of_mass": [0.5, 0, 0],
            "orientation": {"axis": [0, 0, 1], "angle": angle}, "position": position})
    };
    let hinge = |name: &str, i: &str, j: &str, at: [f64; 3], on: [f64; 3]| {
        json!({"name": name, "type": "revolute", "body_i": i, "body_j": j, "point_i": at, "point_j": on,
            "axis_i": [0, 0, 1], "axis_j": [0, 0, 1]})
    };
    let scene = json!({
        "name": "flat", "gravity": [9.81, 0, 0],
        "bodies": [link("a", [0.0; 3], 0.3), link("b", [1.0, 0.0, 0.0], 0.3), link("c", [cosine, sine, 0.0], 0.0)],
        "joints": [hinge("O", "ground", "a", [0.0; 3], [0.0; 3]), hinge("Q", "ground", "b", [1.0, 0.0, 0.0], [0.0; 3]),
            hinge("A", "a", "c", [1.0, 0.0, 0.0], [0.0; 3]), hinge("B", "b", "c", [1.0, 0.0, 0.0], [1.0, 0.0, 0.0])]
    });
    let found = equilibrium(&Scene::from_json(&scene.to_string()).unwrap()).unwrap();
    let off = found.bodies[..2].iter().map(|body| body.u[1].abs()).fold(0.0, f64::max);
    assert!(
        off < 1e-5 && found.error.is_some_and(|error| off < 10.0 * error),
        "{off:e}, told {:?}",
        found.error
    );
}
