//! Motions in time: integrators, events, and what is left out on the way.

#[path = "../common/mod.rs"]
mod common;

mod closed_forms;
mod costs;
mod events;
mod exactness;
mod explicit;
mod friction;
mod given;
mod integrators;
mod light_links;
mod parts;
mod passing;
mod pivots;
mod problems;
mod pushed;
mod radau;
mod references;
mod series;
mod series_catalogue;
mod skips;
mod slender;
mod stiff;
mod turns;
