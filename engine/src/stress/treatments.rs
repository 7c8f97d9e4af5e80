//! The treatments that are compared with each other.

use super::Treatment;
use crate::scene::{IntegratorKind, Stabilization};

/// Integrators with projection, then Baumgarte's stabilization from weak to strong.
pub fn all() -> Vec<(String, Treatment)> {
    let projected = [
        ("taylor, projection", IntegratorKind::Taylor),
        ("dop853, projection", IntegratorKind::Dop853),
        ("dopri5, projection", IntegratorKind::Dopri5),
    ];
    let mut list: Vec<(String, Treatment)> = projected
        .into_iter()
        .map(|(name, integrator)| {
            let stabilization = Some(Stabilization::Projection);
            (name.to_owned(), Treatment { integrator: Some(integrator), stabilization })
        })
        .collect();
    for strength in [0.0, 1.0, 10.0, 100.0] {
        let stabilization = Some(Stabilization::Baumgarte { alpha: strength, beta: strength });
        list.push((
            format!("dop853, Baumgarte {strength}/s"),
            Treatment { integrator: Some(IntegratorKind::Dop853), stabilization },
        ));
    }
    list
}
