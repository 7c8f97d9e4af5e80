//! Lesson 2 in a real browser: open, step, play, see the viewer draw, answer wrongly, then rightly, and find the
//! result after a restart of the server; then the workbench by keyboard, in a lecture and in trouble; then the drawing,
//! without a graphics card and with busy cores; then the first page, frames in other sites, and what is taken along; then
//! the documentation; then how the window is shared, and a robot dropped on it; then a free-body diagram by mouse and by keyboard; then what lessons need from each other; then a class as its
//! teacher runs it, and the account with which they sign in. What it saw is kept in `tests/output/`.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, PoisonError};
use triad_tests::program::{self, Server, free_port, triad};
use triad_tests::root;

/// Where Debian's package puts the browser.
const CHROMIUM: &str = "/usr/bin/chromium";

/// One browser at a time: several that draw by the processor starve each other.
static BROWSER: Mutex<()> = Mutex::new(());

/// Runs a command; its output is shown if it fails.
fn must(what: &str, command: &mut Command) -> String {
    let output = command.output().unwrap_or_else(|error| panic!("{what}: {error} ({command:?})"));
    let said = [output.stdout, output.stderr].concat();
    let said = String::from_utf8_lossy(&said).into_owned();
    assert!(output.status.success(), "{what}: {command:?} failed:\n{said}");
    said
}

/// The folder of the browser scripts, if all that they need is there.
fn scripts() -> PathBuf {
    let folder = root().join("tests/browser");
    let driver = folder.join("node_modules/playwright-core");
    for needed in [Path::new(CHROMIUM), &driver] {
        assert!(needed.exists(), "{} is missing: `cargo verify setup` installs it", needed.display());
    }
    folder
}

#[test]
fn lesson_two_from_the_first_look_to_the_grade_and_after_a_restart() {
    let _alone = BROWSER.lock().unwrap_or_else(PoisonError::into_inner);
    let folder = scripts();
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

/// Runs a script against a server of its own, with what it needs besides.
fn run(script: &str, more: &[&Path]) {
    visit(script, |home| (Server::start(home), more.iter().map(OsString::from).collect()));
}

/// The same with a server that is started for it, and what that says besides.
fn visit(script: &str, start: impl FnOnce(&Path) -> (Server, Vec<OsString>)) {
    let _alone = BROWSER.lock().unwrap_or_else(PoisonError::into_inner);
    let folder = scripts();
    let home = tempfile::tempdir().unwrap();
    let (server, besides) = start(home.path());
    let said = must(
        "the browser",
        Command::new("node")
            .args([script, &format!("http://{}", server.address)])
            .arg(root().join("tests/output"))
            .args(besides)
            .current_dir(&folder),
    );
    println!("{said}");
    server.stop();
}

#[test]
fn the_workbench_by_keyboard_alone_looking_back_in_a_lecture_in_the_editor_and_in_trouble() {
    run("workbench.mjs", &[]);
}

#[test]
fn a_lecture_has_a_window_for_the_projector_two_votes_side_by_side_hands_and_questions() {
    run("lecture.mjs", &[]);
}

#[test]
fn the_first_page_moves_without_a_session_and_another_site_frames_what_is_recorded_alone() {
    run("first-page.mjs", &[]);
}

#[test]
fn pictures_a_film_a_page_that_plays_offline_and_a_lesson_on_paper_are_taken_along() {
    run("take-along.mjs", &[]);
}

#[test]
fn the_drawing_shows_the_moment_of_the_clock_without_a_graphics_card_and_with_busy_cores() {
    run("drawing.mjs", &[]);
}

#[test]
fn traces_a_ghost_and_extremes_are_seen_beside_a_run_and_quantities_over_each_other() {
    run("compare.mjs", &[]);
}

#[test]
fn the_documentation_is_searched_and_read_in_light_and_dark_on_a_phone_and_from_a_disk() {
    let folder = tempfile::tempdir().unwrap();
    let written = program::run(&["export", "docs", folder.path().to_str().unwrap()]);
    assert!(written.status.success(), "{}", String::from_utf8_lossy(&written.stderr));
    run("docs.mjs", &[folder.path()]);
}

#[test]
fn picture_numbers_and_text_share_the_window_and_robots_are_dropped_on_it() {
    run("sharing.mjs", &[]);
}

#[test]
fn a_reload_and_a_second_tab_lose_nothing() {
    run("kept.mjs", &[]);
}

#[test]
fn a_room_keeps_its_name_for_the_term_and_who_is_early_waits_in_it() {
    run("named-room.mjs", &[]);
}

#[test]
fn what_the_server_says_is_german_on_a_german_page() {
    run("told.mjs", &[]);
}

#[test]
fn a_free_body_diagram_is_drawn_with_the_mouse_and_with_the_keyboard_alone() {
    run("diagram.mjs", &[]);
}

#[test]
fn what_the_lessons_need_from_each_other_and_a_course_of_ones_own_by_keyboard() {
    run("course.mjs", &[]);
}

#[test]
fn a_class_from_the_setup_link_to_the_mistakes_of_its_students() {
    visit("class.mjs", |home| {
        let (server, link) = Server::start_class(home);
        (server, vec![link.into()])
    });
}

#[test]
fn people_who_teach_sign_in_with_the_account_of_their_institution_below_a_path() {
    visit("oidc.mjs", |home| {
        // Each has to know where the other one is.
        let (port, institution) = (free_port().to_string(), free_port().to_string());
        let url = format!("http://127.0.0.1:{port}/triad");
        let issuer = format!("http://127.0.0.1:{institution}");
        let mut command = Command::new(triad());
        command.args(["serve", "--class", "--port", &port, "--url", &url, "--base-path", "/triad"]);
        command.args(["--oidc-issuer", &issuer, "--oidc-client-id", "triad", "--oidc-name", "the school"]);
        command.args(["--database", "grades.db"]).current_dir(home);
        let (server, link) = Server::of_class(&mut command);
        (server, vec![link.into(), institution.into()])
    });
}

#[test]
fn a_course_as_files_is_read_and_its_mechanisms_play_without_a_server_and_without_a_network() {
    let _alone = BROWSER.lock().unwrap_or_else(PoisonError::into_inner);
    let folder = scripts();
    let home = tempfile::tempdir().unwrap();
    let site = home.path().join("site");
    let output = Command::new(triad()).args(["export", "site"]).arg(&site).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    if said.contains("[no-engine]") {
        println!("NOT CHECKED: the program has no engine for the page: {said}");
        return;
    }
    assert!(output.status.success(), "{said}");
    let again = Command::new(triad()).args(["export", "site"]).arg(&site).output().unwrap();
    assert!(String::from_utf8_lossy(&again.stderr).contains("[not-empty]"), "nothing is overwritten");
    let mut visit = Command::new("node");
    visit.arg("site.mjs").arg(&site).arg(root().join("tests/output")).current_dir(&folder);
    println!("{}", must("the browser", &mut visit));
}
