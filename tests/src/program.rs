//! The `triad` program from outside: its command line, and a running server.

use crate::root;
use crate::vitals::Vitals;
use serde_json::Value;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::OnceLock;
use std::sync::mpsc::channel;
use std::time::{Duration, Instant, SystemTime};

/// Ends a test that hangs, and decides nothing else: longer than anything here takes on a slow and busy machine.
pub const HANG: Duration = Duration::from_mins(5);

/// The program, in the profile of this test.
///
/// `cargo test --workspace` has built it; after `cargo test -p triad-tests` alone it may be missing or older than its
/// sources, and is built here. `TRIAD_PROGRAM` names another one to be tested instead.
pub fn triad() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        if let Some(program) = std::env::var_os("TRIAD_PROGRAM") {
            return program.into();
        }
        let here = std::env::current_exe().unwrap();
        let profile = here.parent().and_then(Path::parent).expect("tests run from target/<profile>/deps");
        let program = profile.join("triad");
        let sources = [
            "engine",
            "lessons/src",
            "lessons/box/src",
            "lessons/course",
            "server/src",
            "server/build",
            "web/src",
        ];
        let changed = sources.iter().filter_map(|source| newest(&root().join(source))).max();
        if newest(&program) < changed {
            build(profile);
        }
        program
    })
}

/// Time of the last change of a file, or of any file below a folder.
fn newest(path: &Path) -> Option<SystemTime> {
    let about = path.metadata().ok()?;
    if about.is_file() {
        return about.modified().ok();
    }
    path.read_dir().ok()?.filter_map(|entry| newest(&entry.ok()?.path())).max()
}

fn build(profile: &Path) {
    let mut cargo = Command::new(env!("CARGO"));
    // Without `--package`, so that the crates have the same features as in `cargo run` and `cargo test --workspace`.
    cargo.current_dir(root()).args(["build", "--bin", "triad", "--target-dir"]);
    cargo.arg(profile.parent().unwrap());
    if !cfg!(debug_assertions) {
        cargo.arg("--release");
    }
    let output = cargo.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// Runs the program to its end.
pub fn run(arguments: &[&str]) -> Output {
    output(Command::new(triad()).args(arguments))
}

/// What a command says that ends by itself; one that does not is ended, and the test with it.
pub fn output(command: &mut Command) -> Output {
    let command = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let child = command.spawn().unwrap();
    let id = child.id().to_string();
    let (tell, told) = channel();
    std::thread::spawn(move || tell.send(child.wait_with_output()));
    told.recv_timeout(HANG).map_or_else(
        |_| {
            let _ = Command::new("kill").args(["-KILL", &id]).status();
            panic!("{command:?} does not end")
        },
        Result::unwrap,
    )
}

/// Runs the program with `--json`; returns its exit code and what it printed.
pub fn run_json(arguments: &[&str]) -> (i32, Value) {
    let output = output(Command::new(triad()).arg("--json").args(arguments));
    let text = String::from_utf8_lossy(&output.stdout);
    let json = serde_json::from_str(&text).unwrap_or_else(|error| {
        panic!("triad --json {arguments:?}: {error}\n{text}\n{}", String::from_utf8_lossy(&output.stderr))
    });
    (output.status.code().unwrap(), json)
}

/// A server on a free port, with its gradebook in a folder of the test's.
pub struct Server {
    child: Child,
    /// Where it listens, such as `127.0.0.1:41234`.
    pub address: String,
}

impl Server {
    /// Starts a server on a free port and waits until it says where it is.
    pub fn start(folder: &Path) -> Self {
        Self::start_at(folder, "0")
    }

    /// The same, on a given port.
    pub fn start_at(folder: &Path, port: &str) -> Self {
        Self::start_by(folder, &["--port", port])
    }

    /// Starts a server on a free port with more options.
    pub fn start_with(folder: &Path, options: &[&str]) -> Self {
        Self::start_by(folder, &[&["--port", "0"], options].concat())
    }

    /// Starts a server for a class; with the link with which its teacher comes in.
    pub fn start_class(folder: &Path) -> (Self, String) {
        Self::of_class(Self::command(folder, &["--port", "0", "--class"]).stderr(Stdio::inherit()))
    }

    /// A server for a class that a command starts; with the link with which its teacher comes in.
    pub fn of_class(command: &mut Command) -> (Self, String) {
        let (server, mut lines) = Self::saying(command);
        let line = lines.find(|line| line.contains("/setup#")).expect("a link for the teacher");
        let link = line.split_whitespace().find(|word| word.contains("/setup#"));
        (server, link.unwrap_or_default().to_owned())
    }

    fn start_by(folder: &Path, options: &[&str]) -> Self {
        Self::of(Self::command(folder, options).stderr(Stdio::inherit()))
    }

    /// Starts a server on a free port with more options, its log in a file.
    pub fn logging(folder: &Path, options: &[&str], log: &Path) -> Self {
        let options = [&["--port", "0"], options].concat();
        Self::of(Self::command(folder, &options).stderr(std::fs::File::create(log).unwrap()))
    }

    /// A server that a command starts; where it is, it says in its first line.
    pub fn of(command: &mut Command) -> Self {
        Self::saying(command).0
    }

    fn command(folder: &Path, options: &[&str]) -> Command {
        let mut command = Command::new(triad());
        command.arg("serve").args(options).arg("--database").arg(folder.join("grades.db"));
        command.current_dir(folder);
        command
    }

    fn saying(command: &mut Command) -> (Self, impl Iterator<Item = String> + use<>) {
        let mut child = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn().unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap());
        let mut line = String::new();
        lines.read_line(&mut line).unwrap();
        // A path below which it stands is not part of its address.
        let at = line.split("http://").nth(1).and_then(|rest| rest.split(['/', ' ']).next());
        let address = at.unwrap_or_else(|| panic!("the server said {line:?}")).to_owned();
        // Whatever else it says must not fill the pipe.
        let (said, heard) = channel();
        std::thread::spawn(move || {
            for line in lines.lines().map_while(Result::ok) {
                // Nobody need listen.
                drop(said.send(line));
            }
        });
        (Self { child, address }, heard.into_iter())
    }

    /// Asks it to stop, as a system would, and does not wait.
    pub fn ask_to_stop(&self) {
        let id = self.child.id().to_string();
        assert!(Command::new("kill").args(["-TERM", &id]).status().unwrap().success());
    }

    /// Asks it to stop, and waits.
    pub fn stop(mut self) {
        self.ask_to_stop();
        let began = Instant::now();
        while self.child.try_wait().unwrap().is_none() {
            assert!(began.elapsed() < HANG, "the server does not stop when it is asked to");
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// The number of its process.
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// Processor time that the server has used, on Linux.
    pub fn processor_time(&self) -> Duration {
        self.vitals().processor
    }

    /// Memory that the server holds, MB, on Linux.
    pub fn memory(&self) -> f64 {
        self.vitals().memory
    }

    /// Open files of the server, connections among them, on Linux.
    pub fn files(&self) -> usize {
        self.vitals().files
    }

    /// Threads of the server, on Linux.
    pub fn threads(&self) -> f64 {
        self.vitals().threads
    }

    /// What the server holds, on Linux.
    pub fn vitals(&self) -> Vitals {
        Vitals::of(self.child.id())
    }

    /// Gets a path.
    pub fn get(&self, path: &str) -> Reply {
        self.ask("GET", path, None)
    }

    /// Posts JSON.
    pub fn post(&self, path: &str, body: &Value) -> Reply {
        self.ask("POST", path, Some(body.to_string().as_bytes()))
    }

    /// One request on a connection of its own. HTTP/1.0, so that the answer ends with the connection.
    pub fn ask(&self, method: &str, path: &str, body: Option<&[u8]>) -> Reply {
        self.ask_with(method, path, "", body)
    }

    /// The same with more header lines, each with its end.
    pub fn ask_with(&self, method: &str, path: &str, headers: &str, body: Option<&[u8]>) -> Reply {
        let mut stream = TcpStream::connect(&self.address).unwrap();
        stream.set_read_timeout(Some(HANG)).unwrap();
        let about = body.map_or(String::new(), |body| {
            format!("Content-Type: application/json\r\nContent-Length: {}\r\n", body.len())
        });
        let head =
            format!("{method} {path} HTTP/1.0\r\nHost: {}\r\nAccept: */*\r\n{headers}{about}", self.address);
        stream.write_all(format!("{head}\r\n").as_bytes()).unwrap();
        // A server that refuses a body need not read it to its end.
        let _ = stream.write_all(body.unwrap_or_default());
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        Reply::parse(&answer)
    }
}

/// The lines of a log, each a JSON object.
pub fn log_lines(log: &Path) -> Vec<Value> {
    let text = std::fs::read_to_string(log).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap_or_else(|e| panic!("{e}: {line}"))).collect()
}

/// A program that is asked to end with its test, and ends its own children: killed, it would leave them behind.
#[derive(Debug)]
pub struct Ending(pub Child);

impl Drop for Ending {
    fn drop(&mut self) {
        let _ = Command::new("kill").args(["-TERM", &self.0.id().to_string()]).status();
        let _ = self.0.wait();
    }
}

/// What a server says at its admin address, which has a port of its own: its log of JSON lines names it.
pub fn admin(log: &Path, path: &str) -> Reply {
    let text = std::fs::read_to_string(log).unwrap();
    let at = text
        .lines()
        .find_map(|line| serde_json::from_str::<Value>(line).ok()?["admin"].as_str().map(str::to_owned));
    ask(&at.unwrap(), path, "")
}

/// Gets a path of an address with more header lines, each with its end, on a connection of its own.
pub fn ask(address: &str, path: &str, headers: &str) -> Reply {
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(HANG)).unwrap();
    stream.write_all(format!("GET {path} HTTP/1.0\r\nHost: {address}\r\n{headers}\r\n").as_bytes()).unwrap();
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).unwrap();
    Reply::parse(&answer)
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A free port, for a program that cannot say which one it took.
pub fn free_port() -> u16 {
    TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port()
}

/// An answer of the server.
#[derive(Debug)]
pub struct Reply {
    /// Status code.
    pub status: u16,
    /// Header lines, in lower case.
    pub head: String,
    /// Body.
    pub body: Vec<u8>,
}

impl Reply {
    /// Reads an answer that is whole.
    pub fn parse(answer: &[u8]) -> Self {
        let end = answer.windows(4).position(|w| w == b"\r\n\r\n").expect("an answer with a head");
        let head = String::from_utf8_lossy(&answer[..end]).to_lowercase();
        let status = head.split_whitespace().nth(1).and_then(|s| s.parse().ok()).expect("a status");
        Self { status, head, body: answer[end + 4..].to_vec() }
    }

    /// The body as text.
    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.body).into_owned()
    }

    /// The body as JSON.
    pub fn json(&self) -> Value {
        serde_json::from_slice(&self.body).unwrap_or_else(|e| panic!("{}: {e}\n{}", self.status, self.text()))
    }
}

/// What a refusal must have: a code, a hint, and (where `pointer` is not empty) the place.
pub fn assert_problem(problem: &Value, code: &str, pointer: &str) {
    assert_eq!(problem["code"], code, "{problem:#}");
    assert!(problem["hint"].as_str().is_some_and(|hint| hint.len() > 10), "no remedy: {problem:#}");
    assert!(problem["detail"].as_str().is_some_and(|detail| detail.len() > 10), "no reason: {problem:#}");
    if !pointer.is_empty() {
        assert_eq!(problem["errors"][0]["pointer"], format!("#{pointer}"), "{problem:#}");
    }
}
