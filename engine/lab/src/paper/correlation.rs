//! Intraclass correlation of several time series.

use serde::Serialize;

/// Intraclass correlation of single measures, two-way random effects.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Correlation {
    /// Consistency, ICC(C,1): blind to a constant difference between the series.
    pub consistency: f64,
    /// Absolute agreement, ICC(A,1).
    pub agreement: f64,
}

/// Compares series of the same length as raters of the same subjects.
///
/// McGraw and Wong, Forming inferences about some intraclass correlation coefficients, Psychological Methods 1 (1996),
/// from the mean squares of rows, columns and rest. Fewer than two samples or series have no correlation.
pub fn correlation(series: &[&[f64]]) -> Option<Correlation> {
    let k = series.len();
    let n = series.iter().map(|s| s.len()).min()?;
    if n < 2 || k < 2 {
        return None;
    }
    let (count, raters) = (n as f64, k as f64);
    let grand = series.iter().flat_map(|s| &s[..n]).sum::<f64>() / (count * raters);
    let row_mean = |i: usize| series.iter().map(|s| s[i]).sum::<f64>() / raters;
    let rows = raters * (0..n).map(|i| row_mean(i) - grand).map(|d| d * d).sum::<f64>() / (count - 1.0);
    let column_means: Vec<f64> = series.iter().map(|s| s[..n].iter().sum::<f64>() / count).collect();
    let columns =
        count * column_means.iter().map(|mean| mean - grand).map(|d| d * d).sum::<f64>() / (raters - 1.0);
    let mut rest = 0.0;
    for i in 0..n {
        let mean = row_mean(i);
        for (s, column) in series.iter().zip(&column_means) {
            let left = s[i] - mean - column + grand;
            rest += left * left;
        }
    }
    rest /= (count - 1.0) * (raters - 1.0);
    let signal = rows - rest;
    let spread = rows + (raters - 1.0) * rest;
    Some(Correlation {
        consistency: signal / spread,
        agreement: signal / (spread + raters / count * (columns - rest)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Six subjects and four judges of Shrout and Fleiss, Psychological Bulletin 86 (1979), table 2; the coefficients of
    /// their table 4: ICC(2,1) = 0.29 and ICC(3,1) = 0.71.
    #[test]
    fn gives_the_published_coefficients() {
        let judges = [
            [9.0, 6.0, 8.0, 7.0, 10.0, 6.0],
            [2.0, 1.0, 4.0, 1.0, 5.0, 2.0],
            [5.0, 3.0, 6.0, 2.0, 6.0, 4.0],
            [8.0, 2.0, 8.0, 6.0, 9.0, 7.0],
        ];
        let series: Vec<&[f64]> = judges.iter().map(<[f64; 6]>::as_slice).collect();
        let found = correlation(&series).unwrap();
        assert!((found.agreement - 0.29).abs() < 0.005, "{found:?}");
        assert!((found.consistency - 0.71).abs() < 0.006, "{found:?}");
    }
}
