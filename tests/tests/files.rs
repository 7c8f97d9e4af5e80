//! What commands write, and where: nothing is replaced, mixed or left out without a word, and mechanisms of any size keep their digits.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use triad_engine::catalogue;
use triad_tests::program::run;

/// A call: its exit code, and what it printed to standard output and to the other stream.
fn said(line: &[&str]) -> (Option<i32>, String, String) {
    let done = run(line);
    let [out, err] = [&done.stdout, &done.stderr].map(|stream| String::from_utf8_lossy(stream).into_owned());
    (done.status.code(), out, err)
}

/// A path in a folder, as a word.
fn within(folder: &Path, name: &str) -> String {
    folder.join(name).to_string_lossy().into_owned()
}

/// A pendulum a millionth of the usual one in length and mass.
fn tiny() -> Value {
    json!({
        "name": "tiny", "gravity": [0, -9.81, 0],
        "bodies": [{ "name": "bob", "mass": 1e-9, "inertia": { "principal": [1e-19, 1e-19, 1e-19] }, "position": [1e-5, -2e-5, 0] }],
        "joints": [{ "name": "pin", "type": "revolute", "body_i": "ground", "body_j": "bob", "point": [0, 0, 0], "axis": [0, 0, 1] }],
        "simulation": { "duration": 0.002, "every": 0.001 }
    })
}

#[test]
fn no_file_is_replaced_and_no_stream_is_mixed() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| within(folder.path(), name);
    let scene = file("scene.json");
    let text = serde_json::to_string(&catalogue::scene("simple-pendulum").unwrap()).unwrap();
    fs::write(&scene, &text).unwrap();
    let around = format!("{}/sub/../a", folder.path().display());
    fs::create_dir(folder.path().join("sub")).unwrap();
    let urdf = file("robot.urdf");
    fs::write(&urdf, "<robot name=\"r\"><link name=\"a\"/></robot>").unwrap();
    let vary = "/bodies/0/mass=1:2:2";
    let twice = "would both write";
    let not_there = "[no-standard-output]";
    let cases: [(&[&str], &str); 19] = [
        (&["run", &scene, "--svg", &file("a"), "--html", &file("a")], twice),
        (&["run", &scene, "--out", &file("a"), "--rrd", &around], twice),
        (&["run", &scene, "--out", "-", "--svg", "-"], "--out and --svg would both write standard output"),
        (&["run", &scene, "--svg", &scene], "--svg would replace"),
        (&["run", &scene, "--out", "-", "--json"], "--out - and --json would both write to standard output"),
        (&["run", &scene, "--rrd", "-"], not_there),
        (&["sweep", &scene, "--vary", vary, "--out", &file("a"), "--svg", &file("a")], twice),
        (&["sweep", &scene, "--vary", vary, "--out", &scene], "--out would replace"),
        (&["sweep", &scene, "--vary", vary, "--svg", "-", "--json"], "same-file"),
        (&["import", &urdf, "--out", &urdf], "--out would replace"),
        (&["stress", "--quick", "--treatments", "--svg", &file("a"), "--markdown", &file("a")], twice),
        (&["paper", "--bodies", "1", "--svg", "-", "--json"], "same-file"),
        (&["bench", &scene, "--quick", "--out", "-"], not_there),
        (&["export", "docs", "-"], not_there),
        (&["export", "site", "-"], not_there),
        (&["export", "gradescope", "screw", "-o", "-"], not_there),
        (&["lesson", "new", "mine", "--into", "-"], not_there),
        (&["class", "export", "-"], not_there),
        (&["backup", "-"], not_there),
    ];
    for (line, words) in cases {
        let (code, out, err) = said(line);
        assert!(code == Some(3) && (out + &err).contains(words), "triad {}: {code:?}\n{err}", line.join(" "));
    }
    assert_eq!(fs::read_to_string(&scene).unwrap(), text, "the scene is as it was");
    assert!(!folder.path().join("a").exists() && !Path::new("-").exists());
    // What is no file is not replaced.
    let (code, ..) = said(&["run", &scene, "--until", "0.1", "--svg", "/dev/null", "--html", "/dev/null"]);
    assert_eq!(code, Some(0));
}

#[test]
fn a_text_goes_to_standard_output_and_what_is_told_elsewhere() {
    let pendulum = "simple-pendulum";
    let vary = "/bodies/0/mass=1:2:2";
    for (line, begin, end) in [
        (vec!["run", pendulum, "--until", "0.1", "--svg", "-"], "<svg", "</svg>"),
        (vec!["run", pendulum, "--until", "0.1", "--html", "-"], "<!doctype html>", "</html>"),
        (vec!["sweep", pendulum, "--vary", vary, "--until", "0.1", "--svg", "-"], "<svg", "</svg>"),
        (vec!["sweep", pendulum, "--vary", vary, "--until", "0.1", "--out", "-"], "run,", ""),
    ] {
        let (code, out, err) = said(&line);
        let whole = out.to_lowercase().starts_with(begin) && out.trim_end().ends_with(end);
        assert!(code == Some(0) && whole, "triad {}: {code:?}\n{out:.300}", line.join(" "));
        assert!(err.contains(pendulum) && !err.contains("written"), "{err}");
    }
}

/// Text under the ending of another kind was found out by the program that read it.
#[test]
fn the_ending_of_a_table_says_what_it_is_for_runs_and_sweeps() {
    let folder = tempfile::tempdir().unwrap();
    let vary = "/bodies/0/mass=-1:2:3";
    let run: &[&str] = &["run", "simple-pendulum", "--until", "0.1"];
    let sweep: &[&str] = &["sweep", "simple-pendulum", "--vary", vary, "--until", "0.1"];
    let arrow = b"ARROW1\0\0";
    for (command, done) in [(run, 0), (sweep, 1)] {
        for ending in ["csv", "CSV", "arrow", "feather", "Feather", ""] {
            let file = within(folder.path(), &format!("{}.{ending}", command[0]));
            let file = file.trim_end_matches('.');
            let (code, _, err) = said(&[command, &["--out", file]].concat());
            assert_eq!(code, Some(done), "{file}: {err}");
            let written = fs::read(file).unwrap();
            let text = ["csv", ""].contains(&ending.to_lowercase().as_str());
            assert_eq!(std::str::from_utf8(&written).is_ok(), text, "{file}");
            assert!(text || written.starts_with(arrow) && written.ends_with(b"ARROW1"), "{file}");
        }
        for ending in ["json", "parquet", "xlsx", "txt"] {
            let file = within(folder.path(), &format!("new/a.{ending}"));
            let (code, _, err) = said(&[command, &["--out", &file]].concat());
            let refused = format!("tables are not written as .{ending} [unknown-table]");
            assert!(code == Some(3) && err.contains(&refused) && err.contains(".feather"), "{err}");
            assert!(!Path::new(&file).parent().unwrap().exists(), "nothing is begun");
        }
    }
}

#[test]
fn a_sweep_of_which_all_runs_fail_has_no_picture() {
    let folder = tempfile::tempdir().unwrap();
    let (picture, table) = (within(folder.path(), "a.svg"), within(folder.path(), "a.csv"));
    let vary = "/bodies/0/mass=-2:-1:2";
    let files = ["--svg", picture.as_str(), "--out", table.as_str()];
    let (code, out, err) = said(&[&["sweep", "simple-pendulum", "--vary", vary], &files[..]].concat());
    assert!(
        code == Some(1) && out.contains("no picture is written, as no run came to a number"),
        "{out}{err}"
    );
    assert!(out.contains("a.csv") && !out.contains("a.svg") && !Path::new(&picture).exists(), "{out}");
    assert!(!out.contains("more failed"), "{out}");
}

#[test]
fn errors_that_a_scene_chooses_and_does_not_estimate_are_not_left_out_without_a_word() {
    let folder = tempfile::tempdir().unwrap();
    let (path, table) = (within(folder.path(), "scene.json"), within(folder.path(), "a.csv"));
    let mut scene = serde_json::to_value(catalogue::scene("simple-pendulum").unwrap()).unwrap();
    scene["simulation"]["duration"] = json!(0.1);
    let write = |estimate: bool, outputs: Option<Value>| {
        let mut scene = scene.clone();
        scene["simulation"]["error_estimate"] = json!(estimate);
        if let Some(outputs) = outputs {
            scene["simulation"]["outputs"] = outputs;
        }
        fs::write(&path, scene.to_string()).unwrap();
    };
    let run = |more: &[&str]| said(&[&["run", path.as_str(), "--out", &table], more].concat());
    let sweep =
        |more: &[&str]| said(&[&["sweep", path.as_str(), "--vary", "/bodies/0/mass=1:2:2"], more].concat());
    write(false, Some(json!(["energy", "errors"])));
    for (code, _, err) in [run(&[]), sweep(&[])] {
        assert!(
            code == Some(3) && err.contains("[no-errors]") && err.contains("\"error_estimate\": false"),
            "{err}"
        );
    }
    assert!(!Path::new(&table).exists());
    assert_eq!(run(&["--outputs", "energy"]).0, Some(0));
    assert_eq!(said(&["run", &path]).0, Some(0), "no table, nothing lost");
    // The usual outputs are no choice.
    write(false, None);
    assert_eq!((run(&[]).0, sweep(&[]).0), (Some(0), Some(0)));
    write(true, Some(json!(["energy", "errors"])));
    assert_eq!((run(&[]).0, run(&["--no-estimate"]).0), (Some(0), Some(3)));
}

#[test]
fn mechanisms_of_micrometres_keep_their_digits() {
    let folder = tempfile::tempdir().unwrap();
    let path = within(folder.path(), "tiny.json");
    fs::write(&path, tiny().to_string()).unwrap();
    let line = |out: &str, words: &str| {
        let found = out.lines().find(|line| line.contains(words));
        found.unwrap_or_else(|| panic!("{words}: {out}")).to_owned()
    };
    let (_, out, _) = said(&["equilibrium", &path]);
    // m g, and nothing of rounding beside it.
    assert!(
        line(&out, "force ").split_whitespace().eq(["force", "0.000000", "9.810000e-9", "0.000000", "N"]),
        "{out}"
    );
    assert!(line(&out, "moment ").matches("0.000000").count() == 3, "{out}");
    assert!(line(&out, "centre of mass").contains("-2.236068e-5, 0.000000) m"), "{out}");
    let (_, out, _) = said(&["run", &path]);
    assert!(
        line(&out, "energy").contains("-1.962000000e-13 J") || line(&out, "energy").contains("-1.96200000"),
        "{out}"
    );
}

#[test]
fn kinematics_tells_velocities_and_first_what_the_numbers_are_worth() {
    let (_, out, _) = said(&["kinematics", "crank-rocker"]);
    let lines: Vec<&str> = out.lines().take(9).collect();
    assert!(lines[1].starts_with("  error: positions right to about "), "{out:.500}");
    assert!(lines[3].starts_with("  crank: centre of mass ("), "{out:.500}");
    // The motor turns at 5 rad/s, the centre of mass of the crank half a metre from it.
    assert!(
        lines[4].starts_with("    velocity (-0.")
            && lines[4].ends_with("angular velocity (0.000000, 0.000000, 5.000000) rad/s"),
        "{out:.500}"
    );
}

#[test]
fn two_strengths_of_one_treatment_have_two_names() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_string_lossy().into_owned();
    let strength = |x: u32| format!("{{\"kind\": \"baumgarte\", \"alpha\": {x}, \"beta\": {x}}}");
    let (code, text, err) = said(&[
        "bench",
        "--quick",
        "--scenes",
        "simple-pendulum",
        "--integrators",
        "dop853",
        "--tolerances",
        "1e-4",
        "--treatment",
        &strength(10),
        "--treatment",
        &strength(5),
        "--treatment",
        &strength(50),
        "--out",
        &out,
    ]);
    assert_eq!(code, Some(0), "{err}");
    let table = fs::read_to_string(folder.path().join("bench.csv")).unwrap();
    for name in ["baumgarte", "baumgarte alpha=5 beta=5", "baumgarte alpha=50 beta=50"] {
        assert!(text.lines().any(|line| line.contains(&format!("dop853 {name}  "))), "{name}: {text}");
        assert!(table.contains(&format!(",dop853,{name},")), "{name}: {table}");
    }
}

#[test]
fn errors_of_reactions_stand_beside_drivers_and_forces_that_are_shared_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let table = within(folder.path(), "a.csv");
    let head = |scene: &str, outputs: &str| {
        let (code, _, err) = said(&["run", scene, "--until", "0.1", "--outputs", outputs, "--out", &table]);
        assert_eq!(code, Some(0), "{err}");
        let text = fs::read_to_string(&table).unwrap();
        text.lines()
            .filter(|line| !line.starts_with(|c: char| c == '-' || c.is_ascii_digit()))
            .collect::<Vec<_>>()
            .join("\n")
    };
    let of_drivers = head("crank-rocker", "drivers,errors");
    assert!(of_drivers.contains("energy_error,force_error,moment_error"), "{of_drivers}");
    let of_loads = head("car-axis", "loads,errors");
    assert!(
        of_loads.contains("No errors are estimated of what loads do.") && !of_loads.contains("moment_error"),
        "{of_loads}"
    );
    let page = within(folder.path(), "a.html");
    let shared = "not all forces that it shows are unique";
    let (_, out, _) = said(&["run", "n-four-bar:1", "--until", "0.1", "--html", &page]);
    assert!(out.contains(shared), "{out}");
    let (_, out, _) = said(&["run", "spatial-slider-crank", "--until", "0.1", "--html", &page]);
    assert!(!out.contains(shared), "{out}");
    let picture = within(folder.path(), "a.svg");
    let sweep = |outputs: &str| {
        let line = [
            "sweep",
            "n-four-bar:1",
            "--vary",
            "/gravity/1=-9:-1:2",
            "--until",
            "0.1",
            "--outputs",
            outputs,
            "--svg",
            &picture,
        ];
        let (_, out, _) = said(&line);
        (
            out.contains("its reactions are not all unique"),
            fs::read_to_string(&picture).unwrap().contains("(may not be unique)"),
        )
    };
    assert_eq!(sweep("reactions"), (true, true));
    assert_eq!(sweep("energy"), (false, false));
}
