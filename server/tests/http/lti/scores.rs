//! Scores reach the platform: only what changed, never what is held back, whatever the platform does meanwhile.

use serde_json::{Value, json};
use triad::lti::{Lti, scores};
use triad::policy::Moment;

use super::platform::Seen;
use super::{LESSON, School, school};

/// An hour, in milliseconds.
const HOUR: i64 = 3_600_000;

/// A class with a teacher and a student who came from the platform.
struct Lesson {
    school: School,
    teacher: String,
    ada: String,
    id: String,
    right: String,
}

async fn lesson() -> Lesson {
    let school = school().await;
    let (teacher, _) = school.enter("prof", "Instructor").await;
    let (ada, me) = school.enter("ada", "Learner").await;
    let id = me["id"].as_str().expect("an id").to_owned();
    let lesson = school.class.ask("GET", &format!("/api/v1/lessons/{LESSON}"), &ada, None).await.json();
    // Three times the weight of her own bob.
    let right = format!("{:.4}", 3.0 * 9.81 * lesson["scene"]["bodies"][0]["mass"].as_f64().expect("a mass"));
    Lesson { school, teacher, ada, id, right }
}

impl Lesson {
    async fn submit(&self, value: &str) {
        let body = json!({"answers": {"tension-bottom": {"value": value, "unit": "N"}}});
        let path = format!("/api/v1/lessons/{LESSON}/submissions");
        assert_eq!(self.school.class.ask("POST", &path, &self.ada, Some(body)).await.status, 201);
    }

    async fn decide(&self, points: Value) {
        let body = json!({"lesson": LESSON, "points": points, "reason": "looked at it"});
        let path = format!("/api/v1/people/{}/decisions", self.id);
        assert_eq!(self.school.class.ask("POST", &path, &self.teacher, Some(body)).await.status, 201);
    }

    async fn set(&self, policy: Value) {
        let path = format!("/api/v1/assignments/{LESSON}");
        assert_eq!(self.school.class.ask("PUT", &path, &self.teacher, Some(policy)).await.status, 204);
    }

    /// Looks what is to be told and tells it, at a moment after now; how many scores were taken.
    async fn round(&self, later: i64) -> usize {
        self.round_of(self.school.class.app.lti.as_deref().expect("reached"), later).await
    }

    async fn round_of(&self, lti: &Lti, later: i64) -> usize {
        let app = &self.school.class.app;
        scores::plan(&app.store, &app.course, Moment::now().after(later)).await.expect("planned");
        let clock = || Moment::now().after(later);
        scores::deliver(lti, &app.store, &app.course, &clock).await.expect("delivered")
    }

    fn seen<T>(&self, look: impl FnOnce(&mut Seen) -> T) -> T {
        look(&mut self.school.platform.seen.lock().expect("whole"))
    }

    fn given(&self) -> Vec<f64> {
        self.seen(|seen| {
            seen.scores.iter().map(|(_, body)| body["scoreGiven"].as_f64().expect("points")).collect()
        })
    }

    async fn column(&self) -> Value {
        let state = self.school.class.ask("GET", "/api/v1/lti", &self.teacher, None).await.json();
        state["platforms"][0]["columns"][0].clone()
    }
}

#[tokio::test]
async fn only_what_changed_is_sent_into_a_column_that_is_made_once() {
    let lesson = lesson().await;
    assert_eq!(lesson.round(0).await, 0, "nothing was handed in");
    assert_eq!(lesson.seen(|seen| seen.made.len()), 1, "the column is there before the first score");
    lesson.submit("1.000").await;
    assert_eq!((lesson.round(0).await, lesson.given()), (1, vec![0.0]));
    assert_eq!(lesson.round(0).await, 0, "nothing changed");
    lesson.submit("2.000").await;
    assert_eq!(lesson.round(0).await, 0, "a try that earns no more changes nothing");
    lesson.submit(&lesson.right).await;
    assert_eq!((lesson.round(0).await, lesson.given()), (1, vec![0.0, 3.0]));
    lesson.decide(json!(5)).await;
    assert_eq!(lesson.round(0).await, 1);
    lesson.decide(Value::Null).await;
    assert_eq!((lesson.round(0).await, lesson.given()), (1, vec![0.0, 3.0, 5.0, 3.0]));

    let sent = lesson.seen(|seen| seen.scores.clone());
    let (place, first) = &sent[0];
    assert_eq!((place.as_str(), &first["userId"]), ("0", &json!("ada")));
    assert_eq!(
        (&first["gradingProgress"], &first["activityProgress"]),
        (&json!("FullyGraded"), &json!("Submitted"))
    );
    assert_eq!(first["scoreMaximum"], lesson.seen(|seen| seen.made[0]["scoreMaximum"].clone()));
    assert!(first["submission"]["submittedAt"].is_string() && first.get("comment").is_none());
    let times: Vec<&str> = sent.iter().map(|(_, body)| body["timestamp"].as_str().expect("a time")).collect();
    assert!(times.is_sorted_by(|a, b| a < b), "strictly growing: {times:?}");
    assert!(times.iter().all(|time| time.len() == "2026-11-23T10:00:00.000Z".len()), "{times:?}");
    assert_eq!(
        lesson.seen(|seen| (seen.tokens, seen.made.len())),
        (2, 1),
        "a token for columns, one for scores"
    );
    let column = lesson.column().await;
    assert_eq!(
        (&column["lesson"], &column["scores"], &column["sent"]),
        (&json!(LESSON), &json!(1), &json!(1))
    );
}

#[tokio::test]
async fn while_an_explanation_waits_for_points_the_platform_is_told_so() {
    const EXPLAINED: &str = "virtual-work";
    let lesson = lesson().await;
    let links = |word: &mut Value| {
        let target = word["https://purl.imsglobal.org/spec/lti/claim/target_link_uri"].take();
        let elsewhere = target.as_str().expect("an address").replace(LESSON, EXPLAINED);
        word["https://purl.imsglobal.org/spec/lti/claim/target_link_uri"] = json!(elsewhere);
        word["https://purl.imsglobal.org/spec/lti/claim/custom"] = json!({"lesson": EXPLAINED});
    };
    assert_eq!(lesson.school.open_with("ada", "Learner", links).await.status, 303);
    let submit = async |words: usize| {
        let answers = json!({"in-words": {"value": "because ".repeat(words)}});
        let path = format!("/api/v1/lessons/{EXPLAINED}/submissions");
        let told =
            lesson.school.class.ask("POST", &path, &lesson.ada, Some(json!({"answers": answers}))).await;
        assert_eq!(told.status, 201);
    };
    let mark = async |question: Option<&str>, points: Value| {
        let body = json!({"lesson": EXPLAINED, "question": question, "points": points, "reason": "read"});
        let path = format!("/api/v1/people/{}/decisions", lesson.id);
        assert_eq!(lesson.school.class.ask("POST", &path, &lesson.teacher, Some(body)).await.status, 201);
    };
    let last = async || {
        assert_eq!(lesson.round(0).await, 1);
        assert_eq!(lesson.round(0).await, 0, "it is told once");
        lesson.seen(|seen| {
            let (_, body) = seen.scores.last().expect("a score");
            (body["gradingProgress"].as_str().expect("text").to_owned(), body["scoreGiven"].clone())
        })
    };
    let told = |how: &str, points: f64| (how.to_owned(), json!(points));

    submit(45).await;
    assert_eq!(last().await, told("PendingManual", 0.0));
    // No points are points, too: nothing but the state changes.
    mark(Some("in-words"), json!(0)).await;
    assert_eq!(last().await, told("FullyGraded", 0.0));
    mark(Some("in-words"), json!(1.5)).await;
    assert_eq!(last().await, told("FullyGraded", 1.5));
    submit(60).await;
    assert_eq!(last().await, told("PendingManual", 1.5), "other words wait once more");
    // Whoever decides about all points has decided about these.
    mark(None, json!(4)).await;
    assert_eq!(last().await, told("FullyGraded", 4.0));
}

#[tokio::test]
async fn two_scores_within_a_millisecond_have_growing_times() {
    let lesson = lesson().await;
    let app = &lesson.school.class.app;
    let lti = app.lti.as_deref().expect("reached");
    let frozen = Moment::now().after(HOUR);
    let clock = || frozen;
    for points in [1, 2, 3] {
        lesson.decide(json!(points)).await;
        scores::plan(&app.store, &app.course, frozen).await.expect("planned");
        assert_eq!(scores::deliver(lti, &app.store, &app.course, &clock).await.expect("delivered"), 1);
    }
    let times = lesson
        .seen(|seen| seen.scores.iter().map(|(_, body)| body["timestamp"].to_string()).collect::<Vec<_>>());
    assert!(times.is_sorted_by(|a, b| a < b), "{times:?}");
}

#[tokio::test]
async fn what_is_held_back_is_not_sent_not_even_what_was_about_to_be() {
    let lesson = lesson().await;
    let held = json!({"reveal": {"points": "when_released", "messages": "when_released", "reference": "when_released"}});
    lesson.set(held.clone()).await;
    lesson.submit(&lesson.right).await;
    assert_eq!((lesson.round(0).await, lesson.seen(|seen| seen.tried)), (0, 0));
    let release = async |released: bool| {
        let path = format!("/api/v1/assignments/{LESSON}/release");
        let body = Some(json!({"released": released}));
        assert_eq!(lesson.school.class.ask("PUT", &path, &lesson.teacher, body).await.status, 204);
    };
    release(true).await;
    assert_eq!((lesson.round(0).await, lesson.given()), (1, vec![3.0]));
    release(false).await;
    lesson.decide(json!(7)).await;
    assert_eq!(lesson.round(0).await, 0);
    // It was due, and is held back before it is sent.
    release(true).await;
    let app = &lesson.school.class.app;
    scores::plan(&app.store, &app.course, Moment::now()).await.expect("planned");
    release(false).await;
    let lti = app.lti.as_deref().expect("reached");
    assert_eq!(scores::deliver(lti, &app.store, &app.course, &Moment::now).await.expect("delivered"), 0);
    assert_eq!((lesson.seen(|seen| seen.tried), lesson.given()), (1, vec![3.0]));
    release(true).await;
    assert_eq!((lesson.round(0).await, lesson.given()), (1, vec![3.0, 7.0]));
    // By a date that passes, without anybody doing anything.
    lesson.set(json!({"due": Moment::now().after(HOUR), "reveal": {"points": "after_due"}})).await;
    lesson.decide(json!(9)).await;
    assert_eq!(lesson.round(0).await, 0);
    assert_eq!((lesson.round(2 * HOUR).await, lesson.given()), (1, vec![3.0, 7.0, 9.0]));
}

#[tokio::test]
async fn a_platform_that_throttles_breaks_or_forgets_gets_its_score_later() {
    let lesson = lesson().await;
    lesson.submit(&lesson.right).await;
    let answer = |status: u16, after: Option<&'static str>| {
        lesson.seen(|seen| seen.answers.push_back((status, after)));
    };
    answer(429, Some("120"));
    assert_eq!(lesson.round(0).await, 0);
    assert_eq!(
        (lesson.round(119_000).await, lesson.seen(|seen| seen.tried)),
        (0, 1),
        "it is left alone for two minutes"
    );
    let state = lesson.school.class.ask("GET", "/api/v1/lti", &lesson.teacher, None).await.json();
    assert_eq!(state["platforms"][0]["problem"], "the platform answers 429");
    assert!(state["platforms"][0]["paused_until"].is_string());

    let mut later = 125_000;
    for (status, wait) in
        [(503, 65_000), (500, 130_000), (502, 250_000), (403, 500_000), (404, 1_000_000), (400, 1_000_000)]
    {
        answer(status, None);
        assert_eq!(lesson.round(later).await, 0, "{status}");
        assert_eq!(lesson.round(later + 9_000).await, 0, "{status}: not at once again");
        later += wait;
    }
    assert_eq!(lesson.seen(|seen| seen.tried), 7);
    assert_eq!(lesson.column().await["problem"], "the platform answers 400");
    // A token that it no longer knows is asked for anew within the same try.
    lesson.seen(|seen| seen.forgotten = seen.tokens);
    later += HOUR;
    assert_eq!((lesson.round(later).await, lesson.given()), (1, vec![3.0]));
    assert_eq!(lesson.column().await["problem"], "");
    let state = lesson.school.class.ask("GET", "/api/v1/lti", &lesson.teacher, None).await.json();
    assert_eq!(
        (&state["platforms"][0]["problem"], state["platforms"][0].get("paused_until")),
        (&json!(""), None)
    );
}

#[tokio::test]
async fn a_score_whose_answer_was_lost_is_sent_again_and_outlives_the_program() {
    let lesson = lesson().await;
    lesson.submit(&lesson.right).await;
    lesson.seen(|seen| seen.answers.push_back((0, None)));
    assert_eq!(lesson.round(0).await, 0);
    // Another program, with the same gradebook.
    let other = Lti::at("https://triad.test", "secret").expect("an address");
    assert_eq!((lesson.round_of(&other, 40_000).await, lesson.given()), (1, vec![3.0, 3.0]));
    let times = lesson
        .seen(|seen| seen.scores.iter().map(|(_, body)| body["timestamp"].to_string()).collect::<Vec<_>>());
    assert!(times[0] < times[1], "{times:?}");
    assert_eq!(lesson.round_of(&other, HOUR).await, 0);
}

#[tokio::test]
async fn a_score_that_is_refused_for_days_waits_for_somebody_and_others_go_on() {
    let lesson = lesson().await;
    let (bob, _) = lesson.school.enter("bob", "Learner").await;
    lesson.submit(&lesson.right).await;
    let mut later = 0;
    for _ in 0..20 {
        lesson.seen(|seen| seen.answers.push_back((422, None)));
        assert_eq!(lesson.round(later).await, 0);
        later += 7 * HOUR;
    }
    assert_eq!(lesson.round(later).await, 0);
    assert_eq!(lesson.seen(|seen| seen.tried), 20, "it is tried no more");
    assert_eq!(lesson.column().await["given_up"], 1);
    let body = json!({"answers": {"tension-bottom": {"value": "1.0", "unit": "N"}}});
    let path = format!("/api/v1/lessons/{LESSON}/submissions");
    assert_eq!(lesson.school.class.ask("POST", &path, &bob, Some(body)).await.status, 201);
    assert_eq!((lesson.round(later).await, lesson.given()), (1, vec![0.0]));
    // Whoever teaches has it tried again.
    let again = lesson.school.class.ask("POST", "/api/v1/lti/scores", &lesson.teacher, None).await.json();
    assert_eq!(again["platforms"][0]["columns"][0]["sent"], 2);
    assert_eq!(lesson.given(), [0.0, 3.0]);
}

#[tokio::test]
async fn a_column_elsewhere_is_not_written_to() {
    let lesson = lesson().await;
    lesson.round(0).await;
    let elsewhere = |word: &mut Value| {
        word["https://purl.imsglobal.org/spec/lti-ags/claim/endpoint"]["lineitem"] =
            json!("http://127.0.0.2:9/items/1");
    };
    assert_eq!(lesson.school.open_with("ada", "Learner", elsewhere).await.status, 303);
    lesson.submit(&lesson.right).await;
    assert_eq!(lesson.round(0).await, 1, "the column that was registered");
    let state = lesson.school.class.ask("GET", "/api/v1/lti", &lesson.teacher, None).await.json();
    let columns = state["platforms"][0]["columns"].as_array().expect("columns").clone();
    assert_eq!(columns.len(), 2);
    assert!(
        columns.iter().any(|one| one["problem"].as_str().expect("text").contains("--service")),
        "{columns:?}"
    );
}
