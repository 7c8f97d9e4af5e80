#![doc = include_str!("../README.md")]

mod arithmetic;

pub mod block_cholesky;
mod sparse_lu;

mod null_space;

mod basis;

pub mod random;

pub use arithmetic::{fma, larger, larger_or_nan, largest_difference, largest_size, raise};
pub use basis::orthonormal_basis;
pub use block_cholesky::BlockCholesky;
pub use null_space::{
    independent_rows, independent_rows_while, least_squares, left_null_space, null_and_rest,
};
pub use sparse_lu::{Columns, SparseLu};
