//! Built-in scenes with references from outside: `tests/data/problems`.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use std::path::Path;
use triad_engine::catalogue;
use triad_engine::prelude::*;

/// The rows of a reference that have numbers.
fn rows(name: &str) -> Vec<Vec<f64>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/problems").join(name);
    let text = std::fs::read_to_string(path).unwrap();
    let read =
        |line: &str| line.split(',').map(|field| field.trim().parse().ok()).collect::<Option<Vec<f64>>>();
    let rows: Vec<_> = text.lines().filter_map(read).collect();
    assert!(rows.len() > 30, "{name}");
    rows
}

fn motion(name: &str) -> Solution {
    let scene = catalogue::scene(name).unwrap();
    scene.simulate(0.0..scene.simulation.duration).unwrap()
}

/// The markers F, E, G and H against the series of one coordinate.
#[test]
fn the_squeezer_from_both_starts() {
    for (scene, reference) in
        [("squeezer", "squeezer/reference.csv"), ("squeezer:ivp", "squeezer/reference-ivp.csv")]
    {
        let motion = motion(scene);
        for row in rows(reference) {
            let state = motion.at(row[0]).unwrap();
            for (column, marker) in [(4, "F"), (6, "E"), (8, "G"), (10, "H")] {
                let [x, y, _] = state.marker(marker).unwrap().position;
                let off = (x - row[column]).abs().max((y - row[column + 1]).abs());
                assert!(off < 2e-9, "{scene}: {marker} is {off:.1e} m off at {} s", row[0]);
            }
        }
    }
}

/// Balls attached to the arms, and the rate of the bearing alone, make the motion of three coordinates.
#[test]
fn the_governor_from_the_rate_of_its_shaft() {
    let motion = motion("governor");
    for row in rows("governor/reference.csv") {
        let [t, s, alpha, psi] = [row[0], row[1], row[4], row[7]];
        let state = motion.at(t).unwrap();
        let ball = state.marker("ball").unwrap().position;
        let radius = 0.05 + libm::cos(alpha);
        let wanted = [radius * libm::cos(psi), radius * libm::sin(psi), 1.0 - libm::sin(alpha)];
        let off = (0..3).map(|k| (ball[k] - wanted[k]).abs()).fold(0.0, f64::max);
        assert!(off < 1e-8, "the ball is {off:.1e} m off at {t} s");
        assert!((state.marker("collar").unwrap().position[2] - s).abs() < 1e-8, "at {t} s");
    }
}

/// The axle follows asin(0.1 sin 10 t), a formula.
#[test]
fn the_car_axis_over_its_road() {
    let motion = motion("car-axis");
    for row in rows("car-axis/reference.csv") {
        let state = motion.at(row[0]).unwrap();
        for (column, marker) in [(1, "left"), (3, "right")] {
            let wheel = state.marker(marker).unwrap();
            for k in 0..2 {
                let off = (wheel.position[k] - row[column + k]).abs();
                assert!(off < 1e-9, "{marker} is {off:.1e} m off at {} s", row[0]);
                let off = (wheel.velocity[k] - row[column + 4 + k]).abs();
                assert!(off < 1e-7, "{marker} is {off:.1e} m/s off at {} s", row[0]);
            }
        }
    }
}

/// Where |c − p − r (e₁ cos ψ + e₂ sin ψ)| is the length of the coupler: the end of a rocker about p, on the branch that the
/// sign chooses.
fn rocker_end(
    c: [f64; 3],
    p: [f64; 3],
    r: f64,
    [e1, e2]: [[f64; 3]; 2],
    coupler: f64,
    sign: f64,
) -> [f64; 3] {
    let d = [0, 1, 2].map(|k| c[k] - p[k]);
    let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| a[k] * b[k]).sum::<f64>();
    let (a, b) = (dot(d, e1), dot(d, e2));
    let k = (dot(d, d) + r * r - coupler * coupler) / (2.0 * r);
    let psi = libm::atan2(b, a) + sign * libm::acos(k / libm::hypot(a, b));
    [0, 1, 2].map(|k| p[k] + r * (e1[k] * libm::cos(psi) + e2[k] * libm::sin(psi)))
}

#[test]
fn rockers_follow_their_cranks_as_the_loop_says() {
    // (scene, crank end at angle φ, pivot, radius, directions, start angle of the crank, marker of the rocker)
    let plane = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let upright = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]];
    for (name, crank, pivot, radius, directions, start, [on_crank, on_rocker]) in [
        ("crank-rocker", 1.0, [4.0, 0.0, 0.0], 1.65, plane, 0.4, ["A", "B"]),
        ("rssr", 0.1, [0.4, 0.1, 0.2], 0.3, upright, 0.0, ["crank-end", "rocker-end"]),
    ] {
        let motion = motion(name);
        let state = |t: f64| motion.at(t).unwrap();
        let end = |t: f64, marker: &str| state(t).marker(marker).unwrap().position;
        let distance =
            |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum::<f64>().sqrt();
        let coupler = distance(end(0.0, on_crank), end(0.0, on_rocker));
        let at = |t: f64, sign: f64| {
            let phi = start + 5.0 * t;
            let c = [crank * libm::cos(phi), crank * libm::sin(phi), 0.0];
            rocker_end(c, pivot, radius, directions, coupler, sign)
        };
        let sign = if distance(at(0.0, 1.0), end(0.0, on_rocker)) < 1e-9 { 1.0 } else { -1.0 };
        for t in motion.every(0.05) {
            let off = distance(at(t, sign), end(t, on_rocker));
            assert!(off < 2e-8, "{name}: {off:.1e} m off at {t} s");
        }
    }
}
