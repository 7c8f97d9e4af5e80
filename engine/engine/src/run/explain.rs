//! What a run has left out, and what that saved.

use super::Simulation;
use serde::Serialize;

/// Something that a run leaves out unless it is switched off.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct SkippedItem {
    /// Its key in `simulation.skip`.
    pub word: &'static str,
    /// Whether it is switched on.
    pub on: bool,
    /// How much has been left out so far.
    pub saved: u64,
    /// How much there would have been in all.
    pub of: u64,
    /// Both in words.
    pub what: String,
}

/// How often a run did the work after steps and at outputs that it may leave out.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RunCounters {
    /// Outputs found by interpolation within a step, and all outputs.
    pub outputs: [u64; 2],
    /// Steps whose constraints were measured.
    pub checks: u64,
    /// Steps after which energy, reactions and Jacobian were computed although nobody asked for them.
    pub reports: u64,
}

impl SkippedItem {
    fn new(word: &'static str, on: bool, saved: u64, of: u64, what: String) -> Self {
        let what = if of == 0 { "this integrator knows nothing to leave out here".to_owned() } else { what };
        Self { word, on, saved, of, what }
    }
}

impl Simulation {
    /// What the run has left out so far, word by word.
    pub fn left_out(&self) -> Vec<SkippedItem> {
        let mut items = self.left_out_by_the_integrator();
        let skip = self.model().settings.skip;
        let steps = self.integrator.last().steps.accepted;
        let unreported = steps.saturating_sub(self.counters.reports);
        items.push(SkippedItem::new(
            "reports",
            skip.reports,
            unreported,
            steps,
            format!("energy, reactions and Jacobian not found for {unreported} of {steps} steps"),
        ));
        let [read, outputs] = self.counters.outputs;
        items.push(SkippedItem::new(
            "outputs",
            skip.outputs,
            read,
            outputs,
            format!("{read} of {outputs} outputs read off a step without ending one"),
        ));
        items
    }

    fn left_out_by_the_integrator(&self) -> Vec<SkippedItem> {
        let skip = self.model().settings.skip;
        let bodies = self.model().bodies.len() as u64;
        let steps = self.integrator.last().steps.accepted;
        let saved = self.integrator.skipped();
        let s = saved.unwrap_or_default();
        let of = |n: u64| if saved.is_some() { n } else { 0 };
        let (planar, fixed, merged) = (s.planar_bodies as u64, s.fixed_bodies as u64, s.merged_bodies as u64);
        let constants = s.constants;
        let (taken, together) = (s.body_steps, s.body_steps_together);
        let in_plane = format!(
            "{planar} of {bodies} bodies solved in a plane; {} rows instead of {}",
            s.rows, s.rows_in_space
        );
        let apart = format!(
            "{} solved apart; {taken} steps of bodies instead of {together} with common steps",
            plural(s.islands, "part")
        );
        let mut tied = format!("{fixed} of {bodies} bodies tied to the ground and left out");
        if merged > 0 {
            let rows = s.rows;
            tied = format!(
                "{tied}; {merged} merged with those that they are rigidly joined to, {rows} rows left"
            );
        }
        if s.pivoted_bodies > 0 {
            tied = format!(
                "{tied}; {} turned about points of the ground without rows for these",
                s.pivoted_bodies
            );
        }
        let unchanged = format!("{constants} entries of the matrix that never change not written again");
        let axes = s.axes as u64;
        let axis = if axes == 1 { "axis" } else { "axes" };
        let straight = format!("{axes} {axis} of joints kept without products of series");
        let proven = format!(
            "{} of {steps} steps shown consistent by their own projection, {} measured",
            s.checks, self.counters.checks
        );
        vec![
            SkippedItem::new("planar", skip.planar, planar, of(bodies), in_plane),
            SkippedItem::new("islands", skip.islands, together.saturating_sub(taken), of(together), apart),
            SkippedItem::new("fixed", skip.fixed, fixed + merged, of(bodies), tied),
            SkippedItem::new("constants", skip.constants, constants, of(constants.max(1)), unchanged),
            SkippedItem::new("axes", skip.axes, axes, of(axes.max(1)), straight),
            SkippedItem::new("checks", skip.checks, s.checks, of(steps), proven),
        ]
    }
}

fn plural(count: usize, noun: &str) -> String {
    if count == 1 { format!("1 {noun}") } else { format!("{count} {noun}s") }
}
