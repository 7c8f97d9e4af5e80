//! Loads that a program gives as functions of the state: against the same loads built in, and against closed forms.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use triad_engine::prelude::*;
use triad_engine::scene::ConstraintMethod;

/// Acceleration of gravity, m/s².
const GRAVITY: [f64; 3] = [0.0, -9.81, 0.0];
/// The axis of joints.
const UP: [f64; 3] = [0.0, 0.0, 1.0];

/// Two rods that hang on each other; only the joints hold them.
fn double_pendulum() -> Scene {
    let mut scene = Scene::new("double pendulum").gravity([0.0; 3]);
    let upper = scene.add(Body::rod("upper", 1.0, [0.0; 3], [1.0, 0.0, 0.0]));
    let lower = scene.add(Body::rod("lower", 2.0, [1.0, 0.0, 0.0], [1.0, 0.7, 0.0]));
    scene.add(Joint::revolute("hinge", Ground, &upper).at([0.0; 3]).about(UP));
    scene.add(Joint::revolute("knee", &upper, &lower).at([1.0, 0.0, 0.0]).about(UP));
    scene.simulation.tolerance = 1e-10;
    scene
}

fn weight(body: &str, mass: f64) -> CustomLoad {
    CustomLoad::new(format!("weight of {body}"), body, move |_| Wrench::force(GRAVITY.map(|g| mass * g)))
}

fn difference(a: &Solution, b: &Solution, t: f64) -> f64 {
    let (a, b) = (a.at(t).unwrap(), b.at(t).unwrap());
    let pairs = a.bodies().iter().zip(b.bodies());
    let all = pairs.flat_map(|(a, b)| [(a.position, b.position), (a.velocity, b.velocity), (a.u, b.u)]);
    all.flat_map(|(a, b)| [0, 1, 2].map(|k| (a[k] - b[k]).abs())).fold(0.0, f64::max)
}

#[test]
fn weights_given_by_a_program_are_gravity() {
    let scene = double_pendulum();
    let built_in = scene.clone().gravity(GRAVITY).simulate(0.0..2.0).unwrap();
    let given = scene.simulate_with([weight("upper", 1.0), weight("lower", 2.0)], 0.0..2.0).unwrap();
    for t in given.every(0.25) {
        assert!(difference(&built_in, &given, t) < 1e-8, "at {t}: {}", difference(&built_in, &given, t));
    }
    let force = |motion: &Solution| motion.reaction("hinge", 1.3).unwrap().force;
    let (a, b) = (force(&built_in), force(&given));
    assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-6), "{a:?} {b:?}");
    // Gravity has a potential; a function has not, so that its work is counted.
    assert!(built_in.summary().work == 0.0 && given.summary().work.abs() > 1.0);
    assert!(given.energy_drift().abs() < 1e-8, "{}", given.energy_drift());
}

#[test]
fn every_integrator_that_evaluates_knows_the_load() {
    let scene = double_pendulum();
    let exact = scene.clone().gravity(GRAVITY).simulate(0.0..1.0).unwrap();
    let (projection, partitioning) = (ConstraintMethod::Projection, ConstraintMethod::Partitioning);
    let cases = [
        (IntegratorKind::Dop853, projection, 1e-8),
        (IntegratorKind::Dopri5, projection, 1e-7),
        (IntegratorKind::Ode45, projection, 1e-7),
        (IntegratorKind::Radau, projection, 1e-6),
        (IntegratorKind::Rattle, projection, 1e-5),
        (IntegratorKind::Dop853, partitioning, 1e-8),
        (IntegratorKind::Dop853, ConstraintMethod::Baumgarte { alpha: 5.0, beta: 5.0 }, 1e-5),
        (IntegratorKind::Auto, ConstraintMethod::AugmentedLagrangian { alpha: 1e9 }, 1e-4),
        (IntegratorKind::Auto, ConstraintMethod::Penalty { alpha: 1e7, omega: 10.0, mu: 1.0 }, 1e-3),
    ];
    for (integrator, method, tolerance) in cases {
        let mut scene = scene.clone();
        (scene.simulation.integrator, scene.simulation.constraint_method) = (integrator, method);
        if !matches!(method, ConstraintMethod::Projection | ConstraintMethod::Partitioning) {
            scene.simulation.tolerance = 1e-7;
        }
        let given = scene.simulate_with([weight("upper", 1.0), weight("lower", 2.0)], 0.0..1.0);
        let error = given.map(|given| difference(&exact, &given, 1.0));
        assert!(matches!(error, Ok(error) if error < tolerance), "{integrator:?} with {method:?}: {error:?}");
    }
}

/// m ẍ = −k x − d ẋ from x = 1, with the force at a point of the body and its moment taken back.
#[test]
fn a_spring_and_damper_follow_their_closed_form() {
    let (mass, stiffness, damping) = (2.0, 50.0, 3.0);
    let mut scene = Scene::new("oscillator").gravity([0.0; 3]);
    let block = scene.add(Body::sphere("block", mass, 0.1, [1.0, 0.0, 0.0]));
    let end = [0.0, 0.3, 0.0];
    let spring = CustomLoad::new("spring", &block, {
        let block = block.clone();
        move |state| {
            let (x, v) = (state.point(&block, end)[0], state.point_velocity(&block, end)[0]);
            let force = -stiffness * x - damping * v;
            Wrench::force([force, 0.0, 0.0]).with_moment([0.0, 0.0, 0.3 * force])
        }
    });
    scene.simulation.tolerance = 1e-11;
    let motion = scene.simulate_with([spring.at(end)], 0.0..3.0).unwrap();
    let (decay, natural) = (damping / (2.0 * mass), f64::sqrt(stiffness / mass));
    let omega = f64::sqrt(natural * natural - decay * decay);
    for t in motion.every(0.5) {
        let state = motion.at(t).unwrap();
        let exact = libm::exp(-decay * t) * (libm::cos(omega * t) + decay / omega * libm::sin(omega * t));
        assert!((state.position(&block).unwrap()[0] - exact).abs() < 1e-9, "at {t}");
        assert!(state.angular_velocity(&block).unwrap()[2].abs() < 1e-9, "the moments balance");
    }
    let lost = 0.5 * mass * libm::pow(motion.at(3.0).unwrap().velocity(&block).unwrap()[0], 2.0)
        - motion.summary().work;
    assert!(lost.abs() < 1e-8, "all kinetic energy is work of the load: {lost:.1e}");
}

/// I ω̇ = −d ω, and the moment as the built-in damper of the hinge.
#[test]
fn a_moment_slows_a_wheel_as_the_damper_of_its_hinge_does() {
    let wheel = |scene: &mut Scene| {
        let wheel = Body::cylinder("wheel", 3.0, 0.2, [0.0, 0.0, -0.1], [0.0, 0.0, 0.1]);
        let wheel = scene.add(wheel.angular_velocity([0.0, 0.0, 7.0]));
        scene.add(Joint::revolute("axle", Ground, &wheel).at([0.0; 3]).about(UP));
        scene.simulation.tolerance = 1e-11;
        wheel
    };
    let mut scene = Scene::new("wheel");
    let body = wheel(&mut scene);
    let brake = CustomLoad::new("brake", &body, {
        let body = body.clone();
        move |state| Wrench::moment(state.angular_velocity(&body).map(|omega| -0.05 * omega))
    });
    let given = scene.simulate_with([brake], 0.0..2.0).unwrap();
    let mut scene = Scene::new("wheel");
    wheel(&mut scene);
    scene.add(Load::torsion("brake", "axle", 0.0, 0.05));
    let built_in = scene.simulate(0.0..2.0).unwrap();
    let speed = |motion: &Solution| motion.at(2.0).unwrap().angular_velocity(&body).unwrap()[2];
    let exact = 7.0 * libm::exp(-0.05 / (0.5 * 3.0 * 0.2 * 0.2) * 2.0);
    assert!((speed(&given) - exact).abs() < 1e-9 && (speed(&built_in) - exact).abs() < 1e-9);
    assert!((given.summary().work - built_in.summary().work).abs() < 1e-8);
}

#[test]
fn auto_says_why_it_takes_no_series_and_taylor_is_refused() {
    let scene = double_pendulum();
    let motion = scene.simulate_with([weight("upper", 1.0)], 0.0..0.1).unwrap();
    assert_eq!(motion.summary().integrator, IntegratorKind::Dop853);
    assert_eq!(motion.summary().reason, "load \"weight of upper\" is a function without a power series");
    let mut scene = scene;
    scene.simulation.integrator = IntegratorKind::Taylor;
    let error = scene.simulate_with([weight("upper", 1.0)], 0.0..0.1).unwrap_err();
    assert_eq!(error.code(), "load-without-series");
    assert!(error.to_string().contains("weight of upper") && error.hint().contains("dop853"), "{error}");
    assert!(scene.simulate(0.0..0.1).is_ok(), "without the load it may");
}

#[test]
fn errors_name_the_load() {
    let scene = double_pendulum();
    let code = |load: CustomLoad| {
        let error = scene.simulate_with([load], 0.0..2.0).unwrap_err();
        (error.code(), error.to_string(), error.hint())
    };
    let late =
        CustomLoad::new("late", "upper", |state| Wrench::force([f64::sqrt(0.5 - state.time()), 0.0, 0.0]));
    let (kind, text, _) = code(late);
    assert_eq!(kind, "load-not-finite");
    let time = text.split("t = ").nth(1).and_then(|rest| rest.split(' ').next()).map(str::parse::<f64>);
    assert!(matches!(time, Some(Ok(t)) if (0.5..0.501).contains(&t)), "{text}");
    assert!(text.starts_with("load \"late\"") && text.contains("steps"), "{text}");

    let lost = CustomLoad::new("lost", "upper", |state| Wrench::force(state.velocity("uper")));
    let (kind, text, hint) = code(lost);
    assert_eq!((kind, hint.as_str()), ("unknown-name", "Did you mean \"upper\"?"));
    assert_eq!(text, "load \"lost\" asks for body \"uper\", which the scene does not have");

    assert_eq!(code(weight("nobody", 1.0)).0, "unknown-name");
    assert_eq!(code(weight("ground", 1.0)).0, "load-on-ground");
    assert_eq!(code(weight("upper", 1.0).at([f64::NAN, 0.0, 0.0])).0, "load-not-finite");
    let twice = scene.simulate_with([weight("upper", 1.0), weight("upper", 2.0)], 0.0..1.0).unwrap_err();
    assert_eq!(twice.code(), "duplicate-name");
}

/// A name that is met on the way only is told when the run comes there.
#[test]
fn a_body_that_is_asked_for_late_is_missed_late() {
    let late = CustomLoad::new("late", "upper", |state| {
        let body = if state.time() > 0.5 { "uper" } else { "upper" };
        Wrench::force(state.velocity(body))
    });
    let mut run = Simulation::with_loads(&double_pendulum(), [late]).unwrap();
    let error = run.advance_to(2.0).unwrap_err();
    assert_eq!(error.code(), "unknown-name");
    assert!(run.time() > 0.4 && run.time() <= 0.5, "{}", run.time());
}

/// A step that is tried beyond the domain of a function and then shortened is no failure.
#[test]
fn a_state_that_is_only_tried_does_no_harm() {
    let mut scene = Scene::new("stop").gravity([-10.0, 0.0, 0.0]);
    let ball = scene.add(Body::sphere("ball", 1.0, 0.1, [1.0, 0.0, 0.0]));
    let held = ball.clone();
    // A repulsion that grows without bound at x = 0, and has no value beyond.
    let wall = CustomLoad::new("wall", &ball, move |state| {
        let x = state.position(&held)[0];
        Wrench::force([if x > 0.0 { 1e-3 / (x * x * x) } else { f64::NAN }, 0.0, 0.0])
    });
    let motion = scene.simulate_with([wall], 0.0..3.0).unwrap();
    let least =
        motion.every(0.01).map(|t| motion.at(t).unwrap().position(&ball).unwrap()[0]).fold(1.0, f64::min);
    assert!(least > 0.0 && least < 0.1, "{least}");
}

/// Runs are shared between threads, loads with them.
#[test]
fn the_same_bits_from_any_thread() {
    let run = || {
        let motion = double_pendulum().simulate_with([weight("upper", 1.0)], 0.0..1.0).unwrap();
        motion.at(0.7).unwrap().position("lower").unwrap()
    };
    let here = run();
    assert_eq!(std::thread::spawn(run).join().unwrap(), here);
}
