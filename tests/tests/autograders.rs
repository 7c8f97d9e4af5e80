//! Lessons packed for Gradescope and PrairieLearn: graded in a root that holds nothing else, without network, with the verdicts
//! of the server.
//!
//! The program in the pack needs the target x86_64-unknown-linux-musl; where it is missing these tests say so and hold what is
//! refused without it. `TRIAD_GRADE` names a program that was built elsewhere.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

use serde_json::{Value, json};
use tempfile::TempDir;
use triad_tests::program::{Server, assert_problem, run, run_json, triad};
use triad_tests::root;

const TARGET: &str = "x86_64-unknown-linux-musl";

/// The program that is packed, if it can be had here.
fn grader() -> Option<&'static Path> {
    static GRADER: OnceLock<Option<PathBuf>> = OnceLock::new();
    GRADER.get_or_init(find_grader).as_deref()
}

fn find_grader() -> Option<PathBuf> {
    if let Some(program) = std::env::var_os("TRIAD_GRADE") {
        return Some(program.into());
    }
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let asked = Command::new(rustc)
        .args(["--print", "target-libdir", "--target", TARGET])
        .current_dir(root())
        .output();
    let libraries = asked.map(|output| PathBuf::from(String::from_utf8_lossy(&output.stdout).trim()));
    if !libraries.is_ok_and(|folder| folder.is_dir()) {
        eprintln!("no autograder is run: the target {TARGET} is missing (rustup target add {TARGET})");
        return None;
    }
    let target = triad().ancestors().nth(2).unwrap();
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["build", "--profile", "tried", "--target", TARGET, "-p", "triad-grade", "--target-dir"]);
    cargo.arg(target);
    let output = cargo.current_dir(root()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(target.join(TARGET).join("tried/triad-grade"))
}

/// Runs a program of a root that holds nothing but what was put there, as root of that machine and without network; where
/// namespaces are not allowed, says so and runs it in place.
fn in_bare_root(machine: &Path, system: &str, program: &str, option: &[&str]) -> Output {
    let is_root = Command::new("id").arg("-u").output().is_ok_and(|id| id.stdout == b"0\n");
    let mut unshare = Command::new("unshare");
    if !is_root {
        unshare.arg("--map-root-user");
    }
    unshare.args(["--net", "--mount", "--pid", "--fork", "--root"]).arg(machine).env_clear();
    let output = unshare.arg(program).arg(system).args(option).output();
    match output {
        Ok(output) if !String::from_utf8_lossy(&output.stderr).starts_with("unshare:") => output,
        why => {
            eprintln!("not in a root of its own: {why:?}");
            let below = machine.join(if system == "gradescope" { "autograder" } else { "grade" });
            let program = machine.join(program.trim_start_matches('/'));
            Command::new(program).arg(system).args(option).arg("--root").arg(below).output().unwrap()
        }
    }
}

/// Unpacks an archive; the names of its files with their rights.
fn unpack(file: &Path, into: &Path) -> Vec<(String, u32)> {
    let mut archive = zip::ZipArchive::new(fs::File::open(file).unwrap()).unwrap();
    let mut names = Vec::new();
    for index in 0..archive.len() {
        let entry = archive.by_index(index).unwrap();
        names.push((entry.name().to_owned(), entry.unix_mode().unwrap() & 0o777));
    }
    archive.extract(into).unwrap();
    names
}

/// A lesson and what is handed in: numbers and choices, a program's table, a diagram that is missing, nothing at all.
fn handed_in() -> Vec<(&'static str, Value)> {
    let number = |value: &str, unit: &str| json!({"value": value, "unit": unit});
    vec![
        (
            "simple-pendulum",
            json!({"student": "ada", "answers": {"tension-bottom": number("29.43", "N"), "independent-rows": {"value": "11"}}}),
        ),
        ("simple-pendulum", json!({"student": "ben", "answers": {"tension-bottom": number("abc", "N")}})),
        (
            "spherical-joint",
            json!({"student": "Zoë B", "answers": {"pull": number("39.24", "N"), "moment": {"choice": "b"}}}),
        ),
        ("rigid-body-rows", json!({"student": "emmy", "answers": {"whose-force": {"choice": "a"}}})),
        ("screw", json!({"answers": {}})),
    ]
}

/// The server's verdict, without what it keeps beside it and what earlier submissions decide.
fn of_server(server: &Server, slug: &str, submission: &Value) -> Value {
    let mut submission = submission.clone();
    if submission["student"].is_null() {
        submission["student"] = json!("nobody");
        submission["seed"] = json!("");
    }
    let reply = server.post(&format!("/api/v1/lessons/{slug}/submissions"), &submission);
    assert!(matches!(reply.status, 200 | 201), "{slug}: {}", reply.text());
    let mut verdict = reply.json();
    for kept in ["id", "submitted_at"] {
        verdict.as_object_mut().unwrap().remove(kept).unwrap();
    }
    for question in verdict["questions"].as_array_mut().unwrap() {
        question.as_object_mut().unwrap().remove("standing");
        question.as_object_mut().unwrap().remove("reference_html");
    }
    if verdict["student"] == "nobody" {
        verdict.as_object_mut().unwrap().remove("student");
    }
    verdict
}

#[test]
fn gradescope_gets_the_verdicts_of_the_server_without_anything_of_the_machine() {
    let Some(grader) = grader() else { return };
    let folder = TempDir::new().unwrap();
    let server = Server::start(folder.path());
    for (index, (slug, submission)) in handed_in().into_iter().enumerate() {
        let place = folder.path().join(index.to_string());
        let pack = place.join("pack.zip");
        let options = [
            "export",
            "gradescope",
            slug,
            "--program",
            grader.to_str().unwrap(),
            "-o",
            pack.to_str().unwrap(),
        ];
        let (code, told) = run_json(&options);
        assert_eq!((code, &told["lesson"]), (0, &json!(slug)), "{told:#}");
        let source = place.join("autograder/source");
        let names = unpack(&pack, &source);
        for program in ["setup.sh", "run_autograder", "triad-grade"] {
            assert!(names.contains(&(program.to_owned(), 0o755)), "{names:?}");
        }
        let script = fs::read_to_string(source.join("run_autograder")).unwrap();
        assert_eq!(script, "#!/bin/sh\nexec /autograder/source/triad-grade gradescope\n");
        let text = submission.to_string();
        fs::create_dir(place.join("autograder/submission")).unwrap();
        fs::write(place.join("autograder/submission/answers.json"), &text).unwrap();
        let output = in_bare_root(&place, "gradescope", "/autograder/source/triad-grade", &[]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let result: Value =
            serde_json::from_slice(&fs::read(place.join("autograder/results/results.json")).unwrap())
                .unwrap();
        let by_server = of_server(&server, slug, &submission);
        let verdict = &result["extra_data"]["triad"]["verdict"];
        if by_server["gradable"] == true {
            assert_eq!(verdict.to_string(), by_server.to_string(), "{slug}");
        } else {
            assert!(verdict.is_null() && result["output"].as_str().unwrap().contains("no attempt is used"));
        }
        // And byte for byte what the command line prints.
        let file = place.join("autograder/submission/answers.json");
        let printed = run(&["grade", slug, file.to_str().unwrap(), "--json"]);
        let lesson = source.join("lesson.json");
        let own = Command::new(grader).arg("verdict").args([&lesson, &file]).output().unwrap();
        assert_eq!(String::from_utf8_lossy(&own.stdout), String::from_utf8_lossy(&printed.stdout));
    }
    server.stop();
}

#[test]
fn the_program_needs_no_library_and_packs_are_the_same_bytes() {
    let Some(grader) = grader() else { return };
    let bytes = fs::read(grader).unwrap();
    assert!(!bytes.windows(6).any(|part| part == b"GLIBC_"), "it needs a C library");
    let folder = TempDir::new().unwrap();
    let pack = |name: &str| {
        let file = folder.path().join(name);
        let out = run(&[
            "export",
            "gradescope",
            "screw",
            "--numbers-of-email",
            "--program",
            grader.to_str().unwrap(),
            "-o",
            file.to_str().unwrap(),
        ]);
        assert!(out.status.success(), "{}", String::from_utf8_lossy(&out.stderr));
        fs::read(file).unwrap()
    };
    assert_eq!(pack("one.zip"), pack("two.zip"));
    let mut archive = zip::ZipArchive::new(fs::File::open(folder.path().join("one.zip")).unwrap()).unwrap();
    let mut script = String::new();
    archive.by_name("run_autograder").unwrap().read_to_string(&mut script).unwrap();
    assert!(script.ends_with("gradescope --numbers-of-email\n"));
}

#[test]
fn prairielearn_shows_a_variant_and_grades_it() {
    let Some(grader) = grader() else { return };
    let folder = TempDir::new().unwrap();
    let question = folder.path().join("question");
    let (code, told) = run_json(&[
        "export",
        "prairielearn",
        "simple-pendulum",
        "--variants",
        "3",
        "--program",
        grader.to_str().unwrap(),
        "-o",
        question.to_str().unwrap(),
    ]);
    assert_eq!(code, 0, "{told:#}");
    let info: Value = serde_json::from_slice(&fs::read(question.join("info.json")).unwrap()).unwrap();
    assert_eq!(
        (&info["type"], &info["gradingMethod"], &info["singleVariant"]),
        (&json!("v3"), &json!("External"), &json!(false))
    );
    assert_eq!(info["uuid"].as_str().unwrap().len(), 36);
    let external = &info["externalGradingOptions"];
    assert_eq!(
        (&external["enabled"], &external["entrypoint"]),
        (&json!(true), &json!("/grade/tests/triad-grade prairielearn"))
    );
    // What PrairieLearn does with server.py.
    let python = "import json, server; data = {'options': {'question_path': '.'}, 'variant_seed': 34, 'params': {}, \
                  'filename': 'answers.json'}; server.generate(data); data['blank'] = server.file(data); print(json.dumps(data))";
    let shown = Command::new("python3").args(["-c", python]).current_dir(&question).output().unwrap();
    let mut data: Value = serde_json::from_slice(&shown.stdout).unwrap_or_else(|_| panic!("{shown:?}"));
    // 34 is 112 in the digits of a seed: the second of three.
    assert_eq!(data["params"]["triad_seed"], "variant 2");
    let page = data["params"]["questions"].as_str().unwrap();
    assert!(page.contains("<code>tension-bottom</code>") && !page.contains("math inline"), "{page}");
    // The blank file, handed in: nothing is right, all of it is graded, in a machine that holds nothing but the grader.
    let machine = folder.path().join("machine");
    for below in ["data", "student", "tests"] {
        fs::create_dir_all(machine.join("grade").join(below)).unwrap();
    }
    for file in ["triad-grade", "lesson.json"] {
        fs::copy(question.join("tests").join(file), machine.join("grade/tests").join(file)).unwrap();
    }
    let blank = data["blank"].take();
    fs::write(machine.join("grade/data/data.json"), data.to_string()).unwrap();
    fs::write(machine.join("grade/student/answers.json"), blank.as_str().unwrap()).unwrap();
    let output = in_bare_root(&machine, "prairielearn", "/grade/tests/triad-grade", &[]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let result: Value =
        serde_json::from_slice(&fs::read(machine.join("grade/results/results.json")).unwrap()).unwrap();
    assert_eq!((&result["gradable"], &result["score"]), (&json!(true), &json!(0.0)));
    assert_eq!(result["triad"]["verdict"]["provenance"]["seed"], "variant 2");
}

#[test]
fn what_cannot_be_packed_is_refused_with_a_remedy() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("pack.zip");
    let out = out.to_str().unwrap();
    let refused = |more: &[&str], code: &str| {
        let words = [&["export", "gradescope"], more, &["-o", out]].concat();
        let (exit, problem) = run_json(&words);
        assert_ne!(exit, 0);
        assert_problem(&problem, code, "");
        assert!(!Path::new(out).exists());
    };
    refused(&["screw", "--program", triad().to_str().unwrap()], "not-portable");
    refused(&["screw", "--program", "/nowhere"], "no-such-file");
    refused(&["no-such-lesson"], "unknown-lesson");
    fs::write(out, "mine").unwrap();
    let (_, problem) = run_json(&["export", "gradescope", "screw", "-o", out]);
    assert_problem(&problem, "file-exists", "");
    assert_eq!(fs::read_to_string(out).unwrap(), "mine");
}
