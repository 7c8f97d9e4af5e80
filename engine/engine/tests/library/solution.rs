//! A motion that is kept tells at each time what a run that comes to it shows, to the last bit.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use crate::common::Random;
use triad_engine::prelude::*;
use triad_engine::reactions::report::{Convention, ReactionReport};
use triad_engine::run::Frame;
use triad_engine::scene::ConstraintMethod;

/// What a fresh run shows at time t, or how it fails.
fn shown(scene: &Scene, t: f64) -> (Frame, Result<ReactionReport, EngineError>) {
    let mut run = Simulation::new(scene).unwrap();
    run.advance_to(t).unwrap();
    (run.frame(), run.reactions(Convention::default()))
}

/// Asks at times in no order and at ends of steps, and compares.
fn compare(scene: &Scene, end: f64) {
    let motion = scene.simulate(0.0..end).unwrap();
    let scene = scene.clone().duration(end);
    let mut run = Simulation::new(&scene).unwrap();
    run.step().unwrap();
    let mut random = Random::new(7);
    let mut times = vec![0.0, motion.end(), run.time(), 0.5 * run.time()];
    times.extend((0..4).map(|_| 0.5 * (1.0 + random.between(0.0, 1.0)) * motion.end()));
    let at = format!("{} with {}", scene.name, scene.simulation.integrator);
    for t in times {
        let (frame, reactions) = shown(&scene, t);
        let state = motion.at(t).unwrap();
        assert_eq!((state.time(), state.bodies()), (frame.time, &*frame.bodies), "{at}, t = {t}");
        assert_eq!(motion.reactions(t, Convention::default()), reactions, "{at}, t = {t}");
    }
}

#[test]
fn every_integrator_is_told_as_it_ran() {
    use IntegratorKind::{Dop853, Dopri5, Ode45, Radau, Rattle, Taylor};
    for name in ["simple-pendulum", "spatial-slider-crank", "n-four-bar:1"] {
        for integrator in [Taylor, Dop853, Dopri5, Ode45, Radau, Rattle] {
            compare(&catalogue::scene(name).unwrap().integrator(integrator), 0.4);
        }
    }
}

#[test]
fn singular_positions_are_told_as_they_ran() {
    for integrator in [IntegratorKind::Taylor, IntegratorKind::Dop853] {
        let scene = catalogue::scene("n-four-bar:2").unwrap().integrator(integrator);
        assert!(
            !scene.simulate(0.0..2.0).unwrap().summary().singularities.is_empty(),
            "{integrator}: none is passed"
        );
        compare(&scene, 2.0);
    }
}

#[test]
fn every_treatment_is_told_as_it_ran() {
    let scene = catalogue::scene("simple-pendulum").unwrap();
    for method in [
        ConstraintMethod::Projection,
        ConstraintMethod::Partitioning,
        ConstraintMethod::Baumgarte { alpha: 5.0, beta: 5.0 },
        ConstraintMethod::Penalty { alpha: 1e7, omega: 10.0, mu: 1.0 },
        ConstraintMethod::AugmentedLagrangian { alpha: 1e7 },
    ] {
        let mut scene = scene.clone();
        scene.simulation.constraint_method = method;
        compare(&scene, 0.3);
    }
}

#[test]
fn parts_turns_and_outputs_are_told_as_they_ran() {
    // Parts with steps of their own, an angle of many turns, and a run that is asked to step onto its outputs.
    let mut scene = Scene::new("apart").gravity([0.0, -9.81, 0.0]);
    for (name, x) in [("a", 0.0), ("b", 3.0)] {
        let rod = scene.add(Body::rod(name, 1.0, [x, 0.0, 0.0], [x + 1.0, 0.0, 0.0]));
        let pin = format!("pin {name}");
        let pin = scene.add(Joint::revolute(pin, Ground, &rod).at([x, 0.0, 0.0]).about([0.0, 0.0, 1.0]));
        scene.add(Load::motor(format!("motor {name}"), &pin, 6.0 + x));
        scene.add(Load::torsion(format!("spring {name}"), &pin, 0.01, 0.02));
    }
    compare(&scene, 3.0);
    let mut scene = scene.integrator(IntegratorKind::Dopri5);
    compare(&scene, 1.0);
    scene.simulation.skip.outputs = false;
    let motion = scene.simulate(0.0..1.0).unwrap();
    let late = motion.at(0.77).unwrap().bodies().to_vec();
    motion.at(0.31).unwrap();
    assert_eq!(motion.at(0.77).unwrap().bodies(), late);
}

#[test]
fn a_stop_ends_the_motion() {
    let mut scene = catalogue::scene("simple-pendulum").unwrap();
    let body = scene.bodies[0].name.clone();
    let low = scene.add(Event::new("low", Quantity::coordinate(&body, [0.0; 3], scene.gravity), 0.0));
    scene.events[0].value = {
        let start = Simulation::new(&scene).unwrap().frame().bodies[0].position;
        let weight = libm::hypot(scene.gravity[1], scene.gravity[2]).max(scene.gravity[0].abs());
        let height: f64 = (0..3).map(|k| start[k] * scene.gravity[k] / weight).sum();
        height + 0.1
    };
    scene.events[0].stop = true;
    let motion = scene.simulate(0.0..5.0).unwrap();
    assert_eq!(motion.times_of(&low).unwrap(), [motion.end()]);
    assert!(motion.end() < 2.0 && motion.at(motion.end() + 1e-9).is_err());
    compare(&scene, 5.0);
}

#[test]
fn long_runs_keep_some_of_their_steps() {
    let mut scene = catalogue::scene("simple-pendulum").unwrap().integrator(IntegratorKind::Dopri5);
    scene.simulation.step = Some(1e-4);
    compare(&scene, 2.0);
}

#[test]
fn names_and_times_are_checked() {
    let scene = catalogue::scene("n-four-bar:1").unwrap();
    let motion = scene.simulate(0.2..0.5).unwrap();
    assert_eq!((motion.start(), motion.end()), (0.2, 0.5));
    for error in [motion.at(0.1).map(|_| ()).unwrap_err(), motion.reaction("nothing", f64::NAN).unwrap_err()]
    {
        assert_eq!(error.code(), "time-outside-run");
    }
    let error = motion.reaction("nothing", 0.3).unwrap_err();
    assert_eq!((error.code(), &*error.to_string()), ("unknown-name", "there is no joint \"nothing\""));
    for times in [1.0..1.0, -1.0..1.0, f64::NAN..1.0, 0.0..f64::NAN] {
        assert_eq!(scene.simulate(times).unwrap_err().code(), "time-outside-run");
    }
    assert_eq!(motion.every(0.0).count() + motion.every(-1.0).count() + motion.every(f64::NAN).count(), 0);
    assert_eq!(motion.clone().at(0.4).unwrap().bodies(), motion.at(0.4).unwrap().bodies());
}
