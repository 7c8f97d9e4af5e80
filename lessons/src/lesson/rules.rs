//! What counts as right, in words for the student, from the numbers that grade.

use std::fmt::Write as _;

use crate::exercise::{Explanation, Question, QuestionBody, Trajectory, Tuning};
use crate::files::{MeasuredFile, MotionKind, OpensFile};
use crate::text::plain;

/// What counts as right, from what grades.
pub(super) fn rule(question: &Question) -> String {
    match &question.body {
        QuestionBody::Quantity(q) => {
            let shown = if q.asks_unit { "" } else { q.unit.text() };
            let mut rule = q.tolerance.sentence(q.shape, shown, q.frame.as_deref());
            if q.follows.is_some() {
                rule.push_str(" If your earlier answer was wrong, a right step from it still earns a share of the points.");
            }
            rule
        }
        QuestionBody::Choice { .. } => "Choose one option.".to_owned(),
        QuestionBody::Formula(f) => format!(
            "Any form of the right formula counts; it is compared with ours at many points. Symbols: {}.",
            f.symbols.join(", ")
        ),
        QuestionBody::Diagram(d) => format!(
            "Draw every force and moment that acts on {}, each with its point and its sense. What is missing, what is too much \
             and what points the wrong way counts. One arrow for each component; lengths do not matter.",
            d.bodies.join(" and on ")
        ),
        QuestionBody::Implement(i) => {
            let parts = i.asks.iter().map(|p| p.symbol()).collect::<Vec<_>>().join(", ");
            format!(
                "For each of {} states: {parts}. An entry is right if it differs from ours by at most {} of the \
                 largest entry of its part (at least 1). Each part counts the same. JSON or CSV.",
                i.states,
                plain(i.tolerance)
            )
        }
        QuestionBody::Trajectory(t) => trajectory_rule(t),
        QuestionBody::Model(m) => {
            let checks = if m.demands.degrees_of_freedom { "degrees of freedom, " } else { "" };
            format!(
                "The scene is run, up to {} bodies, and judged by what it does: {checks}joints, motion. Any scene \
                 that does the same is right.",
                m.demands.most_bodies
            )
        }
        QuestionBody::Tuning(t) => tuning_rule(t),
        QuestionBody::Explanation(e) => explanation_rule(e),
    }
}

fn trajectory_rule(t: &Trajectory) -> String {
    let bands = t
        .bands
        .iter()
        .map(|b| format!("{} % up to an error of {} %", plain(b.share * 100.0), plain(b.error * 100.0)));
    format!(
        "A table (CSV) from 0 to {} s with a first line of names: t, {}. The error is the root mean square of the \
         difference, relative to that of the motion. Points: {}.",
        plain(t.end),
        t.columns.keys().cloned().collect::<Vec<_>>().join(", "),
        bands.collect::<Vec<_>>().join(", ")
    )
}

fn explanation_rule(e: &Explanation) -> String {
    format!(
        "{} In words, at least {} of them. No program judges it: in a class who teaches reads it and gives the points, \
         beside those that pass the lesson.",
        e.purpose.trim(),
        e.min_words
    )
}

fn tuning_rule(t: &Tuning) -> String {
    let constraints = t.violation.map_or_else(String::new, |violation| {
        format!(", the constraints are violated by at most {}", plain(violation))
    });
    format!(
        "Right if at {} s the error is at most {}{constraints} and at most {} evaluations were used; half the points if it is \
         precise with up to twice as many.",
        plain(t.watch.time),
        plain(t.error),
        t.budget
    )
}

/// When a right answer is shown, in words; or, where verdicts are held back, that none is, and the points are settled all the same.
pub(super) fn opens(opens: OpensFile, held: bool) -> Option<String> {
    let times = |n: usize| if n == 1 { "one answer".to_owned() } else { format!("{n} different answers") };
    let mut when = Vec::new();
    if opens.right {
        when.push(if held { "you have given the right answer" } else { "you have given it" }.to_owned());
    }
    if let Some(n) = opens.attempts {
        when.push(format!("you have tried {}", times(n)));
    }
    let begin = if held {
        "Points are not told at once here, and until they are no right answer is shown. The points of a question are settled all \
         the same when "
    } else {
        "The right answer to a question is shown when "
    };
    let mut text = format!("{begin}{}", when.join(" or when "));
    if let Some(n) = opens.choices {
        let start = if when.is_empty() { "of a choice you have tried" } else { ", of a choice" };
        let _ = write!(text, "{start} {}", times(n));
    }
    text.push_str(if held {
        ". From then on they stay as they are, whatever you hand in, and you are not told of it."
    } else {
        ". From then on its points stay as they are."
    });
    (opens != OpensFile::default()).then_some(text)
}

/// A measurement in words.
pub(super) fn measurement(measured: &MeasuredFile) -> String {
    let component = measured.component.map_or(String::new(), |c| format!("{c:?}").to_lowercase());
    match (&measured.body, &measured.joint) {
        (Some(body), _) => {
            let point = measured.point.map_or(String::new(), |p| {
                format!(" of the point ({}, {}, {}) m", plain(p[0]), plain(p[1]), plain(p[2]))
            });
            let (motion, unit) = match measured.motion {
                Some(MotionKind::Position) => ("position", "m"),
                Some(MotionKind::Velocity) => ("velocity", "m/s"),
                Some(MotionKind::AngularVelocity) => ("angular velocity", "rad/s"),
                Some(MotionKind::U) => ("vector u", "no unit"),
                Some(MotionKind::V) => ("vector v", "no unit"),
                Some(MotionKind::W) => ("vector w", "no unit"),
                None => ("motion", ""),
            };
            format!("{component} of the {motion}{point} of {body}, {unit}")
        }
        (None, Some(joint)) => {
            let side = measured.force_on.as_ref().or(measured.moment_on.as_ref()).map_or("", String::as_str);
            let (what, unit) = if measured.force_on.is_some() { ("force", "N") } else { ("moment", "N m") };
            format!("{component} of the {what} of {joint} on {side}, {unit}")
        }
        _ => "energy, J".to_owned(),
    }
}
