//! What runs cost at different tolerances: a looser one must not cost more.

#![allow(clippy::panic, clippy::unwrap_used, reason = "a test that cannot go on says so")]

use crate::common::problem;
use triad_engine::catalogue;
use triad_engine::run::Simulation;
use triad_engine::scene::{ConstraintMethod, IntegratorKind, Scene};

/// Tolerances, loosest first.
const TOLERANCES: [f64; 8] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10];
/// Cost at a tolerance that a looser one may have, as a factor.
const MORE: f64 = 1.15;

/// Work of a run: evaluations, and factorizations where constraints are solved at stages.
fn costs(scene: &Scene, tolerance: f64) -> [u64; 2] {
    let mut scene = scene.clone();
    scene.simulation.tolerance = tolerance;
    scene.simulation.error_estimate = false;
    let mut run = Simulation::new(&scene).unwrap();
    run.advance_to(run.duration())
        .unwrap_or_else(|error| panic!("{} at {tolerance:.0e}: {error}", scene.name));
    let summary = run.summary();
    let solved = summary.factorizations > summary.evaluations;
    let costs = [summary.evaluations, if solved { summary.factorizations } else { summary.evaluations }];
    println!(
        "{} at {tolerance:.0e}: {costs:?}, {} steps, {} rejected",
        scene.name, summary.steps, summary.rejected
    );
    costs
}

fn looser_costs_no_more(scene: &Scene, most: f64) {
    let mut dearest = [0; 2];
    for tolerance in TOLERANCES {
        let now = costs(scene, tolerance);
        for (dearest, now) in dearest.iter_mut().zip(now) {
            let ratio = *dearest as f64 / now as f64;
            assert!(
                ratio < most,
                "{} at {tolerance:.0e}: a looser tolerance takes {ratio:.2} times as much",
                scene.name
            );
            *dearest = (*dearest).max(now);
        }
    }
}

fn partitioned(mut scene: Scene, integrator: IntegratorKind) -> Scene {
    scene.simulation.constraint_method = ConstraintMethod::Partitioning;
    scene.integrator(integrator)
}

#[test]
fn a_looser_tolerance_costs_no_more_with_independent_coordinates() {
    let names = [
        "heavy-top",
        "spatial-double-pendulum",
        "simple-pendulum",
        "bricard",
        "free-body",
        "spatial-chain:3",
        "spatial-slider-crank",
        "n-four-bar:2",
        "car-axis",
    ];
    for name in names {
        looser_costs_no_more(&partitioned(catalogue::scene(name).unwrap(), IntegratorKind::Auto), MORE);
    }
    for name in ["squeezer/scene", "squeezer/rest"] {
        looser_costs_no_more(&partitioned(problem(name), IntegratorKind::Auto), MORE);
    }
}

/// Of ode45 as well, whose steps would else end far beyond the edge of a chart.
#[test]
fn a_looser_tolerance_costs_no_more_in_a_chart_whatever_the_method() {
    for kind in [IntegratorKind::Dop853, IntegratorKind::Dopri5, IntegratorKind::Ode45] {
        for name in ["heavy-top", "spatial-double-pendulum", "spatial-slider-crank", "bricard"] {
            looser_costs_no_more(&partitioned(catalogue::scene(name).unwrap(), kind), MORE);
        }
    }
}

/// Where a chart is taken near a singular position, what lies in the guess moves by more than rounding: that is no other branch.
#[test]
fn a_looser_tolerance_costs_no_more_through_singular_positions() {
    for name in ["n-four-bar:1", "n-four-bar:2", "n-four-bar:3"] {
        looser_costs_no_more(&partitioned(catalogue::scene(name).unwrap(), IntegratorKind::Dop853), MORE);
    }
}

/// Errors are about those of the same method with projection.
#[test]
fn ode45_is_as_exact_in_a_chart() {
    let run = |integrator, method, tolerance| {
        let mut scene = catalogue::scene("heavy-top").unwrap().tolerance(tolerance).integrator(integrator);
        scene.simulation.constraint_method = method;
        scene.simulation.error_estimate = false;
        let mut run = Simulation::new(&scene).unwrap();
        let place = |half: i32| {
            run.advance_to(0.5 * f64::from(half)).unwrap();
            run.frame().bodies[0].position
        };
        (1..=8).flat_map(place).collect::<Vec<f64>>()
    };
    let (projected, parted) = (ConstraintMethod::Projection, ConstraintMethod::Partitioning);
    let truth = run(IntegratorKind::Taylor, projected, 1e-12);
    for tolerance in [1e-3, 1e-4, 1e-5] {
        let [projected, parted] = [projected, parted].map(|method| {
            let found = run(IntegratorKind::Ode45, method, tolerance);
            found.iter().zip(&truth).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        });
        assert!(parted < 8.0 * projected, "{tolerance:.0e}: {parted:.1e}, by projection {projected:.1e}");
    }
}

/// The top turns 48 times, and two entries of a direction serve for a quarter of a turn: about 190 charts, of a few steps each.
#[test]
fn a_chart_is_left_before_its_edge() {
    let mut scene = catalogue::scene("heavy-top").unwrap();
    scene.simulation.constraint_method = ConstraintMethod::Partitioning;
    scene.simulation.error_estimate = false;
    for (tolerance, steps) in [(1e-3, 1100), (1e-5, 900), (1e-6, 1000)] {
        scene.simulation.tolerance = tolerance;
        let mut run = Simulation::new(&scene).unwrap();
        run.advance_to(run.duration()).unwrap();
        let summary = run.summary();
        assert!(summary.steps < steps, "{tolerance:.0e}: {} steps", summary.steps);
        assert!(summary.position_violation < 1e-12, "{summary:?}");
    }
}

#[test]
fn a_looser_tolerance_costs_no_more_with_the_stiff_method() {
    let mut governor = problem("governor/scene");
    governor.simulation.integrator = IntegratorKind::Radau;
    looser_costs_no_more(&governor, MORE);
    for damping in ["1e3", "1e4", "1e5"] {
        looser_costs_no_more(&damped(damping), MORE);
    }
    for name in ["car-axis", "n-four-bar:2", "squeezer", "heavy-top"] {
        let scene = catalogue::scene(name).unwrap().integrator(IntegratorKind::Radau);
        looser_costs_no_more(&scene, MORE);
        looser_costs_no_more(&partitioned(scene, IntegratorKind::Radau), MORE);
    }
}

/// Three rods on hinges that are parallel to nothing, with a damper in the middle one.
pub fn damped(damping: &str) -> Scene {
    let axes = ["[0, 1, 1]", "[0.3, 1, -0.4]", "[0.1, -0.6, 1]"];
    let bodies: Vec<_> = (0..3).map(|k| {
        format!(r#"{{"name": "b{k}", "mass": 1, "inertia": {{"principal": [0.02, 0.09, 0.08]}}, "position": [{k}.5, 0, 0]}}"#)
    }).collect();
    let joints: Vec<_> = axes.iter().enumerate().map(|(k, axis)| {
        let before = if k == 0 { "ground".to_owned() } else { format!("b{}", k - 1) };
        format!(r#"{{"name": "h{k}", "type": "revolute", "point": [{k}, 0, 0], "axis": {axis}, "body_i": "{before}", "body_j": "b{k}"}}"#)
    }).collect();
    let text = format!(
        r#"{{"name": "damper of {damping} N m s", "gravity": [0, 0, -9.81], "bodies": [{}], "joints": [{}],
            "loads": [{{"type": "torsion", "name": "t", "joint": "h1", "damping": {damping}}}],
            "simulation": {{"duration": 4, "integrator": "radau"}}}}"#,
        bodies.join(","),
        joints.join(",")
    );
    Scene::from_json(&text).unwrap()
}
