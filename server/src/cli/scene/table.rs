//! Tables of a run: as text, or as an Arrow file for programs that read columns.
//!
//! The numbers of rows are computed and written out by as many threads as there are processors, the one that runs among them, and while
//! it runs: which thread writes a row changes no bit of it.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::sync::Arc;

use arrow_array::{ArrayRef, Float64Array, RecordBatch};
use arrow_ipc::writer::FileWriter;
use arrow_schema::{ArrowError, DataType, Field};
use triad_engine::run::{Column, Moment, Outputs, RowWriter, Simulation, append_row};

use super::in_order::{InOrder, Take, Work};
use crate::cli::output::is_standard;
use crate::cli::table::{TableKind, arrow_file, field};
use crate::problem::Problem;
use crate::table::{TextTable, all_columns, head};

/// Most rows of an Arrow file that are written together, and most numbers of them.
const BATCH: usize = 4096;
const BATCH_NUMBERS: usize = 1 << 18;

/// Most threads that write rows, the most rows that one of them writes at once, and numbers of these rows and of their states.
const MOST_WRITERS: usize = 8;
const MOST_ROWS: usize = 64;
const NUMBERS: usize = 1 << 15;

/// A table of a run being written.
pub(super) struct Table {
    outputs: Outputs,
    writing: InOrder<Writer, Sink>,
    filled: Rows,
    /// Rows that are written together.
    together: usize,
}

/// Rows that are written together.
#[derive(Default)]
struct Rows {
    /// Their moments, and as many as were there before.
    moments: Vec<Moment>,
    count: usize,
    /// The numbers of the rows, one row after the other: of one row at a time where they become text.
    numbers: Vec<f64>,
    text: Vec<u8>,
}

/// Writes rows.
#[derive(Clone)]
struct Writer {
    rows: RowWriter,
    as_text: bool,
}

impl Work for Writer {
    type Piece = Rows;

    fn work(&mut self, piece: &mut Rows) {
        let Rows { moments, count, numbers, text } = piece;
        numbers.clear();
        text.clear();
        for moment in &moments[..*count] {
            if self.as_text {
                numbers.clear();
            }
            numbers.push(moment.time());
            self.rows.write(moment, numbers);
            if self.as_text {
                append_row(text, numbers);
            }
        }
    }
}

/// Where rows go.
enum Sink {
    Text(TextTable<Box<dyn Write + Send>>),
    Arrow(ArrowTable),
}

/// An Arrow file.
struct ArrowTable {
    writer: Box<FileWriter<BufWriter<File>>>,
    /// How many columns there are, and how many rows are written together.
    width: usize,
    batch: usize,
    /// Rows that wait for that, one column after the other, and how many they are.
    columns: Vec<f64>,
    waiting: usize,
}

impl Table {
    /// Opens a table (`-` is standard output) and writes its head.
    pub(super) fn create(path: &Path, kind: TableKind, run: &Simulation) -> Result<Self, Problem> {
        Self::with_threads(std::thread::available_parallelism().map_or(1, usize::from), path, kind, run)
    }

    /// The same, written by so many threads at most, this one included.
    fn with_threads(threads: usize, path: &Path, kind: TableKind, run: &Simulation) -> Result<Self, Problem> {
        let outputs = Outputs::new(run);
        let unwritable =
            |error: &dyn std::fmt::Display| crate::cli::output::unwritable(path, &error.to_string());
        let sink = if is_standard(path) {
            Sink::text(Box::new(std::io::stdout()), run, &outputs).map_err(|error| unwritable(&error))?
        } else {
            let file = File::create(path).map_err(|error| unwritable(&error))?;
            match kind {
                TableKind::Arrow => {
                    let table = ArrowTable::new(file, run, &outputs);
                    Sink::Arrow(table.map_err(|error| unwritable(&error))?)
                }
                TableKind::Csv => {
                    Sink::text(Box::new(file), run, &outputs).map_err(|error| unwritable(&error))?
                }
            }
        };
        let writer = Writer { rows: RowWriter::new(run, &outputs), as_text: matches!(sink, Sink::Text(_)) };
        let numbers = outputs.columns().len() + 2 * (run.q().len() + run.q_dot().len());
        let together = (NUMBERS / numbers.max(1)).clamp(1, MOST_ROWS);
        let writing = InOrder::new(threads.min(MOST_WRITERS), writer, sink);
        Ok(Self { outputs, writing, filled: Rows::default(), together })
    }

    /// Adds the current state.
    pub(super) fn row(&mut self, run: &Simulation) -> std::io::Result<()> {
        let Self { outputs, writing, filled, together } = self;
        if filled.count == filled.moments.len() {
            filled.moments.push(Moment::default());
        }
        outputs.keep(run, &mut filled.moments[filled.count]);
        filled.count += 1;
        if filled.count == *together {
            *filled = writing.push(std::mem::take(filled))?;
            filled.count = 0;
        }
        Ok(())
    }

    /// Writes what is still held back.
    pub(super) fn finish(self) -> std::io::Result<()> {
        self.writing.finish(self.filled)?.finish()
    }
}

impl Take<Rows> for Sink {
    fn take(&mut self, rows: &Rows) -> std::io::Result<()> {
        match self {
            Self::Text(table) => table.rows(&rows.text),
            Self::Arrow(table) => table.add(rows).map_err(std::io::Error::other),
        }
    }
}

impl Sink {
    fn text(out: Box<dyn Write + Send>, run: &Simulation, outputs: &Outputs) -> std::io::Result<Self> {
        let out: Box<dyn Write + Send> = Box::new(BufWriter::with_capacity(1 << 16, out));
        TextTable::new(out, run, outputs).map(Self::Text)
    }

    fn finish(self) -> std::io::Result<()> {
        match self {
            Self::Text(table) => table.finish().map(drop),
            Self::Arrow(table) => table.finish().map_err(std::io::Error::other),
        }
    }
}

impl ArrowTable {
    /// Conventions stand in the metadata of the table.
    fn new(file: File, run: &Simulation, outputs: &Outputs) -> Result<Self, ArrowError> {
        let number = |column: Column| field(&column.name, Some(column.unit), DataType::Float64, false);
        let fields: Vec<Field> = all_columns(outputs).map(number).collect();
        let batch = (BATCH_NUMBERS / fields.len()).clamp(1, BATCH);
        let (width, columns) = (fields.len(), vec![0.0; batch * fields.len()]);
        let about = [("triad", head(&run.model().name)), ("conventions", outputs.conventions().join("\n"))];
        let writer = Box::new(arrow_file(file, fields, about)?);
        Ok(Self { writer, width, batch, columns, waiting: 0 })
    }

    /// Adds rows, in plain loops: this crate is compiled for size, and iterators are calls in it.
    fn add(&mut self, rows: &Rows) -> Result<(), ArrowError> {
        let (width, mut row) = (self.width, 0);
        while row < rows.count {
            if self.waiting == self.batch {
                self.write_batch()?;
            }
            // As many rows as there is room for.
            let end = rows.count.min(row + self.batch - self.waiting);
            let mut column = 0;
            while column < width {
                let place = column * self.batch + self.waiting;
                let mut from = row;
                while from < end {
                    self.columns[place + from - row] = rows.numbers[from * width + column];
                    from += 1;
                }
                column += 1;
            }
            self.waiting += end - row;
            row = end;
        }
        Ok(())
    }

    fn write_batch(&mut self) -> Result<(), ArrowError> {
        let Self { writer, batch, columns, waiting, .. } = self;
        let arrays = columns.chunks(*batch).map(|column| {
            let values = column[..*waiting].to_vec();
            Arc::new(Float64Array::from(values)) as ArrayRef
        });
        let batch = RecordBatch::try_new(Arc::clone(writer.schema()), arrays.collect())?;
        *waiting = 0;
        writer.write(&batch)
    }

    fn finish(mut self) -> Result<(), ArrowError> {
        self.write_batch()?;
        self.writer.finish()
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
        let written = |ending: &str, threads: usize| {
            let file = folder.path().join(format!("{threads}.{ending}"));
            let mut run = run("spatial-slider-crank");
            let kind = TableKind::of(&file).unwrap();
            let mut table = Table::with_threads(threads, &file, kind, &run).unwrap();
            // More pieces than may wait, and a part of one.
            for step in 0..9 * 4 * table.together + 5 {
                run.advance_to(0.0001 * step as f64).unwrap();
                table.row(&run).unwrap();
            }
            table.finish().unwrap();
            std::fs::read(file).unwrap()
        };
        for ending in ["csv", "arrow"] {
            let alone = written(ending, 1);
            assert!(alone.len() > 1_000_000, "{}", alone.len());
            for threads in [2, 4, 8] {
                assert!(written(ending, threads) == alone, "{threads} threads, {ending}");
            }
        }
    }

    #[test]
    fn text_and_arrow_hold_the_same_numbers_exactly() {
        let folder = tempfile::tempdir().unwrap();
        let files = ["a.csv", "a.arrow"].map(|name| folder.path().join(name));
        let mut run = run("spatial-slider-crank");
        let mut tables =
            files.each_ref().map(|file| Table::create(file, TableKind::of(file).unwrap(), &run).unwrap());
        let outputs = Outputs::new(&run);
        let mut rows = Vec::new();
        // More than an Arrow file holds together.
        let count = BATCH_NUMBERS / outputs.columns().len() + 5;
        for step in 0..count {
            run.advance_to(0.0005 * step as f64).unwrap();
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
        assert!(batches.len() > 1);
        for index in 0..names.len() {
            let parts =
                batches.iter().map(|batch| batch.column(index).as_any().downcast_ref::<Float64Array>());
            let column: Vec<f64> = parts.flat_map(|part| part.unwrap().values().to_vec()).collect();
            let expected: Vec<f64> = rows.iter().map(|row| row[index]).collect();
            assert_eq!(column, expected);
        }
    }
}
