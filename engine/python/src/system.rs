//! The equations of a mechanism at any state: what a student's own program is checked against.

use crate::arrays::{Numbers, checked, places, shaped, vector};
use crate::refusal::Refusal;
use crate::scene;
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use serde_json::json;
use std::collections::BTreeMap;
use triad_dynamics::constraints::turns;
use triad_dynamics::equations::augmented::{self, AugmentedSystem};
use triad_dynamics::equations::jacobian::Jacobian;
use triad_dynamics::equations::{self, column_names, row_names};
use triad_dynamics::state::State;
use triad_dynamics::system::System as EngineSystem;
use triad_engine::run::Simulation;
use triad_engine::scene::Coordinates;

/// Coordinates beyond which the equations are not solved as a student writes them: dense matrices take minutes.
const MAX_DENSE: usize = 2000;

/// A mechanism, assembled at its start.
#[pyclass(frozen, module = "triad._native")]
pub struct System {
    run: Simulation,
}

/// A sparse matrix: rows, columns and numbers of its entries, and its shape.
type Sparse = (Py<PyAny>, Py<PyAny>, Numbers, (usize, usize));
/// Numbers from Python.
type Given<'py> = PyReadonlyArray1<'py, f64>;

/// A state; without velocities one at rest. Whole turns of angles, which q does not tell, are those with which the rows hold best.
fn at(system: &EngineSystem, q: &[f64], v: Option<&[f64]>, t: f64) -> State {
    let rest;
    let v = if let Some(v) = v {
        v
    } else {
        rest = vec![0.0; q.len()];
        &rest
    };
    let mut state = State::at(system, t, q, v);
    if !state.angles().is_empty() {
        turns::count(system, &mut state);
        state.set(system, t, q, v);
    }
    state
}

#[pymethods]
impl System {
    #[new]
    fn new(py: Python<'_>, kind: &str, text: &str, coordinates: Option<&str>) -> PyResult<Self> {
        let mut scene = scene::read(kind, text)?;
        if let Some(word) = coordinates {
            let read = word.parse::<Coordinates>();
            scene.coordinates = read.map_err(|error| Refusal::word("coordinates", word, error))?;
        }
        let run = py.detach(|| Simulation::new(&scene)).map_err(Refusal::from)?;
        Ok(Self { run })
    }

    /// Names and counts, as JSON.
    fn about(&self) -> String {
        let system = self.run.system();
        json!({
            "name": system.model.name,
            "columns": column_names(system),
            "rows": row_names(system),
            "bodies": system.model.bodies.iter().map(|body| &body.name).collect::<Vec<_>>(),
            "rigid_rows": system.rigid_rows,
            "notes": self.run.notes(),
        })
        .to_string()
    }

    /// Coordinates at the start, after assembly.
    fn q0(&self, py: Python<'_>) -> Numbers {
        vector(py, self.run.q().to_vec())
    }

    /// Velocities at the start, after assembly.
    fn v0(&self, py: Python<'_>) -> Numbers {
        vector(py, self.run.q_dot().to_vec())
    }

    /// Φ(q, t).
    fn phi(&self, py: Python<'_>, q: Given<'_>, t: f64) -> PyResult<Numbers> {
        let system = self.run.system();
        Ok(vector(py, equations::constraints(system, &at(system, self.positions(&q)?, None, t))))
    }

    /// Φ_q(q, t).
    fn jacobian(&self, py: Python<'_>, q: Given<'_>, t: f64) -> PyResult<Sparse> {
        let system = self.run.system();
        let found = Jacobian::new(system, &at(system, self.positions(&q)?, None, t));
        let entries = || found.entries.iter();
        Ok((
            places(py, &entries().map(|entry| entry.row).collect::<Vec<_>>()),
            places(py, &entries().map(|entry| entry.column).collect::<Vec<_>>()),
            vector(py, entries().map(|entry| entry.value).collect()),
            (found.rows.len(), found.columns.len()),
        ))
    }

    /// ν(q, q̇, t), with Φ_q q̇ = ν.
    fn nu(&self, py: Python<'_>, q: Given<'_>, v: Given<'_>, t: f64) -> PyResult<Numbers> {
        let state = self.state(&q, &v, t)?;
        Ok(vector(py, equations::nu(self.run.system(), &state)))
    }

    /// γ(q, q̇, t), with Φ_q q̈ = γ.
    fn gamma(&self, py: Python<'_>, q: Given<'_>, v: Given<'_>, t: f64) -> PyResult<Numbers> {
        let state = self.state(&q, &v, t)?;
        Ok(vector(py, equations::gamma(self.run.system(), &state)))
    }

    /// M(q).
    fn mass(&self, py: Python<'_>, q: Given<'_>) -> PyResult<Sparse> {
        let system = self.run.system();
        let state = at(system, self.positions(&q)?, None, 0.0);
        let mut entries = BTreeMap::<(usize, usize), f64>::new();
        augmented::for_mass_entries(system, &state, |row, column, value| {
            *entries.entry((row, column)).or_default() += value;
        });
        let n = system.coordinates;
        Ok((
            places(py, &entries.keys().map(|place| place.0).collect::<Vec<_>>()),
            places(py, &entries.keys().map(|place| place.1).collect::<Vec<_>>()),
            vector(py, entries.into_values().collect()),
            (n, n),
        ))
    }

    /// g(q, q̇, t): applied forces, without dry friction.
    fn force(&self, py: Python<'_>, q: Given<'_>, v: Given<'_>, t: f64) -> PyResult<Numbers> {
        let state = self.state(&q, &v, t)?;
        Ok(vector(py, augmented::force(self.run.system(), &state).as_slice().to_vec()))
    }

    /// q̈ and λ of all rows, from M q̈ + Φ_qᵀ λ = g and Φ_q q̈ = γ as they stand.
    fn solve(&self, py: Python<'_>, q: Given<'_>, v: Given<'_>, t: f64) -> PyResult<(Numbers, Numbers)> {
        let system = self.run.system();
        if system.coordinates > MAX_DENSE {
            let what = format!("{} coordinates are too many for dense matrices", system.coordinates);
            let hint = format!("take at most {MAX_DENSE}; triad.run(...).accelerations() solves larger ones");
            return Err(Refusal::new("too-large", what, hint).into());
        }
        let state = self.state(&q, &v, t)?;
        let solved = py.detach(|| AugmentedSystem::new(system, &state).solve());
        let solved = solved.ok_or_else(|| {
            let what = "the equations have no solution at this state: a body without inertia is free to turn";
            Refusal::new(
                "singular",
                what,
                "give each body a moment of inertia about axes that it may turn about",
            )
        })?;
        let [acceleration, multipliers] = [solved.acceleration, solved.multipliers];
        Ok((vector(py, acceleration.as_slice().to_vec()), vector(py, multipliers.as_slice().to_vec())))
    }

    /// Numbers body by body as a matrix (bodies, 12): r, u, v, w of coordinates q.
    fn natural(&self, py: Python<'_>, q: Given<'_>) -> PyResult<Numbers> {
        let system = self.run.system();
        let state = at(system, self.positions(&q)?, None, 0.0);
        let numbers = state.bodies().iter().flat_map(|body| {
            let [u, v, w] = body.q.e;
            [body.q.r, u, v, w].into_iter().flat_map(|vector| [vector.x, vector.y, vector.z])
        });
        shaped(py, numbers.collect(), &[system.bodies.len(), 12])
    }
}

impl System {
    fn positions<'a>(&self, q: &'a Given<'_>) -> PyResult<&'a [f64]> {
        Ok(checked("q", q.as_slice()?, self.run.q().len())?)
    }

    fn state(&self, q: &Given<'_>, v: &Given<'_>, t: f64) -> PyResult<State> {
        let v = checked("v", v.as_slice()?, self.run.q().len())?;
        Ok(at(self.run.system(), self.positions(q)?, Some(v), t))
    }
}
