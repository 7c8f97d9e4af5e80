//! What is fuzzed: everything that reads what a stranger wrote.
//!
//! Each function takes any bytes and must return: without a panic, in bounded time. What is accepted must also make
//! sense further on. The program that libFuzzer drives and the test that replays the kept corpus call the same functions.

mod requests;

pub use requests::requests;

use std::collections::BTreeMap;

use triad_engine::Scene;
use triad_engine::run::Simulation;
use triad_engine::scene::expression::Expression;
use triad_lessons::Lesson;
use triad_lessons::Submission;
use triad_lessons::answers::number;
use triad_lessons::answers::units::Unit;
use triad_lessons::rendering::markdown;

/// Reads bytes in one way.
pub type FuzzTarget = fn(&[u8]);

/// What can be fuzzed, by name.
pub const TARGETS: [(&str, FuzzTarget); 5] = [
    ("scene", scene),
    ("lesson", lesson),
    ("submission", submission),
    ("answer", answer),
    ("requests", requests),
];

/// Bodies, joints and steps of a scene that is also run.
const SMALL: usize = 6;
/// Steps that a scene which can start must take without a panic.
const STEPS: u64 = 20;

/// A scene: read, written, read again, checked, and if it is small, started and run for a few steps.
///
/// # Panics
///
/// If one of these goes wrong: that is how a target reports.
pub fn scene(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let Ok(scene) = Scene::from_json(text) else { return };
    let again = Scene::from_json(&scene.to_json());
    // JSON has no infinities: what overflowed is written as null.
    assert!(again.is_err() || again.as_ref() == Ok(&scene), "a scene changed on its way through JSON");
    if scene.bodies.len() > SMALL || scene.joints.len() + scene.drivers.len() > 2 * SMALL {
        return;
    }
    match Simulation::new(&scene) {
        Ok(mut run) => {
            run.set_step_limit(STEPS);
            let stopped = run.advance_to(run.duration()).is_err();
            let frame = run.frame();
            let numbers =
                frame.bodies.iter().flat_map(|b| b.position.into_iter().chain(b.u).chain(b.velocity));
            let sound = stopped || numbers.into_iter().all(f64::is_finite);
            assert!(sound, "a run ended well with something that is no number");
            let _ = (run.summary(), run.multipliers(), run.jacobian());
        }
        Err(error) => {
            let _ = (error.to_string(), error.code(), error.hint(), error.pointer());
        }
    }
}

/// A lesson: four files, parted by lines of `---8<---`, in the order lesson.toml, lesson.md, exercise.toml, scene.json.
pub fn lesson(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let names = ["lesson.toml", "lesson.md", "exercise.toml", "scene.json"];
    let files: BTreeMap<String, Vec<u8>> = names
        .into_iter()
        .zip(text.split("---8<---\n"))
        .map(|(name, part)| (name.to_owned(), part.as_bytes().to_vec()))
        .collect();
    if let Ok(lesson) = Lesson::from_files("01-fuzz", files) {
        let _ = serde_json::to_string(&lesson.public_view());
    }
}

/// A submission as the workbench receives it.
pub fn submission(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    match Submission::from_json(text) {
        Ok(submission) => {
            let _ = serde_json::to_string(&submission);
        }
        Err(error) => {
            let _ = (error.to_string(), error.code(), error.hint());
        }
    }
}

/// One typed answer: as a number with a unit, a unit, a formula, and text to be shown.
pub fn answer(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let _ = number::read(text);
    let _ = Unit::parse(text);
    if let Ok(formula) = Expression::parse(text, &["m", "g", "l", "theta"]) {
        let _ = formula.eval(&[1.0, 9.81, 0.5, 0.3]);
    }
    let _ = markdown::render_short(text);
}
