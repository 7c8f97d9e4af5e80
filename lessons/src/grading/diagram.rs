//! A free-body diagram, compared arrow by arrow.

use crate::answers::Answer;
use crate::answers::diagram::{Arrow, ArrowKind, CENTRE, MAX_ARROWS};
use crate::exercise::Diagram;
use crate::exercise::cut::Cut;
use crate::text::shorten;
use crate::verdict::feedback::{DiagramFinding, DiagramSlip, Feedback, Judgement};
use crate::verdict::invalid::InvalidDiagram;

/// Judges a diagram.
pub(super) fn judge(task: &Diagram, note: &str, answer: &Answer) -> Result<Judgement, InvalidDiagram> {
    let arrows = answer.diagram.as_ref().ok_or(InvalidDiagram::NoDiagram)?;
    readable(task, arrows)?;
    let findings = findings(task, arrows);
    if findings.is_empty() {
        let cut = Cut::new(task).map_err(InvalidDiagram::Reference)?;
        let numbers = cut.acting();
        let figure = Some(cut.svg(&numbers));
        let note = note.to_owned();
        return Ok(Judgement { figure, ..Judgement::right(Feedback::DiagramRight { numbers, note }) });
    }
    let wanted = task.reference.len();
    let bad = |f: &&DiagramFinding| !matches!(f, DiagramFinding::TooMuch(_));
    let hits = wanted - findings.iter().filter(bad).count();
    let extra = findings.len() - findings.iter().filter(bad).count();
    let share = hits.saturating_sub(extra) as f64 / wanted as f64;
    let slip = slip(task, arrows, &findings);
    Ok(Judgement::wrong(share, Some(slip.code()), Feedback::Diagram { slip, findings }))
}

/// Whether every arrow can be drawn, and is drawn once.
fn readable(task: &Diagram, arrows: &[Arrow]) -> Result<(), InvalidDiagram> {
    if arrows.len() > MAX_ARROWS {
        return Err(InvalidDiagram::TooMany);
    }
    for (k, arrow) in arrows.iter().enumerate() {
        if !task.bodies.contains(&arrow.on) {
            let known = task.bodies.join(", ");
            return Err(InvalidDiagram::Body { name: shorten(&arrow.on), known });
        }
        let places = task.places(&arrow.on);
        if !places.contains(&arrow.at.as_str()) {
            let (name, on, known) = (shorten(&arrow.at), arrow.on.clone(), places.join(", "));
            return Err(InvalidDiagram::Place { name, on, known });
        }
        if !task.shows(arrow.kind, arrow.along.axis()) {
            return Err(InvalidDiagram::OutOfPicture { along: arrow.along.text() });
        }
        if arrows[..k].iter().any(|other| same_line(other, arrow)) {
            return Err(InvalidDiagram::Twice { at: arrow.at.clone(), on: arrow.on.clone() });
        }
    }
    Ok(())
}

/// Whether two arrows differ in their sense at most.
fn same_line(a: &Arrow, b: &Arrow) -> bool {
    (a.kind, &a.at, &a.on, a.along.axis()) == (b.kind, &b.at, &b.on, b.along.axis())
}

/// Whether two arrows are drawn alike on two bodies.
fn same_way(a: &Arrow, b: &Arrow) -> bool {
    (a.kind, &a.at, a.along) == (b.kind, &b.at, b.along) && a.on != b.on
}

/// What is missing, points the wrong way, or is too much.
fn findings(task: &Diagram, arrows: &[Arrow]) -> Vec<DiagramFinding> {
    let mut findings = Vec::new();
    for right in &task.reference {
        match arrows.iter().find(|arrow| same_line(arrow, right)) {
            None => findings.push(DiagramFinding::Missing(right.clone())),
            Some(given) if given.along != right.along => {
                findings.push(DiagramFinding::Opposite(given.clone()));
            }
            Some(_) => {}
        }
    }
    let known = |given: &Arrow| task.reference.iter().any(|right| same_line(given, right));
    let strange = arrows.iter().filter(|given| !known(given) && !task.allows(given));
    findings.extend(strange.cloned().map(DiagramFinding::TooMuch));
    // What is cut at a joint acts on the two bodies in opposite directions, also where nothing has to act.
    let again = |(k, given): &(usize, &Arrow)| {
        task.allows(given) && !known(given) && arrows[..*k].iter().any(|other| same_way(other, given))
    };
    findings.extend(
        arrows.iter().enumerate().filter(again).map(|(_, arrow)| DiagramFinding::TooMuch(arrow.clone())),
    );
    findings
}

/// The mistake behind the findings.
fn slip(task: &Diagram, arrows: &[Arrow], findings: &[DiagramFinding]) -> DiagramSlip {
    let at_joint = |arrow: &Arrow| arrow.at != CENTRE;
    let pushed_together =
        arrows.iter().filter(|a| at_joint(a)).any(|a| arrows.iter().any(|b| same_way(a, b)));
    let joints = task.reference.iter().filter(|arrow| at_joint(arrow)).count();
    let turned = |f: &DiagramFinding| matches!(f, DiagramFinding::Opposite(arrow) if at_joint(arrow));
    let missing_weight = |f: &DiagramFinding| matches!(f, DiagramFinding::Missing(arrow) if !at_joint(arrow));
    let at_centre = |f: &DiagramFinding| matches!(f, DiagramFinding::TooMuch(arrow) if !at_joint(arrow));
    let moment = |f: &DiagramFinding| matches!(f, DiagramFinding::TooMuch(arrow) if at_joint(arrow) && arrow.kind == ArrowKind::Moment);
    let elsewhere = findings.iter().any(|f| match f {
        DiagramFinding::TooMuch(given) => findings.iter().any(|other| match other {
            DiagramFinding::Missing(right) => {
                (given.kind, given.along, &given.on) == (right.kind, right.along, &right.on)
            }
            _ => false,
        }),
        _ => false,
    });
    if pushed_together {
        DiagramSlip::ActionReaction
    } else if joints > 0 && findings.len() == joints && findings.iter().all(turned) {
        DiagramSlip::OtherSide
    } else if elsewhere {
        DiagramSlip::WrongPoint
    } else if findings.iter().any(missing_weight) {
        DiagramSlip::WeightMissing
    } else if findings.iter().any(at_centre) {
        DiagramSlip::InertiaForce
    } else if findings.iter().any(moment) {
        DiagramSlip::MomentNotCarried
    } else if findings.iter().any(|f| matches!(f, DiagramFinding::TooMuch(_))) {
        DiagramSlip::TooMuch
    } else if findings.iter().any(|f| matches!(f, DiagramFinding::Missing(_))) {
        DiagramSlip::Missing
    } else {
        DiagramSlip::WrongWay
    }
}
