//! The bits of results, one line for each scene and question: `cargo run --release -p triad-lab --example bits`.
//!
//! `cargo verify bits` compares what two builds print, one for any x86-64 processor and one for those with AVX2 and FMA.
//! The scenes are those of `tests/data/scenes`, with all kinds of joints, drivers and loads.

use std::error::Error;
use std::fmt::{Debug, Write as _};
use std::path::Path;
use triad_engine::analysis::{ModesAbout, equilibrium, kinematics, modes};
use triad_engine::reactions::report::Convention;
use triad_engine::run::Simulation;
use triad_engine::scene::{IntegratorKind, Scene};

/// What is run, for a part of a second and at most so many steps each.
const INTEGRATORS: [IntegratorKind; 3] =
    [IntegratorKind::Taylor, IntegratorKind::Dop853, IntegratorKind::Radau];
const DURATION: f64 = 0.3;
const MOST_STEPS: u64 = 60;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/scenes");
    let mut files =
        folder.read_dir()?.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>, std::io::Error>>()?;
    files.sort();
    for file in files {
        let mut scene = Scene::from_json(&std::fs::read_to_string(&file)?)?;
        let name = file.file_stem().unwrap_or_default().display();
        for integrator in INTEGRATORS {
            scene.simulation.integrator = integrator;
            println!("{name} {integrator} {:016x}", digest(&run(&scene)));
        }
        println!("{name} kinematics {:016x}", digest(&kinematics(&scene, Convention::default())));
        println!("{name} equilibrium {:016x}", digest(&equilibrium(&scene)));
        println!("{name} modes {:016x}", digest(&modes(&scene, ModesAbout::Start)));
    }
    Ok(())
}

/// Everything that a run tells at its end, or why it has none.
fn run(scene: &Scene) -> Result<String, triad_engine::EngineError> {
    let mut run = Simulation::new(scene)?;
    for _ in 0..MOST_STEPS {
        if run.time() < DURATION {
            run.step()?;
        }
    }
    let mut text = String::new();
    let _ = write!(text, "{:?} {:?}", run.frame(), run.summary());
    let _ = write!(text, "{:?} {:?}", run.accelerations(), run.reactions(Convention::default()));
    Ok(text)
}

/// FNV-1a of how a value is written, in which different numbers are different texts.
fn digest(value: &impl Debug) -> u64 {
    let text = format!("{value:?}");
    text.bytes()
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}
