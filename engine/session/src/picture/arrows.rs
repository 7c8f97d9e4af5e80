//! How forces are drawn: which of them, on which side, about which point, and how long.
//!
//! One scale for the whole scene. An arrow that would be longer than the longest is drawn as two in a row. A moment is
//! three quarters of a circle in its sense; one that would be larger than the largest is drawn as two circles.

use triad_engine::reactions::report::Side;

use super::description::{JointVisual, SceneDescription};
use super::sample::Sample;
use super::scale::{NO_MOMENT, has_moment};
use super::vector::{cross, minus, norm, plus, times};
use crate::drawing::{Arrows, DrawnForces, MomentPoint};

/// What an arrow shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ArrowKind {
    /// A joint's force.
    Reaction,
    /// A joint's moment: the head of its circle.
    Moment,
    /// A body's weight.
    Weight,
    /// What loads and springs do to a body, together.
    Load,
}

/// A piece of an arrow as the viewer draws it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// What it shows.
    pub kind: ArrowKind,
    /// Where it starts, m.
    pub from: [f64; 3],
    /// To where, from there, m.
    pub vector: [f64; 3],
}

/// What is drawn of a joint at one instant.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Glyphs {
    /// Arrows.
    pub pieces: Vec<Piece>,
    /// Circles of moments.
    pub circles: Vec<Vec<[f64; 3]>>,
}

/// The smallest circle that is drawn, relative to the size of the mechanism: a smaller one is not seen to turn.
const SMALLEST_CIRCLE: f64 = 0.06;
/// Radius of the rings about a marked joint, relative to the size of the mechanism.
const RING: f64 = 0.18;
/// Points on a circle.
const POINTS: usize = 25;

impl Arrows {
    /// Whether the forces are drawn alike, whatever is marked.
    pub fn draw_as(&self, other: &Self) -> bool {
        (self.on, self.about, &self.drawn) == (other.on, other.about, &other.drawn)
    }

    /// Three rings about the marked joint, wide enough to be seen around the bodies that meet there.
    pub fn mark(&self, description: &SceneDescription, sample: &Sample) -> Vec<Vec<[f64; 3]>> {
        let marked = self.marked.as_ref();
        let joint = marked.and_then(|name| description.joints.iter().position(|visual| visual.name == *name));
        let Some(reaction) = joint.and_then(|joint| sample.reactions.get(joint)) else { return Vec::new() };
        let ring = |axis: usize| {
            let turned = |k: usize| {
                let (sin, cos) = libm::sincos(std::f64::consts::TAU * k as f64 / (POINTS - 1) as f64);
                let mut at = reaction.at;
                at[(axis + 1) % 3] += RING * description.size * cos;
                at[(axis + 2) % 3] += RING * description.size * sin;
                at
            };
            (0..POINTS).map(turned).collect()
        };
        (0..3).map(ring).collect()
    }

    /// The glyphs of a joint at one instant.
    pub fn of_joint(&self, description: &SceneDescription, joint: usize, sample: &Sample) -> Glyphs {
        let visual = &description.joints[joint];
        let mut glyphs = Glyphs::default();
        let Some(reaction) = sample.reactions.get(joint) else { return glyphs };
        let Some((sign, body)) = self.side_of(visual, description) else { return glyphs };
        let force = times(reaction.force, sign);
        let mut moment = times(reaction.moment, sign);
        let mut at = reaction.at;
        let mut is_moment = has_moment(reaction, description.size);
        if let (MomentPoint::Center, Some(body)) = (self.about, body) {
            let center = sample.poses[body].position;
            moment = plus(moment, cross(minus(at, center), force));
            at = center;
            is_moment = norm(moment) > NO_MOMENT * description.size * norm(force).max(1e-300);
        }
        arrow(
            &mut glyphs.pieces,
            ArrowKind::Reaction,
            at,
            times(force, description.scale.force),
            description.scale.longest,
        );
        if is_moment {
            circle(&mut glyphs, at, moment, description);
        }
        glyphs
    }

    /// The sign of a joint's force, and the body that it acts on; nothing if it is not drawn.
    fn side_of(&self, visual: &JointVisual, description: &SceneDescription) -> Option<(f64, Option<usize>)> {
        let first = (1.0, visual.on);
        let second = (-1.0, visual.by);
        match &self.drawn {
            DrawnForces::None => None,
            DrawnForces::Joint(name) if *name != visual.name => None,
            DrawnForces::All | DrawnForces::Joint(_) => Some(if self.on == Side::J { first } else { second }),
            DrawnForces::Body(name) => {
                let body = description.bodies.iter().position(|body| body.name == *name)?;
                [first, second].into_iter().find(|(_, on)| *on == Some(body))
            }
        }
    }

    /// Weight and loads of the body that is cut free, if one is.
    pub fn of_body(&self, description: &SceneDescription, sample: &Sample) -> Vec<Piece> {
        let DrawnForces::Body(name) = &self.drawn else { return Vec::new() };
        let Some(body) = description.bodies.iter().position(|body| body.name == *name) else {
            return Vec::new();
        };
        let (weight, at) = (sample.weights[body], sample.poses[body].position);
        // What neither weight nor joints account for is what loads and springs do.
        let mut rest = minus(sample.inertia[body], weight);
        let mut largest = norm(weight).max(norm(rest));
        for (visual, reaction) in description.joints.iter().zip(&sample.reactions) {
            if let Some((sign, _)) = self.side_of(visual, description) {
                rest = minus(rest, times(reaction.force, sign));
                largest = largest.max(norm(reaction.force));
            }
        }
        let mut pieces = Vec::new();
        arrow(
            &mut pieces,
            ArrowKind::Weight,
            at,
            times(weight, description.scale.force),
            description.scale.longest,
        );
        if sample.reactions.len() == description.joints.len() && norm(rest) > 1e-6 * largest {
            arrow(
                &mut pieces,
                ArrowKind::Load,
                at,
                times(rest, description.scale.force),
                description.scale.longest,
            );
        }
        pieces
    }
}

/// Three quarters of a circle about a moment's axis, with a head where it turns to.
fn circle(glyphs: &mut Glyphs, at: [f64; 3], moment: [f64; 3], description: &SceneDescription) {
    let size = norm(moment);
    let largest = 0.5 * description.scale.longest;
    let wanted = size * description.scale.moment;
    if !wanted.is_finite() || wanted < 1e-3 * largest {
        return;
    }
    let axis = times(moment, 1.0 / size);
    let across = if axis[0].abs() < 0.9 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let a = cross(axis, across);
    let a = times(a, 1.0 / norm(a));
    let b = cross(axis, a);
    let on = |radius: f64, angle: f64| {
        plus(at, plus(times(a, radius * libm::cos(angle)), times(b, radius * libm::sin(angle))))
    };
    let end = 1.5 * std::f64::consts::PI;
    let around =
        |radius: f64| (0..POINTS).map(|k| on(radius, end * k as f64 / (POINTS - 1) as f64)).collect();
    let radius = wanted.clamp(SMALLEST_CIRCLE * description.size, largest);
    glyphs.circles.push(around(radius));
    if wanted > largest {
        glyphs.circles.push(around(0.85 * radius));
    }
    let forward = minus(times(b, libm::cos(end)), times(a, libm::sin(end)));
    let vector = times(forward, 0.1 * description.size);
    glyphs.pieces.push(Piece { kind: ArrowKind::Moment, from: on(radius, end), vector });
}

/// An arrow in pieces: two in a row where it would be too long.
fn arrow(pieces: &mut Vec<Piece>, kind: ArrowKind, from: [f64; 3], vector: [f64; 3], longest: f64) {
    let length = norm(vector);
    if !length.is_finite() || length < 1e-3 * longest {
        return;
    }
    let mut last = (from, vector);
    if length > longest {
        let drawn = times(vector, longest / length);
        pieces.push(Piece { kind, from, vector: times(drawn, 0.46) });
        last = (plus(from, times(drawn, 0.54)), times(drawn, 0.46));
    }
    pieces.push(Piece { kind, from: last.0, vector: last.1 });
}

#[cfg(test)]
mod tests {
    use super::super::description::BodyVisual;
    use super::super::sample::{Pose, SampledReaction};
    use super::super::scale::Scale;
    use super::*;

    #[test]
    fn rings_are_about_the_marked_joint_and_about_no_other() {
        let (description, sample) = hanging();
        let marked = Arrows { marked: Some("pin".into()), ..Arrows::default() };
        let rings = marked.mark(&description, &sample);
        assert_eq!(rings.len(), 3);
        for point in rings.iter().flatten() {
            assert!((norm(minus(*point, sample.reactions[0].at)) - RING * description.size).abs() < 1e-12);
        }
        assert!(Arrows::default().mark(&description, &sample).is_empty());
        assert!(Arrows { marked: Some("no joint".into()), ..marked }.mark(&description, &sample).is_empty());
    }

    /// Axes of the world.
    const AXES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    /// A body of 2 kg that hangs at a pin, which turns it too.
    fn hanging() -> (SceneDescription, Sample) {
        let bob = BodyVisual {
            name: "bob".into(),
            shapes: Vec::new(),
            center_of_mass: [0.0; 3],
            principal_axes: AXES,
            joint_points: Vec::new(),
            markers: Vec::new(),
        };
        let pin = JointVisual { name: "pin".into(), rows: Vec::new(), on: Some(0), by: None };
        let description = SceneDescription {
            title: String::new(),
            bodies: vec![bob],
            joints: vec![pin],
            ground_markers: Vec::new(),
            pattern: super::super::description::Pattern::default(),
            gravity: [0.0, -10.0, 0.0],
            size: 1.0,
            center: [0.0; 3],
            reach: 1.0,
            scale: Scale { force: 0.01, moment: 0.1, longest: 0.8 },
        };
        let reaction = SampledReaction {
            at: [0.0; 3],
            force: [0.0, 25.0, 0.0],
            moment: [0.0, 0.0, 2.0],
            multipliers: Vec::new(),
        };
        let sample = Sample {
            time: 0.0,
            poses: vec![Pose {
                position: [1.0, 0.0, 0.0],
                axes: AXES,
                velocity: [0.0; 3],
                angular_velocity: [0.0; 3],
                acceleration: [0.0; 3],
            }],
            weights: vec![[0.0, -20.0, 0.0]],
            inertia: vec![[0.0, 5.0, 0.0]],
            reactions: vec![reaction],
            energy: 0.0,
            position_violation: 0.0,
            velocity_violation: 0.0,
        };
        (description, sample)
    }

    #[test]
    fn arrows_turn_with_the_body_and_move_with_the_point() {
        let (description, sample) = hanging();
        let mut arrows = Arrows::default();
        let on_j = arrows.of_joint(&description, 0, &sample);
        assert_eq!(
            on_j.pieces[0],
            Piece { kind: ArrowKind::Reaction, from: [0.0; 3], vector: [0.0, 0.25, 0.0] }
        );
        assert_eq!((on_j.pieces.len(), on_j.circles.len()), (2, 1), "an arrow, a circle and its head");
        assert!(on_j.circles[0].iter().all(|p| (norm(*p) - 0.2).abs() < 1e-12 && p[2] == 0.0));
        // It turns as the moment does: counter-clockwise about +z.
        assert!(cross(on_j.circles[0][0], on_j.circles[0][1])[2] > 0.0);
        arrows.on = Side::I;
        let on_i = arrows.of_joint(&description, 0, &sample);
        assert_eq!(on_i.pieces[0].vector, [0.0, -0.25, 0.0]);
        assert!(cross(on_i.circles[0][0], on_i.circles[0][1])[2] < 0.0);
        // About the centre of mass: M + (at − c) × F = 2 − 25 N m, and that is too large to be drawn.
        arrows = Arrows { about: MomentPoint::Center, ..Arrows::default() };
        let about = arrows.of_joint(&description, 0, &sample);
        assert_eq!(about.pieces[0].from, [1.0, 0.0, 0.0]);
        assert_eq!(about.circles.len(), 2, "larger than drawn");
        assert!((norm(minus(about.circles[0][0], [1.0, 0.0, 0.0])) - 0.4).abs() < 1e-12);
        arrows.drawn = DrawnForces::Joint("other".into());
        assert_eq!(arrows.of_joint(&description, 0, &sample), Glyphs::default());
    }

    #[test]
    fn an_arrow_that_would_be_too_long_is_two_in_a_row() {
        let (mut description, sample) = hanging();
        description.scale.force = 1.0;
        let pieces = Arrows::default().of_joint(&description, 0, &sample).pieces;
        let [first, second] = pieces[..2] else { panic!("two pieces: {pieces:?}") };
        assert!((second.from[1] + second.vector[1] - 0.8).abs() < 1e-12, "the tip is at the longest length");
        assert!(first.vector[1] < second.from[1], "with a gap between them");
    }

    #[test]
    fn a_body_that_is_cut_free_has_all_its_forces() {
        let (description, mut sample) = hanging();
        let arrows = Arrows { drawn: DrawnForces::Body("bob".into()), ..Arrows::default() };
        // m a = 25 N − 20 N: nothing is left for loads.
        let pieces = arrows.of_body(&description, &sample);
        assert_eq!(
            pieces,
            [Piece { kind: ArrowKind::Weight, from: [1.0, 0.0, 0.0], vector: [0.0, -0.2, 0.0] }]
        );
        sample.inertia[0] = [2.0, 5.0, 0.0];
        let pieces = arrows.of_body(&description, &sample);
        assert_eq!(
            pieces[1],
            Piece { kind: ArrowKind::Load, from: [1.0, 0.0, 0.0], vector: [0.02, 0.0, 0.0] }
        );
    }

    #[test]
    fn the_scale_is_that_of_the_recording_and_one_outlier_does_not_make_it() {
        let (description, sample) = hanging();
        let mut samples = vec![sample; 100];
        samples[50].reactions[0].force = [0.0, 1e6, 0.0];
        let scale = description.scale.fitted(samples.iter(), 1.0);
        assert!((scale.force - 0.5 / 25.0).abs() < 1e-12, "{scale:?}");
        assert!((scale.moment - 0.22 / 2.0).abs() < 1e-12, "{scale:?}");
        assert!(
            scale.is_near(Scale { force: scale.force * 1.1, ..scale }) && !scale.is_near(description.scale)
        );
    }
}
