//! What a scene takes for granted, in one line above the questions: axes, gravity, masses, inertias, positive senses. It is made
//! from the scene itself, so it holds for the student's own numbers and cannot contradict what is run.

use std::fmt::Write as _;

use triad_engine::scene::{Body, Driver, GROUND, Inertia, Joint, Scene};

use crate::text::plain;

/// Names of the world's axes.
const AXES: [&str; 3] = ["x", "y", "z"];

/// The conventions of a scene, as Markdown.
pub(super) fn conventions(scene: &Scene) -> String {
    let mut sentences = vec![gravity(scene.gravity)];
    sentences.extend(masses(&scene.bodies));
    if scene.bodies.iter().any(|body| matches!(body.inertia, Some(Inertia::Principal(_)))) {
        let axes = "$\\mathbf u,\\mathbf v,\\mathbf w$";
        sentences.push(format!("Moments of inertia are about {axes} through the centre of mass."));
    }
    sentences.extend(sides(&scene.joints));
    sentences.extend(scene.drivers.iter().filter_map(|driver| positive(driver, &scene.joints)));
    sentences.push("Angles, angular velocities and moments are positive by the right-hand rule.".to_owned());
    sentences.join(" ")
}

fn gravity(g: [f64; 3]) -> String {
    let size = g.iter().map(|x| x * x).sum::<f64>().sqrt();
    if size == 0.0 {
        return "No gravity.".to_owned();
    }
    match direction(g.map(|x| -x / size)) {
        Some(axis) => format!("The axis {axis} points up, $g={}$ m/s².", plain(size)),
        None => format!("Gravity is $({})$ m/s².", list(g)),
    }
}

/// The axis along which a unit vector lies, if it lies along one.
fn direction(unit: [f64; 3]) -> Option<String> {
    let k = unit.iter().position(|x| (x.abs() - 1.0).abs() < 1e-12)?;
    Some(format!("${}{}$", if unit[k] > 0.0 { "+" } else { "-" }, AXES[k]))
}

fn list(numbers: [f64; 3]) -> String {
    numbers.map(plain).join(", ")
}

/// A body's name as it is shown.
fn name(text: &str) -> String {
    if text == GROUND { "the ground".to_owned() } else { format!("`{text}`") }
}

fn named(names: &[&str]) -> String {
    let names: Vec<String> = names.iter().map(|n| name(n)).collect();
    match names.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("{} and {last}", rest.join(", ")),
        None => String::new(),
    }
}

/// Bodies of the same mass and inertia in one sentence.
fn masses(bodies: &[Body]) -> Vec<String> {
    let mut groups: Vec<([String; 2], Vec<&str>)> = Vec::new();
    for body in bodies {
        let what = [format!("{} kg", plain(body.mass)), shape(body)];
        match groups.iter_mut().find(|(known, _)| *known == what) {
            Some((_, names)) => names.push(&body.name),
            None => groups.push((what, vec![&body.name])),
        }
    }
    groups
        .into_iter()
        .map(|([mass, shape], names)| {
            let each = if names.len() > 1 { " each" } else { "" };
            format!("{}: {mass}{each}{shape}.", capital(&named(&names)))
        })
        .collect()
}

/// What a body has beside its mass.
fn shape(body: &Body) -> String {
    let mut text = String::new();
    match &body.inertia {
        Some(Inertia::Principal(moments)) => {
            let _ = write!(text, ", moments of inertia $({})$ kg m²", list(*moments));
        }
        Some(Inertia::Tensor(rows)) => {
            let _ = write!(
                text,
                ", inertia tensor $[{}]$ kg m² along its axes, about the centre of mass",
                rows.map(list).join("; ")
            );
        }
        None => text.push_str(", a point mass"),
    }
    for part in &body.attached {
        let _ = write!(text, ", with {} kg at $({})$ m", plain(part.mass), list(part.point));
    }
    text
}

/// Which body of each joint is i and which is j; joints between the same bodies together.
fn sides(joints: &[Joint]) -> Vec<String> {
    let mut groups: Vec<([&str; 2], Vec<&str>)> = Vec::new();
    for joint in joints.iter().filter(|joint| !joint.body_i.is_empty()) {
        let pair = [joint.body_i.as_str(), joint.body_j.as_str()];
        match groups.iter_mut().find(|(known, _)| *known == pair) {
            Some((_, names)) => names.push(&joint.name),
            None => groups.push((pair, vec![&joint.name])),
        }
    }
    if groups.is_empty() {
        return Vec::new();
    }
    let each = groups.iter().map(|([i, j], names)| {
        let lead = if names.len() > 1 { "lead" } else { "leads" };
        format!("{} {lead} from {} to {}", named(names), name(i), name(j))
    });
    vec![format!("From body $i$ to body $j$: {}.", each.collect::<Vec<_>>().join("; "))]
}

/// The sense in which a motor counts.
fn positive(driver: &Driver, joints: &[Joint]) -> Option<String> {
    let (Driver::Angle { name: own, joint, .. } | Driver::Slide { name: own, joint, .. }) = driver else {
        return None;
    };
    let joint = joints.iter().find(|j| j.name == *joint)?;
    let axis = joint.axis.or(joint.axis_i.filter(|_| joint.body_i == GROUND))?;
    let size = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    let unit = axis.map(|x| x / size);
    let axis = direction(unit).unwrap_or_else(|| format!("$({})$", list(unit)));
    let (what, way) = match driver {
        Driver::Angle { .. } => ("angle and moment", "about"),
        _ => ("displacement and force", "along"),
    };
    let (j, i) = (name(&joint.body_j), name(&joint.body_i));
    Some(format!("{}: {what} on {j} against {i} are positive {way} {axis}.", capital(&name(own))))
}

/// A capital first letter, where it is a letter.
fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use crate::Course;

    #[test]
    fn the_line_is_that_of_the_students_own_scene() {
        let course = Course::embedded().unwrap();
        let lesson = course.lesson("inverse-dynamics").unwrap().variant("ada").unwrap();
        let line = lesson.public_view().exercise.conventions_html;
        let mass = lesson.scene["bodies"][0]["mass"].as_f64().unwrap();
        for part in
            [format!("{mass} kg"), "+y".to_owned(), "9.81".to_owned(), "+z".to_owned(), "motor".to_owned()]
        {
            assert!(line.contains(&part), "{part}: {line}");
        }
        let links = course.lesson("jacobian").unwrap().public_view().exercise.conventions_html;
        for part in ["1 kg each, moments", "A</code> leads from the ground to <code>left</code>;"] {
            assert!(links.contains(part), "{part}: {links}");
        }
        assert_eq!(links.matches("centre of mass").count(), 1, "{links}");
        let free = course.lesson("generic-rigid-body").unwrap().public_view().exercise.conventions_html;
        assert!(free.contains("No gravity") && free.contains("(1, 2, 3)"), "{free}");
    }
}
