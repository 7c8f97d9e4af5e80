//! Small vibrations about a position at rest: eigenfrequencies and mode shapes.

use super::{AnalysisError, Stage, equilibrium};
use crate::scene::Scene;
use nalgebra::{Complex, ComplexField, DMatrix, DVector, Matrix3, Schur, SymmetricEigen, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::state::BodyFrame;

/// Damping or asymmetry, relative to the stiffness, below which it counts as zero.
const NEGLIGIBLE: f64 = 1e-6;

/// The position about which the motion is linearized.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ModesAbout {
    /// The equilibrium near the start.
    #[default]
    Equilibrium,
    /// The start itself, at rest.
    Start,
}

/// The part of a mode that one body takes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct ModeShape {
    /// Displacement of the centre of mass, m; of a mode with damping, its part in phase.
    pub translation: [f64; 3],
    /// Rotation, rad.
    pub rotation: [f64; 3],
    /// Displacement a quarter of a period later, zero without damping, m.
    pub translation_later: [f64; 3],
    /// Rotation a quarter of a period later, rad.
    pub rotation_later: [f64; 3],
}

/// One mode, moving as e^(λt).
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Mode {
    /// What it does, in a word: `oscillates`, `decays`, `grows` or `drifts`.
    pub kind: &'static str,
    /// Frequency, Hz.
    pub frequency: f64,
    /// Real part of λ, 1/s: negative where the motion dies away.
    pub growth: f64,
    /// Part of critical damping.
    pub damping_ratio: f64,
    /// The motion of each body, the largest displacement (or rotation times the mechanism's length) being one.
    pub shape: Vec<ModeShape>,
}

/// All modes of a position.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Modes {
    /// Degrees of freedom.
    pub freedoms: usize,
    /// The modes, slowest first.
    pub modes: Vec<Mode>,
    /// The bodies at that position.
    pub bodies: Vec<BodyFrame>,
    /// What has to be known of the result.
    pub notes: Vec<String>,
}

/// Linearizes a scene about a position at rest.
///
/// M ẍ + C ẋ + K x = 0 in an orthonormal basis of small motions; K holds the stiffness of loads and the geometric
/// stiffness of the constraint forces.
///
/// # Errors
///
/// [`AnalysisError`]: as for [`equilibrium`](super::equilibrium()), and a motion without inertia.
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
    let mut stage = Stage::new(scene)?;
    let mut notes = Vec::new();
    if stage.q_dot.iter().any(|v| *v != 0.0) {
        notes.push(
            "velocities of the start are left out: modes are those of the mechanism at rest".to_owned(),
        );
    }
    if about == ModesAbout::Equilibrium {
        equilibrium::find(&mut stage)?;
    }
    stage.rest();
    let basis = stage.tangent();
    let freedoms = basis.ncols();
    if freedoms == 0 {
        notes.push("joints and drivers leave no freedom: nothing can vibrate".to_owned());
        return Ok(Modes { freedoms, modes: Vec::new(), bodies: stage.frames(), notes });
    }
    stage.rest();
    let force = stage.forces();
    let left = basis.tr_mul(&force).amax();
    if left > 1e-6 * force.amax() {
        notes.push(format!(
            "the position is not an equilibrium: a generalized force of {left:.3e} N is left, which the linear \
             equations leave out"
        ));
    }
    let multipliers = stage.accelerate().multipliers.solver_rows().to_vec();
    let stiffness = stage.stiffness(&basis, &multipliers);
    let damping = damping(&mut stage, &basis);
    let mass = mass(&stage, &basis);
    let Some(cholesky) = mass.cholesky() else {
        return Err(AnalysisError::Massless { body: massless(&stage) });
    };
    // x = L⁻ᵀ z makes the mass matrix the identity.
    let l = cholesky.l();
    let reduce = |matrix: &DMatrix<f64>| {
        let half = l.solve_lower_triangular(matrix).unwrap_or_else(|| matrix.clone());
        l.solve_lower_triangular(&half.transpose()).unwrap_or(half).transpose()
    };
    let (k, c) = (reduce(&stiffness), reduce(&damping));
    let scale = k.amax().max(f64::MIN_POSITIVE);
    let plain = c.amax() <= NEGLIGIBLE * scale.sqrt() && (&k - k.transpose()).amax() <= NEGLIGIBLE * scale;
    let found = if plain { undamped(&k) } else { damped(&k, &c) };
    let back = |z: &DVector<f64>| &basis * l.tr_solve_lower_triangular(z).unwrap_or_else(|| z.clone());
    let length = stage.mechanism.system.length;
    let mut modes: Vec<Mode> = found
        .iter()
        .map(|(value, real, imaginary)| mode(*value, scale, &back(real), &back(imaginary), length))
        .collect();
    modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency).then(a.growth.total_cmp(&b.growth)));
    Ok(Modes { freedoms, modes, bodies: stage.frames(), notes })
}

/// Without damping: λ² = −(eigenvalue of K).
fn undamped(k: &DMatrix<f64>) -> Vec<(Complex<f64>, DVector<f64>, DVector<f64>)> {
    let eigen = SymmetricEigen::new((k + k.transpose()) * 0.5);
    (0..k.ncols())
        .map(|i| {
            let square = eigen.eigenvalues[i];
            let value = if square >= 0.0 {
                Complex::new(0.0, square.sqrt())
            } else {
                Complex::new((-square).sqrt(), 0.0)
            };
            (value, eigen.eigenvectors.column(i).into_owned(), DVector::zeros(k.ncols()))
        })
        .collect()
}

/// With damping: eigenvalues of the first-order form with Im λ ≥ 0, each with its vector by inverse iteration.
fn damped(k: &DMatrix<f64>, c: &DMatrix<f64>) -> Vec<(Complex<f64>, DVector<f64>, DVector<f64>)> {
    let n = k.ncols();
    let mut first_order = DMatrix::zeros(2 * n, 2 * n);
    first_order.view_mut((0, n), (n, n)).fill_with_identity();
    first_order.view_mut((n, 0), (n, n)).copy_from(&-k);
    first_order.view_mut((n, n), (n, n)).copy_from(&-c);
    let Some(schur) = Schur::try_new(first_order, f64::EPSILON, 100_000) else { return Vec::new() };
    let values = schur.complex_eigenvalues();
    let scale = values.iter().fold(0.0f64, |a, v| a.max(v.modulus()));
    let mut list = Vec::new();
    for value in values.iter().copied().filter(|v| v.im >= -1e-12 * scale) {
        // (λ² + λ C + K) x = 0, slightly beside the eigenvalue.
        let beside = value + Complex::new(1e-9 * scale, 1e-9 * scale);
        let matrix = DMatrix::from_fn(n, n, |i, j| {
            let unit = if i == j { beside * beside } else { Complex::new(0.0, 0.0) };
            unit + beside * c[(i, j)] + k[(i, j)]
        });
        let lu = matrix.lu();
        let mut x = DVector::from_fn(n, |i, _| Complex::new(1.0 + 0.3 * i as f64, 0.1));
        for _ in 0..4 {
            if let Some(next) = lu.solve(&x) {
                x = next.unscale(next.norm().max(f64::MIN_POSITIVE));
            }
        }
        // Turn the phase so that the largest entry is real.
        let largest = x
            .iter()
            .copied()
            .fold(Complex::new(0.0, 0.0), |a, b| if b.modulus() > a.modulus() { b } else { a });
        let phase = largest.conj() / largest.modulus().max(f64::MIN_POSITIVE);
        list.push((value, x.map(|x| (x * phase).re), x.map(|x| (x * phase).im)));
    }
    list
}

/// C = −∂(generalized force)/∂(velocity).
fn damping(stage: &mut Stage, basis: &DMatrix<f64>) -> DMatrix<f64> {
    let step = 1e-6 * stage.mechanism.system.length;
    let mut out = DMatrix::zeros(basis.ncols(), basis.ncols());
    for k in 0..basis.ncols() {
        let rate = stage.velocity(&basis.column(k).into_owned());
        let [ahead, behind] = [step, -step].map(|size| {
            let q_dot: Vec<f64> = rate.iter().map(|v| v * size).collect();
            let y = [stage.q.as_slice(), q_dot.as_slice()].concat();
            stage.mechanism.set_state(stage.time, &y);
            stage.forces()
        });
        out.set_column(k, &(basis.tr_mul(&(behind - ahead)) / (2.0 * step)));
    }
    stage.rest();
    out
}

/// Basisᵀ diag(m, I_g) basis.
fn mass(stage: &Stage, basis: &DMatrix<f64>) -> DMatrix<f64> {
    let mut weighted = basis.clone();
    let Mechanism { system, state, .. } = &stage.mechanism;
    for (index, (body, at)) in system.bodies.iter().zip(state.bodies()).enumerate() {
        let directors = Matrix3::from_columns(&at.q.e);
        let inertia = directors * Matrix3::from_diagonal(&body.principal) * directors.transpose();
        for mut column in weighted.column_iter_mut() {
            for k in 0..3 {
                column[6 * index + k] *= body.mass;
            }
            let omega = column.fixed_rows::<3>(6 * index + 3).into_owned();
            column.fixed_rows_mut::<3>(6 * index + 3).copy_from(&(inertia * omega));
        }
    }
    basis.tr_mul(&weighted)
}

/// The body with the least inertia for its mass.
fn massless(stage: &Stage) -> String {
    let system = &stage.mechanism.system;
    let inertia = |body: usize| system.bodies[body].principal.min() / system.bodies[body].mass;
    (0..system.bodies.len())
        .min_by(|a, b| inertia(*a).total_cmp(&inertia(*b)))
        .map_or_else(String::new, |body| system.model.bodies[body].name.clone())
}

fn mode(value: Complex<f64>, scale: f64, real: &DVector<f64>, imaginary: &DVector<f64>, length: f64) -> Mode {
    // Stiffness by differences is good to about ten digits: slower motion than this counts as rest.
    let slow = 1e-4 * scale.sqrt();
    let (growth, turning) = (value.re, value.im.abs());
    let kind = match () {
        () if value.modulus() <= slow => "drifts",
        () if growth > slow => "grows",
        () if turning > slow => "oscillates",
        () => "decays",
    };
    let size = (0..real.len())
        .map(|k| {
            let arc = if k % 6 >= 3 { length } else { 1.0 };
            arc * real[k].abs().max(imaginary[k].abs())
        })
        .fold(f64::MIN_POSITIVE, f64::max);
    let part = |from: &DVector<f64>, at: usize| -> [f64; 3] {
        (Vector3::new(from[at], from[at + 1], from[at + 2]) / size).into()
    };
    let shape = (0..real.len() / 6).map(|body| ModeShape {
        translation: part(real, 6 * body),
        rotation: part(real, 6 * body + 3),
        translation_later: part(imaginary, 6 * body),
        rotation_later: part(imaginary, 6 * body + 3),
    });
    let still = kind == "drifts";
    Mode {
        kind,
        frequency: if still { 0.0 } else { turning / std::f64::consts::TAU },
        growth: if still { 0.0 } else { growth },
        damping_ratio: if still { 0.0 } else { -growth / value.modulus() },
        shape: shape.collect(),
    }
}
