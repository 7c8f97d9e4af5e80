//! Power series of the constrained motion — THEORY section 11.
//!
//! With Q(t) = Σ Q_k τᵏ and λ(t) = Σ λ_k τᵏ, the unknowns κ Q_(n+2), κ = (n+1)(n+2), and λ_n of every order n solve the
//! same augmented system at the point of expansion: one factorization serves all orders, and what changes from order
//! to order are convolutions of directors, row factors and multipliers. The rigid-body rows are eliminated as in
//! [`crate::dynamics::elimination`]: body by body the moments Σ e_k × p_k, p_k = P_k − Ī_k ë_k, must vanish, so that no
//! multiplier of a rigid-body row is ever formed. Order 0 is an evaluation of the accelerations.
//!
//! Bodies lie side by side in bundles of L, so that the convolutions run on vector instructions.

mod lanes;

mod recurrence;

mod bodies;

mod constraints;

mod loads;

mod layout;

mod acting;

mod answer;

mod regularization;

mod expand;

mod work;

mod projection;

mod transport;

mod step;

mod instants;

mod probe;

mod island;

pub use island::IslandSeries;
pub use step::{SeriesStep, StepPlan};

use crate::dynamics::elimination::{Counters, REGULARIZATION};
use crate::dynamics::pivots::Pivots;
use crate::model::BodyRef;
use crate::system::System;
use bodies::{Bodies, Bundle, FeatureSlot, LanePlace, Planar, Single};
use constraints::{Angles, JointPoints, NOWHERE, Prescribed, Rows, Schur};
use lanes::LaneVector;
use layout::bundles;
use loads::Loads;
use pulp::{Arch, Simd};
use regularization::InertiaRegularization;
use work::WorkBetween;

/// The smallest tolerance that redundant rows admit: below it, their rounding would be taken for motion.
pub const MIN_TOLERANCE_REDUNDANT: f64 = 1e-11;

/// The series of all bodies and multipliers, and the state that they are expanded about.
#[derive(Clone, Debug)]
#[allow(clippy::struct_excessive_bools, reason = "independent properties of the factorization")]
struct Series<const L: usize, B: Bodies<L> = Bundle<L>> {
    /// Coefficients kept for each body: order plus one.
    stride: usize,
    bundles: Vec<B>,
    slots: Vec<FeatureSlot<L>>,
    /// Position and velocity at the point of expansion, bundle by bundle.
    state: Vec<[B::Natural; 2]>,
    /// Largest |Q_k| over all bodies, order by order.
    sizes: Vec<f64>,
    /// Coefficients of Q, `stride` for each bundle.
    q: Vec<B::Natural>,
    /// Coefficients of the directors' forces p, likewise.
    p: Vec<B::Directors>,
    /// C⁻¹ s̃ of all features.
    mobility: Vec<B::Mobility>,
    /// Values of features (or their rates, or second derivatives), those of the ground behind those of bodies.
    values: Vec<LaneVector<L>>,
    /// Generalized forces on features, in the same order.
    forces: Vec<LaneVector<L>>,
    /// Constant values of the ground's features.
    ground: Vec<LaneVector<L>>,
    points: JointPoints<L>,
    rows: Rows<L>,
    angles: Angles,
    prescribed: Prescribed,
    loads: Loads,
    /// Whether rows, angles, loads or what is prescribed ask for values of features in every order.
    needs_values: bool,
    /// What the kernels are compiled for.
    instructions: Arch,
    /// Time of the state, s.
    time: f64,
    /// Time of the next breakpoint of a prescribed function, s.
    next_break: f64,
    /// Coefficients of the power of drivers and of loads without potential, if there are any.
    power: Vec<f64>,
    /// The work of the last step where they do not reach its end.
    work_between: WorkBetween,
    /// A copy that evaluates it within steps.
    meter: Option<Box<Self>>,
    schur: Schur,
    /// Coefficients of λ, order by order; in each, solver rows stand where the factor has them.
    lambda: Vec<f64>,
    correction: Vec<f64>,
    /// Whether rows that depend on others at every state are left out.
    rows_left_out: bool,
    /// Whether S is known to be singular: always regularized.
    redundant: bool,
    /// Whether the current factor is that of a regularized S.
    regularized: bool,
    /// Those of the current factor.
    pivots: Pivots,
    /// Whether rows that hardly hold are kept.
    resolving: bool,
    /// Whether solutions are only corrections of a state, of which the next one takes out what rounding has left: they are not refined.
    corrects_only: bool,
    expansion: Expansion,
    /// Whether the factor is that of the state, up to the last correction.
    factor_is_here: bool,
    /// What takes δ out again, where bodies need it.
    regularization: Option<Box<InertiaRegularization<L, B>>>,
    /// Work done so far.
    pub counters: Counters,
    /// A copy that evaluates S at other times, and leaves the factor as it is.
    probe: Option<Box<Self>>,
    /// S at several times at once, where that is possible.
    instants: Option<Box<instants::Instants<L, B>>>,
    /// The error that is carried along.
    transport: Option<Box<transport::Transport<L, B>>>,
    /// What Φ of each solver row is measured in, where the factor has its rows.
    row_sizes: Vec<f64>,
}

/// How the motion was expanded last.
#[derive(Clone, Copy, Debug, Default)]
struct Expansion {
    /// Up to which order.
    order: usize,
    /// Whether rows that hardly hold were kept.
    resolving: bool,
    /// Where the step was taken back: whether its series still hold. S is not factored at the state then.
    back: Option<bool>,
}

impl<const L: usize> Series<L> {
    /// Allocates for motion in space, and coefficients up to order `order`; `turns` are the angles of joints at the
    /// start.
    pub fn new(system: &System, order: usize, turns: &[f64]) -> Self {
        Self::of(system, order, turns)
    }
}

impl Series<1, Single> {
    /// The same for one body.
    pub fn single(system: &System, order: usize, turns: &[f64]) -> Self {
        Self::of(system, order, turns)
    }
}

impl<const L: usize> Series<L, Planar<L>> {
    /// The same for motion in a plane, of a system that has been reduced to it.
    pub fn planar(system: &System, order: usize, turns: &[f64]) -> Self {
        Self::of(system, order, turns)
    }
}

impl<const L: usize, B: Bodies<L>> Series<L, B> {
    fn of(system: &System, order: usize, turns: &[f64]) -> Self {
        let (bundles, mut slots, mut place) = bundles::<L, B>(system);
        let moving = slots.len();
        let mut ground = place_ground(system, moving, &mut place);
        let nowhere = LanePlace { slot: moving + ground.len(), lane: 0 };
        ground.push([[0.0; L]; 3]);
        let (stride, all) = (order + 1, moving + ground.len());
        slots.shrink_to_fit();
        let schur = Schur::new(system, &place, L, B::TWIST);
        let points = JointPoints::new(system, &bundles, &slots, &place, &schur.factor, stride);
        let rows = Rows::new(system, &place, nowhere, &schur.factor, stride);
        let angles = Angles::new(system, &place, &schur.factor, stride, turns);
        let prescribed = Prescribed::new(system, &place, &schur.factor, L, stride);
        let loads = Loads::new(system, &place, L, stride);
        let regularization = system.regularizes_inertia().then(|| {
            Box::new(InertiaRegularization::new(&bundles, stride, schur.factor.numbers() + NOWHERE))
        });
        let needs_values = rows.curved() || !angles.is_empty() || !loads.is_empty() || !prescribed.is_empty();
        Self {
            instructions: Arch::new(),
            time: 0.0,
            next_break: f64::INFINITY,
            power: vec![0.0; if system.is_conservative() { 0 } else { stride }],
            work_between: WorkBetween::default(),
            meter: None,
            angles,
            prescribed,
            loads,
            needs_values,
            stride,
            state: vec![[B::at_rest(), B::ZERO]; bundles.len()],
            sizes: vec![0.0; stride],
            q: vec![B::ZERO; bundles.len() * stride],
            p: vec![B::NO_DIRECTORS; bundles.len() * stride],
            mobility: vec![B::NO_MOBILITY; moving],
            bundles,
            slots,
            values: vec![[[0.0; L]; 3]; all],
            forces: vec![[[0.0; L]; 3]; all],
            ground,
            points,
            rows,
            lambda: vec![0.0; (schur.factor.numbers() + NOWHERE) * stride],
            correction: vec![0.0; schur.factor.numbers() + NOWHERE],
            row_sizes: place_sizes(system, &schur),
            schur,
            rows_left_out: false,
            redundant: false,
            regularized: false,
            resolving: false,
            corrects_only: false,
            expansion: Expansion::default(),
            factor_is_here: false,
            pivots: Pivots::new(system),
            regularization,
            counters: Counters::default(),
            probe: None,
            instants: None,
            transport: None,
        }
    }

    /// From now on uses such instructions, and not what the processor has; before it carries errors or evaluates inside steps.
    pub fn restrict(&mut self, instructions: Arch) {
        self.instructions = instructions;
    }

    /// Whether entries of the matrix that never change are written once.
    pub fn keep_constants(&mut self, keep: bool) {
        self.schur.keep_constants = keep;
    }

    /// Entries of the matrix that were not written again.
    pub fn constants_kept(&self) -> u64 {
        self.schur.constants_kept
    }

    /// Builds and factors S at the point of expansion, regularized where it is nearly singular, or always.
    #[inline(always)]
    fn linearize_here<S: Simd>(&mut self, simd: S) {
        self.set_up();
        self.regularized = self.redundant;
        loop {
            self.schur.assemble::<S, L, B>(simd, &self.rows, &self.angles, &self.mobility);
            let epsilon = if self.regularized { REGULARIZATION } else { 0.0 };
            let smallest = self.schur.factor.factor(epsilon, 0.0);
            self.counters.factorizations += 1;
            if !self.pivots.are_lost(smallest, self.resolving) || self.regularized {
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
        if self.is_bare() {
            for (bundle, state) in self.bundles.iter_mut().zip(&self.state) {
                bundle.linearize(&state[0]);
            }
            return;
        }
        // Common points make the same of S whatever their values are.
        if self.needs_values || self.points.has_others() || self.points.has_vectors() {
            self.place_values();
            self.rows.turn_common_vectors(&self.values);
            self.rows.store_factors(0, &self.values);
            self.angles.place(&self.values);
        }
        for (bundle, state) in self.bundles.iter_mut().zip(&self.state) {
            bundle.linearize(&state[0]);
            for slot in bundle.slots() {
                self.mobility[slot] = bundle.half_mobility(&self.slots[slot], &state[0]);
            }
        }
    }

    #[inline(always)]
    fn values_of(&mut self, natural: impl Fn(&[B::Natural; 2], &B) -> B::Natural) {
        for (bundle, state) in self.bundles.iter().zip(&self.state) {
            let x = natural(state, bundle);
            for slot in bundle.slots() {
                self.values[slot] = B::value(&self.slots[slot], &x);
            }
        }
    }

    /// Takes over the factors of rows at the state, from the features' values in place: before anything is solved for.
    #[inline(always)]
    fn take_factors(&mut self) {
        self.rows.store_factors(0, &self.values);
        self.points.take_factors(self.rows.numbers(), &self.rows.commons);
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

    /// Whether the state is made of finite numbers.
    #[inline(always)]
    pub fn is_finite(&self) -> bool {
        let numbers = self.state.as_flattened().iter().flat_map(|x| B::lanes(x).as_flattened());
        // Zero times infinity or NaN is NaN.
        numbers.fold(0.0, |sum, x| sum + 0.0 * x) == 0.0
    }
}

/// What Φ of each solver row is measured in, where the factor has its rows.
fn place_sizes(system: &System, schur: &Schur) -> Vec<f64> {
    let mut sizes = vec![1.0; schur.factor.numbers()];
    for (size, &place) in system.row_sizes().iter().zip(schur.factor.places()) {
        sizes[place] = *size;
    }
    sizes
}

/// Values of the ground's features, which stand behind those of bodies.
fn place_ground<const L: usize>(
    system: &System,
    moving: usize,
    place: &mut [LanePlace],
) -> Vec<LaneVector<L>> {
    let mut ground = Vec::new();
    for (feature, place) in system.features.iter().zip(place) {
        if feature.body == BodyRef::Ground {
            *place = LanePlace { slot: moving + ground.len(), lane: 0 };
            ground.push([0, 1, 2].map(|c| [feature.local[c]; L]));
        }
    }
    ground
}
