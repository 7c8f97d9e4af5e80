//! When an exercise of a class can be handed in, what then counts, and what is told.

use serde_json::{Value, json};
use triad::policy::Moment;
use triad::store::CLASS;

use crate::Reply;
use crate::class::{Class, class};

const LESSON: &str = "simple-pendulum";
const SUBMIT: &str = "/api/v1/lessons/simple-pendulum/submissions";
const POLICY: &str = "/api/v1/assignments/simple-pendulum";
/// An hour, in milliseconds.
const HOUR: i64 = 3_600_000;

/// A class with a teacher and a student, who knows a right answer.
struct Course {
    class: Class,
    owner: String,
    ada: String,
    id: String,
    right: String,
}

async fn course() -> Course {
    let class = class().await;
    let (owner, _) = class.enter("/api/v1/setup", json!({"token": class.setup, "name": "Prof"})).await;
    let (ada, told) = class.join("Ada").await;
    let id = told["person"]["id"].as_str().expect("an id").to_owned();
    let lesson = class.ask("GET", "/api/v1/lessons/simple-pendulum", &ada, None).await.json();
    // Three times the weight of her own bob.
    let right = format!("{:.4}", 3.0 * 9.81 * lesson["scene"]["bodies"][0]["mass"].as_f64().expect("a mass"));
    Course { class, owner, ada, id, right }
}

impl Course {
    async fn set(&self, policy: Value) -> Reply {
        self.class.ask("PUT", POLICY, &self.owner, Some(policy)).await
    }

    async fn submit(&self, value: &str) -> Reply {
        let body = json!({"answers": {"tension-bottom": {"value": value, "unit": "N"}}});
        self.class.ask("POST", SUBMIT, &self.ada, Some(body)).await
    }

    async fn see(&self, path: &str) -> Reply {
        self.class.ask("GET", path, &self.ada, None).await
    }

    async fn preview(&self, body: Value) -> Value {
        self.class.ask("POST", &format!("{POLICY}/preview"), &self.owner, Some(body)).await.json()
    }
}

fn from_now(hours: i64) -> Value {
    json!(Moment::now().after(hours * HOUR))
}

/// The text of an answer without what differs between any two submissions.
fn alike(reply: &Reply) -> String {
    let mut document = reply.json();
    for name in ["id", "submitted_at"] {
        document.as_object_mut().expect("an object").remove(name);
    }
    document.to_string()
}

#[tokio::test]
async fn results_that_are_held_back_are_absent_from_the_bytes() {
    let course = course().await;
    let held = json!({"reveal": {"points": "when_released", "messages": "when_released", "reference": "when_released"}});
    assert_eq!(course.set(held).await.status, 204);
    let (wrong, right) = (course.submit("1.000").await, course.submit(&course.right).await);
    assert_eq!((wrong.status.as_u16(), right.status.as_u16()), (201, 201));
    assert_eq!(alike(&wrong), alike(&right), "nothing tells a right answer from a wrong one");
    let id = right.json()["id"].as_str().expect("an id").to_owned();
    let places = [
        "/api/v1/submissions".to_owned(),
        "/api/v1/record".into(),
        "/api/v1/me/data".into(),
        format!("/api/v1/submissions/{id}/verdicts"),
    ];
    let forbidden = [
        "\"earned\"",
        "\"passed\"",
        "\"right\"",
        "\"wrong\"",
        "\"slip\"",
        "\"best\"",
        "\"figure_svg\"",
        "\"reference_html\"",
        "\"credits\"",
        "three times",
        "Three times",
    ];
    for place in &places {
        let seen = course.see(place).await;
        let text = String::from_utf8_lossy(&seen.bytes).into_owned();
        assert_eq!(seen.status, 200, "{place}: {text}");
        for word in forbidden {
            assert!(!text.contains(word), "{place} tells {word}: {text}");
        }
    }
    // Those who teach see it.
    let mine = course.class.ask("GET", "/api/v1/standings", &course.owner, None).await.json();
    assert_eq!(mine["students"][0]["lessons"][LESSON]["points"], 3.0);

    let release = format!("{POLICY}/release");
    let released = course.class.ask("PUT", &release, &course.owner, Some(json!({"released": true}))).await;
    assert_eq!(released.status, 204);
    let told = course.see("/api/v1/submissions").await.json();
    assert_eq!((&told[0]["earned"], &told[0]["questions"][1]["verdict"]), (&json!(3.0), &json!("right")));
    assert!(
        told[0]["questions"][2]["reference_html"].is_string(),
        "the right answers were to be told now: {told}"
    );
    let record = course.see("/api/v1/record").await.json();
    assert_eq!(record["lessons"][0]["standing"]["points"]["points"], 3.0);
    course.class.ask("PUT", &release, &course.owner, Some(json!({"released": false}))).await;
    assert_eq!(course.see("/api/v1/submissions").await.json()[0].get("earned"), None);
}

/// To be asked for more digits would tell that those are right, and use no attempt.
#[tokio::test]
async fn few_digits_tell_nothing_while_results_are_held_back() {
    let course = course().await;
    course.set(json!({"reveal": {"points": "when_released", "messages": "when_released"}})).await;
    let right: f64 = course.right.parse().expect("a number");
    let (near, far) = (course.submit(&format!("{right:.0e}")).await, course.submit("9e3").await);
    assert_eq!((near.status.as_u16(), far.status.as_u16()), (201, 201), "{}", near.json());
    assert_eq!(alike(&near), alike(&far));
    let record = course.see("/api/v1/record").await.json();
    assert_eq!(record["lessons"][0]["standing"]["attempts"], 2);
    let rebuilt = triad::regrade::check(&course.class.app.store, CLASS).await.expect("rebuilds");
    assert_eq!((rebuilt.same, rebuilt.changed.len()), (2, 0), "{rebuilt:?}");
}

#[tokio::test]
async fn dates_attempts_and_extensions_bound_what_is_handed_in() {
    let course = course().await;
    course.set(json!({"opens": from_now(1)})).await;
    course.submit("1.000").await.problem(409, "not-open");
    course.set(json!({"due": from_now(-2), "closes": from_now(-1)})).await;
    course.submit("1.000").await.problem(409, "closed");
    let extension = format!("{POLICY}/extensions/{}", course.id);
    let extend = async |body: Value| course.class.ask("PUT", &extension, &course.owner, Some(body)).await;
    extend(json!({"until": from_now(1)})).await.problem(422, "invalid-request");
    extend(json!({"reason": "nothing"})).await.problem(422, "invalid-extension");
    assert_eq!(extend(json!({"until": from_now(1), "reason": "was ill"})).await.status, 204);
    assert_eq!(course.submit("1.000").await.status, 201);
    let record = course.see("/api/v1/record").await.json();
    assert_eq!(record["lessons"][0]["extension"]["reason"], "was ill");

    course.set(json!({"most_attempts": 1, "cooldown_minutes": 5})).await;
    course.submit("2.000").await.problem(409, "attempts-used");
    extend(json!({"attempts": 1, "reason": "the network failed"})).await;
    course.submit("2.000").await.problem(409, "too-soon");
    course.set(json!({"most_attempts": 1})).await;
    assert_eq!(course.submit("2.000").await.status, 201);
    let taken = course.class.ask("DELETE", &extension, &course.owner, None).await;
    assert_eq!(taken.status, 204);
    course.submit("3.000").await.problem(409, "attempts-used");
    course.set(json!({"due": from_now(1), "closes": from_now(0)})).await.problem(422, "invalid-policy");
    course.set(json!({"due": "tomorrow"})).await.problem(422, "invalid-request");
}

/// Two teachers, or one twice: one gives time, the other an attempt.
#[tokio::test]
async fn an_extension_adds_to_the_one_before() {
    let course = course().await;
    let extension = format!("{POLICY}/extensions/{}", course.id);
    let extend = async |mut body: Value| {
        body["reason"] = json!("was ill");
        course.class.ask("PUT", &extension, &course.owner, Some(body)).await
    };
    let given = async || {
        let lesson = course.see("/api/v1/record").await.json()["lessons"][0].clone();
        (lesson["extension"]["until"].is_string(), lesson["extension"]["attempts"].clone())
    };
    course.set(json!({"due": from_now(-2), "closes": from_now(-1), "most_attempts": 1})).await;
    assert_eq!(extend(json!({"until": from_now(1)})).await.status, 204);
    assert_eq!(extend(json!({"attempts": 2})).await.status, 204);
    assert_eq!(given().await, (true, json!(2)));
    // As the page's form sends it, with the number that it begins with.
    assert_eq!(extend(json!({"until": from_now(2), "attempts": 0})).await.status, 204);
    assert_eq!(given().await, (true, json!(2)));
    assert_eq!(extend(json!({"attempts": null})).await.status, 204);
    assert_eq!(given().await, (true, json!(0)));
    assert_eq!(extend(json!({"until": null})).await.status, 204);
    assert_eq!(given().await, (false, Value::Null));

    // What everybody may is no extension.
    extend(json!({"until": from_now(-3)})).await.problem(422, "invalid-extension");
    extend(json!({"attempts": 0})).await.problem(422, "invalid-extension");
    course.set(json!({})).await;
    extend(json!({"attempts": 5})).await.problem(422, "invalid-extension");
    assert_eq!(given().await, (false, Value::Null));
}

#[tokio::test]
async fn a_policy_is_looked_at_for_any_student_and_time_before_it_counts() {
    let course = course().await;
    assert_eq!(course.submit(&course.right).await.status, 201);
    let policy = json!({"due": from_now(-3), "late": [{"until": from_now(2), "share": 0.5}],
        "reveal": {"points": "after_due"}});
    let seen = course.preview(json!({"policy": policy, "person": course.id})).await;
    assert_eq!((&seen["standing"]["points"], &seen["standing"]["phase"]), (&json!(1.5), &json!("late")));
    assert_eq!(seen["told"].get("earned"), None, "before the last late step it is held back");
    let later = course.preview(json!({"policy": policy, "person": course.id, "at": from_now(3)})).await;
    assert_eq!((&later["standing"]["phase"], &later["told"]["earned"]), (&json!("practice"), &json!(3.0)));
    let before = course.preview(json!({"policy": policy, "person": course.id, "at": from_now(-1)})).await;
    assert_eq!((&before["standing"]["points"], before.get("told")), (&json!(0.0), None));
    let nobody = course.preview(json!({"policy": policy})).await;
    assert_eq!(nobody["standing"]["worth"], 0.5);
    // Nothing of it counts yet.
    let record = course.see("/api/v1/record").await.json();
    assert_eq!(record["lessons"][0]["standing"]["points"]["points"], 3.0);
}

#[tokio::test]
async fn a_student_asks_to_look_again_and_sees_what_is_answered() {
    let course = course().await;
    let ask = async || {
        let body = json!({"lesson": LESSON, "text": "Is that not right too?"});
        course.class.ask("POST", "/api/v1/record/requests", &course.ada, Some(body)).await
    };
    ask().await.problem(409, "nothing-handed-in");
    let submitted = course.submit("1.000").await.json();
    assert_eq!(ask().await.status, 201);
    ask().await.problem(409, "asked-before");
    let asked = async || {
        let table = course.class.ask("GET", "/api/v1/standings", &course.owner, None).await.json();
        table["students"][0]["lessons"][LESSON]["asked"].clone()
    };
    assert_eq!(asked().await, json!(true));
    let comment = format!("/api/v1/people/{}/comments", course.id);
    let body = json!({"lesson": LESSON, "text": "Look at the speed at the bottom."});
    assert_eq!(course.class.ask("POST", &comment, &course.owner, Some(body)).await.status, 201);
    assert_eq!(asked().await, json!(false));
    let remarks = course.see("/api/v1/record").await.json()["lessons"][0]["remarks"].clone();
    assert_eq!((&remarks[0]["kind"], &remarks[1]["by"]), (&json!("request"), &json!("Prof")));
    // What is one's own is nobody else's.
    let (eve, _) = course.class.join("Eve").await;
    let verdicts = format!("/api/v1/submissions/{}/verdicts", submitted["id"].as_str().expect("an id"));
    course.class.ask("GET", &verdicts, &eve, None).await.problem(404, "unknown-entry");
    assert_eq!(course.see(&verdicts).await.json().as_array().map(Vec::len), Some(1));
    let whole = format!("/api/v1/people/{}/record", course.id);
    course.class.ask("GET", &whole, &eve, None).await.problem(403, "not-yours");
    assert_eq!(course.class.ask("GET", &whole, &course.owner, None).await.json()["name"], "Ada");
}

/// Two who teach look at one policy; each sets something else.
#[tokio::test]
async fn a_policy_that_was_set_meanwhile_is_not_overwritten() {
    let course = course().await;
    let seen = async || {
        let all = course.class.ask("GET", "/api/v1/assignments", &course.owner, None).await.json();
        all.as_array().expect("a list").iter().find(|one| one["slug"] == LESSON).expect("the lesson").clone()
    };
    let set = async |version: &str, policy: Value| {
        let path = format!("{POLICY}?version={version}");
        course.class.ask("PUT", &path, &course.owner, Some(policy)).await
    };
    let first = seen().await["version"].as_str().expect("a version").to_owned();
    let mine = set(&first, json!({"most_attempts": 3})).await;
    assert_eq!(mine.status, 204);
    let refused = set(&first, json!({"cooldown_minutes": 5})).await;
    refused.problem(409, "policy-changed");
    assert_eq!(seen().await["policy"]["most_attempts"], 3, "what was set first stays");
    // Whoever set it goes on from there without looking again.
    let tag = |reply: &Reply| reply.headers["etag"].to_str().expect("text").to_owned();
    let second = tag(&mine).trim_matches('"').to_owned();
    assert_eq!(seen().await["version"], json!(second));
    assert_eq!(set(&second, json!({"most_attempts": 4})).await.status, 204);
    // The same policy as before is the same version; without one whatever there is is replaced.
    assert_eq!(tag(&course.set(json!({"most_attempts": 3})).await), format!("\"{second}\""));
    assert_eq!(course.class.app.store.faults().await.expect("looks"), Vec::<String>::new());
}

#[tokio::test]
async fn a_lesson_promises_no_right_answers_that_its_policy_does_not_tell() {
    let course = course().await;
    let promised = async |policy: Value| {
        course.set(policy).await;
        let lesson = course.see("/api/v1/lessons/simple-pendulum").await.json();
        lesson["exercise"]["opens"].as_str().map(str::to_owned)
    };
    let usual = promised(json!({})).await.expect("a rule");
    assert!(usual.contains("is shown when"), "{usual}");
    for word in ["never", "when_released"] {
        assert_eq!(promised(json!({"reveal": {"reference": word}})).await, None);
    }
    // Nothing is told, and the points are settled all the same: whoever hands in again knows it before.
    let held = promised(json!({"reveal": {"points": "when_released"}})).await.expect("a rule");
    assert!(held.contains("settled all the same") && held.contains("not told of it"), "{held}");
    assert!(!held.contains("is shown when"), "{held}");
    assert_eq!(promised(json!({})).await, Some(usual));
}

/// What cannot be written as a date would be told as none.
#[tokio::test]
async fn dates_and_pauses_beyond_all_bounds_are_refused_by_name() {
    let course = course().await;
    let far = "9999-12-30T18:00:00Z";
    let late = json!({"due": from_now(1), "late": [{"until": far, "share": 0.5}]});
    for (policy, place, said) in [
        (json!({"cooldown_minutes": u32::MAX}), "/cooldown_minutes", "cooldown_minutes is more than 525600"),
        (json!({"opens": "1890-01-01T00:00:00Z"}), "/opens", "opens lies outside of the years 1970 to 2999"),
        (json!({"due": far}), "/due", "due lies outside of the years 1970 to 2999"),
        (late, "/late/0/until", "late/0/until lies outside of the years 1970 to 2999"),
        (json!({"closes": far}), "/closes", "closes lies outside of the years 1970 to 2999"),
    ] {
        let refused = course.set(policy).await.problem(422, "invalid-policy");
        assert_eq!(refused["errors"][0]["pointer"], format!("#{place}"), "{refused}");
        assert!(refused["detail"].as_str().is_some_and(|text| text.contains(said)), "{refused}");
    }
    let last = json!({"due": from_now(-1), "closes": "2999-12-31T23:59:59Z", "cooldown_minutes": 525_600});
    assert_eq!(course.set(last).await.status, 204);
    let extension = format!("{POLICY}/extensions/{}", course.id);
    let body = json!({"until": far, "reason": "was ill"});
    let refused = course.class.ask("PUT", &extension, &course.owner, Some(body)).await;
    let refused = refused.problem(422, "invalid-extension");
    assert_eq!(refused["detail"], "until lies outside of the years 1970 to 2999");
    let body = json!({"until": "2999-12-31T23:59:59Z", "reason": "was ill"});
    assert_eq!(course.class.ask("PUT", &extension, &course.owner, Some(body)).await.status, 204);
    course.submit("1.000").await;
    let turn = course.see("/api/v1/record").await.json()["lessons"][0]["standing"].clone();
    for date in ["due", "closes", "next_attempt"] {
        assert!(turn[date].as_str().is_some_and(|text| text.ends_with('Z')), "{date}: {turn}");
    }
}

#[tokio::test]
async fn exported_lines_have_no_zero_with_a_sign() {
    let course = course().await;
    assert_eq!(course.submit("1.000").await.status, 201);
    let decisions = format!("/api/v1/people/{}/decisions", course.id);
    let body = json!({"lesson": LESSON, "points": -0.0, "reason": "copied"});
    assert_eq!(course.class.ask("POST", &decisions, &course.owner, Some(body)).await.status, 201);
    let told = course.class.ask("GET", "/api/v1/standings.jsonl", &course.owner, None).await;
    let text = String::from_utf8_lossy(&told.bytes).into_owned();
    assert!(text.contains("\"predicted\":0.0") && text.contains("\"explained\":0.0"), "{text}");
    assert!(text.contains("\"points\":0.0"), "{text}");
}
