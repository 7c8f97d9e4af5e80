//! Mechanisms that start where branches of the motion meet: the velocities say which is meant, and drivers lead along it.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use serde_json::{Value, json};
use triad_engine::analysis::check::check;
use triad_engine::analysis::kinematics;
use triad_engine::prelude::*;
use triad_engine::reactions::report::Convention;
use triad_engine::scene::IntegratorKind;

/// Distance of the pivots on the ground, and length of the coupler; crank and rocker have length one.
const BASE: f64 = 2.0;

/// A parallelogram that lies flat, its bars of different masses; angular velocities of crank, coupler and rocker.
fn flat([crank, coupler, rocker]: [f64; 3], motion: &Value) -> Scene {
    let bar = |name: &str, mass: f64, left: f64, length: f64, rise: f64, spin: f64| {
        json!({ "name": name, "mass": mass, "inertia": { "principal": [0.1 * mass, 0.2 * mass, 0.21 * mass] },
            "center_of_mass": [0.4 * length, 0.05, 0.0], "position": [left, 0.0, 0.0],
            "velocity": [0.0, rise, 0.0], "angular_velocity": [0.0, 0.0, spin] })
    };
    let hinge = |name: &str, i: &str, j: &str, x: f64| json!({ "name": name, "type": "revolute", "body_i": i, "body_j": j, "point": [x, 0, 0], "axis": [0, 0, 1] });
    let mut scene = json!({
        "name": "flat", "gravity": [0.3, -9.81, 0.0],
        "bodies": [
            bar("crank", 1.0, 0.0, 1.0, 0.0, crank),
            bar("coupler", 2.0, 1.0, BASE, crank, coupler),
            bar("rocker", 1.5, BASE, 1.0, 0.0, rocker),
        ],
        "joints": [
            hinge("A", "ground", "crank", 0.0), hinge("B", "crank", "coupler", 1.0),
            hinge("C", "coupler", "rocker", 1.0 + BASE), hinge("D", "ground", "rocker", BASE),
        ],
        "simulation": { "duration": 1.0, "every": 0.1 },
    });
    if !motion.is_null() {
        scene["drivers"] = json!([{ "name": "motor", "type": "angle", "joint": "A", "motion": motion }]);
    }
    Scene::from_json(&scene.to_string()).unwrap()
}

fn steady() -> Value {
    json!({ "kind": "ramp", "start": 0.0, "rate": 1.0 })
}

/// Angle of the rocker at that of the crank, from the ends of the coupler: the same on one branch, and where C is on the other side of the
/// line BD on the other.
fn rocker(crank: f64, crossed: bool) -> f64 {
    if !crossed {
        return crank;
    }
    let (c, s) = (libm::cos(crank), libm::sin(crank));
    let along = libm::atan2(s, c - BASE);
    libm::remainder(2.0 * along - crank, std::f64::consts::TAU)
}

fn angle(run: &Simulation, body: usize) -> f64 {
    let frame = run.frame();
    let u = frame.bodies[body].u;
    libm::atan2(u[1], u[0])
}

const PARALLEL: [f64; 3] = [1.0, 0.0, 1.0];
const CROSSED: [f64; 3] = [1.0, -2.0, -3.0];

#[test]
fn a_driven_start_follows_the_branch_of_its_velocities_by_all_integrators() {
    for (rates, crossed) in [(PARALLEL, false), (CROSSED, true)] {
        for integrator in
            [IntegratorKind::Taylor, IntegratorKind::Dop853, IntegratorKind::Dopri5, IntegratorKind::Radau]
        {
            let mut scene = flat(rates, &steady());
            scene.simulation.integrator = integrator;
            let mut run = Simulation::new(&scene).unwrap();
            let at = format!("{rates:?} {integrator:?}");
            assert!(run.notes().iter().all(|note| !note.contains("belong")), "{at} {:?}", run.notes());
            // Forces at the start are those of no branch; a little later they are known.
            assert!(run.reaction_errors().is_none(), "{at}");
            for k in 1..=10 {
                let t = 0.1 * f64::from(k);
                run.advance_to(t).unwrap();
                let off = (angle(&run, 2) - rocker(t, crossed)).abs();
                assert!(off < 1e-7, "{at}: {off:e} at {t}");
            }
            assert!(run.reaction_errors().is_some_and(|error| error.moment < 1e-3), "{at}");
        }
    }
}

#[test]
fn a_driven_start_has_no_freedom_and_tells_that_it_is_singular() {
    let found = check(&flat(PARALLEL, &steady())).unwrap();
    assert_eq!((found.degrees_of_freedom, found.redundant.len()), (0, 1), "{found:?}");
    assert!(found.notes.iter().any(|note| note.contains("singular position")), "{:?}", found.notes);
    // However short the run is, in which drivers hardly lead it away.
    let mut short = flat(PARALLEL, &steady());
    short.simulation.duration = 1e-5;
    let run = Simulation::new(&short).unwrap();
    assert_eq!(run.rank().lost_at_start(), 1);
    assert!(
        run.reaction_errors().is_none() && run.notes().iter().any(|note| note.contains("singular position"))
    );
    // A driver that holds it there lets it lose its hold for ever, and nothing is singular beside that.
    let held = check(&flat([0.0; 3], &json!({ "kind": "constant", "value": 0.0 }))).unwrap();
    assert_eq!(held.degrees_of_freedom, 1);
}

/// Accelerations there are those of no branch, and the first steps go by them.
#[test]
fn velocities_just_after_a_singular_start_are_told_with_what_they_change_by() {
    for rate in [0.01, 1.0, 30.0] {
        let motion = json!({ "kind": "expression", "value": format!("{rate}*t+{rate}*{rate}*t*t/2") });
        let mut scene = flat(PARALLEL.map(|spin| rate * spin), &motion);
        scene.simulation.integrator = IntegratorKind::Taylor;
        let mut run = Simulation::new(&scene).unwrap();
        for way in [1e-7, 1e-6, 2e-6, 5e-6, 1e-5, 2e-5, 5e-5, 1e-4, 2e-4, 1e-3, 1e-2] {
            run.advance_to(way / rate).unwrap();
            let wanted = rate * (1.0 + way);
            let frame = run.frame();
            let spins = [0, 1, 2].map(|body| frame.bodies[body].angular_velocity[2]);
            let off = spins.iter().zip([wanted, 0.0, wanted]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            let told = run.error_estimate().unwrap();
            assert!(
                off <= 3.0 * told.angular_velocity + 1e-13 * rate,
                "{rate} rad/s, {way} rad: off {off:e}, told {told:?}"
            );
            assert!(told.position <= way, "{rate} rad/s, {way} rad: {told:?}");
        }
    }
}

/// Drivers alone do not say which branch is meant, and velocities that obey the rows may belong to none.
#[test]
fn velocities_of_no_branch_are_changed_to_those_of_one_and_told() {
    let cases = [
        (flat([0.0; 3], &steady()), true),
        (flat([1.0, -0.715, -0.43], &steady()), true),
        (flat([1.0, -0.715, -0.43], &Value::Null), false),
    ];
    for (scene, driven) in cases {
        let mut run = Simulation::new(&scene).unwrap();
        let told =
            |note: &String| note.contains("the velocities belonged to none, and were changed by up to");
        assert!(run.notes().iter().any(told), "{:?}", run.notes());
        let spins: Vec<f64> = run.frame().bodies.iter().map(|body| body.angular_velocity[2]).collect();
        let ratio = spins[2] / spins[0];
        assert!((ratio - 1.0).abs().min((ratio + 3.0).abs()) < 1e-12, "{spins:?}");
        run.advance_to(0.5).unwrap();
        let crank = angle(&run, 0);
        let off = [false, true].map(|crossed| (angle(&run, 2) - rocker(crank, crossed)).abs());
        assert!(off[0].min(off[1]) < 1e-8, "{off:?}");
        assert!(!driven || (crank - 0.5).abs() < 1e-8, "{crank}");
    }
}

#[test]
fn kinematics_begins_on_the_branch_of_the_velocities_or_asks_for_them() {
    for (rates, crossed) in [(PARALLEL, false), (CROSSED, true)] {
        let motion = kinematics(&flat(rates, &steady()), Convention::default()).unwrap();
        for state in &motion.states {
            let u = state.bodies[2].u;
            let off = libm::atan2(u[1], u[0]) - rocker(state.time, crossed);
            assert!(off.abs() < 1e-11, "{rates:?}: {off:e} at {}", state.time);
        }
        // The motion backwards is its own picture in a mirror: nothing turns faster or slower at first.
        for spin in &motion.states[0].angular_accelerations {
            assert!(spin[2].abs() < 1e-7, "{rates:?}: {spin:?}");
        }
    }
    let error = kinematics(&flat([0.0; 3], &steady()), Convention::default()).unwrap_err();
    assert!(error.to_string().contains("the velocities do not say which is meant"), "{error}");
}

/// A slider-crank that is stretched, its slide driven back as by a crank that turns with 1 rad/s either way; with the crank's rate given.
fn stretched(rate: f64) -> Scene {
    let bar = |name: &str, left: f64, length: f64, velocity: f64, spin: f64| {
        json!({ "name": name, "mass": 1.0, "inertia": { "principal": [0.1, 0.2, 0.25] }, "center_of_mass": [0.5 * length, 0.0, 0.0],
            "position": [left, 0.0, 0.0], "velocity": [0.0, velocity, 0.0], "angular_velocity": [0.0, 0.0, spin] })
    };
    let hinge = |name: &str, i: &str, j: &str, x: f64| json!({ "name": name, "type": "revolute", "body_i": i, "body_j": j, "point": [x, 0, 0], "axis": [0, 0, 1] });
    let scene = json!({
        "name": "stretched", "gravity": [0, -9.81, 0],
        "bodies": [bar("crank", 0.0, 1.0, 0.0, rate), bar("rod", 1.0, 2.0, rate, -0.5 * rate), bar("slide", 3.0, 0.0, 0.0, 0.0)],
        "joints": [hinge("A", "ground", "crank", 0.0), hinge("B", "crank", "rod", 1.0), hinge("C", "rod", "slide", 3.0),
            { "name": "P", "type": "prismatic", "body_i": "ground", "body_j": "slide", "point": [3, 0, 0], "axis": [1, 0, 0] }],
        "drivers": [{ "name": "pull", "type": "slide", "joint": "P",
            "motion": { "kind": "expression", "value": "cos(t)+sqrt(4-sin(t)^2)-3" } }],
        "simulation": { "duration": 1.0, "every": 0.1 },
    });
    Scene::from_json(&scene.to_string()).unwrap()
}

/// A driver that starts at its dead point stands still at first: its acceleration alone says how fast the crank turns there, and either way
/// is one. Newton's method finds no position a little later from there, and any way aside is one.
#[test]
fn a_driver_may_start_at_its_dead_point() {
    for rate in [1.0, -1.0, 0.3, 0.0] {
        let scene = stretched(rate);
        assert_eq!(check(&scene).unwrap().degrees_of_freedom, 0, "{rate}");
        let mut run = Simulation::new(&scene).unwrap();
        let told = run.notes().iter().any(|note| note.contains("the velocities belonged to none"));
        assert_eq!(told, rate.abs() != 1.0, "{rate}: {:?}", run.notes());
        let started = run.frame().bodies[0].angular_velocity[2];
        assert!(
            (started.abs() - 1.0).abs() < 1e-12 && (rate == 0.0 || started * rate > 0.0),
            "{rate}: {started}"
        );
        run.advance_to(1.0).unwrap();
        let off = (angle(&run, 0) - started.signum()).abs();
        assert!(off < 1e-9, "{rate}: {off:e}");
    }
}
