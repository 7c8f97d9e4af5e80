//! An island, a part of a scene that nothing connects with the rest, and its series.

use crate::integrate::step::{FEW_BREAKS, StopReason};
use crate::integrate::stepper::IslandStep;
use crate::integrate::track::Track;
use crate::scene::Skip;
use std::ops::RangeInclusive;
use triad_dynamics::dynamics::elimination::{Counters, TwistJacobian};
use triad_dynamics::dynamics::series::{IslandSeries, MIN_TOLERANCE_REDUNDANT, StepPlan};
use triad_dynamics::model::BodyRef;
use triad_dynamics::state::State;
use triad_dynamics::system::System;
use triad_dynamics::system::common_axes::{Origin, WithCommonAxes, origins};
use triad_dynamics::system::islands::{self, Island};
use triad_dynamics::system::pivots::about_pivots;
use triad_dynamics::system::planar::{self, Plane};

/// Highest order of the series.
const MAX_ORDER: usize = 30;
/// Bodies up to which there is room for orders above the first one: in large mechanisms some body is always near the end of
/// what its series reach, and more of them would only lengthen what is kept.
const FEW_BODIES: usize = 16;
/// Mean distance of breakpoints, in natural steps of the series, below which they are dense (measured: docs/PERFORMANCE.md).
const DENSE_BREAKPOINTS: f64 = 0.1;
/// Greatest number of breakpoints that are counted.
const MAX_BREAKPOINTS: usize = 100_000;
/// Part of what is left to the end below which a step is the last, if the constraints cannot be satisfied at its end, or only
/// after [`MANY_HALVINGS`]: from there on steps lead nowhere, and spoil the state.
const MIN_PROGRESS: f64 = 1e-9;
/// Rounding of the terms of a step, for each row of the solver. Those of order k grow with the k-th power of its size in distances of its
/// start from a singular configuration: eq. (11.16).
const ROUNDING: f64 = 1e-16;
/// Part of a step within which that makes a singular configuration behind its end too near, below which most steps that it would move pass
/// anyway, and the greatest: a step has to be left.
const CLEARANCE: f64 = 0.65;
const MOST_CLEARANCE: f64 = 0.85;
/// Number of halvings of a step, until the constraints can be satisfied at its end, from which on the step leads nowhere.
const MANY_HALVINGS: u64 = 3;

/// An island and its last step.
#[derive(Clone, Debug)]
pub struct IslandStepper {
    /// What is solved, if it is not the whole as it stands.
    own: Option<Box<System>>,
    /// What the common vectors are that its series have.
    commons: Vec<Origin>,
    /// Places of its joints and drivers among those of the whole.
    constraints: Option<Vec<usize>>,
    /// Joints that have no rows because they are pivots of planar bodies on the ground, with the others of these bodies.
    pivots: Vec<(usize, Vec<usize>)>,
    tolerance: f64,
    /// The order of the next step, not below the one for the tolerance and not above what there is room for.
    order: usize,
    orders: RangeInclusive<usize>,
    length: f64,
    bodies: usize,
    rows: usize,
    /// Whether its joints close loops.
    loops: bool,
    series: IslandSeries,
    /// End of the last step.
    t: f64,
    /// The last step: its start, size and the terms that it used.
    t_old: f64,
    h_old: f64,
    order_old: usize,
    /// Whether the last step has shown by itself that the constraints hold at its end.
    proven: bool,
    steps: u64,
}

impl IslandStepper {
    /// Starts an island of a system, or the whole, at (t, y).
    pub fn new(
        whole: &System,
        own: Option<Island>,
        redundant: bool,
        turns: &[f64],
        t: f64,
        y: &[f64],
        tolerance: f64,
    ) -> Self {
        let own = own.map(|island| island.system);
        let system = own.as_ref().unwrap_or(whole);
        let constraints = own.as_ref().map(|own| places(whole, own));
        let skip = whole.model.settings.skip;
        let q = &y[..whole.coordinates];
        let (reduced, in_plane) = reduced(system, q, skip);
        let solved = reduced.as_ref().unwrap_or(system);
        let (commons, with_axes) = common_axes(solved, q, skip.axes && !in_plane);
        let expanded = with_axes.as_ref().unwrap_or(solved);
        let order = order_for(tolerance, in_plane);
        let most = if system.bodies.len() > FEW_BODIES { order } else { MAX_ORDER };
        let (rows, loops) = (solved.solver_rows, islands::has_loops(&system.model));
        let series_of = |measured: &System, order: usize| {
            if in_plane {
                IslandSeries::in_plane(measured, order, turns)
            } else {
                IslandSeries::in_space(measured, order, turns)
            }
        };
        let mut series = series_of(expanded, most);
        series.keep_constants(skip.constants);
        series.place(solved, t, y);
        let mut dependent = Vec::new();
        if (in_plane || redundant) && rows > 0 {
            let mut measured = series_of(&expanded.in_lengths(), 1);
            measured.place(solved, t, y);
            dependent = measured.find_dependent(system.length, redundant, system.driven_away(t));
            series.leave_out(&dependent);
        }
        let redundant = !dependent.is_empty();
        if loops {
            series.enable_probes(expanded);
        }
        if whole.model.settings.error_estimate {
            series.carry_errors(expanded);
        }
        series.measure_power(expanded, turns, &dependent);
        series.linearize();
        let tolerance = if redundant { tolerance.max(MIN_TOLERANCE_REDUNDANT) } else { tolerance };
        let (length, bodies, pivots) = (system.length, system.bodies.len(), rowless(solved));
        Self {
            loops,
            own: reduced.or(own).map(Box::new),
            commons,
            constraints,
            pivots,
            tolerance,
            order,
            orders: order..=most,
            length,
            bodies,
            rows,
            series,
            t,
            t_old: t,
            h_old: 0.0,
            order_old: order,
            proven: true,
            steps: 0,
        }
    }

    /// End of the last step.
    pub fn time(&self) -> f64 {
        self.t
    }

    /// When its error became too large to be carried, s.
    pub fn error_lost(&self) -> Option<f64> {
        self.series.error_lost()
    }

    /// Writes the error of its own coordinates at time t within its last step, if it is known.
    pub fn error(&self, whole: &System, t: f64, y: &mut [f64]) -> bool {
        let system = self.own.as_deref().unwrap_or(whole);
        self.series.error(system, (t - self.t_old).clamp(0.0, self.h_old), y)
    }

    /// Bodies.
    pub fn bodies(&self) -> usize {
        self.bodies
    }

    /// Rows of the solver.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Bodies that turn about points of the ground, without rows for these.
    pub fn pivoted(&self) -> usize {
        self.own.iter().flat_map(|own| &own.bodies).filter(|body| body.pivot.is_some()).count()
    }

    /// Whether its last step has shown by itself that the constraints hold.
    pub fn is_proven(&self) -> bool {
        self.proven
    }

    /// Steps so far.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Whether it is solved in a plane.
    pub fn is_planar(&self) -> bool {
        self.series.is_planar()
    }

    /// Its last step, if it may hide a singular configuration; `island` is its own place among all.
    pub fn last_step(&self, whole: &System, island: usize) -> Option<IslandStep<'_>> {
        let length = self.own.as_deref().unwrap_or(whole).length;
        let (pivot_products, pace) = (Some(self.series.pivot_products()), self.series.pace(length));
        let (start, end, constraints) = (self.t_old, self.t, self.constraints.as_deref());
        let rounding = ROUNDING * self.rows as f64 / self.tolerance;
        let clearance = libm::pow(rounding, (self.order_old as f64).recip()).min(MOST_CLEARANCE);
        let clearance = if clearance < CLEARANCE { 0.0 } else { clearance };
        self.loops.then_some(IslandStep { island, start, end, pivot_products, constraints, pace, clearance })
    }

    /// Whether its last step can be taken back.
    pub fn can_retreat(&self) -> bool {
        self.h_old > 0.0
    }

    /// Takes its last step back.
    pub fn retreat(&mut self) {
        (self.t, self.h_old) = (self.t_old, 0.0);
        self.steps -= 1;
        self.series.go_back(self.t);
    }

    /// Whether rows that hardly hold are kept.
    pub fn set_resolving(&mut self, resolving: bool) {
        self.series.set_resolving(resolving);
    }

    /// Work done so far.
    pub fn counters(&self) -> Counters {
        self.series.counters()
    }

    /// Entries of the matrix that were not written again.
    pub fn constants_kept(&self) -> u64 {
        self.series.constants_kept()
    }

    /// Takes one step, not beyond `end`, and writes its own coordinates into y. Returns how often it was shortened.
    ///
    /// # Errors
    ///
    /// [`StopReason`]: why the run cannot go on.
    pub fn step(&mut self, whole: &System, end: f64, y: &mut [f64]) -> Result<u64, StopReason> {
        let plan = StepPlan {
            order: self.order,
            tolerance: self.tolerance,
            length: self.length,
            end,
            dry_run: false,
        };
        let system = self.own.as_deref().unwrap_or(whole);
        let taken = self.series.step(plan);
        if taken.finite {
            self.series.store(system, y);
        }
        if !taken.finite || taken.h.is_nan() {
            return Err(StopReason::NotFinite { time: self.t });
        }
        if (taken.far || taken.rejected >= MANY_HALVINGS) && taken.h < MIN_PROGRESS * (end - self.t) {
            return Err(StopReason::StepTooSmall { time: self.t, step: taken.h });
        }
        if taken.h <= 16.0 * f64::EPSILON * self.t.abs().max(end.abs()) && taken.time < end && !taken.at_break
        {
            return Err(StopReason::StepTooSmall { time: self.t, step: taken.h });
        }
        self.t_old = self.t;
        self.h_old = taken.h;
        self.order_old = taken.order;
        self.order = taken.next_order.clamp(*self.orders.start(), *self.orders.end());
        self.t = taken.time;
        self.proven = taken.proven;
        self.steps += 1;
        Ok(taken.rejected)
    }

    /// Whether breakpoints of prescribed functions are so many and follow so closely until `end` that steps, which end at each of them, would
    /// be far shorter than the series allow. At a few all methods end their steps.
    pub fn breakpoints_dense(&mut self, end: f64) -> bool {
        let (t, order, tolerance) = (self.t, self.order, self.tolerance);
        let breakpoints = self.series.breakpoints_before(end, MAX_BREAKPOINTS);
        if breakpoints <= FEW_BREAKS {
            return false;
        }
        // At rest before a pulse the series allow a step without end, and that says nothing.
        let natural = self.series.natural_step(order, tolerance);
        natural.is_finite() && (end - t) / (breakpoints as f64) < DENSE_BREAKPOINTS * natural
    }

    /// Axes of its joints that are kept by rows of common vectors.
    pub fn axes(&self) -> usize {
        self.commons.iter().filter(|origin| matches!(origin, Origin::Axis(_))).count()
    }

    /// Multipliers of the solver rows at a state within the last step, with A there. The series of the whole in space have
    /// them; those of an island or of the plane do not.
    pub fn multipliers(&self, state: &State, jacobian: &TwistJacobian) -> Option<Vec<f64>> {
        let tau = state.time() - self.t_old;
        let inside = self.h_old > 0.0 && (0.0..=self.h_old).contains(&tau);
        if self.own.is_some() || !inside {
            return None;
        }
        self.series.multipliers(tau, self.order_old, |k| match self.commons[k] {
            Origin::CommonVector(row) => jacobian.transverse(row),
            // Of s in s · t as it is written the gradient is t, and −n in a − s.
            Origin::Axis(across) => across.map(|feature| -state.feature_value(feature)),
        })
    }

    /// Work of drivers and of loads without potential from the start of its last step to time t, J.
    pub fn work_to(&self, t: f64) -> f64 {
        self.series.work((t - self.t_old).clamp(0.0, self.h_old))
    }

    /// Writes its own coordinates at time t within its last step.
    pub fn interpolate(&self, whole: &System, t: f64, y: &mut [f64]) {
        let system = self.own.as_deref().unwrap_or(whole);
        if t >= self.t || self.h_old == 0.0 {
            self.series.store(system, y);
            return;
        }
        let tau = (t - self.t_old).clamp(0.0, self.h_old);
        self.series.interpolate(system, tau, self.order_old, y);
    }
}

impl Track for IslandStepper {
    fn numbers(&self) -> usize {
        self.series.numbers()
    }

    fn length(&self) -> f64 {
        self.length
    }

    /// The series go on beyond the step.
    fn place(&mut self, t: f64) {
        self.series.place_probe(self.t_old, t - self.t_old, self.order_old);
    }

    fn read(&mut self, out: &mut [f64]) {
        self.series.read_probe(out);
    }

    fn write(&mut self, t: f64, numbers: &[f64]) {
        self.series.write_probe(t, numbers);
    }

    fn project(&mut self) -> Option<f64> {
        self.series.project_probe(self.length)
    }

    fn open(&mut self) -> f64 {
        self.series.probe_open()
    }

    fn pivot_products(&mut self) -> &[f64] {
        self.series.probe_pivot_products()
    }

    fn pivot_products_at(&mut self, times: [f64; 4]) -> Option<&[[f64; 4]]> {
        self.series.pivot_products_at(&times.map(|t| t - self.t_old), self.order_old)
    }

    fn raise_shares(&mut self, joints: &[(usize, f64)], shares: &mut [f64]) {
        self.series.raise_shares(joints, shares);
        // What the other joints of a body with a pivot do to it, the pivot takes up.
        for (pivot, others) in &self.pivots {
            shares[*pivot] = others.iter().map(|other| shares[*other]).fold(shares[*pivot], f64::max);
        }
    }
}

/// What the common vectors are that series have, and the system with axes among them, if it differs.
fn common_axes(system: &System, q: &[f64], wanted: bool) -> (Vec<Origin>, Option<System>) {
    match if wanted { WithCommonAxes::new(system, q) } else { None } {
        Some(WithCommonAxes { system, origins }) => (origins, Some(system)),
        None => (origins(system), None),
    }
}

/// A system with the coordinates and rows that are solved, if these are not all: those of a plane, which is told, or those of bodies about
/// points of the ground.
fn reduced(system: &System, q: &[f64], skip: Skip) -> (Option<System>, bool) {
    let held = |plane: Option<&Plane>| if skip.fixed { about_pivots(system, q, plane) } else { None };
    let plane = if skip.planar { planar::recognize(system, q).ok() } else { None };
    let flat = plane.and_then(|plane| {
        let in_space = held(Some(&plane)).unwrap_or_else(|| system.clone());
        plane.reduce(in_space, q).ok()
    });
    match flat {
        None => (held(None), false),
        flat => (flat, true),
    }
}

/// Joints without rows in a plane, each with the other joints of its body.
fn rowless(flat: &System) -> Vec<(usize, Vec<usize>)> {
    let joints = &flat.model.joints;
    let moves = |joint: usize, body: BodyRef| body != BodyRef::Ground && joints[joint].bodies.contains(&body);
    let others = |pivot: usize| {
        let shares =
            |&other: &usize| other != pivot && joints[pivot].bodies.iter().any(|body| moves(other, *body));
        (0..joints.len()).filter(shares).collect()
    };
    let rowless = (0..joints.len()).filter(|&joint| flat.constraints[joint].solver.is_empty());
    rowless.map(|pivot| (pivot, others(pivot))).collect()
}

/// Places of the joints and drivers of an island among those of the whole: both lists are in the same order.
fn places(whole: &System, island: &System) -> Vec<usize> {
    let mut next = 0;
    let place = |name: &str| {
        let rest = whole.constraints.get(next..)?;
        next += rest.iter().position(|constraint| constraint.name == name)? + 1;
        Some(next - 1)
    };
    let mut place = place;
    island.constraints.iter().filter_map(|constraint| place(&constraint.name)).collect()
}

/// Order of the first step for a tolerance, and the least of all: 8 for 1e-3, 14 for 1e-9, 18 for 1e-13. In a plane a further order costs little against what
/// each step costs anyway.
fn order_for(tolerance: f64, planar: bool) -> usize {
    let powers = std::iter::successors(Some(tolerance), |t| Some(10.0 * t));
    let digits = powers.take(MAX_ORDER).take_while(|&t| t < 0.3).count();
    let least = if planar { 9 } else { 5 };
    (least + digits).clamp(6, MAX_ORDER)
}
