//! LU factorization with partial pivoting that leaves out zeros, column by column.
//!
//! Gilbert and Peierls, Sparse partial pivoting in time proportional to arithmetic operations, SIAM J. Sci. Stat.
//! Comput. 9 (1988). Pivots, and the order of all sums, are those of the plain factorization of a full square, so that
//! the solution is the same to the last bit.

/// Marks a row that is no pivot yet, or that no column has touched.
const NONE: usize = usize::MAX;

/// A square matrix by columns.
#[derive(Clone, Debug, Default)]
pub struct Columns {
    /// First entry of each column, and the number of entries.
    pub start: Vec<usize>,
    /// Row of each entry.
    pub rows: Vec<usize>,
    /// Its value.
    pub values: Vec<f64>,
}

impl Columns {
    /// Sorts (row, column, value) entries into columns; entries at one place must not repeat.
    pub fn fill(&mut self, n: usize, entries: &[(usize, usize, f64)]) {
        self.start.clear();
        self.start.resize(n + 1, 0);
        for &(_, column, _) in entries {
            self.start[column + 1] += 1;
        }
        for column in 0..n {
            self.start[column + 1] += self.start[column];
        }
        self.rows.clear();
        self.rows.resize(entries.len(), 0);
        self.values.clear();
        self.values.resize(entries.len(), 0.0);
        let mut next = self.start.clone();
        for &(row, column, value) in entries {
            self.rows[next[column]] = row;
            self.values[next[column]] = value;
            next[column] += 1;
        }
    }
}

/// A factorization and its store, used again and again for matrices of one size.
#[derive(Clone, Debug)]
pub struct SparseLu {
    l: Columns,
    u: Columns,
    /// Step at which a row was the pivot's.
    step_of_row: Vec<usize>,
    /// Where each row stands after the exchanges so far, and which row stands where.
    position: Vec<usize>,
    row_at: Vec<usize>,
    x: Vec<f64>,
    marked: Vec<usize>,
    stack: Vec<(usize, usize)>,
    pattern: Vec<usize>,
}

impl SparseLu {
    /// For matrices of n rows.
    pub fn new(n: usize) -> Self {
        Self {
            l: Columns::default(),
            u: Columns::default(),
            step_of_row: vec![NONE; n],
            position: vec![0; n],
            row_at: vec![0; n],
            x: vec![0.0; n],
            marked: vec![NONE; n],
            stack: Vec::new(),
            pattern: Vec::with_capacity(n),
        }
    }

    /// Factorizes. False if the matrix is singular to the last digit.
    pub fn factor(&mut self, matrix: &Columns) -> bool {
        for store in [&mut self.l, &mut self.u] {
            store.start.clear();
            store.start.push(0);
            store.rows.clear();
            store.values.clear();
        }
        self.step_of_row.fill(NONE);
        self.marked.fill(NONE);
        let n = self.position.len();
        for row in 0..n {
            self.position[row] = row;
            self.row_at[row] = row;
        }
        (0..n).all(|step| self.factor_column(matrix, step))
    }

    fn factor_column(&mut self, matrix: &Columns, step: usize) -> bool {
        let range = matrix.start[step]..matrix.start[step + 1];
        self.find_pattern(step, &matrix.rows[range.clone()]);
        for (&row, &value) in matrix.rows[range.clone()].iter().zip(&matrix.values[range]) {
            self.x[row] = value;
        }
        let step_of_row = &self.step_of_row;
        self.pattern.sort_unstable_by_key(|&row| step_of_row[row]);
        for &row in &self.pattern {
            let from = self.step_of_row[row];
            let x = self.x[row];
            if from == NONE {
                break;
            }
            let below = self.l.start[from]..self.l.start[from + 1];
            for (&i, &l) in self.l.rows[below.clone()].iter().zip(&self.l.values[below]) {
                self.x[i] -= l * x;
            }
        }
        let Some(pivot_row) = self.choose_pivot() else { return false };
        let pivot = self.x[pivot_row];
        let inverse = 1.0 / pivot;
        self.step_of_row[pivot_row] = step;
        let (displaced, left) = (self.row_at[step], self.position[pivot_row]);
        self.row_at.swap(step, left);
        self.position[pivot_row] = step;
        self.position[displaced] = left;
        for at in 0..self.pattern.len() {
            let row = self.pattern[at];
            let value = std::mem::take(&mut self.x[row]);
            match self.step_of_row[row] {
                NONE => {
                    self.l.rows.push(row);
                    self.l.values.push(value * inverse);
                }
                from if from < step => {
                    self.u.rows.push(from);
                    self.u.values.push(value);
                }
                _ => {}
            }
        }
        self.l.start.push(self.l.rows.len());
        // The diagonal entry stands last in its column of U.
        self.u.rows.push(step);
        self.u.values.push(pivot);
        self.u.start.push(self.u.rows.len());
        pivot.is_finite()
    }

    /// Rows that can become non-zero in the column of this step, each after those that depend on it.
    fn find_pattern(&mut self, step: usize, rows: &[usize]) {
        self.pattern.clear();
        for &root in rows {
            if self.marked[root] == step {
                continue;
            }
            self.marked[root] = step;
            self.stack.push((root, 0));
            while let Some(&(row, next)) = self.stack.last() {
                let from = self.step_of_row[row];
                let below = if from == NONE { 0..0 } else { self.l.start[from]..self.l.start[from + 1] };
                let mut at = below.start + next;
                while at < below.end && self.marked[self.l.rows[at]] == step {
                    at += 1;
                }
                if at == below.end {
                    self.pattern.push(row);
                    self.stack.pop();
                } else {
                    let child = self.l.rows[at];
                    if let Some(top) = self.stack.last_mut() {
                        top.1 = at + 1 - below.start;
                    }
                    self.marked[child] = step;
                    self.stack.push((child, 0));
                }
            }
        }
    }

    /// The largest entry; among equals the one that stands first.
    fn choose_pivot(&self) -> Option<usize> {
        let mut best: Option<(usize, f64)> = None;
        for &row in &self.pattern {
            if self.step_of_row[row] != NONE {
                continue;
            }
            let size = self.x[row].abs();
            let better = best.is_none_or(|(b, largest)| {
                size > largest || (size == largest && self.position[row] < self.position[b])
            });
            if better {
                best = Some((row, size));
            }
        }
        best.filter(|(_, size)| *size > 0.0).map(|(row, _)| row)
    }

    /// Replaces b by the solution.
    pub fn solve(&mut self, b: &mut [f64]) {
        let n = self.position.len();
        for step in 0..n {
            let x = b[self.row_at[step]];
            self.x[step] = x;
            let below = self.l.start[step]..self.l.start[step + 1];
            for (&row, &l) in self.l.rows[below.clone()].iter().zip(&self.l.values[below]) {
                b[row] -= l * x;
            }
        }
        for step in (0..n).rev() {
            let last = self.u.start[step + 1] - 1;
            let x = self.x[step] / self.u.values[last];
            self.x[step] = 0.0;
            b[step] = x;
            for at in self.u.start[step]..last {
                self.x[self.u.rows[at]] -= self.u.values[at] * x;
            }
        }
    }
}
