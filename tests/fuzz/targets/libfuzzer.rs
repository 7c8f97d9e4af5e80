//! The program that libFuzzer drives; the environment variable `TARGET` says which reader it tries. See `run`.
#![no_main]

use std::panic::catch_unwind;
use std::process::abort;
use std::sync::LazyLock;

static TARGET: LazyLock<fn(&[u8])> = LazyLock::new(|| {
    let wanted = std::env::var("TARGET").unwrap_or_default();
    let found = triad_fuzz::TARGETS.iter().find(|(name, _)| *name == wanted);
    found.map_or_else(|| abort(), |(_, target)| *target)
});

/// Tries one input. A panic ends the process: so libFuzzer knows that the input is worth keeping.
///
/// # Safety
///
/// `data` points to `size` bytes that live until the function returns.
#[allow(unsafe_code, reason = "libFuzzer is called and calls in C")]
#[unsafe(no_mangle)]
pub unsafe extern "C" fn LLVMFuzzerTestOneInput(data: *const u8, size: usize) -> i32 {
    let data = if size == 0 {
        &[]
    } else {
        // SAFETY: what the caller promises.
        unsafe { std::slice::from_raw_parts(data, size) }
    };
    if catch_unwind(|| TARGET(data)).is_err() {
        abort();
    }
    0
}
