//! `cargo +nightly fuzz run scene --features libfuzzer`
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| triad_fuzz::scene(data));
