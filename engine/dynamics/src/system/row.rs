//! Constraint rows — THEORY section 4.
//!
//! Every constraint of every joint is one of four forms; three are polynomials of degree at most two in the natural
//! coordinates of the bodies that they touch, the fourth relates joint angles. A form is a statement about *features*: points C^P Q and vectors C^s Q
//! with constant local coordinates, or points and vectors of the ground. Φ, Φ_q, ν and γ all follow from that one
//! statement, so they cannot disagree.

use crate::system::angle::Angle;
use crate::system::feature::{Difference, Target};
use crate::system::index::FeatureId;
use crate::system::{Row, System};
use std::mem::take;

/// One form of constraint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// a − b = 0 for two points: three independent equations (CP, TP) — eq. (4.3).
    Coincidence {
        /// Point on body i.
        a: FeatureId,
        /// Point on body j.
        b: FeatureId,
    },
    /// a − b = 0 for two unit vectors: three equations of which two are independent (CV, OV) — eq. (4.4).
    CommonVector {
        /// Vector on body i.
        a: FeatureId,
        /// Vector on body j.
        b: FeatureId,
    },
    /// a · b − c = 0: one equation (CAR, AR, line and plane rows, distance) — eq. (4.5).
    Product {
        /// First factor.
        a: Difference,
        /// Second factor.
        b: Difference,
        /// The number c.
        target: Target,
    },
    /// Σ cᵢ θᵢ + d (a · b) − c = 0 between joint angles and a displacement: one equation (gear, screw). The only form
    /// that is not a polynomial — eq. (4.7).
    Relation {
        /// Up to two angles with their factors.
        angles: [Option<(usize, f64)>; 2],
        /// A displacement with its factor.
        slide: Option<(Difference, Difference, f64)>,
        /// The constant c.
        constant: f64,
    },
}

impl Form {
    /// Number of equations as they are written.
    pub fn equations(&self) -> usize {
        match self {
            Self::Coincidence { .. } | Self::CommonVector { .. } => 3,
            Self::Product { .. } | Self::Relation { .. } => 1,
        }
    }

    /// Number of equations that the solver keeps: those of a common vector across it.
    pub fn independent(&self) -> usize {
        match self {
            Self::Coincidence { .. } => 3,
            Self::CommonVector { .. } => 2,
            Self::Product { .. } | Self::Relation { .. } => 1,
        }
    }

    /// The features of the form, in the order in which their gradients are written.
    pub fn features(&self, angles: &[Angle]) -> Vec<FeatureId> {
        let of = |d: Difference| [Some(d.plus), d.minus].into_iter().flatten();
        match *self {
            Self::Coincidence { a, b } | Self::CommonVector { a, b } => vec![a, b],
            Self::Product { a, b, .. } => of(a).chain(of(b)).collect(),
            Self::Relation { angles: terms, slide, .. } => {
                let turning = terms.into_iter().flatten().flat_map(|(k, _)| angles[k].features());
                let sliding = slide.into_iter().flat_map(|(a, b, _)| of(a).chain(of(b)));
                turning.chain(sliding).collect()
            }
        }
    }

    /// Renames features.
    pub fn rename(&mut self, place: &[FeatureId]) {
        match self {
            Self::Coincidence { a, b } | Self::CommonVector { a, b } => {
                *a = place[a.index()];
                *b = place[b.index()];
            }
            Self::Product { a, b, .. } => {
                a.rename(place);
                b.rename(place);
            }
            Self::Relation { slide, .. } => {
                if let Some((a, b, _)) = slide {
                    a.rename(place);
                    b.rename(place);
                }
            }
        }
    }
}

impl System {
    /// What Φ of a form is measured in: m for each point in it.
    pub fn row_size(&self, form: &Form) -> f64 {
        let points = |d: Difference| {
            if self[d.plus].point { self.length } else { 1.0 }
        };
        match *form {
            Form::Coincidence { .. } => self.length,
            Form::Product { a, b, .. } => points(a) * points(b),
            Form::Relation { slide: Some((_, _, factor)), .. } => (self.length * factor.abs()).max(1.0),
            Form::CommonVector { .. } | Form::Relation { .. } => 1.0,
        }
    }

    /// What Φ of each solver row is measured in.
    pub fn row_sizes(&self) -> Vec<f64> {
        let mut sizes = Vec::with_capacity(self.solver_rows);
        for (index, row) in self.rows.iter().enumerate() {
            let end = self.rows.get(index + 1).map_or(self.solver_rows, |next| next.solver);
            sizes.resize(end, self.row_size(&row.form));
        }
        sizes
    }

    /// Keeps of each joint, by its name, the rows that are chosen, each of which counts as many rows of the solver, and numbers them anew.
    ///
    /// # Errors
    ///
    /// What the choice says.
    pub(super) fn keep_rows<E>(
        &mut self,
        mut choose: impl FnMut(&Self, &[Row], &str) -> Result<Vec<Row>, E>,
        independent: impl Fn(&Form) -> usize,
    ) -> Result<(), E> {
        let (rows, mut constraints) = (take(&mut self.rows), take(&mut self.constraints));
        (self.solver_rows, self.block_entries) = (0, 0);
        for constraint in &mut constraints {
            let first = self.rows.len();
            let mut size = 0;
            for mut row in choose(self, &rows[constraint.forms.clone()], &constraint.name)? {
                row.solver = self.solver_rows + size;
                row.local = size;
                size += independent(&row.form);
                self.rows.push(row);
            }
            constraint.forms = first..self.rows.len();
            constraint.solver = self.solver_rows..self.solver_rows + size;
            self.solver_rows += size;
            for incidence in &mut self.incidences[constraint.incidences.clone()] {
                (incidence.rows, incidence.offset) = (size, self.block_entries);
                self.block_entries += 6 * size;
            }
        }
        self.constraints = constraints;
        Ok(())
    }
}

/// Names of the equations of a labelled form.
pub fn equation_labels(label: &str, equations: usize) -> Vec<String> {
    if equations == 1 {
        return vec![label.to_owned()];
    }
    ["x", "y", "z"].iter().take(equations).map(|axis| format!("{label}.{axis}")).collect()
}
