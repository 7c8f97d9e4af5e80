//! The minutes that lessons state, against the rule by which the check estimates them.

use super::course;
use crate::check::minutes::{needed, text};
use crate::check_lesson;

/// A lesson takes at least so many times what it states; that it takes not much more, the check holds.
const AT_LEAST: f64 = 0.55;

#[test]
fn the_minutes_that_lessons_state_are_honest() {
    let mut dishonest = Vec::new();
    let [mut stated, mut estimated] = [0.0; 2];
    println!("lesson                     words  questions  estimated  stated");
    for lesson in course().lessons() {
        let (minutes, says) = (needed(lesson), f64::from(lesson.about.minutes));
        let (words, questions) = (text(lesson)[0], lesson.exercise.questions.len());
        println!("{:26} {words:5.0} {questions:10} {minutes:10.0} {says:7.0}", lesson.folder);
        if !(AT_LEAST..=1.0 / 0.9).contains(&(minutes / says)) {
            dishonest.push(format!("{} states {says} minutes, about {minutes:.0} are needed", lesson.folder));
        }
        stated += says;
        estimated += minutes;
    }
    println!("together {:.1} h estimated, {:.1} h stated", estimated / 60.0, stated / 60.0);
    assert!(dishonest.is_empty(), "{dishonest:#?}");
    assert!((0.85..=1.0).contains(&(estimated / stated)), "{estimated} minutes against {stated}");
}

#[test]
fn a_lesson_that_states_too_few_minutes_is_found() {
    let course = course();
    let mut lesson = course.lesson("ranks").unwrap().clone();
    lesson.about.minutes = 35;
    let found = check_lesson(&course, &lesson);
    let short: Vec<_> = found.iter().filter(|fault| fault.what.contains("it states 35 minutes")).collect();
    assert_eq!((found.len(), short.len()), (1, 1), "{found:?}");
}
