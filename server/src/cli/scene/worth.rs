//! What reactions at a moment of a run are worth.

use serde::Serialize;
use triad_engine::EngineError;
use triad_engine::reactions::report::{Convention, ReactionReport};
use triad_engine::run::{ReactionErrors, Simulation};

use crate::cli::terminal::print_line;

/// Reactions with what they are worth.
#[derive(Serialize)]
pub(super) struct Judged<'a> {
    #[serde(flatten)]
    pub report: &'a ReactionReport,
    #[serde(flatten)]
    pub worth: Worth,
}

/// What the run up to a moment says of the reactions there.
#[derive(Serialize)]
pub(super) struct Worth {
    /// The largest errors; none where they are not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    reaction_errors: Option<ReactionErrors>,
    /// From when on the error is not known, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    error_unknown_from: Option<f64>,
    /// What speaks against the state.
    doubts: Vec<String>,
}

/// Why nothing is known of forces at a singular start.
const OF_NO_BRANCH: &str = "rows lose their hold at the start, which bodies have hardly left: these forces are not those of the branch that the motion follows, which grow \
                            beyond all bounds next to it unless what acts on the bodies happens to be in balance; look a little later";

impl Worth {
    /// At the present of a run, of reactions as they are told.
    pub fn of(
        simulation: &Simulation,
        told: &ReactionReport,
        convention: Convention,
    ) -> Result<Self, EngineError> {
        let reaction_errors = simulation.reaction_errors_as_told(told, convention)?;
        let mut summary = simulation.summary();
        if simulation.is_beside_singular_start() {
            summary.error_unknown_from = Some(simulation.time());
            summary.doubts.push(OF_NO_BRANCH.to_owned());
        }
        Ok(Self { reaction_errors, error_unknown_from: summary.error_unknown_from, doubts: summary.doubts })
    }

    /// For people.
    pub fn print(&self) {
        let line = match (self.reaction_errors, self.error_unknown_from) {
            (Some(e), _) => {
                format!("forces right to about {:.0e} N, moments to {:.0e} N m", e.force, e.moment)
            }
            (None, Some(time)) => format!("from t = {time:.6} s on unknown"),
            (None, None) => "switched off".to_owned(),
        };
        print_line(&format!("  error: {line}"));
        for doubt in &self.doubts {
            print_line(&format!("  doubt: {doubt}"));
        }
    }
}
