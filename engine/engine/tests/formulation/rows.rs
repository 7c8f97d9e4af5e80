//! Φ, Φ_q, ν and γ of every joint and driver against differences, at states that satisfy no constraint, and the
//! accelerations of the elimination against the same rows.

use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use triad_engine::dynamics::elimination::{Elimination, TwistJacobian};
use triad_engine::equations;
use triad_engine::equations::jacobian::Jacobian;
use triad_engine::model::Model;
use triad_engine::scene::{JointKind, Scene};
use triad_engine::state::State;
use triad_engine::system::{Constraint, System};

/// One joint of each kind, between points and along axes that do not meet.
fn joints() -> Vec<serde_json::Value> {
    let two = ["a", "b"];
    let joint = |name: &str, kind: &str, bodies: [&str; 2], axis: bool| {
        let mut joint = serde_json::json!({
            "name": name, "type": kind, "body_i": bodies[0], "body_j": bodies[1],
            "point_i": [0.1, -0.2, 0.3], "point_j": [-0.4, 0.25, 0.15],
        });
        if axis {
            joint["axis_i"] = serde_json::json!([0.6, 0.0, 0.8]);
            joint["axis_j"] = serde_json::json!([0.0, 0.28, 0.96]);
        }
        joint
    };
    let mut joints = vec![
        joint("sph", "spherical", two, false),
        joint("rev", "revolute", ["b", "c"], true),
        joint("rev2", "revolute", ["ground", "a"], true),
        joint("cv", "revolute", ["c", "a"], true),
        joint("uni", "universal", two, true),
        joint("cyl", "cylindrical", two, true),
        joint("pris", "prismatic", ["c", "ground"], true),
        joint("plan", "planar", two, true),
        joint("scr", "screw", two, true),
        joint("fix", "fixed", ["c", "a"], true),
        joint("rod", "rod", two, false),
        joint("line", "point-on-line", two, true),
        joint("plane", "point-in-plane", ["ground", "c"], true),
        serde_json::json!({ "name": "gear", "type": "gear", "joints": ["rev", "rev2"], "ratio": -1.7 }),
    ];
    joints[3]["rows"] = "cp-cv".into();
    joints[8]["pitch"] = 0.3.into();
    joints
}

/// Three bodies with different inertias and centres of mass off their reference points, all joints and drivers.
#[allow(clippy::unwrap_used)] // a helper of tests
fn scene(coordinates: [&str; 3]) -> Scene {
    let body = |name: &str, k: f64, coordinates: &str| {
        serde_json::json!({
            "name": name, "mass": 1.0 + k, "coordinates": coordinates,
            "inertia": { "tensor": [[1.0 + k, 0.1, -0.05], [0.1, 1.2, 0.2], [-0.05, 0.2, 1.5]] },
            "center_of_mass": [0.1, -0.2 * k, 0.3],
            "position": [k, 0.5, -k],
            "orientation": { "axis": [1, k, 0.5], "angle": 0.3 + k },
        })
    };
    let angle = serde_json::json!({ "kind": "polynomial", "coefficients": [0.3, 0.8, 0.5] });
    let turning =
        serde_json::json!({ "kind": "turning", "start": [0.6, 0.8, 0], "axis": [1, 1, 0.3], "angle": angle });
    let path = serde_json::json!({ "kind": "components",
        "x": { "kind": "harmonic", "amplitude": 1, "frequency": 2 },
        "y": { "kind": "polynomial", "coefficients": [0, 0, 0, 1] },
        "z": { "kind": "smooth-step", "from": 1, "to": 2, "start": 0.2, "end": 0.9 } });
    serde_json::from_value(serde_json::json!({
        "name": "everything", "gravity": [0.3, -9.81, 0.2],
        "bodies": [body("a", 0.2, coordinates[0]), body("b", 0.5, coordinates[1]), body("c", 0.9, coordinates[2])],
        "joints": joints(),
        "drivers": [
            { "type": "point", "name": "tp", "body": "a", "point": [0.1, 0.2, 0.3], "motion": path },
            { "type": "vector", "name": "ov", "body": "b", "vector": [0, 1, 2], "motion": turning },
            { "type": "angle", "name": "an", "joint": "rev", "motion": angle },
            { "type": "slide", "name": "sl", "joint": "cyl", "motion": angle },
            { "type": "angle-cosine", "name": "ar", "body_i": "a", "vector_i": [1, 0, 2], "body_j": "c",
              "vector_j": [0, 1, 1], "motion": angle },
            { "type": "angle-to-world", "name": "arw", "body": "a", "vector": [1, 0, 2], "reference": turning,
              "motion": angle },
        ],
    }))
    .unwrap()
}

#[test]
fn every_kind_of_joint_is_differentiated() {
    let scene = scene(["full"; 3]);
    let missing =
        JointKind::ALL.into_iter().filter(|kind| scene.joints.iter().all(|joint| joint.kind != *kind));
    assert_eq!(missing.collect::<Vec<_>>(), [], "add them to the scene of this file");
}

fn kind() -> impl Strategy<Value = &'static str> {
    prop_oneof![Just("full"), Just("reduced")]
}

/// Values of all rows at (t, q, q̇).
struct Rows {
    value: DVector<f64>,
    jacobian: DMatrix<f64>,
    nu: DVector<f64>,
    gamma: DVector<f64>,
}

fn rows(system: &System, at: &mut State, t: f64, q: &DVector<f64>, q_dot: &DVector<f64>) -> Rows {
    at.set(system, t, q.as_slice(), q_dot.as_slice());
    let sparse = Jacobian::new(system, at);
    let mut jacobian = DMatrix::zeros(sparse.rows.len(), sparse.columns.len());
    for entry in &sparse.entries {
        jacobian[(entry.row, entry.column)] += entry.value;
    }
    Rows {
        value: DVector::from_vec(equations::constraints(system, at)),
        jacobian,
        nu: DVector::from_vec(equations::nu(system, at)),
        gamma: DVector::from_vec(equations::gamma(system, at)),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn rows_agree_with_their_differences(
        kinds in [kind(), kind(), kind()],
        noise in prop::collection::vec(-1.0f64..1.0, 72),
        t in 0.0f64..1.0,
    ) {
        let system = System::new(Model::new(&scene(kinds)).unwrap());
        let n = system.coordinates;
        let (mut q, mut v) = (vec![0.0; n], vec![0.0; n]);
        system.start(&mut q, &mut v);
        let q = DVector::from_fn(n, |i, _| q[i] + 0.2 * noise[i]);
        let v = DVector::from_fn(n, |i, _| noise[n + i]);
        let mut at = State::new(&system);
        let here = rows(&system, &mut at, t, &q, &v);
        let h = 1e-5;
        let (qp, qm) = (&q + &v * h, &q - &v * h);
        let after = rows(&system, &mut at, t + h, &qp, &v);
        let before = rows(&system, &mut at, t - h, &qm, &v);
        // Φ̇ = Φ_q q̇ − ν along the motion.
        let rate = (&after.value - &before.value) / (2.0 * h);
        let claimed = &here.jacobian * &v - &here.nu;
        prop_assert!((&rate - &claimed).amax() < 1e-7, "{}", (&rate - &claimed).amax());
        // Φ_q q̈ = γ: with q̈ = 0, the rate of Φ_q q̇ − ν is −γ.
        let second = (&after.jacobian * &v - &after.nu - &before.jacobian * &v + &before.nu) / (2.0 * h);
        prop_assert!((&second + &here.gamma).amax() < 2e-6, "{}", (&second + &here.gamma).amax());
        // Φ_q column by column.
        for column in 0..n {
            let mut unit = DVector::zeros(n);
            unit[column] = h;
            let plus = rows(&system, &mut at, t, &(&q + &unit), &v).value;
            let minus = rows(&system, &mut at, t, &(&q - &unit), &v).value;
            let difference = (plus - minus) / (2.0 * h) - here.jacobian.column(column);
            prop_assert!(difference.amax() < 1e-7, "column {column}: {}", difference.amax());
        }
    }
}

/// A chain with each kind of joint, driven, far from consistent: Φ_q q̈ = γ holds for what the elimination returns.
#[test]
fn accelerations_satisfy_the_written_rows() {
    for kinds in [["full", "full", "full"], ["reduced", "reduced", "reduced"], ["full", "reduced", "full"]] {
        let mut scene = scene(kinds);
        scene.joints.retain(|j| ["rev", "rev2", "cyl", "gear"].contains(&j.name.as_str()));
        scene.drivers.retain(|d| ["sl", "an"].contains(&d.name()));
        let system = System::new(Model::new(&scene).unwrap());
        let n = system.coordinates;
        let (mut q, mut v) = (vec![0.0; n], vec![0.0; n]);
        system.start(&mut q, &mut v);
        let q = DVector::from_fn(n, |i, _| q[i] + 0.1 * libm::sin(i as f64 * 1.7));
        let v = DVector::from_fn(n, |i, _| libm::cos(i as f64 * 0.9));
        let mut at = State::at(&system, 0.4, q.as_slice(), v.as_slice());
        let mut acceleration = vec![0.0; n];
        Elimination::new(&system).accelerate(&system, &at, (0.0, 0.0)).write(&mut acceleration);
        let here = rows(&system, &mut at, 0.4, &q, &v);
        let residual = &here.jacobian * DVector::from_vec(acceleration) - &here.gamma;
        assert!(residual.amax() < 1e-9, "{kinds:?}: {}", residual.amax());
    }
}

/// The pattern and the constant numbers are written once; refreshing gives what writing anew gives.
#[test]
fn a_refreshed_jacobian_is_a_new_one() {
    for kinds in [["full", "full", "full"], ["full", "reduced", "full"]] {
        let system = System::new(Model::new(&scene(kinds)).unwrap());
        let n = system.coordinates;
        let (mut q, mut v) = (vec![0.0; n], vec![0.0; n]);
        system.start(&mut q, &mut v);
        let mut at = State::new(&system);
        at.set_positions(&system, &q);
        let first = Jacobian::new(&system, &at);
        for (i, q) in q.iter_mut().enumerate() {
            *q += 0.1 * libm::sin(i as f64 * 1.3);
        }
        at.set_positions(&system, &q);
        let mut refreshed = first.clone();
        let rows = refreshed.refresh(&system, &at);
        assert_eq!(refreshed, Jacobian::new(&system, &at));
        assert!(rows < first.rows.len(), "some rows are constant");
        for (before, after) in first.entries.iter().zip(&refreshed.entries) {
            assert!(!before.constant || before.value == after.value);
        }
        assert_ne!(first, refreshed);
    }
}

/// The solver's rows of common vectors are written again only where a vector has changed, and of points only how they turn.
#[test]
fn rows_that_are_filled_again_are_those_of_the_state() {
    let system = System::new(Model::new(&scene(["full", "reduced", "full"])).unwrap());
    let n = system.coordinates;
    let (mut q, mut v) = (vec![0.0; n], vec![0.0; n]);
    system.start(&mut q, &mut v);
    let mut at = State::new(&system);
    let mut again = TwistJacobian::new(&system);
    // Bodies turn one after the other: of some rows one vector changes, of others none.
    for moved in [0, 1, 2, 0] {
        let layout = &system.bodies[moved].layout;
        for (i, q) in q[layout.first..][..layout.size()].iter_mut().enumerate() {
            *q += 0.1 * libm::sin(i as f64 * 1.3);
        }
        at.set_positions(&system, &q);
        again.fill(&system, &at);
        let mut new = TwistJacobian::new(&system);
        new.fill(&system, &at);
        for incidence in system.constraints.iter().flat_map(Constraint::incidence_ids) {
            assert_eq!(again.rows_on(&system, incidence), new.rows_on(&system, incidence));
        }
    }
}
