//! Independent coordinates of a mechanism near one position — eq. (10.4).
//!
//! A chart names f functionals η = L (p − p₀) of the numbers p that describe the mechanism, and a basis Z of the motions that
//! the constraints allow at p₀, with L Z = I. The position with given η is where Φ(p, t) = 0 and L (p − p₀) = η; velocities
//! and accelerations follow from η̇ = L ṗ and η̈ = L p̈. In a chart the constraints hold at every stage of an integrator, not
//! only at the ends of steps.

use super::numbers::Numbers;
use nalgebra::{DMatrix, DVector};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::constraints::rank;
use triad_dynamics::constraints::tangent;
use triad_dynamics::newton::{Projectable, Projected, project_positions, project_velocities, rules};
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
    /// Of the coordinates of joints along a tree, orthogonal to all that the constraints forbid: L = Zᵀ W with the weights
    /// W = diag(1/length² of slides, 1 of angles).
    Tangent,
    /// Some of the coordinates q themselves, by pivoting.
    Partition,
}

/// Independent coordinates near one position.
#[derive(Clone, Debug)]
pub struct Chart {
    numbers: Numbers,
    /// p₀.
    base: DVector<f64>,
    /// Z, n × f.
    basis: DMatrix<f64>,
    /// L, f × n.
    functionals: DMatrix<f64>,
    /// Places of the independent coordinates in q, if they are some of them.
    chosen: Vec<usize>,
    /// How often coordinates were chosen.
    pub choices: u64,
    /// What η or η̇ still differ by.
    gap: DVector<f64>,
    /// A correction of p, or p̈.
    change: DVector<f64>,
}

/// The state from which the search for the next one begins: the one that was found last.
#[derive(Clone, Debug)]
pub struct Guess {
    p: DVector<f64>,
    p_dot: DVector<f64>,
    eta: DVector<f64>,
    /// Where the chart was taken: p and η.
    taken: (DVector<f64>, DVector<f64>),
    /// Most iterations of a search since the chart was taken.
    iterations: usize,
}

impl Guess {
    /// Takes over all that another one of the same chart has found.
    pub fn copy_from(&mut self, other: &Self) {
        self.p.copy_from(&other.p);
        self.p_dot.copy_from(&other.p_dot);
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
        self.p.copy_from(&self.taken.0);
        self.eta.copy_from(&self.taken.1);
        self.iterations = usize::MAX;
    }

    /// Remembers how many times a search went on.
    fn note(&mut self, projected: Projected) {
        self.iterations = self.iterations.max(projected.corrections.saturating_sub(1));
    }
}

impl Chart {
    /// Number of independent coordinates near a consistent state y at time t.
    pub fn freedoms_at(mechanism: &mut Mechanism, t: f64, y: &[f64]) -> usize {
        mechanism.set_state(t, y);
        let q = &y[..mechanism.system.coordinates];
        6 * mechanism.system.bodies.len() - rank::analyze(&mechanism.system, &mut mechanism.state, q).rank
    }

    /// A chart about the consistent state y at time t, with the guess to begin from. `None` if the motions that the
    /// constraints allow cannot be determined.
    pub fn new(
        choice: IndependentCoordinates,
        mechanism: &mut Mechanism,
        t: f64,
        y: &[f64],
    ) -> Option<(Self, Guess)> {
        mechanism.set_state(t, y);
        let mut numbers = match choice {
            IndependentCoordinates::Tangent => Numbers::joints(mechanism),
            IndependentCoordinates::Partition => Numbers::Coordinates,
        };
        let n = numbers.count(mechanism);
        let (mut p, mut p_dot) = (DVector::zeros(n), DVector::zeros(n));
        numbers.read(mechanism, y, p.as_mut_slice(), p_dot.as_mut_slice());
        let freedoms = Self::freedoms_at(mechanism, t, y);
        let mut chart = Self {
            numbers,
            base: DVector::zeros(n),
            basis: DMatrix::zeros(n, freedoms),
            functionals: DMatrix::zeros(freedoms, n),
            chosen: Vec::new(),
            choices: 0,
            gap: DVector::zeros(freedoms),
            change: DVector::zeros(n),
        };
        let eta = DVector::zeros(freedoms);
        let mut guess = Guess { taken: (p.clone(), eta.clone()), p, p_dot, eta, iterations: 0 };
        chart.take(mechanism, t, y, &mut guess).then_some((chart, guess))
    }

    /// Whether searches have become slow, or angles large: a new chart at the current state will be better.
    pub fn needs_refresh(&self, guess: &Guess) -> bool {
        guess.iterations > SLOW || self.numbers.is_tilted(guess.p.as_slice())
    }

    /// Number of independent coordinates f.
    pub fn freedoms(&self) -> usize {
        self.basis.ncols()
    }

    /// Whether the numbers place the mechanism by themselves: no constraint is left to be solved.
    fn is_open(&self) -> bool {
        self.basis.nrows() == self.basis.ncols() && matches!(self.numbers, Numbers::Joints { .. })
    }

    /// Takes the chart anew at a consistent state, where the guess is. Returns false if the motions that the constraints allow
    /// there cannot be determined.
    pub fn take(&mut self, mechanism: &mut Mechanism, t: f64, y: &[f64], guess: &mut Guess) -> bool {
        if self.numbers.is_tilted(guess.p.as_slice()) {
            self.numbers.restart(guess.p.as_mut_slice(), guess.p_dot.as_mut_slice());
            self.functionals.fill(0.0);
        }
        self.numbers.commit(guess.p.as_slice());
        let Some(basis) = self.allowed_motions(mechanism, t, y, guess) else { return false };
        guess.iterations = 0;
        let taken = match self.numbers {
            Numbers::Joints { .. } => {
                self.tilt(mechanism, basis, guess);
                true
            }
            Numbers::Coordinates => self.partition(&basis, guess),
        };
        guess.taken.0.copy_from(&guess.p);
        guess.taken.1.copy_from(&guess.eta);
        taken
    }

    /// Keeps L and p₀, and with them the coordinates, while the new basis is not tilted much against the old one; else takes
    /// those of the new position.
    fn tilt(&mut self, mechanism: &Mechanism, basis: DMatrix<f64>, guess: &mut Guess) {
        let tilted = if self.choices > 0 { (&self.functionals * &basis).try_inverse() } else { None };
        if let Some(back) = tilted.filter(|back| back.amax() < TILTED) {
            self.basis = basis * back;
            guess.eta = &self.functionals * (&guess.p - &self.base);
            return;
        }
        let weights = self.numbers.weights(mechanism);
        self.functionals = basis.transpose();
        for (mut column, w) in self.functionals.column_iter_mut().zip(weights.iter()) {
            column *= *w;
        }
        self.basis = basis;
        self.base.copy_from(&guess.p);
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
        guess.eta = &self.functionals * &guess.p;
        true
    }

    /// x = (η, η̇) of what was found.
    pub fn coordinates(&self, found: &Guess, x: &mut [f64]) {
        let f = self.freedoms();
        x[..f].copy_from_slice((&self.functionals * (&found.p - &self.base)).as_slice());
        x[f..].copy_from_slice((&self.functionals * &found.p_dot).as_slice());
    }

    /// The same of what another chart had found, before it was taken anew.
    pub fn translate(&self, before: &Self, found: &Guess) -> Vec<f64> {
        let mut found = found.clone();
        self.numbers.translate(&before.numbers, found.p.as_mut_slice(), found.p_dot.as_mut_slice());
        let mut x = vec![0.0; 2 * self.freedoms()];
        self.coordinates(&found, &mut x);
        x
    }

    /// Counts whole turns from what was found.
    pub fn commit(&mut self, found: &Guess) {
        self.numbers.commit(found.p.as_slice());
    }

    /// Writes η̈ = L p̈ at the state in place, which is the guess; `moved` says that the positions are others than last time.
    pub fn accelerate(&mut self, mechanism: &mut Mechanism, guess: &Guess, moved: bool, out: &mut [f64]) {
        self.numbers.accelerate(mechanism, &guess.p_dot, moved, &mut self.change);
        self.gap.gemv(1.0, &self.functionals, &self.change, 0.0);
        out.copy_from_slice(self.gap.as_slice());
    }

    /// Puts the mechanism into the state with the independent coordinates and velocities x = (η, η̇) at time t, and keeps it
    /// as the next guess. False if there is none near the guess.
    pub fn find_state(&mut self, mechanism: &mut Mechanism, t: f64, x: &[f64], guess: &mut Guess) -> bool {
        let (eta, eta_dot) = x.split_at(self.freedoms());
        let Mechanism { system, state, .. } = mechanism;
        state.set_time(system, t);
        let found =
            self.find_position(mechanism, eta, guess) && self.find_velocity(mechanism, eta_dot, guess);
        if !found {
            guess.go_back();
        }
        found
    }

    /// Puts the mechanism between what was found at the start of a step and at stages, by the weight of each: on the polynomial
    /// through them, not on the constraints. False if that is too far away.
    pub fn place_between<'a>(
        &mut self,
        mechanism: &mut Mechanism,
        start: &Guess,
        stages: impl Iterator<Item = (f64, &'a Guess)>,
    ) -> bool {
        let (mut p, mut p_dot) = (start.p.clone(), start.p_dot.clone());
        for (weight, stage) in stages {
            p += (&stage.p - &start.p) * weight;
            p_dot += (&stage.p_dot - &start.p_dot) * weight;
        }
        let placed = self.numbers.place(mechanism, p.as_slice());
        self.numbers.move_at(mechanism, p_dot.as_slice());
        placed
    }

    /// Φ(p, t) = 0 with L (p − p₀) = η, from the last position and Z times the change of η — eq. (10.4).
    fn find_position(&mut self, mechanism: &mut Mechanism, eta: &[f64], guess: &mut Guess) -> bool {
        if self.is_open() {
            guess.eta.copy_from_slice(eta);
            guess.p.copy_from(&self.base);
            guess.p.gemv(1.0, &self.basis, &guess.eta, 1.0);
            return self.numbers.place(mechanism, guess.p.as_slice());
        }
        self.gap.copy_from_slice(eta);
        self.gap -= &guess.eta;
        guess.p.gemv(1.0, &self.basis, &self.gap, 1.0);
        if !self.numbers.place(mechanism, guess.p.as_slice()) {
            return false;
        }
        let size = mechanism.system.length.max(1.0);
        let mut on = AtCoordinates { chart: self, mechanism, guess, wanted: eta };
        let projected = project_positions(&mut on, &rules::CHART_POSITIONS, size);
        guess.note(projected);
        if projected.has_converged() {
            guess.eta.copy_from_slice(eta);
        }
        projected.has_converged()
    }

    /// Φ_p ṗ = ν with L ṗ = η̇, at the position in place — eq. (10.4).
    pub fn find_velocity(&mut self, mechanism: &mut Mechanism, eta_dot: &[f64], guess: &mut Guess) -> bool {
        if self.is_open() {
            self.gap.copy_from_slice(eta_dot);
            guess.p_dot.gemv(1.0, &self.basis, &self.gap, 0.0);
            self.numbers.move_at(mechanism, guess.p_dot.as_slice());
            return true;
        }
        let mut on = AtCoordinates { chart: self, mechanism, guess, wanted: eta_dot };
        let projected = project_velocities(&mut on, &rules::CHART_VELOCITIES, 1.0);
        guess.note(projected);
        self.numbers.move_at(mechanism, guess.p_dot.as_slice());
        projected.has_converged()
    }

    /// An orthonormal basis, in the sense of W, of the f motions ṗ that the constraints allow at a state. In a singular
    /// position, where they seem to allow more, it is that of the position a little further on.
    fn allowed_motions(
        &mut self,
        mechanism: &mut Mechanism,
        t: f64,
        y: &[f64],
        guess: &Guess,
    ) -> Option<DMatrix<f64>> {
        let (n, f) = (mechanism.system.coordinates, self.freedoms());
        mechanism.set_state(t, y);
        if !self.numbers.place(mechanism, guess.p.as_slice()) {
            return None;
        }
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
        let weights = self.numbers.weights(mechanism).map(f64::sqrt);
        let mut basis = self.numbers.columns(mechanism, &twists);
        for (mut row, w) in basis.row_iter_mut().zip(weights.iter()) {
            row *= *w;
        }
        let mut basis = basis.qr().q();
        for (mut row, w) in basis.row_iter_mut().zip(weights.iter()) {
            row /= *w;
        }
        Some(basis)
    }
}

/// A guess that is moved onto the constraints and to given η, or η̇, in turn — eq. (10.4).
struct AtCoordinates<'a> {
    chart: &'a mut Chart,
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

    /// p ← p + Δp, then p ← p + Z (η − L (p − p₀)); the sizes of both together.
    fn correct_positions(&mut self) -> f64 {
        let Self { chart, mechanism, guess, wanted } = self;
        let Chart { numbers, base, basis, functionals, gap, change, .. } = &mut **chart;
        let step = numbers.correct_positions(mechanism, &mut guess.p, change);
        gap.copy_from_slice(wanted);
        *gap -= &*functionals * (&guess.p - &*base);
        guess.p.gemv(1.0, basis, gap, 1.0);
        if !numbers.place(mechanism, guess.p.as_slice()) {
            return f64::NAN;
        }
        step + gap.amax()
    }

    /// ṗ ← ṗ + Z (η̇ − L ṗ), then ṗ ← ṗ + Δṗ, which the state has not taken over yet; the sizes of both together, relative to
    /// the fastest.
    fn correct_velocities(&mut self) -> f64 {
        let Self { chart, mechanism, guess, wanted } = self;
        let Chart { numbers, basis, functionals, gap, change, .. } = &mut **chart;
        gap.copy_from_slice(wanted);
        gap.gemv(-1.0, functionals, &guess.p_dot, 1.0);
        guess.p_dot.gemv(1.0, basis, gap, 1.0);
        numbers.move_at(mechanism, guess.p_dot.as_slice());
        let step = numbers.correct_velocities(mechanism, &mut guess.p_dot, change) + gap.amax();
        step / mechanism.system.length.max(1.0).max(guess.p_dot.amax())
    }
}
