//! Running the server for others: settings and where they come from, the log and what is never in it, counters, probes, how it
//! goes, and the files of `docs/deploy`. What a machine lacks is said in one line.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use std::fs;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tempfile::TempDir;
use triad_tests::postgres::Postgres;
use triad_tests::program::{HANG, Reply, Server, admin, ask, assert_problem, free_port, run_json, triad};
use triad_tests::root;

/// `triad` with these words, in an environment of its own.
fn with_environment(words: &[&str], environment: &[(&str, &str)]) -> Output {
    let mut command = Command::new(triad());
    command.args(words).env_clear().envs(environment.iter().copied()).stdin(Stdio::null());
    command.output().unwrap()
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

/// The lines of a log, each a JSON object.
fn lines(log: &Path) -> Vec<Value> {
    let text = fs::read_to_string(log).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap_or_else(|e| panic!("{e}: {line}"))).collect()
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
    let graded = lines(&log).into_iter().find(|line| line["message"] == "graded").expect("a grading");
    assert_eq!((&graded["span"]["id"], &graded["lesson"]), (&json!("edge-42"), &json!("simple-pendulum")));
    let answered: Vec<Value> = lines(&log).into_iter().filter(|line| line["message"] == "answered").collect();
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

fn has(program: &str) -> bool {
    Command::new(program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok()
}

fn deployed(file: &str) -> String {
    fs::read_to_string(root().join("docs/deploy").join(file)).unwrap()
}

#[test]
fn the_settings_that_are_shown_are_settings() {
    let file = root().join("docs/deploy/triad.toml");
    let all = settings(&["--config", file.to_str().unwrap()], &[]);
    assert_setting(&all, "log", "json", "file");
    assert_setting(&all, "drain", 5, "file");
}

#[test]
fn the_units_are_ones_for_systemd() {
    if !has("systemd-analyze") {
        eprintln!("the units in docs/deploy are not verified: systemd-analyze is missing");
        return;
    }
    let folder = TempDir::new().unwrap();
    for (file, name, start) in [
        ("triad.service", "triad.service", "serve --config"),
        ("triad-grader@.service", "triad-grader@1.service", "grader"),
    ] {
        let unit = folder.path().join(name);
        let text = deployed(file);
        assert!(text.contains(&format!("ExecStart=/usr/local/bin/triad {start}")));
        fs::write(&unit, text.replace("/usr/local/bin/triad", triad().to_str().unwrap())).unwrap();
        let output = Command::new("systemd-analyze").arg("verify").arg(&unit).output().unwrap();
        let said =
            String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout);
        // Units of this machine that it pulls in are not ours.
        let ours: Vec<&str> = said.lines().filter(|line| line.contains(name)).collect();
        assert!(ours.is_empty() && (output.status.success() || !said.contains("triad")), "{said}");
    }
}

#[test]
fn caddy_understands_its_file() {
    if !has("caddy") {
        eprintln!("docs/deploy/Caddyfile is not validated: caddy is missing (apt-get install caddy)");
        return;
    }
    let file = root().join("docs/deploy/Caddyfile");
    let mut caddy = Command::new("caddy");
    let output = caddy.args(["validate", "--adapter", "caddyfile", "--config"]).arg(file).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// A machine with nothing but the program and the libraries it names, as the image has them.
fn image(at: &Path) {
    let listed = Command::new("ldd").arg(triad()).output().unwrap();
    let text = String::from_utf8_lossy(&listed.stdout).into_owned();
    let files = text.lines().filter_map(|line| line.split_whitespace().find(|word| word.starts_with('/')));
    for file in files.map(Path::new).chain([triad()]) {
        let to = if file == triad() { at.join("triad") } else { at.join(file.strip_prefix("/").unwrap()) };
        fs::create_dir_all(to.parent().unwrap()).unwrap();
        fs::copy(file, to).unwrap();
    }
    for below in ["data", "proc"] {
        fs::create_dir_all(at.join(below)).unwrap();
    }
}

#[test]
fn the_program_runs_as_another_user_in_a_root_that_is_read_only() {
    let is_root = Command::new("id").arg("-u").output().is_ok_and(|id| id.stdout == b"0\n");
    if !(is_root && has("unshare") && has("setpriv") && has("ldd")) {
        eprintln!("the read-only root is not tried: it takes root, unshare, setpriv and ldd");
        return;
    }
    let folder = TempDir::new().unwrap();
    // The other user has to come as far as its root.
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).unwrap();
    let machine = folder.path().join("machine");
    fs::create_dir(&machine).unwrap();
    image(&machine);
    // The words of the image's file are the ones that are run.
    let file = deployed("Containerfile");
    let data = machine.join("data");
    assert!(file.contains("USER 65532:65532") && file.contains("CMD [\"serve\", \"--class\"]"), "{file}");
    let script = format!(
        "mount --bind {m} {m} && mount -o remount,bind,ro {m} && mount -t tmpfs -o mode=0700,uid=65532,gid=65532 none {d} && \
         cd {d} && exec setpriv --reuid=65532 --regid=65532 --clear-groups --no-new-privs --bounding-set=-all --inh-caps=-all \
         unshare --user --map-current-user --root={m} --wd=/data /triad serve --class --port 0",
        m = machine.display(),
        d = data.display(),
    );
    let mut command = Command::new("unshare");
    command.args(["--mount", "sh", "-c", &script]).env_clear().env("PATH", "/usr/sbin:/usr/bin:/sbin:/bin");
    command.env("TRIAD_HOST", "127.0.0.1").env("TRIAD_DATABASE", "/data/grades.db").stderr(Stdio::inherit());
    let server = Server::of(&mut command);
    assert_eq!((server.get("/readyz").status, server.get("/").status), (200, 200));
    assert_eq!(server.get("/api/v1/record").status, 401, "a class asks who it is");
    assert!(!data.join("grades.db").exists(), "what it writes is in its own folder");
    // As the image's words promise, told by the system itself.
    let told = |file: &str| fs::read_to_string(format!("/proc/{}/{file}", server.id())).unwrap();
    let status = told("status");
    for line in [
        "Uid:\t65532\t65532",
        "Gid:\t65532\t65532",
        "CapPrm:\t0000000000000000",
        "CapEff:\t0000000000000000",
        "NoNewPrivs:\t1",
    ] {
        assert!(status.contains(line), "{line} is not in\n{status}");
    }
    let root = told("mounts").lines().next().unwrap_or_default().to_owned();
    assert!(
        root.split_whitespace().nth(3).is_some_and(|how| how.split(',').any(|word| word == "ro")),
        "{root}"
    );
    server.stop();
}

/// A proxy that ends with its test, workers and all: killed, it would leave them behind.
struct Proxy(Child);

impl Drop for Proxy {
    fn drop(&mut self) {
        let _ = Command::new("kill").args(["-TERM", &self.0.id().to_string()]).status();
        let _ = self.0.wait();
    }
}

#[test]
#[allow(clippy::too_many_lines)] // one visit through the proxy
fn behind_nginx_pages_streams_and_names_of_requests_pass() {
    let nginx = ["/usr/sbin/nginx", "/usr/bin/nginx"].iter().map(PathBuf::from).find(|path| path.exists());
    let Some(nginx) = nginx else {
        eprintln!("docs/deploy/nginx.conf is not tried: nginx is missing (apt-get install nginx-light)");
        return;
    };
    let folder = TempDir::new().unwrap();
    // nginx answers as another user than the one that starts it.
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).unwrap();
    let log = folder.path().join("log");
    let server = Server::logging(folder.path(), &["--log", "json", "--proxy", "127.0.0.1"], &log);
    let (port, here) = (free_port(), folder.path().display());
    let site = deployed("nginx.conf")
        .lines()
        .filter(|line| !line.trim().starts_with("ssl_"))
        .collect::<Vec<_>>()
        .join("\n")
        .replace("listen 443 ssl;", &format!("listen 127.0.0.1:{port};"))
        .replace("127.0.0.1:8080", &server.address);
    let whole = format!(
        "daemon off;\npid {here}/nginx.pid;\nerror_log {here}/nginx.log;\nevents {{}}\nhttp {{\naccess_log off;\n\
         client_body_temp_path {here}/body;\nproxy_temp_path {here}/proxy;\nfastcgi_temp_path {here}/f;\n\
         uwsgi_temp_path {here}/u;\nscgi_temp_path {here}/s;\n{site}\n}}\n"
    );
    let file = folder.path().join("nginx.conf");
    fs::write(&file, whole).unwrap();
    let mut nginx = Command::new(nginx);
    nginx.arg("-c").arg(&file).stdout(Stdio::null()).stderr(Stdio::null());
    let mut proxy = Proxy(nginx.spawn().unwrap());
    let address = format!("127.0.0.1:{port}");
    let began = Instant::now();
    while TcpStream::connect(&address).is_err() {
        assert!(
            began.elapsed() < HANG && proxy.0.try_wait().unwrap().is_none(),
            "nginx does not start: {file:?}"
        );
        std::thread::sleep(Duration::from_millis(20));
    }
    assert_eq!(ask(&address, "/", "").status, 200);
    let lost = ask(&address, "/api/v1/lessons/none", "");
    let name = lost.json()["trace_id"].as_str().unwrap().to_owned();
    assert!(lines(&log).iter().any(|line| line["span"]["id"] == name.as_str()), "nginx names the request");
    // Handing in: the page's own origin, as a browser says it.
    let body = json!({"student": "ada", "answers": {}}).to_string();
    let mut stream = TcpStream::connect(&address).unwrap();
    let head = format!(
        "POST /api/v1/lessons/screw/submissions HTTP/1.0\r\nHost: {address}\r\nOrigin: http://{address}\r\nContent-Type: \
         application/json\r\nContent-Length: {}\r\n\r\n{body}",
        body.len()
    );
    stream.write_all(head.as_bytes()).unwrap();
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).unwrap();
    assert_eq!(Reply::parse(&answer).status, 201);
    // A live simulation, opened and watched through nginx.
    let session = server.post("/api/v1/sessions", &json!({"builtin": "simple-pendulum"})).json();
    let id = session["id"].as_str().unwrap_or_else(|| panic!("{session:#}"));
    let mut stream = TcpStream::connect(&address).unwrap();
    stream.set_read_timeout(Some(HANG)).unwrap();
    let head = format!(
        "GET /api/v1/sessions/{id}/stream HTTP/1.1\r\nHost: {address}\r\nOrigin: http://{address}\r\nConnection: Upgrade\r\n\
         Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
    );
    stream.write_all(head.as_bytes()).unwrap();
    let mut seen = Vec::new();
    let mut part = [0; 4096];
    while !String::from_utf8_lossy(&seen).contains("\"time\"") {
        let n = stream.read(&mut part).unwrap();
        assert!(n > 0, "the stream ends: {}", String::from_utf8_lossy(&seen));
        seen.extend_from_slice(&part[..n]);
    }
    assert!(seen.starts_with(b"HTTP/1.1 101"), "{}", String::from_utf8_lossy(&seen));
    drop((stream, proxy));
    server.stop();
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
        assert_problem(&run_json(&all).1, code, "");
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
    let mut grader = Proxy(grader.spawn().unwrap());
    // The server grades as well: until one of them was this grader's.
    let graded = |line: &Value| line["message"] == "graded";
    let (began, mut number) = (Instant::now(), 0);
    while !log.exists() || !lines(&log).iter().any(graded) {
        assert!(began.elapsed() < HANG && grader.0.try_wait().unwrap().is_none());
        number += 1;
        let body = json!({"student": format!("student {number}"), "answers": {}}).to_string();
        let name = format!("X-Request-Id: asked-{number}\r\n");
        let path = "/api/v1/lessons/screw/submissions";
        assert_eq!(server.ask_with("POST", path, &name, Some(body.as_bytes())).status, 202);
    }
    let line = lines(&log).into_iter().find(graded).unwrap();
    assert!(line["span"]["id"].as_str().unwrap().starts_with("asked-"), "{line}");
    let counted = admin(&log, "/metrics").text();
    assert!(counted.contains("triad_queue_aside 0") && counted.contains("lesson=\"screw\""), "{counted}");
    assert_eq!(admin(&log, "/readyz").status, 200);
    postgres.stop();
    assert_eq!(admin(&log, "/readyz").status, 503);
    drop(grader);
}
