//! Who comes in, as whom, and into which course.

use axum::body::Body;
use axum::http::{Request, header};
use serde_json::{Value, json};
use triad::store::{CLASS, Context, Role};

use super::platform::{CLIENT, CONTEXT, Signing};
use super::{LESSON, begun, school, session};
use crate::send;

#[tokio::test]
async fn the_platform_is_asked_who_comes_and_the_browser_is_known_again() {
    let school = school().await;
    let reply = school.login(&[], &[]).await;
    let location = reply.headers[header::LOCATION].to_str().expect("text").to_owned();
    assert!(
        location.starts_with(&format!("{}/auth?tenant=1&scope=openid", school.platform.url)),
        "{location}"
    );
    for pair in [
        "response_type=id_token",
        "response_mode=form_post",
        "prompt=none",
        &format!("client_id={CLIENT}"),
        "redirect_uri=https%3A%2F%2Ftriad.test%2Flti%2Flaunch",
        "login_hint=somebody",
        "lti_message_hint=a+link+%26+more",
    ] {
        assert!(location.contains(pair), "{pair}: {location}");
    }
    let set = reply.headers[header::SET_COOKIE].to_str().expect("text");
    assert!(set.starts_with("__Host-triad-lti-"), "{set}");
    for word in ["; Path=/", "; HttpOnly", "; SameSite=None", "; Secure", "; Max-Age=600"] {
        assert!(set.contains(word), "{word}: {set}");
    }
    // As a form, as some platforms send it.
    let form = super::encoded(&[
        ("iss", &school.platform.url),
        ("login_hint", "x"),
        ("target_link_uri", "https://triad.test/"),
    ]);
    let request = Request::post("/lti/login")
        .header(header::CONTENT_TYPE, "application/x-www-form-urlencoded")
        .header(header::ORIGIN, "https://elsewhere.example");
    let reply = send(&school.class.server, request.body(Body::from(form)).expect("a request")).await;
    assert!(!begun(&reply).state.is_empty());
}

#[tokio::test]
async fn a_course_is_linked_by_its_teacher_and_its_people_come_in() {
    let school = school().await;
    school.open("ada", "Learner").await.problem(403, "lti-not-linked");
    let reply = school.open("prof", "Instructor").await;
    assert_eq!(reply.headers[header::LOCATION], format!("https://triad.test/lessons/{LESSON}"));
    let (teacher, me) = school.enter("prof", "Instructor").await;
    assert_eq!((&me["name"], &me["role"]), (&json!("prof of school"), &json!("instructor")));
    let (_, ada) = school.enter("ada", "Learner").await;
    assert_eq!((&ada["name"], &ada["role"]), (&json!("ada of school"), &json!("student")));
    let (_, again) = school.enter("ada", "Learner").await;
    assert_eq!(ada["id"], again["id"], "the same person each time");

    // A namesake is another person; who has no name is called by a number.
    let rename = |name: Value| move |word: &mut Value| word["name"] = name;
    let namesake = school.open_with("eva", "Learner", rename(json!("ADA of school"))).await;
    let me = school.class.ask("GET", "/api/v1/me", &session(&namesake), None).await.json();
    assert_eq!(me["person"]["name"], "ADA of school (2)");
    let nameless = school.open_with("nobody", "Learner", rename(Value::Null)).await;
    let me = school.class.ask("GET", "/api/v1/me", &session(&nameless), None).await.json();
    assert!(me["person"]["name"].as_str().expect("a name").starts_with("Participant "), "{me}");

    // Another course of the same platform is another class.
    let other = |word: &mut Value| {
        word["https://purl.imsglobal.org/spec/lti/claim/context"] =
            json!({"id": "history", "title": "History"});
    };
    school.open_with("prof", "Instructor", other).await.problem(403, "lti-other-course");
    let platform = &school.class.app.store.platforms(CLASS).await.expect("platforms")[0];
    let history = Context {
        id: "history".into(),
        title: "H".into(),
        line_items: String::new(),
        members: String::new(),
    };
    school.class.app.store.link_context(CLASS, &platform.id, &history).await.expect("linked");
    assert_eq!(school.open_with("hal", "Learner", other).await.status, 303);
    let state = school.class.ask("GET", "/api/v1/lti", &teacher, None).await.json();
    assert_eq!(state["platforms"][0]["courses"][0], json!({"title": "Mechanics at school", "roster": true}));
    assert_eq!(school.class.app.store.faults().await.expect("a log"), Vec::<String>::new());
}

#[tokio::test]
async fn who_comes_twice_at_once_is_one_person() {
    let school = school().await;
    school.enter("prof", "Instructor").await;
    let all = futures_util::future::join_all((0..8).map(|_| school.enter("ada", "Learner"))).await;
    assert!(all.iter().all(|(_, me)| me["id"] == all[0].1["id"]), "{all:?}");
    let namesake = |word: &mut Value| word["name"] = json!("Jane");
    let twins = ["one", "two"].map(|subject| school.open_with(subject, "Learner", namesake));
    let twins = futures_util::future::join_all(twins).await;
    assert!(twins.iter().all(|reply| reply.status == 303));
}

#[tokio::test]
async fn roles_follow_the_platform_but_for_what_was_decided_here() {
    let school = school().await;
    school.class.enter("/api/v1/setup", json!({"token": school.class.setup, "name": "Owner"})).await;
    school.enter("prof", "Instructor").await;
    let store = &school.class.app.store;
    let (_, ada) = school.enter("ada", "Learner").await;
    let id = ada["id"].as_str().expect("an id").to_owned();
    store.set_role(CLASS, "triad", &id, Role::Grader).await.expect("a role");
    assert_eq!(school.enter("ada", "Learner").await.1["role"], "grader", "a role that was given here stays");
    assert_eq!(school.enter("ada", "Instructor").await.1["role"], "instructor");
    assert_eq!(school.enter("ada", "Learner").await.1["role"], "student");
    store.set_role(CLASS, "triad", &id, Role::Owner).await.expect("a role");
    assert_eq!(
        school.enter("ada", "Instructor").await.1["role"],
        "owner",
        "an owner is one by our word alone"
    );
    let administrator = |word: &mut Value| {
        word["https://purl.imsglobal.org/spec/lti/claim/roles"] =
            json!(["http://purl.imsglobal.org/vocab/lis/v2/institution/person#Administrator"]);
    };
    let reply = school.open_with("dean", "Learner", administrator).await;
    let me = school.class.ask("GET", "/api/v1/me", &session(&reply), None).await.json();
    assert_eq!(me["person"]["role"], "student", "what somebody is elsewhere does not count");
}

#[tokio::test]
async fn new_keys_of_the_platform_are_found_and_are_not_asked_for_again_and_again() {
    let school = school().await;
    school.enter("prof", "Instructor").await;
    school.enter("ada", "Learner").await;
    let fetched = || school.platform.seen.lock().expect("whole").fetched;
    assert_eq!(fetched(), 1);
    // Keys that nobody has do not make us ask within the minute.
    let begun = school.begin().await;
    let word = school.platform.word(&begun.nonce, "eve", "Learner", LESSON);
    let token = Signing::new().sign(&word);
    let pairs = [("state", begun.state.as_str()), ("id_token", &token)];
    school.launch(&begun.cookie, &pairs).await.problem(403, "lti-key");
    assert_eq!(fetched(), 1);
    let lti = school.class.app.lti.clone().expect("reached");
    let registered = &school.class.app.store.platforms(CLASS).await.expect("platforms")[0];
    let other = Signing::new();
    school.platform.seen.lock().expect("whole").keys.push(other.public());
    let later = triad::policy::Moment::now().after(61_000);
    let keys = lti.keys_of(registered, Some(&other.name), later).await.expect("keys");
    assert!(keys.find(&other.name).is_some());
    assert_eq!(fetched(), 2);
}

#[tokio::test]
async fn the_roster_is_taken_over_page_by_page_and_from_nowhere_else() {
    let school = school().await;
    let (teacher, _) = school.enter("prof", "Instructor").await;
    let (_, ada) = school.enter("ada", "Learner").await;
    let learner = |id: &str| json!({"user_id": id, "roles": ["Learner"], "name": format!("{id} L."), "status": "Active"});
    {
        let mut seen = school.platform.seen.lock().expect("whole");
        let gone = json!({"user_id": "gone", "roles": ["Learner"], "status": "Inactive"});
        let helper = json!({"user_id": "helper", "given_name": "He", "family_name": "Lper",
            "roles": ["http://purl.imsglobal.org/vocab/lis/v2/membership/Instructor#TeachingAssistant"]});
        seen.people = vec![vec![learner("ada"), learner("bob")], vec![gone, helper]];
    }
    let take = async || school.class.ask("POST", "/api/v1/lti/roster", &teacher, None).await;
    assert_eq!(take().await.json(), json!({"listed": 3, "new": 2}));
    assert_eq!(take().await.json(), json!({"listed": 3, "new": 0}));
    let people = school.class.ask("GET", "/api/v1/people", &teacher, None).await.json();
    let people = people.as_array().expect("people").clone();
    let of = |name: &str| people.iter().find(|one| one["name"] == name).cloned().unwrap_or_default();
    assert_eq!(
        (of("bob L.")["role"].clone(), of("He Lper")["role"].clone()),
        (json!("student"), json!("grader"))
    );
    assert_eq!(of("ada of school")["id"], ada["id"], "who came before is who is listed");
    let (_, bob) = school.enter("bob", "Learner").await;
    assert_eq!(bob["id"], of("bob L.")["id"], "who is listed is who comes");
    school.platform.seen.lock().expect("whole").elsewhere = Some("http://127.0.0.2:9/people".into());
    take().await.problem(502, "lti-roster");
}

#[tokio::test]
async fn who_is_erased_is_unknown_to_the_platform_and_words_do_not_cut_it_off() {
    let school = school().await;
    let (teacher, _) = school.enter("prof", "Instructor").await;
    let (_, ada) = school.enter("ada", "Learner").await;
    let id = ada["id"].as_str().expect("an id").to_owned();
    let store = &school.class.app.store;
    let words = school.class.ask("POST", &format!("/api/v1/people/{id}/words"), &teacher, None).await;
    assert_eq!(words.status, 201);
    assert_eq!(school.enter("ada", "Learner").await.1["id"], ada["id"]);
    let platform = &store.platforms(CLASS).await.expect("platforms")[0];
    let subject = async || store.subject_of(&platform.id, CONTEXT, &id).await.expect("a book");
    assert_eq!(subject().await.as_deref(), Some("ada"));
    store.erase(CLASS, "triad", &id, "asked for it", false).await.expect("erased");
    assert_eq!(subject().await, None);
    assert_ne!(school.enter("ada", "Learner").await.1["id"], ada["id"]);
    store.remove_platform(CLASS, &platform.id).await.expect("removed");
    school.login(&[], &[]).await.problem(403, "lti-platform");
}
