//! Predictions: kept once, told again, counted for those who teach, worth what the author says.

use serde_json::{Value, json};

use crate::class::class;
use crate::{get, post, server};

const PULL: &str = "/api/v1/lessons/simple-pendulum/predictions";

#[tokio::test]
async fn a_prediction_is_kept_once_and_then_tells_what_happens() {
    let server = server();
    let lesson = get(&server, "/api/v1/lessons/simple-pendulum").await.json();
    let asked = &lesson["predictions"][0];
    assert_eq!((&asked["id"], &asked["options"][2]["id"]), (&json!("pull-at-bottom"), &json!("three")));
    for secret in ["happens", "shows", "measured", "outcome"] {
        assert!(asked.get(secret).is_none(), "{secret} left the server");
    }
    let say = async |choice: Value, student: &str| {
        let body = json!({"student": student, "prediction": "pull-at-bottom", "choice": choice, "why": " it is round "});
        post(&server, PULL, body).await
    };
    let first = say(json!("two"), "Ada").await;
    assert_eq!(first.status, 201);
    let kept = first.json();
    assert_eq!((&kept["choice"], &kept["why"]), (&json!("two"), &json!("it is round")));
    assert_eq!(kept["outcome"]["happens"], "three");
    let again = say(json!("three"), " ada ").await;
    assert_eq!((again.status.as_u16(), again.json()), (200, kept.clone()));
    assert_eq!(get(&server, &format!("{PULL}?student=ADA")).await.json(), json!([kept]));
    assert_eq!(get(&server, &format!("{PULL}?student=Eve")).await.json(), json!([]));

    let skipped = say(Value::Null, "Eve").await;
    assert_eq!((skipped.status.as_u16(), skipped.json().get("choice").cloned()), (201, None));
    let counts = get(&server, &format!("{PULL}/counts")).await.json();
    assert_eq!((&counts[0]["chosen"], &counts[0]["skipped"]), (&json!([0, 1, 0, 0]), &json!(1)));
    assert_eq!((&counts[0]["missing"], &counts[0]["reasons"][0]["name"]), (&json!(0), &json!("Ada")));
}

#[tokio::test]
async fn what_is_no_prediction_is_refused_with_its_place() {
    let server = server();
    let refused = async |body: Value, pointer: &str| {
        let problem = post(&server, PULL, body).await.problem(422, "invalid-prediction");
        assert_eq!(problem["errors"][0]["pointer"], format!("#{pointer}"), "{problem}");
    };
    refused(json!({"student": "Ada", "prediction": "pul"}), "/prediction").await;
    refused(json!({"student": "Ada", "prediction": "pull-at-bottom", "choice": "four"}), "/choice").await;
    let long = "why ".repeat(300);
    refused(json!({"student": "Ada", "prediction": "pull-at-bottom", "choice": "two", "why": long}), "/why")
        .await;
    let nobody = json!({"prediction": "pull-at-bottom", "choice": "two"});
    post(&server, PULL, nobody).await.problem(422, "invalid-student");
}

#[tokio::test]
async fn a_class_is_counted_and_predicting_earns_what_the_author_says() {
    let class = class().await;
    let everybody = class.everybody().await;
    let [student, grader, owner] = [1, 2, 4].map(|k| everybody[k].1.as_str());
    let path = "/api/v1/lessons/inverse-dynamics/predictions";
    let body = |choice: Value| json!({"prediction": "upper-end", "choice": choice});
    let named = json!({"student": "Eve", "prediction": "upper-end", "choice": "up"});
    class.ask("POST", path, student, Some(named)).await.problem(403, "not-your-numbers");
    assert_eq!(class.ask("POST", path, student, Some(body(json!("up")))).await.status, 201);
    assert_eq!(class.ask("POST", path, grader, Some(body(json!("down")))).await.status, 201);
    let (second, _) = class.join("Zoë").await;
    assert_eq!(class.ask("POST", path, &second, Some(body(Value::Null))).await.status, 201);
    class.join("Late").await;

    let counts = format!("{path}/counts");
    class.ask("GET", &counts, student, None).await.problem(403, "not-yours");
    let counted = class.ask("GET", &counts, grader, None).await.json();
    assert_eq!(counted[0]["chosen"], json!([1, 0, 0]), "who teaches is not counted: {counted}");
    assert_eq!((&counted[0]["skipped"], &counted[0]["missing"]), (&json!(1), &json!(1)));
    // Wrong, but predicted: the point of the author. Skipped: none.
    let table = class.ask("GET", "/api/v1/standings", owner, None).await.json();
    let of = |name: &str| {
        let rows = table["students"].as_array().expect("rows");
        rows.iter().find(|row| row["name"] == name).expect("a row")["lessons"]["inverse-dynamics"].clone()
    };
    assert_eq!((&of("Student")["predicted"], &of("Student")["points"]), (&json!(1.0), &json!(1.0)));
    assert_eq!(of("Zoë"), Value::Null);
}

#[tokio::test]
async fn a_student_of_a_class_predicts_or_skips_before_the_run_goes_on() {
    let class = class().await;
    let everybody = class.everybody().await;
    let [student, grader] = [1, 2].map(|k| everybody[k].1.as_str());
    let lesson = json!({"lesson": "simple-pendulum"});
    let opened = async |cookie: &str, body: &Value| {
        let reply = class.ask("POST", "/api/v1/sessions", cookie, Some(body.clone())).await;
        assert_eq!(reply.status, 201);
        format!("/api/v1/sessions/{}", reply.json()["id"].as_str().expect("an id"))
    };
    let run = async |session: &str, what: &str, cookie: &str| {
        let body = if what == "step" { json!({"seconds": 0.1}) } else { json!({}) };
        class.ask("POST", &format!("{session}/{what}"), cookie, Some(body)).await
    };
    let own = opened(student, &lesson).await;
    for what in ["step", "play"] {
        let problem = run(&own, what, student).await.problem(409, "predict-first");
        assert!(problem["detail"].to_string().contains("pull-at-bottom"), "{problem}");
        // Whoever has the key of the run is told the same.
        run(&own, what, grader).await.problem(409, "predict-first");
    }
    assert_eq!(class.ask("GET", &own, student, None).await.json()["time"], 0.0);
    // Who teaches shows it to others, and what no lesson asks about goes on.
    assert_eq!(run(&opened(grader, &lesson).await, "step", grader).await.status, 200);
    let scene = opened(student, &json!({"builtin": "simple-pendulum"})).await;
    assert_eq!(run(&scene, "step", student).await.status, 200);
    let skipped = json!({"prediction": "pull-at-bottom", "choice": null});
    assert_eq!(class.ask("POST", PULL, student, Some(skipped)).await.status, 201);
    for what in ["step", "play"] {
        assert_eq!(run(&own, what, student).await.status, 200);
    }
}

#[tokio::test]
async fn a_prediction_is_made_while_the_exercise_can_be_handed_in() {
    let class = class().await;
    let everybody = class.everybody().await;
    let [student, owner] = [1, 4].map(|k| everybody[k].1.as_str());
    let (second, _) = class.join("Zoë").await;
    let predict = async |who: &str, choice: Value| {
        let body = json!({"prediction": "upper-end", "choice": choice});
        class.ask("POST", "/api/v1/lessons/inverse-dynamics/predictions", who, Some(body)).await
    };
    let set = async |policy: Value| {
        let reply = class.ask("PUT", "/api/v1/assignments/inverse-dynamics", owner, Some(policy)).await;
        assert_eq!(reply.status, 204);
    };
    set(json!({"opens": "2100-01-01T00:00:00Z"})).await;
    predict(student, json!("up")).await.problem(409, "not-open");
    set(json!({})).await;
    assert_eq!(predict(student, json!("up")).await.status, 201);
    set(json!({"due": "2020-01-01T00:00:00Z", "closes": "2020-01-02T00:00:00Z"})).await;
    predict(&second, json!("up")).await.problem(409, "closed");
    // What was said before is told again, and the run does not wait for ever.
    assert_eq!(predict(student, json!("up")).await.status, 200);
    assert_eq!(predict(&second, Value::Null).await.status, 201);
    assert_eq!(class.app.store.faults().await.expect("looks"), Vec::<String>::new());
}
