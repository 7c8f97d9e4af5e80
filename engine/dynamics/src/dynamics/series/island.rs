//! The series of one island, bundled as suits its number of bodies: the one place where the kernels are compiled.

use super::{Planar, Series, SeriesStep, Single, StepPlan};
use crate::dynamics::elimination::Counters;
use crate::newton::Projectable;
use crate::system::System;
use crate::system::index::SolverRow;
use nalgebra::Vector3;
use pulp::Arch;

/// The series, bundled as suits the number of bodies.
#[derive(Clone, Debug)]
enum Bundled {
    /// One body.
    Narrow(Box<Series<1, Single>>),
    /// Several.
    Wide(Box<Series<4>>),
    /// One body in a plane.
    NarrowPlanar(Box<Series<1, Planar<1>>>),
    /// Several bodies in a plane.
    WidePlanar(Box<Series<4, Planar<4>>>),
}

/// Runs `$call` with `$series` bound to the series.
macro_rules! with {
    ($island:expr, $series:ident => $call:expr) => {
        match $island {
            Bundled::Narrow($series) => $call,
            Bundled::Wide($series) => $call,
            Bundled::NarrowPlanar($series) => $call,
            Bundled::WidePlanar($series) => $call,
        }
    };
}

/// The series of one island.
#[derive(Clone, Debug)]
pub struct IslandSeries(Bundled);

impl IslandSeries {
    /// Allocates for motion in space, and coefficients up to order `order`; `turns` are the angles of joints at the start.
    pub fn in_space(system: &System, order: usize, turns: &[f64]) -> Self {
        Self(match system.bodies.len() {
            1 => Bundled::Narrow(Box::new(Series::single(system, order, turns))),
            _ => Bundled::Wide(Box::new(Series::new(system, order, turns))),
        })
    }

    /// The same for motion in a plane, of a system that has been reduced to it.
    pub fn in_plane(flat: &System, order: usize, turns: &[f64]) -> Self {
        Self(match flat.bodies.len() {
            1 => Bundled::NarrowPlanar(Box::new(Series::planar(flat, order, turns))),
            _ => Bundled::WidePlanar(Box::new(Series::planar(flat, order, turns))),
        })
    }

    /// From now on uses such instructions, and not what the processor has; before it carries errors or evaluates inside steps.
    pub fn restrict(&mut self, instructions: Arch) {
        with!(&mut self.0, s => s.restrict(instructions));
    }

    /// Whether it moves in a plane.
    pub fn is_planar(&self) -> bool {
        matches!(self.0, Bundled::NarrowPlanar(_) | Bundled::WidePlanar(_))
    }

    /// Whether entries of the matrix that never change are written once.
    pub fn keep_constants(&mut self, keep: bool) {
        with!(&mut self.0, s => s.keep_constants(keep));
    }

    /// Entries of the matrix that were not written again.
    pub fn constants_kept(&self) -> u64 {
        with!(&self.0, s => s.constants_kept())
    }

    /// Takes over a state as the point of expansion.
    pub fn place(&mut self, system: &System, t: f64, y: &[f64]) {
        with!(&mut self.0, s => s.place(system, t, y));
    }

    /// The rows that depend on others everywhere; `expected` tells that there are some, `later` when drivers have moved the mechanism.
    /// The state is left elsewhere.
    pub fn find_dependent(&mut self, length: f64, expected: bool, later: Option<f64>) -> Vec<SolverRow> {
        with!(&mut self.0, s => s.find_dependent(length, expected, later))
    }

    /// From now on leaves out rows that depend on others everywhere. S must be factored afterwards.
    pub fn leave_out(&mut self, rows: &[SolverRow]) {
        with!(&mut self.0, s => s.leave_out(rows));
    }

    /// Makes room for evaluations inside steps; `system` is that of
    /// the series.
    pub fn enable_probes(&mut self, system: &System) {
        with!(&mut self.0, s => s.enable_probes(system));
    }

    /// Whether rows that hardly hold are kept: see [`crate::dynamics::elimination::Elimination::set_resolving`].
    pub fn set_resolving(&mut self, resolving: bool) {
        with!(&mut self.0, s => s.set_resolving(resolving));
    }

    /// Goes back to the start t of the last step.
    pub fn go_back(&mut self, t: f64) {
        with!(&mut self.0, s => s.go_back(t));
    }

    /// From now on carries the error along.
    pub fn carry_errors(&mut self, system: &System) {
        with!(&mut self.0, s => s.carry_errors(system));
    }

    /// From now on knows the power of drivers and of loads without potential as well as the motion, if there is any; `turns` are the
    /// angles of joints at the start, `left_out` the rows that are.
    pub fn measure_power(&mut self, system: &System, turns: &[f64], left_out: &[SolverRow]) {
        with!(&mut self.0, s => s.measure_power(system, turns, left_out));
    }

    /// When the error became too large to be carried, s.
    pub fn error_lost(&self) -> Option<f64> {
        with!(&self.0, s => s.error_lost())
    }

    /// Writes the error of the coordinates of its bodies a time τ after the start of the last step, if it is known.
    pub fn error(&self, system: &System, tau: f64, y: &mut [f64]) -> bool {
        with!(&self.0, s => s.error(system, tau, y))
    }

    /// Builds and factors S at the point of expansion.
    pub fn linearize(&mut self) {
        with!(&mut self.0, s => s.linearize());
    }

    /// Evaluates the accelerations: order 0 of the series.
    pub fn evaluate(&mut self) {
        with!(&mut self.0, s => s.evaluate());
    }

    /// Writes the accelerations that were evaluated last.
    pub fn store_accelerations(&self, system: &System, out: &mut [f64]) {
        with!(&self.0, s => s.store_accelerations(system, out));
    }

    /// One mass-orthogonal Newton step of the positions towards Φ = 0. Returns its size.
    pub fn correct_positions(&mut self) -> f64 {
        with!(&mut self.0, s => s.correct_positions())
    }

    /// Pivot products of the joints at the point of expansion.
    pub fn pivot_products(&self) -> &[f64] {
        with!(&self.0, s => s.pivot_products())
    }

    /// Puts the copy for other states a time τ after the start t of the last step, whose series have the given order.
    pub fn place_probe(&mut self, t: f64, tau: f64, order: usize) {
        with!(&mut self.0, s => {
            s.probe_at(t, tau, order);
        });
    }

    /// How many numbers its state is made of: positions, then as many velocities.
    pub fn numbers(&self) -> usize {
        with!(&self.0, s => s.numbers())
    }

    /// Writes the numbers of the copy's state.
    pub fn read_probe(&mut self, out: &mut [f64]) {
        with!(&mut self.0, s => s.probe().map_or((), |probe| probe.read(out)));
    }

    /// Takes them over as its state at time t.
    pub fn write_probe(&mut self, t: f64, numbers: &[f64]) {
        with!(&mut self.0, s => s.probe().map_or((), |probe| probe.write(t, numbers)));
    }

    /// Moves the copy's state onto the constraints. Returns by how much, if Newton's method has converged.
    pub fn project_probe(&mut self, length: f64) -> Option<f64> {
        with!(&mut self.0, s => s.probe().and_then(|probe| probe.project(length)))
    }

    /// Largest |Φ| of the joints' rows at the copy's state, each relative to its size.
    pub fn probe_open(&mut self) -> f64 {
        with!(&mut self.0, s => s.probe().map_or(0.0, Series::open))
    }

    /// Pivot products of the joints at the copy's state.
    pub fn probe_pivot_products(&mut self) -> &[f64] {
        with!(&mut self.0, s => s.probe().map_or(&[], |probe| probe.pivot_products_here()))
    }

    /// Pivot products of the joints at four times τ after the start of the last step, whose series have the given order. `None` if
    /// they can only be found one after another.
    pub fn pivot_products_at(&mut self, tau: &[f64; 4], order: usize) -> Option<&[[f64; 4]]> {
        match &mut self.0 {
            Bundled::Wide(s) => s.pivot_products_at(tau, order),
            Bundled::WidePlanar(s) => s.pivot_products_at(tau, order),
            Bundled::Narrow(_) | Bundled::NarrowPlanar(_) => None,
        }
    }

    /// Which joints take part where rows of `joints` nearly depend on others, at the copy's last pivot products.
    pub fn raise_shares(&mut self, joints: &[(usize, f64)], shares: &mut [f64]) {
        with!(&mut self.0, s => s.probe().map_or((), |probe| probe.raise_shares(joints, shares)));
    }

    /// How fast rows turn at the state, 1/s.
    pub fn pace(&self, length: f64) -> f64 {
        with!(&self.0, s => s.pace(length))
    }

    /// Work done so far.
    pub fn counters(&self) -> Counters {
        with!(&self.0, s => s.counters)
    }

    /// Takes one step.
    pub fn step(&mut self, plan: StepPlan) -> SeriesStep {
        with!(&mut self.0, s => s.step(plan))
    }

    /// Writes the coordinates of its bodies at the point of expansion.
    pub fn store(&self, system: &System, y: &mut [f64]) {
        with!(&self.0, s => s.store(system, y));
    }

    /// Writes the coordinates of its bodies a time τ after the start of the last step.
    pub fn interpolate(&self, system: &System, tau: f64, order: usize, y: &mut [f64]) {
        with!(&self.0, s => s.interpolate(system, tau, order, y));
    }

    /// Work of drivers and of loads without potential over the last step up to τ, J.
    pub fn work(&self, tau: f64) -> f64 {
        with!(&self.0, s => s.work(tau))
    }

    /// The step that the series allow at the point of expansion, s.
    pub fn natural_step(&mut self, order: usize, tolerance: f64) -> f64 {
        with!(&mut self.0, s => s.natural_step(order, tolerance))
    }

    /// How many times prescribed functions change to another piece before `end`, at most so many.
    pub fn breakpoints_before(&self, end: f64, most: usize) -> usize {
        with!(&self.0, s => s.breakpoints_before(end, most))
    }

    /// Multipliers of the solver rows a time τ after the start of the last step; `across` tells the directions at the state there that
    /// those of each common vector are written in.
    pub fn multipliers(
        &self,
        tau: f64,
        order: usize,
        across: impl Fn(usize) -> [Vector3<f64>; 2],
    ) -> Option<Vec<f64>> {
        with!(&self.0, s => s.multipliers(tau, order, across))
    }
}
