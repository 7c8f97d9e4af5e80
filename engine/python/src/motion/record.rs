//! What is written at each output.

use crate::arrays::{Numbers, shaped, vector};
use pyo3::prelude::*;
use triad_engine::run::{Outputs, Simulation};
use triad_engine::scene::OutputKind;

/// Memory that is taken at the start for the numbers of one array, in numbers: runs that end early need less.
const MOST_AT_ONCE: usize = 1 << 22;

/// Numbers of all outputs, each list row after row.
pub struct Record {
    rows: usize,
    times: Vec<f64>,
    q: Vec<f64>,
    v: Vec<f64>,
    position: Vec<f64>,
    directors: Vec<f64>,
    velocity: Vec<f64>,
    angular_velocity: Vec<f64>,
    markers: Vec<f64>,
    marker_velocities: Vec<f64>,
    table: Vec<f64>,
    errors: Vec<f64>,
    reaction_errors: Vec<f64>,
    /// Coordinates, bodies, markers, columns of the table.
    widths: [usize; 4],
    /// Whether errors of reactions are wanted, which are solved for a second time.
    of_reactions: bool,
}

impl Record {
    /// For about so many outputs of a run.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "bounded by the caller")]
    pub fn new(run: &Simulation, outputs: &Outputs, rows: f64) -> Self {
        let model = run.model();
        let widths = [run.q().len(), model.bodies.len(), model.markers.len(), outputs.columns().len()];
        let rows = rows.max(0.0) as usize + 2;
        let room = |width: usize| Vec::with_capacity((rows * width).min(MOST_AT_ONCE));
        let kinds = &model.settings.outputs;
        let of_reactions =
            model.settings.error_estimate && kinds.iter().any(|output| output.kind == OutputKind::Reactions);
        Self {
            rows: 0,
            times: room(1),
            q: room(widths[0]),
            v: room(widths[0]),
            position: room(3 * widths[1]),
            directors: room(9 * widths[1]),
            velocity: room(3 * widths[1]),
            angular_velocity: room(3 * widths[1]),
            markers: room(3 * widths[2]),
            marker_velocities: room(3 * widths[2]),
            table: room(widths[3]),
            errors: room(5),
            reaction_errors: room(2),
            widths,
            of_reactions,
        }
    }

    /// Writes the current state.
    pub fn write(&mut self, run: &Simulation, outputs: &Outputs) {
        self.rows += 1;
        self.times.push(run.time());
        self.q.extend(run.q());
        self.v.extend(run.q_dot());
        let frame = run.frame();
        for body in &frame.bodies {
            self.position.extend(body.position);
            self.directors.extend([body.u, body.v, body.w].as_flattened());
            self.velocity.extend(body.velocity);
            self.angular_velocity.extend(body.angular_velocity);
        }
        for marker in &frame.markers {
            self.markers.extend(marker.position);
            self.marker_velocities.extend(marker.velocity);
        }
        outputs.write(run, &mut self.table);
        let errors = run.error_estimate().map_or([f64::NAN; 5], |error| {
            [error.position, error.turn, error.velocity, error.angular_velocity, error.energy]
        });
        self.errors.extend(errors);
        let of_reactions = if self.of_reactions { run.reaction_errors() } else { None };
        self.reaction_errors.extend(of_reactions.map_or([f64::NAN; 2], |error| [error.force, error.moment]));
    }

    /// Hands the numbers over to NumPy.
    pub fn into_arrays(self, py: Python<'_>) -> PyResult<Vec<(&'static str, Numbers)>> {
        let (n, [q, bodies, markers, columns]) = (self.rows, self.widths);
        Ok(vec![
            ("t", vector(py, self.times)),
            ("q", shaped(py, self.q, &[n, q])?),
            ("v", shaped(py, self.v, &[n, q])?),
            ("position", shaped(py, self.position, &[n, bodies, 3])?),
            ("directors", shaped(py, self.directors, &[n, bodies, 3, 3])?),
            ("velocity", shaped(py, self.velocity, &[n, bodies, 3])?),
            ("angular_velocity", shaped(py, self.angular_velocity, &[n, bodies, 3])?),
            ("marker_position", shaped(py, self.markers, &[n, markers, 3])?),
            ("marker_velocity", shaped(py, self.marker_velocities, &[n, markers, 3])?),
            ("table", shaped(py, self.table, &[n, columns])?),
            ("errors", shaped(py, self.errors, &[n, 5])?),
            ("reaction_errors", shaped(py, self.reaction_errors, &[n, 2])?),
        ])
    }
}
