//! Augmented Lagrangian at the level of positions (index 3) with projections of velocity and acceleration — eq. (10.10)
//! (Bayo and Ledesma, Nonlinear Dynamics 9 (1996); Cuadrado, Cardenal and Bayo, Multibody System Dynamics 1 (1997)).
//!
//! The partner is the implicit trapezoidal rule: with its formulas for q̇ and q̈, the equations of motion at the end of
//! a step become equations for the positions, solved by Newton's method while the multipliers are augmented,
//! λ ← λ + α Φ. Their matrix M + h/2 C + h²/4 (Φ_qᵀ α Φ_q + K) is never singular, also where rows are redundant, and
//! serves the projections as well. Order 2.

use super::hermite;
use super::step::{MIN_ERROR, MIN_RETRY, SAFETY, StepRecord, StopReason};
use super::stepper::Stepper;
use nalgebra::DVector;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::equations::augmented::{Normal, RankOne, RightSides};
use triad_dynamics::ode::OdeSystem;

/// Greatest number of Newton iterations of a step, each of which augments the multipliers.
const MAX_ITERATIONS: usize = 25;
/// Iterations after which a growing change means that the step cannot be solved.
const MIN_ITERATIONS: usize = 6;
/// Change of the coordinates, in lengths of the mechanism, above which Newton's method has diverged.
const DIVERGED: f64 = 1e3;
/// Greatest number of augmentations of each projection.
const MAX_PROJECTIONS: usize = 40;
/// What a projection may leave of the constraints, relative to the largest velocity or acceleration.
const PROJECTED: f64 = 1e-13;
/// Least and greatest change of the step, as factors.
const CHANGE: (f64, f64) = (0.2, 3.0);
/// The step after one whose equations were not solved, as a factor.
const AFTER_FAILURE: f64 = 0.25;
/// Error to which the equations of a step are solved, relative to the tolerance.
const SOLVED: f64 = 1e-3;

/// The integrator and its last step.
#[derive(Clone, Debug)]
pub struct Augmented {
    alpha: f64,
    tolerance: f64,
    fixed: bool,
    last: StepRecord,
    /// Size of the next step.
    h: f64,
    /// q, q̇ and q̈ at the end of the last step and at its start.
    state: [DVector<f64>; 3],
    old: [DVector<f64>; 3],
    /// Change of q̈ in the last step by its size.
    jerk: Option<DVector<f64>>,
    multipliers: DVector<f64>,
    equations: Normal,
    laws: Vec<Law>,
}

/// Stiffness and damping of a load with the gradient of its coordinate.
type Law = (f64, f64, Vec<(usize, f64)>);

impl Augmented {
    /// Order of the trapezoidal rule.
    pub const ORDER: u32 = 2;

    /// Starts at the consistent state y with the penalty α, N/m; steps have the given size, or follow the tolerance.
    pub fn new(mechanism: &mut Mechanism, t: f64, y: &[f64], alpha: f64, step: Option<f64>) -> Self {
        let n = mechanism.system.coordinates;
        let tolerance = mechanism.system.model.settings.tolerance;
        let mut rate = vec![0.0; 2 * n];
        mechanism.rhs(t, y, &mut rate);
        let equations = Normal::new(&mechanism.system, &mechanism.state);
        let column = |x: &[f64]| DVector::from_column_slice(x);
        let state = [column(&y[..n]), column(&y[n..]), column(&rate[n..])];
        let rows = equations.rows();
        let fastest = state[2].amax().max(1e-3);
        let first = libm::cbrt(12.0 * tolerance / fastest).min(1e-2);
        Self {
            alpha,
            tolerance,
            fixed: step.is_some(),
            last: StepRecord::new(t, y),
            h: step.unwrap_or(first),
            old: state.clone(),
            state,
            jerk: None,
            multipliers: DVector::zeros(rows),
            equations,
            laws: Vec::new(),
        }
    }

    /// Sets a state and evaluates its matrices and right-hand sides.
    fn evaluate(
        &mut self,
        mechanism: &mut Mechanism,
        t: f64,
        q: &DVector<f64>,
        v: &DVector<f64>,
    ) -> RightSides {
        let Mechanism { system, state, elimination, .. } = mechanism;
        state.set(system, t, q.as_slice(), v.as_slice());
        elimination.counters.evaluations += 1;
        self.equations.refresh(system, state);
        RightSides::new(system, state)
    }

    fn take_laws(&mut self, mechanism: &mut Mechanism) {
        let Mechanism { system, state, elimination, .. } = mechanism;
        self.laws.clear();
        for load in 0..system.loads.len() {
            let Some((stiffness, damping)) = elimination.set_unit_load(system, state, load) else { continue };
            let mut gradient = vec![0.0; system.coordinates];
            let bodies = system.bodies.iter().zip(state.bodies()).zip(elimination.bodies());
            for ((body, at), solve) in bodies {
                body.layout.pull_back(&at.q, &solve.force, |column, value| gradient[column] += value);
            }
            let vector = gradient.into_iter().enumerate().filter(|(_, x)| *x != 0.0).collect();
            self.laws.push((stiffness, damping, vector));
        }
    }

    /// Weights h/2 C + h²/4 K of the loads.
    fn tangents(&self, h: f64) -> Vec<RankOne> {
        let weight = |k: f64, d: f64| 0.5 * h * d + 0.25 * h * h * k;
        self.laws
            .iter()
            .map(|(k, d, vector)| RankOne { weight: weight(*k, *d), vector: vector.clone() })
            .collect()
    }

    /// Solves for the end of a step of size h. Returns q, q̇, q̈ and the multipliers there.
    fn attempt(&mut self, mechanism: &mut Mechanism, h: f64) -> Option<([DVector<f64>; 3], DVector<f64>)> {
        let [q0, v0, a0] = self.state.clone();
        let t = self.last.t + h;
        let mut q = &q0 + &v0 * h + &a0 * (0.5 * h * h);
        let mut multipliers = self.multipliers.clone();
        let quarter = 0.25 * h * h;
        // q̇ = 2/h (q − q₀) − q̇₀, q̈ = 4/h² (q − q₀) − 4/h q̇₀ − q̈₀.
        let velocity = |q: &DVector<f64>| (q - &q0) * (2.0 / h) - &v0;
        let acceleration = |q: &DVector<f64>| ((q - &q0) - &v0 * h) / quarter - &a0;
        let mut solved = false;
        let mut last = f64::INFINITY;
        let length = mechanism.system.length;
        for iteration in 0..MAX_ITERATIONS {
            let sides = self.evaluate(mechanism, t, &q, &velocity(&q));
            if iteration == 0 {
                self.take_laws(mechanism);
            }
            // What the penalty exerts now is taken over into the multipliers, and still acts itself.
            let pushed = &sides.value * self.alpha;
            if iteration > 0 {
                multipliers += &pushed;
            }
            let mut residual = sides.force - self.equations.mass_product(&acceleration(&q));
            self.equations.add_transposed(-1.0, &(&multipliers + pushed), &mut residual);
            residual *= quarter;
            mechanism.elimination.counters.factorizations += 1;
            if !self.equations.factor(quarter * self.alpha, &self.tangents(h)) {
                return None;
            }
            self.equations.solve(&mut residual);
            q += &residual;
            let step = residual.amax();
            if !step.is_finite()
                || step > DIVERGED * length.max(1.0)
                || (iteration > MIN_ITERATIONS && step > last)
            {
                solved = step < self.tolerance * length;
                break;
            }
            last = step;
            if step <= SOLVED * self.tolerance * length.min(1.0) && sides.value.amax() <= self.tolerance {
                solved = true;
                break;
            }
        }
        if !solved {
            return None;
        }
        let (v, a) = (velocity(&q), acceleration(&q));
        let (v, a) = self.project(mechanism, t, h, &q, v, a)?;
        Some(([q, v, a], multipliers))
    }

    /// Velocities and accelerations onto their constraints, in the sense of M + h/2 C + h²/4 K.
    fn project(
        &mut self,
        mechanism: &mut Mechanism,
        t: f64,
        h: f64,
        q: &DVector<f64>,
        v: DVector<f64>,
        a: DVector<f64>,
    ) -> Option<(DVector<f64>, DVector<f64>)> {
        let penalty = 0.25 * h * h * self.alpha;
        let sides = self.evaluate(mechanism, t, q, &v);
        let tangents = self.tangents(h);
        if !self.equations.factor(penalty, &tangents) {
            return None;
        }
        let onto = |from: DVector<f64>, target: &DVector<f64>, equations: &mut Normal| {
            let weighted = |x: &DVector<f64>, equations: &Normal| {
                let mut out = equations.mass_product(x);
                for RankOne { weight, vector } in &tangents {
                    let along: f64 = vector.iter().map(|(i, g)| g * x[*i]).sum();
                    for (i, g) in vector {
                        out[*i] += weight * along * g;
                    }
                }
                out
            };
            let mut fixed = weighted(&from, equations);
            equations.add_transposed(penalty, target, &mut fixed);
            let mut multipliers = DVector::zeros(target.len());
            let mut x = from;
            for _ in 0..MAX_PROJECTIONS {
                let mut right = fixed.clone();
                equations.add_transposed(-penalty, &multipliers, &mut right);
                equations.solve(&mut right);
                x = right;
                let open = equations.product(x.as_slice()) - target;
                if open.amax() <= PROJECTED * x.amax().max(1.0) {
                    break;
                }
                multipliers += open;
            }
            x
        };
        let v = onto(v, &sides.nu, &mut self.equations);
        // γ depends on the velocities, which have just changed.
        let gamma = self.evaluate(mechanism, t, q, &v).gamma;
        let a = onto(a, &gamma, &mut self.equations);
        (v.iter().chain(a.iter()).all(|x| x.is_finite())).then_some((v, a))
    }

    /// Error of positions and velocities of a step relative to the tolerance.
    fn error(&self, h: f64, end: &[DVector<f64>; 3]) -> (f64, DVector<f64>) {
        let jerk = (&end[2] - &self.state[2]) / h;
        let mut sum = 0.0;
        let n = jerk.len();
        for i in 0..n {
            let position = h * h * h / 12.0 * jerk[i];
            let snap = self.jerk.as_ref().map_or(0.0, |last| 2.0 * (jerk[i] - last[i]) / (h + self.last.h));
            let velocity = h * h * h / 12.0 * snap;
            let weight = |x: f64, y: f64| self.tolerance * (1.0 + x.abs().max(y.abs()));
            for (k, error) in [position, velocity].into_iter().enumerate() {
                let error = error / weight(self.state[k][i], end[k][i]);
                sum += error * error;
            }
        }
        ((sum / (2 * n).max(1) as f64).sqrt(), jerk)
    }
}

impl Stepper for Augmented {
    fn last(&self) -> &StepRecord {
        &self.last
    }

    fn step(&mut self, mechanism: &mut Mechanism, end: f64) -> Result<(), StopReason> {
        loop {
            let h = self.last.next_size(self.h, end)?;
            let Some((state, multipliers)) = self.attempt(mechanism, h) else {
                self.last.steps.rejected += 1;
                let time = self.last.t;
                if self.fixed || h < MIN_RETRY * (1.0 + time.abs()) {
                    return Err(StopReason::NoConvergence { time, step: h });
                }
                self.h = AFTER_FAILURE * h;
                continue;
            };
            let (error, jerk) = self.error(h, &state);
            // The end was evaluated last.
            let counted = mechanism.knows_turns();
            if self.fixed && !counted {
                return Err(StopReason::TurnsUnknown { time: self.last.t, step: h });
            }
            let error = if counted { error } else { f64::INFINITY };
            let by = (SAFETY * libm::pow(error.max(MIN_ERROR), -1.0 / 3.0)).clamp(CHANGE.0, CHANGE.1);
            if error >= 1.0 && !self.fixed {
                self.last.steps.rejected += 1;
                self.h = h * by;
                continue;
            }
            self.old = std::mem::replace(&mut self.state, state);
            self.multipliers = multipliers;
            self.jerk = Some(jerk);
            self.last.advance(h, end);
            if !self.fixed {
                self.h = if h < self.h { self.h.max(h * by) } else { h * by };
            }
            let StepRecord { t, y, .. } = &mut self.last;
            let (q, q_dot) = y.split_at_mut(self.state[0].len());
            q.copy_from_slice(self.state[0].as_slice());
            q_dot.copy_from_slice(self.state[1].as_slice());
            mechanism.set_state(*t, y);
            mechanism.state.commit_motion();
            return Ok(());
        }
    }

    fn interpolate(&mut self, _: &mut Mechanism, t: f64, y: &mut [f64]) {
        if self.last.has_ended(t) {
            y.copy_from_slice(&self.last.y);
            return;
        }
        let s = self.last.part(t);
        let n = y.len() / 2;
        for i in 0..n {
            let [start, end] = [&self.old, &self.state].map(|state| [0, 1, 2].map(|k| state[k][i]));
            (y[i], y[n + i]) = hermite::quintic(start, end, self.last.h, s);
        }
    }

    fn next_size(&self) -> Option<f64> {
        Some(self.h)
    }

    fn boxed(&self) -> Box<dyn Stepper> {
        Box::new(self.clone())
    }
}
