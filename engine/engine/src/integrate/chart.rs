//! Independent coordinates of a mechanism near one position — eq. (10.4).
//!
//! A chart names f functionals η = L (q − q₀) and a basis Z of the motions that the constraints allow at q₀, with
//! L Z = I. The position with given η is where Φ(q, t) = 0 and L (q − q₀) = η; velocities and accelerations follow from
//! η̇ = L q̇ and η̈ = L q̈. In a chart the constraints hold at every stage of an integrator, not only at the ends of steps.

use nalgebra::{DMatrix, DVector, Vector3};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::constraints::rank;
use triad_dynamics::constraints::tangent;
use triad_dynamics::system::natural::Lift;
use triad_linalg::independent_rows;

/// Corrections of positions and velocities below this, relative to the size of the mechanism, are rounding.
const CONSISTENT: f64 = 1e-13;
/// Iterations of the two solutions.
const ITERATIONS: usize = 30;
/// Iterations above which a chart is taken anew at the state in hand.
const WORN: usize = 9;
/// Largest entry of Z above which independent coordinates are chosen anew.
const ILL_CONDITIONED: f64 = 4.0;
/// How far the basis is looked for ahead of a singular position, relative to the size of the mechanism.
const AHEAD: f64 = 1e-3;

/// How the independent coordinates are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// Orthogonal to all that the constraints forbid: L = Zᵀ W with the weights W = diag(1/length² of r, 1 of directors).
    Tangent,
    /// Some of the coordinates q themselves, by pivoting.
    Partition,
}

/// Independent coordinates near one position.
#[derive(Clone, Debug)]
pub struct Chart {
    choice: Choice,
    base: DVector<f64>,
    /// Z, n × f.
    basis: DMatrix<f64>,
    /// L, f × n.
    functionals: DMatrix<f64>,
    /// Places of the independent coordinates in q, if they are some of them.
    chosen: Vec<usize>,
    /// Position and velocity that were lifted last, from which the next search begins.
    q: DVector<f64>,
    q_dot: DVector<f64>,
    eta: DVector<f64>,
    gap: DVector<f64>,
    /// Most iterations of a lift since the chart was taken.
    iterations: usize,
    /// How often coordinates were chosen.
    pub choices: u64,
}

/// Where a search began.
#[derive(Clone, Debug)]
pub struct Mark {
    q: DVector<f64>,
    q_dot: DVector<f64>,
    eta: DVector<f64>,
    iterations: usize,
}

impl Chart {
    /// A chart about the consistent state y at time t. `None` if the motions allowed cannot be told.
    pub fn new(choice: Choice, mechanism: &mut Mechanism, t: f64, y: &[f64]) -> Option<Self> {
        let n = mechanism.system.coordinates;
        mechanism.set_state(t, y);
        let rank = {
            let Mechanism { system, state, elimination, .. } = &mut *mechanism;
            rank::analyze(system, state, elimination, &y[..n])
        };
        let freedoms = 6 * mechanism.system.bodies.len() - rank.rank;
        let mut chart = Self {
            choice,
            base: DVector::zeros(n),
            basis: DMatrix::zeros(n, freedoms),
            functionals: DMatrix::zeros(freedoms, n),
            chosen: Vec::new(),
            q: DVector::from_column_slice(&y[..n]),
            q_dot: DVector::from_column_slice(&y[n..]),
            eta: DVector::zeros(freedoms),
            gap: DVector::zeros(freedoms),
            iterations: 0,
            choices: 0,
        };
        chart.take(mechanism, t, y).then_some(chart)
    }

    /// Number of independent coordinates f.
    pub fn freedoms(&self) -> usize {
        self.basis.ncols()
    }

    /// Whether lifting has become slow: a new chart at the state in hand will be better.
    pub fn is_worn(&self) -> bool {
        self.iterations > WORN
    }

    /// Takes the chart anew at a consistent state. Returns false if the motions allowed there cannot be told.
    pub fn take(&mut self, mechanism: &mut Mechanism, t: f64, y: &[f64]) -> bool {
        let n = mechanism.system.coordinates;
        let Some(basis) = allowed_motions(mechanism, t, y, self.freedoms()) else { return false };
        self.base.copy_from_slice(&y[..n]);
        self.q.copy_from_slice(&y[..n]);
        self.q_dot.copy_from_slice(&y[n..]);
        self.eta.fill(0.0);
        self.iterations = 0;
        match self.choice {
            Choice::Tangent => {
                let weights = weights(mechanism);
                self.basis = basis;
                self.functionals = self.basis.transpose();
                for (mut column, w) in self.functionals.column_iter_mut().zip(weights.iter()) {
                    column *= *w;
                }
                self.choices += 1;
                true
            }
            Choice::Partition => self.partition(&basis),
        }
    }

    /// Keeps the chosen coordinates while they are well conditioned, else chooses others. η counts from zero of q, so
    /// that it stays the same as long as the choice does.
    fn partition(&mut self, basis: &DMatrix<f64>) -> bool {
        let lifted = |chosen: &[usize]| {
            let square = chosen.len() == basis.ncols();
            square.then(|| basis.select_rows(chosen).try_inverse()).flatten().map(|inverse| basis * inverse)
        };
        let kept = lifted(&self.chosen).filter(|z| z.amax() < ILL_CONDITIONED);
        if kept.is_none() {
            self.chosen = independent_rows(basis, 1e-9);
            self.choices += 1;
        }
        let Some(found) = kept.or_else(|| lifted(&self.chosen)) else { return false };
        self.basis = found;
        self.base.fill(0.0);
        self.functionals.fill(0.0);
        for (row, &column) in self.chosen.iter().enumerate() {
            self.functionals[(row, column)] = 1.0;
        }
        self.eta = &self.functionals * &self.q;
        true
    }

    /// x = (η, η̇) of a consistent state.
    pub fn coordinates(&self, y: &[f64], x: &mut [f64]) {
        let n = self.base.len();
        let f = self.freedoms();
        let q = DVector::from_column_slice(&y[..n]) - &self.base;
        let q_dot = DVector::from_column_slice(&y[n..]);
        x[..f].copy_from_slice((&self.functionals * q).as_slice());
        x[f..].copy_from_slice((&self.functionals * q_dot).as_slice());
    }

    /// η̈ = L q̈.
    pub fn accelerations(&self, q_ddot: &[f64], out: &mut [f64]) {
        let product = &self.functionals * DVector::from_column_slice(q_ddot);
        out.copy_from_slice(product.as_slice());
    }

    /// Where the next search begins, to come back to: outputs between steps must not change the run.
    pub fn mark(&self) -> Mark {
        Mark {
            q: self.q.clone(),
            q_dot: self.q_dot.clone(),
            eta: self.eta.clone(),
            iterations: self.iterations,
        }
    }

    /// Goes back to where a search began.
    pub fn come_back(&mut self, mark: Mark) {
        let Mark { q, q_dot, eta, iterations } = mark;
        (self.q, self.q_dot, self.eta, self.iterations) = (q, q_dot, eta, iterations);
    }

    /// Writes the state y with the independent coordinates and velocities x = (η, η̇) at time t. False if there is none
    /// near the last one.
    pub fn lift(&mut self, mechanism: &mut Mechanism, t: f64, x: &[f64], y: &mut [f64]) -> bool {
        let f = self.freedoms();
        let (eta, eta_dot) = x.split_at(f);
        let found = self.lift_position(mechanism, t, eta) && self.lift_velocity(mechanism, eta_dot);
        let n = self.base.len();
        y[..n].copy_from_slice(self.q.as_slice());
        y[n..].copy_from_slice(self.q_dot.as_slice());
        if !found {
            // The next search must not begin where this one was lost.
            self.q.copy_from(&self.base);
            self.eta.fill(0.0);
            if self.choice == Choice::Partition {
                self.iterations = WORN + 1;
            }
        }
        found
    }

    fn lift_position(&mut self, mechanism: &mut Mechanism, t: f64, eta: &[f64]) -> bool {
        let Mechanism { system, state, elimination, .. } = mechanism;
        state.set_time(system, t);
        self.gap.copy_from_slice(eta);
        self.gap -= &self.eta;
        self.q.gemv(1.0, &self.basis, &self.gap, 1.0);
        let mut last = f64::INFINITY;
        for iteration in 0..ITERATIONS {
            state.set_positions(system, self.q.as_slice());
            if iteration % 4 == 0 {
                elimination.linearize(system, state);
            }
            let mut step = elimination.correct_positions(system, state, self.q.as_mut_slice());
            self.gap.copy_from_slice(eta);
            self.gap -= &self.functionals * (&self.q - &self.base);
            self.q.gemv(1.0, &self.basis, &self.gap, 1.0);
            step += self.gap.amax();
            self.iterations = self.iterations.max(iteration);
            let small = step <= CONSISTENT * system.length.max(1.0);
            if small || (iteration > 4 && step > 0.5 * last && step < 1e-9 * system.length.max(1.0)) {
                self.eta.copy_from_slice(eta);
                state.set_positions(system, self.q.as_slice());
                return true;
            }
            if !step.is_finite() || step > 1e3 * system.length.max(1.0) {
                return false;
            }
            last = step;
        }
        false
    }

    fn lift_velocity(&mut self, mechanism: &mut Mechanism, eta_dot: &[f64]) -> bool {
        let Mechanism { system, state, elimination, .. } = mechanism;
        let mut last = f64::INFINITY;
        for iteration in 0..ITERATIONS {
            self.gap.copy_from_slice(eta_dot);
            self.gap.gemv(-1.0, &self.functionals, &self.q_dot, 1.0);
            self.q_dot.gemv(1.0, &self.basis, &self.gap, 1.0);
            state.set_velocities(system, self.q_dot.as_slice());
            let step =
                elimination.correct_velocities(system, state, self.q_dot.as_mut_slice()) + self.gap.amax();
            self.iterations = self.iterations.max(iteration);
            let scale = system.length.max(1.0).max(self.q_dot.amax());
            if step <= CONSISTENT * scale || (iteration > 4 && step > 0.5 * last && step < 1e-9 * scale) {
                return true;
            }
            if !step.is_finite() {
                return false;
            }
            last = step;
        }
        false
    }
}

/// Weights W of the coordinates: places are measured in lengths of the mechanism.
fn weights(mechanism: &Mechanism) -> DVector<f64> {
    let system = &mechanism.system;
    let place = system.length.powi(-2);
    let mut weights = DVector::from_element(system.coordinates, 1.0);
    for body in &system.bodies {
        weights.rows_mut(body.layout.first, 3).fill(place);
    }
    weights
}

/// An orthonormal basis, in the sense of W, of the f motions q̇ that the constraints allow at a state. In a singular
/// position, where they seem to allow more, it is that of the position a little further on.
fn allowed_motions(mechanism: &mut Mechanism, t: f64, y: &[f64], f: usize) -> Option<DMatrix<f64>> {
    let n = mechanism.system.coordinates;
    mechanism.set_state(t, y);
    let mut twists = tangent::twists(&mechanism.system, &mechanism.state, &mut mechanism.elimination);
    if twists.ncols() != f {
        let speed = y[n..].iter().fold(0.0f64, |a, v| a.max(v.abs()));
        if speed > 0.0 {
            let step = AHEAD * mechanism.system.length / speed;
            let mut ahead: Vec<f64> = y[..n].iter().zip(&y[n..]).map(|(q, v)| q + step * v).collect();
            let Mechanism { system, state, elimination, .. } = mechanism;
            for _ in 0..4 {
                state.set_positions(system, &ahead);
                elimination.linearize(system, state);
                elimination.correct_positions(system, state, &mut ahead);
            }
            state.set_positions(system, &ahead);
            twists = tangent::twists(system, state, elimination);
        }
    }
    if twists.ncols() != f {
        return None;
    }
    let mut basis = DMatrix::zeros(n, f);
    let weights = weights(mechanism).map(f64::sqrt);
    let bodies = mechanism.system.bodies.iter().zip(mechanism.state.bodies());
    for (index, (body, state)) in bodies.enumerate() {
        for k in 0..f {
            let part = |at: usize| Vector3::new(twists[(at, k)], twists[(at + 1, k)], twists[(at + 2, k)]);
            let omega = part(6 * index + 3);
            let rate = Lift { r: part(6 * index), e: state.q.e.map(|e| omega.cross(&e)) };
            body.layout.own_numbers(&rate, |column, value| basis[(column, k)] = value * weights[column]);
        }
    }
    let mut basis = basis.qr().q();
    for (mut row, w) in basis.row_iter_mut().zip(weights.iter()) {
        row /= *w;
    }
    Some(basis)
}
