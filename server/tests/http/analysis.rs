//! What the answers of a class say about its questions.

use serde_json::{Value, json};

use crate::class::{Class, class};

const LESSON: &str = "simple-pendulum";
const QUESTIONS: &str = "/api/v1/assignments/simple-pendulum/questions";

/// Somebody who hands in the force at the bottom, as a multiple of the bob's weight, and then an option.
async fn answers(class: &Class, name: &str, factors: &[f64], sign: &str) {
    let (cookie, _) = class.join(name).await;
    let lesson = class.ask("GET", "/api/v1/lessons/simple-pendulum", &cookie, None).await.json();
    let mass = lesson["scene"]["bodies"][0]["mass"].as_f64().expect("a mass");
    for factor in factors {
        let value = format!("{:.4}", factor * 9.81 * mass);
        let body = json!({"answers": {"tension-bottom": {"value": value, "unit": "N"}, "sign-of-lambda": {"choice": sign}}});
        let reply =
            class.ask("POST", "/api/v1/lessons/simple-pendulum/submissions", &cookie, Some(body)).await;
        assert_eq!(reply.status, 201, "{}", reply.json());
    }
}

#[tokio::test]
async fn mistakes_are_counted_by_student_with_the_answers_behind_each() {
    let class = class().await;
    let (owner, _) = class.enter("/api/v1/setup", json!({"token": class.setup, "name": "Prof"})).await;
    let see = async |path: &str| class.ask("GET", path, &owner, None).await;
    let empty = see(QUESTIONS).await.json();
    assert_eq!((&empty["students"], &empty["questions"][1]["answered"]), (&json!(0), &json!(0)));

    answers(&class, "Ada", &[1.0, 3.0], "b").await;
    answers(&class, "Bob", &[1.0, 1.0, 2.0], "a").await;
    answers(&class, "=Cyd", &[3.02], "b").await;
    answers(&class, "Dee", &[3.0], "b").await;
    let lesson = see(QUESTIONS).await.json();
    let tension =
        lesson["questions"].as_array().expect("questions").iter().find(|one| one["id"] == "tension-bottom");
    let tension = tension.expect("the question");
    // First answers: wrong, wrong, wrong, right; best: right, wrong, wrong, right.
    let shares = (&tension["facility"], &tension["facility_best"]);
    assert_eq!(shares, (&json!(0.25), &json!(0.5)), "{tension}");
    assert_eq!((&tension["answered"], &tension["right"]), (&json!(4), &json!(2)));
    assert_eq!(tension["until_right"], json!([1, 1, 0, 0, 0]));
    let counted = json!([{"name": "static", "students": 2, "still": 0}, {"name": "nearly", "students": 1, "still": 1},
        {"name": "weight-forgotten", "students": 1, "still": 1}]);
    assert_eq!(tension["mistakes"], counted);
    assert!(!lesson.to_string().contains("Bob"), "figures have no names");

    let found = see(&format!("{QUESTIONS}/tension-bottom")).await.json();
    let of_static = &found["mistakes"][0];
    let who = |k: usize| (of_static["answers"][k]["name"].clone(), of_static["answers"][k]["mended"].clone());
    assert_eq!((who(0), who(1)), ((json!("Ada"), json!(true)), (json!("Bob"), json!(false))));
    assert!(of_static["told_html"].as_str().is_some_and(|html| html.contains("rests")), "{of_static}");
    assert_eq!(
        (&found["almost"], &found["sent_back"]),
        (&json!(1), &json!(0)),
        "3.02 is within three tolerances"
    );
    // Three were wrong; whoever looks again draws nobody's numbers.
    assert_eq!(class.app.near.drawn(), 3);
    let again = see(&format!("{QUESTIONS}/tension-bottom")).await.json();
    assert_eq!((again["almost"].clone(), class.app.near.drawn()), (json!(1), 3));
    let names: Vec<&Value> =
        found["drawn"].as_array().expect("numbers").iter().map(|one| &one["name"]).collect();
    assert!(names.contains(&&json!("m")), "{names:?}");

    let sign = see(&format!("{QUESTIONS}/sign-of-lambda")).await.json();
    let right = sign["choices"].as_array().expect("options").iter().find(|one| one["right"] == true);
    let right = right.expect("a right option");
    assert_eq!((&right["id"], &right["first"], &right["last"]), (&json!("b"), &json!(3), &json!(3)));

    see(&format!("{QUESTIONS}/none")).await.problem(404, "unknown-question");
    let text = async |path: &str| String::from_utf8_lossy(&see(path).await.bytes).into_owned();
    let all = text(&format!("{QUESTIONS}/tension-bottom/answers.csv")).await;
    assert!(all.contains("\"'=Cyd\"") && all.contains("\"static\"") && all.lines().count() == 8, "{all}");
    let sheet = text(&format!("{QUESTIONS}.csv")).await;
    assert!(sheet.contains("\"tension-bottom\",\"3\",\"4\",\"4\",\"2\",\"0.250\",\"0.500\""), "{sheet}");
    assert_eq!(LESSON, found["lesson"]);
}
