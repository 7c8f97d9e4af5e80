//! Singular configurations that a run passes, found from the pivots of the factorization — THEORY section 8.
//!
//! The product of a joint's relative pivots in S is the square of a number that passes through zero at a singular
//! configuration. The factorizations of the run give it at the ends of steps. Inside a step, S is evaluated if its rows turn so
//! far that one of these numbers may come near zero and back. What such a dip is, two states beside it tell: a passage, or a
//! place where branches of the motion come near each other. There the step is taken again, shorter, until it follows one of
//! them. Mechanisms without loops have no such step.

mod found;
mod history;
mod overview;
mod passage;
mod probe;
mod sample;
mod search;

pub use found::SingularConfiguration;

use crate::integrate::{Integrator, IslandStep, Track};
use crate::scene::ConstraintMethod;
use found::Found;
use history::IslandHistory;
use overview::Overview;
use passage::{Examiner, root};
use probe::{Path, Probe};
use sample::Sample;
use search::{Again, SAMPLES, Search, StepData};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::constraints::rank::Rank;
use triad_dynamics::constraints::violation;
use triad_dynamics::system::System;
use triad_dynamics::system::islands::has_loops;

/// Part of a joint's largest pivot product that counts as zero: what rounding leaves at a singular configuration.
const ZERO: f64 = 1e-8;
/// Distance of the computed motion from a singular configuration, in tolerances (as an angle) and in violations of the
/// constraints (as a pivot product).
const ERRORS: f64 = 10.0;
/// Part of the time to a place that is not resolved by which the next step goes on.
const APPROACH: f64 = 0.5;
/// Most steps that are taken again on the way past one such place.
const MAX_RETREATS: usize = 200;
/// Root of the least pivot product above which such a place is left behind, and all joints hold.
const LEFT_BEHIND: f64 = 1e-2;
/// Room for the times of dips in a step.
const USUAL_DIPS: usize = 64;

/// Watches the pivots of a run.
#[derive(Clone, Debug)]
pub struct SingularityMonitor {
    /// Evaluates S inside steps, if the mechanism has loops.
    probe: Option<Probe>,
    tolerance: f64,
    /// Whether no projection closes the constraints at the ends of steps.
    violated: bool,
    /// Whether the author has chosen the steps.
    fixed: bool,
    islands: Vec<IslandHistory>,
    found: Found,
    examiner: Examiner,
    /// Pivot products at times of the last step: its start, its end, and those of the probes.
    samples: Vec<Sample>,
    overview: Overview,
    examined: Vec<f64>,
    /// Whether rows that hardly hold are kept on the way past a place that was not resolved, and steps taken again there.
    resolving: bool,
    retreats: usize,
    /// The place that steps are being taken again for lies before this time, s.
    unresolved: f64,
    /// Up to when steps are not taken again, s: the branch could not be told there.
    given_up: f64,
}

impl SingularityMonitor {
    /// For a mechanism whose rank is known.
    pub fn new(mechanism: &mut Mechanism, rank: &Rank) -> Self {
        let Mechanism { system, state, elimination, .. } = mechanism;
        let probe = has_loops(&system.model).then(|| Probe::new(system, state, elimination, &rank.dependent));
        let constraints = if probe.is_some() { system.constraints.len() } else { 0 };
        let settings = &system.model.settings;
        Self {
            probe,
            tolerance: settings.tolerance,
            violated: !matches!(
                settings.constraint_method,
                ConstraintMethod::Projection | ConstraintMethod::Partitioning
            ),
            fixed: settings.step.is_some(),
            islands: Vec::new(),
            found: Found::new(constraints),
            examiner: Examiner::default(),
            samples: (0..SAMPLES).map(|_| Sample::new(constraints)).collect(),
            overview: Overview::new(constraints),
            examined: Vec::with_capacity(USUAL_DIPS),
            resolving: false,
            retreats: 0,
            unresolved: f64::NEG_INFINITY,
            given_up: f64::NEG_INFINITY,
        }
    }

    /// Forgets the run so far.
    pub fn reset(&mut self, mechanism: &mut Mechanism) {
        self.resolving = false;
        self.retreats = 0;
        self.given_up = f64::NEG_INFINITY;
        mechanism.elimination.set_resolving(false);
        self.islands.clear();
        self.found.clear();
        self.examiner.count = 0;
    }

    /// Singular configurations that were passed so far, in the order of time.
    pub fn configurations(&self, system: &System) -> Vec<SingularConfiguration> {
        self.found.list(system)
    }

    /// Where either of two branches may have been followed, in words.
    pub fn doubts(&self, system: &System) -> Vec<String> {
        self.found.doubts(system)
    }

    /// Evaluations of S inside steps so far.
    pub fn probes(&self) -> u64 {
        self.examiner.count
    }

    /// Searches the step that was taken last. Returns the time at which it should have ended, if it passes a place where
    /// branches of the motion come nearer to each other than it can tell, or ends too near before such a place: it is to be taken back.
    pub fn step(&mut self, mechanism: &mut Mechanism, integrator: &mut Integrator) -> Option<f64> {
        let mut probe = self.probe.take()?;
        let shorter = self.search(&mut probe, mechanism, integrator);
        self.probe = Some(probe);
        shorter
    }

    /// Whether steps are being taken again on the way past a place that was not resolved.
    pub fn is_resolving(&self) -> bool {
        self.resolving
    }

    /// Goes on from before such a place, past which `tried` found no way: the step is not taken again for it, and its doubt
    /// stays.
    pub fn give_up(&mut self, tried: &Self, mechanism: &mut Mechanism, integrator: &mut Integrator) {
        self.given_up = tried.unresolved;
        self.resolve(false, mechanism, integrator);
    }

    fn search(
        &mut self,
        probe: &mut Probe,
        mechanism: &mut Mechanism,
        integrator: &mut Integrator,
    ) -> Option<f64> {
        if self.found.is_full() {
            return None;
        }
        let can_retreat = integrator.can_retreat();
        let IslandStep { island, start, end, pace, pivot_products, constraints, clearance } =
            integrator.island_step(mechanism)?;
        if self.islands.len() <= island {
            self.islands.resize(island + 1, IslandHistory::default());
        }
        let history = &mut self.islands[island];
        if history.is_new() {
            let all = 0..mechanism.system.constraints.len();
            history.constraints = constraints.map_or_else(|| all.collect(), <[usize]>::to_vec);
        }
        let known = pivot_products.is_some_and(|products| !products.is_empty());
        let joints = history.constraints.len();
        if self.samples[1].products.len() != joints {
            self.samples.iter_mut().for_each(|sample| sample.resize(joints));
            self.overview.resize(joints);
        }
        if let Some(products) = pivot_products.filter(|_| known) {
            self.samples[1].products.copy_from_slice(products);
        }
        let open = if self.violated { violation::relative(&mechanism.system, &mechanism.state) } else { 0.0 };
        let data = StepData {
            island,
            start,
            end,
            run_end: mechanism.system.model.settings.duration,
            pace: pace.max(history.pace),
            zero: zero(self.tolerance, open),
            violated: self.violated,
            may_shorten: can_retreat && !self.violated && !self.fixed && self.retreats < MAX_RETREATS,
            given_up: self.given_up,
            clearance,
        };
        let result = match integrator.track() {
            Some(track) => self.look(track, data, pace, known),
            None => self.look(&mut Path { probe, mechanism, integrator, start, end }, data, pace, known),
        };
        self.conclude(result, data, mechanism, integrator)
    }

    /// Looks at the path of a step whose rows turn at a pace at its end, where pivot products may be known.
    fn look(&mut self, track: &mut dyn Track, step: StepData, pace: f64, known: bool) -> Result<(), Again> {
        let Self { islands, found, examiner, samples, overview, examined, .. } = self;
        let StepData { island, start, end, .. } = step;
        let history = &mut islands[island];
        let mut sample = |t: f64, out: &mut Vec<f64>| {
            examiner.count += 1;
            track.place(t);
            out.copy_from_slice(track.pivot_products());
        };
        if !known {
            sample(end, &mut samples[1].products);
        }
        if history.is_new() {
            sample(start, &mut samples[0].products);
            history.begin(&samples[0].products, pace);
        } else {
            samples[0].products.copy_from_slice(&history.pivot_products);
        }
        examiner.allocate(track.numbers(), samples[0].products.len());
        history.scales.raise(&samples[1].products);
        samples[..2].iter_mut().for_each(|sample| sample.measure(&history.scales, step.floor()));
        examined.clear();
        let mut search = Search { step, track, found, history, examiner, samples, examined };
        if end > search.history.cleared {
            if !search.shows_no_dip(overview) {
                search.within((start, 0), (end, 1), 2)?;
            }
            search.keeps_clear()?;
        }
        let history = &mut islands[island];
        history.note_change(&samples[0].products, &samples[1].products, (end - start) * step.pace);
        history.pivot_products.clone_from(&samples[1].products);
        history.pace = pace;
        Ok(())
    }

    /// Goes on, or has the step taken again.
    fn conclude(
        &mut self,
        result: Result<(), Again>,
        StepData { island, start, .. }: StepData,
        mechanism: &mut Mechanism,
        integrator: &mut Integrator,
    ) -> Option<f64> {
        let Err(again) = result else {
            let largest = &self.islands[island].scales.largest;
            let least = (0..largest.len())
                .filter(|&joint| largest[joint] > ZERO)
                .map(|joint| root(&self.samples[1].products, largest, joint));
            let behind = least.fold(1.0, f64::min) > LEFT_BEHIND;
            if self.resolving && behind && self.examined.is_empty() {
                self.resolve(false, mechanism, integrator);
            }
            integrator.set_loose(self.resolving || !behind);
            return None;
        };
        let (time, until) = match again {
            Again::Unresolved { time, until } => (time, until),
            Again::TooNear(earlier) => {
                self.islands[island].cleared = earlier;
                self.found.forget_after(island, earlier);
                return Some(earlier);
            }
        };
        self.found.forget_after(island, start);
        self.retreats += 1;
        self.unresolved = until;
        self.resolve(true, mechanism, integrator);
        Some(start + APPROACH * (time - start))
    }

    fn resolve(&mut self, on: bool, mechanism: &mut Mechanism, integrator: &mut Integrator) {
        if !on {
            self.retreats = 0;
        }
        self.resolving = on;
        mechanism.elimination.set_resolving(on);
        integrator.set_resolving(on);
        integrator.set_loose(on);
    }
}

/// What counts as zero, as a part of the largest pivot product. Where constraints are violated, nothing brings bodies nearer
/// to the singular configuration than the root of the violation: there it is of second order.
fn zero(tolerance: f64, violation: f64) -> f64 {
    let error = ERRORS * tolerance;
    ZERO.max(error * error).max(ERRORS * violation)
}
