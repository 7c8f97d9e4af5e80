//! The equations, with the numbers by which the code cites them: `THEORY.md`, its formulas as MathML, which browsers set
//! without scripts or a network.
#![doc = include_str!("../../../docs/theory-mathml.md")]
