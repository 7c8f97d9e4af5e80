//! Every row form, single bodies and mechanisms against numbers from a program that shares nothing with this one;
//! `data/check-vectors.json` says where they come from.

use nalgebra::{DMatrix, DVector};
use serde::Deserialize;
use serde_json::{Value, json};
use triad_engine::dynamics::elimination::Elimination;
use triad_engine::equations;
use triad_engine::equations::augmented::AugmentedSystem;
use triad_engine::equations::jacobian::Jacobian;
use triad_engine::model::Model;
use triad_engine::reactions::rigid_multipliers;
use triad_engine::scene::Scene;
use triad_engine::state::State;
use triad_engine::system::System;
use triad_linalg::independent_rows;

#[derive(Deserialize)]
struct Vectors {
    constraints: Vec<Case>,
    single_body_dynamics: Vec<SingleBody>,
    mechanisms: Vec<Mechanism>,
}

#[derive(Deserialize)]
struct Case {
    constraint: String,
    bodies: [String; 2],
    t: f64,
    q: Vec<f64>,
    qdot: Vec<f64>,
    #[serde(rename = "Phi")]
    phi: Vec<f64>,
    #[serde(rename = "Phi_q")]
    phi_q: Vec<Vec<f64>>,
    nu: Vec<f64>,
    gamma: Vec<f64>,
}

#[derive(Deserialize)]
struct SingleBody {
    body: String,
    m: f64,
    #[serde(rename = "I")]
    inertia: [f64; 3],
    gravity: [f64; 3],
    force: [f64; 3],
    force_local_point: [f64; 3],
    moment_global: [f64; 3],
    q: Vec<f64>,
    qdot: Vec<f64>,
    #[serde(rename = "M")]
    mass: Vec<Vec<f64>>,
    g_total_including_velocity_term: Vec<f64>,
    qddot: Vec<f64>,
    #[serde(rename = "lambda_RB_order_uu_vv_ww_uv_uw_vw_or_uu_vv_uv")]
    multipliers: Vec<f64>,
}

#[derive(Deserialize)]
struct Mechanism {
    model: String,
    kind: String,
    rank: usize,
    q: Vec<f64>,
    qdot: Vec<f64>,
    qddot: Vec<f64>,
    energy: f64,
}

/// The same accelerations by `data/exact_accelerations.py`.
#[derive(Deserialize)]
struct Exact {
    mechanisms: Vec<ExactMechanism>,
}

#[derive(Deserialize)]
struct ExactMechanism {
    model: String,
    kind: String,
    qddot: Vec<f64>,
}

#[allow(clippy::unwrap_used)] // a helper of tests
fn vectors() -> Vectors {
    serde_json::from_str(include_str!("../data/check-vectors.json")).unwrap()
}

fn coordinates(word: &str) -> &'static str {
    if word == "full" { "full" } else { "reduced" }
}

/// A list of the joint with these keys, and no drivers.
fn joint(p1: [f64; 3], p2: [f64; 3], extra: &Value) -> (Value, Value) {
    let mut joint = json!({ "name": "x", "body_i": "a", "body_j": "b", "point_i": p1, "point_j": p2 });
    for (key, value) in extra.as_object().into_iter().flatten() {
        joint[key] = value.clone();
    }
    (json!([joint]), json!([]))
}

/// No joints, and a list of the driver with these keys.
fn driver(mut driver: Value) -> (Value, Value) {
    driver["name"] = "x".into();
    (json!([]), json!([driver]))
}

/// The joint or driver that has the rows of a case, and the label of those rows.
fn element(constraint: &str) -> (Value, Value, &'static str) {
    let (p1, p2, s1, s2) = ([0.1, -0.2, 0.3], [-0.4, 0.25, 0.15], [0.6, 0.0, 0.8], [0.0, 0.28, 0.96]);
    let (ground_point, ground_vector) = ([0.5, -0.7, 0.2], [0.0, 0.6, 0.8]);
    let joint = |extra: Value| joint(p1, p2, &extra);
    let path = json!({ "kind": "components", "x": { "kind": "harmonic", "amplitude": 1, "frequency": 2 },
        "y": { "kind": "polynomial", "coefficients": [0, 0, 0, 1] },
        "z": { "kind": "harmonic", "amplitude": 1, "frequency": 1, "phase": std::f64::consts::FRAC_PI_2 } });
    let fixed_angle = json!({ "kind": "constant", "value": libm::acos(0.1f64) });
    let angle = json!({ "kind": "polynomial", "coefficients": [0.3, 0.8, 0.5] });
    let between = |motion: Value, body_j: &str, vector_j: [f64; 3]| {
        driver(
            json!({ "type": "angle-cosine", "body_i": "a", "vector_i": s1, "body_j": body_j, "vector_j": vector_j,
            "motion": motion }),
        )
    };
    let ((joints, drivers), label) = match constraint {
        "CP" => (joint(json!({ "type": "spherical" })), "CP"),
        "CP_ground" => {
            (joint(json!({ "type": "spherical", "body_j": "ground", "point_j": ground_point })), "CP")
        }
        "CV" => (joint(json!({ "type": "revolute", "rows": "cp-cv", "axis_i": s1, "axis_j": s2 })), "CV"),
        "CV_ground" => (
            joint(json!({ "type": "revolute", "rows": "cp-cv", "body_j": "ground", "axis_i": s1,
                "axis_j": ground_vector })),
            "CV",
        ),
        "CAR" => (between(fixed_angle, "b", s2), "AR"),
        "CAR_ground" => (between(fixed_angle, "ground", ground_vector), "AR"),
        "AR" => (between(angle, "b", s2), "AR"),
        "AR*" => (
            driver(json!({ "type": "angle-to-world", "body": "a", "vector": s1, "motion": angle,
                "reference": { "kind": "fixed", "vector": ground_vector } })),
            "AR*",
        ),
        "TP" => (driver(json!({ "type": "point", "body": "a", "point": p1, "motion": path })), "TP"),
        "OV" => (driver(json!({ "type": "vector", "body": "a", "vector": s1, "motion": path })), "OV"),
        "PERP" => (joint(json!({ "type": "point-in-plane", "axis_i": s1, "axis_j": s2 })), "PLANE"),
        "PLANE" => {
            let on_plane = ground_vector.map(|x| 0.3 * x);
            (
                joint(
                    json!({ "type": "point-in-plane", "body_i": "ground", "body_j": "a", "point_i": on_plane,
                    "point_j": p1, "axis_i": ground_vector, "axis_j": s1 }),
                ),
                "PLANE",
            )
        }
        _ => ((json!([]), json!([])), "RB"),
    };
    (joints, drivers, label)
}

#[test]
fn every_row_form_gives_the_numbers_of_the_check_vectors() {
    let cases = vectors().constraints;
    assert_eq!(cases.len(), 52);
    for case in cases {
        let (joints, drivers, label) = element(&case.constraint);
        let body = |name: &str, word: &str| {
            json!({ "name": name, "mass": 1, "inertia": { "principal": [1, 1.2, 1.5] },
                    "coordinates": coordinates(word) })
        };
        let scene: Scene = serde_json::from_value(json!({
            "name": "case", "joints": joints, "drivers": drivers,
            "bodies": [body("a", &case.bodies[0]), body("b", &case.bodies[1])],
            // The direction of a driver is one at the start alone.
            "simulation": { "duration": 1e-9 },
        }))
        .unwrap();
        let system = System::new(Model::new(&scene).unwrap());
        let at = State::at(&system, case.t, &case.q, &case.qdot);
        let jacobian = Jacobian::new(&system, &at);
        let wanted = format!("x: {label}");
        let rows: Vec<usize> = (0..jacobian.rows.len())
            .filter(|&row| {
                let name = &jacobian.rows[row];
                if label == "RB" { row < system.rigid_rows } else { name.starts_with(&wanted) }
            })
            .collect();
        assert_eq!(rows.len(), case.phi.len(), "{} {:?}", case.constraint, jacobian.rows);
        let dense = dense(&jacobian);
        let values = equations::constraints(&system, &at);
        let (nu, gamma) = (equations::nu(&system, &at), equations::gamma(&system, &at));
        for (k, &row) in rows.iter().enumerate() {
            let close = |found: f64, expected: f64, what: &str| {
                let error = (found - expected).abs() / (1.0 + expected.abs());
                assert!(error < 1e-12, "{} {:?} {what}: {found} {expected}", case.constraint, case.bodies);
            };
            close(values[row], case.phi[k], "Φ");
            close(nu[row], case.nu[k], "ν");
            close(gamma[row], case.gamma[k], "γ");
            for (column, &expected) in case.phi_q[k].iter().enumerate() {
                close(dense[(row, column)], expected, "Φ_q");
            }
        }
    }
}

#[test]
fn single_bodies_accelerate_as_the_check_vectors_say() {
    let cases = vectors().single_body_dynamics;
    assert_eq!(cases.len(), 6);
    for case in cases {
        let fixed = |v: [f64; 3]| json!({ "kind": "fixed", "vector": v });
        let scene: Scene = serde_json::from_value(json!({
            "name": "single", "gravity": case.gravity, "coordinates": coordinates(&case.body),
            "bodies": [{ "name": "a", "mass": case.m, "inertia": { "principal": case.inertia } }],
            "loads": [
                { "type": "force", "name": "f", "body": "a", "point": case.force_local_point, "force": fixed(case.force) },
                { "type": "moment", "name": "m", "body": "a", "moment": fixed(case.moment_global) },
            ],
        }))
        .unwrap();
        let system = System::new(Model::new(&scene).unwrap());
        let at = State::at(&system, 0.0, &case.q, &case.qdot);
        let mut elimination = Elimination::new(&system);
        let found = elimination.accelerate(&system, &at, (0.0, 0.0));
        let mut acceleration = vec![0.0; system.coordinates];
        found.write(&mut acceleration);
        let close = |found: &[f64], expected: &[f64], what: &str| {
            let error = (DVector::from_column_slice(found) - DVector::from_column_slice(expected)).amax();
            assert!(error < 1e-12, "{} {what}: off by {error}", case.body);
        };
        close(&acceleration, &case.qddot, "q̈");
        let augmented = AugmentedSystem::new(&system, &at);
        for (row, expected) in case.mass.iter().enumerate() {
            close(augmented.mass.row(row).transpose().as_slice(), expected, "M");
        }
        close(augmented.force.as_slice(), &case.g_total_including_velocity_term, "g");
        let multipliers: Vec<f64> =
            rigid_multipliers(&found).iter().flat_map(|b| b.rows.iter().map(|m| m.value)).collect();
        close(&multipliers, &case.multipliers, "λ");
    }
}

fn dense(jacobian: &Jacobian) -> DMatrix<f64> {
    let mut dense = DMatrix::zeros(jacobian.rows.len(), jacobian.columns.len());
    for entry in &jacobian.entries {
        dense[(entry.row, entry.column)] = entry.value;
    }
    dense
}

/// The scene of a mechanism of the check vectors, but for its state.
fn mechanism(name: &str) -> Scene {
    let scene = match name {
        "pendulum" => json!({
            "name": name, "gravity": [0, -9.81, 0],
            "bodies": [{ "name": "a", "mass": 1, "position": [-1, 0, 0], "inertia": { "principal": [0.3, 0.3, 0.3] } }],
            "joints": [{ "name": "pin", "type": "revolute", "rows": "cp-cv", "body_i": "a", "body_j": "ground",
                         "point": [0, 0, 0], "axis": [0, 0, 1] }],
        }),
        "heavy_top" => json!({
            "name": name, "gravity": [0, 0, -9.81],
            "bodies": [{ "name": "a", "mass": 15, "inertia": { "principal": [0.234_375, 0.234_375, 0.468_75] },
                         "position": [0, 1, 0], "orientation": { "u": [0, 0, 1], "v": [1, 0, 0] } }],
            "joints": [{ "name": "tip", "type": "spherical", "body_i": "a", "body_j": "ground", "point": [0, 0, 0] }],
        }),
        "spatial_slider_crank" => slider_crank(name),
        "chain6_spherical" => chain(name),
        _ => four_bar(name),
    };
    #[allow(clippy::unwrap_used)] // a helper of tests
    serde_json::from_value(scene).unwrap()
}

fn four_bar(name: &str) -> Value {
    let rod = json!({ "principal": [1.0 / 12.0, 1.0 / 12.0, 1.0 / 12.0] });
    let upright = |k: usize| {
        json!({ "name": format!("v{k}"), "mass": 1, "inertia": rod, "position": [k, 0.5, 0],
                "orientation": { "u": [0, 1, 0], "v": [-1, 0, 0] } })
    };
    let coupler = |k: usize| json!({ "name": format!("h{k}"), "mass": 1, "inertia": rod, "position": [k as f64 + 0.5, 1, 0] });
    let pin = |i: &str, j: &str, x: usize, y: usize| {
        json!({ "name": format!("{i}-{j}"), "type": "revolute", "rows": "cp-cv", "body_i": i, "body_j": j,
                "point": [x, y, 0], "axis": [0, 0, 1] })
    };
    json!({ "name": name, "gravity": [0, -9.81, 0],
        "bodies": [upright(0), upright(1), upright(2), coupler(0), coupler(1)],
        "joints": [pin("v0", "ground", 0, 0), pin("v1", "ground", 1, 0), pin("v2", "ground", 2, 0),
            pin("v0", "h0", 0, 1), pin("h0", "v1", 1, 1), pin("v1", "h1", 1, 1), pin("h1", "v2", 2, 1)] })
}

/// The crank on x, the rod from its pin (0, 0.1, 0.2) to the slider, which a prismatic joint holds; the rod's w and the
/// slider's v cross at right angles.
fn slider_crank(name: &str) -> Value {
    let root = 0.5f64.sqrt();
    let u = [2.0 / 3.0, -1.0 / 3.0, -2.0 / 3.0];
    let v = [root / 3.0, 4.0 * root / 3.0, -root / 3.0];
    json!({ "name": name, "gravity": [0, 0, -9.81],
        "bodies": [
            { "name": "crank", "mass": 0.12, "inertia": { "principal": [1e-4, 1e-5, 1e-4] }, "position": [0, 0.1, 0.12] },
            { "name": "rod", "mass": 0.5, "inertia": { "principal": [4e-4, 4e-3, 4e-3] }, "position": [0.1, 0.05, 0.1],
              "orientation": { "u": u, "v": v } },
            { "name": "slider", "mass": 2, "inertia": { "principal": [1e-4, 1e-4, 1e-4] }, "position": [0.2, 0, 0] },
        ],
        "joints": [
            { "name": "bearing", "type": "revolute", "rows": "cp-cv", "body_i": "ground", "body_j": "crank",
              "point": [0, 0.1, 0.12], "axis": [1, 0, 0] },
            { "name": "ball", "type": "spherical", "body_i": "crank", "body_j": "rod", "point": [0, 0.1, 0.2] },
            { "name": "cross", "type": "universal", "body_i": "rod", "body_j": "slider", "point_i": [0.15, 0, 0],
              "point_j": [0, 0, 0], "axis_i": [0, 0, 1], "axis_j": [0, 1, 0] },
            { "name": "guide", "type": "prismatic", "body_i": "ground", "body_j": "slider", "point": [0.2, 0, 0],
              "axis": [1, 0, 0] },
        ] })
}

/// Six rods of 0.2 m on balls, zigzag.
fn chain(name: &str) -> Value {
    let body = |k: usize| {
        json!({ "name": format!("rod-{k}"), "mass": 0.2,
        "inertia": { "principal": [8e-5, 0.2 * 0.04 / 12.0, 0.2 * 0.04 / 12.0] } })
    };
    let ball = |k: usize| {
        let previous = if k == 0 { "ground".to_owned() } else { format!("rod-{}", k - 1) };
        json!({ "name": format!("ball-{k}"), "type": "spherical", "body_i": previous, "body_j": format!("rod-{k}"),
                "point_i": [if k == 0 { 0.0 } else { 0.1 }, 0, 0], "point_j": [-0.1, 0, 0] })
    };
    json!({ "name": name, "gravity": [0, 0, -9.81],
        "bodies": (0..6).map(body).collect::<Vec<_>>(), "joints": (0..6).map(ball).collect::<Vec<_>>() })
}

#[test]
fn mechanisms_start_as_the_check_vectors_say() {
    let cases = vectors().mechanisms;
    assert_eq!(cases.len(), 10);
    let exact: Exact = serde_json::from_str(include_str!("../data/exact-accelerations.json")).unwrap();
    let exact = exact.mechanisms;
    for case in cases {
        let mut scene = mechanism(&case.model);
        scene.coordinates = serde_json::from_value(json!(coordinates(&case.kind))).unwrap();
        let system = System::new(Model::new(&scene).unwrap());
        let at = State::at(&system, 0.0, &case.q, &case.qdot);
        let mut elimination = Elimination::new(&system);
        elimination.set_redundant(case.model == "double_four_bar");
        let mut acceleration = vec![0.0; system.coordinates];
        elimination.accelerate(&system, &at, (0.0, 0.0)).write(&mut acceleration);
        let rank = independent_rows(&dense(&Jacobian::new(&system, &at)), 1e-9).len();
        assert_eq!(rank, case.rank, "{} {}", case.model, case.kind);
        // The prototype rounds by up to 2.8e-12 of the largest acceleration: what is right beyond is told in 60 digits.
        let exact = exact.iter().find(|e| (&e.model, &e.kind) == (&case.model, &case.kind)).unwrap();
        let scale = exact.qddot.iter().fold(1.0f64, |a, x| a.max(x.abs()));
        for (k, found) in acceleration.iter().enumerate() {
            let far = |other: &[f64]| (found - other[k]).abs() / scale;
            assert!(far(&exact.qddot) < 1e-12, "{} {} q̈[{k}]: {found}", case.model, case.kind);
            assert!(far(&case.qddot) < 5e-12, "{} {} q̈[{k}]: {found}", case.model, case.kind);
        }
        assert!((at.energy(&system) - case.energy).abs() < 1e-9, "{}", case.model);
    }
}
