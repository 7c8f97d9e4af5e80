//! Multipliers of a motion in a plane across an axis of the world, from rows of the plane first — eq. (7.9).
//!
//! Where rows across the plane have nothing of the components in it, accelerations across are zero, and the rows in the plane tell their
//! multipliers by themselves: hinges have two of them instead of five. What acts across the plane (loads, and forces at joints that lie
//! above a centre of mass) is left to the rows across, mostly nothing at all. Where all rows together are
//! redundant but those of the plane are not, the multipliers found so are the smallest as well, and in the plane no regularization
//! is to be refined away. That all this is so is seen, number by number, at each state that is solved.

use super::factor::inverse_inertia;
use super::part::Part;
use super::{Accelerations, BodySolve, Elimination, REFINEMENTS, REGULARIZATION, TwistJacobian};
use crate::state::{BodyState, State};
use crate::system::feature::Difference;
use crate::system::index::{FeatureId, SolverRow};
use crate::system::planar::Plane;
use crate::system::row::Form;
use crate::system::{Row, System};
use nalgebra::Vector3;
use triad_linalg::largest_size;

/// Relative pivot below which the whole of S decides: the position may be a singular one.
const LEAST_PIVOT: f64 = 1e-6;
/// Change of the multipliers, as a part of the largest, up to which one step with the factor of a state nearby finds them: what it
/// misses is about as small a part of the change.
const NEAR: f64 = 1e-6;
/// Acceleration across the plane that rows across may leave, as a part of that without them.
const LEFT: f64 = 1e-10;

/// The equations of a plane and those across it.
#[derive(Clone, Debug)]
pub(super) struct InPlane {
    /// Two directions of the world in the plane, and its normal.
    axes: [usize; 3],
    plane: Part,
    across: Part,
    /// Whether rows across depend on each other.
    redundant: bool,
    /// What acts across the plane on each body: a force and two moments.
    wrenches: Vec<[f64; 3]>,
    /// The changes of A up to which rows across were seen to have nothing of the plane.
    seen: Option<u64>,
}

impl InPlane {
    /// The equations of a plane across an axis of the world, as far as forms and directions at a state tell; none where rows in the
    /// plane depend on each other.
    fn new(system: &System, state: &State, normal: usize, dependent: &[SolverRow]) -> Option<Self> {
        let mut in_plane = vec![false; system.solver_rows];
        for row in &system.rows {
            for k in 0..row.form.independent() {
                in_plane[row.solver + k] = is_in_plane(state, row, k, normal);
            }
        }
        if dependent.iter().any(|row| in_plane[row.index()]) {
            return None;
        }
        let (i, j) = ((normal + 1) % 3, (normal + 2) % 3);
        Some(Self {
            axes: [i, j, normal],
            plane: Part::new(system, [i, j, 3 + normal], |row| in_plane[row]),
            across: Part::new(system, [normal, 3 + i, 3 + j], |row| !in_plane[row]),
            redundant: !dependent.is_empty(),
            wrenches: vec![[0.0; 3]; system.bodies.len()],
            seen: None,
        })
    }

    /// Takes A and the inertia at a state; false where rows across have a part in the plane, or a body products
    /// of inertia, or none in the plane.
    fn set_up(&mut self, system: &System, state: &State, jacobian: &TwistJacobian) -> bool {
        let [i, j, n] = self.axes;
        let (a, changes) = (&jacobian.a, Some(jacobian.changes()));
        if self.seen != changes && !self.across.has_nothing_of([i, j, 3 + n], a) {
            return false;
        }
        self.seen = changes;
        let bodies = system.bodies.iter().zip(state.bodies());
        for (own, (body, BodyState { q, .. })) in self.plane.bodies.iter_mut().zip(bodies) {
            let [mut inertia, mut products] = [0.0, 0.0];
            for (e, ibar) in q.e.iter().zip(body.ibar.iter()) {
                inertia += ibar * (e[i] * e[i] + e[j] * e[j]);
                products += (ibar * e[n] * e[i]).abs() + (ibar * e[n] * e[j]).abs();
            }
            if products != 0.0 || inertia <= body.regularizing_inertia {
                return false;
            }
            let inverse_mass = 1.0 / body.mass;
            own.inverse = [inverse_mass, inverse_mass, 1.0 / inertia, 0.0];
        }
        self.plane.take([n, 3 + i, 3 + j], a);
        self.plane.scale();
        true
    }

    /// Solves with wrenches and γ' in place, in the plane with what was found at a state nearby if that is near enough. False where
    /// the whole of S decides.
    fn solve(&mut self, system: &System, state: &State, given: &Given, near: Option<&Self>) -> bool {
        let [i, j, n] = self.axes;
        let &Given { bodies, gamma, a } = given;
        if self.across.solver_rows().any(|row| gamma[row] != 0.0) {
            return false;
        }
        let push = |part: &mut Part| {
            for (own, body) in part.bodies.iter_mut().zip(bodies) {
                let [force, moment] = &body.wrench;
                own.push([force[i], force[j], moment[n]]);
            }
            part.clear();
        };
        let plane = &mut self.plane;
        push(plane);
        let found = near.is_some_and(|near| {
            plane.add(&near.plane);
            plane.correct(|row| gamma[row], Some(&near.plane));
            let [change, largest] = plane.change();
            change <= NEAR * largest
        });
        if !found {
            push(plane);
            if is_below(plane.factor(0.0), LEAST_PIVOT) {
                return false;
            }
            plane.correct(|row| gamma[row], None);
        }
        self.carry_across(system, state, bodies, a)
    }

    /// Lets the rows across carry what acts across the plane; false where they cannot.
    fn carry_across(&mut self, system: &System, state: &State, bodies: &[BodySolve], a: &[f64]) -> bool {
        let [i, j, n] = self.axes;
        let Self { plane, across, wrenches, .. } = self;
        for (wrench, body) in wrenches.iter_mut().zip(bodies) {
            let [force, moment] = &body.wrench;
            *wrench = [force[n], moment[i], moment[j]];
        }
        plane.exert([n, 3 + i, 3 + j], a, wrenches);
        across.clear();
        if wrenches.iter().all(|wrench| *wrench == [0.0; 3]) {
            return true;
        }
        let given = wrenches.iter().zip(system.bodies.iter().zip(state.bodies()));
        for (own, (wrench, (body, at))) in across.bodies.iter_mut().zip(given) {
            let inverse = inverse_inertia(&at.q, &body.ibar, body.regularizing_inertia);
            own.inverse = [1.0 / body.mass, inverse[(i, i)], inverse[(j, j)], inverse[(i, j)]];
            own.push(*wrench);
        }
        across.take([i, j, 3 + n], a);
        across.scale();
        let (epsilon, refinements) = if self.redundant { (REGULARIZATION, REFINEMENTS) } else { (0.0, 0) };
        let pivot = across.factor(epsilon);
        if !self.redundant && is_below(pivot, LEAST_PIVOT) {
            return false;
        }
        let pushed = across.largest_twist();
        let mut before = 0.0;
        for _ in 0..=refinements {
            across.correct(|_| 0.0, None);
            let [change, largest] = across.change();
            // Changes fall by the same part each time: the next would be rounding.
            if change * change <= f64::EPSILON * largest * before {
                break;
            }
            before = change;
        }
        !is_below(LEFT * pushed, across.largest_twist())
    }

    /// Hands over multipliers and accelerations in space.
    fn hand_over(&self, lambda: &mut [f64], bodies: &mut [BodySolve]) {
        let [i, j, n] = self.axes;
        self.plane.hand_over(lambda);
        self.across.hand_over(lambda);
        for (body, own) in bodies.iter_mut().zip(&self.plane.bodies) {
            body.twist = [Vector3::zeros(); 2];
            let [along_i, along_j, turning] = own.twist;
            (body.twist[0][i], body.twist[0][j], body.twist[1][n]) = (along_i, along_j, turning);
        }
    }
}

/// What the equations of a plane are solved for.
struct Given<'a> {
    bodies: &'a [BodySolve],
    gamma: &'a [f64],
    /// A in space.
    a: &'a [f64],
}

/// Whether a number is not above another, or is none.
fn is_below(x: f64, least: f64) -> bool {
    x.partial_cmp(&least).is_none_or(std::cmp::Ordering::is_lt)
}

/// Whether the k-th row of a form has a part in the plane.
fn is_in_plane(state: &State, row: &Row, k: usize, normal: usize) -> bool {
    let along = |feature: FeatureId| {
        let vector = state.feature_value(feature);
        (0..3).all(|c| c == normal || vector[c] == 0.0)
    };
    let across = |factor: Difference| factor.minus.is_none() && along(factor.plus);
    match row.form {
        Form::Coincidence { .. } => k != normal,
        Form::CommonVector { a, b } => !(along(a) && along(b)),
        Form::Product { a, b, .. } => !(across(a) || across(b)),
        Form::Relation { .. } => true,
    }
}

impl Elimination {
    /// Takes over a plane that a run starts in, at its start, for [`Elimination::examine`]. False where that is across no axis of the
    /// world, or its rows alone do not tell their multipliers there.
    pub fn find_plane(
        &mut self,
        system: &System,
        start: &State,
        plane: &Plane,
        baumgarte: (f64, f64),
    ) -> bool {
        let normal = plane.frame.column(2);
        let axis = normal.iamax();
        if normal[axis] != 1.0 || self.frictions.is_some() {
            return false;
        }
        self.plane = InPlane::new(system, start, axis, &self.dependent).map(Box::new);
        self.solve_in_plane(system, start, baumgarte, None)
    }

    /// Takes over the plane that another solver of the same system has found.
    pub fn stay_in_plane_of(&mut self, other: &Self) {
        self.plane.clone_from(&other.plane);
        if let Some(plane) = &mut self.plane {
            plane.seen = None;
        }
    }

    /// The same numbers as [`Elimination::accelerate`] up to rounding, at less cost where [`Elimination::find_plane`] has found one,
    /// and without a factor to go on with.
    ///
    /// `near` is what was examined last at a state so close that one is the other without its error. The difference between both
    /// is then right to about six digits.
    pub fn examine<'a>(
        &'a mut self,
        system: &'a System,
        state: &'a State,
        baumgarte: (f64, f64),
        near: Option<&Self>,
    ) -> Accelerations<'a> {
        state.require_velocities();
        self.solved_in_plane = self.solve_in_plane(system, state, baumgarte, near);
        if self.solved_in_plane || near.is_some_and(|near| self.solve_near(system, state, baumgarte, near)) {
            self.counters.evaluations += 1;
            return self.last_accelerations(system, state);
        }
        self.shows = true;
        self.linearize(system, state);
        self.accelerate_here(system, state, baumgarte);
        self.shows = false;
        self.last_accelerations(system, state)
    }

    /// Solves in the plane, where there is one; false where that cannot be done.
    fn solve_in_plane(
        &mut self,
        system: &System,
        state: &State,
        baumgarte: (f64, f64),
        near: Option<&Self>,
    ) -> bool {
        if self.resolving {
            return false;
        }
        let Some(mut plane) = self.plane.take() else { return false };
        self.jacobian.fill(system, state);
        let mut solved = plane.set_up(system, state, &self.jacobian);
        if solved {
            self.set_forces(system, state);
            self.set_right_side(system, state, baumgarte);
            let near = near.filter(|near| near.solved_in_plane).and_then(|near| near.plane.as_deref());
            let given = Given { bodies: &self.bodies, gamma: &self.gamma, a: &self.jacobian.a };
            solved = plane.solve(system, state, &given, near);
        }
        if solved {
            plane.hand_over(&mut self.lambda, &mut self.bodies);
        }
        self.plane = Some(plane);
        solved
    }

    /// Solves with the factor and the multipliers of a state nearby; false where that cannot be done, or that state is too far.
    fn solve_near(&mut self, system: &System, state: &State, baumgarte: (f64, f64), near: &Self) -> bool {
        let plain = |of: &Self| !(of.regularizes_inertia || of.resolving || of.frictions.is_some());
        if near.solved_in_plane || near.regularized || near.pivots.small || !plain(near) || !plain(self) {
            return false;
        }
        self.set_up(system, state);
        self.set_forces(system, state);
        self.set_right_side(system, state, baumgarte);
        self.set_free_twists(system);
        self.residual.copy_from_slice(&near.lambda);
        self.apply_multipliers(system);
        self.row_residual(system);
        self.factor.solve_with(&near.factor, &mut self.residual);
        self.apply_multipliers(system);
        for ((lambda, near), change) in self.lambda.iter_mut().zip(&near.lambda).zip(&self.residual) {
            *lambda = near + change;
        }
        let [change, largest] = [&self.residual, &self.lambda].map(|x| largest_size(x));
        change <= NEAR * largest
    }
}
