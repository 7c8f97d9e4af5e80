//! What an author's scene is and shows: what a student's is compared with.

use triad_engine::analysis::check::check;
use triad_engine::run::Simulation;
use triad_engine::scene::Scene;

use crate::exercise::ModelTask;
use crate::scenario::measure::{MeasureError, measure, reference_scenes, start};

/// Of what is demanded.
#[derive(Debug)]
pub(crate) struct AuthorsModel {
    /// None where nobody asks.
    pub degrees_of_freedom: Option<usize>,
    /// What each watch sees, at its own times.
    pub seen: Vec<Vec<Vec<f64>>>,
}

impl AuthorsModel {
    /// Runs the author's scene.
    pub(crate) fn new(task: &ModelTask) -> Result<Self, MeasureError> {
        let counted = task.demands.degrees_of_freedom.then(|| check(&task.reference)).transpose()?;
        let end = times(task).last().copied().unwrap_or(0.0);
        let [scene, _] = reference_scenes(&task.reference, end);
        let seen = seen(task, &scene, &mut start(&scene)?)?.into_iter().collect::<Result<_, _>>()?;
        Ok(Self { degrees_of_freedom: counted.map(|report| report.degrees_of_freedom), seen })
    }
}

/// What one watch sees at its times; why not, where the scene lacks what it looks at.
pub(crate) type Seen = Result<Vec<Vec<f64>>, MeasureError>;

/// What each watch sees of a scene, at its own times.
pub(crate) fn seen(
    task: &ModelTask,
    scene: &Scene,
    simulation: &mut Simulation,
) -> Result<Vec<Seen>, MeasureError> {
    let watches = task.watches();
    let mut seen: Vec<Seen> = vec![Ok(Vec::new()); watches.len()];
    for t in times(task) {
        simulation.advance_to(t)?;
        for (seen, watch) in seen.iter_mut().zip(watches).filter(|(_, w)| w.times.contains(&t)) {
            match (seen.as_mut(), measure(scene, simulation, &watch.measured)) {
                (Ok(seen), Ok(values)) => seen.push(values),
                (Ok(_), Err(problem)) => *seen = Err(problem),
                (Err(_), _) => {}
            }
        }
    }
    Ok(seen)
}

/// All times that are watched, in order.
fn times(task: &ModelTask) -> Vec<f64> {
    let mut times: Vec<f64> = task.watches().iter().flat_map(|w| w.times.clone()).collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}
