//! Inertia δ that regularizes bodies without some about an axis, and how its effect is taken out of the series again — eq. (7.8).

mod residuals;

mod multipliers;

mod iteration;

use super::lanes::sum;
use super::{Bodies, Series};
use multipliers::SharedMultipliers;
use pulp::{Simd, WithSimd};

/// What is known of δ, bundle by bundle.
#[derive(Clone, Debug)]
pub(super) struct InertiaRegularization<const L: usize, B: Bodies<L>> {
    /// ω̇ for which its effect has been taken out, what is left of ω̇, and along what the first is changed next.
    returned: Vec<B::Moment>,
    residual: Vec<B::Moment>,
    direction: Vec<B::Moment>,
    /// The bodies with the solution found so far, and with what a step along the direction adds to it.
    found: Vec<B>,
    along: Vec<B>,
    /// What rows demand beyond the unknowns of a direction: nothing.
    nothing: Vec<f64>,
    /// Coefficients of ω̇ less τ/δ, where τ is what the multipliers μ do, as many for each bundle as of Q.
    turns: Vec<B::Moment>,
    /// Coefficients of the forces of μ on directors, likewise.
    forces: Vec<B::Directors>,
    /// The part of τ, and of those forces, that lower orders make of the order at hand.
    moment: Vec<B::Moment>,
    force: Vec<B::Natural>,
    /// The coefficient of μ of the order at hand.
    mu: SharedMultipliers,
}

impl<const L: usize, B: Bodies<L>> InertiaRegularization<L, B> {
    pub fn new(bundles: &[B], stride: usize, rows: usize) -> Self {
        let count = bundles.len();
        let moments = |count: usize| vec![B::NO_MOMENT; count];
        Self {
            returned: moments(count),
            residual: moments(count),
            direction: moments(count),
            found: bundles.to_vec(),
            along: bundles.to_vec(),
            nothing: vec![0.0; rows],
            turns: moments(count * stride),
            forces: vec![B::NO_DIRECTORS; count * stride],
            moment: moments(count),
            force: vec![B::ZERO; count],
            mu: SharedMultipliers::new(rows),
        }
    }

    /// Takes over the terms of order 0.
    pub fn recall(&mut self, other: &Self, stride: usize) {
        for b in 0..self.moment.len() {
            self.turns[b * stride] = other.turns[b * stride];
            self.forces[b * stride] = other.forces[b * stride];
        }
    }

    /// The iteration begins with nothing returned.
    pub fn begin(&mut self) {
        self.returned.fill(B::NO_MOMENT);
    }
}

impl<const L: usize, B: Bodies<L>> Series<L, B> {
    /// Finds the part of the moment τ of order n that lower orders make. The forces at hand of the bodies are used for that.
    #[inline(always)]
    fn prepare_shared<S: Simd>(
        &mut self,
        simd: S,
        regularization: &mut InertiaRegularization<L, B>,
        n: usize,
    ) {
        for bundle in &mut self.bundles {
            bundle.clear_force();
        }
        if self.needs_values {
            self.exchange_multipliers();
            self.forces.fill([[0.0; L]; 3]);
            self.add_multipliers_forces(simd, n);
            self.prescribed.pull_back(n, &self.forces, &mut self.bundles);
            self.pull_back_convolved();
            self.exchange_multipliers();
        }
        for (b, bundle) in self.bundles.iter_mut().enumerate() {
            let first = b * self.stride;
            let (q, force) = (&self.q[first..first + self.stride], *bundle.force_mut());
            let lower = B::moment(simd, q, &regularization.forces[first..first + self.stride], n);
            let mut moment = B::moment_of(simd, &q[0], &force);
            for (moment, lower) in B::moment_lanes_mut(&mut moment).iter_mut().zip(B::moment_lanes(&lower)) {
                for l in 0..L {
                    moment[l] += lower[l];
                }
            }
            (regularization.moment[b], regularization.force[b]) = (moment, force);
        }
    }

    /// Begins the iteration of order n with ω̇ for which bodies turn on about axes without inertia as they do, where nothing holds them —
    /// eq. (11.19).
    #[inline(always)]
    fn turn_on<S: Simd>(&mut self, simd: S, regularization: &mut InertiaRegularization<L, B>, n: usize) {
        for (b, bundle) in self.bundles.iter_mut().enumerate() {
            let first = b * self.stride;
            let q = &self.q[first..first + self.stride];
            let (known, delta) = (B::known_turn(q, n), *bundle.delta());
            let mut expected = B::carried_on(q, &regularization.turns[first..first + n]);
            regularization.turns[first + n] = known;
            let mut moment = B::NO_MOMENT;
            let moments =
                B::moment_lanes_mut(&mut moment).iter_mut().zip(B::moment_lanes(&regularization.moment[b]));
            let all = B::moment_lanes_mut(&mut expected).iter_mut().zip(B::moment_lanes(&known)).zip(moments);
            for ((expected, known), (moment, tau)) in all {
                for l in 0..L {
                    if delta[l] > 0.0 {
                        expected[l] += tau[l] / delta[l] - known[l];
                        moment[l] = delta[l] * expected[l];
                    }
                }
            }
            regularization.returned[b] = expected;
            bundle.turn(simd, &q[0], moment);
        }
    }

    /// Takes over what the iteration of order n has found.
    #[inline(always)]
    fn store_shared<S: Simd>(&mut self, simd: S, regularization: &mut InertiaRegularization<L, B>, n: usize) {
        let mu = &regularization.mu.value;
        if self.points.has_others() {
            self.set_multipliers_forces(mu);
        }
        self.exchange_multipliers();
        if self.points.has_others() {
            self.prescribed.add_forces(n, &self.forces);
        }
        self.rows.store_multipliers(n, mu);
        self.angles.store_multipliers(n, mu);
        self.exchange_multipliers();
        for (b, bundle) in self.bundles.iter().enumerate() {
            let at = b * self.stride + n;
            let mut force = self.multipliers_force(simd, b, mu);
            let of_mu = B::moment_of(simd, &self.state[b][0], &force);
            for (force, known) in B::lanes_mut(&mut force).iter_mut().zip(B::lanes(&regularization.force[b]))
            {
                *force = sum(force, known);
            }
            regularization.forces[at] = B::directors(&force);
            let delta = bundle.delta();
            let omega =
                B::moment_lanes(bundle.omega()).iter().zip(B::moment_lanes(&regularization.moment[b]));
            let turns =
                B::moment_lanes_mut(&mut regularization.turns[at]).iter_mut().zip(B::moment_lanes(&of_mu));
            for ((turn, of_mu), (omega, tau)) in turns.zip(omega) {
                for l in 0..L {
                    let tau = if delta[l] > 0.0 { (tau[l] + of_mu[l]) / delta[l] } else { 0.0 };
                    turn[l] += omega[l] - tau;
                }
            }
        }
    }

    #[inline(always)]
    fn exchange_multipliers(&mut self) {
        self.rows.exchange_multipliers();
        self.angles.exchange_multipliers();
        self.prescribed.exchange_multipliers();
    }
}

/// What concerns δ in an order, in turn.
#[derive(Clone, Copy, Debug)]
pub(super) enum Stage {
    /// See [`Series::prepare_shared`].
    Prepare,
    /// See [`Series::turn_on`].
    TurnOn,
    /// See [`Series::return_inertia`].
    Return,
    /// See [`Series::store_shared`].
    Store,
}

/// A stage on its own, to be compiled once for each set of vector instructions: most series have nothing of it.
pub(super) struct Regularizing<'a, const L: usize, B: Bodies<L>> {
    pub series: &'a mut Series<L, B>,
    pub regularization: &'a mut InertiaRegularization<L, B>,
    pub n: usize,
    pub stage: Stage,
}

impl<const L: usize, B: Bodies<L>> WithSimd for Regularizing<'_, L, B> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { series, regularization, n, stage } = self;
        match stage {
            Stage::Prepare => series.prepare_shared(simd, regularization, n),
            Stage::TurnOn => series.turn_on(simd, regularization, n),
            Stage::Return => series.return_inertia(simd, regularization, n),
            Stage::Store => series.store_shared(simd, regularization, n),
        }
    }
}
