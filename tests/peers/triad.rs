//! Triad as one of the programs that `run.py` compares: it answers requests from standard input, one a line.
//!
//! `triad-peer SCENE DURATION`, then lines `REPEATS FILE NAME=VALUE …`. FILE gets times and points as doubles (`-`: no
//! file); the answer is `{"times": […]}` in processor seconds of integration alone, or `{"error": "…"}`.

use std::error::Error;
use std::io::{BufRead, Write};
use std::time::Instant;

use serde_json::{Value, json};
use triad_engine::catalogue;
use triad_engine::run::{Frame, Simulation};
use triad_engine::scene::Scene;

/// Samples a second.
const RATE: f64 = 100.0;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [name, duration] = arguments.as_slice() else {
        return Err("usage: triad-peer SCENE DURATION".into());
    };
    let mut scene = catalogue::scene(name)?;
    scene.simulation.duration = duration.parse()?;
    for line in std::io::stdin().lock().lines() {
        let answer =
            measure(name, &mut scene, &line?).unwrap_or_else(|error| json!({ "error": error.to_string() }));
        println!("{answer}");
        std::io::stdout().flush()?;
    }
    Ok(())
}

/// Answers one request.
fn measure(name: &str, scene: &mut Scene, line: &str) -> Result<Value, Box<dyn Error>> {
    let mut words = line.split_whitespace();
    let repeats: usize = words.next().ok_or("how many repeats?")?.parse()?;
    let file = words.next().ok_or("which file?")?;
    for word in words {
        match word.split_once('=').ok_or("a setting is NAME=VALUE")? {
            ("integrator", value) => scene.simulation.integrator = serde_json::from_value(json!(value))?,
            ("tolerance", value) => scene.simulation.tolerance = value.parse()?,
            (other, _) => return Err(format!("there is no setting {other}").into()),
        }
    }
    let mut simulation = Simulation::new(scene)?;
    if file != "-" {
        std::fs::write(file, points(name, &mut simulation)?)?;
    }
    let mut times = Vec::with_capacity(repeats);
    for _ in 0..repeats {
        simulation.reset();
        let start = Clock::start();
        simulation.advance_to(simulation.duration())?;
        times.push(start.seconds());
    }
    Ok(json!({ "times": times }))
}

/// A stopwatch of processor time, so that other work on the machine does not count.
enum Clock {
    /// Nanoseconds on the processor at the start, as Linux counts them.
    Processor(u64),
    /// Elsewhere: the time of day, which needs a quiet machine.
    Wall(Instant),
}

impl Clock {
    fn start() -> Self {
        processor_time().map_or_else(|| Self::Wall(Instant::now()), Self::Processor)
    }

    fn seconds(&self) -> f64 {
        match self {
            Self::Processor(start) => processor_time().unwrap_or(*start).abs_diff(*start) as f64 * 1e-9,
            Self::Wall(start) => start.elapsed().as_secs_f64(),
        }
    }
}

/// Nanoseconds that this thread has run, if the system tells.
fn processor_time() -> Option<u64> {
    // Giving way once makes the system bring its count up to date.
    std::thread::yield_now();
    std::fs::read_to_string("/proc/thread-self/schedstat").ok()?.split_whitespace().next()?.parse().ok()
}

/// Times and compared points of a run, as the bytes of doubles.
fn points(name: &str, simulation: &mut Simulation) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut bytes = Vec::new();
    let mut sample = 0_u32;
    loop {
        let time = f64::from(sample) / RATE;
        if time > simulation.duration() + 1e-9 {
            return Ok(bytes);
        }
        simulation.advance_to(time.min(simulation.duration()))?;
        let frame = simulation.frame();
        for number in [time].into_iter().chain(compared(name, &frame)) {
            bytes.extend(number.to_le_bytes());
        }
        sample += 1;
    }
}

/// The points of a scene that are compared.
fn compared(scene: &str, frame: &Frame) -> Vec<f64> {
    // Rods have their ends half a metre along u; the rim of the top is 0.15 m away.
    let offsets: &[f64] = match scene {
        "simple-pendulum" => &[0.0],
        "heavy-top" => &[0.0, 0.15],
        _ => &[0.5],
    };
    let bodies = if scene.starts_with("n-four-bar") { 1 } else { frame.bodies.len() };
    let ends = frame.bodies.iter().take(bodies).flat_map(|body| {
        offsets.iter().flat_map(move |offset| [0, 1, 2].map(|k| body.position[k] + offset * body.u[k]))
    });
    ends.collect()
}
