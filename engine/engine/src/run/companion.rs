//! The second solution beside a run whose integrator carries no error along: the error is what lies between the two —
//! eq. (11.13).

use super::ringing::Ringing;
use crate::integrate::{self, Integrator, StepRecord};
use crate::scene::IntegratorKind;
use triad_dynamics::constraints::mechanism::Mechanism;

/// Tolerance of the second solution over that of the first: its own error then spoils the estimate by a few parts in a hundred
/// (measured: docs/ACCURACY.md). With a hundredth, a few parts in a hundred of the runs at loose tolerances were more exact than it.
const TIGHTER: f64 = 1e-4;
/// The same of radau beside radau, whose steps are shorter as well.
const TIGHTER_STEPS: f64 = 1e-2;
/// Part of the first one's step that the second one's is not longer than, radau beside radau: while steps only grow from the first one,
/// both would take the same, whatever their tolerances, and agree in their errors.
const SHORTER: f64 = 0.5;
/// The least tolerance of the second solution: rounding is near. That of a run with steps of one size, whose error has nothing to
/// do with its tolerance.
const TIGHTEST: f64 = 1e-12;
/// Part of the first one's tolerance that the second one's is at most, even below [`TIGHTEST`]: two runs by one method at one tolerance
/// are the same run, and nothing lies between them.
const NEAREST: f64 = 0.1;
/// Tolerance of the first one below which rounding leaves no room for a tighter one. There the second one is the looser, at [`TIGHTEST`],
/// and what lies between them is rather its own error.
const NO_TIGHTER: f64 = 5e-13;
/// Evaluations of the second solution beyond which it gets nowhere: so many, and so many times those of the first one. A position that the
/// first one has stepped over may let it take ever shorter steps, and nobody could stop it between them.
const MOST_EVALUATIONS: u64 = 20_000;
const TIMES_FIRST: u64 = 50;
/// Part of the length of the mechanism beyond which the two are no longer compared: as for an error that a series carries.
const LOST: f64 = 0.05;

/// Why, and from when on, s, nothing is known of an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Lost {
    /// It is no longer small against the mechanism.
    TooLarge(f64),
    /// The second solution cannot go on.
    Stopped(f64),
}

impl Lost {
    /// From when on, s.
    pub fn from(self) -> f64 {
        match self {
            Self::TooLarge(time) | Self::Stopped(time) => time,
        }
    }
}

/// A second solution of the same start, by the method that is best for the scene at a tighter tolerance.
///
/// It is compared at the ends of the first one's steps and wherever the first one is looked at, so that an error between steps is
/// seen too. It takes steps of its own, whatever the outputs.
#[derive(Clone, Debug)]
pub(super) struct Companion {
    mechanism: Mechanism,
    integrator: Integrator,
    kind: IntegratorKind,
    /// Whether it goes beside the same method, in its steps where it can.
    alike: bool,
    /// The most evaluations that it may take so far.
    most: u64,
    /// When the two were compared last, s.
    compared: f64,
    /// The second solution at that time, less its own error if it carries that along.
    y: Vec<f64>,
    /// Its own error.
    own: Vec<f64>,
    /// Vibrations that both may lose, where it goes beside the same stiff method.
    ringing: Option<Ringing>,
    lost: Option<Lost>,
}

impl Companion {
    /// Starts beside an integrator of the given kind at (t, y), unless that carries its error along or none is wanted.
    pub fn start(kind: IntegratorKind, mechanism: &Mechanism, t: f64, y: &[f64]) -> Option<Box<Self>> {
        let settings = &mechanism.system.model.settings;
        if kind == IntegratorKind::Taylor || !settings.error_estimate {
            return None;
        }
        // Other methods would resolve what the first one leaves out.
        let stiff = kind == IntegratorKind::Radau && !mechanism.system.loads.is_empty();
        let tolerance = match settings.step {
            // The errors of rattle are far below its tolerance where its steps are limited by something else.
            // Radau beside radau has other stages or steps, whatever the tolerances.
            None if stiff => (TIGHTER_STEPS * settings.tolerance).max(TIGHTEST),
            None if kind != IntegratorKind::Rattle => tolerance_beside(settings.tolerance),
            _ => TIGHTEST,
        };
        let mut mechanism = mechanism.clone();
        let settings = &mut mechanism.system.model.settings;
        let by = if stiff { IntegratorKind::Radau } else { IntegratorKind::Auto };
        settings.compare_by(by, tolerance);
        let (kind, _) = integrate::choose(&mut mechanism, y);
        mechanism.set_state(t, y);
        let integrator = Integrator::start_beside(kind, &mut mechanism, t, y);
        let own = vec![0.0; y.len()];
        let ringing = if stiff { Ringing::new(&mechanism) } else { None };
        Some(Box::new(Self {
            mechanism,
            integrator,
            kind,
            alike: stiff,
            most: MOST_EVALUATIONS,
            compared: t,
            y: y.to_vec(),
            own,
            ringing,
            lost: None,
        }))
    }

    /// Its method and tolerance.
    pub fn method(&self) -> (IntegratorKind, f64) {
        (self.kind, self.mechanism.system.model.settings.tolerance)
    }

    /// From when on nothing is known, and why.
    pub fn lost(&self) -> Option<Lost> {
        self.lost
    }

    /// Goes on to the end of the last step of the first one, which has taken so many evaluations, before it takes another.
    pub fn keep_up(&mut self, first: &Integrator, evaluations: u64) {
        let last = first.last();
        self.most = MOST_EVALUATIONS + TIMES_FIRST * evaluations;
        self.compare(last.t, &last.y, first);
        if let Some(ringing) = self.ringing.as_mut().filter(|_| self.lost.is_none() && last.h > 0.0) {
            ringing.look(&self.mechanism, last, &self.y);
        }
    }

    /// Goes on to time t in the first one's last step, not before that of the last comparison, at which the first solution is y.
    pub fn compare(&mut self, t: f64, y: &[f64], first: &Integrator) {
        if self.lost.is_some() || t <= self.compared {
            return;
        }
        while self.integrator.last().t < t {
            let followed = self.alike && self.follow(first);
            let (work, _) = self.integrator.work(&self.mechanism);
            if work.evaluations > self.most || (!followed && !self.step(first)) {
                self.lost = Some(Lost::Stopped(self.integrator.last().t));
                return;
            }
        }
        let Self { mechanism, integrator, .. } = self;
        integrator.interpolate(mechanism, t, &mut self.y);
        self.compared = t;
        let system = &mechanism.system;
        if integrator.error(system, t, &mut self.own) {
            self.y.iter_mut().zip(&self.own).for_each(|(y, own)| *y -= own);
        }
        // A comparison that is false for NaN as well.
        let [a, b] = [y, &self.y].map(|y| &y[..system.coordinates]);
        let near = system.longest_way(a, b) < LOST * system.length;
        self.lost = (!near).then_some(Lost::TooLarge(t));
    }

    /// Takes the last step of the first one beside it, if that is where it stands.
    fn follow(&mut self, first: &Integrator) -> bool {
        let beside = self.integrator.last().t == first.last().t_old;
        beside && self.integrator.follow(&mut self.mechanism, first)
    }

    /// Takes a step of its own. False if it cannot.
    fn step(&mut self, first: &Integrator) -> bool {
        let StepRecord { t, h, .. } = *first.last();
        let now = self.integrator.last().t;
        let mut to = self.mechanism.system.model.settings.duration;
        if self.alike && h > 0.0 {
            to = to.min(now + SHORTER * h);
            if first.leader().is_some() && now < t {
                to = to.min(t);
            }
        }
        self.integrator.step(&mut self.mechanism, to).is_ok()
    }

    /// Writes the error of y at time t, if the two were compared last then.
    pub fn error(&self, t: f64, y: &[f64], out: &mut [f64]) -> bool {
        let known = self.lost.is_none() && t == self.compared;
        if known {
            for (out, (here, there)) in out.iter_mut().zip(y.iter().zip(&self.y)) {
                *out = here - there;
            }
            if let Some(ringing) = &self.ringing {
                ringing.add_to(out);
            }
        }
        known
    }
}

/// Tolerance of a second solution beside a first one at this tolerance.
pub(super) fn tolerance_beside(first: f64) -> f64 {
    if first < NO_TIGHTER { TIGHTEST } else { (TIGHTER * first).max(TIGHTEST.min(NEAREST * first)) }
}
