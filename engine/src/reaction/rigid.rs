//! Multipliers of the rigid-body rows, on demand — THEORY section 7.
//!
//! They hold the directors of a body at unit length and right angles: stress inside the coordinates, not a reaction.

use super::Multiplier;
use crate::elimination::Elimination;
use crate::equations;
use crate::jacobian::Jacobian;
use crate::lift::Lift;
use crate::literal::{for_mass_entries, force};
use crate::scene::Coordinates;
use crate::system::System;
use serde::Serialize;

/// Multipliers of a body's rigid-body rows.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RigidMultipliers {
    /// The body.
    pub body: String,
    /// Its multipliers, N m.
    pub rows: Vec<Multiplier>,
}

/// The rigid-body multipliers that belong to the elimination's last accelerations and joint multipliers.
///
/// With p = g − Φ_J,qᵀ λ_J − M q̈ of a body, λ_kk = ½ p_k · eᵏ and λ_kl = p_k · eˡ, eˡ being the dual of the directors.
pub fn rigid_multipliers(system: &System, at: &Elimination) -> Vec<RigidMultipliers> {
    let mut rest = force(system, at);
    let mut acceleration = vec![0.0; system.coordinates];
    for (index, body) in system.bodies.iter().enumerate() {
        body.layout.store(&at.lifted_solution(index), &mut acceleration);
    }
    for_mass_entries(system, at, |row, column, value| rest[row] -= value * acceleration[column]);
    let joint: Vec<f64> =
        system.rows.iter().enumerate().flat_map(|(index, row)| at.multipliers(index, row)).collect();
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
        .zip(&at.bodies)
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
fn of_body(coordinates: Coordinates, q: &Lift, p: &Lift) -> Vec<f64> {
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
