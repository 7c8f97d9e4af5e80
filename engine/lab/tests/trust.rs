//! What a run says about itself: singular positions it passed, and how far it can be trusted.

#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

use triad_engine::run::Simulation;
use triad_lab::bench::{BenchCase, BenchPlan, Wish, measure};
use triad_lab::verify::Verifier;
use triad_scene::{ConstraintMethod, IntegratorKind};
use triad_scene::{Scene, catalogue};

/// Those that go through singular positions; rattle stops there.
const INTEGRATORS: [IntegratorKind; 5] = [
    IntegratorKind::Taylor,
    IntegratorKind::Dop853,
    IntegratorKind::Dopri5,
    IntegratorKind::Ode45,
    IntegratorKind::Radau,
];

/// Times at which the motion with the acceleration f(θ, θ̇) passes odd multiples of π/2: classical Runge-Kutta with steps
/// of 0.1 ms, and linear interpolation between them.
fn horizontal_times((mut angle, mut rate): (f64, f64), end: f64, f: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let h = 1e-4;
    let mut times = Vec::new();
    let mut step = 0.0;
    while step * h < end {
        let (a1, r1) = (rate, f(angle, rate));
        let (a2, r2) = (rate + 0.5 * h * r1, f(angle + 0.5 * h * a1, rate + 0.5 * h * r1));
        let (a3, r3) = (rate + 0.5 * h * r2, f(angle + 0.5 * h * a2, rate + 0.5 * h * r2));
        let (a4, r4) = (rate + h * r3, f(angle + h * a3, rate + h * r3));
        let next = angle + h * (a1 + 2.0 * a2 + 2.0 * a3 + a4) / 6.0;
        rate += h * (r1 + 2.0 * r2 + 2.0 * r3 + r4) / 6.0;
        let (before, after) = (libm::cos(angle), libm::cos(next));
        if before * after < 0.0 {
            times.push((step + before / (before - after)) * h);
        }
        angle = next;
        step += 1.0;
    }
    times
}

/// When a four-bar of so many windows passes the horizontal.
fn window_times(windows: f64) -> Vec<f64> {
    let kappa = 9.81 * 3.0 * (3.0 * windows + 1.0) / (2.0 * (4.0 * windows + 1.0));
    horizontal_times((0.0, 1.0), 10.0, |angle, _| kappa * libm::sin(angle))
}

/// Runs a scene with each integrator: the singular configurations that it finds must be those at the given times, all of
/// them, however long the steps, and none invented.
fn singularities_are(exact: &[f64], name: &str, scene: &Scene, missed: &mut Vec<String>) {
    for integrator in INTEGRATORS {
        let mut scene = scene.clone();
        scene.simulation.integrator = integrator;
        let mut run = Simulation::new(&scene).unwrap();
        run.advance_to(run.duration()).unwrap();
        let found = run.summary().singularities;
        let times: Vec<f64> = found.iter().map(|p| p.time).collect();
        let (probes, steps) = (run.probes(), run.summary().steps);
        let tolerance = scene.simulation.tolerance;
        println!(
            "{name} {tolerance:.0e} {integrator:?}: {} found, {probes} probes in {steps} steps",
            times.len()
        );
        if times.len() != exact.len() {
            missed.push(format!("{name} {tolerance:.0e} {integrator:?}: {times:?} of {exact:?}"));
        }
        for found in &found {
            let bound = 1e-5 + 1e3 * tolerance;
            let near = exact.iter().any(|exact| (found.time - exact).abs() < bound);
            assert!(near, "{name} {integrator:?}: {} is none of {exact:?}", found.time);
            assert!(!found.joints.is_empty());
        }
    }
}

#[test]
fn singular_configurations_are_found_with_their_times_and_joints() {
    let mut missed = Vec::new();
    for (windows, tolerance) in
        [(1.0f64, 1e-9), (1.0, 1e-5), (2.0, 1e-9), (2.0, 1e-5), (5.0, 1e-8), (12.0, 1e-6)]
    {
        let exact = window_times(windows);
        assert!(exact.len() >= 9);
        let mut scene = catalogue::scene(&format!("n-four-bar:{windows}")).unwrap();
        scene.simulation.tolerance = tolerance;
        singularities_are(&exact, &format!("{windows} windows"), &scene, &mut missed);
    }
    // Crank and rod of equal length: the slider passes the crank's pivot, and may stay there.
    let acceleration = |angle: f64, rate: f64| {
        let (s, c) = libm::sincos(angle);
        (-6.0 * s * c * rate * rate - 9.81 * c) / (5.0 / 12.0 + 0.25 * c * c + 6.25 * s * s)
    };
    let exact = horizontal_times((0.5, 4.0), 10.0, acceleration);
    assert!(exact.len() >= 9);
    for tolerance in [1e-9, 1e-6] {
        let mut scene = Scene::from_json(include_str!("data/slider-crank-equal.json")).unwrap();
        scene.simulation.tolerance = tolerance;
        singularities_are(&exact, "slider-crank", &scene, &mut missed);
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}

#[test]
fn regular_runs_find_no_singular_configuration() {
    for name in [
        "simple-pendulum",
        "spatial-double-pendulum",
        "spatial-chain:5",
        "spatial-chain:10",
        "heavy-top",
        "spatial-slider-crank",
        "bricard",
    ] {
        for integrator in INTEGRATORS {
            let mut scene = catalogue::scene(name).unwrap();
            scene.simulation.integrator = integrator;
            scene.simulation.duration = 2.0;
            let mut run = Simulation::new(&scene).unwrap();
            run.advance_to(2.0).unwrap();
            assert!(
                run.singular_configurations().is_empty(),
                "{name} {integrator:?}: {:?}",
                run.singular_configurations()
            );
            // Where no joints close loops, nothing is looked at.
            assert!(run.probes() == 0 || ["spatial-slider-crank", "bricard"].contains(&name));
        }
    }
}

#[test]
fn a_second_solution_estimates_the_error_of_a_run() {
    // The error of a loose run is known from a tight one, and the estimate must be of its size.
    for (name, integrator) in
        [("n-four-bar:2", IntegratorKind::Taylor), ("spatial-double-pendulum", IntegratorKind::Dopri5)]
    {
        let mut scene = catalogue::scene(name).unwrap();
        scene.simulation.duration = 4.0;
        scene.simulation.integrator = integrator;
        scene.simulation.tolerance = 1e-6;
        let mut exact = scene.clone();
        exact.simulation.tolerance = 1e-12;
        exact.simulation.integrator = IntegratorKind::Dop853;
        let mut exact = Simulation::new(&exact).unwrap();
        let mut run = Simulation::new(&scene).unwrap();
        let mut verifier = Verifier::new(&scene, &run).unwrap();
        let mut error = 0.0f64;
        for step in 1..=40 {
            let time = f64::from(step) * 0.1;
            run.advance_to(time).unwrap();
            exact.advance_to(time).unwrap();
            // In pieces, as a caller does who must be able to stop.
            while !verifier.compare(&run, 3) {}
            for (a, b) in run.frame().bodies.iter().zip(&exact.frame().bodies) {
                let apart = (0..3).map(|k| a.position[k] - b.position[k]).map(|d| d * d).sum::<f64>().sqrt();
                error = error.max(apart);
            }
        }
        let found = verifier.found();
        println!("{name}: {error:.2e}, estimated {:.2e} by {:?}", found.position, found.integrator);
        assert_eq!(found.compared, 40);
        assert!(found.position > 0.5 * error && found.position < 2.0 * error, "{error:.2e} {found:?}");
        assert_eq!(found.bodies.len(), scene.bodies.len());
    }
}

/// The slider of a slider-crank is driven farther than its rod reaches.
fn out_of_reach() -> Scene {
    let scene = catalogue::scene("spatial-slider-crank").unwrap();
    let mut scene: serde_json::Value = serde_json::from_str(&scene.to_json()).unwrap();
    scene["drivers"] = serde_json::json!([{"type": "slide", "name": "push", "joint": "D",
        "motion": {"kind": "ramp", "start": 0.2, "rate": 1.0}}]);
    Scene::from_json(&scene.to_string()).unwrap()
}

#[test]
fn a_run_that_cannot_go_on_ends_soon_and_says_where() {
    // For radau there is nothing to integrate.
    for integrator in &INTEGRATORS[..4] {
        let mut scene = out_of_reach();
        scene.simulation.integrator = *integrator;
        let mut run = Simulation::new(&scene).unwrap();
        let error = run.advance_to(run.duration()).unwrap_err();
        let summary = run.summary();
        println!("{integrator:?}: {} steps, {error}", summary.steps + summary.rejected);
        let codes = ["step-too-small", "stalled", "constraints-lost", "motion-impossible"];
        assert!(codes.contains(&error.code()), "{error}");
        assert!(summary.steps + summary.rejected < 2_000, "{integrator:?}: {summary:?}");
        // The state that is shown is the last good one.
        assert!((summary.time - 0.09016).abs() < 1e-4, "{}", summary.time);
        assert!(summary.position_violation < 1e-6, "{summary:?}");
        // A step whose end was refused counts among the steps, but not among the good ones.
        let names_steps = |steps: u64| error.to_string().contains(&format!("(after {steps} steps"));
        assert!(names_steps(summary.steps) || names_steps(summary.steps - 1), "{error}");
    }
}

#[test]
fn a_start_that_drivers_and_joints_contradict_is_refused_at_once() {
    // The rod makes a structure of the hinged body that the driver is to turn.
    for seed in [177, 271, 1402] {
        let error = Simulation::new(&triad_lab::stress::random::scene(seed)).unwrap_err();
        println!("{seed}: {error}");
        assert_eq!((error.code(), error.pointer().as_deref()), ("motion-impossible", Some("/drivers/0")));
        assert!(
            error.to_string().contains("\"driver\"") && error.to_string().contains("\"loop0\""),
            "{error}"
        );
    }
}

#[test]
fn what_stands_in_the_way_is_told_in_words() {
    use triad_engine::Cause;
    // A driver that comes to the end of its reach, and a rod that hardly holds since the start.
    let stopped = |scene: &Scene, steps: u64| {
        let mut run = Simulation::new(scene).unwrap();
        run.set_step_limit(steps);
        let error = run.advance_to(run.duration()).unwrap_err();
        println!("{error}");
        error
    };
    let error = stopped(&triad_lab::stress::random::scene(304), 20_000);
    let Some(Cause::OutOfReach { drivers, time, open }) = error.cause() else { panic!("{error}") };
    assert_eq!(drivers, &["driver"]);
    assert!((time - 0.09905).abs() < 1e-4 && open.iter().any(|name| name == "loop0"), "{error}");
    // Steps that lead nowhere are not gone on with.
    for seed in [304, 338, 551, 898, 1143, 1850] {
        let mut run = Simulation::new(&triad_lab::stress::random::scene(seed)).unwrap();
        run.advance_to(run.duration()).unwrap_err();
        let summary = run.summary();
        assert!(summary.steps + summary.rejected < 500, "{seed}: {summary:?}");
    }
    let error = stopped(&out_of_reach(), 20_000);
    let Some(Cause::OutOfReach { drivers, .. }) = error.cause() else { panic!("{error}") };
    assert_eq!(drivers, &["push"]);
    let mut scene = triad_lab::stress::random::scene(1407);
    scene.simulation.integrator = IntegratorKind::Dop853;
    let error = stopped(&scene, 100);
    assert!(matches!(error.cause(), Some(Cause::Weak { joint, .. }) if joint == "loop1"), "{error}");
    // Rows of a tree never depend on each other, however small their pivots: no joint is to blame.
    let error = stopped(&catalogue::scene("spatial-chain:5").unwrap(), 3);
    assert_eq!(error.cause(), None, "{error}");
}

#[test]
fn a_driven_run_is_taken_over_by_another_where_it_stands() {
    let scene = out_of_reach();
    let mut run = Simulation::new(&scene).unwrap();
    for step in 1..=8 {
        run.advance_to(0.01 * f64::from(step)).unwrap();
        let mut next = Simulation::new(&scene).unwrap();
        next.continue_from(&run).unwrap();
        assert!((next.time() - run.time()).abs() < 1e-12);
    }
}

#[test]
fn a_driver_that_starts_from_rest_against_a_structure_is_told() {
    // Its rate contradicts the joints only later: at the start nothing moves.
    for seed in [271, 1402] {
        for integrator in &INTEGRATORS[..4] {
            let mut scene = triad_lab::stress::random::scene(seed);
            scene.gravity = [0.0; 3];
            scene.simulation.integrator = *integrator;
            for body in &mut scene.bodies {
                (body.velocity, body.angular_velocity) = ([0.0; 3], [0.0; 3]);
            }
            let triad_scene::Driver::Angle { motion, .. } = &mut scene.drivers[0] else { panic!() };
            *motion = serde_json::from_value(
                serde_json::json!({"kind": "harmonic", "mean": -0.2, "amplitude": 0.2,
                "frequency": 1.0, "phase": std::f64::consts::FRAC_PI_2}),
            )
            .unwrap();
            let mut run = Simulation::new(&scene).unwrap();
            run.set_step_limit(20_000);
            let error = run.advance_to(run.duration()).unwrap_err();
            let summary = run.summary();
            println!("{seed} {integrator:?} {} steps: {error}", summary.steps + summary.rejected);
            assert!(matches!(error.cause(), Some(triad_engine::Cause::OutOfReach { .. })), "{error}");
            assert!(summary.steps + summary.rejected < 2_000, "{error}");
        }
    }
}

#[test]
fn rattle_goes_as_far_as_the_driver_reaches() {
    let mut scene = out_of_reach();
    scene.simulation.integrator = IntegratorKind::Rattle;
    let mut run = Simulation::new(&scene).unwrap();
    let error = run.advance_to(run.duration()).unwrap_err();
    println!("{} steps, {error}", run.summary().steps);
    assert!((run.reached() - 0.09016).abs() < 1e-3, "{error}");
    assert!(matches!(error.cause(), Some(triad_engine::Cause::OutOfReach { .. })), "{error}");
}

#[test]
fn what_a_treatment_does_not_survive_is_told() {
    let exact = window_times(2.0);
    let end = |method: ConstraintMethod| {
        let mut scene = catalogue::scene("n-four-bar:2").unwrap();
        scene.simulation.integrator = IntegratorKind::Dop853;
        scene.simulation.constraint_method = method;
        let mut run = Simulation::new(&scene).unwrap();
        run.advance_to(10.0).unwrap();
        (run.frame().bodies[0].position, run.summary())
    };
    let (right, projected) = end(ConstraintMethod::Projection);
    assert!(projected.doubts.is_empty(), "{:?}", projected.doubts);
    for method in [
        ConstraintMethod::Baumgarte { alpha: 0.0, beta: 0.0 },
        ConstraintMethod::Baumgarte { alpha: 1.0, beta: 1.0 },
        ConstraintMethod::Baumgarte { alpha: 5.0, beta: 5.0 },
        ConstraintMethod::Penalty { alpha: 1e4, omega: 10.0, mu: 1.0 },
        ConstraintMethod::Penalty { alpha: 1e7, omega: 10.0, mu: 1.0 },
        ConstraintMethod::Partitioning,
    ] {
        let (position, summary) = end(method);
        let off = (0..3).map(|k| (position[k] - right[k]).abs()).fold(0.0, f64::max);
        println!("{method:?}: off by {off:.1e}, {:?}", summary.doubts);
        let first = summary.singularities.first().unwrap();
        assert!((first.time - exact[0]).abs() < 0.05, "{method:?}: {} is not {}", first.time, exact[0]);
        let doubts = summary.doubts.join("\n");
        assert!(
            doubts.contains("singular position") && doubts.contains("use projection"),
            "{method:?}: {doubts}"
        );
        // What is wrong by centimetres is measured, and not only feared.
        let measured = summary.doubts.len() > 1;
        assert!(measured || off < 1e-2, "{method:?}: {off:.1e}, {doubts}");
    }
}

#[test]
fn sound_runs_are_not_doubted() {
    for name in ["simple-pendulum", "spatial-double-pendulum", "spatial-slider-crank", "bricard"] {
        for method in [
            ConstraintMethod::Projection,
            ConstraintMethod::Partitioning,
            ConstraintMethod::Baumgarte { alpha: 20.0, beta: 20.0 },
        ] {
            for integrator in [IntegratorKind::Dop853, IntegratorKind::Radau] {
                let mut scene = catalogue::scene(name).unwrap();
                scene.simulation.integrator = integrator;
                scene.simulation.constraint_method = method;
                scene.simulation.duration = 2.0;
                let mut run = Simulation::new(&scene).unwrap();
                run.advance_to(2.0).unwrap();
                let doubts = run.summary().doubts;
                assert!(doubts.is_empty(), "{name} {method:?} {integrator:?}: {doubts:?}");
            }
        }
    }
}

#[test]
fn a_driven_structure_that_hardly_holds_is_survived_all_the_same() {
    let mut run = Simulation::new(&triad_lab::stress::random::scene(1407)).unwrap();
    run.advance_to(run.duration()).unwrap();
    let summary = run.summary();
    assert!(summary.steps + summary.rejected < 20, "{summary:?}");
    assert!(summary.energy_drift.abs() < 1e-6 * summary.energy.abs(), "{summary:?}");
}

/// `triad bench` of a scene of one's own: no run is told to be more exact than what it is compared with, and that is what a tight run
/// by projection makes of the scene, whatever the scene asks for itself.
#[test]
fn a_benchmark_knows_what_its_reference_is_worth() {
    let errors = |scene: &Scene, tolerances: &[f64]| {
        let mut plan = BenchPlan::quick().with(Wish {
            integrators: vec![IntegratorKind::Dop853],
            tolerances: tolerances.to_vec(),
            ..Wish::default()
        });
        plan.cases = vec![BenchCase::given("mine", scene.clone())];
        (plan.repeats, plan.seconds) = (1, 1.0);
        let (runs, left_out) = measure(&plan, |_, _| ()).unwrap();
        let errors: Vec<f64> = runs.iter().map(|run| run.error.unwrap()).collect();
        (errors, left_out)
    };
    let pendulum = catalogue::scene("simple-pendulum").unwrap().duration(3.0);
    let (found, left_out) = errors(&pendulum, &[1e-6, 1e-13]);
    assert!(left_out.is_empty(), "{left_out:?}");
    assert!(1e-8 < found[0] && found[0] < 1e-4 && 0.0 < found[1] && found[1] < 1e-10, "{found:?}");
    // Soft joints and long steps of the scene are not the reference of those that have neither.
    let mut soft = pendulum.clone();
    soft.simulation.constraint_method = ConstraintMethod::Penalty { alpha: 1e3, omega: 10.0, mu: 1.0 };
    assert_eq!(errors(&soft, &[1e-6]).0, found[..1]);
    let mut stepped = pendulum;
    stepped.simulation.step = Some(0.1);
    let (again, left_out) = errors(&stepped, &[1e-6]);
    assert_eq!(again, found[..1]);
    assert!(left_out.len() == 1 && left_out[0].method == "steps of one size", "{left_out:?}");
    // Where nothing is known of the reference, nothing is said of the others.
    let chaos = catalogue::scene("spatial-double-pendulum").unwrap().duration(60.0);
    let (none, left_out) = errors(&chaos, &[1e-6]);
    assert!(none.is_empty() && left_out[0].why.contains("its own error"), "{none:?} {left_out:?}");
}
