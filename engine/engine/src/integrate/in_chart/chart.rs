//! Independent coordinates of a mechanism near one position — eq. (10.4).
//!
//! A chart names f functionals η = L (p − p₀) of the numbers p that describe the mechanism, and a basis Z of the motions that
//! the constraints allow at p₀, with L Z = I. The position with given η is where Φ(p, t) = 0 and L (p − p₀) = η; velocities
//! and accelerations follow from η̇ = L ṗ and η̈ = L p̈. In a chart the constraints hold at every stage of an integrator, not
//! only at the ends of steps.

mod many;
mod search;

use super::guess::Guess;
use super::numbers::Numbers;
use super::tilt::{Search, Tilt};
use nalgebra::{DMatrix, DVector};
use search::AtCoordinates;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::constraints::rank;
use triad_dynamics::constraints::tangent;
use triad_dynamics::newton::{project_positions, project_velocities, rules};
use triad_linalg::{independent_rows, largest_size};

/// Iterations of one solution above which the chart is taken anew at the current state.
const SLOW: usize = 9;
/// Largest entry of Z above which other independent coordinates are chosen, and below which none are looked for. In between others
/// are chosen if they make it less by this factor: of a body that turns one is always near to one, and what a chart with a
/// large one foresees reaches less far than a step.
const ILL_CONDITIONED: f64 = 4.0;
const WELL_CONDITIONED: f64 = 1.3;
const BETTER: f64 = 0.8;
/// Part of the tolerance that a step in a partition may use of it, measured by its few independent coordinates: then errors are those of
/// the same method with projection.
const PART_OF_TOLERANCE: f64 = 0.1;
/// How much farther than foreseen a position may be found, as a factor, and in lengths of the mechanism.
const FARTHER: f64 = 3.0;
const NEAR: f64 = 1e-7;
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
    /// What the coordinates are of.
    pub numbers: Numbers,
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
    search: Search,
    /// Where the search for p began.
    start: DVector<f64>,
    /// A correction of p, or p̈.
    change: DVector<f64>,
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
            search: Search::new(freedoms),
            start: DVector::zeros(n),
            change: DVector::zeros(n),
        };
        let eta = DVector::zeros(freedoms);
        let tilt = Tilt::new(if chart.is_open() { 0 } else { freedoms });
        let mut guess = Guess { taken: (p.clone(), eta.clone()), p, p_dot, eta, iterations: 0, tilt };
        chart.take(mechanism, t, y, &mut guess).then_some((chart, guess))
    }

    /// Whether searches have become slow, or angles large: a new chart at the current state will be better.
    pub fn needs_refresh(&self, guess: &Guess) -> bool {
        let steep = !self.chosen.is_empty() && guess.tilt.is_steep(WELL_CONDITIONED);
        steep || guess.iterations > SLOW || self.numbers.is_tilted(guess.p.as_slice())
    }

    /// By how much errors of (η, η̇) are magnified in what was found, for methods that measure them by η alone.
    pub fn magnification(&self, found: &Guess) -> f64 {
        match self.numbers {
            Numbers::Joints { .. } => 1.0,
            Numbers::Coordinates => found.tilt.steepness(&self.basis) / PART_OF_TOLERANCE,
        }
    }

    /// Number of independent coordinates f.
    pub fn freedoms(&self) -> usize {
        self.basis.ncols()
    }

    /// Whether the numbers place the mechanism by themselves: no constraint is left to be solved. Z and L are diagonal then.
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
        guess.tilt.forget();
        let taken = match self.numbers {
            Numbers::Joints { .. } => {
                self.tilt(mechanism, basis, guess);
                true
            }
            Numbers::Coordinates => self.partition(&basis, guess),
        };
        guess.settle_here();
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
        let kept = solved(&self.chosen);
        let largest = kept.as_ref().map_or(f64::INFINITY, DMatrix::amax);
        if largest < WELL_CONDITIONED
            && let Some(kept) = kept
        {
            self.basis = kept;
        } else {
            let chosen = independent_rows(basis, DEPENDENT);
            let Some(found) = solved(&chosen) else { return false };
            if let Some(kept) = kept.filter(|_| largest < ILL_CONDITIONED && found.amax() > BETTER * largest)
            {
                self.basis = kept;
            } else {
                (self.chosen, self.basis) = (chosen, found);
                self.choices += 1;
            }
        }
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

    /// Whether numbers η mean the same in another chart.
    pub fn is_same(&self, other: &Self) -> bool {
        self.base == other.base
            && self.functionals == other.functionals
            && self.numbers.is_same(&other.numbers)
    }

    /// A copy for a run that has used another chart of the same kind, `before`: takes what that had found, and writes its x = (η, η̇).
    pub fn adopted(&self, before: &Self, found: &mut Guess, x: &mut [f64]) -> Option<Self> {
        if !self.numbers.is_alike(&before.numbers) || self.freedoms() != before.freedoms() {
            return None;
        }
        self.numbers.translate(&before.numbers, found.p.as_mut_slice(), found.p_dot.as_mut_slice());
        self.coordinates(found, x);
        found.eta.copy_from_slice(&x[..self.freedoms()]);
        found.settle_here();
        found.iterations = 0;
        found.tilt.forget();
        Some(self.clone())
    }

    /// Counts whole turns from what was found.
    pub fn commit(&mut self, found: &Guess) {
        self.numbers.commit(found.p.as_slice());
    }

    /// Says at time t which angles of joints belong to what was found there, for a state that is set without the chart.
    pub fn tell(&self, mechanism: &mut Mechanism, t: f64, found: &Guess) {
        let Mechanism { system, state, .. } = &mut *mechanism;
        state.set_time(system, t);
        self.numbers.tell(mechanism, found.p.as_slice());
    }

    /// Writes η̈ = L p̈ at the state in place, which is the guess; `moved` says that the positions are others than last time.
    pub fn accelerate(&mut self, mechanism: &mut Mechanism, guess: &Guess, moved: bool, out: &mut [f64]) {
        self.numbers.accelerate(mechanism, &guess.p_dot, moved, &mut self.change);
        if self.is_open() {
            for (i, out) in out.iter_mut().enumerate() {
                *out = self.functionals[(i, i)] * self.change[i];
            }
            return;
        }
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
            for (i, eta) in eta.iter().enumerate() {
                guess.p[i] = self.base[i] + self.basis[(i, i)] * eta;
            }
            return self.numbers.place(mechanism, guess.p.as_slice());
        }
        self.gap.copy_from_slice(eta);
        self.gap -= &guess.eta;
        self.search.ask(&guess.tilt, &self.gap);
        self.search.from.copy_from(&guess.eta);
        self.start.copy_from(&guess.p);
        guess.p.gemv(1.0, &self.basis, &self.search.asked, 1.0);
        let foreseen = self.start.metric_distance(&guess.p);
        if !self.numbers.place(mechanism, guess.p.as_slice()) {
            return false;
        }
        let size = mechanism.system.length.max(1.0);
        let mut on =
            AtCoordinates { chart: self, mechanism: &mut *mechanism, guess: &mut *guess, wanted: eta };
        let projected = project_positions(&mut on, &rules::CHART_POSITIONS, size);
        guess.note(projected);
        // What lies much farther away than the tangent says is on another branch, unless drivers have moved it.
        let driven = !mechanism.system.model.drivers.is_empty();
        let near = driven || self.start.metric_distance(&guess.p) < FARTHER * foreseen + NEAR * size;
        let found = projected.has_converged() && near;
        if found {
            guess.eta.copy_from_slice(eta);
        }
        found
    }

    /// Φ_p ṗ = ν with L ṗ = η̇, at the position in place — eq. (10.4).
    pub fn find_velocity(&mut self, mechanism: &mut Mechanism, eta_dot: &[f64], guess: &mut Guess) -> bool {
        if self.is_open() {
            for (i, eta_dot) in eta_dot.iter().enumerate() {
                guess.p_dot[i] = self.basis[(i, i)] * eta_dot;
            }
            self.numbers.move_at(mechanism, guess.p_dot.as_slice());
            return true;
        }
        let mut on = AtCoordinates { chart: self, mechanism, guess, wanted: eta_dot };
        // The first correction also takes out what the last velocities violate here.
        on.chart.search.mixed = true;
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
        if self.is_open() {
            // Each coordinate by itself.
            let weights = self.numbers.weights(mechanism);
            return Some(DMatrix::from_diagonal(&weights.map(|w| 1.0 / w.sqrt())));
        }
        let mut twists = tangent::twists(&mechanism.system, &mechanism.state, &mut mechanism.elimination);
        if twists.ncols() != f {
            let speed = largest_size(&y[n..]);
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
