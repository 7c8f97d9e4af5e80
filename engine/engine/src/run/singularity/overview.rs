//! Samples at four times of a step at once, where they cost hardly more than one: most steps that turn far are shown by them to have no
//! dip. Those that are not are searched from the beginning.

use super::sample::{Sample, any_within, single};
use super::search::Search;

/// Times that are looked at at once.
const AT_ONCE: usize = 4;
/// How often all parts of a step that are open are divided.
const ROUNDS: usize = 3;
/// Most samples in a step.
const MOST: usize = 7 * AT_ONCE;
/// Lower bound of the distance of a joint from a singular configuration, as an angle, rad, that all dips are below that are to be
/// looked at.
const DIP: f32 = 0.101;

/// Samples inside a step, and all times that are known.
#[derive(Clone, Debug)]
pub(super) struct Overview {
    samples: Vec<Sample>,
    /// Times, with the places of their samples: those of the ends are 0 and 1, those of others follow.
    known: Vec<(f64, usize)>,
}

impl Overview {
    /// Allocates for a number of joints.
    pub(super) fn new(joints: usize) -> Self {
        Self {
            samples: (0..MOST).map(|_| Sample::new(joints)).collect(),
            known: Vec::with_capacity(MOST + 2),
        }
    }

    /// Makes room for so many joints.
    pub(super) fn resize(&mut self, joints: usize) {
        self.samples.iter_mut().for_each(|sample| sample.resize(joints));
    }
}

impl Search<'_> {
    /// Whether samples show that no joint has a dip that is to be looked at between the ends of the step, of which there are samples.
    /// They are taken in the parts where one still may.
    pub(super) fn shows_no_dip(&mut self, overview: &mut Overview) -> bool {
        let [start, end] = [(self.step.start, 0), (self.step.end, 1)];
        if !self.is_suspicious(start, end) {
            return true;
        }
        if self.samples[..2].iter().any(|sample| sample.low) {
            return false;
        }
        let mut place = 0;
        overview.known.clear();
        overview.known.extend([start, end]);
        for round in 0..=ROUNDS {
            let Overview { samples, known } = &mut *overview;
            let angles = |place: usize| match place {
                0 | 1 => &*self.samples[place].angles,
                _ => &*samples[place - 2].angles,
            };
            let is_open = |[start, end]: &[(f64, usize); 2]| {
                let turned = single((end.0 - start.0) * self.step.pace);
                is_open(angles(start.1), angles(end.1), &self.history.rate_bounds, turned)
            };
            let (mut parts, mut count) = ([[(0.0, 0); 2]; MOST + 1], 0);
            for part in known.array_windows().filter(|part| is_open(part)) {
                parts[count] = *part;
                count += 1;
            }
            if count == 0 {
                return true;
            }
            let more = count.next_multiple_of(AT_ONCE);
            if round == ROUNDS || place + more > MOST {
                return false;
            }
            let mut times = [0.0; MOST];
            divide(&parts[..count], &mut times[..more]);
            for times in times[..more].as_chunks::<AT_ONCE>().0 {
                let Some(products) = self.track.pivot_products_at(*times) else { return false };
                self.examiner.count += AT_ONCE as u64;
                for (k, time) in times.iter().enumerate() {
                    let sample = &mut samples[place];
                    sample.measure_one(products, k, &self.history.scales, self.step.floor());
                    if sample.low {
                        return false;
                    }
                    known.push((*time, place + 2));
                    place += 1;
                }
            }
            known.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        }
        false
    }
}

/// Spreads times over parts of a step evenly.
fn divide(parts: &[[(f64, usize); 2]], times: &mut [f64]) {
    let (all, count) = (times.len(), parts.len());
    let mut left = times.iter_mut();
    for (k, [start, end]) in parts.iter().enumerate() {
        // The first ones get what cannot be divided.
        let own = (all + count - 1 - k) / count;
        for (i, time) in left.by_ref().take(own).enumerate() {
            *time = start.0 + (i + 1) as f64 / (own + 1) as f64 * (end.0 - start.0);
        }
    }
}

/// Whether some joint may be in a dip between two samples in which none is, while rows turn by an angle.
fn is_open(from: &[f32], to: &[f32], rates: &[f32], turned: f32) -> bool {
    any_within([from, to], rates, |low, high, rate| low + high <= 2.0 * DIP + rate * turned)
}
