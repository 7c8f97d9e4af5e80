//! Two weeks of a class, from the first code to the file for the registrar: people join, hand in, come late, vote in a lecture,
//! complain of a reference that is wrong, are graded again, and are exported. What is counted at each step is known before.
//!
//! The clock is not turned: what a fortnight brings are its events. A deadline passes as the teacher sets it to now, and each
//! day begins with the server started anew on the same gradebook, so that nobody hands in more a day than they may.

mod answers;

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use futures_util::{StreamExt, stream};
use serde_json::{Value, json};
use triad::grader::{Grader, LEASE};
use triad::limits::Limits;
use triad::policy::Moment;
use triad::store::{CLASS, Store};
use triad_lessons::{Course, Lesson};
use triad_tests::postgres;

use crate::class::{Class, class_of};
use crate::regrade::course_with;
use crate::{Reply, state};
use answers::{Habit, attempts};

/// Students, unless `TRIAD_TERM` says otherwise: 300 are a large class, and then all lessons are handed in.
const STUDENTS: usize = 12;
/// Lessons that a small class hands in: as far as the one with the deadline.
const LESSONS: usize = 8;
/// The days on which lessons are handed in.
const DAYS: usize = 7;
/// Requests at a time: a class that works at home.
const AT_ONCE: usize = 8;
/// The lesson with a deadline, an extension and a wrong reference.
const FAULTY: &str = "simple-pendulum";
/// Names a folder in which the gradebook is left as it stands before the regrade, to be looked at with the program.
const KEPT: &str = "TRIAD_TERM_KEPT";
/// An hour, in milliseconds.
const HOUR: i64 = 3_600_000;

struct Student {
    name: String,
    id: String,
    cookie: String,
    seed: String,
}

/// The class, and the truth about its lessons.
struct Term {
    class: Class,
    truth: Arc<Course>,
    lessons: Vec<Lesson>,
    owner: String,
    students: Vec<Student>,
}

impl Term {
    /// Tells a step with the time that it took.
    fn step(began: Instant, what: &str) {
        println!("{:>9.3} s  {what}", began.elapsed().as_secs_f64());
    }

    async fn teacher(&self, method: &str, path: &str, body: Option<Value>) -> Reply {
        let reply = self.class.ask(method, path, &self.owner, body).await;
        assert!(reply.status.is_success(), "{method} {path}: {}", String::from_utf8_lossy(&reply.bytes));
        reply
    }

    /// What a lesson's teacher sets.
    async fn set(&self, policy: Value) {
        self.teacher("PUT", &format!("/api/v1/assignments/{FAULTY}"), Some(policy)).await;
    }

    /// Hands in what the student does with the lesson; how many submissions that were.
    async fn hand_in(&self, number: usize, lesson: &Lesson, habit: Habit) -> u32 {
        if habit == Habit::Never {
            return 0;
        }
        let student = &self.students[number];
        let (truth, slug, seed) = (Arc::clone(&self.truth), lesson.slug.clone(), student.seed.clone());
        let worked_out = move || {
            let own = truth.lesson(&slug).expect("a lesson").variant(&seed).expect("numbers");
            (own.public_view().predictions, attempts(number, habit, &own))
        };
        let (predictions, all) = tokio::task::spawn_blocking(worked_out).await.expect("computed");
        for one in &predictions {
            let choice = &one.options[number % one.options.len()].id;
            let body = json!({"prediction": one.id, "choice": choice, "why": "so it was at home"});
            let path = format!("/api/v1/lessons/{}/predictions", lesson.slug);
            let reply = self.class.ask("POST", &path, &student.cookie, Some(body)).await;
            // Whoever comes back has predicted before.
            assert!(reply.status.is_success() || reply.status == 409, "{}: {}", lesson.slug, reply.json());
        }
        let path = format!("/api/v1/lessons/{}/submissions", lesson.slug);
        for answers in &all {
            let body = json!({ "answers": answers });
            let reply = self.class.ask("POST", &path, &student.cookie, Some(body)).await;
            assert_eq!(reply.status, 201, "{}: {}", lesson.slug, reply.json());
        }
        u32::try_from(all.len()).expect("few")
    }
}

/// The built-in course, with a force at the lowest point that nobody can find.
fn with_a_wrong_reference() -> Course {
    course_with(&format!("{FAULTY}/reference/answers.toml"), |text| {
        assert!(text.contains("value = \"3*m*9.81\""));
        text.replace("value = \"3*m*9.81\"", "value = \"4*m*9.81\"")
    })
}

/// The class comes in, and its lessons are those that it hands in.
async fn begin(folder: &std::path::Path, count: usize, all: bool) -> Term {
    let began = Instant::now();
    let mut app = state(Limits::default());
    if postgres::given().is_none() {
        app.store = Arc::new(Store::open(&folder.join("grades.db")).await.expect("a gradebook"));
    }
    app.course = Arc::new(with_a_wrong_reference());
    let class = class_of(app).await;
    let owner = class.enter("/api/v1/setup", json!({"token": class.setup, "name": "Prof"})).await.0;
    let names: Vec<String> = (0..count).map(|k| format!("Student {k:03}")).collect();
    let joined: Vec<_> = stream::iter(&names).map(|name| class.join(name)).buffered(AT_ONCE).collect().await;
    let members = class.app.store.people(CLASS).await.expect("people");
    let student = |(name, (cookie, told)): (&String, (String, Value))| {
        let id = told["person"]["id"].as_str().expect("an id").to_owned();
        let member = members.iter().find(|one| one.id == id).expect("a member");
        Student { seed: class.app.access.seed_of(member), name: name.clone(), id, cookie }
    };
    let students: Vec<Student> = names.iter().zip(joined).map(student).collect();
    let truth = Arc::new(Course::embedded().expect("a course"));
    let lessons = truth.lessons().iter().take(if all { usize::MAX } else { LESSONS }).cloned().collect();
    let term = Term { class, truth, lessons, owner, students };
    Term::step(began, &format!("{count} students join"));
    term
}

/// Each day some lessons, by everybody as they are used to; how many submissions by student and lesson.
async fn fortnight(term: &mut Term) -> HashMap<(String, String), u32> {
    let mut handed = HashMap::new();
    for day in 0..DAYS {
        let began = Instant::now();
        term.class = term.class.again(Arc::clone(&term.class.app.course)).await;
        let today =
            term.lessons.iter().enumerate().filter(|(k, _)| k % DAYS == day).map(|(_, lesson)| lesson);
        let pairs = today.flat_map(|lesson| (0..term.students.len()).map(move |k| (k, lesson)));
        let one = async |(k, lesson): (usize, &Lesson)| {
            let count = term.hand_in(k, lesson, Habit::of(k, lesson)).await;
            ((term.students[k].id.clone(), lesson.slug.clone()), count)
        };
        let today: Vec<_> = stream::iter(pairs).map(one).buffer_unordered(AT_ONCE).collect().await;
        let count: u32 = today.iter().map(|(_, count)| count).sum();
        handed.extend(today);
        Term::step(began, &format!("day {}: {count} submissions", day + 1));
    }
    handed
}

/// A lecture in which all vote; each counts once, also who votes twice.
async fn lecture(term: &Term) {
    let began = Instant::now();
    let session = term.teacher("POST", "/api/v1/sessions", Some(json!({"lesson": FAULTY}))).await.json();
    let room = term.teacher("POST", "/api/v1/rooms", Some(json!({"session": session["id"]}))).await.json();
    let path = format!("/api/v1/rooms/{}", room["code"].as_str().expect("a code"));
    let key = format!("Bearer {}", room["key"].as_str().expect("a key"));
    let question = json!({"text": "Which way?", "choices": ["up", "down"], "right": 0});
    term.class.lead("PUT", &format!("{path}/question"), &key, Some(question)).await;
    let seen = term.class.ask("GET", &path, "", None).await.json();
    let number = seen["question"]["number"].as_u64().expect("a number");
    for k in 0..term.students.len() {
        for choice in [1, k % 2] {
            let body = json!({"question": number, "voter": format!("voter-{k}"), "choice": choice});
            let reply = term.class.ask("POST", &format!("{path}/answers"), "", Some(body)).await;
            assert_eq!(reply.status, 204);
        }
    }
    term.class.lead("POST", &format!("{path}/reveal"), &key, None).await;
    let result = term.class.ask("GET", &path, "", None).await.json()["question"]["result"].clone();
    let count = term.students.len();
    assert_eq!(result["counts"], json!([count.div_ceil(2), count / 2]), "{result}");
    Term::step(began, &format!("a lecture: {count} vote, each twice"));
}

/// The deadline passes; two who had not begun come late, one of them with more time.
async fn deadline(term: &Term) -> usize {
    let began = Instant::now();
    let (now, later) = (Moment::now(), Moment::now().after(HOUR));
    term.set(json!({"due": now, "late": [{"until": later, "share": 0.5}]})).await;
    let lesson = term.truth.lesson(FAULTY).expect("a lesson").clone();
    let idle = |(k, _): &(usize, &Student)| Habit::of(*k, &lesson) == Habit::Never;
    let late: Vec<(usize, &Student)> = term.students.iter().enumerate().filter(idle).collect();
    let (_, ill) = late.first().expect("somebody who has not begun");
    let more = json!({"until": later, "reason": "was ill"});
    let path = format!("/api/v1/assignments/{FAULTY}/extensions/{}", ill.id);
    term.teacher("PUT", &path, Some(more)).await;
    for (number, _) in &late {
        assert_eq!(term.hand_in(*number, &lesson, Habit::Right).await, 1);
    }
    let table = term.table().await;
    for (k, (_, who)) in late.iter().enumerate() {
        assert_eq!(table[&who.id][FAULTY]["late"], json!(k > 0), "{}", table[&who.id]);
        assert_eq!(table[&who.id][FAULTY]["extended"], json!(k == 0));
    }
    let count = late.len();
    Term::step(began, &format!("a deadline: {count} hand in after it, one with an extension"));
    count
}

/// A student asks to look again; the question's page shows it, the reference is mended, and what was right counts.
async fn regrade(term: &mut Term, right: usize) {
    let began = Instant::now();
    let lesson = term.truth.lesson(FAULTY).expect("a lesson").clone();
    let knows = |(k, _): &(usize, &Student)| Habit::of(*k, &lesson).is_right();
    let (_, ada) = term.students.iter().enumerate().find(knows).expect("somebody who knows");
    let (ada, cookie) = (ada.id.clone(), ada.cookie.clone());
    let words = json!({"lesson": FAULTY, "text": "three times the weight, not four"});
    let asked = term.class.ask("POST", "/api/v1/record/requests", &cookie, Some(words)).await;
    assert_eq!(asked.status, 201, "{}", String::from_utf8_lossy(&asked.bytes));
    let before = term.table().await;
    assert_eq!(before[&ada][FAULTY]["asked"], true);
    let page = format!("/api/v1/assignments/{FAULTY}/questions/tension-bottom");
    assert_eq!(term.teacher("GET", &page, None).await.json()["figures"]["right"], 0);
    Term::step(began, "a student asks to look again: nobody was right");
    if let Some(folder) = std::env::var_os(KEPT) {
        let copied = term.class.app.store.backup(&PathBuf::from(folder).join("before-the-regrade.db")).await;
        println!("{:?}", copied.expect("a file that can be copied"));
    }

    term.class = term.class.again(Arc::clone(&term.truth)).await;
    let began = Instant::now();
    let preview = format!("/api/v1/assignments/{FAULTY}/regrades");
    // Where graders share the gradebook they judge again, too.
    let store = Arc::clone(&term.class.app.store);
    let grading = tokio::spawn(Grader::new(store, Arc::default(), Arc::default(), 2, LEASE).run());
    let seen = term.teacher("POST", &preview, None).await.json();
    grading.abort();
    let counts = &seen["counts"];
    assert_eq!((&counts["up"], &counts["down"], &counts["program"]), (&json!(right), &json!(0), &json!(0)));
    Term::step(began, &format!("a regrade of {} submissions is looked at: {right} up", seen["submissions"]));
    let began = Instant::now();
    let apply = format!("/api/v1/regrades/{}/apply", seen["id"].as_str().expect("an id"));
    let how = json!({"choice": "better", "reason": "the reference was wrong"});
    term.teacher("POST", &apply, Some(how)).await;
    let after = term.table().await;
    assert!(after[&ada][FAULTY]["points"].as_f64() > before[&ada][FAULTY]["points"].as_f64());
    let told = term.class.ask("GET", "/api/v1/record", &cookie, None).await.json();
    assert!(told.to_string().contains("the reference was wrong"), "{told}");
    Term::step(began, "it counts, and its students see why");
}

/// What a registrar gets, and that all of it can be rebuilt.
async fn end(term: &Term, handed: usize) {
    for (path, what) in [
        ("/api/v1/standings", "the table of all by all lessons"),
        ("/api/v1/glance", "the class at a glance"),
        ("/api/v1/standings.csv?for=canvas", "a file for Canvas"),
        ("/api/v1/standings.csv?for=moodle", "a file for Moodle"),
        ("/api/v1/standings.jsonl", "the table as lines of JSON"),
        ("/api/v1/course/export", "the whole course as a file"),
    ] {
        // The first asking may find nothing in the caches.
        let mut best = f64::INFINITY;
        let mut bytes = 0;
        for _ in 0..3 {
            let began = Instant::now();
            let reply = term.teacher("GET", path, None).await;
            best = best.min(began.elapsed().as_secs_f64());
            bytes = reply.bytes.len();
            let text = String::from_utf8_lossy(&reply.bytes);
            let everybody = term.students.iter().all(|who| text.contains(&who.name));
            assert!(everybody || path.ends_with("glance"), "{path}: {text}");
        }
        println!("{best:>9.3} s  {what}: {} kB, the least of three", bytes / 1000);
    }
    let began = Instant::now();
    let rebuilt = triad::regrade::check(&term.class.app.store, CLASS).await.expect("rebuilds");
    assert!(rebuilt.changed.is_empty(), "{:?}", rebuilt.changed.first());
    assert!(rebuilt.same >= handed, "{} of {handed}", rebuilt.same);
    Term::step(began, &format!("{} verdicts are rebuilt byte for byte", rebuilt.same));
    assert_eq!(term.class.app.store.faults().await.expect("looks"), Vec::<String>::new());
}

impl Term {
    /// What everybody has reached, by the person's id.
    async fn table(&self) -> HashMap<String, Value> {
        let table = self.teacher("GET", "/api/v1/standings", None).await.json();
        let rows = table["students"].as_array().expect("rows").iter();
        rows.map(|row| (row["id"].as_str().expect("an id").to_owned(), row["lessons"].clone())).collect()
    }
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_class_joins_hands_in_is_regraded_and_exported() {
    let wanted = std::env::var("TRIAD_TERM").ok().map(|count| count.parse().expect("a number of students"));
    let folder = tempfile::tempdir().expect("a folder");
    let mut term = begin(folder.path(), wanted.unwrap_or(STUDENTS), wanted.is_some()).await;
    let handed = fortnight(&mut term).await;
    lecture(&term).await;
    let late = deadline(&term).await;
    let table = term.table().await;
    for ((person, slug), count) in &handed {
        let late = u32::from(slug == FAULTY && *count == 0);
        assert_eq!(table[person][slug]["attempts"].as_u64().unwrap_or(0), u64::from(count + late), "{slug}");
    }
    let lesson = term.truth.lesson(FAULTY).expect("a lesson").clone();
    let right = (0..term.students.len()).filter(|k| Habit::of(*k, &lesson).is_right()).count() + late;
    regrade(&mut term, right).await;
    let table = term.table().await;
    for (k, who) in term.students.iter().enumerate() {
        for lesson in &term.lessons {
            let passed = table[&who.id][&lesson.slug]["passed"] == true;
            let knows = Habit::of(k, lesson).is_right();
            let is_late = lesson.slug == FAULTY && Habit::of(k, lesson) == Habit::Never;
            assert!(passed == knows || is_late, "{} in {}: {passed}", who.name, lesson.slug);
        }
    }
    let submissions: u32 = handed.values().sum();
    end(&term, submissions as usize + late).await;
    println!("{} students, {submissions} submissions and {late} late ones", term.students.len());
}
