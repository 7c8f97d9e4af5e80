//! Power series of the constrained motion — THEORY section 11.
//!
//! With Q(t) = Σ Q_k τᵏ and λ(t) = Σ λ_k τᵏ, the unknowns κ Q_(n+2), κ = (n+1)(n+2), and λ_n of every order n solve the
//! same augmented system at the point of expansion: one factorization serves all orders, and what changes from order
//! to order are convolutions of directors, row factors and multipliers. The rigid-body rows are eliminated as in
//! [`crate::dynamics::elimination`]: body by body the moments Σ e_k × p_k, p_k = P_k − Ī_k ë_k, must vanish, so that no
//! multiplier of a rigid-body row is ever formed. Order 0 is an evaluation of the accelerations.
//!
//! Bodies lie side by side in bundles of L, so that the convolutions run on vector instructions.

mod acting;
mod angles;
mod bodies;
mod bundle;
mod convolution;
mod island;
mod lanes;
mod layout;
mod loads;
mod planar;
mod prescribed;
mod projection;
mod recurrence;
mod rows;
mod schur;
mod scout;
mod slot;
mod step;

pub use island::IslandSeries;
pub use step::{Plan, Taken};

use bodies::Bodies;
use bundle::Bundle;
use planar::Planar;

use crate::dynamics::elimination::Counters;
use crate::model::BodyRef;
use crate::system::System;
use angles::Angles;
use lanes::{Triple, largest, times};
use layout::bundles;
use loads::Loads;
use prescribed::Prescribed;
use pulp::{Simd, WithSimd};
use rows::{Place, Rows};
use schur::Schur;
use slot::Slot;

/// Regularization of S where rows are redundant, relative to its diagonal; refinement takes its effect out again.
///
/// Rounding in the dependent rows grows with its inverse and from order to order: with 1e-11 a run through singular
/// positions goes wrong at tolerances below 1e-10.
const REGULARIZATION: f64 = 1e-9;
/// A relative pivot below this calls for the regularization.
const NEAR_SINGULAR: f64 = 1e-9;
/// Refinement steps where the factor is that of a regularized system, and where inertia was added.
const REFINEMENTS: usize = 2;
const REFINEMENTS_INERTIA: usize = 3;
/// A correction of this part of the multipliers is none.
const ROUNDING: f64 = 1e-15;
/// The least tolerance that redundant rows admit: below it, their rounding would be taken for motion.
pub const LEAST_TOLERANCE_REDUNDANT: f64 = 1e-11;

/// What becomes of rows that depend on others at every state.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Dependent {
    /// There are none.
    None,
    /// They are left out.
    LeftOut,
    /// Which they are is not found out yet: S is regularized.
    Shifted,
}

/// The series of all bodies and multipliers, and the state that they are expanded about.
#[derive(Clone, Debug)]
struct Series<const L: usize, B: Bodies<L> = Bundle<L>> {
    /// Coefficients kept for each body: order plus one.
    stride: usize,
    bundles: Vec<B>,
    slots: Vec<Slot<L>>,
    /// Position and velocity at the point of expansion, bundle by bundle.
    state: Vec<[B::Lifted; 2]>,
    /// Coefficients of Q and of the directors' forces p, `stride` for each bundle.
    q: Vec<B::Lifted>,
    p: Vec<B::Directors>,
    /// C⁻¹ s̃ of all features.
    mobility: Vec<B::Mobility>,
    /// Values of features (or their rates, or second derivatives) and generalized forces on them. Those of the ground
    /// stand behind those of bodies.
    values: Vec<Triple<L>>,
    forces: Vec<Triple<L>>,
    ground: Vec<Triple<L>>,
    rows: Rows<L>,
    angles: Angles,
    prescribed: Prescribed,
    loads: Loads,
    /// Time of the state, and of the next break in a prescribed function, s.
    time: f64,
    next_break: f64,
    /// Coefficients of the power of drivers and of loads without potential, if there are any.
    power: Vec<f64>,
    schur: Schur,
    /// Coefficients of λ, order by order.
    lambda: Vec<f64>,
    correction: Vec<f64>,
    dependent: Dependent,
    regularized: bool,
    regularizes_inertia: bool,
    /// Work done so far.
    pub counters: Counters,
    /// Where S is looked at elsewhere without touching the factor at hand.
    scout: Option<Box<Self>>,
}

impl<const L: usize> Series<L> {
    /// Allocates for motion in space, and coefficients up to order `order`; `turns` are the angles of joints at the
    /// start.
    pub fn new(system: &System, order: usize, redundant: bool, turns: &[f64]) -> Self {
        Self::of(system, order, redundant, turns)
    }
}

impl<const L: usize> Series<L, Planar<L>> {
    /// The same for motion in a plane, of a system that has been reduced to it.
    pub fn planar(system: &System, order: usize, redundant: bool, turns: &[f64]) -> Self {
        Self::of(system, order, redundant, turns)
    }
}

impl<const L: usize, B: Bodies<L>> Series<L, B> {
    fn of(system: &System, order: usize, redundant: bool, turns: &[f64]) -> Self {
        let (bundles, mut slots, mut place) = bundles::<L, B>(system);
        let moving = slots.len();
        let mut ground = Vec::new();
        for (feature, place) in system.features.iter().zip(&mut place) {
            if feature.body == BodyRef::Ground {
                *place = Place { slot: moving + ground.len(), lane: 0 };
                ground.push([0, 1, 2].map(|c| [feature.local[c]; L]));
            }
        }
        let nowhere = Place { slot: moving + ground.len(), lane: 0 };
        ground.push([[0.0; L]; 3]);
        let stride = order + 1;
        let all = moving + ground.len();
        slots.shrink_to_fit();
        let rows = Rows::new(system, &place, nowhere, stride);
        let angles = Angles::new(system, &place, stride, turns);
        let prescribed = Prescribed::new(system, &place, L, stride);
        let loads = Loads::new(system, &place, L, stride);
        let exchanges = !system.is_conservative();
        Self {
            time: 0.0,
            next_break: f64::INFINITY,
            power: vec![0.0; if exchanges { stride } else { 0 }],
            angles,
            prescribed,
            loads,
            stride,
            state: vec![[B::at_rest(), B::zero()]; bundles.len()],
            q: vec![B::zero(); bundles.len() * stride],
            p: vec![B::no_directors(); bundles.len() * stride],
            mobility: vec![B::no_mobility(); moving],
            bundles,
            slots,
            values: vec![[[0.0; L]; 3]; all],
            forces: vec![[[0.0; L]; 3]; all],
            ground,
            rows,
            schur: Schur::new(system, &place, L, B::TWIST),
            lambda: vec![0.0; system.solver_rows * stride],
            correction: vec![0.0; system.solver_rows],
            dependent: if redundant { Dependent::Shifted } else { Dependent::None },
            regularized: false,
            regularizes_inertia: system.regularizes_inertia(),
            counters: Counters::default(),
            scout: None,
        }
    }

    /// Whether entries of the matrix that never change are written once.
    pub fn keep_constants(&mut self, keep: bool) {
        self.schur.keep_constants = keep;
    }

    /// Entries of the matrix that were not written again.
    pub fn constants_kept(&self) -> u64 {
        self.schur.constants_kept
    }

    /// Builds and factors S at the point of expansion.
    #[inline(always)]
    fn linearize_here<S: Simd>(&mut self, simd: S) {
        self.set_up();
        self.regularized = self.dependent == Dependent::Shifted;
        loop {
            self.schur.assemble::<S, L, B>(simd, &self.rows, &self.angles, &self.mobility);
            let epsilon = if self.regularized { REGULARIZATION } else { 0.0 };
            let smallest = self.schur.factor.factor(epsilon, 0.0);
            self.counters.factorizations += 1;
            if self.regularized || smallest >= NEAR_SINGULAR {
                return;
            }
            self.regularized = true;
        }
    }

    #[inline(always)]
    fn assemble_here<S: Simd>(&mut self, simd: S) {
        self.set_up();
        self.schur.assemble::<S, L, B>(simd, &self.rows, &self.angles, &self.mobility);
    }

    /// Values of features, inertia and mobilities at the point of expansion.
    #[inline(always)]
    fn set_up(&mut self) {
        self.place_values();
        self.rows.turn_common_vectors(&self.values);
        self.rows.store_factors(0, &self.values);
        self.angles.place(&self.values);
        for (bundle, state) in self.bundles.iter_mut().zip(&self.state) {
            bundle.linearize(&state[0]);
            for slot in bundle.slots() {
                self.mobility[slot] = bundle.half_mobility(&self.slots[slot], &state[0]);
            }
        }
    }

    #[inline(always)]
    fn values_of(&mut self, lifted: impl Fn(&[B::Lifted; 2], &B) -> B::Lifted) {
        for (bundle, state) in self.bundles.iter().zip(&self.state) {
            let x = lifted(state, bundle);
            for slot in bundle.slots() {
                self.values[slot] = B::value(&self.slots[slot], &x);
            }
        }
    }

    /// Values of all features at the state.
    #[inline(always)]
    fn place_values(&mut self) {
        self.values_of(|state, _| state[0]);
        self.set_ground(true);
        for bundle in &self.bundles {
            for slot in bundle.slots() {
                bundle.add_constant(&self.slots[slot], &mut self.values[slot]);
            }
        }
    }

    /// Values of the ground's features: themselves, or zero as all their derivatives.
    #[inline(always)]
    fn set_ground(&mut self, themselves: bool) {
        let first = self.values.len() - self.ground.len();
        for (value, ground) in self.values[first..].iter_mut().zip(&self.ground) {
            *value = if themselves { *ground } else { [[0.0; L]; 3] };
        }
    }

    /// Expands the motion about the state up to Q_order and λ_(order−2), with the factor at hand, or up to the first
    /// order that is `enough`. Returns the order.
    #[inline(always)]
    pub fn expand(&mut self, order: usize, enough: impl Fn(&Self, usize) -> bool) -> usize {
        for (b, state) in self.state.iter().enumerate() {
            self.q[b * self.stride..b * self.stride + 2].copy_from_slice(state);
        }
        if self.watches() {
            self.place_values();
            self.store_values(0);
            self.values_of(|state, _| state[1]);
            self.set_ground(false);
            self.prepare_prescribed(1, 1.0);
            self.prescribed.add_known(1.0, &mut self.values);
            self.store_values(1);
        }
        self.rows.clear_extra();
        self.rows.keep_directions();
        self.counters.evaluations += 1;
        let order = order.min(self.stride - 1);
        for n in 0..=order.saturating_sub(2) {
            self.solve_order(n);
            if enough(self, n + 2) {
                return n + 2;
            }
        }
        order
    }

    /// Q_(n+2) and λ_n from all coefficients before them — eq. (11.2).
    #[inline(always)]
    fn solve_order(&mut self, n: usize) {
        let kappa = ((n + 1) * (n + 2)) as f64;
        let over_kappa = 1.0 / kappa;
        for bundle in &mut self.bundles {
            bundle.clear_force();
            if n == 0 {
                bundle.add_weight();
            }
        }
        if self.watches() {
            self.demand(n, kappa);
            self.set_known_forces(n);
        }
        for (b, bundle) in self.bundles.iter_mut().enumerate() {
            let range = b * self.stride..(b + 1) * self.stride;
            let (q, p) = (&self.q[range.clone()], &self.p[range]);
            bundle.begin(&q[0], &B::gram(q, n + 2, kappa), B::moment(q, p, n));
        }
        self.prepare_prescribed(n + 2, kappa);
        self.solve(n);
        for (b, bundle) in self.bundles.iter().enumerate() {
            let at = b * self.stride + n;
            let next = B::lanes_mut(&mut self.q[at + 2]);
            for (q, a) in next.iter_mut().zip(B::lanes(bundle.solution())) {
                *q = times(a, &[over_kappa; L]);
            }
            self.p[at] = bundle.director_forces();
        }
        if self.watches() {
            let rows = self.correction.len();
            let lambda = &self.lambda[n * rows..(n + 1) * rows];
            self.rows.store_multipliers(n, lambda);
            self.angles.store_multipliers(n, lambda);
            for (b, bundle) in self.bundles.iter().enumerate() {
                for slot in bundle.slots() {
                    self.values[slot] = B::value(&self.slots[slot], &self.q[b * self.stride + n + 2]);
                }
            }
            self.prescribed.add_known(over_kappa, &mut self.values);
            self.store_values(n + 2);
        }
    }

    /// Whether values of features are needed in every order.
    #[inline(always)]
    fn watches(&self) -> bool {
        self.rows.curved() || !self.angles.is_empty() || !self.loads.is_empty() || !self.prescribed.is_empty()
    }

    /// Takes over coefficient m of all features.
    #[inline(always)]
    fn store_values(&mut self, m: usize) {
        self.rows.store_factors(m, &self.values);
        self.angles.store(m, &self.values);
        self.loads.store(m, &self.values, &self.angles.list);
    }

    /// Adds the joints' forces to the solutions that bodies have without them; λ goes to order n.
    #[inline(always)]
    fn solve(&mut self, n: usize) {
        let rows = self.correction.len();
        let refinements = match (self.regularizes_inertia, self.regularized) {
            (true, _) => REFINEMENTS_INERTIA,
            (false, true) => REFINEMENTS,
            (false, false) => 0,
        };
        if rows == 0 && !self.regularizes_inertia {
            return;
        }
        self.set_ground(false);
        let (mut first, mut last) = (0.0, f64::INFINITY);
        for pass in 0..=refinements {
            if pass > 0 && self.regularizes_inertia {
                for (bundle, state) in self.bundles.iter_mut().zip(&self.state) {
                    bundle.remove_regularization(&state[0]);
                }
            }
            self.values_of(|_, bundle| *bundle.solution());
            self.prescribed.add_known(1.0, &mut self.values);
            self.rows.residual(B::DIRECTIONS, &self.values, &mut self.correction);
            self.angles.residual(&self.values, &self.rows.extra, &mut self.correction);
            self.schur.factor.solve(&mut self.correction);
            self.counters.solves += 1;
            let lambda = &mut self.lambda[n * rows..(n + 1) * rows];
            for (lambda, correction) in lambda.iter_mut().zip(&self.correction) {
                *lambda = if pass == 0 { *correction } else { *lambda + correction };
            }
            self.forces.fill([[0.0; L]; 3]);
            self.rows.add_forces(B::DIRECTIONS, &self.correction, &mut self.forces);
            self.angles.add_forces(&self.correction, &mut self.forces);
            self.prescribed.add_forces(n, &self.forces);
            for (bundle, state) in self.bundles.iter_mut().zip(&self.state) {
                let mut force = B::zero();
                for slot in bundle.slots() {
                    B::pull_back(&self.slots[slot], &self.forces[slot], &mut force);
                }
                bundle.apply(&state[0], &force);
            }
            if self.regularizes_inertia && !self.regularized {
                // Corrections shrink by the same factor each time: the next one would be size²/last.
                let size = self.correction.iter().fold(0.0f64, |most, x| most.max(x.abs()));
                if pass == 0 {
                    first = size;
                } else if size * size <= ROUNDING * first * last {
                    break;
                }
                last = size;
            }
        }
    }

    /// Largest |Q_k| over all bodies.
    #[inline(always)]
    pub fn size_of(&self, k: usize) -> f64 {
        (0..self.bundles.len()).map(|b| largest(B::lanes(&self.q[b * self.stride + k]))).fold(0.0, f64::max)
    }

    /// Moves the point of expansion to the series' value after h, with terms up to order `order`.
    #[inline(always)]
    pub fn advance(&mut self, h: f64, order: usize) {
        self.angles.advance(h, order);
        for (b, state) in self.state.iter_mut().enumerate() {
            *state = horner::<L, B>(&self.q[b * self.stride..=b * self.stride + order], h);
        }
    }

    /// Whether the state is made of finite numbers.
    #[inline(always)]
    pub fn is_finite(&self) -> bool {
        let numbers = self.state.as_flattened().iter().flat_map(|x| B::lanes(x).as_flattened());
        // Zero times infinity or NaN is NaN.
        numbers.fold(0.0, |sum, x| sum + 0.0 * x) == 0.0
    }
}

/// Value and derivative of a polynomial Σ Q_k τᵏ — eq. (11.1).
#[inline(always)]
fn horner<const L: usize, B: Bodies<L>>(coefficients: &[B::Lifted], tau: f64) -> [B::Lifted; 2] {
    let mut state = [B::zero(); 2];
    let [value, rate] = &mut state;
    let (value, rate) = (B::lanes_mut(value), B::lanes_mut(rate));
    for coefficient in coefficients.iter().rev() {
        for ((value, rate), c) in value.iter_mut().zip(rate.iter_mut()).zip(B::lanes(coefficient)) {
            for l in 0..L {
                rate[l] = rate[l].mul_add(tau, value[l]);
                value[l] = value[l].mul_add(tau, c[l]);
            }
        }
    }
    state
}

/// The same on its own, to be compiled for each set of vector instructions.
struct Value<'a, const L: usize, B: Bodies<L>> {
    coefficients: &'a [B::Lifted],
    tau: f64,
}

impl<const L: usize, B: Bodies<L>> WithSimd for Value<'_, L, B> {
    type Output = [B::Lifted; 2];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> [B::Lifted; 2] {
        horner::<L, B>(self.coefficients, self.tau)
    }
}
