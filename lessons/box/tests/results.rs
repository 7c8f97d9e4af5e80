//! The program in folders as Gradescope and PrairieLearn lay them out: verdicts, formats, and what is said to bad files.

#![allow(clippy::unwrap_used, clippy::panic, clippy::expect_used)] // a test that cannot go on says so

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

use serde_json::{Value, json};
use triad_lessons::{
    Course, Lesson, Mark, Submission, Verdict, grade, reference_submission, wrong_submission,
};

fn program(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_triad-grade")).args(arguments).output().unwrap()
}

fn lesson(slug: &str) -> Lesson {
    Course::embedded().unwrap().lesson(slug).unwrap().clone()
}

/// A folder as one of the systems lays it out.
struct Place {
    folder: TempDir,
    system: &'static str,
    options: Vec<&'static str>,
}

impl Place {
    fn gradescope(lesson: &Lesson) -> Self {
        Self::new("gradescope", "source/lesson.json", "submission", lesson)
    }

    fn prairielearn(lesson: &Lesson) -> Self {
        Self::new("prairielearn", "tests/lesson.json", "student", lesson)
    }

    fn new(system: &'static str, bundle: &str, files: &str, lesson: &Lesson) -> Self {
        let this = Self { folder: TempDir::new().unwrap(), system, options: Vec::new() };
        this.put(bundle, lesson.bundle());
        fs::create_dir(this.path().join(files)).unwrap();
        this
    }

    fn path(&self) -> &Path {
        self.folder.path()
    }

    fn put(&self, name: &str, bytes: impl AsRef<[u8]>) {
        let path = self.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }

    fn answers(&self) -> &'static str {
        if self.system == "gradescope" { "submission/answers.json" } else { "student/answers.json" }
    }

    /// Runs the program, which has to write a result, and reads it.
    fn result(&self) -> Value {
        let root = self.path().to_str().unwrap();
        let output = program(&[&[self.system, "--root", root], self.options.as_slice()].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        self.written()
    }

    fn written(&self) -> Value {
        let result =
            serde_json::from_slice(&fs::read(self.path().join("results/results.json")).unwrap()).unwrap();
        check_fields(&result, self.system);
        result
    }

    fn hand_in(&self, submission: &Submission) -> Value {
        self.put(self.answers(), serde_json::to_vec(submission).unwrap());
        self.result()
    }
}

/// Keys and kinds of values that the systems document; others may be ignored there.
fn check_fields(result: &Value, system: &str) {
    let keys = |value: &Value| value.as_object().unwrap().keys().cloned().collect::<BTreeSet<_>>();
    let known = |value: &Value, known: &[&str]| {
        let strange: Vec<String> =
            keys(value).into_iter().filter(|key| !known.contains(&key.as_str())).collect();
        assert!(strange.is_empty(), "{strange:?}: {value:#}");
    };
    let tests = result["tests"].as_array().cloned().unwrap_or_default();
    if system == "gradescope" {
        known(result, &["score", "output", "output_format", "visibility", "tests", "extra_data"]);
        assert!(result["score"].is_number() && result["output"].is_string(), "{result:#}");
        assert_eq!((&result["output_format"], &result["visibility"]), (&json!("text"), &json!("visible")));
        for test in &tests {
            known(test, &["score", "max_score", "status", "name", "number", "output", "output_format"]);
            assert!(test["number"].is_string() && test["name"].is_string() && test["output"].is_string());
        }
        return;
    }
    known(result, &["gradable", "score", "format_errors", "message", "tests", "triad"]);
    if result["gradable"] == false {
        let errors = result["format_errors"].as_array().unwrap();
        assert!(!errors.is_empty() && errors.iter().all(Value::is_string), "{result:#}");
        assert!(result["score"].is_null() && tests.is_empty());
        return;
    }
    assert!(result["score"].as_f64().is_some_and(|score| (0.0..=1.0).contains(&score)), "{result:#}");
    for test in &tests {
        known(test, &["name", "points", "max_points", "message"]);
        assert!(test["points"].is_number() && test["max_points"].is_number() && test["message"].is_string());
    }
}

/// The verdict that goes along with a result.
fn verdict<'a>(result: &'a Value, system: &str) -> &'a Value {
    if system == "gradescope" {
        &result["extra_data"]["triad"]["verdict"]
    } else {
        &result["triad"]["verdict"]
    }
}

/// As many submissions as there are kinds of mistakes: the reference, and every wrong answer that an author foresaw.
fn submissions(lesson: &Lesson) -> Vec<Submission> {
    let asked =
        lesson.wrong.values().filter(|wrong| wrong.answers.keys().all(|id| lesson.question(id).is_some()));
    let wrong = asked.map(|wrong| wrong_submission(lesson, wrong));
    std::iter::once(reference_submission(lesson)).chain(wrong).collect()
}

#[test]
fn verdicts_are_those_of_the_grader_for_every_lesson() {
    let course = Course::embedded().unwrap();
    let (mut right, mut wrong) = (0, 0);
    for lesson in course.lessons() {
        let lesson = lesson.of_seed("").unwrap();
        let place = Place::gradescope(&lesson);
        // One lesson in each format with all it has, the others with what differs from the reference first.
        for submission in submissions(&lesson).into_iter().take(3) {
            let expected = grade(&lesson, &submission).unwrap();
            let result = place.hand_in(&submission);
            assert_eq!(
                verdict(&result, "gradescope").to_string(),
                json!(expected).to_string(),
                "{}",
                lesson.slug
            );
            assert_eq!(result["score"], json!(expected.earned));
            (right, wrong) = if expected.passed { (right + 1, wrong) } else { (right, wrong + 1) };
            let statuses = expected.questions.iter().map(|q| match q.verdict {
                Mark::Right => json!("passed"),
                // People judge it, there as here.
                Mark::Kept => json!(null),
                _ => json!("failed"),
            });
            let told = result["tests"].as_array().unwrap().iter().map(|test| test["status"].clone());
            assert_eq!(told.collect::<Vec<_>>(), statuses.collect::<Vec<_>>());
        }
    }
    assert!(right >= course.lessons().len() && wrong > 0, "{right} {wrong}");
}

#[test]
fn prairielearn_grades_with_the_numbers_that_it_showed() {
    let lesson = lesson("simple-pendulum");
    let place = Place::prairielearn(&lesson);
    place.put(
        "data/data.json",
        json!({"params": {"triad_seed": "variant 7"}, "variant_seed": 123}).to_string(),
    );
    let own = lesson.of_seed("variant 7").unwrap();
    assert_ne!(own.parameters, lesson.parameters);
    // Whatever name or seed stands in the file.
    let submission = Submission { seed: Some("ada".into()), ..reference_submission(&own) };
    let result = place.hand_in(&submission);
    assert_eq!((&result["gradable"], &result["score"]), (&json!(true), &json!(1.0)));
    assert_eq!(
        verdict(&result, "prairielearn").to_string(),
        json!(grade(&own, &submission).unwrap()).to_string()
    );
    place.put("data/data.json", "{}");
    assert!(place.hand_in(&submission)["score"].as_f64().unwrap() < 1.0, "everybody's numbers are others");
}

#[test]
fn the_command_prints_the_verdict_byte_for_byte() {
    let lesson = lesson("spherical-joint");
    let place = Place::gradescope(&lesson);
    let submission = Submission { student: Some("Ada".into()), ..submissions(&lesson).pop().unwrap() };
    place.hand_in(&submission);
    let path = |name: &str| place.path().join(name).to_str().unwrap().to_owned();
    let output = program(&["verdict", &path("source/lesson.json"), &path("submission/answers.json")]);
    let expected: Verdict = grade(&lesson.of_seed("Ada").unwrap(), &submission).unwrap();
    assert_eq!(
        String::from_utf8_lossy(&output.stdout),
        serde_json::to_string_pretty(&expected).unwrap() + "\n"
    );
    let refused = program(&["verdict", &path("source/lesson.json"), "/nowhere"]);
    assert_eq!(refused.status.code(), Some(3));
    assert_eq!(program(&["gradescope", "--wrong"]).status.code(), Some(2));
    assert_eq!(program(&["prairielearn", "--numbers-of-email"]).status.code(), Some(2));
}

/// What is no submission, with words that its message must have.
fn bad_files() -> Vec<(Vec<u8>, &'static str)> {
    vec![
        (Vec::new(), "line 1"),
        (b"\xff\xfe\x00".to_vec(), "UTF-8"),
        (b"{\"answers\": {\"tension-bottom\"".to_vec(), "line 1"),
        (b"{\"answers\": {}, \"grade\": 10}".to_vec(), "grade"),
        (b"{\"answers\": {\"no-such-question\": {\"value\": \"1\"}}}".to_vec(), "no-such-question"),
        (
            format!("{{\"answers\": {{\"tension-bottom\": {{\"value\": {}}}}}}}", "[".repeat(100_000))
                .into_bytes(),
            "recursion",
        ),
        (vec![b' '; 5 << 20], "too large"),
        (
            format!("{{\"student\": \"{}\", \"answers\": {{}}}}", "x".repeat(101)).into_bytes(),
            "100 characters",
        ),
    ]
}

#[test]
fn bad_files_are_told_and_cost_nothing() {
    let lesson = lesson("simple-pendulum");
    let (scope, prairie) = (Place::gradescope(&lesson), Place::prairielearn(&lesson));
    let earlier = scope.hand_in(&reference_submission(&lesson.of_seed("").unwrap()));
    let failed = json!({"results": null, "autograder_error": true, "score": null});
    let about = json!({"previous_submissions": [{"score": "7.0", "results": earlier}, failed]});
    scope.put("submission_metadata.json", about.to_string());
    let possible = earlier["extra_data"]["triad"]["possible"].clone();
    for (bytes, words) in bad_files() {
        scope.put(scope.answers(), &bytes);
        let result = scope.result();
        let output = result["output"].as_str().unwrap();
        assert!(output.contains(words) && output.contains("no attempt is used"), "{words}: {output}");
        assert_eq!((&result["score"], &result["extra_data"]), (&possible, &earlier["extra_data"]), "{words}");
        // There the numbers are given, so that a name decides nothing.
        if words != "100 characters" {
            prairie.put(prairie.answers(), &bytes);
            let result = prairie.result();
            assert_eq!(result["gradable"], false);
            assert!(result["format_errors"].to_string().contains(words), "{words}: {result:#}");
        }
    }
}

#[test]
fn an_answer_that_cannot_be_read_leaves_the_points_of_before() {
    let lesson = lesson("simple-pendulum").of_seed("").unwrap();
    let (scope, prairie) = (Place::gradescope(&lesson), Place::prairielearn(&lesson));
    let mut submission = reference_submission(&lesson);
    let id = lesson.exercise.questions[0].id.clone();
    submission.answers.get_mut(&id).unwrap().value =
        Some(triad_lessons::answers::TypedValue::Text("a few".into()));
    let first = scope.hand_in(&submission);
    assert_eq!(first["score"], 0.0, "nothing was graded before");
    assert!(first["output"].as_str().unwrap().contains(&id));
    assert!(first["tests"].as_array().unwrap().iter().all(|test| test["score"].is_null()), "{first:#}");
    let result = prairie.hand_in(&submission);
    assert!(result["format_errors"].to_string().contains(&id), "{result:#}");
    // What was reached before is carried on over two of them.
    let graded = scope.hand_in(&reference_submission(&lesson));
    let mut last = graded.clone();
    for _ in 0..2 {
        scope.put(
            "submission_metadata.json",
            json!({"previous_submissions": [{"results": last}]}).to_string(),
        );
        last = scope.hand_in(&submission);
        assert_eq!((&last["score"], &last["extra_data"]), (&graded["score"], &graded["extra_data"]));
    }
}

#[test]
fn the_file_is_found_or_asked_for() {
    let lesson = lesson("simple-pendulum");
    let place = Place::gradescope(&lesson);
    let said = |place: &Place| place.result()["output"].as_str().unwrap().to_owned();
    assert!(said(&place).contains("found: nothing"));
    place.put("submission/one.json", "{\"answers\": {}}");
    assert!(said(&place).contains("0 of"), "a single file will do");
    place.put("submission/two.json", "{\"answers\": {}}");
    assert!(said(&place).contains("found: one.json, two.json"));
    place.put("submission/answers.json", "{\"answers\": {}}");
    assert!(said(&place).contains("0 of"));
    // A link would show what is not the student's to see.
    fs::remove_file(place.path().join("submission/answers.json")).unwrap();
    std::os::unix::fs::symlink("../source/lesson.json", place.path().join("submission/answers.json"))
        .unwrap();
    assert!(said(&place).contains("found: one.json, two.json"));
}

#[test]
fn with_addresses_only_the_own_numbers_are_graded() {
    let lesson = lesson("simple-pendulum");
    let mut place = Place::gradescope(&lesson);
    place.options.push("--numbers-of-email");
    let about =
        json!({"users": [{"email": "Ada@uni.example", "id": 1}, {"email": "emmy@uni.example", "id": 2}]});
    place.put("submission_metadata.json", about.to_string());
    let of = |seed: &str| {
        let submission = reference_submission(&lesson.of_seed(seed).unwrap());
        Submission { seed: Some(seed.to_owned()), student: Some("Ada".into()), ..submission }
    };
    for own in ["ada@uni.example", "emmy@uni.example"] {
        let result = place.hand_in(&of(own));
        assert_eq!(result["score"], result["extra_data"]["triad"]["possible"], "{result:#}");
    }
    for other in ["Ada@uni.example", "bob", ""] {
        let said = place.hand_in(&of(other))["output"].as_str().unwrap().to_owned();
        assert!(said.contains("yours are those of ada@uni.example or emmy@uni.example"), "{said}");
    }
}

#[test]
fn a_broken_box_is_a_result_and_a_failure() {
    let place = Place::gradescope(&lesson("simple-pendulum"));
    place.put("source/lesson.json", "{}");
    let output = program(&["gradescope", "--root", place.path().to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(4));
    assert!(String::from_utf8_lossy(&output.stderr).contains("export the lesson again"));
    assert!(place.written()["output"].as_str().unwrap().contains("not your mistake"));
}
