//! What the series ask of L bodies side by side, whether they move in space or in a plane.

use super::slot::FeatureSlot;
use crate::dynamics::series::lanes::{Lane, LaneVector, lanes_of_rows, rows_of_lanes};
use crate::system::System;
use crate::system::body::RigidBody;
use crate::system::natural::NaturalCoordinates;
use nalgebra::Vector3;
use pulp::Simd;
use std::fmt::Debug;
use std::ops::Range;
use triad_linalg::fma;

/// Points of L bodies, whose numbers are turned over into rows of single bodies and back.
pub trait Points<const L: usize> {
    /// Coordinates of the bodies, or anything that lives on them.
    type Natural: Copy + Debug;

    /// [`Bodies::value`] of points, to be turned over into rows.
    fn point<S: Simd>(simd: S, slot: &FeatureSlot<L>, x: &Self::Natural) -> LaneVector<L>;
    /// Takes off the generalized force of a force on points, which comes from rows.
    fn pull_off<S: Simd>(simd: S, slot: &FeatureSlot<L>, f: &LaneVector<L>, sum: &mut Self::Natural);

    /// Points as rows of single bodies.
    #[inline(always)]
    fn point_rows<S: Simd>(simd: S, slot: &FeatureSlot<L>, x: &Self::Natural) -> [[f64; 4]; L] {
        let [first, second, third] = Self::point(simd, slot, x);
        rows_of_lanes(simd, [first, second, third, [0.0; L]])
    }

    /// Takes off the generalized force of forces on points, row by row; what stands behind the third number counts for nothing.
    #[inline(always)]
    fn pull_off_rows<S: Simd>(simd: S, slot: &FeatureSlot<L>, rows: &[[f64; 4]; L], sum: &mut Self::Natural) {
        let [first, second, third, _] = lanes_of_rows(simd, rows);
        Self::pull_off(simd, slot, &[first, second, third], sum);
    }
}

/// What tells of L bodies whether they are rigid, and how fast they move.
pub trait Measures<const L: usize>: Points<L> {
    /// How fast the bodies turn the rows of their joints: see [`crate::state::pace`].
    fn pace(rate: &Self::Natural, length: f64) -> Lane<L>;
    /// Largest violation of the rigid-body rows, or not a number.
    fn stretch(x: &Self::Natural) -> Lane<L>;
    /// Twice the kinetic energy at these rates: Σ m ṙ² + Ī ė².
    fn twice_kinetic(&self, rate: &Self::Natural) -> Lane<L>;
    /// Work of the weight on the way from one position to another.
    fn work_of_weight(&self, from: &Self::Natural, to: &Self::Natural) -> Lane<L>;
}

/// A bundle of L bodies with the kernels that concern each body alone.
///
/// Features, rows and loads are the same for all kinds of bundles: vectors of three components. In a plane these are
/// components along two directions in the plane and along its normal; the last never changes.
pub trait Bodies<const L: usize>: Measures<L> + Clone + Debug + Sized {
    /// Right-hand sides of the rigid-body rows.
    type Rigid: Copy;
    /// Moments about the centres of mass.
    type Moment: Copy + Debug;
    /// Director forces less the directors' inertia: what moments are made of.
    type Directors: Copy + Debug;
    /// C⁻¹ s̃ of a feature's arm s.
    type Mobility: Copy + Debug;
    /// Zero.
    const ZERO: Self::Natural;
    /// Zero.
    const NO_DIRECTORS: Self::Directors;
    /// Zero.
    const NO_MOBILITY: Self::Mobility;
    /// Zero.
    const NO_MOMENT: Self::Moment;
    /// Directions in which a point can move.
    const DIRECTIONS: usize;
    /// Components of a twist.
    const TWIST: usize;
    /// Strips of four numbers in a block of S for points.
    const STRIPS: usize;

    /// Bodies of mass 1 and no inertia, to be filled in lane by lane.
    fn empty(bodies: Range<usize>, slots: Range<usize>) -> Self;
    /// Takes over the constants of a body.
    fn set_body(&mut self, lane: usize, system: &System, body: &RigidBody);
    /// The bodies; fewer than L in the last bundle, whose other lanes hold bodies at rest without joints.
    fn bodies(&self) -> Range<usize>;
    /// Their features.
    fn slots(&self) -> Range<usize>;

    /// Bodies at rest.
    fn at_rest() -> Self::Natural;
    /// All components.
    fn lanes(x: &Self::Natural) -> &[Lane<L>];
    /// All components.
    fn lanes_mut(x: &mut Self::Natural) -> &mut [Lane<L>];
    /// Their numbers, four at a time: all kinds of bodies have a multiple of that.
    #[inline(always)]
    fn fours(x: &Self::Natural) -> &[Lane<4>] {
        Self::lanes(x).as_flattened().as_chunks().0
    }
    /// The same.
    #[inline(always)]
    fn fours_mut(x: &mut Self::Natural) -> &mut [Lane<4>] {
        Self::lanes_mut(x).as_flattened_mut().as_chunks_mut().0
    }

    /// Takes over the position or velocity of a body.
    fn read(&self, lane: usize, lift: &NaturalCoordinates, out: &mut Self::Natural);
    /// Position (`rate` false), velocity or acceleration of a body.
    fn write(&self, lane: usize, x: &Self::Natural, rate: bool) -> NaturalCoordinates;

    /// Value of a feature of the bodies at x, without what never changes.
    fn value(slot: &FeatureSlot<L>, x: &Self::Natural) -> LaneVector<L>;
    /// Adds to the value of a feature what never changes.
    fn add_constant(&self, slot: &FeatureSlot<L>, value: &mut LaneVector<L>);
    /// Adds the generalized force of a force on a feature.
    fn pull_back(slot: &FeatureSlot<L>, f: &LaneVector<L>, sum: &mut Self::Natural);

    /// Coefficient of a vector with the given local coordinates that the bodies' coefficient q of an order makes.
    fn arm(local: &Vector3<f64>, q: &Self::Natural, lane: usize, order: usize) -> Vector3<f64>;
    /// The part of the centre of mass.
    fn center(q: &Self::Natural, lane: usize) -> Vector3<f64>;
    /// ½ Σ e_k × f_k: ω for e = Q and f = Q̇ — eq. (6.4).
    fn spin(e: &Self::Natural, f: &Self::Natural, lane: usize) -> Vector3<f64>;
    /// Adds a force at a point of a body.
    fn add_force(&mut self, lane: usize, at: &Vector3<f64>, force: &Vector3<f64>);
    /// Adds a force on a vector of a body.
    fn add_director_force(&mut self, lane: usize, at: &Vector3<f64>, force: &Vector3<f64>);
    /// Adds a moment on a body.
    fn add_moment(&mut self, lane: usize, moment: &Vector3<f64>);

    /// Dual basis and inertia at the position q.
    fn linearize(&mut self, q: &Self::Natural);
    /// C⁻¹ s̃ of a feature's arm s.
    fn half_mobility(&self, slot: &FeatureSlot<L>, q: &Self::Natural) -> Self::Mobility;
    /// Adds to a row of H its part of the translation: the gradient g with respect to a feature times ±1/√m, or 0 for
    /// vectors.
    fn add_translation(g: &[f64; 3], factor: f64, row: &mut [f64]);
    /// Writes the part of the rotation of the rows along all directions.
    fn set_unit_rotations(mobility: &Self::Mobility, lane: usize, sign: f64, block: &mut [f64]);
    /// Adds to a row of H its part of the rotation, sign · gᵀ s̃ᵀ C⁻ᵀ.
    fn add_rotation(mobility: &Self::Mobility, lane: usize, g: &[f64; 3], sign: f64, row: &mut [f64]);

    /// s̃_aᵀ I⁻¹ s̃_b of two features, in strips of four numbers as they stand in a block of S.
    fn pair(a: &Self::Mobility, b: &Self::Mobility) -> [[Lane<L>; 4]; 3];

    /// Forgets the force at hand.
    fn clear_force(&mut self);
    /// Adds the weight.
    fn add_weight(&mut self);
    /// The generalized force at hand.
    fn force_mut(&mut self) -> &mut Self::Natural;
    /// Solution without the joints' forces, for right-hand sides Γ of the rigid-body rows and a known moment.
    fn begin<S: Simd>(&mut self, simd: S, q: &Self::Natural, gamma: &Self::Rigid, moment: Self::Moment);
    /// Adds what further generalized forces do.
    fn apply<S: Simd>(&mut self, simd: S, q: &Self::Natural, force: &Self::Natural);
    /// Moment that a generalized force has about the centres of mass.
    fn moment_of<S: Simd>(simd: S, q: &Self::Natural, force: &Self::Natural) -> Self::Moment;
    /// Adds what a moment makes of the unknown.
    fn turn<S: Simd>(&mut self, simd: S, q: &Self::Natural, moment: Self::Moment);
    /// Adds a rotation ω̇ to the unknown.
    fn rotate<S: Simd>(&mut self, simd: S, q: &Self::Natural, omega: Self::Moment);
    /// Forgets the solution, and the force that it is of.
    fn rest(&mut self);
    /// Takes `own` times its solution, with its force, and `factor` times another one.
    fn scale_and_add(&mut self, own: f64, other: &Self, factor: f64);
    /// The squares of what the moments of the solution are made of: Σ |P_k|² + |Ī_k ë_k|².
    fn moments_squared(&self) -> Lane<L>;
    /// δ of each body: its regularizing inertia.
    fn delta(&self) -> &Lane<L>;
    /// ω̇ of the solution.
    fn omega(&self) -> &Self::Moment;
    /// All components.
    fn moment_lanes(moment: &Self::Moment) -> &[Lane<L>];
    /// All components.
    fn moment_lanes_mut(moment: &mut Self::Moment) -> &mut [Lane<L>];
    /// The part of a generalized force that acts on directors.
    fn directors(force: &Self::Natural) -> Self::Directors;
    /// The coefficient n of a vector that has no component along any director in any order, from those before it, `turns`.
    fn carried_on(q: &[Self::Natural], turns: &[Self::Moment]) -> Self::Moment;
    /// The solution.
    fn solution(&self) -> &Self::Natural;
    /// p_k = P_k − Ī_k ë_k of the solution.
    fn director_forces<S: Simd>(&self, simd: S) -> Self::Directors;

    /// κ times −Σ e_k(i) · e_l(n−i) over 0 < i < n for the rigid-body rows, from the series q.
    fn gram<S: Simd>(simd: S, q: &[Self::Natural], n: usize, kappa: f64) -> Self::Rigid;
    /// Σ_k Σ e_k(i) × p_k(n−i) over 0 < i ≤ n: the part of the moment that lower orders make.
    fn moment<S: Simd>(simd: S, q: &[Self::Natural], p: &[Self::Directors], n: usize) -> Self::Moment;
    /// Σ of ½ Σ_k e_k(i) × ë_k(n−i) over 0 < i ≤ n: the part of ω̇ that lower orders make.
    fn known_turn(q: &[Self::Natural], n: usize) -> Self::Moment;
    /// Q_(n+2) of bodies on which nothing acts but their weight, from the coefficients before it, if it is known.
    #[inline(always)]
    fn alone<S: Simd>(&mut self, _: S, _q: &[Self::Natural], _n: usize) -> Option<Self::Natural> {
        None
    }
    /// Right-hand sides that correct positions.
    fn position_correction(&self, q: &Self::Natural) -> Self::Rigid;
    /// Right-hand sides that correct velocities.
    fn velocity_correction(&self, q: &Self::Natural, q_dot: &Self::Natural) -> Self::Rigid;
}

/// x ← own x + factor y.
#[inline(always)]
pub fn scale_and_add<const L: usize>(x: &mut [Lane<L>], own: f64, y: &[Lane<L>], factor: f64) {
    for (x, y) in x.as_flattened_mut().iter_mut().zip(y.as_flattened()) {
        *x = fma(factor, *y, own * *x);
    }
}
