//! The library as a program uses it: scenes, motions that are kept, analyses, the examples.

#[path = "../common/mod.rs"]
mod common;

mod analyses;
mod assembly;
mod bounds;
mod catalogue;
mod counting;
mod custom_loads;
mod doubts;
mod driven_starts;
mod examples;
mod formulas;
mod gears;
mod hanging;
mod kinematics;
mod kinematics_in_space;
mod loops;
mod modes;
mod outputs;
mod parameters;
mod pure;
mod scales;
mod scene_words;
mod short_springs;
mod singular_starts;
mod small_motions;
mod snapshots;
mod solution;
mod steady;
mod steady_motions;
mod told_of_joints;
