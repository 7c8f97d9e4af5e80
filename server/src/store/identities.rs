//! Accounts at an institution by which people of a course come back.

use super::class::members::known;
use super::error::StoreError;
use super::log::{self, Event};
use super::{Store, now, sql};

impl Store {
    /// Whose account that is in a course.
    ///
    /// Errors if the file cannot be read.
    pub async fn person_of_account(&self, course: &str, account: &str) -> Result<Option<String>, StoreError> {
        let find = sqlx::query_as(sql::ACCOUNT).bind(course).bind(account);
        let found: Option<(String,)> = find.fetch_optional(&self.pools.readers).await?;
        Ok(found.map(|(person,)| person))
    }

    /// Whether somebody has connected an account.
    ///
    /// Errors if the file cannot be read.
    pub async fn has_account(&self, person: &str) -> Result<bool, StoreError> {
        let count = sqlx::query_as(sql::ACCOUNTS_OF).bind(person).fetch_one(&self.pools.readers).await?;
        let (accounts,): (i64,) = count;
        Ok(accounts > 0)
    }

    /// Connects an account with somebody, in place of the one that they had; false if it is somebody else's.
    ///
    /// Errors if there is no such person in the course, or it cannot be written.
    pub async fn connect_account(
        &self,
        course: &str,
        person: &str,
        account: &str,
    ) -> Result<bool, StoreError> {
        let mut transaction = self.write().await?;
        // Holds the course: of two who connect one account at once the second sees the first.
        let event = Event { actor: person, what: "connected an account", subject: person, detail: "" };
        log::append(&mut transaction, course, now(), &event).await?;
        known(&mut transaction, course, person).await?;
        let find = sqlx::query_as(sql::ACCOUNT).bind(course).bind(account);
        let found: Option<(String,)> = find.fetch_optional(&mut *transaction).await?;
        if found.is_some_and(|(other,)| other != person) {
            transaction.rollback().await?;
            return Ok(false);
        }
        sqlx::query(sql::REMOVE_ACCOUNT).bind(person).execute(&mut *transaction).await?;
        let add = sqlx::query(sql::ADD_IDENTITY).bind("account").bind(account).bind(person).bind("");
        add.execute(&mut *transaction).await?;
        transaction.commit().await?;
        Ok(true)
    }

    /// Takes somebody's account away; sessions go on.
    ///
    /// Errors if it cannot be written.
    pub async fn disconnect_account(&self, course: &str, person: &str) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        let event = Event { actor: person, what: "disconnected an account", subject: person, detail: "" };
        log::append(&mut transaction, course, now(), &event).await?;
        sqlx::query(sql::REMOVE_ACCOUNT).bind(person).execute(&mut *transaction).await?;
        transaction.commit().await
    }
}
