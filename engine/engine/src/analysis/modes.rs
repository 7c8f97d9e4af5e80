//! Small vibrations about a position at rest: eigenfrequencies and mode shapes.

mod mode;
mod pencil;
mod short_springs;
mod steady;

pub use mode::{Mode, ModeShape};
pub use steady::SteadyMotion;

use super::inertia::{self, Inertia, TurnsWithoutInertia};
use super::{AnalysisError, Stage, Wanted, equilibrium};
use crate::scene::Scene;
use mode::{CLEARLY, mode};
use nalgebra::{Complex, ComplexField, DMatrix, DVector};
use pencil::{Eigen, Pencil, solve};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use steady::Unfelt;
use triad_dynamics::model::LoadKind;
use triad_dynamics::state::BodyFrame;
use triad_linalg::{larger_or_nan, least_squares, null_and_rest};

/// Damping or asymmetry below this part of the stiffness is none.
const NEGLIGIBLE: f64 = 1e-9;
/// Generalized force, as a part of the largest one on a body, above which a position is not an equilibrium.
const UNBALANCED: f64 = 1e-6;
/// Stiffness or damping below this part of the largest is none: differences of order four give both to about 1e-13.
const STIFFLESS: f64 = 1e-11;
/// Damping of a motion without inertia below this part of the largest is none: it is rounding of what dampers do exactly.
const UNCREEPING: f64 = 1e-13;
/// Part of the unit force of a damped load that a drift may feel and yet go on for ever.
const UNDAMPED: f64 = 1e-9;

/// The position about which the motion is linearized.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ModesAbout {
    /// The equilibrium near the start.
    #[default]
    Equilibrium,
    /// The start itself, at rest.
    Start,
    /// The steady motion near the start, drivers at their speed: all bodies keep their places in a frame that turns and slides
    /// uniformly, and spin at most about an axis around which they are alike. What drivers leave free has the momenta of the
    /// start.
    Steady,
}

/// All modes of a position.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Modes {
    /// Degrees of freedom.
    pub freedoms: usize,
    /// The modes, slowest first; those without a frequency by their growth.
    pub modes: Vec<Mode>,
    /// Degrees of freedom that have no inertia, and neither stiffness nor damping: they have no mode.
    pub left_out: usize,
    /// The bodies that turn in those, and their axes.
    pub without_inertia: Vec<TurnsWithoutInertia>,
    /// The steady motion, if the modes are about one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steady: Option<SteadyMotion>,
    /// The bodies at that position.
    pub bodies: Vec<BodyFrame>,
    /// What has to be known of the result.
    pub notes: Vec<String>,
}

/// Linearizes a scene about a position at rest.
///
/// M ẍ + C ẋ + K x = 0 in a basis of small motions; K holds the stiffness of loads and the geometric stiffness of the constraint
/// forces — eq. (10.13). About a steady motion x is measured in its frame, C holds the gyroscopic matrix besides and K the
/// stiffness of the centrifugal forces — eq. (10.15).
///
/// # Errors
///
/// [`AnalysisError`]: as for [`equilibrium`](super::equilibrium()), and eigenvalues that are not found.
///
/// ```
/// use triad_engine::{analysis::{ModesAbout, modes}, prelude::*};
///
/// let mut scene = Scene::new("pendulum").gravity([0.0, -9.81, 0.0]);
/// let rod = scene.add(Body::rod("rod", 1.0, [0.0; 3], [0.0, -1.0, 0.0]));
/// scene.add(Joint::revolute("pin", Ground, &rod).at([0.0; 3]).about([0.0, 0.0, 1.0]));
/// let found = modes(&scene, ModesAbout::Equilibrium)?;
/// let exact = f64::sqrt(1.5 * 9.81) / std::f64::consts::TAU;
/// assert!(found.freedoms == 1 && (found.modes[0].frequency - exact).abs() < 1e-6);
/// # Ok::<(), triad_engine::analysis::AnalysisError>(())
/// ```
pub fn modes(scene: &Scene, about: ModesAbout) -> Result<Modes, AnalysisError> {
    modes_while(scene, about, &Wanted::default())
}

/// As [`modes`], as long as they are wanted.
///
/// # Errors
///
/// As [`modes`], and [`AnalysisError::NoLongerWanted`].
pub fn modes_while(scene: &Scene, about: ModesAbout, wanted: &Wanted) -> Result<Modes, AnalysisError> {
    let mut stage = Stage::new(scene)?;
    stage.wanted = wanted.clone();
    let mut notes = left_out_of_start(&stage, about);
    let moving = stage.q_dot.iter().any(|v| *v != 0.0);
    if about != ModesAbout::Steady {
        stage.hold_drivers();
    }
    short_springs::leave_out_held(&mut stage)?;
    let position = Position::find(&mut stage, about)?;
    if position.steady.is_some() && moving && stage.flow.is_rest() {
        notes.push(NEAREST_IS_REST.to_owned());
    }
    stage.rest();
    short_springs::leave_out_jumping(&mut stage, &mut notes);
    let mut basis = stage.tangent()?;
    let freedoms = basis.ncols();
    let singular = stage.singular_note();
    let is_singular = singular.is_some();
    notes.extend(singular);
    if freedoms == 0 {
        notes.push("joints and drivers leave no freedom: nothing can vibrate".to_owned());
    }
    basis = position.across(&stage, basis);
    stage.rest();
    let left = basis.tr_mul(&stage.forces()).amax();
    if left > (UNBALANCED * stage.largest_force()).max(equilibrium::rounding(&stage)) {
        notes.push(format!(
            "the position is not an equilibrium: a generalized force of {left:.3e} N is left, which the linear \
             equations leave out"
        ));
    }
    let unfelt = position.unfelt.as_ref();
    let small = SmallMotions::new(&mut stage, &basis, unfelt);
    notes.extend(small.told_of_held());
    notes.extend(small.told_of_hidden(&stage));
    let length = stage.mechanism.system.length;
    let found = small.eigen(&stage)?;
    let without_inertia = inertia::turning_bodies(&stage, &small.left_out);
    let bodies = stage.frames();
    let beside = position.beside(&mut stage)?.filter(|beside| beside.len() == found.len());
    if beside.is_none() && !is_singular {
        notes.push(MODES_OF_ROUNDING.to_owned());
    }
    let mut modes: Vec<Mode> = found
        .iter()
        .map(|eigen| Mode {
            error: beside.as_ref().and_then(|beside| error(eigen, beside, position.slower)),
            ..mode(eigen.value, &small.moved(&eigen.vector), length)
        })
        .collect();
    let translations =
        unfelt.map_or_else(|| DMatrix::zeros(basis.nrows(), 0), |unfelt| unfelt.translations.clone());
    modes.extend(
        columns([&small.drifts(), &translations])
            .column_iter()
            .map(|motion| mode(Complex::new(0.0, 0.0), &motion.map(|x| Complex::new(x, 0.0)), length)),
    );
    modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency).then(a.growth.total_cmp(&b.growth)));
    let left_out = small.left_out.ncols();
    Ok(Modes { freedoms, modes, left_out, without_inertia, steady: position.steady, bodies, notes })
}

/// Where the equations are linearized.
struct Position {
    steady: Option<SteadyMotion>,
    unfelt: Option<Unfelt>,
    /// A twist of the bodies by which the position may be off.
    off: DVector<f64>,
    /// Part of the velocities of a steady motion by which they may be off: frequencies are off by as much.
    slower: f64,
}

impl Position {
    /// Finds it, and holds the stage there.
    fn find(stage: &mut Stage, about: ModesAbout) -> Result<Self, AnalysisError> {
        Ok(match about {
            ModesAbout::Equilibrium => {
                let off = equilibrium::find(stage)?.off();
                Self { steady: None, unfelt: None, off, slower: 0.0 }
            }
            ModesAbout::Start => Self {
                steady: None,
                unfelt: None,
                off: DVector::zeros(6 * stage.mechanism.system.bodies.len()),
                slower: 0.0,
            },
            ModesAbout::Steady => {
                let steady::Found { told, unfelt, off, slower } = steady::find(stage)?;
                Self { steady: Some(told), unfelt: Some(unfelt), off, slower }
            }
        })
    }

    /// The part of a basis of small motions that leaves the whole where it is.
    fn across(&self, stage: &Stage, basis: DMatrix<f64>) -> DMatrix<f64> {
        match &self.unfelt {
            Some(unfelt) => unfelt.across(stage, basis),
            None => basis,
        }
    }

    /// The eigenvalues where the stage is after it has been disturbed by what the position may be off, if they are found.
    fn beside(&self, stage: &mut Stage) -> Result<Option<Vec<Complex<f64>>>, AnalysisError> {
        stage.disturb(&self.off);
        stage.rest();
        let basis = stage.tangent()?;
        let basis = self.across(stage, basis);
        let small = SmallMotions::new(stage, &basis, self.unfelt.as_ref());
        match small.eigen(stage) {
            Ok(found) => Ok(Some(found.iter().map(|eigen| eigen.value).collect())),
            Err(AnalysisError::NoModes) => Ok(None),
            Err(error) => Err(error),
        }
    }
}

/// That which modes there are is not certain.
const MODES_OF_ROUNDING: &str =
    "how many modes there are depends on rounding: some motion has next to no inertia or stiffness";

/// Error of an eigenvalue, 1/s: how far it is from the nearest of those found beside, its own rounding, and what of it the velocities of
/// a steady motion may be `slower`.
fn error(eigen: &Eigen, beside: &[Complex<f64>], slower: f64) -> Option<f64> {
    let nearest = beside.iter().map(|other| (other - eigen.value).modulus()).min_by(f64::total_cmp)?;
    // Not `max`, which would leave out what is not a number.
    let error = larger_or_nan(nearest, larger_or_nan(eigen.rounding, slower * eigen.value.modulus()));
    Some(error).filter(|error| f64::is_finite(*error))
}

/// What of the start linear equations about a position leave out.
fn left_out_of_start(stage: &Stage, about: ModesAbout) -> Vec<String> {
    let mut notes = Vec::new();
    if about != ModesAbout::Steady && stage.q_dot.iter().any(|v| *v != 0.0) {
        notes.push(
            "velocities of the start are left out: modes are those of the mechanism at rest; those about the steady motion at these \
             velocities, if there is one, can be asked for"
                .to_owned(),
        );
    }
    if !stage.mechanism.system.frictions.is_empty() {
        notes.push(
            "friction with a coefficient is left out: about a position at rest it has no linear law"
                .to_owned(),
        );
    }
    notes.extend(stage.varying_loads_note());
    notes
}

/// That no motion belongs to the velocities of the start.
const NEAREST_IS_REST: &str = "velocities of the start are left out: they belong to no motion in which all bodies keep their places in a \
                               frame, and the steady motion near the start is rest";

/// The linear equations of the small motions.
struct SmallMotions {
    /// Twists of each body as columns, those with inertia first.
    motions: DMatrix<f64>,
    /// The equations in them.
    pencil: Pencil,
    /// Twists that have neither inertia nor stiffness nor damping.
    left_out: DMatrix<f64>,
    /// How many motions without inertia stiffness alone holds.
    held: usize,
    /// Stiffness of a motion of length one below which it is what differences leave of zero, N/m.
    stiffless: f64,
}

/// What is none of the stiffness (N/m) and of the damping (N s/m) of motions of length one.
struct Limits {
    stiffness: f64,
    damping: f64,
}

impl Limits {
    /// Of motions without inertia: parts of the largest along all motions, since rounding would be something beside itself.
    fn of_massless(stage: &mut Stage, basis: &DMatrix<f64>, multipliers: &[f64]) -> Self {
        let stiffness = stage.stiffness(basis, multipliers);
        stage.rest();
        Self { stiffness: stiffless(stage, &stiffness), damping: UNCREEPING * largest(&stage.damping(basis)) }
    }
}

/// What is none of a stiffness of motions of length one, N/m.
fn stiffless(stage: &Stage, stiffness: &DMatrix<f64>) -> f64 {
    let length = stage.mechanism.system.length;
    // Smaller steps leave more of the rounding of forces.
    STIFFLESS * length / stage.fineness() * largest(stiffness).max(stage.largest_force() / length)
}

impl SmallMotions {
    fn new(stage: &mut Stage, basis: &DMatrix<f64>, unfelt: Option<&Unfelt>) -> Self {
        let multipliers = stage.accelerate().multipliers.solver_rows().to_vec();
        stage.rest();
        let Inertia { inertial, massless } = Inertia::new(stage, basis);
        let limits = if massless.is_empty() {
            Limits { stiffness: 0.0, damping: 0.0 }
        } else {
            Limits::of_massless(stage, basis, &multipliers)
        };
        // Which motions without inertia are damped, which only held, and which neither.
        let (undamped, creeping) = null_and_rest(&stage.damping(&massless), limits.damping);
        let (undamped, creeping) = (&massless * undamped, &massless * creeping);
        let own = stage.stiffness(&undamped, &multipliers);
        stage.rest();
        let (free, held) = null_and_rest(&own, limits.stiffness);
        let (left_out, held) = (&undamped * free, &undamped * held);
        let moving = columns([&inertial, &creeping]);
        // What is held without inertia follows the others at once: K_hh x_h = −K_h· x.
        let all = columns([&moving, &held]);
        let stiffness = stage.stiffness(&all, &multipliers);
        stage.rest();
        let (n, h) = (moving.ncols(), held.ncols());
        let follows =
            solve(stiffness.view((n, n), (h, h)).into_owned(), &stiffness.view((n, 0), (h, n)).into_owned());
        let motions = &moving - &held * &follows;
        let mut stiffness = stiffness.view((0, 0), (n, n)) - stiffness.view((0, n), (n, h)) * &follows;
        if let Some(unfelt) = unfelt {
            // Differences would leave a little of their zeros, of which a drift would grow.
            let along =
                least_squares(&columns([&motions, &left_out]), &unfelt.drifts, 0.0).0.rows(0, n).into_owned();
            let (_, along) = null_and_rest(&along.transpose(), CLEARLY * along.norm());
            stiffness -= &stiffness * &along * along.transpose();
        }
        let damping = stage.damping(&motions);
        // Which motions meet no stiffness is decided where all motions have the same length.
        let mut scaled = stiffness.clone();
        let sizes: Vec<f64> = motions.column_iter().map(|column| size(stage, &column.into_owned())).collect();
        for (i, size_i) in sizes.iter().enumerate() {
            for (j, size_j) in sizes.iter().enumerate() {
                scaled[(i, j)] /= size_i * size_j;
            }
        }
        let stiffless = stiffless(stage, &scaled);
        let (mut drifts, _) = null_and_rest(&scaled, stiffless);
        for (i, size) in sizes.iter().enumerate() {
            drifts.row_mut(i).unscale_mut(*size);
        }
        let drifts = if drifts.is_empty() { drifts } else { drifts.qr().q() };
        let undamped = undamped_drifts(stage, &motions, &drifts);
        let (dampers, gyroscopic) = (stage.dampers(&motions), stage.gyroscopic(&motions));
        let inertial = inertial.ncols();
        let pencil = Pencil { inertial, stiffness, damping, dampers, gyroscopic, drifts, undamped };
        Self { motions, pencil, left_out, held: h, stiffless }
    }

    /// What is told of motions that have no mode, as stiffness alone holds them.
    fn told_of_held(&self) -> Option<String> {
        (self.held > 0).then(|| {
            format!(
                "degrees of freedom without inertia that springs hold: {}; they follow the others at once and have no mode of their own",
                self.held
            )
        })
    }

    /// What is told of a drift that may be none, as the rounding of a stiff spring hides a soft one.
    fn told_of_hidden(&self, stage: &Stage) -> Option<String> {
        if self.pencil.drifts.is_empty() {
            return None;
        }
        let (length, loads) = (stage.mechanism.system.length, &stage.mechanism.system.model.loads);
        let hidden = loads.iter().find(|load| {
            let stiffness = match &load.kind {
                LoadKind::Spring { law, .. } | LoadKind::Slider { law, .. } => law.stiffness,
                LoadKind::Torsion { law, .. } => law.stiffness / (length * length),
                LoadKind::Force { .. } | LoadKind::Moment { .. } => 0.0,
            };
            stiffness > 0.0 && stiffness < self.stiffless
        })?;
        Some(format!(
            "beside the stiffest spring nothing below {:.0e} N/m is felt: load \"{}\" may hold what is told as a drift",
            self.stiffless, hidden.name
        ))
    }

    fn eigen(&self, stage: &Stage) -> Result<Vec<Eigen>, AnalysisError> {
        let Pencil { stiffness: k, damping: c, .. } = &self.pencil;
        let scale = k.amax().max(f64::MIN_POSITIVE);
        let undamped = c.amax() <= NEGLIGIBLE * scale.sqrt();
        if undamped && (k - k.transpose()).amax() <= NEGLIGIBLE * scale {
            return Ok(self.pencil.undamped());
        }
        let mut found = self.pencil.damped().ok_or(AnalysisError::NoModes)?;
        if undamped {
            self.without_rounding(stage, &mut found);
        }
        Ok(found)
    }

    /// Where nothing damps and K is not symmetric, a motion may push another one and meet no stiffness itself: λ² is then what
    /// differences leave of zero, and λ, its root, far more. It is a drift, told once and not as a pair that grows and decays.
    fn without_rounding(&self, stage: &Stage, found: &mut Vec<Eigen>) {
        let none = |eigen: &Eigen| {
            let part = |of: fn(&Complex<f64>) -> f64| size(stage, &self.moved(&eigen.vector).map(|x| of(&x)));
            let size = libm::hypot(part(|x| x.re), part(|x| x.im));
            eigen.value.norm_sqr() * eigen.vector.norm_squared() <= self.stiffless * size * size
        };
        found.retain(|eigen| eigen.value.re >= 0.0 || eigen.value.im != 0.0 || !none(eigen));
        for eigen in found.iter_mut().filter(|eigen| none(eigen)) {
            eigen.value = Complex::new(0.0, 0.0);
        }
    }

    /// Twists of a solution.
    fn moved(&self, solution: &DVector<Complex<f64>>) -> DVector<Complex<f64>> {
        let (real, imaginary) =
            (&self.motions * solution.map(|x| x.re), &self.motions * solution.map(|x| x.im));
        real.zip_map(&imaginary, Complex::new)
    }

    fn drifts(&self) -> DMatrix<f64> {
        &self.motions * &self.pencil.drifts
    }
}

/// Those of the drifts, orthonormal columns, that nothing damps either.
fn undamped_drifts(stage: &Stage, motions: &DMatrix<f64>, drifts: &DMatrix<f64>) -> DMatrix<f64> {
    let mut drifting = motions * drifts;
    let sizes: Vec<f64> = drifting.column_iter().map(|column| size(stage, &column.into_owned())).collect();
    for (mut column, size) in drifting.column_iter_mut().zip(&sizes) {
        column.unscale_mut(*size);
    }
    let (mut free, _) = null_and_rest(&stage.resistance(&drifting), UNDAMPED);
    for (mut row, size) in free.row_iter_mut().zip(&sizes) {
        row.unscale_mut(*size);
    }
    if free.is_empty() { free } else { drifts * free.qr().q() }
}

/// Length of a motion, arcs measured at the mechanism's length.
fn size(stage: &Stage, motion: &DVector<f64>) -> f64 {
    let length = stage.mechanism.system.length;
    let square = |k: usize| {
        let arc = if k % 6 >= 3 { length * motion[k] } else { motion[k] };
        arc * arc
    };
    (0..motion.len()).map(square).sum::<f64>().sqrt().max(f64::MIN_POSITIVE)
}

/// The largest entry, more than zero.
fn largest(matrix: &DMatrix<f64>) -> f64 {
    matrix.iter().fold(f64::MIN_POSITIVE, |a, x| a.max(x.abs()))
}

/// Matrices beside each other.
fn columns<const N: usize>(parts: [&DMatrix<f64>; N]) -> DMatrix<f64> {
    let rows = parts.first().map_or(0, |part| part.nrows());
    let mut out = DMatrix::zeros(rows, parts.iter().map(|part| part.ncols()).sum());
    let mut first = 0;
    for part in parts {
        out.columns_mut(first, part.ncols()).copy_from(part);
        first += part.ncols();
    }
    out
}
