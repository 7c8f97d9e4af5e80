//! Questions with options: each option has feedback of its own.

use crate::answers::Answer;
use crate::exercise::ChoiceOption;
use crate::text::shorten;
use crate::verdict::feedback::{Feedback, Judgement};
use crate::verdict::invalid::InvalidClosed;

/// Judges a choice.
pub(super) fn choice(
    options: &[ChoiceOption],
    right: &str,
    answer: &Answer,
) -> Result<Judgement, InvalidClosed> {
    let id = answer.choice.as_deref().map(str::trim).ok_or(InvalidClosed::NoOption)?;
    let option = options.iter().find(|o| o.id == id).ok_or_else(|| {
        let known = options.iter().map(|o| o.id.as_str()).collect::<Vec<_>>().join(", ");
        InvalidClosed::UnknownOption { id: shorten(id), known }
    })?;
    if option.id == right {
        return Ok(Judgement::right(Feedback::Right { note: option.reason.clone() }));
    }
    Ok(Judgement::wrong(0.0, Some(&option.id), Feedback::Option { reason: option.reason.clone() }))
}
