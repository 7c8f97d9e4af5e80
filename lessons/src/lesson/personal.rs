//! What differs from student to student beside the numbers: the description of the scene and the order of options.

use crate::exercise::{ChoiceOption, Exercise, Parameters, QuestionBody};
use crate::random::SeededRandom;

/// Puts the student's numbers into the description of the scene.
pub(super) fn describe(scene: &mut serde_json::Value, description: &str, parameters: &Parameters) {
    if let Some(place) = scene.get_mut("description") {
        *place = parameters.fill(description).into();
    }
}

/// Puts the options of each choice into an order of the student's own; their ids stay.
pub(super) fn shuffle_options(exercise: &mut Exercise, lesson: &str, drawn_from: &str) {
    for question in &mut exercise.questions {
        let QuestionBody::Choice { options, .. } = &mut question.body else { continue };
        // From the author's order, whatever order they were put into before.
        options.sort_by(|a, b| a.id.cmp(&b.id));
        let mut random = SeededRandom::new(&format!("{lesson}/{}/options/{drawn_from}", question.id));
        let mut drawn: Vec<(f64, ChoiceOption)> = options.drain(..).map(|o| (random.unit(), o)).collect();
        drawn.sort_by(|a, b| a.0.total_cmp(&b.0));
        options.extend(drawn.into_iter().map(|(_, option)| option));
    }
}
