//! The start of a run: the scene is checked and assembled, its rank found, its integrator chosen.

use super::companion::Companion;
use super::examiner::Examiner;
use super::lent_inertia::LentInertia;
use super::notes::Notes;
use super::seen::Seen;
use super::singularity::SingularityMonitor;
use super::state_view::CachedState;
use super::{Simulation, explain};
use crate::error::EngineError;
use crate::integrate::{self, Integrator};
use crate::model::{CustomLoad, CustomLoadError, Model};
use crate::scene::{ConstraintMethod, IntegratorKind, Scene};
use std::sync::OnceLock;
use triad_dynamics::constraints::ConstraintError;
use triad_dynamics::constraints::branch::{self, Branch};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::constraints::rank::{self, Rank};
use triad_dynamics::constraints::start;
use triad_dynamics::dynamics::elimination::Counters;
use triad_dynamics::system::System;

impl Simulation {
    /// Checks, assembles and starts a scene.
    ///
    /// # Errors
    ///
    /// [`EngineError::Model`] for a scene that cannot be, [`EngineError::Constraint`] for constraints that cannot be met,
    /// each with the body or joint and its place in the scene.
    ///
    /// ```
    /// use triad_engine::prelude::*;
    ///
    /// let mut scene = Scene::new("apart");
    /// let rod = scene.add(Body::rod("rod", 1.0, [0.0; 3], [1.0, 0.0, 0.0]));
    /// scene.add(Joint::spherical("left", Ground, &rod).at([0.0; 3]));
    /// assert_eq!(Simulation::new(&scene)?.system().coordinates, 12);
    /// # Ok::<(), EngineError>(())
    /// ```
    pub fn new(scene: &Scene) -> Result<Self, EngineError> {
        Self::from_model(Model::new(scene)?)
    }

    /// Starts a scene on which further loads act, each a function of the state: see [`CustomLoad`].
    ///
    /// # Errors
    ///
    /// Those of [`Simulation::new`], and [`EngineError::CustomLoad`] with the name of the load.
    ///
    /// ```
    /// use triad_engine::prelude::*;
    ///
    /// let scene = catalogue::scene("free-fall")?;
    /// let push = CustomLoad::new("push", "stone", |_| Wrench::force([1.0, 0.0, 0.0]));
    /// let error = Simulation::with_loads(&scene, [push]).unwrap_err();
    /// assert_eq!(error.to_string(), "load \"push\" asks for body \"stone\", which the scene does not have");
    /// # Ok::<(), EngineError>(())
    /// ```
    pub fn with_loads(
        scene: &Scene,
        loads: impl IntoIterator<Item = CustomLoad>,
    ) -> Result<Self, EngineError> {
        Self::from_model(Model::new(scene)?.with_loads(loads)?)
    }

    /// Assembles and starts a checked model.
    ///
    /// # Errors
    ///
    /// [`EngineError::Constraint`] and [`EngineError::CustomLoad`].
    pub fn from_model(model: Model) -> Result<Self, EngineError> {
        let (mut mechanism, mut start, mut notes) = assemble(model, &|| true)?;
        let rank = analyze_rank(&mut mechanism, &mut start, &mut notes, &|| true)?;
        Self::assembled(mechanism, start, rank, notes)
    }

    /// Starts what was assembled.
    pub(crate) fn assembled(
        mut mechanism: Mechanism,
        start: Vec<f64>,
        rank: Rank,
        mut notes: Notes,
    ) -> Result<Self, EngineError> {
        mechanism.set_state(0.0, &start);
        // From where the joints were closed, not from what was given of them: the first step may be half a turn from there.
        mechanism.state.commit_motion();
        let state = &mechanism.state;
        let (current, start_energy) = (CachedState::new(0.0, &start, state), state.energy(&mechanism.system));
        check_loads(&mechanism)?;
        let mut lent_inertia = LentInertia::of(&mechanism);
        lent_inertia.look(&mut mechanism, 0.0, &start)?;
        let (kind, reason) = integrate::choose(&mut mechanism, &start);
        let asked = mechanism.system.model.settings.integrator;
        if asked != IntegratorKind::Auto && asked != kind {
            notes.add(format!("runs by {kind}: {reason}"));
        }
        mechanism.elimination.counters = Counters::default();
        let companion = Companion::start(kind, &mechanism, 0.0, &start);
        let integrator = Integrator::start(kind, &mut mechanism, 0.0, &start);
        if let Some(note) = integrator.told_of_steps() {
            notes.add(note);
        }
        let singularities = SingularityMonitor::new(&mut mechanism, &rank);
        let conservative = mechanism.system.is_conservative();
        let interpolates = !conservative || !mechanism.system.event_functions.is_empty();
        let scratch = vec![0.0; if interpolates { start.len() } else { 0 }];
        let end = mechanism.system.model.settings.duration;
        let seen = Seen::new(0.0, &start);
        let mut simulation = Self {
            mechanism,
            integrator,
            companion,
            kind,
            reason,
            start,
            rank,
            notes,
            current,
            start_energy,
            seen,
            conservative,
            lent_inertia,
            work: 0.0,
            scratch,
            step_limit: u64::MAX,
            occurrences: Vec::new(),
            judged_events: 0,
            off_at_start: OnceLock::new(),
            last_numbers: Vec::new(),
            end,
            counters: explain::RunCounters::default(),
            singularities,
            examiner: Examiner::default(),
            before_branching: None,
        };
        simulation.restart_events();
        Ok(simulation)
    }
}

/// A mechanism, its start (q, q̇) moved onto the constraints, and what was found or corrected, as long as that is wanted.
pub(crate) fn assemble(
    model: Model,
    wanted: &dyn Fn() -> bool,
) -> Result<(Mechanism, Vec<f64>, Notes), ConstraintError> {
    let of_scene = model.notes.len();
    let (mut mechanism, mut start) = start::mechanism_while(model, wanted);
    let mut notes = mechanism.system.model.notes.clone();
    notes.extend(mechanism.assemble_while(&mut start, wanted)?);
    Ok((mechanism, start, Notes::new(notes, of_scene)))
}

/// Finds the rank of a mechanism near its start, as long as that is wanted, and hands the dependent rows to its elimination; counters are
/// reset. The velocities of a singular start become those of a branch of the motion.
pub(crate) fn analyze_rank(
    mechanism: &mut Mechanism,
    start: &mut [f64],
    notes: &mut Notes,
    wanted: &dyn Fn() -> bool,
) -> Result<Rank, ConstraintError> {
    let Mechanism { system, state, elimination, .. } = mechanism;
    let (q, q_dot) = start.split_at_mut(system.coordinates);
    let rank = rank::analyze_while(system, state, q, wanted);
    rank::check_masses(system, state, elimination, q)?;
    if rank.lost_at_start() > 0 {
        notes.add_of_start(singular_start(&rank, branch::take(system, state, q, q_dot)));
        notes.add_of_start(AT_SINGULAR_START.to_owned());
    }
    if let Some((joint, part)) = rank.inexact {
        notes.add(format!(
            "joint \"{}\" holds what others hold, but not exactly: a motion opens it by {part:.0e} of its length, which is taken for \
             rounding; give axes and points with all their digits, or a joint that leaves free what the others hold",
            system[joint].name
        ));
    }
    if !(rank.dependent.is_empty() || system.frictions.is_empty()) {
        notes.add(
            "joints hold more than once what they hold: friction with a coefficient follows the smallest reactions that do, which \
             need not be those of a real mechanism"
                .to_owned(),
        );
    }
    elimination.set_dependent(&rank.dependent);
    elimination.counters = Counters::default();
    Ok(rank)
}

/// What equations of second order say of a singular start.
const AT_SINGULAR_START: &str = "until bodies have moved by a thousandth of the mechanism's length, accelerations and forces are not those of \
                                 the branch that is followed, which the equations hardly determine there";

/// That rows lose their hold at the start, and which branch of the motion begins there.
fn singular_start(rank: &Rank, branch: Branch) -> String {
    let lost = rank.lost_at_start();
    let begins = format!(
        "the start is a singular position: {lost} rows lose their hold there, and several branches of motion may begin"
    );
    match branch {
        Branch::Given => format!(
            "{begins}; without a velocity that chooses one, which of them is followed is not determined"
        ),
        Branch::Chosen(changed) => format!(
            "{begins}; the velocities belonged to none, and were changed by up to {changed:.1e} to those of one that is near: give velocities \
             that choose one"
        ),
        Branch::None => format!(
            "{begins}; the velocities belong to none, and none was found near them: no motion goes on with them, and what follows is not \
             to be trusted"
        ),
    }
}

/// Refuses custom loads that cannot be evaluated at the start, and loads that the integrator cannot that the scene asks for.
fn check_loads(mechanism: &Mechanism) -> Result<(), EngineError> {
    check_friction(&mechanism.system)?;
    let model = &mechanism.system.model;
    let Some(load) = model.custom_loads.first() else { return Ok(()) };
    if model.settings.integrator == IntegratorKind::Taylor {
        return Err(CustomLoadError::NoSeries { load: load.name.clone() }.into());
    }
    for load in &model.custom_loads {
        load.at(model, 0.0, &mechanism.state)?;
    }
    Ok(())
}

/// Refuses dry friction where the reactions that load it are not solved for with the accelerations.
fn check_friction(system: &System) -> Result<(), EngineError> {
    let settings = &system.model.settings;
    if system.frictions.is_empty() {
        return Ok(());
    }
    let why = match (settings.integrator, settings.constraint_method) {
        (IntegratorKind::Taylor, _) => {
            "friction with a coefficient follows from the reactions, whose series are not known before those of the motion"
        }
        (IntegratorKind::Rattle, _) => {
            "friction with a coefficient follows from the reactions, which its steps know as impulses alone"
        }
        (_, ConstraintMethod::Penalty { .. } | ConstraintMethod::AugmentedLagrangian { .. }) => {
            "friction with a coefficient follows from the reactions, for which this treatment of the constraints puts penalties"
        }
        _ => return Ok(()),
    };
    Err(EngineError::Integrator { integrator: settings.integrator, why })
}
