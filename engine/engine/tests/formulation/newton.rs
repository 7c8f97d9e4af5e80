//! Newton's method stops where the state is consistent, and where it never will be.

use triad_engine::newton::{
    AsWanted, Ending, Linearize, Projectable, Projected, StopRule, project_positions, project_velocities,
};

/// One unknown x with x² = 2, corrected by Newton's method with the slope where it was linearized.
struct Root {
    x: f64,
    slope: f64,
    linearized: usize,
}

impl Projectable for Root {
    fn linearize(&mut self) {
        self.slope = 2.0 * self.x;
        self.linearized += 1;
    }
    fn correct_positions(&mut self) -> f64 {
        let step = (self.x * self.x - 2.0) / self.slope;
        self.x -= step;
        step.abs()
    }
    fn correct_velocities(&mut self) -> f64 {
        f64::NAN
    }
}

fn root(rule: &StopRule) -> (Root, Projected) {
    let mut root = Root { x: 1.0, slope: 2.5, linearized: 0 };
    let projected = project_positions(&mut root, rule, 1.0);
    (root, projected)
}

const RULE: StopRule = StopRule {
    linearize: Linearize::Every(1),
    consistent: 1e-13,
    patience: 0,
    diverged: 10.0,
    max_corrections: 40,
};

#[test]
fn it_stops_where_the_state_is_consistent() {
    let (exact, projected) = root(&RULE);
    assert_eq!((projected.ending, projected.corrections), (Ending::Consistent, 6));
    assert!((exact.x - 2.0f64.sqrt()).abs() < 1e-15);
    assert_eq!(exact.linearized, 6);
    // With one slope convergence is linear.
    let (same, projected) = root(&StopRule { linearize: Linearize::Never, ..RULE });
    assert!(projected.has_converged() && projected.corrections > 10 && same.linearized == 0);
    assert_eq!(root(&StopRule { linearize: Linearize::Once, ..RULE }).0.linearized, 1);
}

#[test]
fn it_stops_where_nobody_waits_for_it() {
    let asked = std::cell::Cell::new(0);
    let wanted = || {
        asked.set(asked.get() + 1);
        asked.get() < 4
    };
    let mut on = AsWanted { on: Root { x: 1.0, slope: 2.5, linearized: 0 }, wanted: &wanted };
    let projected = project_positions(&mut on, &RULE, 1.0);
    assert_eq!((projected.ending, projected.corrections, on.on.linearized), (Ending::Diverged, 2, 2));
    assert!(on.on.x < 2.0, "it is left as it is");
}

#[test]
fn it_stops_where_rounding_stalls_where_it_diverges_and_when_corrections_are_used_up() {
    let stalled = StopRule { consistent: -1.0, ..RULE };
    assert_eq!(root(&stalled).1.ending, Ending::Stalled);
    assert_eq!(root(&StopRule { patience: 40, ..stalled }).1.corrections, 40);
    assert_eq!(root(&StopRule { max_corrections: 2, ..RULE }).1.ending, Ending::Exhausted);
    assert_eq!(root(&StopRule { diverged: 0.1, ..RULE }).1.ending, Ending::Diverged);
    let mut none = Root { x: 1.0, slope: 1.0, linearized: 0 };
    let projected = project_velocities(&mut none, &RULE, 1.0);
    assert_eq!((projected.ending, projected.corrections), (Ending::Diverged, 1));
}
