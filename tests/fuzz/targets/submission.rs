//! `cargo +nightly fuzz run submission --features libfuzzer`
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| triad_fuzz::submission(data));
