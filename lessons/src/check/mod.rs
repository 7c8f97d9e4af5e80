//! Proving a course: what an author promises is tried out, and every complaint names its place and a remedy.

mod again;
mod answers;
pub(crate) mod copied;
mod diagram;
mod findings;
pub(crate) mod guessing;
mod measured;
pub(crate) mod minutes;
mod notions;
mod predictions;
mod programs;
mod question;
mod references;
mod tasks;
mod texts;
mod tied;
mod variants;

use std::num::NonZero;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use crate::lesson::{Course, Lesson};
use findings::Findings;

pub use answers::wrong_submission;
pub use findings::Fault;
pub use references::reference_submission;

/// Checks a whole course. Empty means proven.
pub fn check_course(course: &Course) -> Vec<Fault> {
    let lessons: Vec<&Lesson> = course.lessons().iter().collect();
    let mut faults = check_course_files(course);
    faults.extend(guessing::longest(course));
    faults.extend(check_lessons(course, &lessons).into_iter().flat_map(|(faults, _)| faults));
    faults
}

/// Checks some lessons of a course on all processors: the faults of each, in the order of the lessons, and how long it took.
pub fn check_lessons(course: &Course, lessons: &[&Lesson]) -> Vec<(Vec<Fault>, Duration)> {
    let next = AtomicUsize::new(0);
    let work = || {
        let mut done = Vec::new();
        while let Some((at, lesson)) =
            Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|k| Some((k, lessons.get(k)?)))
        {
            let begin = Instant::now();
            done.push((at, (check_lesson(course, lesson), begin.elapsed())));
        }
        done
    };
    let threads = thread::available_parallelism().map_or(1, NonZero::get).min(lessons.len().max(1));
    let mut found: Vec<(usize, (Vec<Fault>, Duration))> = thread::scope(|scope| {
        let running: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        running.into_iter().flat_map(|one| one.join().unwrap_or_default()).collect()
    });
    found.sort_by_key(|(at, _)| *at);
    found.into_iter().map(|(_, one)| one).collect()
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

/// What of a lesson's predictions does not come true in its run.
#[cfg(test)]
pub(crate) fn faults_of_predictions(lesson: &Lesson) -> Vec<Fault> {
    let mut found = Findings::new(lesson);
    predictions::happen(&mut found);
    found.faults
}

/// Checks one lesson of a course.
pub fn check_lesson(course: &Course, lesson: &Lesson) -> Vec<Fault> {
    let mut found = Findings::new(lesson);
    texts::about(course, &mut found);
    minutes::honest(&mut found);
    notions::in_order(course, &mut found);
    texts::text(course, &mut found);
    texts::all_placeholders(&mut found);
    texts::stray_files(&mut found);
    texts::unfinished(&mut found);
    measured::scene(&mut found);
    again::all(&mut found);
    tied::all(&mut found);
    predictions::written(course, &mut found);
    predictions::happen(&mut found);
    for question in &lesson.exercise.questions {
        question::itself(question, &mut found);
        tasks::task(question, &mut found);
        diagram::agrees(question, &mut found);
    }
    guessing::share(&mut found);
    answers::blank_fails(&mut found);
    answers::reference_passes(&mut found);
    answers::wrong_answers_fail(&mut found);
    variants::all_fit(&mut found);
    found.faults
}
