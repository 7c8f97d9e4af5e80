//! All runs of a sweep as a table: the varied numbers, the time at the end, with its error where an event chose it, the outputs there; of
//! a failed run the code of its error.

use std::fmt::Write as _;
use std::fs::File;
use std::path::Path;
use std::sync::Arc;

use arrow_array::{ArrayRef, Float64Array, RecordBatch, StringArray, UInt64Array};
use arrow_schema::{ArrowError, DataType};
use triad_lab::csv::quoted;
use triad_lab::sweep::{Reached, Sweep, SweepRun};

use crate::cli::output::{self, unwritable};
use crate::cli::table::{TableKind, arrow_file, field};
use crate::problem::Problem;
use crate::table::head;

/// Runs that stand together in an Arrow file.
const BATCH: usize = 1 << 16;

/// What a run has of a column; nothing where it has not come to it.
type Of<T> = Box<dyn Fn(&SweepRun) -> Option<T>>;

/// What stands in a column.
enum Cells {
    Counts(Of<u64>),
    Numbers(Of<f64>),
    Words(Of<&'static str>),
}

/// A column, the same for all kinds of tables.
struct SweepColumn {
    name: String,
    unit: Option<&'static str>,
    /// What stands above it in a text, which has no other place for units of outputs.
    heading: String,
    cells: Cells,
}

impl SweepColumn {
    fn new(name: &str, unit: Option<&'static str>, cells: Cells) -> Self {
        Self { name: name.to_owned(), unit, heading: name.to_owned(), cells }
    }
}

fn end(run: &SweepRun) -> Option<&Reached> {
    run.result.as_ref().ok()
}

fn columns(found: &Sweep) -> Vec<SweepColumn> {
    let counts = |name, count: fn(&SweepRun) -> Option<u64>| {
        SweepColumn::new(name, None, Cells::Counts(Box::new(count)))
    };
    let times = |name, time: fn(&SweepRun) -> Option<f64>| {
        SweepColumn::new(name, Some("s"), Cells::Numbers(Box::new(time)))
    };
    let mut columns = vec![counts("run", |run| Some(run.index as u64))];
    columns.extend(found.varied.iter().enumerate().map(|(index, name)| {
        SweepColumn::new(name, None, Cells::Numbers(Box::new(move |run| run.values.get(index).copied())))
    }));
    columns.push(times("time", |run| Some(end(run)?.time)));
    if found.runs.iter().any(|run| end(run).is_some_and(|end| end.time_error.is_some())) {
        columns.push(times("time_error", |run| Some(end(run)?.time_error.unwrap_or(0.0))));
    }
    columns.extend(found.columns.iter().enumerate().map(|(index, column)| SweepColumn {
        name: column.name.clone(),
        unit: Some(column.unit),
        heading: format!("{} [{}]", column.name, column.unit),
        cells: Cells::Numbers(Box::new(move |run| end(run)?.outputs.get(index).copied())),
    }));
    columns.push(counts("evaluations", |run| Some(end(run)?.evaluations)));
    columns.push(counts("doubts", |run| Some(end(run)?.doubts as u64)));
    let stopped = |run: &SweepRun| Some(run.result.as_ref().err()?.code());
    columns.push(SweepColumn::new("stopped", None, Cells::Words(Box::new(stopped))));
    columns
}

/// Writes the table; `-` is standard output.
pub(super) fn write(file: &Path, kind: TableKind, scene: &str, found: &Sweep) -> Result<(), Problem> {
    match kind {
        TableKind::Csv => output::write(file, text(found)),
        TableKind::Arrow => {
            let opened = File::create(file).map_err(|error| unwritable(file, &error))?;
            arrow(opened, scene, found).map_err(|error| unwritable(file, &error))
        }
    }
}

fn text(found: &Sweep) -> String {
    let columns = columns(found);
    let headings: Vec<_> = columns.iter().map(|column| quoted(&column.heading)).collect();
    let mut out = headings.join(",") + "\n";
    let mut digits = zmij::Buffer::new();
    for run in &found.runs {
        for (index, column) in columns.iter().enumerate() {
            if index > 0 {
                out.push(',');
            }
            match &column.cells {
                Cells::Counts(of) => {
                    let _ = of(run).map_or(Ok(()), |count| write!(out, "{count}"));
                }
                Cells::Numbers(of) => out.push_str(of(run).map_or("", |x| digits.format(x))),
                Cells::Words(of) => out.push_str(of(run).unwrap_or("")),
            }
        }
        out.push('\n');
    }
    out
}

fn arrow(file: File, scene: &str, found: &Sweep) -> Result<(), ArrowError> {
    let columns = columns(found);
    let fields = columns.iter().map(|column| {
        let kind = match column.cells {
            Cells::Counts(_) => DataType::UInt64,
            Cells::Numbers(_) => DataType::Float64,
            Cells::Words(_) => DataType::Utf8,
        };
        field(&column.name, column.unit, kind, true)
    });
    let mut writer = arrow_file(file, fields.collect(), [("triad", head(scene))])?;
    for runs in found.runs.chunks(BATCH) {
        let arrays = columns.iter().map(|column| match &column.cells {
            Cells::Counts(of) => Arc::new(runs.iter().map(of).collect::<UInt64Array>()) as ArrayRef,
            Cells::Numbers(of) => Arc::new(runs.iter().map(of).collect::<Float64Array>()) as ArrayRef,
            Cells::Words(of) => Arc::new(runs.iter().map(of).collect::<StringArray>()) as ArrayRef,
        });
        writer.write(&RecordBatch::try_new(Arc::clone(writer.schema()), arrays.collect())?)?;
    }
    writer.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use arrow_array::Array;
    use arrow_array::cast::AsArray;
    use arrow_array::types::{Float64Type, UInt64Type};
    use triad_engine::catalogue;
    use triad_lab::sweep::{SweepPlan, Unwatched, Values, Variation, sweep};

    /// What stands in a row of an Arrow file, as text has it.
    fn fields(batch: &RecordBatch, row: usize) -> Vec<String> {
        let field = |column: &ArrayRef| match column.data_type() {
            _ if column.is_null(row) => String::new(),
            DataType::UInt64 => column.as_primitive::<UInt64Type>().value(row).to_string(),
            DataType::Float64 => {
                zmij::Buffer::new().format(column.as_primitive::<Float64Type>().value(row)).to_owned()
            }
            _ => column.as_string::<i32>().value(row).to_owned(),
        };
        batch.columns().iter().map(field).collect()
    }

    #[test]
    fn text_and_arrow_hold_the_same() {
        let scene = catalogue::scene("simple-pendulum").unwrap().duration(0.2);
        let mass = Variation::new(&scene, "mass", Values::Grid { from: -1.0, to: 2.0, count: 4 }).unwrap();
        let plan = SweepPlan { varied: vec![mass], ..SweepPlan::with_errors(scene) };
        let mut found = sweep(&plan, 1, &Unwatched).unwrap();
        for stopped in [false, true] {
            if stopped {
                found.runs[2].result.as_mut().unwrap().time_error = Some(1e-9);
            }
            let folder = tempfile::tempdir().unwrap();
            let files = ["a.csv", "a.arrow"].map(|name| folder.path().join(name));
            for file in &files {
                write(file, TableKind::of(file).unwrap(), "swing", &found).unwrap();
            }
            let text = std::fs::read_to_string(&files[0]).unwrap();
            let (heads, rows) = text.split_once('\n').unwrap();
            let reader =
                arrow_ipc::reader::FileReader::try_new(File::open(&files[1]).unwrap(), None).unwrap();
            let schema = reader.schema();
            assert!(schema.metadata()["triad"].contains("scene swing"));
            let headings = schema.fields().iter().map(|field| match field.metadata().get("unit") {
                Some(unit) if !field.name().starts_with("time") => format!("{} [{unit}]", field.name()),
                _ => field.name().clone(),
            });
            assert_eq!(heads, headings.collect::<Vec<_>>().join(","));
            assert_eq!(heads.contains(",time_error,"), stopped);
            let batches: Vec<RecordBatch> = reader.map(Result::unwrap).collect();
            let read = batches
                .iter()
                .flat_map(|batch| (0..batch.num_rows()).map(|row| fields(batch, row).join(",")));
            assert_eq!(rows.lines().collect::<Vec<_>>(), read.collect::<Vec<_>>());
            assert!(rows.lines().count() == 4 && rows.contains(",,,mass-not-positive\n"), "{rows}");
        }
    }
}
