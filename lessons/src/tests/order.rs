//! Which lessons a course takes, in which order, and what they need of each other.

use super::course;
use crate::files::{Files, skeleton};
use crate::{Course, NotionGraph, check_lesson};

/// A course with this head and a lesson of its own, `01-own`.
fn own(head: &str) -> Result<Course, String> {
    let mut files = Files::new();
    files.insert("course.toml".to_owned(), format!("format_version = 1\ntitle = \"x\"\n{head}").into_bytes());
    for (name, text) in skeleton::files(1, "own") {
        files.insert(format!("01-own/{name}"), text.replace("TODO", "With care.").into_bytes());
    }
    Course::from_files(files).map_err(|error| error.to_string())
}

fn slugs(course: &Course) -> Vec<&str> {
    course.lessons().iter().map(|lesson| lesson.slug.as_str()).collect()
}

#[test]
fn every_notion_of_the_built_in_course_is_introduced_before_it_is_needed() {
    let graph = NotionGraph::of(&course());
    let needs = graph.lessons.iter().flat_map(|lesson| &lesson.needs);
    let unmet: Vec<_> = needs.clone().filter(|need| !need.met || need.from.is_none()).collect();
    assert!(unmet.is_empty() && needs.count() > 50, "{unmet:?}");
}

#[test]
fn an_instructor_takes_a_subset_in_any_order_and_adds_lessons() {
    let course = own("built_in = true\nlessons = [\"virtual-work\", \"own\", \"simple-pendulum\"]").unwrap();
    assert_eq!(slugs(&course), ["virtual-work", "own", "simple-pendulum"]);
    let pendulum = course.lesson("3").unwrap();
    assert_eq!(pendulum.text.labels[0].0, "3.1");
    // A link to a lesson that is not taken leads there all the same, with the number that it has here.
    let body = course.lesson("generic-rigid-body").unwrap();
    assert!(course.others().iter().any(|other| other.slug == body.slug) && body.number > 3);
    assert!(pendulum.text.html.contains(&format!("/lessons/generic-rigid-body#eq-{}.1", body.number)));
    assert!(check_lesson(&course, course.lesson("own").unwrap()).is_empty());
}

#[test]
fn all_built_in_lessons_are_taken_where_no_order_is_given() {
    let with_own = own("built_in = true").unwrap();
    let mut expected: Vec<String> = course().lessons().iter().map(|l| l.slug.clone()).collect();
    expected.push("own".to_owned());
    assert_eq!(slugs(&with_own), expected);
}

#[test]
fn a_notion_that_comes_too_late_is_told_unless_students_bring_it_along() {
    let faults = |head: &str| {
        let course = own(&format!("built_in = true\nlessons = [\"spherical-joint\"]\n{head}")).unwrap();
        let lesson = &course.lessons()[0];
        check_lesson(&course, lesson).iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    let says = "the notion multiplier is introduced by virtual-work, which does not come before";
    assert!(faults("").iter().any(|fault| fault.contains(says)));
    assert!(!faults("assumes = [\"multiplier\"]").iter().any(|fault| fault.contains(says)));
}

#[test]
fn an_order_that_cannot_be_followed_is_refused() {
    assert!(own("lessons = [\"own\", \"nowhere\"]").unwrap_err().contains("nowhere"));
    assert!(own("lessons = [\"own\", \"own\"]").unwrap_err().contains("own twice"));
}
