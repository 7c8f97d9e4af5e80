//! What is varied, and how.

use triad_engine::EngineError;
use triad_engine::run::{Column, Outputs, Simulation};
use triad_linalg::random::Random;
use triad_scene::{OutputKind, Scene, SceneError, WrittenScene};

/// Runs that a sweep may have.
const MAX_RUNS: usize = 10_000_000;

/// Which values a number takes.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Equally spaced, both ends included; all grids of a plan are crossed.
    Grid {
        /// The first.
        from: f64,
        /// The last.
        to: f64,
        /// How many.
        count: usize,
    },
    /// Drawn between two numbers, each alike.
    Uniform {
        /// The least.
        from: f64,
        /// The bound above.
        to: f64,
    },
    /// Drawn from a normal distribution.
    Normal {
        /// Its mean.
        mean: f64,
        /// Its standard deviation.
        deviation: f64,
    },
}

/// A number of the scene that is varied.
#[derive(Clone, Debug, PartialEq)]
pub struct Variation {
    /// Its name: that of the parameter, or the JSON pointer.
    pub name: String,
    /// JSON pointers of the numbers that follow it, each with its factor.
    places: Vec<(String, f64)>,
    /// Its values.
    pub values: Values,
}

impl Variation {
    /// Whether it replaces the number at a JSON pointer.
    pub fn varies(&self, pointer: &str) -> bool {
        self.places.iter().any(|(place, _)| place == pointer)
    }

    /// Of a parameter of the scene by its name, which sets all its places, or of a number by a JSON pointer such as `/bodies/0/mass`,
    /// which sets that alone.
    ///
    /// # Errors
    ///
    /// [`SceneError`]: no such parameter, or no number there.
    pub fn new(scene: &Scene, name: &str, values: Values) -> Result<Self, SceneError> {
        let places = if name.starts_with('/') {
            vec![(name.to_owned(), 1.0)]
        } else {
            let parameter = scene.parameter(name)?;
            parameter.places().iter().map(|place| (place.pointer().to_owned(), place.factor())).collect()
        };
        let written = WrittenScene::new(&without_sliders(scene.clone()));
        for (pointer, _) in &places {
            written.number(pointer)?;
        }
        Ok(Self { name: name.to_owned(), places, values })
    }

    /// The numbers of the scene at a value.
    pub(super) fn changes(&self, value: f64) -> impl Iterator<Item = (&str, f64)> {
        self.places.iter().map(move |(pointer, factor)| (pointer.as_str(), value * factor))
    }
}

/// What is run.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepPlan {
    /// The scene, without parameters; its outputs at the end are what is told of each run.
    pub scene: Scene,
    /// What is varied: grids are crossed, the last one changes fastest.
    pub varied: Vec<Variation>,
    /// Runs with numbers drawn anew, at each point of the grids.
    pub samples: usize,
    /// Where the drawn numbers come from.
    pub seed: u64,
}

/// Why a sweep cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SweepError {
    /// The scene cannot be.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// Too many runs, or none.
    #[error("the sweep would have {runs} runs; there may be from 1 to {MAX_RUNS}")]
    Count {
        /// How many.
        runs: String,
    },
    /// Two variations of one number: the second would replace what the first chose.
    #[error("{pointer} is varied twice, by {first} and by {second}")]
    Twice {
        /// The number's place in the scene.
        pointer: String,
        /// The name of the first variation.
        first: String,
        /// That of the second.
        second: String,
    },
    /// Several samples of numbers none of which is drawn: all would be the same run.
    #[error(
        "none of the numbers is drawn at random, so that {samples} samples of each point would be the same run"
    )]
    Undrawn {
        /// How many samples.
        samples: usize,
    },
    /// Threads that cannot be started.
    #[error("{threads} threads cannot be started: {reason}")]
    Threads {
        /// How many.
        threads: usize,
        /// Why.
        reason: String,
    },
}

/// The scene as it is run. Its parameters are for the page: how far its sliders go, and which numbers they move together. A sweep goes
/// beyond that, and varies one of these numbers without the others.
fn without_sliders(mut scene: Scene) -> Scene {
    scene.parameters.clear();
    scene
}

impl SweepPlan {
    /// The scene alone, once.
    pub fn new(scene: Scene) -> Self {
        Self { scene: without_sliders(scene), varied: Vec::new(), samples: 1, seed: 1 }
    }

    /// The same, with estimated errors beside the outputs that the scene chooses, if it estimates any: no number without its error,
    /// which takes one part in a hundred of what a run costs.
    pub fn with_errors(mut scene: Scene) -> Self {
        let settings = &mut scene.simulation;
        if settings.error_estimate && !settings.tells_errors() {
            settings.outputs.push(OutputKind::Errors.into());
        }
        Self::new(scene)
    }

    /// How many runs there are.
    ///
    /// # Errors
    ///
    /// [`SweepError::Count`]: none, or too many; [`SweepError::Twice`] and [`SweepError::Undrawn`]: some would not differ as the
    /// plan says.
    pub fn count(&self) -> Result<usize, SweepError> {
        let drawn = |variation: &Variation| !matches!(variation.values, Values::Grid { .. });
        if self.samples > 1 && !self.varied.iter().any(drawn) {
            return Err(SweepError::Undrawn { samples: self.samples });
        }
        for (k, second) in self.varied.iter().enumerate() {
            let shared = self.varied[..k].iter().find_map(|first| {
                second
                    .places
                    .iter()
                    .find(|(pointer, _)| first.varies(pointer))
                    .map(|(pointer, _)| (first, pointer))
            });
            if let Some((first, pointer)) = shared {
                let (pointer, first, second) = (pointer.clone(), first.name.clone(), second.name.clone());
                return Err(SweepError::Twice { pointer, first, second });
            }
        }
        let grids = self.varied.iter().map(|variation| match variation.values {
            Values::Grid { count, .. } => count,
            Values::Uniform { .. } | Values::Normal { .. } => 1,
        });
        let runs = grids.chain([self.samples]).try_fold(1_usize, usize::checked_mul);
        runs.filter(|runs| (1..=MAX_RUNS).contains(runs)).ok_or_else(|| SweepError::Count {
            runs: runs.map_or_else(|| "too many".to_owned(), |runs| runs.to_string()),
        })
    }

    /// What is told of each run: the outputs that the scene chooses.
    ///
    /// # Errors
    ///
    /// [`SweepError::Engine`]: the scene cannot be run.
    pub fn columns(&self) -> Result<Vec<Column>, SweepError> {
        Ok(Outputs::new(&Simulation::new(&self.scene)?).columns().to_vec())
    }

    /// The varied numbers of run `index`.
    pub fn values(&self, index: usize) -> Vec<f64> {
        let mut rest = index / self.samples.max(1);
        let mut values: Vec<f64> = self
            .varied
            .iter()
            .enumerate()
            .rev()
            .map(|(place, variation)| match variation.values {
                Values::Grid { from, to, count } => {
                    let at = rest % count.max(1);
                    rest /= count.max(1);
                    grid_point(from, to, at, count.saturating_sub(1))
                }
                Values::Uniform { from, to } => self.draw(index, place).between(from, to),
                Values::Normal { mean, deviation } => mean + deviation * normal(&mut self.draw(index, place)),
            })
            .collect();
        values.reverse();
        values
    }

    /// A generator for one number of one run: a stream of its own, whichever thread asks.
    fn draw(&self, index: usize, place: usize) -> Random {
        let mut seeds = Random::new(self.seed);
        let mut run = Random::new(seeds.bits() ^ index as u64);
        Random::new(run.bits() ^ (place as u64).rotate_left(32))
    }
}

/// Point `at` of those that divide a range into parts: both ends exactly, and whole numbers and tenths where they are meant.
fn grid_point(from: f64, to: f64, at: usize, parts: usize) -> f64 {
    match at {
        0 => from,
        _ if at >= parts => to,
        _ => (from * (parts - at) as f64 + to * at as f64) / parts as f64,
    }
}

/// A number of the standard normal distribution, by Box and Muller.
fn normal(random: &mut Random) -> f64 {
    let radius = (-2.0 * libm::log(1.0 - random.unit())).sqrt();
    radius * libm::cos(std::f64::consts::TAU * random.unit())
}
