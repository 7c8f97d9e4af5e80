//! Multipliers of the rigid-body rows, on demand — THEORY section 7.
//!
//! They hold the directors of a body at unit length and right angles: stress inside the coordinates, not a reaction.

use super::Multiplier;
use crate::scene::Coordinates;
use serde::Serialize;
use triad_dynamics::dynamics::elimination::Accelerations;
use triad_dynamics::equations;
use triad_dynamics::equations::augmented::{for_mass_entries, force_of};
use triad_dynamics::equations::jacobian::Jacobian;
use triad_dynamics::system::index::RowId;
use triad_dynamics::system::natural::NaturalCoordinates;

/// Multipliers of a body's rigid-body rows.
#[doc(hidden)]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RigidMultipliers {
    /// The body.
    pub body: String,
    /// Its multipliers, N m.
    pub rows: Vec<Multiplier>,
}

#[doc(hidden)]
/// The rigid-body multipliers that belong to accelerations and joint multipliers.
///
/// With p = g − Φ_J,qᵀ λ_J − M q̈ of a body, λ_kk = ½ p_k · eᵏ and λ_kl = p_k · eˡ, eˡ being the dual of the directors.
pub fn rigid_multipliers(accelerations: &Accelerations) -> Vec<RigidMultipliers> {
    let multipliers = &accelerations.multipliers;
    let (system, at) = (multipliers.system, multipliers.state);
    let applied = (0..system.bodies.len()).map(|body| *accelerations.force_on(body));
    let mut rest = force_of(system, at, applied);
    let mut acceleration = vec![0.0; system.coordinates];
    accelerations.write(&mut acceleration);
    for_mass_entries(system, at, |row, column, value| rest[row] -= value * acceleration[column]);
    let joint: Vec<f64> = (0..system.rows.len()).flat_map(|index| multipliers.of_row(RowId(index))).collect();
    for entry in Jacobian::new(system, at).entries {
        if entry.row >= system.rigid_rows {
            rest[entry.column] -= entry.value * joint[entry.row - system.rigid_rows];
        }
    }
    let names = equations::row_names(system);
    let mut next = names.into_iter();
    system
        .bodies
        .iter()
        .zip(at.bodies())
        .zip(&system.model.bodies)
        .map(|((body, state), model)| {
            let p = body.layout.position(rest.as_slice());
            let rows = of_body(body.coordinates, &state.q, &p)
                .into_iter()
                .zip(next.by_ref())
                .map(|(value, name)| {
                    let label =
                        name.rsplit_once(": ").map_or_else(String::new, |(_, label)| label.to_owned());
                    Multiplier { label, value }
                })
                .collect();
            RigidMultipliers { body: model.name.clone(), rows }
        })
        .collect()
}

/// In the order uu, vv, ww, uv, uw, vw, or uu, vv, uv.
fn of_body(coordinates: Coordinates, q: &NaturalCoordinates, p: &NaturalCoordinates) -> Vec<f64> {
    let [u, v, w] = q.e;
    let volume = u.dot(&v.cross(&w));
    let dual = [v.cross(&w) / volume, w.cross(&u) / volume, u.cross(&v) / volume];
    let of = |k: usize, l: usize| p.e[k].dot(&dual[l]) * if k == l { 0.5 } else { 1.0 };
    match coordinates {
        Coordinates::Full | Coordinates::Shared => {
            vec![of(0, 0), of(1, 1), of(2, 2), of(0, 1), of(0, 2), of(1, 2)]
        }
        Coordinates::Reduced => vec![of(0, 0), of(1, 1), of(0, 1)],
    }
}
