//! Values that the elements of a scene share.

/// A vector of three numbers.
pub type Triple = [f64; 3];

/// Whether a value may be left out of the JSON.
pub(crate) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}
