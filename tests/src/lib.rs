//! End-to-end tests of Triad.
