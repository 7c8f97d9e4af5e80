//! Chains find the position in which they hang, however long they are and wherever they start.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests may panic")]

use serde_json::{Value, json};
use triad_engine::analysis::{AnalysisError, Equilibrium, ModesAbout, equilibrium, modes};
use triad_engine::scene::Scene;

/// A straight chain of links of 1 m and 1 kg, or of balls on rods, from the origin, tilted from where it hangs.
fn chain(kind: &str, links: usize, tilt: f64) -> Scene {
    let (sine, cosine) = libm::sincos(tilt);
    let along = |way: f64| [way * sine, -way * cosine, 0.0];
    let (mut bodies, mut joints) = (Vec::new(), Vec::new());
    let mut before = "ground".to_owned();
    for k in 0..links {
        let (name, start) = (format!("link-{k}"), k as f64);
        let mut joint =
            json!({ "name": format!("joint-{k}"), "type": kind, "body_i": before, "body_j": name });
        if kind == "rod" {
            bodies.push(json!({ "name": name, "mass": 1, "position": along(start + 1.0) }));
            joint["points"] = json!([along(start), along(start + 1.0)]);
        } else {
            bodies.push(json!({
                "name": name, "mass": 1, "position": along(start + 0.5),
                "inertia": { "principal": [1.0 / 12.0, 0.001, 1.0 / 12.0] },
                "orientation": { "axis": [0, 0, 1], "angle": tilt }
            }));
            joint["point"] = json!(along(start));
            if kind == "revolute" {
                joint["axis"] = json!([0, 0, 1]);
            }
        }
        joints.push(joint);
        before = name;
    }
    let scene: Value =
        json!({ "name": "chain", "gravity": [0, -9.81, 0], "bodies": bodies, "joints": joints });
    Scene::from_json(&scene.to_string()).unwrap()
}

/// How far the last body is from where it hangs, m.
fn off(found: &Equilibrium, lowest: f64) -> f64 {
    let [x, y, z] = found.bodies.last().unwrap().position;
    let above = y + lowest;
    (x * x + above * above + z * z).sqrt()
}

#[test]
fn chains_hang_down_from_any_tilt() {
    for links in [1, 2, 5, 20, 100] {
        for tilt in [0.2, 0.6, 1.0] {
            let found = equilibrium(&chain("revolute", links, tilt));
            let found = found.unwrap_or_else(|error| panic!("{links} links tilted by {tilt}: {error}"));
            let off = off(&found, links as f64 - 0.5);
            assert!(off < 1e-6 * links as f64, "{links} links tilted by {tilt}: {off}");
            assert_eq!(found.stable, Some(true), "{links} links tilted by {tilt}");
            assert!(found.iterations <= 60, "{links} links tilted by {tilt}: {} steps", found.iterations);
        }
    }
}

#[test]
fn balls_on_rods_and_links_on_spherical_joints_hang_down_too() {
    for (kind, links, lowest) in [("rod", 30, 30.0), ("spherical", 5, 4.5), ("spherical", 30, 29.5)] {
        let found =
            equilibrium(&chain(kind, links, 0.2)).unwrap_or_else(|error| panic!("{links} {kind}: {error}"));
        assert!(off(&found, lowest) < 1e-5, "{kind}: {}", off(&found, lowest));
        assert!(found.stable != Some(false) && found.iterations <= 60, "{kind}: {}", found.iterations);
    }
}

#[test]
fn modes_are_those_of_the_hanging_chain_and_an_upright_one_is_told_unstable() {
    // The slowest mode of a long hanging chain: the first zero of J₀, 2.404826, gives ω = 2.404826/2 √(g/L).
    let found = modes(&chain("revolute", 40, 0.5), ModesAbout::Equilibrium).unwrap();
    let slowest = 2.404_825_557_695_773 / 2.0 * (9.81f64 / 40.0).sqrt() / std::f64::consts::TAU;
    assert!((found.modes[0].frequency / slowest - 1.0).abs() < 0.01, "{}", found.modes[0].frequency);
    let upright = equilibrium(&chain("revolute", 8, std::f64::consts::PI)).unwrap();
    assert_eq!((upright.stable, upright.iterations), (Some(false), 0));
    let falling = equilibrium(&{
        let mut scene = chain("revolute", 3, 0.2);
        scene.joints.remove(1);
        scene
    });
    let Err(error) = falling else { panic!("what falls has no equilibrium") };
    assert!(
        matches!(&error, AnalysisError::NoEquilibrium { body, .. } if body == "link-1" || body == "link-2")
    );
    assert!(error.hint().contains("start nearer to where it comes to rest"));
}

/// Where springs alone carry a body, nothing acts on it at rest, and what is left is rounding however small: it is at rest all the same.
#[test]
fn a_body_that_only_springs_carry_comes_to_rest() {
    let spring = |name: &str, from: [f64; 3], to: [f64; 3]| {
        json!({ "type": "spring", "name": name, "body_i": "ground", "body_j": "body", "point_i": from, "point_j": to,
            "stiffness": 100, "free_length": 0.5 })
    };
    let rest = |joints: Value, loads: &[Value], gravity: f64| {
        let text = json!({ "name": "hung", "gravity": [0, 0, -gravity], "joints": joints, "loads": loads,
            "bodies": [{ "name": "body", "mass": 2, "inertia": { "principal": [0.1, 0.12, 0.15] } }] });
        let scene = Scene::from_json(&text.to_string()).unwrap();
        let found = equilibrium(&scene).unwrap_or_else(|error| panic!("{error}"));
        assert!(found.stable == Some(true) && found.residual < 1e-11, "{found:?}");
        assert_eq!(modes(&scene, ModesAbout::Equilibrium).unwrap().notes, Vec::<String>::new());
        found.bodies[0].position
    };
    let slide = json!([{ "name": "guide", "type": "prismatic", "body_i": "ground", "body_j": "body", "point": [0, 0, 0], "axis": [0, 0, 1] }]);
    for gravity in [9.81, 1.62, 0.0] {
        let position = rest(slide.clone(), &[spring("above", [0.0, 0.0, 1.0], [0.0; 3])], gravity);
        assert!((position[2] - (0.5 - 0.02 * gravity)).abs() < 1e-12, "{position:?}");
        let ends = [
            ([1.0, 0.0, 1.0], [0.2, 0.0, 0.1]),
            ([-0.5, 0.8, 1.0], [-0.1, 0.2, 0.1]),
            ([-0.5, -0.8, 1.1], [-0.1, -0.2, 0.1]),
            ([0.1, 0.9, -1.0], [0.1, 0.2, -0.1]),
            ([0.8, -0.6, -1.0], [0.2, -0.1, -0.1]),
            ([-0.9, 0.1, -0.8], [-0.2, 0.1, -0.1]),
        ];
        let springs: Vec<_> =
            ends.iter().enumerate().map(|(k, (from, to))| spring(&format!("s{k}"), *from, *to)).collect();
        rest(json!([]), &springs, gravity);
    }
    // A motor that its own spring balances.
    let hinge = json!([{ "name": "hinge", "type": "revolute", "body_i": "ground", "body_j": "body", "point": [0, 0, 0], "axis": [0, 0, 1] }]);
    rest(
        hinge,
        &[
            json!({ "type": "torsion", "name": "motor", "joint": "hinge", "stiffness": 3, "free_angle": 0.1, "torque": 0.7 }),
        ],
        9.81,
    );
}

/// A point that turns about itself moves nothing, and nothing has to hold it.
#[test]
fn points_on_springs_hang_stable() {
    for height in [0.0, 1000.0] {
        let scene = json!({
            "name": "point", "gravity": [0, -9.81, 0],
            "bodies": [{ "name": "point", "mass": 1, "position": [0, height - 1.2, 0] }],
            "loads": [{ "type": "spring", "name": "s", "body_i": "ground", "body_j": "point", "point_i": [0, height, 0], "point_j": [0, 0, 0],
                "stiffness": 50, "free_length": 1 }]
        });
        let found = equilibrium(&Scene::from_json(&scene.to_string()).unwrap()).unwrap();
        let y = found.bodies[0].position[1];
        let off = (y - (height - 1.0 - 9.81 / 50.0)).abs();
        assert_eq!((found.stable, found.notes), (Some(true), Vec::new()));
        // The string is longer than the spring's free length: across, a weight holds it.
        assert!(
            (found.least_stiffness / (9.81 / (1.0 + 9.81 / 50.0)) - 1.0).abs() < 1e-9,
            "{}",
            found.least_stiffness
        );
        let error = found.error.unwrap();
        assert!(
            off <= error && error >= f64::EPSILON * y.abs() && error < 1e-11,
            "off {off:e}, told {error:e}"
        );
    }
}
