//! Tests of the course that is built in, and of checks that must complain.

mod claims;
mod dealing;
mod explanations;
mod fairness;
mod few_digits;
mod golden_variants;
mod kinds;
mod minutes;
mod misdirection;
mod order;
mod own_numbers;
mod pools;
mod predictions;
mod properties;
mod refusals;
mod rounded_files;
mod tasks;
mod typed;
mod typical_mistakes;
mod ways_of_writing;
mod wrong_tables;

use std::collections::BTreeMap;

use crate::answers::{Answer, TypedValue};
use crate::files::Files;
use crate::{Course, Mark, Submission, check_course, check_lesson, grade, reference_submission};

fn course() -> Course {
    Course::embedded().unwrap_or_else(|e| panic!("{e}"))
}

fn answer(value: &str, unit: &str) -> Answer {
    Answer {
        value: Some(TypedValue::Text(value.to_owned())),
        unit: Some(unit.to_owned()),
        ..Answer::default()
    }
}

fn judged(lesson: &str, id: &str, answer: Answer) -> crate::QuestionVerdict {
    let course = course();
    let submission =
        Submission { answers: BTreeMap::from([(id.to_owned(), answer)]), ..Submission::default() };
    let verdict = grade(course.lesson(lesson).unwrap(), &submission).unwrap();
    verdict.questions.into_iter().find(|q| q.id == id).unwrap()
}

/// A language that the list lacks does not compile here; one that `ALL` lacks fails.
#[test]
fn every_language_is_listed() {
    use crate::tasks::starter::Language;
    let languages = triad_tests::variants!(Language: Python, Octave, Julia);
    assert_eq!(Language::ALL.map(|language| (languages.of)(&language)), languages.all);
}

#[test]
fn the_built_in_course_is_proven() {
    let problems = check_course(&course());
    let list: Vec<String> = problems.iter().map(ToString::to_string).collect();
    assert!(list.is_empty(), "{}", list.join("\n"));
}

#[test]
fn the_folder_and_the_program_hold_the_same_course() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("course");
    let loaded = Course::load(&folder).unwrap_or_else(|e| panic!("{e}"));
    let hashes =
        |c: &Course| c.lessons().iter().map(|l| (l.slug.clone(), l.hash.clone())).collect::<Vec<_>>();
    assert_eq!(hashes(&loaded), hashes(&course()));
}

#[test]
fn the_tension_is_judged_in_any_unit_and_misconceptions_are_recognised() {
    let tension = |value: &str, unit: &str| judged("simple-pendulum", "tension-bottom", answer(value, unit));
    assert_eq!(tension("29.43", "N").verdict, Mark::Right);
    assert_eq!(tension("0.02943", "kN").verdict, Mark::Right);
    assert_eq!(tension("29,4", "").verdict, Mark::Right);
    assert_eq!(tension("29.43 kg m/s^2", "").verdict, Mark::Right);
    assert_eq!(tension("-29.43", "N").misconception.as_deref(), Some("opposite-sign"));
    assert_eq!(tension("9.81", "N").misconception.as_deref(), Some("static"));
    assert_eq!(tension("29.43", "kN").misconception.as_deref(), Some("power-of-ten"));
    assert_eq!(tension("13.37", "N").misconception, None);
    // Far off is wrong, however few its digits.
    assert_eq!(tension("3", "N").verdict, Mark::Wrong);
}

#[test]
fn an_answer_that_cannot_be_judged_uses_no_attempt_and_gives_the_reason() {
    let tension = |value: &str, unit: &str| judged("simple-pendulum", "tension-bottom", answer(value, unit));
    for (value, unit, says) in [
        ("29", "N", "3 significant digits"),
        ("lots", "N", "not a number"),
        ("1,500", "N", "comma"),
        ("29.43", "furlong", "not a unit"),
        ("29.43", "N m", "this field is in N"),
        ("29.43 N", "kN", "two units"),
        ("NaN", "N", "finite"),
    ] {
        let judged = tension(value, unit);
        assert_eq!(judged.verdict, Mark::Invalid, "{value} {unit}");
        assert!(judged.message_html.contains(says), "{value} {unit}: {}", judged.message_html);
    }
    assert_eq!(tension(" ", "N").verdict, Mark::Blank);
    let choice = Answer { choice: Some("z".to_owned()), ..Answer::default() };
    assert_eq!(judged("simple-pendulum", "sign-of-lambda", choice).verdict, Mark::Invalid);
    assert_eq!(judged("simple-pendulum", "force-on-ground", answer("3", "N")).verdict, Mark::Invalid);
    let course = course();
    let unknown = Submission {
        answers: BTreeMap::from([("nope".to_owned(), answer("1", ""))]),
        ..Submission::default()
    };
    let error = grade(course.lesson("simple-pendulum").unwrap(), &unknown).unwrap_err();
    assert!(error.to_string().contains("tension-bottom"));
}

#[test]
fn a_right_submission_passes_and_repeats_to_the_byte() {
    let course = course();
    for lesson in course.lessons() {
        let submission = reference_submission(lesson);
        let once = serde_json::to_string(&grade(lesson, &submission).unwrap()).unwrap();
        assert_eq!(once, serde_json::to_string(&grade(lesson, &submission).unwrap()).unwrap());
        assert!(grade(lesson, &submission).unwrap().passed);
    }
}

/// No answer, reason, feedback or source may be found in what a student is sent.
#[test]
fn the_public_view_holds_no_answer() {
    use crate::exercise::QuestionBody;
    for lesson in course().lessons() {
        let sent = serde_json::to_string(&lesson.public_view().exercise).unwrap();
        let mut secrets: Vec<String> = Vec::new();
        for question in &lesson.exercise.questions {
            secrets.extend([question.source.clone(), question.right.clone()]);
            secrets.extend(question.hints.iter().cloned());
            match &question.body {
                QuestionBody::Quantity(q) => {
                    secrets.extend(q.misconceptions.iter().map(|m| m.feedback.clone()));
                    secrets.extend(q.misconceptions.iter().map(|m| m.id.clone()));
                }
                QuestionBody::Choice { options, .. } => {
                    secrets.extend(options.iter().map(|o| o.reason.clone()));
                }
                QuestionBody::Formula(f) => {
                    secrets.extend(f.misconceptions.iter().map(|(.., text)| text.clone()));
                }
                QuestionBody::Explanation(e) => secrets.push(e.example.clone()),
                QuestionBody::Model(m) => secrets.extend(m.watches().iter().map(|w| w.feedback.clone())),
                QuestionBody::Diagram(_)
                | QuestionBody::Implement(_)
                | QuestionBody::Trajectory(_)
                | QuestionBody::Tuning(_) => {}
            }
        }
        for secret in secrets.iter().filter(|s| s.len() > 8) {
            let encoded = serde_json::to_string(secret).unwrap();
            assert!(!sent.contains(encoded.trim_matches('"')), "{}: {secret}", lesson.slug);
        }
    }
}

/// Lesson 2 as a course of its own, with one of its files broken: what the check finds.
fn broken(path: &str, from: &str, to: &str) -> Result<Vec<String>, String> {
    broken_in("02-simple-pendulum", path, from, to)
}

/// The same of any lesson.
fn broken_in(lesson: &str, path: &str, from: &str, to: &str) -> Result<Vec<String>, String> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("course").join(lesson);
    let mut files = Files::new();
    add_files(&mut files, &folder, lesson);
    files.insert("course.toml".to_owned(), b"format_version = 1\ntitle = \"x\"\n".to_vec());
    let key = format!("{lesson}/{path}");
    let text = files.get(&key).map(|b| String::from_utf8_lossy(b).into_owned()).unwrap_or_default();
    assert!(from.is_empty() || text.contains(from), "{path} does not contain {from}");
    let text = if from.is_empty() { to.to_owned() } else { text.replacen(from, to, 1) };
    files.insert(key, text.into_bytes());
    let course = Course::from_files(files).map_err(|e| e.to_string())?;
    Ok(check_lesson(&course, &course.lessons()[0]).iter().map(ToString::to_string).collect())
}

/// All files of a folder, by their places below it.
fn add_files(files: &mut Files, folder: &std::path::Path, place: &str) {
    for entry in std::fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let place = format!("{place}/{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            add_files(files, &entry.path(), &place);
        } else {
            files.insert(place, std::fs::read(entry.path()).unwrap());
        }
    }
}

#[test]
fn findings_of_the_check_name_place_and_remedy() {
    finds(&[
        [
            "exercise.toml",
            "value = \"m*9.81\"\n",
            "value = 29.5\n",
            "the misconception static is a right answer",
        ],
        ["reference/answers.toml", "error = 1e-12", "error = 0.1", "at least ten times the error"],
        ["scene.json", "-9.81", "-9.80", "the scene shows"],
        [
            "scene.json",
            "\"tolerance\"",
            "\"error_estimate\": false, \"tolerance\"",
            "by the run's own estimate",
        ],
        ["scene.json", "[0, 0, 1], \"rows\"", "[0, 0, 0], \"rows\"", "pin"],
        ["exercise.toml", "value = \"2*m*9.81\"", "value = \"m*9.82\"", "cannot be distinguished"],
        ["reference/answers.toml", "source = \"M qdd", "source = \"\" # M qdd", "no source"],
        ["reference/answers.toml", "value = \"b\"", "value = \"a\"", "judged Right"],
        ["wrong/other-side.toml", "14.21", "15.21", "recognised other-direction"],
        ["wrong/other-side.toml", "\"14.21\", \"10.90\"", "\"-14.21\", \"-10.90\"", "judged Right"],
        ["lesson.md", "\\tag{2.3}", "\\tag{2.4}", "02-simple-pendulum/lesson.md:"],
        ["lesson.md", "(#eq-2.1)", "(#eq-9.1)", "leads nowhere"],
        ["exercise.toml", "(#eq-2.6)", "(#eq-9.6)", "leads nowhere"],
        ["lesson.md", "## A hinge", "<b>x</b>\n\n## A hinge", "raw HTML"],
        [
            "lesson.md",
            "![Free body diagram: the bob at angle phi from the vertical, its weight m g downwards and the pull S along the rod towards the hinge]",
            "![]",
            "needs a description",
        ],
        ["figures/free-body.svg", "#d9480f", "#ffffff", "may vanish"],
        ["notes.txt", "", "x", "nothing uses this file"],
        [
            "exercise.toml",
            "hints = [\"Write down both",
            "hints = [\"\", \"Write down both",
            "a hint is missing or empty",
        ],
        ["lesson.toml", "minutes = 35", "minutes = 190", "10 to 180 minutes"],
        [
            "lesson.toml",
            "kind = \"run\"",
            "kind = \"check\"",
            "the steps are not predict, run, check, explain",
        ],
        ["lesson.md", "## A hinge", "A $ sign\n\n## A hinge", "lesson.md:1: a $ is left"],
        ["exercise.toml", "The bob has {{m}} kg. How", "The bob has {{M}} kg. How", "{{M}} is no parameter"],
        ["lesson.toml", "text = \"", "text = \"{{mass}} ", "lesson.toml: {{mass}} is no parameter"],
        ["lesson.md", "## A hinge", "Of {{b}} m.\n\n## A hinge", "lesson.md:1: {{b}} is no parameter"],
        ["lesson.md", "## A hinge", "Of {{m}} kg.\n\n## A hinge", "is the same for everybody"],
        ["scene.json", "\"description\": \"", "\"description\": \"{{b}}: ", "{{b}} is no parameter"],
        // Nobody need calculate what a misconception leads to.
        ["wrong/other-side.toml", "14.21", "15.21", "other-side leads to (14.21093, 10.89654, 0) N"],
    ]);
}

#[test]
fn a_lesson_that_guessing_or_copying_passes_is_found() {
    finds(&[
        [
            "exercise.toml",
            "Nothing: the multipliers are the same, and so is the force.",
            "All of the above.",
            "option a says \u{201c}the above\u{201d}",
        ],
        ["exercise.toml", "stays as is.", "stays as it is, as it must.", "the longest wrong one"],
        [
            "exercise.toml",
            "kind = \"number\"\npoints = 2",
            "kind = \"number\"\npoints = 12",
            "choices and counts have 14 of 22 points",
        ],
        [
            "exercise.toml",
            "kind = \"number\"\npoints = 2",
            "kind = \"number\"\npoints = 12",
            "answers that are the same for everybody have 14 of 22 points",
        ],
        // A third, and four tenths by one number.
        [
            "exercise.toml",
            "id = \"tension-bottom\"\nkind = \"number\"\npoints = 3",
            "id = \"tension-bottom\"\nkind = \"number\"\npoints = 20",
            "have 4 of 29 points, one number more 20: together they pass",
        ],
        ["exercise.toml", "step = 0.01", "step = 0.5", "another student's answers pass for "],
        [
            "exercise.toml",
            "step = 0.01",
            "step = 0.5",
            "what is right in the answers of 6 others passes for ",
        ],
        [
            "exercise.toml",
            "[[scene]]\n",
            "[[scene]]\nfile = \"scenes/x.json\"\n",
            "[[scene]] names scenes/x.json, which is not there",
        ],
    ]);
}

/// Each change of a file, path, what stood there and what stands there now, is found by these words.
fn finds(changes: &[[&str; 4]]) {
    for [path, from, to, says] in changes {
        // The prerequisite is not part of this small course; that complaint is always there.
        let problems = broken(path, from, to).unwrap_or_else(|e| panic!("{path}: {e}"));
        assert!(problems.iter().any(|p| p.contains(says)), "{path} {to}: {problems:#?}");
    }
}

/// Nobody edits a scene without the formulas that rest on it, nor a formula without the scene.
#[test]
fn references_are_tied_to_the_scene_or_computed_twice() {
    let (pendulum, bar, box_) = ("02-simple-pendulum", "07-revolute-joint", "11-mass-matrix");
    let answers = "reference/answers.toml";
    for (lesson, path, from, to, says) in [
        // The period is read from the scene: what was computed a second time no longer agrees.
        (pendulum, "scene.json", "-9.81", "-9.80", "question period: its reference is [2.3"),
        (pendulum, answers, "2.367842", "2.377842", "question period: its reference is [2.3678"),
        (pendulum, answers, "again = {", "# again = {", "question period: nothing but its own expression"),
        (pendulum, answers, "sqrt(L/g)", "sqrt(L/9.81)", "9.81 stands in its reference and at /gravity/1"),
        (pendulum, answers, "sqrt(L/g)", "sqrt(L/9.81)", "names g and does not use it"),
        // A formula with the numbers of the scene is what the run shows.
        (
            bar,
            answers,
            "sin(alpha)*cos(alpha)",
            "2*sin(alpha)*cos(alpha)",
            "question moment-formula: the scene shows",
        ),
        (bar, answers, "omega = \"/bodies/0/angular_velocity/2\", ", "", "what its symbols stand for"),
        (box_, answers, "m*R^2/5", "m*R^2/4", "question ball: its reference gives"),
        (box_, answers, "at = { m = 2, R = 0.3 }", "at = { m = 2 }", "does not say for which numbers"),
        (box_, answers, "at = { m = 2, R", "at = { m = 2, r", "does not say for which numbers"),
    ] {
        let problems = broken_in(lesson, path, from, to).unwrap_or_else(|e| panic!("{path}: {e}"));
        assert!(problems.iter().any(|p| p.contains(says)), "{path} {to}: {problems:#?}");
    }
    let apart = broken(answers, "scene = { g = \"-/gravity/1\" }", "apart = true").unwrap_err();
    assert!(apart.contains("question period"), "{apart}");
    let nowhere = broken(answers, "\"-/gravity/1\"", "\"/gravity/7\"").unwrap_err();
    assert!(nowhere.contains("scene.json has no number for g at /gravity/7"), "{nowhere}");
    let taken = broken(answers, "{ g = ", "{ m = \"/gravity/0\", g = ").unwrap_err();
    assert!(taken.contains("scene names m, which is a parameter already"), "{taken}");
}

/// Authors write what they mean: the check calculates it with the numbers of the text.
#[test]
fn a_wrong_answer_may_be_an_expression_in_the_parameters() {
    let (from, by_hand) = ("\"14.21\", \"10.90\"", "\"14.2109311*m\", \"10.8965368*m\"");
    let problems = broken("wrong/other-side.toml", from, by_hand).unwrap();
    let with_numbers = broken(
        "wrong/other-side.toml",
        "",
        &std::fs::read_to_string(
            std::path::Path::new(env!("CARGO_MANIFEST_DIR"))
                .join("course/02-simple-pendulum/wrong/other-side.toml"),
        )
        .unwrap(),
    )
    .unwrap();
    assert_eq!(problems, with_numbers);
    let other = broken("wrong/other-side.toml", from, "\"-14.2109311*m\", \"-10.8965368*m\"").unwrap();
    assert!(other.iter().any(|p| p.contains("judged Right")), "{other:#?}");
}

#[test]
fn errors_of_reading_name_file_and_line() {
    for (path, from, to, says) in [
        ("exercise.toml", "points = 3", "pionts = 3", "02-simple-pendulum/exercise.toml, line"),
        ("exercise.toml", "unit = \"N\"", "unit = \"Newtonn\"", "not a unit I know"),
        ("exercise.toml", "id = \"period\"", "id = \"tension-bottom\"", "used twice"),
        ("reference/answers.toml", "[period]", "[periode]", "question period: it has no reference"),
        ("reference/answers.toml", "ellipk(1/2)", "ellipq(1/2)", "reference/answers.toml, line"),
        ("scene.json", "\"name\"", "name", "scene.json, line 2"),
        ("scene.json", "\"revolute\"", "\"hinge\"", "02-simple-pendulum/scene.json, line"),
        ("lesson.toml", "minutes = 35", "minutes = \"35\"", "lesson.toml, line"),
    ] {
        let error = broken(path, from, to).unwrap_err();
        assert!(error.contains(says), "{path}: {error}");
    }
}
