//! The stages of a step and Newton's method for them, in the coordinates in which A⁻¹ falls into blocks.

mod beside;
mod correction;

use super::blocks::{Blocks, NONE, Pair};
use super::coefficients::{MOST_STAGES, Method, RADAU_9, RadauTables};
use super::factors::Factors;
use super::linear::RateJacobian;
use super::updates::Updates;
use crate::integrate::step::StepRecord;
use nalgebra::DMatrix;
use triad_dynamics::ode::{Many, OdeSystem, What};

/// Rounding of the stages to which Newton's method goes on, and below which it may end where its corrections shrink no further.
const ROUNDING: (f64, f64) = (1e-14, 1e-12);
/// Part of the error that a step may have to which its stages are solved: what is left spoils the estimate of the error, and
/// with 3e-2 steps are refused for nothing.
const SOLVED: f64 = 1e-3;
/// Ratio of successive corrections above which Newton's method does not converge, and the same of the first two: where a stiff load
/// turns along the step, a small error of what it leaves free makes a large one of what it holds, and the updates that learn so need
/// two corrections. Refused at once, steps became ten times as short as they need be (a damper of 1e5 N m s in three rods).
const DIVERGING: f64 = 0.99;
const DIVERGING_AT_FIRST: f64 = 4.0;
/// Ratio of a step to the one before it above which the polynomial of that says nothing about the new stages.
const MAX_EXTRAPOLATION: f64 = 1.6;

/// How Newton's method went.
#[derive(Clone, Copy, Debug)]
pub struct Solved {
    /// Iterations.
    pub iterations: usize,
    /// Ratio of its successive corrections.
    pub contraction: f64,
}

/// The stages.
#[derive(Clone, Debug)]
pub struct Stages {
    /// The method.
    pub method: Method,
    /// Stages less the start of the step.
    pub z: Vec<Vec<f64>>,
    /// Those of the last accepted step.
    pub z_old: Vec<Vec<f64>>,
    /// How they turn into blocks.
    pub blocks: Blocks,
    /// T⁻¹ z.
    w: Vec<Pair>,
    /// ẋ at the stages, f, and what they lack in the coordinates of w.
    f: Vec<Vec<f64>>,
    forward: Vec<Pair>,
    /// Accelerations by the change of the Jacobian matrix, times the correction.
    changed: Vec<Pair>,
    /// Power at the stages, W, and at those of the last accepted step; zero where nothing changes the energy.
    power: Vec<f64>,
    power_old: Vec<f64>,
    /// Times and states of the stages.
    times: Vec<f64>,
    states: Vec<Vec<f64>>,
    /// Whether ẏ and the power at the stages are those at the stages as they were found.
    evaluated: bool,
    trial: Vec<f64>,
    weights: Vec<f64>,
    /// One by the error that each number may have.
    scale: Vec<f64>,
    updates: Updates,
    /// The last moment at which they are evaluated, s.
    pub latest: f64,
    /// Whether one iteration more is made than the tolerance asks for.
    pub further: bool,
}

/// Whether the polynomial of the last step says something about one of size h.
fn reaches(last: &StepRecord, h: f64) -> bool {
    last.h > 0.0 && h <= MAX_EXTRAPOLATION * last.h
}

/// One by the error that number i of n, of size y, may have: coordinates are measured as they are, for where they count from is
/// arbitrary; rates relative to their size if they are large.
pub fn scale(i: usize, n: usize, y: f64, estimated: f64) -> f64 {
    1.0 / (estimated * if 2 * i < n { 1.0 } else { 1.0 + y.abs() })
}

/// Numbers that are summed beside each other.
const TOGETHER: usize = 4;

/// Each column of the matrix as the weights of a sum.
fn combine<'a>(
    weights: &DMatrix<f64>,
    from: &(impl Iterator<Item = &'a [f64]> + Clone),
    out: &mut [Vec<f64>],
) {
    let n = out.first().map_or(0, Vec::len);
    for start in (0..n).step_by(TOGETHER) {
        let range = start..n.min(start + TOGETHER);
        let mut parts = [[0.0; TOGETHER]; MOST_STAGES];
        for (part, from) in parts.iter_mut().zip(from.clone()) {
            match from[start..].first_chunk() {
                Some(whole) => *part = *whole,
                None => part[..range.len()].copy_from_slice(&from[range.clone()]),
            }
        }
        for (weights, out) in weights.as_slice().chunks_exact(weights.nrows()).zip(&mut *out) {
            let mut sum = [0.0; TOGETHER];
            for (weight, part) in weights.iter().zip(&parts) {
                sum.iter_mut().zip(part).for_each(|(sum, x)| *sum += weight * x);
            }
            match out[start..].first_chunk_mut() {
                Some(whole) => *whole = sum,
                None => out[range.clone()].copy_from_slice(&sum[..range.len()]),
            }
        }
    }
}

/// The rows of all stages.
fn rows(stages: &[Vec<f64>]) -> impl Iterator<Item = &[f64]> + Clone {
    stages.iter().map(Vec::as_slice)
}

impl Stages {
    /// Allocates for n numbers.
    pub fn new(tables: &'static RadauTables, n: usize) -> Self {
        let method = Method::new(tables);
        let s = method.stages();
        let zeros = || vec![vec![0.0; n]; s];
        let blocks = Blocks::new(&method);
        let rows = |n: usize| vec![NONE; n * blocks.groups];
        Self {
            method,
            z: zeros(),
            z_old: zeros(),
            w: rows(n),
            f: zeros(),
            forward: rows(n),
            changed: rows(n / 2),
            power: vec![0.0; s],
            power_old: vec![0.0; s],
            times: vec![0.0; s],
            states: zeros(),
            evaluated: false,
            trial: vec![0.0; n],
            weights: vec![0.0; s],
            scale: Vec::with_capacity(n),
            updates: Updates::new(n * blocks.groups),
            blocks,
            latest: f64::INFINITY,
            further: false,
        }
    }

    /// Greatest number of iterations of Newton's method for a step: with more stages it takes more.
    pub fn max_iterations(&self) -> usize {
        (6 + self.method.stages()).max(9)
    }

    /// Solves for the stages of a step of size h by simplified Newton iteration with Broyden's updates, to a part of the error
    /// `estimated`.
    pub fn solve(
        &mut self,
        system: &mut impl OdeSystem,
        last: &StepRecord,
        (jacobian, factors): (&RateJacobian, &mut Factors),
        estimated: f64,
    ) -> Option<Solved> {
        self.predict(last, factors.h);
        self.set_scale(last, estimated);
        let [wanted, enough] = [ROUNDING.0, ROUNDING.1].map(|rounding| (rounding / estimated).max(SOLVED));
        let most = self.max_iterations();
        let (mut size_before, mut rate, mut contraction) = (0.0f64, 0.0f64, 0.0f64);
        let mut solved = None;
        self.updates.restart();
        for iteration in 0..most {
            let size = self.find_correction(system, last, (jacobian, factors), iteration == 0)?;
            self.apply();
            if solved.is_some() {
                return solved;
            }
            if iteration > 0 {
                rate = size / size_before;
                // Corrections near rounding say nothing of how others shrink.
                if iteration == 1 {
                    contraction = rate;
                } else if size_before > enough {
                    contraction = (rate * contraction).sqrt();
                }
                if rate.is_nan() || rate >= if iteration == 1 { DIVERGING_AT_FIRST } else { DIVERGING } {
                    // Rounding keeps small corrections from shrinking.
                    return (size <= enough).then_some(Solved { iterations: iteration + 1, contraction });
                }
                let left = (most - 1 - iteration) as f64;
                let hopeless = || rate / (1.0 - rate) * size * libm::pow(rate, left) > 10.0 * enough;
                if iteration > 1 && size > enough && hopeless() {
                    return None;
                }
            }
            size_before = size.max(f64::MIN_POSITIVE);
            let converged = if iteration == 0 {
                size <= 1e-3 * wanted
            } else {
                rate < DIVERGING && rate / (1.0 - rate) * size <= wanted
            };
            if converged {
                solved = Some(Solved { iterations: iteration + 1, contraction });
                if !self.further {
                    return solved;
                }
            }
        }
        (size_before <= enough).then_some(Solved { iterations: most, contraction })
    }

    /// The sizes in which errors beside the last step are measured.
    fn set_scale(&mut self, last: &StepRecord, estimated: f64) {
        self.scale.clear();
        self.scale.extend(last.y.iter().enumerate().map(|(i, y)| scale(i, last.y.len(), *y, estimated)));
    }

    /// Finds the correction of all stages by an iteration of Newton's method, to be applied next. Returns its size, if the stages are finite.
    fn find_correction(
        &mut self,
        system: &mut impl OdeSystem,
        last: &StepRecord,
        (jacobian, factors): (&RateJacobian, &mut Factors),
        first: bool,
    ) -> Option<f64> {
        if !self.evaluate(system, last, factors.h, first) {
            return None;
        }
        let size = self.correct(last.t, jacobian, factors);
        let numbers = self.scale.len() as f64 * self.z.len() as f64;
        Some(size / numbers.sqrt())
    }

    /// ẋ and the power at all stages at once, if the system can.
    fn evaluate_at_once(
        &mut self,
        system: &mut impl OdeSystem,
        last: &StepRecord,
        h: f64,
        what: What,
    ) -> bool {
        for stage in 0..self.z.len() {
            self.times[stage] = self.time(last, h, stage);
            let numbers = last.y.iter().zip(&self.z[stage]);
            self.states[stage].iter_mut().zip(numbers).for_each(|(state, (x, z))| *state = x + z);
        }
        let Self { times, states, f, power, .. } = self;
        system.rhs_of_many(Many { times, states, rates: f, power, what })
    }

    /// ẋ at all stages. False if it is not finite.
    fn evaluate(&mut self, system: &mut impl OdeSystem, last: &StepRecord, h: f64, first: bool) -> bool {
        self.evaluated = false;
        if self.evaluate_at_once(system, last, h, What::Stages) {
            return self.f.iter().flatten().all(|f| f.is_finite());
        }
        for stage in 0..self.z.len() {
            self.set_trial(last, stage);
            system.begin_stage(stage, first);
            system.rhs(self.time(last, h, stage), &self.trial, &mut self.f[stage]);
            if !self.f[stage].iter().all(|f| f.is_finite()) {
                return false;
            }
        }
        true
    }

    /// When a stage is.
    fn time(&self, last: &StepRecord, h: f64, stage: usize) -> f64 {
        (last.t + self.method.tables.nodes[stage].0 * h).min(self.latest)
    }

    fn set_trial(&mut self, last: &StepRecord, stage: usize) {
        for (trial, (x, z)) in self.trial.iter_mut().zip(last.y.iter().zip(&self.z[stage])) {
            *trial = x + z;
        }
    }

    /// Evaluates the stages once more as they were found, for the power there. Returns by how much the work of the step may be
    /// off, relative to it, if the power at its start is `before`: the power there less what the stages make of it.
    pub fn find_power(
        &mut self,
        system: &mut impl OdeSystem,
        last: &StepRecord,
        h: f64,
        before: f64,
    ) -> [f64; 2] {
        self.evaluated = self.evaluate_at_once(system, last, h, What::FoundStages);
        for stage in 0..if self.evaluated { 0 } else { self.z.len() } {
            self.set_trial(last, stage);
            system.begin_stage(stage, false);
            let time = self.time(last, h, stage);
            self.power[stage] = system.power_at(time, &self.trial).unwrap_or(0.0);
        }
        self.method.through(0.0, &mut self.weights);
        let foreseen: f64 = self.weights.iter().zip(&self.power).map(|(weight, power)| weight * power).sum();
        let nodes = self.method.tables.nodes;
        let turnover: f64 = nodes.iter().zip(&self.power).map(|((_, b), power)| b * power.abs()).sum();
        [h / self.method.tables.real * (before - foreseen).abs(), h * turnover]
    }

    /// ẋ at the last stage as it was found, if it is at that time and was evaluated there.
    pub fn rate_at(&self, time: f64) -> Option<&[f64]> {
        let known = self.evaluated && self.times.last() == Some(&time);
        self.f.last().filter(|_| known).map(Vec::as_slice)
    }

    /// Keeps the stages as those of the last step.
    pub fn accept(&mut self) {
        std::mem::swap(&mut self.z, &mut self.z_old);
        std::mem::swap(&mut self.power, &mut self.power_old);
    }

    /// Integral of the power from the start of the last step, of size h, to its part x, J.
    pub fn work(&self, x: f64, h: f64) -> f64 {
        if x == 1.0 {
            let parts = self.method.tables.nodes.iter().zip(&self.power_old);
            return h * parts.map(|((_, b), power)| b * power).sum::<f64>();
        }
        let mut weights = vec![0.0; self.power_old.len()];
        let mut work = 0.0;
        // Exact for a polynomial through the stages.
        for (node, weight) in RADAU_9.nodes {
            self.method.through(node * x, &mut weights);
            work += weight
                * weights.iter().zip(&self.power_old).map(|(weight, power)| weight * power).sum::<f64>();
        }
        work * x * h
    }

    /// First stages: from the polynomial of the last step, or none.
    fn predict(&mut self, last: &StepRecord, h: f64) {
        let s = self.z.len();
        let known = reaches(last, h);
        for stage in 0..s {
            if !known {
                self.z[stage].fill(0.0);
                continue;
            }
            let node = self.method.tables.nodes[stage].0;
            self.method.collocation(1.0 + node * h / last.h, &mut self.weights);
            for i in 0..last.y.len() {
                self.z[stage][i] = self.polynomial(i) - self.z_old[s - 1][i];
            }
        }
        self.turn_over();
    }

    /// Adds to the end of the last step what its polynomial foresees for the part `part` of a step of size h, if that is not too far.
    pub fn foresee(&mut self, last: &StepRecord, h: f64, part: f64, out: &mut [f64]) -> bool {
        if !reaches(last, h) {
            return false;
        }
        self.method.collocation(1.0 + part * h / last.h, &mut self.weights);
        for (i, out) in out.iter_mut().enumerate() {
            *out = last.y[i] + self.polynomial(i) - self.z_old[self.z_old.len() - 1][i];
        }
        true
    }

    /// Weights of the stages, less the start of the step, in its collocation polynomial at the part x.
    pub fn weights_at(&mut self, x: f64) -> &[f64] {
        self.method.collocation(x, &mut self.weights);
        &self.weights
    }

    /// The collocation polynomial of the last step, less its start, with the weights in place.
    fn polynomial(&self, i: usize) -> f64 {
        self.weights.iter().zip(&self.z_old).map(|(weight, z)| weight * z[i]).sum()
    }

    /// Takes the last step in other coordinates: its stages and its start.
    pub fn replace(&mut self, stages: &[Vec<f64>], start: &[f64]) {
        for (z, stage) in self.z_old.iter_mut().zip(stages) {
            for (z, (stage, start)) in z.iter_mut().zip(stage.iter().zip(start)) {
                *z = stage - start;
            }
        }
    }

    /// Adds to `start`, the state at the start of the last step, what the polynomial of that step gains up to its part x.
    pub fn interpolate(&mut self, x: f64, start: &[f64], out: &mut [f64]) {
        self.method.collocation(x, &mut self.weights);
        for (i, (out, start)) in out.iter_mut().zip(start).enumerate() {
            *out = start + self.polynomial(i);
        }
    }
}
