//! What this version and earlier ones wrote is read: the scenes and gradebooks in `tests/data/kept/`, one folder a version.
//! The JSON Schema of a scene is the one that was reviewed.
//!
//! `TRIAD_WRITE_GOLDEN=1 cargo test --release -p triad-tests --test compatibility` writes the schema and the folder of the
//! version at hand anew. Folders of earlier versions stay as they are: that is what they are for.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use serde_json::{Map, Value, json};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use triad_engine::Scene;
use triad_engine::analysis::check::check;
use triad_tests::program::{Server, run_json};
use triad_tests::root;

/// Relative difference of numbers that count as equal: what different C libraries leave of a sine.
const ROUNDING: f64 = 1e-9;

fn kept() -> PathBuf {
    root().join("tests/data/kept")
}

fn writing() -> bool {
    std::env::var_os("TRIAD_WRITE_GOLDEN").is_some()
}

fn json_of(path: &Path) -> Value {
    let text = fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    serde_json::from_str(&text).unwrap()
}

/// One member a line, so that a difference shows which.
fn write_members(path: &Path, members: &Map<String, Value>) {
    let lines: Vec<String> =
        members.iter().map(|(name, value)| format!("{}: {value}", json!(name))).collect();
    fs::write(path, format!("{{\n{}\n}}\n", lines.join(",\n"))).unwrap();
}

/// A gradebook of the format before the one of 0.1.0, which no released version wrote.
const FORMAT_1: &str = "gradebook-1";

/// The folders of all versions, that of the version at hand among them.
fn versions() -> Vec<PathBuf> {
    let folders = kept().read_dir().unwrap().map(|entry| entry.unwrap().path());
    let folders: Vec<PathBuf> = folders.filter(|path| path.is_dir() && !path.ends_with(FORMAT_1)).collect();
    let here = kept().join(env!("CARGO_PKG_VERSION"));
    assert!(folders.contains(&here), "{} is missing: see the head of this file", here.display());
    folders
}

/// Where `now` lacks something that `before` had, or has it otherwise. What is new is no difference.
fn lost(before: &Value, now: &Value, at: &str, found: &mut Vec<String>) {
    match (before, now) {
        (Value::Object(before), Value::Object(now)) => {
            for (key, value) in before {
                lost(value, now.get(key).unwrap_or(&Value::Null), &format!("{at}/{key}"), found);
            }
        }
        (Value::Array(before), Value::Array(now)) if before.len() == now.len() => {
            for (k, (before, now)) in before.iter().zip(now).enumerate() {
                lost(before, now, &format!("{at}/{k}"), found);
            }
        }
        (Value::Number(before), Value::Number(now)) => {
            let (before, now) = (before.as_f64().unwrap(), now.as_f64().unwrap());
            if (before - now).abs() > ROUNDING * before.abs().max(1.0) {
                found.push(format!("{at}: {now} instead of {before}"));
            }
        }
        (before, now) if before == now => {}
        (before, now) => found.push(format!("{at}: {now} instead of {before}")),
    }
}

fn none_lost(before: &Value, now: &Value, at: &str) {
    let mut found = Vec::new();
    lost(before, now, at, &mut found);
    assert!(found.is_empty(), "{} differences:\n{}", found.len(), found[..found.len().min(20)].join("\n"));
}

/// A scene as it is read, everything that was left away written out, and what it amounts to.
fn read(scene: &Value) -> Value {
    let scene = Scene::from_json(&scene.to_string()).unwrap();
    let mut checked =
        check(&scene).map_or_else(|error| json!({"code": error.code()}), |report| json!(report));
    // Sentences may be written better.
    checked.as_object_mut().unwrap().remove("notes");
    json!({ "scene": serde_json::from_str::<Value>(&scene.to_json()).unwrap(), "check": checked })
}

/// Scenes of all kinds as their authors write them: `tests/data/scenes`, lessons and built-in scenes among them.
fn keep_scenes(folder: &Path) {
    let mut scenes = Map::new();
    for entry in root().join("tests/data/scenes").read_dir().unwrap() {
        let path = entry.unwrap().path();
        scenes.insert(path.file_stem().unwrap().to_str().unwrap().to_owned(), json_of(&path));
    }
    // What no scene of the corpus needs.
    scenes.extend(json_of(&root().join("tests/data/every-word.json")).as_object().unwrap().clone());
    let read = scenes.iter().map(|(name, scene)| (name.clone(), read(scene))).collect();
    fs::create_dir_all(folder).unwrap();
    write_members(&folder.join("scenes.json"), &scenes);
    write_members(&folder.join("scenes-read.json"), &read);
}

#[test]
fn scenes_of_each_version_give_the_same_model() {
    if writing() {
        keep_scenes(&kept().join(env!("CARGO_PKG_VERSION")));
    }
    for folder in versions() {
        let (scenes, before) =
            (json_of(&folder.join("scenes.json")), json_of(&folder.join("scenes-read.json")));
        assert!(scenes.as_object().unwrap().len() > 50);
        for (name, scene) in scenes.as_object().unwrap() {
            none_lost(&before[name], &read(scene), &format!("{}/{name}", folder.display()));
        }
    }
}

/// Keys, and words to choose from, that a schema or a document has.
fn words(value: &Value, schema: bool, found: &mut BTreeSet<String>) {
    match value {
        Value::Object(members) => {
            for (key, value) in members {
                match (schema, key.as_str()) {
                    (true, "properties") => found.extend(value.as_object().unwrap().keys().cloned()),
                    (true, "const") => found.extend(value.as_str().map(str::to_owned)),
                    (true, "enum") => found.extend(
                        value.as_array().unwrap().iter().filter_map(Value::as_str).map(str::to_owned),
                    ),
                    (true, _) => {}
                    (false, key) => {
                        found.insert(key.to_owned());
                    }
                }
                words(value, schema, found);
            }
        }
        Value::Array(list) => list.iter().for_each(|value| words(value, schema, found)),
        Value::String(word) if !schema => {
            found.insert(word.clone());
        }
        _ => {}
    }
}

/// A feature that no kept scene uses could change its meaning unseen.
#[test]
fn the_kept_scenes_use_every_word_of_the_format() {
    let (mut known, mut used) = (BTreeSet::new(), BTreeSet::new());
    words(&triad_engine::scene::schema(), true, &mut known);
    let folder = kept().join(env!("CARGO_PKG_VERSION"));
    words(&json_of(&folder.join("scenes.json")), false, &mut used);
    assert!(known.len() > 100, "{known:?}");
    let missing: Vec<_> = known.difference(&used).collect();
    assert!(missing.is_empty(), "add a scene to tests/data/scenes or every-word.json that uses {missing:?}");
}

#[test]
fn the_schema_is_the_one_that_was_reviewed() {
    let path = root().join("docs/scene.schema.json");
    let now = serde_json::to_string_pretty(&triad_engine::scene::schema()).unwrap() + "\n";
    if writing() {
        fs::write(&path, &now).unwrap();
    }
    let reviewed = fs::read_to_string(&path).unwrap_or_default();
    assert!(
        reviewed == now,
        "docs/scene.schema.json differs: set TRIAD_WRITE_GOLDEN=1, test again, read the change"
    );
}

/// A class of two: a wrong answer and a right one, and a part of another lesson.
fn keep_grades(folder: &Path) {
    let home = tempfile::tempdir().unwrap();
    let server = Server::start(home.path());
    let hand_in = |lesson: &str, student: &str, answers: Value| {
        let body = json!({ "student": student, "answers": answers });
        assert_eq!(server.post(&format!("/api/v1/lessons/{lesson}/submissions"), &body).status, 201);
    };
    let tension = |value: &str| json!({"tension-bottom": {"value": value, "unit": "N"}, "sign-of-lambda": {"choice": "b"}});
    hand_in("simple-pendulum", "Ada Lovelace", tension("9.81"));
    hand_in("simple-pendulum", "Ada Lovelace", tension("29.43"));
    hand_in("screw", "Émilie du Châtelet", json!({}));
    let rows = server.get("/api/v1/submissions?limit=10").json();
    server.stop();
    fs::create_dir_all(folder).unwrap();
    fs::copy(home.path().join("grades.db"), folder.join("grades.db")).unwrap();
    fs::write(folder.join("grades.json"), serde_json::to_string_pretty(&rows).unwrap() + "\n").unwrap();
}

#[test]
fn gradebooks_of_each_version_open_with_all_their_rows() {
    if writing() {
        keep_grades(&kept().join(env!("CARGO_PKG_VERSION")));
    }
    for folder in versions().into_iter().chain([kept().join(FORMAT_1)]) {
        let before = json_of(&folder.join("grades.json"));
        assert!(before.as_array().is_some_and(|rows| rows.len() > 2), "{}", folder.display());
        let home = tempfile::tempdir().unwrap();
        fs::copy(folder.join("grades.db"), home.path().join("grades.db")).unwrap();
        let server = Server::start(home.path());
        none_lost(&before, &server.get("/api/v1/submissions?limit=10").json(), &folder.display().to_string());
        // It goes on from there.
        let body = json!({"student": "Ada Lovelace", "answers": {}});
        let reply = server.post("/api/v1/lessons/simple-pendulum/submissions", &body);
        assert_eq!(reply.status, 201, "{}", reply.text());
        let rows = server.get("/api/v1/submissions?student=Ada%20Lovelace").json();
        assert_eq!(rows.as_array().unwrap().len(), 3);
        server.stop();
        // Its records can be looked at, and what this version graded is rebuilt.
        let database = home.path().join("grades.db").display().to_string();
        let ask = |words: &[&str]| run_json(&[words, &["--database", &database]].concat());
        assert_eq!(ask(&["grades", "--check"]), (0, json!([])));
        let (code, rebuilt) = ask(&["regrade", "--check"]);
        assert_eq!((code, &rebuilt["changed"]), (0, &json!([])), "{rebuilt}");
        let (_, table) = ask(&["grades"]);
        let ada =
            table["students"].as_array().unwrap().iter().find(|row| row["name"] == "Ada Lovelace").unwrap();
        let reached = &ada["lessons"]["simple-pendulum"];
        assert_eq!((&reached["points"], &reached["attempts"]), (&json!(5.0), &json!(3)), "{table}");
        let csv = triad_tests::program::run(&["grades", "--csv", "--for", "moodle", "--database", &database]);
        assert!(String::from_utf8(csv.stdout).unwrap().contains("\"Ada Lovelace\",\"\","));
    }
}
