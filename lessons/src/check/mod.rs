//! Proving a course: what an author promises is tried out, and every complaint names its place and a remedy.

mod answers;
mod findings;
pub(crate) mod guessing;
mod measured;
mod notions;
mod programs;
mod question;
mod references;
mod tasks;
mod texts;
mod variants;

use crate::lesson::{Course, Lesson};
use findings::Findings;

pub use findings::Fault;
pub use references::reference_submission;

/// Checks a whole course. Empty means proven.
pub fn check_course(course: &Course) -> Vec<Fault> {
    let mut faults = check_course_files(course);
    faults.extend(guessing::longest(course));
    for lesson in course.lessons() {
        faults.extend(check_lesson(course, lesson));
    }
    faults
}

/// Checks that every file of a course belongs to a lesson.
pub fn check_course_files(course: &Course) -> Vec<Fault> {
    let stray = |file: &String| Fault {
        file: file.clone(),
        line: 0,
        what: "it belongs to no lesson".to_owned(),
        remedy: "move it into a lesson or remove it".to_owned(),
    };
    course.stray().iter().map(stray).collect()
}

/// Checks one lesson of a course.
pub fn check_lesson(course: &Course, lesson: &Lesson) -> Vec<Fault> {
    let mut found = Findings::new(lesson);
    texts::about(course, &mut found);
    notions::in_order(course, &mut found);
    texts::text(course, &mut found);
    texts::stray_files(&mut found);
    texts::unfinished(&mut found);
    measured::scene(&mut found);
    for question in &lesson.exercise.questions {
        question::itself(question, &mut found);
        tasks::task(question, &mut found);
    }
    guessing::share(&mut found);
    answers::blank_fails(&mut found);
    answers::reference_passes(&mut found);
    answers::wrong_answers_fail(&mut found);
    variants::all_fit(&mut found);
    found.faults
}
