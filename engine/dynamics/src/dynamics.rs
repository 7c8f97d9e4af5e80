//! Accelerations and multipliers: at one state by elimination, and as power series about one.

mod blocks;

mod pivots;

mod proximal;

pub use blocks::products_within;

pub mod elimination;

pub mod series;
