//! A learning platform sends people, chooses lessons and takes scores.

mod arrivals;
mod below;
mod choices;
pub(crate) mod platform;
mod refusals;
mod scores;

use axum::body::Body;
use axum::http::{Request, header};
use serde_json::Value;
use triad::lti::{Lti, keys};
use triad::store::CLASS;

use crate::class::{Class, class};
use crate::{Reply, send};
use platform::{CLIENT, Platform};

/// The lesson that is opened.
const LESSON: &str = "simple-pendulum";

/// A class that a platform reaches.
struct School {
    class: Class,
    platform: Platform,
    /// The path below which the class stands; empty for the root.
    base: &'static str,
}

/// A launch that was begun: what the browser keeps, and what the platform was told.
struct Begun {
    cookie: String,
    state: String,
    nonce: String,
}

async fn school() -> School {
    school_below("").await
}

async fn school_below(base: &'static str) -> School {
    let class = class().await;
    let home = format!("https://triad.test{base}");
    let platform = Platform::start(&home).await;
    let registered = platform.registration().check().expect("a platform");
    class.app.store.add_platform(CLASS, &registered).await.expect("registered");
    let ours = keys::published(&class.app.store).await.expect("keys");
    platform.seen.lock().expect("whole").ours = Some(ours);
    let app = class.app.clone().with_lti(Lti::at(&home, "secret").expect("an address")).below(base);
    School { class: Class { server: triad::app(app.clone()), app, ..class }, platform, base }
}

fn encoded(pairs: &[(&str, &str)]) -> String {
    url::form_urlencoded::Serializer::new(String::new()).extend_pairs(pairs).finish()
}

impl School {
    /// What the platform says first.
    async fn login(&self, more: &[(&str, &str)], headers: &[(&str, &str)]) -> Reply {
        let target = format!("{}/lessons/{LESSON}", self.platform.tool);
        let usual = [
            ("iss", self.platform.url.as_str()),
            ("login_hint", "somebody"),
            ("target_link_uri", &target),
            ("client_id", CLIENT),
            ("lti_message_hint", "a link & more"),
        ];
        let usual = usual.into_iter().filter(|(name, _)| !more.iter().any(|(other, _)| name == other));
        let pairs: Vec<(&str, &str)> = usual.chain(more.iter().copied()).collect();
        let mut request = Request::get(format!("{}/lti/login?{}", self.base, encoded(&pairs)));
        for (name, value) in headers {
            request = request.header(*name, *value);
        }
        send(&self.class.server, request.body(Body::empty()).expect("a request")).await
    }

    async fn begin(&self) -> Begun {
        begun(&self.login(&[], &[]).await)
    }

    /// The platform's answer, as a page of the platform has the browser send it.
    async fn launch(&self, cookie: &str, pairs: &[(&str, &str)]) -> Reply {
        let request = Request::post(format!("{}/lti/launch", self.base))
            .header(header::CONTENT_TYPE, "application/x-www-form-urlencoded")
            .header(header::ORIGIN, &self.platform.url)
            .header("sec-fetch-site", "cross-site")
            .header(header::COOKIE, cookie);
        send(&self.class.server, request.body(Body::from(encoded(pairs))).expect("a request")).await
    }

    /// Somebody opens the lesson.
    async fn open(&self, subject: &str, role: &str) -> Reply {
        self.open_with(subject, role, |_| {}).await
    }

    /// The same, where the platform says something else.
    async fn open_with(&self, subject: &str, role: &str, change: impl FnOnce(&mut Value)) -> Reply {
        let begun = self.begin().await;
        let mut word = self.platform.word(&begun.nonce, subject, role, LESSON);
        change(&mut word);
        let token = self.platform.signing.sign(&word);
        self.launch(&begun.cookie, &[("state", &begun.state), ("id_token", &token)]).await
    }

    /// Somebody comes in: the cookie of their session, and who they are.
    async fn enter(&self, subject: &str, role: &str) -> (String, Value) {
        let reply = self.open(subject, role).await;
        assert_eq!(reply.status, 303, "{}", String::from_utf8_lossy(&reply.bytes));
        let cookie = session(&reply);
        let me = self.class.ask("GET", &format!("{}/api/v1/me", self.base), &cookie, None).await.json();
        (cookie, me["person"].clone())
    }
}

/// What the browser was given and sent on with.
fn begun(reply: &Reply) -> Begun {
    assert_eq!(reply.status, 302, "{}", String::from_utf8_lossy(&reply.bytes));
    let location =
        url::Url::parse(reply.headers[header::LOCATION].to_str().expect("text")).expect("an address");
    let of = |wanted: &str| {
        let found = location.query_pairs().find(|(name, _)| name == wanted);
        found.map(|(_, value)| value.into_owned()).unwrap_or_default()
    };
    let cookie = reply.headers.get(header::SET_COOKIE).map(|set| set.to_str().expect("text"));
    let cookie = cookie.and_then(|set| set.split(';').next()).unwrap_or_default().to_owned();
    Begun { cookie, state: of("state"), nonce: of("nonce") }
}

/// The cookie of the session that a launch began.
fn session(reply: &Reply) -> String {
    let sets = reply.headers.get_all(header::SET_COOKIE).iter().map(|set| set.to_str().expect("text"));
    let set = sets.filter(|set| set.starts_with("triad=")).collect::<Vec<_>>();
    assert_eq!(set.len(), 1);
    assert!(set[0].contains("SameSite=Lax") && set[0].contains("HttpOnly"), "{}", set[0]);
    set[0].split(';').next().unwrap_or_default().to_owned()
}
