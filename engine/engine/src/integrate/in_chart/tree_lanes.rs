//! Accelerations of an open tree at several states at once — eq. (7.13): the stages of an implicit step, or the places of a difference
//! quotient, lie side by side in the lanes of the processor's registers. Nothing but coordinates and rates goes in, and the state of the
//! mechanism stays as it is.
//!
//! The equations are those of [`super::tree_dynamics`]; all is seen from the point of reference.

mod loads;

use super::edge::OneScrew;
use super::spatial::Placement;
use super::tree::Tree;
use crate::integrate::wide::{
    MOST_LANES, Stored, StoredPair, StoredPlacement, StoredVector, Wide, WidePair, WidePlacement, WideVector,
};
use loads::{Torsion, torsions};
use nalgebra::{Matrix3, Vector3};
use pulp::{Arch, Simd, WithSimd};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::system::System;

/// How a body moves against another.
#[derive(Clone, Debug)]
struct Link {
    body: usize,
    parent: Option<usize>,
    /// Its coordinates.
    first: usize,
    count: usize,
    product: Vec<OneScrew>,
}

/// What is known of a body in each lane.
#[derive(Clone, Copy, Debug, Default)]
struct Body {
    place: StoredPlacement,
    velocity: StoredPair,
    /// Acceleration with no acceleration of a coordinate.
    drag: StoredPair,
    /// First moments and inertia of all that it carries.
    first: StoredVector,
    about: [Stored; 6],
    /// What it lacks for that acceleration, and all that it carries.
    lacking: StoredPair,
}

/// The equations of motion of a tree, for as many states at once as a register has lanes.
#[derive(Clone, Debug)]
pub struct TreeLanes {
    center: Vector3<f64>,
    links: Vec<Link>,
    before: Vec<Option<usize>>,
    /// Mass of each body and all that it carries.
    carried: Vec<f64>,
    torsions: Vec<Option<Torsion>>,
    bodies: Vec<Body>,
    /// Twist of each coordinate.
    twists: Vec<StoredPair>,
    /// M = Lᵀ D L by rows, below its diagonal; on it 1/D.
    matrix: Vec<Stored>,
    /// The states.
    pub at: LaneStates,
}

/// Some states, one in each lane, and what follows.
#[derive(Clone, Debug)]
pub struct LaneStates {
    /// Times, s.
    pub times: Stored,
    /// Coordinates p and their rates.
    pub places: Vec<Stored>,
    /// ṗ.
    pub rates: Vec<Stored>,
    /// p̈.
    pub accelerations: Vec<Stored>,
    /// Power of loads without potential, W.
    pub power: Stored,
}

struct Evaluate<'a>(&'a mut TreeLanes, &'a System);

impl WithSimd for Evaluate<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self(lanes, system) = self;
        lanes.follow(simd, system);
        lanes.apply_loads(simd, system);
        lanes.gather(simd);
        lanes.solve(simd);
    }
}

/// Lanes of a register.
struct Width;

impl WithSimd for Width {
    type Output = usize;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> usize {
        S::F64_LANES
    }
}

impl TreeLanes {
    /// For the tree of a mechanism that alone decides how it moves, seen from `center`, with the coordinate before each one. `None` if loads act
    /// that ask for a state in place.
    pub fn new(
        mechanism: &Mechanism,
        tree: &Tree,
        before: &[Option<usize>],
        center: &Vector3<f64>,
    ) -> Option<Self> {
        let system = &mechanism.system;
        let torsions = torsions(mechanism, tree)?;
        let mut carried: Vec<f64> = system.bodies.iter().map(|body| body.mass).collect();
        for edge in tree.edges().iter().rev() {
            if let Some(parent) = edge.parent {
                carried[parent] += carried[edge.body];
            }
        }
        let n = before.len();
        let zeros = || vec![[0.0; MOST_LANES]; n];
        let at = LaneStates {
            times: [0.0; MOST_LANES],
            places: zeros(),
            rates: zeros(),
            accelerations: zeros(),
            power: [0.0; MOST_LANES],
        };
        let mut lanes = Self {
            center: *center,
            links: Vec::new(),
            before: before.to_vec(),
            carried,
            torsions,
            bodies: vec![Body::default(); system.bodies.len()],
            twists: vec![StoredPair::default(); n],
            matrix: vec![[0.0; MOST_LANES]; n * n],
            at,
        };
        lanes.follow_tree(tree);
        Some(lanes)
    }

    /// Takes over how bodies move in a tree that has been restarted.
    pub fn follow_tree(&mut self, tree: &Tree) {
        let links = tree.edges().iter().map(|edge| Link {
            body: edge.body,
            parent: edge.parent,
            first: edge.first,
            count: edge.range().len(),
            product: edge.product(&self.center),
        });
        self.links = links.collect();
    }

    /// How many states are evaluated at once.
    pub fn width() -> usize {
        Arch::new().dispatch(Width)
    }

    /// Finds the accelerations of the states in `at`, and the power of loads there.
    pub fn evaluate(&mut self, system: &System) {
        Arch::new().dispatch(Evaluate(self, system));
    }

    /// Places, velocities and inertia of all bodies, and what each lacks for its acceleration but for loads.
    #[inline(always)]
    fn follow<S: Simd>(&mut self, simd: S, system: &System) {
        for link in &self.links {
            let (mut place, mut velocity, mut drag) = (None, WidePair::zero(simd), WidePair::zero(simd));
            if let Some(parent) = link.parent {
                let parent = &self.bodies[parent];
                place = Some(WidePlacement::load(simd, &parent.place));
                velocity = WidePair::load(simd, &parent.velocity);
                drag = WidePair::load(simd, &parent.drag);
            }
            for (index, screw) in link.product.iter().enumerate() {
                let known = link.first + index;
                let mut moved = screw.start_in(simd);
                if index < link.count {
                    let mut twist = screw.twist_in(simd);
                    let rate = Wide::load(simd, &self.at.rates[known]);
                    if let Some(place) = &place {
                        twist = WidePlacement::carry(place, twist);
                        drag = drag.plus(velocity.drag(twist), rate);
                    }
                    velocity = velocity.plus(twist, rate);
                    twist.store(&mut self.twists[known]);
                    screw.move_to(Wide::load(simd, &self.at.places[known]), &mut moved);
                }
                place = match place {
                    Some(place) => Some(WidePlacement::after(&place, &moved)),
                    None => Some(moved),
                };
            }
            let Some(place) = place else { continue };
            let body = &mut self.bodies[link.body];
            place.store(&mut body.place);
            velocity.store(&mut body.velocity);
            drag.store(&mut body.drag);
            let ibar = &system.bodies[link.body].ibar;
            body.set_inertia(&place, system.bodies[link.body].mass, ibar);
            let inertia = Inertia::load(simd, body, system.bodies[link.body].mass);
            let momentum = inertia.momentum(velocity);
            let weight = WideVector::all(simd, &system.model.gravity);
            let mut lacking = WidePair {
                turning: inertia.first.cross(weight)
                    - velocity.turning.cross(momentum.turning)
                    - velocity.moving.cross(momentum.moving),
                moving: weight.times(inertia.mass) - velocity.turning.cross(momentum.moving),
            };
            // Only the first twist on the way from the ground does not change.
            if link.parent.is_some() || link.count > 1 {
                lacking = lacking - inertia.momentum(drag);
            }
            lacking.store(&mut body.lacking);
        }
    }

    /// Forces along all coordinates, and M below its diagonal, from the leaves to the ground.
    #[inline(always)]
    fn gather<S: Simd>(&mut self, simd: S) {
        let n = self.before.len();
        for link in self.links.iter().rev() {
            let body = &self.bodies[link.body];
            let lacking = WidePair::load(simd, &body.lacking);
            let inertia = Inertia::load(simd, body, self.carried[link.body]);
            for place in link.first..link.first + link.count {
                let twist = WidePair::load(simd, &self.twists[place]);
                lacking.along(twist).store(&mut self.at.accelerations[place]);
                let momentum = inertia.momentum(twist);
                let mut other = Some(place);
                while let Some(column) = other {
                    let along = momentum.along(WidePair::load(simd, &self.twists[column]));
                    along.store(&mut self.matrix[place * n + column]);
                    other = self.before[column];
                }
            }
            let Some(parent) = link.parent.map(|parent| &mut self.bodies[parent]) else { continue };
            let mut sum = WidePair::load(simd, &parent.lacking);
            sum += lacking;
            sum.store(&mut parent.lacking);
            (WideVector::load(simd, &parent.first) + inertia.first).store(&mut parent.first);
            for (k, sum) in parent.about.iter_mut().enumerate() {
                (Wide::load(simd, sum) + inertia.about[k]).store(sum);
            }
        }
    }

    /// p̈ ← M⁻¹ p̈ by M = Lᵀ D L: from the leaves on nothing is filled in.
    #[inline(always)]
    fn solve<S: Simd>(&mut self, simd: S) {
        let Self { before, matrix, at: LaneStates { accelerations: x, .. }, .. } = self;
        let n = before.len();
        for k in (0..n).rev() {
            let inverse = Wide::all(simd, 1.0) / Wide::load(simd, &matrix[k * n + k]);
            inverse.store(&mut matrix[k * n + k]);
            let own = Wide::load(simd, &x[k]);
            let mut above = before[k];
            while let Some(i) = above {
                let factor = Wide::load(simd, &matrix[k * n + i]) * inverse;
                let mut other = Some(i);
                while let Some(j) = other {
                    let entry = Wide::load(simd, &matrix[i * n + j]);
                    entry.less(factor, Wide::load(simd, &matrix[k * n + j])).store(&mut matrix[i * n + j]);
                    other = before[j];
                }
                Wide::load(simd, &x[i]).less(factor, own).store(&mut x[i]);
                factor.store(&mut matrix[k * n + i]);
                above = before[i];
            }
        }
        for i in 0..n {
            let mut sum = Wide::load(simd, &x[i]) * Wide::load(simd, &matrix[i * n + i]);
            let mut above = before[i];
            while let Some(j) = above {
                sum = sum.less(Wide::load(simd, &matrix[i * n + j]), Wide::load(simd, &x[j]));
                above = before[j];
            }
            sum.store(&mut x[i]);
        }
    }
}

/// Mass, first moments and inertia: xx, yy, zz, yz, xz, xy.
#[derive(Clone, Copy)]
struct Inertia<S: Simd> {
    mass: Wide<S>,
    first: WideVector<S>,
    about: [Wide<S>; 6],
}

impl<S: Simd> Inertia<S> {
    #[inline(always)]
    fn load(simd: S, body: &Body, mass: f64) -> Self {
        let mut about = [Wide::all(simd, 0.0); 6];
        for (k, about) in about.iter_mut().enumerate() {
            *about = Wide::load(simd, &body.about[k]);
        }
        Self { mass: Wide::all(simd, mass), first: WideVector::load(simd, &body.first), about }
    }

    /// The momentum at a twist.
    #[inline(always)]
    fn momentum(&self, twist: WidePair<S>) -> WidePair<S> {
        let [xx, yy, zz, yz, xz, xy] = self.about;
        let WideVector([x, y, z]) = twist.turning;
        let turning = WideVector([
            (xx * x).plus(xy, y).plus(xz, z),
            (xy * x).plus(yy, y).plus(yz, z),
            (xz * x).plus(yz, y).plus(zz, z),
        ]);
        WidePair {
            turning: turning + self.first.cross(twist.moving),
            moving: twist.turning.cross(self.first).plus(twist.moving, self.mass),
        }
    }
}

impl Body {
    /// That of the body itself at its place.
    #[inline(always)]
    fn set_inertia<S: Simd>(&mut self, place: &WidePlacement<S>, mass: f64, ibar: &Vector3<f64>) {
        let simd = place.at.simd();
        let first = place.at.times(Wide::all(simd, mass));
        let (WideVector([x, y, z]), WideVector([p, q, r])) = (place.at, first);
        let mut squares = [x * p, y * q, z * r, y * r, x * r, x * q];
        for k in 0..3 {
            let WideVector([x, y, z]) = place.turn[k];
            let WideVector([p, q, r]) = place.turn[k].times(Wide::all(simd, ibar[k]));
            let parts = [(x, p), (y, q), (z, r), (y, r), (x, r), (x, q)];
            for (k, sum) in squares.iter_mut().enumerate() {
                *sum = sum.plus(parts[k].0, parts[k].1);
            }
        }
        let [xx, yy, zz, yz, xz, xy] = squares;
        first.store(&mut self.first);
        let about = [yy + zz, xx + zz, xx + yy, -yz, -xz, -xy];
        for (k, to) in self.about.iter_mut().enumerate() {
            about[k].store(to);
        }
    }
}

impl OneScrew {
    /// Its twist, in the frame from which it starts.
    #[inline(always)]
    fn twist_in<S: Simd>(&self, simd: S) -> WidePair<S> {
        let turning = WideVector::all(simd, &self.twist.spin);
        WidePair { turning, moving: WideVector::all(simd, &self.twist.flow) }
    }

    /// The placement at zero.
    #[inline(always)]
    fn start_in<S: Simd>(&self, simd: S) -> WidePlacement<S> {
        let Placement { turn, at } = &self.start;
        let turn = [column(simd, turn, 0), column(simd, turn, 1), column(simd, turn, 2)];
        WidePlacement { turn, at: WideVector::all(simd, at) }
    }

    /// Makes that the placement at s.
    #[inline(always)]
    fn move_to<S: Simd>(&self, s: Wide<S>, placement: &mut WidePlacement<S>) {
        let simd = s.simd();
        if self.turn != 0.0 {
            let angle = s * Wide::all(simd, self.turn);
            let [sin, cosine] = angle.sine_cosine();
            let versine = Wide::all(simd, 1.0) - cosine;
            for k in 0..3 {
                let by = [column(simd, &self.turning.turn, k), column(simd, &self.turned.turn, k)];
                placement.turn[k] = placement.turn[k].plus(by[0], sin).plus(by[1], versine);
            }
            let by = [WideVector::all(simd, &self.turning.at), WideVector::all(simd, &self.turned.at)];
            placement.at = placement.at.plus(by[0], sin).plus(by[1], versine);
        }
        placement.at = placement.at.plus(WideVector::all(simd, &self.slide), s);
    }
}

#[inline(always)]
fn column<S: Simd>(simd: S, matrix: &Matrix3<f64>, k: usize) -> WideVector<S> {
    WideVector([
        Wide::all(simd, matrix[(0, k)]),
        Wide::all(simd, matrix[(1, k)]),
        Wide::all(simd, matrix[(2, k)]),
    ])
}
