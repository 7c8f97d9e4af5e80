//! The same scenes give the same bits: every number that the program tells of some sixty scenes, in three kinds of
//! coordinates, by the integrators, treatments and analyses of the command line, against those kept in
//! `tests/data/corpus.txt`. Words may change, numbers may not.
//!
//! `TRIAD_WRITE_GOLDEN=1 cargo test --release -p triad-tests --test corpus` renews the file; do so only with a reason
//! that stands in the commit. `TRIAD_PROGRAM=old/triad` beside it renews it from another program.
//!
//! The last state of each scene's first run stands beside its digests, to tell a change of rounding from a change of motion.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use triad_tests::program::triad;
use triad_tests::root;

/// What is asked of each scene. `run` gets a place for its table besides.
const QUESTIONS: &[&str] = &[
    "run",
    "run --tolerance 1e-6 --no-skip all",
    "run --verify",
    "run --integrator taylor --tolerance 1e-12",
    "run --integrator dop853",
    "run --integrator dopri5 --tolerance 1e-6",
    "run --integrator ode45 --tolerance 1e-4",
    "run --integrator radau --tolerance 1e-6",
    "run --integrator rattle --step 0.02",
    "run --integrator dop853 --step 0.05",
    "run --integrator dop853 --treatment baumgarte --tolerance 1e-6",
    "run --integrator taylor --treatment baumgarte --tolerance 1e-6",
    "run --integrator dop853 --treatment partitioning",
    "run --integrator radau --treatment partitioning --tolerance 1e-6",
    "reactions --at 0.3",
    "reactions --on i --about origin --in body",
    "check",
    "equilibrium",
    "modes --at-start",
    "kinematics",
    "assemble",
];

/// Whole runs of built-in scenes, larger ones, the treatments that cannot follow every driver, and what covers many mechanisms at once.
const COMMANDS: &[&str] = &[
    "run simple-pendulum",
    "run n-four-bar:2",
    "run n-four-bar:40 --explain",
    "run spatial-chain:100 --until 1",
    "run spatial-double-pendulum --integrator dop853",
    "run free-body-flip",
    "run heavy-top",
    "run bricard",
    "run spatial-slider-crank",
    "run spatial-slider-crank:mbdyn --integrator radau",
    "run simple-pendulum --until 1 --integrator dopri5 --treatment penalty --tolerance 1e-4",
    "run bricard --until 1 --integrator dopri5 --treatment penalty --tolerance 1e-4",
    "run spatial-double-pendulum --until 1 --integrator dopri5 --treatment penalty --tolerance 1e-4",
    "run heavy-top --until 1 --integrator dopri5 --treatment penalty --tolerance 1e-4",
    "run simple-pendulum --until 1 --treatment augmented-lagrangian --step 0.02",
    "run bricard --until 1 --treatment augmented-lagrangian --step 0.02",
    "run spatial-double-pendulum --until 1 --treatment augmented-lagrangian --step 0.02",
    "run heavy-top --until 1 --treatment augmented-lagrangian --step 0.02",
    "modes spatial-double-pendulum",
    "modes n-four-bar:2",
    "stress --quick",
    "stress --case random --seeds 100 --from 1000",
];

/// FNV-1a, so that the file has sixteen digits for each answer.
struct Digest(u64);

impl Digest {
    fn add(&mut self, bytes: &[u8]) {
        for byte in bytes.iter().chain(&[0]) {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    /// Names and numbers of a document, and the stable codes of refusals; other texts may be worded anew. Times that
    /// the computing took, and the fingerprint of a scene's text, say nothing of its motion.
    fn document(&mut self, value: &Value) {
        match value {
            Value::Object(members) => {
                for (name, member) in
                    members.iter().filter(|(name, _)| !["seconds", "repeat"].contains(&&***name))
                {
                    self.add(name.as_bytes());
                    if name == "code" {
                        self.add(member.as_str().unwrap_or_default().as_bytes());
                    }
                    self.document(member);
                }
            }
            Value::Array(items) => items.iter().for_each(|item| self.document(item)),
            Value::String(_) => self.add(b"text"),
            other => self.add(other.to_string().as_bytes()),
        }
    }
}

/// What was told: a digest, and the last line of the table of a run.
fn ask(question: &str, scene: &str, folder: &Path) -> (String, Vec<f64>) {
    let table = folder.join("table.csv");
    let _ = std::fs::remove_file(&table);
    let mut command = Command::new(triad());
    let mut words = question.split(' ');
    command.arg("--json").args(words.next()).args((!scene.is_empty()).then_some(scene)).args(words);
    if question.starts_with("run") {
        command.arg("--out").arg(&table);
    }
    if !scene.is_empty() && question.starts_with("run") {
        command.args(["--until", "1", "--every", "0.25", "--most-steps", "200"]);
    }
    let output = command.current_dir(folder).stdin(Stdio::null()).output().unwrap();
    let mut digest = Digest(0xcbf2_9ce4_8422_2325);
    digest.add(output.status.code().unwrap().to_string().as_bytes());
    let said = String::from_utf8_lossy(&output.stdout);
    match serde_json::from_str(&said) {
        Ok(document) => digest.document(&document),
        Err(error) => panic!("{question} {scene}: {error}\n{said}"),
    }
    let table = std::fs::read_to_string(&table).unwrap_or_default();
    let lines: Vec<&str> = table.lines().filter(|line| !line.starts_with('#')).collect();
    for line in &lines {
        digest.add(line.as_bytes());
    }
    let last =
        lines.last().map_or(vec![], |line| line.split(',').filter_map(|x| x.parse().ok()).take(13).collect());
    (format!("{:016x}", digest.0), last)
}

/// The scenes of the corpus in each kind of coordinates, as name and text.
fn subjects() -> Vec<(String, String)> {
    let mut files: Vec<PathBuf> =
        root().join("tests/data/scenes").read_dir().unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let mut subjects = Vec::new();
    for file in files {
        let scene: Value = serde_json::from_slice(&std::fs::read(&file).unwrap()).unwrap();
        for coordinates in ["full", "reduced", "shared"] {
            let mut scene = scene.clone();
            scene["coordinates"] = coordinates.into();
            subjects
                .push((format!("{}/{coordinates}", file.file_stem().unwrap().display()), scene.to_string()));
        }
    }
    subjects
}

/// Does the work with as many threads as there are processors; answers in order.
fn beside_each_other<T: Sync, R: Send>(work: &[T], each: impl Fn(&T, &Path) -> R + Sync) -> Vec<R> {
    let next = std::sync::atomic::AtomicUsize::new(0);
    let done = std::sync::Mutex::new(BTreeMap::new());
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().unwrap().get() {
            scope.spawn(|| {
                let folder = tempfile::tempdir().unwrap();
                while let index = next.fetch_add(1, std::sync::atomic::Ordering::Relaxed)
                    && index < work.len()
                {
                    let answer = each(&work[index], folder.path());
                    done.lock().unwrap().insert(index, answer);
                }
            });
        }
    });
    done.into_inner().unwrap().into_values().collect()
}

/// Every line of the corpus: a subject with its digests and the last state of its first run.
fn lines() -> Vec<(String, Vec<String>, Vec<f64>)> {
    let mut lines = beside_each_other(&subjects(), |(name, scene), folder| {
        let file = folder.join("scene.json");
        std::fs::write(&file, scene).unwrap();
        let mut answers: Vec<_> =
            QUESTIONS.iter().map(|question| ask(question, file.to_str().unwrap(), folder)).collect();
        let last = std::mem::take(&mut answers[0].1);
        let digests = answers.into_iter().map(|(digest, _)| digest);
        (name.clone(), digests.collect(), last)
    });
    lines.extend(beside_each_other(COMMANDS, |command, folder| {
        let (digest, last) = ask(command, "", folder);
        (format!("`{command}`"), vec![digest], last)
    }));
    lines
}

#[test]
fn the_same_scenes_give_the_same_bits() {
    let file = root().join("tests/data/corpus.txt");
    let now = lines();
    let kept = std::fs::read_to_string(&file).unwrap_or_default();
    if std::env::var_os("TRIAD_WRITE_GOLDEN").is_some() {
        let mut text = String::new();
        for (name, digests, last) in &now {
            let numbers: Vec<String> = last.iter().map(f64::to_string).collect();
            writeln!(text, "{name} | {} | {}", digests.join(" "), numbers.join(" ")).unwrap();
        }
        std::fs::write(&file, text).unwrap();
        return;
    }
    let kept: BTreeMap<&str, &str> = kept.lines().filter_map(|line| line.split_once(" | ")).collect();
    let mut faults = Vec::new();
    for (name, digests, last) in &now {
        let (bits, numbers) = kept.get(&name[..]).and_then(|rest| rest.split_once(" |")).unwrap_or_default();
        let changed =
            digests.iter().zip(QUESTIONS).zip(bits.split(' ')).filter(|((now, _), then)| now != then);
        let changed: Vec<&str> = changed.map(|((_, question), _)| *question).collect();
        if changed.is_empty() && !bits.is_empty() {
            continue;
        }
        let numbers: Vec<f64> = numbers.split_whitespace().map(|x| x.parse().unwrap()).collect();
        let off = last.iter().zip(&numbers).map(|(now, then)| (now - then).abs()).fold(0.0, f64::max);
        faults.push(format!("{name}: other numbers in {changed:?}; its first run ends {off:.1e} away"));
    }
    assert_eq!(now.len(), kept.len(), "scenes or commands that the corpus does not have, or that have gone");
    assert!(faults.is_empty(), "{} of {} subjects differ:\n{}", faults.len(), now.len(), faults.join("\n"));
}
