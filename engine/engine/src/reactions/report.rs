//! Reactions as they are told: on which body, about which point, in which frame, and which numbers are unique.

use crate::reactions::uniqueness::{NullSpace, Redundancy, TOLERANCE, UniquenessError};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use triad_dynamics::dynamics::elimination::Multipliers;
use triad_dynamics::model::{BodyRef, DriverKind, ModelJoint};
use triad_dynamics::newton::DEPENDENT;
use triad_dynamics::state::State;
use triad_dynamics::system::index::SolverRow;
use triad_dynamics::system::{Constraint, System};
use triad_linalg::orthonormal_basis;

/// Part of the force and moment of a row below which a component of them is rounding.
const ROUNDING: f64 = 1e-13;

/// Which of the two bodies of a joint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// Body i.
    I,
    /// Body j.
    #[default]
    J,
}

/// The point about which moments are taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MomentReference {
    /// The joint's point on the body that the reaction acts on.
    #[default]
    JointPoint,
    /// The centre of mass of that body (for the ground: the world's origin).
    CenterOfMass,
    /// A point of the world, m.
    WorldPoint([f64; 3]),
}

/// The frame of the components.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ExpressedIn {
    /// The world.
    #[default]
    World,
    /// The joint: x along its axis, y and z across it, fixed in body i.
    Joint,
    /// The frame of the body that the reaction acts on.
    Body,
}

/// How reactions are wanted: on body j, about the joint's point, in the world, unless it says otherwise.
///
/// ```
/// use triad_engine::prelude::*;
/// use triad_engine::reactions::report::{Convention, ExpressedIn};
///
/// let mut scene = Scene::new("tilted").gravity([0.0, 0.0, -10.0]);
/// let block = scene.add(Body::sphere("block", 3.0, 0.1, [0.0; 3]));
/// scene.add(Joint::prismatic("rail", Ground, &block).at([0.0; 3]).about([0.6, 0.0, -0.8]));
/// let along_rail = Convention { expressed_in: ExpressedIn::Joint, ..Convention::default() };
/// let rail = &Simulation::new(&scene)?.reactions(along_rail)?.reactions[0];
/// let [x, y, z] = rail.force.map(|component| component.value);
/// assert!(x.abs() < 1e-12 && (f64::hypot(y, z) - 0.6 * 30.0).abs() < 1e-12, "none along the rail");
/// # Ok::<(), EngineError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Convention {
    /// On which body.
    pub on: Side,
    /// About which point.
    pub about: MomentReference,
    /// In which frame.
    pub expressed_in: ExpressedIn,
}

/// One component of a force or moment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ReactionComponent {
    /// Value, N or N m; where it is not unique, that of the smallest multipliers that give the same motion.
    pub value: f64,
    /// Whether the equations of motion determine it.
    pub unique: bool,
}

/// The reaction of a joint or driver: what body `by` does to body `on` through it — eq. (9.1).
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Reaction {
    /// The joint or driver.
    pub joint: String,
    /// Whether it is a driver.
    pub driver: bool,
    /// The body that the reaction acts on.
    pub on: String,
    /// The body that exerts it.
    pub by: String,
    /// The point about which the moment is taken, in words.
    pub about: String,
    /// That point in the world, m.
    pub about_at: [f64; 3],
    /// The frame of the components, in words.
    pub expressed_in: String,
    /// Its axes x, y, z in the world: unit vectors.
    pub axes: [[f64; 3]; 3],
    /// Force f, N, along those axes.
    pub force: [ReactionComponent; 3],
    /// Moment τ about that point, N m, along those axes.
    pub moment: [ReactionComponent; 3],
}

/// Every reaction at one moment, and what is not unique about them — THEORY section 9.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ReactionReport {
    /// Time t, s.
    pub time: f64,
    /// The reactions, joints before drivers.
    pub reactions: Vec<Reaction>,
    /// Sets of joints that share redundant rows at this position.
    pub redundancies: Vec<Redundancy>,
    /// A row of unit length of which less than this is across the others depends on them.
    pub rank_tolerance: f64,
    /// A component that changes by less than this part of its own size is unique.
    pub tolerance: f64,
}

/// All reactions of multipliers.
///
/// # Errors
///
/// [`UniquenessError`]: too many rows to tell what is unique, or a state that is not finite.
#[doc(hidden)]
pub fn report(at: &Multipliers, convention: Convention) -> Result<ReactionReport, UniquenessError> {
    let system = at.system;
    let null = NullSpace::new(system, at.state, at.jacobian)?;
    let multipliers = null.smallest(at.solver_rows());
    let tell = |constraint| reaction(at, constraint, convention, &null, &multipliers);
    let reactions = system.constraints.iter().map(tell).collect();
    Ok(ReactionReport {
        time: at.state.time(),
        reactions,
        redundancies: null.redundancies(system, at.state),
        rank_tolerance: DEPENDENT.sqrt(),
        tolerance: TOLERANCE,
    })
}

fn reaction(
    at: &Multipliers,
    constraint: &Constraint,
    convention: Convention,
    null: &NullSpace,
    multipliers: &[f64],
) -> Reaction {
    let (system, state) = (at.system, at.state);
    let side = usize::from(convention.on == Side::J);
    let body = constraint.bodies[side];
    let (about, point) = about(system, state, constraint, side, convention.about);
    let (expressed_in, axes) = frame(system, state, constraint, body, convention.expressed_in);
    let map = wrench_map(at, constraint, body, &point);
    let lambda = DVector::from_column_slice(&multipliers[constraint.solver.clone()]);
    let component = |row: usize| {
        let turned = axes.column(row % 3).transpose() * map.rows(row / 3 * 3, 3);
        let mut weights: Vec<f64> = turned.iter().copied().collect();
        let arm = point.norm() + system.length;
        drop_rounding(&mut weights, &map, if row < 3 { None } else { Some(arm) });
        ReactionComponent {
            value: (turned * &lambda)[0],
            unique: null.is_unique(SolverRow(constraint.solver.start), &weights),
        }
    };
    Reaction {
        joint: constraint.name.clone(),
        driver: constraint.driver,
        on: body_name(system, body),
        by: body_name(system, constraint.bodies[1 - side]),
        about,
        about_at: point.into(),
        expressed_in,
        axes: [0, 1, 2].map(|k| axes.column(k).into_owned().into()),
        force: [0, 1, 2].map(component),
        moment: [3, 4, 5].map(component),
    }
}

/// Takes for zero what rounding leaves of components that a row has no part in: of a force, or of a moment where the arm of forces is
/// known. A ball joint has no moment, and a hinge none about its axis.
fn drop_rounding(weights: &mut [f64], map: &DMatrix<f64>, arm: Option<f64>) {
    for (weight, row) in weights.iter_mut().zip(map.column_iter()) {
        let [force, moment] = [0, 3].map(|first| row.rows(first, 3).norm());
        let size = arm.map_or(force, |arm| moment + arm * force);
        if weight.abs() <= ROUNDING * size {
            *weight = 0.0;
        }
    }
}

fn body_name(system: &System, body: BodyRef) -> String {
    match body {
        BodyRef::Ground => crate::scene::GROUND.to_owned(),
        BodyRef::Moving(body) => system.model.bodies[body].name.clone(),
    }
}

fn about(
    system: &System,
    at: &State,
    constraint: &Constraint,
    side: usize,
    about: MomentReference,
) -> (String, Vector3<f64>) {
    let body = constraint.bodies[side];
    let name = body_name(system, body);
    match (about, body) {
        (MomentReference::WorldPoint(point), _) => ("the stated point".to_owned(), point.into()),
        (MomentReference::CenterOfMass, BodyRef::Ground) => {
            ("the world's origin".to_owned(), Vector3::zeros())
        }
        (MomentReference::CenterOfMass, BodyRef::Moving(index)) => {
            (format!("the centre of mass of \"{name}\""), at.bodies()[index].q.r)
        }
        (MomentReference::JointPoint, BodyRef::Ground) => {
            (format!("the point of \"{}\" on \"{name}\"", constraint.name), constraint.points[side])
        }
        (MomentReference::JointPoint, BodyRef::Moving(index)) => {
            let q = &at.bodies()[index].q;
            (
                format!("the point of \"{}\" on \"{name}\"", constraint.name),
                q.r + q.arm(&constraint.points[side]),
            )
        }
    }
}

/// The frame in words and its axes as columns.
fn frame(
    system: &System,
    at: &State,
    constraint: &Constraint,
    body: BodyRef,
    expressed_in: ExpressedIn,
) -> (String, Matrix3<f64>) {
    let world = || ("world".to_owned(), Matrix3::identity());
    match (expressed_in, body) {
        (ExpressedIn::World, _) | (ExpressedIn::Body, BodyRef::Ground) => world(),
        (ExpressedIn::Body, BodyRef::Moving(index)) => {
            let directors = Matrix3::from_columns(&at.bodies()[index].q.e);
            let axes = directors * system.model.bodies[index].principal_axes.transpose();
            (format!("frame of \"{}\"", body_name(system, body)), axes)
        }
        (ExpressedIn::Joint, _) => match joint_of(system, constraint) {
            Some(joint) if joint.axes[0] != Vector3::zeros() => {
                let turn = |local: &Vector3<f64>| match joint.bodies[0] {
                    BodyRef::Ground => *local,
                    BodyRef::Moving(index) => at.bodies()[index].q.arm(local),
                };
                let x = turn(&joint.axes[0]).normalize();
                let y = turn(&joint.cross[0][0]);
                let y = (y - x * x.dot(&y)).try_normalize(1e-9).unwrap_or_else(|| orthonormal_basis(&x)[0]);
                let axes = Matrix3::from_columns(&[x, y, x.cross(&y)]);
                (format!("joint \"{}\", x along its axis", joint.name), axes)
            }
            _ => world(),
        },
    }
}

/// The joint that a constraint belongs to, or that its driver moves.
fn joint_of<'a>(system: &'a System, constraint: &Constraint) -> Option<&'a ModelJoint> {
    let model = &system.model;
    if !constraint.driver {
        return model.joints.iter().find(|joint| joint.name == constraint.name);
    }
    let driver = model.drivers.iter().find(|driver| driver.name == constraint.name)?;
    match driver.kind {
        DriverKind::Angle { joint, .. } | DriverKind::Slide { joint, .. } => model.joints.get(joint),
        _ => None,
    }
}

/// The 6 × m map from a constraint's solver multipliers to force and moment about `point` on one of its bodies.
///
/// On a moving body it is −A_bᵀ, moved from the centre of mass to the point. On the ground it is the opposite of all
/// that the constraint does to moving bodies, since a joint has no mass.
fn wrench_map(
    at: &Multipliers,
    constraint: &Constraint,
    body: BodyRef,
    point: &Vector3<f64>,
) -> DMatrix<f64> {
    let system = at.system;
    let mut map = DMatrix::zeros(6, constraint.solver.len());
    for index in constraint.incidence_ids() {
        let incidence = &system[index];
        let sign = match body {
            BodyRef::Ground => 1.0,
            BodyRef::Moving(own) if own == incidence.body => -1.0,
            BodyRef::Moving(_) => continue,
        };
        let arm = at.state.bodies()[incidence.body].q.r - point;
        for (k, row) in at.jacobian.rows_on(system, index).chunks_exact(6).enumerate() {
            let force = Vector3::new(row[0], row[1], row[2]) * sign;
            let moment = Vector3::new(row[3], row[4], row[5]) * sign + arm.cross(&force);
            for c in 0..3 {
                map[(c, k)] += force[c];
                map[(3 + c, k)] += moment[c];
            }
        }
    }
    map
}
