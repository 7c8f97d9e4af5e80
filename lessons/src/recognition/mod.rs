//! Which usual mistake a wrong number or formula comes from: seen from the right answer alone ([`values`]), from the
//! reference's own expression with one mistake in it ([`mutation`]), and from runs of wrong models ([`crate::scenario::worlds`]).
//!
//! Where several mistakes lead to the same number the first of this order is named: what is certain (zero, signs, a power of
//! ten, components), wrong models, one mistake in the expression (functions and units of angles before powers, powers before
//! terms, terms before factors), plain factors, and last what is true of many answers.

mod fit;
pub(crate) mod formula;
mod mutation;
pub(crate) mod quantity;
mod values;

pub(crate) mod digits;

#[cfg(test)]
pub(crate) use mutation::slips;
