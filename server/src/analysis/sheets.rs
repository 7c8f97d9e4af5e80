//! The same as tables for other programs.

use super::figures::{Flag, LessonFigures};
use super::question::in_a_line;
use super::work::{Class, Work};
use crate::grades::sheet;
use crate::policy::Moment;
use crate::problem::Problem;

/// The figures of a lesson's questions as CSV, a row for each.
///
/// Errors if it cannot be written, which memory does not do.
pub fn figures_csv(figures: &LessonFigures) -> Result<String, Problem> {
    let head = [
        "Question",
        "Points",
        "Asked",
        "Answered",
        "Right",
        "Facility",
        "Facility of best",
        "Discrimination",
        "Upper less lower",
        "Most frequent mistake",
        "Students",
        "Flags",
    ];
    let number = |value: Option<f64>| value.map(|value| format!("{value:.3}")).unwrap_or_default();
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for one in &figures.questions {
        let worst = one.mistakes.iter().find(|mistake| !mistake.name.is_empty());
        rows.push(vec![
            one.id.clone(),
            one.points.to_string(),
            one.asked.to_string(),
            one.answered.to_string(),
            one.right.to_string(),
            number(one.facility),
            number(one.facility_best),
            number(one.discrimination),
            number(one.upper_less_lower),
            worst.map(|mistake| mistake.name.clone()).unwrap_or_default(),
            worst.map(|mistake| mistake.students.to_string()).unwrap_or_default(),
            one.flags.iter().map(|flag: &Flag| flag.name()).collect::<Vec<_>>().join(" "),
        ]);
    }
    sheet(&rows)
}

/// Every answer to a question as CSV, in the order of the students' names.
///
/// Errors if it cannot be written, which memory does not do.
pub fn answers_csv(class: &Class, question: &str) -> Result<String, Problem> {
    let head = ["Student", "Id", "Handed in", "Answer", "Verdict", "Share of points", "Mistake"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    let none = Vec::new();
    let works: &Vec<Work> = class.questions.get(question).unwrap_or(&none);
    for (work, one) in works.iter().flat_map(|work| work.tries.iter().map(move |one| (work, one))) {
        rows.push(vec![
            work.name.clone(),
            work.person.clone(),
            Moment::to_string(&one.at),
            in_a_line(&one.answer),
            format!("{:?}", one.mark).to_lowercase(),
            one.share.to_string(),
            one.wrong().unwrap_or_default().to_owned(),
        ]);
    }
    sheet(&rows)
}
