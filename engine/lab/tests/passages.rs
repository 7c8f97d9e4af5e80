//! Singular positions that runs pass: all of them, none invented, at their times and with all joints that take part; and
//! positions where branches of the motion only come near each other.

#![allow(clippy::unwrap_used, missing_docs)]

use serde_json::{Value, json};
use std::f64::consts::PI;
use triad_engine::Scene;
use triad_engine::run::{Simulation, Summary};
use triad_engine::system::islands::has_loops;
use triad_lab::verify::Verifier;
use triad_scene::IntegratorKind::{self, Dop853, Dopri5, Ode45, Radau, Taylor, Trapezoidal};
use triad_scene::{ConstraintMethod, catalogue};

const TOLERANCES: [f64; 6] = [1e-3, 1e-4, 1e-6, 1e-8, 1e-9, 1e-12];

fn problem(path: &str) -> Scene {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/problems/");
    Scene::from_json(&std::fs::read_to_string(format!("{folder}{path}")).unwrap()).unwrap()
}

fn scene_of(scene: &Scene, integrator: IntegratorKind, tolerance: f64) -> Scene {
    let mut scene = scene.clone();
    (scene.simulation.integrator, scene.simulation.tolerance) = (integrator, tolerance);
    scene
}

fn run(scene: &Scene, integrator: IntegratorKind, tolerance: f64) -> Simulation {
    let mut run = Simulation::new(&scene_of(scene, integrator, tolerance)).unwrap();
    run.set_step_limit(3_000);
    run
}

/// Runs a scene: it passes singular positions at the exact times and at no others, with these joints.
fn passes(
    scene: &Scene,
    kinds: &[IntegratorKind],
    exact: &[f64],
    joints: &[&str],
    error: impl Fn(f64) -> f64,
) {
    let mut wrong = Vec::new();
    for &kind in kinds {
        for tolerance in TOLERANCES {
            let mut run = run(scene, kind, tolerance);
            run.advance_to(run.duration()).unwrap();
            let found = run.singular_configurations();
            let off = found.iter().zip(exact).map(|(f, e)| (f.time - e).abs()).fold(0.0, f64::max);
            let named = found.iter().all(|found| found.joints == joints);
            if found.len() != exact.len() || off > error(tolerance) || !named {
                wrong.push(format!("{kind:?} {tolerance:.0e}: off by {off:.1e}: {found:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_driven_parallelogram_passes_its_flat_positions() {
    // Crank angle 0.4 + 5 t.
    let exact: Vec<f64> = (1..5).map(|k| (PI * f64::from(k) - 0.4) / 5.0).collect();
    let kinds = [Taylor, Dop853, Dopri5, Ode45, Radau];
    passes(&problem("four-bars/parallelogram.json"), &kinds, &exact, &["O", "A", "B", "D"], |tolerance| {
        1e-11 + tolerance
    });
}

#[test]
fn the_linkage_of_sarrus_passes_its_flat_positions() {
    // Both pairs of plates lie flat at once.
    let exact = [0.256_695_961, 0.544_490_164];
    let joints = ["x1", "x2", "x3", "y1", "y2", "y3"];
    passes(
        &problem("sarrus/passages.json"),
        &[Taylor, Dop853, Dopri5, Ode45, Radau],
        &exact,
        &joints,
        |tolerance| 5e-8 + 10.0 * tolerance,
    );
}

/// A four-bar of links 1, 2 − δ, 1 and 2 m, with the crank at −1 rad and 1.5 rad/s: where it would be flat without δ, at
/// t = 2/3 s, it is `nearness` away from that.
fn beside_a_change_point(nearness: f64) -> Scene {
    let coupler = 2.0 - 0.25 * nearness * nearness;
    let crank = (libm::cos(-1.0), libm::sin(-1.0));
    // The rocker's end is 1 from (2, 0) and `coupler` from the crank's end.
    let (dx, dy) = (2.0 - crank.0, -crank.1);
    let apart = libm::hypot(dx, dy);
    let along = (coupler * coupler - 1.0 + apart * apart) / (2.0 * apart);
    let across = (coupler * coupler - along * along).sqrt();
    let (ux, uy) = (dx / apart, dy / apart);
    let ends =
        [1.0, -1.0].map(|s| (crank.0 + along * ux - s * across * uy, crank.1 + along * uy + s * across * ux));
    let end = if (ends[0].1 - crank.1).abs() < (ends[1].1 - crank.1).abs() { ends[0] } else { ends[1] };
    let c = ((end.0 - crank.0) / coupler, (end.1 - crank.1) / coupler);
    let r = (end.0 - 2.0, end.1);
    // Velocities: those of the joints along the coupler agree.
    let v = (-1.5 * crank.1, 1.5 * crank.0);
    let rocker = (v.0 * c.0 + v.1 * c.1) / (-r.1 * c.0 + r.0 * c.1);
    let w = (-rocker * r.1, rocker * r.0);
    let turning = ((w.0 - v.0) * -c.1 + (w.1 - v.1) * c.0) / coupler;
    let body =
        |name: &str, mass: f64, at: (f64, f64), u: (f64, f64), length: f64, v: (f64, f64), omega: f64| {
            let inertia = mass * length * length / 12.0;
            json!({"name": name, "mass": mass, "position": [at.0, at.1, 0],
            "center_of_mass": [0.5 * length, 0, 0], "inertia": {"principal": [0.001, inertia, inertia]},
            "orientation": {"u": [u.0, u.1, 0], "v": [-u.1, u.0, 0]},
            "velocity": [v.0, v.1, 0], "angular_velocity": [0, 0, omega]})
        };
    let joint = |name: &str, i: &str, p: (f64, f64), j: &str, q: f64| {
        json!({"name": name, "type": "revolute", "body_i": i, "point_i": [p.0, p.1, 0], "axis_i": [0, 0, 1],
            "body_j": j, "point_j": [q, 0, 0], "axis_j": [0, 0, 1]})
    };
    let scene = json!({"name": "beside a change point", "gravity": [0, 0, 0],
        "bodies": [body("crank", 1.0, (0.0, 0.0), crank, 1.0, (0.0, 0.0), 1.5),
            body("coupler", 2.0, crank, c, coupler, v, turning),
            body("rocker", 1.0, (2.0, 0.0), r, 1.0, (0.0, 0.0), rocker)],
        "joints": [joint("O", "ground", (0.0, 0.0), "crank", 0.0), joint("A", "crank", (1.0, 0.0), "coupler", 0.0),
            joint("B", "coupler", (coupler, 0.0), "rocker", 1.0), joint("D", "ground", (2.0, 0.0), "rocker", 0.0)],
        "simulation": {"duration": 1.5}});
    Scene::from_json(&scene.to_string()).unwrap()
}

/// Runs the four-bar beside its change point. Returns whether it has kept to its branch, and what it says of itself.
fn beside(nearness: f64, run: &mut Simulation) -> (bool, Summary, bool) {
    let stopped = run.advance_to(run.duration()).is_err();
    let rocker = run.frame().bodies[2].angular_velocity[2];
    // Nothing turns back: the shorter coupler makes the rocker swing. Nearer than rounding it goes on as a parallelogram.
    let right = if nearness > 1e-7 { rocker < 0.0 } else { (rocker - 1.5).abs() < 1e-2 };
    (right && !stopped, run.summary(), stopped)
}

#[test]
fn near_a_change_point_the_branch_is_right_or_the_doubt_is_told() {
    let mut silent = Vec::new();
    for nearness in [1e-2, 1e-4, 1e-6] {
        let scene = beside_a_change_point(nearness);
        for kind in [Taylor, Dop853, Dopri5, Ode45, Radau] {
            for tolerance in (3..=12).map(|digits| libm::pow(10.0, -f64::from(digits))) {
                let (right, summary, stopped) = beside(nearness, &mut run(&scene, kind, tolerance));
                let told = stopped || summary.doubts.iter().any(|doubt| doubt.contains("branch"));
                // The series tell branches apart that are farther from each other than rounding, and nothing singular is told.
                let sure = kind == Taylor && nearness > 1e-5 && !(right && summary.singularities.is_empty());
                if !(right || told) || sure {
                    silent.push(format!("{nearness:.0e} {kind:?} {tolerance:.0e}: {summary:?}"));
                }
            }
        }
    }
    assert!(silent.is_empty(), "{}", silent.join("\n"));
}

#[test]
fn near_a_change_point_other_treatments_are_right_or_say_so() {
    let treatments = [
        (Dop853, ConstraintMethod::Partitioning),
        (Dopri5, ConstraintMethod::Partitioning),
        (Radau, ConstraintMethod::Partitioning),
        (Dop853, ConstraintMethod::Baumgarte { alpha: 5.0, beta: 5.0 }),
        (Dopri5, ConstraintMethod::Baumgarte { alpha: 20.0, beta: 20.0 }),
        (Dop853, ConstraintMethod::Penalty { alpha: 1e7, omega: 10.0, mu: 1.0 }),
        (Trapezoidal, ConstraintMethod::AugmentedLagrangian { alpha: 1e7 }),
    ];
    let mut silent = Vec::new();
    for nearness in [1e-2, 1e-4, 1e-6, 1e-8] {
        let mut scene = beside_a_change_point(nearness);
        for (kind, method) in treatments {
            scene.simulation.constraint_method = method;
            for tolerance in [1e-3, 1e-6, 1e-9, 1e-12] {
                let (right, summary, stopped) = beside(nearness, &mut run(&scene, kind, tolerance));
                if !right && !stopped && summary.doubts.is_empty() {
                    silent.push(format!("{nearness:.0e} {kind:?} {method} {tolerance:.0e}: {summary:?}"));
                }
            }
        }
    }
    assert!(silent.is_empty(), "{}", silent.join("\n"));
}

#[test]
fn far_from_any_branch_nothing_is_doubted() {
    // Joint A comes within 6e-2 of losing its hold, at 1.33 s, where its hold hardly changes.
    let scene = beside_a_change_point(1e-2);
    for (kind, tolerance) in
        [(Dop853, 1e-7), (Dop853, 1e-10), (Dop853, 1e-12), (Dopri5, 1e-10), (Radau, 1e-9)]
    {
        let (right, summary, _) = beside(1e-2, &mut run(&scene, kind, tolerance));
        assert!(right && summary.doubts.is_empty(), "{kind:?} {tolerance:.0e}: {:?}", summary.doubts);
    }
}

#[test]
fn a_stiff_method_passes_all_windows_at_every_tolerance() {
    for name in ["n-four-bar:1", "n-four-bar:2"] {
        let scene = catalogue::scene(name).unwrap();
        let mut tight = run(&scene, Taylor, 1e-12);
        tight.advance_to(tight.duration()).unwrap();
        let exact = tight.singular_configurations();
        assert_eq!(exact.len(), 10);
        for tolerance in TOLERANCES {
            let mut run = run(&scene, Radau, tolerance);
            run.advance_to(run.duration()).unwrap();
            let found = run.singular_configurations();
            let off = found
                .iter()
                .zip(&exact)
                .map(|(found, exact)| (found.time - exact.time).abs())
                .fold(0.0, f64::max);
            assert!(found.len() == 10 && off < 1e-5 + 10.0 * tolerance, "{name} {tolerance:.0e}: {found:?}");
        }
    }
}

/// Passages of the flat positions of the windows by the motion that a run has computed, whether that is right or not: the times at
/// which the first upright lies down, found between moments so far apart, and up to when they were looked for.
fn lies_down(run: &mut Simulation, apart: f64) -> (Vec<f64>, f64) {
    let mut times = Vec::new();
    let (mut before, mut height) = (0.0, run.frame().bodies[0].position[1]);
    while run.time() < run.duration() && run.advance_to((before + apart).min(run.duration())).is_ok() {
        let (time, next) = (run.time(), run.frame().bodies[0].position[1]);
        if next.signum() != height.signum() {
            times.push(before + (time - before) * height / (height - next));
        }
        (before, height) = (time, next);
    }
    (times, before)
}

/// Where a passage falls between the stages of a step, no state may be found at it in the coordinates of the step.
#[test]
fn explicit_methods_in_independent_coordinates_pass_all_windows() {
    let mut wrong = Vec::new();
    for name in ["n-four-bar:1", "n-four-bar:2", "n-four-bar:3"] {
        let mut scene = catalogue::scene(name).unwrap();
        scene.simulation.constraint_method = ConstraintMethod::Partitioning;
        scene.simulation.error_estimate = false;
        for (kind, tolerance) in
            [Dop853, Dopri5, Ode45].into_iter().flat_map(|kind| [1e-3, 1e-4, 1e-5].map(|t| (kind, t)))
        {
            let mut run = run(&scene, kind, tolerance);
            let (there, until) = lies_down(&mut run, 0.02);
            let found = run.singular_configurations();
            let off = found.iter().zip(&there).map(|(found, there)| (found.time - there).abs());
            if found.len() != there.len() || there.len() < 10 || off.fold(0.0, f64::max) > 1e-3 {
                wrong.push(format!("{name} {kind:?} {tolerance:.0e} up to {until}: {there:?} but {found:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Rounding grows on the way past singular positions, and more with the number of windows: steps start far enough before them.
#[test]
fn forty_windows_in_a_row_are_passed_at_the_tightest_tolerances() {
    let mut scene = catalogue::scene("n-four-bar:40").unwrap();
    scene.simulation.error_estimate = false;
    let mut before: Option<u64> = None;
    for tolerance in [1e-9, 1e-10, 1e-11, 1e-12] {
        let mut run = run(&scene, Taylor, tolerance);
        run.advance_to(run.duration()).unwrap();
        let Summary { steps, rejected, .. } = run.summary();
        assert_eq!(run.singular_configurations().len(), 10, "{tolerance:.0e}");
        assert!(before.is_none_or(|before| steps <= before * 13 / 10), "{tolerance:.0e}: {steps} steps");
        assert!(rejected <= 10, "one for each position: {rejected}");
        before = Some(steps);
    }
}

/// `TRIAD_PASSAGES=10` takes all ten tolerances, and many more steps. Mechanisms without loops are not searched.
#[test]
fn every_built_in_scene_passes_what_there_is_by_every_integrator() {
    let all = std::env::var("TRIAD_PASSAGES").is_ok_and(|count| count == "10");
    let (digits, most): (Vec<i32>, u64) =
        if all { ((3..=12).collect(), 30_000) } else { (vec![3, 6, 10], 150) };
    let parted = [Dop853, Radau].map(|kind| (kind, ConstraintMethod::Partitioning));
    let kinds = [Taylor, Dop853, Dopri5, Ode45, Radau, IntegratorKind::Rattle];
    let kinds: Vec<_> =
        kinds.map(|kind| (kind, ConstraintMethod::Projection)).into_iter().chain(parted).collect();
    let (mut wrong, mut runs, mut passed) = (Vec::new(), 0, 0);
    for entry in catalogue::ENTRIES {
        let windows = entry.name.starts_with("n-four-bar");
        let mut scene = catalogue::scene(&entry.name.replace(":N", ":2")).unwrap();
        scene.simulation.error_estimate = false;
        if !has_loops(&Simulation::new(&scene).unwrap().system().model) {
            continue;
        }
        for (digits, (kind, method)) in
            digits.iter().flat_map(|digits| kinds.iter().map(move |k| (digits, *k)))
        {
            scene.simulation.constraint_method = method;
            let mut run = run(&scene, kind, libm::pow(10.0, -f64::from(*digits)));
            run.set_step_limit(most);
            let (there, until) =
                if windows { lies_down(&mut run, 0.02) } else { (Vec::new(), f64::INFINITY) };
            let _ = run.advance_to(run.duration());
            // The last step may have gone beyond the last moment that was looked at.
            let mut found = run.singular_configurations();
            found.retain(|found| found.time < until);
            let off = found.iter().zip(&there).map(|(found, there)| (found.time - there).abs());
            let off = off.fold(0.0, f64::max);
            (runs, passed) = (runs + 1, passed + found.len());
            if found.len() != there.len() || off > 1e-3 {
                let found: Vec<f64> = found.iter().map(|found| found.time).collect();
                wrong.push(format!("{} {kind:?} {method} 1e-{digits}: {there:?} but {found:?}", entry.name));
            }
        }
    }
    println!("{runs} runs, {passed} passages");
    assert!(wrong.is_empty() && passed > 80, "{passed} passages\n{}", wrong.join("\n"));
}

#[test]
fn a_second_solution_that_jumps_along_verifies_nothing() {
    let scene = beside_a_change_point(3e-7);
    let mut jumped = 0;
    for (kind, tolerance) in [(Ode45, 1e-10), (Radau, 1e-3), (Radau, 1e-6), (Dop853, 1e-4), (Taylor, 1e-3)] {
        let mut run = run(&scene, kind, tolerance);
        let mut verifier = Verifier::new(&scene_of(&scene, kind, tolerance), &run).unwrap();
        for tenths in 1..=15 {
            if run.advance_to(0.1 * f64::from(tenths)).is_err() {
                break;
            }
            while !verifier.compare(&run, 1_000) {}
        }
        let wrong = run.frame().bodies[2].angular_velocity[2] > 0.0;
        let found = verifier.found();
        jumped += u32::from(wrong && found.position < 0.1);
        assert!(!wrong || !found.doubts(&run).is_empty(), "{kind:?} {tolerance:.0e}: {found:?}");
    }
    assert!(jumped > 0, "no second solution jumps along");
}

#[test]
fn nearer_than_rounding_a_change_point_is_one() {
    // 2 − 0.25e-16 m is 2 m: the four-bar is flat at 2/3 s, and the smooth branch goes on as a parallelogram.
    let scene = beside_a_change_point(1e-8);
    for kind in [Taylor, Dop853, Dopri5, Ode45, Radau] {
        for tolerance in TOLERANCES {
            let mut run = run(&scene, kind, tolerance);
            run.advance_to(run.duration()).unwrap();
            let rocker = run.frame().bodies[2].angular_velocity[2];
            assert!((rocker - 1.5).abs() < 1e-5 + 3.0 * tolerance, "{kind:?} {tolerance:.0e}: {rocker}");
            let found = run.singular_configurations();
            assert_eq!(found.len(), 1, "{kind:?} {tolerance:.0e}: {found:?}");
            assert!(
                (found[0].time - 2.0 / 3.0).abs() < 1e-5 + tolerance,
                "{kind:?} {tolerance:.0e}: {found:?}"
            );
        }
    }
}

#[test]
fn each_island_names_its_own_joints_where_it_is_singular() {
    // A parallelogram, and beside it a copy of which the crank is a fifth faster.
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/problems/four-bars/parallelogram.json");
    let mut scene: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let copies = ["bodies", "joints", "drivers"];
    for list in copies {
        let Some(items) = scene[list].as_array().cloned() else { continue };
        for mut item in items {
            for key in ["name", "body_i", "body_j", "joint"] {
                if let Some(name) = item[key].as_str().filter(|name| *name != "ground") {
                    item[key] = format!("{name}2").into();
                }
            }
            if list == "drivers" {
                item["motion"]["rate"] = 6.0.into();
            }
            scene[list].as_array_mut().unwrap().push(item);
        }
    }
    let scene = Scene::from_json(&scene.to_string()).unwrap();
    for kind in [Taylor, Dop853, Radau] {
        let mut run = run(&scene, kind, 1e-8);
        run.advance_to(run.duration()).unwrap();
        let found = run.singular_configurations();
        for (rate, names) in [(5.0, ["O", "A", "B", "D"]), (6.0, ["O2", "A2", "B2", "D2"])] {
            let own: Vec<_> = found.iter().filter(|found| found.joints == names).collect();
            let exact = (1..).map(|k| (PI * f64::from(k) - 0.4) / rate).take_while(|t| *t < run.duration());
            let off: Vec<f64> = exact.zip(&own).map(|(exact, found)| (found.time - exact).abs()).collect();
            assert_eq!(off.len(), if rate > 5.5 { found.len() - 4 } else { 4 }, "{kind:?}: {found:?}");
            assert!(own.len() == off.len() && off.iter().all(|off| *off < 1e-7), "{kind:?}: {found:?}");
        }
    }
}
