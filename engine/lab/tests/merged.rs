//! Bodies that rigid connections join are solved as one, and nothing that anybody can ask for changes.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use triad_engine::EngineError;
use triad_engine::reactions::report::Convention;
use triad_engine::run::Simulation;
use triad_lab::stress::random;
use triad_scene::{GROUND, IntegratorKind, Joint, JointKind, Scene};

/// Mechanisms drawn.
const SEEDS: u64 = 150;

/// A drawn mechanism with two of three ball joints between its bodies made rigid, and every third of these rigid twice: a loop of
/// fixed joints.
fn welded(seed: u64) -> Scene {
    let mut scene = random::scene(seed).integrator(IntegratorKind::Taylor);
    let mut again = Vec::new();
    for (index, joint) in scene.joints.iter_mut().enumerate() {
        let inner = joint.body_i != GROUND && joint.body_j != GROUND;
        if inner && joint.kind == JointKind::Spherical && index % 3 != 0 {
            joint.kind = JointKind::Fixed;
            if index % 3 == 1 {
                let second = Joint::fixed(format!("again{index}"), &*joint.body_j, &*joint.body_i);
                again.push(second.at([0.1, 0.2, 0.3]));
            }
        }
    }
    scene.joints.extend(again);
    scene
}

/// What is asked of a run at a time: places, velocities, energy, and the reactions of all joints.
struct Answers {
    motion: Vec<f64>,
    energy: f64,
    reactions: Vec<f64>,
    /// Whether each component of each reaction is unique.
    unique: Vec<bool>,
}

fn answers(run: &Simulation) -> Answers {
    let mut motion = Vec::new();
    for body in run.frame().bodies {
        for vector in [body.position, body.u, body.v, body.w, body.velocity, body.angular_velocity] {
            motion.extend(vector);
        }
    }
    let report = run.reactions(Convention::default()).unwrap();
    let (mut reactions, mut unique) = (Vec::new(), Vec::new());
    for joint in report.reactions {
        for component in joint.force.into_iter().chain(joint.moment) {
            // What is not unique is one solution of many.
            reactions.push(if component.unique { component.value } else { 0.0 });
            unique.push(component.unique);
        }
    }
    Answers { motion, energy: run.summary().energy, reactions, unique }
}

fn run(scene: &Scene) -> Result<(Vec<Answers>, u64), EngineError> {
    let mut run = Simulation::new(scene)?;
    let mut all = Vec::new();
    for k in 0..=4 {
        run.advance_to(0.1 * f64::from(k))?;
        all.push(answers(&run));
    }
    let merged = run.left_out().iter().find(|item| item.word == "fixed").map_or(0, |item| item.saved);
    Ok((all, merged))
}

/// Largest difference, in parts of the largest number or of one.
fn apart(one: &[f64], other: &[f64]) -> f64 {
    let size = one.iter().fold(1.0f64, |size, x| size.max(x.abs()));
    one.iter().zip(other).fold(0.0f64, |most, (x, y)| most.max((x - y).abs())) / size
}

#[test]
fn merged_bodies_answer_as_if_they_were_apart() {
    let mut compared = 0;
    for scene in (0..SEEDS).map(welded) {
        let mut each = scene.clone();
        each.simulation.skip.fixed = false;
        let (one, other) = match (run(&scene), run(&each)) {
            (Ok(one), Ok(other)) => (one, other),
            (Err(one), Err(other)) => {
                assert_eq!(one.code(), other.code(), "{}: {one} / {other}", scene.name);
                continue;
            }
            (one, other) => panic!("{}: {:?} / {:?}", scene.name, one.err(), other.err()),
        };
        assert_eq!(other.1, 0, "{}", scene.name);
        if one.1 == 0 {
            continue;
        }
        compared += 1;
        for (k, (a, b)) in one.0.iter().zip(&other.0).enumerate() {
            let [motion, energy] = [apart(&a.motion, &b.motion), apart(&[a.energy], &[b.energy])];
            let reactions = apart(&a.reactions, &b.reactions);
            assert_eq!(a.unique, b.unique, "{} at output {k}", scene.name);
            assert!(
                motion < 1e-7 && energy < 1e-7 && reactions < 1e-6,
                "{} at output {k}: motion {motion:e}, energy {energy:e}, reactions {reactions:e}",
                scene.name
            );
        }
    }
    assert!(compared > 30, "only {compared} mechanisms had bodies to merge");
}
