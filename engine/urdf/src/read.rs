//! From XML to links and joints; every number checked where it stands.

use nalgebra::{Isometry3, Matrix3, Quaternion, Translation3, UnitQuaternion, Vector3};
use roxmltree::{Document, Node, ParsingOptions};

use crate::omissions::{MAX_LINKS, OmittedItem, UrdfError, go_on};

/// XML nodes that are read.
const MAX_NODES: u32 = 400_000;

/// Attributes that an element may have; those of URDF have at most six. The XML reader compares each with all others.
const MAX_ATTRIBUTES: usize = 100;

#[derive(Debug)]
pub(super) struct Robot {
    pub name: String,
    pub links: Vec<Link>,
    pub joints: Vec<UrdfJoint>,
}

#[derive(Debug)]
pub(super) struct Link {
    pub line: u32,
    pub name: String,
    pub inertial: Option<Inertial>,
    pub shapes: Vec<Visual>,
}

/// Mass and inertia in the frame of the link.
#[derive(Debug)]
pub(super) struct Inertial {
    pub mass: f64,
    pub center: Vector3<f64>,
    pub tensor: Matrix3<f64>,
}

#[derive(Debug)]
pub(super) struct Visual {
    pub line: u32,
    pub origin: Isometry3<f64>,
    pub geometry: Geometry,
}

#[derive(Debug)]
pub(super) enum Geometry {
    Box(Vector3<f64>),
    Sphere(f64),
    Cylinder { radius: f64, length: f64 },
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum JointType {
    Revolute,
    Prismatic,
    Fixed,
    Floating,
    Planar,
}

#[derive(Debug)]
pub(super) struct UrdfJoint {
    pub line: u32,
    pub name: String,
    pub kind: JointType,
    pub origin: Isometry3<f64>,
    pub axis: Vector3<f64>,
    pub parent: String,
    pub child: String,
    pub damping: f64,
    pub friction: f64,
    /// The joint that it follows, with factor and offset.
    pub mimic: Option<(String, f64, f64)>,
}

/// What is left out, with its lines.
struct Report<'a> {
    left_out: &'a mut Vec<OmittedItem>,
    /// Where in the text lines end: the XML reader counts them from its beginning each time it is asked for one.
    ends: Vec<usize>,
}

impl Report<'_> {
    fn line(&self, node: Node) -> u32 {
        let before = self.ends.partition_point(|end| *end < node.range().start);
        u32::try_from(before + 1).unwrap_or(u32::MAX)
    }

    /// Tells attributes that an element of URDF does not have: a misspelt one would be taken for one that is missing.
    fn attributes(&mut self, node: Node, of: &str, known: &[&str]) {
        for attribute in node.attributes().filter(|attribute| attribute.namespace().is_none()) {
            let name = attribute.name();
            if !known.contains(&name) {
                let what = format!("\"{name}\" of <{}> has no meaning here", node.tag_name().name());
                self.leave_out(node, of, what);
            }
        }
    }

    fn leave_out(&mut self, node: Node, of: &str, what: String) {
        self.left_out.push(OmittedItem { line: self.line(node), of: of.to_owned(), what });
    }
}

pub(super) fn robot(
    text: &str,
    left_out: &mut Vec<OmittedItem>,
    wanted: &dyn Fn() -> bool,
) -> Result<Robot, UrdfError> {
    go_on(wanted)?;
    bound_attributes(text)?;
    let options = ParsingOptions { nodes_limit: MAX_NODES, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text, options)
        .map_err(|error| UrdfError::Xml { line: error.pos().row, cause: error.to_string() })?;
    let root = document.root_element();
    if !root.has_tag_name("robot") {
        let what = format!("the root element is <{}>, not <robot>", root.tag_name().name());
        return Err(wrong(root, what, "is this a URDF? SDF and MJCF are other formats"));
    }
    let mut report = Report { left_out, ends: text.match_indices('\n').map(|(at, _)| at).collect() };
    let mut robot =
        Robot { name: attribute(root, "name")?.to_owned(), links: Vec::new(), joints: Vec::new() };
    for node in root.children().filter(Node::is_element) {
        go_on(wanted)?;
        match node.tag_name().name() {
            "link" => robot.links.push(link(node, &mut report)?),
            "joint" => robot.joints.push(joint(node, &mut report)?),
            "material" => {}
            other => report.leave_out(node, "robot", format!("<{other}> has no meaning for a scene")),
        }
        if robot.links.len() > MAX_LINKS {
            return Err(wrong(
                node,
                format!("the robot has more than {MAX_LINKS} links"),
                "import a part of it",
            ));
        }
    }
    Ok(robot)
}

/// Refuses elements of very many attributes before they are read.
fn bound_attributes(text: &str) -> Result<(), UrdfError> {
    let (mut line, mut attributes, mut quote, mut before) = (1, 0, None, b' ');
    for byte in text.bytes() {
        match (byte, quote) {
            (b'\n', _) => line += 1,
            (b'"' | b'\'', None) => {
                quote = Some(byte);
                attributes += usize::from(before == b'=');
            }
            (_, Some(opened)) if byte == opened => quote = None,
            // Quotes do not pair in texts and comments: each element begins anew.
            (b'<', _) => (attributes, quote) = (0, None),
            _ => {}
        }
        if !byte.is_ascii_whitespace() {
            before = byte;
        }
        if attributes > MAX_ATTRIBUTES {
            return Err(UrdfError::Wrong {
                line,
                what: format!("an element has more than {MAX_ATTRIBUTES} attributes"),
                hint: "URDF has no such element: look at the end of the one before",
            });
        }
    }
    Ok(())
}

fn link(node: Node, report: &mut Report) -> Result<Link, UrdfError> {
    let name = attribute(node, "name")?.to_owned();
    let of = format!("link {name}");
    let mut link = Link { line: report.line(node), name, inertial: None, shapes: Vec::new() };
    once(node, &["inertial"])?;
    for part in node.children().filter(Node::is_element) {
        match part.tag_name().name() {
            "inertial" => link.inertial = Some(inertial(part, &of, report)?),
            "visual" => link.shapes.extend(visual(part, &of, report)?),
            "collision" => {}
            other => report.leave_out(part, &of, format!("<{other}> has no meaning for a scene")),
        }
    }
    if node.children().any(|part| part.has_tag_name("collision")) {
        let what = "<collision>: scenes have no contact between bodies".to_owned();
        report.leave_out(node, &of, what);
    }
    Ok(link)
}

fn inertial(node: Node, of: &str, report: &mut Report) -> Result<Inertial, UrdfError> {
    const MOMENTS: [&str; 6] = ["ixx", "iyy", "izz", "ixy", "ixz", "iyz"];
    once(node, &["origin", "mass", "inertia"])?;
    let origin = origin(node, of, report)?;
    let mass_node = child(node, "mass")?;
    report.attributes(mass_node, of, &["value"]);
    let mass = number(mass_node, "value")?;
    if mass < 0.0 {
        return Err(wrong(mass_node, format!("the mass of {of} is {mass}"), "a mass is never negative"));
    }
    let given = child(node, "inertia")?;
    report.attributes(given, of, &MOMENTS);
    let [xx, yy, zz] = ["ixx", "iyy", "izz"].map(|name| number(given, name));
    let [xy, xz, yz] = ["ixy", "ixz", "iyz"].map(|name| optional(given, name, 0.0));
    let (xx, xy, xz, yy, yz, zz) = (xx?, xy?, xz?, yy?, yz?, zz?);
    let own = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let turn = origin.rotation.to_rotation_matrix();
    Ok(Inertial { mass, center: origin.translation.vector, tensor: turn * own * turn.transpose() })
}

fn visual(node: Node, of: &str, report: &mut Report) -> Result<Option<Visual>, UrdfError> {
    once(node, &["origin", "geometry"])?;
    let geometry = child(node, "geometry")?;
    let Some(shape) = geometry.children().find(Node::is_element) else {
        return Err(wrong(
            geometry,
            "<geometry> is empty".to_owned(),
            "put a box, cylinder or sphere into it",
        ));
    };
    let geometry = match shape.tag_name().name() {
        "box" => Geometry::Box(vector(shape, "size")?),
        "sphere" => Geometry::Sphere(number(shape, "radius")?),
        "cylinder" => {
            Geometry::Cylinder { radius: number(shape, "radius")?, length: number(shape, "length")? }
        }
        other => {
            let file = shape.attribute("filename").map(|name| format!(" {name}")).unwrap_or_default();
            let what = format!("<{other}>{file}: it is drawn as bars between its joints");
            report.leave_out(shape, of, what);
            return Ok(None);
        }
    };
    Ok(Some(Visual { line: report.line(node), origin: origin(node, of, report)?, geometry }))
}

fn joint(node: Node, report: &mut Report) -> Result<UrdfJoint, UrdfError> {
    let name = attribute(node, "name")?.to_owned();
    let of = format!("joint {name}");
    let kind = match attribute(node, "type")? {
        "revolute" | "continuous" => JointType::Revolute,
        "prismatic" => JointType::Prismatic,
        "fixed" => JointType::Fixed,
        "floating" => JointType::Floating,
        "planar" => JointType::Planar,
        other => {
            let what = format!("{of} is of type \"{other}\"");
            return Err(wrong(node, what, "use revolute, continuous, prismatic, fixed, floating or planar"));
        }
    };
    once(node, &["origin", "parent", "child", "axis", "dynamics", "mimic"])?;
    let mut axis = Vector3::x();
    let (mut damping, mut friction, mut mimic) = (0.0, 0.0, None);
    for part in node.children().filter(Node::is_element) {
        let mut leave = |what: &str| report.leave_out(part, &of, what.to_owned());
        match part.tag_name().name() {
            "origin" => {}
            "parent" | "child" => report.attributes(part, &of, &["link"]),
            "axis" => {
                report.attributes(part, &of, &["xyz"]);
                axis = vector(part, "xyz")?;
            }
            "dynamics" => {
                report.attributes(part, &of, &["damping", "friction"]);
                damping = optional(part, "damping", 0.0)?;
                friction = optional(part, "friction", 0.0)?;
            }
            "mimic" => {
                report.attributes(part, &of, &["joint", "multiplier", "offset"]);
                let factor = optional(part, "multiplier", 1.0)?;
                mimic = Some((attribute(part, "joint")?.to_owned(), factor, optional(part, "offset", 0.0)?));
            }
            "limit" if kind == JointType::Fixed => {}
            "limit" => leave("<limit>: the joint moves beyond its limits, and its effort is not bounded"),
            other => leave(&format!("<{other}> has no meaning for a scene")),
        }
    }
    if !matches!(kind, JointType::Fixed | JointType::Floating) && axis.norm() < 1e-9 {
        return Err(wrong(
            node,
            format!("the axis of {of} has no direction"),
            "give it an axis like \"0 0 1\"",
        ));
    }
    let end = |which: &str| Ok::<_, UrdfError>(attribute(child(node, which)?, "link")?.to_owned());
    Ok(UrdfJoint {
        line: report.line(node),
        kind,
        origin: origin(node, &of, report)?,
        axis: axis.try_normalize(1e-12).unwrap_or_else(Vector3::x),
        parent: end("parent")?,
        child: end("child")?,
        damping,
        friction,
        mimic,
        name,
    })
}

/// The frame of an element: xyz, then roll, pitch and yaw about fixed axes, or a quaternion.
fn origin(node: Node, of: &str, report: &mut Report) -> Result<Isometry3<f64>, UrdfError> {
    let Some(origin) = node.children().find(|part| part.has_tag_name("origin")) else {
        return Ok(Isometry3::identity());
    };
    report.attributes(origin, of, &["xyz", "rpy", "quat_xyzw"]);
    let or_zero = |name: &str| match origin.attribute(name) {
        Some(_) => vector(origin, name),
        None => Ok(Vector3::zeros()),
    };
    let (xyz, rpy) = (or_zero("xyz")?, or_zero("rpy")?);
    let mut turn = UnitQuaternion::from_euler_angles(rpy.x, rpy.y, rpy.z);
    if origin.has_attribute("quat_xyzw") {
        let [x, y, z, w] = numbers(origin, "quat_xyzw", "four numbers", "write them like \"0 0 0 1\"")?;
        if origin.has_attribute("rpy") {
            let what = "<origin> is turned by rpy and by quat_xyzw".to_owned();
            return Err(wrong(origin, what, "keep one of them"));
        }
        let quaternion = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-9);
        turn = quaternion.ok_or_else(|| {
            wrong(origin, "quat_xyzw is no rotation".to_owned(), "write one like \"0 0 0 1\"")
        })?;
    }
    Ok(Isometry3::from_parts(Translation3::from(xyz), turn))
}

/// Refuses parts that an element has twice: which of them is meant is not known.
fn once(node: Node, names: &[&str]) -> Result<(), UrdfError> {
    for name in names {
        if let Some(second) = node.children().filter(|part| part.has_tag_name(*name)).nth(1) {
            let what = format!("<{}> has <{name}> twice", node.tag_name().name());
            return Err(wrong(second, what, "keep one of them"));
        }
    }
    Ok(())
}

fn wrong(node: Node, what: String, hint: &'static str) -> UrdfError {
    UrdfError::Wrong { line: node.document().text_pos_at(node.range().start).row, what, hint }
}

fn child<'a, 'd>(node: Node<'a, 'd>, name: &str) -> Result<Node<'a, 'd>, UrdfError> {
    node.children().find(|part| part.has_tag_name(name)).ok_or_else(|| {
        wrong(node, format!("<{}> has no <{name}>", node.tag_name().name()), "the URDF is not complete here")
    })
}

fn attribute<'a>(node: Node<'a, '_>, name: &str) -> Result<&'a str, UrdfError> {
    let missing = || {
        let what = format!("<{}> has no attribute \"{name}\"", node.tag_name().name());
        wrong(node, what, "the URDF is not complete here")
    };
    node.attribute(name).map(str::trim).filter(|text| !text.is_empty()).ok_or_else(missing)
}

fn number(node: Node, name: &str) -> Result<f64, UrdfError> {
    let text = attribute(node, name)?;
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(wrong(node, format!("{name} is \"{text}\", not a number"), "write it like 0.25 or 1e-3")),
    }
}

fn optional(node: Node, name: &str, otherwise: f64) -> Result<f64, UrdfError> {
    if node.has_attribute(name) { number(node, name) } else { Ok(otherwise) }
}

fn vector(node: Node, name: &str) -> Result<Vector3<f64>, UrdfError> {
    numbers(node, name, "three numbers", "write them like \"0 0 1\"").map(Vector3::from)
}

/// So many numbers; `many` says how many, `like` how they are written.
fn numbers<const N: usize>(
    node: Node,
    name: &str,
    many: &str,
    like: &'static str,
) -> Result<[f64; N], UrdfError> {
    let text = attribute(node, name)?;
    let read: Option<Vec<f64>> =
        text.split_whitespace().map(|part| part.parse().ok().filter(|x: &f64| x.is_finite())).collect();
    read.and_then(|numbers| numbers.try_into().ok())
        .ok_or_else(|| wrong(node, format!("{name} is \"{text}\", not {many}"), like))
}
