//! Accelerations of an open tree in the coordinates of its joints — eq. (7.13): where no loop is closed there are no multipliers to
//! solve for, only a matrix of the size of the coordinates, which has no entries between branches.
//!
//! The matrix comes from composite bodies, the forces from the leaves to the ground, and both are factored and solved along
//! the branches (Featherstone, Rigid Body Dynamics Algorithms, sections 5.3, 6.2 and 6.5).

use super::spatial::Twist;
use super::tree::Tree;
use super::tree_lanes::TreeLanes;
use nalgebra::Vector3;
use std::ops::AddAssign;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::system::System;
use triad_dynamics::system::body::RigidBody;
use triad_dynamics::system::natural::NaturalCoordinates;

/// A force and its moment about the point of reference, N and N m; or a momentum likewise.
#[derive(Clone, Copy, Debug, Default)]
struct Wrench {
    force: Vector3<f64>,
    moment: Vector3<f64>,
}

impl Wrench {
    /// Power along a twist, or what a coordinate feels of it.
    fn along(&self, twist: &Twist) -> f64 {
        self.force.dot(&twist.flow) + self.moment.dot(&twist.spin)
    }
}

impl AddAssign for Wrench {
    fn add_assign(&mut self, other: Self) {
        self.force += other.force;
        self.moment += other.moment;
    }
}

/// Mass, first moments and inertia about the point of reference: xx, yy, zz, yz, xz, xy.
#[derive(Clone, Copy, Debug, Default)]
struct Inertia {
    mass: f64,
    first: Vector3<f64>,
    about: [f64; 6],
}

impl Inertia {
    /// Of a body at q, seen from `center`.
    fn of(body: &RigidBody, q: &NaturalCoordinates, center: &Vector3<f64>) -> Self {
        let (arm, mass) = (q.r - center, body.mass);
        let first = arm * mass;
        let mut squares = [
            arm.x * first.x,
            arm.y * first.y,
            arm.z * first.z,
            arm.y * first.z,
            arm.x * first.z,
            arm.x * first.y,
        ];
        for (e, i) in q.e.iter().zip(body.ibar.iter()) {
            let p = e * *i;
            let more = [e.x * p.x, e.y * p.y, e.z * p.z, e.y * p.z, e.x * p.z, e.x * p.y];
            squares.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
        }
        let [xx, yy, zz, yz, xz, xy] = squares;
        Self { mass, first, about: [yy + zz, xx + zz, xx + yy, -yz, -xz, -xy] }
    }

    /// The momentum at a twist, whose flow is that of the point of reference.
    fn momentum(&self, Twist { spin, flow }: &Twist) -> Wrench {
        let [xx, yy, zz, yz, xz, xy] = self.about;
        let turning = Vector3::new(
            xx * spin.x + xy * spin.y + xz * spin.z,
            xy * spin.x + yy * spin.y + yz * spin.z,
            xz * spin.x + yz * spin.y + zz * spin.z,
        );
        Wrench { force: flow * self.mass + spin.cross(&self.first), moment: turning + self.first.cross(flow) }
    }
}

impl AddAssign for Inertia {
    fn add_assign(&mut self, other: Self) {
        self.mass += other.mass;
        self.first += other.first;
        self.about.iter_mut().zip(other.about).for_each(|(sum, more)| *sum += more);
    }
}

/// The equations of motion of a tree, with the factors of its mass matrix at the positions that were factored last.
#[derive(Clone, Debug)]
pub struct TreeDynamics {
    /// Point of reference for moments, in the middle of the mechanism: about one far away they would cancel each other.
    center: Vector3<f64>,
    /// The coordinate before each one on the way to the ground.
    before: Vec<Option<usize>>,
    /// Inertia of each body, and of all that it carries.
    own: Vec<Inertia>,
    carried: Vec<Inertia>,
    /// Twist of each coordinate with the flow of the point of reference.
    twists: Vec<Twist>,
    /// Acceleration of each body with no acceleration of a coordinate.
    accelerations: Vec<Twist>,
    /// What each body lacks for that, and all that it carries.
    lacking: Vec<Wrench>,
    /// M = Lᵀ D L by rows, the unit lower triangular L below the diagonal and D on it.
    matrix: Vec<f64>,
    /// The same for several states at once, where loads allow it.
    pub lanes: Option<Box<TreeLanes>>,
}

impl TreeDynamics {
    /// For the tree of a mechanism, if that alone decides how it moves: no other joint or driver, no friction that reactions load, and
    /// no body that lacks inertia.
    pub fn new(mechanism: &Mechanism, tree: &Tree) -> Option<Self> {
        let system = &mechanism.system;
        let bodies = system.bodies.len();
        let alone = system.constraints.len() == tree.joints()
            && system.frictions.is_empty()
            && !system.regularizes_inertia();
        let mut last = vec![None; bodies];
        let mut before = vec![None; tree.coordinates()];
        for edge in tree.edges() {
            let mut nearest = edge.parent.and_then(|parent| last[parent]);
            for place in edge.range() {
                before[place] = nearest;
                nearest = Some(place);
            }
            last[edge.body] = nearest;
        }
        let n = before.len();
        let middle: Vector3<f64> = mechanism.state.bodies().iter().map(|body| body.q.r).sum();
        let center = middle / bodies.max(1) as f64;
        alone.then(|| Self {
            lanes: TreeLanes::new(mechanism, tree, &before, &center).map(Box::new),
            center,
            before,
            own: vec![Inertia::default(); bodies],
            carried: vec![Inertia::default(); bodies],
            twists: vec![Twist::zero(); n],
            accelerations: vec![Twist::zero(); bodies],
            lacking: vec![Wrench::default(); bodies],
            matrix: vec![0.0; n * n],
        })
    }

    /// p̈ at the state in place, where the tree has the rates ṗ; `moved` says that the positions are others than last time.
    pub fn accelerate(
        &mut self,
        mechanism: &mut Mechanism,
        tree: &Tree,
        rates: &[f64],
        moved: bool,
        out: &mut [f64],
    ) {
        let Mechanism { system, state, elimination, .. } = mechanism;
        elimination.set_forces(system, state);
        elimination.counters.evaluations += 1;
        if moved {
            let at = state.bodies().iter().map(|body| &body.q);
            self.assemble(system, at, tree);
            self.factor();
        }
        let applied = |body: usize| {
            let (force, q) = (&elimination.bodies()[body].force, &state.bodies()[body].q);
            let moment: Vector3<f64> = (0..3).map(|k| q.e[k].cross(&force.e[k])).sum();
            Wrench { force: force.r, moment: moment + (q.r - self.center).cross(&force.r) }
        };
        for edge in tree.edges() {
            let rest = edge.parent.map_or_else(Twist::zero, |parent| self.accelerations[parent]);
            let drag = edge.range().fold(Twist::zero(), |sum, place| sum + *tree.drag(place) * rates[place]);
            let acceleration = rest + drag.about(&self.center);
            let (moving, own) = (tree.velocity(edge.body).about(&self.center), &self.own[edge.body]);
            let (momentum, change) = (own.momentum(&moving), own.momentum(&acceleration));
            let applied = applied(edge.body);
            self.lacking[edge.body] = Wrench {
                force: applied.force - change.force - moving.spin.cross(&momentum.force),
                moment: applied.moment
                    - change.moment
                    - moving.spin.cross(&momentum.moment)
                    - moving.flow.cross(&momentum.force),
            };
            self.accelerations[edge.body] = acceleration;
        }
        for edge in tree.edges().iter().rev() {
            let lacking = self.lacking[edge.body];
            for place in edge.range() {
                out[place] = lacking.along(&self.twists[place]);
            }
            if let Some(parent) = edge.parent {
                self.lacking[parent] += lacking;
            }
        }
        self.solve(out);
    }

    /// M at the positions of bodies, below its diagonal: entries (i, j) where coordinate i is carried by j.
    fn assemble<'a>(
        &mut self,
        system: &System,
        at: impl Iterator<Item = &'a NaturalCoordinates>,
        tree: &Tree,
    ) {
        for (own, (body, q)) in self.own.iter_mut().zip(system.bodies.iter().zip(at)) {
            *own = Inertia::of(body, q, &self.center);
        }
        for (place, twist) in self.twists.iter_mut().enumerate() {
            *twist = tree.twist(place).about(&self.center);
        }
        self.carried.copy_from_slice(&self.own);
        let n = self.before.len();
        for edge in tree.edges().iter().rev() {
            let carried = self.carried[edge.body];
            for place in edge.range() {
                let momentum = carried.momentum(&self.twists[place]);
                let mut other = Some(place);
                while let Some(column) = other {
                    self.matrix[place * n + column] = momentum.along(&self.twists[column]);
                    other = self.before[column];
                }
            }
            if let Some(parent) = edge.parent {
                self.carried[parent] += carried;
            }
        }
    }

    /// M = Lᵀ D L in place: from the leaves on nothing is filled in.
    fn factor(&mut self) {
        let (n, matrix) = (self.before.len(), &mut self.matrix);
        for k in (0..n).rev() {
            let pivot = matrix[k * n + k];
            let mut above = self.before[k];
            while let Some(i) = above {
                let factor = matrix[k * n + i] / pivot;
                let mut other = Some(i);
                while let Some(j) = other {
                    matrix[i * n + j] -= factor * matrix[k * n + j];
                    other = self.before[j];
                }
                matrix[k * n + i] = factor;
                above = self.before[i];
            }
        }
    }

    /// x ← M⁻¹ x.
    fn solve(&self, x: &mut [f64]) {
        let n = self.before.len();
        for i in (0..n).rev() {
            let mut above = self.before[i];
            while let Some(j) = above {
                x[j] -= self.matrix[i * n + j] * x[i];
                above = self.before[j];
            }
        }
        for i in 0..n {
            x[i] /= self.matrix[i * n + i];
            let mut above = self.before[i];
            while let Some(j) = above {
                x[i] -= self.matrix[i * n + j] * x[j];
                above = self.before[j];
            }
        }
    }
}
