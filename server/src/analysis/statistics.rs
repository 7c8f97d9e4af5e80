//! Figures of item analysis, as functions of numbers alone.

/// Share of a class in its upper and in its lower group, after Kelley.
const KELLEY: f64 = 0.27;

/// Mean; none of nothing.
#[allow(clippy::cast_precision_loss)] // counts of people
pub fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// Pearson's correlation; none with fewer than three pairs, or where one side does not vary.
pub fn correlation(pairs: &[(f64, f64)]) -> Option<f64> {
    let (x, y): (Vec<f64>, Vec<f64>) = pairs.iter().copied().unzip();
    let (mean_x, mean_y) = (mean(&x)?, mean(&y)?);
    let sum = |f: &dyn Fn(f64, f64) -> f64| pairs.iter().map(|(x, y)| f(x - mean_x, y - mean_y)).sum::<f64>();
    let (xx, yy, xy) = (sum(&|x, _| x * x), sum(&|_, y| y * y), sum(&|x, y| x * y));
    // Sums of squares of shares: below this they are rounding.
    let varies = xx > 1e-12 && yy > 1e-12;
    (pairs.len() >= 3 && varies).then(|| (xy / (xx * yy).sqrt()).clamp(-1.0, 1.0))
}

/// Mean score of the upper group less that of the lower: pairs of score and criterion, grouped by the criterion, 27 % of all in
/// each. None with fewer than four pairs. Where the border lies among equals, each of these counts in part, so that the order
/// in which people stand does not matter.
#[allow(clippy::cast_precision_loss)] // counts of people
pub fn upper_less_lower(pairs: &[(f64, f64)]) -> Option<f64> {
    if pairs.len() < 4 {
        return None;
    }
    let size = (KELLEY * pairs.len() as f64).round().max(1.0);
    let mut sorted = pairs.to_vec();
    sorted.sort_by(|a, b| a.1.total_cmp(&b.1));
    let lower = of_first(&sorted, size);
    sorted.reverse();
    Some(of_first(&sorted, size) - lower)
}

/// Mean score of the first `size` pairs; the group of equals at the border fills what is left of it evenly.
#[allow(clippy::cast_precision_loss)] // counts of people
fn of_first(sorted: &[(f64, f64)], size: f64) -> f64 {
    let (mut left, mut sum) = (size, 0.0);
    for equals in sorted.chunk_by(|a, b| a.1 == b.1) {
        let share = (left / equals.len() as f64).min(1.0);
        sum += share * equals.iter().map(|(score, _)| score).sum::<f64>();
        left -= share * equals.len() as f64;
        if left <= 0.0 {
            break;
        }
    }
    sum / size
}

/// Two groups of scores: those whose key lies below the median of the keys, and the others.
pub fn halves(pairs: &[(f64, f64)]) -> Option<Halves> {
    let mut keys: Vec<f64> = pairs.iter().map(|(_, key)| *key).collect();
    keys.sort_by(f64::total_cmp);
    let border = *keys.get(keys.len() / 2)?;
    let (below, above): (Vec<_>, Vec<_>) = pairs.iter().partition(|(_, key)| *key < border);
    let scores = |group: &[(f64, f64)]| group.iter().map(|(score, _)| *score).collect::<Vec<_>>();
    let (below, above) = (scores(&below), scores(&above));
    let deviations = deviations(&below, &above);
    Some(Halves {
        border,
        below: (below.len(), mean(&below)?),
        above: (above.len(), mean(&above)?),
        deviations,
    })
}

/// Scores by halves of a class.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Halves {
    /// The upper half begins here.
    pub border: f64,
    /// How many lie below, and their mean score.
    pub below: (usize, f64),
    /// The others.
    pub above: (usize, f64),
    /// The difference of the means in standard errors.
    pub deviations: Option<f64>,
}

/// The difference of two means in standard errors (Welch); none where a group has fewer than two, or nothing varies.
#[allow(clippy::cast_precision_loss)] // counts of people
fn deviations(a: &[f64], b: &[f64]) -> Option<f64> {
    let of_mean = |values: &[f64]| {
        let mean = mean(values)?;
        let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
        let count = values.len() as f64;
        (values.len() > 1).then(|| (mean, squares / (count - 1.0) / count))
    };
    let ((mean_a, a), (mean_b, b)) = (of_mean(a)?, of_mean(b)?);
    (a + b > 0.0).then(|| (mean_b - mean_a) / (a + b).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: Option<f64>, b: f64) {
        assert!(a.is_some_and(|a| (a - b).abs() < 1e-12), "{a:?} instead of {b}");
    }

    #[test]
    fn means_and_correlations_are_those_computed_by_hand() {
        assert_eq!(mean(&[]), None);
        close(mean(&[1.0, 0.0, 0.5]), 0.5);
        // Deviations (−1, 0, 1) and (−2, 1, 1): sums 2, 6 and 3, so 3/√12.
        close(correlation(&[(0.0, 1.0), (1.0, 4.0), (2.0, 4.0)]), 3.0 / 12f64.sqrt());
        close(correlation(&[(0.0, 3.0), (1.0, 2.0), (2.0, 1.0)]), -1.0);
        assert_eq!(correlation(&[(0.0, 1.0), (1.0, 2.0)]), None, "two points lie on a line");
        assert_eq!(correlation(&[(1.0, 1.0), (1.0, 2.0), (1.0, 3.0)]), None, "nothing varies");
    }

    #[test]
    fn groups_after_kelley_share_those_at_the_border() {
        // Of eleven three are in each group: 0.27 · 11 = 2.97.
        let scores = [0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 1.0, 1.0, 1.0, 0.5];
        let pairs: Vec<(f64, f64)> = scores.iter().enumerate().map(|(k, s)| (*s, k as f64)).collect();
        close(upper_less_lower(&pairs), (1.0 + 1.0 + 0.5 - 1.0) / 3.0);
        let shuffled: Vec<(f64, f64)> = (0..11).map(|k| pairs[(k * 4) % 11]).collect();
        close(upper_less_lower(&shuffled), 0.5);
        // Four, one in each group; two are last with the same criterion, and one of them was right.
        close(upper_less_lower(&[(1.0, 0.0), (0.0, 0.0), (0.0, 0.5), (1.0, 1.0)]), 1.0 - 0.5);
        assert_eq!(upper_less_lower(&[(1.0, 1.0); 3]), None);
    }

    #[test]
    fn halves_are_compared_in_standard_errors() {
        let pairs = [(1.0, 1.0), (1.0, 1.5), (0.0, 2.0), (1.0, 3.0), (0.0, 4.0), (0.0, 5.0)];
        let halves = halves(&pairs).unwrap();
        assert_eq!((halves.border, halves.below.0, halves.above.0), (3.0, 3, 3));
        // Means 2/3 and 1/3; both have the sum of squares 2/3, so the variance 1/3 and that of the mean 1/9.
        close(halves.deviations, -(1.0 / 3.0) / (2.0f64 / 9.0).sqrt());
        assert_eq!(super::halves(&[(1.0, 2.0); 4]), None, "all have the same number");
        assert_eq!(super::halves(&[]), None);
    }
}
