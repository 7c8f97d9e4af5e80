//! The equations of a mechanism at states that are dealt to a student, and the same with a slip.

mod answer;
mod slips;
mod view;

use triad_engine::lift::Director;
use triad_engine::literal::Literal;
use triad_engine::mechanism::Mechanism;
use triad_engine::row::Form;
use triad_engine::scene::Scene;
use triad_engine::simulation::Simulation;

pub(crate) use answer::{Given, Shape, read};
pub(crate) use slips::{all_agree, recognise, slipped};
pub use view::DealView;

use crate::exercise::{Body, Implement};
use crate::files::Part;
use crate::lesson::Lesson;
use crate::random::Random;
use crate::slip::literal_at;

/// Draws after which a consistent state is given up.
const MOST_DRAWS: usize = 40;

/// Rows of numbers.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Grid {
    pub rows: usize,
    pub columns: usize,
    /// Row by row.
    pub values: Vec<f64>,
}

impl Grid {
    pub(crate) fn column(values: Vec<f64>) -> Self {
        Self { rows: values.len(), columns: 1, values }
    }

    fn make(rows: usize, columns: usize, value: impl Fn(usize, usize) -> f64) -> Self {
        let values = (0..rows * columns).map(|k| value(k / columns, k % columns)).collect();
        Self { rows, columns, values }
    }

    pub(crate) fn at(&self, row: usize, column: usize) -> f64 {
        self.values[row * self.columns + column]
    }

    fn scaled(&self, k: f64) -> Self {
        Self { values: self.values.iter().map(|x| k * x).collect(), ..*self }
    }

    pub(crate) fn transposed(&self) -> Self {
        Self::make(self.columns, self.rows, |row, column| self.at(column, row))
    }

    /// Largest size of an entry, at least 1: the scale of a tolerance.
    pub(crate) fn scale(&self) -> f64 {
        self.values.iter().fold(1.0, |a, x| a.max(x.abs()))
    }

    /// Whether all entries agree, where a difference of `tolerance` times `scale` is allowed.
    pub(crate) fn agrees(&self, other: &Self, tolerance: f64, scale: f64) -> bool {
        (self.rows, self.columns) == (other.rows, other.columns)
            && self.values.iter().zip(&other.values).all(|(a, b)| (a - b).abs() <= tolerance * scale)
    }
}

/// A state that is dealt.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct State {
    pub t: f64,
    pub q: Vec<f64>,
    pub q_dot: Vec<f64>,
}

impl State {
    fn together(&self) -> Vec<f64> {
        [self.q.as_slice(), self.q_dot.as_slice()].concat()
    }
}

/// A mechanism and the states at which its equations are asked for.
pub(crate) struct Deal {
    pub mechanism: Mechanism,
    pub states: Vec<State>,
    /// The equations at each state.
    literals: Vec<Literal>,
}

impl Deal {
    /// The states of a seed.
    pub(crate) fn new(task: &Implement, seed: &str) -> Result<Self, String> {
        let mut mechanism = mechanism(&task.scene)?;
        if mechanism.system.rows.iter().any(|row| matches!(row.form, Form::Relation { .. })) {
            return Err("gears, screws and angle drivers are not polynomials; leave them out".to_owned());
        }
        let own = |d: &Director| d.is_own() || *d == Director::Product;
        if !mechanism.system.bodies.iter().all(|body| body.layout.directors.iter().all(own)) {
            return Err(
                "bodies that share directors have no columns of their own; write full or reduced".to_owned()
            );
        }
        let mut random = Random::new(seed);
        let mut states = Vec::with_capacity(task.states);
        for _ in 0..task.states {
            states.push(if task.consistent {
                consistent(&mut mechanism, &task.scene, &mut random)?
            } else {
                anything(&mechanism, &task.scene, &mut random)
            });
        }
        Ok(Self::at(mechanism, states))
    }

    /// A mechanism at given states.
    pub(crate) fn at(mut mechanism: Mechanism, states: Vec<State>) -> Self {
        let literals = states.iter().map(|s| literal_at(&mut mechanism, s.t, &s.together())).collect();
        Self { mechanism, states, literals }
    }

    /// Puts state `k` in place and hands out the mechanism and its equations there.
    fn placed(&mut self, k: usize) -> (&Mechanism, &Literal) {
        let state = &self.states[k];
        self.mechanism.set_state(state.t, &state.together());
        (&self.mechanism, &self.literals[k])
    }

    /// What is asked for, at every state.
    pub(crate) fn answers(&self, part: Part) -> Result<Vec<Grid>, String> {
        self.literals.iter().map(|literal| part_of(literal, part)).collect()
    }
}

/// The system of a scene, ready to be put into any state.
fn mechanism(scene: &Scene) -> Result<Mechanism, String> {
    let simulation = Simulation::new(scene).map_err(|e| e.to_string())?;
    let mut mechanism = Mechanism::new(simulation.system().clone());
    mechanism.elimination.set_redundant(!simulation.rank().dependent.is_empty());
    Ok(mechanism)
}

/// One part of the equations.
pub(crate) fn part_of(literal: &Literal, part: Part) -> Result<Grid, String> {
    let matrix = |m: &dyn Fn(usize, usize) -> f64, rows, columns| Grid::make(rows, columns, m);
    Ok(match part {
        Part::Phi => Grid::column(literal.constraints.iter().copied().collect()),
        Part::Gamma => Grid::column(literal.gamma.iter().copied().collect()),
        Part::Jacobian => {
            let j = &literal.jacobian;
            matrix(&|row, column| j[(row, column)], j.nrows(), j.ncols())
        }
        Part::Mass => {
            let m = &literal.mass;
            matrix(&|row, column| m[(row, column)], m.nrows(), m.ncols())
        }
        Part::Acceleration => {
            let solution =
                literal.solve().ok_or("the equations of motion have no solution at a dealt state")?;
            Grid::column(solution.acceleration.iter().copied().collect())
        }
    })
}

/// A number between −size and size with three decimals.
fn short(random: &mut Random, size: f64) -> f64 {
    (random.unit() * 2.0 - 1.0) * size
}

fn rounded(x: f64) -> f64 {
    (x * 1e3).round() / 1e3
}

fn time(scene: &Scene, random: &mut Random) -> f64 {
    let moment = rounded(random.unit());
    if scene.drivers.is_empty() && scene.loads.is_empty() { 0.0 } else { moment }
}

/// Numbers that satisfy nothing.
fn anything(mechanism: &Mechanism, scene: &Scene, random: &mut Random) -> State {
    let n = mechanism.system.coordinates;
    let t = time(scene, random);
    let q = (0..n).map(|_| rounded(short(random, 1.0))).collect();
    let q_dot = (0..n).map(|_| rounded(short(random, 2.0))).collect();
    State { t, q, q_dot }
}

/// A state that satisfies the constraints, near the start.
fn consistent(mechanism: &mut Mechanism, scene: &Scene, random: &mut Random) -> Result<State, String> {
    let n = mechanism.system.coordinates;
    let length = mechanism.system.length;
    for _ in 0..MOST_DRAWS {
        let t = time(scene, random);
        let mut y = vec![0.0; 2 * n];
        let (q, q_dot) = y.split_at_mut(n);
        mechanism.system.start(q, q_dot);
        for x in &mut *q {
            *x += short(random, 0.2 * length);
        }
        for x in &mut *q_dot {
            *x += short(random, 2.0 * length);
        }
        if mechanism.assemble_at(t, &mut y).is_ok() {
            let q_dot = y.split_off(n);
            return Ok(State { t, q: y, q_dot });
        }
    }
    Err("no state near the start satisfies the constraints".to_owned())
}

/// The implement question of a lesson.
pub(crate) fn task<'a>(lesson: &'a Lesson, question: &str) -> Option<&'a Implement> {
    match &lesson.question(question)?.body {
        Body::Implement(task) => Some(task),
        _ => None,
    }
}

/// The seed of the states of a question: each student and each question has their own.
pub(crate) fn seed(lesson: &Lesson, question: &str) -> String {
    format!("{}/{question}/{}", lesson.slug, lesson.seed)
}
