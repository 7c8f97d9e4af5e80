//! What must hold for every mechanism at every state — on random scenes.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use proptest::prelude::*;
use triad_engine::dynamics::series::IslandSeries;
use triad_engine::newton::{StopRule, project_positions, project_velocities, rules};
use triad_engine::run::Simulation;
use triad_engine::scene::IntegratorKind;
use triad_engine::state::BodyFrame;
use triad_tests::probe::TestMechanism;
use triad_tests::random::{Choice, scenes};
use triad_tests::reference::distance;

/// Derivative at zero of a polynomial of degree at most four, exact but for rounding.
fn derivative<T>(mut f: impl FnMut(f64) -> T) -> T
where
    T: std::ops::Sub<Output = T> + std::ops::Mul<f64, Output = T>,
{
    let h = 0.5;
    let near = f(h) - f(-h);
    let far = f(2.0 * h) - f(-2.0 * h);
    (near * 8.0 - far) * (1.0 / (12.0 * h))
}

/// So many random scenes, or as many as `PROPTEST_CASES` says; their seed is in `.cargo/config.toml`.
fn few(cases: u32) -> ProptestConfig {
    let cases = std::env::var("PROPTEST_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(cases);
    ProptestConfig::with_cases(cases)
}

proptest! {
    #![proptest_config(few(64))]

    /// Φ has degree four at most, eq. (4.1), so differences give Φ_q exactly, at states far from the constraints.
    #[test]
    fn the_jacobian_is_the_derivative_of_the_constraints(
        scene in scenes(),
        shift in prop::collection::vec(-0.5..0.5f64, 96),
    ) {
        let mut probe = TestMechanism::new(&scene.scene(Choice::default()));
        let y = probe.along(&shift[..probe.y.len()], 1.0);
        probe.y.clone_from(&y);
        let phi_q = probe.jacobian(&y);
        for column in 0..probe.n() {
            let mut unit = vec![0.0; y.len()];
            unit[column] = 1.0;
            let difference = derivative(|h| { let y = probe.along(&unit, h); probe.phi(&y) });
            let error = (phi_q.column(column) - difference).amax();
            prop_assert!(error < 1e-12, "column {column}: {error}");
        }
    }

    /// Φ̈ = Φ_q q̈ − γ, eq. (4.2): with q̈ = 0, γ is minus the rate of Φ_q q̇.
    #[test]
    fn gamma_is_minus_the_rate_of_the_jacobian_times_the_velocity(
        scene in scenes(),
        shift in prop::collection::vec(-0.5..0.5f64, 96),
    ) {
        let mut probe = TestMechanism::new(&scene.scene(Choice::default()));
        let y = probe.along(&shift[..probe.y.len()], 1.0);
        probe.y.clone_from(&y);
        let velocity = probe.velocity();
        let mut ahead = velocity.as_slice().to_vec();
        ahead.resize(y.len(), 0.0);
        let rate = derivative(|h| { let y = probe.along(&ahead, h); probe.jacobian(&y) * &velocity });
        let gamma = probe.gamma(&y);
        let error = (&gamma + rate).amax();
        prop_assert!(error < 1e-11 * (1.0 + gamma.amax()), "{error}");
    }

    /// The elimination of section 7 gives the accelerations of the augmented system of section 6.
    #[test]
    fn the_elimination_solves_the_augmented_system(scene in scenes()) {
        let mut probe = TestMechanism::new(&scene.scene(Choice::default())).assembled();
        let y = probe.y.clone();
        let (ours, (dense, condition)) = (probe.accelerations(&y), probe.augmented(&y));
        let error = (&ours - &dense).amax();
        let allowed = (1e-10 + 1e-14 * condition) * (1.0 + dense.amax());
        prop_assert!(error < allowed, "{error} of {}, condition {condition:.1e}", dense.amax());
        let residual = (probe.jacobian(&y) * &ours - probe.gamma(&y)).amax();
        prop_assert!(residual < 1e-9 * (1.0 + dense.amax()), "{residual}");
    }

    /// The same off the constraints, where the directors are neither unit nor perpendicular. (A common vector keeps
    /// two of its three rows there, and redundant rows contradict each other, so the scenes have neither.)
    #[test]
    fn the_elimination_is_exact_off_the_constraints(
        scene in scenes(),
        shift in prop::collection::vec(-0.1..0.1f64, 96),
    ) {
        let choice = Choice { coordinates: Some("full"), revolute: Some("cp-2car"), tree: true, free: false };
        let mut probe = TestMechanism::new(&scene.scene(choice));
        let y = probe.along(&shift[..probe.y.len()], 1.0);
        let (ours, (dense, condition)) = (probe.accelerations(&y), probe.augmented(&y));
        let error = (&ours - &dense).amax();
        let allowed = (1e-10 + 1e-14 * condition) * (1.0 + dense.amax());
        prop_assert!(error < allowed, "{error} of {}, condition {condition:.1e}", dense.amax());
    }

    /// The projection (10.2) is one: a second one finds nothing to do. And it is the shortest in the sense of the masses: the
    /// velocities lose the kinetic energy of their change.
    #[test]
    fn a_projection_is_idempotent_and_orthogonal(
        scene in scenes(),
        shift in prop::collection::vec(-0.01..0.01f64, 96),
    ) {
        let choice = Choice { coordinates: Some("full"), ..Choice::default() };
        let mut probe = TestMechanism::new(&scene.scene(choice)).assembled();
        let mut y = probe.along(&shift[..probe.y.len()], 1.0);
        let (n, length) = (probe.n(), probe.mechanism.system.length);
        let mechanism = &mut probe.mechanism;
        mechanism.set_state(0.0, &y);
        let there = project_positions(&mut mechanism.projectable(&mut y), &rules::ASSEMBLY_POSITIONS, length);
        prop_assert!(there.has_converged() && there.moved > 1e-4);
        mechanism.set_state(0.0, &y);
        let given = y[n..].to_vec();
        project_velocities(&mut mechanism.projectable(&mut y), &rules::ASSEMBLY_VELOCITIES, length);
        let energy = |v: &[f64]| -> f64 {
            let bodies = mechanism.system.bodies.iter();
            let parts = bodies.map(|body| {
                let v = body.layout.velocity(&body.layout.position(&y), v);
                let turning: f64 = (0..3).map(|k| body.ibar[k] * v.e[k].norm_squared()).sum();
                body.mass * v.r.norm_squared() + turning
            });
            parts.sum()
        };
        let change: Vec<f64> = given.iter().zip(&y[n..]).map(|(given, v)| given - v).collect();
        let lost = energy(&given) - energy(&y[n..]);
        prop_assert!((lost - energy(&change)).abs() < 1e-9 * energy(&given), "{lost}");
        mechanism.set_state(0.0, &y);
        let mut again = y.clone();
        let mut on = mechanism.projectable(&mut again);
        let once_more = StopRule { max_corrections: 1, ..rules::ASSEMBLY_VELOCITIES };
        let moved = project_velocities(&mut on, &once_more, length).moved
            + project_positions(&mut on, &once_more, length).moved;
        prop_assert!(moved < 1e-11, "{moved}");
    }

    /// The rank (8.1) is the same by elimination and by the series, which are written independently; a joint that is written
    /// twice adds all its rows to those that depend on others.
    #[test]
    fn both_evaluations_find_the_same_rank(scene in scenes(), which in any::<prop::sample::Index>()) {
        let mut scene = scene.scene(Choice::default());
        let once = TestMechanism::new(&scene).assembled().dependent_rows();
        prop_assume!(!scene.joints.is_empty());
        let joint = which.index(scene.joints.len());
        let mut copy = scene.joints[joint].clone();
        copy.name = "again".to_owned();
        scene.joints.push(copy);
        let mut probe = TestMechanism::new(&scene).assembled();
        let dependent = probe.dependent_rows();
        let system = &probe.mechanism.system;
        prop_assert_eq!(dependent, once + system.constraints[joint].solver.len());
        let mut series = IslandSeries::in_space(&system.in_lengths(), 2, &[]);
        series.place(system, 0.0, &probe.y);
        prop_assert_eq!(series.find_dependent(system.length, true, None).len(), dependent);
    }

    /// Joints do no work: dE/dt = 0 under gravity alone.
    #[test]
    fn power_is_balanced(scene in scenes()) {
        let mut probe = TestMechanism::new(&scene.scene(Choice::default())).assembled();
        let y = probe.y.clone();
        let mut rate = probe.velocity().as_slice().to_vec();
        rate.extend_from_slice(probe.accelerations(&y).as_slice());
        // The energy has degree six along the rate; the step makes what is left out smaller than rounding.
        let h = 1e-3;
        let mut at = |k: f64| { let y = probe.along(&rate, k * h); probe.energy(&y) };
        let power = (45.0 * (at(1.0) - at(-1.0)) - 9.0 * (at(2.0) - at(-2.0)) + at(3.0) - at(-3.0)) / (60.0 * h);
        let size = rate.iter().fold(1.0f64, |a, x| a.max(x.abs()));
        prop_assert!(power.abs() < 1e-10 * size * size, "{power} W at rates of {size}");
    }

    /// Free mechanisms: the momentum changes by the weight, the angular momentum by its moment, whatever the joints
    /// and coordinates. This sees the sign of the velocity term of eq. (6.5), which the energy does not.
    #[test]
    fn momentum_and_angular_momentum_are_balanced(scene in scenes()) {
        let scene = scene.scene(Choice { free: true, ..Choice::default() });
        let mut probe = TestMechanism::new(&scene).assembled();
        let y = probe.y.clone();
        let accelerations = probe.accelerations(&y);
        let mut rate = probe.velocity().as_slice().to_vec();
        rate.extend_from_slice(accelerations.as_slice());
        let gravity = nalgebra::Vector3::from(scene.gravity);
        let mut weight = nalgebra::Vector3::zeros();
        let mut moment = nalgebra::Vector3::zeros();
        for (state, body) in probe.mechanism.state.bodies().iter().zip(&probe.mechanism.system.bodies) {
            weight += gravity * body.mass;
            moment += state.q.r.cross(&(gravity * body.mass));
        }
        let h = 1e-3;
        let mut momenta = |k: f64| {
            let y = probe.along(&rate, k * h);
            probe.mechanism.set_state(0.0, &y);
            let (mut p, mut l) = (nalgebra::Vector3::zeros(), nalgebra::Vector3::zeros());
            for (state, body) in probe.mechanism.state.bodies().iter().zip(&probe.mechanism.system.bodies) {
                p += state.q_dot.r * body.mass;
                l += state.q.r.cross(&state.q_dot.r) * body.mass;
                for k in 0..3 {
                    l += state.q.e[k].cross(&state.q_dot.e[k]) * body.ibar[k];
                }
            }
            [p, l]
        };
        let [[p1, l1], [p2, l2], [p3, l3], [p4, l4]] = [momenta(1.0), momenta(-1.0), momenta(2.0), momenta(-2.0)];
        let p_rate = ((p1 - p2) * 8.0 - (p3 - p4)) / (12.0 * h);
        let l_rate = ((l1 - l2) * 8.0 - (l3 - l4)) / (12.0 * h);
        let size = 1.0 + accelerations.amax();
        prop_assert!((p_rate - weight).amax() < 1e-9 * size, "{p_rate} {weight}");
        prop_assert!((l_rate - moment).amax() < 1e-9 * size, "{l_rate} {moment}");
    }
}

/// Position, attitude and velocity of a body as one list.
fn numbers(frame: &BodyFrame) -> Vec<f64> {
    [frame.position, frame.u, frame.v, frame.w, frame.velocity, frame.angular_velocity].concat()
}

proptest! {
    #![proptest_config(few(10))]

    /// A body moves the same, with full and with reduced coordinates.
    #[test]
    fn full_and_reduced_coordinates_give_one_motion(scene in scenes()) {
        let [mut full, mut reduced] = ["full", "reduced"].map(|coordinates| {
            let choice = Choice { coordinates: Some(coordinates), ..Choice::default() };
            let mut scene = scene.scene(choice);
            if coordinates == "full" {
                // The default may share no code with the other one: all the better.
                scene.simulation.integrator = IntegratorKind::default();
            }
            Simulation::new(&scene).unwrap()
        });
        for k in 1..=10 {
            let t = 0.05 * f64::from(k);
            full.advance_to(t).unwrap();
            reduced.advance_to(t).unwrap();
            for (a, b) in full.frame().bodies.iter().zip(&reduced.frame().bodies) {
                let error = distance(&numbers(a), &numbers(b));
                prop_assert!(error < 1e-6, "{error} at {t} s");
            }
        }
    }

    /// A revolute joint moves the same and holds with the same force and moment, whichever rows it is made of.
    #[test]
    fn both_forms_of_a_revolute_joint_agree(scene in scenes()) {
        let [mut cv, mut car] = ["cp-cv", "cp-2car"].map(|revolute| {
            let choice = Choice { revolute: Some(revolute), ..Choice::default() };
            Simulation::new(&scene.scene(choice)).unwrap()
        });
        // With redundant rows the reactions are not unique; the rows that CV drops by itself do not count.
        let unique = car.rank().dependent.is_empty();
        for k in 1..=10 {
            let t = 0.05 * f64::from(k);
            cv.advance_to(t).unwrap();
            car.advance_to(t).unwrap();
            for (a, b) in cv.frame().bodies.iter().zip(&car.frame().bodies) {
                let error = distance(&numbers(a), &numbers(b));
                prop_assert!(error < 1e-6, "{error} at {t} s");
            }
            for (a, b) in cv.multipliers().iter().zip(&car.multipliers()).filter(|_| unique) {
                let size = 1.0 + distance(&b.force, &[0.0; 3]) + distance(&b.moment, &[0.0; 3]);
                let error = distance(&a.force, &b.force).max(distance(&a.moment, &b.moment));
                prop_assert!(error < 1e-5 * size, "{}: {error} of {size} at {t} s", a.joint);
            }
        }
    }
}
