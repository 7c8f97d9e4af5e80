//! Driven loops in space against closed forms, and links that spin about themselves.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests may panic")]

use crate::loops::problem;
use nalgebra::{Isometry3, Rotation3, Translation3, UnitQuaternion, Vector3};
use serde_json::json;
use triad_engine::analysis::{AnalysisError, KinematicState, Kinematics, kinematics};
use triad_engine::reactions::report::Convention;
use triad_engine::scene::Scene;

fn follow(scene: &Scene) -> Kinematics {
    kinematics(scene, Convention::default()).unwrap()
}

/// The crank's end at a time, and the rocker's angle with its rate: |S2 − S1| is the coupler's length.
struct Rssr {
    pin: Vector3<f64>,
    arm: Vector3<f64>,
    length: f64,
}

impl Rssr {
    fn new() -> Self {
        let (pin, end) = (
            Vector3::new(0.4, 0.1, 0.2),
            Vector3::new(0.488_656_061_998_401_9, 0.1, 0.486_600_946_737_681_8),
        );
        Self { pin, arm: end - pin, length: (end - Vector3::new(0.1, 0.0, 0.0)).norm() }
    }

    fn crank(time: f64) -> Vector3<f64> {
        let angle = 5.0 * time;
        Vector3::new(0.1 * libm::cos(angle), 0.1 * libm::sin(angle), 0.0)
    }

    fn rocker_end(&self, angle: f64) -> Vector3<f64> {
        self.pin + Rotation3::from_axis_angle(&Vector3::y_axis(), angle) * self.arm
    }

    /// c cos φ + s sin φ = k.
    fn angle(&self, time: f64) -> f64 {
        let from = Self::crank(time) - self.pin;
        let k = 0.5 * (self.arm.norm_squared() + from.norm_squared() - self.length * self.length)
            - from.y * self.arm.y;
        let c = from.x * self.arm.x + from.z * self.arm.z;
        let s = from.x * self.arm.z - from.z * self.arm.x;
        // The branch that it starts on, at zero.
        let offset = libm::acos(k / libm::hypot(c, s));
        [libm::atan2(s, c) + offset, libm::atan2(s, c) - offset]
            .into_iter()
            .map(|angle| angle - std::f64::consts::TAU * (angle / std::f64::consts::TAU).round())
            .min_by(|a, b| a.abs().total_cmp(&b.abs()))
            .unwrap()
    }

    /// Kinetic and potential energy of `ss.json`, its coupler without spin about itself.
    fn energy(&self, time: f64, weight: Vector3<f64>) -> f64 {
        let h = 1e-4;
        let rate = |f: &dyn Fn(f64) -> Vector3<f64>| {
            (f(time - 2.0 * h) - f(time - h) * 8.0 + f(time + h) * 8.0 - f(time + 2.0 * h)) / (12.0 * h)
        };
        let (s1, s2) = (|t: f64| Self::crank(t), |t: f64| self.rocker_end(self.angle(t)));
        let along = |t: f64| (s2(t) - s1(t)) / self.length;
        let middle = |t: f64| (s1(t) + s2(t)) * 0.5;
        let crank = |t: f64| s1(t) * 0.5;
        let rocker = |t: f64| self.pin + (s2(t) - self.pin) * 0.5;
        let swing = rate(&s2).norm() / self.arm.norm();
        0.5 * 0.5 * rate(&crank).norm_squared()
            + 0.5 * 0.001 * 25.0
            + 0.5 * 0.8 * rate(&rocker).norm_squared()
            + 0.5 * 0.006 * swing * swing
            + 0.5 * 0.3 * rate(&middle).norm_squared()
            + 0.5 * 0.001 * rate(&along).norm_squared()
            - weight.dot(&(crank(time) * 0.5 + rocker(time) * 0.8 + middle(time) * 0.3))
    }
}

fn rocker_is_right(found: &Kinematics, rocker: usize) {
    let loop_ = Rssr::new();
    let arm = (loop_.arm) * 0.5;
    let middle = |angle: f64| loop_.pin + Rotation3::from_axis_angle(&Vector3::y_axis(), angle) * arm;
    for state in &found.states {
        let expected = middle(loop_.angle(state.time));
        let missed = (Vector3::from(state.bodies[rocker].position) - expected).norm();
        assert!(missed < 1e-10, "{missed:e} at t = {}", state.time);
    }
}

#[test]
fn a_spatial_four_bar_keeps_its_branch_with_a_rod_or_a_universal_joint() {
    for name in ["rssr/rod", "rssr/su"] {
        for every in [0.01, 0.25] {
            let mut scene = problem(name);
            scene.simulation.every = every;
            rocker_is_right(&follow(&scene), 1);
        }
    }
}

/// Nothing turns a symmetric link between two spherical joints about itself: it keeps its spin, and so the driver's torque is
/// what the energy asks for.
#[test]
fn a_link_that_spins_about_itself_is_left_its_spin_and_named() {
    let scene = problem("rssr/ss");
    let found = follow(&scene);
    rocker_is_right(&found, 1);
    assert!(
        found
            .notes
            .iter()
            .any(|note| note.contains("\"coupler\" can spin about its axis through \"S1\", \"S2\""))
    );
    let loop_ = Rssr::new();
    let weight = Vector3::from(scene.gravity);
    for state in found.states.iter().step_by(10) {
        let h = 2e-3;
        let e = |k: f64| loop_.energy(state.time + k * h, weight);
        let power = (e(-2.0) - 8.0 * e(-1.0) + 8.0 * e(1.0) - e(2.0)) / (12.0 * h);
        let motor = state.reactions.reactions.iter().find(|r| r.joint == "motor").unwrap();
        assert!(
            (motor.moment[2].value * 5.0 - power).abs() < 1e-6 * power.abs().max(1.0),
            "{} {power}",
            motor.moment[2].value * 5.0
        );
        let axis = Vector3::from(state.bodies[2].u);
        assert!(axis.dot(&Vector3::from(state.bodies[2].angular_velocity)).abs() < 1e-9);
    }
}

#[test]
fn a_link_that_something_turns_about_itself_is_refused_by_name() {
    let mut scene = problem("rssr/ss");
    scene.bodies[2].center_of_mass = [0.0, 0.01, 0.0];
    scene.gravity = [0.0, 0.0, -9.81];
    let error = kinematics(&scene, Convention::default()).unwrap_err();
    let AnalysisError::Spins { body, joints, moment, .. } = &error else { panic!("{error}") };
    assert_eq!((body.as_str(), joints.join(" ")), ("coupler", "S1 S2".to_owned()));
    assert!(*moment > 0.0 && error.hint().contains("universal"), "{error}");
}

/// The frames of Bennett's linkage at a crank angle: four links of lengths a, b, a, b and twists α, β, α, β with
/// a / sin α = b / sin β.
struct Bennett {
    lengths: [f64; 2],
    twists: [f64; 2],
}

impl Bennett {
    fn new() -> Self {
        let twists: [f64; 2] = [0.6, 1.1];
        Self { lengths: twists.map(|twist| 0.8 * libm::sin(twist)), twists }
    }

    /// Angles at the four joints: tan(θ₁/2) tan(θ₂/2) = sin((β + α)/2) / sin((β − α)/2), θ₃ = −θ₁, θ₄ = −θ₂.
    fn angles(&self, first: f64) -> [f64; 4] {
        let [alpha, beta] = self.twists;
        let k = libm::sin(0.5 * (beta + alpha)) / libm::sin(0.5 * (beta - alpha));
        let second = 2.0 * libm::atan2(k * libm::cos(0.5 * first), libm::sin(0.5 * first));
        [first, second, -first, -second]
    }

    /// The frame at the end of each link; that of the last one is the first one again.
    fn frames(&self, first: f64) -> [Isometry3<f64>; 4] {
        let mut at = Isometry3::identity();
        let mut index = 0;
        self.angles(first).map(|angle| {
            let side = index % 2;
            index += 1;
            at *= UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle)
                * Translation3::new(self.lengths[side], 0.0, 0.0)
                * UnitQuaternion::from_axis_angle(&Vector3::x_axis(), self.twists[side]);
            at
        })
    }

    /// Links 1 to 3 move; link 4 is the ground, so that the closed form closes.
    fn scene(&self, start: f64, rate: f64, duration: f64, every: f64) -> Scene {
        let frames = self.frames(start);
        let closure = frames[3];
        assert!(closure.translation.vector.norm() < 1e-14 && closure.rotation.angle() < 1e-7, "{closure}");
        let starts = [Isometry3::identity(), frames[0], frames[1], frames[2]];
        let bodies: Vec<_> = (0..3)
            .map(|k| {
                let (from, to) = (starts[k].translation.vector, frames[k].translation.vector);
                let q = frames[k].rotation;
                json!({"name": format!("link {}", k + 1), "mass": 1.0, "inertia": {"principal": [0.1, 0.1, 0.1]},
                    "position": [to.x, to.y, to.z], "orientation": {"quaternion": [q.w, q.i, q.j, q.k]},
                    "center_of_mass": (frames[k].inverse_transform_vector(&((from - to) * 0.5))).as_slice()})
            })
            .collect();
        let names = ["ground", "link 1", "link 2", "link 3", "ground"];
        let joints: Vec<_> = (0..4)
            .map(|k| {
                let (p, z) = (starts[k].translation.vector, starts[k].rotation * Vector3::z());
                json!({"name": format!("J{}", k + 1), "type": "revolute", "body_i": names[k], "body_j": names[k + 1],
                    "point": p.as_slice(), "axis": z.as_slice()})
            })
            .collect();
        let scene = json!({
            "name": "bennett", "gravity": [0, 0, 0], "bodies": bodies, "joints": joints,
            "drivers": [{"type": "angle", "name": "motor", "joint": "J1", "motion": {"kind": "ramp", "rate": rate}}],
            "simulation": {"duration": duration, "every": every},
        });
        Scene::from_json(&scene.to_string()).unwrap()
    }
}

/// Overconstrained: three rows of its four hinges repeat others.
#[test]
fn bennetts_linkage_goes_round_at_any_interval_of_outputs() {
    let linkage = Bennett::new();
    for every in [0.05, 0.5, 1.0, 2.5] {
        let scene = linkage.scene(0.5, 2.0, 7.5, every);
        let found = follow(&scene);
        assert!(found.singularities.is_empty());
        for state in &found.states {
            // What the motor does, the links take up: three of 1 kg, with 0.1 kg m² about every axis.
            let energy = |time: f64| {
                let h = 1e-4;
                let place =
                    |time: f64| linkage.frames(0.5 + 2.0 * time).map(|frame| frame.translation.vector);
                let rates = [-2.0, -1.0, 1.0, 2.0].map(|k| place(time + k * h));
                let ends: Vec<Vector3<f64>> = (0..3)
                    .map(|k| (rates[0][k] - rates[1][k] * 8.0 + rates[2][k] * 8.0 - rates[3][k]) / (12.0 * h))
                    .collect();
                let turned = |frames: [Isometry3<f64>; 4]| frames.map(|frame| frame.rotation);
                let (before, after) = (
                    turned(linkage.frames(0.5 + 2.0 * (time - h))),
                    turned(linkage.frames(0.5 + 2.0 * (time + h))),
                );
                let spin = |k: usize| (after[k] * before[k].inverse()).scaled_axis() / (2.0 * h);
                let starts = [Vector3::zeros(), ends[0], ends[1]];
                (0..3)
                    .map(|k| {
                        0.5 * ((starts[k] + ends[k]) * 0.5).norm_squared() + 0.05 * spin(k).norm_squared()
                    })
                    .sum::<f64>()
            };
            let e = |k: f64| energy(state.time + k * 3e-3);
            let power = (e(-2.0) - 8.0 * e(-1.0) + 8.0 * e(1.0) - e(2.0)) / 0.036;
            let motor = state.reactions.reactions.iter().find(|r| r.joint == "motor").unwrap();
            let axis = motor.moment[2];
            assert!(
                axis.unique && (axis.value * 2.0 - power).abs() < 1e-6 * power.abs().max(1.0),
                "{axis:?} {power}"
            );
            assert!(!state.reactions.redundancies.is_empty());
            let here = |state: &KinematicState, body: usize| Vector3::from(state.bodies[body].position);
            let frames = linkage.frames(0.5 + 2.0 * state.time);
            let mut from = Vector3::zeros();
            for (body, frame) in frames.iter().take(3).enumerate() {
                let to = frame.translation.vector;
                let missed = (here(state, body) - (from + to) * 0.5).norm();
                assert!(missed < 1e-10, "{missed:e} of link {} at t = {}", body + 1, state.time);
                from = to;
            }
        }
    }
}

/// The kind of a driver, and where it starts.
type Asked<'a> = (&'a str, [f64; 3]);

/// A body that drivers turn about the vertical through a joint, once a second and more than once round.
fn turned(joint: &str, drivers: &[Asked]) -> Kinematics {
    let drivers: Vec<_> = drivers
        .iter()
        .enumerate()
        .map(|(k, (kind, start))| {
            let motion = json!({ "kind": "turning", "start": start, "axis": [0, 0, 1], "angle": { "kind": "ramp", "rate": 1.0 } });
            json!({ "type": kind, "name": format!("d{k}"), "body": "b", *kind: start, "motion": motion })
        })
        .collect();
    let joints = match joint {
        "none" => json!([]),
        kind => {
            let mut joint =
                json!({ "name": "J", "type": kind, "body_i": "ground", "body_j": "b", "point": [0, 0, 0] });
            if kind == "revolute" {
                joint["axis"] = json!([0, 0, 1]);
            }
            json!([joint])
        }
    };
    let scene = json!({
        "name": "turned", "gravity": [1, 2, -3],
        "bodies": [{ "name": "b", "mass": 2, "center_of_mass": [0.2, 0.1, 0.3], "inertia": { "principal": [0.1, 0.3, 0.2] },
            "position": [0, 0, 0], "velocity": [0, 0, 0], "angular_velocity": [0, 0, 1] }],
        "joints": joints, "drivers": drivers, "simulation": { "duration": 7.0, "every": 0.01 },
    });
    follow(&Scene::from_json(&scene.to_string()).unwrap())
}

/// Of the rows of a driver that asks for more than is free, others depend on the rest when the body has turned. No position of a
/// uniform rotation is singular: the forces on the body are m (a − g) throughout, and what is unique stays so.
#[test]
fn which_rows_depend_on_others_may_change_without_a_singular_position() {
    let point = [0.5, 0.0, 0.2];
    let cases: [(&str, &[Asked]); 4] = [
        ("revolute", &[("point", point)]),
        ("revolute", &[("vector", [1.0, 0.0, 0.0])]),
        ("spherical", &[("vector", [1.0, 0.0, 0.0]), ("vector", [0.0, 1.0, 0.0])]),
        ("none", &[("point", point), ("point", [0.0, 0.4, 0.1]), ("point", [-0.3, 0.1, 0.6])]),
    ];
    for (joint, drivers) in cases {
        let found = turned(joint, drivers);
        let told: Vec<_> = found.notes.iter().filter(|note| note.contains("singular")).collect();
        assert!(told.is_empty(), "{joint} with {drivers:?}: {} notes, first {:?}", told.len(), told.first());
        assert!(found.singularities.is_empty());
        for state in &found.states {
            let unique = |at: usize| state.reactions.reactions[at].moment[2].unique;
            match (joint, drivers[0].0) {
                // The moment about a hinge without friction is none.
                ("revolute", _) => assert!(unique(0), "t = {}", state.time),
                ("spherical", _) => {
                    assert!(state.reactions.reactions[0].force.iter().all(|force| force.unique));
                }
                _ => {}
            }
            let [x, y] = [0.2, 0.1];
            let (sin, cos) = (libm::sin(state.time), libm::cos(state.time));
            let inward = [-(cos * x - sin * y), -(sin * x + cos * y), 0.0];
            for (k, (a, g)) in inward.into_iter().zip([1.0, 2.0, -3.0]).enumerate() {
                let force: f64 = state.reactions.reactions.iter().map(|r| r.force[k].value).sum();
                assert!((force - 2.0 * (a - g)).abs() < 1e-8, "{joint}: {force} at t = {}", state.time);
            }
        }
    }
}
