//! Which steady motion a mechanism takes at a position: joints and drivers ask for some of its velocities, and the others are those
//! at which the momenta along them are what they were at the start — eq. (10.16).

use super::flow::{Flow, Spin};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use triad_dynamics::system::body::RigidBody;
use triad_dynamics::system::natural::NaturalCoordinates;
use triad_linalg::{least_squares, null_and_rest};

/// Relative difference of principal moments below which a body is alike all around the third axis.
const ALIKE: f64 = 1e-9;
/// Part of the largest below which velocities and momenta are rounding.
pub const MISSED: f64 = 1e-8;

/// Solutions of linear conditions.
#[derive(Clone, Debug)]
pub struct Solutions {
    /// One of them.
    pub one: DVector<f64>,
    /// What may be added to it: orthonormal columns.
    pub free: DMatrix<f64>,
}

impl Solutions {
    /// All vectors of a length.
    pub fn all(length: usize) -> Self {
        Self { one: DVector::zeros(length), free: DMatrix::identity(length, length) }
    }

    /// Those among them with `matrix` p = `right`, as nearly as can be; parts of `matrix` below `smallest` are none.
    pub fn narrow(&mut self, matrix: &DMatrix<f64>, right: &DVector<f64>, smallest: f64) {
        let left = right - matrix * &self.one;
        let left = DMatrix::from_column_slice(left.len(), 1, left.as_slice());
        let (added, null) = least_squares(&(matrix * &self.free), &left, smallest);
        self.one += &self.free * added.column(0);
        self.free = &self.free * null;
    }

    /// Those among them that make `matrix` p zero.
    pub fn without(&mut self, matrix: &DMatrix<f64>, smallest: f64) {
        self.narrow(matrix, &DVector::zeros(matrix.nrows()), smallest);
    }
}

/// Twists of steady motions: three turns and three translations of the whole, then a spin of each body that is alike around an axis.
#[derive(Clone, Debug)]
pub struct Fields {
    /// Body and director of each spin.
    axes: Vec<(usize, usize)>,
    /// The mechanism's length: arcs of this radius have the velocity one.
    length: f64,
    /// The point about which the whole turns: the centre of mass, as turns about a point far away hardly differ from translations.
    about: Vector3<f64>,
}

impl Fields {
    /// Those of the bodies of a mechanism of this length at these places.
    pub fn new(bodies: &[RigidBody], at: &[NaturalCoordinates], length: f64) -> Self {
        let axis = |j: &Vector3<f64>| {
            let same = |a: usize, b: usize| (j[a] - j[b]).abs() <= ALIKE * j.max();
            (0..3).find(|&k| same((k + 1) % 3, (k + 2) % 3) && !same(k, (k + 1) % 3))
        };
        let spins = bodies.iter().enumerate();
        let axes = spins.filter_map(|(index, body)| Some((index, axis(&body.principal)?))).collect();
        let weighted = bodies.iter().zip(at).map(|(body, at)| at.r * body.mass).sum::<Vector3<f64>>();
        let about = weighted / bodies.iter().map(|body| body.mass).sum::<f64>();
        Self { axes, length, about }
    }

    /// How many.
    pub fn count(&self) -> usize {
        6 + self.axes.len()
    }

    /// How many bodies may spin about themselves.
    pub fn spins(&self) -> usize {
        self.axes.len()
    }

    /// Columns of (v, ω) body by body.
    pub fn twists(&self, at: &[NaturalCoordinates]) -> DMatrix<f64> {
        let mut out = DMatrix::zeros(6 * at.len(), self.count());
        for (index, at) in at.iter().enumerate() {
            for k in 0..3 {
                let unit = Vector3::ith(k, 1.0);
                out.fixed_view_mut::<3, 1>(6 * index, k)
                    .copy_from(&(unit.cross(&(at.r - self.about)) / self.length));
                out[(6 * index + 3 + k, k)] = 1.0 / self.length;
                out[(6 * index + k, 3 + k)] = 1.0;
            }
        }
        for (column, &(body, axis)) in self.axes.iter().enumerate() {
            let e = at[body].e[axis] / self.length;
            out.fixed_view_mut::<3, 1>(6 * body + 3, 6 + column).copy_from(&e);
        }
        out
    }

    /// What adds to the change of a wrench on each body that is carried along a field, if it turns as the field does.
    pub fn turned(&self, field: usize, wrenches: &DVector<f64>) -> DVector<f64> {
        let mut out = DVector::zeros(wrenches.len());
        if field < 3 {
            let turning = Vector3::ith(field, 1.0 / self.length);
            for k in (0..wrenches.len()).step_by(3) {
                out.fixed_rows_mut::<3>(k).copy_from(&turning.cross(&wrenches.fixed_rows::<3>(k)));
            }
        }
        out
    }

    /// A twist that is nothing special.
    pub fn any(&self, length: usize, which: usize) -> DVector<f64> {
        let arc = |k: usize| if k % 6 >= 3 { self.length } else { 1.0 };
        DVector::from_fn(length, |k, _| libm::sin((3 * k + which + 1) as f64) / arc(k))
    }

    /// Length of a twist, arcs measured as the fields measure them.
    pub fn size(&self, twist: &DVector<f64>) -> f64 {
        let arc = |k: usize| if k % 6 >= 3 { self.length } else { 1.0 };
        twist.iter().enumerate().map(|(k, x)| arc(k) * x).fold(0.0, libm::hypot)
    }

    /// [ξ, p] of each field ξ: how it changes when the motion p carries it along.
    pub fn bracket(&self, p: &DVector<f64>) -> DMatrix<f64> {
        let (turning, sliding) = (part(p, 0).cross_matrix(), part(p, 3).cross_matrix());
        let mut out = DMatrix::zeros(6, self.count());
        out.fixed_view_mut::<3, 3>(0, 0).copy_from(&-turning);
        out.fixed_view_mut::<3, 3>(3, 0).copy_from(&-sliding);
        out.fixed_view_mut::<3, 3>(3, 3).copy_from(&-turning);
        out
    }

    /// The steady motion of given velocities along the fields, of which those below `least` are rounding.
    pub fn flow(&self, p: &DVector<f64>, least: f64, bodies: usize) -> Flow {
        let rounded = |x: f64| if x.abs() <= least { 0.0 } else { x };
        let mut flow = Flow {
            turning: part(p, 0).map(|x| rounded(x) / self.length),
            about: self.about,
            sliding: part(p, 3).map(rounded),
            carried: Vector3::zeros(),
            spins: vec![Spin::default(); bodies],
        };
        for (k, &(body, axis)) in self.axes.iter().enumerate() {
            flow.spins[body] = Spin { axis, rate: rounded(p[6 + k]) / self.length };
        }
        flow
    }
}

fn part(p: &DVector<f64>, first: usize) -> Vector3<f64> {
    p.fixed_rows::<3>(first).into_owned()
}

/// Rows (√m v, √J_k ω_k) of each body: half their squares are its kinetic energy.
pub fn energetic(bodies: &[RigidBody], at: &[NaturalCoordinates], mut twists: DMatrix<f64>) -> DMatrix<f64> {
    for (index, (body, at)) in bodies.iter().zip(at).enumerate() {
        let roots = body.principal.map(|moment| moment.max(0.0).sqrt());
        for mut column in twists.column_iter_mut() {
            let turning = Matrix3::from_columns(&at.e).tr_mul(&column.fixed_rows::<3>(6 * index + 3));
            let mut moving = column.fixed_rows_mut::<3>(6 * index);
            moving *= body.mass.sqrt();
            column.fixed_rows_mut::<3>(6 * index + 3).copy_from(&turning.component_mul(&roots));
        }
    }
    twists
}

/// The momenta that a steady motion keeps wherever the bodies are.
#[derive(Clone, Debug)]
pub struct Momenta {
    /// The fields that velocities belong to.
    pub fields: Fields,
    /// Velocities that joints and drivers ask for, and those that they leave free.
    pub allowed: Solutions,
    /// μ, the momenta along the free ones.
    pub along: DVector<f64>,
    /// Uniform velocity of a mechanism that is free to move as a whole.
    pub carried: Vector3<f64>,
    /// Translations of the whole that nothing resists, along the fields.
    pub translations: DMatrix<f64>,
    /// Velocities below this are rounding.
    pub least: f64,
}

/// The part of a basis of twists that leaves the whole where it is: it has nothing to do with the translations.
pub fn across(
    bodies: &[RigidBody],
    at: &[NaturalCoordinates],
    translations: DMatrix<f64>,
    basis: DMatrix<f64>,
) -> DMatrix<f64> {
    let momentum = energetic(bodies, at, translations).tr_mul(&energetic(bodies, at, basis.clone()));
    basis * null_and_rest(&momentum, MISSED * momentum.norm()).0
}

impl Momenta {
    /// Velocities along the fields that have these momenta at a place, but for the velocity as a whole.
    pub fn velocities(&self, bodies: &[RigidBody], at: &[NaturalCoordinates]) -> DVector<f64> {
        let moving = energetic(bodies, at, self.fields.twists(at));
        let Solutions { one, free } = &self.allowed;
        let along = &moving * free;
        let (null, rest) = null_and_rest(&along, MISSED * along.norm());
        let mut found = Solutions { one: one.clone(), free: free * null };
        if !rest.is_empty() {
            // Rᵀ R y = restᵀ (μ − …), as the factor R of the velocities has more digits than that of the masses.
            let qr = (along * &rest).qr();
            let mut y = rest.tr_mul(&self.along);
            qr.r().tr_solve_upper_triangular_mut(&mut y);
            y -= qr.q().tr_mul(&(moving * one));
            qr.r().solve_upper_triangular_mut(&mut y);
            found.one += free * (rest * y);
        }
        // A frame that need not turn does not: then frequencies are those that somebody at rest sees.
        let turning = DMatrix::identity(3, found.one.len());
        found.without(&turning, MISSED);
        found.one
    }

    /// The steady motion at a place.
    pub fn flow(&self, bodies: &[RigidBody], at: &[NaturalCoordinates]) -> Flow {
        let mut flow = self.fields.flow(&self.velocities(bodies, at), self.least, bodies.len());
        flow.carried = self.carried;
        flow.sliding += self.carried;
        flow
    }
}
