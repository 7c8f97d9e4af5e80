//! The equations from a student's own program: which block, row and column is off, and which misconception it is.

use std::collections::BTreeSet;

use triad_engine::equations::{column_names, row_names};

use crate::answers::Answer;
use crate::exercise::Implement;
use crate::files::EquationPart;
use crate::tasks::InstanceError;
use crate::tasks::grid::Grid;
use crate::tasks::instances::Instances;
use crate::tasks::misconceptions::{all_agree, misconceptions, recognise};
use crate::tasks::program_output::{OutputSize, ProgramOutput, read};
use crate::verdict::feedback::{Discrepancy, Feedback, Judgement, PartFinding};
use crate::verdict::invalid::InvalidProgram;

/// Difference below which a wrong entry is a multiple of the right one, relative to 1 plus its size.
const SAME_MULTIPLE: f64 = 1e-5;

/// Judges what a program sent; `seed` is that of the instances.
pub(super) fn judge(task: &Implement, seed: &str, answer: &Answer) -> Result<Judgement, InvalidProgram> {
    let text = answer.file.as_ref().ok_or(InvalidProgram::NoFile)?;
    let mut instances = Instances::new(task, seed).map_err(InvalidProgram::Instances)?;
    let rows = row_names(&instances.mechanism.system);
    let columns = column_names(&instances.mechanism.system);
    let size = OutputSize { states: task.states, asks: &task.asks, rows: rows.len(), columns: columns.len() };
    let given = read(text, &size)?;
    let names = Names { rows: &rows, columns: &columns };
    let mut parts = Vec::with_capacity(task.asks.len());
    for part in &task.asks {
        let finding = judge_part(task, &mut instances, *part, &given, &names);
        parts.push((*part, finding.map_err(InvalidProgram::Equations)?));
    }
    let right = parts.iter().filter(|(_, finding)| *finding == PartFinding::Right).count();
    if right == parts.len() {
        return Ok(Judgement::right(Feedback::Right { note: String::new() }));
    }
    let misconception = parts.iter().find_map(|(part, finding)| match finding {
        PartFinding::Misconception { id, .. } => Some(format!("{}-{id}", part.key())),
        _ => None,
    });
    let share = right as f64 / parts.len() as f64;
    Ok(Judgement::wrong(share, misconception.as_deref(), Feedback::Program { parts }))
}

/// Names of the rows of Φ and of the coordinates.
struct Names<'a> {
    rows: &'a [String],
    columns: &'a [String],
}

fn judge_part(
    task: &Implement,
    instances: &mut Instances,
    part: EquationPart,
    given: &ProgramOutput,
    names: &Names,
) -> Result<PartFinding, InstanceError> {
    let Some(given) = given.get(&part) else { return Ok(PartFinding::Missing) };
    let right = instances.answers(part)?;
    if all_agree(given, &right, &right, task.tolerance) {
        return Ok(PartFinding::Right);
    }
    let known = misconceptions(task, instances, part)?;
    if let Some(one) = recognise(given, &right, &known, task.tolerance) {
        return Ok(PartFinding::Misconception { id: one.id, feedback: one.feedback });
    }
    let finding = given.iter().zip(&right).enumerate().find_map(|(k, (a, b))| {
        let off = where_off(a, b, task.tolerance);
        (!off.is_empty()).then(|| discrepancy((k, given.len()), part, a, b, &off, names))
    });
    Ok(finding.unwrap_or(PartFinding::Unknown))
}

/// Places that are off, as (row, column).
fn where_off(given: &Grid, right: &Grid, tolerance: f64) -> Vec<(usize, usize)> {
    if (given.rows, given.columns) != (right.rows, right.columns) {
        return vec![(0, 0)];
    }
    let allowed = tolerance * right.scale();
    let all = (0..right.rows).flat_map(|row| (0..right.columns).map(move |column| (row, column)));
    all.filter(|(row, column)| (given.at(*row, *column) - right.at(*row, *column)).abs() > allowed).collect()
}

/// Where the program is wrong, for one instance of several.
fn discrepancy(
    (k, states): (usize, usize),
    part: EquationPart,
    given: &Grid,
    right: &Grid,
    off: &[(usize, usize)],
    names: &Names,
) -> PartFinding {
    if (given.rows, given.columns) != (right.rows, right.columns) {
        return PartFinding::Size {
            rows: given.rows,
            columns: given.columns,
            wanted_rows: right.rows,
            wanted_columns: right.columns,
        };
    }
    let by_columns = matches!(part, EquationPart::Mass | EquationPart::Acceleration);
    let row_names = if by_columns { names.columns } else { names.rows };
    let matrix = right.columns > 1;
    let named = |places: BTreeSet<usize>, names: &[String]| {
        places.iter().map(|k| names.get(*k).map_or("?", String::as_str).to_owned()).collect()
    };
    let columns = if matrix { off.iter().map(|(_, column)| *column).collect() } else { BTreeSet::new() };
    PartFinding::Off(Discrepancy {
        state: k + 1,
        states,
        entries: off.len(),
        of: right.values.len(),
        rows: named(off.iter().map(|(row, _)| *row).collect(), row_names),
        rows_are_coordinates: by_columns && !matrix,
        columns: named(columns, names.columns),
        block: if matrix { block(off, row_names, names.columns) } else { None },
        factor: common_factor(given, right, off),
    })
}

/// Where all wrong entries lie in one block: the joint or body of its rows, and the body of its columns.
fn block(off: &[(usize, usize)], rows: &[String], columns: &[String]) -> Option<(String, String)> {
    let owner = |name: &String| name.split([':', '.']).next().unwrap_or_default().to_owned();
    let owners: BTreeSet<(String, String)> = off
        .iter()
        .filter_map(|(row, column)| Some((owner(rows.get(*row)?), owner(columns.get(*column)?))))
        .collect();
    if owners.len() == 1 { owners.into_iter().next() } else { None }
}

/// −1, 2 or 0 if every wrong entry is that times the right one.
fn common_factor(given: &Grid, right: &Grid, off: &[(usize, usize)]) -> Option<i32> {
    [-1, 2, 0].into_iter().find(|k| {
        off.iter().all(|&(row, column)| {
            let (x, t) = (given.at(row, column), right.at(row, column));
            (x - f64::from(*k) * t).abs() <= SAME_MULTIPLE * (1.0 + t.abs())
        })
    })
}
