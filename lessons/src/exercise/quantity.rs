//! Questions that are answered by numbers: units read, expressions evaluated, wrong models run.

use super::context::{BuildContext, BuildError, build_error, refuse};
use super::derivation::Derivation;
use super::parameters::Parameters;
use super::question::{Misconception, QuantityQuestion, QuestionBody};
use crate::answers::TypedValue;
use crate::answers::tolerance::{Tolerance, ValueShape};
use crate::answers::units::Unit;
use crate::files::{MisconceptionFile, ProvenanceKind, QuestionFile, ReferenceFile};
use crate::scenario::{measure, wrong_model};

/// A number, vector or matrix with its reference and its misconceptions.
pub(super) fn quantity(
    question: &QuestionFile,
    reference: &ReferenceFile,
    shape: ValueShape,
    context: &BuildContext,
) -> Result<QuestionBody, BuildError> {
    refuse(!question.options.is_empty(), "an option", "number, vector or matrix")?;
    refuse(!question.symbols.is_empty(), "symbols", "number, vector or matrix")?;
    let unit_text =
        question.unit.as_deref().ok_or_else(|| build_error("it has no unit", "add unit = \"N\", or \"\""))?;
    let unit = Unit::parse(unit_text).map_err(|e| build_error(format!("its unit: {e}"), "correct unit"))?;
    let tolerance = tolerance(question)?;
    if shape != ValueShape::Number && question.frame.is_none() {
        return Err(build_error("it has no frame", "add frame = \"the ground frame (x, y, z)\""));
    }
    let form = Form { shape, unit: &unit, context };
    let (values, error) = form.reference(reference)?;
    let misconceptions = question
        .misconceptions
        .iter()
        .map(|m| form.misconception(m, reference, values.size))
        .collect::<Result<_, _>>()?;
    Ok(QuestionBody::Quantity(QuantityQuestion {
        shape,
        size: values.size,
        unit,
        asks_unit: question.asks_unit,
        frame: question.frame.clone(),
        tolerance,
        reference: values.values,
        error,
        misconceptions,
        derivation: Derivation::new(question, reference, context),
        follows: question.follows.clone(),
    }))
}

/// The tolerance of a question: exact, or a range.
fn tolerance(question: &QuestionFile) -> Result<Tolerance, BuildError> {
    let file = question.tolerance.ok_or_else(|| {
        build_error("it has no tolerance", "add tolerance = { relative = 0.005, absolute = 0 }")
    })?;
    let in_range = |x: f64| (0.0..f64::INFINITY).contains(&x);
    if !in_range(file.relative) || file.relative >= 0.5 || !in_range(file.absolute) {
        return Err(build_error("its tolerance is negative or too large", "keep relative between 0 and 0.5"));
    }
    let tolerance = Tolerance { absolute: file.absolute, relative: file.relative };
    if file.exact != tolerance.is_exact() {
        return Err(build_error(
            "its tolerance is neither exact nor a range",
            "write exact = true, or relative/absolute",
        ));
    }
    Ok(tolerance)
}

/// What the values of a question look like, and where they come from.
struct Form<'a> {
    shape: ValueShape,
    unit: &'a Unit,
    context: &'a BuildContext<'a>,
}

/// Values row by row, in the unit of the question, with rows and columns.
pub(crate) struct SizedValues {
    pub(crate) values: Vec<f64>,
    pub(crate) size: [usize; 2],
}

impl Form<'_> {
    /// What was measured in SI units, as a column in the question's unit.
    fn measured(&self, values: &[f64]) -> SizedValues {
        let values: Vec<f64> = values.iter().map(|x| x / self.unit.factor).collect();
        let size = [values.len(), 1];
        SizedValues { values, size }
    }

    /// The reference and a bound on its error: written by the author, or measured by the engine.
    fn reference(&self, reference: &ReferenceFile) -> Result<(SizedValues, f64), BuildError> {
        let engine = reference.provenance == ProvenanceKind::Engine;
        match (&reference.value, &reference.measured) {
            (None, Some(measured)) if engine => {
                let found = measure::with_error(&self.context.scene_of(None)?, measured);
                let (values, error) = found
                    .map_err(|e| build_error(format!("its measurement: {e}"), "correct it").in_reference())?;
                Ok((self.measured(&values), error / self.unit.factor))
            }
            (Some(value), _) if !engine => {
                let values = numbers(value, self.shape, self.context.parameters);
                Ok((values.map_err(BuildError::in_reference)?, reference.error))
            }
            _ => {
                let remedy =
                    "give a value and its source, or provenance = \"engine\" with measured and no value";
                Err(build_error("its reference has no value, or one too many", remedy).in_reference())
            }
        }
    }

    /// A misconception of the reference's size: written by the author, or what a wrong model shows.
    fn misconception(
        &self,
        file: &MisconceptionFile,
        reference: &ReferenceFile,
        size: [usize; 2],
    ) -> Result<Misconception, BuildError> {
        let id = &file.id;
        let parameters = self.context.parameters;
        let found = match (&file.value, &file.model, &reference.measured) {
            (Some(value), None, _) => numbers(value, self.shape, parameters)?,
            (None, Some(wrong), Some(measured)) => {
                let found = wrong_model::value(&self.context.scene_of(None)?, measured, wrong);
                self.measured(
                    &found.map_err(|e| build_error(format!("misconception {id}: {e}"), "correct it"))?,
                )
            }
            _ => {
                return Err(build_error(
                    format!("misconception {id} has no value, or a model without measured"),
                    "give value = …, or model = { slip = … } and measure the reference",
                ));
            }
        };
        if found.size != size {
            return Err(build_error(
                format!("misconception {id} has another size"),
                "give it the reference's",
            ));
        }
        let feedback = parameters.fill(&file.feedback);
        Ok(Misconception { id: id.clone(), value: found.values, feedback, computed: file.model.is_some() })
    }
}

/// Numbers of an author: written out or as an expression in the parameters.
pub(crate) fn numbers(
    entry: &TypedValue,
    shape: ValueShape,
    parameters: &Parameters,
) -> Result<SizedValues, BuildError> {
    let one = |entry: &TypedValue| -> Result<f64, BuildError> {
        let value = match entry {
            TypedValue::Number(x) => *x,
            TypedValue::Text(text) => parameters
                .eval(text)
                .map_err(|e| build_error(format!("the value \u{201c}{text}\u{201d}: {e}"), "correct it"))?,
            TypedValue::List(_) => {
                return Err(build_error("a value is nested too deeply", "write one list per row"));
            }
        };
        if value.is_finite() {
            Ok(value)
        } else {
            Err(build_error("a value is not finite", "correct the expression"))
        }
    };
    let row = |entry: &TypedValue| -> Result<Vec<f64>, BuildError> {
        match entry {
            TypedValue::List(list) if !list.is_empty() => list.iter().map(one).collect(),
            _ => Err(build_error("a value is not a list", "write value = [1, 2, 3]")),
        }
    };
    match (shape, entry) {
        (ValueShape::Number, entry) => Ok(SizedValues { values: vec![one(entry)?], size: [1, 1] }),
        (ValueShape::Vector, entry) => {
            let values = row(entry)?;
            let size = [values.len(), 1];
            Ok(SizedValues { values, size })
        }
        (ValueShape::Matrix, TypedValue::List(rows)) => {
            let rows: Vec<Vec<f64>> = rows.iter().map(row).collect::<Result<_, _>>()?;
            let columns = rows.first().map_or(0, Vec::len);
            if columns == 0 || rows.iter().any(|r| r.len() != columns) {
                return Err(build_error("the rows have different lengths", "write every row in full"));
            }
            Ok(SizedValues { size: [rows.len(), columns], values: rows.concat() })
        }
        (ValueShape::Matrix, _) => {
            Err(build_error("the value is not a list of rows", "write value = [[1, 0], [0, 1]]"))
        }
    }
}
