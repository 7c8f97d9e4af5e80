//! Why an answer cannot be judged. Each message says what to do; no attempt is used.

use thiserror::Error;
use triad_engine::EngineError;
use triad_engine::scene::SceneError;

use crate::answers::number::NumberError;
use crate::answers::table::TableError;
use crate::answers::units::UnitError;
use crate::scenario::measure::MeasureError;
use crate::tasks::InstanceError;
use crate::tasks::program_output::OutputError;
use crate::text::{plain, sentence};
use triad_engine::scene::expression::ExpressionError;

/// An answer that cannot be judged, by kind of question.
#[derive(Debug, Clone, PartialEq, Error)]
pub(crate) enum InvalidAnswer {
    #[error(transparent)]
    Quantity(#[from] InvalidQuantity),
    #[error(transparent)]
    Closed(#[from] InvalidClosed),
    #[error(transparent)]
    Diagram(#[from] InvalidDiagram),
    #[error(transparent)]
    Program(#[from] InvalidProgram),
    #[error(transparent)]
    Trajectory(#[from] InvalidTrajectory),
    #[error(transparent)]
    Model(#[from] InvalidModel),
    #[error(transparent)]
    Settings(#[from] InvalidSettings),
    #[error(transparent)]
    Explanation(#[from] InvalidExplanation),
}

/// Numbers, vectors and matrices.
#[derive(Debug, Clone, PartialEq, Error)]
pub(crate) enum InvalidQuantity {
    #[error("This question asks for a value, not for an option.")]
    NoValue,
    #[error("This question asks for one number, not a list.")]
    List,
    #[error("Give {rows} components, such as {}.", example(*rows))]
    Components { rows: usize },
    #[error("Give {rows} rows of {columns} entries, such as [1 0; 0 1] for two rows of two.")]
    Rows { rows: usize, columns: usize },
    #[error("Each row of the matrix has {columns} entries.")]
    RowLength { columns: usize },
    #[error("Entry {entry} is empty; write 0 if it is zero.")]
    Empty { entry: usize },
    #[error("A value is not a finite number.")]
    NotFinite,
    #[error("A list is nested too deeply.")]
    Nested,
    #[error("{}", sentence(&.0.to_string()))]
    Number(#[from] NumberError),
    #[error("{}", sentence(&.0.to_string()))]
    Unit(#[from] UnitError),
    #[error(
        "Only component {entry} has a unit, {unit}; write one behind each, or behind the brackets as in (1, 2, 3) {unit}."
    )]
    UnitOfOne { entry: usize, unit: String },
    #[error("{given} is another kind of quantity; this field is in {wanted}.")]
    OtherUnit { given: String, wanted: String },
    #[error("This asks for a count, which has no unit; leave out {unit}.")]
    Count { unit: String },
    #[error("Hz counts turns per second; this field is in {wanted}. One turn is 2\u{3c0} rad.")]
    Hertz { wanted: String },
    #[error("There are two units, {behind} and {field}; keep one.")]
    TwoUnits { behind: String, field: String },
    #[error("A unit is missing; finding it is part of the question.")]
    NoUnit,
    #[error("mN is millinewton, a force. For newton metre write N m.")]
    Millinewton,
    #[error(
        "With so few digits rounding alone can make an answer wrong; give {}, with zeros where the value is round.",
        .digits.map_or_else(|| "more decimals".to_owned(), |n| format!("at least {n} significant digits"))
    )]
    InsufficientPrecision { digits: Option<u32> },
}

/// A list of so many numbers.
fn example(count: usize) -> String {
    format!("({})", (1..=count).map(|k| k.to_string()).collect::<Vec<_>>().join(", "))
}

/// Options and formulas.
#[derive(Debug, Clone, PartialEq, Error)]
pub(crate) enum InvalidClosed {
    #[error("This question asks for one of its options, not for a value.")]
    NoOption,
    #[error("There is no option \u{201c}{id}\u{201d}; choose one of {known}.")]
    UnknownOption { id: String, known: String },
    #[error("This question asks for a formula, written as text such as 2*m*g.")]
    NoFormula,
    #[error("The formula cannot be read: {0}.")]
    Formula(#[from] ExpressionError),
}

/// Free-body diagrams.
#[derive(Debug, Clone, PartialEq, Error)]
pub(crate) enum InvalidDiagram {
    #[error("This question asks for a diagram: a list of forces and moments.")]
    NoDiagram,
    #[error("There is no body \u{201c}{name}\u{201d} in the picture; the bodies are {known}.")]
    Body { name: String, known: String },
    #[error("There is no point \u{201c}{name}\u{201d} on {on}; its points are {known}.")]
    Place { name: String, on: String, known: String },
    #[error(
        "Forces lie in the plane of the picture, moments turn about the axis out of it; {along} does not fit."
    )]
    OutOfPicture { along: &'static str },
    #[error("At {at} on {on} there are two arrows on one line; keep one.")]
    Twice { at: String, on: String },
    #[error("There are more arrows than a diagram can hold.")]
    TooMany,
    #[error("The scene could not be run: {0}.")]
    Reference(MeasureError),
}

/// What a program sends.
#[derive(Debug, Clone, PartialEq, Error)]
pub(crate) enum InvalidProgram {
    #[error("This question asks for a file, JSON or CSV, that your program writes.")]
    NoFile,
    #[error("The states could not be drawn: {0}.")]
    Instances(InstanceError),
    #[error("The equations could not be written: {0}.")]
    Equations(InstanceError),
    #[error(transparent)]
    Output(#[from] OutputError),
}

/// Tables of a motion.
#[derive(Debug, Clone, PartialEq, Error)]
pub(crate) enum InvalidTrajectory {
    #[error("This question asks for a table (CSV) that your program writes.")]
    NoFile,
    #[error("The reference could not be run: {0}.")]
    Reference(MeasureError),
    #[error(transparent)]
    Table(#[from] TableError),
    #[error("There is no column {name}; the first line names {known}.")]
    NoColumn { name: String, known: String },
    #[error("There are {rows} rows; at least {fewest} are needed.")]
    FewRows { rows: usize, fewest: usize },
    #[error("Times must grow; they do not from {from} to {to} s.")]
    Times { from: f64, to: f64 },
    #[error("The table goes from {first} to {last} s; it must cover 0 to {end} s.")]
    Range { first: f64, last: f64, end: f64 },
    #[error("There is a gap of {} s between two rows; at most {} s.", plain(*.gap), plain(*.most))]
    Gap { gap: f64, most: f64 },
}

/// Scenes.
#[derive(Debug, Clone, PartialEq, Error)]
pub(crate) enum InvalidModel {
    #[error("This question asks for a scene, as the text of its JSON file.")]
    NoFile,
    #[error("The scene cannot be read: {0}.")]
    Scene(#[from] Box<SceneError>),
    #[error("The scene has {bodies} bodies; at most {most} are run here.")]
    Bodies { bodies: usize, most: usize },
    #[error("The scene has {connections} joints, drivers and loads; that is more than is run here.")]
    Connections { connections: usize },
    #[error("The scene is refused: {why}. {hint}", why = .0, hint = .0.hint())]
    Refused(#[from] Box<EngineError>),
    #[error("The author's scene does not run: {0}.")]
    Reference(MeasureError),
}

/// Settings of a run.
#[derive(Debug, Clone, PartialEq, Error)]
pub(crate) enum InvalidSettings {
    #[error("This question asks for settings: an integrator, a tolerance, a stabilization.")]
    NoSettings,
    #[error("There is no choice {integrator}; choose one of {known}.")]
    Integrator { integrator: String, known: String },
    #[error("The tolerance goes from 1e-13 to 0.1.")]
    ToleranceRange,
    #[error("Baumgarte's stabilization is no choice here.")]
    NoBaumgarte,
    #[error("Alpha and beta go up to 10000 1/s.")]
    BaumgarteRange,
    #[error("{what}: {error}.")]
    Number { what: &'static str, error: NumberError },
    #[error("{what} is one number.")]
    List { what: &'static str },
    #[error("{what} is not negative.")]
    Negative { what: &'static str },
    #[error("The reference could not be run: {0}.")]
    Reference(MeasureError),
}

/// Explanations.
#[derive(Debug, Clone, PartialEq, Error)]
pub(crate) enum InvalidExplanation {
    #[error("This question asks for an explanation in words.")]
    NoText,
    #[error("Your explanation has {found} of the {wanted} words that it takes; say why, step by step.")]
    Short { found: usize, wanted: usize },
    #[error("Your explanation has more than {most} characters; say it shorter.")]
    Long { most: usize },
}
