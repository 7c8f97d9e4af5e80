//! Static equilibrium: where nothing accelerates.

use super::stability::{self, Stability, Stiffness};
use super::{AnalysisError, Stage, Wanted};
use crate::error::EngineError;
use crate::reactions::report::{Convention, ReactionReport, report};
use crate::scene::Scene;
use nalgebra::{DMatrix, DVector, DVectorView, SymmetricEigen};
use schemars::JsonSchema;
use serde::Serialize;
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::state::BodyFrame;

/// Greatest number of steps of the search, those that were taken back among them.
const STEPS: usize = 300;
/// Generalized force along a motion, relative to what the forces on bodies that it moves would make of it if they all pointed along
/// their ways, below which it counts as zero.
const BALANCED: f64 = 1e-10;
/// Part of the mechanism's length by which a position that rounding leaves open is told to be so.
const TOLD: f64 = 1e-6;
/// Part of the largest force that takes part in a balance which rounding leaves.
const ROUNDED: f64 = 1e-14;
/// So many of them may add up.
const SEVERAL: f64 = 10.0;
/// Part of what was left before a step that a step which leads on leaves.
const STALLED: f64 = 0.1;
/// Stiffness, relative to the largest, below which the search takes none.
const SOFTEST: f64 = 1e-9;
/// Change of forces by a motion, relative to the largest, below which it changes none: what differences leave of zero.
const UNFELT: f64 = 1e-7;
/// Step, in lengths of the mechanism, that no stiffness is soft enough for: it is cut short in any case.
const FARTHEST: f64 = 1e6;
/// Largest first step, relative to the length of the mechanism; those that lead on are followed by longer ones.
const LARGEST: f64 = 0.2;
/// Largest turn of a body in one step, rad.
const LARGEST_TURN: f64 = 0.5;
/// Steps shorter than this part of the length of the mechanism are taken as they are; shorter ones than its square mean that
/// none leads on.
const SHORT: f64 = 1e-6;
/// Force along a step, as a part of that at its start, with which the end may push back: more means that the step went too far.
const PUSHED_BACK: f64 = 0.5;

/// A position of rest.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Equilibrium {
    /// Steps of the search.
    pub iterations: usize,
    /// Generalized force that is left, N.
    pub residual: f64,
    /// How far the bodies may be from rest, m, rotations times the mechanism's length: what is left of the forces, or their rounding, over the
    /// stiffness. `None` where some motion meets no stiffness.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<f64>,
    /// Smallest stiffness along a small motion, N/m: a position with a negative one is left at a touch. Motions are
    /// measured by the displacements of all bodies and by their rotations times the mechanism's length, squared and
    /// added.
    pub least_stiffness: f64,
    /// Whether every small displacement is driven back; undecided (`None`) where some motion meets no stiffness. Where forces have no
    /// potential, whether no small motion grows, and undecided where something damps it.
    pub stable: Option<bool>,
    /// The bodies, at rest.
    pub bodies: Vec<BodyFrame>,
    /// Reactions at rest.
    pub reactions: ReactionReport,
    /// What has to be known of the result.
    pub notes: Vec<String>,
}

/// Finds a position of rest near the start, drivers and loads held at their start.
///
/// Newton's method in the small motions of the mechanism, its stiffness made positive in every direction so that the
/// search runs downhill: it comes to a stable position, unless it starts at an unstable one. A step after which the forces push
/// back is taken again, shorter; after one that led on, longer ones are tried.
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
    equilibrium_while(scene, &Wanted::default())
}

/// As [`equilibrium`], as long as it is wanted.
///
/// # Errors
///
/// As [`equilibrium`], and [`AnalysisError::NoLongerWanted`].
pub fn equilibrium_while(scene: &Scene, wanted: &Wanted) -> Result<Equilibrium, AnalysisError> {
    let mut stage = Stage::new(scene)?;
    stage.wanted = wanted.clone();
    stage.hold_drivers();
    let found = find(&mut stage)?;
    told(&mut stage, found)
}

/// Eigenvalues and eigenvectors of the symmetric part; none where nothing can move.
fn eigen(matrix: &DMatrix<f64>) -> (DVector<f64>, DMatrix<f64>) {
    if matrix.is_empty() {
        return (DVector::zeros(0), DMatrix::zeros(0, 0));
    }
    let eigen = SymmetricEigen::new((matrix + matrix.transpose()) * 0.5);
    (eigen.eigenvalues, eigen.eigenvectors)
}

/// A held position with its small motions and the forces along them.
struct Held {
    basis: DMatrix<f64>,
    /// Of the forces on bodies, the largest, N.
    largest: f64,
    /// The forces, body by body.
    force: DVector<f64>,
    /// The generalized force.
    along: DVector<f64>,
}

impl Held {
    fn new(stage: &mut Stage) -> Result<Self, AnalysisError> {
        let basis = stage.displacements()?;
        stage.rest();
        let force = stage.forces();
        Ok(Self { largest: stage.largest(&force), along: basis.tr_mul(&force), force, basis })
    }

    /// What the forces on bodies would make of each motion, a unit vector in the basis, if they all pointed along their ways, N. A weight
    /// that a rail carries counts along the rail, and says nothing of what hangs on it.
    fn carried(&self, motions: &DMatrix<f64>) -> Vec<f64> {
        let moved = &self.basis * motions;
        let of = |motion: DVectorView<f64>| {
            let part = |k: usize| self.force.rows(k, 3).norm() * motion.rows(k, 3).norm();
            (0..motion.len()).step_by(3).map(part).sum()
        };
        moved.column_iter().map(of).collect()
    }

    /// Whether nothing is left along any of the motions.
    fn is_balanced(&self, motions: &DMatrix<f64>) -> bool {
        let left = motions.tr_mul(&self.along);
        left.iter()
            .zip(self.carried(motions))
            .all(|(left, carried)| left.abs() <= BALANCED * carried.max(f64::MIN_POSITIVE))
    }

    /// How far what is left moves the bodies, along motions that it does not balance and where it is more than the rounding of the
    /// forces on bodies, m.
    fn off_by(&self, Stiffness { along, motions, .. }: &Stiffness) -> f64 {
        let (left, rounded) = (motions.tr_mul(&self.along), SEVERAL * ROUNDED * self.largest);
        let unbalanced = left
            .iter()
            .zip(self.carried(motions))
            .zip(along.iter())
            .filter(|((left, carried), _)| left.abs() > (BALANCED * carried).max(rounded))
            .map(|((left, _), stiffness)| (left / stiffness).abs());
        unbalanced.fold(0.0, f64::max)
    }

    /// How far from rest the position is along each motion, m: what is left, or the rounding of the forces on bodies, over its stiffness.
    fn off(&self, Stiffness { along, motions, .. }: &Stiffness) -> DVector<f64> {
        let rounded = SEVERAL * f64::EPSILON * self.largest;
        motions
            .tr_mul(&self.along)
            .zip_map(along, |left, stiffness| left.abs().max(rounded) / stiffness.abs())
    }

    /// The same of all motions together.
    fn error(&self, stiffness: &Stiffness) -> Option<f64> {
        Some(self.off(stiffness).norm()).filter(|error| error.is_finite())
    }

    /// Work of the forces for each unit of a motion, of which the part counts that the joints allow here.
    fn push(&self, motion: &DVector<f64>, length: f64) -> f64 {
        let mut measured = motion.clone();
        measured.iter_mut().enumerate().filter(|(k, _)| k % 6 >= 3).for_each(|(_, x)| *x *= length * length);
        self.along.dot(&self.basis.tr_mul(&measured))
    }
}

/// What a stage that has been moved to equilibrium is like there.
pub(super) struct Found {
    held: Held,
    stiffness: Stiffness,
    iterations: usize,
}

impl Found {
    /// A twist of the bodies by which the position may be off. Motions that the forces do not hold are not in it.
    pub(super) fn off(&self) -> DVector<f64> {
        let Self { held, stiffness, .. } = self;
        let none = SOFTEST * stiffness.along.amax();
        let felt = |off: f64, along: f64| if along.abs() > none { off } else { 0.0 };
        let off = held.off(stiffness).zip_map(&stiffness.along, felt);
        &held.basis * (&stiffness.motions * off)
    }
}

/// Moves a stage to equilibrium.
pub(super) fn find(stage: &mut Stage) -> Result<Found, AnalysisError> {
    stage.rest();
    let mut held = Held::new(stage)?;
    let mut reach = LARGEST * stage.mechanism.system.length;
    let (mut steps, mut before) = (0, f64::INFINITY);
    loop {
        stage.wanted.check()?;
        let multipliers = stage.accelerate().multipliers.solver_rows().to_vec();
        let matrix = stage.stiffness(&held.basis, &multipliers);
        let (along, motions) = eigen(&matrix);
        let stiffness = Stiffness { matrix, along, motions };
        let residual = held.along.amax();
        let rounded = residual <= rounding(stage);
        let balanced = held.is_balanced(&stiffness.motions);
        // Of rounding no step takes more away; whatever else there is still becomes smaller.
        if balanced || (rounded && residual > STALLED * before) {
            stage.rest();
            return Ok(Found { held, stiffness, iterations: steps });
        }
        let next = if residual.is_finite() {
            let nothing = rounding(stage).max(BALANCED * held.largest);
            let length = stage.mechanism.system.length;
            let step = downhill(&held, &stiffness, length, nothing);
            advance(stage, &held, &step, &mut reach, &mut steps)?
        } else {
            None
        };
        before = residual;
        let Some(next) = next else {
            // Where branches of the motion meet, positions are known to the root of their rounding.
            let near = SHORT * stage.mechanism.system.length;
            if rounded || held.error(&stiffness).is_some_and(|error| error < near) {
                stage.rest();
                return Ok(Found { held, stiffness, iterations: steps });
            }
            let body = stage.foremost(&(&held.basis * &held.along));
            return Err(AnalysisError::NoEquilibrium { iterations: steps, residual, body });
        };
        held = next;
    }
}

/// Forces, and moments over the mechanism's length, below this are the rounding of a balance, N: a part of the largest one that
/// takes part in it. What is left on a body that springs alone carry is rounding itself, and nothing to compare with.
pub(super) fn rounding(stage: &Stage) -> f64 {
    ROUNDED * largest_part(stage)
}

/// The largest force, or moment over the mechanism's length, that takes part in a balance, N.
pub(super) fn largest_part(stage: &Stage) -> f64 {
    let Mechanism { system, state, .. } = &stage.mechanism;
    let length = system.length;
    let reach = state.bodies().iter().fold(length, |reach, at| reach.max(at.q.r.norm()));
    let weights = system.bodies.iter().map(|body| body.mass * system.model.gravity.norm());
    let loads = system.loads.iter().map(|load| load.largest_part(state, length, reach));
    let turning = system.bodies.iter().zip(state.bodies()).enumerate().map(|(index, (body, at))| {
        let [_, omega] = stage.flow.twist(index, &at.q);
        body.principal.max() * omega.norm_squared() / length
    });
    let inertial = turning.fold(stage.largest(&(stage.forces() - stage.loads())), f64::max);
    weights.chain(loads).fold(inertial, f64::max)
}

/// Rounding of the numbers that places are told by, m.
fn rounding_of_places(stage: &Stage) -> f64 {
    let farthest = stage.mechanism.state.bodies().iter().fold(0.0f64, |most, at| most.max(at.q.r.norm()));
    f64::EPSILON * farthest
}

/// The position of rest at which the stage is.
fn told(
    stage: &mut Stage,
    Found { held, stiffness, iterations }: Found,
) -> Result<Equilibrium, AnalysisError> {
    let carried = held.carried(&stiffness.motions);
    let stiffness = stiffness.of_what_moves(stage, &held.basis, &carried);
    let least = stiffness.along.iter().fold(f64::INFINITY, |a, b| a.min(*b));
    let Stability { stable, note } =
        stability::judge(stage, &held.basis, &stiffness, &held.carried(&stiffness.motions));
    stage.rest();
    let mut notes: Vec<String> = note.into_iter().chain(stage.varying_loads_note()).collect();
    let off = held.off_by(&stiffness);
    if off > TOLD * stage.mechanism.system.length {
        notes.push(format!(
            "springs are too different to find it: what is left of the forces, {:.1e} N, is the rounding of the stiffest, and moves what the \
             softest hold by up to {off:.0e} m",
            held.along.amax()
        ));
    }
    if stage.mechanism.system.loads.iter().any(|load| load.dry_friction().is_some()) {
        notes.push("dry friction is left out: where it holds, positions beside this one are positions of rest as well".to_owned());
    }
    let reactions = report(&stage.accelerate().multipliers, Convention::default());
    Ok(Equilibrium {
        iterations,
        residual: held.along.amax(),
        error: held
            .error(&stiffness)
            .map(|error| error.max(rounding_of_places(stage)))
            .filter(|error| *error < stage.mechanism.system.length),
        least_stiffness: if least.is_finite() { least } else { 0.0 },
        stable,
        bodies: stage.frames(),
        reactions: reactions.map_err(EngineError::from)?,
        notes,
    })
}

/// The step of Newton's method with all stiffnesses made positive.
///
/// Motions that change no force, such as the spin of a link about its own axis, are left out where `nothing` pushes along them, N: away
/// from equilibrium the symmetric part of the stiffness couples them with motions that matter, by a stiffness below zero.
fn downhill(
    held: &Held,
    Stiffness { matrix, along: stiffnesses, motions }: &Stiffness,
    length: f64,
    nothing: f64,
) -> DVector<f64> {
    let stiffest = stiffnesses.amax();
    let floor = (SOFTEST * stiffest).max(held.along.amax() / (FARTHEST * length)).max(f64::MIN_POSITIVE);
    let divided = |mut along: DVector<f64>, stiffnesses: &DVector<f64>| {
        for (x, stiffness) in along.iter_mut().zip(stiffnesses.iter()) {
            *x /= stiffness.abs().max(floor);
        }
        along
    };
    let idle = if stiffnesses.min() > SOFTEST * stiffest { None } else { idle_and_felt(matrix) };
    let Some([idle, felt]) = idle else {
        return motions * divided(motions.tr_mul(&held.along), stiffnesses);
    };
    let (stiffnesses, motions) = eigen(&felt.tr_mul(&(matrix * &felt)));
    let motions = felt * motions;
    let step = &motions * divided(motions.tr_mul(&held.along), &stiffnesses);
    let along = idle.tr_mul(&held.along);
    if along.amax() <= nothing { step } else { step + idle * (along / floor) }
}

/// Bases of the motions that change no force and of the others; `None` where all do.
fn idle_and_felt(stiffness: &DMatrix<f64>) -> Option<[DMatrix<f64>; 2]> {
    let (squares, motions) = eigen(&stiffness.tr_mul(stiffness));
    let most = squares.amax() * UNFELT * UNFELT;
    let (idle, felt): (Vec<usize>, Vec<usize>) = (0..squares.len()).partition(|&k| squares[k] <= most);
    (!idle.is_empty()).then(|| [motions.select_columns(&idle), motions.select_columns(&felt)])
}

/// Takes a step, or as much of it as leads on: `reach` is how far that was thought to be, and is learned from. `None` where nothing
/// does, or where all `steps` are used up; then the stage is where it was.
fn advance(
    stage: &mut Stage,
    held: &Held,
    step: &DVector<f64>,
    reach: &mut f64,
    steps: &mut usize,
) -> Result<Option<Held>, AnalysisError> {
    let length = stage.mechanism.system.length;
    let (from, turns) = (stage.q.clone(), stage.turns());
    let whole = &held.basis * step;
    let size = step.norm();
    let turn = (0..whole.len() / 6).fold(0.0f64, |a, body| a.max(whole.fixed_rows::<3>(6 * body + 3).norm()));
    let there = held.along.dot(step);
    while *steps < STEPS && *reach > SHORT * SHORT * length {
        stage.wanted.check()?;
        *steps += 1;
        let scale = (*reach / size).min(LARGEST_TURN / turn.max(LARGEST_TURN)).min(1.0);
        let open = stage.assemble(stage.moved(&whole, scale));
        // Comparisons that are false for NaN as well.
        if open <= 1e-6 && stage.q.iter().all(|x| x.is_finite()) {
            let next = Held::new(stage)?;
            let push = next.push(&whole, length);
            if push >= -PUSHED_BACK * there || size * scale <= SHORT * length {
                if scale < 1.0 && push > 0.0 {
                    *reach = (2.0 * *reach).min(FARTHEST * length);
                }
                return Ok(Some(next));
            }
        }
        stage.put_back(&from, &turns);
        *reach = 0.25 * size * scale;
    }
    Ok(None)
}
