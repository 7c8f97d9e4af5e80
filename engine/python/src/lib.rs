//! The native part of the Python module `triad`: it takes scenes and options as JSON, and gives arrays and JSON.
//!
//! What a user sees, with its documentation, is the Python around it (`python/triad`); what of it is native, and with which
//! types, is in `python/triad/_native.pyi`. The modules stand in reading order: [`refusal`] (errors), [`scene`] (which scene,
//! with which options), [`arrays`], [`watch`] (Ctrl-C and progress), [`motion`] (a run), [`system`] (the equations at any
//! state), [`analyses`], [`sweep`], [`grade`].

mod refusal;

mod scene;

mod arrays;

mod watch;

mod motion;

mod system;

mod analyses;

mod sweep;

mod grade;

use pyo3::prelude::*;

/// The module `triad._native`.
#[pymodule(gil_used = true)]
mod _native {
    #[pymodule_export]
    use crate::analyses::{analyse, check, scene_json, scene_schema, scenes};
    #[pymodule_export]
    use crate::grade::{grade, lessons};
    #[pymodule_export]
    use crate::motion::{Motion, run};
    #[pymodule_export]
    use crate::refusal::TriadError;
    #[pymodule_export]
    use crate::sweep::{Sweep, sweep};
    #[pymodule_export]
    use crate::system::System;
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("VERSION", triad_engine::VERSION)
    }
}
