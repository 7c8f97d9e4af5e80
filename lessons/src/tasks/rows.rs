//! Rows of the equations, found by what they are, and grids with some of them changed.

use std::ops::Range;

use triad_engine::constraints::mechanism::Mechanism;
use triad_engine::system::Row as EquationRow;
use triad_engine::system::feature::Target;
use triad_engine::system::row::Form;

use super::grid::Grid;

/// Some rows with the other sign.
pub(super) fn turned(grid: &Grid, rows: Range<usize>) -> Grid {
    let mut grid = grid.clone();
    grid.values[rows.start * grid.columns..rows.end * grid.columns].iter_mut().for_each(|x| *x = -*x);
    grid
}

/// The rows that are differences of body i and body j, and change their sign when these are swapped; products do not.
pub(super) fn differences(mechanism: &Mechanism) -> Vec<Range<usize>> {
    let system = &mechanism.system;
    let of = |row: &EquationRow| {
        let first = system.rigid_rows + row.equation;
        first..first + row.form.equations()
    };
    system.rows.iter().filter(|row| !row.implied && row.form.equations() == 3).map(of).collect()
}

/// Those of the first of them.
pub(super) fn first(mechanism: &Mechanism) -> Range<usize> {
    differences(mechanism).into_iter().next().unwrap_or(0..0)
}

/// Rows with a prescribed number, and that number with its derivatives.
pub(super) fn driven(mechanism: &Mechanism) -> Vec<(usize, [f64; 3])> {
    let system = &mechanism.system;
    let target = |row: &EquationRow| match row.form {
        Form::Product { target: target @ Target::Driven(_), .. } => {
            Some((system.rigid_rows + row.equation, mechanism.state.target(target)))
        }
        _ => None,
    };
    system.rows.iter().filter(|row| !row.implied).filter_map(target).collect()
}

/// The rows that say that a director has unit length.
pub(super) fn unit_rows(mechanism: &Mechanism) -> Vec<usize> {
    let names = triad_engine::equations::row_names(&mechanism.system);
    let unit = |name: &&str| [": uu", ": vv", ": ww"].iter().any(|end| name.ends_with(end));
    let rigid = mechanism.system.rigid_rows;
    (0..rigid.min(names.len())).filter(|k| unit(&names[*k].as_str())).collect()
}

/// For joints between two bodies of equally many coordinates: the blocks exchanged.
pub(super) fn columns_swapped(mechanism: &Mechanism, right: &Grid) -> Grid {
    let system = &mechanism.system;
    let mut grid = right.clone();
    for constraint in &system.constraints {
        let touched: Vec<usize> =
            system.incidences[constraint.incidences.clone()].iter().map(|i| i.body).collect();
        let [a, b] = touched.as_slice() else { continue };
        let (a, b) = (system.bodies[*a].layout, system.bodies[*b].layout);
        if a.size() != b.size() {
            continue;
        }
        for row in constraint.equations.clone() {
            for k in 0..a.size() {
                let line = (system.rigid_rows + row) * grid.columns;
                grid.values.swap(line + a.first + k, line + b.first + k);
            }
        }
    }
    grid
}

/// The 3 × 3 blocks of rows that come in threes, transposed.
pub(super) fn blocks_transposed(mechanism: &Mechanism, right: &Grid) -> Grid {
    let system = &mechanism.system;
    let mut grid = right.clone();
    for row in system.rows.iter().filter(|row| !row.implied && row.form.equations() == 3) {
        let first = system.rigid_rows + row.equation;
        for block in (0..right.columns / 3).map(|k| 3 * k) {
            for (i, j) in (0..9).map(|k| (k / 3, k % 3)) {
                grid.values[(first + i) * right.columns + block + j] = right.at(first + j, block + i);
            }
        }
    }
    grid
}
