//! Factors of small dense matrices in place, real or complex: nothing is allocated, and nothing is gained by blocks.

use nalgebra::ComplexField;

/// P M = L U of a matrix by columns, L below the diagonal without it.
#[derive(Clone, Debug)]
pub struct Factored<T> {
    entries: Vec<T>,
    /// One by the diagonal of U.
    inverse: Vec<T>,
    /// The row that each one was exchanged with.
    exchanged: Vec<usize>,
}

impl<T: ComplexField<RealField = f64> + Copy> Factored<T> {
    /// Room for a matrix of n rows.
    pub fn new(n: usize, zero: T) -> Self {
        Self { entries: vec![zero; n * n], inverse: vec![zero; n], exchanged: vec![0; n] }
    }

    /// Factors the matrix with these entries, by columns, and a number added to its diagonal. False if it is singular.
    pub fn factor(&mut self, n: usize, entries: impl Iterator<Item = T>, diagonal: T) -> bool {
        self.entries.iter_mut().zip(entries).for_each(|(own, entry)| *own = entry);
        self.entries.iter_mut().step_by(n + 1).for_each(|entry| *entry += diagonal);
        (0..n).all(|k| self.eliminate(n, k))
    }

    /// Eliminates column k. False if it has no pivot.
    fn eliminate(&mut self, n: usize, k: usize) -> bool {
        let column = &self.entries[k * n..][..n];
        let mut pivot = k;
        for i in k + 1..n {
            if column[i].norm1() > column[pivot].norm1() {
                pivot = i;
            }
        }
        if column[pivot].norm1().is_nan() || column[pivot].norm1() == 0.0 {
            return false;
        }
        self.exchanged[k] = pivot;
        if pivot != k {
            self.entries.chunks_exact_mut(n).for_each(|column| column.swap(k, pivot));
        }
        let (before, behind) = self.entries.split_at_mut((k + 1) * n);
        let column = &mut before[k * n..];
        let inverse = T::one() / column[k];
        self.inverse[k] = inverse;
        column[k + 1..].iter_mut().for_each(|x| *x *= inverse);
        for other in behind.chunks_exact_mut(n) {
            let factor = other[k];
            for (x, l) in other[k + 1..].iter_mut().zip(&column[k + 1..]) {
                *x -= *l * factor;
            }
        }
        true
    }

    /// x ← M⁻¹ x.
    pub fn solve(&self, x: &mut [T]) {
        let n = x.len();
        for (k, &other) in self.exchanged.iter().enumerate() {
            x.swap(k, other);
        }
        for (k, column) in self.entries.chunks_exact(n.max(1)).enumerate() {
            let known = x[k];
            for (x, l) in x[k + 1..].iter_mut().zip(&column[k + 1..]) {
                *x -= *l * known;
            }
        }
        for (k, column) in self.entries.chunks_exact(n.max(1)).enumerate().rev() {
            let known = x[k] * self.inverse[k];
            x[k] = known;
            for (x, u) in x[..k].iter_mut().zip(column) {
                *x -= *u * known;
            }
        }
    }
}
