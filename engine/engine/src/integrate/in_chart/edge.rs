//! How one body moves against another: a product of screws — eq. (10.5).

use super::spatial::{Placement, Twist};
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};
use triad_dynamics::model::{JointGeometry, ModelJoint};

/// Second of three angles beyond which the three axes are too near to one plane, rad.
const TILTED: f64 = 0.6;
/// Largest number of screws.
const MOST: usize = 6;
/// Newton steps to the screws of a given placement, and the last one's size.
const MAX_CORRECTIONS: usize = 30;
const PLACED: f64 = 1e-14;

/// A motion by one coordinate s in the frame of the body from which it starts: s `turn` about the axis through the point,
/// and s `slide` along it.
#[derive(Clone, Copy, Debug)]
struct Screw {
    axis: Vector3<f64>,
    point: Vector3<f64>,
    turn: f64,
    slide: f64,
}

impl Screw {
    fn turn(axis: Vector3<f64>, point: Vector3<f64>) -> Self {
        Self { axis, point, turn: 1.0, slide: 0.0 }
    }

    fn slide(axis: Vector3<f64>, point: Vector3<f64>) -> Self {
        Self { axis, point, turn: 0.0, slide: 1.0 }
    }

    fn displacement(&self, s: f64) -> Placement {
        let mut turn = Matrix3::identity();
        if self.turn != 0.0 {
            let angle = self.turn * s;
            let (sin, cos) = (libm::sin(angle), libm::cos(angle));
            turn = self.axis * self.axis.transpose() * (1.0 - cos)
                + Matrix3::from_diagonal_element(cos)
                + self.axis.cross_matrix() * sin;
        }
        Placement { turn, at: self.point - turn * self.point + self.axis * (self.slide * s) }
    }

    fn twist(&self) -> Twist {
        let spin = self.axis * self.turn;
        Twist { spin, flow: self.point.cross(&spin) + self.axis * self.slide }
    }
}

/// A body, the one that it moves against, and how.
#[derive(Clone, Debug)]
pub struct Edge {
    /// The body.
    pub body: usize,
    /// The body that it moves against; the ground if there is none.
    pub parent: Option<usize>,
    /// Place of its first coordinate.
    pub first: usize,
    screws: Vec<Screw>,
    /// Placement of the body seen from the other where all coordinates are zero.
    start: Placement,
    /// Its motion where it has one coordinate.
    one: Option<Box<OneScrew>>,
}

/// A motion by one screw, whose placement is a + b sin s + c (1 − cos s) + d s with constant parts.
#[derive(Clone, Debug)]
pub struct OneScrew {
    /// a.
    pub start: Placement,
    /// b.
    pub turning: Placement,
    /// c.
    pub turned: Placement,
    /// d.
    pub slide: Vector3<f64>,
    /// The twist of s, in the frame of the body from which it starts.
    pub twist: Twist,
    /// The angle for each unit of s.
    pub turn: f64,
}

impl OneScrew {
    /// From x ↦ R (x − p) + p + d s after the start, R = 1 + K sin s + K² (1 − cos s).
    fn new(screw: &Screw, start: &Placement) -> Self {
        let cross = screw.axis.cross_matrix();
        let first = Placement { turn: start.turn, at: start.at - screw.point };
        let by = |turn: Matrix3<f64>| Placement { turn: turn * first.turn, at: turn * first.at };
        let turning = by(cross);
        let again = cross * cross;
        Self {
            start: *start,
            turning,
            turned: by(again),
            slide: screw.axis * screw.slide,
            twist: screw.twist(),
            turn: screw.turn,
        }
    }

    /// None, which leaves the body where it is.
    fn none(start: Placement) -> Self {
        let screw = Screw { axis: Vector3::z(), point: Vector3::zeros(), turn: 0.0, slide: 0.0 };
        Self::new(&screw, &start)
    }

    fn placement(&self, s: f64) -> Placement {
        let mut at = self.start;
        if self.turn != 0.0 {
            let angle = self.turn * s;
            let (sin, versine) = (libm::sin(angle), 1.0 - libm::cos(angle));
            at.turn += self.turning.turn * sin + self.turned.turn * versine;
            at.at += self.turning.at * sin + self.turned.at * versine;
        }
        at.at += self.slide * s;
        at
    }
}

/// Number of screws of a joint, if its motions are a product of screws.
pub fn screws_of(joint: &ModelJoint) -> Option<usize> {
    match joint.geometry {
        JointGeometry::Fixed => Some(0),
        JointGeometry::Revolute { .. } | JointGeometry::Prismatic | JointGeometry::Screw { .. } => Some(1),
        JointGeometry::Cylindrical | JointGeometry::Universal => Some(2),
        JointGeometry::Spherical | JointGeometry::Planar => Some(3),
        JointGeometry::Rod { .. }
        | JointGeometry::PointOnLine
        | JointGeometry::PointInPlane
        | JointGeometry::Gear { .. } => None,
    }
}

impl Edge {
    /// A body that moves against another by a joint; `side` is that of the other body in the joint, `start` the placement
    /// of the body seen from it.
    pub fn by_joint(
        joint: &ModelJoint,
        side: usize,
        [body, first]: [usize; 2],
        parent: Option<usize>,
        start: Placement,
    ) -> Self {
        let (point, axis) = (joint.points[side], joint.axes[side]);
        let cross = joint.cross[side];
        let far_axis = start.turn * joint.axes[1 - side];
        let screws = match joint.geometry {
            JointGeometry::Revolute { .. } => vec![Screw::turn(axis, point)],
            JointGeometry::Prismatic => vec![Screw::slide(axis, point)],
            JointGeometry::Screw { pitch } => vec![Screw { axis, point, turn: 1.0, slide: pitch }],
            JointGeometry::Cylindrical => vec![Screw::slide(axis, point), Screw::turn(axis, point)],
            JointGeometry::Universal => vec![Screw::turn(axis, point), Screw::turn(far_axis, point)],
            JointGeometry::Spherical => turns(point),
            // The body turns about a point of its own: the other's may be far away from it.
            JointGeometry::Planar => {
                let own = start.turn * joint.points[1 - side] + start.at;
                vec![Screw::slide(cross[0], own), Screw::slide(cross[1], own), Screw::turn(axis, own)]
            }
            JointGeometry::Fixed
            | JointGeometry::Rod { .. }
            | JointGeometry::PointOnLine
            | JointGeometry::PointInPlane
            | JointGeometry::Gear { .. } => Vec::new(),
        };
        let one = match screws[..] {
            [ref screw] => Some(Box::new(OneScrew::new(screw, &start))),
            _ => None,
        };
        Self { body, parent, first, screws, start, one }
    }

    /// A body that moves freely.
    pub fn free([body, first]: [usize; 2], start: Placement) -> Self {
        let mut screws: Vec<Screw> = axes().map(|axis| Screw::slide(axis, start.at)).into();
        screws.extend(turns(start.at));
        Self { body, parent: None, first, screws, start, one: None }
    }

    /// Its motion as a product of one for each coordinate, the last one with the placement where all are zero; one for a body that
    /// does not move. Points of the ground are seen from `center`.
    pub fn product(&self, center: &Vector3<f64>) -> Vec<OneScrew> {
        let origin = if self.parent.is_none() { *center } else { Vector3::zeros() };
        let start = Placement { at: self.start.at - origin, ..self.start };
        let Some((last, before)) = self.screws.split_last() else { return vec![OneScrew::none(start)] };
        let seen = |screw: &Screw| Screw { point: screw.point - origin, ..*screw };
        let first = before.iter().map(|screw| OneScrew::new(&seen(screw), &Placement::identity()));
        first.chain([OneScrew::new(&seen(last), &start)]).collect()
    }

    /// The only coordinate that turns the body, with the axis in the frame of the other body.
    pub fn only_turn(&self) -> Option<(usize, Vector3<f64>)> {
        let mut turning = self.range().zip(&self.screws).filter(|(_, screw)| screw.turn != 0.0);
        let (place, screw) = turning.next()?;
        turning.next().is_none().then_some((place, screw.axis * screw.turn))
    }

    /// Its coordinates among all.
    pub fn range(&self) -> std::ops::Range<usize> {
        self.first..self.first + self.screws.len()
    }

    /// Which of them are angles.
    pub fn angles(&self) -> impl Iterator<Item = usize> {
        self.range().zip(&self.screws).filter(|(_, screw)| screw.turn != 0.0).map(|(place, _)| place)
    }

    /// Placement of the body seen from the other at its coordinates s; writes the twists of the coordinates, in the frame of
    /// the other.
    pub fn relative(&self, s: &[f64], twists: &mut [Twist]) -> Placement {
        if let (Some(one), [s], [twist]) = (&self.one, s, &mut *twists) {
            *twist = one.twist;
            return one.placement(*s);
        }
        let mut moved = Placement::identity();
        for ((screw, s), twist) in self.screws.iter().zip(s).zip(twists) {
            *twist = moved.carry(&screw.twist());
            moved = moved.after(&screw.displacement(*s));
        }
        moved.after(&self.start)
    }

    /// Whether its axes have come too near to one plane.
    pub fn is_tilted(&self, s: &[f64]) -> bool {
        self.middle().is_some_and(|middle| s[middle].abs() > TILTED)
    }

    /// Whether its coordinates are those of another edge of the same bodies.
    pub fn is_same(&self, other: &Self) -> bool {
        self.start == other.start
    }

    /// The second of three angles.
    fn middle(&self) -> Option<usize> {
        let turning = |three: &[Screw]| three.iter().all(|screw| screw.turn != 0.0);
        self.screws.windows(3).position(turning).map(|place| place + 1)
    }

    /// The same edge with coordinates that are zero where these are s.
    pub fn restarted(&self, s: &[f64]) -> Self {
        let start = self.relative(s, &mut [Twist::zero(); MOST]);
        if self.screws.len() == MOST {
            return Self::free([self.body, self.first], start);
        }
        Self { start, ..self.clone() }
    }

    /// Coordinates s and rates of this edge, near to zero, where another one of the same bodies has the given ones.
    pub fn translate(&self, other: &Self, s: &mut [f64], rates: &mut [f64], length: f64) {
        let mut twists = [Twist::zero(); MOST];
        let wanted = other.relative(s, &mut twists);
        let moving =
            twists.iter().zip(rates.iter()).fold(Twist::zero(), |sum, (twist, rate)| sum + *twist * *rate);
        s.fill(0.0);
        let mut step = [0.0; MOST];
        for _ in 0..MAX_CORRECTIONS {
            let reached = self.relative(s, &mut twists);
            let apart = wanted.turn * reached.turn.transpose();
            let spin = Vector3::new(
                apart[(2, 1)] - apart[(1, 2)],
                apart[(0, 2)] - apart[(2, 0)],
                apart[(1, 0)] - apart[(0, 1)],
            ) * 0.5;
            let gap = Twist::through(&reached.at, &(wanted.at - reached.at), &spin);
            solve(&twists[..s.len()], &gap, &reached.at, length, &mut step[..s.len()]);
            s.iter_mut().zip(&step).for_each(|(s, step)| *s += step);
            if step[..s.len()].iter().all(|step| step.abs() <= PLACED) {
                break;
            }
        }
        let reached = self.relative(s, &mut twists);
        solve(&twists[..s.len()], &moving, &reached.at, length, rates);
    }
}

fn axes() -> [Vector3<f64>; 3] {
    [Vector3::x(), Vector3::y(), Vector3::z()]
}

fn turns(point: Vector3<f64>) -> Vec<Screw> {
    axes().map(|axis| Screw::turn(axis, point)).into()
}

/// The rates with which the twists of coordinates make up a given one, as nearly as can be where they cannot: turns are
/// compared with velocities at `point` as parts of `length`.
pub fn solve(twists: &[Twist], whole: &Twist, point: &Vector3<f64>, length: f64, rates: &mut [f64]) {
    let numbers = |twist: &Twist| (twist.spin, twist.at(point) / length);
    let product = |a: &Twist, b: &Twist| {
        let ((spin, flow), (other_spin, other_flow)) = (numbers(a), numbers(b));
        spin.dot(&other_spin) + flow.dot(&other_flow)
    };
    if twists.is_empty() {
        return;
    }
    if let [twist] = twists {
        rates[0] = product(twist, whole) / product(twist, twist);
        return;
    }
    let mut matrix = Matrix6::identity();
    let mut right = Vector6::zeros();
    for (i, a) in twists.iter().enumerate() {
        right[i] = product(a, whole);
        for (j, b) in twists.iter().enumerate() {
            matrix[(i, j)] = product(a, b);
        }
    }
    match matrix.cholesky() {
        Some(factor) => factor.solve_mut(&mut right),
        None => right.fill(f64::NAN),
    }
    rates.iter_mut().zip(right.iter()).for_each(|(rate, x)| *rate = *x);
}
