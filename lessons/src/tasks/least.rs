//! Where a function of one number is least: at the best of some places, and then closer and closer around it.

/// What the distance to the two neighbours is multiplied by, each time.
const CLOSER: f64 = 0.6;

/// The place and the value there, of equal ones the first, from places that were tried with their values, `step` apart; each
/// further place is asked for once. None where nothing was tried.
pub(super) fn least(
    tried: impl Iterator<Item = (f64, f64)>,
    step: f64,
    rounds: usize,
    fit: impl Fn(f64) -> f64,
) -> Option<(f64, f64)> {
    let first = |pairs: &mut dyn Iterator<Item = (f64, f64)>| pairs.min_by(|a, b| a.1.total_cmp(&b.1));
    let mut tried = tried;
    let mut best = first(&mut tried)?;
    let mut h = step;
    for _ in 0..rounds {
        h *= CLOSER;
        let (before, after) = (best.0 - h, best.0 + h);
        let around = [(before, fit(before)), best, (after, fit(after))];
        best = first(&mut around.into_iter()).unwrap_or(best);
    }
    Some(best)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    #[test]
    fn the_least_value_is_found_and_each_place_asked_for_once() {
        let asked = Cell::new(0);
        let fit = |x: f64| {
            asked.set(asked.get() + 1);
            (x - 0.337) * (x - 0.337)
        };
        let tried = (0..=10).map(|k| 0.1 * f64::from(k)).map(|x| (x, fit(x)));
        let (place, value) = least(tried, 0.1, 40, fit).unwrap();
        assert!((place - 0.337).abs() < 1e-8 && value < 1e-15, "{place} {value}");
        assert_eq!(asked.get(), 11 + 2 * 40);
        assert_eq!(least([3.0, 1.0, 2.0].map(|x| (x, 5.0)).into_iter(), 0.0, 1, |_| 5.0), Some((3.0, 5.0)));
        assert_eq!(least(std::iter::empty(), 0.1, 3, |x| x), None);
    }
}
