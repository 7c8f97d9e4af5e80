//! Whole turns of joint angles at positions that no run has led to. Directors tell an angle but for whole turns; where a screw is, what a
//! driver prescribes and what a gear makes of another angle tell them — eq. (4.7).

use crate::model::DriverKind;
use crate::state::{State, nearest};
use crate::system::System;
use crate::system::row::Form;
use std::f64::consts::{PI, TAU};

/// Whole turns up to which one wheel of a gear is tried, either way, where nothing tells how far it has turned.
const MOST_TURNS: i32 = 1000;
/// Part of a relation's angles by which it must be nearer to holding for more turns to count.
const NEARER: f64 = 1e-9;

/// One side of a gear: an angle and its factor.
type Wheel = (usize, f64);

/// Counts whole turns of the angles of a state so that screws, drivers and gears hold as nearly as they can, else from the angles of the
/// start. Positions and velocities have to be taken over again afterwards.
pub fn count(system: &System, state: &mut State) {
    count_from(system, state, system.start_angles());
}

/// Goes on counting whole turns where another run of the same joints stood, `angles`, as far as screws, drivers and gears of this one say
/// nothing else; of what they do say, where it is more than half a turn away, tells in sentences.
pub fn go_on(system: &System, state: &mut State, angles: &[f64]) -> Vec<String> {
    count_from(system, state, angles.iter().copied());
    let counted = state.angles().iter().map(|angle| angle.reference);
    let joints = system.angle_joints.iter().zip(angles.iter().zip(counted));
    let other = joints.filter(|(_, (from, to))| (*to - *from).abs() > PI);
    other.map(|(joint, (from, to))| {
        format!("joint \"{joint}\": its angle goes on at {to:.4} rad, as drivers, gears and screws say; it stood at {from:.4} rad")
    }).collect()
}

fn count_from(system: &System, state: &mut State, from: impl Iterator<Item = f64>) {
    let mut angles: Vec<f64> = state.angles().iter().map(|angle| angle.value).collect();
    for (angle, from) in angles.iter_mut().zip(from) {
        *angle = nearest(*angle, from);
    }
    let mut known = vec![false; angles.len()];
    let set = |angles: &mut [f64], known: &mut [bool], place: usize, wanted: f64| {
        angles[place] = nearest(angles[place], wanted);
        known[place] = true;
    };
    for driver in &system.model.drivers {
        let DriverKind::Angle { joint, motion } = &driver.kind else { continue };
        let name = &system.model.joints[*joint].name;
        if let Some(place) = system.angle_joints.iter().position(|joint| joint == name) {
            set(&mut angles, &mut known, place, motion.at(state.time())[0]);
        }
    }
    let mut gears: Vec<([Wheel; 2], f64)> = Vec::new();
    for row in &system.rows {
        match row.form {
            Form::Relation { angles: [Some((place, factor)), None], slide: Some(_), .. } if !known[place] => {
                // What is left of the row is what the angle lacks.
                let left = state.relation(&row.form).value / factor;
                set(&mut angles, &mut known, place, state.angles()[place].value - left);
            }
            Form::Relation { angles: [Some(first), Some(second)], constant, .. } => {
                gears.push(([first, second], constant));
            }
            _ => {}
        }
    }
    while !gears.is_empty() {
        // From what is known, as long as that leads on.
        let leads_on = gears.iter().position(|([(a, _), (b, _)], _)| known[*a] || known[*b]);
        let (wheels, constant) = gears.remove(leads_on.unwrap_or(0));
        let [(first, of_first), (second, of_second)] = wheels;
        let other = |angle: f64, by: f64, over: f64| (constant - by * angle) / over;
        if leads_on.is_none() {
            let turns = turns_of(wheels, constant, &angles);
            let turned = angles[first] + turns;
            set(&mut angles, &mut known, first, turned);
        }
        if known[first] && !known[second] {
            let wanted = other(angles[first], of_first, of_second);
            set(&mut angles, &mut known, second, wanted);
        } else if known[second] && !known[first] {
            let wanted = other(angles[second], of_second, of_first);
            set(&mut angles, &mut known, first, wanted);
        }
    }
    state.set_revolutions(angles.into_iter());
}

/// Whole turns of the first wheel, as an angle, with which the second one meets the gear best: no more of them than that takes.
fn turns_of([(first, of_first), (second, of_second)]: [Wheel; 2], constant: f64, angles: &[f64]) -> f64 {
    let mut best = (f64::INFINITY, 0.0);
    for turns in (0..=MOST_TURNS).flat_map(|turns| [turns, -turns]) {
        let turned = f64::from(turns) * TAU;
        let wanted = (constant - of_first * (angles[first] + turned)) / of_second;
        let off = (wanted - nearest(angles[second], wanted)).abs();
        if off < best.0 - NEARER * (1.0 + wanted.abs()) {
            best = (off, turned);
        }
    }
    best.1
}
