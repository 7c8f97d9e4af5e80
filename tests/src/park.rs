//! Several servers and graders on one PostgreSQL, on machines that are killed, cut off and of another time.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, OnceLock};
use std::time::{Duration, Instant, SystemTime};

use crate::cable::Cable;
use crate::network::Namespace;
use crate::postgres::Postgres;
use crate::program::{HANG, triad};

const SERVERS: usize = 3;
const GRADERS: usize = 4;
/// The time between two kills.
const LIFE: Duration = Duration::from_millis(250);
/// How long nothing comes through: longer than the leases of the graders.
const STALL: Duration = Duration::from_secs(3);

/// Debian's package of that name.
const FAKETIME: &str = "/usr/lib/x86_64-linux-gnu/faketime/libfaketime.so.1";

/// A program that was killed.
#[derive(Debug, Clone, Copy)]
pub struct Killed {
    /// Its number.
    pub id: u32,
    /// When, in milliseconds since 1970.
    pub at: i64,
    /// Whether it was a grader.
    pub is_grader: bool,
}

/// Where a program runs.
#[derive(Debug, Clone)]
struct Machine {
    /// By which address it finds the database.
    url: String,
    /// How far its clock is off, in words of faketime.
    clock: Option<&'static str>,
    /// Its network, where it has one of its own.
    network: Option<Arc<Namespace>>,
}

/// What joins machines to the database: a network that is cut, where this machine lets a test make one, and a cable that is held up.
#[derive(Debug)]
struct Wires {
    network: Option<Arc<Namespace>>,
    by_network: String,
    cable: Cable,
    by_cable: String,
}

impl Wires {
    fn of(postgres: &Postgres, url: &str) -> Self {
        let network = match Namespace::make() {
            Ok(network) => Some(Arc::new(network)),
            Err(missing) => {
                println!("left out: a network that is cut, a cable is held up in its place: {missing}");
                None
            }
        };
        let (cable, by_cable) = postgres.by_cable(url);
        let by_network = network.as_ref().map(|network| postgres.at(&network.here, url));
        Self { network, by_network: by_network.unwrap_or_else(|| by_cable.clone()), cable, by_cable }
    }

    /// So many machines: of the first the clock is an hour fast, the second is joined by a network that is cut, of the third the
    /// clock is an hour slow, to the fourth leads a cable that is held up.
    fn machines(&self, count: usize, url: &str) -> Vec<Machine> {
        let is_there = Path::new(FAKETIME).exists();
        let url = |k: usize| [url, &self.by_network, url, self.by_cable.as_str()][k].to_owned();
        let machine = |k: usize| Machine {
            url: url(k),
            clock: [Some("+60m"), None, Some("-60m"), None][k].filter(|_| is_there),
            network: self.network.clone().filter(|_| k == 1),
        };
        (0..count).map(machine).collect()
    }

    /// Nothing comes through for a while, without a word to anybody.
    fn lose(&self, time: Duration) {
        if let Some(network) = &self.network {
            network.cut();
        }
        self.cable.hold_up(time);
        if let Some(network) = &self.network {
            network.mend();
        }
    }
}

/// A program that is killed and started again.
#[derive(Debug)]
struct Process {
    child: Child,
    /// What it says once it has started: a server where it listens.
    said: Arc<OnceLock<String>>,
}

impl Process {
    fn start(is_grader: bool, machine: &Machine, folder: &Path) -> Self {
        let at = machine.network.as_ref();
        let mut command = at.map_or_else(|| Command::new(triad()), |network| network.command(triad()));
        if let Some(clock) = machine.clock {
            // What is waited for by the program itself takes as long as ever.
            command
                .env("LD_PRELOAD", FAKETIME)
                .env("FAKETIME", clock)
                .env("FAKETIME_DONT_FAKE_MONOTONIC", "1");
        }
        // Nothing is answered at once: all of it goes through the queue.
        command.args(if is_grader {
            ["grader", "--slots", "2", "--lease", "2"]
        } else {
            ["serve", "--port", "0", "--at-once", "0"]
        });
        if let Some(network) = at.filter(|_| !is_grader) {
            command.args(["--open", "--host", &network.there]);
        }
        command.args(["--database", &machine.url]).current_dir(folder).stdin(Stdio::null());
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap());
        let said = Arc::new(OnceLock::new());
        let heard = Arc::clone(&said);
        std::thread::spawn(move || {
            let mut line = String::new();
            // Where the database is away as it starts it ends without a word here.
            if lines.read_line(&mut line).is_ok_and(|length| length > 0) {
                drop(heard.set(line));
            }
            drop(std::io::copy(&mut lines, &mut std::io::sink()));
        });
        Self { child, said }
    }

    /// Whether it is up, or has ended by itself.
    fn has_started(&mut self) -> bool {
        self.said.get().is_some() || self.child.try_wait().is_ok_and(|ended| ended.is_some())
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        drop(self.child.kill());
        drop(self.child.wait());
    }
}

/// A place where a program runs, one after the other.
#[derive(Debug)]
struct Place {
    is_grader: bool,
    machine: Machine,
    process: Mutex<Process>,
}

/// Three servers and four graders of one database. They end with this.
#[derive(Debug)]
pub struct Park {
    places: Vec<Place>,
    wires: Wires,
    folder: PathBuf,
    stop: AtomicBool,
}

impl Park {
    /// Starts them on a database; what they write beside it goes into a folder. What this machine cannot do is said in a line.
    pub fn start(postgres: &Postgres, url: &str, folder: &Path) -> Self {
        if !Path::new(FAKETIME).exists() {
            println!(
                "left out: clocks that are off: faketime is not installed (Debian: apt-get install libfaketime)"
            );
        }
        let wires = Wires::of(postgres, url);
        let mut places: Vec<Place> = Vec::new();
        for (is_grader, count) in [(false, SERVERS), (true, GRADERS)] {
            for machine in wires.machines(count, url) {
                let process = Process::start(is_grader, &machine, folder);
                if places.is_empty() {
                    // The first makes the tables.
                    let began = Instant::now();
                    while process.said.get().is_none() {
                        assert!(began.elapsed() < HANG, "no server starts");
                        std::thread::sleep(Duration::from_millis(10));
                    }
                }
                places.push(Place { is_grader, machine, process: Mutex::new(process) });
            }
        }
        Self { places, wires, folder: folder.to_owned(), stop: AtomicBool::new(false) }
    }

    /// Servers in all.
    pub fn servers(&self) -> usize {
        self.places.iter().filter(|place| !place.is_grader).count()
    }

    /// Where a server listens; `None` while it starts.
    pub fn address(&self, server: usize) -> Option<String> {
        let said = Arc::clone(&self.places[server].process.lock().unwrap().said);
        let at = said.get()?.split("http://").nth(1)?;
        at.split_whitespace().next().map(str::to_owned)
    }

    /// Lets all go on in peace.
    pub fn rest(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    fn is_at_rest(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// Kills one after the other, in an order without a rhythm, and starts another in its place, until they [rest](Self::rest). Who is
    /// starting on a busy machine is left to it.
    pub fn kill(&self) -> Vec<Killed> {
        let (mut killed, mut due) = (Vec::new(), Instant::now());
        for turn in 0.. {
            due += LIFE;
            std::thread::sleep(due.saturating_duration_since(Instant::now()));
            if self.is_at_rest() {
                break;
            }
            let which = (f64::from(turn) * 0.618_034).fract() * self.places.len() as f64;
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // one of the places
            let Place { is_grader, machine, process } = &self.places[which as usize];
            let mut process = process.lock().unwrap();
            if !process.has_started() {
                continue;
            }
            let id = process.child.id();
            drop(process.child.kill());
            drop(process.child.wait());
            killed.push(Killed { id, at: now(), is_grader: *is_grader });
            *process = Process::start(*is_grader, machine, &self.folder);
        }
        killed
    }

    /// Ends connections, and lets nothing through for longer than leases last, in turns, until they [rest](Self::rest); how often.
    pub fn disturb(&self) -> u32 {
        let mut cuts = 0;
        while !self.is_at_rest() {
            std::thread::sleep(2 * LIFE);
            self.wires.cable.hold_up(3 * LIFE);
            self.wires.cable.cut();
            std::thread::sleep(2 * LIFE);
            self.wires.lose(STALL);
            cuts += 1;
        }
        cuts
    }
}

/// The time, in milliseconds since 1970.
fn now() -> i64 {
    let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap();
    i64::try_from(since.as_millis()).unwrap()
}
