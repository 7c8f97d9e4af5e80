//! Tables as text that other programs read.

/// A field, in quotation marks if it needs them.
///
/// ```
/// assert_eq!(triad_lab::csv::quoted("a,\"b\""), "\"a,\"\"b\"\"\"");
/// assert_eq!(triad_lab::csv::quoted("a b"), "a b");
/// ```
pub fn quoted(field: &str) -> String {
    if field.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}
