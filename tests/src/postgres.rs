//! A PostgreSQL server for tests: the one that is installed, on a folder of its own, thrown away afterwards.

use std::io::Write;
use std::os::unix::process::CommandExt;
use std::path::PathBuf;
use std::process::{Command, Output};
use std::sync::atomic::{AtomicUsize, Ordering};
use tempfile::TempDir;

use crate::cable::Cable;

/// Names the server in the tests that [`again`] runs, or another one to be used instead.
const GIVEN: &str = "TRIAD_TEST_POSTGRES";
/// Whoever is root lets the server run as nobody: it refuses to be run by root.
const NOBODY: u32 = 65534;
/// The database that new ones are copied from.
const TEMPLATE: &str = "triad_template";

/// A running server. It ends when this is dropped.
pub struct Postgres {
    folder: Option<TempDir>,
    /// Address of its first database.
    url: String,
}

impl Postgres {
    /// Starts one. Where PostgreSQL is missing, a line says so and that `what` is left out.
    pub fn start(what: &str) -> Option<Self> {
        if let Ok(url) = std::env::var(GIVEN) {
            return Some(Self { folder: None, url });
        }
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().to_str().unwrap().to_owned();
        let url = format!("postgres://triad@localhost/postgres?host={place}");
        let server = Self { folder: Some(folder), url };
        if is_root() {
            std::os::unix::fs::chown(&place, Some(NOBODY), Some(NOBODY)).unwrap();
        }
        let data = format!("{place}/data");
        let made = server.own(
            "initdb",
            &["--no-sync", "--auth=trust", "--username=triad", "--encoding=UTF8", "--locale=C", "-D", &data],
        );
        if !made.is_ok_and(|made| made.status.success()) {
            println!("left out: {what}: PostgreSQL is not installed (Debian: apt-get install postgresql)");
            return None;
        }
        server.hears("");
        server.control(&["start"]);
        Some(server)
    }

    /// Ends it as a power cut would, and starts it again.
    pub fn crash(&self) {
        self.control(&["--mode=immediate", "restart"]);
    }

    /// Ends it as a power cut would.
    pub fn stop(&self) {
        self.control(&["--mode=immediate", "stop"]);
    }

    /// A new database; its address. It is a copy of the template, where there is one.
    pub fn database(&self) -> String {
        static COUNT: AtomicUsize = AtomicUsize::new(0);
        let name = format!("t{}_{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let is_there = self.ask(&format!("SELECT 1 FROM pg_database WHERE datname = '{TEMPLATE}'"));
        let from = if is_there == "1" { format!(" TEMPLATE {TEMPLATE}") } else { String::new() };
        self.ask(&format!("CREATE DATABASE {name}{from}"));
        self.address(&name)
    }

    /// Makes the template empty; its address.
    pub fn template(&self) -> String {
        self.ask(&format!("CREATE DATABASE {TEMPLATE}"));
        self.address(TEMPLATE)
    }

    /// The address of a database.
    pub fn address(&self, name: &str) -> String {
        let (before, after) = self.url.split_once("/postgres?").unwrap_or((&self.url, ""));
        format!("{before}/{name}?{after}")
    }

    /// A cable to it, and the address of a database at its end.
    pub fn by_cable(&self, database: &str) -> (Cable, String) {
        let folder = self.folder.as_ref().expect("a server of its own").path();
        let cable = Cable::to(folder.join(".s.PGSQL.5432"));
        let (before, _) = database.split_once('?').unwrap_or((database, ""));
        let address = before.replace("localhost", &format!("127.0.0.1:{}", cable.port));
        (cable, format!("{address}?sslmode=disable"))
    }

    /// Lets the machines of a network reach it at this machine's address there, once it is started again; where a database is for
    /// them.
    pub fn at(&self, address: &str, database: &str) -> String {
        self.hears(address);
        self.set("pg_hba.conf", "host all all samenet trust");
        self.control(&["restart"]);
        let (before, _) = database.split_once('?').unwrap_or((database, ""));
        format!("{}?sslmode=disable", before.replace("localhost", address))
    }

    fn hears(&self, address: &str) {
        self.set("postgresql.conf", &format!("listen_addresses = '{address}'"));
    }

    /// Adds a line to one of its files: the last one counts.
    fn set(&self, file: &str, line: &str) {
        let path = self.folder.as_ref().expect("a server of its own").path().join("data").join(file);
        writeln!(std::fs::OpenOptions::new().append(true).open(path).unwrap(), "{line}").unwrap();
    }

    /// What a statement says, in its first database.
    pub fn ask(&self, statement: &str) -> String {
        psql(&self.url, statement)
    }

    /// Runs the tests of this program whose names have `filter` in them, but none of `without`, once more with this server: see
    /// [`given`].
    pub fn again(&self, filter: &[&str], without: &[&str]) {
        let mut tests = Command::new(std::env::current_exe().unwrap());
        tests.args(filter).args(without.iter().flat_map(|name| ["--skip", name])).env(GIVEN, &self.url);
        let output = tests.output().unwrap();
        let said = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success(), "{said}\n{}", String::from_utf8_lossy(&output.stderr));
        let passed = said.lines().find(|line| line.starts_with("test result")).unwrap();
        assert!(!passed.contains(" 0 passed"), "{passed}");
        println!("on PostgreSQL: {passed}");
    }

    fn control(&self, what: &[&str]) {
        let place = self.folder.as_ref().expect("a server of its own").path().to_str().unwrap();
        let settings = format!("-k {place} -c fsync=off -c full_page_writes=off -c max_connections=300");
        let (data, log) = (format!("{place}/data"), format!("{place}/log"));
        let mut all = vec!["-D", &data, "-l", &log, "-o", &settings, "-w", "-s"];
        all.extend(what);
        told(&self.own("pg_ctl", &all).unwrap());
    }

    /// Runs one of its programs, never as root.
    fn own(&self, program: &str, arguments: &[&str]) -> std::io::Result<Output> {
        let mut command = Command::new(programs().join(program));
        command.args(arguments).env("LC_ALL", "C").current_dir("/");
        if is_root() {
            command.uid(NOBODY).gid(NOBODY);
        }
        // Its server would hold pipes open.
        let folder = self.folder.as_ref().expect("a server of its own").path();
        let file = |name: &str| std::fs::OpenOptions::new().create(true).append(true).open(folder.join(name));
        command.stdout(file("said")?).stderr(file("said")?);
        let status = command.status()?;
        let stderr = std::fs::read(folder.join("said"))?;
        Ok(Output { status, stdout: Vec::new(), stderr })
    }
}

impl Drop for Postgres {
    fn drop(&mut self) {
        if let Some(folder) = &self.folder
            && folder.path().join("data/postmaster.pid").exists()
        {
            self.stop();
        }
    }
}

/// The server with which [`Postgres::again`] runs this test; `None` in its first run.
pub fn given() -> Option<Postgres> {
    std::env::var(GIVEN).ok().map(|url| Postgres { folder: None, url })
}

/// What a statement says in the database of that address.
pub fn psql(url: &str, statement: &str) -> String {
    let asked = Command::new("psql").args(["-qAtX", "-v", "ON_ERROR_STOP=1", "-c", statement, url]).output();
    told(&asked.unwrap())
}

fn told(output: &Output) -> String {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).trim().to_owned()
}

fn is_root() -> bool {
    use std::os::unix::fs::MetadataExt;
    std::fs::metadata("/proc/self").is_ok_and(|own| own.uid() == 0)
}

/// The folder of the server's programs: Debian leaves them out of the path.
fn programs() -> PathBuf {
    let told = Command::new("pg_config").arg("--bindir").output().ok().filter(|told| told.status.success());
    let named = told.map(|told| PathBuf::from(String::from_utf8_lossy(&told.stdout).trim()));
    let installed = std::fs::read_dir("/usr/lib/postgresql").into_iter().flatten().flatten();
    let newest = installed.map(|version| version.path().join("bin")).max_by_key(|folder| {
        let version = folder.parent().and_then(|version| version.file_name()?.to_str()?.parse::<u32>().ok());
        version.unwrap_or_default()
    });
    named.filter(|folder| folder.join("initdb").exists()).or(newest).unwrap_or_default()
}
