//! What is said of a given start that the constraints change.

use crate::system::System;
use nalgebra::Vector3;

/// A given velocity that is changed by more than this part of itself is told.
const LARGE_PART: f64 = 0.1;

/// |Φ| and |Φ̇| relative to the mechanism's length up to which a start fits.
const FITS: f64 = 1e-9;

/// That positions which violated the constraints by `violated` were moved.
pub(super) fn position_note(system: &System, violated: f64, moved: f64) -> Option<String> {
    (violated > FITS * system.length).then(|| {
        format!(
            "positions violated the constraints by {violated:.3e}; bodies were moved by up to {moved:.3e} onto them"
        )
    })
}

/// That velocities which violated the constraints by `rate` were changed.
pub(super) fn velocity_note(system: &System, rate: f64, given: &[f64], found: &[f64]) -> Option<String> {
    let n = system.coordinates;
    let changes = given[n..].iter().zip(&found[n..]).map(|(x, y)| (x - y).abs());
    let changed = changes.fold(0.0f64, f64::max);
    (rate > FITS * system.length).then(|| {
        format!(
            "velocities violated the constraints by {rate:.3e}; they were changed by up to {changed:.3e} onto them"
        )
    })
}

/// The body whose given velocity or angular velocity was changed by the largest part of itself, in a sentence, if that part is
/// large: a body of no mass to speak of yields to its neighbours, and the motion that was asked for may be gone.
pub(super) fn velocity_lost(system: &System, given: &[f64], found: &[f64]) -> Option<String> {
    let n = system.coordinates;
    let mut worst: Option<(f64, String)> = None;
    let mut count = 0_usize;
    for (body, model) in system.bodies.iter().zip(&system.model.bodies) {
        let motion = |y: &[f64]| {
            let at = body.layout.position(&y[..n]);
            let rate = body.layout.velocity(&at, &y[n..]);
            let omega = (0..3).map(|k| at.e[k].cross(&rate.e[k])).sum::<Vector3<f64>>() * 0.5;
            let arm = at.arm(&-model.principal_axes.tr_mul(&model.center_of_mass));
            [rate.r + omega.cross(&arm), omega]
        };
        let (before, after) = (motion(given), motion(found));
        let words = [("velocity", "m/s"), ("angular velocity", "rad/s")];
        let mut lost = false;
        for ((was, is), (what, unit)) in before.iter().zip(&after).zip(words) {
            let part = (was - is).norm() / was.norm();
            if !part.is_finite() || part <= LARGE_PART {
                continue;
            }
            lost = true;
            if worst.as_ref().is_none_or(|(largest, _)| part > *largest) {
                let text = |v: &Vector3<f64>| format!("({:.4e}, {:.4e}, {:.4e})", v[0], v[1], v[2]);
                let told = format!(
                    "body \"{}\": of the {what} {} {unit} it keeps {}",
                    model.name,
                    text(was),
                    text(is)
                );
                worst = Some((part, told));
            }
        }
        count += usize::from(lost);
    }
    worst.map(|(_, told)| {
        let others = if count > 1 { format!(", and {} other bodies likewise", count - 1) } else { String::new() };
        format!("the joints do not allow the given velocities: {told}{others}; give rates of joints (\"start\") instead")
    })
}
