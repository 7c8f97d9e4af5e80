#![doc = include_str!("../README.md")]

pub mod message;

mod whole;

mod inquiry;

mod live;

pub mod desk;

#[cfg(target_family = "wasm")]
mod doors;
