//! First-order ordinary differential equations, the form in which integrators see a mechanism.

/// States that are evaluated at once, and what is found there.
#[derive(Debug)]
pub struct Many<'a> {
    /// The times, s.
    pub times: &'a [f64],
    /// The states y.
    pub states: &'a [Vec<f64>],
    /// ẏ.
    pub rates: &'a mut [Vec<f64>],
    /// Power of what changes the energy, W.
    pub power: &'a mut [f64],
    /// What they are.
    pub what: What,
}

/// What several states are that are evaluated at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
    /// The stages of an implicit step, in their order.
    Stages,
    /// These as they were found: of their ẏ only that at the end is used.
    FoundStages,
    /// States beside each other, for differences.
    Beside,
}

/// ẏ = f(t, y).
pub trait OdeSystem {
    /// Writes ẏ = f(t, y). The result must depend on nothing but t and y.
    fn rhs(&mut self, t: f64, y: &[f64], rate: &mut [f64]);

    /// The same as [`OdeSystem::rhs`], for the ẏ of second-order equations y = (x, ẋ) where x is that of the last evaluation: what
    /// depends on x alone need not be found again.
    fn rhs_at_rates(&mut self, t: f64, y: &[f64], rate: &mut [f64]) {
        self.rhs(t, y, rate);
    }

    /// The same as [`OdeSystem::rhs`] at several states at once, each with its own time, and the power at each. False, and nothing is written,
    /// if this is not quicker than one after the other. What is in place stays as it is.
    fn rhs_of_many(&mut self, _of: Many) -> bool {
        false
    }

    /// Says that the next evaluation is that of a stage of an implicit step, and whether it is the first one of the stage in this
    /// step: what was found there before is near.
    fn begin_stage(&mut self, _stage: usize, _first: bool) {}

    /// Whether f follows from y without equations that are solved by search: then it is smooth to the last digits.
    fn solves_nothing(&self) -> bool {
        false
    }

    /// The first moment after t at which something in f begins anew, s, or infinity: between such moments it is smooth.
    fn next_break(&self, _t: f64) -> f64 {
        f64::INFINITY
    }

    /// By how much errors of y are magnified where it was evaluated last.
    fn magnification(&self) -> f64 {
        1.0
    }

    /// Goes to the state y without asking for its ẏ. False if there is none.
    fn reach(&mut self, _t: f64, _y: &[f64]) -> bool {
        true
    }

    /// Which way each dry friction slides at the state (t, y): 1 or −1, or 0 where it sticks or turns round; nothing where there is none.
    fn slidings(&mut self, _t: f64, _y: &[f64], out: &mut Vec<i8>) {
        out.clear();
    }

    /// Power of what changes the energy at the state that was evaluated last, W, where there is such and the system knows it.
    fn power(&self) -> Option<f64> {
        None
    }

    /// The same at a state of its own, whose ẏ is not asked for.
    fn power_at(&mut self, _t: f64, _y: &[f64]) -> Option<f64> {
        None
    }

    /// What the energy of the state that was evaluated last is off by where each of its numbers is off by `error`, J: no work need be
    /// known better.
    fn energy_of(&self, _error: f64) -> f64 {
        0.0
    }

    /// Whether it is known how many whole turns joints have made since the last step at the state that was evaluated last.
    fn knows_turns(&self) -> bool {
        true
    }

    /// Called once after each accepted step, with ẏ = f(t, y) at its end. It may move y onto the constraints; then it must
    /// evaluate ẏ again unless the change was negligible.
    fn after_step(&mut self, t: f64, y: &mut [f64], rate: &mut [f64]);
}

impl<S: OdeSystem + ?Sized> OdeSystem for &mut S {
    fn rhs(&mut self, t: f64, y: &[f64], rate: &mut [f64]) {
        (**self).rhs(t, y, rate);
    }
    fn rhs_at_rates(&mut self, t: f64, y: &[f64], rate: &mut [f64]) {
        (**self).rhs_at_rates(t, y, rate);
    }
    fn rhs_of_many(&mut self, of: Many) -> bool {
        (**self).rhs_of_many(of)
    }
    fn power_at(&mut self, t: f64, y: &[f64]) -> Option<f64> {
        (**self).power_at(t, y)
    }
    fn slidings(&mut self, t: f64, y: &[f64], out: &mut Vec<i8>) {
        (**self).slidings(t, y, out);
    }
    fn energy_of(&self, error: f64) -> f64 {
        (**self).energy_of(error)
    }
    fn reach(&mut self, t: f64, y: &[f64]) -> bool {
        (**self).reach(t, y)
    }
    fn begin_stage(&mut self, stage: usize, first: bool) {
        (**self).begin_stage(stage, first);
    }
    fn solves_nothing(&self) -> bool {
        (**self).solves_nothing()
    }
    fn next_break(&self, t: f64) -> f64 {
        (**self).next_break(t)
    }
    fn magnification(&self) -> f64 {
        (**self).magnification()
    }
    fn knows_turns(&self) -> bool {
        (**self).knows_turns()
    }
    fn power(&self) -> Option<f64> {
        (**self).power()
    }
    fn after_step(&mut self, t: f64, y: &mut [f64], rate: &mut [f64]) {
        (**self).after_step(t, y, rate);
    }
}
