//! What everybody handed in as far as grades go by it, and what people decided about it.

use std::collections::HashMap;

use crate::policy::{Handed, Moment};
use crate::store::error::StoreError;
use crate::store::log::{self, Event};
use crate::store::rulings;
use crate::store::{Store, identifier, now, sql};

use super::assignments::ensured;
use super::members::known;

/// What somebody handed in to a lesson.
#[derive(Debug, Clone, PartialEq)]
pub struct HandedRow {
    /// The person's id.
    pub person: String,
    /// Slug of the lesson.
    pub lesson: String,
    /// When it came and what it earned, by the verdict in force.
    pub handed: Handed,
    /// Points that could be earned by it.
    pub possible: f64,
    /// The lesson that gave it; empty where it was not kept.
    pub lesson_sha256: String,
}

/// What kind of thing is said about somebody's work in a lesson.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DecisionKind {
    /// Which points count.
    Points,
    /// Which points an explanation gets, with a remark on it.
    Mark,
    /// A remark of somebody who teaches.
    Comment,
    /// The student asks to look again; whatever somebody who teaches says later answers it.
    Request,
}

impl DecisionKind {
    /// The word for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Points => "points",
            Self::Mark => "mark",
            Self::Comment => "comment",
            Self::Request => "request",
        }
    }

    fn named(name: &str) -> Self {
        [Self::Mark, Self::Comment, Self::Request]
            .into_iter()
            .find(|kind| kind.name() == name)
            .unwrap_or(Self::Points)
    }
}

/// What somebody decided or said about a person's work in a lesson; of points later decisions replace earlier ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Decision {
    /// The person whom it is about.
    pub person: String,
    /// Slug of the lesson.
    pub lesson: String,
    /// Of which kind.
    pub kind: DecisionKind,
    /// The question that it is about; `None`: the whole lesson.
    pub question: Option<String>,
    /// The points that count instead; `None`: those that were earned, and of an explanation that it waits again.
    pub points: Option<f64>,
    /// Why, or what is said.
    pub reason: String,
    /// Name of who decided.
    pub by: String,
    /// When.
    pub at: Moment,
}

/// What is decided or said.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Said<'a> {
    /// Of which kind.
    pub kind: DecisionKind,
    /// The question that it is about; `None`: the whole lesson.
    pub question: Option<&'a str>,
    /// The points that count instead; `None` takes an earlier decision back.
    pub points: Option<f64>,
    /// Why, or what is said.
    pub text: &'a str,
}

impl<'a> Said<'a> {
    /// Something said about the whole lesson, which decides nothing.
    pub fn words(kind: DecisionKind, text: &'a str) -> Self {
        Self { kind, question: None, points: None, text }
    }

    /// Which points count in the whole lesson.
    pub fn points(points: Option<f64>, reason: &'a str) -> Self {
        Self { kind: DecisionKind::Points, question: None, points, text: reason }
    }
}

impl Store {
    /// What was handed in, as far as grades go by it: all of a course, or of one person or lesson.
    ///
    /// Errors if the file cannot be read.
    pub async fn handed(
        &self,
        course: &str,
        person: Option<&str>,
        lesson: Option<&str>,
    ) -> Result<Vec<HandedRow>, StoreError> {
        type Row = (String, String, String, i64, i64, i64, f64, f64, String);
        let list = sqlx::query_as(person.map_or(sql::HANDED, |_| sql::HANDED_OF))
            .bind(course)
            .bind(person)
            .bind(lesson);
        let rows: Vec<Row> = list.fetch_all(&self.pools.readers).await?;
        let read = |(person, lesson, id, n, at, judged, earned, possible, lesson_sha256): Row| {
            let handed = Handed { id, n, at: Moment(at), judged: judged == 1, earned, pass: None };
            HandedRow { person, lesson, handed, possible, lesson_sha256 }
        };
        Ok(rows.into_iter().map(read).collect())
    }

    /// How many people have handed in something, by lesson.
    ///
    /// Errors if the file cannot be read.
    pub async fn handed_by(&self, course: &str) -> Result<HashMap<String, usize>, StoreError> {
        let count = sqlx::query_as(sql::HANDED_BY).bind(course);
        let rows: Vec<(String, i64)> = count.fetch_all(&self.pools.readers).await?;
        Ok(rows.into_iter().map(|(lesson, people)| (lesson, usize::try_from(people).unwrap_or(0))).collect())
    }

    /// The decisions of a course, or of those about one person or lesson, in the order in which they were made.
    ///
    /// Errors if the file cannot be read.
    pub async fn decisions(
        &self,
        course: &str,
        person: Option<&str>,
        lesson: Option<&str>,
    ) -> Result<Vec<Decision>, StoreError> {
        type Row = (String, String, String, Option<String>, Option<f64>, String, String, i64);
        let list = sqlx::query_as(sql::DECISIONS).bind(course).bind(person).bind(lesson);
        let rows: Vec<Row> = list.fetch_all(&self.pools.readers).await?;
        let read = |(person, lesson, kind, question, points, reason, by, at): Row| Decision {
            person,
            lesson,
            kind: DecisionKind::named(&kind),
            question,
            points,
            reason,
            by,
            at: Moment(at),
        };
        Ok(rows.into_iter().map(read).collect())
    }

    /// Writes down what somebody decided or said.
    ///
    /// Errors if there is no such person or it cannot be written.
    pub async fn decide(
        &self,
        course: &str,
        actor: &str,
        person: &str,
        lesson: &str,
        said: Said<'_>,
    ) -> Result<(), StoreError> {
        let Said { kind, question, points, text } = said;
        let at = now();
        let mut transaction = self.write().await?;
        let detail = rulings::decision(lesson, kind.name(), points, text, question).to_string();
        let event = Event { actor, what: rulings::DECIDED, subject: person, detail: &detail };
        let n = log::append(&mut transaction, course, at, &event).await?;
        known(&mut transaction, course, person).await?;
        let assignment = ensured(&mut transaction, course, lesson).await?.id;
        // Not kept prepared: without points the driver declares a number of four bytes to PostgreSQL, and the next
        // decision's eight would be refused.
        let add = sqlx::query(sql::ADD_DECISION).persistent(false);
        let add = add.bind(identifier()).bind(course).bind(n).bind(kind.name());
        let add =
            add.bind(person).bind(assignment).bind(question).bind(points).bind(text).bind(actor).bind(at);
        add.execute(&mut *transaction).await?;
        transaction.commit().await
    }
}
