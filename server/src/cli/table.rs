//! Tables that commands write: what the ending of a file chooses, and the Arrow files among them.

use std::collections::HashMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use arrow_ipc::writer::FileWriter;
use arrow_schema::{ArrowError, DataType, Field, Schema};
use axum::http::StatusCode;

use crate::problem::Problem;

/// How a table is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TableKind {
    /// As text.
    Csv,
    /// As Arrow (Feather), for programs that read columns.
    Arrow,
}

impl TableKind {
    /// By the ending of the file, text where it has none: asked before anything is computed. Text under the ending of another kind
    /// would only be found out by who reads it.
    pub(super) fn of(file: &Path) -> Result<Self, Problem> {
        let ending = file.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            None | Some("csv") => Ok(Self::Csv),
            Some("arrow" | "feather") => Ok(Self::Arrow),
            Some(ending) => Err(Problem::new(
                StatusCode::UNPROCESSABLE_ENTITY,
                "unknown-table",
                format!("tables are not written as .{ending}"),
                "give a file that ends in .csv, or in .arrow or .feather for pandas, polars, R and MATLAB",
            )),
        }
    }
}

/// A column of an Arrow file. Its unit, if it has one, stands in its metadata.
pub(super) fn field(name: &str, unit: Option<&str>, kind: DataType, may_be_empty: bool) -> Field {
    let unit = unit.map(|unit| ("unit".to_owned(), unit.to_owned()));
    Field::new(name, kind, may_be_empty).with_metadata(unit.into_iter().collect())
}

/// Begins an Arrow file; what is said of the whole stands in its metadata.
pub(super) fn arrow_file(
    file: File,
    fields: Vec<Field>,
    about: impl IntoIterator<Item = (&'static str, String)>,
) -> Result<FileWriter<BufWriter<File>>, ArrowError> {
    let about: HashMap<_, _> = about.into_iter().map(|(key, text)| (key.to_owned(), text)).collect();
    FileWriter::try_new_buffered(file, &Schema::new(fields).with_metadata(about))
}
