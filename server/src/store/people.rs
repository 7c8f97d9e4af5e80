//! People of a course: how they come in, come back, and what they may do.

use sqlx::AnyConnection;

use super::class::members::known;
use super::error::StoreError;
use super::hash::sha256;
use super::log::{self, Event};
use super::{Store, identifier, names, now, random, schema, sql};

/// The course of those who have accounts.
pub const CLASS: &str = "class";
/// A session that was not used this long is over, in milliseconds: a week.
const IDLE: i64 = 7 * 24 * 3_600_000;
/// A session of this age is over, in milliseconds: 30 days.
pub const LIFE: i64 = 30 * 24 * 3_600_000;
/// A session's last use is written at most so often, in milliseconds: reading a page writes nothing.
const SEEN: i64 = 3_600_000;
/// How long an invitation can be followed, in milliseconds: a week.
const INVITED: i64 = 7 * 24 * 3_600_000;

/// What somebody may do in a course; each may do all that those before may.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    /// Hands in, and sees what is their own.
    Student,
    /// Sees everybody's work and decides about it.
    Grader,
    /// Runs the course.
    Instructor,
    /// Names the others.
    Owner,
}

impl Role {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Student, Self::Grader, Self::Instructor, Self::Owner];

    /// The word for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Student => "student",
            Self::Grader => "grader",
            Self::Instructor => "instructor",
            Self::Owner => "owner",
        }
    }

    /// The role of that word.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|role| role.name() == name)
    }
}

/// Somebody in a course.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Member {
    /// The person's id.
    pub id: String,
    /// The name as it is shown.
    pub name: String,
    /// What they may do.
    pub role: Role,
    /// What their numbers are drawn from, together with the course's secret.
    pub seed: String,
    /// When they came, in milliseconds since 1970.
    pub joined_at: i64,
}

pub(super) type MemberRow = (String, String, String, String, i64);

/// A member as the row says.
pub(super) fn member((id, name, role, seed, joined_at): MemberRow) -> Member {
    // A word that a later version wrote gives the least right.
    Member { id, name, role: Role::named(&role).unwrap_or(Role::Student), seed, joined_at }
}

/// A course.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CourseRow {
    /// Its title.
    pub title: String,
    /// What students type to join.
    pub join_code: String,
    /// Whether they may.
    pub join_open: bool,
    /// What enters every seed and is told to nobody.
    pub secret: String,
}

/// What somebody comes back with: only hashes of it are kept.
#[derive(Debug, Clone)]
pub struct Return {
    /// Hash of the four words, in the form of PHC strings.
    pub phrase: String,
    /// The secret of the link.
    pub link: String,
}

impl Store {
    /// Makes the course if it is not there.
    ///
    /// Errors if it cannot be written.
    pub async fn ensure_course(&self, id: &str, title: &str) -> Result<CourseRow, StoreError> {
        let mut transaction = self.write().await?;
        schema::add_course(&mut transaction, id, title).await?;
        transaction.commit().await?;
        self.course(id).await
    }

    /// A course.
    ///
    /// Errors if it is not there.
    pub async fn course(&self, id: &str) -> Result<CourseRow, StoreError> {
        let find = sqlx::query_as(sql::COURSE).bind(id).fetch_optional(&self.pools.readers).await?;
        let (title, join_code, open, secret): (String, String, i64, String) =
            find.ok_or(StoreError::Unknown("course"))?;
        Ok(CourseRow { title, join_code, join_open: open == 1, secret })
    }

    /// Changes a course's title, whether students may join, and on request their code.
    ///
    /// Errors if it is not there or cannot be written.
    pub async fn set_course(
        &self,
        id: &str,
        actor: &str,
        title: &str,
        join_open: bool,
        new_code: bool,
    ) -> Result<CourseRow, StoreError> {
        let before = self.course(id).await?;
        let code = if new_code { random::join_code()? } else { before.join_code };
        let mut transaction = self.write().await?;
        let detail = format!(
            "joining {}, {} code",
            if join_open { "open" } else { "closed" },
            if new_code { "new" } else { "same" }
        );
        log::append(
            &mut transaction,
            id,
            now(),
            &Event { actor, what: "changed", subject: id, detail: &detail },
        )
        .await?;
        let set = sqlx::query(sql::SET_COURSE).bind(id).bind(title).bind(code).bind(i64::from(join_open));
        set.execute(&mut *transaction).await?;
        transaction.commit().await?;
        self.course(id).await
    }

    /// Whether a course has an owner.
    ///
    /// Errors if the file cannot be read.
    pub async fn has_owner(&self, course: &str) -> Result<bool, StoreError> {
        let count = sqlx::query_as(sql::OWNERS).bind(course).fetch_one(&self.pools.readers).await?;
        let (owners,): (i64,) = count;
        Ok(owners > 0)
    }

    /// A secret with which one person may enter a course in a role, within a week.
    ///
    /// Errors if it cannot be written.
    pub async fn invite(&self, course: &str, actor: &str, role: Role) -> Result<String, StoreError> {
        let token = random::token()?;
        let mut transaction = self.write().await?;
        let event = Event { actor, what: "invited", subject: course, detail: role.name() };
        log::append(&mut transaction, course, now(), &event).await?;
        let add = sqlx::query(sql::ADD_INVITATION).bind(sha256(&token)).bind(course).bind(role.name());
        add.bind(now() + INVITED).execute(&mut *transaction).await?;
        transaction.commit().await?;
        Ok(token)
    }

    /// Follows an invitation, which is used up.
    ///
    /// Errors if there is no such invitation, or the name is taken.
    pub async fn accept(&self, token: &str, name: &str, back: &Return) -> Result<Member, StoreError> {
        let mut transaction = self.write().await?;
        let find = sqlx::query_as(sql::USE_INVITATION).bind(sha256(token)).bind(now());
        let found: Option<(String, String)> = find.fetch_optional(&mut *transaction).await?;
        let (course, role) = found.ok_or(StoreError::Unknown("invitation, or it is used or a week old"))?;
        let role = Role::named(&role).unwrap_or(Role::Student);
        let joined = enrol(&mut transaction, &course, name, role, back).await?;
        transaction.commit().await?;
        Ok(joined)
    }

    /// Joins a course as a student.
    ///
    /// Errors if the name is taken.
    pub async fn join(&self, course: &str, name: &str, back: &Return) -> Result<Member, StoreError> {
        let mut transaction = self.write().await?;
        let joined = enrol(&mut transaction, course, name, Role::Student, back).await?;
        transaction.commit().await?;
        Ok(joined)
    }

    /// The person of that name and the hash of their four words.
    ///
    /// Errors if the file cannot be read.
    pub async fn phrase_of(&self, course: &str, name: &str) -> Result<Option<(String, String)>, StoreError> {
        let find = sqlx::query_as(sql::PHRASE).bind(course).bind(names::key(name));
        Ok(find.fetch_optional(&self.pools.readers).await?)
    }

    /// Whose link that is.
    ///
    /// Errors if the file cannot be read.
    pub async fn person_of_link(&self, link: &str) -> Result<Option<String>, StoreError> {
        let found = sqlx::query_as(sql::LINK).bind(sha256(link)).fetch_optional(&self.pools.readers).await?;
        Ok(found.map(|(person,): (String,)| person))
    }

    /// Gives somebody other words and another link; those of before are worth nothing, sessions end.
    ///
    /// Errors if there is no such person in the course.
    pub async fn renew_return(
        &self,
        course: &str,
        actor: &str,
        person: &str,
        back: &Return,
    ) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        let event = Event { actor, what: "renewed the words of", subject: person, detail: "" };
        log::append(&mut transaction, course, now(), &event).await?;
        known(&mut transaction, course, person).await?;
        for statement in [sql::REMOVE_IDENTITIES, sql::REMOVE_SESSIONS] {
            sqlx::query(statement).bind(person).execute(&mut *transaction).await?;
        }
        add_identities(&mut transaction, person, back).await?;
        transaction.commit().await
    }

    /// Begins a session; its secret.
    ///
    /// Errors if it cannot be written.
    pub async fn begin_session(&self, person: &str) -> Result<String, StoreError> {
        let token = random::token()?;
        let mut transaction = self.write().await?;
        let add = sqlx::query(sql::ADD_SESSION).bind(sha256(&token)).bind(person).bind(now()).bind(now());
        add.bind(now() + LIFE).execute(&mut *transaction).await?;
        transaction.commit().await?;
        Ok(token)
    }

    /// Who has the session of that secret, if it is not over.
    ///
    /// Errors if the file cannot be read.
    pub async fn member_of_session(&self, course: &str, token: &str) -> Result<Option<Member>, StoreError> {
        let hash = sha256(token);
        let find = sqlx::query_as(sql::SESSION).bind(&hash).bind(course).bind(now()).bind(now() - IDLE);
        let found: Option<(String, String, String, String, i64, i64)> =
            find.fetch_optional(&self.pools.readers).await?;
        let Some((id, name, role, seed, joined_at, seen_at)) = found else { return Ok(None) };
        if seen_at < now() - SEEN {
            let mut transaction = self.write().await?;
            sqlx::query(sql::SEE_SESSION).bind(&hash).bind(now()).execute(&mut *transaction).await?;
            transaction.commit().await?;
        }
        Ok(Some(member((id, name, role, seed, joined_at))))
    }

    /// Ends a session.
    ///
    /// Errors if it cannot be written.
    pub async fn end_session(&self, token: &str) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        sqlx::query(sql::END_SESSION).bind(sha256(token)).execute(&mut *transaction).await?;
        transaction.commit().await
    }

    /// Everybody in a course, by name.
    ///
    /// Errors if the file cannot be read.
    pub async fn people(&self, course: &str) -> Result<Vec<Member>, StoreError> {
        let rows: Vec<MemberRow> =
            sqlx::query_as(sql::PEOPLE).bind(course).fetch_all(&self.pools.readers).await?;
        Ok(rows.into_iter().map(member).collect())
    }

    /// Gives somebody another role.
    ///
    /// Errors if there is no such person, or the course would be without an owner.
    pub async fn set_role(
        &self,
        course: &str,
        actor: &str,
        person: &str,
        role: Role,
    ) -> Result<(), StoreError> {
        let mut transaction = self.write().await?;
        let event = Event { actor, what: "gave a role to", subject: person, detail: role.name() };
        log::append(&mut transaction, course, now(), &event).await?;
        known(&mut transaction, course, person).await?;
        let set = sqlx::query(sql::SET_ROLE).bind(course).bind(person).bind(role.name());
        set.execute(&mut *transaction).await?;
        let (owners,): (i64,) = sqlx::query_as(sql::OWNERS).bind(course).fetch_one(&mut *transaction).await?;
        if owners == 0 {
            return Err(StoreError::LastOwner);
        }
        transaction.commit().await
    }
}

async fn enrol(
    connection: &mut AnyConnection,
    course: &str,
    name: &str,
    role: Role,
    back: &Return,
) -> Result<Member, StoreError> {
    let member = add_member(connection, course, name, role).await?;
    add_identities(connection, &member.id, back).await?;
    Ok(member)
}

/// Adds a person to a course, without a way to come back.
///
/// Errors if the name is taken.
pub(super) async fn add_member(
    connection: &mut AnyConnection,
    course: &str,
    name: &str,
    role: Role,
) -> Result<Member, StoreError> {
    let (id, at, key) = (identifier(), now(), names::key(name));
    let event = Event { actor: &id, what: "joined", subject: course, detail: role.name() };
    log::append(connection, course, at, &event).await?;
    let taken = sqlx::query_as(sql::MEMBER_BY_NAME).bind(course).bind(&key).fetch_optional(&mut *connection);
    let taken: Option<(String,)> = taken.await?;
    if taken.is_some() {
        return Err(StoreError::NameTaken(name.to_owned()));
    }
    let seed = random::token()?;
    sqlx::query(sql::ADD_PERSON).bind(&id).bind(name).bind(at).execute(&mut *connection).await?;
    let add = sqlx::query(sql::ADD_MEMBER).bind(course).bind(&id).bind(role.name()).bind(key).bind(&seed);
    add.bind(at).execute(&mut *connection).await?;
    Ok(Member { id, name: name.to_owned(), role, seed, joined_at: at })
}

async fn add_identities(
    connection: &mut AnyConnection,
    person: &str,
    back: &Return,
) -> Result<(), StoreError> {
    let link = sha256(&back.link);
    for (kind, subject, secret) in [("phrase", person, back.phrase.as_str()), ("link", link.as_str(), "")] {
        let add = sqlx::query(sql::ADD_IDENTITY).bind(kind).bind(subject).bind(person).bind(secret);
        add.execute(&mut *connection).await?;
    }
    Ok(())
}
