//! Points of springs and dampers that pass each other closely: from afar nothing knows of it, and a step must not go over it.

#![allow(clippy::unwrap_used)]

use serde_json::{Value, json};
use triad_engine::run::Simulation;
use triad_engine::scene::{IntegratorKind, Scene};

const WAYS: [IntegratorKind; 6] = [
    IntegratorKind::Auto,
    IntegratorKind::Taylor,
    IntegratorKind::Dop853,
    IntegratorKind::Dopri5,
    IntegratorKind::Radau,
    IntegratorKind::Rattle,
];

/// A body of 1.5 kg on the x-axis that comes from −1 m with 3 m/s, and a spring or damper to a point at x = 0.2 m, beside its way by `gap`.
fn passing(gap: f64, law: &Value) -> Scene {
    let mut spring = json!({"type": "spring", "name": "S", "body_i": "ground", "point_i": [0.2, gap, 0], "body_j": "A", "point_j": [0, 0, 0]});
    spring.as_object_mut().unwrap().extend(law.as_object().unwrap().clone());
    let scene = json!({
        "name": "passing", "gravity": [0, 0, 0],
        "bodies": [{"name": "A", "mass": 1.5, "inertia": {"principal": [0.1, 0.2, 0.25]}, "position": [-1, 0, 0], "velocity": [3, 0, 0]}],
        "joints": [{"name": "rail", "type": "prismatic", "body_i": "ground", "body_j": "A", "point": [-1, 0, 0], "axis": [1, 0, 0]}],
        "loads": [spring],
        "simulation": {"duration": 1.2}
    });
    Scene::from_json(&scene.to_string()).unwrap()
}

/// m v′ = −c x²/(x² + g²): the velocity is a function of the way.
#[test]
fn a_damper_that_is_passed_closely_is_not_stepped_over() {
    let (mass, damping) = (1.5, 2.0);
    for gap in [1e-2, 1e-3, 1e-4, 1e-6] {
        let braked = |x: f64| damping / mass * (x - gap * libm::atan(x / gap));
        for (kind, tolerance) in WAYS.iter().flat_map(|way| [1e-3, 1e-6, 1e-9].map(|tol| (*way, tol))) {
            let scene = passing(gap, &json!({"damping": damping, "stiffness": 0, "free_length": 0}));
            let mut run = Simulation::new(&scene.integrator(kind).tolerance(tolerance)).unwrap();
            run.advance_to(1.2).unwrap();
            let body = run.frame().bodies[0];
            let expected = 3.0 - braked(body.position[0] - 0.2) + braked(-1.2);
            let error = (body.velocity[0] - expected).abs();
            let told = run.error_estimate().unwrap();
            let told = told.velocity + damping / mass * told.position;
            // The second solution of a method that carries no error along is not better than a ten-thousandth of the tolerance.
            let least = 1e-4 * tolerance + 1e-11;
            assert!(
                error < 10.0 * told + least && error < 100.0 * tolerance,
                "{kind}, {tolerance:e}, gap {gap:e}: {error:e}, told {told:e}"
            );
        }
    }
}

/// The force of a spring that is pushed together turns round where its points pass, and a force f(t) along the line does too: the energy
/// stays, or is what the force has done. Also where they meet.
#[test]
fn a_spring_that_is_passed_closely_keeps_its_energy() {
    for gap in [1e-2, 1e-4, 1e-8, 0.0] {
        for (kind, tolerance) in WAYS.iter().flat_map(|way| [1e-3, 1e-6, 1e-9].map(|tol| (*way, tol))) {
            for law in [
                json!({"stiffness": 2, "free_length": 0.3}),
                json!({"stiffness": 0, "free_length": 0, "force": 0.5}),
            ] {
                let mut run =
                    Simulation::new(&passing(gap, &law).integrator(kind).tolerance(tolerance)).unwrap();
                run.advance_to(1.2).unwrap();
                let summary = run.summary();
                let lost = summary.energy_drift.abs();
                assert!(
                    lost < 300.0 * tolerance && summary.doubts.is_empty(),
                    "{kind}, {tolerance:e}, gap {gap:e}, {law}: {lost:e}, {:?}",
                    summary.doubts
                );
            }
        }
    }
}

/// A mass on a spring and a damper whose points coincide at the start, where neither has a direction: m x″ = −m g − c x′ − k x.
#[test]
fn points_that_coincide_at_the_start_part_along_their_way() {
    let (mass, g) = (1.5f64, 9.81);
    for (stiffness, damping) in [(100.0f64, 5.0), (0.0, 5.0)] {
        let half = 0.5 * damping / mass;
        let speed = libm::sqrt((stiffness / mass - half * half).max(0.0));
        let exact = |t: f64| {
            if stiffness == 0.0 {
                return -mass * g / damping * (t - (1.0 - libm::exp(-2.0 * half * t)) / (2.0 * half));
            }
            let (sine, cosine) = libm::sincos(speed * t);
            -mass * g / stiffness * (1.0 - libm::exp(-half * t) * (cosine + half / speed * sine))
        };
        for (beside, kind) in
            [0.0, 1e-6].into_iter().flat_map(|beside| WAYS[..3].iter().map(move |kind| (beside, *kind)))
        {
            let scene = json!({
                "name": "hanging", "gravity": [0, 0, -g],
                "bodies": [{"name": "A", "mass": mass, "inertia": {"principal": [0.1, 0.2, 0.25]}, "position": [0, 0, beside]}],
                "loads": [{"type": "spring", "name": "S", "body_i": "ground", "point_i": [0, 0, 0], "body_j": "A",
                    "point_j": [0, 0, 0], "stiffness": stiffness, "damping": damping}],
                "simulation": {"duration": 1}
            });
            let scene = Scene::from_json(&scene.to_string()).unwrap();
            let mut run = Simulation::new(&scene.integrator(kind).tolerance(1e-9)).unwrap();
            for t in [0.1, 0.3, 1.0] {
                run.advance_to(t).unwrap();
                let off = (run.frame().bodies[0].position[2] - exact(t)).abs();
                let told = run.error_estimate().unwrap().position;
                assert!(
                    off < 10.0 * told + 2.0 * beside + 1e-11,
                    "{kind}, {stiffness}, {t} s: {off:e}, told {told:e}"
                );
                assert!(off < 3e-9 + 2.0 * beside, "{kind}, {stiffness}, {beside:e}, {t} s: {off:e}");
            }
        }
    }
}

/// The same where they part along an arc, which no closed form tells: by the series as by radau.
#[test]
fn points_that_coincide_at_the_start_part_along_an_arc() {
    let scene = json!({
        "name": "arm", "gravity": [0, 0, -9.81],
        "bodies": [{"name": "A", "mass": 1, "inertia": {"principal": [0.1, 0.12, 0.2]}, "center_of_mass": [0.5, 0, 0]}],
        "joints": [{"name": "h", "type": "revolute", "body_i": "ground", "body_j": "A", "point": [0, 0, 0], "axis": [0, 1, 0]}],
        "loads": [{"type": "spring", "name": "S", "body_i": "ground", "point_i": [1, 0, 0], "body_j": "A", "point_j": [1, 0, 0],
            "stiffness": 0, "damping": 1, "free_length": 0}],
        "simulation": {"duration": 2}
    });
    let scene = Scene::from_json(&scene.to_string()).unwrap();
    let run =
        |kind, tolerance| Simulation::new(&scene.clone().integrator(kind).tolerance(tolerance)).unwrap();
    let (mut series, mut radau) = (run(IntegratorKind::Taylor, 1e-9), run(IntegratorKind::Radau, 1e-11));
    for k in 1..=20 {
        let t = 0.1 * f64::from(k);
        series.advance_to(t).unwrap();
        radau.advance_to(t).unwrap();
        let [a, b] = [&series, &radau].map(|run| run.frame().bodies[0].position);
        let off = triad_linalg::largest_difference(&a, &b);
        let told = series.error_estimate().unwrap().position;
        assert!(off < 1e-8 && off < 10.0 * told + 1e-10, "{t} s: {off:e}, told {told:e}");
    }
}

/// Position and velocity at times of a body of 1 kg that a spring of 9 N/m and 0.3 m pulls through its own anchor from 1 m away.
fn through_the_anchor(times: impl Iterator<Item = f64>) -> Vec<[f64; 2]> {
    let (pace, free) = (3.0, 0.3);
    // x = side (c + A cos + B sin): the first crossing comes from rest, and all others take as long as each other.
    let first = libm::acos(-free / 0.7) / pace;
    let speed = 0.7 * pace * libm::sin(pace * first);
    let (b, c) = (speed / pace, free);
    // The way out and back: c − c cos + b sin = 0 again.
    let between = 2.0 * (std::f64::consts::PI - libm::atan2(b, c)) / pace;
    let at = |t: f64| {
        if t < first {
            return [free + 0.7 * libm::cos(pace * t), -0.7 * pace * libm::sin(pace * t)];
        }
        let (mut from, mut side) = (first, -1.0);
        while t >= from + between {
            (from, side) = (from + between, -side);
        }
        let (sine, cosine) = libm::sincos(pace * (t - from));
        [side * (c - c * cosine + b * sine), side * pace * (c * sine + b * cosine)]
    };
    times.map(at).collect()
}

/// The motion without the error passes the anchor at another moment, and its force turns round then.
#[test]
fn an_error_is_carried_over_where_a_spring_turns_round() {
    let scene = json!({
        "name": "kink", "gravity": [0, 0, 0],
        "bodies": [{"name": "b", "mass": 1, "inertia": {"principal": [0.1, 0.1, 0.1]}, "position": [1, 0, 0]}],
        "joints": [{"name": "j", "type": "prismatic", "body_i": "ground", "body_j": "b", "point": [0, 0, 0], "axis": [1, 0, 0]}],
        "loads": [{"name": "s", "type": "spring", "body_i": "ground", "body_j": "b", "point_i": [0, 0, 0], "point_j": [0, 0, 0],
            "stiffness": 9, "free_length": 0.3}],
        "simulation": {"duration": 5}
    });
    let scene = Scene::from_json(&scene.to_string()).unwrap();
    let times: Vec<f64> = (1..=280).map(|k| 0.0173 * f64::from(k)).collect();
    let exact = through_the_anchor(times.iter().copied());
    for tolerance in [1e-4, 1e-5, 1e-6, 1e-7, 1e-9] {
        let scene = scene.clone().integrator(IntegratorKind::Taylor).tolerance(tolerance);
        let mut run = Simulation::new(&scene).unwrap();
        let mut few = 0;
        for (&t, [x, v]) in times.iter().zip(&exact) {
            run.advance_to(t).unwrap();
            let (body, told) = (run.frame().bodies[0], run.error_estimate().unwrap());
            let off = [(body.position[0] - x).abs(), (body.velocity[0] - v).abs()];
            assert!(off[0] < 1e3 * tolerance, "{tolerance:e}, {t}: {off:?}");
            assert!(off[0] < 10.0 * told.position + 1e-14, "{tolerance:e}, {t}: {off:?}, told {told:?}");
            few += usize::from(off[0] > 3.0 * told.position + 1e-14 || off[1] > 3.0 * told.velocity + 1e-14);
        }
        assert!(few <= 7, "{tolerance:e}: {few} moments of 280");
    }
}
