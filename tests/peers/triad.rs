//! Triad as one of the programs that `run.py` compares: it answers requests from standard input, one a line.
//!
//! `triad-peer SCENE DURATION`, where SCENE is a built-in one or a file, then lines `REPEATS FILE NAME=VALUE …`. FILE gets times
//! and points as doubles (`-`: no file), 100 times a second unless `samples=N` asks for N of equal distances; `estimate=false` leaves
//! out the estimate of errors. The answer is `{"times": […]}` in processor seconds of integration alone, or `{"error": "…"}`.

use std::error::Error;
use std::io::{BufRead, Write};
use std::path::Path;
use std::time::Instant;

use serde_json::{Value, json};
use triad_engine::EngineError;
use triad_engine::catalogue;
use triad_engine::run::{Frame, Simulation};
use triad_engine::scene::Scene;

/// Samples a second.
const RATE: f64 = 100.0;
/// Shortest batch of runs, s: reading the clock takes a thousandth of it.
const BATCH: f64 = 0.02;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [name, duration] = arguments.as_slice() else {
        return Err("usage: triad-peer SCENE DURATION".into());
    };
    let mut scene = if Path::new(name).extension().is_some_and(|kind| kind == "json") {
        Scene::from_json(&std::fs::read_to_string(name)?)?
    } else {
        catalogue::scene(name)?
    };
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
    let mut samples = (RATE * scene.simulation.duration).round();
    scene.simulation.error_estimate = true;
    for word in words {
        match word.split_once('=').ok_or("a setting is NAME=VALUE")? {
            ("integrator", value) => scene.simulation.integrator = serde_json::from_value(json!(value))?,
            ("tolerance", value) => scene.simulation.tolerance = value.parse()?,
            ("samples", value) => samples = value.parse()?,
            ("estimate", value) => scene.simulation.error_estimate = value.parse()?,
            (other, _) => return Err(format!("there is no setting {other}").into()),
        }
    }
    let mut simulation = Simulation::new(scene)?;
    if file != "-" {
        std::fs::write(file, points(name, &mut simulation, samples)?)?;
    }
    let mut times = Vec::with_capacity(repeats);
    for _ in 0..repeats {
        times.push(batch(&mut simulation)?);
    }
    Ok(json!({ "times": times }))
}

/// Processor seconds of one run: the mean of a batch so long that the clock's own time does not count, less the time of
/// going back to the start as often.
fn batch(simulation: &mut Simulation) -> Result<f64, Box<dyn Error>> {
    let mut count = 1;
    loop {
        let whole = timed(count, simulation, |run| run.advance_to(run.duration()))?;
        if whole >= BATCH {
            let resets = timed(count, simulation, |_| Ok(()))?;
            return Ok((whole - resets) / f64::from(count));
        }
        // The first runs warm the caches.
        count *= 4;
    }
}

/// Seconds for doing something so often, each time from the start.
fn timed(
    count: u32,
    simulation: &mut Simulation,
    act: impl Fn(&mut Simulation) -> Result<(), EngineError>,
) -> Result<f64, Box<dyn Error>> {
    let start = Clock::start();
    for _ in 0..count {
        simulation.reset();
        act(simulation)?;
    }
    Ok(start.seconds())
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
fn points(name: &str, simulation: &mut Simulation, samples: f64) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut bytes = Vec::new();
    let mut sample = 0.0;
    while sample <= samples {
        let time = simulation.duration() * sample / samples;
        simulation.advance_to(time)?;
        let frame = simulation.frame();
        for number in [time].into_iter().chain(compared(name, &frame)) {
            bytes.extend(number.to_le_bytes());
        }
        sample += 1.0;
    }
    Ok(bytes)
}

/// The points of a scene that are compared.
fn compared(scene: &str, frame: &Frame) -> Vec<f64> {
    // Files are the problems of `dae.hpp`.
    if scene.contains("squeezer") {
        return frame.bodies[0].u[..2].to_vec();
    }
    if scene.contains("governor") {
        return vec![frame.bodies[1].position[2], -frame.bodies[2].u[2]];
    }
    if scene.contains("car-axis") {
        let chassis = &frame.bodies[2];
        return [-0.5, 0.5]
            .iter()
            .flat_map(|half| [0, 1].map(|k| chassis.position[k] + half * chassis.u[k]))
            .collect();
    }
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
