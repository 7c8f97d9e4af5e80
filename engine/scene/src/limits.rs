//! How large a scene may be.

/// Largest number of bodies that a scene may have.
pub const MAX_BODIES: usize = 5_000;
/// Largest number of joints, drivers, loads or markers that a scene may have (each).
pub const MAX_JOINTS: usize = 20_000;
/// Largest number of events that a scene may look for.
pub const MAX_EVENTS: usize = 1_000;
/// Largest text of a scene, in bytes.
pub const MAX_TEXT: usize = 16 << 20;
