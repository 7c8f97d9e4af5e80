//! The right answers, shown when the author says so.

use super::sent::Verdict;
use crate::answers::tolerance::ValueShape;
use crate::exercise::{QuantityQuestion, Question, QuestionBody};
use crate::lesson::Lesson;
use crate::rendering::html::escape;
use crate::rendering::markdown::render_short;
use crate::text::plain;

/// Adds the right answers to a verdict if the author opens them now. `attempts` counts this submission too.
pub fn open(lesson: &Lesson, verdict: &mut Verdict, attempts: usize) {
    let opens = lesson.exercise.opens;
    let enough = opens.attempts.is_some_and(|n| attempts >= n);
    if !verdict.gradable || !(opens.passed && verdict.passed || enough) {
        return;
    }
    for question in &mut verdict.questions {
        question.reference_html = lesson.question(&question.id).and_then(reference);
    }
}

/// The right answer with its source. Work (programs, tables, scenes, settings) has no single right answer.
fn reference(question: &Question) -> Option<String> {
    let answer = match &question.body {
        QuestionBody::Quantity(q) => format!("<p>{}</p>", escape(&written(q))),
        QuestionBody::Choice { options, right } => {
            render_short(&options.iter().find(|o| o.id == *right)?.text)
        }
        QuestionBody::Formula(f) => format!("<p><code>{}</code></p>", escape(&f.reference_text)),
        QuestionBody::Implement(_)
        | QuestionBody::Trajectory(_)
        | QuestionBody::Model(_)
        | QuestionBody::Tuning(_) => return None,
    };
    let why = render_short(&question.right);
    Some(format!("{answer}{why}<p>Source: {}</p>", escape(&question.source)))
}

fn written(q: &QuantityQuestion) -> String {
    let list = |values: &[f64]| {
        let values: Vec<String> = values.iter().map(|x| plain(*x)).collect();
        format!("({})", values.join(", "))
    };
    let value = match q.shape {
        ValueShape::Number => q.reference.first().map(|x| plain(*x)).unwrap_or_default(),
        ValueShape::Vector => list(&q.reference),
        ValueShape::Matrix => {
            let rows: Vec<String> = q.reference.chunks(q.size[1].max(1)).map(list).collect();
            format!("rows {}", rows.join(", "))
        }
    };
    format!("{value} {}", q.unit.text()).trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Course, Submission, grade, reference_submission};

    fn verdict(passed: bool, attempts: usize) -> Verdict {
        let lesson = Course::embedded().unwrap().lesson("spherical-joint").unwrap().clone();
        let submission = if passed { reference_submission(&lesson) } else { Submission::default() };
        let mut verdict = grade(&lesson, &submission).unwrap();
        open(&lesson, &mut verdict, attempts);
        verdict
    }

    #[test]
    fn the_right_answers_open_when_the_author_says_so_and_not_before() {
        let opened = |v: &Verdict| v.questions.iter().filter(|q| q.reference_html.is_some()).count();
        assert_eq!(opened(&verdict(false, 5)), 0);
        let enough = verdict(false, 6);
        assert_eq!(opened(&enough), enough.questions.len());
        let passed = verdict(true, 1);
        assert_eq!(opened(&passed), passed.questions.len());
        // 2 kg at 60 degrees: m g / cos(phi).
        let pull = passed.questions.iter().find(|q| q.id == "pull").unwrap();
        assert!(pull.reference_html.as_ref().unwrap().starts_with("<p>39.24 N</p>"), "{pull:?}");
    }
}
