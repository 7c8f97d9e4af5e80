//! What a dip of a pivot product is: a passage of a singular configuration, or a place where branches of the motion only come
//! near each other — THEORY section 8.
//!
//! On both sides of a singular configuration the motion is that of one smooth curve: two states beside it, moved onto the
//! constraints, have one between them, by Hermite's interpolation, that is on the constraints up to the fourth power of their
//! distance. Where branches do not meet, it lies between two of them, and the constraints are open by what keeps them apart.

use crate::integrate::{Track, hermite};
use triad_linalg::{largest_difference, largest_size};

/// Distance of the two states from the dip, as an angle, rad: its fourth power is rounding.
const BESIDE: f64 = 5e-4;
/// The same in distances of the path from the singular configuration.
const CLEAR: f64 = 20.0;
/// The greatest distance, as the root of a pivot product.
const WIDEST: f64 = 0.15;
/// Part of a distance by which the next one is smaller, with the curve found so far as the path.
const NARROWER: f64 = 0.25;
/// Most distances that are tried.
const ROUNDS: usize = 6;
/// Part by which the opening must shrink with the distance if it is not to be that of two branches: far more than its fourth
/// power, far less than one.
const SHRINKING: f64 = 0.25;
/// How far a state beside the dip may be moved, in its distance from it.
const MAX_MOVED: f64 = 0.3;
/// Openings of states on the constraints, and rounding, within which one is no opening.
const ROUNDING: (f64, f64) = (4.0, 16.0 * f64::EPSILON);
/// Root of a pivot product above which a state in the dip itself can be moved onto the constraints.
const RESOLVED: f64 = 3e-7;
/// How far the path may be from the constraints there, in distances from the singular configuration, and how far off its velocity,
/// if it has followed one branch.
const FOLLOWED: (f64, f64) = (0.02, 0.05);
/// Root of a pivot product in the middle, relative to those beside it, below which a joint loses its hold there.
const VANISHING: f64 = 0.2;
/// Share in the dependence of rows above which a joint is named.
const INVOLVED: f64 = 3e-2;
/// Most sums of rows, with changing signs, that are tried before each row by itself.
const SUMS: usize = 4;

/// A minimum of a joint's pivot product along the path of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dip {
    pub joint: usize,
    /// When, s.
    pub time: f64,
    /// Root of the pivot product, relative to the largest.
    pub root: f64,
    /// How fast that changes beside the dip, 1/s.
    pub slope: f64,
    /// How fast rows turn, 1/s.
    pub pace: f64,
}

/// What a dip is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Finding {
    /// The rows keep their hold, and the step has followed the motion.
    Regular,
    /// The motion passes a singular configuration at this time, s.
    Singular(f64),
    /// Branches of the motion come so near each other, as an angle, that the step may have left one for the other.
    Unresolved(f64),
}

/// Looks at dips; its memory is there from the start.
#[derive(Clone, Debug, Default)]
pub(super) struct Examiner {
    /// States before and after the dip, and the next ones.
    beside: [[Vec<f64>; 2]; 2],
    middle: Vec<f64>,
    /// Pivot products before and after the dip, and in it.
    products: [Vec<f64>; 3],
    /// Share of each joint in what was found last.
    shares: Vec<f64>,
    /// Joints that lose their hold there, with signs.
    lost: Vec<(usize, f64)>,
    /// Evaluations so far.
    pub count: u64,
}

impl Examiner {
    /// Joints that take part in the singular configuration that was found last.
    pub(super) fn involved(&self) -> impl Iterator<Item = usize> + '_ {
        self.shares.iter().enumerate().filter(|(_, share)| **share > INVOLVED).map(|(joint, _)| joint)
    }

    /// Makes room for so many numbers and joints.
    pub(super) fn allocate(&mut self, numbers: usize, joints: usize) {
        for state in self.beside.as_flattened_mut().iter_mut().chain([&mut self.middle]) {
            state.resize(numbers, 0.0);
        }
        self.products.iter_mut().for_each(|products| products.resize(joints, 0.0));
        self.shares.resize(joints, 0.0);
        self.lost.clear();
        self.lost.reserve(joints);
    }

    /// What a dip is. `largest` are the largest pivot products so far.
    pub(super) fn examine(&mut self, track: &mut dyn Track, dip: Dip, largest: &[f64]) -> Finding {
        let mut tau = (BESIDE / dip.pace).max(CLEAR * dip.root / dip.slope);
        let mut time = dip.time;
        let mut last: Option<(f64, f64, f64)> = None;
        for _ in 0..ROUNDS {
            // False for NaN as well.
            let beside = dip.slope * tau <= WIDEST;
            if !beside {
                return Finding::Unresolved(dip.root);
            }
            let Some((open, left)) = self.straddle(track, dip, time, tau, last.map(|(t, tau, _)| (t, tau)))
            else {
                return Finding::Unresolved(dip.root);
            };
            let [a, b] = [0, 1].map(|side| root(&self.products[side], largest, dip.joint));
            let off = tau * (a - b) / (a + b);
            if open <= left {
                return match self.settle(track, dip, (time, tau, off), largest) {
                    Some(time) => Finding::Singular(time),
                    None => Finding::Unresolved(dip.root),
                };
            }
            if last.is_some_and(|(.., before)| open > SHRINKING * before) {
                return Finding::Unresolved(open.sqrt().max(dip.root));
            }
            last = Some((time, tau, open));
            self.beside.swap(0, 1);
            time += off;
            tau *= NARROWER;
        }
        Finding::Unresolved(dip.root)
    }

    /// Whether the path is on the constraints in the dip itself, with its velocity.
    pub(super) fn has_followed(&mut self, track: &mut dyn Track, dip: Dip) -> bool {
        if dip.root < RESOLVED {
            return false;
        }
        self.count += 1;
        track.place_smoothly(dip.time);
        track.read(&mut self.beside[0][0]);
        let most = FOLLOWED.0 * dip.root * track.length();
        if !track.project().is_some_and(|moved| moved <= most) {
            return false;
        }
        track.read(&mut self.beside[0][1]);
        let [path, there] = [0, 1].map(|side| {
            let state = &self.beside[0][side];
            &state[state.len() / 2..]
        });
        let speed = largest_size(there);
        let off = largest_difference(path, there);
        off <= FOLLOWED.1 * speed
    }

    /// Moves two states beside the dip onto the constraints, from the path, or from the curve through those of the time and the
    /// distance before. Returns how far the curve through them is open between them, and how far it may be.
    fn straddle(
        &mut self,
        track: &mut dyn Track,
        dip: Dip,
        time: f64,
        tau: f64,
        before: Option<(f64, f64)>,
    ) -> Option<(f64, f64)> {
        let mut open = 0.0f64;
        for side in 0..2 {
            let at = time + [-tau, tau][side];
            match before {
                None => track.place(at),
                Some(before) => self.write(track, 1, before, at),
            }
            let moved = track.project()?;
            let near = moved <= MAX_MOVED * dip.slope * tau * track.length();
            if !near {
                return None;
            }
            open = open.max(track.open());
            track.read(&mut self.beside[0][side]);
            self.products[side].copy_from_slice(track.pivot_products());
        }
        self.write(track, 0, (time, tau), time);
        self.count += 3;
        Some((track.open(), ROUNDING.0 * open + ROUNDING.1))
    }

    /// Puts the state at time t in place on the curve through a pair of states at the distance τ from a time.
    fn write(&mut self, track: &mut dyn Track, pair: usize, (time, tau): (f64, f64), t: f64) {
        let [before, after] = &self.beside[pair];
        let (n, x) = (before.len() / 2, 0.5 + 0.5 * (t - time) / tau);
        let [before, after] = [before, after].map(|state| state.split_at(n));
        let (positions, velocities) = self.middle.split_at_mut(n);
        let ends = before.0.iter().zip(before.1).zip(after.0.iter().zip(after.1));
        for ((y, v), ((y0, v0), (y1, v1))) in positions.iter_mut().zip(velocities).zip(ends) {
            (*y, *v) = hermite::cubic([*y0, *v0], [*y1, *v1], 2.0 * tau, x);
        }
        track.write(t, &self.middle);
    }

    /// The time of the zero on the curve that was found, from four roots beside it with their signs, and the joints that take part.
    fn settle(
        &mut self,
        track: &mut dyn Track,
        dip: Dip,
        (time, tau, off): (f64, f64, f64),
        largest: &[f64],
    ) -> Option<f64> {
        let mut points = [(0.0, 0.0); 4];
        let ends = [0, 1].map(|side| root(&self.products[side], largest, dip.joint));
        (points[0], points[3]) = ((-ends[0], -tau), (ends[1], tau));
        self.write(track, 0, (time, tau), time + off);
        self.products[2].copy_from_slice(track.pivot_products());
        let part = 0.5 * (tau - off.abs());
        for (place, sign) in [(1, -1.0), (2, 1.0)] {
            let at = off + sign * part;
            self.write(track, 0, (time, tau), time + at);
            points[place] = (sign * root(track.pivot_products(), largest, dip.joint), at);
        }
        self.count += 3;
        self.find_shares(track, largest);
        inverse(&points).map(|at| time + at)
    }

    /// Shares of the joints in the dependences of rows there, with the pivot products beside it that were asked for last.
    fn find_shares(&mut self, track: &mut dyn Track, largest: &[f64]) {
        let Self { products, shares, lost, .. } = self;
        lost.clear();
        for joint in 0..largest.len() {
            let [a, b, m] = [0, 1, 2].map(|which| root(&products[which], largest, joint));
            if a.max(b) < WIDEST && m < VANISHING * a.min(b) {
                lost.push((joint, 1.0));
            }
        }
        let all = |shares: &[f64]| shares.iter().all(|share| *share > INVOLVED);
        // Many joints lose their hold at once where all take part: a few sums of their rows show it.
        shares.fill(0.0);
        for sum in 0..SUMS.min(lost.len() / 2) {
            for (joint, sign) in &mut *lost {
                *sign = if mixed(*joint, sum) { 1.0 } else { -1.0 };
            }
            track.raise_shares(lost, shares);
            if all(shares) {
                return;
            }
        }
        shares.fill(0.0);
        for (joint, _) in &*lost {
            track.raise_shares(&[(*joint, 1.0)], shares);
            if all(shares) {
                return;
            }
        }
    }
}

/// A bit that changes irregularly from one joint to the next, for each sum of them.
fn mixed(joint: usize, sum: usize) -> bool {
    (joint as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> (40 + 5 * sum) & 1 == 1
}

/// Root of a joint's pivot product relative to the largest.
pub(super) fn root(products: &[f64], largest: &[f64], joint: usize) -> f64 {
    (products[joint] / largest[joint]).max(0.0).sqrt()
}

/// Where the cubic through points (f, t), t as a function of f, is for f = 0. `None` if the f are not in order.
fn inverse(points: &[(f64, f64); 4]) -> Option<f64> {
    let ordered = points.windows(2).all(|pair| pair[0].0 < pair[1].0);
    let term = |k: usize| {
        let others = points.iter().enumerate().filter(|(i, _)| *i != k);
        others.fold(points[k].1, |t, (_, other)| t * other.0 / (other.0 - points[k].0))
    };
    ordered.then(|| (0..4).map(term).sum())
}
