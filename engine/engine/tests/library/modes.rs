//! Modes against closed forms: bodies without inertia about an axis, slow decays beside fast ones, long chains.

#![allow(
    clippy::unwrap_used,
    clippy::excessive_precision,
    clippy::unreadable_literal,
    reason = "tests may panic, and write numbers as they were computed elsewhere"
)]

use crate::common::same;
use serde_json::json;
use std::f64::consts::TAU;
use triad_engine::analysis::{Modes, ModesAbout, modes};
use triad_engine::scene::Scene;

fn path(name: &str) -> String {
    format!("{}/../../tests/data/problems/modes/{name}.json", env!("CARGO_MANIFEST_DIR"))
}

fn problem(name: &str) -> Modes {
    let scene = Scene::from_json(&std::fs::read_to_string(path(name)).unwrap()).unwrap();
    modes(&scene, ModesAbout::Equilibrium).unwrap()
}

/// ω of those that oscillate.
fn frequencies(found: &Modes) -> Vec<f64> {
    found.modes.iter().filter(|mode| mode.kind == "oscillates").map(|mode| TAU * mode.frequency).collect()
}

const G: f64 = 9.81;

#[test]
fn pendulums_of_points_and_thin_rods_have_their_closed_forms() {
    let points = [2.0 - 2f64.sqrt(), 2.0 + 2f64.sqrt()].map(|square| (square * G).sqrt());
    let rods = [3.0 - 6.0 / 7f64.sqrt(), 3.0 + 6.0 / 7f64.sqrt()].map(|square| (square * G).sqrt());
    let twice = |[a, b]: [f64; 2]| [a, a, b, b];
    for (name, expected, left_out) in [
        ("one-point-spherical", vec![G.sqrt(); 2], 1),
        ("one-rod-spherical", vec![(12.0 / 13.0 * G).sqrt(); 2], 1),
        ("points", points.to_vec(), 0),
        ("points-spherical", twice(points).to_vec(), 2),
        ("rods", rods.to_vec(), 0),
        ("rods-slender", rods.to_vec(), 0),
    ] {
        let found = problem(name);
        same(&frequencies(&found), &expected, 1e-9);
        assert_eq!(found.left_out, left_out, "{name}");
        assert_eq!(found.freedoms, found.left_out + found.modes.len(), "{name}");
        let axes: usize = found.without_inertia.iter().map(|body| body.axes.len()).sum();
        assert_eq!(axes, left_out, "{name} {:?}", found.without_inertia);
    }
    // Rods that are not quite thin spin about themselves, and have a mode of their own for that.
    let found = problem("spherical");
    same(&frequencies(&found), &twice(rods), 1e-9);
    assert_eq!((found.left_out, found.modes.iter().filter(|mode| mode.kind == "drifts").count()), (0, 2));
}

/// Two masses on a line, the damper between them of 10³, 10⁵ and 10⁷ times its critical damping. Eigenvalues by Newton's method on
/// the characteristic polynomial in 60 digits.
#[test]
fn slow_decays_beside_fast_ones_keep_their_digits() {
    let scene = std::fs::read_to_string(path("overdamped")).unwrap();
    for (damping, fast, slow, pair) in [
        (
            "18973.665961010276",
            -28460.559693865715,
            -0.004_743_417_676_107_151,
            [-0.067_252_116_011_641, 8.164_679_102_403_774],
        ),
        (
            "1897366.5961010277",
            -2_846_049.960_759_065,
            -4.743_416_490_371_154e-5,
            [-0.066_672_521_174_645_02, 8.164_693_495_758_861],
        ),
        (
            "189736659.61010277",
            -284_604_989.481_820_2,
            -4.743416490252581e-07,
            [-0.066_666_725_211_747_88, 8.164_693_637_779_681],
        ),
    ] {
        let scene = Scene::from_json(&scene.replace("1897366.5961010277", damping)).unwrap();
        let found = modes(&scene, ModesAbout::Equilibrium).unwrap();
        let kinds: Vec<&str> = found.modes.iter().map(|mode| mode.kind).collect();
        assert_eq!(kinds, ["decays", "decays", "oscillates"], "{damping}");
        let growths: Vec<f64> = found.modes.iter().map(|mode| mode.growth).collect();
        same(&growths, &[fast, slow, pair[0]], 1e-9);
        same(&[TAU * found.modes[2].frequency], &pair[1..], 1e-9);
    }
}

/// Masses on equal springs whose dampers differ: all eigenvalues −d/2 ± i √(k − d²/4) have the modulus √k.
#[test]
fn equal_springs_with_different_dampers_have_each_mode_once() {
    let dampings = [0.1, 0.5, 1.0, 3.0, 4.0, 7.0];
    for count in 2..=dampings.len() {
        let (mut bodies, mut joints, mut loads) = (Vec::new(), Vec::new(), Vec::new());
        for (k, damping) in dampings[..count].iter().enumerate() {
            bodies.push(json!({ "name": format!("b{k}"), "mass": 1, "position": [0, k, 0], "inertia": { "principal": [0.1, 0.1, 0.1] } }));
            joints.push(json!({ "name": format!("p{k}"), "type": "prismatic", "body_i": "ground", "body_j": format!("b{k}"),
                "point": [0, k, 0], "axis": [1, 0, 0] }));
            loads.push(json!({ "name": format!("k{k}"), "type": "slider", "joint": format!("p{k}"), "stiffness": 100, "damping": damping }));
        }
        let text = json!({ "name": "row", "gravity": [0, 0, 0], "bodies": bodies, "joints": joints, "loads": loads });
        let found = modes(&Scene::from_json(&text.to_string()).unwrap(), ModesAbout::Equilibrium).unwrap();
        let growths: Vec<f64> = found.modes.iter().map(|mode| mode.growth).collect();
        let expected: Vec<f64> = dampings[..count].iter().rev().map(|damping| -0.5 * damping).collect();
        same(&growths, &expected, 1e-9);
    }
}

/// Points in a row on hinges: ω² L / g are the zeros of the Laguerre polynomial of that order.
#[test]
fn a_chain_of_300_has_its_modes() {
    let chain = |count: usize, moment: f64, arm: f64| {
        let (mut bodies, mut joints) = (Vec::new(), Vec::new());
        for k in 0..count {
            let (top, before) = (k as f64, if k == 0 { "ground".to_owned() } else { format!("b{}", k - 1) });
            bodies.push(format!(
                r#"{{"name": "b{k}", "mass": 1, "position": [0, {}, 0], "inertia": {{"principal": [{moment}, 0, {moment}]}}}}"#,
                -top - arm
            ));
            joints.push(format!(
                r#"{{"name": "j{k}", "type": "revolute", "body_i": "{before}", "body_j": "b{k}", "point": [0, {}, 0], "axis": [0, 0, 1]}}"#,
                -top
            ));
        }
        let text = format!(
            r#"{{"name": "chain", "gravity": [0, -{G}, 0], "bodies": [{}], "joints": [{}]}}"#,
            bodies.join(","),
            joints.join(",")
        );
        modes(&Scene::from_json(&text).unwrap(), ModesAbout::Equilibrium).unwrap()
    };
    let points = chain(300, 0.0, 1.0);
    assert_eq!((points.freedoms, points.left_out), (300, 0));
    let found = frequencies(&points);
    assert_eq!(found.len(), 300);
    for omega in found {
        let x = omega * omega / G;
        // L_k and its derivative by recurrence; a step of Newton's method says how far off the zero is.
        let (mut before, mut polynomial) = (1.0, 1.0 - x);
        for k in 1..300 {
            let k = f64::from(k);
            (before, polynomial) = (polynomial, ((2.0 * k + 1.0 - x) * polynomial - k * before) / (k + 1.0));
        }
        let slope = 300.0 * (polynomial - before) / x;
        assert!((polynomial / slope).abs() < 1e-6 * x, "{x}: off by {}", polynomial / slope);
    }
    // Rods come near to a heavy rope, whose slowest frequency is half the first zero of J₀ times √(g/L).
    let rods = chain(300, 1.0 / 12.0, 0.5);
    assert_eq!(rods.modes.len(), 300);
    same(&frequencies(&rods)[..1], &[0.5 * 2.404_825_557_695_773 * (G / 300.0).sqrt()], 2e-3);
}

fn steady(text: &str) -> Modes {
    modes(&Scene::from_json(text).unwrap(), ModesAbout::Steady).unwrap()
}

/// A shaft about z, driven at a constant speed, and what is mounted on it.
fn on_a_shaft(speed: f64, gravity: &str, bodies: &str, joints: &str, loads: &str) -> String {
    format!(
        r#"{{"name": "shaft", "gravity": {gravity}, "bodies": [
            {{"name": "shaft", "mass": 1, "inertia": {{"principal": [0.1, 0.1, 0.2]}}, "angular_velocity": [0, 0, {speed}]}}, {bodies}],
            "joints": [{{"name": "bearing", "type": "revolute", "body_i": "ground", "body_j": "shaft", "point": [0, 0, 0], "axis": [0, 0, 1]}}, {joints}],
            "drivers": [{{"type": "angle", "name": "motor", "joint": "bearing", "motion": {{"kind": "ramp", "rate": {speed}}}}}],
            "loads": [{loads}]}}"#
    )
}

/// A point on a shaft that turns at Ω: cos θ = g / (L Ω²), and ω = Ω sin θ about that.
#[test]
fn a_pendulum_on_a_turning_shaft_swings_about_its_raised_position() {
    let (speed, near) = (6.0, 1.2f64);
    let (x, z) = (libm::sin(near), -libm::cos(near));
    let found = steady(&on_a_shaft(
        speed,
        "[0, 0, -9.81]",
        &format!(
            r#"{{"name": "bob", "mass": 2, "position": [{x}, 0, {z}], "velocity": [0, {}, 0], "angular_velocity": [0, 0, {speed}]}}"#,
            speed * x
        ),
        r#"{"name": "hinge", "type": "revolute", "body_i": "shaft", "body_j": "bob", "point": [0, 0, 0], "axis": [0, 1, 0]}"#,
        "",
    ));
    let cosine = G / (speed * speed);
    let turning = found.steady.as_ref().unwrap().turning;
    assert!((turning[2] - speed).abs() < 1e-12 && turning[0] == 0.0, "{turning:?}");
    assert!((found.bodies[1].position[2] + cosine).abs() < 1e-9, "{:?}", found.bodies[1].position);
    same(&frequencies(&found), &[speed * (1.0 - cosine * cosine).sqrt()], 1e-9);
}

/// Two slides across each other on a shaft that turns: M ẍ − 2 m Ω ẏ + (k − M Ω²) x = 0, m ÿ + 2 m Ω ẋ + (c − m Ω²) y = 0.
#[test]
fn slides_on_a_turning_shaft_feel_coriolis_forces() {
    let (speed, both, bob) = (5.0f64, 3.0, 2.0);
    let (stiff_x, stiff_y) = (400.0 - both * speed * speed, 150.0 - bob * speed * speed);
    let found = steady(&on_a_shaft(
        speed,
        "[0, 0, 0]",
        r#"{"name": "carriage", "mass": 1, "inertia": {"principal": [0.1, 0.1, 0.1]}, "angular_velocity": [0, 0, 5]},
           {"name": "bob", "mass": 2, "inertia": {"principal": [0.1, 0.2, 0.1]}, "angular_velocity": [0, 0, 5]}"#,
        r#"{"name": "x", "type": "prismatic", "body_i": "shaft", "body_j": "carriage", "point": [0, 0, 0], "axis": [1, 0, 0]},
           {"name": "y", "type": "prismatic", "body_i": "carriage", "body_j": "bob", "point": [0, 0, 0], "axis": [0, 1, 0]}"#,
        r#"{"type": "slider", "name": "k", "joint": "x", "stiffness": 400}, {"type": "slider", "name": "c", "joint": "y", "stiffness": 150}"#,
    ));
    // λ⁴ M m + λ² (M c' + m k' + 4 m² Ω²) + k' c' = 0.
    let (a, b, c) =
        (both * bob, both * stiff_y + bob * stiff_x + 4.0 * bob * bob * speed * speed, stiff_x * stiff_y);
    let root = (b * b - 4.0 * a * c).sqrt();
    same(&frequencies(&found), &[(b - root) / (2.0 * a), (b + root) / (2.0 * a)].map(f64::sqrt), 1e-9);
}

/// Upright: I ω² − C s ω + m g l = 0, both turning the way the top spins; its spin is a drift.
#[test]
fn a_sleeping_top_nods_and_precesses() {
    let (about_pivot, along, spin) = (0.1 + 0.25, 0.05, 80.0);
    let found = steady(
        r#"{"name": "top", "gravity": [0, 0, -9.81], "bodies": [{"name": "top", "mass": 1, "position": [0, 0, 0.5],
            "inertia": {"principal": [0.1, 0.1, 0.05]}, "angular_velocity": [0, 0, 80]}],
            "joints": [{"name": "tip", "type": "spherical", "body_i": "ground", "body_j": "top", "point": [0, 0, 0]}]}"#,
    );
    let told = found.steady.as_ref().unwrap();
    assert_eq!((told.turning, told.spins.len()), ([0.0; 3], 1));
    let (b, c) = (along * spin, G * 0.5);
    let root = (b * b - 4.0 * about_pivot * c).sqrt();
    same(&frequencies(&found), &[(b - root) / (2.0 * about_pivot), (b + root) / (2.0 * about_pivot)], 1e-9);
    assert_eq!(found.modes[0].kind, "drifts");
    for mode in &found.modes[1..] {
        let shape = mode.shape[0];
        assert!(mode.growth.abs() < 1e-9, "{}", mode.growth);
        let ([x, y, _], [x_later, y_later, _]) = (shape.rotation, shape.rotation_later);
        assert!((x * y_later - y * x_later - (x * x + y * y)).abs() < 1e-9, "{shape:?}");
    }
}

/// A hinged body on a shaft that turns freely: the shaft's turn is a drift, whose momentum p stays. With J(θ) about the shaft,
/// A ω² = ∂²(p²/(2 J) + V)/∂θ², and nothing grows.
#[test]
fn a_shaft_that_turns_freely_drifts_and_does_not_grow() {
    let (speed, mass, arm) = (5.0, 2.0, 0.8);
    let [i, j, k] = [0.02, 0.03, 0.04];
    let about_hinge = k + mass * arm * arm;
    let across = mass * arm * arm + i - j;
    let cosine = mass * G * arm / (speed * speed * across);
    let sine = (1.0 - cosine * cosine).sqrt();
    let (s, c) = (sine, cosine);
    let found = steady(&format!(
        r#"{{"name": "hoop", "gravity": [0, -9.81, 0], "bodies": [
            {{"name": "shaft", "mass": 1, "inertia": {{"principal": [0.1, 0.2, 0.1]}}, "angular_velocity": [0, 5, 0]}},
            {{"name": "arm", "mass": 2, "inertia": {{"principal": [{i}, {j}, {k}]}}, "center_of_mass": [0, -0.8, 0],
              "orientation": {{"u": [{c}, {s}, 0], "v": [-{s}, {c}, 0]}}, "angular_velocity": [0, 5, 0]}}],
            "joints": [
            {{"name": "S", "type": "revolute", "body_i": "ground", "body_j": "shaft", "point": [0, 0, 0], "axis": [0, 1, 0]}},
            {{"name": "H", "type": "revolute", "body_i": "shaft", "body_j": "arm", "point": [0, 0, 0], "axis": [0, 0, 1]}}]}}"#
    ));
    let about_shaft = 0.2 + j + across * s * s;
    let (first, second) = (2.0 * across * s * c, 2.0 * across * (c * c - s * s));
    let momentum = about_shaft * speed;
    let bent = momentum
        * momentum
        * (2.0 * first * first / (about_shaft * about_shaft * about_shaft)
            - second / (about_shaft * about_shaft))
        / 2.0;
    let exact = ((bent + mass * G * arm * c) / about_hinge).sqrt();
    let kinds: Vec<&str> = found.modes.iter().map(|mode| mode.kind).collect();
    assert_eq!(kinds, ["drifts", "oscillates"], "{:?}", found.modes);
    assert!((TAU * found.modes[1].frequency / exact - 1.0).abs() < 1e-9);
}

/// Points on rods turn freely, and thin rods between balls spin: they count as freedoms, and a refusal says so.
#[test]
fn too_many_freedoms_are_told_with_those_that_are_idle() {
    let chain = |n: usize| {
        let bodies: Vec<String> = (0..n)
            .map(|k| format!(r#"{{"name": "p{k}", "mass": 1, "position": [0, -{}, 0]}}"#, k + 1))
            .collect();
        let joint = |k: usize| {
            let above = if k == 0 { "ground".to_owned() } else { format!("p{}", k - 1) };
            format!(
                r#"{{"name": "j{k}", "type": "rod", "body_i": "{above}", "body_j": "p{k}", "point_i": [0, 0, 0], "point_j": [0, 0, 0], "length": 1}}"#
            )
        };
        let joints: Vec<String> = (0..n).map(joint).collect();
        let text = format!(
            r#"{{"name": "points", "gravity": [0, -9.81, 0], "bodies": [{}], "joints": [{}]}}"#,
            bodies.join(","),
            joints.join(",")
        );
        modes(&Scene::from_json(&text).unwrap(), ModesAbout::Equilibrium)
    };
    let refused = chain(121).unwrap_err();
    let told = refused.to_string();
    assert!(told.contains("has 605, 363 of which are turns") && told.contains("\"p0\" first"), "{told}");
    assert!(refused.hint().contains("revolute"), "{}", refused.hint());
    let found = chain(3).unwrap();
    assert_eq!((found.freedoms, found.left_out), (15, 9));
}

/// With its shaft driven, a governor has three motions besides, all damped or at least not growing.
#[test]
fn a_driven_governor_has_modes_about_its_steady_motion() {
    let governor = format!("{}/../../tests/data/problems/governor/scene.json", env!("CARGO_MANIFEST_DIR"));
    let mut scene = Scene::from_json(&std::fs::read_to_string(governor).unwrap()).unwrap();
    let free = modes(&scene, ModesAbout::Steady).unwrap();
    let motor = r#"{"type": "angle", "name": "motor", "joint": "bearing", "motion": {"kind": "ramp", "rate": 6.283185307179586}}"#;
    scene.drivers.push(serde_json::from_str(motor).unwrap());
    let found = modes(&scene, ModesAbout::Steady).unwrap();
    assert_eq!((free.freedoms, found.freedoms), (4, 3));
    assert_eq!(free.modes.iter().filter(|mode| mode.kind == "drifts").count(), 1);
    assert!(found.modes.iter().all(|mode| mode.growth < 0.0), "{:?}", found.modes);
    assert!(found.bodies[2].position[2] < 1.0);
}

#[test]
fn a_motion_that_is_not_steady_is_refused_with_the_reason() {
    let pendulum = |axis: &str, motion: &str| {
        let text = on_a_shaft(
            3.0,
            "[0, 0, -9.81]",
            r#"{"name": "bob", "mass": 2, "position": [0, 0, -1], "angular_velocity": [0, 0, 3]}"#,
            r#"{"name": "hinge", "type": "revolute", "body_i": "shaft", "body_j": "bob", "point": [0, 0, 0], "axis": [0, 1, 0]}"#,
            "",
        );
        let text = text.replace("[0, 0, -9.81]", axis).replace(r#"{"kind": "ramp", "rate": 3}"#, motion);
        modes(&Scene::from_json(&text).unwrap(), ModesAbout::Steady).unwrap_err().to_string()
    };
    let ramp = r#"{"kind": "ramp", "rate": 3}"#;
    let tilted = pendulum("[0, -5, -8]", ramp);
    assert!(tilted.contains("change in the frame"), "{tilted}");
    let harmonic = pendulum("[0, 0, -9.81]", r#"{"kind": "harmonic", "amplitude": 1, "frequency": 3}"#);
    assert!(harmonic.contains("\"motor\" does not go on"), "{harmonic}");
}

/// A mass on a soft spring, where a far stiffer one stands elsewhere: found, or told to be hidden.
#[test]
fn a_soft_spring_that_a_stiff_one_hides_is_told() {
    for stiffness in [1e3, 1e8, 1e12, 1e14] {
        let rail = |name: &str, body: &str, z: f64| json!({"name": name, "type": "prismatic", "body_i": "ground", "body_j": body, "point": [0, 0, z], "axis": [1, 0, 0]});
        let text = json!({
            "name": "springs", "gravity": [0, 0, 0],
            "bodies": [{"name": "a", "mass": 1}, {"name": "b", "mass": 1, "position": [0, 0, 1]}],
            "joints": [rail("first", "a", 0.0), rail("second", "b", 1.0)],
            "loads": [
                {"name": "stiff", "type": "slider", "joint": "first", "stiffness": stiffness},
                {"name": "soft", "type": "slider", "joint": "second", "stiffness": 1}
            ]
        });
        let found = modes(&Scene::from_json(&text.to_string()).unwrap(), ModesAbout::Start).unwrap();
        let right = (TAU * found.modes[0].frequency - 1.0).abs() < 1e-4;
        let told =
            found.notes.iter().any(|note| note.contains("load \"soft\" may hold what is told as a drift"));
        assert!(right != told, "{stiffness:e}: {:?} {:?}", found.modes, found.notes);
    }
}

/// Two equal sliders, each on a spring and a damper, and a weak spring between them.
fn coupled(damping: f64, between: f64) -> Modes {
    let body = |name: &str, x: f64| json!({"name": name, "mass": 1.3, "inertia": {"principal": [0.1, 0.2, 0.25]}, "position": [x, 0, 0]});
    let rail = |name: &str, body: &str, x: f64| json!({"name": name, "type": "prismatic", "body_i": "ground", "body_j": body, "point": [x, 0, 0], "axis": [1, 0, 0]});
    let held = |name: &str, joint: &str| json!({"type": "slider", "name": name, "joint": joint, "stiffness": 5.0, "damping": damping});
    let scene = json!({
        "name": "coupled", "gravity": [0, -9.81, 0], "bodies": [body("a", 0.0), body("b", 2.0)],
        "joints": [rail("A", "a", 0.0), rail("B", "b", 2.0)],
        "loads": [held("left", "A"), held("right", "B"), {"type": "spring", "name": "between", "body_i": "a", "point_i": [0, 0, 0],
            "body_j": "b", "point_j": [0, 0, 0], "stiffness": between}],
    });
    modes(&Scene::from_json(&scene.to_string()).unwrap(), ModesAbout::Equilibrium).unwrap()
}

/// How far eigenvalues are from λ² m + λ c + k = 0 for each stiffness, beside what is told.
fn beside_told(found: &Modes, damping: f64, stiffnesses: [f64; 2]) {
    assert_eq!(found.modes.len(), 2, "{:?}", found.modes);
    for mode in &found.modes {
        let roots = stiffnesses.map(|k| {
            let (half, square) = (0.5 * damping / 1.3, k / 1.3);
            (-half, (square - half * half).sqrt())
        });
        let off = |(re, im): (f64, f64)| libm::hypot(mode.growth - re, TAU * mode.frequency - im);
        let (off, told) = (off(roots[0]).min(off(roots[1])), mode.error.unwrap());
        assert!(off < 3.0 * told && told < 1e-11, "off {off:e}, told {told:e}");
    }
}

/// Inverse iteration finds any two vectors of eigenvalues that are nearly equal: what it leaves of them is told apart in the small space
/// that they span.
#[test]
fn nearly_equal_eigenvalues_are_told_apart_to_their_error() {
    for between in [0.0, 1e-9, 1e-7, 1e-6, 1e-5, 1e-3] {
        for damping in [0.0, 0.1, 0.3] {
            beside_told(&coupled(damping, between), damping, [5.0, 5.0 + 2.0 * between]);
        }
    }
}

/// Two eigenvalues that meet in one vector are known to the root of rounding, and a position to what the softest motion leaves of it.
#[test]
fn errors_grow_where_eigenvalues_meet() {
    let critical = 2.0 * (5.0f64 * 1.3).sqrt();
    let found = coupled(critical, 1e-3);
    let exact = -0.5 * critical / 1.3;
    let off = |mode: &triad_engine::analysis::Mode| libm::hypot(mode.growth - exact, TAU * mode.frequency);
    let met: Vec<_> = found.modes.iter().filter(|mode| off(mode) < 1e-4).collect();
    assert!(!met.is_empty());
    for mode in met {
        let (off, told) = (off(mode), mode.error.unwrap());
        assert!(off < 3.0 * told && told < 1e-6, "off {off:e}, told {told:e}");
    }
    let hanging = problem("rods");
    let exact = [3.0 - 6.0 / 7f64.sqrt(), 3.0 + 6.0 / 7f64.sqrt()].map(|square| (square * G).sqrt());
    for (mode, exact) in hanging.modes.iter().zip(exact) {
        let (off, told) = ((TAU * mode.frequency - exact).abs(), mode.error.unwrap());
        assert!(off < 3.0 * told && told < 1e-10, "off {off:e}, told {told:e}");
    }
}

#[test]
fn loads_that_change_with_time_are_taken_as_they_are_at_the_start_and_told() {
    let scene = |force: serde_json::Value| {
        let scene = json!({
            "name": "pushed", "bodies": [{"name": "a", "mass": 1, "inertia": {"principal": [0.1, 0.2, 0.25]}}],
            "joints": [{"name": "rail", "type": "prismatic", "body_i": "ground", "body_j": "a", "point": [0, 0, 0], "axis": [1, 0, 0]}],
            "loads": [{"type": "slider", "name": "spring", "joint": "rail", "stiffness": 5.0}, {"type": "force", "name": "push", "body": "a",
                "force": force}],
        });
        Scene::from_json(&scene.to_string()).unwrap()
    };
    let waves = scene(
        json!({"kind": "components", "x": {"kind": "harmonic", "mean": 1.0, "amplitude": 2.0, "frequency": 3.0, "phase": 0.0},
        "y": {"kind": "constant", "value": 0.0}, "z": {"kind": "constant", "value": 0.0}}),
    );
    let (still, rest) =
        (scene(json!([1.0, 0.0, 0.0])), |scene: &Scene| triad_engine::analysis::equilibrium(scene).unwrap());
    let told = |notes: &[String]| {
        notes.iter().any(|note| note.contains("change with time") && note.contains("\"push\""))
    };
    let (moving, fixed) = (rest(&waves), rest(&still));
    same(&[moving.bodies[0].position[0], fixed.bodies[0].position[0]], &[0.2, 0.2], 1e-12);
    assert!(told(&moving.notes) && !told(&fixed.notes));
    assert!(told(&modes(&waves, ModesAbout::Equilibrium).unwrap().notes));
    assert!(!told(&modes(&still, ModesAbout::Equilibrium).unwrap().notes));
}
