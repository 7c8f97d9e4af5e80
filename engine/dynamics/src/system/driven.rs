//! When drivers have moved a mechanism: at a start from which they alone lead away, the rank is looked at there.

use super::System;
use super::feature::{Feature, TargetCurve};
use crate::model::motion::{TRIED, VectorCurve, first_where};
use nalgebra::Vector3;

/// How far drivers are followed, rad or lengths of the mechanism.
const AWAY: f64 = 0.03;
/// How far beyond the end of the run they are followed, in lengths of the run, where they do not go that far within it: what rows depend on
/// others is no matter of how long a run is.
const BEYOND: [f64; 5] = [1.0, 1e3, 1e6, 1e9, 1e12];

impl System {
    /// The first moment after t at which a driver has moved something by `AWAY`, as far as a thousand moments of the run tell, or of times
    /// beyond it; where none goes that far, that at which one has gone farthest. `None` if all stand still.
    pub fn driven_away(&self, t: f64) -> Option<f64> {
        let changes = self.curves.iter().any(VectorCurve::changes);
        if !changes && !self.targets.iter().any(|target| target.curve.changes()) {
            return None;
        }
        let end = if self.model.settings.duration > 0.0 { self.model.settings.duration } else { 1.0 };
        let (vectors, numbers) = self.driven(t);
        let moved = |later: f64| {
            let (vectors_later, numbers_later) = self.driven(later);
            let turned = vectors.iter().zip(&vectors_later).map(|(a, b)| (a - b).norm());
            let slid = numbers.iter().zip(&numbers_later).map(|(a, b)| (a - b).abs());
            turned.chain(slid).filter(|moved| moved.is_finite()).fold(0.0, f64::max)
        };
        let (mut farthest, mut before) = ((0.0, t), t);
        let moments =
            BEYOND.iter().flat_map(|far| (1..=TRIED).map(move |k| far * f64::from(k) / f64::from(TRIED)));
        for part in moments {
            let later = t + end * part;
            if later <= before {
                continue;
            }
            let way = moved(later);
            if way >= AWAY {
                return Some(first_where(before, later, |time| moved(time) >= AWAY));
            }
            // Beyond the run nothing is nearer to the motion than what it shows itself.
            if way > farthest.0 && (part <= 1.0 || farthest.0 == 0.0) {
                farthest = (way, later);
            }
            before = later;
        }
        (farthest.0 > 0.0).then_some(farthest.1)
    }

    /// Values of what drivers prescribe at a time: points over the mechanism's length and directions; angles in rad and ways over that
    /// length.
    fn driven(&self, t: f64) -> (Vec<Vector3<f64>>, Vec<f64>) {
        let of_feature = |feature: &Feature| {
            let value = self.curves[feature.curve?].at(t)[0];
            Some(if feature.point { value / self.length } else { value })
        };
        let of_target = |target: &TargetCurve| {
            let value = target.curve.at(t)[0];
            if target.cosine { value } else { value / self.length }
        };
        (self.features.iter().filter_map(of_feature).collect(), self.targets.iter().map(of_target).collect())
    }
}
