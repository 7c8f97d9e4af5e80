//! Bad input is answered with a code, a place and a remedy: by the engine, on the command line and over HTTP alike,
//! and the server lives on.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use serde_json::{Value, json};
use triad_engine::EngineError;
use triad_engine::analysis::check;
use triad_engine::scene::Scene;
use triad_tests::program::{Server, assert_problem, run, run_json};

/// A bar that hangs on the ground and a second bar that hangs on the first.
fn good() -> Value {
    json!({
        "name": "bars",
        "bodies": [
            { "name": "upper", "mass": 1, "inertia": { "principal": [0.1, 1, 1] }, "position": [0.5, 0, 0] },
            { "name": "lower", "mass": 1, "inertia": { "principal": [0.1, 1, 1] }, "position": [1.5, 0, 0] }
        ],
        "joints": [
            { "name": "top", "type": "revolute", "body_i": "ground", "body_j": "upper",
              "point": [0, 0, 0], "axis": [0, 1, 0] },
            { "name": "elbow", "type": "spherical", "body_i": "upper", "body_j": "lower",
              "point_i": [0.5, 0, 0], "point_j": [-0.5, 0, 0] }
        ]
    })
}

/// Writes a value to a place that may be new.
fn set(scene: &mut Value, place: &str, value: Value) {
    let (parent, key) = place.rsplit_once('/').unwrap();
    let parent = scene.pointer_mut(parent).unwrap();
    match key.parse::<usize>() {
        Ok(index) => parent[index] = value,
        Err(_) => parent[key] = value,
    }
}

/// What is wrong, as a change of the good scene; the code; the place.
fn cases() -> Vec<(&'static str, Value, &'static str, &'static str)> {
    let case = |place: &'static str, value: Value, code, pointer| {
        let mut scene = good();
        set(&mut scene, place, value);
        (place, scene, code, pointer)
    };
    vec![
        case("/bodies/0/colour", json!("red"), "scene-syntax", "/bodies/0/colour"),
        case("/bodies/0/mass", json!("heavy"), "scene-syntax", "/bodies/0/mass"),
        case("/joints/1/type", json!("hinge"), "scene-syntax", "/joints/1/type"),
        case("/gravity", json!([0, 1]), "scene-syntax", "/gravity"),
        case("/bodies/1/mass", Value::Null, "scene-syntax", "/bodies/1/mass"),
        case("/joints/1/body_j", json!("lowr"), "unknown-body", "/joints/1/body_j"),
        case("/joints/1/body_j", json!("upper"), "joint-to-itself", "/joints/1/body_j"),
        case("/bodies/1/name", json!("upper"), "duplicate-name", "/bodies/1/name"),
        case("/bodies", json!([]), "no-bodies", "/bodies"),
        case("/bodies/0/mass", json!(0), "mass-not-positive", "/bodies/0/mass"),
        case("/bodies/1/mass", json!(-2), "mass-not-positive", "/bodies/1/mass"),
        case(
            "/bodies/0/inertia",
            json!({"principal": [1, 1, 5]}),
            "inertia-not-physical",
            "/bodies/0/inertia",
        ),
        case(
            "/bodies/0/inertia",
            json!({"tensor": [[1, 0.5, 0], [0, 1, 0], [0, 0, 1]]}),
            "inertia-not-symmetric",
            "/bodies/0/inertia/tensor",
        ),
        case(
            "/bodies/0/orientation",
            json!({"u": [1, 0, 0]}),
            "orientation-invalid",
            "/bodies/0/orientation",
        ),
        case("/joints/0/axis", json!([0, 0, 0]), "joint-geometry", "/joints/0/axis"),
        case("/joints/1/point_i", json!([9, 0, 0]), "start-too-far", "/joints/1"),
        case("/simulation", json!({"tolerance": 0}), "out-of-range", "/simulation/tolerance"),
    ]
}

#[test]
fn every_mistake_in_a_scene_is_named_in_all_three_ways_of_use() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(folder.path());
    assert_eq!(server.post("/api/v1/check", &good()).status, 200, "the scene itself is good");
    for (place, scene, code, pointer) in cases() {
        let text = scene.to_string();
        let error = match Scene::from_json(&text).map_err(EngineError::from).and_then(|s| check::check(&s)) {
            Err(error) => error,
            Ok(report) => panic!("{place}: {report:?}"),
        };
        assert_eq!((error.code(), error.pointer().as_deref()), (code, Some(pointer)), "{place}: {error}");
        assert!(error.hint().len() > 10, "{place}: {error}");

        let file = folder.path().join("scene.json");
        std::fs::write(&file, &text).unwrap();
        let (exit, problem) = run_json(&["check", file.to_str().unwrap()]);
        assert_eq!(exit, 3, "{place}");
        assert_problem(&problem, code, pointer);

        for (path, body, prefix) in
            [("/api/v1/check", scene.clone(), ""), ("/api/v1/sessions", json!({ "scene": scene }), "/scene")]
        {
            let reply = server.post(path, &body);
            assert_eq!(reply.status, 422, "{place}: {}", reply.text());
            assert!(reply.head.contains("application/problem+json"));
            assert_problem(&reply.json(), code, &format!("{prefix}{pointer}"));
        }
    }
    assert_eq!(server.get("/api/v1/health").status, 200);
}

/// The command line's own form is for people: the sentence, the place, the remedy.
#[test]
fn a_terminal_is_told_the_sentence_the_place_and_the_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scene.json");
    let mut scene = good();
    scene["joints"][1]["body_j"] = json!("lowr");
    std::fs::write(&file, scene.to_string()).unwrap();
    let output = run(&["run", file.to_str().unwrap()]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(3));
    for part in ["\"elbow\"", "\"lowr\"", "[unknown-body]", "/joints/1/body_j", "Did you mean \"lower\"?"] {
        assert!(said.contains(part), "{part} is missing in: {said}");
    }
}

/// A key that is none is answered with what was meant: the nearest key there, or where a setting belongs.
#[test]
fn an_unknown_key_is_told_what_was_meant() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(folder.path());
    for (place, value, said) in [
        ("/duration", json!(3), "\"duration\" is one of the settings: write it within \"simulation\"."),
        ("/joint", json!([]), "Did you mean \"joints\"?"),
        ("/bodies/0/mas", json!(2), "Did you mean \"mass\"?"),
        ("/bodies/0/positon", json!([0, 0, 0]), "Did you mean \"position\"?"),
    ] {
        let mut scene = good();
        set(&mut scene, place, value);
        let answer = server.post("/api/v1/check", &scene);
        let refused = answer.json();
        assert_eq!(answer.status, 422, "{place}: {refused}");
        assert_eq!(refused["hint"], json!(said), "{place}: {refused}");
        let file = folder.path().join("scene.json");
        std::fs::write(&file, scene.to_string()).unwrap();
        let output = run(&["check", file.to_str().unwrap()]);
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(3) && told.contains(said), "{place}: {told}");
    }
}

/// Near a solution the start is moved onto it, and the report says so and by how much.
#[test]
fn a_start_off_the_constraints_is_corrected_and_reported() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(folder.path());
    for (place, value, said) in [
        ("/joints/1/point_i", json!([0.52, 0, 0]), "positions violated the constraints by 2.000e-2"),
        ("/bodies/0/orientation", json!({"u": [1, 0.02, 0], "v": [0, 1, 0]}), "made orthonormal"),
        ("/bodies/1/velocity", json!([0.3, 0, 0]), "velocities violated the constraints by 3.000e-1"),
    ] {
        let mut scene = good();
        set(&mut scene, place, value);
        let report = check::check(&Scene::from_json(&scene.to_string()).unwrap()).unwrap();
        assert!(report.notes.iter().any(|note| note.contains(said)), "{place}: {:?}", report.notes);
        let told = server.post("/api/v1/check", &scene).json();
        assert_eq!(told["notes"], json!(report.notes));
        let file = folder.path().join("scene.json");
        std::fs::write(&file, scene.to_string()).unwrap();
        let output = run(&["check", file.to_str().unwrap()]);
        assert!(String::from_utf8_lossy(&output.stdout).contains(said), "{output:?}");
    }
}

#[test]
fn numbers_that_are_none_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(folder.path());
    for number in ["NaN", "1e999", "-Infinity"] {
        let text = good().to_string().replacen("\"mass\":1", &format!("\"mass\":{number}"), 1);
        let error = EngineError::from(Scene::from_json(&text).unwrap_err());
        assert_eq!(error.code(), "scene-syntax", "{number}");
        assert!(error.to_string().contains("line 1"), "{error}");
        let file = folder.path().join("scene.json");
        std::fs::write(&file, &text).unwrap();
        let (exit, problem) = run_json(&["check", file.to_str().unwrap()]);
        assert_eq!(exit, 3);
        assert_problem(&problem, "scene-syntax", "");
        let reply = server.ask("POST", "/api/v1/check", Some(text.as_bytes()));
        assert!((400..500).contains(&reply.status), "{number}: {}", reply.text());
        assert!(reply.json()["hint"].is_string());
    }
    // In the engine's own types such a number is possible; it is named like the others.
    let mut scene = Scene::from_json(&good().to_string()).unwrap();
    scene.bodies[1].angular_velocity[2] = f64::NAN;
    let error = check::check(&scene).unwrap_err();
    assert_eq!(
        (error.code(), error.pointer().as_deref()),
        ("not-finite", Some("/bodies/1/angular_velocity"))
    );
    let output = run(&["run", "free-body", "--until", "NaN"]);
    assert!(!output.status.success());
    assert!(!output.stderr.is_empty());
}

#[test]
fn a_million_bodies_and_a_hundred_megabytes_harm_nobody() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(folder.path());
    let scene = |count: usize| {
        let bodies = r#"{"name":"b","mass":1},"#.repeat(count);
        format!(r#"{{"name":"many","bodies":[{}]}}"#, bodies.trim_end_matches(','))
    };
    let (many, million) = (scene(6000), scene(1_000_000));

    let error = EngineError::from(Scene::from_json(&many).unwrap_err());
    assert_eq!((error.code(), error.pointer().as_deref()), ("scene-too-large", Some("/bodies")));
    assert_eq!(EngineError::from(Scene::from_json(&million).unwrap_err()).code(), "scene-too-long");

    let file = folder.path().join("many.json");
    for (text, exit, expected) in [(&many, 3, "scene-too-large"), (&million, 4, "unreadable-file")] {
        std::fs::write(&file, text).unwrap();
        let (code, problem) = run_json(&["check", file.to_str().unwrap()]);
        assert_eq!(code, exit, "{problem}");
        assert_problem(&problem, expected, "");
    }

    assert_problem(&server.ask("POST", "/api/v1/check", Some(many.as_bytes())).json(), "scene-too-large", "");
    let reply = server.ask("POST", "/api/v1/check", Some(million.as_bytes()));
    assert_eq!(reply.status, 413);
    assert_problem(&reply.json(), "request-too-large", "");
    let reply = server.ask("POST", "/api/v1/sessions", Some(&vec![b' '; 100_000_000]));
    assert_eq!(reply.status, 413);
    assert_problem(&reply.json(), "request-too-large", "");
    assert_eq!(server.get("/api/v1/health").status, 200);
}

#[test]
fn lessons_that_do_not_exist_and_text_where_a_number_belongs() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(folder.path());
    let submission = json!({"student": "ada", "answers": {"period": {"value": "quite long", "unit": "s"}}});
    let file = folder.path().join("answers.json");
    std::fs::write(&file, submission.to_string()).unwrap();
    let file = file.to_str().unwrap();

    let (exit, problem) = run_json(&["grade", "simple-pendulm", file]);
    assert_eq!(exit, 3);
    assert_problem(&problem, "unknown-lesson", "");
    let reply = server.get("/api/v1/lessons/simple-pendulm");
    assert_eq!(reply.status, 404);
    assert_problem(&reply.json(), "unknown-lesson", "");
    assert!(reply.text().contains("simple-pendulum"), "the nearest name is offered");

    // No attempt is used, and the student is told what to write instead: the same verdict in both ways.
    let (exit, here) = run_json(&["grade", "simple-pendulum", file]);
    assert_eq!(exit, 1);
    let mut there = server.post("/api/v1/lessons/simple-pendulum/submissions", &submission).json();
    for verdict in [&here, &there] {
        assert_eq!(verdict["gradable"], false, "{verdict:#}");
        let question = verdict["questions"].as_array().unwrap().iter().find(|q| q["id"] == "period").unwrap();
        assert_eq!(question["verdict"], "invalid");
        assert!(question["message_html"].as_str().unwrap().contains("quite long"), "{question}");
    }
    // How many attempts there were only the gradebook knows.
    for question in there["questions"].as_array_mut().unwrap() {
        question.as_object_mut().unwrap().remove("standing");
    }
    assert_eq!(here["questions"], there["questions"]);
    let kept = server.get("/api/v1/submissions?student=ada").json();
    assert_eq!((kept.as_array().unwrap().len(), &kept[0]["gradable"]), (1, &json!(false)), "{kept:#}");
}
