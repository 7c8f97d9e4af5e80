//! Free-body diagrams: the reference is what the run shows, and its mistakes are recognised.

use super::findings::Findings;
use super::references::judged;
use crate::answers::Answer;
use crate::answers::diagram::{Arrow, CENTRE, Sense};
use crate::exercise::cut::{Cut, in_words};
use crate::exercise::{Diagram, Question, QuestionBody};
use crate::verdict::Mark;
use crate::verdict::feedback::DiagramSlip;

/// Compares the reference with the run, at the lesson's own numbers.
pub(super) fn agrees(question: &Question, found: &mut Findings) {
    let QuestionBody::Diagram(task) = &question.body else { return };
    let id = question.id.as_str();
    let acting = match Cut::new(task) {
        Ok(cut) => cut.acting(),
        Err(error) => return found.question(id, error, "correct the diagram or its scene"),
    };
    for (arrow, value) in &acting {
        if !task.reference.contains(arrow) {
            let what = format!("the run shows a {}, the reference does not", in_words(arrow, Some(*value)));
            found.question(id, what, "add it to the reference, or ask at another time");
        }
    }
    for arrow in task.reference.iter().filter(|right| !acting.iter().any(|(shown, _)| shown == *right)) {
        let what = format!("the run shows no {}", in_words(arrow, None));
        found.question(id, what, "take it out of the reference, or write it under allowed");
    }
    for allowed in &task.allowed {
        let places = task.bodies.iter().any(|body| task.places(body).contains(&allowed.at.as_str()));
        if !places || !task.shows(allowed.kind, allowed.axis) {
            found.question(
                id,
                format!("the allowed arrow at {} is not in the picture", allowed.at),
                "remove it",
            );
        }
    }
}

/// Tries out what students draw: nothing at a joint, everything on the other side, no weight.
pub(super) fn mistakes(found: &mut Findings, id: &str, task: &Diagram) {
    let turned =
        |arrow: &Arrow| Arrow { along: Sense::of(arrow.along.axis(), -arrow.along.sign()), ..arrow.clone() };
    let at_joint = |arrow: &Arrow| arrow.at != CENTRE;
    let other_side = task.reference.iter().map(|a| if at_joint(a) { turned(a) } else { a.clone() }).collect();
    let no_weight: Vec<Arrow> = task.reference.iter().filter(|a| at_joint(a)).cloned().collect();
    let lacks_weight = no_weight.len() < task.reference.len();
    let cases: [(Vec<Arrow>, DiagramSlip, bool); 2] = [
        (other_side, DiagramSlip::OtherSide, !no_weight.is_empty()),
        (no_weight.clone(), DiagramSlip::WeightMissing, lacks_weight && !no_weight.is_empty()),
    ];
    for (arrows, slip, applies) in cases {
        let answer = Answer { diagram: Some(arrows), ..Answer::default() };
        let Some(given) = judged(found.lesson, id, answer).filter(|_| applies) else { continue };
        if given.mark != Mark::Wrong || given.misconception.as_deref() != Some(slip.code()) {
            let got = given.misconception.unwrap_or_else(|| format!("{:?}", given.mark));
            found.question(id, format!("{} is judged {got}", slip.code()), "correct the reference");
        }
    }
}
