//! What is measured.

use std::fmt;

use triad_scene::{ConstraintMethod, Coordinates, IntegratorKind, Scene};

/// A scene to be measured and how its error is known.
#[derive(Clone, Debug)]
pub struct BenchCase {
    /// Name of the built-in scene, or what the given one is called.
    pub scene: String,
    /// A scene that is not built in.
    pub given: Option<Scene>,
    /// Length of the run, s.
    pub duration: f64,
    /// Where its reference comes from.
    pub truth: Truth,
    /// Whether it is run by the methods only whose work grows no faster than the number of bodies.
    pub large: bool,
}

/// The source of a reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Truth {
    /// One degree of freedom: the angle's own equation φ̈ = κ sin φ, solved by itself; compared is the centre of mass
    /// of the first body, `arm` (sin φ, cos φ).
    Angle {
        /// κ, 1/s².
        kappa: f64,
        /// φ from the upward vertical at the start, rad.
        start: f64,
        /// φ̇ at the start, rad/s.
        rate: f64,
        /// Distance of the centre of mass from the pivot, m.
        arm: f64,
    },
    /// The same scene by DOP853 at its tightest tolerance, by Radau IIA where it is stiff; compared are the positions of
    /// all bodies.
    Converged,
}

impl BenchCase {
    /// A scene of the user's, over its own duration.
    pub fn given(name: impl Into<String>, scene: Scene) -> Self {
        let large = scene.bodies.len() > MANY;
        let duration = scene.simulation.duration;
        Self { scene: name.into(), given: Some(scene), duration, truth: Truth::Converged, large }
    }
}

/// Bodies from which on a given scene counts as large: the built-in ones that do have more, the others fewer.
const MANY: usize = 25;

/// One way to run a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Method {
    /// The integrator.
    pub integrator: IntegratorKind,
    /// The constraint method.
    pub constraint_method: ConstraintMethod,
    /// The kind of all bodies.
    pub coordinates: Coordinates,
}

impl Method {
    /// The constraint method, with the numbers that are not the usual ones of its kind.
    pub fn treatment(&self) -> String {
        let word = self.constraint_method.to_string();
        let usual = word.parse().map_or_else(|_| Vec::new(), numbers);
        let own = numbers(self.constraint_method).into_iter().filter(|number| !usual.contains(number));
        own.fold(word, |words, (name, value)| format!("{words} {name}={value}"))
    }
}

/// What a constraint method may be given, by the scene format's words.
fn numbers(method: ConstraintMethod) -> Vec<(&'static str, f64)> {
    match method {
        ConstraintMethod::Projection | ConstraintMethod::Partitioning => Vec::new(),
        ConstraintMethod::Baumgarte { alpha, beta } => vec![("alpha", alpha), ("beta", beta)],
        ConstraintMethod::Penalty { alpha, omega, mu } => {
            vec![("alpha", alpha), ("omega", omega), ("mu", mu)]
        }
        ConstraintMethod::AugmentedLagrangian { alpha } => vec![("alpha", alpha)],
    }
}

impl fmt::Display for Method {
    /// The integrator, and whatever else is not the default.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.integrator)?;
        if self.constraint_method != ConstraintMethod::default() {
            write!(f, " {}", self.treatment())?;
        }
        if self.coordinates != Coordinates::default() {
            write!(f, " {}", self.coordinates)?;
        }
        Ok(())
    }
}

/// Everything that is measured.
#[derive(Clone, Debug)]
pub struct BenchPlan {
    /// The scenes.
    pub cases: Vec<BenchCase>,
    /// The ways to run them.
    pub methods: Vec<Method>,
    /// The tolerances.
    pub tolerances: Vec<f64>,
    /// Time for all repeats together, s.
    pub seconds: f64,
    /// Most repeats of one run.
    pub repeats: usize,
}

/// The user's lists in place of those of a plan; an empty list keeps the plan's own.
#[derive(Clone, Debug, Default)]
pub struct Wish {
    /// Parts of names of scenes.
    pub scenes: Vec<String>,
    /// Integrators.
    pub integrators: Vec<IntegratorKind>,
    /// Constraint methods.
    pub constraint_methods: Vec<ConstraintMethod>,
    /// Kinds of bodies.
    pub coordinates: Vec<Coordinates>,
    /// Tolerances.
    pub tolerances: Vec<f64>,
}

/// Acceleration of gravity in the built-in scenes, m/s².
const GRAVITY: f64 = 9.81;

/// κ of the N-four-bar mechanism.
fn four_bar(windows: f64) -> f64 {
    GRAVITY * 3.0 * (3.0 * windows + 1.0) / (2.0 * (4.0 * windows + 1.0))
}

fn windows(scene: &'static str, count: f64) -> BenchCase {
    let truth = Truth::Angle { kappa: four_bar(count), start: 0.0, rate: 1.0, arm: 0.5 };
    BenchCase { scene: scene.to_owned(), given: None, duration: 10.0, truth, large: count > 4.0 }
}

fn converged(scene: &'static str, duration: f64) -> BenchCase {
    let large = scene == "spatial-chain:100";
    BenchCase { scene: scene.to_owned(), given: None, duration, truth: Truth::Converged, large }
}

fn method(integrator: IntegratorKind) -> Method {
    Method { integrator, constraint_method: ConstraintMethod::default(), coordinates: Coordinates::default() }
}

impl BenchPlan {
    /// The whole sweep: all integrators, the other constraint methods with one of them, and the other kinds of bodies with the
    /// two best.
    pub fn full() -> Self {
        use IntegratorKind::{Dop853, Taylor, Trapezoidal};
        let pendulum =
            Truth::Angle { kappa: GRAVITY, start: -std::f64::consts::FRAC_PI_2, rate: 0.0, arm: 1.0 };
        // The augmented Lagrangian brings its own integrator along.
        let constraint_methods = ConstraintMethod::ALL.into_iter().skip(1).map(|constraint_method| Method {
            constraint_method,
            ..method(if matches!(constraint_method, ConstraintMethod::AugmentedLagrangian { .. }) {
                Trapezoidal
            } else {
                Dop853
            })
        });
        let others = [Coordinates::Reduced, Coordinates::Shared]
            .into_iter()
            .flat_map(|coordinates| [Taylor, Dop853].map(|i| Method { coordinates, ..method(i) }));
        Self {
            cases: vec![
                BenchCase {
                    scene: "simple-pendulum".to_owned(),
                    given: None,
                    duration: 10.0,
                    truth: pendulum,
                    large: false,
                },
                windows("n-four-bar:2", 2.0),
                windows("n-four-bar:10", 10.0),
                windows("n-four-bar:40", 40.0),
                converged("bricard", 10.0),
                converged("spatial-slider-crank", 5.0),
                converged("spatial-double-pendulum", 10.0),
                converged("heavy-top", 5.0),
                converged("spatial-chain:10", 2.0),
                converged("spatial-chain:100", 2.0),
            ],
            methods: IntegratorKind::ALL
                .into_iter()
                .map(method)
                .chain(constraint_methods)
                .chain(others)
                .collect(),
            tolerances: vec![1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11],
            seconds: 240.0,
            repeats: 21,
        }
    }

    /// A sweep that takes less than a minute.
    pub fn quick() -> Self {
        let mut plan = Self::full();
        plan.cases.retain(|case| {
            !["spatial-chain:100", "n-four-bar:40", "n-four-bar:10"].contains(&case.scene.as_str())
        });
        let few =
            [IntegratorKind::Auto, IntegratorKind::Taylor, IntegratorKind::Dop853, IntegratorKind::Dopri5];
        plan.methods.retain(|m| few.map(method).contains(m));
        plan.tolerances = vec![1e-4, 1e-6, 1e-8, 1e-10];
        plan.seconds = 20.0;
        plan.repeats = 9;
        plan
    }

    /// The plan with the user's lists, in all combinations.
    #[must_use]
    pub fn with(mut self, wish: Wish) -> Self {
        let Wish { scenes, integrators, constraint_methods, coordinates, tolerances } = wish;
        if !scenes.is_empty() {
            self.cases.retain(|case| scenes.iter().any(|part| case.scene.contains(part.as_str())));
        }
        if !tolerances.is_empty() {
            self.tolerances = tolerances;
        }
        if integrators.is_empty() && constraint_methods.is_empty() && coordinates.is_empty() {
            return self;
        }
        let or = |list: Vec<IntegratorKind>, own| if list.is_empty() { own } else { list };
        let mut own: Vec<IntegratorKind> = Vec::new();
        for method in &self.methods {
            if !own.contains(&method.integrator) {
                own.push(method.integrator);
            }
        }
        let constraint_methods = if constraint_methods.is_empty() {
            vec![ConstraintMethod::default()]
        } else {
            constraint_methods
        };
        let coordinates = if coordinates.is_empty() { vec![Coordinates::default()] } else { coordinates };
        self.methods.clear();
        for integrator in or(integrators, own) {
            for &constraint_method in &constraint_methods {
                for &coordinates in &coordinates {
                    self.methods.push(Method { integrator, constraint_method, coordinates });
                }
            }
        }
        self
    }

    /// Whether a run is worth its time: a method of low order is not at tight tolerances, and neither is one whose work
    /// grows with the cube of the number of bodies in a large scene.
    pub fn worth(case: &BenchCase, method: Method, tolerance: f64) -> bool {
        use IntegratorKind::{Auto, Dop853, Dopri5, Ode45, Radau, Rattle, Taylor, Trapezoidal};
        let (linear, tightest) = match method.integrator {
            Auto | Taylor | Dop853 => (true, 0.0),
            Dopri5 | Ode45 => (true, 1e-8),
            Radau | Rattle => (false, 1e-9),
            Trapezoidal => (false, 1e-5),
        };
        let linear = linear && method.constraint_method == ConstraintMethod::default();
        tolerance > 0.99 * tightest && (linear || !case.large)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wishes_are_crossed_and_the_rest_of_the_plan_stays() {
        let plan = BenchPlan::quick().with(Wish {
            scenes: vec!["four-bar".into()],
            integrators: vec![IntegratorKind::Taylor, IntegratorKind::Dop853],
            coordinates: vec![Coordinates::Full, Coordinates::Shared],
            ..Wish::default()
        });
        let names: Vec<String> = plan.methods.iter().map(Method::to_string).collect();
        assert_eq!(names, ["taylor", "taylor shared", "dop853", "dop853 shared"]);
        assert_eq!(plan.cases.iter().map(|c| c.scene.as_str()).collect::<Vec<_>>(), ["n-four-bar:2"]);
        assert_eq!(plan.tolerances, BenchPlan::quick().tolerances);
        assert_eq!(BenchPlan::quick().with(Wish::default()).methods, BenchPlan::quick().methods);
    }
}
