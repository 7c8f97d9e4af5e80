//! Places and motions of bodies, as a tree of joints multiplies and adds them.

use nalgebra::{Matrix3, Vector3};
use std::ops::{Add, Mul, Sub};

/// A turn and a shift: x ↦ `turn` x + `at`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// The turn.
    pub turn: Matrix3<f64>,
    /// Where the origin comes to lie, m.
    pub at: Vector3<f64>,
}

impl Placement {
    /// No motion.
    pub fn identity() -> Self {
        Self { turn: Matrix3::identity(), at: Vector3::zeros() }
    }

    /// First `first`, then this one.
    pub fn after(&self, first: &Self) -> Self {
        Self { turn: self.turn * first.turn, at: self.turn * first.at + self.at }
    }

    /// Where the unit vectors come to point: the directors of a body.
    pub fn directors(&self) -> [Vector3<f64>; 3] {
        let m = &self.turn;
        [
            Vector3::new(m.m11, m.m21, m.m31),
            Vector3::new(m.m12, m.m22, m.m32),
            Vector3::new(m.m13, m.m23, m.m33),
        ]
    }

    /// This placement as seen from another one.
    pub fn seen_from(&self, other: &Self) -> Self {
        Self { turn: other.turn.tr_mul(&self.turn), at: other.turn.tr_mul(&(self.at - other.at)) }
    }

    /// A twist that is written in the moved frame, in the one from which it moved.
    pub fn carry(&self, twist: &Twist) -> Twist {
        let spin = self.turn * twist.spin;
        Twist { spin, flow: self.turn * twist.flow + self.at.cross(&spin) }
    }
}

/// A velocity, or an acceleration, of a rigid body: angular, and of its point that is at the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist {
    /// Angular velocity, rad/s.
    pub spin: Vector3<f64>,
    /// Velocity of the point at the origin, m/s.
    pub flow: Vector3<f64>,
}

impl Twist {
    /// Rest.
    pub fn zero() -> Self {
        Self { spin: Vector3::zeros(), flow: Vector3::zeros() }
    }

    /// From the velocity of the point at `at`.
    pub fn through(at: &Vector3<f64>, velocity: &Vector3<f64>, spin: &Vector3<f64>) -> Self {
        Self { spin: *spin, flow: velocity - spin.cross(at) }
    }

    /// Velocity of the point at `at`.
    pub fn at(&self, at: &Vector3<f64>) -> Vector3<f64> {
        self.flow + self.spin.cross(at)
    }

    /// The same with the velocity of the point at `center` in the place of that at the origin.
    pub fn about(&self, center: &Vector3<f64>) -> Self {
        Self { spin: self.spin, flow: self.at(center) }
    }

    /// Rate of a twist that is constant in a frame that moves with this one.
    pub fn drag(&self, carried: &Self) -> Self {
        Self {
            spin: self.spin.cross(&carried.spin),
            flow: self.spin.cross(&carried.flow) + self.flow.cross(&carried.spin),
        }
    }
}

impl Add for Twist {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { spin: self.spin + other.spin, flow: self.flow + other.flow }
    }
}

impl Sub for Twist {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self { spin: self.spin - other.spin, flow: self.flow - other.flow }
    }
}

impl Mul<f64> for Twist {
    type Output = Self;
    fn mul(self, by: f64) -> Self {
        Self { spin: self.spin * by, flow: self.flow * by }
    }
}
