//! The files of `docs/deploy` as far as this machine allows: units of systemd, proxies, the image's user and its read-only root.
//! What a machine lacks is said in one line.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use std::fs;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::json;
use tempfile::TempDir;
use triad_tests::program::{Ending, HANG, Reply, Server, ask, free_port, log_lines, triad};
use triad_tests::root;

fn has(program: &str) -> bool {
    Command::new(program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok()
}

fn deployed(file: &str) -> String {
    fs::read_to_string(root().join("docs/deploy").join(file)).unwrap()
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
    let mut proxy = Ending(nginx.spawn().unwrap());
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
    assert!(
        log_lines(&log).iter().any(|line| line["span"]["id"] == name.as_str()),
        "nginx names the request"
    );
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
