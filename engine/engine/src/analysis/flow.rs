//! Steady motions: all bodies keep their places in a frame that turns and slides uniformly; a body that is alike all around an
//! axis may spin about it besides — eq. (10.15).

use nalgebra::{Matrix3, Rotation3, Vector3};
use triad_dynamics::system::body::RigidBody;
use triad_dynamics::system::natural::NaturalCoordinates;

/// A spin about a principal axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spin {
    /// Which director.
    pub axis: usize,
    /// Angular velocity in the frame, rad/s.
    pub rate: f64,
}

/// A steady motion; by default none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Flow {
    /// Angular velocity Ω of the frame, rad/s.
    pub turning: Vector3<f64>,
    /// A point, and the velocity of the frame there, m/s.
    pub about: Vector3<f64>,
    pub sliding: Vector3<f64>,
    /// Uniform velocity that carries the axis of turning along, m/s.
    pub carried: Vector3<f64>,
    /// Spin of each body; none at rest.
    pub spins: Vec<Spin>,
}

impl Flow {
    /// Velocity and angular velocity of a body at a place.
    pub fn twist(&self, body: usize, at: &NaturalCoordinates) -> [Vector3<f64>; 2] {
        let Spin { axis, rate } = self.spins.get(body).copied().unwrap_or_default();
        [self.sliding + self.turning.cross(&(at.r - self.about)), self.turning + at.e[axis] * rate]
    }

    /// Velocity of the frame at the world's origin, m/s; what of it is below `least` is rounding.
    pub fn at_origin(&self, least: f64) -> Vector3<f64> {
        (self.sliding - self.turning.cross(&self.about)).map(|x| if x.abs() <= least { 0.0 } else { x })
    }

    /// Generalized velocities of a body at a place.
    pub fn rate(&self, body: usize, at: &NaturalCoordinates) -> NaturalCoordinates {
        let [v, omega] = self.twist(body, at);
        NaturalCoordinates { r: v, e: at.e.map(|e| omega.cross(&e)) }
    }

    /// Whether anything moves.
    pub fn is_rest(&self) -> bool {
        self.turning == Vector3::zeros()
            && self.sliding == Vector3::zeros()
            && self.spins.iter().all(|spin| spin.rate == 0.0)
    }

    /// Force and moment of inertia (−m a, −ḣ) on a body that moves in the frame with velocity v and angular velocity w, and does
    /// not accelerate there: centrifugal, Coriolis and gyroscopic parts.
    pub fn inertial(
        &self,
        index: usize,
        body: &RigidBody,
        at: &NaturalCoordinates,
        [v, w]: [Vector3<f64>; 2],
    ) -> [Vector3<f64>; 2] {
        let Spin { axis, rate } = self.spins.get(index).copied().unwrap_or_default();
        let axes = Matrix3::from_columns(&at.e);
        let inertia = axes * Matrix3::from_diagonal(&body.principal) * axes.transpose();
        let (turning, e) = (self.turning, at.e[axis]);
        let turned = turning.cross(&(at.r - self.about));
        let acceleration = turning.cross(&(self.sliding - self.carried + turned)) + turning.cross(&v) * 2.0;
        // h = I ω changes with the attitude of the body in the frame, with the axis of its spin, and with the frame.
        let (omega, attitude) = (turning + e * rate + w, w + e * rate);
        let h = inertia * omega;
        let change = attitude.cross(&h) - inertia * attitude.cross(&omega)
            + inertia * w.cross(&e) * rate
            + turning.cross(&h);
        [acceleration * -body.mass, -change]
    }

    /// The place of a body a time later.
    pub fn later(&self, body: usize, at: &NaturalCoordinates, time: f64) -> NaturalCoordinates {
        let Spin { axis, rate } = self.spins.get(body).copied().unwrap_or_default();
        let turn = Rotation3::from_scaled_axis(self.turning * time);
        let spin = Rotation3::from_scaled_axis(at.e[axis] * (rate * time));
        // A point of the axis, and how it moves.
        let (square, sliding) = (self.turning.norm_squared(), self.sliding - self.carried);
        let (centre, along) = if square > 0.0 {
            let along = self.turning * (self.turning.dot(&sliding) / square);
            (self.about + self.turning.cross(&sliding) / square, along + self.carried)
        } else {
            (self.about, self.sliding)
        };
        NaturalCoordinates {
            r: centre + turn * (at.r - centre) + along * time,
            e: at.e.map(|e| turn * (spin * e)),
        }
    }
}
