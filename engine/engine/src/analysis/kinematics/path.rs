//! The motion that drivers prescribe, as geometry alone.
//!
//! Where drivers leave no freedom, every distribution of masses moves the same way. So the motion is that of bodies that all
//! have one mass, and one inertia about every axis, under no loads: their power series follow from the drivers alone, their
//! steps from how the series converge, and no mass, however small, makes them inexact.

use super::dead_point::Approach;
use crate::analysis::{AnalysisError, Stage};
use crate::error::EngineError;
use crate::run::{EventOccurrence, Simulation, SingularConfiguration};
use crate::scene::{ConstraintMethod, IntegratorKind, Scene};
use nalgebra::Vector3;
use triad_dynamics::constraints::branch::{self, Branch};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::dynamics::elimination::ProjectableState;
use triad_dynamics::model::{ForceLaw, LoadKind, Model};
use triad_dynamics::newton::{project_positions, project_velocities, rules};
use triad_dynamics::state;
use triad_dynamics::system::index::SolverRow;
use triad_dynamics::system::natural::NaturalCoordinates;
use triad_dynamics::system::{Constraint, System};
use triad_linalg::{largest_difference, largest_size};

/// Tolerance of the series: as tight as their rounding allows, because it decides which branch is followed where two come near
/// each other.
const TOLERANCE: f64 = 1e-12;
/// What the end of a step or an output may be moved onto the constraints by, in lengths of the mechanism or, of directors,
/// without a unit: ten thousand tolerances. Another branch is farther away wherever a run does not report a singular position.
const MAX_CORRECTION: f64 = 1e-8;
/// Least pivot product at which a position is corrected and the accelerations follow from the rows: the square of the angle
/// to a singular position, where rounding of 1e-16 is multiplied by its inverse.
const NEARLY_SINGULAR: f64 = 1e-7;
/// Number of times, and their distance as a turn of the fastest body, rad, from whose velocities, or accelerations, those are taken at a
/// singular position: the error is about the seventh power of it, and rounding divided by it.
const NODES: usize = 7;
const ASIDE: f64 = 0.02;
/// Part of the largest multiplier from which a joint takes part in a dead point.
const INVOLVED: f64 = 1e-3;
/// The bits of a number that are those of the power of two below it.
const POWER_OF_TWO: u64 = f64::INFINITY.to_bits();

/// A motion without masses, and the mechanism held at its current moment.
#[derive(Debug)]
pub(super) struct Path {
    run: Simulation,
    /// The mechanism, held at the time that was asked for last.
    pub(super) stage: Stage,
    /// Q̈ of each body there.
    pub(super) accelerations: Vec<NaturalCoordinates>,
    /// Newton-Raphson steps so far.
    pub(super) iterations: usize,
    /// The largest number by which they have moved an output, m or, of directors, without a unit.
    pub(super) correction: f64,
    /// Whether the rows leave accelerations and multipliers open there.
    pub(super) singular: bool,
    /// End of the step that was checked last, s.
    checked: f64,
    /// The last steps, for a dead point that they may lead to.
    approach: Approach,
}

impl Path {
    /// Starts at the start of a scene.
    pub(super) fn new(scene: &Scene) -> Result<Self, AnalysisError> {
        let model = bare(Model::new(scene).map_err(EngineError::from)?);
        let run = Simulation::from_model(model.clone())?;
        let mut stage = Stage::from_model(model)?;
        let Mechanism { elimination, .. } = &mut stage.mechanism;
        elimination.set_dependent(&run.rank().dependent);
        elimination.keep_pivot_products();
        Ok(Self {
            run,
            stage,
            accelerations: Vec::new(),
            iterations: 0,
            correction: 0.0,
            singular: false,
            checked: 0.0,
            approach: Approach::default(),
        })
    }

    /// Degrees of freedom that the drivers leave — eq. (8.1).
    pub(super) fn freedoms(&self) -> usize {
        (6 * self.run.system().bodies.len()).saturating_sub(self.run.rank().rank)
    }

    /// The joints and drivers whose rows depend on others at the start alone, if it is a singular position and its velocities do not say
    /// which branch of the motion is meant.
    pub(super) fn undecided_at_start(&mut self) -> Option<Vec<String>> {
        let Self { run, stage: Stage { mechanism: Mechanism { system, state, .. }, q, q_dot, .. }, .. } =
            self;
        let rank = run.rank();
        if rank.lost_at_start() == 0 {
            return None;
        }
        if branch::take(system, state, q, &mut q_dot.clone()) == Branch::Given {
            return None;
        }
        let lost: Vec<&SolverRow> =
            rank.dependent_at_start.iter().filter(|row| !rank.dependent.contains(row)).collect();
        let holds =
            |constraint: &&Constraint| lost.iter().any(|row| constraint.solver.contains(&row.index()));
        Some(system.constraints.iter().filter(holds).map(|constraint| constraint.name.clone()).collect())
    }

    /// Steps so far.
    pub(super) fn steps(&self) -> u64 {
        self.run.summary().steps
    }

    /// What was found or corrected at the start.
    pub(super) fn notes(&self) -> &[String] {
        self.run.notes()
    }

    /// Singular positions passed so far.
    pub(super) fn singularities(&self) -> Vec<SingularConfiguration> {
        self.run.singular_configurations()
    }

    /// Where either of two branches may have been followed, in words.
    pub(super) fn doubts(&self) -> Vec<String> {
        self.run.branching()
    }

    /// Events so far.
    pub(super) fn events(&self) -> &[EventOccurrence] {
        self.run.events()
    }

    /// Whether the end is reached, or an event that stops the motion.
    pub(super) fn has_ended(&self) -> bool {
        self.run.finished()
    }

    /// Follows the motion to a time, and holds the mechanism there.
    pub(super) fn go_to(&mut self, time: f64) -> Result<(), AnalysisError> {
        loop {
            self.stage.wanted.check()?;
            let there = match self.run.advance_towards(time, 1) {
                Ok(there) => there,
                Err(error) => return Err(self.stopped(error)),
            };
            self.check_step()?;
            if there {
                break;
            }
        }
        self.hold()
    }

    /// Refuses a step whose end is not where its series lead: its projection has found another branch.
    fn check_step(&mut self) -> Result<(), AnalysisError> {
        let reached = self.run.reached();
        if reached > self.checked {
            self.checked = reached;
            let [mut led, mut end] = [(), ()].map(|()| vec![0.0; 2 * self.run.system().coordinates]);
            self.run.look_into_step(reached.next_down(), &mut led);
            self.run.look_into_step(reached, &mut end);
            let positions = self.run.system().coordinates;
            self.approach.note(reached, &end[positions..]);
            self.check_moved(reached, largest_difference(&led[..positions], &end[..positions]))?;
        }
        Ok(())
    }

    fn check_moved(&self, time: f64, moved: f64) -> Result<(), AnalysisError> {
        let length = self.run.system().length.max(1.0);
        // A comparison that is false for NaN as well.
        if moved <= MAX_CORRECTION * length { Ok(()) } else { Err(AnalysisError::BranchLost { time, moved }) }
    }

    /// Takes over the state of the motion, with its last digits put right, and finds the accelerations.
    fn hold(&mut self) -> Result<(), AnalysisError> {
        let Self { run, stage, .. } = self;
        stage.time = run.time();
        stage.q.copy_from_slice(run.q());
        stage.q_dot.copy_from_slice(run.q_dot());
        let length = run.system().length;
        stage.mechanism.state.copy_revolutions(run.state().known());
        let time = stage.time;
        let mut on = stage.projectable();
        on.state.set_time(on.system, time);
        on.state.set_positions(on.system, on.q);
        on.elimination.linearize(on.system, on.state);
        self.singular = is_nearly_singular(&mut on, run.rank().dependent.len());
        let mut moved = 0.0;
        if !self.singular {
            self.iterations += project_positions(&mut on, &rules::KINEMATICS_POSITIONS, length).corrections;
            on.state.set_velocities(on.system, on.q_dot);
            project_velocities(&mut on, &rules::KINEMATICS_VELOCITIES, length);
            moved = largest_difference(run.q(), on.q);
        }
        self.check_moved(time, moved)?;
        self.correction = self.correction.max(moved);
        let bodies = self.run.system().bodies.len();
        let found = self.stage.accelerate();
        self.accelerations = (0..bodies).map(|body| found.of_body(body)).collect();
        if self.singular {
            if self.run.time() <= 0.0 && self.run.is_beside_singular_start() {
                self.accelerate_from_later()?;
            } else {
                self.accelerate_smoothly();
            }
        }
        Ok(())
    }

    /// Takes the accelerations of a singular start from those at some times after it, where the rows determine them.
    fn accelerate_from_later(&mut self) -> Result<(), AnalysisError> {
        let (mut ahead, mut stage) = (self.run.clone(), self.stage.clone());
        let pace = state::fastest(ahead.system(), &[ahead.q(), ahead.q_dot()].concat());
        let apart = (ASIDE / pace).min(ahead.duration() / NODES as f64);
        if pace == 0.0 || apart == 0.0 {
            return Ok(());
        }
        self.accelerations.fill(NaturalCoordinates::default());
        // The polynomial through values at 1, 2, …, n has at 0 their sum with binomial coefficients of changing signs.
        let mut weight = -1.0;
        for k in 1..=NODES {
            weight *= -((NODES + 1 - k) as f64) / k as f64;
            ahead.advance_to(apart * k as f64)?;
            stage.time = ahead.time();
            stage.q.copy_from_slice(ahead.q());
            stage.q_dot.copy_from_slice(ahead.q_dot());
            let found = stage.accelerate();
            for (body, out) in self.accelerations.iter_mut().enumerate() {
                let there = found.of_body(body);
                out.r += there.r * weight;
                for (out, e) in out.e.iter_mut().zip(there.e) {
                    *out += e * weight;
                }
            }
        }
        Ok(())
    }

    /// Takes the accelerations from the velocities about the held time. At a singular position the rows say nothing about some
    /// of them, which the motion on both sides determines.
    fn accelerate_smoothly(&mut self) {
        let ([start, end], time) = (self.run.last_step(), self.stage.time);
        if end <= start {
            return;
        }
        let pace = state::fastest(self.run.system(), &[&*self.stage.q, &*self.stage.q_dot].concat());
        let width = (ASIDE * (NODES - 1) as f64 / pace).min(end - start);
        let first = (time - 0.5 * width).clamp(start, end - width);
        let nodes = std::array::from_fn(|k| first + width * k as f64 / (NODES - 1) as f64);
        let mut y = vec![0.0; 2 * self.run.system().coordinates];
        self.accelerations.fill(NaturalCoordinates::default());
        for (node, weight) in nodes.into_iter().zip(slope_weights(&nodes, time)) {
            self.run.look_into_step(node, &mut y);
            let system = self.run.system();
            let (q, q_dot) = y.split_at(system.coordinates);
            for (second, body) in self.accelerations.iter_mut().zip(&system.bodies) {
                let rate = body.layout.velocity(&body.layout.position(q), q_dot);
                second.r += rate.r * weight;
                for (second, rate) in second.e.iter_mut().zip(rate.e) {
                    *second += rate * weight;
                }
            }
        }
    }

    /// Why the motion cannot go on. At a dead point the multipliers of the joints and drivers that meet in it are far beyond all
    /// others.
    fn stopped(&self, error: EngineError) -> AnalysisError {
        let Some(time) = self.approach.dead_point() else { return error.into() };
        let state = self.run.state();
        let sizes: Vec<(bool, String, f64)> = state
            .multipliers()
            .iter()
            .zip(&self.run.system().constraints)
            .map(|(joint, constraint)| {
                let size = largest_size([joint.force, joint.moment].as_flattened());
                (constraint.driver, constraint.name.clone(), size)
            })
            .collect();
        let largest = sizes.iter().fold(0.0f64, |a, (_, _, size)| a.max(*size));
        let named = |driver: bool| {
            let involved = sizes.iter().filter(|s| s.0 == driver && s.2 >= INVOLVED * largest);
            involved.map(|(_, name, _)| name.clone()).collect()
        };
        AnalysisError::Unreachable { time, drivers: named(true), joints: named(false) }
    }
}

/// Whether the position in place, where S was factored, is nearly singular: whether more rows than those that depend on others
/// everywhere, so many, nearly do. Which ones these are changes while bodies turn: of the three rows of a point that can only go along a
/// circle, the one that moves the most holds. Where those that were kept do so no longer, others are taken from here on.
fn is_nearly_singular(on: &mut ProjectableState<'_>, dependent: usize) -> bool {
    let ProjectableState { system, state, elimination, .. } = on;
    if elimination.pivot_products().iter().all(|product| *product >= NEARLY_SINGULAR) {
        return false;
    }
    if dependent == 0 {
        return true;
    }
    let here = elimination.dependent_rows(system, state, NEARLY_SINGULAR);
    let singular = here.len() > dependent;
    if !singular {
        elimination.set_dependent(&here);
    }
    elimination.linearize(system, state);
    singular
}

/// What numbers at some times contribute to the slope, at time t, of the polynomial through them.
fn slope_weights(nodes: &[f64; NODES], t: f64) -> [f64; NODES] {
    let others =
        |but: [usize; 2]| nodes.iter().enumerate().filter(move |(k, _)| !but.contains(k)).map(|(_, x)| *x);
    std::array::from_fn(|j| {
        let terms = (0..NODES).filter(|&m| m != j).map(|m| {
            others([j, m]).map(|x| (t - x) / (nodes[j] - x)).product::<f64>() / (nodes[j] - nodes[m])
        });
        terms.sum()
    })
}

/// A model with its joints and drivers alone: bodies of one mass and one inertia, no weight and no loads.
fn bare(mut model: Model) -> Model {
    let length = System::new(model.clone()).length;
    // A power of two near the masses: what rounding leaves of directors is a force in their scale, and nothing else changes.
    let heaviest = model.bodies.iter().fold(f64::MIN_POSITIVE, |most, body| most.max(body.mass));
    let mass = f64::from_bits(heaviest.to_bits() & POWER_OF_TWO);
    for body in &mut model.bodies {
        (body.mass, body.principal) = (mass, Vector3::repeat(mass * length * length));
    }
    model.gravity = Vector3::zeros();
    // Springs about joints stay, without force: whole turns of their angles are counted, for their moments.
    model.loads.retain_mut(|load| match &mut load.kind {
        LoadKind::Torsion { law, .. } => {
            *law = ForceLaw { stiffness: 0.0, free: 0.0, damping: 0.0, drive: None, friction: None };
            true
        }
        _ => false,
    });
    let settings = &mut model.settings;
    (settings.integrator, settings.constraint_method) =
        (IntegratorKind::Taylor, ConstraintMethod::Projection);
    (settings.step, settings.tolerance) = (None, TOLERANCE);
    // Steps follow from the motion, not from where it is asked for.
    settings.skip.outputs = true;
    model
}
