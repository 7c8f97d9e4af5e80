//! Every command with every option over every built-in scene, every lesson's scene, every scene of `tests/data` and every
//! problem there: each call is answered, or refused with a reason and a remedy; nothing panics, prints what is no number,
//! or replaces what was asked for.
//!
//! The options are those that the program's own help lists: a new one without a case here fails.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use triad_engine::catalogue;
use triad_engine::scene::{ConstraintMethod, Coordinates, IntegratorKind, OutputKind, Scene};
use triad_tests::options::{commands, faults, options};
use triad_tests::program::run;
use triad_tests::root;

/// Time that runs of one call cover, s: some steps of each integrator.
const UNTIL: &str = "0.01";
/// Steps after which a call ends, answered with `step-limit`.
const MOST_STEPS: &str = "40";

/// Options that have their cases in other tests, or open a port: the command, and where.
const ELSEWHERE: [(&str, &str); 30] = [
    ("config", "operating.rs"),
    ("serve", "workbench.rs, lecture.rs and browser.rs run the server"),
    ("lesson preview", "it serves a page"),
    ("lesson list", "commands.rs"),
    ("lesson graph", "lessons/src/tests"),
    ("lesson check", "the course is proved by lessons/src/tests"),
    ("lesson new", "lessons/src/tests"),
    ("lesson starter", "lessons/src/tests"),
    ("grade", "workbench.rs and bad_input.rs"),
    ("export gradescope", "autograders.rs"),
    ("export prairielearn", "autograders.rs"),
    ("grades", "compatibility.rs; it takes no scene"),
    ("regrade", "compatibility.rs; it takes no scene"),
    ("backup", "gradebook.rs; it takes no scene"),
    ("restore", "gradebook.rs; it takes no scene"),
    ("class export", "gradebook.rs; it takes no scene"),
    ("class import", "gradebook.rs; it takes no scene"),
    ("class copy", "gradebook.rs; it takes no scene"),
    ("class erase", "gradebook.rs; it takes no scene"),
    ("grader", "chaos.rs; it takes no scene"),
    ("lti tool", "server/tests/http/lti; it takes no scene"),
    ("lti add", "server/tests/http/lti; it takes no scene"),
    ("lti list", "server/tests/http/lti; it takes no scene"),
    ("lti remove", "server/tests/http/lti; it takes no scene"),
    ("lti link", "server/tests/http/lti; it takes no scene"),
    ("lti unlink", "server/tests/http/lti; it takes no scene"),
    ("lti renew-key", "server/tests/http/lti; it takes no scene"),
    ("export site", "browser.rs opens what it writes; it takes no scene"),
    ("paper", "engine/lab/tests/paper.rs"),
    ("stress", "engine/lab/tests/stress.rs"),
];

/// Options of every command: this test gives the first to all, the other is for courses.
const GLOBAL: [&str; 2] = ["--json", "--course"];

/// The calls for one scene, without its name: the command, then the options.
fn calls(scene: &Scene, folder: &Path, index: usize) -> Vec<Vec<String>> {
    let file = |ending: &str| folder.join(format!("{index}.{ending}")).to_string_lossy().into_owned();
    let (table, recording, film, page) = (file("csv"), file("rrd"), file("svg"), file("html"));
    let body = scene.bodies.first().map_or("none", |body| body.name.as_str());
    let mut calls: Vec<Vec<String>> = Vec::new();
    let mut add = |command: &str, options: &[&str]| {
        calls.push([command].iter().chain(options).map(|&word| word.to_owned()).collect());
    };
    for command in ["check", "equilibrium", "kinematics", "modes"] {
        add(command, &[]);
    }
    for coordinates in [Coordinates::Reduced, Coordinates::Shared] {
        let coordinates = coordinates.to_string();
        for command in ["check", "equilibrium", "assemble", "kinematics"] {
            add(command, &["--coordinates", &coordinates]);
        }
        add("modes", &["--coordinates", &coordinates]);
        add("reactions", &["--coordinates", &coordinates, "--at", UNTIL]);
        for integrator in ["taylor", "dop853"] {
            add("run", &["--coordinates", &coordinates, "--integrator", integrator]);
        }
    }
    add("run", &["--no-estimate"]);
    add("modes", &["--at-start"]);
    add("modes", &["--steady"]);
    add("assemble", &["--keep", body]);
    for (on, about, frame) in [("i", "center-of-mass", "joint"), ("i", "origin", "body")] {
        for command in ["reactions", "kinematics"] {
            add(command, &["--on", on, "--about", about, "--in", frame]);
        }
    }
    for integrator in IntegratorKind::ALL {
        add("run", &["--integrator", &integrator.to_string()]);
    }
    for treatment in ConstraintMethod::ALL {
        add("run", &["--treatment", &treatment.to_string()]);
        add("run", &["--treatment", &treatment.to_string(), "--integrator", "radau"]);
    }
    for tolerance in ["1e-3", "1e-12"] {
        add("run", &["--tolerance", tolerance, "--verify", "--explain"]);
    }
    add("run", &["--step", "1e-3", "--no-skip", "all", "--most-seconds", "10"]);
    add("run", &["--every", "0.004", "--out", &table, "--rrd", &recording, "--svg", &film, "--html", &page]);
    let words: Vec<String> = OutputKind::ALL.map(|kind| kind.to_string()).to_vec();
    add("run", &["--outputs", &words.join(","), "--out", &file("all.csv")]);
    calls
}

/// Every scene that there is, by the name or file that the program takes.
fn scenes() -> Vec<(String, Scene)> {
    let mut names: Vec<String> =
        catalogue::ENTRIES.iter().map(|entry| entry.name.replace(":N", ":2")).collect();
    let below = |folder: &str, list: &mut Vec<String>| {
        let mut files = Vec::new();
        json_files(&root().join(folder), &mut files);
        files.sort();
        list.extend(files);
    };
    for folder in ["tests/data/scenes", "tests/data/problems", "lessons/course"] {
        below(folder, &mut names);
    }
    let read = |name: String| {
        let scene = match fs::read_to_string(&name) {
            Ok(text) => Scene::from_json(&text).ok()?,
            Err(_) => catalogue::scene(&name).unwrap(),
        };
        Some((name, scene))
    };
    names.into_iter().filter_map(read).collect()
}

fn json_files(folder: &Path, files: &mut Vec<String>) {
    for entry in folder.read_dir().unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            json_files(&path, files);
        } else if path.extension().is_some_and(|ending| ending == "json")
            && (!folder.starts_with(root().join("lessons"))
                || path.ends_with("scene.json")
                || folder.ends_with("scenes"))
        {
            files.push(path.to_string_lossy().into_owned());
        }
    }
}

/// All calls, as the program takes them.
fn all_calls(folder: &Path) -> Vec<Vec<String>> {
    let mut all = Vec::new();
    for (index, (name, scene)) in scenes().into_iter().enumerate() {
        for mut call in calls(&scene, folder, index) {
            call.insert(1, name.clone());
            if call[0] == "run" {
                call.extend(["--until", UNTIL, "--most-steps", MOST_STEPS].map(str::to_owned));
            }
            call.push("--json".to_owned());
            all.push(call);
        }
    }
    all
}

#[test]
fn every_option_of_the_help_has_a_case() {
    let folder = tempfile::tempdir().unwrap();
    let mut met: BTreeSet<(String, String)> = BTreeSet::new();
    let others = others(folder.path());
    for call in all_calls(folder.path()).iter().chain(&others) {
        met.extend(
            call.iter().filter(|word| word.starts_with("--")).map(|word| (call[0].clone(), word.clone())),
        );
    }
    let mut missing = Vec::new();
    for command in
        commands().into_iter().filter(|command| ELSEWHERE.iter().all(|(other, _)| other != command))
    {
        let listed = options(&command);
        assert!(listed.contains(&"--json".to_owned()), "{command}: {listed:?}");
        let without = listed.into_iter().filter(|option| !GLOBAL.contains(&option.as_str()));
        missing.extend(
            without
                .filter(|option| !met.contains(&(command.clone(), option.clone())))
                .map(|o| format!("{command} {o}")),
        );
    }
    assert!(missing.is_empty(), "no case for: {}", missing.join(", "));
}

/// Calls that are not about one scene each.
#[allow(clippy::too_many_lines, reason = "a list")]
fn others(folder: &Path) -> Vec<Vec<String>> {
    let file = |name: &str| folder.join(name).to_string_lossy().into_owned();
    let data = |name: &str| root().join("tests/data").join(name).to_string_lossy().into_owned();
    let lines: [&[&str]; 13] = [
        &["run", "simple-pendulum", "--until", UNTIL, "--rerun", "rerun+http://127.0.0.1:1/proxy"],
        &[
            "sweep",
            "simple-pendulum",
            "--vary",
            "/bodies/0/mass=1:2:3",
            "--vary",
            "/gravity/1=normal:-9:0.1",
            "--samples",
            "2",
            "--seed",
            "3",
            "--threads",
            "2",
            "--until",
            UNTIL,
            "--tolerance",
            "1e-6",
            "--integrator",
            "taylor",
            "--no-estimate",
            "--outputs",
            "joints,energy",
            "--out",
            &file("sweep.csv"),
            "--svg",
            &file("sweep.svg"),
            "--draw",
            "energy",
        ],
        &["sweep", "simple-pendulum", "--vary", "mass=1:2"],
        &["sweep", "simple-pendulum", "--vary", "/bodies/7/mass=1:2:2"],
        &["scenes", "free-fall"],
        &["scenes", "--list"],
        &["scenes", "--guide"],
        &["scenes", "free-fell"],
        &["schema", "scene"],
        &["export", "docs", &file("docs")],
        &["import", &data("arm.urdf"), "--out", &file("arm.json")],
        &["import", &data("problems/mimic/mimic.urdf"), "--with", &data("problems/mimic/side.json")],
        &[
            "bench",
            "--quick",
            "--scenes",
            "pendulum",
            "--integrators",
            "taylor",
            "--coordinates",
            "full",
            "--tolerances",
            "1e-4",
            "--treatment",
            "projection",
            "--out",
            &file("bench"),
        ],
    ];
    let call =
        |line: &&[&str]| line.iter().map(|&word| word.to_owned()).chain(["--json".to_owned()]).collect();
    lines.iter().map(call).collect()
}

#[test]
fn every_call_is_answered_or_refused_with_a_reason_and_a_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let mut all = all_calls(folder.path());
    all.extend(others(folder.path()));
    let next = AtomicUsize::new(0);
    let found = Mutex::new(Vec::new());
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(call) = all.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let faults = faults(call);
                    let line = call.join(" ").replace(&root().to_string_lossy().into_owned(), "");
                    found
                        .lock()
                        .unwrap()
                        .extend(faults.into_iter().map(|fault| format!("triad {line}\n    {fault}")));
                }
            });
        }
    });
    for entry in folder.path().read_dir().unwrap().map(|entry| entry.unwrap().path()) {
        if entry.extension().is_some_and(|ending| ending == "csv") {
            let text = fs::read_to_string(&entry).unwrap();
            let none = text.split([',', '\n']).any(|field| ["NaN", "inf", "-inf"].contains(&field));
            assert!(!none, "{}: a field that is no number", entry.display());
        }
    }
    let mut found = found.into_inner().unwrap();
    found.sort();
    assert!(found.is_empty(), "{} of {} calls:\n{}", found.len(), all.len(), found.join("\n"));
}

/// What a call said to people, with its exit code.
fn said(line: &[&str]) -> (Option<i32>, String) {
    let done = run(line);
    let text =
        [&done.stdout, &done.stderr].map(|stream| String::from_utf8_lossy(stream).into_owned()).concat();
    (done.status.code(), text)
}

#[test]
#[allow(clippy::too_many_lines, reason = "a list")]
fn what_is_asked_for_is_done_refused_or_told_to_change_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let mut stiff: Value = serde_json::to_value(catalogue::scene("simple-pendulum").unwrap()).unwrap();
    stiff["simulation"]["stabilization"] = json!({"kind": "baumgarte", "alpha": 5, "beta": 5});
    fs::write(file("baumgarte.json"), stiff.to_string()).unwrap();
    let robot = fs::read_to_string(root().join("tests/data/problems/mimic/mimic.urdf")).unwrap();
    fs::write(file("robot.urdf"), robot.replace("joint=\"lead\"", "joint=\"led\"")).unwrap();
    fs::write(file("side.json"), r#"{"positons": {"lead": 1}}"#).unwrap();
    fs::write(file("double.json"), r#"{"velocities": {"lead": 1, "lead": 2}}"#).unwrap();
    let mut driven: Value = serde_json::to_value(catalogue::scene("crank-rocker").unwrap()).unwrap();
    driven["drivers"][0]["motion"] = json!({"kind": "ramp", "start": 2.5, "rate": 5});
    fs::write(file("driven.json"), driven.to_string()).unwrap();
    let pendulum = "simple-pendulum";
    let vary = "/bodies/0/mass=1:2:2";
    let cases: [(&[&str], i32, &str); 26] = [
        (&["reactions", pendulum, "--at", "11"], 3, "which goes from 0 s to 10 s"),
        (&["reactions", pendulum, "--at", "11"], 3, "it ends after the \"duration\""),
        (&["run", pendulum, "--until", "1e-300"], 0, "simple-pendulum: 1e-300 s of 1e-300 s\n"),
        (&["run", pendulum, "--integrator", "foo"], 2, "rattle, and trapezoidal with the treatment"),
        (&["bench", pendulum, "--integrators", "foo"], 2, "rattle, and trapezoidal with the treatment"),
        (&["reactions", pendulum, "--at", "nan"], 3, "which goes from 0 s to 10 s"),
        (&["reactions", pendulum, "--at", "-1"], 3, "which goes from 0 s to 10 s"),
        (&["run", pendulum, "--until", "-1"], 3, "-1 is not between"),
        (&["run", pendulum, "--until", "0.1", "--outputs", "joints"], 0, "without --out it changes nothing"),
        (&["run", pendulum, "--until", "0.1", "--every", "0.1"], 0, "where nothing is written"),
        (
            &["run", pendulum, "--no-estimate", "--outputs", "errors", "--out", &file("a.csv")],
            3,
            "[no-errors]",
        ),
        (&["sweep", pendulum, "--vary", vary, "--no-estimate", "--outputs", "errors"], 3, "[no-errors]"),
        (&["sweep", pendulum, "--vary", vary, "--threads", "100000"], 3, "[threads]"),
        (&["sweep", pendulum, "--vary", vary, "--samples", "5"], 3, "none of the numbers is drawn"),
        (&["sweep", pendulum, "--vary", vary, "--vary", "mass=1:3:2"], 3, "is varied twice"),
        (&["sweep", pendulum, "--vary", "/simulation/duration=1:3:3", "--until", "2"], 3, "--until sets"),
        (
            &["sweep", &file("baumgarte.json"), "--vary", vary, "--integrator", "taylor"],
            3,
            "[choices-conflict]",
        ),
        (&["bench", pendulum, "--tolerances", "0", "--out", &file("b")], 2, "not between 1e-14 and 0.1"),
        (
            &["bench", pendulum, "--integrators", "taylor", "--treatment", "penalty", "--out", &file("b")],
            3,
            "it would run by dop853",
        ),
        (
            &["bench", pendulum, "--integrators", "trapezoidal", "--out", &file("b")],
            3,
            "augmented Lagrangian alone",
        ),
        (&["import", &file("robot.urdf")], 0, "<mimic> of led: there is no such joint"),
        (&["import", &file("robot.urdf"), "--with", &file("side.json")], 3, "the side-car could not be read"),
        (&["import", &file("robot.urdf"), "--with", &file("double.json")], 3, "duplicate field `lead`"),
        (&["check", &file("driven.json")], 3, "driver \"motor\" is open at the start"),
        (&["check", &file("driven.json")], 3, "Let the driver begin where"),
        (&["modes", "governor", "--steady"], 0, "where the bodies stand in it"),
    ];
    let wrong: Vec<String> = cases
        .iter()
        .map(|(line, code, words)| (line, code, words, said(line)))
        .filter(|(_, code, words, (found, text))| *found != Some(**code) || !text.contains(**words))
        .map(|(line, .., (found, text))| format!("triad {}: {found:?}\n{text}", line.join(" ")))
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn numbers_of_options_are_refused_as_what_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("a.csv").to_string_lossy().into_owned();
    for (option, number, code, words) in [
        ("--every", "0", 3, "/simulation/every: 0 is not between"),
        ("--most-seconds", "-1", 2, "it must be above 0"),
        ("--step", "100", 1, "Take shorter steps than those of 100 s"),
    ] {
        let (found, text) = said(&["run", "simple-pendulum", option, number, "--out", &table]);
        assert!(found == Some(code) && text.contains(words), "{option} {number}: {found:?}\n{text}");
    }
}

#[test]
fn slow_decays_are_printed_with_their_digits_and_shapes_with_their_scale() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("slow.json").to_string_lossy().into_owned();
    let sliding = r#"{"name": "slow", "gravity": [0, 0, 0], "bodies": [{"name": "a", "mass": 1}], "joints": [{"name": "p",
        "type": "prismatic", "body_i": "ground", "body_j": "a", "point": [0, 0, 0], "axis": [1, 0, 0]}], "loads": [{"name": "s",
        "type": "slider", "joint": "p", "stiffness": 2, "damping": 4e9}]}"#;
    fs::write(&path, sliding).unwrap();
    let (code, text) = said(&["modes", &path]);
    assert!(code == Some(0) && text.contains("growth -5.000000e-10 1/s"), "{text}");
    assert!(text.contains("shapes: the largest component"), "{text}");
}
