//! Coordinates of joints along a tree that spans the mechanism: they place all bodies, and their joints hold by themselves.
//! Joints outside the tree close loops, and remain to be solved — eq. (10.5).

use super::edge::{self, Edge, screws_of};
use super::spatial::{Placement, Twist};
use nalgebra::{Matrix3, Vector3};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::model::{BodyRef, DriverKind};
use triad_dynamics::state::{BodyState, State};
use triad_dynamics::system::System;
use triad_dynamics::system::index::FeatureId;
use triad_dynamics::system::natural::NaturalCoordinates;

/// Turn of a joint within a step above which whole turns of angles that no coordinate tells could be miscounted, or half turns be missed by
/// drivers, rad.
const LONGEST_TURN: f64 = 1.5;

/// The angle of a joint as a coordinate of the tree, times a factor and from an offset on.
#[derive(Clone, Copy, Debug)]
struct Told {
    angle: usize,
    place: usize,
    factor: f64,
    offset: f64,
}

/// The tree, with the placements and velocities that it was given last.
#[derive(Clone, Debug)]
pub struct Tree {
    /// Each after the one of its parent.
    edges: Vec<Edge>,
    /// How many of them are joints: the others are bodies that move freely.
    joints: usize,
    length: f64,
    /// Angles that must not turn far within a step, with their values at its start: none where coordinates tell all turns that count, and
    /// nothing drives an angle.
    watched: Vec<(usize, f64)>,
    /// Angles that coordinates tell.
    told: Vec<Told>,
    placements: Vec<Placement>,
    velocities: Vec<Twist>,
    /// Twist of each coordinate.
    twists: Vec<Twist>,
    /// How it changes while the coordinates move uniformly.
    drags: Vec<Twist>,
    /// Scratch: of bodies.
    accelerations: Vec<Twist>,
    natural: Vec<NaturalCoordinates>,
}

impl Tree {
    /// The tree of a mechanism at the state in place, where all coordinates are zero.
    pub fn new(mechanism: &Mechanism) -> Self {
        let system = &mechanism.system;
        let bodies = system.bodies.len();
        let places: Vec<Placement> = mechanism.state.bodies().iter().map(placement).collect();
        let (edges, joints) = span(system, &places);
        let coordinates = edges.last().map_or(0, |edge| edge.range().end);
        let told: Vec<Told> =
            (0..system.angles.len()).filter_map(|k| Told::new(mechanism, &edges, k)).collect();
        let counted = told.iter().filter(|told| told.angle < system.needed_angles).count();
        // The row of a driven angle holds half a turn away as well, and a long step would find that.
        let mut drivers = system.model.drivers.iter();
        let watches = counted < system.needed_angles
            || drivers.any(|driver| matches!(driver.kind, DriverKind::Angle { .. }));
        let watched = edges.iter().filter(|_| watches).flat_map(Edge::angles).map(|place| (place, 0.0));
        Self {
            watched: watched.collect(),
            told,
            length: system.length,
            placements: places,
            velocities: vec![Twist::zero(); bodies],
            twists: vec![Twist::zero(); coordinates],
            drags: vec![Twist::zero(); coordinates],
            accelerations: vec![Twist::zero(); bodies],
            natural: vec![NaturalCoordinates::default(); bodies],
            edges,
            joints,
        }
    }

    /// How each body moves against another, each after the one of its parent.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// The coordinate that alone turns one of two bodies against the other, and the angle about an axis of the first one for each unit of it,
    /// at the state in place.
    pub fn turn_between(&self, state: &State, bodies: [BodyRef; 2], axis: FeatureId) -> Option<(usize, f64)> {
        turn_between(&self.edges, state, bodies, axis)
    }

    /// Number of joints that hold by themselves.
    pub fn joints(&self) -> usize {
        self.joints
    }

    /// Twist of a coordinate at the positions in place.
    pub fn twist(&self, place: usize) -> &Twist {
        &self.twists[place]
    }

    /// How that twist changes for each unit of its coordinate's rate, at the velocities in place.
    pub fn drag(&self, place: usize) -> &Twist {
        &self.drags[place]
    }

    /// Twist of a body at the velocities in place.
    pub fn velocity(&self, body: usize) -> &Twist {
        &self.velocities[body]
    }

    /// Number of coordinates.
    pub fn coordinates(&self) -> usize {
        self.twists.len()
    }

    /// 1 for coordinates that are angles, 1/length² for those that are lengths.
    pub fn weights(&self) -> Vec<f64> {
        let mut weights = vec![1.0 / (self.length * self.length); self.coordinates()];
        for place in self.edges.iter().flat_map(Edge::angles) {
            weights[place] = 1.0;
        }
        weights
    }

    /// Whether no joint has turned too far since the last step, at coordinates by their places.
    pub fn reaches(&self, s: impl Fn(usize) -> f64) -> bool {
        self.watched.iter().all(|&(place, start)| (s(place) - start).abs() <= LONGEST_TURN)
    }

    /// Says which angles belong to the coordinates s at the state's time, however many turns those have made.
    pub fn tell(&self, state: &mut State, s: &[f64]) {
        for &Told { angle, place, factor, offset } in &self.told {
            state.expect_angle(angle, offset + factor * s[place]);
        }
    }

    /// Positions of all bodies at the coordinates s; nothing if a joint has turned too far since the last step.
    pub fn place(&mut self, s: &[f64]) -> Option<&[NaturalCoordinates]> {
        if !self.reaches(|place| s[place]) {
            return None;
        }
        for edge in &self.edges {
            let twists = &mut self.twists[edge.range()];
            let mut at = edge.relative(&s[edge.range()], twists);
            if let Some(parent) = edge.parent {
                let parent = &self.placements[parent];
                at = parent.after(&at);
                for twist in twists.iter_mut() {
                    *twist = parent.carry(twist);
                }
            }
            self.placements[edge.body] = at;
            self.natural[edge.body] = NaturalCoordinates { r: at.at, e: at.directors() };
        }
        Some(&self.natural)
    }

    /// Velocities of all bodies at the rates of the coordinates, at the positions in place.
    pub fn move_at(&mut self, rates: &[f64]) -> &[NaturalCoordinates] {
        for edge in &self.edges {
            let mut velocity = edge.parent.map_or_else(Twist::zero, |parent| self.velocities[parent]);
            for place in edge.range() {
                self.drags[place] = velocity.drag(&self.twists[place]);
                velocity = velocity + self.twists[place] * rates[place];
            }
            self.velocities[edge.body] = velocity;
            let at = &self.placements[edge.body];
            let [u, v, w] = at.directors();
            let e = [velocity.spin.cross(&u), velocity.spin.cross(&v), velocity.spin.cross(&w)];
            self.natural[edge.body] = NaturalCoordinates { r: velocity.at(&at.at), e };
        }
        &self.natural
    }

    /// Rates of the coordinates for velocities of the bodies, given as (ṙ, ω), at the positions in place.
    pub fn rates(&mut self, of: impl Fn(usize) -> [Vector3<f64>; 2], rates: &mut [f64]) {
        for (body, twist) in self.accelerations.iter_mut().enumerate() {
            let [velocity, spin] = of(body);
            *twist = Twist::through(&self.placements[body].at, &velocity, &spin);
        }
        for edge in &self.edges {
            let own = self.accelerations[edge.body];
            let beyond = edge.parent.map_or(own, |parent| own - self.accelerations[parent]);
            let at = &self.placements[edge.body].at;
            edge::solve(&self.twists[edge.range()], &beyond, at, self.length, &mut rates[edge.range()]);
        }
    }

    /// Second derivatives of the coordinates for accelerations (r̈, ω̇) of the bodies, at the positions and velocities in place.
    pub fn second_derivatives(
        &mut self,
        of: impl Fn(usize) -> [Vector3<f64>; 2],
        rates: &[f64],
        out: &mut [f64],
    ) {
        for (body, twist) in self.accelerations.iter_mut().enumerate() {
            let [acceleration, turning] = of(body);
            let (at, moving) = (&self.placements[body].at, &self.velocities[body]);
            *twist = Twist::through(at, &acceleration, &turning);
            twist.flow -= moving.spin.cross(&moving.at(at));
        }
        let Self { edges, twists, drags, placements, accelerations, length, .. } = self;
        // Children before their parents, whose own share must still be in place.
        for edge in edges.iter().rev() {
            let drag = edge.range().fold(Twist::zero(), |sum, place| sum + drags[place] * rates[place]);
            let own = accelerations[edge.body] - drag;
            let beyond = edge.parent.map_or(own, |parent| own - accelerations[parent]);
            let at = &placements[edge.body].at;
            edge::solve(&twists[edge.range()], &beyond, at, *length, &mut out[edge.range()]);
        }
    }

    /// Counts turns from the coordinates s on.
    pub fn commit(&mut self, s: &[f64]) {
        for (place, start) in &mut self.watched {
            *start = s[*place];
        }
    }

    /// Whether a body has turned so far that its three angles should start anew.
    pub fn is_tilted(&self, s: &[f64]) -> bool {
        self.edges.iter().any(|edge| edge.is_tilted(&s[edge.range()]))
    }

    /// Starts the angles of bodies anew that have turned far, at the coordinates s with their rates.
    pub fn restart(&mut self, s: &mut [f64], rates: &mut [f64]) {
        let before = self.clone();
        for edge in &mut self.edges {
            if edge.is_tilted(&s[edge.range()]) {
                *edge = edge.restarted(&s[edge.range()]);
            }
        }
        self.translate(&before, s, rates);
    }

    /// Whether its coordinates are those of another tree of the same mechanism.
    pub fn is_same(&self, other: &Self) -> bool {
        self.edges.iter().zip(&other.edges).all(|(edge, other)| edge.is_same(other))
    }

    /// Takes coordinates and rates of this tree before it was restarted, `other`, over into those that it has now.
    pub fn translate(&self, other: &Self, s: &mut [f64], rates: &mut [f64]) {
        for (edge, other) in self.edges.iter().zip(&other.edges).filter(|(edge, other)| !edge.is_same(other))
        {
            edge.translate(other, &mut s[edge.range()], &mut rates[edge.range()], self.length);
        }
    }
}

impl Told {
    /// The angle of a joint at the state in place, where all coordinates are zero.
    fn new(Mechanism { system, state, .. }: &Mechanism, edges: &[Edge], angle: usize) -> Option<Self> {
        let joint = system.model.joints.iter().find(|joint| joint.name == system.angle_joints[angle])?;
        let (place, factor) = turn_between(edges, state, joint.bodies, system.angles[angle].axis)?;
        Some(Self { angle, place, factor, offset: state.angles()[angle].value })
    }
}

/// The coordinate that alone turns one of two bodies against the other, at the state in place, and the angle about an axis of the first one
/// for each unit of it.
fn turn_between(
    edges: &[Edge],
    state: &State,
    bodies: [BodyRef; 2],
    axis: FeatureId,
) -> Option<(usize, f64)> {
    let index = |body: BodyRef| match body {
        BodyRef::Ground => None,
        BodyRef::Moving(body) => Some(body),
    };
    let [i, j] = bodies.map(index);
    edges.iter().find_map(|edge| {
        let own = Some(edge.body);
        let along = if own == j && edge.parent == i {
            1.0
        } else if own == i && edge.parent == j {
            -1.0
        } else {
            return None;
        };
        let (place, turn) = edge.only_turn()?;
        let world = edge.parent.map_or(turn, |parent| state.bodies()[parent].q.arm(&turn));
        Some((place, along * world.dot(&state.feature_value(axis))))
    })
}

fn placement(body: &BodyState) -> Placement {
    Placement { turn: Matrix3::from_columns(&body.q.e), at: body.q.r }
}

/// Edges that reach all bodies from the ground, each by the joint that leaves the fewest motions, and how many are joints; a body that
/// no such joint holds moves freely.
fn span(system: &System, places: &[Placement]) -> (Vec<Edge>, usize) {
    let mut reached = vec![false; places.len()];
    let mut edges: Vec<Edge> = Vec::with_capacity(places.len());
    let mut joints = 0;
    let known = |reached: &[bool], body: BodyRef| match body {
        BodyRef::Ground => true,
        BodyRef::Moving(body) => reached[body],
    };
    while edges.len() < places.len() {
        let first = edges.last().map_or(0, |edge| edge.range().end);
        let reaching = system.model.joints.iter().filter_map(|joint| {
            let [i, j] = joint.bodies.map(|body| known(&reached, body));
            let side = usize::from(!i);
            screws_of(joint).filter(|_| i != j).map(|screws| (screws, joint, side))
        });
        let nearest = reaching.min_by_key(|(screws, ..)| *screws);
        let edge = if let Some((joint, side, parent, BodyRef::Moving(body))) =
            nearest.map(|(_, joint, side)| (joint, side, joint.bodies[side], joint.bodies[1 - side]))
        {
            let parent = match parent {
                BodyRef::Ground => None,
                BodyRef::Moving(parent) => Some(parent),
            };
            joints += 1;
            let from = parent.map_or_else(Placement::identity, |parent| places[parent]);
            Edge::by_joint(joint, side, [body, first], parent, places[body].seen_from(&from))
        } else {
            let body = reached.iter().position(|reached| !reached).unwrap_or(0);
            Edge::free([body, first], places[body])
        };
        reached[edge.body] = true;
        edges.push(edge);
    }
    (edges, joints)
}
