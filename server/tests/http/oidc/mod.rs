//! People of a class come back with the account that they have at their institution, and nobody else does.

mod institution;

use std::sync::Arc;

use axum::body::Body;
use axum::extract::State;
use axum::http::{Request, StatusCode, header};
use base64::Engine;
use base64::prelude::BASE64_URL_SAFE_NO_PAD;
use serde_json::{Value, json};
use triad::lti::Lti;
use triad::oidc::{BACK, Oidc, Return};
use triad::policy::Moment;
use url::Url;

use crate::class::{Class, class};
use crate::lti::platform::Signing;
use crate::{Reply, send};
use institution::{Asked, Institution, describes};

/// Where the class is.
const HOME: &str = "https://triad.test";
const MINUTE: i64 = 60_000;

struct School {
    class: Class,
    institution: Institution,
    owner: String,
    /// The path below which the class stands; empty for the root.
    base: &'static str,
}

async fn school() -> School {
    school_below("").await
}

async fn school_below(base: &'static str) -> School {
    let class = class().await;
    let home = format!("{HOME}{base}");
    let institution = Institution::start(&home).await;
    let app = class.app.clone().with_lti(Lti::at(&home, "secret").expect("an address")).below(base);
    let lti = app.lti.clone().expect("reached");
    let app = app.with_oidc(Oidc::new(institution.provider(), lti));
    let class = Class { server: triad::app(app.clone()), app, ..class };
    let setup = format!("{base}/api/v1/setup");
    let owner = class.enter(&setup, json!({"token": class.setup, "name": "Prof"})).await.0;
    School { class, institution, owner, base }
}

fn text(reply: &Reply, name: header::HeaderName) -> String {
    reply.headers[name].to_str().expect("text").to_owned()
}

impl School {
    /// Begins to sign in.
    async fn leaves(&self) -> Asked {
        let reply = self.class.ask("GET", &format!("{}/oidc/login", self.base), "", None).await;
        assert_eq!(reply.status, 302, "{}", String::from_utf8_lossy(&reply.bytes));
        Asked::new(&text(&reply, header::LOCATION), &reply)
    }

    /// Begins to connect an account.
    async fn connects(&self, who: &str) -> Asked {
        let reply = self.class.ask("POST", &format!("{}/api/v1/me/account", self.base), who, None).await;
        assert_eq!(reply.status, 200, "{}", reply.json());
        let to = reply.json()["to"].as_str().expect("an address").to_owned();
        Asked::new(&to, &reply)
    }

    /// Comes back with these words in the address.
    async fn returns(&self, cookies: &[&str], pairs: &[(&str, &str)]) -> Reply {
        let query = url::form_urlencoded::Serializer::new(String::new()).extend_pairs(pairs).finish();
        let request =
            Request::get(format!("{}{BACK}?{query}", self.base)).header(header::COOKIE, cookies.join("; "));
        send(&self.class.server, request.body(Body::empty()).expect("a request")).await
    }

    async fn signs_in(&self, subject: &str) -> Reply {
        let asked = self.leaves().await;
        let code = self.institution.agrees(&asked, subject, |_| {});
        self.returns(&[&asked.cookie], &[("code", &code), ("state", &asked.of("state"))]).await
    }

    async fn connected(&self, who: &str, subject: &str) -> Reply {
        let asked = self.connects(who).await;
        let code = self.institution.agrees(&asked, subject, |_| {});
        self.returns(&[who, &asked.cookie], &[("code", &code), ("state", &asked.of("state"))]).await
    }

    async fn me(&self, who: &str) -> Value {
        self.class.ask("GET", &format!("{}/api/v1/me", self.base), who, None).await.json()
    }
}

/// The cookie of the session that was begun.
fn session(reply: &Reply) -> String {
    assert_eq!(reply.status, 303, "{}", String::from_utf8_lossy(&reply.bytes));
    let sets = reply.headers.get_all(header::SET_COOKIE).iter().map(|set| set.to_str().expect("text"));
    let sets: Vec<&str> = sets.collect();
    let set = sets.iter().find(|set| set.starts_with("triad=")).expect("a session");
    assert!(sets.iter().any(|set| set.contains("triad-oidc-") && set.contains("Max-Age=0")), "it is used up");
    set.split(';').next().unwrap_or_default().to_owned()
}

#[tokio::test]
async fn who_connected_an_account_comes_back_with_it_in_the_role_that_the_class_gives() {
    let school = school().await;
    let nobody = school.me("").await;
    assert_eq!(nobody["institution"], json!({"name": "the school", "connected": false}));
    let asked = school.leaves().await;
    assert_eq!((asked.of("scope").as_str(), asked.of("response_type").as_str()), ("openid", "code"));
    assert_eq!((asked.of("tenant"), asked.of("code_challenge_method")), ("1".into(), "S256".into()));
    assert_eq!(asked.of("redirect_uri"), format!("{HOME}{BACK}"));

    school.signs_in("emmy@school").await.problem(403, "oidc-unknown");
    let reply = school.connected(&school.owner, "emmy@school").await;
    assert_eq!(text(&reply, header::LOCATION), "/class");
    assert_eq!(school.me(&session(&reply)).await["institution"]["connected"], true);
    let me = school.me(&session(&school.signs_in("emmy@school").await)).await;
    assert_eq!((&me["person"]["name"], &me["person"]["role"]), (&json!("Prof"), &json!("owner")));
    school.signs_in("somebody else@school").await.problem(403, "oidc-unknown");

    let gone = school.class.ask("DELETE", "/api/v1/me/account", &school.owner, None).await;
    assert_eq!(gone.status, 204);
    school.signs_in("emmy@school").await.problem(403, "oidc-unknown");
    assert_eq!(school.me(&school.owner).await["institution"]["connected"], false);
    // What was done stands in the log; the account itself does not.
    let log = school.class.ask("GET", "/api/v1/course/export", &school.owner, None).await;
    let log = String::from_utf8_lossy(&log.bytes).into_owned();
    assert!(log.contains("connected an account") && !log.contains("emmy@school"));
}

#[tokio::test]
async fn below_a_path_people_come_back_below_it() {
    let school = school_below("/school/triad").await;
    let asked = school.leaves().await;
    assert_eq!(asked.of("redirect_uri"), format!("{HOME}/school/triad{BACK}"));
    let connected = school.connected(&school.owner, "emmy@school").await;
    assert_eq!(text(&connected, header::LOCATION), "/school/triad/class");
    let back = school.signs_in("emmy@school").await;
    assert_eq!(text(&back, header::LOCATION), "/school/triad/class");
    assert_eq!(school.me(&session(&back)).await["person"]["name"], "Prof");
    // Cookies go to nobody else on the host.
    let mut sets = back.headers.get_all(header::SET_COOKIE).iter().map(|set| set.to_str().expect("text"));
    assert!(asked.cookie.starts_with("__Secure-") && sets.all(|set| set.contains("; Path=/school/triad;")));
}

#[tokio::test]
async fn an_account_is_one_persons_and_connected_by_those_who_teach() {
    let school = school().await;
    let (student, _) = school.class.join("Ada").await;
    school.class.ask("POST", "/api/v1/me/account", &student, None).await.problem(403, "not-yours");
    school.class.ask("POST", "/api/v1/me/account", "", None).await.problem(401, "sign-in-needed");
    session(&school.connected(&school.owner, "one").await);
    // Another in its place: the first leads nowhere.
    session(&school.connected(&school.owner, "two").await);
    school.signs_in("one").await.problem(403, "oidc-unknown");
    let invited =
        school.class.ask("POST", "/api/v1/invitations", &school.owner, Some(json!({"role": "grader"}))).await;
    let token = invited.json()["token"].clone();
    let (grader, _) = school.class.enter("/api/v1/setup", json!({"token": token, "name": "Noether"})).await;
    school.connected(&grader, "two").await.problem(409, "oidc-taken");
    // New words, because the old ones were seen by others: no account is left to them either.
    session(&school.connected(&grader, "three").await);
    let person = school.me(&grader).await["person"]["id"].as_str().expect("an id").to_owned();
    let renewed =
        school.class.ask("POST", &format!("/api/v1/people/{person}/words"), &school.owner, None).await;
    assert!(renewed.status.is_success());
    school.signs_in("three").await.problem(403, "oidc-unknown");
    // Begun by one and finished in the browser of another, who is signed in there.
    let asked = school.connects(&school.owner).await;
    let code = school.institution.agrees(&asked, "four", |_| {});
    let pairs = [("code", code.as_str()), ("state", &asked.of("state"))];
    school.returns(&[&student, &asked.cookie], &pairs).await.problem(403, "oidc-browser");
}

/// A change to what the provider's word says.
type Change = fn(&mut Value);

#[tokio::test]
async fn every_word_that_is_not_the_providers_for_us_and_of_now_is_refused() {
    let school = school().await;
    session(&school.connected(&school.owner, "emmy").await);
    let changes: &[(&str, Change)] = &[
        ("oidc-issuer", |word| word["iss"] = json!("https://other.example")),
        ("oidc-missing", |word| word["iss"] = Value::Null),
        ("oidc-audience", |word| word["aud"] = json!("another")),
        ("oidc-audience", |word| word["aud"] = json!(["another"])),
        ("oidc-authorized-party", |word| word["aud"] = json!(["triad", "another"])),
        ("oidc-authorized-party", |word| word["azp"] = json!("another")),
        ("oidc-expired", |word| word["exp"] = json!(1_000_000)),
        ("oidc-missing", |word| word["exp"] = Value::Null),
        ("oidc-early", |word| word["iat"] = json!(4_000_000_000_u64)),
        ("oidc-nonce", |word| word["nonce"] = json!("of another sign-in")),
        ("oidc-missing", |word| word["nonce"] = Value::Null),
        ("oidc-missing", |word| word["sub"] = json!("")),
        ("oidc-unreadable", |word| word["exp"] = json!("soon")),
    ];
    for (code, change) in changes {
        let asked = school.leaves().await;
        let given = school.institution.agrees(&asked, "emmy", change);
        let pairs = [("code", given.as_str()), ("state", &asked.of("state"))];
        school.returns(&[&asked.cookie], &pairs).await.problem(403, code);
    }
    let forges = |forged| school.institution.seen.lock().expect("whole").forges = forged;
    forges(Some(Signing::new()));
    school.signs_in("emmy").await.problem(403, "oidc-key");
    let name = school.institution.seen.lock().expect("whole").signing.name.clone();
    forges(Some(Signing { name, ..Signing::new() }));
    school.signs_in("emmy").await.problem(403, "oidc-signature");
    forges(None);
    let unsigned = BASE64_URL_SAFE_NO_PAD.encode(r#"{"alg":"none","kid":"any"}"#) + ".e30.";
    let symmetric = BASE64_URL_SAFE_NO_PAD.encode(r#"{"alg":"HS256","kid":"any"}"#) + ".e30.AA";
    for (answer, status, code) in [
        ((200, json!({"id_token": unsigned})), 403, "oidc-algorithm"),
        ((200, json!({"id_token": symmetric})), 403, "oidc-algorithm"),
        ((200, json!({"id_token": "no token"})), 403, "oidc-unreadable"),
        ((200, json!({"id_token": "a".repeat(70_000)})), 403, "oidc-too-long"),
        ((200, json!({})), 403, "oidc-missing"),
        ((401, json!({"error": "invalid_client"})), 403, "oidc-code"),
        ((500, json!("broken")), 502, "oidc-provider"),
    ] {
        let answers = (StatusCode::from_u16(answer.0).expect("a status"), answer.1);
        school.institution.seen.lock().expect("whole").answers = Some(answers);
        school.signs_in("emmy").await.problem(status, code);
    }
    session(&school.signs_in("emmy").await);
}

#[tokio::test]
async fn every_return_that_was_not_begun_here_is_refused() {
    let school = school().await;
    session(&school.connected(&school.owner, "emmy").await);
    let asked = school.leaves().await;
    let (state, cookie) = (asked.of("state"), asked.cookie.as_str());
    let code = school.institution.agrees(&asked, "emmy", |_| {});
    let other = school.leaves().await;
    let long = "a".repeat(20_000);
    for (cookies, pairs, wanted) in [
        (vec![cookie], vec![("code", code.as_str())], "oidc-state"),
        (vec![cookie], vec![("code", &code), ("state", "made up")], "oidc-state"),
        (vec![cookie], vec![("code", &code), ("state", &long)], "oidc-state"),
        (vec![], vec![("code", &code), ("state", &state)], "oidc-browser"),
        (vec![&other.cookie], vec![("code", &code), ("state", &state)], "oidc-browser"),
        (vec![cookie], vec![("state", &state)], "oidc-missing"),
        (vec![cookie], vec![("error", "access_denied"), ("state", &state)], "oidc-reported"),
        (vec![cookie], vec![("code", "made up"), ("state", &state)], "oidc-code"),
        (
            vec![cookie],
            vec![("code", &code), ("state", &state), ("iss", "https://other.example")],
            "oidc-other-provider",
        ),
    ] {
        school.returns(&cookies, &pairs).await.problem(403, wanted);
    }
    // What none of these used up still brings one person in, once.
    let pairs = [("code", code.as_str()), ("state", &state), ("iss", &school.institution.url)];
    session(&school.returns(&[cookie], &pairs).await);
    school.returns(&[cookie], &pairs).await.problem(403, "oidc-code");
    let off = class().await;
    off.ask("GET", "/oidc/login", "", None).await.problem(404, "no-oidc");
    off.ask("GET", BACK, "", None).await.problem(404, "no-oidc");
    assert_eq!(off.ask("GET", "/api/v1/me", "", None).await.json()["institution"], Value::Null);
}

/// What a provider says of itself is looked at, and kept for an hour; a new key is fetched a minute later.
#[tokio::test]
async fn a_provider_may_change_its_keys_and_not_its_name() {
    let institution = Institution::start(HOME).await;
    let lti = Arc::new(Lti::at(HOME, "secret").expect("an address"));
    let oidc = Oidc::new(institution.provider(), lti.clone());
    let now = Moment::now();
    let come = async |oidc: &Oidc, at: Moment| {
        let departure = oidc.begin(None, at).await?;
        let asked = Asked { to: Url::parse(&departure.to).expect("an address"), cookie: String::new() };
        let code = institution.agrees(&asked, "emmy", |word| {
            word["iat"] = json!(at.0 / 1000);
            word["exp"] = json!(at.0 / 1000 + 300);
        });
        let back = json!({"code": code, "state": asked.of("state")});
        let back: Return = serde_json::from_value(back).expect("a return");
        let (name, secret) = departure.cookie;
        let found = |wanted: &str| (wanted == name).then(|| secret.clone());
        let (begun, _) = oidc.begun(&back, found, at)?;
        oidc.account(&back, &begun, &secret, at).await
    };
    let code = |result: Result<String, triad::oidc::refusal::Refusal>| {
        triad::problem::Problem::from(result.expect_err("a refusal")).code()
    };
    let account = come(&oidc, now).await.expect("comes in");
    institution.seen.lock().expect("whole").signing = Signing::new();
    assert_eq!(code(come(&oidc, now).await), "oidc-key", "not asked again at once");
    assert_eq!(
        come(&oidc, now.after(MINUTE + 1)).await,
        Ok(account.clone()),
        "the same person by the new key"
    );

    // Its secret is shown as it wants to see it.
    institution.seen.lock().expect("whole").in_body = true;
    let fresh = Oidc::new(institution.provider(), lti.clone());
    assert_eq!(come(&fresh, now).await, Ok(account.clone()));

    let describe = |said| institution.seen.lock().expect("whole").describes = Some(said);
    let (good, url) = (describes(State(institution.seen.clone())).await.0, institution.url.as_str());
    for (member, value) in [
        ("issuer", json!("https://other.example")),
        ("authorization_endpoint", json!("http://other.example/auth")),
        ("token_endpoint", json!("http://other.example/token")),
        ("jwks_uri", Value::Null),
        ("issuer", json!(format!("{url}/"))),
    ] {
        let mut said = good.clone();
        said[member] = value;
        describe(said);
        let fresh = Oidc::new(institution.provider(), lti.clone());
        assert_eq!(code(come(&fresh, now).await), "oidc-provider", "{member}");
    }
    // Who is known is taken at its word while it says nothing.
    institution.seen.lock().expect("whole").in_body = false;
    let later = now.after(120 * MINUTE);
    assert_eq!(come(&oidc, later).await.map_err(|error| error.to_string()), Ok(account));
}
