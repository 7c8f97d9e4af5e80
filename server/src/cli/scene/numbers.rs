//! Numbers of mechanisms of any size, for people: what is small beside the largest of its kind is nothing, what is not keeps its digits.

use triad_engine::reactions::report::{Reaction, ReactionComponent, ReactionReport};
use triad_engine::scene::Scene;
use triad_engine::state::BodyFrame;

use crate::cli::terminal::print_line;

/// Half of the last place that is shown, as a part of the largest number of a kind, or of one where that is larger.
pub(super) const LEAST: f64 = 5e-7;
/// Part of what forces do over the length of a mechanism below which moments are their rounding, and forces likewise.
const ROUNDING: f64 = 1e-12;

/// Six places, or six digits of what would be lost in them.
pub(super) fn digits(x: f64) -> String {
    if x == 0.0 || (1e-3..1e7).contains(&x.abs()) { format!("{:.6}", x + 0.0) } else { format!("{x:.6e}") }
}

/// The same, and zero for what is nothing.
fn unless(x: f64, nothing: f64) -> String {
    digits(if x.abs() < nothing { 0.0 } else { x })
}

/// What is nothing beside the largest number of its kind.
fn nothing(largest: f64) -> f64 {
    LEAST * largest.min(1.0)
}

/// A vector among others whose largest component this is.
pub(super) fn triple(v: [f64; 3], largest: f64) -> String {
    let [x, y, z] = v.map(|x| unless(x, nothing(largest)));
    format!("({x}, {y}, {z})")
}

/// The largest component of vectors.
pub(super) fn largest(vectors: &[[f64; 3]]) -> f64 {
    vectors.as_flattened().iter().fold(0.0, |most, x| most.max(x.abs()))
}

/// How large the numbers of a state are.
pub(super) struct Scale {
    /// Coordinates, m.
    length: f64,
    /// Forces, N, and moments, N m, that are nothing.
    no_force: f64,
    no_moment: f64,
}

impl Scale {
    /// Of places alone.
    pub(super) fn of_places(bodies: &[BodyFrame]) -> Self {
        let length = bodies.iter().fold(0.0f64, |most, body| most.max(largest(&[body.position])));
        Self { length, no_force: 0.0, no_moment: 0.0 }
    }

    /// Of places and reactions.
    pub(super) fn of(bodies: &[BodyFrame], report: &ReactionReport) -> Self {
        let length = Self::of_places(bodies).length;
        let of = |part: fn(&Reaction) -> &[ReactionComponent; 3]| {
            let parts = report.reactions.iter().flat_map(part);
            parts.fold(0.0f64, |most, component| most.max(component.value.abs()))
        };
        let (force, moment) = (of(|reaction| &reaction.force), of(|reaction| &reaction.moment));
        let from_moments = if length > 0.0 { ROUNDING * moment / length } else { 0.0 };
        Self {
            length,
            no_force: nothing(force).max(from_moments),
            no_moment: nothing(moment).max(ROUNDING * force * length),
        }
    }

    /// Where bodies are.
    pub(super) fn print_bodies(&self, scene: &Scene, frames: &[BodyFrame]) {
        for (body, frame) in scene.bodies.iter().zip(frames) {
            self.print_body(&body.name, frame);
        }
    }

    fn print_body(&self, name: &str, frame: &BodyFrame) {
        let (place, u) = (triple(frame.position, self.length), triple(frame.u, 1.0));
        print_line(&format!("  {name}: centre of mass {place} m, u {u}"));
    }

    /// Where bodies are, and how they move.
    pub(super) fn print_moving(&self, scene: &Scene, frames: &[BodyFrame]) {
        let of = |part: fn(&BodyFrame) -> [f64; 3]| largest(&frames.iter().map(part).collect::<Vec<_>>());
        let (fastest, turning) = (of(|frame| frame.velocity), of(|frame| frame.angular_velocity));
        for (body, frame) in scene.bodies.iter().zip(frames) {
            self.print_body(&body.name, frame);
            let (v, omega) = (triple(frame.velocity, fastest), triple(frame.angular_velocity, turning));
            print_line(&format!("    velocity {v} m/s, angular velocity {omega} rad/s"));
        }
    }

    /// Reactions, and what is not unique about them.
    pub(super) fn print_reactions(&self, report: &ReactionReport) {
        for reaction in &report.reactions {
            self.print_reaction(reaction);
        }
        if report.redundancies.is_empty() {
            print_line("  every reaction is unique");
        } else {
            print_line(&format!(
                "  ~ marks what the equations of motion leave open (tolerance {:.0e}); the smallest such values are shown",
                report.tolerance
            ));
        }
        for redundancy in &report.redundancies {
            print_line(&format!(
                "  {} redundant rows are shared by {}",
                redundancy.rows,
                redundancy.joints.join(", ")
            ));
            for remedy in &redundancy.remedies {
                print_line(&format!(
                    "    remedy: make \"{}\" a {} joint, which gives up {}",
                    remedy.joint, remedy.becomes, remedy.gives_up
                ));
            }
        }
    }

    /// One of them.
    pub(super) fn print_reaction(&self, reaction: &Reaction) {
        let line = |what: &str, unit: &str, components: &[ReactionComponent; 3], nothing: f64| {
            let number = |c: &ReactionComponent| {
                let value = unless(c.value, nothing);
                format!("{:>15}", if c.unique { value } else { format!("~{value}") })
            };
            let numbers = components.each_ref().map(number).concat();
            print_line(&format!("    {what:<8}{numbers} {unit}"));
        };
        print_line(&format!(
            "  {}{}: on \"{}\" by \"{}\", about {}, in {}",
            if reaction.driver { "driver " } else { "" },
            reaction.joint,
            reaction.on,
            reaction.by,
            reaction.about,
            reaction.expressed_in
        ));
        line("force", "N", &reaction.force, self.no_force);
        line("moment", "N m", &reaction.moment, self.no_moment);
    }
}
