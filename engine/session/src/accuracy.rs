//! What a session knows of its errors, and what it knew of them before it was taken up again.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use triad_engine::run::{ErrorEstimate, Simulation, Summary};

/// Estimated errors of a state, each the largest over all bodies or joints: what the run has collected since its start.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Accuracy {
    /// Of centres of mass, m.
    pub position: f64,
    /// Of directions, rad.
    pub turn: f64,
    /// Of velocities of centres of mass, m/s.
    pub velocity: f64,
    /// Of angular velocities, rad/s.
    pub angular_velocity: f64,
    /// Of the energy, J.
    pub energy: f64,
    /// Of forces in joints and drivers, N; absent where the state tells no forces.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force: Option<f64>,
    /// Of their moments, N m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub moment: Option<f64>,
}

impl Accuracy {
    /// That of the run's current state, with that of its forces if these are told.
    fn of(simulation: &Simulation, error: ErrorEstimate, forces: bool) -> Self {
        let reactions = if forces { simulation.reaction_errors() } else { None };
        Self {
            position: error.position,
            turn: error.turn,
            velocity: error.velocity,
            angular_velocity: error.angular_velocity,
            energy: error.energy,
            force: reactions.map(|found| found.force),
            moment: reactions.map(|found| found.moment),
        }
    }

    fn is_finite(&self) -> bool {
        let Self { position, turn, velocity, angular_velocity, energy, force, moment } = self;
        let of_forces = force.iter().chain(moment);
        [position, turn, velocity, angular_velocity, energy]
            .into_iter()
            .chain(of_forces)
            .all(|error| error.is_finite())
    }

    /// The errors of before and those that have come since.
    fn and(self, since: &Self) -> Self {
        Self {
            position: self.position + since.position,
            turn: self.turn + since.turn,
            velocity: self.velocity + since.velocity,
            angular_velocity: self.angular_velocity + since.angular_velocity,
            energy: self.energy + since.energy,
            force: self.force.zip(since.force).map(|(before, since)| before + since),
            moment: self.moment.zip(since.moment).map(|(before, since)| before + since),
        }
    }
}

/// What a session knows of the errors of its run, and what there is to say of the run.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Known {
    /// The moment, s.
    pub time: f64,
    /// Estimated errors, where they are known.
    pub accuracy: Option<Accuracy>,
    /// From when on they are not known, s.
    pub error_unknown_from: Option<f64>,
    /// Energy less that of the start and the work of drivers and of loads without potential since, J, where it is known.
    pub energy_drift: Option<f64>,
    /// What was found or corrected, and what speaks against the result.
    pub notes: Vec<String>,
}

impl Known {
    /// Of a simulation that knows of itself alone.
    fn of(simulation: &Simulation, summary: &Summary, forces: bool) -> Self {
        Self {
            time: summary.time,
            accuracy: summary.error.map(|error| Accuracy::of(simulation, error, forces)),
            error_unknown_from: summary.error_unknown_from,
            energy_drift: Some(summary.energy_drift),
            notes: [simulation.notes(), &summary.doubts].concat(),
        }
    }

    /// The same after what was known before.
    fn after(mut self, before: &Self) -> Self {
        self.notes.retain(|note| !before.notes.contains(note));
        Self {
            time: self.time,
            accuracy: before.accuracy.clone().zip(self.accuracy).map(|(before, since)| before.and(&since)),
            error_unknown_from: before.error_unknown_from.or(self.error_unknown_from),
            energy_drift: before.energy_drift.zip(self.energy_drift).map(|(before, since)| before + since),
            notes: [before.notes.as_slice(), &self.notes].concat(),
        }
    }
}

/// What a run knows of itself beside what its simulation knows.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Since {
    /// When it went on with other numbers last, s.
    changed: Option<f64>,
    /// What was known when it was taken up again, or its numbers were changed: its simulation counts from there and knows nothing of it.
    taken_up: Option<Known>,
}

impl Since {
    /// Whether its simulation has begun at the start of the run.
    pub fn is_start(&self) -> bool {
        self.taken_up.as_ref().is_none_or(|known| known.time <= 0.0)
    }

    /// What is known where another simulation goes on with other numbers from the state of this one: what was not known of its errors is
    /// not known then either.
    pub fn change(&self, simulation: &Simulation, forces: bool) -> Self {
        let Self { taken_up: Some(mut known), .. } = self.taken_up(simulation, forces) else {
            return Self::default();
        };
        if known.time <= 0.0 {
            return Self::default();
        }
        // What the simulation has said of itself and of its energy ends with it.
        known.energy_drift = Some(0.0);
        known.notes = self.taken_up.as_ref().map_or_else(Vec::new, |before| before.notes.clone());
        Self { changed: Some(known.time), taken_up: Some(known) }
    }

    /// The same for the run that takes up this one where it stands.
    pub fn taken_up(&self, simulation: &Simulation, forces: bool) -> Self {
        let mut known = self.known(simulation, &simulation.summary(), forces);
        // What is kept has no words for numbers that are none.
        if known.accuracy.as_ref().is_some_and(|accuracy| !accuracy.is_finite()) {
            (known.accuracy, known.error_unknown_from) = (None, Some(known.time));
        }
        known.energy_drift = known.energy_drift.filter(|drift| drift.is_finite());
        Self { changed: self.changed, taken_up: Some(known) }
    }

    /// The same for a run that is taken up at that time, s, of which nothing else was kept.
    pub fn or_unknown(mut self, time: f64) -> Self {
        if self.taken_up.is_none() && time > 0.0 {
            self.taken_up = Some(Known { time, error_unknown_from: Some(time), ..Known::default() });
        }
        self
    }

    /// What is known of a run, with all that was known of it before.
    pub fn known(&self, simulation: &Simulation, summary: &Summary, forces: bool) -> Known {
        let known = Known::of(simulation, summary, forces);
        match &self.taken_up {
            None => known,
            Some(before) => known.after(before),
        }
    }

    /// What its errors count, in sentences, where there are any.
    pub fn notes(&self, known: &Known) -> Vec<String> {
        if known.accuracy.is_none() {
            return Vec::new();
        }
        let told = |what: &str, time: f64| {
            format!(
                "{what} at t = {time:.3} s: estimated errors are those of then with what has come since; how those of then grow is not known"
            )
        };
        let changed = self.changed.map(|time| told("the numbers of the run were changed", time));
        let taken_up = self.taken_up.as_ref().map(|before| before.time);
        let taken_up = taken_up.filter(|time| *time > 0.0 && self.changed != Some(*time));
        changed.into_iter().chain(taken_up.map(|time| told("the run was taken up again", time))).collect()
    }
}
