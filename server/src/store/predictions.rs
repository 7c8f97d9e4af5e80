//! What people said before a run: kept once, never changed.

use sqlx::AnyConnection;

use super::class::Assignment;
use super::class::assignments::{ensured, extension_of};
use super::error::StoreError;
use super::log::{self, Event};
use super::records::PredictionRow;
use super::submissions::{Whose, person_of};
use super::{Store, now, sql};
use crate::policy::{Moment, admit};

/// A prediction that is made, or declined.
#[derive(Debug, Clone)]
pub struct NewPrediction {
    /// The course.
    pub course: String,
    /// Who makes it.
    pub whose: Whose,
    /// The person's name.
    pub student: String,
    /// Slug of the lesson.
    pub lesson: String,
    /// Id of the prediction.
    pub prediction: String,
    /// Id of the option; `None`: none was made.
    pub choice: Option<String>,
    /// Why, in the person's words; may be empty.
    pub why: String,
}

/// A prediction as it is kept.
#[derive(Debug, Clone, PartialEq)]
pub struct KeptPrediction {
    /// Who made it, by id.
    pub person: String,
    /// Name of the person.
    pub name: String,
    /// Slug of the lesson.
    pub lesson: String,
    /// Id of the prediction.
    pub prediction: String,
    /// Id of the option; `None`: it was skipped.
    pub choice: Option<String>,
    /// Why, in the person's words; may be empty.
    pub why: String,
    /// When, in milliseconds since 1970.
    pub given_at: i64,
}

/// Person, name, lesson, prediction, choice, why, when.
type Row = (String, String, String, String, Option<String>, String, i64);

impl Store {
    /// Keeps a prediction, unless the person has made it before: then nothing is changed. Whether it is new, and the id of the
    /// person.
    ///
    /// Errors if the lesson is not open or closed, or it cannot be written.
    pub async fn predict(&self, new: &NewPrediction) -> Result<(bool, String), StoreError> {
        self.place_is_right()?;
        let mut transaction = self.write().await?;
        let (is_new, person) = predict(&mut transaction, new).await?;
        if is_new {
            transaction.commit().await?;
        } else {
            transaction.rollback().await?;
        }
        self.place_is_right()?;
        Ok((is_new, person))
    }

    /// The predictions of a course, in the order in which they were made: of one person, of one lesson, or all.
    ///
    /// Errors if the file cannot be read.
    pub async fn predictions(
        &self,
        course: &str,
        person: Option<&str>,
        lesson: Option<&str>,
    ) -> Result<Vec<KeptPrediction>, StoreError> {
        let statement = person.map_or(sql::PREDICTIONS, |_| sql::PREDICTIONS_OF);
        let list = sqlx::query_as(statement).bind(course).bind(person).bind(lesson);
        let rows: Vec<Row> = list.fetch_all(&self.pools.readers).await?;
        let kept = |(person, name, lesson, prediction, choice, why, given_at)| KeptPrediction {
            person,
            name,
            lesson,
            prediction,
            choice,
            why,
            given_at,
        };
        Ok(rows.into_iter().map(kept).collect())
    }
}

async fn predict(connection: &mut AnyConnection, new: &NewPrediction) -> Result<(bool, String), StoreError> {
    log::hold(connection, &new.course).await?;
    let at = now();
    let person = match &new.whose {
        Whose::Person(id) => id.clone(),
        Whose::Named => person_of(connection, &new.course, &new.student, at).await?,
    };
    let row = PredictionRow {
        course: new.course.clone(),
        person: person.clone(),
        slug: new.lesson.clone(),
        prediction: new.prediction.clone(),
        choice: new.choice.clone(),
        why: new.why.clone(),
        given_at: at,
    };
    let find = sqlx::query_as(sql::PREDICTED).bind(&row.course).bind(&row.person).bind(&row.slug);
    let (before,): (i64,) = find.bind(&row.prediction).fetch_one(&mut *connection).await?;
    if before > 0 {
        return Ok((false, person));
    }
    // To skip earns nothing, and the run waits for one or the other.
    if row.choice.is_some() {
        let Assignment { id, policy, .. } = ensured(connection, &row.course, &row.slug).await?;
        let extension = extension_of(connection, &id, &person).await?;
        admit(&policy, extension.as_ref(), &[], false, Moment(at))?;
    }
    let event = Event { actor: &person, what: "predicted", subject: &row.subject(), detail: &row.hash() };
    let n = log::append(connection, &new.course, at, &event).await?;
    row.add(connection, n).await?;
    Ok((true, person))
}
