//! What misconceptions make of the parts of the equations.

use triad_engine::constraints::mechanism::Mechanism;
use triad_engine::equations::augmented::AugmentedSystem;
use triad_engine::scene::Coordinates;
use triad_engine::system::body::RigidBody;

use super::grid::Grid;
use super::instances::{InstanceError, part_of};
use super::rows::{blocks_transposed, columns_swapped, differences, driven, first, turned, unit_rows};
use crate::files::EquationPart;
use crate::scenario::equations::{gamma_parts, with_ibar, with_velocity_term};

const SWAPPED: &str = "In the rows of joints body i and body j are swapped.";
const ONE_SWAPPED: &str = "In the rows of one joint body i and body j are swapped.";
const INERTIA: &str =
    "The moments of inertia stand where Ī belongs: Ī_u = ½(I_v + I_w − I_u), the reach along the axis.";
const GAMMA_TERM_MISSING: &str =
    "The term with V̇q̇ of the reduced body is missing in γ, wherever a row contains w.";
const GAMMA_TERM_SIGN: &str = "The term with V̇q̇ of the reduced body has the wrong sign in γ.";
const UNIT_ROWS_HALF: &str = "The rows of unit length lack their factor 2: the derivative of uᵀu is 2uᵀ.";
const HALF_TERM: &str =
    "In V̇q̇ of the reduced body a factor 2 is missing: the product rule brings u̇ × v̇ twice.";

/// A misconception's name, what is said of it, and what it makes of the equations.
pub(super) type Row =
    (&'static str, &'static str, Box<dyn Fn(&Mechanism, &AugmentedSystem) -> Result<Grid, InstanceError>>);

fn row(
    id: &'static str,
    feedback: &'static str,
    make: impl Fn(&Mechanism, &AugmentedSystem) -> Result<Grid, InstanceError> + 'static,
) -> Row {
    (id, feedback, Box::new(make))
}

pub(super) fn table(part: EquationPart) -> Vec<Row> {
    match part {
        EquationPart::Phi => phi(),
        EquationPart::Jacobian => jacobian(),
        EquationPart::Gamma => gamma(),
        EquationPart::Mass => mass(),
        EquationPart::Acceleration => acceleration(),
    }
}

fn phi() -> Vec<Row> {
    vec![
        row("sign", "Every Φ has the opposite sign. Take body i less body j.", |_, l| {
            Ok(part_of(l, EquationPart::Phi)?.scaled(-1.0))
        }),
        row(
            "unit-length",
            "The rows of unit length lack their −1: the product of a unit vector with itself is 1.",
            |m, l| {
                let mut grid = part_of(l, EquationPart::Phi)?;
                for row in unit_rows(m) {
                    grid.values[row] += 1.0;
                }
                Ok(grid)
            },
        ),
        row("bodies-swapped", SWAPPED, |m, l| {
            Ok(turned(&part_of(l, EquationPart::Phi)?, m.system.rigid_rows..l.constraints.len()))
        }),
        row("bodies-swapped", SWAPPED, |m, l| {
            let grid = part_of(l, EquationPart::Phi)?;
            Ok(differences(m).into_iter().fold(grid, |grid, rows| turned(&grid, rows)))
        }),
        row("one-joint-swapped", ONE_SWAPPED, |m, l| Ok(turned(&part_of(l, EquationPart::Phi)?, first(m)))),
        row("driver-target", "In the row of the driver the prescribed number is missing.", |m, l| {
            let mut grid = part_of(l, EquationPart::Phi)?;
            for (row, [c, ..]) in driven(m) {
                grid.values[row] += c;
            }
            Ok(grid)
        }),
    ]
}

fn jacobian() -> Vec<Row> {
    vec![
        row("sign", "Every entry has the opposite sign.", |_, l| {
            Ok(part_of(l, EquationPart::Jacobian)?.scaled(-1.0))
        }),
        row(
            "transposed",
            "This is Φ_qᵀ: one line for each row of Φ, one column for each coordinate.",
            |_, l| Ok(part_of(l, EquationPart::Jacobian)?.transposed()),
        ),
        row("unit-rows-half", UNIT_ROWS_HALF, |m, l| {
            let mut grid = part_of(l, EquationPart::Jacobian)?;
            for row in unit_rows(m) {
                grid.values[row * grid.columns..(row + 1) * grid.columns].iter_mut().for_each(|x| *x *= 0.5);
            }
            Ok(grid)
        }),
        row("bodies-swapped", SWAPPED, |m, l| {
            Ok(turned(&part_of(l, EquationPart::Jacobian)?, m.system.rigid_rows..l.constraints.len()))
        }),
        row("bodies-swapped", SWAPPED, |m, l| {
            let grid = part_of(l, EquationPart::Jacobian)?;
            Ok(differences(m).into_iter().fold(grid, |grid, rows| turned(&grid, rows)))
        }),
        row("one-joint-swapped", ONE_SWAPPED, |m, l| {
            Ok(turned(&part_of(l, EquationPart::Jacobian)?, first(m)))
        }),
        row("columns-swapped", "In the rows of joints the columns of the two bodies are swapped.", |m, l| {
            Ok(columns_swapped(m, &part_of(l, EquationPart::Jacobian)?))
        }),
        row(
            "block-transposed",
            "The 3 × 3 blocks of the joints' rows are transposed; for a skew block this is its sign.",
            |m, l| Ok(blocks_transposed(m, &part_of(l, EquationPart::Jacobian)?)),
        ),
    ]
}

fn gamma() -> Vec<Row> {
    let mut rows = gamma_of_joints();
    rows.extend(gamma_of_drivers());
    rows
}

fn gamma_of_joints() -> Vec<Row> {
    vec![
        row(
            "gamma-sign",
            "γ has the opposite sign. From Φ_q q̈ + (Φ_q q̇)_q q̇ = 0 it is minus the second term.",
            |_, l| Ok(part_of(l, EquationPart::Gamma)?.scaled(-1.0)),
        ),
        row(
            "gamma-half",
            "γ is half of what it should be: the product rule brings every pair twice.",
            |_, l| Ok(part_of(l, EquationPart::Gamma)?.scaled(0.5)),
        ),
        row(
            "gamma-zero",
            "γ is zero. It is so for linear rows only; differentiate the quadratic ones twice.",
            |_, l| Ok(part_of(l, EquationPart::Gamma)?.scaled(0.0)),
        ),
        row(
            "velocity-term-missing",
            "The term with V̇q̇ of the reduced body is missing: ẅ has the part 2 u̇ × v̇, which enters γ wherever a row contains w.",
            |m, _| Ok(Grid::column(gamma_parts(m).into_iter().map(|[natural, _]| natural).collect())),
        ),
        row("velocity-term-sign", GAMMA_TERM_SIGN, |m, _| {
            Ok(Grid::column(gamma_parts(m).into_iter().map(|[natural, reduced]| natural - reduced).collect()))
        }),
        row(
            "velocity-term-alone",
            "Only the term with V̇q̇ of the reduced body is there; the rows' own second derivative is missing.",
            |m, _| Ok(Grid::column(gamma_parts(m).into_iter().map(|[_, reduced]| reduced).collect())),
        ),
        row("velocity-term-half", HALF_TERM, |m, _| {
            Ok(Grid::column(gamma_parts(m).into_iter().map(|[own, reduced]| own + 0.5 * reduced).collect()))
        }),
    ]
}

fn gamma_of_drivers() -> Vec<Row> {
    vec![
        driver("driver-sign", "The part of the driver has the wrong sign in γ.", |[_, _, c2], _, own| {
            own - 2.0 * c2
        }),
        driver(
            "driver-left-out",
            "The driver's own second derivative is missing in γ.",
            |[_, _, c2], _, own| own - c2,
        ),
        driver(
            "driver-product",
            "In γ of the driver's row the part 2 ȧᵀḃ of the two vectors is missing.",
            |[_, _, c2], _, _| c2,
        ),
        driver(
            "driver-square",
            "In γ of the driver's row a part is missing: a cosine differentiated twice has a part with θ̇² as well.",
            |_, square, own| own + square,
        ),
        driver(
            "driver-acceleration",
            "In γ of the driver's row the part with θ̈ is missing.",
            |[_, _, c2], square, own| own - c2 - square,
        ),
        driver(
            "driver-square-sign",
            "In γ of the driver's row the part with θ̇² has the wrong sign.",
            |_, square, own| own + 2.0 * square,
        ),
        driver(
            "driver-acceleration-sign",
            "In γ of the driver's row the part with θ̈ has the wrong sign.",
            |[_, _, c2], square, own| own - 2.0 * (c2 + square),
        ),
        driver("driver-row-sign", "γ of the driver's row has the opposite sign.", |_, _, own| -own),
        driver(
            "driver-row-zero",
            "γ of the driver's row is zero: its second derivatives are missing.",
            |_, _, _| 0.0,
        ),
    ]
}

/// A misconception of γ in the rows of drivers: from the prescribed number with its derivatives, its part with the square of
/// the angle's rate (taken positive in γ's place, so that γ has it with a minus), and the right entry.
fn driver(
    id: &'static str,
    feedback: &'static str,
    make: impl Fn([f64; 3], f64, f64) -> f64 + 'static,
) -> Row {
    row(id, feedback, move |m, l| {
        let mut grid = part_of(l, EquationPart::Gamma)?;
        for (row, target) in driven(m) {
            let [c, rate, _] = target;
            let square = if c * c < 1.0 { c * rate * rate / (1.0 - c * c) } else { 0.0 };
            grid.values[row] = make(target, square, grid.values[row]);
        }
        Ok(grid)
    })
}

fn mass() -> Vec<Row> {
    vec![
        row("moments-of-inertia", INERTIA, |m, _| {
            let full = |b: &mut RigidBody| {
                if b.coordinates == Coordinates::Full {
                    b.ibar = b.principal;
                }
            };
            part_of(&with_ibar(m, full), EquationPart::Mass)
        }),
        row("moments-of-inertia", INERTIA, |m, _| {
            part_of(&with_ibar(m, |b| b.ibar = b.principal), EquationPart::Mass)
        }),
        row("moments-of-inertia", INERTIA, |m, _| {
            let reduced = |b: &mut RigidBody| {
                if b.coordinates == Coordinates::Reduced {
                    b.ibar = b.principal;
                }
            };
            part_of(&with_ibar(m, reduced), EquationPart::Mass)
        }),
        row("inertia-half", "The ½ of Ī is missing: Ī_u = ½(I_v + I_w − I_u).", |m, _| {
            part_of(&with_ibar(m, |b| b.ibar *= 2.0), EquationPart::Mass)
        }),
        row("w-left-out", "The part of w is missing: M is VᵀMV, and w = u × v has mass too.", |m, l| {
            let mut grid = part_of(l, EquationPart::Mass)?;
            for body in m.system.bodies.iter().filter(|b| b.coordinates == Coordinates::Reduced) {
                let first = body.layout.first + 3;
                for (row, column) in (0..36).map(|k| (k / 6, k % 6)) {
                    let own = if row == column { body.ibar[row / 3] } else { 0.0 };
                    grid.values[(first + row) * grid.columns + first + column] = own;
                }
            }
            Ok(grid)
        }),
    ]
}

fn acceleration() -> Vec<Row> {
    vec![
        row("gamma-sign", "The accelerations are those of −γ: look at the sign of γ.", |_, l| {
            let mut wrong = l.clone();
            wrong.gamma.neg_mut();
            part_of(&wrong, EquationPart::Acceleration)
        }),
        row("gamma-zero", "The accelerations are those without γ.", |_, l| {
            let mut wrong = l.clone();
            wrong.gamma.fill(0.0);
            part_of(&wrong, EquationPart::Acceleration)
        }),
        row("velocity-term-sign", "The term −M V̇q̇ of the reduced body stands with a plus.", |m, l| {
            velocity_term(m, l, -1.0, 1.0)
        }),
        row("velocity-term-sign", "The term −M V̇q̇ of the reduced body stands with a plus.", |m, l| {
            velocity_term(m, l, -1.0, -1.0)
        }),
        row("velocity-term-sign", GAMMA_TERM_SIGN, |m, l| velocity_term(m, l, 1.0, -1.0)),
        row(
            "velocity-term-missing",
            "The term with V̇q̇ of the reduced body is missing: in the forces −M V̇q̇, and in γ wherever a row contains w.",
            |m, l| velocity_term(m, l, 0.0, 0.0),
        ),
        row("velocity-term-missing", "The forces lack the term −M V̇q̇ of the reduced body.", |m, l| {
            velocity_term(m, l, 0.0, 1.0)
        }),
        row("velocity-term-missing", GAMMA_TERM_MISSING, |m, l| velocity_term(m, l, 1.0, 0.0)),
        row("velocity-term-half", HALF_TERM, |m, l| velocity_term(m, l, 0.5, 0.5)),
        row("velocity-term-half", HALF_TERM, |m, l| velocity_term(m, l, 0.5, 1.0)),
        row("velocity-term-half", HALF_TERM, |m, l| velocity_term(m, l, 1.0, 0.5)),
        row("moments-of-inertia", INERTIA, |m, _| {
            part_of(&with_ibar(m, |b| b.ibar = b.principal), EquationPart::Acceleration)
        }),
        row("inertia-half", "The ½ of Ī is missing: Ī_u = ½(I_v + I_w − I_u).", |m, _| {
            part_of(&with_ibar(m, |b| b.ibar *= 2.0), EquationPart::Acceleration)
        }),
        row("unit-rows-half", UNIT_ROWS_HALF, |m, l| {
            let mut wrong = l.clone();
            for row in unit_rows(m) {
                wrong.jacobian.row_mut(row).scale_mut(0.5);
            }
            part_of(&wrong, EquationPart::Acceleration)
        }),
        row("sign", "Every acceleration has the opposite sign.", |_, l| {
            Ok(part_of(l, EquationPart::Acceleration)?.scaled(-1.0))
        }),
        row(
            "constraints-forgotten",
            "These are the accelerations of free bodies: the rows are missing.",
            |_, l| {
                let mut wrong = l.clone();
                wrong.jacobian.fill(0.0);
                // A body without inertia about some axis has no such accelerations.
                part_of(&wrong, EquationPart::Acceleration)
                    .or_else(|_| part_of(l, EquationPart::Acceleration))
            },
        ),
    ]
}

/// Accelerations with parts of the term with V̇q̇, in the forces and in γ.
fn velocity_term(
    m: &Mechanism,
    l: &AugmentedSystem,
    in_forces: f64,
    in_gamma: f64,
) -> Result<Grid, InstanceError> {
    let mut wrong = with_velocity_term(m, l.clone(), in_forces);
    for (gamma, [natural, reduced]) in wrong.gamma.iter_mut().zip(gamma_parts(m)) {
        *gamma = natural + in_gamma * reduced;
    }
    part_of(&wrong, EquationPart::Acceleration)
}
