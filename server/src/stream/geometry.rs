//! Shapes, axes and the Jacobian's picture: everything that is logged once.

use re_sdk_types::archetypes::{
    Arrows3D, Boxes3D, Capsules3D, Image, LineStrips3D, Points3D, SeriesLines, Transform3D, ViewCoordinates,
};
use re_sdk_types::components::{Color, FillMode};
use re_sdk_types::datatypes::Quaternion;
use rerun::{EntityPath, EntityPathPart, RecordingStream, RecordingStreamResult};
use triad_engine::scene::Shape;
use triad_session::picture::{ArrowKind, BodyVisual, MarkerVisual, Pattern, SceneDescription};

/// Colours that stay apart for colour-blind eyes too (Okabe and Ito).
const PALETTE: [[u8; 3]; 6] =
    [[86, 180, 233], [230, 159, 0], [0, 158, 115], [240, 228, 66], [0, 114, 178], [204, 121, 167]];
/// Joints are grey.
const PIN: [u8; 3] = [120, 120, 120];
/// Markers are black, with their names.
const MARKER: [u8; 3] = [20, 20, 20];
/// Weight and loads of a body that is cut free.
pub(super) const FREE_BODY: &str = "world/cut-free";
/// Rings about the joint that somebody selected.
pub(super) const MARK: &str = "world/marked";
/// Colour of the rings: blue, as selected rows are framed.
const MARKED: [u8; 3] = [20, 120, 215];
/// Directors u, v, w: red, green, blue as everywhere.
const AXES: [[u8; 3]; 3] = [[220, 60, 60], [60, 170, 60], [70, 110, 230]];
/// The largest picture of a Jacobian, in pixels a side; a larger one is drawn smaller.
const LARGEST_PICTURE: usize = 1024;

/// An entity path of parts that are taken literally, whatever characters they have.
pub(super) fn path(parts: &[&str]) -> EntityPath {
    EntityPath::new(parts.iter().map(|part| EntityPathPart::new(*part)).collect())
}

/// Logs all that does not change.
pub(super) fn log_static(
    recording: &RecordingStream,
    description: &SceneDescription,
) -> RecordingStreamResult<()> {
    let up = if description.y_is_up() {
        ViewCoordinates::RIGHT_HAND_Y_UP()
    } else {
        ViewCoordinates::RIGHT_HAND_Z_UP()
    };
    recording.log_static("world", &up)?;
    recording.log_static("world/ground", &axes(0.35 * description.size, ["x", "y", "z"]))?;
    log_markers(
        recording,
        path(&["world", "ground", "markers"]),
        &description.ground_markers,
        description.size,
    )?;
    for (index, body) in description.bodies.iter().enumerate() {
        let of_body = path(&["world", "bodies", &body.name, "markers"]);
        log_markers(recording, of_body, &body.markers, description.size)?;
        log_body(recording, body, PALETTE[index % PALETTE.len()], description.size)?;
    }
    for joint in &description.joints {
        let arrow = Arrows3D::update_fields()
            .with_radii([narrow(0.012 * description.size)])
            .with_labels([joint.name.as_str()])
            .with_show_labels(false);
        recording.log_static(path(&["world", "joints", &joint.name]), &arrow)?;
        let circle = LineStrips3D::update_fields()
            .with_colors([color_of(ArrowKind::Moment)])
            .with_radii([narrow(0.01 * description.size)]);
        recording.log_static(path(&["world", "joints", &joint.name, "moment"]), &circle)?;
        let names = joint.rows.iter().map(|row| format!("{} {row}", joint.name));
        let lines = SeriesLines::new().with_names(names);
        recording.log_static(path(&["plots", "multipliers", &joint.name]), &lines)?;
    }
    let arrow = Arrows3D::update_fields().with_radii([narrow(0.012 * description.size)]);
    recording.log_static(FREE_BODY, &arrow)?;
    let rings = LineStrips3D::update_fields()
        .with_colors([color(MARKED)])
        .with_radii([narrow(0.008 * description.size)]);
    recording.log_static(MARK, &rings)?;
    recording.log_static("plots/energy", &SeriesLines::new().with_names(["energy, J"]))?;
    let violation = SeriesLines::new().with_names(["position, m", "velocity, m/s"]);
    recording.log_static("plots/violation", &violation)?;
    if description.pattern.rows > 0 {
        recording.log_static("jacobian", &picture(&description.pattern))?;
    }
    Ok(())
}

fn axes(length: f64, labels: [&str; 3]) -> Arrows3D {
    let vectors = [[length, 0.0, 0.0], [0.0, length, 0.0], [0.0, 0.0, length]];
    Arrows3D::from_vectors(vectors.map(single))
        .with_colors(AXES.map(color))
        .with_labels(labels)
        .with_show_labels(false)
        .with_radii([narrow(0.012 * length)])
}

fn log_markers(
    recording: &RecordingStream,
    entity: EntityPath,
    markers: &[MarkerVisual],
    size: f64,
) -> RecordingStreamResult<()> {
    if markers.is_empty() {
        return Ok(());
    }
    let points = Points3D::new(markers.iter().map(|marker| single(marker.point)))
        .with_labels(markers.iter().map(|marker| marker.name.as_str()))
        .with_show_labels(true)
        .with_colors([color(MARKER)])
        .with_radii([narrow(0.012 * size)]);
    recording.log_static(entity, &points)
}

fn log_body(
    recording: &RecordingStream,
    body: &BodyVisual,
    rgb: [u8; 3],
    size: f64,
) -> RecordingStreamResult<()> {
    let at = |part: &str| path(&["world", "bodies", &body.name, part]);
    recording.log_static(at("axes"), &axes(0.2 * size, ["u", "v", "w"]))?;
    if !body.joint_points.is_empty() {
        let pins = Points3D::new(body.joint_points.iter().map(|&point| single(point)));
        recording
            .log_static(at("joints"), &pins.with_colors([color(PIN)]).with_radii([narrow(0.02 * size)]))?;
    }
    if body.shapes.is_empty() {
        // A body that nobody drew is a ball at the centre of mass, with a bar to each of its joints.
        let bars = body.joint_points.iter().map(|&point| [[0.0_f32; 3], single(point)]);
        recording.log_static(
            at("shape"),
            &LineStrips3D::new(bars).with_colors([color(rgb)]).with_radii([narrow(0.02 * size)]),
        )?;
        let ball = Points3D::new([[0.0_f32; 3]]).with_colors([color(rgb)]).with_radii([narrow(0.05 * size)]);
        return recording.log_static(at("center"), &ball);
    }
    // Shapes are written in the author's frame; the body's entity moves with the principal one.
    let rows = body.principal_axes;
    let offset: [f64; 3] =
        std::array::from_fn(|k| -(0..3).map(|m| rows[k][m] * body.center_of_mass[m]).sum::<f64>());
    let columns: [[f64; 3]; 3] = std::array::from_fn(|m| std::array::from_fn(|k| rows[k][m]));
    recording.log_static(
        at("shape"),
        &Transform3D::from_translation_mat3x3(single(offset), columns.map(single)),
    )?;
    for (index, shape) in body.shapes.iter().enumerate() {
        let entity = path(&["world", "bodies", &body.name, "shape", &index.to_string()]);
        log_shape(recording, entity, shape, color(rgb))?;
    }
    Ok(())
}

fn log_shape(
    recording: &RecordingStream,
    entity: EntityPath,
    shape: &Shape,
    color: Color,
) -> RecordingStreamResult<()> {
    match shape {
        Shape::Rod { from, to, radius } => {
            let (length, rotation) = from_z(std::array::from_fn(|k| to[k] - from[k]));
            let rod = Capsules3D::from_lengths_and_radii([narrow(length)], [narrow(*radius)])
                .with_translations([single(*from)])
                .with_quaternions([rotation])
                .with_fill_mode(FillMode::Solid)
                .with_colors([color]);
            recording.log_static(entity, &rod)
        }
        Shape::Sphere { center, radius } => recording.log_static(
            entity,
            &Points3D::new([single(*center)]).with_radii([narrow(*radius)]).with_colors([color]),
        ),
        Shape::Box { center, size } => {
            let solid = Boxes3D::from_centers_and_sizes([single(*center)], [single(*size)])
                .with_fill_mode(FillMode::Solid)
                .with_colors([color]);
            recording.log_static(entity, &solid)
        }
    }
}

/// Length of a vector, and the rotation that takes +z to its direction.
fn from_z(vector: [f64; 3]) -> (f64, Quaternion) {
    let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length == 0.0 {
        return (0.0, Quaternion::from_xyzw([0.0, 0.0, 0.0, 1.0]));
    }
    let [x, y, z] = vector.map(|component| component / length);
    let q = if z > -1.0 + 1e-12 { [-y, x, 0.0, 1.0 + z] } else { [1.0, 0.0, 0.0, 0.0] };
    let norm = q.iter().map(|c| c * c).sum::<f64>().sqrt();
    (length, Quaternion::from_xyzw(q.map(|c| narrow(c / norm))))
}

/// The pattern as an image: rows downwards, coordinates to the right, constant entries blue, others orange.
fn picture(pattern: &Pattern) -> Image {
    let shrink = pattern.rows.max(pattern.columns).div_ceil(LARGEST_PICTURE).max(1);
    let (width, height) = (pattern.columns.div_ceil(shrink), pattern.rows.div_ceil(shrink));
    let mut pixels = vec![245_u8; 3 * width * height];
    // Constant entries first, so that one that changes is seen where several share a pixel.
    for constant in [true, false] {
        let rgb = if constant { [0, 114, 178] } else { [230, 159, 0] };
        for &(row, column, _) in pattern.entries.iter().filter(|entry| entry.2 == constant) {
            let first = 3 * ((row / shrink) * width + column / shrink);
            pixels[first..first + 3].copy_from_slice(&rgb);
        }
    }
    let side = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    Image::from_rgb24(pixels, [side(width), side(height)])
}

/// Reactions are vermilion everywhere, moments purple, weights blue, loads green.
pub(super) fn color_of(kind: ArrowKind) -> Color {
    color(match kind {
        ArrowKind::Reaction => [213, 94, 0],
        ArrowKind::Moment => [204, 121, 167],
        ArrowKind::Weight => [0, 114, 178],
        ArrowKind::Load => [0, 158, 115],
    })
}

fn color(rgb: [u8; 3]) -> Color {
    Color::from_rgb(rgb[0], rgb[1], rgb[2])
}

/// The viewer draws in single precision.
#[allow(clippy::cast_possible_truncation)]
pub(super) fn narrow(x: f64) -> f32 {
    x as f32
}

/// The viewer draws in single precision.
pub(super) fn single(vector: [f64; 3]) -> [f32; 3] {
    vector.map(narrow)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rotates +z by a quaternion.
    fn turned([x, y, z, w]: [f32; 4]) -> [f32; 3] {
        [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)]
    }

    #[test]
    fn rods_point_from_one_end_to_the_other() {
        for vector in [[0.0, 0.0, -2.0], [3.0, 0.0, 0.0], [1.0, -2.0, 0.5], [0.0, 0.0, 1.0]] {
            let (length, rotation) = from_z(vector);
            let direction = turned(rotation.0);
            for k in 0..3 {
                assert!((f64::from(direction[k]) * length - vector[k]).abs() < 1e-5, "{vector:?}");
            }
        }
    }
}
