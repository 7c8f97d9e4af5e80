//! What comes of bodies that have no inertia about some axis: joints have to lend them some — THEORY section 11.

use triad_dynamics::constraints::ConstraintError;
use triad_dynamics::constraints::mechanism::Mechanism;

/// What is looked for in the accelerations of a run that has such bodies.
#[derive(Clone, Debug)]
pub(super) struct LentInertia {
    /// Whether there are any.
    needed: bool,
    /// Whether something may turn one about an axis about which it has none.
    may_lose_balance: bool,
    /// When bodies first moved together with next to no inertia, s, and which.
    pub hardly_inert: Option<(f64, Vec<usize>)>,
}

impl LentInertia {
    /// Before anything was looked at.
    pub fn of(mechanism: &Mechanism) -> Self {
        let needed = mechanism.system.regularizes_inertia();
        Self { needed, may_lose_balance: needed && mechanism.may_lose_balance(), hardly_inert: None }
    }

    /// Looks at a state (t, y) of the run.
    ///
    /// # Errors
    ///
    /// [`ConstraintError::NothingHolds`]: something turns a body about an axis about which it has no inertia, and no joint holds it.
    pub fn look(&mut self, mechanism: &mut Mechanism, t: f64, y: &[f64]) -> Result<(), ConstraintError> {
        if !self.may_lose_balance && (!self.needed || self.hardly_inert.is_some()) {
            return Ok(());
        }
        mechanism.accelerations_aside(t, y);
        if self.may_lose_balance {
            mechanism.check_balance(t)?;
        }
        if self.hardly_inert.is_none() {
            let bodies = mechanism.elimination.hardly_inert();
            self.hardly_inert = (!bodies.is_empty()).then_some((t, bodies));
        }
        Ok(())
    }
}
