//! Explanations: counted, kept, and judged by people.

use crate::answers::{Answer, TypedValue};
use crate::exercise::Explanation;
use crate::text::words;
use crate::verdict::Mark;
use crate::verdict::feedback::{Feedback, Judgement};
use crate::verdict::invalid::InvalidExplanation;

/// Longest explanation, in characters.
pub(crate) const LONGEST: usize = 10_000;

/// Takes an explanation that is long enough; nothing in it is judged.
pub(super) fn judge(task: &Explanation, answer: &Answer) -> Result<Judgement, InvalidExplanation> {
    let Some(TypedValue::Text(text)) = &answer.value else { return Err(InvalidExplanation::NoText) };
    if text.chars().count() > LONGEST {
        return Err(InvalidExplanation::Long { most: LONGEST });
    }
    let found = words(text);
    if found < task.min_words {
        return Err(InvalidExplanation::Short { found, wanted: task.min_words });
    }
    let feedback = Feedback::Explanation { words: found };
    Ok(Judgement { mark: Mark::Kept, ..Judgement::wrong(0.0, None, feedback) })
}
