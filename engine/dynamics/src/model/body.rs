//! A body with its centre of mass, principal axes and start.

use super::{MAX_INERTIA, MAX_LENGTH, MAX_MASS, MIN_MASS, ModelError, finite, within};
use crate::scene::{Body, Coordinates, Inertia, Orientation, Triple, WrittenOrientation};
use nalgebra::{Matrix3, Quaternion, SymmetricEigen, Unit, UnitQuaternion, Vector3};

/// Deviation of directors from orthonormal ones, or of a quaternion's norm from 1, up to which it is corrected; what is
/// farther off is refused as a mistake.
const DIRECTOR_SLACK: f64 = 0.3;
/// Relative tolerance of the triangle inequality, of symmetry and of unit length: data are often printed with six digits.
const PRINTED: f64 = 1e-6;

/// A checked body, its start written with the centre of mass and the principal axes.
#[derive(Clone, Debug)]
pub struct ModelBody {
    /// Name.
    pub name: String,
    /// Mass m, kg.
    pub mass: f64,
    /// Principal moments of inertia about u, v, w, kg m².
    pub principal: Vector3<f64>,
    /// Which coordinates describe it.
    pub coordinates: Coordinates,
    /// Centre of mass in the author's frame, m.
    pub center_of_mass: Vector3<f64>,
    /// Principal axes in the author's frame, as columns.
    pub principal_axes: Matrix3<f64>,
    /// Start: centre of mass r in the world, m.
    pub position: Vector3<f64>,
    /// Start: directors u, v, w in the world, as columns.
    pub directors: Matrix3<f64>,
    /// Start: velocity of the centre of mass, m/s.
    pub velocity: Vector3<f64>,
    /// Start: angular velocity in the world frame, rad/s.
    pub angular_velocity: Vector3<f64>,
}

impl ModelBody {
    /// Checks body `index` of a scene.
    pub(super) fn new(
        body: &Body,
        index: usize,
        coordinates: Coordinates,
        notes: &mut Vec<String>,
    ) -> Result<Self, ModelError> {
        let at = |key: &str| format!("/bodies/{index}/{key}");
        let vectors = [
            ("center_of_mass", body.center_of_mass),
            ("position", body.position),
            ("velocity", body.velocity),
            ("angular_velocity", body.angular_velocity),
        ];
        for (key, vector) in vectors {
            within(&vector, MAX_LENGTH, &at(key))?;
        }
        check_mass(&named(body), body.mass, &at("mass"))?;
        let Composite { mass, center_of_mass, principal, principal_axes } = Composite::of(body, &at, notes)?;
        let frame = orientation(body, &at("orientation"), notes)?;
        let angular_velocity = Vector3::from(body.angular_velocity);
        let arm = frame * center_of_mass;
        Ok(Self {
            name: body.name.clone(),
            mass,
            principal,
            coordinates: body.coordinates.unwrap_or(coordinates),
            center_of_mass,
            principal_axes,
            position: Vector3::from(body.position) + arm,
            directors: frame * principal_axes,
            velocity: Vector3::from(body.velocity) + angular_velocity.cross(&arm),
            angular_velocity,
        })
    }

    /// The body that rigidly joined `parts`, this one among them, make together, each given with its centre of mass r and its
    /// directors as columns; `frame` are this one's. It keeps this one's name, its principal axes are next to `frame`, and its
    /// rates are left at zero.
    pub(crate) fn joined(&self, parts: &[(&Self, Vector3<f64>, Matrix3<f64>)], frame: &Matrix3<f64>) -> Self {
        let parts: Vec<_> = parts
            .iter()
            .map(|(body, r, directors)| (body.mass, *r, tensor(&body.principal, directors)))
            .collect();
        let (mass, position, inertia) = composed(&parts);
        let inertia = frame.tr_mul(&inertia) * frame;
        let (principal, axes) = principal_axes(&((inertia + inertia.transpose()) * 0.5), inertia.amax());
        Self {
            name: self.name.clone(),
            mass,
            principal,
            coordinates: self.coordinates,
            center_of_mass: Vector3::zeros(),
            principal_axes: Matrix3::identity(),
            position,
            directors: frame * axes,
            velocity: Vector3::zeros(),
            angular_velocity: Vector3::zeros(),
        }
    }

    /// Principal moments about one of its points, and the axes there as columns; both in its principal frame.
    pub(crate) fn principal_about(&self, point: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
        let inertia = Matrix3::from_diagonal(&self.principal) + of_point(self.mass, point);
        principal_axes(&inertia, inertia.amax())
    }

    /// Coordinates (ξ, η, ζ) in the principal frame of a point of the author's frame.
    pub fn point_to_principal(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.principal_axes.tr_mul(&(point - self.center_of_mass))
    }

    /// A point of the author's frame from its coordinates in the principal frame.
    pub fn point_from_principal(&self, point: Triple) -> Triple {
        (self.center_of_mass + self.principal_axes * Vector3::from(point)).into()
    }

    /// Components in the principal frame of a vector of the author's frame.
    pub fn vector_to_principal(&self, vector: &Vector3<f64>) -> Vector3<f64> {
        self.principal_axes.tr_mul(vector)
    }
}

/// What errors and notes call a body.
fn named(body: &Body) -> String {
    format!("body \"{}\"", body.name)
}

/// Refuses a mass of that body, or of what is attached to one.
fn check_mass(element: &str, mass: f64, pointer: &str) -> Result<(), ModelError> {
    finite(&[mass], pointer)?;
    let (low, high) = (MIN_MASS, MAX_MASS);
    if mass <= 0.0 {
        return Err(ModelError::Mass { element: element.to_owned(), pointer: pointer.to_owned(), mass });
    }
    if !(low..=high).contains(&mass) {
        return Err(ModelError::OutOfRange { pointer: pointer.to_owned(), value: mass, low, high });
    }
    Ok(())
}

/// Mass, centre of mass and principal axes of a body with all that is attached to it.
struct Composite {
    mass: f64,
    center_of_mass: Vector3<f64>,
    principal: Vector3<f64>,
    principal_axes: Matrix3<f64>,
}

impl Composite {
    fn of(body: &Body, at: &impl Fn(&str) -> String, notes: &mut Vec<String>) -> Result<Self, ModelError> {
        let (own, of_body) = (Vector3::from(body.center_of_mass), named(body));
        let (moments, axes) = principal_inertia(&of_body, body.inertia.as_ref(), &at("inertia"), notes)?;
        if body.attached.is_empty() {
            let (principal, principal_axes) = (moments, axes);
            return Ok(Self { mass: body.mass, center_of_mass: own, principal, principal_axes });
        }
        // Each part as (mass, centre, inertia about its centre), in the author's frame.
        let mut parts = vec![(body.mass, own, tensor(&moments, &axes))];
        for (index, attached) in body.attached.iter().enumerate() {
            let at = |key: &str| at(&format!("attached/{index}/{key}"));
            let element = format!("attached[{index}] of {of_body}");
            check_mass(&element, attached.mass, &at("mass"))?;
            within(&attached.point, MAX_LENGTH, &at("point"))?;
            let inertia = attached.inertia.as_ref();
            let (moments, axes) = principal_inertia(&element, inertia, &at("inertia"), notes)?;
            parts.push((attached.mass, Vector3::from(attached.point), tensor(&moments, &axes)));
        }
        let (mass, center_of_mass, whole) = composed(&parts);
        let rows = [0, 1, 2].map(|i| [0, 1, 2].map(|j| whole[(i, j)]));
        let (principal, principal_axes) =
            principal_inertia(&of_body, Some(&Inertia::Tensor(rows)), &at("attached"), notes)?;
        notes.push(format!(
            "{of_body}: with {} attached masses it has {mass} kg, its centre of mass at ({:.6}, {:.6}, {:.6})",
            body.attached.len(),
            center_of_mass[0],
            center_of_mass[1],
            center_of_mass[2]
        ));
        Ok(Self { mass, center_of_mass, principal, principal_axes })
    }
}

/// Mass, centre of mass and inertia about it of parts, each with its mass, centre and inertia about that.
fn composed(parts: &[(f64, Vector3<f64>, Matrix3<f64>)]) -> (f64, Vector3<f64>, Matrix3<f64>) {
    let mass: f64 = parts.iter().map(|part| part.0).sum();
    let center_of_mass = parts.iter().map(|part| part.1 * part.0).sum::<Vector3<f64>>() / mass;
    // Steiner's theorem: the parallel axes of all parts meet in the common centre.
    let whole = parts
        .iter()
        .map(|(mass, center, inertia)| inertia + of_point(*mass, &(center - center_of_mass)))
        .sum();
    (mass, center_of_mass, whole)
}

/// Inertia of a point mass about a point that it is this far from.
fn of_point(mass: f64, arm: &Vector3<f64>) -> Matrix3<f64> {
    (Matrix3::identity() * arm.norm_squared() - arm * arm.transpose()) * mass
}

/// The tensor of principal moments about axes, the columns.
fn tensor(moments: &Vector3<f64>, axes: &Matrix3<f64>) -> Matrix3<f64> {
    axes * Matrix3::from_diagonal(moments) * axes.transpose()
}

/// Principal moments and axes (columns, right-handed) of an inertia of a body or of one of its parts.
fn principal_inertia(
    element: &str,
    inertia: Option<&Inertia>,
    pointer: &str,
    notes: &mut Vec<String>,
) -> Result<(Vector3<f64>, Matrix3<f64>), ModelError> {
    let (moments, axes) = match inertia {
        None => (Vector3::zeros(), Matrix3::identity()),
        Some(Inertia::Principal(moments)) => {
            within(moments, MAX_INERTIA, &format!("{pointer}/principal"))?;
            (Vector3::from(*moments), Matrix3::identity())
        }
        Some(Inertia::Tensor(rows)) => {
            let (moments, axes) = diagonalize(element, rows, &format!("{pointer}/tensor"))?;
            if axes != Matrix3::identity() {
                notes.push(format!(
                    "{element}: principal moments {:.6e}, {:.6e}, {:.6e} kg m² found along {}",
                    moments[0],
                    moments[1],
                    moments[2],
                    axes.column_iter()
                        .map(|a| format!("({:.6}, {:.6}, {:.6})", a[0], a[1], a[2]))
                        .collect::<Vec<_>>()
                        .join(", ")
                ));
            }
            (moments, axes)
        }
    };
    let slack = PRINTED * moments.amax();
    let total = moments.sum();
    if moments.iter().any(|&i| i < 0.0 || 2.0 * i > total + slack) {
        return Err(ModelError::Inertia {
            element: element.to_owned(),
            pointer: pointer.to_owned(),
            a: moments[0],
            b: moments[1],
            c: moments[2],
        });
    }
    Ok((moments, axes))
}

fn diagonalize(
    element: &str,
    rows: &[Triple; 3],
    pointer: &str,
) -> Result<(Vector3<f64>, Matrix3<f64>), ModelError> {
    for (i, row) in rows.iter().enumerate() {
        within(row, MAX_INERTIA, &format!("{pointer}/{i}"))?;
    }
    let tensor = Matrix3::from_fn(|i, j| rows[i][j]);
    let largest = tensor.amax();
    for (row, column) in [(0, 1), (0, 2), (1, 2)] {
        let difference = (tensor[(row, column)] - tensor[(column, row)]).abs();
        if difference > PRINTED * largest {
            let (element, pointer) = (element.to_owned(), pointer.to_owned());
            return Err(ModelError::Asymmetric { element, pointer, row, column, difference });
        }
    }
    if [(0, 1), (0, 2), (1, 2)].iter().all(|&(i, j)| tensor[(i, j)] == 0.0 && tensor[(j, i)] == 0.0) {
        return Ok((tensor.diagonal(), Matrix3::identity()));
    }
    Ok(principal_axes(&((tensor + tensor.transpose()) * 0.5), largest))
}

/// Principal moments and axes (columns, right-handed) of a symmetric tensor, whose largest entry as written is `largest`.
fn principal_axes(tensor: &Matrix3<f64>, largest: f64) -> (Vector3<f64>, Matrix3<f64>) {
    let eigen = SymmetricEigen::new(*tensor);
    // Keep each principal axis next to the author's axis that it is nearest to, so that the frame reads well.
    let mut order = [0, 1, 2];
    let permutations = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    let score = |p: &[usize; 3]| (0..3).map(|k| eigen.eigenvectors[(k, p[k])].abs()).sum::<f64>();
    for candidate in permutations {
        if score(&candidate) > score(&order) {
            order = candidate;
        }
    }
    let mut axes = Matrix3::zeros();
    for k in 0..3 {
        let axis = eigen.eigenvectors.column(order[k]);
        let sign = if axis[k] < 0.0 { -1.0 } else { 1.0 };
        axes.set_column(k, &(axis * sign));
    }
    if axes.determinant() < 0.0 {
        let third = -axes.column(2);
        axes.set_column(2, &third);
    }
    // Rounding may leave a rod less than no inertia about its axis.
    let moment = |k: usize| match eigen.eigenvalues[order[k]] {
        moment if moment < 0.0 && moment > -PRINTED * largest => 0.0,
        moment => moment,
    };
    (Vector3::from_fn(|k, _| moment(k)), axes)
}

fn orientation(body: &Body, pointer: &str, notes: &mut Vec<String>) -> Result<Matrix3<f64>, ModelError> {
    let fail = |reason: String| ModelError::Orientation {
        body: body.name.clone(),
        pointer: pointer.to_owned(),
        reason,
    };
    let Some(written) = &body.orientation else { return Ok(Matrix3::identity()) };
    let keys = WrittenOrientation::from(written.clone());
    let triples = [keys.u, keys.v, keys.w, keys.axis].into_iter().flatten().flatten();
    let numbers = triples.chain(keys.quaternion.into_iter().flatten()).chain(keys.angle);
    finite(&numbers.collect::<Vec<_>>(), pointer)?;
    match *written {
        Orientation::Directors { u, v, w } => {
            from_directors(&Vector3::from(u), &Vector3::from(v), w.map(Vector3::from), |reason| {
                notes.push(format!("body \"{}\": {reason}", body.name));
            })
            .map_err(fail)
        }
        Orientation::Quaternion(q) => {
            let quaternion = Quaternion::new(q[0], q[1], q[2], q[3]);
            let norm = quaternion.norm();
            if (norm - 1.0).abs() > DIRECTOR_SLACK {
                return Err(fail(format!("the quaternion has the norm {norm}, not 1")));
            }
            if (norm - 1.0).abs() > PRINTED {
                notes
                    .push(format!("body \"{}\": the quaternion of norm {norm:.6} was normalized", body.name));
            }
            Ok(UnitQuaternion::from_quaternion(quaternion).to_rotation_matrix().into_inner())
        }
        Orientation::Rotation { axis, angle } => {
            let axis = Unit::try_new(Vector3::from(axis), 1e-12)
                .ok_or_else(|| fail("the axis of the rotation has no length".to_owned()))?;
            Ok(UnitQuaternion::from_axis_angle(&axis, angle).to_rotation_matrix().into_inner())
        }
        Orientation::Unclear(_) => {
            Err(fail("the orientation is given in none of the three ways, or in more than one".to_owned()))
        }
    }
}

/// Directors as columns, corrected onto orthonormal ones if they are near them.
fn from_directors(
    u: &Vector3<f64>,
    v: &Vector3<f64>,
    w: Option<Vector3<f64>>,
    mut note: impl FnMut(String),
) -> Result<Matrix3<f64>, String> {
    let error = (u.norm() - 1.0).abs().max((v.norm() - 1.0).abs()).max(u.dot(v).abs());
    if error > DIRECTOR_SLACK {
        return Err(format!(
            "u and v are not perpendicular unit vectors: |u| = {:.6}, |v| = {:.6}, u·v = {:.6}",
            u.norm(),
            v.norm(),
            u.dot(v)
        ));
    }
    // The symmetric correction (each director moves equally), one Newton step at a time.
    let (mut a, mut b) = (u.normalize(), v.normalize());
    for _ in 0..8 {
        let half = 0.5 * a.dot(&b);
        (a, b) = ((a - b * half).normalize(), (b - a * half).normalize());
    }
    let c = a.cross(&b);
    if let Some(w) = w {
        if w.dot(&c) < 0.0 {
            return Err("u, v, w are left-handed: w must be u × v, not its opposite".to_owned());
        }
        if (w - c).norm() > DIRECTOR_SLACK {
            return Err("w is not u × v".to_owned());
        }
    }
    if error > PRINTED {
        note(format!("directors off by {error:.3e} were made orthonormal"));
    }
    Ok(Matrix3::from_columns(&[a, b, c]))
}
