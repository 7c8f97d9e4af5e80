//! The iteration that takes the effect of δ out of the solution of one order again — eq. (7.8).

use super::InertiaRegularization;
use super::residuals::ConjugateResiduals;
use crate::dynamics::series::answer::Answer;
use crate::dynamics::series::{Bodies, Series};
use pulp::Simd;
use triad_linalg::fma;

impl<const L: usize, B: Bodies<L>> InertiaRegularization<L, B> {
    /// Sets the residual ω̇ less what has been returned. Squares of it, and of what all that makes moments would make.
    #[inline(always)]
    fn set_residual(&mut self) -> [f64; 2] {
        let mut squares = [0.0; 2];
        for ((found, returned), residual) in self.found.iter().zip(&self.returned).zip(&mut self.residual) {
            let delta = found.delta();
            let omega = B::moment_lanes(found.omega()).iter().zip(B::moment_lanes(returned));
            for (residual, (omega, returned)) in B::moment_lanes_mut(residual).iter_mut().zip(omega) {
                for l in 0..L {
                    residual[l] = omega[l] - returned[l];
                    squares[0] += delta[l] * residual[l] * residual[l];
                }
            }
            for (delta, moments) in delta.iter().zip(found.moments_squared()) {
                if *delta > 0.0 {
                    squares[1] += moments / delta;
                }
            }
        }
        squares
    }

    /// The product of the residual, by which the bodies were turned from rest, and of what their inertia makes of it.
    #[inline(always)]
    fn product(&self, bundles: &[B]) -> f64 {
        let mut product = 0.0;
        for (bundle, residual) in bundles.iter().zip(&self.residual) {
            let delta = bundle.delta();
            for (residual, turned) in B::moment_lanes(residual).iter().zip(B::moment_lanes(bundle.omega())) {
                for l in 0..L {
                    product += delta[l] * residual[l] * (residual[l] - turned[l]);
                }
            }
        }
        product
    }

    /// The next direction: the residual, and a part of the last one; likewise what it does. Its square, and that of what inertia makes of it.
    #[inline(always)]
    fn next_direction(&mut self, bundles: &[B], beta: f64) -> [f64; 2] {
        let mut squares = [0.0; 2];
        for (b, bundle) in bundles.iter().enumerate() {
            let (along, delta) = (&mut self.along[b], bundle.delta());
            along.scale_and_add(beta, bundle, 1.0);
            let directions = B::moment_lanes_mut(&mut self.direction[b]).iter_mut();
            let residuals = B::moment_lanes(&self.residual[b]).iter().zip(B::moment_lanes(along.omega()));
            for (direction, (residual, along)) in directions.zip(residuals) {
                for l in 0..L {
                    direction[l] = fma(beta, direction[l], residual[l]);
                    let made = direction[l] - along[l];
                    squares[0] += delta[l] * direction[l] * direction[l];
                    squares[1] += delta[l] * made * made;
                }
            }
        }
        self.mu.next_direction(beta);
        squares
    }

    /// A step of this length along the direction.
    #[inline(always)]
    fn step(&mut self, alpha: f64) {
        for (b, found) in self.found.iter_mut().enumerate() {
            found.scale_and_add(1.0, &self.along[b], alpha);
            let directions = B::moment_lanes(&self.direction[b]);
            for (returned, direction) in B::moment_lanes_mut(&mut self.returned[b]).iter_mut().zip(directions)
            {
                for l in 0..L {
                    returned[l] = fma(alpha, direction[l], returned[l]);
                }
            }
        }
        self.mu.step(alpha);
    }
}

impl<const L: usize, B: Bodies<L>> Series<L, B> {
    /// Takes the effect of δ out of the solution of order n.
    #[inline(always)]
    pub(super) fn return_inertia<S: Simd>(
        &mut self,
        simd: S,
        regularization: &mut InertiaRegularization<L, B>,
        n: usize,
    ) {
        let mut residuals = ConjugateResiduals::begin();
        regularization.mu.begin();
        regularization.found.clone_from_slice(&self.bundles);
        // What bodies do that are turned from rest: no row demands anything.
        self.exchange_demands(regularization);
        loop {
            let [square, scale] = regularization.set_residual();
            if !residuals.goes_on(square, scale) {
                break;
            }
            self.turn_from_rest(simd, regularization);
            let Some(beta) = residuals.beta(regularization.product(&self.bundles)) else { break };
            let [square, made] = regularization.next_direction(&self.bundles, beta);
            let Some(alpha) = residuals.alpha(square, made) else { break };
            regularization.step(alpha);
        }
        self.exchange_demands(regularization);
        self.bundles.clone_from_slice(&regularization.found);
        let rows = self.correction.len();
        if residuals.is_free() {
            self.turn_as_returned(simd, regularization);
            self.refine(simd, n);
        }
        let mu = &mut regularization.mu;
        for (lambda, added) in self.lambda[n * rows..(n + 1) * rows].iter_mut().zip(&mu.added) {
            *lambda += added;
        }
        mu.end();
    }

    /// Turns the bodies, at rest, by δ times the residual, with what joints answer.
    #[inline(always)]
    fn turn_from_rest<S: Simd>(&mut self, simd: S, regularization: &mut InertiaRegularization<L, B>) {
        for ((bundle, state), residual) in
            self.bundles.iter_mut().zip(&self.state).zip(&regularization.residual)
        {
            let (mut moment, delta) = (*residual, *bundle.delta());
            for moment in B::moment_lanes_mut(&mut moment) {
                for l in 0..L {
                    moment[l] *= delta[l];
                }
            }
            bundle.rest();
            bundle.turn(simd, &state[0], moment);
        }
        let answer = &mut regularization.mu.answer;
        answer.fill(0.0);
        for _ in 0..=self.refinements() {
            simd.vectorize(Answer(self));
            for (all, correction) in answer.iter_mut().zip(&self.correction) {
                *all += correction;
            }
        }
    }

    /// Has regularized bodies turn as it was returned for: the rest is the rounding of moments, over δ, that nothing holds.
    #[inline(always)]
    fn turn_as_returned<S: Simd>(&mut self, simd: S, regularization: &InertiaRegularization<L, B>) {
        for (b, bundle) in self.bundles.iter_mut().enumerate() {
            let (mut rest, delta) = (B::NO_MOMENT, *bundle.delta());
            let omega =
                B::moment_lanes(bundle.omega()).iter().zip(B::moment_lanes(&regularization.returned[b]));
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
    fn exchange_demands(&mut self, regularization: &mut InertiaRegularization<L, B>) {
        std::mem::swap(&mut self.rows.extra, &mut regularization.nothing);
        self.prescribed.exchange_known();
    }
}
