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
    /// For each row of that form, the bits of the vectors that its blocks were written for: in a plane they never change.
    vectors: Vec<[[u64; 3]; 2]>,
    /// Where blocks begin that are sums over features.
    sums: Vec<usize>,
    /// How often rows have changed that are not those of points.
    changes: u64,
}

impl TwistJacobian {
    /// Allocates for a system.
    pub fn new(system: &System) -> Self {
        let mut a = vec![0.0; system.block_entries];
        let mut sums = Vec::new();
        for row in &system.rows {
            let blocks = || row.incidence.iter().filter(|&&incidence| incidence != NO_INCIDENCE);
            let at = |&incidence: &usize| system.incidences[incidence].offset + 6 * row.local;
            match row.form {
                Form::Coincidence { a: first, b: second } => {
                    for (place, feature, sign) in [(0, first, 1.0), (1, second, -1.0)] {
                        let incidence = row.incidence[place];
                        if incidence != NO_INCIDENCE && system[feature].point {
                            (0..3).for_each(|k| a[at(&incidence) + 7 * k] = sign);
                        }
                    }
                }
                Form::CommonVector { .. } => {}
                Form::Product { .. } | Form::Relation { .. } => sums.extend(blocks().map(at)),
            }
        }
        sums.sort_unstable();
        sums.dedup();
        Self {
            a,
            transverse: vec![[Vector3::zeros(); 2]; system.rows.len()],
            vectors: vec![[[f64::NAN.to_bits(); 3]; 2]; system.rows.len()],
            sums,
            changes: 0,
        }
    }

    /// Counts the changes of rows that are not those of points: as long as it stays the same, so do they.
    pub(super) fn changes(&self) -> u64 {
        self.changes
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
        self.changes += u64::from(!self.sums.is_empty());
        for &at in &self.sums {
            self.a[at..at + 6].copy_from_slice(&[0.0; 6]);
        }
        for (index, row) in system.rows.iter().enumerate() {
            match row.form {
                Form::Coincidence { a, b } => {
                    self.put_point(system, state, row, (0, a), 1.0);
                    self.put_point(system, state, row, (1, b), -1.0);
                }
                Form::CommonVector { a, b } => {
                    self.put_common_vector(system, index, [a, b].map(|f| state.feature_value(f)));
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

    /// Puts down the two rows of a common vector, of which a body has one and another body or the ground the other.
    fn put_common_vector(&mut self, system: &System, index: usize, vectors: [Vector3<f64>; 2]) {
        let known = self.vectors[index];
        let changes = |k: usize, c: usize| vectors[k][c].to_bits() ^ known[k][c];
        if (0..3).fold(0, |any, c| any | changes(0, c) | changes(1, c)) == 0 {
            return;
        }
        self.vectors[index] = vectors.map(|vector| <[f64; 3]>::from(vector).map(f64::to_bits));
        self.changes += 1;
        let across = orthonormal_basis(&vectors[0].normalize());
        self.transverse[index] = across;
        for (place, sign) in [(0, 1.0), (1, -1.0)] {
            let moments = across.map(|t| vectors[place].cross(&(t * sign)));
            self.put_moments(system, &system.rows[index], place, &moments);
        }
    }

    /// Puts down the three rows ±C of a point: those of the directions of the world, arm × e_k written out. How they turn is all that
    /// changes in them.
    fn put_point(
        &mut self,
        system: &System,
        state: &State,
        row: &Row,
        (place, feature): (usize, FeatureId),
        sign: f64,
    ) {
        let [x, y, z] = (state.feature_arm(feature) * sign).into();
        self.put_moments(system, row, place, &[[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]].map(Vector3::from));
    }

    /// Puts down how a body turns rows of a form, from the first one on.
    #[inline(always)]
    fn put_moments(&mut self, system: &System, row: &Row, place: usize, moments: &[Vector3<f64>]) {
        let incidence = row.incidence[place];
        if incidence == NO_INCIDENCE {
            return;
        }
        let at = system.incidences[incidence].offset + 6 * row.local;
        for (row, moment) in self.a[at..].as_chunks_mut::<6>().0.iter_mut().zip(moments) {
            (row[3], row[4], row[5]) = (moment[0], moment[1], moment[2]);
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
