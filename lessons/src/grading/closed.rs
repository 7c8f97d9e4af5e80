//! Questions with options: each option has feedback of its own.

use triad_engine::scene::expression::notation;

use crate::answers::{Answer, TypedValue};
use crate::exercise::ChoiceOption;
use crate::text::shorten;
use crate::verdict::feedback::{Feedback, Judgement};
use crate::verdict::invalid::InvalidClosed;

/// Judges a choice.
pub(crate) fn choice(
    options: &[ChoiceOption],
    right: &str,
    answer: &Answer,
) -> Result<Judgement, InvalidClosed> {
    let text = text(answer).ok_or(InvalidClosed::NoOption)?;
    let id = id(text);
    let option = options.iter().find(|o| o.id.to_lowercase() == id).ok_or_else(|| {
        let known = options.iter().map(|o| o.id.as_str()).collect::<Vec<_>>().join(", ");
        InvalidClosed::UnknownOption { id: shorten(text), known }
    })?;
    if option.id == right {
        return Ok(Judgement::right(Feedback::Right { note: option.reason.clone() }));
    }
    Ok(Judgement::wrong(0.0, Some(&option.id), Feedback::Option { reason: option.reason.clone() }))
}

/// The option that an answer names, in small letters.
pub fn chosen(answer: &Answer) -> Option<String> {
    text(answer).map(id)
}

fn text(answer: &Answer) -> Option<&str> {
    match (&answer.choice, &answer.value) {
        (Some(text), _) | (None, Some(TypedValue::Text(text))) => Some(text),
        _ => None,
    }
}

/// What stands in front of an id, in small letters.
const LEADS: [&str; 6] = ["the answer is", "my answer is", "i choose", "option", "answer", "choice"];

/// The id in `B)`, `(b)`, `**b**` or `option b`, in small letters.
fn id(text: &str) -> String {
    let plain = notation::plain(text).to_lowercase();
    let plain = notation::undecorated(plain.trim_matches('*'));
    let named = LEADS.iter().find_map(|lead| plain.strip_prefix(lead)).unwrap_or(plain);
    named.trim().trim_end_matches([')', '.', ':']).trim().to_owned()
}
