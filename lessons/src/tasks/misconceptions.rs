//! The equations as misconceptions have them, so that these can be recognised in what a student's program sends.

use triad_engine::EngineError;
use triad_engine::constraints::mechanism::Mechanism;
use triad_engine::equations::augmented::AugmentedSystem;
use triad_engine::model::Model;
use triad_engine::scene::{Coordinates, Scene};
use triad_engine::system::System;

use super::grid::Grid;
use super::instances::{InstanceError, Instances, part_of};
use crate::exercise::Implement;
use crate::files::EquationPart;
use crate::scenario::equations::{gamma_parts, in_degrees, wrong_sign};

/// What a misconception makes of a part, at every instance.
pub(crate) struct ProgramMisconception {
    pub id: &'static str,
    pub feedback: &'static str,
    pub grids: Vec<Grid>,
}

/// The misconception, if what was sent is one of these.
pub(crate) fn recognise<'a>(
    given: &[Grid],
    right: &[Grid],
    known: &'a [ProgramMisconception],
    tolerance: f64,
) -> Option<&'a ProgramMisconception> {
    known.iter().find(|one| all_agree(given, &one.grids, right, tolerance))
}

/// Whether two answers agree at every instance, on the scale of the right one.
pub(crate) fn all_agree(given: &[Grid], wanted: &[Grid], right: &[Grid], tolerance: f64) -> bool {
    given.iter().zip(wanted).zip(right).all(|((a, b), r)| a.agrees(b, tolerance, r.scale()))
}

/// What one misconception makes of the equations at one instance.
type Make<'a> = &'a dyn Fn(&Mechanism, &AugmentedSystem) -> Result<Grid, InstanceError>;

/// Every misconception of a part that differs from the right answer on this mechanism.
pub(crate) fn misconceptions(
    task: &Implement,
    instances: &mut Instances,
    part: EquationPart,
) -> Result<Vec<ProgramMisconception>, InstanceError> {
    let right = instances.answers(part)?;
    let mut list: Vec<ProgramMisconception> = Vec::new();
    let add = |id, feedback, grids: Vec<Grid>, list: &mut Vec<ProgramMisconception>| {
        let same = |a: &[Grid], b: &[Grid]| {
            a.iter().zip(b).all(|(a, b)| a.agrees(b, 10.0 * task.tolerance, b.scale()))
        };
        if !same(&grids, &right) && !list.iter().any(|other| same(&grids, &other.grids)) {
            list.push(ProgramMisconception { id, feedback, grids });
        }
    };
    let each = |instances: &mut Instances, make: Make| -> Result<Vec<Grid>, InstanceError> {
        (0..instances.states.len())
            .map(|k| {
                let (mechanism, augmented) = instances.placed(k);
                make(mechanism, augmented)
            })
            .collect()
    };
    for (id, feedback, make) in table(part) {
        add(id, feedback, each(instances, &make)?, &mut list);
    }
    for (id, feedback, scene) in other_scenes(task, part) {
        // The wrong mechanism need not close at its start: it is only put into the instances.
        let model = Model::new(&scene).map_err(EngineError::from)?;
        let other = Instances::at_states(Mechanism::new(System::new(model)), instances.states.clone());
        add(id, feedback, other.answers(part)?, &mut list);
    }
    Ok(list)
}

/// The same states in a mechanism that was read wrongly.
fn other_scenes(task: &Implement, part: EquationPart) -> Vec<(&'static str, &'static str, Scene)> {
    let scene = &task.scene;
    let mut list = Vec::new();
    if part == EquationPart::Acceleration && scene.gravity != [0.0; 3] {
        let scene = Scene { gravity: [0.0; 3], ..scene.clone() };
        list.push(("no-gravity", "The weight is missing in the forces g.", scene));
    }
    if !scene.drivers.is_empty()
        && matches!(part, EquationPart::Phi | EquationPart::Gamma | EquationPart::Acceleration)
    {
        let feedback = "An angle was taken for degrees: sine and cosine want radians.";
        list.push(("degrees", feedback, in_degrees(scene)));
    }
    list
}

type Row =
    (&'static str, &'static str, Box<dyn Fn(&Mechanism, &AugmentedSystem) -> Result<Grid, InstanceError>>);

fn row(
    id: &'static str,
    feedback: &'static str,
    make: impl Fn(&Mechanism, &AugmentedSystem) -> Result<Grid, InstanceError> + 'static,
) -> Row {
    (id, feedback, Box::new(make))
}

fn table(part: EquationPart) -> Vec<Row> {
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
        row("bodies-swapped", "In the rows of joints body i and body j are swapped.", |m, l| {
            let mut grid = part_of(l, EquationPart::Phi)?;
            grid.values[m.system.rigid_rows..].iter_mut().for_each(|x| *x = -*x);
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
        row(
            "unit-rows-half",
            "The rows of unit length lack their factor 2: the derivative of uᵀu is 2uᵀ.",
            |m, l| {
                let mut grid = part_of(l, EquationPart::Jacobian)?;
                for row in unit_rows(m) {
                    grid.values[row * grid.columns..(row + 1) * grid.columns]
                        .iter_mut()
                        .for_each(|x| *x *= 0.5);
                }
                Ok(grid)
            },
        ),
        row("bodies-swapped", "In the rows of joints body i and body j are swapped.", |m, l| {
            let mut grid = part_of(l, EquationPart::Jacobian)?;
            let first = m.system.rigid_rows * grid.columns;
            grid.values[first..].iter_mut().for_each(|x| *x = -*x);
            Ok(grid)
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
        row(
            "velocity-term-sign",
            "The term with V̇q̇ of the reduced body has the wrong sign in γ.",
            |m, _| {
                Ok(Grid::column(
                    gamma_parts(m).into_iter().map(|[natural, reduced]| natural - reduced).collect(),
                ))
            },
        ),
        row(
            "velocity-term-alone",
            "Only the term with V̇q̇ of the reduced body is there; the rows' own second derivative is missing.",
            |m, _| Ok(Grid::column(gamma_parts(m).into_iter().map(|[_, reduced]| reduced).collect())),
        ),
    ]
}

fn mass() -> Vec<Row> {
    vec![
        row(
            "moments-of-inertia",
            "The moments of inertia stand where Ī belongs: Ī_u = ½(I_v + I_w − I_u), the reach along the axis.",
            |m, l| {
                let mut grid = part_of(l, EquationPart::Mass)?;
                for body in m.system.bodies.iter().filter(|b| b.coordinates == Coordinates::Full) {
                    for (k, director) in body.layout.directors.iter().enumerate() {
                        let Some((column, _)) = director.column() else { continue };
                        for at in column..column + 3 {
                            grid.values[at * grid.columns + at] += body.principal[k] - body.ibar[k];
                        }
                    }
                }
                Ok(grid)
            },
        ),
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
            part_of(&wrong_sign(m, l.clone()), EquationPart::Acceleration)
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

/// The rows that say that a director has unit length.
fn unit_rows(mechanism: &Mechanism) -> Vec<usize> {
    let names = triad_engine::equations::row_names(&mechanism.system);
    let unit = |name: &&str| [": uu", ": vv", ": ww"].iter().any(|end| name.ends_with(end));
    let rigid = mechanism.system.rigid_rows;
    (0..rigid.min(names.len())).filter(|k| unit(&names[*k].as_str())).collect()
}

/// For joints between two bodies of equally many coordinates: the blocks exchanged.
fn columns_swapped(mechanism: &Mechanism, right: &Grid) -> Grid {
    let system = &mechanism.system;
    let mut grid = right.clone();
    for constraint in &system.constraints {
        let touched: Vec<usize> =
            system.incidences[constraint.incidences.clone()].iter().map(|i| i.body).collect();
        let [a, b] = touched.as_slice() else { continue };
        let (a, b) = (system.bodies[*a].layout, system.bodies[*b].layout);
        if a.size() != b.size() {
            continue;
        }
        for row in constraint.equations.clone() {
            for k in 0..a.size() {
                let line = (system.rigid_rows + row) * grid.columns;
                grid.values.swap(line + a.first + k, line + b.first + k);
            }
        }
    }
    grid
}

/// The 3 × 3 blocks of rows that come in threes, transposed.
fn blocks_transposed(mechanism: &Mechanism, right: &Grid) -> Grid {
    let system = &mechanism.system;
    let mut grid = right.clone();
    for row in system.rows.iter().filter(|row| !row.implied && row.form.equations() == 3) {
        let first = system.rigid_rows + row.equation;
        for block in (0..right.columns / 3).map(|k| 3 * k) {
            for (i, j) in (0..9).map(|k| (k / 3, k % 3)) {
                grid.values[(first + i) * right.columns + block + j] = right.at(first + j, block + i);
            }
        }
    }
    grid
}
