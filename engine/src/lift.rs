//! Coordinates of a body, full or reduced, and the map between them — THEORY section 3.
//!
//! Constraints, loads and inertia are written in the *lifted* coordinates Q = (r, u, v, w) of a body. A full body has
//! q = Q; a reduced body has q = (r, u, v), and w = u × v. Then Q̇ = V q̇ and Q̈ = V q̈ + V̇ q̇, where V is never built:
//! each product with it is two cross products.

use crate::scene::Coordinates;
use nalgebra::Vector3;

/// A vector of the lifted coordinates (r, u, v, w) of one body: position, velocity, acceleration or force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lift {
    /// Part that belongs to the centre of mass r.
    pub r: Vector3<f64>,
    /// Parts that belong to the directors u, v, w.
    pub e: [Vector3<f64>; 3],
}

impl Default for Lift {
    fn default() -> Self {
        Self { r: Vector3::zeros(), e: [Vector3::zeros(); 3] }
    }
}

impl Lift {
    /// Sum of products of all twelve components.
    pub fn dot(&self, other: &Self) -> f64 {
        self.r.dot(&other.r) + (0..3).map(|k| self.e[k].dot(&other.e[k])).sum::<f64>()
    }

    /// C Q for local coordinates (ξ, η, ζ), without the part of r: ξ u + η v + ζ w — eq. (2.3).
    pub fn arm(&self, local: &Vector3<f64>) -> Vector3<f64> {
        self.e[0] * local[0] + self.e[1] * local[1] + self.e[2] * local[2]
    }
}

/// Number of generalized coordinates of a body.
pub const fn size(coordinates: Coordinates) -> usize {
    match coordinates {
        Coordinates::Full => 12,
        Coordinates::Reduced => 9,
    }
}

/// Number of rigid-body rows of a body.
pub const fn rigid_rows(coordinates: Coordinates) -> usize {
    match coordinates {
        Coordinates::Full => 6,
        Coordinates::Reduced => 3,
    }
}

fn vector(q: &[f64], at: usize) -> Vector3<f64> {
    Vector3::new(q[at], q[at + 1], q[at + 2])
}

/// Q of generalized coordinates q.
pub fn position(coordinates: Coordinates, q: &[f64]) -> Lift {
    let (r, u, v) = (vector(q, 0), vector(q, 3), vector(q, 6));
    let w = match coordinates {
        Coordinates::Full => vector(q, 9),
        Coordinates::Reduced => u.cross(&v),
    };
    Lift { r, e: [u, v, w] }
}

/// Q̇ = V q̇ — eq. (3.2).
pub fn velocity(coordinates: Coordinates, q: &Lift, q_dot: &[f64]) -> Lift {
    let (r, u, v) = (vector(q_dot, 0), vector(q_dot, 3), vector(q_dot, 6));
    let w = match coordinates {
        Coordinates::Full => vector(q_dot, 9),
        Coordinates::Reduced => u.cross(&q.e[1]) + q.e[0].cross(&v),
    };
    Lift { r, e: [u, v, w] }
}

/// Writes the generalized part of a lifted vector: all of it, or (r, u, v).
pub fn store(coordinates: Coordinates, lifted: &Lift, out: &mut [f64]) {
    out[..3].copy_from_slice(lifted.r.as_slice());
    for k in 0..size(coordinates) / 3 - 1 {
        out[3 + 3 * k..6 + 3 * k].copy_from_slice(lifted.e[k].as_slice());
    }
}

/// Vᵀ p: a generalized force of the lifted coordinates, in the body's own — eq. (3.4).
pub fn pull_back(coordinates: Coordinates, q: &Lift, p: &Lift) -> Lift {
    match coordinates {
        Coordinates::Full => *p,
        Coordinates::Reduced => Lift {
            r: p.r,
            e: [p.e[0] + q.e[1].cross(&p.e[2]), p.e[1] - q.e[0].cross(&p.e[2]), Vector3::zeros()],
        },
    }
}
