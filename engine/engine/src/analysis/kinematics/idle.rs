//! Bodies that can spin about themselves without moving anything else, like a link between two spherical joints.

use super::inverse::Masses;
use crate::analysis::{AnalysisError, Stage};
use nalgebra::{DMatrix, Vector3};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::system::index::IncidenceId;
use triad_linalg::left_null_space;

/// A row of unit length depends on the others if its component orthogonal to them is shorter than this.
const DEPENDENT: f64 = 1e-9;
/// Part of a velocity, in lengths of the mechanism, below which a point rests; and of a moment below which there is none.
const NEGLIGIBLE: f64 = 1e-8;

/// A body that can spin about an axis of its own.
#[derive(Clone, Debug)]
pub(super) struct Idle {
    body: usize,
    name: String,
    /// The joints that it spins in.
    joints: Vec<String>,
}

impl Idle {
    /// The bodies that can spin about an axis while all others stand, at the held position. `None` if they do not account
    /// for all `freedoms`.
    pub(super) fn of_all(stage: &mut Stage, freedoms: usize) -> Option<Vec<Self>> {
        let Mechanism { system, state, elimination, .. } = &mut stage.mechanism;
        state.set_positions(system, &stage.q);
        elimination.linearize(system, state);
        let mut list = Vec::new();
        let mut found = 0;
        for body in 0..stage.mechanism.system.bodies.len() {
            let twists = own_twists(stage, body);
            found += twists.ncols();
            let turns = twists.ncols() == 1 && axis_of(&twists, stage.mechanism.system.length).is_some();
            if turns && !is_hinged(stage, body) {
                list.push(Self::of_body(stage, body));
            }
        }
        (found == freedoms && list.len() == freedoms).then_some(list)
    }

    fn of_body(stage: &Stage, body: usize) -> Self {
        let system = &stage.mechanism.system;
        let joints = system.incidences_of_body[body]
            .iter()
            .map(|&incidence| system[system.incidences[incidence].constraint].name.clone());
        Self { body, name: system.model.bodies[body].name.clone(), joints: joints.collect() }
    }

    /// The note for a result that leaves its spin as it was.
    pub(super) fn note(&self, stage: &Stage) -> String {
        let spin = self.axis(stage).map_or(0.0, |axis| {
            let at = &stage.mechanism.state.bodies()[self.body];
            0.5 * (0..3).map(|k| at.q.e[k].cross(&at.q_dot.e[k])).sum::<Vector3<f64>>().dot(&axis)
        });
        format!(
            "body \"{}\" can spin about its axis through {}, which moves nothing else: it keeps the {:.6} rad/s about it that \
             it starts with, as nothing turns it there",
            self.name,
            triad_dynamics::constraints::quoted(&self.joints),
            spin.abs()
        )
    }

    /// Refuses a moment about the axis: the body would not keep its spin, and how it spins is not geometry.
    pub(super) fn check(&self, stage: &Stage, masses: &Masses) -> Result<(), AnalysisError> {
        let Some(axis) = self.axis(stage) else { return Ok(()) };
        let system = &stage.mechanism.system;
        let twists = own_twists(stage, self.body);
        let [force, moment] = masses.on(self.body);
        let along = |k: usize| Vector3::new(twists[(k, 0)], twists[(k + 1, 0)], twists[(k + 2, 0)]);
        let (v, omega) = (along(0), along(3));
        let turning = (v.dot(&force) + omega.dot(&moment)) / omega.dot(&axis);
        let largest = moment.norm() + force.norm() * system.length;
        // A comparison that is false for NaN as well.
        if turning.abs() <= NEGLIGIBLE * largest {
            return Ok(());
        }
        Err(AnalysisError::Spins {
            body: self.name.clone(),
            joints: self.joints.clone(),
            time: stage.time,
            moment: turning.abs(),
        })
    }

    fn axis(&self, stage: &Stage) -> Option<Vector3<f64>> {
        axis_of(&own_twists(stage, self.body), stage.mechanism.system.length)
    }
}

/// A basis of the twists that a body's own joints and drivers allow it while all other bodies stand, as columns of (v, ω), at
/// the position that was linearized last.
fn own_twists(stage: &Stage, body: usize) -> DMatrix<f64> {
    twists_within(stage, &stage.mechanism.system.incidences_of_body[body])
}

/// Whether one of its joints alone lets a body turn about no more than one axis: then the joint's angle can be driven, and its
/// turning is a freedom like others.
fn is_hinged(stage: &Stage, body: usize) -> bool {
    stage.mechanism.system.incidences_of_body[body].iter().any(|&incidence| {
        let turns = twists_within(stage, &[incidence]).rows(3, 3) * stage.mechanism.system.length;
        turns.singular_values().iter().nth(1).is_none_or(|second| *second < NEGLIGIBLE)
    })
}

/// The twists that some joints allow.
fn twists_within(stage: &Stage, incidences: &[usize]) -> DMatrix<f64> {
    let Mechanism { system, elimination, .. } = &stage.mechanism;
    let mut rows = Vec::new();
    for &incidence in incidences {
        for row in elimination.jacobian().rows_on(system, IncidenceId(incidence)).chunks_exact(6) {
            let scaled = |c: usize| if c < 3 { row[c] } else { row[c] / system.length };
            let norm = (0..6).map(|c| scaled(c) * scaled(c)).sum::<f64>().sqrt();
            if norm > 0.0 {
                rows.extend((0..6).map(|c| scaled(c) / norm));
            }
        }
    }
    let mut twists = left_null_space(&DMatrix::from_column_slice(6, rows.len() / 6, &rows), DEPENDENT);
    for mut turn in twists.row_iter_mut().skip(3) {
        turn /= system.length;
    }
    twists
}

/// The axis of a twist that is a rotation.
fn axis_of(twists: &DMatrix<f64>, length: f64) -> Option<Vector3<f64>> {
    let column = twists.column_iter().next()?;
    let (v, omega) = (column.fixed_rows::<3>(0).into_owned(), column.fixed_rows::<3>(3).into_owned());
    let axis = omega.try_normalize(NEGLIGIBLE * v.norm() / length)?;
    (v.dot(&axis).abs() <= NEGLIGIBLE * omega.norm() * length).then_some(axis)
}
