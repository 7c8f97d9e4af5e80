//! Inertia that is lent to bodies which have none about some axis, and how its effect is taken out of the series again — eq. (7.8).

use super::answer::Answer;
use super::lanes::sum;
use super::{Bodies, Series};
use pulp::{Simd, WithSimd};
use triad_linalg::fma;

/// Most steps: in exact arithmetic there are as many as rotations without inertia that differ.
const MOST_STEPS: usize = 100;
/// Part of all that makes moments below which what is left of them is rounding.
const ROUNDING: f64 = 4e-15;
/// Part of what was left before that a step leaves at least where it has met nothing but rounding, which nothing holds.
const STALLED: f64 = 0.98;
/// Part of what is left, or of a direction, below which what inertia makes of it may be rounding, which is that of I_g beside δ: nothing holds the
/// bodies along it.
const HELD: f64 = 1e-6;
/// The same for what is left where the iteration ends.
const FREE: f64 = 1e-3;

/// The iteration by conjugate residuals: where nothing holds the bodies it stays where it began. Products and squares are sums of
/// δ a · b over the bodies.
#[derive(Clone, Copy, Debug)]
struct Residuals {
    steps: usize,
    left: f64,
    product: f64,
    /// Whether a step has left nearly as much as there was, and whether nothing holds the bodies in that.
    stalls: bool,
    free: bool,
}

impl Residuals {
    fn begin() -> Self {
        Self { steps: 0, left: f64::INFINITY, product: 0.0, stalls: false, free: false }
    }

    /// Whether it goes on, from the squares of what is left to return, and of what all that makes moments would make.
    fn go_on(&mut self, left: f64, scale: f64) -> bool {
        self.stalls = left >= STALLED * STALLED * self.left;
        self.left = left;
        self.steps += 1;
        self.free = false;
        // False for NaN as well.
        left > ROUNDING * ROUNDING * scale && self.steps <= MOST_STEPS
    }

    /// The part of the last direction that is added to what is left for the next one; `product` is that of what is left and of what the
    /// bodies' inertia makes of it. `None` where nothing holds the bodies, or only rounding is left of what does.
    fn part(&mut self, product: f64) -> Option<f64> {
        let part = if self.steps > 1 { product / self.product } else { 0.0 };
        self.product = product;
        self.free = product <= FREE * self.left;
        (product > HELD * self.left && !self.stalls).then_some(part)
    }

    /// How far to go along a direction, from its own square and that of what inertia makes of it. `None` where nothing holds the bodies.
    fn length(&self, square: f64, made: f64) -> Option<f64> {
        (made > HELD * HELD * square).then(|| self.product / made)
    }
}

/// What is known of the lent inertia, bundle by bundle.
#[derive(Clone, Debug)]
pub(super) struct Lent<const L: usize, B: Bodies<L>> {
    /// ω̇ for which its effect has been taken out, and along what that is changed next.
    returned: Vec<B::Moment>,
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
    mu: Mu,
}

/// δ (ω̇ − what the iteration began with) is Dx − Aᵀμ with A x = 0 — eq. (11.18). Each direction p of the iteration is such a sum too, with multipliers
/// that are known when it ends: `count` times all that it has added to λ, less `ahead`.
#[derive(Clone, Debug, Default)]
struct Mu {
    value: Vec<f64>,
    added: Vec<f64>,
    answer: Vec<f64>,
    along: Vec<f64>,
    ahead: Vec<f64>,
    count: f64,
    total: f64,
}

impl Mu {
    #[inline(always)]
    fn begin(&mut self) {
        self.value.fill(0.0);
        self.added.fill(0.0);
        self.ahead.fill(0.0);
        self.along.fill(0.0);
        (self.count, self.total) = (0.0, 0.0);
    }

    /// The next direction is what is left, and a part of the last one.
    #[inline(always)]
    fn turn(&mut self, part: f64) {
        for (along, answer) in self.along.iter_mut().zip(&self.answer) {
            *along = fma(part, *along, *answer);
        }
        self.count = fma(part, self.count, 1.0);
        for (ahead, added) in self.ahead.iter_mut().zip(&self.added) {
            *ahead = fma(part, *ahead, *added);
        }
    }

    /// A step of this length along it.
    #[inline(always)]
    fn go(&mut self, length: f64) {
        self.total = fma(length, self.count, self.total);
        for (value, ahead) in self.value.iter_mut().zip(&self.ahead) {
            *value = fma(length, *ahead, *value);
        }
        for (added, along) in self.added.iter_mut().zip(&self.along) {
            *added = fma(length, *along, *added);
        }
    }

    #[inline(always)]
    fn end(&mut self) {
        for (value, added) in self.value.iter_mut().zip(&self.added) {
            *value = fma(-self.total, *added, *value);
        }
    }
}

impl<const L: usize, B: Bodies<L>> Lent<L, B> {
    pub fn new(bundles: &[B], stride: usize, rows: usize) -> Self {
        let (count, zeros) = (bundles.len(), || vec![0.0; rows]);
        let moments = |count: usize| vec![B::no_moment(); count];
        Self {
            returned: moments(count),
            direction: moments(count),
            found: bundles.to_vec(),
            along: bundles.to_vec(),
            nothing: zeros(),
            turns: moments(count * stride),
            forces: vec![B::no_directors(); count * stride],
            moment: moments(count),
            force: vec![B::zero(); count],
            mu: Mu {
                value: zeros(),
                added: zeros(),
                answer: zeros(),
                along: zeros(),
                ahead: zeros(),
                ..Mu::default()
            },
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
        self.returned.fill(B::no_moment());
    }

    /// Squares of what is left to return, and of what all that makes moments would make.
    #[inline(always)]
    fn left(&self) -> [f64; 2] {
        let mut squares = [0.0; 2];
        for (found, returned) in self.found.iter().zip(&self.returned) {
            let lent = found.lent();
            for (omega, returned) in B::moment_lanes(found.omega()).iter().zip(B::moment_lanes(returned)) {
                for l in 0..L {
                    let left = omega[l] - returned[l];
                    squares[0] += lent[l] * left * left;
                }
            }
            for (lent, moments) in lent.iter().zip(found.moments_squared()) {
                if *lent > 0.0 {
                    squares[1] += moments / lent;
                }
            }
        }
        squares
    }

    /// The product of what is left, by which the bodies were turned from rest, and of what their inertia makes of it.
    #[inline(always)]
    fn product(&self, bundles: &[B]) -> f64 {
        let mut product = 0.0;
        for ((bundle, found), returned) in bundles.iter().zip(&self.found).zip(&self.returned) {
            let lent = bundle.lent();
            let omega = B::moment_lanes(bundle.omega()).iter().zip(B::moment_lanes(found.omega()));
            for (returned, (turned, omega)) in B::moment_lanes(returned).iter().zip(omega) {
                for l in 0..L {
                    let left = omega[l] - returned[l];
                    product += lent[l] * left * (left - turned[l]);
                }
            }
        }
        product
    }

    /// The next direction: what is left, and a part of the last one; likewise what it does. Its square, and that of what inertia makes of it.
    #[inline(always)]
    fn turn(&mut self, bundles: &[B], part: f64) -> [f64; 2] {
        let mut squares = [0.0; 2];
        for (b, bundle) in bundles.iter().enumerate() {
            let (found, along, lent) = (&self.found[b], &mut self.along[b], bundle.lent());
            along.scale_and_add(part, bundle, 1.0);
            let omega = B::moment_lanes(found.omega()).iter().zip(B::moment_lanes(&self.returned[b]));
            let along = B::moment_lanes(along.omega());
            let directions = B::moment_lanes_mut(&mut self.direction[b]).iter_mut().zip(along);
            for ((direction, along), (omega, returned)) in directions.zip(omega) {
                for l in 0..L {
                    direction[l] = fma(part, direction[l], omega[l] - returned[l]);
                    let made = direction[l] - along[l];
                    squares[0] += lent[l] * direction[l] * direction[l];
                    squares[1] += lent[l] * made * made;
                }
            }
        }
        squares
    }

    /// A step of this length along the direction.
    #[inline(always)]
    fn go(&mut self, length: f64) {
        for (b, found) in self.found.iter_mut().enumerate() {
            found.scale_and_add(1.0, &self.along[b], length);
            let directions = B::moment_lanes(&self.direction[b]);
            for (returned, direction) in B::moment_lanes_mut(&mut self.returned[b]).iter_mut().zip(directions)
            {
                for l in 0..L {
                    returned[l] = fma(length, direction[l], returned[l]);
                }
            }
        }
        self.mu.go(length);
    }
}

impl<const L: usize, B: Bodies<L>> Series<L, B> {
    /// Takes the effect of lent inertia out of the solution of order n.
    #[inline(always)]
    fn return_inertia<S: Simd>(&mut self, simd: S, lent: &mut Lent<L, B>, n: usize) {
        let mut residuals = Residuals::begin();
        lent.mu.begin();
        lent.found.clone_from_slice(&self.bundles);
        // What bodies do that are turned from rest: no row demands anything.
        self.exchange_demands(lent);
        loop {
            let [left, scale] = lent.left();
            if !residuals.go_on(left, scale) {
                break;
            }
            for (b, bundle) in self.bundles.iter_mut().enumerate() {
                let (mut moment, delta) = (B::no_moment(), *bundle.lent());
                let omega =
                    B::moment_lanes(lent.found[b].omega()).iter().zip(B::moment_lanes(&lent.returned[b]));
                for (moment, (omega, returned)) in B::moment_lanes_mut(&mut moment).iter_mut().zip(omega) {
                    for l in 0..L {
                        moment[l] = delta[l] * (omega[l] - returned[l]);
                    }
                }
                bundle.rest();
                bundle.turn(simd, &self.state[b][0], moment);
            }
            lent.mu.answer.fill(0.0);
            for _ in 0..=self.refinements() {
                simd.vectorize(Answer(self));
                for (all, correction) in lent.mu.answer.iter_mut().zip(&self.correction) {
                    *all += correction;
                }
            }
            let Some(part) = residuals.part(lent.product(&self.bundles)) else { break };
            lent.mu.turn(part);
            let [square, made] = lent.turn(&self.bundles, part);
            let length = residuals.length(square, made);
            let Some(length) = length else { break };
            lent.go(length);
        }
        self.exchange_demands(lent);
        self.bundles.clone_from_slice(&lent.found);
        let rows = self.correction.len();
        if residuals.free {
            self.turn_as_returned(simd, lent);
            self.refine(simd, n);
        }
        for (lambda, added) in self.lambda[n * rows..(n + 1) * rows].iter_mut().zip(&lent.mu.added) {
            *lambda += added;
        }
        lent.mu.end();
    }

    /// Has bodies that are lent inertia turn as it was returned for: the rest is the rounding of moments, over δ, that nothing holds.
    #[inline(always)]
    fn turn_as_returned<S: Simd>(&mut self, simd: S, lent: &Lent<L, B>) {
        for (b, bundle) in self.bundles.iter_mut().enumerate() {
            let (mut rest, delta) = (B::no_moment(), *bundle.lent());
            let omega = B::moment_lanes(bundle.omega()).iter().zip(B::moment_lanes(&lent.returned[b]));
            for (rest, (omega, returned)) in B::moment_lanes_mut(&mut rest).iter_mut().zip(omega) {
                for l in 0..L {
                    if delta[l] > 0.0 {
                        rest[l] = returned[l] - omega[l];
                    }
                }
            }
            bundle.rotate(simd, &self.state[b][0], rest);
        }
    }

    /// Has rows demand nothing of the unknowns, or what they did again.
    #[inline(always)]
    fn exchange_demands(&mut self, lent: &mut Lent<L, B>) {
        std::mem::swap(&mut self.rows.extra, &mut lent.nothing);
        self.prescribed.exchange_known();
    }

    /// Finds the part of the moment τ of order n that lower orders make. The forces at hand of the bodies are used for that.
    #[inline(always)]
    fn prepare_lent<S: Simd>(&mut self, simd: S, lent: &mut Lent<L, B>, n: usize) {
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
            let lower = B::moment(simd, q, &lent.forces[first..first + self.stride], n);
            let mut moment = B::moment_of(simd, &q[0], &force);
            for (moment, lower) in B::moment_lanes_mut(&mut moment).iter_mut().zip(B::moment_lanes(&lower)) {
                for l in 0..L {
                    moment[l] += lower[l];
                }
            }
            (lent.moment[b], lent.force[b]) = (moment, force);
        }
    }

    /// Begins the iteration of order n with ω̇ for which bodies turn on about axes without inertia as they do, where nothing holds them —
    /// eq. (11.19).
    #[inline(always)]
    fn turn_on<S: Simd>(&mut self, simd: S, lent: &mut Lent<L, B>, n: usize) {
        for (b, bundle) in self.bundles.iter_mut().enumerate() {
            let first = b * self.stride;
            let q = &self.q[first..first + self.stride];
            let (known, delta) = (B::known_turn(q, n), *bundle.lent());
            let mut expected = B::carried_on(q, &lent.turns[first..first + n]);
            lent.turns[first + n] = known;
            let mut moment = B::no_moment();
            let moments = B::moment_lanes_mut(&mut moment).iter_mut().zip(B::moment_lanes(&lent.moment[b]));
            let all = B::moment_lanes_mut(&mut expected).iter_mut().zip(B::moment_lanes(&known)).zip(moments);
            for ((expected, known), (moment, tau)) in all {
                for l in 0..L {
                    if delta[l] > 0.0 {
                        expected[l] += tau[l] / delta[l] - known[l];
                        moment[l] = delta[l] * expected[l];
                    }
                }
            }
            lent.returned[b] = expected;
            bundle.turn(simd, &q[0], moment);
        }
    }

    /// Takes over what the iteration of order n has found.
    #[inline(always)]
    fn store_lent<S: Simd>(&mut self, simd: S, lent: &mut Lent<L, B>, n: usize) {
        let mu = &lent.mu.value;
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
            for (force, known) in B::lanes_mut(&mut force).iter_mut().zip(B::lanes(&lent.force[b])) {
                *force = sum(force, known);
            }
            lent.forces[at] = B::directors(&force);
            let delta = bundle.lent();
            let omega = B::moment_lanes(bundle.omega()).iter().zip(B::moment_lanes(&lent.moment[b]));
            let turns = B::moment_lanes_mut(&mut lent.turns[at]).iter_mut().zip(B::moment_lanes(&of_mu));
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

/// What concerns lent inertia in an order, in turn.
#[derive(Clone, Copy, Debug)]
pub(super) enum Stage {
    /// See [`Series::prepare_lent`].
    Prepare,
    /// See [`Series::turn_on`].
    TurnOn,
    /// See [`Series::return_inertia`].
    Return,
    /// See [`Series::store_lent`].
    Store,
}

/// A stage on its own, to be compiled once for each set of vector instructions: most series have nothing of it.
pub(super) struct Lending<'a, const L: usize, B: Bodies<L>> {
    pub series: &'a mut Series<L, B>,
    pub lent: &'a mut Lent<L, B>,
    pub n: usize,
    pub stage: Stage,
}

impl<const L: usize, B: Bodies<L>> WithSimd for Lending<'_, L, B> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { series, lent, n, stage } = self;
        match stage {
            Stage::Prepare => series.prepare_lent(simd, lent, n),
            Stage::TurnOn => series.turn_on(simd, lent, n),
            Stage::Return => series.return_inertia(simd, lent, n),
            Stage::Store => series.store_lent(simd, lent, n),
        }
    }
}
