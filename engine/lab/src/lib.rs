#![doc = include_str!("../README.md")]

pub mod csv;

pub mod verify;

pub mod stress;

pub mod estimates;

pub mod paper;

pub mod bench;

pub mod sweep;

pub mod film;
