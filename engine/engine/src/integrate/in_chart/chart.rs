//! Independent coordinates of a mechanism near one position — eq. (10.4).
//!
//! A chart names f functionals η = L (q − q₀) and a basis Z of the motions that the constraints allow at q₀, with
//! L Z = I. The position with given η is where Φ(q, t) = 0 and L (q − q₀) = η; velocities and accelerations follow from
//! η̇ = L q̇ and η̈ = L q̈. In a chart the constraints hold at every stage of an integrator, not only at the ends of steps.

use nalgebra::{DMatrix, DVector, Vector3};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::constraints::rank;
use triad_dynamics::constraints::tangent;
use triad_dynamics::newton::{Projectable, Projected, project_positions, project_velocities, rules};
use triad_dynamics::system::natural::NaturalCoordinates;
use triad_linalg::independent_rows;

/// Iterations of one solution above which the chart is taken anew at the current state.
const SLOW: usize = 9;
/// Largest entry of Z above which other independent coordinates are chosen.
const ILL_CONDITIONED: f64 = 4.0;
/// Largest entry of (L Z)⁻¹ above which tangent coordinates are taken anew: the chart is tilted by 34 degrees then.
const TILTED: f64 = 1.2;
/// Pivot of a row of the basis, relative to the largest, below which it depends on the rows that are chosen.
const DEPENDENT: f64 = 1e-9;
/// Distance beyond a singular configuration at which the basis is taken instead, in lengths of the mechanism.
const AHEAD: f64 = 1e-3;

/// How the independent coordinates are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IndependentCoordinates {
    /// Orthogonal to all that the constraints forbid: L = Zᵀ W with the weights W = diag(1/length² of r, 1 of directors).
    Tangent,
    /// Some of the coordinates q themselves, by pivoting.
    Partition,
}

/// Independent coordinates near one position.
#[derive(Clone, Debug)]
pub struct Chart {
    choice: IndependentCoordinates,
    /// q₀.
    base: DVector<f64>,
    /// Z, n × f.
    basis: DMatrix<f64>,
    /// L, f × n.
    functionals: DMatrix<f64>,
    /// Places of the independent coordinates in q, if they are some of them.
    chosen: Vec<usize>,
    /// How often coordinates were chosen.
    pub choices: u64,
}

/// The state from which the search for the next one begins: the one that was found last.
#[derive(Clone, Debug)]
pub struct Guess {
    q: DVector<f64>,
    q_dot: DVector<f64>,
    eta: DVector<f64>,
    /// Where the chart was taken: q and η.
    taken: (DVector<f64>, DVector<f64>),
    /// What η or η̇ still differ by.
    gap: DVector<f64>,
    /// Most iterations of a search since the chart was taken.
    iterations: usize,
}

impl Guess {
    /// Takes over all that another one of the same chart has found.
    pub fn copy_from(&mut self, other: &Self) {
        self.q.copy_from(&other.q);
        self.q_dot.copy_from(&other.q_dot);
        self.eta.copy_from(&other.eta);
        self.taken.0.copy_from(&other.taken.0);
        self.taken.1.copy_from(&other.taken.1);
        self.iterations = other.iterations;
    }

    /// Is as slow as another one of the same chart.
    pub fn share_slowness(&mut self, other: &Self) {
        self.iterations = self.iterations.max(other.iterations);
    }

    /// Goes back to where the chart was taken: the next search must not begin where this one was lost.
    fn go_back(&mut self) {
        self.q.copy_from(&self.taken.0);
        self.eta.copy_from(&self.taken.1);
        self.iterations = usize::MAX;
    }

    /// Remembers how many times a search went on.
    fn note(&mut self, projected: Projected) {
        self.iterations = self.iterations.max(projected.corrections.saturating_sub(1));
    }
}

impl Chart {
    /// A chart about the consistent state y at time t, with the guess to begin from. `None` if the motions that the
    /// constraints allow cannot be determined.
    pub fn new(
        choice: IndependentCoordinates,
        mechanism: &mut Mechanism,
        t: f64,
        y: &[f64],
    ) -> Option<(Self, Guess)> {
        let n = mechanism.system.coordinates;
        mechanism.set_state(t, y);
        let rank = rank::analyze(&mechanism.system, &mut mechanism.state, &y[..n]);
        let freedoms = 6 * mechanism.system.bodies.len() - rank.rank;
        let mut chart = Self {
            choice,
            base: DVector::zeros(n),
            basis: DMatrix::zeros(n, freedoms),
            functionals: DMatrix::zeros(freedoms, n),
            chosen: Vec::new(),
            choices: 0,
        };
        let mut guess = Guess {
            q: DVector::from_column_slice(&y[..n]),
            q_dot: DVector::from_column_slice(&y[n..]),
            eta: DVector::zeros(freedoms),
            taken: (DVector::zeros(n), DVector::zeros(freedoms)),
            gap: DVector::zeros(freedoms),
            iterations: 0,
        };
        chart.take(mechanism, t, y, &mut guess).then_some((chart, guess))
    }

    /// Whether searches have become slow: a new chart at the current state will be better.
    pub fn needs_refresh(&self, guess: &Guess) -> bool {
        guess.iterations > SLOW
    }

    /// Number of independent coordinates f.
    pub fn freedoms(&self) -> usize {
        self.basis.ncols()
    }

    /// Takes the chart anew at a consistent state. Returns false if the motions that the constraints allow there cannot be
    /// determined.
    pub fn take(&mut self, mechanism: &mut Mechanism, t: f64, y: &[f64], guess: &mut Guess) -> bool {
        let n = mechanism.system.coordinates;
        let Some(basis) = allowed_motions(mechanism, t, y, self.freedoms()) else { return false };
        guess.q.copy_from_slice(&y[..n]);
        guess.q_dot.copy_from_slice(&y[n..]);
        guess.iterations = 0;
        let taken = match self.choice {
            IndependentCoordinates::Tangent => {
                self.tilt(mechanism, basis, guess);
                true
            }
            IndependentCoordinates::Partition => self.partition(&basis, guess),
        };
        guess.taken.0.copy_from(&guess.q);
        guess.taken.1.copy_from(&guess.eta);
        taken
    }

    /// Keeps L and q₀, and with them the coordinates, while the new basis is not tilted much against the old one; else takes
    /// those of the new position.
    fn tilt(&mut self, mechanism: &Mechanism, basis: DMatrix<f64>, guess: &mut Guess) {
        let tilted = if self.choices > 0 { (&self.functionals * &basis).try_inverse() } else { None };
        if let Some(back) = tilted.filter(|back| back.amax() < TILTED) {
            self.basis = basis * back;
            guess.eta = &self.functionals * (&guess.q - &self.base);
            return;
        }
        let weights = weights(mechanism);
        self.functionals = basis.transpose();
        for (mut column, w) in self.functionals.column_iter_mut().zip(weights.iter()) {
            column *= *w;
        }
        self.basis = basis;
        self.base.copy_from(&guess.q);
        guess.eta.fill(0.0);
        self.choices += 1;
    }

    /// Keeps the chosen coordinates while they are well conditioned, else chooses others. η counts from zero of q, so
    /// that it stays the same as long as the choice does.
    fn partition(&mut self, basis: &DMatrix<f64>, guess: &mut Guess) -> bool {
        let solved = |chosen: &[usize]| {
            let square = chosen.len() == basis.ncols();
            square.then(|| basis.select_rows(chosen).try_inverse()).flatten().map(|inverse| basis * inverse)
        };
        let kept = solved(&self.chosen).filter(|z| z.amax() < ILL_CONDITIONED);
        if kept.is_none() {
            self.chosen = independent_rows(basis, DEPENDENT);
            self.choices += 1;
        }
        let Some(found) = kept.or_else(|| solved(&self.chosen)) else { return false };
        self.basis = found;
        self.base.fill(0.0);
        self.functionals.fill(0.0);
        for (row, &column) in self.chosen.iter().enumerate() {
            self.functionals[(row, column)] = 1.0;
        }
        guess.eta = &self.functionals * &guess.q;
        true
    }

    /// x = (η, η̇) of what was found.
    pub fn coordinates_of(&self, found: &Guess) -> Vec<f64> {
        let mut x = vec![0.0; 2 * self.freedoms()];
        let y: Vec<f64> = found.q.iter().chain(&found.q_dot).copied().collect();
        self.coordinates(&y, &mut x);
        x
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

    /// Writes the state y with the independent coordinates and velocities x = (η, η̇) at time t, and keeps it as the next
    /// guess. False if there is none near the guess.
    pub fn find_state(
        &self,
        mechanism: &mut Mechanism,
        t: f64,
        x: &[f64],
        guess: &mut Guess,
        y: &mut [f64],
    ) -> bool {
        let (eta, eta_dot) = x.split_at(self.freedoms());
        let found =
            self.find_position(mechanism, t, eta, guess) && self.find_velocity(mechanism, eta_dot, guess);
        let n = self.base.len();
        y[..n].copy_from_slice(guess.q.as_slice());
        y[n..].copy_from_slice(guess.q_dot.as_slice());
        if !found {
            guess.go_back();
        }
        found
    }

    /// Φ(q, t) = 0 with L (q − q₀) = η, from the last position and Z times the change of η — eq. (10.4).
    fn find_position(&self, mechanism: &mut Mechanism, t: f64, eta: &[f64], guess: &mut Guess) -> bool {
        let Mechanism { system, state, .. } = mechanism;
        let Guess { q, eta: known, gap, .. } = guess;
        state.set_time(system, t);
        gap.copy_from_slice(eta);
        *gap -= &*known;
        q.gemv(1.0, &self.basis, gap, 1.0);
        state.set_positions(system, q.as_slice());
        let size = system.length.max(1.0);
        let mut on = AtCoordinates { chart: self, mechanism, guess, wanted: eta };
        let projected = project_positions(&mut on, &rules::CHART_POSITIONS, size);
        guess.note(projected);
        if projected.has_converged() {
            guess.eta.copy_from_slice(eta);
        }
        projected.has_converged()
    }

    /// Φ_q q̇ = ν with L q̇ = η̇ — eq. (10.4).
    fn find_velocity(&self, mechanism: &mut Mechanism, eta_dot: &[f64], guess: &mut Guess) -> bool {
        let mut on = AtCoordinates { chart: self, mechanism, guess, wanted: eta_dot };
        let projected = project_velocities(&mut on, &rules::CHART_VELOCITIES, 1.0);
        guess.note(projected);
        projected.has_converged()
    }
}

/// A guess that is moved onto the constraints and to given η, or η̇, in turn — eq. (10.4).
struct AtCoordinates<'a> {
    chart: &'a Chart,
    mechanism: &'a mut Mechanism,
    guess: &'a mut Guess,
    /// η, or η̇.
    wanted: &'a [f64],
}

impl Projectable for AtCoordinates<'_> {
    fn linearize(&mut self) {
        let Mechanism { system, state, elimination, .. } = &mut *self.mechanism;
        elimination.linearize(system, state);
    }

    /// q ← q + Δq, then q ← q + Z (η − L (q − q₀)); the sizes of both together.
    fn correct_positions(&mut self) -> f64 {
        let Mechanism { system, state, elimination, .. } = &mut *self.mechanism;
        let Guess { q, gap, .. } = &mut *self.guess;
        let step = elimination.correct_positions(system, state, q.as_mut_slice());
        gap.copy_from_slice(self.wanted);
        *gap -= &self.chart.functionals * (&*q - &self.chart.base);
        q.gemv(1.0, &self.chart.basis, gap, 1.0);
        state.set_positions(system, q.as_slice());
        step + gap.amax()
    }

    /// q̇ ← q̇ + Z (η̇ − L q̇), then q̇ ← q̇ + Δq̇, which the state has not taken over yet; the sizes of both together, relative to
    /// the fastest.
    fn correct_velocities(&mut self) -> f64 {
        let Mechanism { system, state, elimination, .. } = &mut *self.mechanism;
        let Guess { q_dot, gap, .. } = &mut *self.guess;
        gap.copy_from_slice(self.wanted);
        gap.gemv(-1.0, &self.chart.functionals, q_dot, 1.0);
        q_dot.gemv(1.0, &self.chart.basis, gap, 1.0);
        state.set_velocities(system, q_dot.as_slice());
        let step = elimination.correct_velocities(system, state, q_dot.as_mut_slice()) + gap.amax();
        step / system.length.max(1.0).max(q_dot.amax())
    }
}

/// Weights W of the coordinates: places are measured in lengths of the mechanism.
fn weights(mechanism: &Mechanism) -> DVector<f64> {
    let system = &mechanism.system;
    let place = 1.0 / (system.length * system.length);
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
            let mut ahead = y.to_vec();
            ahead.iter_mut().zip(&y[n..]).for_each(|(q, v)| *q += step * v);
            mechanism.state.set_positions(&mechanism.system, &ahead[..n]);
            let length = mechanism.system.length;
            project_positions(&mut mechanism.projectable(&mut ahead), &rules::AHEAD_POSITIONS, length);
            twists = tangent::twists(&mechanism.system, &mechanism.state, &mut mechanism.elimination);
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
            let rate = NaturalCoordinates { r: part(6 * index), e: state.q.e.map(|e| omega.cross(&e)) };
            body.layout.own_numbers(&rate, |column, value| basis[(column, k)] = value * weights[column]);
        }
    }
    let mut basis = basis.qr().q();
    for (mut row, w) in basis.row_iter_mut().zip(weights.iter()) {
        row /= *w;
    }
    Some(basis)
}
