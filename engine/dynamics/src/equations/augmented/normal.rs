//! M + c Φ_qᵀ Φ_q, the matrix of penalty methods, with its factors; zeros are left out.

use super::{for_mass_entries, force};
use crate::equations;
use crate::equations::jacobian::Jacobian;
use crate::state::State;
use crate::system::System;
use nalgebra::DVector;
use std::ops::Range;
use triad_linalg::{Columns, SparseLu};

/// A matrix of rank one: weight times the product of a sparse vector with itself.
#[derive(Clone, Debug)]
pub struct RankOne {
    /// The weight.
    pub weight: f64,
    /// Nonzero entries of the vector.
    pub vector: Vec<(usize, f64)>,
}

/// A square matrix to which entries are added: of each column those that were ever added to, by growing rows. A matrix of
/// all entries would not fit into memory for a mechanism of a thousand bodies.
#[derive(Clone, Debug)]
struct SparseSum {
    columns: Vec<Vec<(usize, f64)>>,
}

impl SparseSum {
    /// Sets all entries to zero; their places stay.
    fn clear(&mut self) {
        self.columns.iter_mut().flatten().for_each(|(_, value)| *value = 0.0);
    }

    fn add(&mut self, row: usize, column: usize, value: f64) {
        let column = &mut self.columns[column];
        match column.binary_search_by_key(&row, |&(row, _)| row) {
            Ok(place) => column[place].1 += value,
            Err(place) => column.insert(place, (row, value)),
        }
    }
}

/// The equations at one state, and the factors of M + c Φ_qᵀ Φ_q.
#[derive(Clone, Debug)]
pub struct Normal {
    jacobian: Jacobian,
    /// Entries of each row of the Jacobian.
    rows: Vec<Range<usize>>,
    mass: Vec<(usize, usize, f64)>,
    matrix: SparseSum,
    entries: Vec<(usize, usize, f64)>,
    columns: Columns,
    lu: SparseLu,
}

impl Normal {
    /// For a system.
    pub fn new(system: &System, at: &State) -> Self {
        let n = system.coordinates;
        let jacobian = Jacobian::new(system, at);
        let mut rows = Vec::with_capacity(jacobian.rows.len());
        let mut first = 0;
        for row in 0..jacobian.rows.len() {
            let count = jacobian.entries[first..].iter().take_while(|entry| entry.row == row).count();
            rows.push(first..first + count);
            first += count;
        }
        Self {
            jacobian,
            rows,
            mass: Vec::new(),
            matrix: SparseSum { columns: vec![Vec::new(); n] },
            entries: Vec::new(),
            columns: Columns::default(),
            lu: SparseLu::new(n),
        }
    }

    /// Number of rows, rigid-body rows included.
    pub fn rows(&self) -> usize {
        self.rows.len()
    }

    /// Takes M and Φ_q at the positions of a state.
    pub fn refresh(&mut self, system: &System, at: &State) {
        self.jacobian.refresh(system, at);
        self.mass.clear();
        let mass = &mut self.mass;
        for_mass_entries(system, at, |row, column, value| mass.push((row, column, value)));
    }

    /// Factors M + c Φ_qᵀ Φ_q and further matrices of rank one. False if the sum is singular.
    pub fn factor(&mut self, penalty: f64, others: &[RankOne]) -> bool {
        self.matrix.clear();
        for &(row, column, value) in &self.mass {
            self.matrix.add(row, column, value);
        }
        for range in &self.rows {
            for a in &self.jacobian.entries[range.clone()] {
                for b in &self.jacobian.entries[range.clone()] {
                    self.matrix.add(a.column, b.column, penalty * a.value * b.value);
                }
            }
        }
        for RankOne { weight, vector } in others {
            for &(i, a) in vector {
                for &(j, b) in vector {
                    self.matrix.add(i, j, weight * a * b);
                }
            }
        }
        self.entries.clear();
        for (column, values) in self.matrix.columns.iter().enumerate() {
            let nonzero = values.iter().filter(|(_, value)| *value != 0.0);
            self.entries.extend(nonzero.map(|&(row, value)| (row, column, value)));
        }
        self.columns.fill(self.matrix.columns.len(), &self.entries);
        self.lu.factor(&self.columns)
    }

    /// Replaces b by the solution.
    pub fn solve(&mut self, b: &mut DVector<f64>) {
        self.lu.solve(b.as_mut_slice());
    }

    /// Φ_q v.
    pub fn product(&self, v: &[f64]) -> DVector<f64> {
        let mut out = DVector::zeros(self.rows.len());
        for entry in &self.jacobian.entries {
            out[entry.row] += entry.value * v[entry.column];
        }
        out
    }

    /// out ← out + factor Φ_qᵀ x.
    pub fn add_transposed(&self, factor: f64, x: &DVector<f64>, out: &mut DVector<f64>) {
        for entry in &self.jacobian.entries {
            out[entry.column] += factor * entry.value * x[entry.row];
        }
    }

    /// M v.
    pub fn mass_product(&self, v: &DVector<f64>) -> DVector<f64> {
        let mut out = DVector::zeros(v.len());
        for &(row, column, value) in &self.mass {
            out[row] += value * v[column];
        }
        out
    }
}

/// Φ, ν, γ and g of all rows at a state, loads included.
#[derive(Clone, Debug)]
pub struct RightSides {
    /// Φ.
    pub value: DVector<f64>,
    /// ν.
    pub nu: DVector<f64>,
    /// γ.
    pub gamma: DVector<f64>,
    /// g.
    pub force: DVector<f64>,
}

impl RightSides {
    /// At a state.
    pub fn new(system: &System, at: &State) -> Self {
        Self {
            value: equations::constraints(system, at).into(),
            nu: equations::nu(system, at).into(),
            gamma: equations::gamma(system, at).into(),
            force: force(system, at),
        }
    }
}
