//! Kinds of question that are judged in ways of their own: matrix, formula, and a unit that is asked for.

use std::collections::BTreeMap;

use crate::answers::{Answer, TypedValue};
use crate::files::Files;
use crate::{Course, Mark, QuestionVerdict, Submission, grade, understand};

const EXERCISE: &str = r#"
pass_mark = 1.0

[[question]]
id = "c"
kind = "matrix"
points = 2
prompt = "C"
unit = "m"
frame = "the ground frame"
tolerance = { relative = 0.01, absolute = 0 }
hints = ["h"]
[[question.misconception]]
id = "transposed"
value = [[1, 0], [2, 1], [0, 0]]
feedback = "rows and columns"

[[question]]
id = "moment"
kind = "number"
points = 4
prompt = "M"
unit = "N m"
asks_unit = true
tolerance = { relative = 0.01, absolute = 0 }
hints = ["h"]

[[question]]
id = "energy"
kind = "formula"
points = 1
prompt = "T"
symbols = { m = [0.5, 2.0], v = [1.0, 3.0] }
hints = ["h"]
[[question.misconception]]
id = "no-half"
value = "m*v^2"
feedback = "the half"
"#;

const REFERENCES: &str = r#"
c = { value = [[1, 2], [0, 1], [0, 0]], provenance = "closed-form", source = "by definition" }
moment = { value = 12.0, provenance = "closed-form", source = "force times arm" }
energy = { value = "1/2*m*v^2", provenance = "closed-form", source = "kinetic energy" }
"#;

fn course() -> Course {
    let lesson = "title = \"t\"\nsummary = \"s\"\nminutes = 10\nobjectives = [\"o\"]\n";
    let files: [(&str, &str); 6] = [
        ("course.toml", "format_version = 1\ntitle = \"x\"\n"),
        ("01-kinds/lesson.toml", lesson),
        ("01-kinds/lesson.md", "text\n"),
        (
            "01-kinds/scene.json",
            r#"{"name": "one", "bodies": [{"name": "a", "mass": 1, "inertia": {"principal": [1, 1, 1]}}]}"#,
        ),
        ("01-kinds/exercise.toml", EXERCISE),
        ("01-kinds/reference/answers.toml", REFERENCES),
    ];
    let files: Files = files.into_iter().map(|(n, t)| (n.to_owned(), t.as_bytes().to_vec())).collect();
    Course::from_files(files).unwrap_or_else(|e| panic!("{e}"))
}

fn judged(id: &str, value: TypedValue, unit: Option<&str>) -> QuestionVerdict {
    let answer = Answer { value: Some(value), unit: unit.map(str::to_owned), ..Answer::default() };
    let submission =
        Submission { answers: BTreeMap::from([(id.to_owned(), answer)]), ..Submission::default() };
    let verdict = grade(course().lesson("kinds").unwrap(), &submission).unwrap();
    assert!(!verdict.passed);
    verdict.questions.into_iter().find(|q| q.id == id).unwrap()
}

fn text(text: &str) -> TypedValue {
    TypedValue::Text(text.to_owned())
}

fn rows(rows: &[&[&str]]) -> TypedValue {
    TypedValue::List(rows.iter().map(|row| TypedValue::List(row.iter().map(|x| text(x)).collect())).collect())
}

#[test]
fn a_matrix_is_judged_as_a_whole_and_its_form_is_checked() {
    let right = judged("c", rows(&[&["1.00", "2.00"], &["0", "1.00"], &["0", "0"]]), Some("m"));
    assert_eq!(right.verdict, Mark::Right);
    let scaled = judged("c", rows(&[&["100.0", "200.0"], &["0", "100.0"], &["0", "0"]]), Some("cm"));
    assert_eq!(scaled.verdict, Mark::Right);
    let transposed = judged("c", rows(&[&["1.00", "0"], &["2.00", "1.00"], &["0", "0"]]), None);
    assert_eq!(transposed.misconception.as_deref(), Some("transposed"));
    for (form, says) in [
        (rows(&[&["1", "0"], &["0", "1"]]), "3 rows of 2"),
        (rows(&[&["1"], &["2"], &["0"]]), "2 entries"),
        (text("1 2 0"), "3 rows of 2"),
        (rows(&[&["1", ""], &["0", "1"], &["0", "0"]]), "Entry 2 is empty"),
    ] {
        let verdict = judged("c", form, Some("m"));
        assert_eq!(verdict.verdict, Mark::Invalid);
        assert!(verdict.message_html.contains(says), "{}", verdict.message_html);
    }
}

#[test]
fn a_unit_that_is_asked_for_counts_half() {
    let earned = |value: &str, unit| {
        let verdict = judged("moment", text(value), unit);
        (verdict.verdict, verdict.earned)
    };
    assert_eq!(earned("12.0", Some("N m")), (Mark::Right, 4.0));
    assert_eq!(earned("12.0", Some("J")), (Mark::Right, 4.0));
    assert_eq!(earned("12.0", Some("N")), (Mark::Wrong, 2.0));
    assert_eq!(earned("13.0", Some("N m")), (Mark::Wrong, 1.0));
    assert_eq!(earned("13.0", Some("kg")), (Mark::Wrong, 0.0));
    assert_eq!(earned("12.0", None), (Mark::Invalid, 0.0));
    assert_eq!(earned("12.0", Some("mN")), (Mark::Invalid, 0.0));
    let view = serde_json::to_string(&course().lesson("kinds").unwrap().public_view()).unwrap();
    assert!(!view.contains("N m"), "the unit that is asked for must not be shown");
}

/// While one field cannot be read nothing is said of the others, or they could be tried one by one without an attempt.
#[test]
fn nothing_is_judged_beside_an_answer_that_cannot_be_read() {
    let answers = |moment: &str, energy: &str| {
        let energy = Answer { value: Some(text(energy)), ..Answer::default() };
        let moment = Answer { value: Some(text(moment)), unit: Some("N m".to_owned()), ..Answer::default() };
        let answers = BTreeMap::from([("energy".to_owned(), energy), ("moment".to_owned(), moment)]);
        grade(course().lesson("kinds").unwrap(), &Submission { answers, ..Submission::default() }).unwrap()
    };
    for moment in ["12.0", "13.0"] {
        let verdict = answers(moment, "m*(v");
        let marks: Vec<Mark> = verdict.questions.iter().map(|q| q.verdict).collect();
        assert_eq!(marks, [Mark::Blank, Mark::Waiting, Mark::Invalid]);
        assert!(!verdict.gradable && !verdict.passed && verdict.earned == 0.0);
        assert_eq!(verdict.questions[1].misconception, None);
    }
    assert_eq!(answers("12.0", "m*v^2/2").earned, 5.0);
}

/// A unit belongs to the number it stands behind; hertz counts turns; a count has no unit.
#[test]
fn units_are_taken_at_their_word() {
    let lesson = course();
    let lesson = lesson.lesson("kinds").unwrap();
    let read = |id: &str, value: TypedValue| {
        let answer = Answer { value: Some(value), ..Answer::default() };
        understand(lesson.question(id).unwrap(), &answer).unwrap()
    };
    let rows = |last: &str| {
        let row = |a: &str, b: &str| TypedValue::List(vec![text(a), text(b)]);
        TypedValue::List(vec![row("1", "2"), row("0", "1"), row("0", last)])
    };
    assert_eq!(read("c", rows("0 m")).text.as_deref(), Some("[1 2; 0 1; 0 0] m"));
    assert!(read("c", rows("87 cm")).problem.unwrap().contains("component 6 has a unit"));
    assert_eq!(read("moment", text("3*4 N m")).text.as_deref(), Some("12 N m"));
    assert_eq!(read("moment", text("1200 Ncm")).text.as_deref(), Some("1200 Ncm = 12 N m"));
    assert_eq!(read("energy", text("½mv²")).text.as_deref(), Some("1/2·m·v^2"));
    let pasted = read("c", text("[[1, 2], [0, 1], [0, 0]] cm"));
    assert_eq!(pasted.cells, ["1 cm", "2 cm", "0 cm", "1 cm", "0 cm", "0 cm"]);
}

#[test]
fn a_formula_is_judged_by_what_it_means() {
    for same in ["m*v^2/2", "0.5 m v^2", "v*m*v/2", "(m v)^2/(2 m)"] {
        assert_eq!(judged("energy", text(same), None).verdict, Mark::Right, "{same}");
    }
    // Rounded to four digits, but not to three.
    assert_eq!(judged("energy", text("0.5004 m v^2"), None).verdict, Mark::Wrong);
    assert_eq!(judged("energy", text("0.5002 m v^2"), None).verdict, Mark::Right);
    let misconception = |formula: &str| judged("energy", text(formula), None).misconception;
    assert_eq!(misconception("m v^2/2 + 0.1").as_deref(), Some("constant-term"));
    assert_ne!(misconception("m v^2.002/2").as_deref(), Some("constant-term"));
    assert_eq!(misconception("v^2 m").as_deref(), Some("no-half"));
    assert_eq!(misconception("-m v^2/2").as_deref(), Some("opposite-sign"));
    assert!(judged("energy", text("v^2/2"), None).message_html.contains("depends on m"));
    for (unreadable, says) in [("m v^2/2)", "bracket"), ("m*w", "known are m, v"), ("m**", "character")] {
        let verdict = judged("energy", text(unreadable), None);
        assert_eq!(verdict.verdict, Mark::Invalid, "{unreadable}");
        assert!(verdict.message_html.contains(says), "{}", verdict.message_html);
    }
    // A formula that is nowhere defined is not right by accident.
    assert_eq!(judged("energy", text("sqrt(-1-v)"), None).verdict, Mark::Wrong);
}

#[test]
fn a_joule_is_taken_for_a_moment_and_the_reader_says_so() {
    let course = Course::embedded().unwrap();
    let question = course.lesson("inverse-dynamics").unwrap().question("holding").unwrap();
    let read = |text: &str| {
        let answer = Answer { value: Some(TypedValue::Text(text.to_owned())), ..Answer::default() };
        understand(question, &answer).unwrap().text.unwrap()
    };
    assert_eq!(read("17.70 J"), "17.7 N m: a moment; joules are for work and energy");
    assert_eq!(read("17.70 N m"), "17.7 N m");
}
