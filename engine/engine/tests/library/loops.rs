//! Closed forms of loops that are driven, and the scenes that they belong to.
#![allow(clippy::unwrap_used, reason = "tests may panic")]

use nalgebra::Vector2;
use serde_json::{Value, json};
use triad_engine::scene::Scene;

/// A scene of `tests/data/problems`.
pub fn problem(name: &str) -> Scene {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/problems");
    let text = std::fs::read_to_string(root.join(format!("{name}.json"))).unwrap();
    Scene::from_json(&text).unwrap()
}

fn cross(a: Vector2<f64>, b: Vector2<f64>) -> f64 {
    a.x * b.y - a.y * b.x
}

/// The unit vector at an angle from the x axis.
pub fn direction(angle: f64) -> Vector2<f64> {
    Vector2::new(libm::cos(angle), libm::sin(angle))
}

fn quarter(a: Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-a.y, a.x)
}

/// The third corner of a triangle with the sides and the sense of the triangle `given`, over the corners `at`.
pub fn circles(at: [Vector2<f64>; 2], given: [Vector2<f64>; 3]) -> Vector2<f64> {
    let (first, second) = ((given[2] - given[0]).norm(), (given[2] - given[1]).norm());
    let sense = cross(given[1] - given[0], given[2] - given[0]).signum();
    let between = at[1] - at[0];
    let length = between.norm();
    let along = (first * first - second * second + length * length) / (2.0 * length);
    let across = (first * first - along * along).sqrt();
    at[0] + between * (along / length) + quarter(between) * (sense * across / length)
}

/// A body in its plane: its centre of mass and its turning.
#[derive(Clone, Copy, Debug)]
pub struct Planar {
    pub place: Vector2<f64>,
    pub velocity: Vector2<f64>,
    pub acceleration: Vector2<f64>,
    pub spin: f64,
    pub spin_rate: f64,
}

/// The loop at one moment.
pub struct FourBarState {
    pub bodies: [Planar; 3],
}

/// A plane four-bar O A B D with O at the origin and D on the x axis, its crank turned from 0.4 rad at 5 rad/s.
pub struct FourBar {
    /// Crank, coupler, rocker and ground, m.
    pub lengths: [f64; 4],
    /// Of crank, coupler and rocker, kg.
    pub masses: [f64; 3],
    /// Of the same about the normal of the plane, through their middles, kg m².
    pub inertias: [f64; 3],
}

const RATE: f64 = 5.0;
/// The crank's angle at the start, rad.
pub const START: f64 = 0.4;

impl FourBar {
    /// Uniform bars of 1 kg/m.
    pub fn new(lengths: [f64; 4]) -> Self {
        let [a, b, c, _] = lengths;
        Self { lengths, masses: [a, b, c], inertias: [a, b, c].map(|l| l * l * l / 12.0) }
    }

    /// O, A, B and D at an angle of the crank, with B to the left of the line from A to D, which is the branch that it starts on.
    fn points(&self, angle: f64) -> [Vector2<f64>; 4] {
        let [a, b, c, d] = self.lengths;
        let (o, top, foot) = (Vector2::zeros(), direction(angle) * a, Vector2::new(d, 0.0));
        let between = foot - top;
        let length = between.norm();
        let along = (b * b - c * c + length * length) / (2.0 * length);
        // As a product, which keeps its digits next to a change point.
        let height = (((b + c + length) * (b + c - length) * (length + b - c) * (length - b + c)).sqrt())
            / (2.0 * length);
        [o, top, top + between * (along / length) + quarter(between) * (height / length), foot]
    }

    /// Everything at a time, the crank turning at its rate.
    pub fn at(&self, time: f64) -> FourBarState {
        self.turned([START + RATE * time, RATE, 0.0])
    }

    /// Everything at an angle of the crank, with its first and second derivative, by differentiating |B − A| = b.
    pub fn turned(&self, [angle, rate, growth]: [f64; 3]) -> FourBarState {
        let [_, a, b, d] = self.points(angle);
        let (link, arm) = (b - a, b - d);
        let (a_dot, a_ddot) = (quarter(a) * rate, quarter(a) * growth - a * (rate * rate));
        let lever = link.dot(&quarter(arm));
        let rocker = link.dot(&a_dot) / lever;
        let b_dot = quarter(arm) * rocker;
        let relative = b_dot - a_dot;
        let rocker_rate = (link.dot(&(a_ddot + arm * (rocker * rocker))) - relative.norm_squared()) / lever;
        let b_ddot = quarter(arm) * rocker_rate - arm * (rocker * rocker);
        let square = link.norm_squared();
        let middle = |x: Vector2<f64>, y: Vector2<f64>| (x + y) * 0.5;
        let zero = Vector2::zeros();
        let body = |place, velocity, acceleration, spin, spin_rate| Planar {
            place,
            velocity,
            acceleration,
            spin,
            spin_rate,
        };
        FourBarState {
            bodies: [
                body(a * 0.5, a_dot * 0.5, a_ddot * 0.5, rate, growth),
                body(
                    middle(a, b),
                    middle(a_dot, b_dot),
                    middle(a_ddot, b_ddot),
                    cross(link, relative) / square,
                    cross(link, b_ddot - a_ddot) / square,
                ),
                body(middle(d, b), middle(zero, b_dot), middle(zero, b_ddot), rocker, rocker_rate),
            ],
        }
    }

    /// The torque that the motor exerts: its power is what the bodies take up, weight included.
    pub fn torque(&self, at: &FourBarState) -> f64 {
        let weight = Vector2::new(0.0, -9.81);
        let power =
            at.bodies.iter().zip(self.masses.iter().zip(self.inertias)).map(|(body, (mass, inertia))| {
                (body.acceleration - weight).dot(&body.velocity) * mass + inertia * body.spin * body.spin_rate
            });
        power.sum::<f64>() / at.bodies[0].spin
    }

    /// The scene.
    pub fn scene(&self, duration: f64, every: f64) -> Scene {
        let [o, a, b, d] = self.points(START);
        let bar = |index: usize, name: &str, from: Vector2<f64>, to: Vector2<f64>| {
            let (u, inertia) = ((to - from).normalize(), self.inertias[index]);
            json!({
                "name": name, "mass": self.masses[index], "inertia": {"principal": [0.0, inertia, inertia]},
                "center_of_mass": [0.5 * (to - from).norm(), 0, 0], "position": [from.x, from.y, 0],
                "orientation": {"u": [u.x, u.y, 0], "v": [-u.y, u.x, 0]},
            })
        };
        let pin = |name: &str, i: &str, j: &str, at: Vector2<f64>| -> Value {
            json!({"name": name, "type": "revolute", "body_i": i, "body_j": j, "point": [at.x, at.y, 0], "axis": [0, 0, 1]})
        };
        let scene = json!({
            "name": "four-bar", "gravity": [0, -9.81, 0],
            "bodies": [bar(0, "crank", o, a), bar(1, "coupler", a, b), bar(2, "rocker", d, b)],
            "joints": [
                pin("O", "ground", "crank", o), pin("A", "crank", "coupler", a),
                pin("B", "coupler", "rocker", b), pin("D", "ground", "rocker", d),
            ],
            "drivers": [{"type": "angle", "name": "motor", "joint": "O", "motion": {"kind": "ramp", "rate": RATE}}],
            "simulation": {"duration": duration, "every": every},
        });
        Scene::from_json(&scene.to_string()).unwrap()
    }
}
