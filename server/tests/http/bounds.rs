//! What one caller takes from the others: their work and their rights never, places and time only so much.

use std::sync::Arc;

use serde_json::{Value, json};
use triad::access::rights::{RIGHTS, Right};
use triad::app::App;
use triad::limits::Limits;
use triad::store::{Role, Store};

use crate::class::{class, class_of};
use crate::{post, state};

/// What is about others, or changes the class, takes somebody who grades at least: by address, whatever stands in the table.
#[test]
fn what_is_about_others_belongs_to_those_who_grade() {
    let of_others =
        ["assignments", "people", "standings", "glance", "regrades", "invitations", "course", "lti"];
    let own = ["record", "me", "submissions"];
    for (method, path, right) in RIGHTS {
        let part = path.split('/').nth(3).unwrap_or_default();
        let least = match right {
            Right::Role(role) => Some(*role),
            Right::Anyone | Right::Key => None,
        };
        if of_others.contains(&part) || path.ends_with("/counts") {
            assert!(least >= Some(Role::Grader), "{method} {path}: {right:?}");
        }
        if own.contains(&part) && *path != "/api/v1/me" {
            assert!(least >= Some(Role::Student), "{method} {path}: {right:?}");
        }
        // Roles and what leaves the gradebook are the owner's, other changes of the class the instructors'.
        let is_owners = path.ends_with("/role") || path.ends_with("/erase") || path.ends_with("/export");
        assert!(!(is_owners || part == "invitations") || least == Some(Role::Owner), "{method} {path}");
        let decides = ["/decisions", "/comments", "/preview", "/canvas"];
        if *method != "GET" && of_others.contains(&part) && !decides.iter().any(|end| path.ends_with(end)) {
            assert!(least >= Some(Role::Instructor), "{method} {path}: {right:?}");
        }
    }
}

/// Who hands in without a pause is asked to wait, and others are not.
#[tokio::test]
async fn one_student_hands_in_so_often_and_not_more() {
    let class = class().await;
    let ((max, _), (ada, _)) = (class.join("Max").await, class.join("Ada").await);
    let hand_in = async |who: &str| {
        let path = "/api/v1/lessons/simple-pendulum/submissions";
        class.ask("POST", path, who, Some(json!({"answers": {}}))).await
    };
    let mut kept = 0;
    let refused = loop {
        let reply = hand_in(&max).await;
        if reply.status == 429 || kept > 200 {
            break reply;
        }
        kept += 1;
    };
    refused.problem(429, "too-often");
    assert!(kept >= 20, "{kept}");
    assert!(hand_in(&ada).await.status.is_success());
}

/// Who guesses words with names of megabytes fills no memory: such a name is nobody's, and counts as the empty one.
#[tokio::test]
async fn a_name_that_nobody_can_have_is_not_remembered() {
    let class = class().await;
    let guess = async |name: String| {
        let body = json!({"name": name, "words": "acorn acorn acorn acorn"});
        class.ask("POST", "/api/v1/return", "", Some(body)).await
    };
    for k in 0..10 {
        guess(format!("{k}{}", "x".repeat(100_000))).await.problem(403, "wrong-words");
    }
    guess("y".repeat(200_000)).await.problem(429, "too-often");
    guess("Ada".into()).await.problem(403, "wrong-words");
}

/// As many are graded at a time as there are places: a class at the bell leaves the processors to others.
#[tokio::test]
async fn whoever_is_graded_takes_a_place() {
    let app = state(Limits::default());
    let server = triad::app(app.clone());
    let path = "/api/v1/lessons/simple-pendulum/submissions";
    let handed = || json!({"student": "ada", "answers": {}});
    assert!(post(&server, path, handed()).await.status.is_success());
    let places = std::thread::available_parallelism().map_or(1, usize::from);
    assert_eq!(app.at_once.available_permits(), places, "each is given back");
    // Where there are no places any more nobody is graded without one.
    app.at_once.close();
    assert_eq!(post(&server, path, handed()).await.status, 500);
}

/// What strangers send waits in memory until it is whole: of them a class takes little at a time, of its members whole files.
#[tokio::test]
async fn strangers_send_little_at_a_time() {
    let class = class().await;
    let (ada, _) = class.join("Ada").await;
    let long = json!({"text": "x".repeat(300 << 10)});
    let reading = "/api/v1/lessons/simple-pendulum/questions/period/reading";
    class.ask("POST", reading, "", Some(long.clone())).await.problem(413, "request-too-large");
    class.ask("POST", "/api/v1/join", "", Some(long.clone())).await.problem(413, "request-too-large");
    class.ask("POST", reading, &ada, Some(long)).await.problem(422, "invalid-request");
}

/// Who may give others new words could come in with them: those of somebody who may more are not given.
#[tokio::test]
async fn nobody_comes_in_as_somebody_who_may_more() {
    let class = class().await;
    let everybody = class.everybody().await;
    let of = |wanted: Role| &everybody.iter().find(|(role, _)| *role == Some(wanted)).expect("it is there").1;
    let people = class.ask("GET", "/api/v1/people", of(Role::Owner), None).await.json();
    let words = async |role: Role, who: &str| {
        let person = people.as_array().expect("people").iter().find(|one| one["role"] == role.name());
        let id = person.expect("it is there")["id"].as_str().expect("an id").to_owned();
        class.ask("POST", &format!("/api/v1/people/{id}/words"), who, None).await
    };
    words(Role::Owner, of(Role::Instructor)).await.problem(403, "not-yours");
    assert_eq!(words(Role::Student, of(Role::Instructor)).await.status, 201);
    assert_eq!(words(Role::Instructor, of(Role::Owner)).await.status, 201);
}

/// The name of a submission is no key: what another student handed in is not there.
#[tokio::test]
async fn the_work_of_others_is_not_there() {
    let class = class().await;
    let ((ada, _), (eve, _)) = (class.join("Ada").await, class.join("Eve").await);
    let path = "/api/v1/lessons/simple-pendulum/submissions";
    let answers = json!({"answers": {"tension-bottom": {"value": "1", "unit": "N"}}});
    let kept = class.ask("POST", path, &ada, Some(answers)).await.json();
    let own = format!("/api/v1/submissions/{}", kept["id"].as_str().expect("an id"));
    for what in ["", "/verdicts"] {
        let path = format!("{own}{what}");
        assert_eq!(class.ask("GET", &path, &ada, None).await.status, 200);
        class.ask("GET", &path, &eve, None).await.problem(404, "unknown-entry");
    }
    class.ask("GET", &format!("{own}/files/tension-bottom"), &eve, None).await.problem(404, "unknown-entry");
}

/// Whoever reads the file of a gradebook comes in as nobody: of what opens an account there are hashes in it.
#[tokio::test]
async fn what_opens_an_account_is_not_in_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("grades.db");
    let store = Store::open(&path).await.expect("opens");
    let class = class_of(App { store: Arc::new(store), ..state(Limits::default()) }).await;
    let (owner, _) = class.enter("/api/v1/setup", json!({"token": class.setup, "name": "Prof"})).await;
    let (ada, told) = class.join("Ada Lovelace").await;
    let invited =
        class.ask("POST", "/api/v1/invitations", &owner, Some(json!({"role": "grader"}))).await.json();
    let text = |value: &Value| value.as_str().expect("text").to_owned();
    let token = |cookie: &str| cookie.split_once('=').expect("a cookie").1.to_owned();
    class.app.store.close().await;
    let bytes = std::fs::read(&path).expect("reads");
    let holds = |text: &str| bytes.windows(text.len()).any(|part| part == text.as_bytes());
    assert!(holds("Ada Lovelace"), "it is the file");
    for secret in [
        token(&owner),
        token(&ada),
        text(&told["words"]),
        text(&told["link"]),
        text(&invited["token"]),
        class.setup,
    ] {
        assert!(!holds(&secret), "{secret} is in the file");
    }
}
