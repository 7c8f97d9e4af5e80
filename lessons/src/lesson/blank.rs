//! A file of answers to fill in, for students who hand in a file.

use serde_json::{Map, Value, json};

use super::content::Lesson;
use super::view::QuestionView;
use crate::files::QuestionKind;

impl Lesson {
    /// A submission with a place for each answer and nothing in it: handed in as it is, every question is blank.
    pub fn blank_answers(&self) -> Value {
        let questions = self.public_view().exercise.questions;
        let answers: Map<String, Value> = questions.iter().map(|q| (q.id.clone(), blank(q))).collect();
        json!({"student": self.seed, "answers": answers})
    }
}

fn blank(question: &QuestionView) -> Value {
    let [rows, columns] = question.size.unwrap_or([1, 1]);
    let unit = question.unit.clone().unwrap_or_default();
    match question.kind {
        QuestionKind::Number => json!({"value": "", "unit": unit}),
        QuestionKind::Vector => json!({"value": vec![""; rows * columns], "unit": unit}),
        QuestionKind::Matrix => json!({"value": vec![vec![""; columns]; rows], "unit": unit}),
        QuestionKind::Choice => json!({"choice": ""}),
        QuestionKind::Formula | QuestionKind::Explanation => json!({"value": ""}),
        QuestionKind::Diagram => json!({"diagram": []}),
        QuestionKind::Implement | QuestionKind::Trajectory | QuestionKind::Model => json!({"file": ""}),
        QuestionKind::Tuning => {
            let integrator = question.tuning.as_ref().and_then(|tuning| tuning.integrators.first());
            json!({"settings": {"integrator": integrator, "tolerance": ""}})
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Course, Mark, Submission, grade};

    #[test]
    fn what_is_to_be_filled_in_can_be_handed_in_and_is_blank() {
        for lesson in Course::embedded().unwrap().lessons() {
            let lesson = lesson.of_seed("ada").unwrap();
            let text = lesson.blank_answers().to_string();
            let submission = Submission::from_json(&text).unwrap_or_else(|e| panic!("{}: {e}", lesson.slug));
            assert_eq!(submission.answers.len(), lesson.exercise.questions.len(), "{}", lesson.slug);
            let verdict = grade(&lesson, &submission).unwrap();
            assert!(
                verdict.questions.iter().all(|q| q.verdict == Mark::Blank),
                "{}: {verdict:#?}",
                lesson.slug
            );
        }
    }
}
