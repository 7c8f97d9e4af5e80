//! What people set, allow and decide, as the log says it, and whether that is what stands in the tables.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Value, json};
use sqlx::AnyConnection;

use super::error::StoreError;
use super::log::Event;
use super::sql;
use crate::policy::Moment;

/// The verb of an entry about a policy.
pub(super) const SET_POLICY: &str = "set the policy of";
/// The verb of an entry about results that are told from then on.
pub(super) const RELEASED: &str = "released";
/// The verb of an entry that takes a release back.
pub(super) const HELD_BACK: &str = "held back";
/// The verb of an entry about an extension.
pub(super) const EXTENDED: &str = "extended";
/// The verb of an entry that takes an extension back.
pub(super) const TOOK_BACK: &str = "took back the extension of";
/// The verb of an entry about a decision.
pub(super) const DECIDED: &str = "decided about";

/// What the log says of an extension; `None` of one that was taken back.
pub(super) fn extension(lesson: &str, given: Option<(Option<Moment>, i64, &str)>) -> Value {
    let given = given.map(|(until, attempts, reason)| (lesson, until, attempts, reason));
    json!([lesson, given])
}

/// What the log says of a decision.
pub(super) fn decision(
    lesson: &str,
    kind: &str,
    points: Option<f64>,
    text: &str,
    question: Option<&str>,
) -> Value {
    match question {
        None => json!([lesson, kind, points, text]),
        Some(question) => json!([lesson, kind, points, text, question]),
    }
}

/// What holds by the entries of a log.
#[derive(Debug, Default)]
pub(super) struct Rulings {
    /// Policies, by lesson.
    policies: BTreeMap<String, String>,
    /// When results were released, by lesson.
    released: BTreeMap<String, i64>,
    /// Extensions with who gave them and when, by lesson and person.
    extensions: BTreeMap<(String, String), Value>,
    /// Decisions with whom they are about, who made them and when, by their place in the log.
    decisions: BTreeMap<i64, Value>,
}

impl Rulings {
    /// Takes the next entry of the log.
    pub(super) fn take(&mut self, n: i64, at: i64, event: &Event<'_>) {
        let Event { actor, what, subject, detail } = *event;
        let subject = subject.to_owned();
        match what {
            SET_POLICY => drop(self.policies.insert(subject, detail.to_owned())),
            // As format 2 said it: the migration from there writes it so.
            "bounded" => {
                let most = detail.strip_suffix(" attempts").and_then(|most| most.parse::<i64>().ok());
                let policy = most.map_or(json!({}), |most| json!({"most_attempts": most}));
                self.policies.insert(subject, policy.to_string());
            }
            RELEASED => drop(self.released.insert(subject, at)),
            HELD_BACK => drop(self.released.remove(&subject)),
            EXTENDED | TOOK_BACK => {
                let detail = read(detail);
                let place = (detail[0].as_str().unwrap_or_default().to_owned(), subject);
                self.extensions.remove(&place);
                if what == EXTENDED {
                    self.extensions.insert(place, json!([detail, actor, at]));
                }
            }
            DECIDED => {
                let mut detail = read(detail);
                // Format 2 knew one kind.
                if let Some([lesson, points, reason]) = detail.as_array().map(Vec::as_slice) {
                    detail = json!([lesson, "points", points, reason]);
                }
                self.decisions.insert(n, json!([subject, detail, actor, at]));
            }
            _ => {}
        }
    }

    /// Sentences about what stands in the tables otherwise.
    pub(super) async fn faults(
        &self,
        connection: &mut AnyConnection,
        course: &str,
    ) -> Result<Vec<String>, StoreError> {
        let mut found = self.wrong_assignments(connection, course).await?;
        let extensions = extensions(connection, course).await?;
        for (lesson, person) in differing(&self.extensions, &extensions) {
            found.push(format!("the extension of {person} for {lesson} is not the one that was logged"));
        }
        let decisions = decisions(connection, course).await?;
        for n in differing(&self.decisions, &decisions) {
            let about = self.decisions.get(n).or(decisions.get(n)).unwrap_or(&Value::Null);
            let (person, lesson) = (about[0].as_str(), about[1][0].as_str());
            found.push(format!(
                "the decision about {} in {} is not the one of entry {n} of the log",
                person.unwrap_or_default(),
                lesson.unwrap_or_default()
            ));
        }
        Ok(found)
    }

    async fn wrong_assignments(
        &self,
        connection: &mut AnyConnection,
        course: &str,
    ) -> Result<Vec<String>, StoreError> {
        let rows: Vec<(String, String, String, Option<i64>)> =
            sqlx::query_as(sql::ASSIGNMENTS).bind(course).fetch_all(connection).await?;
        let mut found = Vec::new();
        for (_, lesson, policy, released) in &rows {
            if self.policies.get(lesson).map_or("{}", String::as_str) != policy {
                found.push(format!("the policy of {lesson} is not the one that was logged"));
            }
            if self.released.get(lesson) != released.as_ref() {
                found.push(format!("the results of {lesson} are not released as it was logged"));
            }
        }
        let there: BTreeSet<&String> = rows.iter().map(|(_, lesson, ..)| lesson).collect();
        let logged: BTreeSet<&String> = self.policies.keys().chain(self.released.keys()).collect();
        let missing = |lesson| format!("the policy of {lesson} is logged, and is missing");
        found.extend(logged.difference(&there).map(missing));
        Ok(found)
    }
}

/// A detail as its entry has it; nothing where it cannot be read.
fn read(detail: &str) -> Value {
    serde_json::from_str(detail).unwrap_or_default()
}

/// The extensions of a course as they stand in their table.
async fn extensions(
    connection: &mut AnyConnection,
    course: &str,
) -> Result<BTreeMap<(String, String), Value>, StoreError> {
    type Row = (String, String, Option<i64>, i64, String, String, i64);
    let rows: Vec<Row> = sqlx::query_as(sql::EXTENSION_ROWS).bind(course).fetch_all(connection).await?;
    let stands = |(lesson, person, until, attempts, reason, by, at): Row| {
        let given = extension(&lesson, Some((until.map(Moment), attempts, &reason)));
        ((lesson, person), json!([given, by, at]))
    };
    Ok(rows.into_iter().map(stands).collect())
}

/// The decisions of a course as they stand in their table.
async fn decisions(connection: &mut AnyConnection, course: &str) -> Result<BTreeMap<i64, Value>, StoreError> {
    type Row = (i64, String, String, String, Option<String>, Option<f64>, String, String, i64);
    let rows: Vec<Row> = sqlx::query_as(sql::DECISION_ROWS).bind(course).fetch_all(connection).await?;
    let stands = |(n, person, lesson, kind, question, points, text, by, at): Row| {
        // As it was logged: a number that was read from a text.
        let decided = read(&decision(&lesson, &kind, points, &text, question.as_deref()).to_string());
        (n, json!([person, decided, by, at]))
    };
    Ok(rows.into_iter().map(stands).collect())
}

/// Keys whose values differ, or that only one of the two has.
fn differing<'a, K: Ord>(a: &'a BTreeMap<K, Value>, b: &'a BTreeMap<K, Value>) -> BTreeSet<&'a K> {
    a.keys().chain(b.keys()).filter(|key| a.get(key) != b.get(key)).collect()
}
