//! Lesson 2 in a real browser: open, step, play, see the viewer draw, answer wrongly, then rightly, and find the
//! result after a restart of the server; then the workbench by keyboard, in a lecture and in trouble. What it saw is
//! kept in `tests/output/`.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use std::path::Path;
use std::process::Command;
use std::sync::Mutex;
use triad_tests::program::Server;
use triad_tests::root;

const CHROMIUM: &str = "/usr/bin/chromium";

/// Runs a command; its output is shown if it fails.
fn must(what: &str, command: &mut Command) -> String {
    let output = command.output().unwrap_or_else(|error| panic!("{what}: {error} ({command:?})"));
    let said = [output.stdout, output.stderr].concat();
    let said = String::from_utf8_lossy(&said).into_owned();
    assert!(output.status.success(), "{what}: {command:?} failed:\n{said}");
    said
}

/// Installs what is missing: Debian's Chromium (as root), and the driver from `tests/browser/package-lock.json`.
fn prepare(folder: &Path) {
    // Two tests at once must not install twice.
    static TURN: Mutex<()> = Mutex::new(());
    let _turn = TURN.lock().unwrap();
    if !Path::new(CHROMIUM).exists() {
        let user = must("who runs this", Command::new("id").arg("-u"));
        assert_eq!(
            user.trim(),
            "0",
            "the browser test needs {CHROMIUM}: install it (apt-get install chromium), or run the test as root"
        );
        println!("installing chromium");
        must("package lists", Command::new("apt-get").args(["update", "-qq"]));
        let mut install = Command::new("apt-get");
        install.env("DEBIAN_FRONTEND", "noninteractive");
        must("chromium", install.args(["install", "-y", "-qq", "--no-install-recommends", "chromium"]));
    }
    let lock = std::fs::metadata(folder.join("package-lock.json")).unwrap().modified().unwrap();
    let installed =
        std::fs::metadata(folder.join("node_modules/.package-lock.json")).and_then(|m| m.modified());
    if installed.is_ok_and(|installed| installed >= lock) {
        return;
    }
    must("browser driver", Command::new("npm").args(["ci", "--no-audit", "--no-fund"]).current_dir(folder));
}

#[test]
fn lesson_two_from_the_first_look_to_the_grade_and_after_a_restart() {
    let folder = root().join("tests/browser");
    prepare(&folder);
    let home = tempfile::tempdir().unwrap();
    let profile = home.path().join("profile");
    let pictures = root().join("tests/output");
    let visit = |which: &str, server: &Server| {
        let said = must(
            "the browser",
            Command::new("node")
                .args(["lesson.mjs", which, &format!("http://{}", server.address)])
                .args([&profile, &pictures])
                .current_dir(&folder),
        );
        println!("{said}");
    };
    let server = Server::start(home.path());
    visit("first", &server);
    // The same address, so that the browser knows its student again.
    let port = server.address.rsplit(':').next().unwrap().to_owned();
    server.stop();
    let server = Server::start_at(home.path(), &port);
    visit("later", &server);
}

#[test]
fn the_workbench_by_keyboard_alone_looking_back_in_a_lecture_in_the_editor_and_in_trouble() {
    let folder = root().join("tests/browser");
    prepare(&folder);
    let home = tempfile::tempdir().unwrap();
    let server = Server::start(home.path());
    let said = must(
        "the browser",
        Command::new("node")
            .args(["workbench.mjs", &format!("http://{}", server.address)])
            .arg(root().join("tests/output"))
            .current_dir(&folder),
    );
    println!("{said}");
    server.stop();
}
