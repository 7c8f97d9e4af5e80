//! Directors that two bodies share at a revolute joint — THEORY section 3.
//!
//! Where the axis of a joint is a director of both of its bodies, its three coordinates need to be written once: the
//! rows of the common vector vanish and the mass matrix couples the bodies. A director joined to the ground becomes a
//! constant. Directors that are shared in turn all follow the first body that has them.

use crate::model::{BodyRef, Model, ModelJoint, director_along};
use crate::system::natural::{Director, Layout};
use nalgebra::Vector3;

/// What a director follows.
#[derive(Clone, Copy, Debug)]
enum Root {
    /// Nothing: it has its own coordinates.
    Own,
    /// A director of another body, times a sign.
    Follows(usize, usize, f64),
    /// A vector of the ground.
    Fixed(Vector3<f64>),
}

/// Layouts of all bodies, columns in the order of bodies.
pub fn layouts(model: &Model) -> Vec<Layout> {
    let mut roots = vec![[Root::Own; 3]; model.bodies.len()];
    for joint in &model.joints {
        if joint.geometry.shares_director() {
            share(&mut roots, joint);
        }
    }
    let mut next = 0;
    let mut layouts: Vec<Layout> = Vec::with_capacity(model.bodies.len());
    for (body, root) in model.bodies.iter().zip(&roots) {
        let mut layout = Layout::own(body.coordinates, next);
        let mut column = next + 3;
        for (director, root) in layout.directors.iter_mut().zip(root) {
            if let (Root::Own, Director::Own(place)) = (root, &mut *director) {
                *place = column;
                column += 3;
            } else if let Root::Fixed(value) = root {
                *director = Director::Fixed(*value);
            }
        }
        next = column;
        layouts.push(layout);
    }
    for body in 0..layouts.len() {
        for k in 0..3 {
            if let (other, l, sign) = follow(&roots, body, k)
                && (other, l) != (body, k)
            {
                layouts[body].directors[k] = match layouts[other].directors[l] {
                    Director::Own(column) => Director::Shared { column, sign },
                    Director::Fixed(value) => Director::Fixed(value * sign),
                    own => own,
                };
            }
        }
    }
    layouts
}

/// The director that (body, k) follows in the end, and its sign.
fn follow(roots: &[[Root; 3]], mut body: usize, mut k: usize) -> (usize, usize, f64) {
    let mut sign = 1.0;
    while let Root::Follows(other, l, s) = roots[body][k] {
        (body, k, sign) = (other, l, sign * s);
    }
    (body, k, sign)
}

fn share(roots: &mut [[Root; 3]], joint: &ModelJoint) {
    // The model has checked that each axis lies along a director.
    let side = |side: usize| match joint.bodies[side] {
        BodyRef::Ground => None,
        BodyRef::Moving(body) => director_along(&joint.axes[side]).map(|(k, sign)| (body, k, sign)),
    };
    match (side(0), side(1)) {
        (Some((i, k, si)), Some((j, l, sj))) => {
            let (a, ka, sa) = follow(roots, i, k);
            let (b, lb, sb) = follow(roots, j, l);
            if (a, ka) == (b, lb) {
                return;
            }
            // Columns are laid out in the order of bodies; the earlier one keeps its own.
            let sign = si * sj * sa * sb;
            let (kept, freed) = if (a, ka) < (b, lb) { ((a, ka), (b, lb)) } else { ((b, lb), (a, ka)) };
            match roots[freed.0][freed.1] {
                Root::Fixed(value) if matches!(roots[kept.0][kept.1], Root::Own) => {
                    roots[kept.0][kept.1] = Root::Fixed(value * sign);
                }
                Root::Fixed(_) => return,
                _ => {}
            }
            roots[freed.0][freed.1] = Root::Follows(kept.0, kept.1, sign);
        }
        (None, Some((body, k, sign))) => fix(roots, body, k, joint.axes[0] * sign),
        (Some((body, k, sign)), None) => fix(roots, body, k, joint.axes[1] * sign),
        (None, None) => {}
    }
}

fn fix(roots: &mut [[Root; 3]], body: usize, k: usize, value: Vector3<f64>) {
    let (root, l, sign) = follow(roots, body, k);
    if matches!(roots[root][l], Root::Own) {
        roots[root][l] = Root::Fixed(value * sign);
    }
}
