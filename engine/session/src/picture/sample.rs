//! What is recorded of one instant.

use triad_engine::run::{Simulation, list_size};

/// A body at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Centre of mass in the world, in metres.
    pub position: [f64; 3],
    /// Principal axes u, v, w in the world, unit vectors.
    pub axes: [[f64; 3]; 3],
    /// Velocity of the centre of mass in the world, in metres a second.
    pub velocity: [f64; 3],
    /// Angular velocity in the world, in radians a second.
    pub angular_velocity: [f64; 3],
    /// Acceleration of the centre of mass in the world, in metres a second squared.
    pub acceleration: [f64; 3],
}

/// A joint's reaction at one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct SampledReaction {
    /// Where it acts, in the world, in metres.
    pub at: [f64; 3],
    /// The force on the body `on` of its [`JointVisual`](super::JointVisual), in the world, in newtons.
    pub force: [f64; 3],
    /// The moment on that body about `at`, in the world, in newton metres.
    pub moment: [f64; 3],
    /// The multipliers of the joint's rows.
    pub multipliers: Vec<f64>,
}

/// The whole mechanism at one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Time of the simulation, in seconds.
    pub time: f64,
    /// One a body, in the scene's order.
    pub poses: Vec<Pose>,
    /// Weights, in the world, in newtons; one a body.
    pub weights: Vec<[f64; 3]>,
    /// Mass times acceleration of the centre of mass, in the world, in newtons; one a body.
    pub inertia: Vec<[f64; 3]>,
    /// One a joint, in the scene's order; empty where the reactions could not be found.
    pub reactions: Vec<SampledReaction>,
    /// Energy, in joules.
    pub energy: f64,
    /// Norm of the position constraints, in metres.
    pub position_violation: f64,
    /// Norm of the velocity constraints, in metres a second.
    pub velocity_violation: f64,
}

impl Sample {
    /// Bytes that it takes to hold this sample, with what an allocator adds to each of its lists.
    pub fn size(&self) -> usize {
        let rows = self.reactions.iter().map(|reaction| list_size(&reaction.multipliers));
        size_of::<Self>()
            + list_size(&self.poses)
            + list_size(&self.weights)
            + list_size(&self.inertia)
            + list_size(&self.reactions)
            + rows.sum::<usize>()
    }
}

/// The simulation at its current time, as it is recorded.
pub fn sample(simulation: &Simulation) -> Sample {
    let frame = simulation.frame();
    let summary = simulation.summary();
    let accelerations = simulation.mass_accelerations();
    let model = simulation.model();
    let weights = model.bodies.iter().map(|body| (model.gravity * body.mass).into()).collect();
    let inertia =
        model.bodies.iter().zip(&accelerations).map(|(body, a)| a.map(|part| part * body.mass)).collect();
    let reactions = simulation.multipliers_between_steps().into_iter().map(|joint| SampledReaction {
        at: joint.about,
        force: joint.force,
        moment: joint.moment,
        multipliers: joint.rows.iter().map(|row| row.value).collect(),
    });
    let poses = frame.bodies.iter().zip(&accelerations).map(|(body, &acceleration)| Pose {
        position: body.position,
        axes: [body.u, body.v, body.w],
        velocity: body.velocity,
        angular_velocity: body.angular_velocity,
        acceleration,
    });
    Sample {
        time: simulation.time(),
        poses: poses.collect(),
        weights,
        inertia,
        reactions: reactions.collect(),
        energy: summary.energy,
        position_violation: summary.position_violation,
        velocity_violation: summary.velocity_violation,
    }
}
