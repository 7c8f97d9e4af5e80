//! Questions that are answered in words and judged by people.

use super::context::{BuildError, build_error, refuse};
use super::question::{Explanation, QuestionBody};
use crate::answers::TypedValue;
use crate::files::{QuestionFile, ReferenceFile};
use crate::text::words;

/// Most words that may be demanded.
const MOST_WORDS: usize = 300;

pub(super) fn explanation(
    question: &QuestionFile,
    reference: &ReferenceFile,
) -> Result<QuestionBody, BuildError> {
    refuse(question.unit.is_some(), "a unit", "explanation")?;
    refuse(question.tolerance.is_some(), "a tolerance", "explanation")?;
    refuse(!question.options.is_empty(), "an option", "explanation")?;
    refuse(!question.misconceptions.is_empty(), "a misconception", "explanation")?;
    let file = question.explanation.as_ref().ok_or_else(|| {
        build_error("it has no table explanation", "add [question.explanation] with purpose and min_words")
    })?;
    if !(1..=MOST_WORDS).contains(&file.min_words) {
        let remedy = format!("write min_words = 20, and at most {MOST_WORDS}");
        return Err(build_error(format!("{} words are demanded", file.min_words), remedy));
    }
    if question.pool.is_some() {
        // Then the points that a program gives would differ from hand to hand.
        return Err(build_error("it is in a pool", "ask it of everybody: no numbers of it can be copied"));
    }
    match &reference.value {
        Some(TypedValue::Text(example)) if words(example) >= file.min_words => {
            Ok(QuestionBody::Explanation(Explanation {
                purpose: file.purpose.clone(),
                min_words: file.min_words,
                example: example.clone(),
            }))
        }
        _ => {
            let remedy = "write a good explanation as value, of as many words as are demanded: it is shown where right answers are";
            Err(build_error("its reference is no such explanation", remedy).in_reference())
        }
    }
}
