//! Rows of numbers, as programs write them.

/// Rows of numbers.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Grid {
    pub rows: usize,
    pub columns: usize,
    /// Row by row.
    pub values: Vec<f64>,
}

impl Grid {
    /// One column.
    pub(crate) fn column(values: Vec<f64>) -> Self {
        Self { rows: values.len(), columns: 1, values }
    }

    /// A grid from its entries.
    pub(crate) fn make(rows: usize, columns: usize, value: impl Fn(usize, usize) -> f64) -> Self {
        let values = (0..rows * columns).map(|k| value(k / columns, k % columns)).collect();
        Self { rows, columns, values }
    }

    /// An entry.
    pub(crate) fn at(&self, row: usize, column: usize) -> f64 {
        self.values[row * self.columns + column]
    }

    /// All entries times a factor.
    pub(crate) fn scaled(&self, k: f64) -> Self {
        Self { values: self.values.iter().map(|x| k * x).collect(), ..*self }
    }

    /// Rows and columns exchanged.
    pub(crate) fn transposed(&self) -> Self {
        Self::make(self.columns, self.rows, |row, column| self.at(column, row))
    }

    /// Largest size of an entry, at least 1: the scale of a tolerance.
    pub(crate) fn scale(&self) -> f64 {
        self.values.iter().fold(1.0, |a, x| a.max(x.abs()))
    }

    /// Whether all entries agree, where a difference of `tolerance` times `scale` is allowed.
    pub(crate) fn agrees(&self, other: &Self, tolerance: f64, scale: f64) -> bool {
        (self.rows, self.columns) == (other.rows, other.columns)
            && self.values.iter().zip(&other.values).all(|(a, b)| (a - b).abs() <= tolerance * scale)
    }
}
