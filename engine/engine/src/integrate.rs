//! Integrators of the equations of motion. Each fills a [`StepRecord`]; [`Stepper`] is what a run needs of it.

pub(crate) mod hermite;
mod power;
mod step;

mod passings;

mod track;

mod stepper;

mod wide;

mod explicit;
mod radau;

mod augmented;
mod driven;
mod in_chart;
mod penalty;
mod rattle;
mod taylor;

mod choice;
mod integrator;

pub use augmented::Augmented;
pub use choice::choose;
pub use driven::Driven;
pub use explicit::{DOP853, DOPRI5, Explicit, ODE45_TOLERANCE, Tableau};
pub use in_chart::{Bridged, Chart, IndependentCoordinates, Start};
pub use integrator::Integrator;
pub use penalty::{Penalty, PenaltyParameters};
pub use power::{add_power, power};
pub use radau::{RADAU_5, RADAU_9, RADAU_13, Radau, RadauTables};
pub use rattle::Rattle;
pub use step::{StepRecord, Steps, StopReason};
pub use stepper::{IslandStep, OdeMethod, SkippedWork, Stepper};
pub use taylor::Taylor;
pub use track::Track;
