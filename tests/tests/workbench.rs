//! The whole program as a class would use it: over HTTP against the running server, and on the command line.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use serde_json::{Value, json};
use std::io::Write;
use std::net::TcpStream;
use std::time::Instant;
use triad_engine::catalogue;
use triad_tests::program::{HANG, Server, run, run_json};
use triad_tests::reference::distance;

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

/// The answers that pass the lesson on the pendulum: values of the closed form, written as a student would.
fn right_answers(student: &str) -> Value {
    json!({"student": student, "seed": "", "answers": {
        "independent-rows": {"value": "11"},
        "tension-bottom": {"value": "29.43", "unit": "N"},
        "period": {"value": "2.368", "unit": "s"},
        "force-on-ground": {"value": ["-14.21", "-10.90", "0"], "unit": "N"},
        "sign-of-lambda": {"choice": "b"}
    }})
}

#[test]
fn a_lesson_is_read_run_and_answered_and_the_result_survives_a_restart() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(folder.path());
    assert!(server.get("/").text().contains("<html"));
    let lesson = server.get("/api/v1/lessons/simple-pendulum").json();
    assert_eq!(lesson["number"], 8);

    // The scenario, to the time that the exercise asks about.
    let created = server.post("/api/v1/sessions", &json!({"lesson": "simple-pendulum"}));
    assert_eq!(created.status, 201, "{}", created.text());
    let id = created.json()["id"].as_str().unwrap().to_owned();
    assert!(created.head.contains(&format!("location: /api/v1/sessions/{id}")), "{}", created.head);
    let session = format!("/api/v1/sessions/{id}");
    let state = server.post(&format!("{session}/step"), &json!({"steps": 1})).json();
    assert_eq!(state["steps"], 1, "{state}");
    assert!(state["time"].as_f64().unwrap() > 0.0);
    let rest = 2.0 - state["time"].as_f64().unwrap();
    let state = server.post(&format!("{session}/step"), &json!({"seconds": rest})).json();
    assert!((state["time"].as_f64().unwrap() - 2.0).abs() < 1e-12);
    assert!(state["energy_drift"].as_f64().unwrap().abs() < 1e-7);
    assert_eq!((numbers(&state["q"]).len(), numbers(&state["q_dot"]).len()), (12, 12));
    // Benchmark A01 at 2 s.
    let bob = numbers(&state["bodies"][0]["position"]);
    let error = distance(&bob, &[-0.793_566_195_343_321_7, -0.608_483_930_443_791_5, 0.0]);
    assert!(error < 1e-7, "{error:e} m");

    check_matrices(&server, &session);
    check_playing(&server, &session);

    // Wrong, then right.
    let path = "/api/v1/lessons/simple-pendulum/submissions";
    let mut wrong = right_answers("ada");
    wrong["answers"]["tension-bottom"]["value"] = "9.81".into();
    let verdict = server.post(path, &wrong).json();
    let tension = verdict["questions"].as_array().unwrap().iter().find(|q| q["id"] == "tension-bottom");
    assert_eq!(tension.unwrap()["verdict"], "wrong");
    assert!(tension.unwrap()["message_html"].as_str().unwrap().contains("weight"), "{tension:?}");
    let verdict = server.post(path, &right_answers("ada")).json();
    assert_eq!((&verdict["passed"], &verdict["earned"]), (&json!(true), &verdict["possible"]), "{verdict:#}");

    assert_eq!(server.ask("DELETE", &session, None).status, 204);
    assert_eq!(server.get(&session).status, 404);

    server.stop();
    let server = Server::start(folder.path());
    let kept = server.get("/api/v1/submissions?student=ada").json();
    assert_eq!(kept.as_array().unwrap().len(), 2);
    assert_eq!((&kept[0]["id"], &kept[0]["passed"]), (&verdict["id"], &json!(true)), "newest first");
    assert_eq!(kept[1]["passed"], verdict_of_wrong(&kept), "{kept:#}");
}

/// The Jacobian and the reaction of the pendulum's joint at 2 s.
fn check_matrices(server: &Server, session: &str) {
    let jacobian = server.get(&format!("{session}/jacobian")).json();
    let (rows, columns) = (jacobian["rows"].as_array().unwrap(), jacobian["columns"].as_array().unwrap());
    assert_eq!((rows.len(), columns.len()), (12, 12));
    assert!(rows.contains(&json!("bob: uu")) && columns.contains(&json!("bob.rx")), "{jacobian}");
    let multipliers = server.get(&format!("{session}/multipliers")).json();
    let force = numbers(&multipliers[0]["force_on_j"]);
    assert!(distance(&force, &[14.210_931_130_057_3, 10.896_536_772_893, 0.0]) < 1e-5, "{force:?}");
}

/// A session plays, is paused and goes back to its start.
fn check_playing(server: &Server, session: &str) {
    let played = server.post(&format!("{session}/play"), &json!({"speed": 4})).json();
    assert_eq!(played["playing"], true);
    // It plays on by itself; how fast is a matter of the machine.
    let waiting = Instant::now();
    while server.get(session).json()["time"].as_f64().unwrap() <= 2.1 {
        assert!(waiting.elapsed() < HANG, "the session does not play");
    }
    let paused = server.post(&format!("{session}/pause"), &json!({})).json();
    assert!(paused["time"].as_f64().unwrap() > 2.1, "{}", paused["time"]);
    let reset = server.post(&format!("{session}/reset"), &json!({})).json();
    assert_eq!(reset["time"], 0.0);
}

/// The wrong submission lost the points of one question, and still has those of the others.
fn verdict_of_wrong(kept: &Value) -> Value {
    assert!(kept[1]["earned"].as_f64() < kept[0]["earned"].as_f64());
    kept[1]["passed"].clone()
}

#[test]
fn grading_on_the_command_line_gives_the_verdict_of_the_server() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(folder.path());
    let file = folder.path().join("answers.json");
    // Two students: what somebody has had right keeps its points.
    for (student, period, exit) in [("ada", "2.368", 0), ("emmy", "9.900", 0)] {
        let mut answers = right_answers(student);
        answers["answers"]["period"]["value"] = period.into();
        std::fs::write(&file, answers.to_string()).unwrap();
        let (code, here) = run_json(&["grade", "simple-pendulum", file.to_str().unwrap()]);
        let mut there = server.post("/api/v1/lessons/simple-pendulum/submissions", &answers).json();
        // Reference answers open by attempts, which only the gradebook counts.
        for question in there["questions"].as_array_mut().unwrap() {
            let question = question.as_object_mut().unwrap();
            question.remove("reference_html");
            question.remove("standing");
        }
        for key in ["questions", "earned", "possible", "passed", "provenance"] {
            assert_eq!(here[key], there[key], "{key}");
        }
        assert_eq!(code, exit, "{here:#}");
    }
}

#[test]
fn the_api_describes_itself() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(folder.path());
    let document = server.get("/api/openapi.json").json();
    for path in [
        "/api/v1/lessons",
        "/api/v1/lessons/{slug}",
        "/api/v1/lessons/{slug}/submissions",
        "/api/v1/submissions",
        "/api/v1/scenes",
        "/api/v1/check",
        "/api/v1/sessions",
        "/api/v1/sessions/{id}/step",
        "/api/v1/sessions/{id}/jacobian",
        "/api/v1/sessions/{id}/multipliers",
        "/api/v1/health",
    ] {
        assert!(document["paths"][path].is_object(), "{path} is not described");
    }
    let schema = server.get("/api/v1/schema/scene").json();
    let printed: Value = serde_json::from_slice(&run(&["schema"]).stdout).unwrap();
    assert_eq!(schema, printed);
    assert_eq!(schema["additionalProperties"], false);
}

#[test]
fn a_run_writes_a_table_a_recording_and_a_film_and_says_how_far_it_can_be_trusted() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (csv, rrd, svg, html) = (at("run.csv"), at("run.rrd"), at("run.svg"), at("run.html"));
    let outputs = format!("--out {csv} --rrd {rrd} --svg {svg} --html {html}");
    let arguments = format!("run simple-pendulum --until 2 --every 0.1 {outputs}");
    let (exit, report) = run_json(&arguments.split(' ').collect::<Vec<_>>());
    assert_eq!(exit, 0);
    assert!(report["summary"]["energy_drift"].as_f64().unwrap().abs() < 1e-7, "{report}");
    assert_eq!(report["summary"]["finished"], true);
    let table = std::fs::read_to_string(&csv).unwrap();
    let lines: Vec<&str> = table.lines().filter(|line| !line.starts_with('#')).collect();
    assert_eq!(lines.len(), 2 + 21, "names, units and 21 times");
    assert!(lines[0].contains("bob"), "{}", lines[0]);
    assert!(lines[22].starts_with("2,"), "{}", lines[22]);
    assert!(std::fs::read(&rrd).unwrap().starts_with(b"RRF2"));
    let film = std::fs::read_to_string(&svg).unwrap();
    let pictures = film.split("attributeName=\"d\"").nth(1).unwrap().split("values=\"").nth(1).unwrap();
    assert_eq!(pictures.split('"').next().unwrap().split(';').count(), 21);
    let page = std::fs::read_to_string(&html).unwrap();
    let data =
        page.split_once(r#"id="motion">"#).and_then(|(_, rest)| rest.split_once("</script>")).unwrap().0;
    let played: Value = serde_json::from_str(data).unwrap();
    assert_eq!((&played["motion"]["until"], &played["motion"]["bodies"]), (&json!(2.0), &json!(["bob"])));
    assert!(page.len() < 300_000, "{} bytes", page.len());
}

#[test]
fn the_last_row_of_a_table_is_written_once() {
    for (until, every, count) in [("0.9", "0.3", 4), ("0.9", "0.15", 7), ("2.1", "0.7", 4), ("0.9", "0.4", 4)]
    {
        let written = run(&["run", "simple-pendulum", "--until", until, "--every", every, "--out", "-"]);
        let text = String::from_utf8(written.stdout).unwrap();
        let rows = text.lines().filter(|line| !line.starts_with('#')).skip(2);
        let times: Vec<&str> = rows.filter_map(|row| row.split(',').next()).collect();
        assert_eq!((times.len(), times.last()), (count, Some(&until)), "{times:?}");
    }
}

#[test]
fn reports_are_written_into_folders_that_are_not_there_yet_and_a_bad_place_is_told_before_the_work() {
    let folder = tempfile::tempdir().unwrap();
    let report = folder.path().join("reports/stress.html");
    let done = run(&["stress", "--case", "bookshelf", "--quick", "--html", report.to_str().unwrap()]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    assert!(std::fs::read_to_string(&report).unwrap().contains("<html"));
    // A file is no folder: nothing is run whose report has no place.
    let nowhere = report.join("stress.html");
    let refused = run(&["stress", "--html", nowhere.to_str().unwrap()]);
    assert_eq!(refused.status.code(), Some(4));
    let told = String::from_utf8_lossy(&refused.stderr);
    assert!(told.contains("unwritable-file") && told.contains("try:"), "{told}");
}

#[test]
fn check_counts_rows_and_names_the_redundant_ones() {
    let (exit, report) = run_json(&["check", "simple-pendulum"]);
    assert_eq!(exit, 0);
    let count = |key: &str| report[key].as_u64().unwrap();
    assert_eq!(
        [count("coordinates"), count("rows"), count("rank"), count("degrees_of_freedom")],
        [12, 12, 11, 1]
    );
    assert_eq!(report["redundant"], json!([{"joint": "pin", "rows": ["CV"]}]));
    // 6·5 − 1 = 29 independent joint rows of 7·6: each CV repeats one, and 3 N = 6 more are repeated by the loops.
    let (_, report) = run_json(&["check", "n-four-bar:2"]);
    let count = |key: &str| report[key].as_u64().unwrap();
    assert_eq!(
        [count("coordinates"), count("rows"), count("rank"), count("degrees_of_freedom")],
        [60, 72, 59, 1]
    );
    for (scene, freedom) in [("free-body", 6), ("spatial-double-pendulum", 6), ("n-four-bar:40", 1)] {
        assert_eq!(run_json(&["check", scene]).1["degrees_of_freedom"], freedom, "{scene}");
    }
}

#[test]
fn the_course_proves_itself() {
    let output = run(&["lesson", "check"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
}

#[test]
fn help_teaches_with_examples() {
    for (arguments, example) in [
        (&["--help"][..], "triad run simple-pendulum"),
        (&["run", "--help"], "--until 5"),
        (&["grade", "--help"], "answers.json"),
    ] {
        let output = run(arguments);
        assert!(output.status.success());
        assert!(String::from_utf8_lossy(&output.stdout).contains(example), "{arguments:?}");
    }
}

#[test]
fn connections_that_say_nothing_cost_little_and_do_not_keep_the_server_up() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(folder.path());
    server.get("/api/v1/health").json();
    let before = server.memory();
    let mut silent: Vec<TcpStream> = (0..400).map(|_| TcpStream::connect(&server.address).unwrap()).collect();
    server.get("/api/v1/health").json();
    let cost = (server.memory() - before) / 400.0;
    // 1.5 MB was the cost of a router of its own for each.
    assert!(cost < 0.1, "{cost} MB a connection");
    silent[0].write_all(b"GET / HTTP/1.1\r\nHost: x\r\n").unwrap();
    silent[1].write_all(b"POST /api/v1/sessions HTTP/1.1\r\nHost: x\r\ncontent-length: 9\r\n\r\n{").unwrap();
    server.stop(); // or fails, if it does not end
}

/// The motion of a driven mechanism is as good as exact, and the work of its drivers as exact as the tolerance asks: its energy drifts by no
/// more than that.
#[test]
fn a_drift_of_the_energy_is_what_the_tolerance_allows() {
    for (tolerance, least) in [("1e-4", 1e-2), ("1e-6", 1e-4), ("1e-8", 1e-6)] {
        let done = run(&["run", "crank-rocker", "--until", "10", "--tolerance", tolerance]);
        let told = String::from_utf8(done.stdout).unwrap();
        let energy = told.lines().find(|line| line.starts_with("  energy")).unwrap();
        let drift = energy.split_once("drift ").and_then(|(_, drift)| drift.strip_suffix(" J"));
        let drift: f64 = drift.and_then(|drift| drift.parse().ok()).unwrap_or_else(|| panic!("{energy}"));
        assert!(drift.abs() < least, "at {tolerance}: {energy}");
    }
}

/// What a sweep tells has its errors beside it, whatever is chosen.
#[test]
fn a_sweep_tells_the_errors_of_what_it_tells() {
    let words = [
        "sweep",
        "simple-pendulum",
        "--vary",
        "/gravity/1=-9.9:-9.7:3",
        "--until",
        "1",
        "--outputs",
        "joints",
    ];
    let told = String::from_utf8(run(&words).stdout).unwrap();
    let line = told.lines().find(|line| line.starts_with("  error ")).unwrap_or_else(|| panic!("{told}"));
    assert!(
        line.contains("positions right to about ") && line.ends_with("the greatest of all runs"),
        "{line}"
    );
    let (_, found) = run_json(&words);
    let names: Vec<&str> =
        found["columns"].as_array().unwrap().iter().map(|column| column["name"].as_str().unwrap()).collect();
    assert!(names[0].starts_with("pin.") && names.contains(&"position_error"), "{names:?}");
    let place = names.iter().position(|name| *name == "position_error").unwrap();
    let errors: Vec<f64> =
        found["runs"].as_array().unwrap().iter().map(|run| run["outputs"][place].as_f64().unwrap()).collect();
    assert!(errors.iter().all(|error| *error > 0.0 && *error < 1e-5), "{errors:?}");
    // None are told that are not known.
    let bare = String::from_utf8(run(&[&words[..], &["--no-estimate"]].concat()).stdout).unwrap();
    assert!(!bare.contains("  error "), "{bare}");
    let failed = run(&["sweep", "simple-pendulum", "--vary", "/bodies/0/mass=-2:-1:2"]);
    let failed = String::from_utf8(failed.stdout).unwrap();
    assert!(failed.contains("0 of 2 runs, 2 failed") && !failed.contains("  error "), "{failed}");
}

/// "is no name with values" was said of all of these, and five failures were told of any number.
#[test]
fn a_sweep_says_what_is_wrong_with_its_values_and_how_many_runs_failed() {
    for (vary, code, words) in [
        ("mass", 3, "no = stands between a name and its values"),
        ("mass=1:2", 3, "\"1:2\" is no grid and no distribution"),
        ("mass=1:2:0", 3, "whole number from 1 on, and \"0\" is none"),
        ("mass=1:2:2.5", 3, "whole number from 1 on, and \"2.5\" is none"),
        ("mass=normal:1:-0.1", 3, "a deviation is not below 0, as -0.1 is"),
        ("mass=nan:1:3", 3, "\"nan\" is no finite number"),
        ("mass=uniform:1:inf", 3, "\"inf\" is no finite number"),
        ("mass=-9:-1:8", 1, "  … and 3 more failed runs; --json tells all\n"),
        ("/bodies/0/mass=20:30:2", 0, "2 of 2 runs"),
    ] {
        let done = run(&["sweep", "simple-pendulum", "--vary", vary, "--until", "0.1"]);
        let told =
            [&done.stdout, &done.stderr].map(|text| String::from_utf8_lossy(text).into_owned()).concat();
        assert!(done.status.code() == Some(code) && told.contains(words), "{vary}: {told}");
    }
}

/// Names are an author's: one with a comma once moved all columns behind it.
#[test]
fn a_table_of_a_sweep_has_as_many_names_as_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let mut scene = serde_json::to_value(catalogue::scene("free-body").unwrap()).unwrap();
    scene["bodies"][0]["name"] = "a, \"b\"".into();
    std::fs::write(file("a.json"), scene.to_string()).unwrap();
    run(&[
        "sweep",
        &file("a.json"),
        "--vary",
        "/bodies/0/mass=1:2:2",
        "--until",
        "0.1",
        "--outputs",
        "bodies",
        "--out",
        &file("a.csv"),
    ]);
    let table = std::fs::read_to_string(file("a.csv")).unwrap();
    let (head, rows) = table.split_once('\n').unwrap();
    assert!(head.contains("\"a, \"\"b\"\".rx [m]\","), "{head}");
    let names = head.split("\"a, \"\"b\"\".").count() - 1 + head.matches("_error [").count();
    let numbers = rows.lines().next().unwrap().split(',').count();
    assert_eq!(names + "run mass time evaluations doubts stopped".split(' ').count(), numbers, "{head}");
}
