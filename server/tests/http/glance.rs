//! A class at a glance while it works, and its grades for other programs.

use serde_json::{Value, json};
use triad::glance::{HERE, Presence};
use triad::policy::Moment;
use triad::store::CLASS;

use crate::class::class;

const SUBMIT: &str = "/api/v1/lessons/simple-pendulum/submissions";

#[tokio::test]
async fn who_is_where_who_is_stuck_and_what_was_handed_in() {
    let class = class().await;
    let (owner, _) = class.enter("/api/v1/setup", json!({"token": class.setup, "name": "Prof"})).await;
    let glance = async || class.ask("GET", "/api/v1/glance", &owner, None).await.json();
    let (ada, told) = class.join("Ada").await;
    let (bob, _) = class.join("Bob").await;
    let (cyd, _) = class.join("Cyd").await;
    let quiet = glance().await;
    assert_eq!((&quiet["students"], &quiet["here"], &quiet["handed"]), (&json!(3), &json!(0), &json!([])));

    class.ask("GET", "/api/v1/lessons/screw", &cyd, None).await;
    class.ask("GET", "/api/v1/lessons/screw", &owner, None).await;
    let hand_in = async |cookie: &str, value: &str| {
        let body = json!({"answers": {"tension-bottom": {"value": value, "unit": "N"}}});
        let reply = class.ask("POST", SUBMIT, cookie, Some(body)).await;
        assert!(reply.status.is_success(), "{}", reply.json());
    };
    for value in ["1.000", "2.000", "2.000", "not a number"] {
        hand_in(&bob, value).await;
    }
    for value in ["1.000", "1.0000", "1.000 N"] {
        hand_in(&ada, value).await;
    }
    let recent = class.app.store.recent(CLASS, Moment(0)).await.expect("reads");
    assert!(recent.iter().all(|one| one.answers.is_empty() && one.body.contains("earned")), "{recent:?}");
    let seen = glance().await;
    let lessons: Vec<(&Value, usize)> = seen["lessons"]
        .as_array()
        .expect("lessons")
        .iter()
        .map(|lesson| (&lesson["slug"], lesson["people"].as_array().map_or(0, Vec::len)))
        .collect();
    assert_eq!(lessons, [(&json!("simple-pendulum"), 2), (&json!("screw"), 1)], "who teaches is not counted");
    let stuck = seen["stuck"].as_array().expect("a list");
    let which = |one: &Value| (one["name"].clone(), one["question"].clone(), one["tries"].clone());
    assert_eq!(
        stuck.iter().map(which).collect::<Vec<_>>(),
        [(json!("Bob"), json!("tension-bottom"), json!(3))],
        "one answer that is sent again is one try"
    );
    let bobs = &seen["lessons"][0]["people"][1];
    assert_eq!((&bobs["name"], &bobs["stuck"]), (&json!("Bob"), &json!(true)));
    assert_eq!((&seen["handed_in_all"], &seen["handed"][0]["name"]), (&json!(7), &json!("Ada")));

    let lesson = class.ask("GET", "/api/v1/lessons/simple-pendulum", &bob, None).await.json();
    let mass = lesson["scene"]["bodies"][0]["mass"].as_f64().expect("a mass");
    hand_in(&bob, &format!("{:.4}", 3.0 * 9.81 * mass)).await;
    assert_eq!(glance().await["stuck"], json!([]));
    let told = told["person"]["id"].as_str().expect("an id");
    assert_eq!(glance().await["lessons"][0]["people"][0]["person"], told);
}

#[test]
fn whoever_was_not_here_for_a_while_is_forgotten() {
    let presence = Presence::default();
    presence.note("ada", Some("screw"), Moment(0));
    presence.note("bob", Some("screw"), Moment(0));
    presence.note("ada", None, Moment(HERE));
    let here = presence.since(Moment(1));
    assert_eq!((here.len(), here["ada"].lesson.as_deref()), (1, Some("screw")));
    assert_eq!(presence.since(Moment(0)).len(), 1, "bob is not remembered");
}

#[tokio::test]
async fn grades_go_into_what_canvas_exported_and_out_as_lines() {
    let class = class().await;
    let (owner, _) = class.enter("/api/v1/setup", json!({"token": class.setup, "name": "Prof"})).await;
    let (ada, _) = class.join("Ada Lovelace").await;
    class.ask("POST", SUBMIT, &ada, Some(json!({"answers": {"tension-bottom": {"value": "1.000"}}}))).await;
    let lines = class.ask("GET", "/api/v1/standings.jsonl", &owner, None).await;
    let line: Value = serde_json::from_slice(&lines.bytes).expect("one line");
    assert_eq!(
        (&line["student"], &line["lesson"], &line["attempts"]),
        (&json!("Ada Lovelace"), &json!("simple-pendulum"), &json!(1))
    );
    let title = class.ask("GET", "/api/v1/lessons/simple-pendulum", &ada, None).await.json()["title"].clone();
    let title = title.as_str().expect("a title");
    let file =
        format!("Student,ID,SIS User ID,SIS Login ID,Section,\"{title} (77)\"\n\"Lovelace, Ada\",5,,,M,\n");
    let filled =
        class.ask("POST", "/api/v1/standings/canvas", &owner, Some(json!({"file": file}))).await.json();
    assert_eq!(
        (&filled["changed"], &filled["missing"], &filled["without_column"]),
        (&json!(1), &json!([]), &json!([]))
    );
    assert!(
        filled["csv"]
            .as_str()
            .is_some_and(|csv| csv.contains("\"Lovelace, Ada\",\"5\",\"\",\"\",\"M\",\"0\"")),
        "{filled}"
    );
    class
        .ask("POST", "/api/v1/standings/canvas", &owner, Some(json!({"file": "Name\n"})))
        .await
        .problem(422, "no-canvas-export");
}
