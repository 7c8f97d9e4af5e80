//! Lessons are chosen from the platform, and what stands in its frames.

use axum::body::Body;
use axum::http::{Request, header};
use jsonwebtoken::{Algorithm, DecodingKey, Validation};
use serde_json::{Value, json};

use super::platform::{CLIENT, DEPLOYMENT};
use super::{Begun, School, begun, encoded, school};
use crate::{Reply, send};

const CHOICE: (&str, &str) = ("target_link_uri", "https://triad.test/lti/choice");
const FRAME: (&str, &str) = ("sec-fetch-dest", "iframe");

pub(super) fn settings(school: &School) -> Value {
    json!({
        "deep_link_return_url": format!("{}/chosen", school.platform.url), "accept_types": ["link", "ltiResourceLink"],
        "accept_presentation_document_targets": ["iframe", "window"], "accept_multiple": true, "data": "from & to",
    })
}

pub(super) async fn offer(
    school: &School,
    begun: &Begun,
    role: &str,
    change: impl FnOnce(&mut Value),
) -> Reply {
    let mut word = school.platform.word(&begun.nonce, "prof", role, "none");
    word["https://purl.imsglobal.org/spec/lti/claim/message_type"] = json!("LtiDeepLinkingRequest");
    word["https://purl.imsglobal.org/spec/lti-dl/claim/deep_linking_settings"] = settings(school);
    change(&mut word);
    let token = school.platform.signing.sign(&word);
    school.launch(&begun.cookie, &[("state", &begun.state), ("id_token", &token)]).await
}

/// The value of a hidden field of a page.
pub(super) fn field(reply: &Reply, name: &str) -> String {
    let text = String::from_utf8_lossy(&reply.bytes).into_owned();
    let value = text.split_once(&format!("name=\"{name}\" value=\"")).expect("a field").1;
    value.split('"').next().unwrap_or_default().to_owned()
}

pub(super) async fn choose(school: &School, pairs: &[(&str, &str)]) -> Reply {
    let request = Request::post(format!("{}/lti/choice", school.base))
        .header(header::CONTENT_TYPE, "application/x-www-form-urlencoded");
    send(&school.class.server, request.body(Body::from(encoded(pairs))).expect("a request")).await
}

/// What we say to the platform, checked by our published keys.
pub(super) async fn said(school: &School, reply: &Reply) -> Value {
    let token = field(reply, "JWT");
    let request = Request::get(format!("{}/lti/keys", school.base)).body(Body::empty()).expect("a request");
    let set = send(&school.class.server, request).await.json();
    let set: jsonwebtoken::jwk::JwkSet = serde_json::from_value(set).expect("keys");
    let name = jsonwebtoken::decode_header(&token).expect("a header").kid.expect("a name");
    let key = DecodingKey::from_jwk(set.find(&name).expect("published")).expect("a key");
    let mut validation = Validation::new(Algorithm::RS256);
    validation.set_audience(&[&school.platform.url]);
    validation.set_issuer(&[CLIENT]);
    jsonwebtoken::decode::<Value>(&token, &key, &validation).expect("signed").claims
}

#[tokio::test]
async fn lessons_are_chosen_in_a_frame_of_the_platform() {
    let school = school().await;
    let begun = begun(&school.login(&[CHOICE], &[FRAME]).await);
    assert_eq!(begun.cookie, "", "browsers keep nothing there");
    let list = offer(&school, &begun, "Instructor", |_| {}).await;
    assert_eq!(list.status, 200);
    let text = String::from_utf8_lossy(&list.bytes).into_owned();
    assert!(text.contains("type=\"checkbox\" name=\"lesson\" value=\"screw\""), "{text}");
    let policy = list.headers["content-security-policy"].to_str().expect("text");
    assert!(policy.contains("default-src 'none'") && policy.contains("frame-ancestors *"), "{policy}");
    let ticket = field(&list, "ticket");
    let back = choose(
        &school,
        &[("ticket", &ticket), ("lesson", "screw"), ("lesson", "simple-pendulum"), ("lesson", "no-such")],
    )
    .await;
    assert_eq!(back.status, 200);
    let page = String::from_utf8_lossy(&back.bytes).into_owned();
    assert!(page.contains(&format!("action=\"{}/chosen\"", school.platform.url)), "{page}");
    let claims = said(&school, &back).await;
    let of = |name: &str| claims[format!("https://purl.imsglobal.org/spec/{name}")].clone();
    assert_eq!(of("lti/claim/message_type"), "LtiDeepLinkingResponse");
    assert_eq!(
        (of("lti/claim/deployment_id"), of("lti-dl/claim/data")),
        (json!(DEPLOYMENT), json!("from & to"))
    );
    let items = of("lti-dl/claim/content_items");
    assert_eq!(items.as_array().map(Vec::len), Some(2));
    // In the order of the course.
    assert_eq!(items[0]["url"], "https://triad.test/lessons/simple-pendulum");
    assert_eq!(
        (&items[0]["type"], &items[0]["custom"]),
        (&json!("ltiResourceLink"), &json!({"lesson": "simple-pendulum"}))
    );
    let column = &items[0]["lineItem"];
    assert_eq!(column["resourceId"], "simple-pendulum");
    assert!(column["scoreMaximum"].as_f64().expect("points") > 0.0);
}

#[tokio::test]
async fn a_choice_is_bounded_by_what_the_platform_asks_for() {
    let school = school().await;
    let settings = "https://purl.imsglobal.org/spec/lti-dl/claim/deep_linking_settings";
    let begin = async || begun(&school.login(&[CHOICE], &[]).await);
    let once = begin().await;
    let one = offer(&school, &once, "Instructor", |word| {
        word[settings]["accept_multiple"] = json!(false);
        word[settings]["accept_lineitem"] = json!(false);
        word[settings].as_object_mut().expect("settings").remove("data");
    });
    let one = one.await;
    assert!(String::from_utf8_lossy(&one.bytes).contains("type=\"radio\""));
    let ticket = field(&one, "ticket");
    let back =
        choose(&school, &[("ticket", &ticket), ("lesson", "screw"), ("lesson", "simple-pendulum")]).await;
    let claims = said(&school, &back).await;
    let items = &claims["https://purl.imsglobal.org/spec/lti-dl/claim/content_items"];
    assert_eq!(items.as_array().map(Vec::len), Some(1));
    assert_eq!(items[0].get("lineItem"), None);
    assert_eq!(claims.get("https://purl.imsglobal.org/spec/lti-dl/claim/data"), None);

    offer(&school, &begin().await, "Learner", |_| {}).await.problem(403, "lti-not-teacher");
    let other = |word: &mut Value| word[settings]["accept_types"] = json!(["file"]);
    offer(&school, &begin().await, "Instructor", other).await.problem(403, "lti-content");
    let script = |word: &mut Value| word[settings]["deep_link_return_url"] = json!("javascript:alert(1)");
    offer(&school, &begin().await, "Instructor", script).await.problem(403, "lti-target");
    choose(&school, &[("ticket", "none"), ("lesson", "screw")]).await.problem(403, "lti-state");
    // A ticket for a launch is none for a choice.
    choose(&school, &[("ticket", &begin().await.state)]).await.problem(403, "lti-state");
}

#[tokio::test]
async fn a_lesson_in_a_frame_opens_a_window_of_its_own() {
    let school = school().await;
    let reply = school.login(&[("login_hint", "\"><script>")], &[FRAME]).await;
    assert_eq!(reply.status, 200);
    let text = String::from_utf8_lossy(&reply.bytes).into_owned();
    assert!(
        text.contains("target=\"_blank\"") && text.contains("action=\"https://triad.test/lti/login\""),
        "{text}"
    );
    assert!(text.contains("value=\"&quot;&gt;&lt;script&gt;\"") && !text.contains("<script"), "{text}");
    assert!(reply.headers.get(header::SET_COOKIE).is_none());
    // What was begun in a frame lets nobody in.
    let begun = begun(&school.login(&[CHOICE], &[FRAME]).await);
    let word = school.platform.word(&begun.nonce, "prof", "Instructor", "screw");
    let token = school.platform.signing.sign(&word);
    school.launch("", &[("state", &begun.state), ("id_token", &token)]).await.problem(403, "lti-browser");
}

#[tokio::test]
async fn people_are_told_on_a_page_and_programs_in_a_document() {
    let school = school().await;
    let page = school.login(&[("iss", "https://<b>evil</b>.example")], &[("accept", "text/html,*/*")]).await;
    assert_eq!(page.status, 403);
    let text = String::from_utf8_lossy(&page.bytes).into_owned();
    assert!(text.contains("is not registered here") && text.contains("lti-platform"), "{text}");
    assert!(text.contains("&lt;b&gt;") && !text.contains("<b>"), "{text}");
    let request = Request::get("/lti/configuration").body(Body::empty()).expect("a request");
    let told = send(&school.class.server, request).await.json();
    assert_eq!(told["oidc_initiation_url"], "https://triad.test/lti/login");
    assert_eq!(told["extensions"][0]["settings"]["placements"][0]["target_link_uri"], CHOICE.1);
    // A server that platforms do not reach has none of it.
    let other = crate::server();
    for path in ["/lti/keys", "/lti/configuration", "/lti/login?iss=x"] {
        crate::get(&other, path).await.problem(404, "no-lti");
    }
}
