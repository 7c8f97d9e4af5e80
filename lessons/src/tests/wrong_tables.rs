//! Tables of the pendulum of benchmark A01 as wrong programs write them. The motions are integrated here, without the engine.

use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Write as _;

use crate::answers::Answer;
use crate::grading::judge;
use crate::{Mark, Submission};

use super::course;

/// Share of the wrong tables that must get words of their own.
const RECOGNISED: f64 = 0.9;
/// Gravity of the benchmark, m/s².
const G: f64 = 9.81;
/// Time that the table covers, s.
const END: f64 = 10.0;
/// Rows of a table.
const ROWS: u32 = 500;

/// Angle from the downward vertical, and its rate.
type Angle = [f64; 2];

/// One step of the classical Runge-Kutta method for θ̈ = −k sin θ.
fn runge_kutta(k: f64, [a, w]: Angle, h: f64) -> Angle {
    let rate = |[a, w]: Angle| [w, -k * libm::sin(a)];
    let along = |s: Angle, r: Angle, h: f64| [s[0] + h * r[0], s[1] + h * r[1]];
    let s = [a, w];
    let k1 = rate(s);
    let k2 = rate(along(s, k1, 0.5 * h));
    let k3 = rate(along(s, k2, 0.5 * h));
    let k4 = rate(along(s, k3, h));
    [0, 1].map(|i| s[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
}

/// One step of explicit Euler.
fn explicit(k: f64, [a, w]: Angle, h: f64) -> Angle {
    [a + h * w, w - h * k * libm::sin(a)]
}

/// One step of implicit Euler, by fixed-point iteration.
fn implicit(k: f64, [a, w]: Angle, h: f64) -> Angle {
    let mut next = [a, w];
    for _ in 0..50 {
        next = [a + h * next[1], w - h * k * libm::sin(next[0])];
    }
    next
}

/// Angles at the rows of the table; the pendulum starts at rest at x = −1.
fn motion(step: fn(f64, Angle, f64) -> Angle, k: f64, start: Angle, substeps: u32) -> Vec<Angle> {
    let h = END / f64::from(ROWS * substeps);
    let mut state = start;
    let mut list = vec![state];
    for _ in 0..ROWS {
        for _ in 0..substeps {
            state = step(k, state, h);
        }
        list.push(state);
    }
    list
}

/// Time, x and y of every row as text.
fn table(angles: &[Angle], row: impl Fn(f64, f64, f64) -> [f64; 3]) -> String {
    let mut text = String::from("t,x,y\n");
    for (k, [a, _]) in angles.iter().enumerate() {
        let t = END * k as f64 / f64::from(ROWS);
        let [t, x, y] = row(t, libm::sin(*a), -libm::cos(*a));
        let _ = writeln!(text, "{t:.9},{x:.9},{y:.9}");
    }
    text
}

fn wrong_tables() -> Vec<(&'static str, String)> {
    let start = [-FRAC_PI_2, 0.0];
    let right = motion(runge_kutta, G, start, 20);
    let of = |step, k, substeps| motion(step, k, start, substeps);
    let harmonic = |k: f64| {
        let angle = |row: u32| -FRAC_PI_2 * libm::cos(k.sqrt() * END * f64::from(row) / f64::from(ROWS));
        (0..=ROWS).map(|row| [angle(row), 0.0]).collect::<Vec<Angle>>()
    };
    let plain = |t, x, y| [t, x, y];
    let rates: Vec<Angle> = right.clone();
    let mut velocities = String::from("t,x,y\n");
    for (k, [a, w]) in rates.iter().enumerate() {
        let t = END * k as f64 / f64::from(ROWS);
        let _ = writeln!(velocities, "{t},{},{}", w * libm::cos(*a), w * libm::sin(*a));
    }
    vec![
        ("mirror image", table(&right, |t, x, y| [t, -x, y])),
        ("y downwards", table(&right, |t, x, y| [t, x, -y])),
        ("both opposite", table(&right, |t, x, y| [t, -x, -y])),
        ("columns swapped", table(&right, |t, x, y| [t, y, x])),
        ("axes turned", table(&right, |t, x, y| [t, y, -x])),
        ("axes turned the other way", table(&right, |t, x, y| [t, -y, x])),
        ("centimetres", table(&right, |t, x, y| [t, 100.0 * x, 100.0 * y])),
        ("millimetres", table(&right, |t, x, y| [t, 1000.0 * x, 1000.0 * y])),
        ("degrees for radians", table(&right, |t, x, y| [t, x * 180.0 / PI, y * 180.0 / PI])),
        ("sine of degrees", table(&of(runge_kutta, G * PI / 180.0, 20), plain)),
        ("g = 10", table(&of(runge_kutta, 10.0, 20), plain)),
        ("mass for weight", table(&of(runge_kutta, 1.0, 20), plain)),
        ("no weight", table(&of(runge_kutta, 0.0, 20), plain)),
        ("small angles", table(&harmonic(G), plain)),
        ("small angles, x alone", table(&harmonic(G), |t, _, y| [t, -libm::cos(G.sqrt() * t), y])),
        ("small angles, g = 10", table(&harmonic(10.0), plain)),
        ("explicit Euler", table(&of(explicit, G, 1), plain)),
        ("explicit Euler, small steps", table(&of(explicit, G, 5), plain)),
        ("implicit Euler", table(&of(implicit, G, 1), plain)),
        ("implicit Euler, small steps", table(&of(implicit, G, 5), plain)),
        ("velocities", velocities),
        ("half the pace", table(&motion(runge_kutta, 0.25 * G, start, 20), plain)),
        ("twice the pace", table(&motion(runge_kutta, 4.0 * G, start, 20), plain)),
        ("origin at the lowest point", table(&right, |t, x, y| [t, x, y + 1.0])),
        ("origin at the start", table(&right, |t, x, y| [t, x + 1.0, y])),
        ("nothing moves", table(&right, |t, _, _| [t, -1.0, 0.0])),
        ("late by a fifth of a second", table(&right_late(0.2), plain)),
        ("longer", table(&right, |t, x, y| [t, 1.5 * x, 1.5 * y])),
        ("another start", table(&motion(runge_kutta, G, [-1.0, 0.0], 20), plain)),
        ("a rod of 2 m", table(&of(runge_kutta, 0.5 * G, 20), |t, x, y| [t, 2.0 * x, 2.0 * y])),
    ]
}

/// The motion that begins later.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a whole number from 0 to ROWS
fn right_late(by: f64) -> Vec<Angle> {
    let fine = motion(runge_kutta, G, [-FRAC_PI_2, 0.0], 20);
    let rows = (by / END * f64::from(ROWS)).round();
    (0..=ROWS).map(|k| fine[(f64::from(k) - rows).max(0.0) as usize]).collect()
}

#[test]
fn wrong_tables_get_words_of_their_own() {
    let course = course();
    let lesson = course.lesson("verification").unwrap();
    let place = lesson.exercise.questions.iter().position(|q| q.id == "your-run").unwrap();
    let judged = |text: String| {
        let answer = Answer { file: Some(text), ..Answer::default() };
        let answers = BTreeMap::from([("your-run".to_owned(), answer)]);
        judge(lesson, &Submission { answers, ..Submission::default() }).unwrap().swap_remove(place)
    };
    let right = motion(runge_kutta, G, [-FRAC_PI_2, 0.0], 20);
    assert_eq!(judged(table(&right, |t, x, y| [t, x, y])).mark, Mark::Right);
    let tables = wrong_tables();
    let all = tables.len();
    let mut recognised = 0;
    for (name, text) in tables {
        let judgement = judged(text);
        println!("{name}: {:?} {:?}", judgement.mark, judgement.misconception);
        assert_eq!(judgement.mark, Mark::Wrong, "{name}");
        recognised += usize::from(judgement.misconception.is_some());
    }
    println!("{recognised} of {all}");
    assert!(recognised as f64 >= RECOGNISED * all as f64, "{recognised} of {all}");
}
