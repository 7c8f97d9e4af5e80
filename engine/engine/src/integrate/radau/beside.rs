//! A run beside another one of the same method, for the estimate of its error: in the same steps and coordinates, with two more stages, and
//! begun from what the other one has found, so that little is left to solve.

use super::Radau;
use super::coefficients::{RADAU_9, RADAU_13, RADAU_17};
use super::factors::Factors;
use super::linear::RateJacobian;
use super::stages::Stages;
use nalgebra::DMatrix;
use triad_dynamics::ode::OdeSystem;

/// What such a run needs beside its own steps.
#[derive(Clone, Debug)]
pub struct Beside {
    /// Two stages more than the other has.
    pub stages: Stages,
    /// Whether the last step was taken with them.
    pub stepped: bool,
    /// Weights of the other's stages in its polynomial at each of these: a column for each.
    between: DMatrix<f64>,
    jacobian: RateJacobian,
    factors: Factors,
}

impl Beside {
    fn new(other: &Stages, n: usize) -> Self {
        let known = other.method.stages();
        let tables = match known {
            3 => &RADAU_9,
            5 => &RADAU_13,
            _ => &RADAU_17,
        };
        let stages = Stages::new(tables, n);
        let mut between = DMatrix::zeros(known, tables.nodes.len());
        let mut weights = vec![0.0; known];
        for (mut column, (node, _)) in between.column_iter_mut().zip(tables.nodes) {
            other.method.collocation(*node, &mut weights);
            column.copy_from_slice(&weights);
        }
        let factors = Factors::new(n / 2, &stages.blocks);
        Self { stages, stepped: false, between, jacobian: RateJacobian::new(n / 2), factors }
    }

    /// Takes the matrices of the other run for a step of size h. False if one is singular.
    fn factor(&mut self, jacobian: &RateJacobian, h: f64) -> bool {
        let same = self.jacobian.copy_from(jacobian);
        let known = same && self.factors.h == h;
        known || self.factors.factor(&self.jacobian, &self.stages.blocks, h)
    }
}

impl Radau {
    /// Takes the last step of another run, in the same coordinates. False, and nothing has changed, where that is not possible.
    pub(super) fn follow_step(&mut self, system: &mut impl OdeSystem, other: &Self) -> bool {
        let h = other.last.h;
        if other.fixed || h <= 0.0 || self.last.t != other.last.t_old || !other.jacobian.valid {
            return false;
        }
        let n = self.last.y.len();
        let known = self.beside.take().filter(|beside| beside.between.nrows() == other.stages.z.len());
        let mut beside = known.unwrap_or_else(|| Box::new(Beside::new(&other.stages, n)));
        beside.stages.latest = other.stages.latest;
        let found = beside.factor(&other.jacobian, h) && self.find_beside(system, other, &mut beside);
        if found {
            beside.stepped = true;
            beside.stages.accept();
            self.x_old.copy_from_slice(&self.last.y);
            self.last.y.copy_from_slice(&self.trial);
            self.last.follow(&other.last);
            // What steps of its own begin with, should they be needed.
            self.h = 0.5 * h;
            self.turnover = other.turnover;
            system.after_step(self.last.t, &mut self.last.y, &mut self.rate);
        }
        self.beside = Some(beside);
        found
    }

    /// Finds the stages of that step, and puts the system to its end, `trial`.
    fn find_beside(&mut self, system: &mut impl OdeSystem, other: &Self, beside: &mut Beside) -> bool {
        let Beside { stages, between, jacobian, factors, .. } = beside;
        if !stages.solve_beside(
            system,
            &self.last,
            (jacobian, factors),
            (&other.stages, between, &other.last.y),
            self.estimated,
        ) {
            return false;
        }
        let Some(z) = stages.z.last() else { return false };
        for (trial, (x, z)) in self.trial.iter_mut().zip(self.last.y.iter().zip(z)) {
            *trial = x + z;
        }
        system.begin_stage(stages.z.len() - 1, false);
        system.reach(other.last.t, &self.trial)
    }

    /// Goes on by steps of its own after one that was taken beside another run.
    pub(super) fn go_alone(&mut self, system: &mut impl OdeSystem) {
        if self.beside.as_mut().is_some_and(|beside| std::mem::take(&mut beside.stepped)) {
            system.rhs(self.last.t, &self.last.y, &mut self.rate);
            self.last.h = 0.0;
            self.power = system.power();
            self.before = None;
            self.jacobian.valid = false;
            self.factors.forget();
        }
    }

    /// The stages of the last step.
    pub(super) fn last_stages(&mut self) -> &mut Stages {
        match &mut self.beside {
            Some(beside) if beside.stepped => &mut beside.stages,
            _ => &mut self.stages,
        }
    }
}
