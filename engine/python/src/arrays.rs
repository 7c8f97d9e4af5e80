//! Numbers for NumPy: what a run has written is handed over, not copied.

use numpy::{PyArray1, PyArrayMethods, ToPyArray};
use pyo3::prelude::*;

use crate::refusal::Refusal;

/// An array of floating-point numbers of any shape.
pub type Numbers = Py<PyAny>;

/// Numbers in rows as an array of that shape; NumPy takes the memory over.
pub fn shaped(py: Python<'_>, numbers: Vec<f64>, shape: &[usize]) -> PyResult<Numbers> {
    let flat = PyArray1::from_vec(py, numbers);
    Ok(flat.reshape(shape)?.into_any().unbind())
}

/// Numbers as a vector.
pub fn vector(py: Python<'_>, numbers: Vec<f64>) -> Numbers {
    PyArray1::from_vec(py, numbers).into_any().unbind()
}

/// Rows and columns as an array of whole numbers.
pub fn places(py: Python<'_>, places: &[usize]) -> Py<PyAny> {
    let places: Vec<i64> = places.iter().map(|&place| i64::try_from(place).unwrap_or(i64::MAX)).collect();
    places.to_pyarray(py).into_any().unbind()
}

/// Answers to yes or no as an array of that shape.
pub fn truths(py: Python<'_>, truths: Vec<bool>, shape: &[usize]) -> PyResult<Py<PyAny>> {
    let flat = PyArray1::from_vec(py, truths);
    Ok(flat.reshape(shape)?.into_any().unbind())
}

/// Refuses numbers that are not `count` finite ones.
pub fn checked<'a>(name: &str, numbers: &'a [f64], count: usize) -> Result<&'a [f64], Refusal> {
    if numbers.len() != count {
        let what = format!("{name} has {} numbers, and the system has {count} coordinates", numbers.len());
        let hint =
            "system.columns names the coordinates in their order; system.q0 and system.v0 are its start";
        return Err(Refusal::new("wrong-size", what, hint));
    }
    if let Some(place) = numbers.iter().position(|x| !x.is_finite()) {
        let what = format!("{name}[{place}] is {}, not a finite number", numbers[place]);
        return Err(Refusal::new("not-finite", what, "look where it was computed"));
    }
    Ok(numbers)
}
