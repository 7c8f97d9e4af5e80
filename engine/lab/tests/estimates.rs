//! Error estimates hold what docs/ACCURACY.md promises, on a sample.

use std::sync::LazyLock;
use triad_engine::catalogue;
use triad_engine::run::Simulation;
use triad_lab::estimates::{Judged, QUANTITIES, Quantity, WAYS, in_the_way, judge, judge_all, scenes};
use triad_lab::stress::random;
use triad_lab::verify::Verifier;
use triad_scene::{IntegratorKind, Scene};

/// Estimates of all quantities of runs by `taylor`.
static SAMPLE: LazyLock<Vec<Judged>> = LazyLock::new(|| {
    let mut judged: Vec<Judged> = Vec::new();
    for scene in &scenes(60) {
        for tolerance in [1e-3, 1e-4, 1e-6, 1e-9] {
            // A driver may ask for more than drawn loops allow.
            judged.extend(judge_all(&scene.clone().tolerance(tolerance)).unwrap_or_default());
        }
    }
    judged
});

fn sample_of(quantity: Quantity) -> Vec<&'static Judged> {
    SAMPLE.iter().filter(|one| one.quantity == quantity).collect()
}

#[test]
fn estimates_are_within_a_factor_of_three_of_the_error() {
    let judged = sample_of(Quantity::Position);
    let good = judged.iter().filter(|one| one.is_good()).count();
    assert!(judged.len() > 3000 && 100 * good >= 97 * judged.len(), "{good} of {}", judged.len());
    // Where two contributions cancel for a moment, an estimate may pass through zero.
    let bad: Vec<&&Judged> = judged.iter().filter(|one| one.is_bad()).collect();
    assert!(1000 * bad.len() <= judged.len(), "{bad:?}");
}

/// Velocities, the energy, forces and moments likewise, each judged by itself.
#[test]
fn estimates_of_all_quantities_are_within_a_factor_of_three() {
    for quantity in QUANTITIES {
        let of = sample_of(quantity);
        let good = of.iter().filter(|one| one.is_good()).count();
        assert!(of.len() > 2500 && 100 * good >= 97 * of.len(), "{quantity:?}: {good} of {}", of.len());
        let bad: Vec<&&Judged> = of.iter().filter(|one| one.is_bad()).collect();
        assert!(500 * bad.len() <= of.len(), "{quantity:?}: {bad:?}");
    }
}

/// Estimates that were a tenth of the error and less, down to a hundredth: contributions cancel for a moment in what is estimated, but not
/// in what is so.
#[test]
fn estimates_do_not_vanish_where_contributions_cancel() {
    for (quantity, cases) in [
        (Quantity::AngularVelocity, &[(107, 1e-3), (258, 1e-4), (92, 1e-4), (394, 1e-8)][..]),
        (Quantity::Energy, &[(107, 1e-3), (21, 1e-3), (111, 1e-3), (146, 1e-4), (169, 1e-4), (113, 1e-6)]),
        (Quantity::Force, &[(107, 1e-3), (170, 1e-3), (159, 1e-3), (418, 1e-3), (499, 1e-4), (382, 1e-6)]),
        (Quantity::Moment, &[(123, 1e-3), (107, 1e-3), (457, 1e-3), (103, 1e-4), (499, 1e-4)]),
    ] {
        for &(seed, tolerance) in cases {
            let mut judged = judge_all(&random::scene(seed).tolerance(tolerance)).unwrap();
            judged.retain(|one| one.quantity == quantity);
            let bad: Vec<&Judged> = judged.iter().filter(|one| one.is_bad()).collect();
            assert!(judged.len() >= 3 && bad.is_empty(), "{bad:?} of {}", judged.len());
        }
    }
}

/// Near a singular position a rounding of the state changes forces by a twentieth: two runs that agree in it only seem to know them.
#[test]
fn forces_that_rounding_changes_are_not_told_to_be_exact() {
    let mut run = Simulation::new(&random::scene(292).tolerance(1e-4)).unwrap();
    run.advance_to(0.025).unwrap();
    let errors = run.reaction_errors().unwrap();
    assert!(errors.force > 1e-5 * errors.largest_force, "{errors:?}");
}

/// Rows that depend on others leave their multipliers open, and rounding fills them: by a thousandth of the largest force, and what is said
/// of it by more, if it is not taken out.
#[test]
fn reactions_of_dependent_rows_hold_no_rounding() {
    let judged = judge_all(&catalogue::scene("bricard").unwrap().tolerance(1e-6)).unwrap();
    let forces: Vec<&Judged> = judged.iter().filter(|one| one.quantity == Quantity::Force).collect();
    assert!(forces.len() >= 15 && forces.iter().all(|one| one.is_good()), "{forces:?}");
    assert!(forces.iter().all(|one| one.error < 1e-5 * one.size), "{forces:?}");
}

/// Of a chain that hangs at rest forces are known to rounding, and moments are nothing but that: they say nothing about themselves.
#[test]
fn moments_that_are_rounding_are_not_measured_by_themselves() {
    let link = |name: &str, z: f64| {
        let tensor = [[0.1, 0.01, 0.003], [0.01, 0.2, 0.02], [0.003, 0.02, 0.15]];
        serde_json::json!({ "name": name, "mass": 1.3, "position": [0.3, 0.1, z], "inertia": { "tensor": tensor } })
    };
    let hinge = |name: &str, bodies: [&str; 2], from: [f64; 3], to: f64| {
        let axis = [0.3, 1.0, 0.0];
        serde_json::json!({ "name": name, "type": "revolute", "body_i": bodies[0], "body_j": bodies[1], "point_i": from,
            "point_j": [0.0, 0.0, to], "axis_i": axis, "axis_j": axis })
    };
    let scene = serde_json::json!({ "name": "hanging", "gravity": [0.0, 0.0, -9.81],
        "bodies": [link("b", -1.7), link("c", -2.7)],
        "joints": [hinge("j", ["ground", "b"], [0.3, 0.1, -1.0], 0.7), hinge("k", ["b", "c"], [0.0, 0.0, -0.5], 0.5)],
        "loads": [{ "name": "d", "type": "torsion", "joint": "j", "damping": 100.0 }],
        "simulation": { "duration": 3.0, "integrator": "radau" } });
    let mut run = Simulation::new(&Scene::from_json(&scene.to_string()).unwrap()).unwrap();
    run.advance_to(3.0).unwrap();
    let errors = run.reaction_errors().unwrap();
    assert!(errors.largest_force > 25.0 && errors.relative() < 1e-12, "{errors:?}");
}

/// By every integrator and treatment, from a second solution.
#[test]
fn every_method_says_what_its_result_is_worth() {
    for way in WAYS.iter().filter(|&&way| way != "taylor") {
        let mut judged: Vec<Judged> = Vec::new();
        for scene in &scenes(2) {
            let scene = in_the_way(scene, way).unwrap().tolerance(1e-5);
            // Not every method runs every scene.
            judged.extend(judge(&scene).unwrap_or_default());
        }
        let good = judged.iter().filter(|one| one.is_good()).count();
        assert!(judged.len() > 40 && 100 * good >= 95 * judged.len(), "{way}: {good} of {}", judged.len());
        let bad: Vec<&Judged> = judged.iter().filter(|one| one.is_bad()).collect();
        assert!(bad.is_empty(), "{way}: {bad:?}");
    }
}

/// Two runs by radau whose steps only grow from the first one agree in their errors if they take the same, or if they make as many
/// iterations of Newton's method; and where a run is for a moment off by what its second solution is off, the two agree.
#[test]
fn a_second_solution_shares_no_error_with_radau() {
    let mut judged: Vec<Judged> = Vec::new();
    for scene in scenes(25).iter().chain(&[86, 217, 225].map(random::scene)) {
        let scene = in_the_way(scene, "radau").unwrap().tolerance(1e-3);
        judged.extend(judge(&scene).unwrap_or_default());
    }
    let good = judged.iter().filter(|one| one.is_good()).count();
    assert!(judged.len() > 400 && 100 * good >= 99 * judged.len(), "{good} of {}", judged.len());
    let bad: Vec<&Judged> = judged.iter().filter(|one| one.is_bad()).collect();
    assert!(bad.is_empty(), "{bad:?}");
}

/// Beside the stiff method the second solution takes the same steps and begins with what the first one has found: what Newton's method
/// leaves of the difference must not become the difference.
#[test]
fn the_estimate_of_a_stiff_run_is_as_good() {
    for name in ["scene", "rest"] {
        let file = format!("{}/../../tests/data/problems/governor/{name}.json", env!("CARGO_MANIFEST_DIR"));
        let scene = Scene::from_json(&std::fs::read_to_string(file).unwrap()).unwrap();
        let mut judged: Vec<Judged> = Vec::new();
        for tolerance in [1e-3, 1e-6, 1e-8] {
            judged.extend(judge(&in_the_way(&scene, "radau").unwrap().tolerance(tolerance)).unwrap());
        }
        let good = judged.iter().filter(|one| one.is_good()).count();
        assert!(judged.len() >= 40 && 100 * good >= 90 * judged.len(), "{name}: {good} of {judged:?}");
        let bad = judged.iter().filter(|one| one.is_bad()).count();
        assert!(bad <= 1, "{name}: {bad} of {judged:?}");
    }
}

/// Neighbouring motions part: after the moment that the run tells, it gives no figure any more.
#[test]
fn a_chaotic_run_says_from_when_on_it_knows_nothing() {
    for integrator in [IntegratorKind::Taylor, IntegratorKind::Dop853] {
        let scene = catalogue::scene("spatial-double-pendulum").unwrap().duration(60.0).tolerance(1e-5);
        let mut run = Simulation::new(&scene.integrator(integrator)).unwrap();
        run.advance_to(60.0).unwrap();
        let summary = run.summary();
        let from = summary.error_unknown_from.unwrap();
        assert!(5.0 < from && from < 60.0 && summary.error.is_none(), "{integrator}: {from}");
        assert!(
            summary.doubts.iter().any(|doubt| doubt.contains("nothing is known")),
            "{:?}",
            summary.doubts
        );
    }
}

/// Two thousand seconds at a loose tolerance: the phase is lost long before the end, and the run says so.
#[test]
fn a_long_run_is_not_silent() {
    let scene = catalogue::scene("simple-pendulum").unwrap().duration(2000.0).tolerance(1e-4);
    let mut run = Simulation::new(&scene).unwrap();
    run.advance_to(2000.0).unwrap();
    let summary = run.summary();
    let told = |of: &str| summary.doubts.iter().filter(|doubt| doubt.contains(of)).count();
    assert_eq!(
        (told("nothing is known of the error"), told("came from nowhere")),
        (1, 1),
        "{:?}",
        summary.doubts
    );
    assert_eq!(summary.doubts.len(), 2, "{:?}", summary.doubts);
    assert!(summary.error.is_none_or(|error| error.position > 0.01));
}

/// What is left out of an error that is carried along adds up with the time: of hundreds of steps it must not make another error, least of
/// all at loose tolerances, where only the energy tells it.
#[test]
fn the_estimate_of_a_long_run_is_as_good() {
    for (name, duration, tolerance) in [
        ("simple-pendulum", 150.0, 1e-8),
        ("simple-pendulum", 300.0, 1e-6),
        ("simple-pendulum", 120.0, 1e-5),
        ("spatial-slider-crank", 24.0, 1e-8),
        ("n-four-bar:2", 40.0, 1e-8),
    ] {
        let scene = catalogue::scene(name).unwrap().duration(duration).tolerance(tolerance);
        let judged = judge(&scene).unwrap();
        let good = judged.iter().filter(|one| one.is_good()).count();
        assert!(judged.len() >= 15 && 100 * good >= 90 * judged.len(), "{name}: {good} of {judged:?}");
    }
}

/// The same where no energy is kept: of a pendulum on a spring that pulls now more, now less, and of a top that is driven round.
#[test]
fn the_estimate_of_a_long_driven_run_is_as_good() {
    let pendulum = serde_json::json!({
        "name": "pulled", "title": "A pendulum and an actuated spring", "gravity": [0, -9.81, 0],
        "bodies": [{ "name": "rod", "mass": 1.2, "inertia": { "principal": [0.0005, 0.1, 0.1] }, "center_of_mass": [0.5, 0, 0] }],
        "joints": [{ "name": "pivot", "type": "revolute", "body_i": "ground", "body_j": "rod", "point": [0, 0, 0],
            "axis": [0, 0, 1], "start": { "angle": -1.2 } }],
        "loads": [{ "name": "spring", "type": "spring", "body_i": "ground", "body_j": "rod", "point_i": [0.3, -1, 0.1],
            "point_j": [0.8, 0, 0.1], "stiffness": 40, "free_length": 0.3,
            "force": { "kind": "harmonic", "mean": 0, "amplitude": 0.4, "frequency": 1.3, "phase": 0.2 } }],
    });
    let top = serde_json::json!({
        "name": "pushed", "title": "A top that a moment pushes", "gravity": [0, -9.81, 0],
        "bodies": [{ "name": "top", "mass": 1, "inertia": { "principal": [0.02, 0.03, 0.05] },
            "center_of_mass": [0.1, 0.02, 0.3], "angular_velocity": [0.3, 0.2, 25] }],
        "joints": [{ "name": "ball", "type": "spherical", "body_i": "ground", "body_j": "top", "point": [0, 0, 0] }],
        "loads": [{ "name": "push", "type": "moment", "body": "top", "moment": [0, 0.05, 0] }],
    });
    for (scene, duration, tolerance) in
        [(&pendulum, 300.0, 1e-7), (&pendulum, 160.0, 1e-5), (&pendulum, 300.0, 1e-10), (&top, 180.0, 1e-7)]
    {
        let scene = Scene::from_json(&scene.to_string()).unwrap().duration(duration).tolerance(tolerance);
        let judged = judge(&scene).unwrap();
        let good = judged.iter().filter(|one| one.is_good()).count();
        assert!(
            judged.len() >= 15 && 100 * good >= 95 * judged.len() && !judged.iter().any(Judged::is_bad),
            "{}, {tolerance:e}: {good} of {judged:?}",
            scene.name
        );
    }
}

/// The same by radau, whose second solution goes on from where the run came to: what Newton's method leaves of their difference adds up.
#[test]
fn the_estimate_of_a_long_run_by_radau_is_as_good() {
    let mut scene: serde_json::Value =
        serde_json::from_str(&catalogue::scene("simple-pendulum").unwrap().to_json()).unwrap();
    scene["loads"] = serde_json::json!([{ "type": "spring", "name": "soft", "body_i": "ground", "point_i": [0, -2, 0],
        "body_j": "bob", "point_j": [0, 0, 0], "stiffness": 3, "free_length": 1 }]);
    let scene = Scene::from_json(&scene.to_string()).unwrap().integrator(IntegratorKind::Radau);
    for (tolerance, duration) in [(1e-4, 30.0), (1e-6, 60.0), (1e-8, 60.0)] {
        let judged = judge(&scene.clone().duration(duration).tolerance(tolerance)).unwrap();
        assert!(judged.len() >= 15 && judged.iter().all(Judged::is_good), "{tolerance:e}: {judged:?}");
    }
}

/// The same of a pendulum on a spring, whose potential counts.
#[test]
fn the_energy_of_springs_tells_of_errors_too() {
    let mut scene: serde_json::Value =
        serde_json::from_str(&catalogue::scene("simple-pendulum").unwrap().to_json()).unwrap();
    for load in [
        serde_json::json!({ "type": "spring", "name": "soft", "body_i": "ground", "point_i": [0, -2, 0],
            "body_j": "bob", "point_j": [0, 0, 0], "stiffness": 3, "free_length": 1 }),
        serde_json::json!({ "type": "torsion", "name": "soft", "joint": "pin", "stiffness": 3, "free_angle": 0.4 }),
    ] {
        scene["loads"] = serde_json::json!([load]);
        let scene = Scene::from_json(&scene.to_string()).unwrap().duration(200.0).tolerance(1e-7);
        let judged = judge(&scene).unwrap();
        assert!(judged.len() >= 15 && judged.iter().all(Judged::is_good), "{judged:?}");
    }
}

/// A pendulum that dry friction slows down, for which there is no series.
fn rubbing_pendulum() -> serde_json::Value {
    serde_json::json!({
        "name": "rubbing", "gravity": [0, -9.81, 0],
        "bodies": [{ "name": "rod", "mass": 1, "inertia": { "principal": [0.1, 0.1, 0.1] }, "center_of_mass": [0.5, 0, 0] }],
        "joints": [{ "name": "pin", "type": "revolute", "body_i": "ground", "body_j": "rod", "point": [0, 0, 0], "axis": [0, 0, 1] }],
        "loads": [{ "name": "rub", "type": "torsion", "joint": "pin", "friction": { "coefficient": 0.02, "radius": 0.05, "smoothing": 0.5 } }],
        "simulation": { "duration": 60 }
    })
}

/// Where the second solution is by the same method it must not be at the same tolerance: then it is the same run, and no error lies
/// between them.
#[test]
fn a_second_solution_by_the_same_method_is_another_run() {
    let pendulum = Scene::from_json(&rubbing_pendulum().to_string()).unwrap();
    let at_end = |integrator, tolerance| {
        let mut run = Simulation::new(&pendulum.clone().integrator(integrator).tolerance(tolerance)).unwrap();
        run.advance_to(60.0).unwrap();
        (run.frame().bodies[0].position, run.summary().error.unwrap().position)
    };
    let (exact, _) = at_end(IntegratorKind::Radau, 1e-14);
    for tolerance in [1e-10, 1e-11, 2e-12, 1e-12, 6e-13, 4e-13, 1e-13] {
        let (found, told) = at_end(IntegratorKind::Dop853, tolerance);
        let error = found.iter().zip(exact).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
        let least = if error > 1e-13 { 0.3 * error } else { 0.0 };
        assert!(least <= told && told < 1e-7, "{tolerance:e}: {told:e} for {error:e}");
    }
}

/// The same of `--verify`; and a scene without a series can be verified.
#[test]
fn a_run_is_verified_by_another_run() {
    for (integrator, tolerance) in [
        (IntegratorKind::Dop853, 1e-6),
        (IntegratorKind::Dopri5, 1e-6),
        (IntegratorKind::Radau, 1e-6),
        (IntegratorKind::Radau, 1e-12),
        (IntegratorKind::Radau, 1e-13),
        (IntegratorKind::Dop853, 1e-13),
    ] {
        let scene = Scene::from_json(&rubbing_pendulum().to_string())
            .unwrap()
            .duration(5.0)
            .integrator(integrator)
            .tolerance(tolerance);
        let mut run = Simulation::new(&scene).unwrap();
        let mut verifier =
            Verifier::new(&scene, &run).unwrap_or_else(|error| panic!("{integrator}: {error}"));
        run.advance_to(5.0).unwrap();
        assert!(verifier.compare(&run, u64::MAX));
        let found = verifier.found();
        assert!(0.0 < found.position && found.position < 1e-4, "{integrator} at {tolerance:e}: {found:?}");
        assert!(found.contradiction.is_none() && found.doubts(&run).is_empty(), "{found:?}");
    }
}

/// What a step adds is told with all terms that it leaves out, not by the first one alone: else the first steps of this run nearly cancel in
/// the estimate (4e-8 m for 7e-6 m), and not in the error.
#[test]
fn the_errors_of_few_steps_do_not_cancel_in_the_estimate_alone() {
    let scene = Scene::from_json(include_str!("data/plane-slider-with-rod.json")).unwrap();
    let judged = judge(&scene.integrator(IntegratorKind::Taylor).tolerance(1e-4)).unwrap();
    let bad: Vec<&Judged> = judged.iter().filter(|one| one.is_bad()).collect();
    assert!(judged.len() > 10 && bad.is_empty(), "{bad:?}");
}

/// Where an estimate is wrong, the second solution of a verification says so.
#[test]
fn a_verification_contradicts_an_estimate_that_is_too_small() {
    let text = include_str!("data/plane-mechanism-with-rod.json");
    let time = 0.24;
    let scene = Scene::from_json(text).unwrap().duration(time).tolerance(1e-3);
    let mut run = Simulation::new(&scene).unwrap();
    let mut verifier = Verifier::new(&scene, &run).unwrap();
    run.advance_to(time).unwrap();
    assert!(verifier.compare(&run, u64::MAX));
    let found = verifier.found().contradiction.unwrap();
    assert!(found.apart > 10.0 * found.told && (found.apart - 2.4e-5).abs() < 1e-6, "{found:?}");
    assert!(verifier.found().doubts(&run).iter().any(|doubt| doubt.contains("one of them is wrong")));
}

/// The estimate changes nothing of the motion, nor of what it took.
#[test]
fn a_run_without_it_has_the_same_bits() {
    let built_in = ["n-four-bar:2", "bricard", "spatial-chain:5", "heavy-top", "simple-pendulum"];
    let taylor = built_in.map(|name| catalogue::scene(name).unwrap());
    let taylor = taylor.into_iter().chain((0..12).map(random::scene));
    let others = [IntegratorKind::Dop853, IntegratorKind::Radau, IntegratorKind::Rattle];
    let others = others.map(|kind| catalogue::scene("spatial-double-pendulum").unwrap().integrator(kind));
    let mut compared = 0;
    for scene in taylor.map(|scene| scene.integrator(IntegratorKind::Taylor)).chain(others) {
        let name = &scene.name;
        let mut without = scene.clone();
        without.simulation.error_estimate = false;
        // A driver may ask for more than drawn loops allow.
        let [Ok(mut a), Ok(mut b)] = [&scene, &without].map(Simulation::new) else { continue };
        compared += 1;
        for k in 1..=10 {
            let time = 0.1 * f64::from(k) * scene.simulation.duration;
            let outcomes = [a.advance_to(time), b.advance_to(time)].map(|outcome| outcome.is_ok());
            assert_eq!(outcomes[0], outcomes[1], "{name}");
            let bits = |run: &Simulation| {
                let all = run.q().iter().chain(run.q_dot());
                all.map(|x| x.to_bits()).collect::<Vec<u64>>()
            };
            assert_eq!(bits(&a), bits(&b), "{name}");
        }
        let (mut a, b) = (a.summary(), b.summary());
        assert!((a.error.is_some() || a.error_unknown_from.is_some()) && b.error.is_none(), "{name}");
        if a.error_unknown_from.is_none() {
            (a.error, a.error_method) = (None, None);
            assert_eq!(a, b, "{name}");
        }
    }
    assert!(compared >= 15, "{compared}");
}
