//! Coordinates of a body, full, reduced or shared with a neighbour, and the map between them — THEORY section 3.
//!
//! Constraints, loads and inertia are written in *natural coordinates* Q = (r, u, v, w) of a body. A full body has
//! q = Q; a reduced body has q = (r, u, v), and w = u × v. Then Q̇ = V q̇ and Q̈ = V q̈ + V̇ q̇, where V is never built:
//! each product with it is two cross products. Two bodies that share a director at a joint have its coordinates once.

use crate::scene::Coordinates;
use nalgebra::Vector3;

/// A vector of the natural coordinates (r, u, v, w) of one body: position, velocity, acceleration or force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NaturalCoordinates {
    /// Part that belongs to the centre of mass r.
    pub r: Vector3<f64>,
    /// Parts that belong to the directors u, v, w.
    pub e: [Vector3<f64>; 3],
}

impl Default for NaturalCoordinates {
    fn default() -> Self {
        Self { r: Vector3::zeros(), e: [Vector3::zeros(); 3] }
    }
}

impl NaturalCoordinates {
    /// Sum of products of all twelve components.
    pub fn dot(&self, other: &Self) -> f64 {
        self.r.dot(&other.r) + (0..3).map(|k| self.e[k].dot(&other.e[k])).sum::<f64>()
    }

    /// Largest violation of the rigid-body rows; not a number if one of them is none.
    pub fn stretch(&self) -> f64 {
        let mut largest = 0.0;
        for k in 0..3 {
            for l in 0..=k {
                let unit = if k == l { 1.0 } else { 0.0 };
                let violation = (self.e[k].dot(&self.e[l]) - unit).abs();
                if violation.is_nan() || violation > largest {
                    largest = violation;
                }
            }
        }
        largest
    }

    /// C Q for local coordinates (ξ, η, ζ), without the part of r: ξ u + η v + ζ w — eq. (2.3).
    pub fn arm(&self, local: &Vector3<f64>) -> Vector3<f64> {
        self.e[0] * local[0] + self.e[1] * local[1] + self.e[2] * local[2]
    }

    /// Natural coordinates of what stands at `place` in the frame of this body. Linear, so for rates and errors as for positions —
    /// eq. (7.11).
    #[must_use]
    pub fn carried(&self, place: &Self) -> Self {
        Self { r: self.r + self.arm(&place.r), e: place.e.map(|e| self.arm(&e)) }
    }

    /// Natural coordinates of the body in whose frame this one stands at `place`.
    #[must_use]
    pub fn carrier(&self, place: &Self) -> Self {
        let e = [0, 1, 2].map(|l| (0..3).map(|k| self.e[k] * place.e[k][l]).sum());
        let carrier = Self { r: self.r, e };
        Self { r: self.r - carrier.arm(&place.r), e }
    }
}

/// Where a director of a body comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Director {
    /// Its own coordinates, from this column of q on.
    Own(usize),
    /// A director of another body, or its opposite: their joint shares it.
    Shared {
        /// First column of that director.
        column: usize,
        /// 1 or −1.
        sign: f64,
    },
    /// A vector of the ground.
    Fixed(Vector3<f64>),
    /// The third director of a reduced body, u × v.
    Product,
}

impl Director {
    /// First column of its coordinates and their sign, if it has any.
    pub fn column(self) -> Option<(usize, f64)> {
        match self {
            Self::Own(column) => Some((column, 1.0)),
            Self::Shared { column, sign } => Some((column, sign)),
            Self::Fixed(_) | Self::Product => None,
        }
    }

    /// Whether it is described by coordinates of its body.
    pub fn is_own(self) -> bool {
        matches!(self, Self::Own(_))
    }
}

/// How the natural coordinates of a body follow from q.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layout {
    /// First column of its own coordinates: those of r.
    pub first: usize,
    /// Its directors u, v, w.
    pub directors: [Director; 3],
}

/// Directors (k, l) of the six rigid-body rows, in their order, and the labels of the rows — eq. (4.6).
pub const RIGID_ROWS: [(usize, usize, &str); 6] =
    [(0, 0, "uu"), (1, 1, "vv"), (2, 2, "ww"), (0, 1, "uv"), (0, 2, "uw"), (1, 2, "vw")];

impl Layout {
    /// A body with its own directors; the third of a reduced body is a product.
    pub fn own(coordinates: Coordinates, first: usize) -> Self {
        let third = match coordinates {
            Coordinates::Full | Coordinates::Shared => Director::Own(first + 9),
            Coordinates::Reduced => Director::Product,
        };
        Self { first, directors: [Director::Own(first + 3), Director::Own(first + 6), third] }
    }

    /// Number of its own generalized coordinates.
    pub fn size(&self) -> usize {
        3 + 3 * self.directors.iter().filter(|d| d.is_own()).count()
    }

    /// Its rigid-body rows: each pair of directors of which at least one is its own and none a product, and the unit
    /// length of its own.
    pub fn rigid_rows(&self) -> impl Iterator<Item = (usize, usize, &'static str)> {
        let directors = self.directors;
        RIGID_ROWS.into_iter().filter(move |&(k, l, _)| {
            let pair = [directors[k], directors[l]];
            pair.iter().any(|d| d.is_own()) && !pair.contains(&Director::Product)
        })
    }

    /// Whether all twelve numbers are its own, one after the other.
    fn is_plain(&self) -> bool {
        let own = |k: usize| matches!(self.directors[k], Director::Own(at) if at == self.first + 3 + 3 * k);
        own(0) && own(1) && own(2)
    }

    /// The numbers of such a body.
    #[inline(always)]
    fn plain(&self, q: &[f64]) -> Option<NaturalCoordinates> {
        let numbers = q[self.first..].first_chunk::<12>().filter(|_| self.is_plain())?;
        let vector = |k: usize| Vector3::new(numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]);
        Some(NaturalCoordinates { r: vector(0), e: [vector(1), vector(2), vector(3)] })
    }

    /// Q of all generalized coordinates q; a reduced body has w = u × v — eq. (3.1).
    pub fn position(&self, q: &[f64]) -> NaturalCoordinates {
        if let Some(plain) = self.plain(q) {
            return plain;
        }
        let read = |d: Director| match d {
            Director::Own(column) => vector(q, column),
            Director::Shared { column, sign } => vector(q, column) * sign,
            Director::Fixed(value) => value,
            Director::Product => Vector3::zeros(),
        };
        let mut e = self.directors.map(read);
        if self.directors[2] == Director::Product {
            e[2] = e[0].cross(&e[1]);
        }
        NaturalCoordinates { r: vector(q, self.first), e }
    }

    /// Q̇ = V q̇ — eq. (3.2).
    pub fn velocity(&self, at: &NaturalCoordinates, q_dot: &[f64]) -> NaturalCoordinates {
        if let Some(plain) = self.plain(q_dot) {
            return plain;
        }
        let read = |d: Director| match d.column() {
            Some((column, sign)) => vector(q_dot, column) * sign,
            None => Vector3::zeros(),
        };
        let mut e = self.directors.map(read);
        if self.directors[2] == Director::Product {
            e[2] = e[0].cross(&at.e[1]) + at.e[0].cross(&e[1]);
        }
        NaturalCoordinates { r: vector(q_dot, self.first), e }
    }

    /// Calls `put(column, value)` for each of the body's own coordinates in a vector of natural coordinates.
    pub fn own_numbers(&self, natural: &NaturalCoordinates, mut put: impl FnMut(usize, f64)) {
        for axis in 0..3 {
            put(self.first + axis, natural.r[axis]);
        }
        for (director, e) in self.directors.iter().zip(&natural.e) {
            if let Director::Own(column) = *director {
                for axis in 0..3 {
                    put(column + axis, e[axis]);
                }
            }
        }
    }

    /// Writes the body's own coordinates of a vector of natural coordinates into q.
    pub fn store(&self, natural: &NaturalCoordinates, q: &mut [f64]) {
        if let (true, Some(q)) = (self.is_plain(), q[self.first..].first_chunk_mut::<12>()) {
            let [u, v, w] = &natural.e;
            let vectors = q.as_chunks_mut::<3>().0.iter_mut().zip([&natural.r, u, v, w]);
            vectors.for_each(|(q, vector)| *q = (*vector).into());
            return;
        }
        self.own_numbers(natural, |column, value| q[column] = value);
    }

    /// Calls `put(column, value)` for each number of Vᵀ p, p a generalized force of the natural coordinates — eq. (3.4).
    pub fn pull_back(
        &self,
        at: &NaturalCoordinates,
        p: &NaturalCoordinates,
        mut put: impl FnMut(usize, f64),
    ) {
        let mut e = p.e;
        if self.directors[2] == Director::Product {
            e[0] += at.e[1].cross(&p.e[2]);
            e[1] -= at.e[0].cross(&p.e[2]);
        }
        for axis in 0..3 {
            put(self.first + axis, p.r[axis]);
        }
        for (director, e) in self.directors.iter().zip(&e) {
            if let Some((column, sign)) = director.column() {
                for axis in 0..3 {
                    put(column + axis, e[axis] * sign);
                }
            }
        }
    }
}

fn vector(q: &[f64], at: usize) -> Vector3<f64> {
    Vector3::new(q[at], q[at + 1], q[at + 2])
}
