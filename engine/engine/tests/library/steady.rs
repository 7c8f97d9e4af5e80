//! Modes about steady motions against closed forms: tops, rotors, cones and satellites.

#![allow(clippy::unwrap_used, reason = "tests may panic")]

use crate::common::same;
use nalgebra::{Matrix3, SMatrix, Vector3};
use serde_json::{Value, json};
use std::f64::consts::TAU;
use triad_engine::analysis::{AnalysisError, Modes, ModesAbout, modes};
use triad_engine::scene::Scene;

const G: f64 = 9.81;

fn steady(text: &str) -> Modes {
    modes(&Scene::from_json(text).unwrap(), ModesAbout::Steady).unwrap()
}

fn steady_of(scene: &Value) -> Modes {
    steady(&scene.to_string())
}

/// ω of those that do not drift; none of them may grow or decay.
fn frequencies(found: &Modes) -> Vec<f64> {
    let moving = found.modes.iter().filter(|mode| mode.kind != "drifts");
    moving
        .map(|mode| {
            assert!(
                mode.kind == "oscillates" && mode.growth.abs() < 1e-9 * mode.frequency,
                "{:?}",
                found.modes
            );
            TAU * mode.frequency
        })
        .collect()
}

fn drifts(found: &Modes) -> usize {
    found.modes.iter().filter(|mode| mode.kind == "drifts").count()
}

/// A top without an axis of symmetry, upright at the speed Ω, with the moments A, B, C about its tip:
/// A B λ⁴ + (A k₂ + B k₁ + (A + B − C)² Ω²) λ² + k₁ k₂ = 0, k₁ = (C − B) Ω² − m g l, k₂ = (C − A) Ω² − m g l. Of four roots with one modulus
/// two grow.
#[test]
fn an_unsymmetrical_top_may_grow_and_says_so() {
    let (a, b, c, speed) = (0.05 + 0.18, 0.07 + 0.18, 0.04, 40.0);
    let found = steady(
        r#"{"name": "top", "gravity": [0, 0, -9.81], "bodies": [{"name": "top", "mass": 2, "center_of_mass": [0, 0, 0.3],
            "inertia": {"principal": [0.05, 0.07, 0.04]}, "angular_velocity": [0, 0, 40]}],
            "joints": [{"name": "tip", "type": "spherical", "body_i": "ground", "body_j": "top", "point": [0, 0, 0]}]}"#,
    );
    let [k1, k2] = [b, a].map(|other| (c - other) * speed * speed - 2.0 * G * 0.3);
    let (twice, product) = (a * k2 + b * k1 + (a + b - c) * (a + b - c) * speed * speed, k1 * k2 / (a * b));
    // λ = ±σ ± iω: σ² + ω² is the root of the product, ω² − σ² half the coefficient.
    let (modulus, middle) = (product.sqrt(), 0.5 * twice / (a * b));
    let (omega, sigma) = ((0.5 * (modulus + middle)).sqrt(), (0.5 * (modulus - middle)).sqrt());
    assert_eq!(found.modes[0].kind, "drifts");
    // Their frequencies are equal but for rounding.
    let mut swings: Vec<_> = found.modes[1..].iter().collect();
    swings.sort_by(|a, b| a.growth.total_cmp(&b.growth));
    assert_eq!([swings[0].kind, swings[1].kind], ["oscillates", "grows"]);
    same(&[swings[0].growth, swings[1].growth], &[-sigma, sigma], 1e-9);
    same(&[swings[0].frequency, swings[1].frequency].map(|f| TAU * f), &[omega; 2], 1e-9);
}

/// A rotor in springs that turn with its shaft, whose dampers turn with it as well: m (r̈ + 2 Ω × ṙ − Ω² r) + d ṙ + k r = 0. Beyond the
/// critical speed √(k/m) nothing pushes it back.
#[test]
fn a_rotor_in_turning_springs_is_steady_on_its_axis() {
    let (m, spring, damper) = (2.0, 150.0, 3.0);
    for speed in [5.0, 20.0] {
        let loads: Vec<_> = [0.2f64, 0.2 + TAU / 3.0, 0.2 + 2.0 * TAU / 3.0]
            .iter()
            .enumerate()
            .map(|(k, angle)| {
                json!({ "type": "spring", "name": format!("s{k}"), "body_i": "shaft", "body_j": "rotor", "stiffness": spring,
                    "damping": damper, "point_i": [libm::cos(*angle), libm::sin(*angle), 0], "point_j": [0, 0, 0], "free_length": 0.6 })
            })
            .collect();
        let text = json!({ "name": "rotor", "gravity": [0, 0, 0],
            "bodies": [
                { "name": "rotor", "mass": m, "inertia": { "principal": [0.1, 0.13, 0.2] }, "angular_velocity": [0, 0, speed] },
                { "name": "shaft", "mass": 1, "inertia": { "principal": [0.1, 0.1, 0.1] } }],
            "joints": [
                { "name": "plane", "type": "planar", "body_i": "ground", "body_j": "rotor", "point": [0, 0, 0], "axis": [0, 0, 1] },
                { "name": "bearing", "type": "revolute", "body_i": "ground", "body_j": "shaft", "point": [0, 0, 0], "axis": [0, 0, 1] }],
            "drivers": [{ "type": "angle", "name": "motor", "joint": "bearing", "motion": { "kind": "ramp", "rate": speed } }],
            "loads": loads });
        let found = steady(&text.to_string());
        // With z = x + iy: λ² + (d/m + 2iΩ) λ + k/m − Ω² = 0: three springs are 3/2 of one along each direction, and their
        // tension, 0.4 of a stiffness, 3/2 of it across.
        let half = nalgebra::Complex::<f64>::new(0.75 * damper / m, speed);
        let root = nalgebra::ComplexField::sqrt(half * half - (1.5 * 1.4 * spring / m - speed * speed));
        let mut expected = [-half + root, -half - root].map(|value| (value.re, value.im.abs()));
        expected.sort_by(|a, b| a.1.total_cmp(&b.1));
        let told: Vec<_> = found.modes.iter().filter(|mode| mode.kind != "drifts").collect();
        assert_eq!(told.len(), 2, "{:?}", found.modes);
        for (mode, (growth, omega)) in told.iter().zip(expected) {
            assert!(
                (mode.growth - growth).abs() < 1e-8 && (TAU * mode.frequency - omega).abs() < 1e-8,
                "{mode:?}"
            );
        }
    }
}

/// A symmetrical top on its tip: m, l, A about the tip, C.
const TOP: [f64; 4] = [2.0, 0.3, 0.05 + 2.0 * 0.3 * 0.3, 0.04];

fn top(tilt: f64, angular_velocity: [f64; 3]) -> Value {
    let [m, l, _, c] = TOP;
    json!({ "name": "top", "gravity": [0, 0, -G],
        "bodies": [{ "name": "top", "mass": m, "inertia": { "principal": [0.05, 0.05, c] }, "center_of_mass": [0, 0, l],
            "orientation": { "axis": [0, 1, 0], "angle": tilt }, "angular_velocity": angular_velocity }],
        "joints": [{ "name": "tip", "type": "spherical", "body_i": "ground", "body_j": "top", "point": [0, 0, 0] }] })
}

/// First and second derivative of V(θ) = (p_z − p₃ cos θ)²/(2 A sin² θ) + m g l cos θ, in which a top with these momenta nods.
fn well(tilt: f64, p3: f64, pz: f64) -> [f64; 2] {
    let [m, l, a, _] = TOP;
    let (sine, cosine) = (libm::sin(tilt), libm::cos(tilt));
    let (n, square) = (pz - p3 * cosine, sine * sine);
    let slope = (n * p3 / sine - n * n * cosine / (square * sine)) / a - m * G * l * sine;
    let bent =
        p3 * p3 - 3.0 * n * p3 * cosine / square + n * n * (1.0 + 2.0 * cosine * cosine) / (square * square);
    [slope, bent / a - m * G * l * cosine]
}

fn goes_round(found: &Modes, tilt: f64, turn: f64, spin: f64, nods: f64) {
    let told = found.steady.as_ref().unwrap();
    assert!((told.turning[2] - turn).abs() < 1e-7 * turn.abs(), "{told:?} instead of {turn}");
    assert!(told.turning[0].abs() + told.turning[1].abs() < 1e-7 * turn.abs(), "{told:?}");
    let rate = told.spins.first().map_or(0.0, |spin| spin.rate);
    assert!((rate - spin).abs() < 1e-7 * spin.abs().max(turn.abs()), "{told:?} instead of {spin}");
    assert!((found.bodies[0].w[2] - libm::cos(tilt)).abs() < 1e-7, "{:?}", found.bodies[0]);
    same(&frequencies(found), &[nods], 1e-7);
    assert_eq!((drifts(found), found.modes.len()), (2, 3), "{:?}", found.modes);
}

/// m g l = Ω (C ω₃ − A Ω cos θ) goes round slowly and fast; it nods with A ω² = V''. Any turn of the frame would fit the
/// velocities, with another spin: that about the weight is steady. Without spin it is a conical pendulum.
#[test]
fn a_top_at_a_tilt_goes_round_slowly_or_fast_and_nods() {
    let [m, l, a, c] = TOP;
    let hanging = 2.5f64;
    let cone = (m * G * l / ((a - c) * -libm::cos(hanging))).sqrt();
    let mut cases = vec![(hanging, cone, cone * libm::cos(hanging))];
    for (tilt, about_axis) in [(0.7f64, 100.0), (1.9, 60.0), (0.4, 400.0), (0.2, -90.0)] {
        // A cos θ Ω² − C ω₃ Ω + m g l = 0.
        let (p, h) = (a * libm::cos(tilt), c * about_axis);
        let root = (h * h - 4.0 * p * m * G * l).sqrt();
        cases.extend([(h - root) / (2.0 * p), (h + root) / (2.0 * p)].map(|turn| (tilt, turn, about_axis)));
    }
    for (tilt, turn, about_axis) in cases {
        let (sine, cosine) = (libm::sin(tilt), libm::cos(tilt));
        let spin = about_axis - turn * cosine;
        let (p3, pz) = (c * about_axis, a * turn * sine * sine + c * about_axis * cosine);
        let found = steady_of(&top(tilt, [spin * sine, 0.0, turn + spin * cosine]));
        goes_round(&found, tilt, turn, spin, (well(tilt, p3, pz)[1] / a).sqrt());
    }
}

/// Let go at a tilt, spinning about its axis alone, a top nods about the steady precession with the same momenta.
#[test]
fn a_top_that_is_let_go_has_the_precession_about_which_it_nods() {
    let [_, _, a, c] = TOP;
    for (tilt, spin) in [(0.5f64, 120.0), (1.2, 70.0), (0.8, 1000.0)] {
        let (sine, cosine) = (libm::sin(tilt), libm::cos(tilt));
        let (p3, pz) = (c * spin, c * spin * cosine);
        let found = steady_of(&top(tilt, [spin * sine, 0.0, spin * cosine]));
        // It falls first.
        let (mut above, mut below) = (tilt, std::f64::consts::PI - 1e-3);
        for _ in 0..100 {
            let middle = 0.5 * (above + below);
            if well(middle, p3, pz)[0] < 0.0 { above = middle } else { below = middle }
        }
        let there = libm::cos(above);
        let turn = (pz - p3 * there) / (a * libm::sin(above) * libm::sin(above));
        goes_round(&found, above, turn, spin - turn * there, (well(above, p3, pz)[1] / a).sqrt());
    }
}

/// Upright it sleeps where C² ω² > 4 A m g l, and falls where not.
#[test]
fn a_top_sleeps_above_its_critical_speed() {
    let [m, l, a, c] = TOP;
    let critical = (4.0 * a * m * G * l).sqrt() / c;
    let awake = steady_of(&top(0.0, [0.0, 0.0, critical * (1.0 - 1e-6)]));
    let asleep = steady_of(&top(0.0, [0.0, 0.0, critical * (1.0 + 1e-6)]));
    assert!(awake.modes.iter().any(|mode| mode.growth > 1e-4), "{:?}", awake.modes);
    // λ² A² = m g l A − (C ω / 2)², seen in the frame of half the precession.
    let split = (m * G * l / a * 2e-6).sqrt();
    let middle = 0.5 * c * critical / a;
    same(&frequencies(&asleep), &[middle - split, middle + split], 1e-5);
}

/// −λ x + … = 0 of Euler's and Poisson's equations in the body, I ω̇ = I ω × ω + m g γ × c, γ̇ = γ × ω with γ upwards: of six
/// eigenvalues two are zero, and the others those of the reduced motion.
fn of_a_heavy_body(
    inertia: Matrix3<f64>,
    first: Vector3<f64>,
    omega: Vector3<f64>,
    up: Vector3<f64>,
) -> Vec<f64> {
    let inverse = inertia.try_inverse().unwrap();
    let mut matrix = SMatrix::<f64, 6, 6>::zeros();
    let cross = |v: Vector3<f64>| v.cross_matrix();
    let by_omega = inverse * (cross(inertia * omega) - cross(omega) * inertia);
    matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&by_omega);
    matrix.fixed_view_mut::<3, 3>(0, 3).copy_from(&(-inverse * cross(first) * G));
    matrix.fixed_view_mut::<3, 3>(3, 0).copy_from(&cross(up));
    matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&-cross(omega));
    let mut values: Vec<f64> =
        matrix.complex_eigenvalues().iter().map(|x| x.im).filter(|im| *im > 1e-3).collect();
    values.sort_by(f64::total_cmp);
    values
}

/// Rods, and a body without any symmetry whose joint lies off its axes, on cones: they turn about the weight only.
#[test]
fn a_body_on_a_ball_goes_round_on_a_cone() {
    for (principal, center) in [
        ([0.09, 0.09, 0.0], [0.0, 0.0, -0.5]),
        ([0.06, 0.07, 0.02], [0.0, 0.0, -0.5]),
        ([0.05, 0.08, 0.04], [0.12, -0.07, -0.5]),
    ] {
        let scene = json!({ "name": "cone", "gravity": [0, 0, -G],
            "bodies": [{ "name": "rod", "mass": 1.3, "inertia": { "principal": principal }, "center_of_mass": center,
                "orientation": { "axis": [0.2, 1, 0.1], "angle": -0.6 }, "angular_velocity": [0.1, 0, 5] }],
            "joints": [{ "name": "ball", "type": "spherical", "body_i": "ground", "body_j": "rod", "point": [0, 0, 0] }] });
        let found = steady_of(&scene);
        let turning = Vector3::from(found.steady.as_ref().unwrap().turning);
        assert!(turning.xy().norm() < 1e-9 && turning.z > 3.0, "{turning:?}");
        let at = &found.bodies[0];
        let axes = Matrix3::from_columns(&[at.u, at.v, at.w].map(Vector3::from));
        let arm = axes.tr_mul(&Vector3::from(at.position));
        let about_ball = Matrix3::from_diagonal(&Vector3::from(principal))
            + (Matrix3::identity() * arm.norm_squared() - arm * arm.transpose()) * 1.3;
        let (omega, up) = (axes.tr_mul(&turning), axes.tr_mul(&Vector3::z()));
        let moment = (about_ball * omega).cross(&omega) + up.cross(&arm) * (1.3 * G);
        assert!(moment.norm() < 1e-8, "{moment:?}");
        if principal[2] == 0.0 {
            // Without a moment about itself: Ω² (1 + 3 cos² θ).
            let cosine = arm.normalize().dot(&up);
            same(&frequencies(&found), &[turning.z * (1.0 + 3.0 * cosine * cosine).sqrt()], 1e-8);
            assert_eq!((drifts(&found), found.left_out), (1, 1));
        } else {
            same(&frequencies(&found), &of_a_heavy_body(about_ball, arm * 1.3, omega, up), 1e-7);
            assert_eq!((drifts(&found), found.left_out), (1, 0));
        }
    }
}

/// A point on a rod keeps m l² Ω sin² θ on its way to the cone where Ω² cos θ = g/l, and nods there with Ω² (1 + 3 cos² θ).
#[test]
fn a_point_on_a_rod_goes_round_on_a_cone() {
    let (arm, speed) = ([0.6f64, -0.8], 2.0);
    let found = steady_of(&json!({ "name": "point", "gravity": [0, 0, -G],
        "bodies": [{ "name": "bob", "mass": 1.5, "position": [arm[0], 0, arm[1]], "velocity": [0, speed, 0] }],
        "joints": [{ "name": "rod", "type": "rod", "body_i": "ground", "body_j": "bob", "point_i": [0, 0, 0], "point_j": [0, 0, 0], "length": 1 }] }));
    let turn = found.steady.as_ref().unwrap().turning[2];
    let [x, y, z] = found.bodies[0].position;
    same(&[(x * x + y * y) * turn, -z * turn * turn], &[arm[0] * speed, G], 1e-9);
    same(&frequencies(&found), &[turn * (1.0 + 3.0 * z * z).sqrt()], 1e-9);
    assert_eq!((found.freedoms, drifts(&found), found.left_out), (5, 1, 3));
}

/// A satellite of two parts, one of which slides on a spring: with x between their centres and μ = m₁ m₂/(m₁ + m₂), k (x − x₀) =
/// μ x Ω², I Ω the momentum of the start, and ω² = k/μ − Ω² + 4 μ x² Ω²/I along the slide. Besides it wobbles as a rigid body. It
/// starts off balance, with a velocity across its axis, and goes along uniformly.
#[test]
fn a_satellite_with_a_sliding_mass_keeps_its_momentum() {
    let ([m1, m2], stiffness, unstretched, speed) = ([5.0f64, 0.5], 40.0, 0.9, 3.0);
    let between = 1.1;
    let scene = json!({ "name": "satellite", "gravity": [0, 0, 0],
        "bodies": [
            { "name": "hull", "mass": m1, "inertia": { "principal": [0.5, 0.6, 0.8] }, "position": [0.3, 0, 0],
              "velocity": [0.2, -0.1, 0.4], "angular_velocity": [0, 0, speed] },
            { "name": "mass", "mass": m2, "inertia": { "principal": [0.01, 0.012, 0.011] }, "position": [0.3 + between, 0, 0],
              "velocity": [0.2, -0.1 + between * speed, 0.4], "angular_velocity": [0, 0, speed] }],
        "joints": [{ "name": "slide", "type": "prismatic", "body_i": "hull", "body_j": "mass", "point_i": [0, 0, 0],
            "point_j": [0, 0, 0], "axis_i": [1, 0, 0], "axis_j": [1, 0, 0] }],
        "loads": [{ "type": "slider", "name": "spring", "joint": "slide", "stiffness": stiffness, "free_length": unstretched }] });
    let found = steady_of(&scene);
    let reduced = m1 * m2 / (m1 + m2);
    let about = |x: f64| 0.8 + 0.011 + reduced * x * x;
    let momentum = about(between) * speed;
    let mut x = between;
    for _ in 0..200 {
        let turn = momentum / about(x);
        x = unstretched + reduced * x * turn * turn / stiffness;
    }
    let (turn, [i, j, k]) = (momentum / about(x), [0.51, 0.612 + reduced * x * x, about(x)]);
    let told = found.steady.as_ref().unwrap();
    assert!((Vector3::from(told.turning) - Vector3::z() * turn).norm() < 1e-8, "{told:?}");
    let [hull, mass] = [0, 1].map(|body| Vector3::from(found.bodies[body].position));
    assert!(((mass - hull).norm() - x).abs() < 1e-9);
    let total = (0..2).map(|k| Vector3::from(found.bodies[k].velocity) * [m1, m2][k]).sum::<Vector3<f64>>();
    let center = Vector3::new(0.2, -0.1 + m2 / (m1 + m2) * between * speed, 0.4);
    assert!((total / (m1 + m2) - center).norm() < 1e-9, "{total:?}");
    let slides = (stiffness / reduced - turn * turn + 4.0 * reduced * x * x * turn * turn / k).sqrt();
    let wobbles = turn * ((k - i) * (k - j) / (i * j)).sqrt();
    let mut expected = [turn, slides, wobbles];
    expected.sort_by(f64::total_cmp);
    same(&frequencies(&found), &expected, 1e-7);
    assert_eq!((found.freedoms, drifts(&found), found.modes.len()), (7, 4, 7));
}

/// A block that spins about the axis of its least moment, with a mass on a spring beside it: the start is the steady motion but for
/// five digits. With less energy, at that momentum, it could turn about another axis.
#[test]
fn a_start_that_is_all_but_steady_is_not_left_for_a_stable_one() {
    let scene = json!({ "name": "block", "gravity": [0, 0, 0],
        "bodies": [
            { "name": "block", "mass": 5, "inertia": { "principal": [0.8, 0.7, 0.3] }, "angular_velocity": [1e-5, -1e-5, 2] },
            { "name": "mass", "mass": 0.5, "inertia": { "principal": [0.01, 0.012, 0.011] }, "position": [0, 0, 0.2],
              "angular_velocity": [1e-5, -1e-5, 2] }],
        "joints": [{ "name": "slide", "type": "prismatic", "body_i": "block", "body_j": "mass", "point": [0, 0, 0], "axis": [1, 0, 0] }],
        "loads": [{ "type": "slider", "name": "spring", "joint": "slide", "stiffness": 40, "free_length": 1e-4 }] });
    let found = steady_of(&scene);
    assert!((found.bodies[0].w[2] - 1.0).abs() < 1e-6, "{:?}", found.bodies[0]);
    assert!((found.steady.as_ref().unwrap().turning[2] - 2.0).abs() < 1e-4, "{:?}", found.steady);
    assert_eq!(found.modes.len(), 7);
}

/// Of a body alike around an axis e that is free, the axis goes round its momentum H at H/A, and it spins about e.
#[test]
fn a_free_body_goes_round_its_momentum() {
    let (a, c) = (0.5, 0.8);
    let omega = Vector3::new(0.6, -0.3, 2.0);
    let found = steady_of(
        &json!({ "name": "disc", "gravity": [0, 0, 0], "bodies": [{ "name": "disc", "mass": 3,
        "inertia": { "principal": [a, a, c] }, "velocity": [1, 2, 3], "angular_velocity": [0.6, -0.3, 2.0] }] }),
    );
    let momentum = Vector3::new(a * omega.x, a * omega.y, c * omega.z);
    let told = found.steady.as_ref().unwrap();
    assert!((Vector3::from(told.turning) - momentum / a).norm() < 1e-9, "{told:?}");
    same(&[told.spins[0].rate], &[omega.z * (1.0 - c / a)], 1e-9);
    same(&frequencies(&found), &[momentum.norm() / a], 1e-9);
    assert_eq!((found.freedoms, drifts(&found)), (6, 5));
}

#[test]
fn what_cannot_stay_as_it_is_is_refused_with_the_reason() {
    let refused = |scene: &Value| -> AnalysisError {
        modes(&Scene::from_json(&scene.to_string()).unwrap(), ModesAbout::Steady).unwrap_err()
    };
    let braked = json!({ "name": "braked", "gravity": [0, 0, -G],
        "bodies": [{ "name": "wheel", "mass": 1, "inertia": { "principal": [0.1, 0.2, 0.3] }, "angular_velocity": [0, 0, 2] }],
        "joints": [{ "name": "axle", "type": "revolute", "body_i": "ground", "body_j": "wheel", "point": [0, 0, 0], "axis": [0, 0, 1] }],
        "loads": [{ "type": "torsion", "name": "brake", "joint": "axle", "damping": 0.1 }] });
    let falling = json!({ "name": "falling", "gravity": [0, 0, -G],
        "bodies": [{ "name": "stone", "mass": 1, "inertia": { "principal": [0.1, 0.2, 0.3] }, "angular_velocity": [0, 0, 2] }] });
    for (scene, body) in [(braked, "wheel"), (falling, "stone")] {
        let error = refused(&scene);
        let told = error.to_string();
        assert!(
            told.contains("loads drive or brake them") && told.contains(&format!("\"{body}\"")),
            "{told}"
        );
        assert!(
            error.hint().contains("falls freely") && error.hint().contains("constant speed"),
            "{}",
            error.hint()
        );
    }
}
