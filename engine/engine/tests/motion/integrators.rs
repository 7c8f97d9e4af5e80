//! Every integrator with every constraint method keeps its order, and the structure-preserving ones their invariants.

#![allow(clippy::unwrap_used, clippy::panic)]

use triad_engine::Scene;
use triad_engine::catalogue;
use triad_engine::run::{Frame, Simulation};
use triad_engine::scene::{ConstraintMethod, IntegratorKind};

/// Largest distance of centres of mass.
fn apart(a: &Frame, b: &Frame) -> f64 {
    let pairs = a.bodies.iter().zip(&b.bodies);
    let distance = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] - b[k]).map(|d| d * d).sum::<f64>().sqrt();
    pairs.map(|(a, b)| distance(a.position, b.position)).fold(0.0, f64::max)
}

fn scene(name: &str, duration: f64) -> Scene {
    let mut scene = catalogue::scene(name).unwrap();
    scene.simulation.duration = duration;
    scene.simulation.tolerance = 1e-13;
    scene
}

fn treated(mut scene: Scene, integrator: IntegratorKind, method: ConstraintMethod) -> Scene {
    scene.simulation.integrator = integrator;
    scene.simulation.constraint_method = method;
    scene
}

fn end(scene: &Scene) -> (Frame, Simulation) {
    let mut run = Simulation::new(scene).unwrap();
    run.advance_to(run.duration()).unwrap();
    (run.frame(), run)
}

/// Observed order at the end of a run when the steps become half as large. Coordinates of a partition are chosen anew between steps, at
/// other times in runs of other steps, and errors depend on the choice: there it is the mean order of two halvings.
fn order(name: &str, integrator: IntegratorKind, method: ConstraintMethod, step: f64) -> f64 {
    let scene = treated(scene(name, 0.48), integrator, method);
    let reference = end(&treated(scene.clone(), IntegratorKind::Dop853, ConstraintMethod::Projection)).0;
    let error = |step: f64| {
        let mut scene = scene.clone();
        scene.simulation.step = Some(step);
        let (frame, run) = end(&scene);
        assert_eq!(run.summary().integrator, integrator, "{}", run.summary().reason);
        apart(&frame, &reference)
    };
    let halvings = if method == ConstraintMethod::Partitioning { 2.0 } else { 1.0 };
    let (coarse, fine) = (error(step), error(step / libm::exp2(halvings)));
    assert!(coarse < 1e-2, "{name} {integrator:?}: {coarse:.1e} is no error of a converging method");
    libm::log2(coarse / fine) / halvings
}

#[test]
fn each_method_has_its_order_on_constrained_mechanisms() {
    use IntegratorKind::{Dop853, Dopri5, Radau, Rattle, Trapezoidal};
    let augmented = ConstraintMethod::AugmentedLagrangian { alpha: 1e9 };
    let feedback = ConstraintMethod::Baumgarte { alpha: 5.0, beta: 5.0 };
    let penalty = ConstraintMethod::Penalty { alpha: 1e8, omega: 10.0, mu: 1.0 };
    let cases = [
        (Dop853, ConstraintMethod::Projection, 8.0, 0.08),
        (Dopri5, ConstraintMethod::Projection, 5.0, 0.02),
        (Radau, ConstraintMethod::Projection, 5.0, 0.04),
        (Rattle, ConstraintMethod::Projection, 6.0, 0.04),
        (Dop853, ConstraintMethod::Partitioning, 8.0, 0.08),
        (Dopri5, ConstraintMethod::Partitioning, 5.0, 0.02),
        (Radau, ConstraintMethod::Partitioning, 5.0, 0.04),
        (Dopri5, feedback, 5.0, 0.02),
        (Dopri5, penalty, 5.0, 0.04),
        (Trapezoidal, augmented, 2.0, 0.005),
    ];
    for (integrator, method, expected, step) in cases {
        let check = |name: &str, step: f64, most: f64| {
            let found = order(name, integrator, method, step);
            println!("{name} {integrator:?} {method}: {found:.2}");
            assert!(
                found > expected - 0.6 && found < most,
                "{name}, {integrator:?} with {method}: order {found:.2} instead of {expected}"
            );
        };
        check("spatial-double-pendulum", step, expected + 1.8);
        // A closed loop moves more slowly at first: its steps are longer, so that the errors stand above rounding, and
        // where that leaves only two or three of them the order may seem higher than it is.
        let few = integrator == Dop853 && method == ConstraintMethod::Partitioning;
        check("n-four-bar:2", if few { 3.0 } else { 2.0 } * step, expected + 2.5);
    }
}

/// A chain that floats freely: its momentum has nothing to change it.
fn floating() -> Scene {
    let mut scene = scene("spatial-chain:3", 60.0);
    scene.joints.remove(0);
    scene.gravity = [0.0; 3];
    treated(scene, IntegratorKind::Rattle, ConstraintMethod::Projection)
}

fn angular_momentum(run: &Simulation) -> [f64; 3] {
    let frame = run.frame();
    let mut sum = nalgebra::Vector3::zeros();
    for (body, shown) in run.model().bodies.iter().zip(&frame.bodies) {
        let vector = nalgebra::Vector3::from;
        sum += vector(shown.position).cross(&vector(shown.velocity)) * body.mass;
        let omega = vector(shown.angular_velocity);
        for (axis, moment) in [shown.u, shown.v, shown.w].into_iter().zip(body.principal.iter()) {
            sum += vector(axis) * vector(axis).dot(&omega) * *moment;
        }
    }
    sum.into()
}

#[test]
fn rattle_keeps_momentum_and_its_energy_error_has_no_slope() {
    let mut scene = floating();
    scene.simulation.step = Some(0.1);
    let mut run = Simulation::new(&scene).unwrap();
    let momentum = angular_momentum(&run);
    // Largest energy errors of the quarters of the run.
    let mut errors = [0.0f64; 4];
    for step in 1..=600usize {
        run.advance_to(step as f64 * 0.1).unwrap();
        let quarter = &mut errors[(step - 1) / 150];
        *quarter = quarter.max(run.summary().energy_drift.abs());
        let now = angular_momentum(&run);
        for k in 0..3 {
            assert!((now[k] - momentum[k]).abs() < 1e-11, "{now:?} {momentum:?}");
        }
    }
    println!("{errors:?}");
    assert!(errors[0] > 1e-10, "the step is so small that the test says nothing: {errors:?}");
    assert!(errors[3] < 3.0 * errors[0], "{errors:?}");
    assert!(run.summary().velocity_violation < 1e-12);
}

#[test]
fn rattle_says_where_its_steps_are_not_those_that_were_asked_for() {
    let notes = |name: &str, step: Option<f64>, tolerance: f64| {
        let mut scene = treated(scene(name, 1.0), IntegratorKind::Rattle, ConstraintMethod::Projection);
        (scene.simulation.step, scene.simulation.tolerance) = (step, tolerance);
        let mut run = Simulation::new(&scene).unwrap();
        let told: Vec<String> =
            run.notes().iter().filter(|note| note.starts_with("steps of ")).cloned().collect();
        run.step().unwrap();
        (told, run.summary().step_size)
    };
    let (told, size) = notes("simple-pendulum", Some(0.3), 1e-9);
    assert_eq!((told.len(), size), (1, 0.25));
    assert!(told[0].starts_with("steps of 0.25 s in place of 0.3 s"), "{told:?}");
    assert!(notes("simple-pendulum", Some(0.1), 1e-9).0.is_empty());
    // The top's trial begins with steps that no tolerance needs.
    let (told, loose) = notes("heavy-top", None, 1e-3);
    assert!(told.len() == 1 && told[0].contains("changes nothing"), "{told:?}");
    assert_eq!(notes("heavy-top", None, 1e-9).1, loose);
    // Where the tolerance decides, nothing is said.
    let (told, loose) = notes("simple-pendulum", None, 1e-3);
    assert!(told.is_empty(), "{told:?}");
    assert!(notes("simple-pendulum", None, 1e-11).1 < loose);
}

#[test]
fn rattle_is_symmetric_in_time() {
    for name in ["spatial-chain:3", "spatial-double-pendulum", "n-four-bar:2"] {
        // The loop only as far as its first singular position.
        let duration = if name == "n-four-bar:2" { 0.6 } else { 2.0 };
        let mut scene = treated(scene(name, duration), IntegratorKind::Rattle, ConstraintMethod::Projection);
        scene.simulation.step = Some(0.02);
        let start = Simulation::new(&scene).unwrap().frame();
        let (_, run) = end(&scene);
        let mut back = run.turned_back();
        back.advance_to(duration).unwrap();
        let apart = apart(&start, &back.frame());
        println!("{name}: {apart:.1e}");
        assert!(apart < 1e-10, "{name}: {apart:.1e}");
    }
}

#[test]
fn partitioning_satisfies_the_constraints_at_every_output_and_passes_full_turns() {
    // Turns over the top: no coordinate can be the independent one all the time.
    let mut scene =
        treated(scene("simple-pendulum", 4.0), IntegratorKind::Dop853, ConstraintMethod::Partitioning);
    scene.simulation.tolerance = 1e-9;
    scene.bodies[0].velocity[2] -= 7.0;
    let reference = treated(scene.clone(), IntegratorKind::Dop853, ConstraintMethod::Projection);
    let mut reference = Simulation::new(&reference).unwrap();
    let mut run = Simulation::new(&scene).unwrap();
    for step in 1..=100 {
        let time = f64::from(step) * 0.04;
        run.advance_to(time).unwrap();
        reference.advance_to(time).unwrap();
        let summary = run.summary();
        assert!(summary.position_violation < 1e-12, "{time}: {}", summary.position_violation);
        assert!(summary.velocity_violation < 1e-11, "{time}: {}", summary.velocity_violation);
        let apart = apart(&run.frame(), &reference.frame());
        assert!(apart < 1e-6, "{time}: {apart:.1e}");
    }
}

#[test]
fn penalties_converge_to_the_constrained_motion_as_they_grow() {
    let plain = scene("spatial-double-pendulum", 1.0);
    let reference = end(&treated(plain.clone(), IntegratorKind::Dop853, ConstraintMethod::Projection)).0;
    let error = |alpha: f64| {
        let penalty = ConstraintMethod::Penalty { alpha, omega: 10.0, mu: 1.0 };
        let mut scene = treated(plain.clone(), IntegratorKind::Dop853, penalty);
        scene.simulation.tolerance = 1e-9;
        apart(&end(&scene).0, &reference)
    };
    let (weak, strong) = (error(1e4), error(1e5));
    println!("{weak:.1e} {strong:.1e}");
    assert!(strong < 1e-4 && (5.0..20.0).contains(&(weak / strong)), "{weak:.1e} {strong:.1e}");
}

#[test]
fn the_augmented_lagrangian_follows_its_tolerance_and_keeps_all_constraints() {
    let plain = scene("spatial-double-pendulum", 1.0);
    let reference = end(&treated(plain.clone(), IntegratorKind::Dop853, ConstraintMethod::Projection)).0;
    let augmented = ConstraintMethod::AugmentedLagrangian { alpha: 1e9 };
    let mut last = f64::INFINITY;
    for tolerance in [1e-5, 1e-7, 1e-9] {
        let mut scene = treated(plain.clone(), IntegratorKind::Auto, augmented);
        scene.simulation.tolerance = tolerance;
        let (frame, run) = end(&scene);
        let summary = run.summary();
        let error = apart(&frame, &reference);
        println!(
            "{tolerance:.0e}: {error:.1e}, {:.1e}, {:.1e}, {} steps",
            summary.position_violation, summary.velocity_violation, summary.steps
        );
        assert_eq!(summary.integrator, IntegratorKind::Trapezoidal);
        assert!(summary.position_violation <= tolerance && summary.velocity_violation < 1e-9);
        assert!(error < 0.3 * last && error < 1e3 * tolerance, "{error:.1e}");
        last = error;
    }
}

#[test]
fn an_integrator_that_a_treatment_does_not_know_is_replaced_with_the_reason() {
    let feedback = ConstraintMethod::Baumgarte { alpha: 5.0, beta: 5.0 };
    let augmented = ConstraintMethod::AugmentedLagrangian { alpha: 1e9 };
    for (integrator, method, instead) in [
        (IntegratorKind::Radau, feedback, IntegratorKind::Dop853),
        (IntegratorKind::Rattle, ConstraintMethod::Partitioning, IntegratorKind::Dop853),
        (IntegratorKind::Dop853, augmented, IntegratorKind::Trapezoidal),
    ] {
        let scene = treated(scene("simple-pendulum", 0.01), integrator, method);
        let summary = Simulation::new(&scene).unwrap().summary();
        assert_eq!(summary.integrator, instead);
        assert!(summary.reason.contains(&integrator.to_string()), "{}", summary.reason);
    }
}

/// A mass on a guide with a load along it, at 0.01 m from rest.
fn guided(load: &serde_json::Value, speed: f64, duration: f64, integrator: &str) -> Scene {
    let scene = serde_json::json!({
        "name": "guided",
        "gravity": [0.0, 0.0, 0.0],
        "bodies": [{"name": "mass", "mass": 1.0, "inertia": {"principal": [0.1, 0.1, 0.1]},
                    "position": [1.01, 0.0, 0.0], "velocity": [speed, 0.0, 0.0]}],
        "joints": [{"name": "guide", "type": "prismatic", "body_i": "ground", "body_j": "mass",
                    "point": [0.0, 0.0, 0.0], "axis": [1.0, 0.0, 0.0]}],
        "loads": [load],
        "simulation": {"duration": duration, "tolerance": 1e-8, "integrator": integrator}
    });
    Scene::from_json(&scene.to_string()).unwrap()
}

#[test]
fn stiff_loads_cost_few_steps_and_auto_knows_them() {
    let spring = |stiffness: f64, damping: f64| {
        serde_json::json!({"type": "spring", "name": "spring", "body_i": "ground", "point_i": [0.0, 0.0, 0.0],
            "body_j": "mass", "point_j": [0.0, 0.0, 0.0], "stiffness": stiffness, "free_length": 1.0,
            "damping": damping})
    };
    let friction = serde_json::json!({"type": "slider", "name": "friction", "joint": "guide",
        "friction": {"coulomb": 2.0, "smoothing": 1e-6}});
    // Overdamped: x = x₀ exp(−k t / d) but for 1e-3 of it; 1e10 N/m at twice critical damping is at rest at once.
    let cases = [
        (spring(1e8, 4e5), 0.0, 1.0, 0.0, 1e-7),
        (spring(1e10, 4e5), 0.0, 1.0, 0.0, 1e-7),
        (friction, 1.0, 1.0, 0.25 + 0.01, 1e-6),
    ];
    for (load, speed, duration, travel, bound) in cases {
        let scene = guided(&load, speed, duration, "auto");
        let (frame, run) = end(&scene);
        let summary = run.summary();
        println!(
            "{load}: {} steps, {} rejected, {} evaluations",
            summary.steps, summary.rejected, summary.evaluations
        );
        assert_eq!(summary.integrator, IntegratorKind::Radau, "{}", summary.reason);
        assert!(summary.steps + summary.rejected < 1500, "{summary:?}");
        let x = frame.bodies[0].position[0] - 1.0;
        assert!((x - travel).abs() < bound, "{x} instead of {travel}");
    }
    // Mild loads are left to the others.
    let mild = Simulation::new(&guided(&spring(100.0, 1.0), 0.0, 1.0, "auto")).unwrap().summary();
    assert_eq!(mild.integrator, IntegratorKind::Taylor);
    // What rests takes the series a step for every ten radians that a spring could make: few of them, or too many.
    for (stiffness, kind) in [(1.6e3, IntegratorKind::Taylor), (1e8, IntegratorKind::Radau)] {
        let mut load = spring(stiffness, 0.0);
        load["free_length"] = 1.01.into();
        let summary = Simulation::new(&guided(&load, 0.0, 1.0, "auto")).unwrap().summary();
        assert_eq!(summary.integrator, kind, "{stiffness:.0e} N/m: {}", summary.reason);
    }
}

#[test]
fn what_is_looked_at_between_steps_does_not_change_a_run_in_a_chart() {
    for (integrator, method) in [
        (IntegratorKind::Radau, ConstraintMethod::Projection),
        (IntegratorKind::Dop853, ConstraintMethod::Partitioning),
    ] {
        let mut scene = treated(scene("n-four-bar:2", 2.0), integrator, method);
        scene.simulation.tolerance = 1e-5;
        let (frame, _) = end(&scene);
        let mut looked = Simulation::new(&scene).unwrap();
        (1..=2000).for_each(|k| looked.advance_to(f64::from(k) * 1e-3).unwrap());
        assert_eq!(format!("{frame:?}"), format!("{:?}", looked.frame()), "{integrator:?}");
    }
}

/// Feedback holds the constraints as loosely as the tolerance lets it, and passes no singular position unharmed. A motion that goes astray
/// by more than ten tolerances is told: by an error of its size, or by a doubt.
#[test]
fn a_motion_that_feedback_lets_go_astray_says_so() {
    let feedback = ConstraintMethod::Baumgarte { alpha: 10.0, beta: 10.0 };
    let (mut told, mut doubted) = (0, 0);
    for name in ["n-four-bar:1", "n-four-bar:2", "n-four-bar:3", "crank-rocker", "spatial-slider-crank"] {
        let exact = treated(scene(name, 3.0), IntegratorKind::Taylor, ConstraintMethod::Projection);
        for integrator in [IntegratorKind::Dop853, IntegratorKind::Dopri5, IntegratorKind::Ode45] {
            for tolerance in [1e-3, 1e-4, 1e-5, 1e-6] {
                let mut scene = treated(scene(name, 3.0), integrator, feedback);
                scene.simulation.tolerance = tolerance;
                let (mut run, mut exact) =
                    (Simulation::new(&scene).unwrap(), Simulation::new(&exact).unwrap());
                for time in [0.5, 1.0, 1.5, 2.0, 2.5, 3.0] {
                    run.advance_to(time).unwrap();
                    exact.advance_to(time).unwrap();
                    let (error, summary) = (apart(&run.frame(), &exact.frame()), run.summary());
                    let estimated = summary.error.map_or(f64::NAN, |error| error.position);
                    let what = format!(
                        "{name} by {integrator:?} at {tolerance:.0e}, {time} s: {error:.1e}, told {estimated:.1e}"
                    );
                    if error > 10.0 * tolerance && summary.doubts.is_empty() {
                        assert!(estimated > error / 3.0, "{what}");
                        told += 1;
                    }
                    doubted += usize::from(error > 10.0 * tolerance && !summary.doubts.is_empty());
                }
            }
        }
    }
    println!("astray: {told} times told, {doubted} times doubted");
    assert!(told > 0 && doubted > 0, "{told}, {doubted}");
}

/// A block that dry friction brings to rest, smoothed at a millionth of its speed: v²/(2 a) far. Whatever step comes upon the end of the
/// motion, none goes over it.
#[test]
fn no_stiff_step_goes_over_the_end_of_sliding() {
    let friction = serde_json::json!({"type": "slider", "name": "friction", "joint": "guide",
        "friction": {"coulomb": 2.0, "smoothing": 1e-6}});
    for tolerance in [1e-5, 1e-7, 1e-9] {
        for speed in [0.9, 0.95, 1.0, 1.05, 1.1, 1.2] {
            let mut scene = guided(&friction, speed, 1.0, "radau");
            scene.simulation.tolerance = tolerance;
            let (frame, run) = end(&scene);
            let error = (frame.bodies[0].position[0] - 1.01 - 0.25 * speed * speed).abs();
            let summary = run.summary();
            println!("{tolerance:.0e}, {speed}: {error:.1e}, {} + {} steps", summary.steps, summary.rejected);
            assert!(error < tolerance.min(1e-9), "{tolerance:.0e}, {speed} m/s: off by {error:.1e} m");
        }
    }
}

/// The same where a force pushes the block to and fro, and it sticks in between: beside a method that knows no matrices.
#[test]
fn stiff_steps_see_blocks_stick_and_slip() {
    let friction = serde_json::json!({"type": "slider", "name": "friction", "joint": "guide",
        "force": {"kind": "harmonic", "amplitude": 3.0, "frequency": 0.5},
        "friction": {"coulomb": 2.0, "smoothing": 1e-3}});
    let at_end = |integrator: &str, tolerance: f64| {
        let mut scene = guided(&friction, 0.3, 4.0, integrator);
        scene.simulation.tolerance = tolerance;
        end(&scene).0.bodies[0].position[0]
    };
    let reference = at_end("dop853", 1e-10);
    for tolerance in [1e-4, 1e-6, 1e-8] {
        let error = (at_end("radau", tolerance) - reference).abs();
        println!("{tolerance:.0e}: {error:.1e}");
        assert!(error < 3.0 * tolerance, "{tolerance:.0e}: off by {error:.1e} m");
    }
}
