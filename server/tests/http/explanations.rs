//! Explanations: kept and judged by nobody but people, who read them beside the predictions and give the points.

use serde_json::{Value, json};

use crate::class::{Class, class};
use crate::{Reply, get, post, server};

const LESSON: &str = "virtual-work";
const SUBMIT: &str = "/api/v1/lessons/virtual-work/submissions";

fn words(count: usize) -> Value {
    json!({"answers": {"in-words": {"value": "because ".repeat(count)}}})
}

fn of(verdict: &Value) -> Value {
    let all = verdict["questions"].as_array().expect("questions");
    all.iter().find(|question| question["id"] == "in-words").expect("the explanation").clone()
}

async fn said(class: &Class, cookie: &str) -> Value {
    class.ask("GET", &format!("/api/v1/assignments/{LESSON}/words"), cookie, None).await.json()
}

async fn give(class: &Class, cookie: &str, person: &Value, points: Value, reason: &str) -> Reply {
    let path = format!("/api/v1/people/{}/decisions", person.as_str().expect("an id"));
    let body = json!({"lesson": LESSON, "question": "in-words", "points": points, "reason": reason});
    class.ask("POST", &path, cookie, Some(body)).await
}

/// What the table of the class says of the only student.
async fn reached(class: &Class, cookie: &str) -> Value {
    let table = class.ask("GET", "/api/v1/standings", cookie, None).await.json();
    table["students"][0]["lessons"][LESSON].clone()
}

#[tokio::test]
async fn at_home_an_explanation_is_kept_and_a_good_one_stands_beside_it() {
    let server = server();
    let named = |mut body: Value| {
        body["student"] = json!("Ada");
        body
    };
    let short = post(&server, SUBMIT, named(words(39))).await;
    assert_eq!((short.status.as_u16(), of(&short.json())["verdict"].clone()), (200, json!("invalid")));
    assert_eq!(of(&short.json()).get("reference_html"), None, "a good one is told too early");
    let kept = post(&server, SUBMIT, named(words(40))).await;
    let found = of(&kept.json());
    assert_eq!((kept.status.as_u16(), &found["verdict"]), (201, &json!("kept")));
    assert_eq!((&found["earned"], &found["possible"]), (&json!(0.0), &json!(0.0)));
    assert!(found["reference_html"].as_str().is_some_and(|good| good.contains("does no work")), "{found}");
    // Its points are none of those that a program gives.
    let lesson = get(&server, "/api/v1/lessons/virtual-work").await.json();
    let questions = lesson["exercise"]["questions"].as_array().expect("questions");
    let judged = questions.iter().filter(|question| question["kind"] != "explanation");
    let points: f64 = judged.filter_map(|question| question["points"].as_f64()).sum();
    assert_eq!(kept.json()["possible"], json!(points));
}

#[tokio::test]
async fn who_teaches_reads_explanations_beside_predictions_and_gives_their_points() {
    let class = class().await;
    let everybody = class.everybody().await;
    let [student, grader, owner] = [1, 2, 4].map(|k| everybody[k].1.as_str());
    let asked = get(&class.server, &format!("/api/v1/lessons/{LESSON}")).await.json();
    let prediction = &asked["predictions"][0];
    let body = json!({"prediction": prediction["id"], "choice": prediction["options"][0]["id"], "why": "it is round"});
    let predict = format!("/api/v1/lessons/{LESSON}/predictions");
    assert_eq!(class.ask("POST", &predict, student, Some(body)).await.status, 201);
    let told = class.ask("POST", SUBMIT, student, Some(words(41))).await;
    assert_eq!(of(&told.json()).get("reference_html"), None, "a class explains in words of its own");

    let path = format!("/api/v1/assignments/{LESSON}/words");
    class.ask("GET", &path, student, None).await.problem(403, "not-yours");
    let read = said(&class, grader).await;
    assert_eq!(
        (&read["explanations"][0]["waiting"], &read["explanations"][0]["points"]),
        (&json!(1), &json!(2.0))
    );
    let one = read["students"][0].clone();
    assert_eq!((&one["name"], &one["predicted"][0]["why"]), (&json!("Student"), &json!("it is round")));
    assert_eq!(one["explained"][0]["text"], json!("because ".repeat(41)));
    assert_eq!(reached(&class, owner).await["points"], 0.0);

    let person = &one["person"];
    give(&class, grader, person, json!(2.5), "").await.problem(422, "invalid-decision");
    let whole = json!({"lesson": LESSON, "points": 2, "reason": " "});
    let decisions = format!("/api/v1/people/{}/decisions", person.as_str().expect("an id"));
    class.ask("POST", &decisions, grader, Some(whole)).await.problem(422, "invalid-decision");
    let judged = json!({"lesson": LESSON, "question": asked["exercise"]["questions"][0]["id"], "points": 1, "reason": ""});
    class.ask("POST", &decisions, grader, Some(judged)).await.problem(422, "invalid-decision");
    assert_eq!(give(&class, grader, person, json!(1.5), "where does its size come from?").await.status, 201);

    let stands = reached(&class, owner).await;
    assert_eq!(
        (&stands["points"], &stands["explained"], &stands["earned"]),
        (&json!(1.5), &json!(1.5), &json!(0.0))
    );
    assert_eq!(said(&class, grader).await["explanations"][0]["waiting"], 0);
    let own = class.ask("GET", "/api/v1/submissions", student, None).await.json();
    let mark = &of(&own[0])["mark"];
    assert_eq!((&mark["points"], &mark["remark"]), (&json!(1.5), &json!("where does its size come from?")));
    let record = class.ask("GET", "/api/v1/record", student, None).await.json();
    let remark = &record["lessons"][0]["remarks"][0];
    assert_eq!((&remark["kind"], &remark["question"]), (&json!("mark"), &json!("in-words")));

    // The same words beside another answer are no new ones; other words wait once more, and keep what was given.
    let mut again = words(41);
    again["answers"]["why"] = json!({"choice": "a"});
    assert_eq!(class.ask("POST", SUBMIT, student, Some(again)).await.status, 201);
    assert_eq!(said(&class, grader).await["explanations"][0]["waiting"], 0);
    assert_eq!(class.ask("POST", SUBMIT, student, Some(words(60))).await.status, 201);
    let renewed = said(&class, grader).await;
    assert_eq!(
        (&renewed["explanations"][0]["waiting"], &renewed["students"][0]["explained"][0]["renewed"]),
        (&json!(1), &json!(true))
    );
    assert_eq!(reached(&class, owner).await["points"], 1.5);
    let own = class.ask("GET", "/api/v1/submissions", student, None).await.json();
    assert_eq!(of(&own[0]).get("mark"), None, "nobody has read these words");
    // Taken back, it waits again and counts nothing.
    assert_eq!(give(&class, grader, person, Value::Null, "").await.status, 201);
    assert_eq!(reached(&class, owner).await["points"], 0.0);
}

/// Said in the exercise class, for example.
#[tokio::test]
async fn points_count_where_nothing_was_handed_in_and_in_previews() {
    let class = class().await;
    let everybody = class.everybody().await;
    let [student, grader, owner] = [1, 2, 4].map(|k| everybody[k].1.as_str());
    let person = class.ask("GET", "/api/v1/record", student, None).await.json()["id"].clone();
    assert_eq!(give(&class, grader, &person, json!(1.5), "told me").await.status, 201);
    let stands = reached(&class, owner).await;
    assert_eq!((&stands["points"], &stands["attempts"]), (&json!(1.5), &json!(0)));
    let preview = format!("/api/v1/assignments/{LESSON}/preview");
    let points = async |at: Value| {
        let body = json!({"person": person, "at": at});
        class.ask("POST", &preview, owner, Some(body)).await.json()["standing"]["points"].clone()
    };
    assert_eq!(points(Value::Null).await, json!(1.5));
    assert_eq!(points(json!("2020-01-01T00:00:00Z")).await, json!(0.0), "that was before");
    assert_eq!(give(&class, grader, &person, Value::Null, "").await.status, 201);
    assert_eq!(reached(&class, owner).await, Value::Null);
}

#[tokio::test]
async fn points_of_an_explanation_are_held_back_as_others_are() {
    let class = class().await;
    let everybody = class.everybody().await;
    let [student, grader, instructor] = [1, 2, 3].map(|k| everybody[k].1.as_str());
    let policy =
        json!({"reveal": {"points": "when_released", "messages": "when_released", "reference": "never"}});
    let set = format!("/api/v1/assignments/{LESSON}");
    assert!(class.ask("PUT", &set, instructor, Some(policy)).await.status.is_success());
    class.ask("POST", SUBMIT, student, Some(words(41))).await;
    let person = said(&class, grader).await["students"][0]["person"].clone();
    give(&class, grader, &person, json!(2), "a secret remark").await;
    for path in ["/api/v1/submissions", "/api/v1/record", "/api/v1/me/data"] {
        let told = class.ask("GET", path, student, None).await.json().to_string();
        assert!(!told.contains("secret remark"), "{path}: {told}");
    }
    let release = json!({"released": true});
    assert!(class.ask("PUT", &format!("{set}/release"), instructor, Some(release)).await.status.is_success());
    for path in ["/api/v1/submissions", "/api/v1/record", "/api/v1/me/data"] {
        let told = class.ask("GET", path, student, None).await.json().to_string();
        assert!(told.contains("secret remark"), "{path}: {told}");
    }
}
