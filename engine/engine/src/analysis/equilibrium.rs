//! Static equilibrium: where nothing accelerates.

use super::{AnalysisError, Stage, Wanted};
use crate::error::EngineError;
use crate::reactions::report::{Convention, ReactionReport, report};
use crate::scene::Scene;
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use schemars::JsonSchema;
use serde::Serialize;
use triad_dynamics::state::BodyFrame;

/// Greatest number of steps of the search.
const STEPS: usize = 300;
/// Generalized force, relative to the largest force on a body, below which it counts as zero.
const BALANCED: f64 = 1e-10;
/// Stiffness, relative to the largest, below which the search takes none.
const SOFTEST: f64 = 1e-9;
/// Step, in lengths of the mechanism, that no stiffness is soft enough for: it is cut short to [`LARGEST`] in any case.
const FARTHEST: f64 = 1e6;
/// Largest step, relative to the length of the mechanism.
const LARGEST: f64 = 0.2;

/// A position of rest.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Equilibrium {
    /// Steps of the search.
    pub iterations: usize,
    /// Generalized force that is left, N.
    pub residual: f64,
    /// Smallest stiffness along a small motion, N/m: a position with a negative one is left at a touch. Motions are
    /// measured by the displacements of all bodies and by their rotations times the mechanism's length, squared and
    /// added.
    pub least_stiffness: f64,
    /// Whether every small displacement is driven back; undecided (`None`) where some motion meets no stiffness.
    pub stable: Option<bool>,
    /// The bodies, at rest.
    pub bodies: Vec<BodyFrame>,
    /// Reactions at rest.
    pub reactions: ReactionReport,
}

/// Finds a position of rest near the start, drivers and loads held at their start.
///
/// Newton's method in the small motions of the mechanism, its stiffness made positive in every direction so that the
/// search runs downhill: it comes to a stable position, unless it starts at an unstable one.
///
/// # Errors
///
/// [`AnalysisError`]: a scene that cannot be, one too large for dense matrices, or no position of rest.
///
/// ```
/// use triad_engine::{analysis::equilibrium, prelude::*};
///
/// let mut scene = Scene::new("hanging").gravity([0.0, -9.81, 0.0]);
/// let rod = scene.add(Body::rod("rod", 1.0, [0.0; 3], [1.0, 0.0, 0.0]));
/// scene.add(Joint::revolute("pin", Ground, &rod).at([0.0; 3]).about([0.0, 0.0, 1.0]));
/// let rest = equilibrium(&scene)?;
/// assert!((rest.bodies[0].position[1] + 0.5).abs() < 1e-6 && rest.stable == Some(true));
/// # Ok::<(), triad_engine::analysis::AnalysisError>(())
/// ```
pub fn equilibrium(scene: &Scene) -> Result<Equilibrium, AnalysisError> {
    equilibrium_if(scene, &Wanted::default())
}

/// As [`equilibrium`], as long as it is wanted.
///
/// # Errors
///
/// As [`equilibrium`], and [`AnalysisError::NoLongerWanted`].
pub fn equilibrium_if(scene: &Scene, wanted: &Wanted) -> Result<Equilibrium, AnalysisError> {
    let mut stage = Stage::new(scene)?;
    stage.wanted = wanted.clone();
    find(&mut stage)
}

/// Eigenvalues and eigenvectors of the symmetric part; none where nothing can move.
fn eigen(matrix: &DMatrix<f64>) -> (DVector<f64>, DMatrix<f64>) {
    if matrix.is_empty() {
        return (DVector::zeros(0), DMatrix::zeros(0, 0));
    }
    let eigen = SymmetricEigen::new((matrix + matrix.transpose()) * 0.5);
    (eigen.eigenvalues, eigen.eigenvectors)
}

/// Moves a stage to equilibrium.
pub(super) fn find(stage: &mut Stage) -> Result<Equilibrium, AnalysisError> {
    stage.rest();
    let length = stage.mechanism.system.length;
    // What is left over where a further step leads to no numbers.
    let mut last = (0.0, String::new());
    let mut taken = STEPS;
    for iterations in 0..STEPS {
        stage.wanted.check()?;
        let basis = stage.tangent()?;
        stage.rest();
        let force = stage.forces();
        let along = basis.tr_mul(&force);
        let residual = along.amax();
        let multipliers = stage.accelerate().multipliers.solver_rows().to_vec();
        let stiffness = stage.stiffness(&basis, &multipliers);
        let (stiffnesses, motions) = eigen(&stiffness);
        let stiffest = stiffnesses.amax();
        if residual <= BALANCED * force.amax().max(f64::MIN_POSITIVE) {
            stage.rest();
            let least = stiffnesses.iter().fold(f64::INFINITY, |a, b| a.min(*b));
            let clear = least.abs() > 1e-7 * stiffest;
            let reactions = report(&stage.accelerate().multipliers, Convention::default());
            return Ok(Equilibrium {
                iterations,
                residual,
                least_stiffness: if least.is_finite() { least } else { 0.0 },
                stable: if basis.ncols() == 0 { Some(true) } else { clear.then_some(least > 0.0) },
                bodies: stage.frames(),
                reactions: reactions.map_err(EngineError::from)?,
            });
        }
        if !residual.is_finite() {
            taken = iterations;
            break;
        }
        last = (residual, stage.foremost(&(&basis * &along)));
        let floor = (SOFTEST * stiffest).max(residual / (FARTHEST * length)).max(f64::MIN_POSITIVE);
        let mut step = motions.tr_mul(&along);
        for (x, stiffness) in step.iter_mut().zip(stiffnesses.iter()) {
            *x /= stiffness.abs().max(floor);
        }
        let step = motions * step;
        let size = step.norm();
        let scale = if size > LARGEST * length { LARGEST * length / size } else { 1.0 };
        let there = stage.moved(&(basis * step), scale);
        let open = stage.assemble(there);
        if open.is_nan() || open > 1e-6 {
            taken = iterations + 1;
            break;
        }
    }
    let (residual, body) = left_over(stage)?.unwrap_or(last);
    Err(AnalysisError::NoEquilibrium { iterations: taken, residual, body })
}

/// The generalized force that is left at the held position, N, and the body that it acts on most; `None` where there are no numbers.
fn left_over(stage: &mut Stage) -> Result<Option<(f64, String)>, AnalysisError> {
    if !stage.q.iter().all(|x| x.is_finite()) {
        return Ok(None);
    }
    let basis = stage.tangent()?;
    stage.rest();
    let along = basis.tr_mul(&stage.forces());
    let body = stage.foremost(&(&basis * &along));
    Ok(along.amax().is_finite().then(|| (along.amax(), body)))
}
