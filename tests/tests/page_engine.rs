//! The engine of the page beside the one of this machine: the same requests, answered by WebAssembly in Node. Their last
//! digits differ, as products are rounded twice there; the motions lie within the errors that both tell.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use std::path::PathBuf;
use std::process::Command;

use serde_json::{Value, json};
use triad_engine::catalogue;
use triad_tests::root;
use triad_web::desk::Desk;

/// Scenes and the end of their runs, s.
const RUNS: [(&str, f64); 7] = [
    ("n-four-bar:2", 2.0),
    ("simple-pendulum", 3.0),
    ("spatial-slider-crank", 1.0),
    ("bricard", 1.0),
    ("heavy-top", 0.5),
    ("spatial-double-pendulum", 1.0),
    ("spatial-chain:5", 0.5),
];
/// What rounding alone may make of numbers of the size of these mechanisms, m: errors that are told may be below it.
const ROUNDING: f64 = 1e-13;
/// How far forces may lie beyond what is told of them, which is an estimate and no bound. 1.6 are seen, where the four-bar has just
/// passed its singular position: a motion's error across the constraints, 10⁻¹² m within a step, counts there by one over the
/// distance, and what is told of each run is right up to a factor of 2.2 (six tolerances beside one of 10⁻¹⁴), elsewhere of 1.3.
/// Both choose the same steps up to their last digits.
const FORCES: f64 = 2.5;
/// The same of positions. Where the energy holds what is told it is right to some hundredths, and two runs that are off to both sides are as far apart
/// as both errors together.
const POSITIONS: f64 = 1.1;
/// The largest engine, packed as browsers get it, bytes.
const LARGEST: f64 = 1.55e6;

/// The engine as the program's build made it, or the one that is named; says in one line where there is none.
fn engine() -> Option<PathBuf> {
    let named = std::env::var_os("TRIAD_ENGINE_WASM").map(PathBuf::from);
    let built = || {
        let test = std::env::current_exe().unwrap();
        // …/target/release/deps/page_engine-…
        let target = test.ancestors().nth(3)?.to_owned();
        Some(target.join("engine/wasm32-unknown-unknown/release/triad_web.wasm"))
    };
    let found = named.or_else(built).filter(|file| file.exists());
    if found.is_none() {
        println!(
            "NOT CHECKED: the page's engine is not built: rustup target add wasm32-unknown-unknown, then cargo build --release"
        );
    }
    found
}

/// The answers of WebAssembly, by Node.
fn of_page(engine: &PathBuf, requests: &[Value]) -> Vec<Value> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("requests");
    let lines: Vec<String> = requests.iter().map(Value::to_string).collect();
    std::fs::write(&file, lines.join("\n")).unwrap();
    let script = root().join("tests/browser/engine.mjs");
    let output = Command::new("node").arg(script).arg(engine).arg(file).output();
    let output =
        output.unwrap_or_else(|error| panic!("node: {error}; `cargo verify setup` names what is missing"));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines()
        .map(|line| {
            let found: Value = serde_json::from_str(line).unwrap();
            assert_eq!(found["status"], 200, "{found}");
            serde_json::from_str(found["body"].as_str().unwrap()).unwrap()
        })
        .collect()
}

/// The answers of this machine.
fn of_machine(requests: &[Value]) -> Vec<Value> {
    let mut desk = Desk::default();
    let answer = |request: &Value| {
        desk.take(request.to_string().as_bytes(), 0.0);
        loop {
            if let Some(message) = desk.next_message() {
                let end = message.iter().position(|byte| *byte == b'\n').unwrap();
                return serde_json::from_slice(&message[end + 1..]).unwrap();
            }
            desk.work(0.0);
        }
    };
    requests.iter().map(answer).collect()
}

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(parts) => parts.iter().flat_map(numbers).collect(),
        Value::Number(number) => vec![number.as_f64().unwrap()],
        Value::Null => vec![f64::NAN],
        _ => panic!("no numbers: {value}"),
    }
}

/// The largest distance of two lists of points, and the largest number among them.
fn distance(one: &Value, other: &Value) -> (f64, f64) {
    let (one, other) = (numbers(one), numbers(other));
    assert_eq!((one.len(), one.len() % 3), (other.len(), 0));
    let between =
        |(a, b): (&[f64], &[f64])| a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
    let apart = one.chunks(3).zip(other.chunks(3)).map(between).fold(0.0, f64::max);
    (apart, one.iter().map(|x| x.abs()).fold(1.0, f64::max))
}

#[test]
fn its_motions_lie_within_the_errors_that_are_told() {
    let Some(engine) = engine() else { return };
    let requests: Vec<Value> = (1..)
        .zip(RUNS)
        .map(|(id, (name, until))| {
            let scene = catalogue::scene(name).unwrap();
            let body = json!({"scene": scene, "overrides": {"duration": until}});
            json!({"id": id, "method": "POST", "path": "/run", "body": body})
        })
        .collect();
    let mut other_bits = 0;
    for ((name, _), (page, machine)) in
        RUNS.iter().zip(of_page(&engine, &requests).iter().zip(of_machine(&requests)))
    {
        assert_eq!(page["time"], machine["time"], "{name}");
        let forces = ("joints", "force_error", "force", 1e3 * ROUNDING, FORCES);
        // Of redundant rows no forces are told: any share of them is as good.
        let forces = Some(forces).filter(|_| *name != "bricard");
        for (what, error, members, rounding, margin) in
            [("bodies", "position_error", "position", ROUNDING, POSITIONS)].into_iter().chain(forces)
        {
            let (told_there, told_here) = (numbers(&page[error]), numbers(&machine[error]));
            let known = told_there.iter().zip(&told_here).filter(|(a, b)| (**a + **b).is_finite()).count();
            assert!(
                2 * known > told_here.len(),
                "{name} tells {error} at {known} times of {}",
                told_here.len()
            );
            for (one, other) in machine[what].as_array().unwrap().iter().zip(page[what].as_array().unwrap()) {
                for (frame, told) in told_there.iter().zip(&told_here).map(|(a, b)| a + b).enumerate() {
                    let (apart, size) = distance(&one[members][frame], &other[members][frame]);
                    // Where an error is not told, nothing is promised.
                    assert!(
                        told.is_nan() || apart <= margin * told + rounding * size,
                        "{name}, {members} at {}: {apart:.1e}, {told:.1e} told",
                        machine["time"][frame]
                    );
                    other_bits += usize::from(apart > 0.0);
                }
            }
        }
        println!("{name}: {} steps there, {} here", page["steps"], machine["steps"]);
    }
    assert!(other_bits > 0, "the bits of both are equal: this compares an engine with itself");
}

#[test]
fn its_live_runs_answer_as_the_servers_do() {
    let Some(engine) = engine() else { return };
    let ask = |id: u32, method: &str, path: &str, body: Value| json!({"id": id, "method": method, "path": path, "body": body});
    let requests = [
        ask(1, "POST", "/sessions", json!({"builtin": "n-four-bar:2"})),
        ask(2, "POST", "/sessions/here-1/step", json!({"seconds": 0.3})),
        ask(
            3,
            "POST",
            "/sessions/here-1/parameters",
            json!({"places": {"/bodies/0/mass": 2}, "then": "continue"}),
        ),
        ask(4, "POST", "/sessions/here-1/step", json!({"seconds": 0.1})),
        ask(5, "GET", "/sessions/here-1/reactions?at=0.1", Value::Null),
        ask(6, "GET", "/sessions/here-1/jacobian", Value::Null),
        ask(7, "GET", "/sessions/here-1/scene", Value::Null),
        ask(8, "POST", "/analyses/modes", json!({"scene": catalogue::scene("simple-pendulum").unwrap()})),
        ask(9, "POST", "/check", json!(catalogue::scene("bricard").unwrap())),
        ask(10, "GET", "/scenes", Value::Null),
    ];
    for ((page, machine), request) in
        of_page(&engine, &requests).iter().zip(of_machine(&requests)).zip(&requests)
    {
        same_shape(page, &machine, request["path"].as_str().unwrap());
    }
}

/// The same members, words and whole numbers; other numbers are near.
fn same_shape(one: &Value, other: &Value, place: &str) {
    match (one, other) {
        (Value::Object(one), Value::Object(other)) => {
            assert_eq!(one.keys().collect::<Vec<_>>(), other.keys().collect::<Vec<_>>(), "{place}");
            for (key, value) in one {
                // Estimates of errors and residuals are rounding themselves.
                let rounding =
                    ["accuracy", "position_violation", "velocity_violation", "energy_drift", "error"];
                if !rounding.contains(&key.as_str()) {
                    same_shape(value, &other[key], &format!("{place}/{key}"));
                }
            }
        }
        (Value::Array(one), Value::Array(other)) => {
            assert_eq!(one.len(), other.len(), "{place}");
            one.iter().zip(other).for_each(|(one, other)| same_shape(one, other, place));
        }
        (Value::Number(one), Value::Number(other)) => {
            let (one, other) = (one.as_f64().unwrap(), other.as_f64().unwrap());
            assert!((one - other).abs() <= 1e-5 * (1.0 + one.abs()), "{place}: {one} {other}");
        }
        _ => assert_eq!(one, other, "{place}"),
    }
}

/// How often an instruction is in the engine: its bytes, which hardly anything else has.
fn count(engine: &[u8], instruction: &[u8]) -> usize {
    engine.windows(instruction.len()).filter(|bytes| *bytes == instruction).count()
}

/// What made it fast: numbers are compared by vectors (`f64x2.pmax`), and what is small is not copied or cleared by functions
/// of the browser (`memory.copy`, `memory.fill`). Left to itself the compiler writes 0 of the first and 3548 and 1038 of these.
#[test]
fn its_loops_stay_within_compiled_code() {
    let Some(engine) = engine() else { return };
    let engine = std::fs::read(engine).unwrap();
    let [compared, copied, cleared] =
        [&[0xfd, 0xf7, 0x01][..], &[0xfc, 0x0a, 0, 0], &[0xfc, 0x0b, 0]].map(|bytes| count(&engine, bytes));
    println!("{compared} comparisons by vectors, {copied} copies and {cleared} clearings by the browser");
    assert!(compared > 100 && copied < 2500 && cleared < 550);
}

#[test]
fn it_is_small() {
    let Some(engine) = engine() else { return };
    // Packed as the page's build packs it.
    let pack = "const z = require('zlib'), options = { params: { [z.constants.BROTLI_PARAM_QUALITY]: 9 } };
        console.log(z.brotliCompressSync(require('fs').readFileSync(process.argv[1]), options).length)";
    let output = Command::new("node").args(["-e", pack]).arg(engine).output().unwrap();
    let bytes: f64 = String::from_utf8(output.stdout).unwrap().trim().parse().unwrap();
    println!("the engine has {:.2} MB packed", bytes / 1e6);
    assert!(bytes < LARGEST, "{bytes} bytes");
}
