//! The twist Jacobian A of the solver rows: six columns for each body — eq. (7.4).

use crate::state::State;
use crate::system::index::{FeatureId, IncidenceId, RowId};
use crate::system::row::Form;
use crate::system::{NO_INCIDENCE, Row, System};
use nalgebra::Vector3;
use triad_linalg::orthonormal_basis;

/// A, block by block, in twist form.
#[derive(Clone, Debug)]
pub struct TwistJacobian {
    pub(super) a: Vec<f64>,
    /// For each row of form `CommonVector`, the two directions across the vector.
    transverse: Vec<[Vector3<f64>; 2]>,
}

impl TwistJacobian {
    /// Allocates for a system.
    pub fn new(system: &System) -> Self {
        Self {
            a: vec![0.0; system.block_entries],
            transverse: vec![[Vector3::zeros(); 2]; system.rows.len()],
        }
    }

    /// The two directions across the vector of a row that the solver keeps.
    pub fn transverse(&self, row: RowId) -> [Vector3<f64>; 2] {
        self.transverse[row.index()]
    }

    /// The rows A_b of an incidence, six numbers each: translation, then rotation.
    pub fn rows_on(&self, system: &System, incidence: IncidenceId) -> &[f64] {
        let incidence = &system[incidence];
        &self.a[incidence.offset..incidence.offset + 6 * incidence.rows]
    }

    /// Takes A at the positions of a state.
    pub fn fill(&mut self, system: &System, state: &State) {
        self.a.fill(0.0);
        for (index, row) in system.rows.iter().enumerate() {
            match row.form {
                Form::Coincidence { a, b } => {
                    self.add_point(system, state, row, (0, a), 1.0);
                    self.add_point(system, state, row, (1, b), -1.0);
                }
                Form::CommonVector { a, b } => {
                    self.transverse[index] = orthonormal_basis(&state.feature_value(a).normalize());
                    for k in 0..2 {
                        let t = self.transverse[index][k];
                        self.add_gradient(system, state, row, k, (0, a), &t);
                        self.add_gradient(system, state, row, k, (1, b), &-t);
                    }
                }
                Form::Product { a, b, .. } => {
                    let (x, y) = (a.of(|f| state.feature_value(f)), b.of(|f| state.feature_value(f)));
                    let mut place = 0;
                    for (difference, g) in [(a, y), (b, x)] {
                        self.add_gradient(system, state, row, 0, (place, difference.plus), &g);
                        place += 1;
                        if let Some(minus) = difference.minus {
                            self.add_gradient(system, state, row, 0, (place, minus), &-g);
                            place += 1;
                        }
                    }
                }
                Form::Relation { angles, slide, .. } => {
                    let mut place = 0;
                    for (angle, factor) in angles.into_iter().flatten() {
                        let gradient = state.angles()[angle].gradient;
                        for (feature, g) in system.angles[angle].features().into_iter().zip(gradient) {
                            self.add_gradient(system, state, row, 0, (place, feature), &(g * factor));
                            place += 1;
                        }
                    }
                    if let Some((a, b, factor)) = slide {
                        let (x, y) = (a.of(|f| state.feature_value(f)), b.of(|f| state.feature_value(f)));
                        for (difference, g) in [(a, y * factor), (b, x * factor)] {
                            self.add_gradient(system, state, row, 0, (place, difference.plus), &g);
                            place += 1;
                            if let Some(minus) = difference.minus {
                                self.add_gradient(system, state, row, 0, (place, minus), &-g);
                                place += 1;
                            }
                        }
                    }
                }
            }
        }
    }

    /// Adds the three rows ±C of a point: those of the directions of the world, arm × e_k written out.
    fn add_point(
        &mut self,
        system: &System,
        state: &State,
        row: &Row,
        (place, feature): (usize, FeatureId),
        sign: f64,
    ) {
        let incidence = row.incidence[place];
        if incidence == NO_INCIDENCE {
            return;
        }
        let at = system.incidences[incidence].offset + 6 * row.local;
        let arm = state.feature_arm(feature) * sign;
        let rows = self.a[at..].as_chunks_mut::<6>().0;
        let moments = [[0.0, arm[2], -arm[1]], [-arm[2], 0.0, arm[0]], [arm[1], -arm[0], 0.0]];
        for (k, (row, moment)) in rows.iter_mut().zip(&moments).enumerate() {
            if system[feature].point {
                row[k] += sign;
            }
            for c in 0..3 {
                row[3 + c] += moment[c];
            }
        }
    }

    /// Adds the row gᵀ C of one feature, given with its place within the form, in twist form (g, arm × g) — eq. (7.4).
    fn add_gradient(
        &mut self,
        system: &System,
        state: &State,
        row: &Row,
        k: usize,
        (place, feature): (usize, FeatureId),
        g: &Vector3<f64>,
    ) {
        let incidence = row.incidence[place];
        if incidence == NO_INCIDENCE {
            return;
        }
        let at = system.incidences[incidence].offset + 6 * (row.local + k);
        let moment = state.feature_arm(feature).cross(g);
        let block = &mut self.a[at..at + 6];
        if system[feature].point {
            for c in 0..3 {
                block[c] += g[c];
            }
        }
        for c in 0..3 {
            block[3 + c] += moment[c];
        }
    }
}
