//! The examples run, and find what they assert.

#![allow(clippy::unwrap_used)] // a test that cannot go on says so

#[path = "../../examples/driver_torque.rs"]
mod driver_torque;
#[path = "../../examples/event.rs"]
mod event;
#[path = "../../examples/four_bar_reactions.rs"]
mod four_bar_reactions;
#[path = "../../examples/own_load.rs"]
mod own_load;
#[path = "../../examples/pendulum.rs"]
mod pendulum;

#[test]
fn a_pendulum_keeps_its_energy() {
    pendulum::main().unwrap();
}

#[test]
fn reactions_of_a_four_bar_are_told_with_what_is_unique() {
    four_bar_reactions::main().unwrap();
}

#[test]
fn a_driver_tells_its_torque() {
    driver_torque::main().unwrap();
}

#[test]
fn an_event_stops_the_run() {
    event::main().unwrap();
}

#[test]
fn a_function_of_the_state_is_a_load() {
    own_load::main().unwrap();
}
