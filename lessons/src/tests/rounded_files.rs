//! Files as programs print them: six digits are enough where the rule says so, however they are written.

use std::collections::BTreeMap;

use serde_json::Value;

use super::course;
use crate::answers::Answer;
use crate::exercise::QuestionBody;
use crate::{Lesson, Mark, Submission, grade, reference_submission};

/// How a program writes a number.
type Print = fn(f64) -> String;

/// Six digits: `%.6g`, `%.5e`, as C, Python, Octave and Julia print them.
const PRINTED: [(&str, Print); 2] =
    [("%.6g", |x| format!("{}", rounded(x))), ("%.5e", |x| format!("{x:.5e}"))];

fn rounded(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}

/// The file with each of its numbers written anew. Indices, which are whole, stay whole.
fn printed(file: &Value, print: Print) -> String {
    match file {
        Value::Number(x) if x.is_f64() => print(x.as_f64().unwrap_or(f64::NAN)),
        Value::Array(list) => {
            format!("[{}]", list.iter().map(|x| printed(x, print)).collect::<Vec<_>>().join(","))
        }
        Value::Object(map) => {
            let field = |(name, value): (&String, &Value)| format!("{name:?}:{}", printed(value, print));
            format!("{{{}}}", map.iter().map(field).collect::<Vec<_>>().join(","))
        }
        other => other.to_string(),
    }
}

fn mark(lesson: &Lesson, id: &str, file: String) -> Mark {
    let answer = Answer { file: Some(file), ..Answer::default() };
    let answers = BTreeMap::from([(id.to_owned(), answer)]);
    let verdict = grade(lesson, &Submission { answers, ..Submission::default() }).unwrap();
    verdict.questions.into_iter().find(|q| q.id == id).unwrap().verdict
}

#[test]
fn programs_that_print_six_digits_are_right_and_those_that_print_four_are_not() {
    let mut seen = 0;
    for lesson in course().lessons() {
        for seed in ["ada", "grace"] {
            let own = lesson.variant(seed).unwrap();
            let reference = reference_submission(&own).answers;
            for question in &own.exercise.questions {
                let QuestionBody::Implement(_) = &question.body else { continue };
                let text = reference[&question.id].file.clone().unwrap();
                let file: Value = serde_json::from_str(&text).unwrap();
                for (name, print) in PRINTED {
                    let what = format!("{}/{} of {seed} by {name}", own.slug, question.id);
                    assert_eq!(mark(&own, &question.id, printed(&file, print)), Mark::Right, "{what}");
                    seen += 1;
                }
            }
        }
    }
    assert!(seen >= 20, "{seen}");
    let lesson = course();
    let lesson = lesson.lesson("rigid-body-rows").unwrap();
    let text = reference_submission(lesson).answers["program"].file.clone().unwrap();
    let coarse = printed(&serde_json::from_str(&text).unwrap(), |x| format!("{x:.3e}"));
    assert_eq!(mark(lesson, "program", coarse), Mark::Wrong, "four digits tell too little");
}
