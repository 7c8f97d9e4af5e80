//! Feedback as HTML: no other module writes it.

use std::fmt::Write as _;

use super::feedback::{
    Demand, DemandResult, DiagramFinding, DiagramSlip, Discrepancy, Feedback, FormulaFinding, MotionFinding,
    NumberFinding, PartFinding, QuantityFeedback, TuningFeedback, UnitFinding,
};
use super::invalid::InvalidQuantity;
use crate::answers::diagram::{Arrow, place_in_words};
use crate::answers::tolerance::ValueShape;
use crate::answers::units::Unit;
use crate::exercise::cut::in_words;
use crate::files::EquationPart;
use crate::recognition::quantity::Recognised;
use crate::rendering::html::escape;
use crate::rendering::markdown::render_short;
use crate::text::{plain, sentence};

/// Names that a message lists.
const MAX_NAMES: usize = 4;

/// What is said, as safe HTML.
pub(crate) fn message(feedback: &Feedback) -> String {
    match feedback {
        Feedback::Blank => paragraph("Not answered."),
        Feedback::Waiting => paragraph("This answer can be read. It is judged when all of them can."),
        Feedback::Invalid(why) => format!("<p>{} No attempt is used.</p>", escape(&why.to_string())),
        Feedback::Right { note } => paragraph("Right.") + &render_short(note),
        Feedback::Option { reason } => paragraph("Not right.") + &render_short(reason),
        Feedback::Formula(finding) => paragraph("Not right.") + &formula(finding),
        Feedback::Quantity(quantity) => self::quantity(quantity),
        Feedback::FollowThrough { questions } => {
            let list = questions.iter().map(ToString::to_string).collect::<Vec<_>>().join(" and ");
            paragraph(&format!(
                "Right with your own answer to question {list}, which is not right: this step is good. When you \
                 correct that one, correct this one too."
            ))
        }
        Feedback::DiagramRight { numbers, note } => diagram_right(numbers, note),
        Feedback::Diagram { slip, findings } => diagram(*slip, findings),
        Feedback::Program { parts } => program(parts),
        Feedback::Model { demands, note } => model(demands, note.as_deref()),
        Feedback::TrajectoryRight { error, note } => {
            format!("<p>Right.</p>{}{}", motion_error(*error), render_short(note))
        }
        Feedback::Trajectory { error, finding } => {
            let what = escape(&motion(*finding));
            format!("<p>Not close enough.</p>{}<p>{what}</p>", motion_error(*error))
        }
        Feedback::Tuning(run) => tuning(run),
        Feedback::Explanation { words } => {
            paragraph(&format!("Your explanation of {words} words is kept. No program judges it."))
        }
        Feedback::TuningStopped { problem } => {
            let problem = escape(&problem.to_string());
            format!("<p>Not yet.</p><p>With these settings the run stops: {problem}.</p>")
        }
    }
}

/// A sentence of our own, without anything that needs an escape.
fn paragraph(text: &str) -> String {
    format!("<p>{text}</p>")
}

/// The numbers of a right diagram.
fn diagram_right(numbers: &[(Arrow, f64)], note: &str) -> String {
    let line = |(arrow, value): &(Arrow, f64)| format!("<li>{}</li>", escape(&in_words(arrow, Some(*value))));
    let lines: String = numbers.iter().map(line).collect();
    format!("<p>Right.</p>{}<p>The run fills in the numbers:</p><ul>{lines}</ul>", render_short(note))
}

/// What is wrong with a diagram: where something is missing, which arrows are wrong.
fn diagram(slip: DiagramSlip, findings: &[DiagramFinding]) -> String {
    let line = |finding: &DiagramFinding| match finding {
        DiagramFinding::Missing(arrow) => {
            let at = escape(&place_in_words(&arrow.at));
            format!("<li>Missing: something at {at} on {}.</li>", escape(&arrow.on))
        }
        DiagramFinding::Opposite(arrow) => {
            format!("<li>Points the wrong way: {}.</li>", escape(&in_words(arrow, None)))
        }
        DiagramFinding::TooMuch(arrow) => format!("<li>Too much: {}.</li>", escape(&in_words(arrow, None))),
    };
    let lines: String = findings.iter().map(line).collect();
    format!("<p>Not right.</p>{}<ul>{lines}</ul>", render_short(slip.advice()))
}

fn formula(finding: &FormulaFinding) -> String {
    match finding {
        FormulaFinding::Misconception { feedback } => render_short(feedback),
        FormulaFinding::OppositeSign => paragraph("The formula is right but for its sign."),
        FormulaFinding::MissingSymbol { symbol } => {
            paragraph(&format!("The answer also depends on {}.", escape(symbol)))
        }
        FormulaFinding::Usual(recognised) => usual(recognised),
        FormulaFinding::Unknown => String::new(),
    }
}

fn quantity(quantity: &QuantityFeedback) -> String {
    let one = quantity.shape == ValueShape::Number;
    let number = match &quantity.number {
        NumberFinding::Right => {
            let numbers = if one { "number is" } else { "numbers are" };
            return paragraph(&format!("The {numbers} right, the unit is not.")) + &unit(&quantity.unit);
        }
        NumberFinding::Misconception { feedback } => render_short(feedback),
        NumberFinding::MisconceptionAndMore { feedback } => {
            render_short(feedback) + &paragraph("Something else is off besides.")
        }
        NumberFinding::OppositeSign if one => paragraph("The size is right, the sign is not."),
        NumberFinding::OppositeSign => {
            paragraph("The size is right, every sign is not: this is the opposite one.")
        }
        NumberFinding::PowerOfTen => {
            paragraph("The digits are right, the power of ten is not: check the units.")
        }
        NumberFinding::Direction { frame } => {
            let frame = escape(frame.as_deref().unwrap_or("the stated frame"));
            paragraph(&format!("The length is right, the direction is not. Components in {frame}?"))
        }
        NumberFinding::Usual(recognised) => usual(recognised),
        NumberFinding::TooCoarse { digits } => {
            paragraph(&InvalidQuantity::InsufficientPrecision { digits: *digits }.to_string())
        }
        NumberFinding::Unknown => String::new(),
    };
    let either = match quantity.unit {
        UnitFinding::Mismatch { .. } => paragraph("The unit does not fit either."),
        UnitFinding::Given | UnitFinding::Found => String::new(),
    };
    format!("<p>Not right.</p>{number}{either}{}", unit(&quantity.unit))
}

/// What to look at after a usual mistake.
fn usual(recognised: &Recognised) -> String {
    let sign = if recognised.and_sign { " Look at the sign as well." } else { "" };
    paragraph(&format!("{}{sign}", escape(recognised.mistake.words)))
}

fn unit(finding: &UnitFinding) -> String {
    match finding {
        UnitFinding::Given => String::new(),
        UnitFinding::Found => paragraph("The unit fits."),
        UnitFinding::Mismatch { given, wanted } => {
            let (is, wanted) = (given.dimension.to_string(), wanted.dimension.to_string());
            let name = unit_name(given);
            format!("<p>{name} is {}; what is asked for is {}.</p>", escape(&is), escape(&wanted))
        }
    }
}

fn unit_name(unit: &Unit) -> String {
    if unit.text().is_empty() { "No unit".to_owned() } else { escape(unit.text()) }
}

fn program(parts: &[(EquationPart, PartFinding)]) -> String {
    let right = parts.iter().filter(|(_, finding)| *finding == PartFinding::Right).count();
    let line = |(part, finding): &(EquationPart, PartFinding)| {
        format!("<li><strong>{}</strong>: {}</li>", part.symbol(), self::part(finding))
    };
    let lines: String = parts.iter().map(line).collect();
    format!("<p>{right} of {} parts are right.</p><ul>{lines}</ul>", parts.len())
}

fn part(finding: &PartFinding) -> String {
    match finding {
        PartFinding::Missing => "not in the file.".to_owned(),
        PartFinding::Right => "right.".to_owned(),
        PartFinding::Misconception { feedback, .. } => render_short(feedback),
        PartFinding::Size { rows, columns, wanted_rows, wanted_columns } => format!(
            "it has {rows} rows and {columns} columns; {wanted_rows} and {wanted_columns} are asked for."
        ),
        PartFinding::Off(off) => format!("{}.", escape(&discrepancy(off))),
        PartFinding::Unknown => String::new(),
    }
}

fn discrepancy(off: &Discrepancy) -> String {
    let mut text = format!(
        "state {} of {}: {} of {} entries are off, in {} {}",
        off.state,
        off.states,
        off.entries,
        off.of,
        if off.rows_are_coordinates { "coordinate" } else { "row" },
        listed(&off.rows)
    );
    if !off.columns.is_empty() {
        text += ", column ";
        text += &listed(&off.columns);
    }
    if let Some((row, body)) = &off.block {
        let _ = write!(text, ": all in the block of {row} and body {body}");
    }
    text += match off.factor {
        Some(-1) => ". They have the right size and the wrong sign",
        Some(2) => ". They are twice as large as they should be",
        Some(0) => ". They are zero where they should not be",
        _ => "",
    };
    text
}

/// Names, a few of them.
fn listed(names: &[String]) -> String {
    let mut list: Vec<&str> = names.iter().take(MAX_NAMES).map(String::as_str).collect();
    if names.len() > MAX_NAMES {
        list.push("…");
    }
    list.join(", ")
}

fn model(demands: &[DemandResult], note: Option<&str>) -> String {
    let lines: String = demands.iter().map(demand).collect();
    let list = format!("<ul class=\"checks\">{lines}</ul>");
    if let Some(note) = note {
        return format!("<p>Right.</p>{list}{}", render_short(note));
    }
    let met = demands.iter().filter(|d| d.met).count();
    format!("<p>{met} of {} demands are met.</p>{list}", demands.len())
}

fn demand(result: &DemandResult) -> String {
    let (what, advice) = match &result.demand {
        Demand::DegreesOfFreedom { found } => (
            "the number of degrees of freedom".to_owned(),
            format!("<p>Your scene has {found}. Count bodies and rows of the joints again.</p>"),
        ),
        Demand::NoRedundancy { joints } => {
            let joints = escape(&joints.join(", "));
            let advice = format!("<p>Rows of these joints say what others say already: {joints}.</p>");
            ("no redundant rows".to_owned(), advice)
        }
        Demand::Joint { kind, found } => {
            (format!("a {kind} joint is used"), format!("<p>Your scene has {found} of this type.</p>"))
        }
        Demand::Watch { what, stopped: Some(problem), .. } => {
            (what.clone(), format!("<p>{}</p>", escape(&sentence(&problem.to_string()))))
        }
        Demand::Watch { what, feedback, stopped: None, .. } => (what.clone(), render_short(feedback)),
    };
    let what = escape(&what);
    if result.met { format!("<li>✓ {what}</li>") } else { format!("<li>✗ {what}{advice}</li>") }
}

fn motion_error(error: f64) -> String {
    paragraph(&format!("The error is {} %.", percent(error)))
}

/// A share in percent, with three significant digits.
fn percent(x: f64) -> String {
    plain(format!("{:.2e}", 100.0 * x).parse().unwrap_or(100.0 * x))
}

fn motion(finding: MotionFinding) -> String {
    let phase = |late: f64| {
        let by = plain(format!("{:.2e}", late.abs()).parse().unwrap_or(0.0));
        format!("it comes {by} s too {}", if late > 0.0 { "late" } else { "early" })
    };
    let amplitude = |factor: f64| {
        let by = percent((factor - 1.0).abs());
        format!("its swings are {by} % too {}", if factor > 1.0 { "large" } else { "small" })
    };
    match finding {
        MotionFinding::OppositeSign => {
            "Every value has the opposite sign: the other direction, or the other side.".to_owned()
        }
        MotionFinding::Usual(mistake) => mistake.words.to_owned(),
        MotionFinding::Phase { late } => format!(
            "The motion has the right form, but {}. An error that grows with time like this comes from the step or \
             the tolerance, a constant one from the start.",
            phase(late)
        ),
        MotionFinding::Amplitude { factor } => format!(
            "The motion has the right rhythm, but {}. Look at the start, at lengths, and at units.",
            amplitude(factor)
        ),
        MotionFinding::PhaseAndAmplitude { late, factor } => {
            format!("Phase and amplitude are both off: {}, and {}.", phase(late), amplitude(factor))
        }
        MotionFinding::Unknown => {
            "Neither a delay nor a factor explains the difference: it is another motion. \
             Compare the first tenth of a second by hand."
                .to_owned()
        }
    }
}

fn tuning(run: &TuningFeedback) -> String {
    let result = run_result(run);
    let advice = match (run.is_precise(), run.is_cheap()) {
        (false, _) if run.has_drifted() => {
            "The joint has come apart: look at what keeps the constraints, not only at the tolerance."
        }
        (true, true) => return format!("<p>Right.</p><p>{result}</p>{}", render_short(&run.note)),
        (true, false) => "You bought more digits than were asked for, or bought them at the wrong place.",
        (false, true) => "There is money left: a tighter tolerance costs little for a method of high order.",
        (false, false) if run.error.is_none() && run.stabilized => {
            "Look at alpha and beta too: the larger they are, the shorter the steps that they ask for."
        }
        (false, false) if run.error.is_none() => {
            "How precise it would have been is not known: with this method every further digit is too dear. Try another one."
        }
        (false, false) => {
            "Both are missed: with this method every further digit is too dear. Try another one."
        }
    };
    format!("<p>Not yet.</p><p>{result}</p><p>{advice}</p>")
}

fn run_result(run: &TuningFeedback) -> String {
    let than = |good: bool| if good { "not more than" } else { "more than" };
    let (most, budget) = (run.most, run.budget);
    let Some(error) = run.error else {
        let times = most.checked_div(budget).unwrap_or_default();
        return format!(
            "The run was stopped after {most} evaluations, {times} times the budget of {budget}."
        );
    };
    let constraints = run.violation.map_or_else(String::new, |[seen, allowed]| {
        let allowed_text = plain(allowed);
        format!(
            "Constraints violated by {seen:.1e}, {} the {allowed_text} that is allowed. ",
            than(seen <= allowed)
        )
    });
    format!(
        "Error {error:.1e}, {} the {} that is allowed. {constraints}{} evaluations, {} the budget of {budget}.",
        than(error <= run.allowed),
        plain(run.allowed),
        run.evaluations,
        than(run.is_cheap()),
    )
}
