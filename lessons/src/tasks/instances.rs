//! States at which a student's program evaluates the equations, drawn for each student and question.

use std::collections::BTreeMap;

use thiserror::Error;
use triad_engine::EngineError;
use triad_engine::constraints::mechanism::Mechanism;
use triad_engine::equations::augmented::AugmentedSystem;
use triad_engine::run::Simulation;
use triad_engine::scene::Scene;
use triad_engine::system::natural::Director;
use triad_engine::system::row::Form;

use super::grid::Grid;
use crate::exercise::{Implement, QuestionBody};
use crate::files::EquationPart;
use crate::lesson::Lesson;
use crate::random::SeededRandom;
use crate::scenario::equations::augmented_at;

/// Draws after which the search for a consistent state ends with an error.
const MAX_DRAWS: usize = 40;
/// Largest coordinate of a state that satisfies nothing, m.
const FREE_POSITION: f64 = 1.0;
/// Largest rate of a coordinate of such a state, m/s.
const FREE_VELOCITY: f64 = 2.0;
/// Distance of a consistent state from the start before assembly, as a part of the mechanism's length.
const NEAR_START: f64 = 0.2;
/// Rates of a consistent state before assembly, mechanism's lengths per second.
const NEAR_START_RATE: f64 = 2.0;

/// Why there are no instances.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum InstanceError {
    /// Relations of angles.
    #[error("gears, screws and angle drivers are not polynomials; leave them out")]
    NotPolynomial,
    /// Shared directors.
    #[error("bodies that share directors have no columns of their own; write full or reduced")]
    SharedDirectors,
    /// The augmented system is singular.
    #[error("the equations of motion have no solution at a state that was drawn")]
    Singular,
    /// Assembly failed for every draw.
    #[error("no state near the start satisfies the constraints")]
    NoneConsistent,
    /// A relation that a program's input cannot describe.
    #[error("a relation of angles cannot be given as numbers")]
    Relation,
    /// A prescribed point or vector.
    #[error("a point or vector that moves as prescribed cannot be given as numbers; use an angle")]
    MovingFeature,
    /// The scene does not start.
    #[error(transparent)]
    Engine(Box<EngineError>),
}

impl From<EngineError> for InstanceError {
    fn from(error: EngineError) -> Self {
        Self::Engine(Box::new(error))
    }
}

/// A state at which the equations are asked for.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Instance {
    pub t: f64,
    pub q: Vec<f64>,
    pub q_dot: Vec<f64>,
}

impl Instance {
    fn together(&self) -> Vec<f64> {
        [self.q.as_slice(), self.q_dot.as_slice()].concat()
    }
}

/// A mechanism and the states at which its equations are asked for.
pub(crate) struct Instances {
    pub mechanism: Mechanism,
    pub states: Vec<Instance>,
    /// The equations at each state.
    augmented: Vec<AugmentedSystem>,
}

impl Instances {
    /// The states of a seed.
    pub(crate) fn new(task: &Implement, seed: &str) -> Result<Self, InstanceError> {
        let mut mechanism = mechanism(&task.scene)?;
        if mechanism.system.rows.iter().any(|row| matches!(row.form, Form::Relation { .. })) {
            return Err(InstanceError::NotPolynomial);
        }
        let own = |d: &Director| d.is_own() || *d == Director::Product;
        if !mechanism.system.bodies.iter().all(|body| body.layout.directors.iter().all(own)) {
            return Err(InstanceError::SharedDirectors);
        }
        let mut random = SeededRandom::new(seed);
        let mut states = Vec::with_capacity(task.states);
        for _ in 0..task.states {
            states.push(if task.consistent {
                consistent(&mut mechanism, &task.scene, &mut random)?
            } else {
                anything(&mechanism, &task.scene, &mut random)
            });
        }
        Ok(Self::at_states(mechanism, states))
    }

    /// A mechanism at given states.
    pub(crate) fn at_states(mut mechanism: Mechanism, states: Vec<Instance>) -> Self {
        let augmented = states.iter().map(|s| augmented_at(&mut mechanism, s.t, &s.together())).collect();
        Self { mechanism, states, augmented }
    }

    /// Puts state `k` in place and hands out the mechanism and its equations there.
    pub(super) fn placed(&mut self, k: usize) -> (&Mechanism, &AugmentedSystem) {
        let state = &self.states[k];
        self.mechanism.set_state(state.t, &state.together());
        (&self.mechanism, &self.augmented[k])
    }

    /// What is asked for, at every state.
    pub(crate) fn answers(&self, part: EquationPart) -> Result<Vec<Grid>, InstanceError> {
        self.augmented.iter().map(|augmented| part_of(augmented, part)).collect()
    }

    /// Several parts, at every state.
    pub(crate) fn all_answers(
        &self,
        parts: &[EquationPart],
    ) -> Result<BTreeMap<EquationPart, Vec<Grid>>, InstanceError> {
        parts.iter().map(|part| Ok((*part, self.answers(*part)?))).collect()
    }
}

/// The system of a scene, ready to be put into any state.
fn mechanism(scene: &Scene) -> Result<Mechanism, InstanceError> {
    let simulation = Simulation::new(scene)?;
    let mut mechanism = Mechanism::new(simulation.system().clone());
    mechanism.elimination.set_redundant(!simulation.rank().dependent.is_empty());
    Ok(mechanism)
}

/// One part of the equations.
pub(crate) fn part_of(augmented: &AugmentedSystem, part: EquationPart) -> Result<Grid, InstanceError> {
    let matrix = |m: &dyn Fn(usize, usize) -> f64, rows, columns| Grid::make(rows, columns, m);
    Ok(match part {
        EquationPart::Phi => Grid::column(augmented.constraints.iter().copied().collect()),
        EquationPart::Gamma => Grid::column(augmented.gamma.iter().copied().collect()),
        EquationPart::Jacobian => {
            let j = &augmented.jacobian;
            matrix(&|row, column| j[(row, column)], j.nrows(), j.ncols())
        }
        EquationPart::Mass => {
            let m = &augmented.mass;
            matrix(&|row, column| m[(row, column)], m.nrows(), m.ncols())
        }
        EquationPart::Acceleration => {
            let solution = augmented.solve().ok_or(InstanceError::Singular)?;
            Grid::column(solution.acceleration.iter().copied().collect())
        }
    })
}

/// A number between −size and size.
fn within(random: &mut SeededRandom, size: f64) -> f64 {
    (random.unit() * 2.0 - 1.0) * size
}

/// A number with three decimals.
fn rounded(x: f64) -> f64 {
    (x * 1e3).round() / 1e3
}

/// A time that matters only where something depends on it, s.
fn time(scene: &Scene, random: &mut SeededRandom) -> f64 {
    let moment = rounded(random.unit());
    if scene.drivers.is_empty() && scene.loads.is_empty() { 0.0 } else { moment }
}

/// Numbers that satisfy nothing.
fn anything(mechanism: &Mechanism, scene: &Scene, random: &mut SeededRandom) -> Instance {
    let n = mechanism.system.coordinates;
    let t = time(scene, random);
    let q = (0..n).map(|_| rounded(within(random, FREE_POSITION))).collect();
    let q_dot = (0..n).map(|_| rounded(within(random, FREE_VELOCITY))).collect();
    Instance { t, q, q_dot }
}

/// A state that satisfies the constraints, near the start.
fn consistent(
    mechanism: &mut Mechanism,
    scene: &Scene,
    random: &mut SeededRandom,
) -> Result<Instance, InstanceError> {
    let n = mechanism.system.coordinates;
    let length = mechanism.system.length;
    for _ in 0..MAX_DRAWS {
        let t = time(scene, random);
        let mut y = vec![0.0; 2 * n];
        let (q, q_dot) = y.split_at_mut(n);
        mechanism.system.start(q, q_dot);
        for x in &mut *q {
            *x += within(random, NEAR_START * length);
        }
        for x in &mut *q_dot {
            *x += within(random, NEAR_START_RATE * length);
        }
        if mechanism.assemble_at(t, &mut y).is_ok() {
            let q_dot = y.split_off(n);
            return Ok(Instance { t, q: y, q_dot });
        }
    }
    Err(InstanceError::NoneConsistent)
}

/// The question of a lesson that a program answers.
pub(crate) fn task<'a>(lesson: &'a Lesson, question: &str) -> Option<&'a Implement> {
    match &lesson.question(question)?.body {
        QuestionBody::Implement(task) => Some(task),
        _ => None,
    }
}

/// The seed of the states of a question: each student and each question has their own.
pub(crate) fn seed(lesson: &Lesson, question: &str) -> String {
    format!("{}/{question}/{}", lesson.slug, lesson.drawn_from)
}
