//! What is not taken from a platform, or from somebody who says to be one.

use std::collections::BTreeSet;

use jsonwebtoken::{Algorithm, EncodingKey, Header};
use serde_json::{Value, json};
use triad::lti::refusal::Refusal;
use triad::lti::{Lti, verify};
use triad::policy::Moment;

use super::platform::Signing;
use super::{Begun, LESSON, School, school};

const CLAIM: &str = "https://purl.imsglobal.org/spec/lti/claim/";

/// A claim of LTI.
fn lti(name: &str) -> String {
    format!("{CLAIM}{name}")
}

/// What is sent with the launch.
type Pairs = Vec<(&'static str, String)>;

/// How a launch is made wrong: what the platform says, who signs it, and what is sent.
struct Wrong {
    code: &'static str,
    what: &'static str,
    said: fn(&mut Value),
    signed: fn(&School, &Value) -> String,
    sent: fn(&mut Pairs, &mut String),
}

fn as_it_should(school: &School, word: &Value) -> String {
    school.platform.signing.sign(word)
}

fn said(code: &'static str, what: &'static str, said: fn(&mut Value)) -> Wrong {
    Wrong { code, what, said, signed: as_it_should, sent: |_, _| {} }
}

fn signed(code: &'static str, what: &'static str, signed: fn(&School, &Value) -> String) -> Wrong {
    Wrong { code, what, said: |_| {}, signed, sent: |_, _| {} }
}

fn sent(code: &'static str, what: &'static str, sent: fn(&mut Pairs, &mut String)) -> Wrong {
    Wrong { code, what, said: |_| {}, signed: as_it_should, sent }
}

fn without(word: &mut Value, name: &str) {
    word.as_object_mut().expect("claims").remove(name);
}

fn seconds(from_now: i64) -> Value {
    json!(jiff::Timestamp::now().as_second() + from_now)
}

fn header(school: &School, algorithm: Algorithm) -> Header {
    Header { kid: Some(school.platform.signing.name.clone()), ..Header::new(algorithm) }
}

/// The second of the three parts of a token.
fn payload(token: &str) -> &str {
    token.split('.').nth(1).expect("a payload")
}

#[allow(clippy::too_many_lines)] // one table
fn all() -> Vec<Wrong> {
    vec![
        said("lti-expired", "it has expired", |word| word["exp"] = seconds(-61)),
        said("lti-early", "made in the future", |word| word["iat"] = seconds(120)),
        said("lti-early", "good in the future", |word| word["nbf"] = seconds(120)),
        said("lti-missing", "no end", |word| without(word, "exp")),
        said("lti-missing", "no beginning", |word| without(word, "iat")),
        said("lti-unreadable", "an end that is no number", |word| word["exp"] = json!("soon")),
        said("lti-audience", "for another tool", |word| word["aud"] = json!("another-tool")),
        said("lti-missing", "for nobody", |word| without(word, "aud")),
        said("lti-authorized-party", "for several, of whom another may use it", |word| {
            word["aud"] = json!([super::CLIENT, "another-tool"]);
            word["azp"] = json!("another-tool");
        }),
        said("lti-authorized-party", "for several, and nobody may use it", |word| {
            word["aud"] = json!([super::CLIENT, "another-tool"]);
        }),
        said("lti-issuer", "of another platform", |word| word["iss"] = json!("https://other.example")),
        said("lti-nonce", "of another launch", |word| word["nonce"] = json!("another")),
        said("lti-missing", "of no launch", |word| without(word, "nonce")),
        said("lti-deployment", "of another deployment", |word| word[lti("deployment_id")] = json!("8")),
        said("lti-missing", "of no deployment", |word| without(word, &lti("deployment_id"))),
        said("lti-version", "LTI 1.1", |word| word[lti("version")] = json!("LTI-1p0")),
        said("lti-missing", "no version", |word| without(word, &lti("version"))),
        said("lti-message", "another message", |word| {
            word[lti("message_type")] = json!("LtiSubmissionReviewRequest");
        }),
        said("lti-missing", "no message", |word| without(word, &lti("message_type"))),
        said("lti-missing", "about nobody", |word| without(word, "sub")),
        said("lti-missing", "no link", |word| without(word, &lti("resource_link"))),
        said("lti-missing", "no course", |word| without(word, &lti("context"))),
        said("lti-missing", "no target", |word| without(word, &lti("target_link_uri"))),
        said("lti-target", "an unencrypted target", |word| {
            word[lti("target_link_uri")] = json!("http://triad.test/lessons/screw");
        }),
        said("lti-target", "a target elsewhere", |word| {
            word[lti("target_link_uri")] = json!("https://triad.test.evil.example/lessons/screw");
        }),
        said("lti-target", "a target in another's name", |word| {
            word[lti("target_link_uri")] = json!("https://triad.test@evil.example/lessons/screw");
        }),
        said("lti-target", "a target that is no page for people", |word| {
            word[lti("target_link_uri")] = json!("https://triad.test/api/v1/course");
        }),
        said("lti-lesson", "a lesson that is not there", |word| {
            word[lti("target_link_uri")] = json!("https://triad.test/lessons/none");
        }),
        said("lti-missing", "a choice without settings", |word| {
            word[lti("message_type")] = json!("LtiDeepLinkingRequest");
        }),
        signed("lti-algorithm", "signed by nobody: alg none", |school, word| {
            // {"alg":"none","typ":"JWT"}
            let token = school.platform.signing.sign(word);
            format!("eyJhbGciOiJub25lIiwidHlwIjoiSldUIn0.{}.", payload(&token))
        }),
        signed("lti-algorithm", "HS256 with the public key as the secret", |school, word| {
            let public = serde_json::to_vec(&school.platform.signing.public()).expect("JSON");
            let key = EncodingKey::from_secret(&public);
            jsonwebtoken::encode(&header(school, Algorithm::HS256), word, &key).expect("signed")
        }),
        signed("lti-algorithm", "RS512", |school, word| {
            let header = header(school, Algorithm::RS512);
            jsonwebtoken::encode(&header, word, &school.platform.signing.key).expect("signed")
        }),
        signed("lti-signature", "another key under the same name", |school, word| {
            jsonwebtoken::encode(&header(school, Algorithm::RS256), word, &Signing::new().key)
                .expect("signed")
        }),
        signed("lti-key", "a key that is not published", |_, word| Signing::new().sign(word)),
        signed("lti-missing", "no name of a key", |school, word| {
            let header = Header::new(Algorithm::RS256);
            jsonwebtoken::encode(&header, word, &school.platform.signing.key).expect("signed")
        }),
        signed("lti-signature", "changed after it was signed", |school, word| {
            let (mut other, token) = (word.clone(), school.platform.signing.sign(word));
            other["sub"] = json!("prof");
            let other = school.platform.signing.sign(&other);
            token.replace(payload(&token), payload(&other))
        }),
        signed("lti-signature", "cut off", |school, word| {
            let token = school.platform.signing.sign(word);
            token[..token.len() - 4].to_owned()
        }),
        signed("lti-unreadable", "no token", |_, _| "none".to_owned()),
        signed("lti-too-long", "too long a token", |school, word| {
            let mut word = word.clone();
            word["more"] = json!("x".repeat(64 << 10));
            school.platform.signing.sign(&word)
        }),
        sent("lti-state", "no state", |pairs, _| pairs.retain(|(name, _)| *name != "state")),
        sent("lti-state", "an unknown state", |pairs, _| pairs[0].1.push('x')),
        sent("lti-browser", "another browser", |_, cookie| *cookie = "__Host-triad-lti-00000000=1".into()),
        sent("lti-browser", "no cookie", |_, cookie| cookie.clear()),
        sent("lti-missing", "no word", |pairs, _| pairs.truncate(1)),
        sent("lti-reported", "the platform refuses", |pairs, _| {
            pairs.push(("error", "login_required".into()));
        }),
    ]
}

#[tokio::test]
async fn every_wrong_launch_is_refused_for_what_is_wrong_and_lets_nobody_in() {
    let school = school().await;
    school.enter("prof", "Instructor").await;
    let people = async || school.class.app.store.people("class").await.expect("people").len();
    let before = people().await;
    let all = all();
    assert!(all.len() >= 45, "{}", all.len());
    for wrong in &all {
        let begun = school.begin().await;
        let mut word = school.platform.word(&begun.nonce, "eve", "Learner", LESSON);
        (wrong.said)(&mut word);
        let token = (wrong.signed)(&school, &word);
        let mut cookie = begun.cookie;
        let mut pairs = vec![("state", begun.state), ("id_token", token.clone())];
        (wrong.sent)(&mut pairs, &mut cookie);
        let pairs: Vec<(&str, &str)> = pairs.iter().map(|(name, value)| (*name, value.as_str())).collect();
        let reply = school.launch(&cookie, &pairs).await;
        let told = reply.json();
        assert_eq!(told["code"], wrong.code, "{}: {told}", wrong.what);
        assert!(reply.headers.get("set-cookie").is_none(), "{}", wrong.what);
        // Nothing that others could use, or that tells who came, is repeated: answers are what logs are made of.
        let text = told.to_string();
        for secret in [payload_of(&token), "eve of school", begun.nonce.as_str()] {
            assert!(secret.is_empty() || !text.contains(secret), "{}: {text}", wrong.what);
        }
        assert_eq!(people().await, before, "{}", wrong.what);
    }
    // The same launch, with nothing wrong.
    school.enter("eve", "Learner").await;
}

/// The word of the platform of these tests, as another tool is to judge it: `cargo verify lti` names the file.
#[tokio::test]
async fn what_this_platform_signs_is_taken_by_us_and_can_be_judged_by_others() {
    let school = school().await;
    let word = school.platform.word("a-launch", "ada", "Learner", LESSON);
    let token = school.platform.signing.sign(&word);
    let keys = jsonwebtoken::jwk::JwkSet { keys: vec![school.platform.signing.public()] };
    let registered = school.platform.registration().check().expect("a platform");
    let name = verify::key_name(&token).expect("a name");
    let claims = verify::signed(&token, &name, &keys).expect("signed");
    verify::meant(&claims, &registered, "a-launch", Moment::now()).expect("for us");
    if let Some(path) = std::env::var_os("TRIAD_LTI_WORD") {
        let told = json!({"token": token, "keys": keys, "issuer": school.platform.url});
        std::fs::write(path, told.to_string()).expect("written");
    }
}

fn payload_of(token: &str) -> &str {
    token.split('.').nth(1).unwrap_or_default()
}

#[tokio::test]
async fn a_launch_is_good_once() {
    let school = school().await;
    let Begun { cookie, state, nonce } = school.begin().await;
    let token = school.platform.signing.sign(&school.platform.word(&nonce, "prof", "Instructor", LESSON));
    let pairs = [("state", state.as_str()), ("id_token", &token)];
    assert_eq!(school.launch(&cookie, &pairs).await.status, 303);
    school.launch(&cookie, &pairs).await.problem(403, "lti-used");
    // A word that is signed again for the same launch is no other.
    let again = school.platform.signing.sign(&school.platform.word(&nonce, "prof", "Learner", LESSON));
    school.launch(&cookie, &[("state", &state), ("id_token", &again)]).await.problem(403, "lti-used");
    // The state of one launch, the word of another.
    let (one, other) = (school.begin().await, school.begin().await);
    let word = school.platform.word(&other.nonce, "prof", "Instructor", LESSON);
    let token = school.platform.signing.sign(&word);
    let both = format!("{}; {}", one.cookie, other.cookie);
    school.launch(&both, &[("state", &one.state), ("id_token", &token)]).await.problem(403, "lti-nonce");
}

#[tokio::test]
async fn a_login_that_is_not_of_a_platform_begins_nothing() {
    let school = school().await;
    let long = "x".repeat(9000);
    for (code, status, changed) in [
        ("lti-platform", 403, ("iss", "https://other.example")),
        ("lti-platform", 403, ("client_id", "another-tool")),
        ("lti-missing", 403, ("login_hint", "")),
        ("lti-missing", 403, ("iss", "")),
        ("lti-missing", 403, ("target_link_uri", "")),
        ("lti-target", 403, ("target_link_uri", "http://triad.test/lessons/screw")),
        ("lti-target", 403, ("target_link_uri", "https://evil.example/")),
        ("lti-deployment", 403, ("lti_deployment_id", "8")),
        ("lti-too-long", 413, ("lti_message_hint", long.as_str())),
    ] {
        let reply = school.login(&[changed], &[]).await;
        reply.problem(status, code);
        assert!(reply.headers.get("set-cookie").is_none() && reply.headers.get("location").is_none());
    }
    let mut twice = school.platform.registration();
    twice.client_id = "another-tool".into();
    let twice = twice.check().expect("a platform");
    school.class.app.store.add_platform("class", &twice).await.expect("registered");
    school.login(&[("client_id", "")], &[]).await.problem(403, "lti-client");
    assert_eq!(school.login(&[], &[]).await.status, 302);
    // Keys that cannot be fetched.
    let begun = {
        let mut gone = school.platform.registration();
        gone.client_id = "gone".into();
        gone.keys_url = "http://127.0.0.1:9/keys".into();
        let gone = gone.check().expect("a platform");
        school.class.app.store.add_platform("class", &gone).await.expect("registered");
        super::begun(&school.login(&[("client_id", "gone")], &[]).await)
    };
    let token = school.platform.signing.sign(&school.platform.word(&begun.nonce, "x", "Learner", LESSON));
    let reply = school.launch(&begun.cookie, &[("state", &begun.state), ("id_token", &token)]).await;
    reply.problem(502, "lti-no-keys");
}

#[test]
fn browsers_bring_back_what_they_are_given_by_encrypted_servers_alone() {
    for good in [
        "https://triad.example.org",
        "https://example.org/triad/",
        "http://127.0.0.1:8080",
        "http://localhost:1",
    ] {
        assert!(Lti::at(good, "s").is_ok(), "{good}");
    }
    let mut codes = BTreeSet::new();
    for bad in [
        "http://triad.example.org",
        "http://192.168.1.7",
        "ftp://localhost",
        "triad",
        "https://a:b@triad.example.org",
        "https://triad.example.org/?x=1",
    ] {
        assert!(matches!(Lti::at(bad, "s"), Err(Refusal::NotServed(_))), "{bad}");
        codes.insert(triad::problem::Problem::from(Refusal::NotServed(bad.into())).code());
    }
    assert_eq!(codes, BTreeSet::from(["lti-needs-https"]));
    let below = Lti::at("https://example.org/triad/", "s").expect("an address");
    assert_eq!(below.own_path("https://example.org/triad/lessons/screw").expect("ours"), "/lessons/screw");
    assert_eq!(below.own_path("https://example.org/triad").expect("ours"), "/");
    assert!(below.own_path("https://example.org/triadic").is_err());
    assert!(below.own_path("https://example.org/lessons/screw").is_err());
}
