//! Questions with a written answer: units read, expressions evaluated, wrong models run.

use super::{Body, Choice, FormulaBody, Ground, Misconception, Quantity, Trouble, refuse, trouble};
use crate::expression::Expression;
use crate::files::{ProvenanceKind, QuestionFile, ReferenceFile};
use crate::submission::Entry;
use crate::tolerance::{Rule, Shape};
use crate::units::Unit;
use crate::variant::Parameters;
use crate::{measure, slip};

pub(super) fn quantity(
    question: &QuestionFile,
    reference: &ReferenceFile,
    shape: Shape,
    ground: &Ground,
) -> Result<Body, Trouble> {
    let parameters = ground.parameters;
    refuse(!question.options.is_empty(), "an option", "number, vector or matrix")?;
    refuse(!question.symbols.is_empty(), "symbols", "number, vector or matrix")?;
    let unit_text =
        question.unit.as_deref().ok_or_else(|| trouble("it has no unit", "add unit = \"N\", or \"\""))?;
    let unit = Unit::parse(unit_text).map_err(|e| trouble(format!("its unit: {e}"), "correct unit"))?;
    let tolerance = question.tolerance.ok_or_else(|| {
        trouble("it has no tolerance", "add tolerance = { relative = 0.005, absolute = 0 }")
    })?;
    let in_range = |x: f64| (0.0..f64::INFINITY).contains(&x);
    if !in_range(tolerance.relative) || tolerance.relative >= 0.5 || !in_range(tolerance.absolute) {
        return Err(trouble("its tolerance is negative or too large", "keep relative between 0 and 0.5"));
    }
    let rule = Rule { absolute: tolerance.absolute, relative: tolerance.relative };
    if tolerance.exact != rule.is_exact() {
        return Err(trouble(
            "its tolerance is neither exact nor a range",
            "write exact = true, or relative/absolute",
        ));
    }
    if shape != Shape::Number && question.frame.is_none() {
        return Err(trouble("it has no frame", "add frame = \"the ground frame (x, y, z)\""));
    }
    let engine = reference.provenance == ProvenanceKind::Engine;
    let (values, size, error) = match (&reference.value, &reference.measured) {
        (None, Some(measured)) if engine => {
            let found = measure::with_error(&ground.scene_of(None)?, measured);
            let (values, error) =
                found.map_err(|e| trouble(format!("its measurement: {e}"), "correct it").in_reference())?;
            let values: Vec<f64> = values.iter().map(|x| x / unit.factor).collect();
            let size = [values.len(), 1];
            (values, size, error / unit.factor)
        }
        (Some(value), _) if !engine => {
            let (values, size) = numbers(value, shape, parameters).map_err(Trouble::in_reference)?;
            (values, size, reference.error)
        }
        _ => {
            let remedy = "give a value and its source, or provenance = \"engine\" with measured and no value";
            return Err(trouble("its reference has no value, or one too many", remedy).in_reference());
        }
    };
    let mut misconceptions = Vec::with_capacity(question.misconceptions.len());
    for m in &question.misconceptions {
        let (value, own) = match (&m.value, &m.model, &reference.measured) {
            (Some(value), None, _) => numbers(value, shape, parameters)?,
            (None, Some(wrong), Some(measured)) => {
                let found = slip::value(&ground.scene_of(None)?, measured, wrong);
                let found =
                    found.map_err(|e| trouble(format!("misconception {}: {e}", m.id), "correct it"))?;
                let found: Vec<f64> = found.iter().map(|x| x / unit.factor).collect();
                let size = [found.len(), 1];
                (found, size)
            }
            _ => {
                let problem = format!("misconception {} has no value, or a model without measured", m.id);
                return Err(trouble(
                    problem,
                    "give value = …, or model = { slip = … } and measure the reference",
                ));
            }
        };
        if own != size {
            return Err(trouble(
                format!("misconception {} has another size", m.id),
                "give it the reference's",
            ));
        }
        misconceptions.push(Misconception {
            id: m.id.clone(),
            value,
            feedback: parameters.fill(&m.feedback),
            computed: m.model.is_some(),
        });
    }
    Ok(Body::Quantity(Quantity {
        shape,
        size,
        unit,
        asks_unit: question.asks_unit,
        frame: question.frame.clone(),
        rule,
        reference: values,
        error,
        misconceptions,
        follows: question.follows.clone(),
    }))
}

/// Numbers of an author: written out or as an expression in the parameters.
pub(crate) fn numbers(
    entry: &Entry,
    shape: Shape,
    parameters: &Parameters,
) -> Result<(Vec<f64>, [usize; 2]), Trouble> {
    let one = |entry: &Entry| -> Result<f64, Trouble> {
        let value = match entry {
            Entry::Number(x) => *x,
            Entry::Text(text) => parameters
                .eval(text)
                .map_err(|e| trouble(format!("the value \u{201c}{text}\u{201d}: {e}"), "correct it"))?,
            Entry::List(_) => return Err(trouble("a value is nested too deeply", "write one list per row")),
        };
        if value.is_finite() {
            Ok(value)
        } else {
            Err(trouble("a value is not finite", "correct the expression"))
        }
    };
    let row = |entry: &Entry| -> Result<Vec<f64>, Trouble> {
        match entry {
            Entry::List(list) if !list.is_empty() => list.iter().map(one).collect(),
            _ => Err(trouble("a value is not a list", "write value = [1, 2, 3]")),
        }
    };
    match (shape, entry) {
        (Shape::Number, entry) => Ok((vec![one(entry)?], [1, 1])),
        (Shape::Vector, entry) => {
            let values = row(entry)?;
            let size = [values.len(), 1];
            Ok((values, size))
        }
        (Shape::Matrix, Entry::List(rows)) => {
            let rows: Vec<Vec<f64>> = rows.iter().map(row).collect::<Result<_, _>>()?;
            let columns = rows.first().map_or(0, Vec::len);
            if columns == 0 || rows.iter().any(|r| r.len() != columns) {
                return Err(trouble("the rows have different lengths", "write every row in full"));
            }
            Ok((rows.concat(), [rows.len(), columns]))
        }
        (Shape::Matrix, _) => {
            Err(trouble("the value is not a list of rows", "write value = [[1, 0], [0, 1]]"))
        }
    }
}

pub(super) fn choice(question: &QuestionFile, reference: &ReferenceFile) -> Result<Body, Trouble> {
    refuse(question.unit.is_some(), "a unit", "choice")?;
    refuse(question.tolerance.is_some(), "a tolerance", "choice")?;
    refuse(!question.misconceptions.is_empty(), "a misconception (the options have reasons)", "choice")?;
    let options: Vec<Choice> = question
        .options
        .iter()
        .map(|o| Choice { id: o.id.clone(), text: o.text.clone(), reason: o.reason.clone() })
        .collect();
    if options.len() < 2 || options.iter().enumerate().any(|(k, o)| options[..k].iter().any(|p| p.id == o.id))
    {
        return Err(trouble("it has fewer than two options, or two with the same id", "add options a, b, …"));
    }
    match &reference.value {
        Some(Entry::Text(right)) if options.iter().any(|o| o.id == *right) => {
            Ok(Body::Choice { options, right: right.clone() })
        }
        _ => Err(trouble("its reference is not one of its options", "name the right option's id as value")),
    }
}

pub(super) fn formula(question: &QuestionFile, reference: &ReferenceFile) -> Result<Body, Trouble> {
    refuse(question.unit.is_some(), "a unit", "formula")?;
    refuse(question.tolerance.is_some(), "a tolerance", "formula")?;
    refuse(!question.options.is_empty(), "an option", "formula")?;
    let symbols: Vec<String> = question.symbols.keys().cloned().collect();
    let ranges: Vec<[f64; 2]> = question.symbols.values().copied().collect();
    if symbols.is_empty()
        || ranges.iter().any(|[low, high]| !(low.is_finite() && high.is_finite() && low < high))
    {
        return Err(trouble("it has no symbols, or an empty range", "add symbols = { m = [0.5, 2.0] }"));
    }
    let names: Vec<&str> = symbols.iter().map(String::as_str).collect();
    let read = |entry: Option<&Entry>| match entry {
        Some(Entry::Text(text)) => Expression::parse(text, &names)
            .map_err(|e| trouble(format!("\u{201c}{text}\u{201d}: {e}"), "correct it")),
        _ => Err(trouble("a formula is not text", "write value = \"m*g\"")),
    };
    let reference_text = match &reference.value {
        Some(Entry::Text(text)) => text.clone(),
        _ => String::new(),
    };
    let misconceptions = question
        .misconceptions
        .iter()
        .map(|m| Ok((m.id.clone(), read(m.value.as_ref())?, m.feedback.clone())))
        .collect::<Result<_, Trouble>>()?;
    let expression = read(reference.value.as_ref())?;
    Ok(Body::Formula(FormulaBody { symbols, ranges, reference: expression, reference_text, misconceptions }))
}
