//! Tables of a run: as text, or as an Arrow file for programs that read columns.

use std::collections::HashMap;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::sync::Arc;

use arrow_array::{ArrayRef, Float64Array, RecordBatch};
use arrow_ipc::writer::FileWriter;
use arrow_schema::{ArrowError, DataType, Field, Schema};
use axum::http::StatusCode;
use triad_engine::run::{Column, Outputs, Simulation};

use crate::problem::Problem;
use crate::table::{TextTable, all_columns, head};

/// Endings of files that are written as Arrow.
const ARROW: [&str; 2] = ["arrow", "feather"];
/// Endings of tables that are not written.
const OTHERS: [&str; 3] = ["parquet", "xlsx", "mat"];
/// Rows of an Arrow file that are written together.
const BATCH: usize = 4096;

/// A table of a run being written.
pub(super) struct Table {
    outputs: Outputs,
    row: Vec<f64>,
    sink: Sink,
}

/// Where rows go.
enum Sink {
    Text(TextTable<Box<dyn Write>>),
    Arrow { writer: Box<FileWriter<BufWriter<File>>>, columns: Vec<Vec<f64>> },
}

impl Table {
    /// Opens a table (`-` is standard output) and writes its head; the ending of the file chooses its kind.
    pub(super) fn create(path: &Path, run: &Simulation) -> Result<Self, Problem> {
        let outputs = Outputs::new(run);
        let unwritable =
            |error: &dyn std::fmt::Display| crate::cli::output::unwritable(path, &error.to_string());
        let ending =
            path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
        if OTHERS.contains(&ending.as_str()) {
            return Err(Problem::new(
                StatusCode::UNPROCESSABLE_ENTITY,
                "unknown-table",
                format!("tables are not written as .{ending}"),
                "give a file that ends in .csv, or in .arrow or .feather for pandas, polars, R and MATLAB",
            ));
        }
        let sink = if path.as_os_str() == "-" {
            Sink::text(Box::new(std::io::stdout()), run, &outputs).map_err(|error| unwritable(&error))?
        } else {
            let file = File::create(path).map_err(|error| unwritable(&error))?;
            if ARROW.contains(&ending.as_str()) {
                Sink::arrow(file, run, &outputs).map_err(|error| unwritable(&error))?
            } else {
                Sink::text(Box::new(file), run, &outputs).map_err(|error| unwritable(&error))?
            }
        };
        Ok(Self { outputs, row: Vec::new(), sink })
    }

    /// Writes the current state.
    pub(super) fn row(&mut self, run: &Simulation) -> std::io::Result<()> {
        self.row.clear();
        self.row.push(run.time());
        self.outputs.write(run, &mut self.row);
        self.sink.row(&self.row)
    }

    /// Writes what is still held back.
    pub(super) fn finish(self) -> std::io::Result<()> {
        self.sink.finish()
    }
}

impl Sink {
    fn text(out: Box<dyn Write>, run: &Simulation, outputs: &Outputs) -> std::io::Result<Self> {
        let out: Box<dyn Write> = Box::new(BufWriter::with_capacity(1 << 16, out));
        TextTable::new(out, run, outputs).map(Self::Text)
    }

    /// Units stand in the metadata of the columns, conventions in that of the table.
    fn arrow(file: File, run: &Simulation, outputs: &Outputs) -> Result<Self, ArrowError> {
        let field = |column: Column| {
            let unit = HashMap::from([("unit".to_owned(), column.unit.to_owned())]);
            Field::new(column.name, DataType::Float64, false).with_metadata(unit)
        };
        let fields: Vec<Field> = all_columns(outputs).map(field).collect();
        let columns = vec![Vec::with_capacity(BATCH); fields.len()];
        let about = HashMap::from([
            ("triad".to_owned(), head(run)),
            ("conventions".to_owned(), outputs.conventions().join("\n")),
        ]);
        let schema = Schema::new(fields).with_metadata(about);
        let writer = Box::new(FileWriter::try_new_buffered(file, &schema)?);
        Ok(Self::Arrow { writer, columns })
    }

    fn row(&mut self, row: &[f64]) -> std::io::Result<()> {
        match self {
            Self::Text(table) => table.row(row),
            Self::Arrow { columns, .. } => {
                for (column, number) in columns.iter_mut().zip(row) {
                    column.push(*number);
                }
                if columns.first().is_some_and(|column| column.len() >= BATCH) {
                    self.write_batch().map_err(std::io::Error::other)?;
                }
                Ok(())
            }
        }
    }

    fn write_batch(&mut self) -> Result<(), ArrowError> {
        let Self::Arrow { writer, columns } = self else { return Ok(()) };
        let arrays = columns.iter_mut().map(|column| {
            let values = std::mem::replace(column, Vec::with_capacity(BATCH));
            Arc::new(Float64Array::from(values)) as ArrayRef
        });
        let batch = RecordBatch::try_new(Arc::clone(writer.schema()), arrays.collect())?;
        writer.write(&batch)
    }

    fn finish(mut self) -> std::io::Result<()> {
        self.write_batch().map_err(std::io::Error::other)?;
        match self {
            Self::Text(table) => table.finish().map(drop),
            Self::Arrow { mut writer, .. } => writer.finish().map_err(std::io::Error::other),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use triad_engine::catalogue;
    use triad_engine::scene::OutputKind;

    /// A run that shows everything that can be chosen.
    fn run(name: &str) -> Simulation {
        let mut scene = catalogue::scene(name).unwrap();
        scene.simulation.outputs = OutputKind::ALL.map(Into::into).to_vec();
        Simulation::new(&scene).unwrap()
    }

    #[test]
    fn text_and_arrow_hold_the_same_numbers_exactly() {
        let folder = tempfile::tempdir().unwrap();
        let files = ["a.csv", "a.arrow"].map(|name| folder.path().join(name));
        let mut run = run("spatial-slider-crank");
        let mut tables = files.each_ref().map(|file| Table::create(file, &run).unwrap());
        let mut rows = Vec::new();
        for step in 0..5 {
            run.advance_to(0.01 * f64::from(step)).unwrap();
            for table in &mut tables {
                table.row(&run).unwrap();
            }
            rows.push(tables[0].row.clone());
        }
        for table in tables {
            table.finish().unwrap();
        }
        let text = std::fs::read_to_string(&files[0]).unwrap();
        let lines = text.lines().filter(|line| !line.starts_with('#')).skip(2);
        let read: Vec<Vec<f64>> =
            lines.map(|line| line.split(',').map(|x| x.parse().unwrap()).collect()).collect();
        assert_eq!(read, rows);
        let reader = arrow_ipc::reader::FileReader::try_new(File::open(&files[1]).unwrap(), None).unwrap();
        let names: Vec<String> = reader.schema().fields().iter().map(|field| field.name().clone()).collect();
        assert_eq!(names.len(), rows[0].len());
        assert!(text.contains(&names[7]), "{names:?}");
        let batches: Vec<RecordBatch> = reader.map(Result::unwrap).collect();
        for (index, column) in batches[0].columns().iter().enumerate() {
            let column = column.as_any().downcast_ref::<Float64Array>().unwrap();
            let expected: Vec<f64> = rows.iter().map(|row| row[index]).collect();
            assert_eq!(column.values().to_vec(), expected);
        }
    }
}
