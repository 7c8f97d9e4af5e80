//! Why somebody who signs in with the account of their institution does not come in, and what to do.

use axum::http::StatusCode;

use crate::lti::refusal::Refusal as Word;
use crate::problem::Problem;

/// Why a sign-in is refused. None repeats a code or a token: it could be used by others.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// The server knows no provider.
    #[error("this server knows no sign-in of an institution")]
    Off,
    /// The provider does not say what it has to, or not at all.
    #[error("the provider {at} does not answer as it should: {why}")]
    Provider {
        /// Where it was asked.
        at: String,
        /// What it does instead.
        why: String,
    },
    /// What we sent along did not come back, or is too old.
    #[error("this sign-in was not begun here, or more than ten minutes ago")]
    State,
    /// The browser did not keep what it was given.
    #[error("this browser is not the one in which the sign-in was begun, or it keeps no cookies")]
    Browser,
    /// The provider says that it did not go well.
    #[error("the provider reports: {0}")]
    Reported(String),
    /// The answer names another provider.
    #[error("the answer comes from another provider than the one that was asked")]
    OtherProvider,
    /// The provider does not exchange its code.
    #[error("the provider does not take the code that came with the answer: {0}")]
    Code(String),
    /// Its signed word is not taken. What LTI calls a platform is a provider here.
    #[error("{}", .0.to_string().replace("platform", "provider"))]
    Word(#[from] Word),
    /// The account is nobody's here.
    #[error("nobody in this class has connected this account")]
    Unknown,
    /// The account is somebody else's here.
    #[error("this account is connected with somebody else in this class")]
    Taken,
}

impl Refusal {
    fn table(&self) -> (StatusCode, &'static str, &'static str) {
        const AGAIN: &str = "begin once more: sign in";
        const SETTINGS: &str = "ask who runs the server to compare oidc-issuer, oidc-client-id and oidc-client-secret with \
            what the provider has registered";
        const NO: StatusCode = StatusCode::FORBIDDEN;
        match self {
            Self::Off => (
                StatusCode::NOT_FOUND,
                "no-oidc",
                "start it with --oidc-issuer: triad serve --help; or come back with four words",
            ),
            Self::Provider { .. } => (
                StatusCode::BAD_GATEWAY,
                "oidc-provider",
                "try again in a minute, or come back with your four words",
            ),
            Self::State => (NO, "oidc-state", AGAIN),
            Self::Browser => (NO, "oidc-browser", "allow cookies for this address, and begin once more"),
            Self::Reported(_) => (NO, "oidc-reported", AGAIN),
            Self::OtherProvider => (NO, "oidc-other-provider", AGAIN),
            Self::Code(_) => (NO, "oidc-code", SETTINGS),
            Self::Word(word) => match word {
                Word::NoKeys { .. } => (StatusCode::BAD_GATEWAY, "oidc-no-keys", AGAIN),
                Word::Audience | Word::AuthorizedParty | Word::Issuer | Word::Algorithm => {
                    (NO, code(word), SETTINGS)
                }
                Word::Early => (NO, "oidc-early", "compare the clocks of the provider and of this server"),
                Word::Key => (NO, "oidc-key", "if the provider has new keys, try again in a minute"),
                _ => (NO, code(word), AGAIN),
            },
            Self::Unknown => (
                NO,
                "oidc-unknown",
                "come in with your invitation or your four words, press your name at the top, and connect the account",
            ),
            Self::Taken => (
                StatusCode::CONFLICT,
                "oidc-taken",
                "sign in with it to see as whom, and disconnect it there first",
            ),
        }
    }
}

/// The code of what is wrong with a word.
fn code(word: &Word) -> &'static str {
    match word {
        Word::Missing(_) => "oidc-missing",
        Word::TooLong(_) => "oidc-too-long",
        Word::Algorithm => "oidc-algorithm",
        Word::Signature => "oidc-signature",
        Word::Issuer => "oidc-issuer",
        Word::Audience => "oidc-audience",
        Word::AuthorizedParty => "oidc-authorized-party",
        Word::Expired => "oidc-expired",
        Word::Nonce => "oidc-nonce",
        _ => "oidc-unreadable",
    }
}

impl From<Refusal> for Problem {
    fn from(refusal: Refusal) -> Self {
        let (status, code, hint) = refusal.table();
        Self::new(status, code, refusal.to_string(), hint)
    }
}
