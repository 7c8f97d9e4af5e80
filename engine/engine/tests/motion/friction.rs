//! Friction that the reaction of its own joint loads, against closed forms: far above the speed of smoothing tanh is 1 to the last
//! bit. Slopes, pins, guides, the law of a rope on a drum, frictions that load each other, locking, and who refuses it.

#![allow(clippy::disallowed_methods)] // closed forms, not bits
#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use triad_engine::prelude::*;
use triad_engine::scene::{ConstraintMethod, IntegratorKind};
use triad_engine::{Cause, EngineError};

const G: f64 = 9.81;
const TOLERANCE: f64 = 1e-11;
/// Integrators that solve for reactions.
const ABLE: [IntegratorKind; 4] =
    [IntegratorKind::Auto, IntegratorKind::Dop853, IntegratorKind::Dopri5, IntegratorKind::Radau];

fn run(scene: &Scene) -> Simulation {
    Simulation::new(scene).unwrap()
}

/// A block on a slope that falls along x, with this speed along it.
fn slope(incline: f64, speed: f64, friction: Friction) -> Scene {
    let mut scene = Scene::new("slope").gravity([0.0, 0.0, -G]).duration(1.0).tolerance(TOLERANCE);
    let down = [incline.cos(), 0.0, -incline.sin()];
    let block = scene.add(Body::sphere("block", 2.0, 0.1, [0.0; 3]).velocity(down.map(|x| speed * x)));
    let guide = scene.add(Joint::prismatic("guide", Ground, &block).at([0.0; 3]).about(down));
    scene.add(Load::sliding_friction("rub", &guide, friction));
    scene.simulation.outputs = vec!["loads".parse().unwrap()];
    scene
}

#[test]
fn a_block_slides_down_a_slope() {
    let (incline, speed, mu) = (0.6f64, 3.0, 0.3);
    let acceleration = G * (incline.sin() - mu * incline.cos());
    for integrator in ABLE {
        let mut scene = slope(incline, speed, Friction::dry(mu));
        scene.simulation.integrator = integrator;
        let mut run = run(&scene);
        run.advance_to(1.0).unwrap();
        let block = &run.frame().bodies[0];
        let way = block.position[0] / incline.cos();
        assert!((way - speed - 0.5 * acceleration).abs() < 1e-8, "{integrator}: {way}");
        let mut row = Vec::new();
        triad_engine::run::Outputs::new(&run).write(&run, &mut row);
        let friction = -mu * 2.0 * G * incline.cos();
        let rate = speed + acceleration;
        for (found, exact) in row.iter().zip([way, rate, friction, friction * rate]) {
            assert!((found - exact).abs() < 1e-7, "{integrator}: {row:?}");
        }
        assert!(run.summary().energy_drift.abs() < 1e-8, "{integrator}: {}", run.summary().energy_drift);
    }
}

#[test]
fn a_block_at_rest_creeps_as_slowly_as_friction_is_smooth() {
    // Where μ is above the slope, m g sin α = μ m g cos α tanh(v / v₀).
    let (incline, mu) = (0.3f64, 0.5);
    let mut run = run(&slope(incline, 0.5, Friction { smoothing: 1e-3, ..Friction::dry(mu) }));
    run.advance_to(1.0).unwrap();
    let speed = run.frame().bodies[0].velocity[0] / incline.cos();
    let exact = 1e-3 * (incline.tan() / mu).atanh();
    assert!((speed - exact).abs() < 1e-8, "{speed} {exact}");
}

/// A disc on a pin along y at the origin, its centre of mass so far along the pin, turning about it.
fn disc(arm: [f64; 3], rate: f64, gravity: f64, friction: Friction) -> Scene {
    let mut scene = Scene::new("disc").gravity([0.0, 0.0, -gravity]).duration(1.0).tolerance(TOLERANCE);
    let velocity = [rate * arm[2], 0.0, -rate * arm[0]];
    let disc =
        scene.add(Body::sphere("disc", 3.0, 0.2, arm).velocity(velocity).angular_velocity([0.0, rate, 0.0]));
    let pin = scene.add(Joint::revolute("pin", Ground, &disc).at([0.0; 3]).about([0.0, 1.0, 0.0]));
    scene.add(Load::turning_friction("rub", &pin, friction));
    scene
}

/// Moment of inertia of the disc about a pin at this distance.
fn inertia(radius: f64) -> f64 {
    3.0 * (0.4 * 0.04 + radius * radius)
}

#[test]
fn a_pin_brakes_by_its_radius_and_a_short_guide_by_its_moments() {
    let (mu, radius, rate) = (0.2, 0.03, 30.0);
    // Beyond the guide's end both ends press, with F d / ℓ ± F / 2.
    for (guide, aside, pressing) in
        [(None, 0.0, 1.0), (None, 0.3, 1.0), (Some(0.1), 0.02, 1.0), (Some(0.1), 0.3, 6.0)]
    {
        let friction = Friction { guide, ..Friction::dry(mu).radius(radius) };
        let mut run = run(&disc([0.0, aside, 0.0], rate, G, friction));
        run.advance_to(1.0).unwrap();
        let exact = rate - mu * radius * pressing * 3.0 * G / inertia(0.0);
        let found = run.frame().bodies[0].angular_velocity[1];
        assert!((found - exact).abs() < 1e-8, "{guide:?} {aside}: {found} {exact}");
    }
}

#[test]
fn friction_that_its_own_braking_loads_falls_as_a_rope_slips_on_a_drum() {
    // The pin holds m R (−ω², ω̇): ω̇ = −β ω², so that ω falls exponentially with the angle.
    let (mu, pin, arm, rate) = (0.6, 0.25, 0.5, 4.0);
    let pressing = mu * pin * 3.0 * arm;
    let beta = pressing / (inertia(arm).powi(2) - pressing * pressing).sqrt();
    for integrator in ABLE {
        let mut scene = disc([arm, 0.0, 0.0], rate, 0.0, Friction::dry(mu).radius(pin));
        scene.simulation.integrator = integrator;
        let mut run = run(&scene);
        run.advance_to(1.0).unwrap();
        let exact = rate / (1.0 + beta * rate);
        let found = run.frame().bodies[0].angular_velocity[1];
        assert!((found - exact).abs() < 1e-8, "{integrator}: {found} {exact}");
        assert!(run.summary().energy_drift.abs() < 1e-8);
    }
}

#[test]
fn frictions_that_load_each_other_balance_power() {
    let mut scene = Scene::new("two").gravity([0.0, 0.0, -G]).duration(0.5).tolerance(TOLERANCE);
    let upper =
        scene.add(Body::rod("upper", 1.0, [0.0; 3], [1.0, 0.0, 0.0]).angular_velocity([0.0, 3.0, 0.0]));
    let lower = Body::rod("lower", 0.5, [1.0, 0.0, 0.0], [1.0, 0.0, -1.0]);
    let lower = scene.add(lower.angular_velocity([0.0, 12.0, 0.0]));
    let first = scene.add(Joint::revolute("first", Ground, &upper).at([0.0; 3]).about([0.0, 1.0, 0.0]));
    let second =
        scene.add(Joint::revolute("second", &upper, &lower).at([1.0, 0.0, 0.0]).about([0.0, 1.0, 0.0]));
    scene.add(Load::turning_friction("rub1", &first, Friction::dry(0.4).radius(0.2)));
    scene.add(Load::turning_friction("rub2", &second, Friction::dry(0.5).radius(0.1).guide(0.05)));
    let mut run = run(&scene);
    run.advance_to(0.5).unwrap();
    let summary = run.summary();
    assert!(summary.work < -1.0 && summary.energy_drift.abs() < 1e-8, "{summary:?}");
    let mut again = Simulation::new(&scene).unwrap();
    again.advance_to(0.5).unwrap();
    assert_eq!(run.q(), again.q());
}

#[test]
fn friction_without_a_solution_locks_and_says_so() {
    // β has no real value where μ ρ m R ≥ I.
    let error = run(&disc([0.5, 0.0, 0.0], 4.0, 0.0, Friction::dry(2.0).radius(0.4))).advance_to(1.0);
    let error = error.unwrap_err();
    assert!(matches!(error.cause(), Some(Cause::Locked { load }) if load == "rub"), "{error}");
    assert!(error.hint().contains("smaller coefficient"), "{}", error.hint());
}

#[test]
fn who_knows_no_reactions_refuses_it() {
    let scene = slope(0.6, 1.0, Friction::dry(0.3));
    for integrator in [IntegratorKind::Taylor, IntegratorKind::Rattle] {
        let mut scene = scene.clone();
        scene.simulation.integrator = integrator;
        let error = Simulation::new(&scene).unwrap_err();
        assert!(matches!(error, EngineError::Integrator { .. }) && error.hint().contains("auto"), "{error}");
    }
    for treatment in [
        ConstraintMethod::Penalty { alpha: 1e6, omega: 10.0, mu: 1.0 },
        ConstraintMethod::AugmentedLagrangian { alpha: 1e6 },
    ] {
        let mut scene = scene.clone();
        scene.simulation.constraint_method = treatment;
        assert!(matches!(Simulation::new(&scene), Err(EngineError::Integrator { .. })));
    }
    let code = |friction| Simulation::new(&disc([0.0; 3], 1.0, G, friction)).unwrap_err().code();
    assert_eq!(code(Friction::dry(0.3)), "load-invalid", "it lacks the radius of the pin");
    assert_eq!(code(Friction::new(0.0, 1.0).radius(0.1)), "load-invalid");
    assert_eq!(code(Friction::dry(-0.1).radius(0.1)), "out-of-range");
    let code = |friction| Simulation::new(&slope(0.3, 1.0, friction)).unwrap_err().code();
    assert_eq!(code(Friction::dry(0.3).radius(0.1)), "load-invalid", "nothing turns");
}
