//! Comparing a reference with what the scenario shows: the engine measures, the author's source decides.
//!
//! A measurement is no source. It proves that scenario and question speak of the same thing, so that a student who
//! reads the answer off the run is right: the run must know it, by its own estimate, far better than the question asks. What has no
//! closed form may be computed by the engine; then the error comes from a second run by another method, too.

use thiserror::Error;
use triad_engine::run::Simulation;
use triad_engine::scene::Scene;

use super::again::{OF_TOLERANCE, value_at};
use super::findings::Findings;
use crate::answers::tolerance::{distance, norm};
use crate::exercise::{Formula, QuestionBody, named};
use crate::files::MeasuredFile;
use crate::scenario::measure::{MAX_STEPS, MeasureError, estimated_error, measure};

/// How well a formula agrees with the scene, relative: a tenth of what the tightest question about numbers asks.
const FORMULA: f64 = 1e-4;

/// Reads the scenario, runs it as far as the questions ask, and compares.
pub(super) fn scene(found: &mut Findings) {
    let remedy = "try the scene with `triad check`";
    let scene = match Scene::from_json(&found.lesson.scene.to_string()) {
        Ok(scene) => scene,
        Err(error) => return found.add("scene.json", 0, error.to_string(), "correct the key it names"),
    };
    let mut simulation = match Simulation::new(&scene) {
        Ok(simulation) => simulation,
        Err(error) => return found.add("scene.json", 0, error.to_string(), remedy),
    };
    simulation.set_step_limit(MAX_STEPS);
    let mut wanted: Vec<(&str, &MeasuredFile)> = found
        .lesson
        .exercise
        .questions
        .iter()
        .filter_map(|q| Some((q.id.as_str(), q.measured.as_ref()?)))
        .collect();
    wanted.sort_by(|a, b| a.1.time.total_cmp(&b.1.time));
    for (id, measured) in wanted {
        if let Err(error) = simulation.advance_to(measured.time) {
            return found.add("scene.json", 0, error.to_string(), remedy);
        }
        let outcome = measure(&scene, &simulation, measured)
            .map_err(Disagreement::from)
            .and_then(|value| compare(found, id, &value, estimated_error(&simulation, measured)));
        if let Err(problem) = outcome {
            found.question(id, problem, "compare measured, value and the scene");
        }
    }
}

/// Why what the scenario shows does not prove an answer.
#[derive(Debug, Error)]
enum Disagreement {
    #[error(transparent)]
    Measure(#[from] MeasureError),
    #[error("only numbers, vectors and formulas can be measured")]
    NoQuantity,
    #[error(
        "what its symbols stand for in the scene is not said; write scene = {{ m = \"/bodies/0/mass\" }} for each"
    )]
    NoSymbols,
    #[error("what is measured has another size; say component = \"x\" or \"size\"")]
    Size,
    #[error(
        "the scene shows {value:?}, a tenth of the tolerance is {allowed:e}, the difference {difference:e}"
    )]
    Value { value: Vec<f64>, allowed: f64, difference: f64 },
    #[error(
        "the scene shows it to {error:.0e} by the run's own estimate, a tenth of the tolerance is {allowed:e}"
    )]
    Uncertain { error: f64, allowed: f64 },
}

/// Compares what was measured, in SI units with an error, with the reference.
fn compare(found: &Findings, id: &str, value: &[f64], error: f64) -> Result<(), Disagreement> {
    let quantity = match found.lesson.question(id).map(|q| &q.body) {
        Some(QuestionBody::Quantity(quantity)) => quantity,
        Some(QuestionBody::Formula(formula)) => return compare_formula(found, id, formula, value, error),
        _ => return Err(Disagreement::NoQuantity),
    };
    let value: Vec<f64> = value.iter().map(|x| x / quantity.unit.factor).collect();
    if value.len() != quantity.reference.len() {
        return Err(Disagreement::Size);
    }
    let difference = distance(&value, &quantity.reference);
    let allowed = OF_TOLERANCE * quantity.tolerance.allowed(norm(&quantity.reference));
    let error = error / quantity.unit.factor;
    agree(value, difference, error, allowed)
}

/// Whether a difference, and an error, are no more than is allowed.
fn agree(value: Vec<f64>, difference: f64, error: f64, allowed: f64) -> Result<(), Disagreement> {
    if difference > allowed {
        Err(Disagreement::Value { value, allowed, difference })
    } else if error > allowed {
        Err(Disagreement::Uncertain { error, allowed })
    } else {
        Ok(())
    }
}

/// The same of a formula, with the scene's own numbers in the place of its symbols.
fn compare_formula(
    found: &Findings,
    id: &str,
    formula: &Formula,
    value: &[f64],
    error: f64,
) -> Result<(), Disagreement> {
    let lesson = found.lesson;
    let [value] = value else { return Err(Disagreement::Size) };
    let places = lesson.sources.references.get(id).map(|reference| &reference.scene);
    let at = places.and_then(|places| named::numbers(places, &lesson.scene, &lesson.parameters).ok());
    let expected = at.and_then(|at| value_at(formula, &at)).ok_or(Disagreement::NoSymbols)?;
    let (difference, allowed) = ((value - expected).abs(), FORMULA * expected.abs());
    agree(vec![*value], difference, error, allowed)
}
