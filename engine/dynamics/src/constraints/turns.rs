//! Whole turns of joint angles at positions that no run has led to. Directors tell an angle but for whole turns; where a screw is, what a
//! driver prescribes and what a gear makes of another angle tell them — eq. (4.7).

use crate::model::DriverKind;
use crate::state::{State, nearest};
use crate::system::System;
use crate::system::row::Form;
use std::f64::consts::TAU;

/// Whole turns up to which one wheel of a gear is tried, either way, where nothing tells how far it has turned.
const MOST_TURNS: i32 = 1000;
/// Part of a relation's angles by which it must be nearer to holding for more turns to count.
const NEARER: f64 = 1e-9;

/// One side of a gear: an angle and its factor.
type Wheel = (usize, f64);

/// Counts whole turns of the angles of a state so that screws, drivers and gears hold as nearly as they can, else from the angles of the
/// start. Positions and velocities have to be taken over again afterwards.
pub fn count(system: &System, state: &mut State) {
    let mut angles: Vec<f64> = state.angles().iter().map(|angle| angle.value).collect();
    for (angle, start) in angles.iter_mut().zip(system.start_angles()) {
        *angle = nearest(*angle, start);
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
            Form::Relation { angles: [Some((place, factor)), None], slide: Some(_), .. } => {
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
