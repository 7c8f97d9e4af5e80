//! `cargo +nightly fuzz run lesson --features libfuzzer`
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| triad_fuzz::lesson(data));
