//! `triad lesson graph`.

use std::collections::BTreeMap;

use triad_lessons::{Course, NotionGraph};

use crate::cli::terminal::{Outcome, print_json, print_line};

/// Tells what each lesson introduces and needs.
pub(in crate::cli) fn graph(course: &Course, dot: bool, json: bool) -> Outcome {
    let graph = NotionGraph::of(course);
    if dot {
        print_line("digraph course {\n  rankdir = LR");
    }
    if json {
        print_json(&graph);
    } else {
        for lesson in &graph.lessons {
            // Lessons that it builds on, each with the notions that come from there.
            let mut from: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
            for need in &lesson.needs {
                let whence = need.from.as_deref().filter(|_| need.met).unwrap_or("nowhere");
                let whence = if need.met && need.from.is_none() { "the students" } else { whence };
                from.entry(whence).or_default().push(&need.notion);
            }
            if dot {
                for (whence, notions) in &from {
                    let label = notions.join(", ");
                    print_line(&format!("  \"{whence}\" -> \"{}\" [label = \"{label}\"]", lesson.slug));
                }
                continue;
            }
            print_line(&format!("{:>2}  {}", lesson.number, lesson.slug));
            if !lesson.introduces.is_empty() {
                print_line(&format!("      introduces {}", lesson.introduces.join(", ")));
            }
            for (whence, notions) in &from {
                print_line(&format!("      needs {} from {whence}", notions.join(", ")));
            }
        }
    }
    if dot {
        print_line("}");
    }
    Outcome::Done
}
