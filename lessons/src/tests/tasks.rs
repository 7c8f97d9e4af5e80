//! Questions that are answered by work, and what goes with them: right, wrong with its own feedback, bad input, bounds.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use crate::answers::diagram::{Arrow, ArrowKind, Sense};
use crate::answers::table::TableError;
use crate::answers::{Answer, RunSettings, TypedValue};
use crate::grading::judge;
use crate::lesson::Lesson;
use crate::tasks::program_output::OutputError;
use crate::verdict::feedback::{Demand, Discrepancy, Feedback, Judgement, MotionFinding, PartFinding};
use crate::verdict::html;
use crate::verdict::invalid::{
    InvalidAnswer, InvalidModel, InvalidProgram, InvalidSettings, InvalidTrajectory,
};
use crate::{Course, Mark, QuestionVerdict, Submission, grade, reference_submission};

pub(super) fn lesson(slug: &str) -> Lesson {
    Course::embedded().unwrap_or_else(|e| panic!("{e}")).lesson(slug).unwrap().clone()
}

fn judged(lesson: &Lesson, id: &str, answer: Answer) -> QuestionVerdict {
    all(lesson, [(id, answer)]).remove(id).unwrap()
}

fn all<const N: usize>(lesson: &Lesson, answers: [(&str, Answer); N]) -> BTreeMap<String, QuestionVerdict> {
    let answers = answers.into_iter().map(|(id, a)| (id.to_owned(), a)).collect();
    let verdict = grade(lesson, &Submission { answers, ..Submission::default() }).unwrap();
    verdict.questions.into_iter().map(|q| (q.id.clone(), q)).collect()
}

fn file(text: impl Into<String>) -> Answer {
    Answer { file: Some(text.into()), ..Answer::default() }
}

pub(super) fn value(text: &str) -> Answer {
    Answer { value: Some(TypedValue::Text(text.to_owned())), ..Answer::default() }
}

/// One answer, judged as data.
pub(super) fn judgement(lesson: &Lesson, id: &str, answer: Answer) -> Judgement {
    let answers = BTreeMap::from([(id.to_owned(), answer)]);
    let judgements = judge(lesson, &Submission { answers, ..Submission::default() }).unwrap();
    let place = lesson.exercise.questions.iter().position(|q| q.id == id).unwrap();
    judgements.into_iter().nth(place).unwrap()
}

/// Why an answer cannot be judged.
fn invalid(judgement: Judgement) -> InvalidAnswer {
    match judgement.feedback {
        Feedback::Invalid(why) if judgement.mark == Mark::Invalid => why,
        other => panic!("{other:?}"),
    }
}

/// The file of the reference, as JSON to be spoilt.
fn reference(lesson: &Lesson, id: &str) -> serde_json::Value {
    let text = reference_submission(lesson).answers[id].file.clone().unwrap();
    serde_json::from_str(&text).unwrap()
}

/// Whether an error is the expected one.
type Is<E> = fn(&E) -> bool;

#[test]
fn feedback_names_block_row_and_column_of_a_wrong_entry() {
    let lesson = lesson("jacobian").variant("ada").unwrap();
    let right = judged(&lesson, "program", file(reference(&lesson, "program").to_string()));
    assert_eq!((right.verdict, right.earned), (Mark::Right, right.possible));

    let mut spoilt = reference(&lesson, "program");
    // Row 12 is the hinge's first, columns from 0 the upper link's.
    spoilt["states"][2]["jacobian"][12][3] = 7.0.into();
    let wrong = judgement(&lesson, "program", file(spoilt.to_string()));
    assert_eq!((wrong.mark, wrong.share), (Mark::Wrong, 0.5));
    let Feedback::Program { parts } = &wrong.feedback else { panic!("{:?}", wrong.feedback) };
    let off = Discrepancy {
        state: 3,
        states: 5,
        entries: 1,
        of: 504,
        rows: vec!["hinge: CP.x".to_owned()],
        rows_are_coordinates: false,
        columns: vec!["upper.ux".to_owned()],
        block: Some(("hinge".to_owned(), "upper".to_owned())),
        factor: None,
    };
    assert!(parts.iter().any(|(_, finding)| *finding == PartFinding::Off(off.clone())), "{parts:?}");
    let own = reference(&lesson, "program")["states"][2]["jacobian"][12][3].to_string();
    assert!(!html::message(&wrong.feedback).contains(&own), "the right number is not shown");
}

#[test]
fn misconceptions_of_a_program_are_recognised() {
    let lesson = lesson("rigid-body-rows").variant("ada").unwrap();
    let spoilt = |part: &str, change: &dyn Fn(f64) -> f64| {
        let mut answer = reference(&lesson, "program");
        for state in answer["states"].as_array_mut().unwrap() {
            for x in state[part].as_array_mut().unwrap() {
                *x = change(x.as_f64().unwrap()).into();
            }
        }
        judged(&lesson, "program", file(answer.to_string()))
    };
    assert_eq!(spoilt("gamma", &|x| -x).misconception.as_deref(), Some("gamma-gamma-sign"));
    assert_eq!(spoilt("gamma", &|x| x / 2.0).misconception.as_deref(), Some("gamma-gamma-half"));
    assert_eq!(spoilt("phi", &|x| -x).misconception.as_deref(), Some("phi-sign"));
    let mut transposed = reference(&lesson, "program");
    for state in transposed["states"].as_array_mut().unwrap() {
        let rows = state["jacobian"].as_array().unwrap().clone();
        let columns: Vec<Vec<_>> = (0..12).map(|c| rows.iter().map(|r| r[c].clone()).collect()).collect();
        state["jacobian"] = serde_json::json!(columns);
    }
    let verdict = judged(&lesson, "program", file(transposed.to_string()));
    assert_eq!(verdict.misconception.as_deref(), Some("jacobian-transposed"), "{}", verdict.message_html);
    // The states of another student are not one's own.
    let other = lesson.variant("emmy").unwrap();
    let copied = judged(&other, "program", file(reference(&lesson, "program").to_string()));
    assert_eq!((copied.verdict, copied.earned), (Mark::Wrong, 0.0));
}

#[test]
fn a_program_may_write_csv_and_bad_files_use_no_attempt() {
    let lesson = lesson("rigid-body-rows");
    let reference = reference(&lesson, "program");
    let mut csv = "state,part,row,column,value\n".to_owned();
    for (k, state) in reference["states"].as_array().unwrap().iter().enumerate() {
        for part in ["phi", "gamma", "jacobian"] {
            for (row, line) in state[part].as_array().unwrap().iter().enumerate() {
                let cells = line.as_array().cloned().unwrap_or_else(|| vec![line.clone()]);
                for (column, x) in
                    cells.iter().enumerate().filter(|(_, x)| part != "jacobian" || x.as_f64() != Some(0.0))
                {
                    writeln!(csv, "{},{part},{},{},{x}", k + 1, row + 1, column + 1).unwrap();
                }
            }
        }
    }
    assert_eq!(judged(&lesson, "program", file(&csv)).verdict, Mark::Right);
    let cases: [(&str, Is<OutputError>); 8] = [
        ("{", |e| matches!(e, OutputError::Json { .. })),
        ("{\"states\": []}", |e| *e == OutputError::StateCount { found: 0, given: 5 }),
        (
            "{\"states\": [{\"phi\": [1]},{\"phi\": [1]},{\"phi\": [1]},{\"phi\": [1]},{\"phi\": [1]}]}",
            |e| matches!(e, OutputError::Form { wanted, .. } if wanted == "6 numbers"),
        ),
        ("{\"states\": [{\"phi\": [1,2,3,4,5,null]},{},{},{},{}]}", |e| {
            matches!(e, OutputError::Form { .. })
        }),
        ("state,part,row,column,value\n9,phi,1,1,0", |e| {
            matches!(e, OutputError::OutOfRange { line: 2, name: "state", most: 5, .. })
        }),
        (
            "state,part,row,column,value\n1,psi,1,1,0",
            |e| matches!(e, OutputError::UnknownPart { part, .. } if part == "psi"),
        ),
        ("state,row,column,value\n1,1,1,0", |e| *e == OutputError::MissingColumn { name: "part" }),
        ("state,part,row,column,value\n1,phi,1,1,NaN", |e| {
            matches!(e, OutputError::Table(TableError::NotFinite { line: 2, .. }))
        }),
    ];
    for (text, is) in cases {
        match invalid(judgement(&lesson, "program", file(text))) {
            InvalidAnswer::Program(InvalidProgram::Output(error)) => assert!(is(&error), "{text}: {error:?}"),
            other => panic!("{text}: {other:?}"),
        }
    }
    assert_eq!(judged(&lesson, "program", value("3")).verdict, Mark::Invalid);
    let huge = serde_json::json!({"answers": {"program": {"file": "x".repeat((1 << 20) + 1)}}});
    assert_eq!(Submission::from_json(&huge.to_string()).unwrap_err().code(), "submission-too-large");
}

/// A table of the plane pendulum by hand: the engine's own reference, shifted or stretched.
fn pendulum(late: f64, factor: f64, every: f64) -> String {
    let lesson = lesson("verification");
    let text = reference_submission(&lesson).answers["your-run"].file.clone().unwrap();
    let rows: Vec<Vec<f64>> =
        text.lines().skip(1).map(|l| l.split(',').map(|x| x.parse().unwrap()).collect()).collect();
    let at = |t: f64, column: usize| {
        let k = rows.iter().position(|r| r[0] > t).unwrap_or(1000).clamp(1, 1000) - 1;
        let s = (t - rows[k][0]) / 0.01;
        rows[k][column] * (1.0 - s) + rows[k + 1][column] * s
    };
    let mut out = "t; x [m]; y [m]\n".to_owned();
    let mean = |c: usize| rows.iter().map(|r| r[c]).sum::<f64>() / rows.len() as f64;
    let (mx, my) = (mean(1), mean(2));
    let mut t = 0.0;
    while t < 10.0 + 0.5 * every {
        let (x, y) = (at(t - late, 1), at(t - late, 2));
        writeln!(out, "{t};{};{}", mx + factor * (x - mx), my + factor * (y - my)).unwrap();
        t += every;
    }
    out
}

#[test]
fn a_table_is_judged_by_bands_and_phase_is_distinguished_from_amplitude() {
    let lesson = lesson("verification");
    let judge = |text: String| judged(&lesson, "your-run", file(text));
    let right = judge(pendulum(0.0, 1.0, 0.02));
    assert_eq!((right.verdict, right.earned), (Mark::Right, 4.0), "{}", right.message_html);
    let late = judge(pendulum(0.05, 1.0, 0.02));
    assert_eq!(late.misconception.as_deref(), Some("phase"), "{}", late.message_html);
    let late = judgement(&lesson, "your-run", file(pendulum(0.05, 1.0, 0.02)));
    let Feedback::Trajectory { finding: MotionFinding::Phase { late }, .. } = late.feedback else {
        panic!("{late:?}")
    };
    assert!((late - 0.05).abs() < 1e-3, "{late}");
    let large = judge(pendulum(0.0, 1.2, 0.04));
    assert_eq!(large.misconception.as_deref(), Some("amplitude"), "{}", large.message_html);
    let nearly = judge(pendulum(0.0, 1.006, 0.02));
    assert_eq!(nearly.earned, 0.7 * 4.0, "{}", nearly.message_html);
    let swapped = judge(pendulum(0.0, 1.0, 0.02).replace("x [m]; y", "y [m]; x"));
    assert_eq!((swapped.verdict, swapped.earned), (Mark::Wrong, 0.0));
    assert_eq!(swapped.misconception.as_deref(), Some("swapped-columns"));
}

#[test]
fn an_unusable_table_gets_the_reason() {
    let lesson = lesson("verification");
    let long = pendulum(0.0, 1.0, 0.02);
    let cases: [(String, Is<InvalidTrajectory>); 6] = [
        ("t,x\n0,1\n".to_owned(), |e| matches!(e, InvalidTrajectory::NoColumn { name, .. } if name == "y")),
        ("t,x,y\n0,1,2\n".to_owned(), |e| *e == InvalidTrajectory::FewRows { rows: 1, fewest: 20 }),
        (long.lines().take(300).collect::<Vec<_>>().join("\n"), |e| {
            matches!(e, InvalidTrajectory::Range { end: 10.0, .. })
        }),
        (pendulum(0.0, 1.0, 10.0 / 19.0), |e| matches!(e, InvalidTrajectory::Gap { most: 0.5, .. })),
        (long.replace("0.02;", "0;"), |e| matches!(e, InvalidTrajectory::Times { .. })),
        (
            long.replace("0.02;", "soon;"),
            |e| matches!(e, InvalidTrajectory::Table(TableError::NotANumber { line: 3, column, .. }) if column == "t"),
        ),
    ];
    // What people write for the same thing.
    let named = long.replacen("t;", "\u{feff}Time [s];", 1);
    assert!(named != long);
    assert_eq!(judged(&lesson, "your-run", file(named)).verdict, Mark::Right);
    for (text, is) in cases {
        match invalid(judgement(&lesson, "your-run", file(text))) {
            InvalidAnswer::Trajectory(error) => assert!(is(&error), "{error:?}"),
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn a_scene_is_judged_by_what_it_does() {
    let lesson = lesson("slider-crank");
    let mut scene = reference(&lesson, "scene");
    // Other names, another order, another way to say the same: nobody looks at the text.
    scene["bodies"][0]["name"] = "wheel".into();
    scene["joints"][0]["body_j"] = "wheel".into();
    scene["joints"][1]["body_i"] = "wheel".into();
    scene["bodies"].as_array_mut().unwrap().reverse();
    let right = judged(&lesson, "scene", file(format!("\u{feff}{scene}")));
    assert_eq!(right.verdict, Mark::Right, "{}", right.message_html);

    let mut heavy = scene.clone();
    heavy["gravity"] = serde_json::json!([0, 0, 0]);
    let wrong = judged(&lesson, "scene", file(heavy.to_string()));
    assert_eq!(wrong.verdict, Mark::Wrong);
    assert!(wrong.earned > 0.0 && wrong.earned < wrong.possible, "partial credit: {}", wrong.earned);

    let mut large = scene.clone();
    large["bodies"] = serde_json::json!(vec![scene["bodies"][0].clone(); 7]);
    let Feedback::Model { demands, note: None } =
        judgement(&lesson, "scene", file(heavy.to_string())).feedback
    else {
        panic!("a note for a wrong scene")
    };
    assert!(demands.iter().any(|d| !d.met && matches!(d.demand, Demand::Watch { stopped: None, .. })));

    // Who gives the guide another name loses what is seen at the guide, not the motion.
    let mut renamed = scene.clone();
    let joints = renamed["joints"].as_array_mut().unwrap();
    joints.iter_mut().find(|joint| joint["name"] == "guide").unwrap()["name"] = "rail".into();
    let renamed = judged(&lesson, "scene", file(renamed.to_string()));
    assert!(renamed.earned > 0.5 * renamed.possible, "{}", renamed.message_html);
    assert!(renamed.message_html.contains("There is no joint or driver guide."), "{}", renamed.message_html);

    let why = |text: String| invalid(judgement(&lesson, "scene", file(text)));
    let mut nameless = scene.clone();
    nameless.as_object_mut().unwrap().remove("name");
    let nameless = why(nameless.to_string()).to_string();
    assert!(nameless.contains("`name` is missing: write it between the braces"), "{nameless}");
    assert!(matches!(why("{".to_owned()), InvalidAnswer::Model(InvalidModel::Scene(_))));
    let hinge = why(scene.to_string().replace("\"universal\"", "\"hinge\""));
    assert!(
        matches!(&hinge, InvalidAnswer::Model(InvalidModel::Scene(e)) if e.to_string().contains("hinge"))
    );
    let many = InvalidAnswer::Model(InvalidModel::Bodies { bodies: 7, most: 6 });
    assert_eq!(why(large.to_string()), many);
    // Another structure earns nothing, whatever else it shares: a block alone on its guide, and the scene of the lesson.
    let mut alone = scene.clone();
    let block = scene["bodies"].as_array().unwrap().iter().find(|b| b["name"] == "block").unwrap();
    let guide = scene["joints"].as_array().unwrap().iter().find(|j| j["name"] == "guide").unwrap();
    alone["bodies"] = serde_json::json!([block]);
    alone["joints"] = serde_json::json!([guide]);
    for other in [alone, lesson.scene.clone()] {
        assert_eq!(judged(&lesson, "scene", file(other.to_string())).earned, 0.0);
    }
    let empty = judgement(&lesson, "scene", file("{\"name\":\"x\",\"bodies\":[]}"));
    assert!(matches!(empty.mark, Mark::Wrong | Mark::Invalid), "{empty:?}");
}

#[test]
fn settings_are_run_and_drawn() {
    let lesson = lesson("work-and-precision");
    let chosen = |word: &str, tolerance: &str| {
        let integrator = serde_json::from_value(serde_json::json!(word)).unwrap();
        let tolerance = TypedValue::Text(tolerance.to_owned());
        Answer { settings: Some(RunSettings { integrator, tolerance, baumgarte: None }), ..Answer::default() }
    };
    let settings = |word: &str, tolerance: &str| judged(&lesson, "tune", chosen(word, tolerance));
    let right = settings("dop853", "1e-8");
    assert_eq!(right.verdict, Mark::Right, "{}", right.message_html);
    let picture = right.figure_svg.unwrap();
    assert!(picture.contains("dopri5") && picture.contains("your run"), "the curves open when it is right");
    let coarse = settings("dop853", "1e-4");
    assert_eq!(
        (coarse.misconception.as_deref(), coarse.earned),
        (Some("too-coarse"), 0.0),
        "cheap is no work"
    );
    assert!(!coarse.figure_svg.unwrap().contains("polyline"), "the curves would be the answer");
    assert_eq!(settings("dop853", "1e-11").misconception.as_deref(), Some("too-dear"));
    assert_eq!(settings("dopri5", "1e-12").verdict, Mark::Wrong);
    let why = |word: &str, tolerance: &str| match invalid(judgement(&lesson, "tune", chosen(word, tolerance)))
    {
        InvalidAnswer::Settings(error) => error,
        other => panic!("{other:?}"),
    };
    let unknown = why("taylor", "1e-8");
    assert!(matches!(unknown, InvalidSettings::Integrator { integrator, .. } if integrator == "taylor"));
    assert!(matches!(why("dop853", "soon"), InvalidSettings::Number { what: "The tolerance", .. }));
    assert_eq!(why("dop853", "1e-20"), InvalidSettings::ToleranceRange);
    assert_eq!(settings("dop853", "").verdict, Mark::Blank);
}

#[test]
fn a_right_step_from_a_wrong_answer_counts() {
    let lesson = lesson("spherical-joint");
    let both = |speed: &str, pull: &str| {
        let verdicts = all(&lesson, [("speed", value(speed)), ("pull", value(pull))]);
        (verdicts["speed"].verdict, verdicts["pull"].clone())
    };
    let (speed, pull) = both("3.000", "18.00");
    assert_eq!(
        (speed, pull.verdict, pull.misconception.as_deref()),
        (Mark::Wrong, Mark::Wrong, Some("follow-through"))
    );
    assert_eq!(pull.earned, 0.8 * pull.possible);
    // Nothing follows from zero, and what a known mistake leads to earns nothing.
    assert_eq!(both("0", "0").1.earned, 0.0);
    assert_eq!(both("3.1321", "19.62").1.misconception.as_deref(), Some("weight"));
    assert_eq!(html::message(&Feedback::FollowThrough { questions: vec![2] }), pull.message_html);
    // The same number beside a right speed is wrong.
    assert_eq!(both("4.4294", "18.00").1.verdict, Mark::Wrong);
    assert_eq!(both("3.000", "17.00").1.verdict, Mark::Wrong);
    // The right answer stays right.
    assert_eq!(both("3.000", "39.24").1.misconception, None);
}

/// The wrong models agree with derivations on paper.
#[test]
fn wrong_models_give_the_answers_of_their_misconceptions() {
    use crate::exercise::QuestionBody;
    let answers = |slug: &str, id: &str| -> BTreeMap<String, Vec<f64>> {
        let lesson = lesson(slug);
        let QuestionBody::Quantity(q) = &lesson.question(id).unwrap().body else { panic!("{id}") };
        q.misconceptions.iter().map(|m| (m.id.clone(), m.value.clone())).collect()
    };
    let near = |a: &[f64], b: &[f64]| {
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6 * (1.0 + b.abs())), "{a:?} {b:?}");
    };
    let hinge = answers("joint-reactions", "force-on-ground");
    near(&hinge["on-the-ball"], &[0.0, 2.0 * 9.81 + 32.0, 0.0]);
    near(&hinge["static"], &[0.0, -2.0 * 9.81, 0.0]);
    near(&hinge["weight-missing"], &[0.0, -32.0, 0.0]);
    near(&answers("equations-of-motion", "force")["mass-for-weight"], &[0.0, 0.75, 0.0]);
    let arm = answers("inverse-dynamics", "upper-end");
    near(&arm["static"], &[3.0 * 9.81 * 0.6 * libm::cos(1f64)]);
    near(&arm["no-gravity"], &[-3.0 * 1.44 / 3.0 * 9.0]);
    near(&answers("points-and-vectors", "corner-start")["opposite-corner"], &[1.2, 1.7, 0.9]);
    // The wrong sign turns the body differently: no closed form, but surely not the same.
    let QuestionBody::Quantity(turned) = &lesson("reduced-body").question("turned").unwrap().body.clone()
    else {
        panic!()
    };
    assert!(
        turned.error < 1e-8 && !turned.tolerance.accepts(&turned.misconceptions[0].value, &turned.reference)
    );
}

#[test]
fn how_a_model_would_be_run_and_stopped_is_no_part_of_it() {
    let lesson = lesson("capstone");
    let mut model = reference(&lesson, "machine");
    model["simulation"] =
        serde_json::json!({ "step": 1e-5, "integrator": "dop853", "tolerance": 0.1, "duration": 0.01 });
    model["events"] = serde_json::json!([{ "name": "early", "of": { "type": "angle", "joint": model["joints"][0]["name"] },
        "value": 0.1, "stop": true }]);
    let judged = judgement(&lesson, "machine", file(model.to_string()));
    assert_eq!(judged.mark, Mark::Right, "{:?}", judged.feedback);
}

#[test]
fn what_is_cut_acts_on_two_bodies_in_opposite_directions_also_where_it_is_zero() {
    let lesson = lesson("two-links");
    let reference = reference_submission(&lesson).answers["cut"].clone();
    let mark = |senses: [Sense; 2]| {
        let arrow = |(on, along): (&str, Sense)| {
            let (at, on) = ("elbow".to_owned(), on.to_owned());
            Arrow { kind: ArrowKind::Force, at, on, along }
        };
        let more = ["upper", "lower"].into_iter().zip(senses).map(arrow);
        let diagram = Some(reference.diagram.iter().flatten().cloned().chain(more).collect());
        judgement(&lesson, "cut", Answer { diagram, ..Answer::default() }).mark
    };
    assert_eq!(mark([Sense::PlusX, Sense::MinusX]), Mark::Right);
    assert_eq!(mark([Sense::PlusX, Sense::PlusX]), Mark::Wrong);
}
