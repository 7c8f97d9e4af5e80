//! Built-in scenes against references that were made with minimal coordinates or closed forms.
#![allow(clippy::unwrap_used, reason = "tests may panic")]

use crate::common::table;
use triad_engine::catalogue;
use triad_engine::run::{Frame, Simulation};
use triad_engine::scene::Coordinates;

/// Largest deviation of `ours` from columns of a reference, over its whole duration, with a tight tolerance.
fn deviation(
    scene: &str,
    coordinates: Coordinates,
    reference: &str,
    columns: &[&str],
    ours: impl Fn(&Frame) -> Vec<f64>,
) -> f64 {
    let mut scene = catalogue::scene(scene).unwrap();
    scene.coordinates = coordinates;
    scene.simulation.tolerance = 1e-11;
    let mut simulation = Simulation::new(&scene).unwrap();
    let (names, rows) = table(reference);
    let places: Vec<usize> = columns.iter().map(|c| names.iter().position(|n| n == c).unwrap()).collect();
    let mut largest = 0.0f64;
    for row in &rows {
        simulation.advance_to(row[0]).unwrap();
        assert!((simulation.time() - row[0]).abs() < 1e-12, "the reference is longer than the run");
        for (place, value) in places.iter().zip(ours(&simulation.frame())) {
            largest = largest.max((row[*place] - value).abs());
        }
    }
    assert!(rows.len() > 20);
    println!("{} {coordinates:?}: {largest:.2e}", scene.name);
    largest
}

/// Each kind of body coordinates.
const KINDS: [Coordinates; 3] = [Coordinates::Full, Coordinates::Reduced, Coordinates::Shared];

#[test]
fn the_falling_body_follows_its_reference() {
    for kind in KINDS {
        let columns = ["x", "y", "z[m]", "px", "py", "pz[m]"];
        let found = deviation("free-fall", kind, include_str!("../data/free-fall.csv"), &columns, |frame| {
            let body = &frame.bodies[0];
            let point =
                [0, 1, 2].map(|k| body.position[k] + 0.3 * body.u[k] - 0.2 * body.v[k] + 0.5 * body.w[k]);
            [body.position, point].concat()
        });
        assert!(found < 1e-10, "{found:e}");
    }
}

#[test]
fn the_heavy_top_follows_its_scalar_equation() {
    for kind in KINDS {
        let columns = ["rx[m]", "ry", "rz", "px[m]", "py", "pz"];
        let found = deviation("heavy-top", kind, include_str!("../data/heavy-top.csv"), &columns, |frame| {
            let top = &frame.bodies[0];
            let rim = [0, 1, 2].map(|k| top.position[k] + 0.15 * top.u[k]);
            [top.position, rim].concat()
        });
        assert!(found < 1e-9, "{found:e}");
    }
}
