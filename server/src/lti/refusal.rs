//! Why somebody whom a platform sends does not come in, and what to do.

use axum::http::StatusCode;

use crate::problem::Problem;

/// Why a word of a platform is not taken. None of them repeats the word itself: it could be used by others.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// Browsers would not bring back what they are given there.
    #[error("learning platforms cannot reach this server at {0}")]
    NotServed(String),
    /// The server does not know where it is reached.
    #[error("this server takes nobody from a learning platform")]
    Off,
    /// No platform of that name is registered.
    #[error("the platform {issuer} is not registered here, or under another client id")]
    Platform {
        /// What it calls itself.
        issuer: String,
    },
    /// Several are, and it does not say which it is.
    #[error("the platform {issuer} is registered more than once, and does not say for which client it asks")]
    Client {
        /// What it calls itself.
        issuer: String,
    },
    /// An address that is not ours.
    #[error("the platform sends to {0}, which is no address of this server")]
    Target(String),
    /// A part of what the platform has to send is missing.
    #[error("the platform does not say {0}")]
    Missing(&'static str),
    /// What it sends is too long.
    #[error("what the platform sends is longer than {0} bytes")]
    TooLong(usize),
    /// What we sent along did not come back, or is too old.
    #[error("this launch was not begun here, or more than ten minutes ago")]
    State,
    /// The browser did not keep what it was given.
    #[error("this browser is not the one in which the launch was begun, or it keeps no cookies")]
    Browser,
    /// The platform says that it did not go well.
    #[error("the platform reports: {0}")]
    Reported(String),
    /// No token.
    #[error("the platform's word cannot be read: {0}")]
    Unreadable(String),
    /// A token that is signed in another way, or in none.
    #[error("the platform's word is not signed by RS256")]
    Algorithm,
    /// Its keys cannot be fetched.
    #[error("the platform's keys at {at} cannot be fetched: {why}")]
    NoKeys {
        /// Where they should be.
        at: String,
        /// What is there instead.
        why: String,
    },
    /// It names a key that the platform does not publish.
    #[error("the platform's word is signed with a key that it does not publish")]
    Key,
    /// The signature is not of that key.
    #[error("the signature of the platform's word is wrong")]
    Signature,
    /// It is of another platform.
    #[error("the word is of another platform than the one that was asked")]
    Issuer,
    /// It is for somebody else.
    #[error("the platform's word is for another tool")]
    Audience,
    /// It is for several, of whom we are not the one that may use it.
    #[error("the platform's word is for several tools, and this one may not use it")]
    AuthorizedParty,
    /// Its time is over.
    #[error("the platform's word has expired")]
    Expired,
    /// Its time has not come.
    #[error("the platform's word is of the future")]
    Early,
    /// It answers another question.
    #[error("the platform's word answers another launch")]
    Nonce,
    /// It was taken before.
    #[error("this launch was used before")]
    Used,
    /// A deployment that is not registered.
    #[error("the platform's deployment {0} is not registered here")]
    Deployment(String),
    /// Another version of LTI.
    #[error("the platform speaks LTI {0}, not 1.3.0")]
    Version(String),
    /// A message that we do not know.
    #[error("the platform sends a message {0}, which this server does not know")]
    Message(String),
    /// The platform's course is not linked yet.
    #[error("your teacher has not opened this course's lessons yet")]
    NotLinked,
    /// The class belongs to another course there.
    #[error("this class belongs to the course {0} of the platform")]
    OtherCourse(String),
    /// Lessons are chosen by those who teach.
    #[error("lessons are chosen by those who teach the course")]
    NotTeacher,
    /// The platform wants to choose something else.
    #[error("the platform asks for something else than links to lessons")]
    Content,
    /// There is no such lesson.
    #[error("there is no lesson {0} here")]
    Lesson(String),
}

/// A text of others, short enough to be repeated.
pub fn shortened(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).take(200).collect()
}

impl Refusal {
    #[allow(clippy::too_many_lines, reason = "one table")]
    fn table(&self) -> (StatusCode, &'static str, &'static str) {
        const AGAIN: &str = "go back to your course and open the lesson there once more";
        const SETTINGS: &str = "ask who runs the platform to compare its settings with `triad lti list`";
        const NO: StatusCode = StatusCode::FORBIDDEN;
        match self {
            Self::NotServed(_) => (
                StatusCode::UNPROCESSABLE_ENTITY,
                "lti-needs-https",
                "name an encrypted address, as --url https://triad.example.org; http is for trials on this machine alone",
            ),
            Self::Off => (
                StatusCode::NOT_FOUND,
                "no-lti",
                "start it with `triad serve --class --url https://…` and register the platform: triad lti add --help",
            ),
            Self::Platform { .. } => (NO, "lti-platform", "register it on the server: triad lti add --help"),
            Self::Client { .. } => (NO, "lti-client", "let the platform send client_id, as LTI 1.3 asks"),
            Self::Target(_) => (NO, "lti-target", "give the platform the addresses of `triad lti tool`"),
            Self::Missing(_) => (NO, "lti-missing", SETTINGS),
            Self::TooLong(_) => (StatusCode::PAYLOAD_TOO_LARGE, "lti-too-long", AGAIN),
            Self::State => (NO, "lti-state", AGAIN),
            Self::Browser => (
                NO,
                "lti-browser",
                "open the lesson in a window of its own, and allow cookies for this address",
            ),
            Self::Reported(_) => {
                (NO, "lti-reported", "sign in at the platform, then open the lesson there once more")
            }
            Self::Unreadable(_) => (NO, "lti-unreadable", AGAIN),
            Self::Algorithm => (NO, "lti-algorithm", SETTINGS),
            Self::NoKeys { .. } => (StatusCode::BAD_GATEWAY, "lti-no-keys", SETTINGS),
            Self::Key => (
                NO,
                "lti-key",
                "if the platform has new keys, try again in a minute; else compare --jwks-url",
            ),
            Self::Signature => (NO, "lti-signature", AGAIN),
            Self::Issuer => (NO, "lti-issuer", AGAIN),
            Self::Audience => (NO, "lti-audience", SETTINGS),
            Self::AuthorizedParty => (NO, "lti-authorized-party", SETTINGS),
            Self::Expired => (NO, "lti-expired", AGAIN),
            Self::Early => (NO, "lti-early", "compare the clocks of the platform and of this server"),
            Self::Nonce => (NO, "lti-nonce", AGAIN),
            Self::Used => (NO, "lti-used", AGAIN),
            Self::Deployment(_) => (NO, "lti-deployment", "register it too: triad lti add … --deployment ID"),
            Self::Version(_) => (NO, "lti-version", "add the tool to the platform as one of LTI 1.3"),
            Self::Message(_) => {
                (NO, "lti-message", "open a lesson, or choose lessons, from the platform's course")
            }
            Self::NotLinked => {
                (NO, "lti-not-linked", "ask your teacher to open a lesson once, which links the course")
            }
            Self::OtherCourse(_) => (
                NO,
                "lti-other-course",
                "for another course start another server; for more courses of one class see `triad lti link`",
            ),
            Self::NotTeacher => (NO, "lti-not-teacher", "ask your teacher"),
            Self::Content => {
                (NO, "lti-content", "choose the tool where the platform adds an activity or an assignment")
            }
            Self::Lesson(_) => {
                (StatusCode::NOT_FOUND, "lti-lesson", "ask your teacher to choose the lesson anew")
            }
        }
    }
}

impl From<Refusal> for Problem {
    fn from(refusal: Refusal) -> Self {
        let (status, code, hint) = refusal.table();
        Self::new(status, code, refusal.to_string(), hint)
    }
}
