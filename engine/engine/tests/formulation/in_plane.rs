//! States that are looked at: in the plane, and with what was found at one nearby, the multipliers are those of the whole of S.
#![allow(clippy::unwrap_used, reason = "tests may panic")]

use triad_engine::catalogue;
use triad_engine::dynamics::elimination::{Accelerations, Elimination};
use triad_engine::run::Simulation;
use triad_engine::scene::{Inertia, Orientation, Scene};
use triad_engine::state::State;
use triad_engine::system::planar;

fn kept(name: &str) -> Scene {
    let path = format!("{}/../../tests/data/scenes/{name}.json", env!("CARGO_MANIFEST_DIR"));
    Scene::from_json(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn bars() -> Scene {
    catalogue::scene("n-four-bar:3").unwrap()
}

/// Bars whose weight acts across their plane too.
fn lying() -> Scene {
    Scene { gravity: [1.0, -2.0, -9.0], ..bars() }
}

/// Bars that lie one above the other.
fn layered() -> Scene {
    let mut scene = bars();
    for (layer, body) in scene.bodies.iter_mut().enumerate() {
        body.position[2] += 0.1 * (layer as f64 + 1.0);
        body.inertia = Some(Inertia::Principal([0.06, 0.08, 0.1]));
    }
    scene
}

/// Bars that turn about none of their principal axes.
fn skew() -> Scene {
    let mut scene = bars();
    for body in &mut scene.bodies {
        body.orientation = Some(Orientation::directors([0.6, 0.0, 0.8], [0.0, 1.0, 0.0]));
        body.inertia = Some(Inertia::Principal([0.06, 0.08, 0.1]));
    }
    scene
}

/// Bars in a plane across another axis.
fn turned() -> Scene {
    let turn = |[x, y, z]: [f64; 3]| [z, x, y];
    let mut scene = bars();
    scene.gravity = turn(scene.gravity);
    for body in &mut scene.bodies {
        body.orientation = None;
        body.position = turn(body.position);
        body.velocity = turn(body.velocity);
        body.angular_velocity = turn(body.angular_velocity);
    }
    for joint in &mut scene.joints {
        joint.point = joint.point.map(turn);
        joint.axis = joint.axis.map(turn);
    }
    scene
}

/// A solver of all rows.
fn solver(run: &Simulation) -> Elimination {
    let mut solver = Elimination::new(run.system());
    solver.set_dependent(&run.rank().dependent);
    solver
}

fn state(run: &Simulation) -> State {
    State::at(run.system(), run.time(), run.q(), run.q_dot())
}

/// A solver that has looked for the plane of a run at its start, and whether it has found one.
fn examiner(run: &Simulation) -> (Elimination, bool) {
    let mut solver = solver(run);
    let plane = planar::recognize(run.system(), run.q());
    let found = plane.is_ok_and(|plane| solver.find_plane(run.system(), &state(run), &plane, (0.0, 0.0)));
    (solver, found)
}

/// Multipliers and accelerations.
fn numbers(run: &Simulation, found: &Accelerations) -> [Vec<f64>; 2] {
    let mut q_ddot = vec![0.0; run.system().coordinates];
    found.write(&mut q_ddot);
    [found.multipliers.solver_rows().to_vec(), q_ddot]
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()))
}

fn minus(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// Goes along a run, and compares what is examined with what is solved with all rows: multipliers to the part `most`.
fn compare(name: &str, run: &mut Simulation, mut examiner: Elimination, most: f64) {
    let mut whole = solver(run);
    for step in 0..12 {
        run.advance_to(0.07 * f64::from(step)).unwrap();
        let (system, state) = (run.system(), state(run));
        let a = numbers(run, &whole.examine(system, &state, (0.0, 0.0), None));
        let b = numbers(run, &examiner.examine(system, &state, (0.0, 0.0), None));
        for ((a, b), most) in a.iter().zip(&b).zip([most, 1e-11]) {
            let off = largest(&minus(a, b)) / largest(a).max(1.0);
            assert!(off < most, "{name} at {}: off by {off:e} of {}", run.time(), largest(a));
        }
    }
}

#[test]
fn rows_of_the_plane_alone_give_the_multipliers_of_all() {
    let names = [
        "lesson-09-jacobian",
        "lesson-16-inverse-dynamics",
        "lesson-17-singular-positions",
        "rough-four-bar",
    ];
    for (name, scene) in names.map(|name| (name, kept(name))).into_iter().chain([("n-four-bar:3", bars())]) {
        let mut run = Simulation::new(&scene).unwrap();
        let (examiner, found) = examiner(&run);
        assert!(found, "{name}");
        compare(name, &mut run, examiner, 1e-11);
    }
}

#[test]
fn what_acts_across_the_plane_is_not_overlooked() {
    let scenes = [
        ("lying", lying(), true),
        ("layered", layered(), true),
        ("turned", turned(), true),
        ("skew", skew(), false),
    ];
    let most = 1e-11;
    for (name, scene, helps) in scenes {
        let mut run = Simulation::new(&scene).unwrap();
        let (own, found) = examiner(&run);
        assert!(found || !helps, "{name}");
        compare(name, &mut run, own, most);
        // Of the same rows, but with nothing across its plane: what was found at its start need not hold here.
        let (other, found) = examiner(&Simulation::new(&bars()).unwrap());
        assert!(found);
        run.reset();
        compare(name, &mut run, other, most);
    }
}

#[test]
fn a_state_nearby_gives_the_difference() {
    let scenes = ["n-four-bar:3", "spatial-chain:3", "spatial-slider-crank", "bricard"];
    let scenes = scenes.map(|name| (name, catalogue::scene(name).unwrap())).into_iter();
    for (name, scene) in scenes.chain([("turned", turned())]) {
        // The second is so far away that it takes a factor of its own.
        for (apart, least) in [(1e-8, 1e-3), (0.1, 1e-9)] {
            let mut run = Simulation::new(&scene).unwrap();
            let (mut here, _) = examiner(&run);
            let (mut there, mut whole) = (here.clone(), solver(&run));
            run.advance_to(0.3).unwrap();
            let first = state(&run);
            run.advance_to(0.3 + apart).unwrap();
            let (system, second) = (run.system(), state(&run));
            let mut exact = || {
                let [a, b] = [&first, &second]
                    .map(|state| numbers(&run, &whole.examine(system, state, (0.0, 0.0), None)));
                minus(&b[0], &a[0])
            };
            let exact = exact();
            let a = numbers(&run, &here.examine(system, &first, (0.0, 0.0), None));
            let b = numbers(&run, &there.examine(system, &second, (0.0, 0.0), Some(&here)));
            let off = largest(&minus(&exact, &minus(&b[0], &a[0])));
            assert!(off < least * largest(&exact), "{name}, {apart}: {off:e} of {:e}", largest(&exact));
        }
    }
}
