//! Comparing a reference with what the scenario shows: the engine measures, the author's source decides.
//!
//! A measurement is no source. It proves that scenario and question speak of the same thing, so that a student who
//! reads the answer off the run is right.

use triad_engine::check::check as engine_check;
use triad_engine::scene::{GROUND, Scene};
use triad_engine::simulation::Simulation;

use super::Found;
use crate::exercise::Body;
use crate::files::{Component, CountKind, MeasuredFile, MotionKind};
use crate::tolerance::norm;

/// Reads the scenario, runs it as far as the questions ask, and compares.
pub(super) fn scene(found: &mut Found) {
    let remedy = "try the scene with `triad check`";
    let scene = match Scene::from_json(&found.lesson.scene.to_string()) {
        Ok(scene) => scene,
        Err(error) => return found.add("scene.json", 0, error.to_string(), "correct the key it names"),
    };
    let mut simulation = match Simulation::new(&scene) {
        Ok(simulation) => simulation,
        Err(error) => return found.add("scene.json", 0, error.to_string(), remedy),
    };
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
        let outcome = measure(&scene, &mut simulation, measured).and_then(|value| compare(found, id, &value));
        if let Err(problem) = outcome {
            found.question(id, problem, "compare measured, value and the scene");
        }
    }
}

fn compare(found: &Found, id: &str, value: &[f64]) -> Result<(), String> {
    let Some(Body::Quantity(quantity)) = found.lesson.question(id).map(|q| &q.body) else {
        return Err("only numbers and vectors can be measured".to_owned());
    };
    let value: Vec<f64> = value.iter().map(|x| x / quantity.unit.factor).collect();
    if value.len() != quantity.reference.len() {
        return Err("what is measured has another size; say component = \"x\" or \"size\"".to_owned());
    }
    let difference = norm(&value.iter().zip(&quantity.reference).map(|(a, b)| a - b).collect::<Vec<_>>());
    let allowed = 0.1 * quantity.rule.allowed(norm(&quantity.reference));
    if difference <= allowed {
        return Ok(());
    }
    Err(format!(
        "the scene shows {value:?}, a tenth of the tolerance is {allowed:e}, the difference {difference:e}"
    ))
}

fn measure(scene: &Scene, simulation: &mut Simulation, measured: &MeasuredFile) -> Result<Vec<f64>, String> {
    let vector = if let Some(count) = measured.count {
        let report = engine_check(scene).map_err(|e| e.to_string())?;
        let n = match count {
            CountKind::DegreesOfFreedom => report.degrees_of_freedom,
            CountKind::Rank => report.rank,
            CountKind::Rows => report.rows,
            CountKind::Coordinates => report.coordinates,
            CountKind::JacobianEntries => simulation.jacobian().entries.len(),
        };
        return Ok(vec![n as f64]);
    } else if measured.energy {
        return Ok(vec![simulation.summary().energy]);
    } else if let Some(joint) = &measured.joint {
        reaction(simulation, joint, measured)?
    } else if let Some(body) = &measured.body {
        motion(scene, simulation, body, measured)?
    } else {
        return Err("measured names neither a count, the energy, a joint nor a body".to_owned());
    };
    Ok(match measured.component {
        None => vector.to_vec(),
        Some(Component::X) => vec![vector[0]],
        Some(Component::Y) => vec![vector[1]],
        Some(Component::Z) => vec![vector[2]],
        Some(Component::Size) => vec![norm(&vector)],
    })
}

/// Force or moment of a joint on the side that is asked for.
fn reaction(simulation: &mut Simulation, joint: &str, measured: &MeasuredFile) -> Result<[f64; 3], String> {
    let all = simulation.multipliers();
    let reaction =
        all.iter().find(|m| m.joint == joint).ok_or_else(|| format!("there is no joint {joint}"))?;
    let (side, vector) = match (&measured.force_on, &measured.moment_on) {
        (Some(side), None) => (side, reaction.force),
        (None, Some(side)) => (side, reaction.moment),
        _ => return Err("a joint is measured by force_on or by moment_on".to_owned()),
    };
    if *side == reaction.on {
        Ok(vector)
    } else if *side == reaction.by || *side == GROUND && reaction.by == GROUND {
        Ok(vector.map(|x| -x))
    } else {
        Err(format!("{side} is not a body of the joint {joint}"))
    }
}

fn motion(
    scene: &Scene,
    simulation: &mut Simulation,
    body: &str,
    measured: &MeasuredFile,
) -> Result<[f64; 3], String> {
    let index = scene.bodies.iter().position(|b| b.name == body);
    let frame = simulation.frame();
    let state = index.and_then(|k| frame.bodies.get(k)).ok_or_else(|| format!("there is no body {body}"))?;
    let [xi, eta, zeta] = measured.point.unwrap_or_default();
    let arm: [f64; 3] = std::array::from_fn(|k| xi * state.u[k] + eta * state.v[k] + zeta * state.w[k]);
    let [a, b, c] = state.angular_velocity;
    let turning = [b * arm[2] - c * arm[1], c * arm[0] - a * arm[2], a * arm[1] - b * arm[0]];
    match measured.motion {
        Some(MotionKind::Position) => Ok(std::array::from_fn(|k| state.position[k] + arm[k])),
        Some(MotionKind::Velocity) => Ok(std::array::from_fn(|k| state.velocity[k] + turning[k])),
        Some(MotionKind::AngularVelocity) => Ok(state.angular_velocity),
        Some(MotionKind::U) => Ok(state.u),
        Some(MotionKind::V) => Ok(state.v),
        Some(MotionKind::W) => Ok(state.w),
        None => {
            Err("a body is measured by its motion: position, velocity, angular-velocity, u, v or w"
                .to_owned())
        }
    }
}
