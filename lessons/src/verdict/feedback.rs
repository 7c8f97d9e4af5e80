//! What is said about one answer, as data: numbers, names, and texts of the author in Markdown.

pub(crate) use super::diagram::{DiagramFinding, DiagramSlip};
use super::invalid::{InvalidAnswer, InvalidQuantity};
use super::sent::Mark;
use crate::answers::diagram::Arrow;
use crate::answers::tolerance::ValueShape;
use crate::answers::units::Unit;
use crate::files::EquationPart;
use crate::mistakes::Mistake;
use crate::recognition::quantity::Recognised;
use crate::scenario::measure::MeasureError;

/// How one answer was judged.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Judgement {
    pub mark: Mark,
    /// Share of the points, from 0 to 1.
    pub share: f64,
    /// The misconception that was recognised.
    pub misconception: Option<String>,
    pub feedback: Feedback,
    /// A picture, as SVG that the grader drew.
    pub figure: Option<String>,
}

impl Judgement {
    /// All points.
    pub(crate) fn right(feedback: Feedback) -> Self {
        Self { mark: Mark::Right, share: 1.0, misconception: None, feedback, figure: None }
    }

    /// A share of the points, perhaps none.
    pub(crate) fn wrong(share: f64, misconception: Option<&str>, feedback: Feedback) -> Self {
        let misconception = misconception.map(str::to_owned);
        Self { mark: Mark::Wrong, share, misconception, feedback, figure: None }
    }

    /// The same with the author's words on what is right, where it tells them.
    pub(crate) fn with_note(self, note: &str) -> Self {
        let note = note.to_owned();
        let feedback = match self.feedback {
            Feedback::Right { .. } => Feedback::Right { note },
            Feedback::Model { demands, note: Some(_) } => Feedback::Model { demands, note: Some(note) },
            Feedback::TrajectoryRight { error, .. } => Feedback::TrajectoryRight { error, note },
            Feedback::Tuning(told) => Feedback::Tuning(TuningFeedback { note, ..told }),
            other => other,
        };
        Self { feedback, ..self }
    }

    /// Nothing was filled in.
    pub(crate) fn blank() -> Self {
        Self { mark: Mark::Blank, share: 0.0, misconception: None, feedback: Feedback::Blank, figure: None }
    }

    /// What is not judged as long as another answer cannot be.
    pub(crate) fn waiting() -> Self {
        Self {
            mark: Mark::Waiting,
            share: 0.0,
            misconception: None,
            feedback: Feedback::Waiting,
            figure: None,
        }
    }

    /// Whether it says that the number is right to its few digits.
    pub(crate) fn asks_for_digits(&self) -> bool {
        let Feedback::Invalid(InvalidAnswer::Quantity(why)) = &self.feedback else { return false };
        matches!(why, InvalidQuantity::InsufficientPrecision { .. })
    }

    /// What cannot be judged.
    pub(crate) fn invalid(why: InvalidAnswer) -> Self {
        let feedback = Feedback::Invalid(why);
        Self { mark: Mark::Invalid, share: 0.0, misconception: None, feedback, figure: None }
    }
}

/// What is said about one answer.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Feedback {
    Blank,
    Waiting,
    Invalid(InvalidAnswer),
    /// The right number, option, formula or program, and why it is so.
    Right {
        note: String,
    },
    /// A wrong option, and why it is wrong.
    Option {
        reason: String,
    },
    Formula(FormulaFinding),
    Quantity(QuantityFeedback),
    /// A right step from the student's own wrong answers to these questions, counted from 1.
    FollowThrough {
        questions: Vec<usize>,
    },
    /// A right diagram, with the numbers of the run.
    DiagramRight {
        numbers: Vec<(Arrow, f64)>,
        note: String,
    },
    /// What is wrong with a diagram.
    Diagram {
        slip: DiagramSlip,
        findings: Vec<DiagramFinding>,
    },
    Program {
        parts: Vec<(EquationPart, PartFinding)>,
    },
    /// What a scene was asked to do; the note if it does all of it.
    Model {
        demands: Vec<DemandResult>,
        note: Option<String>,
    },
    /// Relative error of a motion that is close enough.
    TrajectoryRight {
        error: f64,
        note: String,
    },
    /// Relative error of a motion that is not, and its kind.
    Trajectory {
        error: f64,
        finding: MotionFinding,
    },
    Tuning(TuningFeedback),
    /// An explanation that is kept, of so many words.
    Explanation {
        words: usize,
    },
    /// A run with the chosen settings that ends early.
    TuningStopped {
        problem: MeasureError,
    },
}

impl Feedback {
    /// The author's own text on a misconception or an option.
    pub(crate) fn authored(&self) -> Option<&str> {
        match self {
            Self::Option { reason } => Some(reason),
            Self::Formula(FormulaFinding::Misconception { feedback })
            | Self::Quantity(QuantityFeedback {
                number: NumberFinding::Misconception { feedback }, ..
            }) => Some(feedback),
            _ => None,
        }
    }
}

/// What is wrong with a formula.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum FormulaFinding {
    Misconception {
        feedback: String,
    },
    OppositeSign,
    /// A mistake that every question knows.
    Usual(Recognised),
    /// The only symbol that the formula lacks.
    MissingSymbol {
        symbol: String,
    },
    Unknown,
}

/// Number and unit of a wrong answer, judged apart.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct QuantityFeedback {
    pub shape: ValueShape,
    pub number: NumberFinding,
    pub unit: UnitFinding,
}

/// What is wrong with the number.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum NumberFinding {
    Right,
    Misconception {
        feedback: String,
    },
    /// The author's misconception, and another mistake besides.
    MisconceptionAndMore {
        feedback: String,
    },
    OppositeSign,
    PowerOfTen,
    /// A mistake that every question knows.
    Usual(Recognised),
    /// The length of a vector is right, its direction is not.
    Direction {
        frame: Option<String>,
    },
    /// Wrong by no more than the rounding of its digits, where more could not be asked for; or wrong, and of too few to tell why.
    TooCoarse {
        digits: Option<u32>,
    },
    Unknown,
}

/// What is said of the unit.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum UnitFinding {
    /// It fits, and nobody asked for it.
    Given,
    /// It fits, and was part of the question.
    Found,
    Mismatch {
        given: Unit,
        wanted: Unit,
    },
}

/// What a part of the equations from a student's program is like.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum PartFinding {
    Missing,
    Right,
    Misconception {
        id: &'static str,
        feedback: &'static str,
    },
    Size {
        rows: usize,
        columns: usize,
        wanted_rows: usize,
        wanted_columns: usize,
    },
    Off(Discrepancy),
    /// Wrong on the scale of another instance only.
    Unknown,
}

/// Where the first wrong instance is off, in names; never the right number.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Discrepancy {
    /// The instance, from 1, and how many there are.
    pub state: usize,
    pub states: usize,
    /// Wrong entries, and all entries.
    pub entries: usize,
    pub of: usize,
    /// Rows that are off; of accelerations, coordinates.
    pub rows: Vec<String>,
    pub rows_are_coordinates: bool,
    /// Columns that are off; empty if there is one column only.
    pub columns: Vec<String>,
    /// Row owner and body, if all lies in one block.
    pub block: Option<(String, String)>,
    /// −1, 2 or 0 if every wrong entry is that times the right one.
    pub factor: Option<i32>,
}

/// Something that a scene was asked to do.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DemandResult {
    pub demand: Demand,
    pub met: bool,
}

/// What a scene is asked to do, with what it does.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Demand {
    DegreesOfFreedom {
        found: usize,
    },
    /// Joints with redundant rows.
    NoRedundancy {
        joints: Vec<String>,
    },
    /// Joints of one type.
    Joint {
        kind: String,
        found: usize,
    },
    /// A value that is watched: its place among the demands of this kind (from 1), its name, what to look at, and why
    /// the run did not come so far.
    Watch {
        number: usize,
        what: String,
        feedback: String,
        stopped: Option<MeasureError>,
    },
}

impl Demand {
    /// Name of the misconception if it is not met.
    pub(crate) fn misconception(&self) -> String {
        match self {
            Self::DegreesOfFreedom { .. } => "degrees-of-freedom".to_owned(),
            Self::NoRedundancy { .. } => "redundant".to_owned(),
            Self::Joint { kind, .. } => format!("joint-{kind}"),
            Self::Watch { number, .. } => format!("watch-{number}"),
        }
    }
}

/// The kind of error of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum MotionFinding {
    OppositeSign,
    /// A mistake that every table can have.
    Usual(&'static Mistake),
    /// Time by which it is late, s.
    Phase {
        late: f64,
    },
    /// Factor by which its swings are larger.
    Amplitude {
        factor: f64,
    },
    PhaseAndAmplitude {
        late: f64,
        factor: f64,
    },
    Unknown,
}

impl MotionFinding {
    /// Name of the misconception.
    pub(crate) fn misconception(self) -> Option<&'static str> {
        match self {
            Self::OppositeSign => Some("opposite-sign"),
            Self::Usual(mistake) => Some(mistake.code),
            Self::Phase { .. } => Some("phase"),
            Self::Amplitude { .. } => Some("amplitude"),
            Self::PhaseAndAmplitude { .. } => Some("phase-and-amplitude"),
            Self::Unknown => None,
        }
    }
}

/// What a run with chosen settings cost, and how far it was off.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TuningFeedback {
    pub evaluations: u64,
    /// Evaluations that may be spent.
    pub budget: u64,
    /// Evaluations after which the run was given up.
    pub most: u64,
    /// Error at the end; none if the run was given up.
    pub error: Option<f64>,
    /// Error to reach.
    pub allowed: f64,
    /// How far the constraints are violated at the end, and how far they may be, where that is asked.
    pub violation: Option<[f64; 2]>,
    /// Whether Baumgarte's stabilization was chosen.
    pub stabilized: bool,
    /// Why it is right.
    pub note: String,
}

impl TuningFeedback {
    /// Whether error and constraints are as they are asked for.
    pub(crate) fn is_precise(&self) -> bool {
        self.reaches_error() && !self.has_drifted()
    }

    fn reaches_error(&self) -> bool {
        self.error.is_some_and(|error| error <= self.allowed)
    }

    /// Whether the run came to its end with joints that have come apart.
    pub(crate) fn has_drifted(&self) -> bool {
        self.error.is_some() && self.violation.is_some_and(|[seen, allowed]| seen > allowed)
    }

    /// Whether the budget was kept.
    pub(crate) fn is_cheap(&self) -> bool {
        self.evaluations <= self.budget
    }
}
