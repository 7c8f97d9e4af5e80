//! Whether guessing pays: what can be guessed must not pass a lesson, and nothing about an option may tell that it is right.

use super::findings::{Fault, Findings};
use crate::exercise::{ChoiceOption, Question, QuestionBody};
use crate::lesson::Course;

/// Largest share of the points that choices and counts may have together.
const MOST_GUESSED: f64 = 0.5;
/// How many times as long as the longest wrong option the right one may be.
const LONGER: f64 = 1.1;
/// Shares of a course's choices between which the longest option is the right one: if it never is, that tells as much.
const LONGEST: [f64; 2] = [0.1, 0.5];
/// Choices from which that share is judged.
const ENOUGH: usize = 8;
/// Words that speak of other options, or of places in a list that everybody sees in another order.
const OF_OTHERS: [&str; 12] = [
    "the above",
    "all of these",
    "none of these",
    "all of them",
    "none of them",
    "both of them",
    "option a",
    "option b",
    "option c",
    "option d",
    "the first option",
    "the last option",
];

/// Whether choices and counts alone pass the lesson, or come near to it.
pub(super) fn share(found: &mut Findings) {
    let all = found.lesson.exercise.possible();
    let guessed = found.lesson.exercise.at_most(can_be_guessed);
    if guessed > MOST_GUESSED * all {
        let what = format!("choices and counts have {guessed} of {all} points");
        let remedy = "give at least half of the points to what has to be worked out";
        found.add("exercise.toml", 0, what, remedy);
    }
}

/// Whether somebody who knows nothing can hit upon the answer: an option, or a whole number.
pub(crate) fn can_be_guessed(question: &Question) -> bool {
    match &question.body {
        QuestionBody::Choice { .. } => true,
        QuestionBody::Quantity(q) => q.tolerance.is_exact(),
        _ => false,
    }
}

/// The options of one choice: their lengths, and words about each other.
pub(super) fn options(id: &str, options: &[ChoiceOption], right: &str, found: &mut Findings) {
    for option in options {
        let text = option.text.to_lowercase();
        if let Some(words) = OF_OTHERS.iter().find(|words| text.contains(**words)) {
            let what = format!("option {} says \u{201c}{words}\u{201d}", option.id);
            found.question(id, what, "options are shown in any order: let each stand for itself");
        }
    }
    let (right, wrong) = lengths(options, right);
    if right as f64 > LONGER * wrong as f64 {
        let what = format!("the right option has {right} characters, the longest wrong one {wrong}");
        found.question(id, what, "shorten it or say more in a wrong one: the longest is taken for right");
    }
}

/// Length of the right option and of the longest wrong one, in characters.
pub(crate) fn lengths(options: &[ChoiceOption], right: &str) -> (usize, usize) {
    let length = |o: &ChoiceOption| o.text.chars().count();
    let longest = |is_right: bool| {
        options.iter().filter(|o| (o.id == right) == is_right).map(length).max().unwrap_or_default()
    };
    (longest(true), longest(false))
}

/// Whether the longest option is right too often or too rarely in a whole course.
pub(super) fn longest(course: &Course) -> Option<Fault> {
    let choices: Vec<(usize, usize)> = course
        .lessons()
        .iter()
        .flat_map(|lesson| &lesson.exercise.questions)
        .filter_map(|q| match &q.body {
            QuestionBody::Choice { options, right } => Some(lengths(options, right)),
            _ => None,
        })
        .collect();
    too_telling(&choices)
}

/// The same of choices with the lengths of the right option and of the longest wrong one.
fn too_telling(choices: &[(usize, usize)]) -> Option<Fault> {
    let longest = choices.iter().filter(|(right, wrong)| right > wrong).count();
    let [least, most] = LONGEST.map(|share| share * choices.len() as f64);
    (choices.len() >= ENOUGH && !(least..=most).contains(&(longest as f64))).then(|| Fault {
        file: "course.toml".to_owned(),
        line: 0,
        what: format!("the longest option is the right one in {longest} of {} choices", choices.len()),
        remedy: "let the right option be the longest as often as any other".to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_option_may_be_right_neither_too_often_nor_never() {
        let of = |right: usize, all: usize| {
            let choices: Vec<_> = (0..all).map(|k| if k < right { (40, 38) } else { (38, 40) }).collect();
            too_telling(&choices).map(|fault| fault.what)
        };
        assert_eq!(of(7, 12).as_deref(), Some("the longest option is the right one in 7 of 12 choices"));
        assert_eq!(of(1, 12).as_deref(), Some("the longest option is the right one in 1 of 12 choices"));
        assert_eq!((of(6, 12), of(2, 12)), (None, None));
        assert_eq!(of(7, 7), None, "seven choices tell nothing");
    }
}
