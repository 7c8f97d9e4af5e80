//! Reference solutions: CSV files in `tests/data/` whose first lines say where they come from.

use crate::root;

/// A table of numbers with named columns.
pub struct Reference {
    name: &'static str,
    columns: Vec<String>,
    /// The rows.
    pub rows: Vec<Vec<f64>>,
}

impl Reference {
    /// Reads `tests/data/<name>.csv`.
    pub fn read(name: &'static str) -> Self {
        let path = root().join(format!("tests/data/{name}.csv"));
        let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        assert!(text.starts_with("# provenance:"), "{name}: the first line must state the provenance");
        let mut lines = text.lines().filter(|line| !line.starts_with('#'));
        let columns = lines.next().unwrap().split(',').map(str::to_owned).collect();
        let rows = lines.map(|line| line.split(',').map(|x| x.parse().unwrap()).collect()).collect();
        Self { name, columns, rows }
    }

    /// Places of the columns of these names.
    pub fn columns<const N: usize>(&self, names: [&str; N]) -> [usize; N] {
        names.map(|name| {
            let at = self.columns.iter().position(|column| column == name);
            at.unwrap_or_else(|| panic!("{}: no column {name}", self.name))
        })
    }
}

/// Length of the difference of two vectors.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| a - b).map(|d| d * d).sum::<f64>().sqrt()
}
