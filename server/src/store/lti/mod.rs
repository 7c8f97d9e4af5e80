//! Learning platforms: their registrations, who comes from them, and the scores that they are told.

mod arrivals;
mod scores;

use serde::Serialize;
use sqlx::AnyConnection;

use super::error::StoreError;
use super::log::{self, Event};
use super::sql::lti as sql;
use super::{Store, now};

pub use arrivals::{Admission, Arrival};
pub use scores::{Column, ColumnState, Due, Told, Wanted};

/// A platform as it was registered: what it is called and where it is asked.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Platform {
    /// Its id here: it follows from issuer and client.
    pub id: String,
    /// What it calls itself.
    pub issuer: String,
    /// What it calls us.
    pub client_id: String,
    /// Where its keys are.
    pub keys_url: String,
    /// Where a browser is sent to be known.
    pub login_url: String,
    /// Where we get tokens.
    pub token_url: String,
    /// For whom our proof towards that place is made.
    pub audience: String,
    /// Origins at which its services may be asked: those of the addresses above, and others that were named.
    pub services: Vec<String>,
    /// Its deployments that may send people.
    pub deployments: Vec<String>,
}

/// One of its courses whose people come into ours.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Context {
    /// What the platform calls it.
    pub id: String,
    /// Its title there.
    pub title: String,
    /// Where its columns of scores are; empty if it has none for us.
    pub line_items: String,
    /// Where its people are listed; empty if we may not see them.
    pub members: String,
}

/// Whether a platform is asked now.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pause {
    /// Not before this, in milliseconds since 1970.
    pub until: i64,
    /// How often in a row it did not answer as it should.
    pub failures: u32,
    /// What it did instead.
    pub problem: String,
}

type PlatformRow = (String, String, String, String, String, String, String, String, String);

fn platform(row: PlatformRow) -> Result<Platform, StoreError> {
    let (id, issuer, client_id, keys_url, login_url, token_url, audience, services, deployments) = row;
    let list = |text: &str| -> Result<Vec<String>, StoreError> {
        serde_json::from_str(text)
            .map_err(|cause| StoreError::Damaged(format!("the platform {issuer}: {cause}")))
    };
    let (services, deployments) = (list(&services)?, list(&deployments)?);
    Ok(Platform { id, issuer, client_id, keys_url, login_url, token_url, audience, services, deployments })
}

impl Store {
    /// Registers a platform for a course; one of the same issuer and client is changed.
    ///
    /// Errors if it cannot be written.
    pub async fn add_platform(&self, course: &str, new: &Platform) -> Result<(), StoreError> {
        let list = |list: &[String]| serde_json::json!(list).to_string();
        let mut transaction = self.write().await?;
        let detail = serde_json::json!([new.issuer, new.client_id]).to_string();
        let event =
            Event { actor: "triad", what: "registered the platform", subject: &new.id, detail: &detail };
        log::append(&mut transaction, course, now(), &event).await?;
        let add = sqlx::query(sql::ADD_PLATFORM).bind(&new.id).bind(course).bind(&new.issuer);
        let add = add.bind(&new.client_id).bind(&new.keys_url).bind(&new.login_url).bind(&new.token_url);
        let add = add.bind(&new.audience).bind(list(&new.services)).bind(list(&new.deployments));
        add.bind(now()).execute(&mut *transaction).await?;
        transaction.commit().await
    }

    /// The platforms of a course, in the order in which they were registered.
    ///
    /// Errors if the file cannot be read.
    pub async fn platforms(&self, course: &str) -> Result<Vec<Platform>, StoreError> {
        let rows: Vec<PlatformRow> =
            sqlx::query_as(sql::PLATFORMS).bind(course).fetch_all(&self.pools.readers).await?;
        rows.into_iter().map(platform).collect()
    }

    /// Takes a registration back. Whoever came from the platform stays, and is the same person if it is registered again.
    ///
    /// Errors if it cannot be written.
    pub async fn remove_platform(&self, course: &str, id: &str) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        let event = Event { actor: "triad", what: "removed the platform", subject: id, detail: "" };
        log::append(&mut transaction, course, now(), &event).await?;
        for statement in [
            sql::REMOVE_SCORES,
            sql::REMOVE_COLUMNS,
            sql::REMOVE_CONTEXTS,
            sql::REMOVE_NONCES,
            sql::REMOVE_PLATFORM,
        ] {
            sqlx::query(statement).bind(id).execute(&mut *transaction).await?;
        }
        transaction.commit().await
    }

    /// The courses of a platform whose people come into ours.
    ///
    /// Errors if the file cannot be read.
    pub async fn contexts(&self, platform: &str) -> Result<Vec<Context>, StoreError> {
        let rows: Vec<(String, String, String, String)> =
            sqlx::query_as(sql::CONTEXTS).bind(platform).fetch_all(&self.pools.readers).await?;
        let read = |(id, title, line_items, members)| Context { id, title, line_items, members };
        Ok(rows.into_iter().map(read).collect())
    }

    /// Lets the people of a course of the platform come into ours.
    ///
    /// Errors if it cannot be written.
    pub async fn link_context(
        &self,
        course: &str,
        platform: &str,
        context: &Context,
    ) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        link(&mut transaction, course, "triad", platform, context).await?;
        transaction.commit().await
    }

    /// Lets them come no longer; scores are no longer sent there.
    ///
    /// Errors if it cannot be written.
    pub async fn unlink_context(
        &self,
        course: &str,
        platform: &str,
        context: &str,
    ) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        let event =
            Event { actor: "triad", what: "unlinked a course of", subject: platform, detail: context };
        log::append(&mut transaction, course, now(), &event).await?;
        for statement in [sql::REMOVE_SCORES_OF, sql::REMOVE_COLUMNS_OF, sql::REMOVE_CONTEXT] {
            sqlx::query(statement).bind(platform).bind(context).execute(&mut *transaction).await?;
        }
        transaction.commit().await
    }

    /// Our keys, the newest first: name and private key.
    ///
    /// Errors if the file cannot be read.
    pub async fn lti_keys(&self) -> Result<Vec<(String, String)>, StoreError> {
        Ok(sqlx::query_as(sql::KEYS).fetch_all(&self.pools.readers).await?)
    }

    /// Adds a key of ours; it signs from now on, and those of before stay known.
    ///
    /// Errors if it cannot be written.
    pub async fn add_lti_key(&self, kid: &str, private: &str) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        let add = sqlx::query(sql::ADD_KEY).bind(kid).bind(private).bind(now());
        add.execute(&mut *transaction).await?;
        transaction.commit().await
    }

    /// Whether a platform is asked now.
    ///
    /// Errors if the file cannot be read.
    pub async fn pause_of(&self, platform: &str) -> Result<Pause, StoreError> {
        let find = sqlx::query_as(sql::PAUSE).bind(platform).fetch_optional(&self.pools.readers).await?;
        let found: Option<(i64, i64, String)> = find;
        let (until, failures, problem) = found.unwrap_or_default();
        Ok(Pause { until, failures: u32::try_from(failures).unwrap_or(u32::MAX), problem })
    }

    /// Asks nothing of a platform for a while, as it did not answer; `None`: it answered.
    ///
    /// Errors if it cannot be written.
    pub async fn pause(&self, platform: &str, until: Option<(i64, &str)>) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        match until {
            Some((until, problem)) => {
                let set = sqlx::query(sql::SET_PAUSE).bind(platform).bind(until).bind(problem);
                set.execute(&mut *transaction).await?;
            }
            None => {
                sqlx::query(sql::END_PAUSE).bind(platform).execute(&mut *transaction).await?;
            }
        }
        transaction.commit().await
    }
}

/// Links a course of a platform, or brings what is known of it up to date.
async fn link(
    connection: &mut AnyConnection,
    course: &str,
    actor: &str,
    platform: &str,
    context: &Context,
) -> Result<(), StoreError> {
    let detail = serde_json::json!([context.id, context.title]).to_string();
    let event = Event { actor, what: "linked a course of", subject: platform, detail: &detail };
    log::append(connection, course, now(), &event).await?;
    set_context(connection, platform, context).await
}

async fn set_context(
    connection: &mut AnyConnection,
    platform: &str,
    context: &Context,
) -> Result<(), StoreError> {
    let set = sqlx::query(sql::SET_CONTEXT).bind(platform).bind(&context.id).bind(&context.title);
    let set = set.bind(&context.line_items).bind(&context.members).bind(now());
    set.execute(connection).await?;
    Ok(())
}
