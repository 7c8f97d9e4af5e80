//! Turns of single bodies that have no inertia and that no joint feels: of a point mass on rods, of a thin rod between ball joints.
//! They count as degrees of freedom, though nothing moves in them.

use nalgebra::{DMatrix, Vector3};
use triad_dynamics::constraints::mechanism::Mechanism;
use triad_dynamics::system::index::IncidenceId;
use triad_linalg::left_null_space;

/// Principal moment, as a part of the largest one of the body, below which it is rounding of zero.
const NO_MOMENT: f64 = 1e-13;
/// Part of the mechanism's length below which an arm is none.
const NO_ARM: f64 = 1e-9;

/// Degrees of freedom that are turns of bodies about axes about which they have no inertia.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct IdleTurns {
    /// How many.
    pub turns: usize,
    /// The first body that turns so.
    pub body: String,
}

/// A principal moment, or zero where it is no more than rounding.
pub fn moment(principal: &Vector3<f64>, axis: usize) -> f64 {
    if principal[axis] > NO_MOMENT * principal.max() { principal[axis] } else { 0.0 }
}

/// Counts such turns at the positions taken over last. `None` if there are none.
pub fn turns(mechanism: &mut Mechanism) -> Option<IdleTurns> {
    let Mechanism { system, state, elimination, .. } = mechanism;
    elimination.fill_rows(system, state);
    let smallest = NO_ARM * system.length;
    let (mut turns, mut first) = (0, None);
    for (index, (body, at)) in system.bodies.iter().zip(state.bodies()).enumerate() {
        let axes: Vec<Vector3<f64>> =
            (0..3).filter(|&k| moment(&body.principal, k) == 0.0).map(|k| at.q.e[k]).collect();
        let rows: Vec<Vector3<f64>> = system.incidences_of_body[index]
            .iter()
            .flat_map(|&incidence| {
                elimination.jacobian().rows_on(system, IncidenceId(incidence)).chunks_exact(6)
            })
            .map(|row| Vector3::new(row[3], row[4], row[5]))
            .collect();
        let felt = DMatrix::from_fn(axes.len(), rows.len(), |k, row| axes[k].dot(&rows[row]));
        let longest = felt.row_iter().fold(0.0f64, |a, row| a.max(row.norm()));
        let idle =
            if longest <= smallest { axes.len() } else { left_null_space(&felt, smallest / longest).ncols() };
        turns += idle;
        if idle > 0 && first.is_none() {
            first = Some(index);
        }
    }
    first.map(|index| IdleTurns { turns, body: system.model.bodies[index].name.clone() })
}
