//! The archive that Gradescope builds an image from: `setup.sh` and `run_autograder` at its root, the rest beside them. All of
//! it lies in `/autograder/source` there.

use std::fs;
use std::io::{Cursor, Write};
use std::path::Path;

use triad_lessons::Lesson;
use zip::write::SimpleFileOptions;
use zip::{DateTime, ZipWriter};

use super::program::NAME;
use crate::cli::output::{make_room, unwritable};
use crate::problem::Problem;

/// Nothing is installed, so that an image can be built without network.
const SETUP: &str =
    "#!/bin/sh\nset -eu\nchmod 755 /autograder/source/triad-grade /autograder/source/run_autograder\n";

/// Rights of programs and of other files.
const PROGRAM: u32 = 0o755;
const FILE: u32 = 0o644;

/// Writes the archive; the same lesson and program always give the same bytes.
pub(super) fn write(
    lesson: &Lesson,
    program: &[u8],
    numbers_of_email: bool,
    out: &Path,
) -> Result<(), Problem> {
    let option = if numbers_of_email { " --numbers-of-email" } else { "" };
    let run = format!("#!/bin/sh\nexec /autograder/source/{NAME} gradescope{option}\n");
    let blank =
        serde_json::to_string_pretty(&lesson.of_seed("")?.blank_answers()).map_err(Problem::internal)?;
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes, rights) in [
        ("setup.sh", SETUP.as_bytes(), PROGRAM),
        ("run_autograder", run.as_bytes(), PROGRAM),
        (NAME, program, PROGRAM),
        ("lesson.json", lesson.bundle().as_bytes(), FILE),
        ("answers-to-fill-in.json", blank.as_bytes(), FILE),
    ] {
        let options =
            SimpleFileOptions::default().unix_permissions(rights).last_modified_time(DateTime::default());
        archive.start_file(name, options).map_err(Problem::internal)?;
        archive.write_all(bytes).map_err(Problem::internal)?;
    }
    let bytes = archive.finish().map_err(Problem::internal)?.into_inner();
    make_room(out)?;
    fs::write(out, bytes).map_err(|error| unwritable(out, &error))
}
