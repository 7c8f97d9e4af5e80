//! Questions that are answered by an option or by a formula.

use super::context::{BuildError, build_error, refuse};
use super::question::{ChoiceOption, Formula, QuestionBody};
use crate::answers::TypedValue;
use crate::files::{QuestionFile, ReferenceFile};
use triad_engine::scene::expression::Expression;

pub(super) fn choice(question: &QuestionFile, reference: &ReferenceFile) -> Result<QuestionBody, BuildError> {
    refuse(question.unit.is_some(), "a unit", "choice")?;
    refuse(question.tolerance.is_some(), "a tolerance", "choice")?;
    refuse(!question.misconceptions.is_empty(), "a misconception (the options have reasons)", "choice")?;
    let options: Vec<ChoiceOption> = question
        .options
        .iter()
        .map(|o| ChoiceOption { id: o.id.clone(), text: o.text.clone(), reason: o.reason.clone() })
        .collect();
    if options.len() < 2 || options.iter().enumerate().any(|(k, o)| options[..k].iter().any(|p| p.id == o.id))
    {
        return Err(build_error(
            "it has fewer than two options, or two with the same id",
            "add options a, b, …",
        ));
    }
    match &reference.value {
        Some(TypedValue::Text(right)) if options.iter().any(|o| o.id == *right) => {
            Ok(QuestionBody::Choice { options, right: right.clone() })
        }
        _ => {
            Err(build_error("its reference is not one of its options", "name the right option's id as value"))
        }
    }
}

pub(super) fn formula(
    question: &QuestionFile,
    reference: &ReferenceFile,
) -> Result<QuestionBody, BuildError> {
    refuse(question.unit.is_some(), "a unit", "formula")?;
    refuse(question.tolerance.is_some(), "a tolerance", "formula")?;
    refuse(!question.options.is_empty(), "an option", "formula")?;
    let symbols: Vec<String> = question.symbols.keys().cloned().collect();
    let ranges: Vec<[f64; 2]> = question.symbols.values().copied().collect();
    if symbols.is_empty()
        || ranges.iter().any(|[low, high]| !(low.is_finite() && high.is_finite() && low < high))
    {
        return Err(build_error("it has no symbols, or an empty range", "add symbols = { m = [0.5, 2.0] }"));
    }
    let names: Vec<&str> = symbols.iter().map(String::as_str).collect();
    let read = |entry: Option<&TypedValue>| match entry {
        Some(TypedValue::Text(text)) => Expression::parse(text, &names)
            .map_err(|e| build_error(format!("\u{201c}{text}\u{201d}: {e}"), "correct it")),
        _ => Err(build_error("a formula is not text", "write value = \"m*g\"")),
    };
    let reference_text = match &reference.value {
        Some(TypedValue::Text(text)) => text.clone(),
        _ => String::new(),
    };
    let misconceptions = question
        .misconceptions
        .iter()
        .map(|m| Ok((m.id.clone(), read(m.value.as_ref())?, m.feedback.clone())))
        .collect::<Result<_, BuildError>>()?;
    let expression = read(reference.value.as_ref())?;
    Ok(QuestionBody::Formula(Formula {
        symbols,
        ranges,
        reference: expression,
        reference_text,
        misconceptions,
    }))
}
