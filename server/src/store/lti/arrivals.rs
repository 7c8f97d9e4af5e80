//! Who comes from a platform: as whom, and into which course.

use sqlx::AnyConnection;

use super::{Context, set_context, sql};
use crate::store::error::StoreError;
use crate::store::log::{self, Event};
use crate::store::people::{Member, Role, add_member};
use crate::store::sql as common;
use crate::store::{Store, names, now};

/// Most people of one name.
const NAMESAKES: u32 = 1000;

/// Somebody whom a platform sends, as its signed word says.
#[derive(Debug, Clone)]
pub struct Arrival {
    /// The platform.
    pub platform: String,
    /// What makes the word one that is taken once, and until when it is good, in milliseconds since 1970.
    pub nonce: (String, i64),
    /// The course there.
    pub context: Context,
    /// What the platform calls the person.
    pub subject: String,
    /// The name, as it is to be shown.
    pub name: String,
    /// What they are there.
    pub role: Role,
    /// The lesson that they open, and where its scores go; an empty address where there is no such place yet.
    pub column: Option<(String, String)>,
}

/// Whether somebody comes in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Admission {
    /// As this member.
    In(Member),
    /// The word was taken before.
    Used,
    /// Nobody who teaches has come from there yet.
    NotLinked,
    /// Our course belongs to another one of the platform: its title.
    OtherCourse(String),
}

impl Store {
    /// Lets somebody in whom a platform sends: a person who is known, or a new one. The first who teaches links their course
    /// with ours; people of other courses of the platform do not come in.
    ///
    /// Errors if it cannot be written: then nothing is kept, not even that the word was taken.
    pub async fn arrive(&self, course: &str, arrival: &Arrival) -> Result<Admission, StoreError> {
        let mut transaction = self.write().await?;
        hold(&mut transaction, course).await?;
        let admission = admit(&mut transaction, course, arrival).await?;
        match admission {
            Admission::Used => transaction.rollback().await?,
            _ => transaction.commit().await?,
        }
        Ok(admission)
    }

    /// Takes the nonce of a word that brings nobody in; false if it was taken before. Links the course if it can be.
    ///
    /// Errors if it cannot be written.
    pub async fn take_word(&self, course: &str, arrival: &Arrival) -> Result<Option<Admission>, StoreError> {
        let mut transaction = self.write().await?;
        hold(&mut transaction, course).await?;
        if !take(&mut transaction, arrival).await? {
            transaction.rollback().await?;
            return Ok(Some(Admission::Used));
        }
        let refused = linked(&mut transaction, course, arrival).await?;
        transaction.commit().await?;
        Ok(refused)
    }

    /// Adds the people of a platform's roster, by what it calls them, name and role; how many of them are new.
    ///
    /// Errors if it cannot be written: then nobody is added.
    pub async fn enlist(
        &self,
        course: &str,
        platform: &str,
        context: &str,
        people: &[(String, String, Role)],
    ) -> Result<usize, StoreError> {
        let mut transaction = self.write().await?;
        hold(&mut transaction, course).await?;
        let mut new = 0;
        for (subject, name, role) in people {
            let one = (subject.as_str(), name.as_str(), *role);
            let (_, is_new) = person(&mut transaction, course, platform, context, one).await?;
            new += usize::from(is_new);
        }
        transaction.commit().await?;
        Ok(new)
    }
}

async fn hold(connection: &mut AnyConnection, course: &str) -> Result<(), StoreError> {
    sqlx::query(sql::HOLD_COURSE).bind(course).execute(connection).await?;
    Ok(())
}

async fn admit(
    connection: &mut AnyConnection,
    course: &str,
    arrival: &Arrival,
) -> Result<Admission, StoreError> {
    if !take(connection, arrival).await? {
        return Ok(Admission::Used);
    }
    if let Some(refused) = linked(connection, course, arrival).await? {
        return Ok(refused);
    }
    let Arrival { platform, context, subject, name, role, column, .. } = arrival;
    let (member, _) = person(connection, course, platform, &context.id, (subject, name, *role)).await?;
    if let Some((slug, url)) = column {
        add_column(connection, platform, &context.id, slug, url).await?;
    }
    Ok(Admission::In(member))
}

/// Takes the nonce of a word; false if it was taken before.
async fn take(connection: &mut AnyConnection, arrival: &Arrival) -> Result<bool, StoreError> {
    sqlx::query(sql::FORGET_NONCES).bind(now()).execute(&mut *connection).await?;
    let (nonce, ends_at) = &arrival.nonce;
    let add = sqlx::query(sql::ADD_NONCE).bind(&arrival.platform).bind(nonce).bind(ends_at);
    Ok(add.execute(connection).await?.rows_affected() == 1)
}

/// Why people of this course there do not come into ours; nothing if they do.
async fn linked(
    connection: &mut AnyConnection,
    course: &str,
    arrival: &Arrival,
) -> Result<Option<Admission>, StoreError> {
    let Arrival { platform, context, role, .. } = arrival;
    let known: Vec<(String, String, String, String)> =
        sqlx::query_as(sql::CONTEXTS).bind(platform).fetch_all(&mut *connection).await?;
    match known.first() {
        _ if known.iter().any(|(id, ..)| *id == context.id) => {
            set_context(connection, platform, context).await?;
        }
        Some((_, title, ..)) => return Ok(Some(Admission::OtherCourse(title.clone()))),
        None if *role < Role::Instructor => return Ok(Some(Admission::NotLinked)),
        None => super::link(connection, course, platform, platform, context).await?,
    }
    Ok(None)
}

/// The person whom the platform calls so, in the role that it gives them; whether they are new.
async fn person(
    connection: &mut AnyConnection,
    course: &str,
    platform: &str,
    context: &str,
    (subject, name, role): (&str, &str, Role),
) -> Result<(Member, bool), StoreError> {
    let find = sqlx::query_as(sql::PERSON_OF_SUBJECT).bind(platform).bind(subject);
    let found: Option<(String,)> = find.fetch_optional(&mut *connection).await?;
    let known = match found {
        Some((id,)) => member_of(connection, course, &id).await?,
        None => None,
    };
    let is_new = known.is_none();
    let mut member = if let Some(member) = known {
        member
    } else {
        let free = free(connection, course, name).await?;
        add_member(connection, course, &free, role).await?
    };
    let before = sqlx::query_as(sql::ROLE_OF_SUBJECT).bind(platform).bind(context).bind(subject);
    let before: Option<(String,)> = before.fetch_optional(&mut *connection).await?;
    // A role that was given here stays until the platform changes its own mind, and an owner is one by our word alone.
    let is_changed = before.is_some_and(|(before,)| before != role.name());
    if is_changed && member.role != Role::Owner && member.role != role {
        let event =
            Event { actor: platform, what: "gave a role to", subject: &member.id, detail: role.name() };
        log::append(connection, course, now(), &event).await?;
        let set = sqlx::query(common::SET_ROLE).bind(course).bind(&member.id).bind(role.name());
        set.execute(&mut *connection).await?;
        member.role = role;
    }
    let set = sqlx::query(sql::SET_PERSON).bind(platform).bind(context).bind(subject);
    set.bind(&member.id).bind(role.name()).execute(connection).await?;
    Ok((member, is_new))
}

async fn member_of(
    connection: &mut AnyConnection,
    course: &str,
    person: &str,
) -> Result<Option<Member>, StoreError> {
    type Row = (String, String, String, String, i64);
    let people: Option<Row> =
        sqlx::query_as(sql::MEMBER).bind(course).bind(person).fetch_optional(connection).await?;
    Ok(people.map(crate::store::people::member))
}

/// The name, with a number where somebody has it already.
async fn free(connection: &mut AnyConnection, course: &str, name: &str) -> Result<String, StoreError> {
    for n in 1..=NAMESAKES {
        let tried = if n == 1 { name.to_owned() } else { format!("{name} ({n})") };
        let find = sqlx::query_as(common::MEMBER_BY_NAME).bind(course).bind(names::key(&tried));
        let taken: Option<(String,)> = find.fetch_optional(&mut *connection).await?;
        if taken.is_none() {
            return Ok(tried);
        }
    }
    Err(StoreError::NameTaken(name.to_owned()))
}

/// Remembers where the scores of a lesson go. A place that is still to be made is remembered if there is none.
async fn add_column(
    connection: &mut AnyConnection,
    platform: &str,
    context: &str,
    slug: &str,
    url: &str,
) -> Result<(), StoreError> {
    let list = sqlx::query_as(sql::COLUMNS_OF_LESSON).bind(platform).bind(context).bind(slug);
    let known: Vec<(String,)> = list.fetch_all(&mut *connection).await?;
    if known.iter().any(|(known,)| known == url) || (url.is_empty() && !known.is_empty()) {
        return Ok(());
    }
    if !url.is_empty() {
        let remove = sqlx::query(sql::REMOVE_COLUMN).bind(platform).bind(context).bind(slug).bind("");
        remove.execute(&mut *connection).await?;
    }
    let add = sqlx::query(sql::ADD_COLUMN).bind(platform).bind(context).bind(slug).bind(url);
    add.execute(connection).await?;
    Ok(())
}
