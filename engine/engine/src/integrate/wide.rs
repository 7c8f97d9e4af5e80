//! Numbers and vectors of several states side by side, one in each lane of a register of the processor.
//!
//! Products are added by fused operations, so that every processor gives the same bits, however many lanes it has. No closure holds
//! numbers of several states: what takes one, as `map` of arrays does, is not compiled for the registers of the processor.

mod sine;

use nalgebra::Vector3;
use pulp::Simd;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// Most lanes of a register.
pub const MOST_LANES: usize = 4;

/// Numbers as they lie in memory, and vectors of them; where registers have fewer lanes, the last ones are idle.
pub type Stored = [f64; MOST_LANES];
/// A vector.
pub type StoredVector = [Stored; 3];

/// A number of each state.
#[derive(Clone, Copy)]
pub struct Wide<S: Simd> {
    simd: S,
    lanes: S::f64s,
}

impl<S: Simd> Wide<S> {
    /// The same number in all lanes.
    #[inline(always)]
    pub fn all(simd: S, x: f64) -> Self {
        Self { simd, lanes: simd.splat_f64s(x) }
    }

    /// The registers.
    #[inline(always)]
    pub fn simd(self) -> S {
        self.simd
    }

    /// Out of memory.
    #[inline(always)]
    pub fn load(simd: S, from: &Stored) -> Self {
        const { assert!(S::F64_LANES <= MOST_LANES) };
        match S::as_simd_f64s(from).0 {
            [lanes, ..] => Self { simd, lanes: *lanes },
            [] => Self::all(simd, f64::NAN),
        }
    }

    /// Into memory.
    #[inline(always)]
    pub fn store(self, to: &mut Stored) {
        if let Some(to) = S::as_mut_simd_f64s(to).0.first_mut() {
            *to = self.lanes;
        }
    }

    /// Lane by lane.
    #[inline(always)]
    pub fn each(self, mut of: impl FnMut(usize, f64) -> f64) -> Self {
        let mut lanes = [0.0; MOST_LANES];
        self.store(&mut lanes);
        for (lane, x) in lanes[..S::F64_LANES].iter_mut().enumerate() {
            *x = of(lane, *x);
        }
        Self::load(self.simd, &lanes)
    }

    /// Itself and a b.
    #[inline(always)]
    pub fn plus(self, a: Self, b: Self) -> Self {
        Self { lanes: self.simd.mul_add_f64s(a.lanes, b.lanes, self.lanes), ..self }
    }

    /// Itself less a b.
    #[inline(always)]
    pub fn less(self, a: Self, b: Self) -> Self {
        Self { lanes: self.simd.negate_mul_add_f64s(a.lanes, b.lanes, self.lanes), ..self }
    }

    /// √x.
    #[inline(always)]
    pub fn root(self) -> Self {
        Self { lanes: self.simd.sqrt_f64s(self.lanes), ..self }
    }
}

impl<S: Simd> Add for Wide<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { lanes: self.simd.add_f64s(self.lanes, other.lanes), ..self }
    }
}

impl<S: Simd> Sub for Wide<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { lanes: self.simd.sub_f64s(self.lanes, other.lanes), ..self }
    }
}

impl<S: Simd> Mul for Wide<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self { lanes: self.simd.mul_f64s(self.lanes, other.lanes), ..self }
    }
}

impl<S: Simd> Div for Wide<S> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Self { lanes: self.simd.div_f64s(self.lanes, other.lanes), ..self }
    }
}

impl<S: Simd> Neg for Wide<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { lanes: self.simd.neg_f64s(self.lanes), ..self }
    }
}

/// A vector of each state.
#[derive(Clone, Copy)]
pub struct WideVector<S: Simd>(pub [Wide<S>; 3]);

impl<S: Simd> WideVector<S> {
    /// The same vector in all lanes.
    #[inline(always)]
    pub fn all(simd: S, v: &Vector3<f64>) -> Self {
        Self([Wide::all(simd, v.x), Wide::all(simd, v.y), Wide::all(simd, v.z)])
    }

    /// The registers.
    #[inline(always)]
    pub fn simd(self) -> S {
        self.0[0].simd()
    }

    /// Out of memory.
    #[inline(always)]
    pub fn load(simd: S, [x, y, z]: &StoredVector) -> Self {
        Self([Wide::load(simd, x), Wide::load(simd, y), Wide::load(simd, z)])
    }

    /// Into memory.
    #[inline(always)]
    pub fn store(self, to: &mut StoredVector) {
        let [x, y, z] = self.0;
        let [to_x, to_y, to_z] = to;
        x.store(to_x);
        y.store(to_y);
        z.store(to_z);
    }

    /// a · b.
    #[inline(always)]
    pub fn dot(self, Self([u, v, w]): Self) -> Wide<S> {
        let [x, y, z] = self.0;
        (x * u).plus(y, v).plus(z, w)
    }

    /// a × b.
    #[inline(always)]
    pub fn cross(self, Self([u, v, w]): Self) -> Self {
        let [x, y, z] = self.0;
        Self([(y * w).less(z, v), (z * u).less(x, w), (x * v).less(y, u)])
    }

    /// Times a number.
    #[inline(always)]
    pub fn times(self, by: Wide<S>) -> Self {
        let [x, y, z] = self.0;
        Self([x * by, y * by, z * by])
    }

    /// Itself and a times b.
    #[inline(always)]
    pub fn plus(self, Self([u, v, w]): Self, by: Wide<S>) -> Self {
        let [x, y, z] = self.0;
        Self([x.plus(u, by), y.plus(v, by), z.plus(w, by)])
    }
}

impl<S: Simd> Add for WideVector<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, Self([u, v, w]): Self) -> Self {
        let [x, y, z] = self.0;
        Self([x + u, y + v, z + w])
    }
}

impl<S: Simd> Sub for WideVector<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, Self([u, v, w]): Self) -> Self {
        let [x, y, z] = self.0;
        Self([x - u, y - v, z - w])
    }
}

/// Two vectors that belong together: spin and flow of a twist, or moment and force.
#[derive(Clone, Copy)]
pub struct WidePair<S: Simd> {
    /// Spin, or moment.
    pub turning: WideVector<S>,
    /// Flow, or force.
    pub moving: WideVector<S>,
}

/// The same in memory.
pub type StoredPair = [StoredVector; 2];

impl<S: Simd> WidePair<S> {
    /// Rest, or no force.
    #[inline(always)]
    pub fn zero(simd: S) -> Self {
        let zero = WideVector([Wide::all(simd, 0.0); 3]);
        Self { turning: zero, moving: zero }
    }

    /// Out of memory.
    #[inline(always)]
    pub fn load(simd: S, [turning, moving]: &StoredPair) -> Self {
        Self { turning: WideVector::load(simd, turning), moving: WideVector::load(simd, moving) }
    }

    /// Into memory.
    #[inline(always)]
    pub fn store(self, to: &mut StoredPair) {
        let [turning, moving] = to;
        self.turning.store(turning);
        self.moving.store(moving);
    }

    /// Power of a wrench along a twist.
    #[inline(always)]
    pub fn along(self, twist: Self) -> Wide<S> {
        self.turning.dot(twist.turning) + self.moving.dot(twist.moving)
    }

    /// Itself and another one times a number.
    #[inline(always)]
    pub fn plus(self, other: Self, by: Wide<S>) -> Self {
        Self { turning: self.turning.plus(other.turning, by), moving: self.moving.plus(other.moving, by) }
    }

    /// Rate of a twist that is constant in a frame that moves with this one.
    #[inline(always)]
    pub fn drag(self, carried: Self) -> Self {
        Self {
            turning: self.turning.cross(carried.turning),
            moving: self.turning.cross(carried.moving) + self.moving.cross(carried.turning),
        }
    }
}

impl<S: Simd> AddAssign for WidePair<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        self.turning = self.turning + other.turning;
        self.moving = self.moving + other.moving;
    }
}

impl<S: Simd> Sub for WidePair<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { turning: self.turning - other.turning, moving: self.moving - other.moving }
    }
}

/// A turn, by its columns, and a shift.
#[derive(Clone, Copy)]
pub struct WidePlacement<S: Simd> {
    /// Where the unit vectors come to point.
    pub turn: [WideVector<S>; 3],
    /// Where the origin comes to lie.
    pub at: WideVector<S>,
}

/// The same in memory.
pub type StoredPlacement = [StoredVector; 4];

impl<S: Simd> WidePlacement<S> {
    /// Out of memory.
    #[inline(always)]
    pub fn load(simd: S, [u, v, w, at]: &StoredPlacement) -> Self {
        let turn = [WideVector::load(simd, u), WideVector::load(simd, v), WideVector::load(simd, w)];
        Self { turn, at: WideVector::load(simd, at) }
    }

    /// Into memory.
    #[inline(always)]
    pub fn store(self, to: &mut StoredPlacement) {
        let [u, v, w, at] = to;
        let turn = self.turn;
        turn[0].store(u);
        turn[1].store(v);
        turn[2].store(w);
        self.at.store(at);
    }

    /// A vector that turns with it.
    #[inline(always)]
    pub fn turned(&self, WideVector([x, y, z]): WideVector<S>) -> WideVector<S> {
        let [u, v, w] = self.turn;
        u.times(x).plus(v, y).plus(w, z)
    }

    /// First `first`, then this one.
    #[inline(always)]
    pub fn after(&self, first: &Self) -> Self {
        let [u, v, w] = first.turn;
        Self { turn: [self.turned(u), self.turned(v), self.turned(w)], at: self.turned(first.at) + self.at }
    }

    /// A twist that is written in the moved frame, in the one from which it moved.
    #[inline(always)]
    pub fn carry(&self, twist: WidePair<S>) -> WidePair<S> {
        let turning = self.turned(twist.turning);
        WidePair { turning, moving: self.turned(twist.moving) + self.at.cross(turning) }
    }
}
