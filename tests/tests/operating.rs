//! Running the server for others: settings and where they come from, the log and what is never in it, counters, probes, how it
//! goes, and addresses below a path.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use std::fs;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::process::{Command, Output, Stdio};
use std::time::Instant;

use serde_json::{Value, json};
use tempfile::TempDir;
use triad_tests::postgres::Postgres;
use triad_tests::program::{Ending, HANG, Server, admin, assert_problem, log_lines, output, run_json, triad};
use triad_tests::root;

/// `triad` with these words, in an environment of its own.
fn with_environment(words: &[&str], environment: &[(&str, &str)]) -> Output {
    let mut command = Command::new(triad());
    output(command.args(words).env_clear().envs(environment.iter().copied()))
}

/// The settings that `triad config` tells.
fn settings(words: &[&str], environment: &[(&str, &str)]) -> Value {
    let output = with_environment(&[&["config", "--json"], words].concat(), environment);
    serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{output:?}"))
}

fn assert_setting(all: &Value, name: &str, value: impl Into<Value>, from: &str) {
    assert_eq!((&all[name]["value"], &all[name]["from"]), (&value.into(), &json!(from)), "{name} in {all:#}");
}

#[test]
fn the_command_line_goes_before_the_environment_the_file_and_the_default() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("triad.toml");
    fs::write(
        &file,
        "port = 1111\nhost = \"::1\"\nmax-rooms = 3\nproxy = [\"10.0.0.1\", \"10.0.0.2\"]\nclass = true\n",
    )
    .unwrap();
    let config = ["--config", file.to_str().unwrap()];
    let environment = [("TRIAD_PORT", "2222"), ("TRIAD_HOST", "10.1.1.1")];
    let all = settings(&[&config[..], &["--port", "3333"]].concat(), &environment);
    assert_setting(&all, "port", 3333, "command line");
    assert_setting(&all, "host", "10.1.1.1", "environment");
    assert_setting(&all, "max-rooms", 3, "file");
    assert_setting(&all, "class", true, "file");
    assert_setting(&all, "proxy", json!(["10.0.0.1", "10.0.0.2"]), "file");
    assert_setting(&all, "max-sessions", 64, "default");
    assert_setting(&all, "url", Value::Null, "default");
    // The file may be named by the environment too, and what is printed is such a file.
    let named = [("TRIAD_CONFIG", file.to_str().unwrap())];
    let text = String::from_utf8(with_environment(&["config"], &named).stdout).unwrap();
    assert!(text.contains("port = 1111  # file\n") && text.contains("# url is not set\n"), "{text}");
    fs::write(&file, &text).unwrap();
    assert_setting(&settings(&config, &[]), "port", 1111, "file");
    let hidden = settings(&["--database", "postgres://triad:words@db/grades"], &[]);
    assert_setting(&hidden, "database", "postgres://triad:***@db/grades", "command line");
}

#[test]
fn a_file_of_settings_with_a_mistake_is_refused() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("triad.toml");
    for (text, code, word) in [
        ("prot = 1", "unknown-setting", "port"),
        ("port = [1]", "invalid-setting", "number"),
        ("port = 99999", "invalid-setting", "triad serve --help"),
        ("class = \"yes\"", "invalid-setting", "triad serve --help"),
        ("proxy = [\"here\"]", "invalid-setting", "triad serve --help"),
        ("port = ", "settings-unreadable", "one setting a line"),
    ] {
        fs::write(&file, text).unwrap();
        let output = with_environment(&["config", "--json", "--config", file.to_str().unwrap()], &[]);
        assert_eq!(output.status.code(), Some(3), "{text}");
        let problem: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_problem(&problem, code, "");
        assert!(problem["hint"].as_str().unwrap().contains(word), "{problem:#}");
    }
    let both = with_environment(&["serve", "--open", "--class"], &[]);
    assert!(!both.status.success());
}

const NAME: &str = "Quetzalcoatl Weatherwax";
const ANSWER: &str = "48.151623";

#[test]
fn a_request_is_followed_from_header_to_log_and_no_name_answer_or_secret_is_in_it() {
    let folder = TempDir::new().unwrap();
    let log = folder.path().join("log");
    let options = ["--log", "json", "--admin-address", "127.0.0.1:0"];
    let server = Server::logging(folder.path(), &options, &log);
    let body =
        json!({"student": NAME, "answers": {"tension-bottom": {"value": ANSWER, "unit": "N"}}}).to_string();
    let path = "/api/v1/lessons/simple-pendulum/submissions";
    let reply = server.ask_with("POST", path, "X-Request-Id: edge-42\r\n", Some(body.as_bytes()));
    assert_eq!(reply.status, 201, "{}", reply.text());
    assert!(reply.head.contains("x-request-id: edge-42"), "{}", reply.head);
    let lost =
        server.ask_with("GET", "/api/v1/lessons/none?student=Weatherwax", "X-Request-Id: edge-43\r\n", None);
    assert_eq!(lost.json()["trace_id"], "edge-43");
    let fresh = server.get("/api/v1/lessons/none").json()["trace_id"].as_str().unwrap().to_owned();
    let graded = log_lines(&log).into_iter().find(|line| line["message"] == "graded").expect("a grading");
    assert_eq!((&graded["span"]["id"], &graded["lesson"]), (&json!("edge-42"), &json!("simple-pendulum")));
    let answered: Vec<Value> =
        log_lines(&log).into_iter().filter(|line| line["message"] == "answered").collect();
    let of = |id: &str| {
        answered.iter().find(|line| line["span"]["id"] == id).unwrap_or_else(|| panic!("{id}: {answered:#?}"))
    };
    assert_eq!((&of("edge-42")["status"], &of("edge-42")["span"]["method"]), (&json!(201), &json!("POST")));
    assert_eq!(of("edge-42")["span"]["route"], "/api/v1/lessons/{slug}/submissions");
    assert_eq!((&of("edge-43")["code"], &of(&fresh)["status"]), (&json!("unknown-lesson"), &json!(404)));
    let counted = admin(&log, "/metrics").text();
    for line in [
        "triad_requests_total{method=\"POST\",route=\"/api/v1/lessons/{slug}/submissions\",status=\"201\",code=\"\"} 1",
        "triad_requests_total{method=\"GET\",route=\"/api/v1/lessons/{slug}\",status=\"404\",code=\"unknown-lesson\"} 2",
        "triad_grading_duration_seconds_count{lesson=\"simple-pendulum\"} 1",
        "triad_ready 1",
        "# EOF",
    ] {
        assert!(counted.contains(line), "{line} is not in\n{counted}");
    }
    server.stop();
    let text = fs::read_to_string(&log).unwrap() + &counted;
    for secret in ["Quetzal", "Weatherwax", ANSWER, "48.15"] {
        assert!(!text.contains(secret), "{secret} is in the log:\n{text}");
    }
}

#[test]
fn a_class_leaves_no_code_and_no_token_in_the_log() {
    let folder = TempDir::new().unwrap();
    let log = folder.path().join("log");
    let server = Server::logging(folder.path(), &["--class", "--log", "json"], &log);
    let database = folder.path().join("grades.db");
    let file = folder.path().join("class.triad");
    let words = ["class", "export", file.to_str().unwrap(), "--database", database.to_str().unwrap()];
    assert!(with_environment(&words, &[]).status.success());
    let kept = fs::read_to_string(&file).unwrap();
    let row = kept.lines().find_map(|line| {
        let at = line.split("\"join_code\":\"").nth(1)?;
        at.split('"').next().map(str::to_owned)
    });
    let code = row.unwrap_or_else(|| panic!("{kept}"));
    let joined = server.post("/api/v1/join", &json!({"code": code, "name": NAME}));
    assert_eq!(joined.status, 201, "{}", joined.text());
    let told = joined.text();
    let cookie = joined.head.lines().find_map(|line| line.strip_prefix("set-cookie: ")).unwrap().to_owned();
    let pair = cookie.split(';').next().unwrap();
    let body = json!({"answers": {"tension-bottom": {"value": ANSWER, "unit": "N"}}}).to_string();
    let path = "/api/v1/lessons/simple-pendulum/submissions";
    // Header lines were lowered for reading: a token has digits and small letters alone, else this is refused.
    let reply = server.ask_with("POST", path, &format!("Cookie: {pair}\r\n"), Some(body.as_bytes()));
    assert_eq!(reply.status, 201, "{}", reply.text());
    server.stop();
    let text = fs::read_to_string(&log).unwrap();
    assert!(text.contains("\"graded\""), "{text}");
    let token = pair.split('=').nth(1).unwrap();
    let phrase: Value = serde_json::from_str(&told).unwrap();
    let mut secrets = vec![code, token.to_owned(), NAME.to_owned(), ANSWER.to_owned()];
    strings(&phrase, &mut secrets);
    for secret in secrets.iter().filter(|text| text.len() > 5) {
        assert!(!text.contains(secret.as_str()), "{secret} is in the log:\n{text}");
    }
}

/// Every text of a document but links of the page itself.
fn strings(value: &Value, found: &mut Vec<String>) {
    match value {
        Value::String(text) if text != "student" => found.push(text.clone()),
        Value::Array(list) => list.iter().for_each(|one| strings(one, found)),
        Value::Object(map) => map.values().for_each(|one| strings(one, found)),
        _ => {}
    }
}

#[test]
fn a_server_that_goes_says_so_first_and_answers_until_then() {
    let folder = TempDir::new().unwrap();
    let log = folder.path().join("log");
    let server = Server::logging(folder.path(), &["--drain", "600", "--log", "json"], &log);
    assert_eq!(server.get("/readyz").status, 200);
    server.ask_to_stop();
    let began = Instant::now();
    let told = loop {
        let reply = server.get("/readyz");
        if reply.status != 200 || began.elapsed() > HANG {
            break reply;
        }
    };
    assert_problem(&told.json(), "draining", "");
    assert_eq!((told.status, server.get("/livez").status), (503, 200));
    assert_eq!(server.get("/api/v1/lessons").status, 200, "it still answers");
    // Asked once more it goes at once, however long it would wait.
    server.stop();
}

#[test]
fn a_gradebook_that_is_gone_is_not_ready() {
    let folder = TempDir::new().unwrap();
    let log = folder.path().join("log");
    let server = Server::logging(folder.path(), &["--log", "json", "--admin-address", "127.0.0.1:0"], &log);
    fs::rename(folder.path().join("grades.db"), folder.path().join("elsewhere.db")).unwrap();
    assert_eq!((server.get("/readyz").status, server.get("/livez").status), (503, 200));
    assert_eq!(admin(&log, "/readyz").status, 503);
    assert!(admin(&log, "/metrics").text().contains("triad_ready 0\n"));
    // What was asked at the address of the class has no counters.
    assert_eq!(server.get("/metrics").status, 404);
}

#[test]
fn the_settings_that_are_shown_are_settings() {
    let file = root().join("docs/deploy/triad.toml");
    let all = settings(&["--config", file.to_str().unwrap()], &[]);
    assert_setting(&all, "log", "json", "file");
    assert_setting(&all, "drain", 5, "file");
}

/// A class of the newer addresses, below a path: the page, a run and its stream; and whoever hears all machines has accounts.
#[test]
fn at_an_address_of_ipv6_and_below_a_path_pages_and_streams_pass() {
    let folder = TempDir::new().unwrap();
    let log = folder.path().join("log");
    let options =
        ["--host", "::1", "--base-path", "/school/triad/", "--admin-address", "[::1]:0", "--log", "json"];
    let server = Server::logging(folder.path(), &options, &log);
    assert!(server.address.starts_with("[::1]:"), "{}", server.address);
    let page = server.get("/school/triad/");
    assert_eq!(page.status, 200);
    assert!(page.head.contains(&format!(" ws://{0} wss://{0} ", server.address)), "{}", page.head);
    assert_eq!(admin(&log, "/readyz").status, 200);

    let session = server.post("/school/triad/api/v1/sessions", &json!({"builtin": "simple-pendulum"}));
    let at = session.head.lines().find_map(|line| line.strip_prefix("location: ")).unwrap();
    let mut stream = TcpStream::connect(&server.address).unwrap();
    stream.set_read_timeout(Some(HANG)).unwrap();
    write!(
        stream,
        "GET {at}/stream HTTP/1.1\r\nHost: {0}\r\nOrigin: http://{0}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n\
         Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n",
        server.address
    )
    .unwrap();
    let mut head = [0; 12];
    stream.read_exact(&mut head).unwrap();
    assert_eq!(&head, b"HTTP/1.1 101");
    drop(stream);
    server.stop();

    let book = folder.path().join("g.db");
    let book = book.to_str().unwrap();
    for (words, code) in [
        (&["--host", "::"][..], "open-to-all"),
        (&["--host", "2001:db8::7"], "open-to-all"),
        (&["--class", "--url", "https://school.example/triad"], "settings-contradict"),
        (&["--class", "--oidc-client-id", "triad"], "settings-contradict"),
        (
            &["--class", "--oidc-issuer", "https://login.example", "--oidc-client-id", "triad"],
            "settings-contradict",
        ),
        (
            &[
                "--class",
                "--url",
                "https://triad.example",
                "--oidc-issuer",
                "http://login.example",
                "--oidc-client-id",
                "triad",
            ],
            "settings-contradict",
        ),
    ] {
        let all = [&["serve", "--port", "0", "--database", book], words].concat();
        let told = run_json(&all).1;
        assert_problem(&told, code, "");
        let hint = told["hint"].as_str().unwrap();
        assert!(code != "open-to-all" || (hint.contains("--class") && hint.contains("--open")), "{hint}");
    }
}

/// A grader by itself: its counters, and the name of the request with which it was asked.
#[test]
fn a_grader_tells_what_it_does_and_for_which_request() {
    let Some(postgres) = Postgres::start("counters and log of a grader") else { return };
    let (folder, url) = (TempDir::new().unwrap(), postgres.database());
    let log = folder.path().join("log");
    let mut server = Command::new(triad());
    server.args(["serve", "--port", "0", "--at-once", "0", "--database", &url]).current_dir(folder.path());
    let server = Server::of(server.stderr(Stdio::null()));
    let mut grader = Command::new(triad());
    grader.args(["grader", "--log", "json", "--admin-address", "0", "--slots", "1", "--database", &url]);
    grader.stdout(Stdio::null()).stderr(fs::File::create(&log).unwrap());
    let mut grader = Ending(grader.spawn().unwrap());
    // The server grades as well: until one of them was this grader's.
    let graded = |line: &Value| line["message"] == "graded";
    let (began, mut number) = (Instant::now(), 0);
    while !log.exists() || !log_lines(&log).iter().any(graded) {
        assert!(began.elapsed() < HANG && grader.0.try_wait().unwrap().is_none());
        number += 1;
        let body = json!({"student": format!("student {number}"), "answers": {}}).to_string();
        let name = format!("X-Request-Id: asked-{number}\r\n");
        let path = "/api/v1/lessons/screw/submissions";
        assert_eq!(server.ask_with("POST", path, &name, Some(body.as_bytes())).status, 202);
    }
    let line = log_lines(&log).into_iter().find(graded).unwrap();
    assert!(line["span"]["id"].as_str().unwrap().starts_with("asked-"), "{line}");
    let counted = admin(&log, "/metrics").text();
    assert!(counted.contains("triad_queue_aside 0") && counted.contains("lesson=\"screw\""), "{counted}");
    assert_eq!(admin(&log, "/readyz").status, 200);
    postgres.stop();
    assert_eq!(admin(&log, "/readyz").status, 503);
    drop(grader);
}
