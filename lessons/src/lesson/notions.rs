//! Which lesson introduces what, and which builds on it.

use schemars::JsonSchema;
use serde::Serialize;

use super::content::Lesson;
use super::course::Course;
use crate::files::OpensFile;

/// What each lesson of a course introduces and needs, in the course's order.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct NotionGraph {
    /// Title of the course.
    pub title: String,
    /// When the right answer to a question is shown.
    pub opens: OpensFile,
    /// Notions that students bring along.
    pub assumes: Vec<String>,
    /// The lessons in order.
    pub lessons: Vec<NotionNode>,
    /// Lessons that are at hand and not taken.
    pub others: Vec<NotionNode>,
}

/// A lesson in the graph.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct NotionNode {
    /// Slug of the lesson.
    pub slug: String,
    /// Its place.
    pub number: u32,
    /// Its title.
    pub title: String,
    /// Title of the part of the course that it stands in.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part: Option<String>,
    /// How long a student needs, in minutes.
    pub minutes: u32,
    /// Notions that it introduces.
    pub introduces: Vec<String>,
    /// Notions that it builds on.
    pub needs: Vec<Need>,
}

/// A notion that a lesson builds on.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Need {
    /// The notion.
    pub notion: String,
    /// Slug of the lesson that introduces it, taken or not; none if students bring it along, or nothing does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from: Option<String>,
    /// Whether it is known by then: brought along, or introduced by an earlier lesson of the course.
    pub met: bool,
}

impl NotionGraph {
    /// The graph of a course.
    pub fn of(course: &Course) -> Self {
        let node = |lesson: &Lesson| NotionNode {
            slug: lesson.slug.clone(),
            number: lesson.number,
            title: lesson.about.title.clone(),
            part: lesson.part.clone(),
            minutes: lesson.about.minutes,
            introduces: lesson.about.introduces.keys().cloned().collect(),
            needs: lesson.about.needs.iter().map(|notion| need(course, lesson, notion)).collect(),
        };
        Self {
            title: course.title.clone(),
            opens: course.opens,
            assumes: course.assumes.clone(),
            lessons: course.lessons().iter().map(node).collect(),
            others: course.others().iter().map(node).collect(),
        }
    }
}

/// Where a notion comes from, and whether it comes in time.
pub(crate) fn need(course: &Course, lesson: &Lesson, notion: &str) -> Need {
    let introduces = |l: &&Lesson| l.about.introduces.contains_key(notion);
    let earlier = course.lessons().iter().take_while(|l| l.slug != lesson.slug).find(introduces);
    let from = earlier.or_else(|| course.lessons().iter().chain(course.others()).find(introduces));
    let brought = course.assumes.iter().any(|known| known == notion);
    Need { notion: notion.to_owned(), from: from.map(|l| l.slug.clone()), met: brought || earlier.is_some() }
}
