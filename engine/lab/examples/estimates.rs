//! Statistics of error estimates: `cargo run --release -p triad-lab --example estimates [seeds [file …]]`.
//!
//! For each tolerance: how many estimates are within a factor of three of the error, how many below a tenth of it, and the worst.

use triad_engine::scene::Scene;
use triad_lab::estimates::{Judged, judge, scenes};

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let seeds = arguments.first().and_then(|text| text.parse().ok()).unwrap_or(100);
    let mut all = scenes(seeds);
    for path in arguments.iter().skip(1) {
        match std::fs::read_to_string(path).ok().and_then(|text| Scene::from_json(&text).ok()) {
            Some(mut scene) => {
                scene.name.clone_from(path);
                all.push(scene);
            }
            None => eprintln!("{path} is no scene"),
        }
    }
    for tolerance in [1e-3, 1e-4, 1e-6, 1e-8, 1e-9, 1e-10] {
        let mut judged: Vec<Judged> = Vec::new();
        for scene in &all {
            match judge(&scene.clone().tolerance(tolerance)) {
                Ok(found) => judged.extend(found),
                Err(error) => eprintln!("{}: {error}", scene.name),
            }
        }
        let count = |which: fn(&Judged) -> bool| judged.iter().filter(|&one| which(one)).count();
        let (good, bad) = (count(Judged::is_good), count(Judged::is_bad));
        let share = 100.0 * good as f64 / judged.len().max(1) as f64;
        println!("{tolerance:.0e}: {share:.1} of 100 within three, {bad} of {} below a tenth", judged.len());
        judged.sort_by(|a, b| (a.estimate / a.error).total_cmp(&(b.estimate / b.error)));
        let worst = judged.iter().take(6).chain(judged.iter().rev().take(3));
        for Judged { scene, time, estimate, error, .. } in worst {
            println!("    {scene} at {time:.3} s: {estimate:.1e} for {error:.1e}");
        }
    }
}
