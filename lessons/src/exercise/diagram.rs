//! Free-body diagrams: bodies, places and the right arrows.

use triad_engine::scene::{Driver, Scene};

use super::context::{BuildContext, BuildError, build_error, refuse};
use crate::answers::diagram::{Arrow, ArrowKind, Axis, CENTRE};
use crate::files::diagram::{AllowedArrowFile, EmptyPointFile};
use crate::files::{QuestionFile, ReferenceFile};

/// Most bodies of one picture.
const MAX_BODIES: usize = 4;

/// A free-body diagram.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagram {
    /// The mechanism.
    pub scene: Scene,
    /// The bodies that are cut free.
    pub bodies: Vec<String>,
    /// The moment that is shown, s.
    pub time: f64,
    /// The axis that points out of the picture.
    pub view: Axis,
    /// Points where nothing acts.
    pub points: Vec<EmptyPointFile>,
    /// Arrows that count neither way.
    pub allowed: Vec<AllowedArrowFile>,
    /// The right arrows.
    pub reference: Vec<Arrow>,
}

impl Diagram {
    /// The places where an arrow may be put on a body: its joints and drivers, its centre of mass, and points where
    /// nothing acts.
    pub(crate) fn places(&self, body: &str) -> Vec<&str> {
        let joints = self.scene.joints.iter().filter(|j| j.body_i == body || j.body_j == body);
        let mut places: Vec<&str> = joints.map(|j| j.name.as_str()).collect();
        places.extend(self.scene.drivers.iter().filter(|d| self.drives(d, body)).map(Driver::name));
        places.push(CENTRE);
        places.extend(self.points.iter().filter(|p| p.body == body).map(|p| p.name.as_str()));
        places
    }

    /// Whether a driver acts on a body.
    fn drives(&self, driver: &Driver, body: &str) -> bool {
        let meets = |name: &str| {
            self.scene.joints.iter().any(|j| j.name == name && (j.body_i == body || j.body_j == body))
        };
        match driver {
            Driver::Point { body: b, .. }
            | Driver::Vector { body: b, .. }
            | Driver::AngleToWorld { body: b, .. } => b == body,
            Driver::Angle { joint, .. } | Driver::Slide { joint, .. } => meets(joint),
            Driver::AngleCosine { body_i, body_j, .. } => body_i == body || body_j == body,
        }
    }

    /// Whether an arrow can be drawn in the picture: a force in its plane, a moment out of it.
    pub(crate) fn shows(&self, kind: ArrowKind, axis: Axis) -> bool {
        (kind == ArrowKind::Moment) == (axis == self.view)
    }

    /// Whether an arrow counts neither way.
    pub(crate) fn allows(&self, arrow: &Arrow) -> bool {
        let same =
            |a: &AllowedArrowFile| a.kind == arrow.kind && a.at == arrow.at && a.axis == arrow.along.axis();
        self.allowed.iter().any(same)
    }
}

pub(super) fn diagram(
    question: &QuestionFile,
    reference: &ReferenceFile,
    context: &BuildContext,
) -> Result<Diagram, BuildError> {
    refuse(question.unit.is_some(), "a unit", "diagram")?;
    refuse(question.tolerance.is_some(), "a tolerance", "diagram")?;
    refuse(!question.misconceptions.is_empty(), "a misconception (they are known)", "diagram")?;
    let file = question.diagram.as_ref();
    let file = file.ok_or_else(|| build_error("it has no table diagram", "add [question.diagram]"))?;
    let scene = context.scene_of(file.scene.as_deref())?;
    if file.bodies.is_empty() || file.bodies.len() > MAX_BODIES || !(0.0..=60.0).contains(&file.time) {
        let problem = "it cuts no body free, too many, or at no usable time";
        return Err(build_error(problem, "name 1 to 4 bodies and a time from 0 to 60 s"));
    }
    let known = |name: &str| scene.bodies.iter().any(|body| body.name == name);
    let strangers = file.bodies.iter().chain(file.points.iter().map(|p| &p.body)).find(|name| !known(name));
    if let Some(name) = strangers {
        return Err(build_error(format!("there is no body {name}"), "name a body of the scene"));
    }
    if !scene.loads.is_empty() {
        let remedy = "take them out, or ask about a body without them in a scene of its own";
        return Err(build_error("its scene has loads, which are not drawn", remedy));
    }
    let diagram = Diagram {
        scene,
        bodies: file.bodies.clone(),
        time: file.time,
        view: file.view,
        points: file.points.clone(),
        allowed: file.allowed.clone(),
        reference: reference.diagram.clone().unwrap_or_default(),
    };
    let fits = |arrow: &Arrow| {
        diagram.bodies.contains(&arrow.on)
            && diagram.places(&arrow.on).contains(&arrow.at.as_str())
            && diagram.shows(arrow.kind, arrow.along.axis())
    };
    if diagram.reference.is_empty() {
        let remedy =
            "write diagram = [{ kind = \"force\", at = \"centre\", on = \"rod\", along = \"-y\" }, …]";
        return Err(build_error("its reference has no diagram", remedy).in_reference());
    }
    if let Some(arrow) = diagram.reference.iter().find(|arrow| !fits(arrow)) {
        let problem = format!("its arrow at {} on {} is not in the picture", arrow.at, arrow.on);
        return Err(
            build_error(problem, "name a body, one of its places, and an axis that is seen").in_reference()
        );
    }
    Ok(diagram)
}
