//! The numbers among which a chart chooses: the coordinates q themselves, or those of joints along a tree.

use super::tree::Tree;
use super::tree_dynamics::TreeDynamics;
use super::tree_lanes::TreeLanes;
use nalgebra::{DMatrix, DVector, Vector3};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::model::{BodyMotion, Motions};
use triad_dynamics::system::natural::NaturalCoordinates;

/// The numbers p that describe a mechanism.
#[derive(Clone, Debug)]
pub enum Numbers {
    /// Its coordinates q.
    Coordinates,
    /// Coordinates of joints.
    Joints {
        /// The tree.
        tree: Box<Tree>,
        /// Room for a correction of q, which the bodies' own motions say better.
        unused: Vec<f64>,
        /// The equations of motion in these coordinates, where the tree alone decides how the mechanism moves.
        dynamics: Option<Box<TreeDynamics>>,
    },
}

impl Numbers {
    /// Coordinates of joints about the state in place.
    pub fn joints(mechanism: &Mechanism) -> Self {
        let unused = vec![0.0; mechanism.system.coordinates];
        let tree = Box::new(Tree::new(mechanism));
        let dynamics = TreeDynamics::new(mechanism, &tree).map(Box::new);
        Self::Joints { tree, unused, dynamics }
    }

    /// Whether the tree alone decides how the mechanism moves: then there is nothing to solve for.
    pub fn are_all_free(&self) -> bool {
        matches!(self, Self::Joints { dynamics: Some(_), .. })
    }

    /// The tree and its equations of motion for several states at once, where there are such.
    pub fn lanes(&mut self) -> Option<(&Tree, &mut TreeLanes)> {
        match self {
            Self::Joints { tree, dynamics: Some(dynamics), .. } => {
                dynamics.lanes.as_mut().map(|lanes| (&**tree, &mut **lanes))
            }
            _ => None,
        }
    }

    /// How many they are.
    pub fn count(&self, mechanism: &Mechanism) -> usize {
        match self {
            Self::Coordinates => mechanism.system.coordinates,
            Self::Joints { tree, .. } => tree.coordinates(),
        }
    }

    /// Writes (p, ṗ) of the state y, which is in place.
    pub fn read(&mut self, mechanism: &Mechanism, y: &[f64], p: &mut [f64], p_dot: &mut [f64]) {
        match self {
            Self::Coordinates => {
                p.copy_from_slice(&y[..p.len()]);
                p_dot.copy_from_slice(&y[p.len()..]);
            }
            Self::Joints { tree, .. } => {
                p.fill(0.0);
                tree.place(p);
                let of = |body| {
                    let BodyMotion { velocity, angular_velocity, .. } = mechanism.state.motion(body);
                    [velocity, angular_velocity]
                };
                tree.rates(of, p_dot);
            }
        }
    }

    /// Puts the mechanism to p. False if that is too far away.
    pub fn place(&mut self, mechanism: &mut Mechanism, p: &[f64]) -> bool {
        let Mechanism { system, state, .. } = mechanism;
        match self {
            Self::Coordinates => state.set_positions(system, p),
            Self::Joints { tree, .. } => {
                tree.tell(state, p);
                let Some(positions) = tree.place(p) else { return false };
                state.set_natural_positions(system, positions);
            }
        }
        true
    }

    /// Says which angles of joints belong to p at the time of the state in place, where they do.
    pub fn tell(&self, mechanism: &mut Mechanism, p: &[f64]) {
        if let Self::Joints { tree, .. } = self {
            tree.tell(&mut mechanism.state, p);
        }
    }

    /// Gives it the velocities ṗ, at the positions in place.
    pub fn move_at(&mut self, mechanism: &mut Mechanism, p_dot: &[f64]) {
        let Mechanism { system, state, .. } = mechanism;
        match self {
            Self::Coordinates => state.set_velocities(system, p_dot),
            Self::Joints { tree, .. } => state.set_natural_velocities(system, tree.move_at(p_dot)),
        }
    }

    /// Corrects p towards Φ = 0 — eq. (10.2) — without putting the mechanism there. Returns the largest change of a coordinate.
    pub fn correct_positions(
        &mut self,
        mechanism: &mut Mechanism,
        p: &mut DVector<f64>,
        change: &mut DVector<f64>,
    ) -> f64 {
        let Mechanism { system, state, elimination, .. } = mechanism;
        match self {
            Self::Coordinates => elimination.correct_positions(system, state, p.as_mut_slice()),
            Self::Joints { tree, unused, .. } => {
                let size = elimination.correct_positions(system, state, unused);
                tree.rates(|body| elimination.bodies()[body].twist, change.as_mut_slice());
                *p += &*change;
                size
            }
        }
    }

    /// Corrects ṗ towards Φ̇ = 0 likewise.
    pub fn correct_velocities(
        &mut self,
        mechanism: &mut Mechanism,
        p_dot: &mut DVector<f64>,
        change: &mut DVector<f64>,
    ) -> f64 {
        let Mechanism { system, state, elimination, .. } = mechanism;
        match self {
            Self::Coordinates => elimination.correct_velocities(system, state, p_dot.as_mut_slice()),
            Self::Joints { tree, unused, .. } => {
                let size = elimination.correct_velocities(system, state, unused);
                tree.rates(|body| elimination.bodies()[body].twist, change.as_mut_slice());
                *p_dot += &*change;
                size
            }
        }
    }

    /// Writes p̈ at the state in place, where the rates are ṗ; `moved` says that the positions are others than last time.
    pub fn accelerate(
        &mut self,
        mechanism: &mut Mechanism,
        p_dot: &DVector<f64>,
        moved: bool,
        out: &mut DVector<f64>,
    ) {
        if let Self::Joints { tree, dynamics: Some(dynamics), .. } = self {
            dynamics.accelerate(mechanism, tree, p_dot.as_slice(), moved, out.as_mut_slice());
            return;
        }
        let Mechanism { system, state, elimination, .. } = mechanism;
        if moved {
            elimination.linearize(system, state);
        }
        let found = elimination.accelerate_here(system, state, (0.0, 0.0));
        match self {
            Self::Coordinates => found.write(out.as_mut_slice()),
            Self::Joints { tree, .. } => {
                // ω̇ = ½ Σ e_k × ë_k: what was solved is the part of ω̇ beyond the particular acceleration, which for a reduced
                // body has one of its own.
                let of = |body: usize| {
                    let (q, a) = (&state.bodies()[body].q, elimination.solution(state, body));
                    [a.r, (0..3).map(|k| q.e[k].cross(&a.e[k])).sum::<Vector3<f64>>() * 0.5]
                };
                tree.second_derivatives(of, p_dot.as_slice(), out.as_mut_slice());
            }
        }
    }

    /// Velocities ṗ of small motions (v, ω) of the bodies, a column each, from the positions in place.
    pub fn columns(&mut self, mechanism: &Mechanism, twists: &DMatrix<f64>) -> DMatrix<f64> {
        let mut columns = DMatrix::zeros(self.count(mechanism), twists.ncols());
        for k in 0..twists.ncols() {
            let part = |at: usize| Vector3::new(twists[(at, k)], twists[(at + 1, k)], twists[(at + 2, k)]);
            let mut column = columns.column_mut(k);
            match self {
                Self::Coordinates => {
                    let bodies = mechanism.system.bodies.iter().zip(mechanism.state.bodies());
                    for (index, (body, state)) in bodies.enumerate() {
                        let omega = part(6 * index + 3);
                        let e = state.q.e.map(|e| omega.cross(&e));
                        let rate = NaturalCoordinates { r: part(6 * index), e };
                        body.layout.own_numbers(&rate, |place, value| column[place] = value);
                    }
                }
                Self::Joints { tree, .. } => {
                    tree.rates(|body| [part(6 * body), part(6 * body + 3)], column.as_mut_slice());
                }
            }
        }
        columns
    }

    /// Weights W: lengths are measured in lengths of the mechanism.
    pub fn weights(&self, mechanism: &Mechanism) -> DVector<f64> {
        match self {
            Self::Coordinates => {
                let system = &mechanism.system;
                let place = 1.0 / (system.length * system.length);
                let mut weights = DVector::from_element(system.coordinates, 1.0);
                for body in &system.bodies {
                    weights.rows_mut(body.layout.first, 3).fill(place);
                }
                weights
            }
            Self::Joints { tree, .. } => DVector::from_vec(tree.weights()),
        }
    }

    /// Counts whole turns of joints from p on.
    pub fn commit(&mut self, p: &[f64]) {
        if let Self::Joints { tree, .. } = self {
            tree.commit(p);
        }
    }

    /// Whether other numbers would describe the mechanism better at p.
    pub fn is_tilted(&self, p: &[f64]) -> bool {
        match self {
            Self::Coordinates => false,
            Self::Joints { tree, .. } => tree.is_tilted(p),
        }
    }

    /// Takes the others, and (p, ṗ) among them.
    pub fn restart(&mut self, p: &mut [f64], p_dot: &mut [f64]) {
        if let Self::Joints { tree, dynamics, .. } = self {
            tree.restart(p, p_dot);
            if let Some(lanes) = dynamics.as_mut().and_then(|dynamics| dynamics.lanes.as_mut()) {
                lanes.follow_tree(tree);
            }
        }
    }

    /// Whether they are of the same kind.
    pub fn is_alike(&self, other: &Self) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }

    /// Whether they are the same: then equal ones describe equal states.
    pub fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Joints { tree, .. }, Self::Joints { tree: other, .. }) => tree.is_same(other),
            _ => self.is_alike(other),
        }
    }

    /// Takes (p, ṗ) among the numbers before a restart over into these.
    pub fn translate(&self, before: &Self, p: &mut [f64], p_dot: &mut [f64]) {
        if let (Self::Joints { tree, .. }, Self::Joints { tree: before, .. }) = (self, before) {
            tree.translate(before, p, p_dot);
        }
    }
}
