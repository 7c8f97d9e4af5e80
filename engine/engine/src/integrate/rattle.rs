//! RATTLE, composed symmetrically to order 6: symplectic, symmetric in time, with the constraints of position and
//! velocity satisfied at the end of each step — eq. (10.8)
//! (Hairer, Lubich, Wanner, Geometric Numerical Integration, sections V.3, VII.1.4).
//!
//! It works in the natural coordinates of all bodies, where the mass matrix is constant. Steps have one size: energy
//! then oscillates within bounds and does not drift, however long the run.

#![allow(clippy::excessive_precision, reason = "the numbers stand as they were published")]

use super::explicit::{DOP853, Explicit};
use super::hermite;
use super::step::{StepRecord, StopReason};
use super::stepper::Stepper;
use nalgebra::Vector3;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::ode::OdeSystem;
use triad_dynamics::state::{Residual, State};
use triad_dynamics::system::natural::NaturalCoordinates;
use triad_linalg::larger_or_nan;

/// Substeps of the composition by Kahan and Li (1997), in parts of a step; the first five, the others mirror them.
const PARTS: [f64; 5] = [
    0.392_161_444_007_314_14,
    0.332_599_136_789_359_44,
    -0.706_246_172_557_639_4,
    0.082_213_596_293_550_8,
    0.798_543_990_934_829_9,
];
/// Substeps of a step.
const SUBSTEPS: usize = 9;

/// The parts make a whole step, and their cubes vanish: the conditions of a symmetric composition.
const _: () = {
    let (mut sum, mut cubes, mut k) = (0.0, 0.0, 0);
    while k < SUBSTEPS {
        let part = PARTS[if k < SUBSTEPS - 1 - k { k } else { SUBSTEPS - 1 - k }];
        (sum, cubes, k) = (sum + part, cubes + part * part * part, k + 1);
    }
    assert!((sum - 1.0).abs() < 1e-15 && cubes.abs() < 1e-15);
};
/// Greatest number of iterations for the end of a substep.
const MAX_ITERATIONS: usize = 100;
/// Iterations after which a growing change means that the substep cannot be solved.
const MIN_ITERATIONS: usize = 8;
/// A change below this part of the mechanism's length that does not shrink any more is rounding.
const STALLED: f64 = 1e-9;
/// A change below this part of the mechanism's length that no longer halves is rounding.
const ROUNDING: f64 = 1e-15;
/// A step that is longer than what is left to the end by less than this part of itself is the last.
const LAST_STEP: f64 = 1e-6;
/// Greatest number of steps of the trial run from which the step size is found.
const TRIAL_STEPS: usize = 100;
/// Part of the longest step of the trial below which the trial is coming to a halt, and says no more about the motion before
/// that.
const HALTING: f64 = 1e-4;
/// A step after which the next one is so many times longer still grows from the first guess, whatever the tolerance.
const GROWING: f64 = 2.0;
/// The step size in steps of the trial.
const PART_OF_TRIAL: f64 = 0.5;
/// Steps of a run whose trial came to no second step.
const STEPS_WITHOUT_TRIAL: f64 = 20.0;

/// The integrator and its last step.
#[derive(Clone, Debug)]
pub struct Rattle {
    last: StepRecord,
    /// Size of the steps.
    h: f64,
    /// What there is to say of it.
    told: Option<String>,
    position: Vec<NaturalCoordinates>,
    velocity: Vec<NaturalCoordinates>,
    /// Both at the start of the step.
    kept: (Vec<NaturalCoordinates>, Vec<NaturalCoordinates>),
    y_old: Vec<f64>,
    /// Rates at both ends of the last step, for dense output.
    rates: [Vec<f64>; 2],
    dense_ready: bool,
    /// Where the constraints are evaluated while the factor stays at the start of a substep.
    other: State,
    there: Vec<NaturalCoordinates>,
    /// Q₁ − Q₀ − h Q̇₀ of the substep.
    change: Vec<NaturalCoordinates>,
    half: Vec<NaturalCoordinates>,
    forces: Vec<NaturalCoordinates>,
    pushed: Vec<NaturalCoordinates>,
    residuals: Vec<Residual>,
    /// Whether loads act: their forces may depend on the velocity.
    loaded: bool,
}

impl Rattle {
    /// Order of the composition.
    pub const ORDER: u32 = 6;

    /// Starts at the consistent state y with steps of size h; if none is given, of a size that a trial run with the
    /// given tolerance finds.
    pub fn new(mechanism: &mut Mechanism, t: f64, y: &[f64], h: Option<f64>) -> Self {
        let settings = &mechanism.system.model.settings;
        let (tolerance, end) = (settings.tolerance, settings.duration);
        let left = (end - t).max(f64::MIN_POSITIVE);
        let trial = if h.is_none() { trial(mechanism, t, y, tolerance, end) } else { Trial::default() };
        let asked = h.unwrap_or(PART_OF_TRIAL * trial.step);
        // Steps of one size that end at the end.
        let size = left / (left / asked).ceil().max(1.0);
        let told = if h.is_some() && size < asked * (1.0 - LAST_STEP) {
            Some(format!(
                "steps of {size} s in place of {asked} s: those of rattle have one size and end with the run"
            ))
        } else {
            trial.as_it_begins.then(|| {
                format!(
                    "steps of {size:.3e} s: the trial that finds their size begins with them, and the tolerance, which allows longer \
                     ones, changes nothing; \"step\" gives another size"
                )
            })
        };
        let system = &mechanism.system;
        let bodies = system.bodies.len();
        let zero = vec![NaturalCoordinates::default(); bodies];
        let (q, q_dot) = y.split_at(system.coordinates);
        let position: Vec<NaturalCoordinates> = system.bodies.iter().map(|b| b.layout.position(q)).collect();
        let velocity =
            system.bodies.iter().zip(&position).map(|(b, q)| b.layout.velocity(q, q_dot)).collect();
        let rates = [vec![0.0; y.len()], vec![0.0; y.len()]];
        let mut rattle = Self {
            last: StepRecord::new(t, y),
            h: size,
            told,
            position,
            velocity,
            kept: (zero.clone(), zero.clone()),
            y_old: y.to_vec(),
            rates,
            dense_ready: false,
            other: mechanism.state.clone(),
            there: zero.clone(),
            change: zero.clone(),
            half: zero.clone(),
            forces: zero.clone(),
            pushed: zero,
            residuals: vec![Residual::zeros(); system.rows.len()],
            loaded: !(system.loads.is_empty() && system.model.custom_loads.is_empty()),
        };
        rattle.restore(mechanism);
        rattle
    }

    /// Puts the state at the end of the last step in place, with its factor.
    fn restore(&mut self, mechanism: &mut Mechanism) {
        let Mechanism { system, state, elimination, .. } = mechanism;
        state.set_time(system, self.last.t);
        state.set_natural_positions(system, &self.position);
        state.set_natural_velocities(system, &self.velocity);
        elimination.linearize(system, state);
        self.other.follow_motion(state);
    }

    /// One step of RATTLE of size h from time t. False if its equations cannot be solved.
    fn substep(&mut self, mechanism: &mut Mechanism, t: f64, h: f64) -> bool {
        let Mechanism { system, state: here, elimination, .. } = mechanism;
        elimination.set_forces(system, here);
        for (index, q) in self.position.iter().enumerate() {
            self.there[index] = combined(q, h, &self.velocity[index]);
            self.change[index] = NaturalCoordinates::default();
            self.pushed[index] = elimination.bodies()[index].force;
            self.forces[index] = scaled(0.5 * h * h, &self.pushed[index]);
        }
        self.other.set_time(system, t + h);
        let (mut last, mut converged) = (f64::INFINITY, false);
        for iteration in 0..MAX_ITERATIONS {
            self.other.set_natural_positions(system, &self.there);
            self.other.residuals(system, false, &mut self.residuals);
            elimination.increment(system, here, &self.forces, &self.other, false, &self.residuals);
            let mut step = 0.0f64;
            for (index, there) in self.there.iter_mut().enumerate() {
                let change = elimination.solution(here, index);
                step = step.max(largest(&change));
                *there = combined(there, 1.0, &change);
                self.change[index] = combined(&self.change[index], 1.0, &change);
                self.forces[index] = NaturalCoordinates::default();
            }
            if !step.is_finite() {
                return false;
            }
            // To the last bit: what is left over would add up in a long run.
            let rounding = (step >= last && step < STALLED * system.length)
                || (step > 0.5 * last && step < ROUNDING * system.length);
            if step == 0.0 || (iteration > 0 && rounding) {
                converged = true;
                break;
            }
            if iteration > MIN_ITERATIONS && step > last {
                return false;
            }
            last = step;
            if self.loaded {
                // The force at the start of the substep, with the velocity in its middle.
                for (half, (v, change)) in self.half.iter_mut().zip(self.velocity.iter().zip(&self.change)) {
                    *half = combined(v, 1.0 / h, change);
                }
                here.set_natural_velocities(system, &self.half);
                elimination.set_forces(system, here);
                for (index, old) in self.pushed.iter_mut().enumerate() {
                    let new = elimination.bodies()[index].force;
                    self.forces[index] = scaled(0.5 * h * h, &combined(&new, -1.0, old));
                    *old = new;
                }
            }
        }
        converged && self.finish(mechanism, t + h, h)
    }

    /// The second half of a substep: forces of its end, and velocities onto the constraints there.
    fn finish(&mut self, mechanism: &mut Mechanism, t: f64, h: f64) -> bool {
        let Mechanism { system, state: here, elimination, .. } = mechanism;
        // Not the difference of the positions, which would lose digits.
        for (half, (v, change)) in self.half.iter_mut().zip(self.velocity.iter().zip(&self.change)) {
            *half = combined(v, 1.0 / h, change);
        }
        self.position.copy_from_slice(&self.there);
        here.set_time(system, t);
        here.set_natural_positions(system, &self.position);
        here.set_natural_velocities(system, &self.half);
        here.commit_motion();
        elimination.linearize(system, here);
        elimination.set_forces(system, here);
        here.residuals(system, true, &mut self.residuals);
        for (force, solve) in self.forces.iter_mut().zip(elimination.bodies()) {
            *force = scaled(0.5 * h, &solve.force);
        }
        self.other.set_natural_positions(system, &self.position);
        self.other.set_natural_velocities(system, &self.half);
        self.other.follow_motion(here);
        elimination.increment(system, here, &self.forces, &self.other, true, &self.residuals);
        let mut finite = true;
        for (index, velocity) in self.velocity.iter_mut().enumerate() {
            *velocity = combined(&self.half[index], 1.0, &elimination.solution(here, index));
            finite &= largest(velocity).is_finite();
        }
        here.set_natural_velocities(system, &self.velocity);
        elimination.counters.evaluations += 1;
        finite
    }

    fn store(&mut self, mechanism: &Mechanism) {
        let n = mechanism.system.coordinates;
        let (q, q_dot) = self.last.y.split_at_mut(n);
        for (index, body) in mechanism.system.bodies.iter().enumerate() {
            body.layout.store(&self.position[index], q);
            body.layout.store(&self.velocity[index], q_dot);
        }
    }
}

impl Stepper for Rattle {
    fn last(&self) -> &StepRecord {
        &self.last
    }

    fn step(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), StopReason> {
        let start = self.last.t;
        let left = end - start;
        let h = if left <= self.h * (1.0 + LAST_STEP) { left } else { self.h };
        self.last.check_size(h, end)?;
        self.kept.0.copy_from_slice(&self.position);
        self.kept.1.copy_from_slice(&self.velocity);
        // Outputs between steps have moved the mechanism.
        self.restore(mechanism);
        let mut t = start;
        for part in 0..SUBSTEPS {
            let part = PARTS[part.min(SUBSTEPS - 1 - part)];
            if !self.substep(mechanism, t, part * h) {
                self.position.copy_from_slice(&self.kept.0);
                self.velocity.copy_from_slice(&self.kept.1);
                return Err(StopReason::NoConvergence { time: start, step: h });
            }
            t += part * h;
        }
        self.y_old.copy_from_slice(&self.last.y);
        self.last.advance(h, end);
        self.store(mechanism);
        self.dense_ready = false;
        Ok(())
    }

    fn interpolate(&mut self, mechanism: &mut Mechanism, t: f64, y: &mut [f64]) {
        let StepRecord { t: t_new, y: y_new, t_old, h, .. } = &self.last;
        if self.last.has_ended(t) {
            y.copy_from_slice(y_new);
            return;
        }
        if !self.dense_ready {
            mechanism.rhs(*t_old, &self.y_old, &mut self.rates[0]);
            mechanism.rhs(*t_new, y_new, &mut self.rates[1]);
            self.dense_ready = true;
        }
        let n = y.len() / 2;
        let s = self.last.part(t);
        for i in 0..n {
            let start = [self.y_old[i], self.y_old[n + i], self.rates[0][n + i]];
            let end = [y_new[i], y_new[n + i], self.rates[1][n + i]];
            (y[i], y[n + i]) = hermite::quintic(start, end, *h, s);
        }
    }

    fn next_size(&self) -> Option<f64> {
        Some(self.h)
    }

    fn told_of_steps(&self) -> Option<String> {
        self.told.clone()
    }

    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }
}

/// What a trial run from the start says of steps.
#[derive(Clone, Copy, Debug, Default)]
struct Trial {
    /// The smallest, s.
    step: f64,
    /// Whether it is the first that counts, after which the tolerance allows longer ones at once.
    as_it_begins: bool,
}

fn trial(mechanism: &mut Mechanism, t: f64, y: &[f64], tolerance: f64, end: f64) -> Trial {
    let mut trial = mechanism.clone();
    let mut explicit = Explicit::new(&DOP853, &mut trial, t, y, tolerance);
    let mut steps = Vec::with_capacity(TRIAL_STEPS);
    let mut largest = 0.0f64;
    for step in 0..TRIAL_STEPS {
        if explicit.last().t >= end || explicit.step(&mut trial, end).is_err() {
            break;
        }
        // The first step is a guess, the last one is cut.
        let &StepRecord { t, h, .. } = explicit.last();
        if step > 0 && t < end {
            largest = largest.max(h);
            if h < HALTING * largest {
                break;
            }
            steps.push(h);
        }
    }
    let smallest = steps.iter().copied().fold(f64::INFINITY, f64::min);
    match steps[..] {
        [] => Trial { step: (end - t) / STEPS_WITHOUT_TRIAL, as_it_begins: false },
        [first, second, ..] => {
            Trial { step: smallest, as_it_begins: smallest == first && second > GROWING * first }
        }
        [_] => Trial { step: smallest, as_it_begins: false },
    }
}

/// a + factor b.
fn combined(a: &NaturalCoordinates, factor: f64, b: &NaturalCoordinates) -> NaturalCoordinates {
    NaturalCoordinates { r: a.r + b.r * factor, e: [0, 1, 2].map(|k| a.e[k] + b.e[k] * factor) }
}

fn scaled(factor: f64, a: &NaturalCoordinates) -> NaturalCoordinates {
    NaturalCoordinates { r: a.r * factor, e: a.e.map(|e| e * factor) }
}

/// Largest component; NaN is larger than any.
fn largest(a: &NaturalCoordinates) -> f64 {
    let amax = |v: &Vector3<f64>| if v.iter().any(|x| x.is_nan()) { f64::NAN } else { v.amax() };
    let all = [amax(&a.r), amax(&a.e[0]), amax(&a.e[1]), amax(&a.e[2])];
    all.into_iter().fold(0.0, larger_or_nan)
}
