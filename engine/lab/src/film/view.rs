//! From which side a mechanism is seen, and where its points are then on the paper.

use nalgebra::{Vector2, Vector3};

/// Part of the extent of a mechanism below which it is flat in a direction.
const FLAT: f64 = 1e-6;
/// From where a mechanism in space is seen: to the right of its front and above, rad.
const ASIDE: [f64; 2] = [0.6, 0.4];

/// An orthographic view.
#[derive(Clone, Debug)]
pub(super) struct View {
    right: Vector3<f64>,
    up: Vector3<f64>,
    /// Middle of what is seen, in these directions, m.
    middle: Vector2<f64>,
    /// Pixels of a metre.
    scale: f64,
    /// Middle of the paper, px.
    paper: Vector2<f64>,
}

impl View {
    /// Of points that shall all be on paper of that size, with a margin.
    pub fn around(
        points: impl Iterator<Item = [f64; 3]>,
        y_is_up: bool,
        size: [f64; 2],
        margin: f64,
    ) -> Self {
        let points: Vec<Vector3<f64>> =
            points.map(Vector3::from).filter(|point| point.iter().all(|x| x.is_finite())).collect();
        let vertical = if y_is_up { Vector3::y() } else { Vector3::z() };
        let towards = towards(&points, y_is_up);
        let mut right = vertical.cross(&towards);
        if right.norm() < 0.5 {
            // Seen from above.
            right = Vector3::x();
        }
        let right = right.normalize();
        let up = towards.cross(&right);
        let flat: Vec<Vector2<f64>> =
            points.iter().map(|point| Vector2::new(right.dot(point), up.dot(point))).collect();
        let (low, high) = ends(&flat);
        let room = Vector2::new(size[0] - 2.0 * margin, size[1] - 2.0 * margin);
        let span = high - low;
        let fits = [(room.x, span.x), (room.y, span.y)].into_iter().filter(|(_, span)| *span > 0.0);
        let scale = fits.map(|(room, span)| room / span).fold(f64::INFINITY, f64::min);
        Self {
            right,
            up,
            middle: (low + high) * 0.5,
            scale: if scale.is_finite() { scale } else { 0.25 * room.y },
            paper: Vector2::new(0.5 * size[0], 0.5 * size[1]),
        }
    }

    /// Where a point is on the paper, px from its upper left corner.
    pub fn place(&self, point: [f64; 3]) -> [f64; 2] {
        let point = Vector3::from(point);
        let x = self.paper.x + self.scale * (self.right.dot(&point) - self.middle.x);
        let y = self.paper.y - self.scale * (self.up.dot(&point) - self.middle.y);
        [x, y]
    }

    /// How long a length across the view is on the paper, px.
    pub fn long(&self, length: f64) -> f64 {
        self.scale * length
    }
}

/// From where points are seen: across their plane, or from aside.
fn towards(points: &[Vector3<f64>], y_is_up: bool) -> Vector3<f64> {
    let extent: [f64; 3] = std::array::from_fn(|k| {
        let (low, high) =
            points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (p[k].min(l), p[k].max(h)));
        high - low
    });
    let largest = extent.iter().copied().fold(0.0, f64::max);
    // Of a motion along a line the side is open: across the vertical.
    let order = if y_is_up { [2, 0, 1] } else { [1, 0, 2] };
    if let Some(axis) = order.into_iter().find(|&axis| extent[axis] <= FLAT * largest) {
        // From the side on which the other two axes are as one writes them: x, or y, to the right.
        let sign = if axis == 1 { -1.0 } else { 1.0 };
        let mut side = Vector3::zeros();
        side[axis] = sign;
        return side;
    }
    let [turn, rise] = ASIDE;
    let (front, aside, above) =
        (libm::cos(turn) * libm::cos(rise), libm::sin(turn) * libm::cos(rise), libm::sin(rise));
    if y_is_up { Vector3::new(aside, above, front) } else { Vector3::new(aside, -front, above) }
}

fn ends(points: &[Vector2<f64>]) -> (Vector2<f64>, Vector2<f64>) {
    let first = points.first().copied().unwrap_or_default();
    points.iter().fold((first, first), |(low, high), point| (low.inf(point), high.sup(point)))
}
