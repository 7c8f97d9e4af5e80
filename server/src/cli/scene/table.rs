//! Tables of a run: as text, or as an Arrow file for programs that read columns.
//!
//! The numbers of a row are computed and written out by as many threads as there are processors, while the run goes on one block of rows
//! at a time: which thread writes a row changes no bit of it.

use std::collections::HashMap;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::sync::Arc;

use arrow_array::{ArrayRef, Float64Array, RecordBatch};
use arrow_ipc::writer::FileWriter;
use arrow_schema::{ArrowError, DataType, Field, Schema};
use axum::http::StatusCode;
use rayon::prelude::*;
use triad_engine::run::{Column, Moment, Outputs, RowWriter, Simulation, append_row};

use crate::problem::Problem;
use crate::table::{TextTable, all_columns, head};

/// Endings of files that are written as Arrow.
const ARROW: [&str; 2] = ["arrow", "feather"];
/// Endings of tables that are not written.
const OTHERS: [&str; 3] = ["parquet", "xlsx", "mat"];
/// Rows of an Arrow file that are written together.
const BATCH: usize = 4096;

/// Moments that wait until their rows are written together, and most threads that do so.
const BLOCK: usize = 64;
const MOST_WRITERS: usize = 8;

/// A table of a run being written.
pub(super) struct Table {
    outputs: Outputs,
    waiting: Vec<Moment>,
    writers: Vec<Writer>,
    sink: Sink,
}

/// Writes a part of a block.
struct Writer {
    rows: RowWriter,
    /// The numbers of its rows, one row after the other, and their text where that is wanted.
    numbers: Vec<f64>,
    text: Vec<u8>,
}

impl Writer {
    fn write(&mut self, moments: &[Moment], as_text: bool) {
        for moment in moments {
            if as_text {
                self.numbers.clear();
            }
            self.numbers.push(moment.time());
            self.rows.write(moment, &mut self.numbers);
            if as_text {
                append_row(&mut self.text, &self.numbers);
            }
        }
    }
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
        let count = rayon::current_num_threads().clamp(1, MOST_WRITERS);
        let rows = RowWriter::new(run, &outputs);
        let writer = || Writer { rows: rows.clone(), numbers: Vec::new(), text: Vec::new() };
        let writers = std::iter::repeat_with(writer).take(count).collect();
        Ok(Self { outputs, waiting: Vec::with_capacity(BLOCK), writers, sink })
    }

    /// Adds the current state.
    pub(super) fn row(&mut self, run: &Simulation) -> std::io::Result<()> {
        self.waiting.push(self.outputs.moment(run));
        if self.waiting.len() < BLOCK { Ok(()) } else { self.write_block() }
    }

    /// Writes the rows of all moments that wait.
    fn write_block(&mut self) -> std::io::Result<()> {
        let Self { waiting, writers, sink, .. } = self;
        let as_text = matches!(sink, Sink::Text(_));
        let share = waiting.len().div_ceil(writers.len()).max(1);
        let parts = writers.par_iter_mut().zip(waiting.par_chunks(share));
        parts.for_each(|(writer, moments)| writer.write(moments, as_text));
        for writer in writers {
            sink.rows(writer)?;
            writer.numbers.clear();
            writer.text.clear();
        }
        waiting.clear();
        Ok(())
    }

    /// Writes what is still held back.
    pub(super) fn finish(mut self) -> std::io::Result<()> {
        self.write_block()?;
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

    /// Takes over the rows that a writer has made.
    fn rows(&mut self, writer: &Writer) -> std::io::Result<()> {
        match self {
            Self::Text(table) => table.rows(&writer.text),
            Self::Arrow { columns, .. } => {
                for row in writer.numbers.chunks_exact(columns.len()) {
                    for (column, number) in columns.iter_mut().zip(row) {
                        column.push(*number);
                    }
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
    fn the_number_of_threads_changes_no_byte() {
        let folder = tempfile::tempdir().unwrap();
        let written = |threads: usize| {
            let file = folder.path().join(format!("{threads}.csv"));
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut run = run("spatial-slider-crank");
                let mut table = Table::create(&file, &run).unwrap();
                // Two blocks and a part of one.
                for step in 0..2 * BLOCK + 5 {
                    run.advance_to(0.005 * step as f64).unwrap();
                    table.row(&run).unwrap();
                }
                table.finish().unwrap();
            });
            std::fs::read(file).unwrap()
        };
        let alone = written(1);
        assert!(alone.len() > 100_000);
        for threads in [2, 3, 7] {
            assert!(written(threads) == alone, "{threads} threads");
        }
    }

    #[test]
    fn text_and_arrow_hold_the_same_numbers_exactly() {
        let folder = tempfile::tempdir().unwrap();
        let files = ["a.csv", "a.arrow"].map(|name| folder.path().join(name));
        let mut run = run("spatial-slider-crank");
        let mut tables = files.each_ref().map(|file| Table::create(file, &run).unwrap());
        let outputs = Outputs::new(&run);
        let mut rows = Vec::new();
        for step in 0..5 {
            run.advance_to(0.01 * f64::from(step)).unwrap();
            for table in &mut tables {
                table.row(&run).unwrap();
            }
            let mut row = vec![run.time()];
            outputs.write(&run, &mut row);
            rows.push(row);
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
