//! What a run has left out, and what that saved.

use super::Simulation;
use serde::Serialize;

/// Something that a run leaves out unless it is switched off.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct SkippedItem {
    /// Its word in `simulation.skip`.
    pub word: &'static str,
    /// Whether it is switched on.
    pub on: bool,
    /// How much has been left out so far.
    pub saved: u64,
    /// Of how much.
    pub of: u64,
    /// Both in words.
    pub what: String,
}

/// Work that was done or left out after steps and at outputs.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counted {
    /// Outputs that were read off a step, and all outputs.
    pub outputs: [u64; 2],
    /// Steps whose constraints were measured.
    pub checks: u64,
    /// Steps of which energy, reactions and Jacobian were found though nobody asked.
    pub reports: u64,
}

impl Simulation {
    /// What the run has left out so far, word by word.
    pub fn left_out(&self) -> Vec<SkippedItem> {
        let skip = self.model().settings.skip;
        let bodies = self.model().bodies.len() as u64;
        let steps = self.integrator.last().steps.accepted;
        let saved = self.integrator.skipped();
        let entry = |word, on, saved: u64, of: u64, what: String| {
            let what =
                if of == 0 { "this integrator knows nothing to leave out here".to_owned() } else { what };
            SkippedItem { word, on, saved, of, what }
        };
        let s = saved.unwrap_or_default();
        let of = |n: u64| if saved.is_some() { n } else { 0 };
        let (rows, all_rows) = (s.rows as u64, s.rows_in_space as u64);
        let (taken, together) = (s.body_steps, s.body_steps_together);
        let constants = s.constants;
        let (read, outputs) = (self.counted.outputs[0], self.counted.outputs[1]);
        vec![
            entry(
                "planar",
                skip.planar,
                s.planar_bodies as u64,
                of(bodies),
                format!(
                    "{} of {bodies} bodies solved in a plane; {rows} rows instead of {all_rows}",
                    s.planar_bodies
                ),
            ),
            entry(
                "islands",
                skip.islands,
                together.saturating_sub(taken),
                of(together),
                format!(
                    "{} solved apart; {taken} steps of bodies instead of {together} with common steps",
                    plural(s.islands, "part")
                ),
            ),
            entry(
                "fixed",
                skip.fixed,
                s.fixed_bodies as u64,
                of(bodies),
                format!("{} of {bodies} bodies tied to the ground and left out", s.fixed_bodies),
            ),
            entry(
                "constants",
                skip.constants,
                constants,
                of(constants.max(1)),
                format!("{constants} entries of the matrix that never change not written again"),
            ),
            entry(
                "checks",
                skip.checks,
                s.checks,
                of(steps),
                format!(
                    "{} of {steps} steps shown consistent by their own projection, {} measured",
                    s.checks, self.counted.checks
                ),
            ),
            entry(
                "reports",
                skip.reports,
                steps.saturating_sub(self.counted.reports),
                steps,
                format!(
                    "energy, reactions and Jacobian not found for {} of {steps} steps",
                    steps - self.counted.reports
                ),
            ),
            entry(
                "outputs",
                skip.outputs,
                read,
                outputs,
                format!("{read} of {outputs} outputs read off a step without ending one"),
            ),
        ]
    }
}

fn plural(count: usize, noun: &str) -> String {
    if count == 1 { format!("1 {noun}") } else { format!("{count} {noun}s") }
}
