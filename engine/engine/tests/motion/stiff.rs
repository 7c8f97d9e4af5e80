//! Stiff and driven mechanisms by the implicit method, on problems whose references come from outside.

#![allow(clippy::panic, reason = "tests may panic, and write numbers as they were computed elsewhere")]
#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use crate::common::{problem, random_scene};
use crate::costs::damped;
use triad_engine::catalogue;
use triad_engine::prelude::{CustomLoad, Wrench};
use triad_engine::run::{Frame, Simulation};
use triad_engine::scene::{
    Body, ConstraintMethod, Coordinates, Driver, GROUND, IntegratorKind, Joint, Load, Motion, Scene,
};

/// A problem by an integrator, cut short.
fn by(name: &str, integrator: IntegratorKind, tolerance: f64, duration: f64) -> Scene {
    let mut scene = problem(name);
    let settings = &mut scene.simulation;
    (settings.integrator, settings.tolerance, settings.duration) = (integrator, tolerance, duration);
    scene
}

/// Largest distance of a centre of mass.
fn apart(a: &Frame, b: &Frame) -> f64 {
    let pairs = a.bodies.iter().zip(&b.bodies);
    pairs.flat_map(|(a, b)| (0..3).map(|k| (a.position[k] - b.position[k]).abs())).fold(0.0, f64::max)
}

fn end(scene: &Scene) -> (Frame, Simulation) {
    let mut run = Simulation::new(scene).unwrap();
    run.advance_to(run.duration()).unwrap_or_else(|error| panic!("{}: {error}", scene.name));
    (run.frame(), run)
}

#[test]
fn the_stiff_method_starts_from_driven_states_at_every_tolerance() {
    for (name, duration) in [
        ("driven-damper/scene", 0.1),
        ("driven-damper/radau", 0.3),
        ("car-axis/scene", 0.03),
        ("car-axis/points", 0.03),
        ("car-axis/box", 0.03),
    ] {
        let (exact, _) = end(&by(name, IntegratorKind::Taylor, 1e-12, duration));
        for exponent in 3..=10 {
            let tolerance = libm::pow(10.0, -f64::from(exponent));
            let (frame, run) = end(&by(name, IntegratorKind::Radau, tolerance, duration));
            let (error, steps) = (apart(&frame, &exact), run.summary().steps);
            println!("{name} at {tolerance:.0e}: {error:.1e}, {steps} steps");
            assert!(error < 10.0 * tolerance, "{name} at {tolerance:.0e}: {error:.1e}");
        }
    }
}

#[test]
fn a_mechanism_that_drivers_move_completely_runs_in_independent_coordinates() {
    for (name, duration) in [("squeezer/driven", 0.02), ("four-bars/crank-rocker", 1.5)] {
        let (exact, series) = end(&by(name, IntegratorKind::Taylor, 1e-12, duration));
        let scene = by(name, IntegratorKind::Radau, 1e-6, duration);
        let mut parted = by(name, IntegratorKind::Dop853, 1e-6, duration);
        parted.simulation.constraint_method = ConstraintMethod::Partitioning;
        for scene in [scene, parted] {
            let (frame, run) = end(&scene);
            let (error, summary) = (apart(&frame, &exact), run.summary());
            let wanted = series.summary();
            println!("{name}: {error:.1e}, {} steps, {} rejected", summary.steps, summary.rejected);
            assert!(error < 1e-9, "{name}: {error:.1e}");
            assert!(summary.position_violation < 1e-12 && summary.doubts.is_empty(), "{summary:?}");
            assert!((summary.work - wanted.work).abs() < 1e-6 * wanted.work.abs().max(1.0), "{summary:?}");
            // Between steps it is as exact as at their ends.
            let mut looked = Simulation::new(&scene).unwrap();
            looked.advance_to(0.37 * duration).unwrap();
            let mut series = Simulation::new(&by(name, IntegratorKind::Taylor, 1e-12, duration)).unwrap();
            series.advance_to(0.37 * duration).unwrap();
            assert!(apart(&looked.frame(), &series.frame()) < 1e-9);
        }
    }
}

/// A driver that waits does no work until it begins. The last step of rest ends there, not an instant later: what it does in that
/// instant is beyond all measure beside nothing.
#[test]
fn a_driver_that_waits_lets_the_stiff_method_go_on() {
    for start in [0.1, 0.15, 0.3] {
        let mut scene = Scene::new("a driver that waits").duration(1.0).integrator(IntegratorKind::Radau);
        let crank = scene.add(Body::rod("crank", 1.0, [0.0; 3], [1.0, 0.0, 0.0]));
        let rod = scene.add(Body::rod("rod", 1.0, [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]));
        let pin = Joint::revolute("pin", GROUND, crank.clone()).at([0.0; 3]).about([0.0, 0.0, 1.0]);
        let pin = scene.add(pin);
        scene.add(Joint::revolute("elbow", crank, rod).at([1.0, 0.0, 0.0]).about([0.0, 0.0, 1.0]));
        scene.add(Driver::angle("motor", pin, Motion::SmoothStep { from: 0.0, to: 0.7, start, end: 0.7 }));
        let (frame, run) = end(&scene);
        let summary = run.summary();
        println!("{start}: {} steps, {} rejected", summary.steps, summary.rejected);
        assert!(summary.rejected < 8 && summary.evaluations < 900, "{start}: {summary:?}");
        scene.simulation.integrator = IntegratorKind::Taylor;
        scene.simulation.tolerance = 1e-12;
        assert!(apart(&frame, &end(&scene).0) < 1e-6);
    }
}

/// Where a torque begins, a step ends: one that passes there may be eight tolerances off and not see it. Knots of a table, which
/// follow closely, take no more steps than the motion does.
#[test]
fn steps_end_where_a_torque_begins_but_not_at_each_knot() {
    let rods = |motion: Motion| {
        let mut scene = damped("1e3");
        scene.add(Load::motor("motor", "h0", motion));
        scene
    };
    let frames = |scene: Scene| {
        let mut run = Simulation::new(&scene).unwrap();
        let mut frame = |tenths: i32| {
            run.advance_to(0.1 * f64::from(tenths)).unwrap();
            run.frame()
        };
        (1..=40).map(&mut frame).collect::<Vec<Frame>>()
    };
    let mut largest = 0.0f64;
    for start in [0.9, 1.0, 1.1, 1.2, 1.3, 1.4] {
        let begins = rods(Motion::SmoothStep { from: 0.0, to: 20.0, start, end: start + 0.5 });
        let exact = frames(begins.clone().integrator(IntegratorKind::Taylor).tolerance(1e-12));
        for tolerance in [1e-6, 1e-8] {
            let found = frames(begins.clone().tolerance(tolerance));
            let error = found.iter().zip(&exact).map(|(a, b)| apart(a, b)).fold(0.0, f64::max);
            println!("{start} {tolerance:.0e}: {error:.1e}");
            largest = largest.max(error / tolerance);
        }
    }
    assert!(largest < 1.0, "{largest}");
    let times: Vec<f64> = (0..=1000).map(|k| 4e-3 * f64::from(k)).collect();
    let values = times.iter().map(|t| libm::sin(9.0 * t)).collect();
    let summary = end(&rods(Motion::Table { times, values }).tolerance(1e-6)).1.summary();
    assert!(summary.steps < 100, "{summary:?}");
}

#[test]
fn the_work_of_a_stiff_damper_is_no_doubt() {
    for tolerance in [1e-4, 1e-5, 1e-6] {
        let mut scene = by("driven-damper/scene", IntegratorKind::Radau, tolerance, 3.0);
        let text = scene.to_json().replace("1000000.0", "100000.0");
        scene = Scene::from_json(&text).unwrap();
        let summary = end(&scene).1.summary();
        println!("{tolerance:.0e}: drift {:.1e} J of {:.2e} J", summary.energy_drift, summary.work);
        assert!(summary.doubts.is_empty(), "{:?}", summary.doubts);
        assert!(summary.energy_drift.abs() < 1e-2, "{summary:?}");
    }
}

#[test]
fn forty_windows_go_through_at_a_tight_tolerance_or_say_that_it_is_too_tight() {
    let mut scene = catalogue::scene("n-four-bar:40").unwrap();
    scene.simulation.tolerance = 1e-12;
    let mut run = Simulation::new(&scene).unwrap();
    if let Err(error) = run.advance_to(run.duration()) {
        assert!(error.hint().contains("tenfold"), "{}", error.hint());
    }
}

#[test]
fn the_governor_costs_less_and_errs_more_at_looser_tolerances() {
    let (exact, _) = end(&by("governor/scene", IntegratorKind::Taylor, 1e-11, 2.0));
    let (mut error_before, mut work_before) = (f64::INFINITY, 0);
    for exponent in [3, 5, 7, 9] {
        let tolerance = libm::pow(10.0, -f64::from(exponent));
        let (frame, run) = end(&by("governor/scene", IntegratorKind::Radau, tolerance, 2.0));
        let (error, summary) = (apart(&frame, &exact), run.summary());
        let work = summary.evaluations;
        println!(
            "{tolerance:.0e}: {error:.1e}, {work} evaluations, {} factorizations",
            summary.factorizations
        );
        assert!(error < error_before && error < 10.0 * tolerance, "{tolerance:.0e}: {error:.1e}");
        assert!(work > work_before, "{tolerance:.0e}: {work} evaluations");
        // Coordinates of joints leave no multipliers to solve for.
        assert!(summary.factorizations <= 2 * summary.steps, "{summary:?}");
        (error_before, work_before) = (error, work);
    }
    let summary = end(&by("governor/scene", IntegratorKind::Radau, 1e-6, 10.0)).1.summary();
    assert!(summary.evaluations < 3500 && summary.steps < 100, "{summary:?}");
    // With one Jacobian matrix for all stages it takes 11 600.
    let from_rest = end(&by("governor/rest", IntegratorKind::Radau, 1e-6, 10.0)).1.summary();
    assert!(from_rest.evaluations < 8500, "{from_rest:?}");
    assert!(summary.position_violation < 1e-12, "{summary:?}");
}

#[test]
fn an_open_tree_moves_by_the_equations_of_its_joints() {
    let kinds: [fn(usize) -> &'static str; 2] =
        [|_| "full", |body| if body % 2 == 0 { "reduced" } else { "full" }];
    for seed in 1..=6 {
        for kind in kinds {
            let mut scene = random_scene(seed, 3, kind);
            let settings = &mut scene.simulation;
            (settings.duration, settings.tolerance) = (0.5, 1e-12);
            settings.integrator = IntegratorKind::Taylor;
            let (exact, _) = end(&scene);
            (scene.simulation.integrator, scene.simulation.tolerance) = (IntegratorKind::Radau, 1e-10);
            let (frame, run) = end(&scene);
            let (error, summary) = (apart(&frame, &exact), run.summary());
            println!("{seed}: {error:.1e}, {} factorizations", summary.factorizations);
            assert!(error < 1e-9, "{seed}: {error:.1e}");
            assert!(summary.factorizations <= 2 * summary.steps, "{summary:?}");
            assert!(summary.energy_drift.abs() < 1e-8, "{summary:?}");
        }
    }
}

#[test]
fn joints_of_every_kind_in_the_tree() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/scenes");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let named = |path: &std::path::PathBuf, start: &str| {
        path.file_name().unwrap().to_string_lossy().starts_with(start)
    };
    let mut seen = 0;
    for path in files.filter(|path| named(path, "joint-") || named(path, "spatial-") || named(path, "heavy"))
    {
        let mut scene = Scene::from_json(&std::fs::read_to_string(&path).unwrap()).unwrap();
        scene.simulation.duration = scene.simulation.duration.min(1.0);
        scene.simulation.step = None;
        let by = |integrator, tolerance, coordinates| {
            let mut scene = scene.clone();
            (scene.simulation.integrator, scene.simulation.tolerance) = (integrator, tolerance);
            scene.coordinates = coordinates;
            end(&scene)
        };
        let (exact, _) = by(IntegratorKind::Taylor, 1e-12, Coordinates::Full);
        // Reduced bodies have another particular acceleration.
        for coordinates in [Coordinates::Full, Coordinates::Reduced] {
            let (frame, run) = by(IntegratorKind::Radau, 1e-8, coordinates);
            let (error, summary) = (apart(&frame, &exact), run.summary());
            assert!(error < 1e-6, "{} {coordinates:?}: {error:.1e}", path.display());
            assert!(summary.position_violation < 1e-9, "{} {coordinates:?}: {summary:?}", path.display());
        }
        seen += 1;
    }
    assert!(seen >= 16, "{seen} scenes");
}

/// Three rods on hinges that are parallel to nothing, the middle one with a damper, N m s.
fn rods(damping: f64) -> Scene {
    let axes = [[0.0, 1.0, 1.0], [0.3, 1.0, -0.4], [0.1, -0.6, 1.0]];
    let bodies: Vec<_> = (0..3)
        .map(|k| {
            serde_json::json!({ "name": format!("b{k}"), "mass": 1, "inertia": { "principal": [0.02, 0.09, 0.08] },
            "position": [f64::from(k) + 0.5, 0, 0] })
        })
        .collect();
    let joints: Vec<_> = (0..3)
        .map(|k: usize| {
            let from = if k == 0 { "ground".to_owned() } else { format!("b{}", k - 1) };
            serde_json::json!({ "name": format!("h{k}"), "type": "revolute", "point": [k, 0, 0], "axis": axes[k],
            "body_i": from, "body_j": format!("b{k}") })
        })
        .collect();
    let scene = serde_json::json!({ "name": "rods", "gravity": [0, 0, -9.81], "bodies": bodies, "joints": joints,
        "loads": [{ "type": "torsion", "name": "damper", "joint": "h1", "damping": damping }],
        "simulation": { "duration": 4 } });
    Scene::from_json(&scene.to_string()).unwrap()
}

/// What such a damper holds turns with the rods: corrections of the stages may grow before they shrink.
#[test]
fn a_damper_that_all_but_locks_a_joint_takes_long_steps_at_every_tolerance() {
    let by = |tolerance| {
        let mut scene = rods(1e5);
        (scene.simulation.integrator, scene.simulation.tolerance) = (IntegratorKind::Radau, tolerance);
        end(&scene)
    };
    // The series agree to 6e-10 m with it, but take a second; the damper makes 7e-9 m of rounding at 1e-12.
    let (exact, _) = by(1e-10);
    for exponent in 3..=9 {
        let tolerance = libm::pow(10.0, -f64::from(exponent));
        let (frame, run) = by(tolerance);
        let (error, summary) = (apart(&frame, &exact), run.summary());
        println!("{tolerance:.0e}: {error:.1e}, {} steps, {} rejected", summary.steps, summary.rejected);
        assert!(error < 10.0 * tolerance, "{tolerance:.0e}: {error:.1e}");
        assert!(summary.steps < 120 && summary.rejected < 40, "{tolerance:.0e}: {summary:?}");
    }
}

#[test]
fn the_stiff_method_is_taken_where_an_open_tree_makes_it_cheap() {
    // The run has 6.5 decays for each N m s.
    for (damping, wanted) in [(20.0, IntegratorKind::Taylor), (100.0, IntegratorKind::Radau)] {
        let run = Simulation::new(&rods(damping)).unwrap();
        assert_eq!(run.summary().integrator, wanted, "{damping}");
    }
}

#[test]
fn a_stiff_governor_gets_the_stiff_method_at_every_tolerance() {
    for name in ["governor/scene", "governor/balls", "governor/rest"] {
        for exponent in 3..=10 {
            let tolerance = libm::pow(10.0, -f64::from(exponent));
            let run = Simulation::new(&by(name, IntegratorKind::Auto, tolerance, 10.0)).unwrap();
            assert_eq!(run.summary().integrator, IntegratorKind::Radau, "{name} at {tolerance:.0e}");
        }
    }
}

/// At loose tolerances a whole step leads off the constraints there, and a shorter one does not.
#[test]
fn beside_a_change_point_a_driven_mechanism_runs_to_its_end_at_every_tolerance() {
    let name = "four-bars/near-change-point";
    let (exact, _) = end(&by(name, IntegratorKind::Taylor, 1e-12, 4.0));
    for integrator in
        [IntegratorKind::Auto, IntegratorKind::Taylor, IntegratorKind::Dop853, IntegratorKind::Radau]
    {
        for exponent in 3..=10 {
            let tolerance = libm::pow(10.0, -f64::from(exponent));
            let (frame, _) = end(&by(name, integrator, tolerance, 4.0));
            let error = apart(&frame, &exact);
            assert!(error < 1e-9, "{integrator} at {tolerance:.0e}: {error:.1e}");
        }
    }
}

/// Of an open tree, stages of a step are evaluated beside each other, unless a load is there that asks for a state in place: one that
/// pushes nothing makes the same motion one by one.
#[test]
fn stages_beside_each_other_move_as_one_by_one() {
    let text = r#"{"name": "all loads", "gravity": [0.3, 0, -9.81],
        "bodies": [{"name": "arm", "mass": 1.2, "inertia": {"principal": [0.02, 0.09, 0.08]}, "position": [0.5, 0, 0]},
            {"name": "sledge", "mass": 0.7, "inertia": {"principal": [0.01, 0.02, 0.03]}, "position": [1, 0.2, 0]},
            {"name": "ball", "mass": 0.4, "inertia": {"principal": [0.03, 0.02, 0.01]}, "position": [1, 0.2, 0.5]},
            {"name": "free", "mass": 0.9, "inertia": {"principal": [0.04, 0.05, 0.06]}, "position": [0, 2, 0]}],
        "joints": [{"name": "hinge", "type": "revolute", "body_i": "arm", "body_j": "ground", "point": [0, 0, 0], "axis": [0.2, 1, 0.1]},
            {"name": "slide", "type": "prismatic", "body_i": "arm", "body_j": "sledge", "point": [1, 0, 0], "axis": [0.1, 0.3, 1]},
            {"name": "socket", "type": "spherical", "body_i": "sledge", "body_j": "ball", "point": [1, 0.2, 0.1]}],
        "loads": [{"type": "torsion", "name": "a", "joint": "hinge", "stiffness": 20, "damping": 300,
                "torque": {"kind": "harmonic", "amplitude": 4, "frequency": 1.5}},
            {"type": "slider", "name": "b", "joint": "slide", "stiffness": 90, "damping": 40, "free_length": 0.1,
                "friction": {"coulomb": 0.5, "smoothing": 0.1}},
            {"type": "spring", "name": "c", "body_i": "ball", "point_i": [0.1, 0, 0.1], "body_j": "ground", "point_j": [2, 1, 1],
                "stiffness": 40, "damping": 15, "free_length": 1},
            {"type": "spring", "name": "d", "body_i": "free", "point_i": [0, 0.1, 0], "body_j": "arm", "point_j": [0.2, 0, 0.1], "stiffness": 30,
                "damping": 5, "free_length": 1},
            {"type": "force", "name": "e", "body": "free", "point": [0.1, 0.2, 0], 
                "force": {"kind": "turning", "start": [0.5, 1, 2], "axis": [1, 1, 0], "angle": {"kind": "ramp", "rate": 2}}, "frame": "body"},
            {"type": "moment", "name": "f", "body": "sledge", "moment": {"kind": "turning", "start": [3, 0, 1], "axis": [1, 1, 0], "angle": {"kind": "ramp", "rate": 2}}}],
        "simulation": {"duration": 2, "integrator": "radau", "tolerance": 1e-10, "error_estimate": false}}"#;
    let scene = Scene::from_json(text).unwrap();
    let (beside, run) = end(&scene);
    let mut one_by_one =
        Simulation::with_loads(&scene, [CustomLoad::new("nothing", "free", |_| Wrench::force([0.0; 3]))])
            .unwrap();
    one_by_one.advance_to(2.0).unwrap();
    let off = apart(&beside, &one_by_one.frame());
    let [work, other] = [run.summary().work, one_by_one.summary().work];
    println!("{off:.1e}, work {work} and {other}");
    assert!(off < 1e-9 && (work - other).abs() < 1e-7, "{off:.1e}, work {work} and {other}");
}

/// A mass on a rail that swings on a spring, x = a e^(−γt) cos ωt, and a stiff damper elsewhere, for whose sake the stiff method is taken:
/// its steps skip the swings, and damp them.
fn quiver(stiffness: f64, amplitude: f64, own_damping: f64) -> Scene {
    let block = |name: &str, y: f64| serde_json::json!({"name": name, "mass": 1, "inertia": {"principal": [0.1, 0.1, 0.1]}, "position": [0, y, 0]});
    let rail = |name: &str, i: &str, j: &str, y: f64, axis: [f64; 3], start: serde_json::Value| serde_json::json!({"name": name, "type": "prismatic", "body_i": i, "body_j": j, "point_i": [0, y, 0], "point_j": [0, 0, 0], "axis_i": axis, "axis_j": axis, "start": start});
    let value = serde_json::json!({
        "name": "quiver", "gravity": [0, 0, 0], "bodies": [block("m", 0.0), block("d", 1.0)],
        "joints": [
            rail("rail", "ground", "m", 0.0, [1.0, 0.0, 0.0], serde_json::json!({"slide": amplitude})),
            rail("pot", "m", "d", 1.0, [0.0, 1.0, 0.0], serde_json::json!({"speed": 1}))
        ],
        "loads": [
            {"name": "spring", "type": "slider", "joint": "rail", "stiffness": stiffness, "damping": own_damping},
            {"name": "damper", "type": "slider", "joint": "pot", "damping": 1e5}
        ],
        "simulation": {"duration": 0.5}
    });
    Scene::from_json(&value.to_string()).unwrap().integrator(IntegratorKind::Radau)
}

#[test]
fn a_vibration_that_both_solutions_lose_stays_in_the_error() {
    // Two blocks move along the rail.
    for (stiffness, amplitude, tolerance) in [(2e7, 1e-5, 1e-3), (2e7, 1e-4, 1e-2), (2e7, 1e-6, 1e-4)] {
        let mut run = Simulation::new(&quiver(stiffness, amplitude, 0.0).tolerance(tolerance)).unwrap();
        let omega = (stiffness / 2.0).sqrt();
        for row in 1..=50 {
            run.advance_to(0.01 * f64::from(row)).unwrap();
            let turn = omega * run.time();
            let [x, v] = [amplitude * libm::cos(turn), -amplitude * omega * libm::sin(turn)];
            let body = run.frame().bodies[0];
            let [off, faster] = [(body.position[0] - x).abs(), (body.velocity[0] - v).abs()];
            let told = run.error_estimate().unwrap();
            // Positions and velocities pass through zero in turns.
            let [worth, error] = [omega * told.position + told.velocity, omega * off + faster];
            assert!(worth > 0.1 * error, "{row}: {told:?} for {off:e} m and {faster:e} m/s");
            assert!(worth < 8.0 * amplitude * omega, "{row}: {told:?}");
        }
        assert!(run.frame().bodies[0].position[0].abs() < 0.1 * amplitude, "it is not lost");
    }
}

#[test]
fn a_vibration_that_dampers_end_leaves_the_error() {
    let (stiffness, damping, amplitude) = (2e7, 160.0, 1e-5);
    let mut run = Simulation::new(&quiver(stiffness, amplitude, damping).tolerance(1e-3)).unwrap();
    run.advance_to(0.02).unwrap();
    let early = run.error_estimate().unwrap();
    run.advance_to(0.5).unwrap();
    let late = run.error_estimate().unwrap();
    // γ = c/2m = 40/s for 0.48 s.
    assert!(late.position < 1e-6 * early.position.max(amplitude), "{early:?}, {late:?}");
}
