//! Each variant of the errors of lessons is met by a case here, and its sentence is one that was read:
//! `tests/data/reviewed/refusals-lessons.snap` and `refusals-answers.snap`.

use std::collections::BTreeMap;

use triad_tests::refusals::{Refusals, all_reviewed};
use triad_tests::variants;

use crate::answers::number::{self, NumberError};
use crate::answers::table::{self, TableError};
use crate::answers::units::{Unit, UnitError};
use crate::answers::{Answer, Submission, SubmissionError};
use crate::files::{EquationPart, Files};
use crate::grading::GradeError;
use crate::lesson::{Course, CourseError, LessonError, VariantError};
use crate::rendering::figure::{Figure, FigureError};
use crate::scenario::measure::MeasureError;
use crate::tasks::instances::InstanceError;
use crate::tasks::program_output::{self, OutputError, OutputSize};
use triad_engine::analysis::Wanted;
use triad_engine::scene::expression::{Expression, ExpressionError};

/// What is quoted beside the refusal.
fn quoted(text: &str) -> String {
    let start: String = text.chars().take(40).collect();
    if start.len() < text.len() { format!("{start:?}…") } else { format!("{start:?}") }
}

#[test]
fn answers_that_cannot_be_read() {
    let mut numbers = Refusals::new(variants!(NumberError: Empty, NotANumber, AmbiguousComma, NotFinite));
    for text in [" ", "lots", "1,500", "2.4x10-3", "NaN", "1e999"] {
        let error = number::read(text).unwrap_err();
        numbers.meet(&quoted(text), &error, error.code(), None, "");
    }
    let mut units = Refusals::new(variants!(UnitError: Unknown, Ambiguous, Syntax));
    for text in ["furlong", "kg/m s", "m^", "m//s"] {
        let error = Unit::parse(text).unwrap_err();
        units.meet(&quoted(text), &error, error.code(), None, "");
    }
    let mut formulas = Refusals::new(variants!(ExpressionError: Empty, TooLarge, UnknownSymbol, Syntax));
    for text in ["", &"(".repeat(500), "m*w^2", "m*(v", "m v)", "m+*v"] {
        let error = Expression::parse(text, &["m", "v"]).unwrap_err();
        formulas.meet(&quoted(text), &error, error.code(), None, "");
    }
    let mut tables = Refusals::new(variants!(
        TableError: Empty, TooManyColumns, NoNames, Uneven, TooManyLines, TooManyRows, NotFinite, NotANumber
    ));
    let rows = |count: usize| format!("t,x\n{}", "0,1\n".repeat(count));
    for text in [
        "",
        &"x,".repeat(70),
        "0,1\n1,2",
        "t,x\n1",
        &rows(200_001),
        &rows(20_001),
        "t,x\n0,NaN",
        "t,x\n0,one",
    ] {
        let error = table::read(text).unwrap_err();
        tables.meet(&quoted(text), &error, "", None, "");
    }
    let mut submissions = Refusals::new(variants!(SubmissionError: Unreadable, TooLarge));
    let many: BTreeMap<String, Answer> = (0..201).map(|k| (format!("q{k}"), Answer::default())).collect();
    let many = serde_json::json!({"student": "ada", "answers": many}).to_string();
    for text in ["{", r#"{"answers": {"period": {"valu": 1}}}"#, &" ".repeat(5 << 20), &many] {
        let error = Submission::from_json(text).unwrap_err();
        submissions.meet(&quoted(text), &error, error.code(), None, error.hint());
    }
    all_reviewed(
        "refusals-answers",
        [numbers.text(), units.text(), formulas.text(), tables.text(), submissions.text()],
    );
}

fn engine_error() -> triad_engine::EngineError {
    triad_engine::catalogue::scene("pendulum").unwrap_err().into()
}

fn instance_errors() -> Refusals<InstanceError> {
    // Found while a lesson is prepared; `triad lesson check` tells them with the file.
    let mut instances = Refusals::new(variants!(
        InstanceError: NotPolynomial, SharedDirectors, Singular, NoneConsistent, Relation, MovingFeature, Engine
    ));
    for error in [
        InstanceError::NotPolynomial,
        InstanceError::SharedDirectors,
        InstanceError::Singular,
        InstanceError::NoneConsistent,
        InstanceError::Relation,
        InstanceError::MovingFeature,
        engine_error().into(),
    ] {
        instances.meet("a task of equations", &error, "", None, "");
    }
    instances
}

fn measure_errors() -> Refusals<MeasureError> {
    let mut measures = Refusals::new(variants!(
        MeasureError: Nothing, NoJoint, NoBody, NoSide, NotOfJoint, NoMotion, Engine
    ));
    for error in [
        MeasureError::Nothing,
        MeasureError::NoJoint("pen".to_owned()),
        MeasureError::NoBody("bab".to_owned()),
        MeasureError::NoSide,
        MeasureError::NotOfJoint { body: "bab".to_owned(), joint: "pin".to_owned() },
        MeasureError::NoMotion,
        engine_error().into(),
    ] {
        measures.meet("a measured answer", &error, "", None, "");
    }
    measures
}

#[test]
fn programs_and_figures_that_cannot_be_read() {
    let mut outputs = Refusals::new(variants!(
        OutputError: Json, NoStates, StateCount, Missing, Form, Table, MissingColumn, UnknownPart, OutOfRange, Twice, LineCount,
        NoValue
    ));
    let size =
        OutputSize { states: 2, asks: &[EquationPart::Phi, EquationPart::Jacobian], rows: 2, columns: 3 };
    let csv = |lines: &str| format!("state,part,row,column,value\n{lines}");
    for text in [
        "{".to_owned(),
        r#"{"answer": 1}"#.to_owned(),
        r#"{"states": []}"#.to_owned(),
        r#"{"states": [{"phi": [0, 0], "jacobian": [[0, 0, 0], [0, 0, 0]]}, {"phi": [0, 0]}]}"#.to_owned(),
        r#"{"states": [{"phi": [0]}, {"phi": [0]}]}"#.to_owned(),
        "state,part\n1".to_owned(),
        "state,row,column,value\n1,1,1,0".to_owned(),
        csv("1,psi,1,1,0"),
        csv("7,phi,1,1,0"),
        csv("1,phi,1,1,0\n1,phi,1,1,2"),
        csv("1,phi,1,1,0"),
        csv(""),
    ] {
        let error = program_output::read(&text, &size).map(|_| ()).unwrap_err();
        outputs.meet(&quoted(&text), &error, "", None, "");
    }
    let mut figures = Refusals::new(variants!(FigureError: Malformed, Forbidden, Colour));
    let svg = |inner: &str| format!("<svg viewBox=\"0 0 9 9\">\n{inner}</svg>");
    for text in [
        "<p>".to_owned(),
        "<svg ></svg>".to_owned(),
        svg("<path"),
        svg("<script/>"),
        svg("<path onload=\"x\"/>"),
        svg("<path fill=\"#ffffff\"/>"),
    ] {
        let error = Figure::parse(&text).map(|_| ()).unwrap_err();
        figures.meet(&quoted(&text), &error, "", None, "");
    }
    let (instances, measures) = (instance_errors(), measure_errors());
    all_reviewed("refusals-tasks", [outputs.text(), figures.text(), instances.text(), measures.text()]);
}

/// The files of a course of one lesson, with another text in one of them.
fn course_with(path: &str, from: &str, to: &str) -> Files {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("course/01-generic-rigid-body");
    let mut files =
        Files::from([("course.toml".to_owned(), b"format_version = 1\ntitle = \"x\"\n".to_vec())]);
    for name in ["lesson.toml", "lesson.md", "scene.json", "exercise.toml", "reference/answers.toml"] {
        files.insert(format!("01-generic-rigid-body/{name}"), std::fs::read(folder.join(name)).unwrap());
    }
    let figures = std::fs::read_dir(folder.join("figures")).unwrap();
    for figure in figures.map(|entry| entry.unwrap()) {
        let name = figure.file_name().to_string_lossy().into_owned();
        files.insert(format!("01-generic-rigid-body/figures/{name}"), std::fs::read(figure.path()).unwrap());
    }
    let text = String::from_utf8(files[path].clone()).unwrap();
    assert!(text.contains(from), "{path}: {from}");
    files.insert(path.to_owned(), text.replacen(from, to, 1).into_bytes());
    files
}

/// Submissions of which no verdict comes.
fn grades_met() -> Refusals<GradeError> {
    let mut grades = Refusals::new(variants!(GradeError: UnknownQuestion, NoLongerWanted));
    let course = Course::embedded().unwrap();
    let submission =
        Submission::from_json(r#"{"student": "ada", "answers": {"perod": {"value": "1"}}}"#).unwrap();
    let error = crate::grade(course.lesson("simple-pendulum").unwrap(), &submission).unwrap_err();
    grades.meet("a question that is not there", &error, error.code(), None, "");
    let wanted = Wanted::default();
    wanted.no_longer();
    let lesson = course.lesson("simple-pendulum").unwrap();
    let error =
        crate::grade_while(lesson, &Submission::default(), &crate::Known::default(), &wanted).unwrap_err();
    grades.meet("a verdict that nobody waits for", &error, error.code(), None, "");
    grades
}

#[test]
fn courses_and_lessons_that_cannot_be_read() {
    const EXERCISE: &str = "01-generic-rigid-body/exercise.toml";
    let mut courses = Refusals::new(variants!(CourseError: Unreadable, TooLarge, Head, Twice, Lesson));
    let mut lessons = Refusals::new(variants!(LessonError: Missing, Unreadable, Question));
    let mut meet = |tried: &str, error: CourseError| {
        courses.meet(tried, &error, error.code(), None, "");
        if let CourseError::Lesson(error) = error {
            lessons.meet(tried, &error, error.code(), None, "");
        }
    };
    let error = |files: Files| Course::from_files(files).map(|_| ()).unwrap_err();
    let folder = std::env::temp_dir().join(format!("triad-course-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("course.toml"), "format_version = 1\ntitle = \"x\"\n").unwrap();
    std::fs::File::create(folder.join("film.bin")).unwrap().set_len(5 << 20).unwrap();
    meet("a file of 5 MiB", Course::load(&folder).map(|_| ()).unwrap_err());
    std::fs::remove_dir_all(&folder).unwrap();
    meet(
        "a folder that is not there",
        Course::load(std::path::Path::new("/no/such/folder")).map(|_| ()).unwrap_err(),
    );
    meet("a later format", error(course_with("course.toml", "format_version = 1", "format_version = 2")));
    let twice = course_with("course.toml", "", "")
        .into_iter()
        .flat_map(|(name, bytes)| [(name.replace("01-generic", "01-another"), bytes.clone()), (name, bytes)]);
    meet("two lessons of one number", error(twice.collect()));
    let mut without = course_with("course.toml", "", "");
    without.remove(EXERCISE);
    meet("a lesson without exercise.toml", error(without));
    meet("an unknown key", error(course_with(EXERCISE, "points =", "pionts =")));
    meet("a unit that does not exist", error(course_with(EXERCISE, "unit = \"", "unit = \"furlong")));

    let mut variants_met = Refusals::new(variants!(VariantError: Range, Unusable, NoneFits));
    for (tried, from, to) in [
        (
            "a range without steps",
            "a = { from = 1, to = 2.2, step = 0.2",
            "a = { from = 1, to = 2.2, step = 0",
        ),
        ("a place that is not there", "/bodies/0/angular_velocity/0", "/bodies/9/mass"),
        ("numbers for which the scene does not start", "value = \"a\"", "value = \"1e300*a\""),
    ] {
        let course = Course::from_files(course_with(EXERCISE, from, to)).unwrap();
        let error = course.lessons()[0].variant("ada").unwrap_err();
        variants_met.meet(tried, &error, error.code(), None, "");
    }
    // It leaves the drawing of numbers only as the reason of `NoneFits`.
    let error = VariantError::Unusable {
        what: "scene.json has no number at /bodies/9/mass; correct the pointer".to_owned(),
    };
    variants_met.meet("one draw of them", &error, error.code(), None, "");
    all_reviewed(
        "refusals-lessons",
        [courses.text(), lessons.text(), variants_met.text(), grades_met().text()],
    );
}
