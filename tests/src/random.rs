//! Random scenes: bodies with asymmetric inertia given about shifted and turned frames, joints at points off their
//! centres, full and reduced coordinates mixed, trees with and without a closed loop.

use proptest::prelude::*;
use serde_json::{Value, json};
use triad_engine::Scene;

type Triple = [f64; 3];

/// What a body is drawn as.
#[derive(Clone, Debug)]
pub struct RandomBody {
    mass: f64,
    /// ∫ξ² dm, ∫η² dm, ∫ζ² dm: any positive numbers make a possible body.
    second_moments: Triple,
    tensor_axis: Triple,
    center_of_mass: Triple,
    position: Triple,
    axis: Triple,
    angle: f64,
    velocity: Triple,
    angular_velocity: Triple,
    reduced: bool,
    /// Which earlier body it hangs on; the first choice is the ground.
    parent: prop::sample::Index,
    joint: RandomJoint,
}

/// What a joint is drawn as.
#[derive(Clone, Debug)]
pub struct RandomJoint {
    kind: u8,
    point: Triple,
    axis: Triple,
}

/// A scene before it is written down.
#[derive(Clone, Debug)]
pub struct RandomScene {
    bodies: Vec<RandomBody>,
    gravity: Triple,
    /// Joins the last body to the ground at one more point.
    loop_closure: Option<Triple>,
    /// Whether the first body hangs on the ground.
    grounded: bool,
}

fn triple(size: f64) -> impl Strategy<Value = Triple> {
    prop::array::uniform3(-size..size)
}

fn direction() -> impl Strategy<Value = Triple> {
    triple(1.0).prop_filter("a direction has a length", |a| a.iter().map(|x| x * x).sum::<f64>() > 0.1)
}

fn joint() -> impl Strategy<Value = RandomJoint> {
    (0u8..4, triple(1.0), direction()).prop_map(|(kind, point, axis)| RandomJoint { kind, point, axis })
}

fn body() -> impl Strategy<Value = RandomBody> {
    (
        (0.3..3.0f64, prop::array::uniform3(0.05..1.0f64), direction(), triple(0.4)),
        (triple(1.0), direction(), -3.0..3.0f64, triple(1.0), triple(2.0)),
        (any::<bool>(), any::<prop::sample::Index>(), joint()),
    )
        .prop_map(|(inertia, start, rest)| RandomBody {
            mass: inertia.0,
            second_moments: inertia.1,
            tensor_axis: inertia.2,
            center_of_mass: inertia.3,
            position: start.0,
            axis: start.1,
            angle: start.2,
            velocity: start.3,
            angular_velocity: start.4,
            reduced: rest.0,
            parent: rest.1,
            joint: rest.2,
        })
}

/// Scenes of one to four bodies.
pub fn scenes() -> impl Strategy<Value = RandomScene> {
    (prop::collection::vec(body(), 1..=4), triple(10.0), prop::option::of(triple(1.0)), any::<bool>())
        .prop_map(|(bodies, gravity, loop_closure, grounded)| RandomScene {
            bodies,
            gravity,
            loop_closure,
            grounded,
        })
}

/// How a scene is written down.
#[derive(Clone, Copy, Default)]
pub struct Choice {
    /// Coordinates of all bodies, if not those drawn.
    pub coordinates: Option<&'static str>,
    /// Rows of revolute joints.
    pub revolute: Option<&'static str>,
    /// Leave the ground and the closed loop away.
    pub free: bool,
    /// Leave the closed loop away.
    pub tree: bool,
}

impl RandomScene {
    /// The scene.
    pub fn scene(&self, choice: Choice) -> Scene {
        let bodies: Vec<Value> =
            self.bodies.iter().enumerate().map(|(i, b)| b.write(i, choice.coordinates)).collect();
        let mut joints = Vec::new();
        for (i, body) in self.bodies.iter().enumerate() {
            let parent = body.parent.index(i + 1);
            let hangs_on_ground = parent == 0;
            if hangs_on_ground && (choice.free || !self.grounded) {
                continue;
            }
            let parent = if hangs_on_ground { "ground".to_owned() } else { format!("b{}", parent - 1) };
            joints.push(body.joint.write(i, &parent, choice.revolute));
        }
        if let Some(point) = self.loop_closure.filter(|_| !choice.free && !choice.tree) {
            let last = format!("b{}", self.bodies.len() - 1);
            joints.push(json!({
                "name": "closure", "type": "spherical", "body_i": last, "body_j": "ground", "point": point
            }));
        }
        let scene = json!({
            "name": "random", "gravity": self.gravity, "bodies": bodies, "joints": joints,
            "simulation": { "duration": 1.0, "tolerance": 1e-11, "integrator": "dop853" }
        });
        Scene::from_json(&scene.to_string()).unwrap()
    }
}

impl RandomBody {
    fn write(&self, index: usize, coordinates: Option<&str>) -> Value {
        let chosen = if self.reduced { "reduced" } else { "full" };
        json!({
            "name": format!("b{index}"),
            "mass": self.mass,
            "inertia": { "tensor": self.tensor() },
            "center_of_mass": self.center_of_mass,
            "position": self.position,
            "orientation": { "axis": self.axis, "angle": self.angle },
            "velocity": self.velocity,
            "angular_velocity": self.angular_velocity,
            "coordinates": coordinates.unwrap_or(chosen),
        })
    }

    /// R diag(I) Rᵀ for a turn of one radian about the drawn axis.
    fn tensor(&self) -> [Triple; 3] {
        let [a, b, c] = self.second_moments;
        let moments = nalgebra::Vector3::new(b + c, c + a, a + b);
        let axis = nalgebra::Unit::new_normalize(nalgebra::Vector3::from(self.tensor_axis));
        let turn = nalgebra::Rotation3::from_axis_angle(&axis, 1.0).into_inner();
        let tensor = turn * nalgebra::Matrix3::from_diagonal(&moments) * turn.transpose();
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| 0.5 * (tensor[(i, j)] + tensor[(j, i)])))
    }
}

impl RandomJoint {
    fn write(&self, index: usize, parent: &str, revolute: Option<&str>) -> Value {
        let mut joint = json!({
            "name": format!("j{index}"), "body_i": parent, "body_j": format!("b{index}"), "point": self.point
        });
        match self.kind {
            0 => joint["type"] = json!("spherical"),
            1 => {
                joint["type"] = json!("universal");
                let first = nalgebra::Vector3::from(self.axis).normalize();
                let other = if first.x.abs() < 0.5 { nalgebra::Vector3::x() } else { nalgebra::Vector3::y() };
                let second: Triple = first.cross(&other).normalize().into();
                joint["axes"] = json!([Triple::from(first), second]);
            }
            kind => {
                joint["type"] = json!("revolute");
                joint["axis"] = json!(self.axis);
                joint["rows"] = json!(revolute.unwrap_or(if kind == 2 { "cp-cv" } else { "cp-2car" }));
            }
        }
        joint
    }
}
