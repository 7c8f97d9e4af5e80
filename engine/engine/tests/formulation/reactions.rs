//! Reactions against references and equilibrium, and what is told of their uniqueness.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests may panic")]

use crate::common::{problem, random_scene, start, table};
use nalgebra::Vector3;
use serde_json::json;
use triad_engine::analysis::check::check;
use triad_engine::catalogue;
use triad_engine::equations::augmented::AugmentedSystem;
use triad_engine::model::BodyRef;
use triad_engine::reactions::report::{
    Convention, ExpressedIn, MomentReference, Reaction, ReactionComponent, ReactionReport, Side,
};
use triad_engine::run::Simulation;
use triad_engine::scene::{AxisRows, Joint, JointKind, Orientation, Scene};
use triad_engine::state::State;
use triad_linalg::left_null_space;

fn on(side: Side, about: MomentReference) -> Convention {
    Convention { on: side, about, ..Convention::default() }
}

fn of<'a>(report: &'a ReactionReport, joint: &str) -> &'a Reaction {
    report.reactions.iter().find(|r| r.joint == joint).unwrap()
}

fn values(components: [ReactionComponent; 3]) -> Vector3<f64> {
    Vector3::from(components.map(|c| c.value))
}

/// The double four-bar at an angle from upright, turning as the reference does.
fn four_bar_at(phi: f64) -> Scene {
    let kappa = 11.445;
    let rate = (1.0 + 2.0 * kappa * (1.0 - libm::cos(phi))).sqrt();
    let mut scene = catalogue::scene("n-four-bar:2").unwrap();
    let (along, turn) =
        ([libm::sin(phi), libm::cos(phi), 0.0], [libm::cos(phi) * rate, -libm::sin(phi) * rate, 0.0]);
    let plus = |a: [f64; 3], b: [f64; 3], f: f64| [0, 1, 2].map(|k| a[k] + f * b[k]);
    for i in 0..3 {
        let body = &mut scene.bodies[i];
        body.position = plus([i as f64, 0.0, 0.0], along, 0.5);
        body.velocity = plus([0.0; 3], turn, 0.5);
        body.angular_velocity = [0.0, 0.0, -rate];
        body.orientation = Some(Orientation::directors(along, [-along[1], along[0], 0.0]));
    }
    for i in 0..2 {
        let body = &mut scene.bodies[3 + i];
        body.position = plus([i as f64 + 0.5, 0.0, 0.0], along, 1.0);
        body.velocity = turn;
    }
    for joint in scene.joints.iter_mut().filter(|joint| joint.name.starts_with('B')) {
        let foot = [joint.point.unwrap()[0], 0.0, 0.0];
        joint.point = Some(plus(foot, along, 1.0));
    }
    scene
}

#[test]
fn the_pins_of_the_double_four_bar_match_their_reference() {
    let (names, rows) = table(include_str!("../data/four-bar-reactions.csv"));
    // The reference's column, our joint, and the side of the link that its name tells first.
    let pins = [
        ("A0_F", "A0", Side::J),
        ("A1_F", "A1", Side::J),
        ("A2_F", "A2", Side::J),
        ("B0_V0_H1_F", "B0", Side::I),
        ("B1_V1_H1_F", "B1", Side::J),
        ("B1_V1_H2_F", "B1-right", Side::I),
        ("B2_V2_H2_F", "B2", Side::J),
    ];
    let (mut compared, mut largest) = (0, 0.0f64);
    for row in rows.iter().filter(|row| libm::cos(row[1]).abs() > 0.2) {
        let simulation = Simulation::new(&four_bar_at(row[1])).unwrap();
        let reports = [Side::I, Side::J]
            .map(|side| simulation.reactions(on(side, MomentReference::JointPoint)).unwrap());
        let scale = row[2..16].iter().fold(1.0f64, |a, x| a.max(x.abs()));
        for (column, joint, side) in pins {
            let found = of(&reports[usize::from(side == Side::J)], joint);
            for k in 0..2 {
                let name = format!("{column}{}[N]", ["x", "y"][k]);
                let expected = row[names.iter().position(|n| *n == name).unwrap()];
                largest = largest.max((found.force[k].value - expected).abs() / scale);
                compared += 1;
            }
            // Every loop repeats the force out of its plane and the two moments across the axes.
            assert_eq!(found.force.map(|c| c.unique), [true, true, false], "{joint} at {}", row[0]);
            assert_eq!(found.moment.map(|c| c.unique), [false, false, true], "{joint} at {}", row[0]);
        }
        assert_eq!(reports[0].redundancies.iter().map(|r| r.rows).sum::<usize>(), 6);
    }
    println!("{compared} components, largest deviation {largest:.1e}");
    assert!(compared > 1000 && largest < 1e-7, "{compared}: {largest:e}");
}

#[test]
fn the_seventeen_reactions_of_the_slider_crank_match_their_reference() {
    let mut scene = catalogue::scene("spatial-slider-crank").unwrap();
    scene.simulation.tolerance = 1e-11;
    let mut simulation = Simulation::new(&scene).unwrap();
    let (names, rows) = table(include_str!("../../../../tests/data/b01-slider-crank.csv"));
    let column = |row: &[f64], name: &str| row[names.iter().position(|n| *n == name).unwrap()];
    let mut largest = 0.0f64;
    for row in &rows {
        simulation.advance_to(row[0]).unwrap();
        let on_i = simulation.reactions(on(Side::I, MomentReference::JointPoint)).unwrap();
        let on_j = simulation.reactions(on(Side::J, MomentReference::JointPoint)).unwrap();
        let at_block = simulation.reactions(on(Side::J, MomentReference::CenterOfMass)).unwrap();
        assert!(on_i.redundancies.is_empty());
        assert!(on_i.reactions.iter().all(|r| r.force.iter().chain(&r.moment).all(|c| c.unique)));
        let (a, b, c, d) = (of(&on_j, "A"), of(&on_i, "B"), of(&on_i, "C"), of(&at_block, "D"));
        let arm = Vector3::from(["e_x", "e_y", "e_z"].map(|n| column(row, n)));
        let across = Vector3::x().cross(&arm).normalize();
        let found = [
            values(a.force).as_slice(),
            &values(a.moment).as_slice()[1..],
            values(b.force).as_slice(),
            values(c.force).as_slice(),
            &[values(c.moment).dot(&across)],
            &values(d.force).as_slice()[1..],
            values(d.moment).as_slice(),
        ]
        .concat();
        let expected = [
            "FAx[N]",
            "FAy[N]",
            "FAz[N]",
            "MAy[Nm]",
            "MAz[Nm]",
            "FBx[N]",
            "FBy[N]",
            "FBz[N]",
            "FCx[N]",
            "FCy[N]",
            "FCz[N]",
            "mu_universal[Nm]",
            "FDy[N]",
            "FDz[N]",
            "MDx[Nm]",
            "MDy[Nm]",
            "MDz[Nm]",
        ];
        assert_eq!(found.len(), expected.len());
        let scale = expected.iter().fold(0.0f64, |a, n| a.max(column(row, n).abs()));
        for (value, name) in found.iter().zip(expected) {
            let deviation = (value - column(row, name)).abs() / scale;
            largest = largest.max(deviation);
            assert!(deviation < 1e-7, "{name} at {}: {value} {}", row[0], column(row, name));
        }
    }
    println!("17 components at {} times, largest deviation {largest:.1e}", rows.len());
}

/// Newton and Euler for every body of random scenes, with reactions on both sides, in every frame.
#[test]
fn every_body_is_in_equilibrium_with_its_reactions() {
    for (seed, bodies) in (0..6).zip([2, 4, 5].into_iter().cycle()) {
        let scene = random_scene(seed, bodies, |body| if body % 2 == 0 { "full" } else { "reduced" });
        let simulation = Simulation::new(&scene).unwrap();
        let acceleration = simulation.accelerations();
        let frame = simulation.frame();
        let mut force = vec![Vector3::zeros(); bodies];
        let mut moment = vec![Vector3::zeros(); bodies];
        for expressed_in in [ExpressedIn::World, ExpressedIn::Joint, ExpressedIn::Body] {
            for side in [Side::I, Side::J] {
                let convention = Convention { on: side, about: MomentReference::CenterOfMass, expressed_in };
                for reaction in simulation.reactions(convention).unwrap().reactions {
                    let Some(body) = scene.bodies.iter().position(|b| b.name == reaction.on) else {
                        continue;
                    };
                    let turn = |v: [ReactionComponent; 3]| {
                        (0..3).map(|k| Vector3::from(reaction.axes[k]) * v[k].value).sum::<Vector3<f64>>()
                    };
                    force[body] += turn(reaction.force) / 3.0;
                    moment[body] += turn(reaction.moment) / 3.0;
                }
            }
        }
        let system = simulation.system();
        for (index, body) in system.bodies.iter().enumerate() {
            let second =
                |k: usize| Vector3::from_column_slice(&acceleration[body.layout.first + 3 * k..][..3]);
            let e = [frame.bodies[index].u, frame.bodies[index].v, frame.bodies[index].w].map(Vector3::from);
            let omega = Vector3::from(frame.bodies[index].angular_velocity);
            let turned = |k: usize| second(k + 1) - omega.cross(&omega.cross(&e[k]));
            let (a, b) = (turned(0), turned(1));
            let c = a.cross(&e[1]) + e[0].cross(&b);
            let alpha = (e[0].cross(&a) + e[1].cross(&b) + e[2].cross(&c)) * 0.5;
            let inertia = |x: Vector3<f64>| {
                (0..3).map(|k| e[k] * (body.principal[k] * e[k].dot(&x))).sum::<Vector3<f64>>()
            };
            let newton = second(0) * body.mass - force[index] - system.model.gravity * body.mass;
            let euler = inertia(alpha) + omega.cross(&inertia(omega)) - moment[index];
            assert!(newton.amax() < 1e-9 && euler.amax() < 1e-9, "seed {seed}: {newton} {euler}");
        }
    }
}

/// The two sides of a joint are opposite about one point, the ground's side included.
#[test]
fn action_is_opposite_to_reaction() {
    for name in ["bricard", "spatial-slider-crank", "spatial-double-pendulum"] {
        let mut simulation = Simulation::new(&catalogue::scene(name).unwrap()).unwrap();
        simulation.advance_to(0.3).unwrap();
        let about = MomentReference::WorldPoint([0.3, -0.2, 0.7]);
        let [i, j] = [Side::I, Side::J].map(|side| simulation.reactions(on(side, about)).unwrap());
        for (a, b) in i.reactions.iter().zip(&j.reactions) {
            assert_eq!((&a.on, &a.by), (&b.by, &b.on));
            assert!((values(a.force) + values(b.force)).amax() < 1e-10);
            assert!((values(a.moment) + values(b.moment)).amax() < 1e-10);
            assert!(values(a.force).norm() > 1e-6, "{name}: {} carries nothing", a.joint);
        }
    }
}

/// A door of 20 kg on two hinges of one axis, 1.2 m apart, opening slowly.
fn door() -> Scene {
    Scene::from_json(
        r#"{"name": "door", "bodies": [{"name": "leaf", "mass": 20, "inertia": {"principal": [5, 1.2, 6]},
            "position": [0.4, 0, 1], "angular_velocity": [0, 0, 0.5], "velocity": [0, 0.2, 0]}],
           "joints": [
            {"name": "upper", "type": "revolute", "body_i": "ground", "body_j": "leaf", "point": [0, 0, 1.6], "axis": [0, 0, 1]},
            {"name": "lower", "type": "revolute", "body_i": "ground", "body_j": "leaf", "point": [0, 0, 0.4], "axis": [0, 0, 1]}]}"#,
    )
    .unwrap()
}

#[test]
fn a_door_on_two_hinges_has_a_resultant_but_no_split() {
    let simulation = Simulation::new(&door()).unwrap();
    let report = simulation.reactions(on(Side::J, MomentReference::WorldPoint([0.0, 0.0, 1.0]))).unwrap();
    assert_eq!(report.redundancies.len(), 1);
    assert_eq!((report.redundancies[0].rows, report.redundancies[0].joints.len()), (5, 2));
    for hinge in &report.reactions {
        assert!(hinge.force.iter().all(|c| !c.unique));
        assert_eq!(hinge.moment.map(|c| c.unique), [false, false, true]);
    }
    // The leaf's centre of mass circles at 0.4 m: its resultant is known.
    let total = |of: fn(&Reaction) -> [ReactionComponent; 3]| {
        report.reactions.iter().map(|r| values(of(r))).sum::<Vector3<f64>>()
    };
    let (force, moment) = (total(|r| r.force), total(|r| r.moment));
    assert!((force - Vector3::new(-20.0 * 0.25 * 0.4, 0.0, 20.0 * 9.81)).amax() < 1e-9, "{force}");
    assert!((moment - Vector3::new(0.0, 0.4 * 20.0 * -9.81, 0.0)).amax() < 1e-9, "{moment}");
    // Symmetric hinges share the weight equally in the answer of least norm.
    let [upper, lower] = [0, 1].map(|k| report.reactions[k].force[2].value);
    assert!((upper - lower).abs() < 1e-9 && (upper - 98.1).abs() < 1e-9, "{upper} {lower}");
    apply_remedies(&door());
}

/// Changes the joints as told; then nothing is redundant, everything is unique, and no freedom is gained.
fn apply_remedies(scene: &Scene) {
    let simulation = Simulation::new(scene).unwrap();
    let report = simulation.reactions(Convention::default()).unwrap();
    let mut changed = scene.clone();
    for remedy in report.redundancies.iter().flat_map(|r| &r.remedies) {
        let joint = changed.joints.iter_mut().find(|j| j.name == remedy.joint).unwrap();
        let bare = Joint::new(&joint.name, remedy.becomes, &joint.body_i, &joint.body_j);
        let axis = joint.axis.filter(|_| remedy.becomes != JointKind::Spherical);
        *joint = Joint { point: joint.point, axis, ..bare };
        println!(
            "{}: {} becomes {:?}, giving up {}",
            scene.name, remedy.joint, remedy.becomes, remedy.gives_up
        );
    }
    assert_ne!(&changed, scene);
    let simulation = Simulation::new(&changed).unwrap();
    let after = simulation.reactions(Convention::default()).unwrap();
    assert!(after.redundancies.is_empty(), "{:?}", after.redundancies);
    assert!(after.reactions.iter().all(|r| r.force.iter().chain(&r.moment).all(|c| c.unique)));
    assert_eq!(check(scene).unwrap().degrees_of_freedom, check(&changed).unwrap().degrees_of_freedom);
}

#[test]
fn the_bricard_loop_shares_one_row_among_all_joints() {
    let scene = catalogue::scene("bricard").unwrap();
    let mut simulation = Simulation::new(&scene).unwrap();
    for time in [0.0, 0.7, 1.9] {
        simulation.advance_to(time).unwrap();
        let report = simulation.reactions(Convention::default()).unwrap();
        assert_eq!(report.redundancies.len(), 1);
        assert_eq!((report.redundancies[0].rows, report.redundancies[0].joints.len()), (1, 6));
        assert_eq!(report.redundancies[0].remedies.len(), 1);
    }
    apply_remedies(&scene);
    apply_remedies(&catalogue::scene("n-four-bar:1").unwrap());
}

/// Rows that depend on others do so where the joints are closed. Between steps they are open by as much as the tolerance allows, which
/// is nothing that a reaction could be determined by.
#[test]
fn what_is_unique_does_not_change_with_the_tolerance_nor_along_the_motion() {
    let flags = |report: &ReactionReport| -> Vec<bool> {
        report.reactions.iter().flat_map(|r| r.force.iter().chain(&r.moment)).map(|c| c.unique).collect()
    };
    for (scene, frame) in [
        (catalogue::scene("bricard").unwrap(), ExpressedIn::Joint),
        (catalogue::scene("bricard").unwrap(), ExpressedIn::Body),
        (problem("sarrus/passages"), ExpressedIn::Joint),
    ] {
        let convention = Convention { expressed_in: frame, ..Convention::default() };
        let expected = flags(&Simulation::new(&scene).unwrap().reactions(convention).unwrap());
        for tolerance in [1e-3, 1e-4, 1e-6] {
            let mut scene = scene.clone();
            scene.simulation.tolerance = tolerance;
            let mut run = Simulation::new(&scene).unwrap();
            let mut other = Vec::new();
            for k in 1..=60 {
                run.advance_to(f64::from(k) / 61.3 * run.duration()).unwrap();
                if flags(&run.reactions(convention).unwrap()) != expected {
                    other.push(k);
                }
            }
            println!("{} at {tolerance:.0e}: other {other:?}", scene.name);
            assert!(other.is_empty(), "{} at {tolerance:.0e}: {other:?}", scene.name);
        }
    }
}

/// The null space of the solver's rows tells the same as that of all rows of Φ_q, rigid-body rows included.
#[test]
fn all_rows_and_the_solver_rows_mark_the_same() {
    for (mut scene, common_vectors) in [
        (door(), 2),
        (catalogue::scene("bricard").unwrap(), 6),
        (catalogue::scene("n-four-bar:1").unwrap(), 4),
    ] {
        for joint in &mut scene.joints {
            joint.rows = Some(AxisRows::Cv);
        }
        let simulation = Simulation::new(&scene).unwrap();
        let report = simulation.reactions(on(Side::J, MomentReference::WorldPoint([0.0; 3]))).unwrap();
        let (system, ..) = start(&scene);
        let at = State::at(&system, 0.0, simulation.q(), simulation.q_dot());
        let jacobian = AugmentedSystem::new(&system, &at).jacobian;
        let null = left_null_space(&jacobian, 1e-9);
        assert!(jacobian.tr_mul(&null).amax() < 1e-13);
        let redundant: usize = report.redundancies.iter().map(|r| r.rows).sum();
        assert_eq!(null.ncols(), redundant + common_vectors, "{}", scene.name);
        for (constraint, reaction) in system.constraints.iter().zip(&report.reactions) {
            let BodyRef::Moving(body) = constraint.bodies[1] else { continue };
            let (first, state) = (system.bodies[body].layout.first, &at.bodies()[body]);
            let mut changes = [0.0f64; 6];
            for k in 0..null.ncols() {
                let part = |at: usize| -> f64 {
                    constraint
                        .equations
                        .clone()
                        .map(|e| system.rigid_rows + e)
                        .map(|e| null[(e, k)] * jacobian[(e, first + at)])
                        .sum()
                };
                let p = |at: usize| Vector3::new(part(at), part(at + 1), part(at + 2));
                let moment = (0..3).map(|d| state.q.e[d].cross(&p(3 + 3 * d))).sum::<Vector3<f64>>()
                    + state.q.r.cross(&p(0));
                for c in 0..3 {
                    changes[c] = changes[c].max(p(0)[c].abs());
                    changes[3 + c] = changes[3 + c].max(moment[c].abs());
                }
            }
            let marks: Vec<bool> = reaction.force.iter().chain(&reaction.moment).map(|c| c.unique).collect();
            assert_eq!(
                marks,
                changes.map(|c| c < 1e-8),
                "{} of {}: {changes:?} {reaction:?}",
                reaction.joint,
                scene.name
            );
        }
    }
}

/// Errors are those of the numbers that are told: about a point far away a moment is off by what the force is off there.
#[test]
fn errors_of_reactions_are_those_of_the_convention() {
    let far = 1000.0;
    let run = |tolerance: f64| {
        let scene = json!({
            "name": "far", "bodies": [
                {"name": "a", "mass": 1.3, "inertia": {"principal": [0.02, 0.05, 0.06]}, "center_of_mass": [0.1, 0.02, -0.3],
                    "position": [far, 0, 0], "angular_velocity": [3, 1, 2]},
                {"name": "b", "mass": 0.7, "inertia": {"principal": [0.02, 0.03, 0.04]}, "center_of_mass": [0.1, 0.02, -0.3],
                    "position": [far, 0, -0.6]}],
            "joints": [
                {"name": "s", "type": "spherical", "body_i": "ground", "body_j": "a", "point": [far, 0, 0]},
                {"name": "u", "type": "universal", "body_i": "a", "body_j": "b", "point": [far, 0, -0.6], "axes": [[1, 0, 0], [0, 1, 0]]}],
            "simulation": {"duration": 2.5, "tolerance": tolerance}
        });
        let mut run = Simulation::new(&Scene::from_json(&scene.to_string()).unwrap()).unwrap();
        run.advance_to(2.5).unwrap();
        run
    };
    let (rough, exact) = (run(1e-4), run(1e-11));
    for convention in [
        Convention::default(),
        Convention { about: MomentReference::WorldPoint([0.0; 3]), ..Convention::default() },
        Convention { about: MomentReference::CenterOfMass, ..Convention::default() },
        Convention { expressed_in: ExpressedIn::Body, ..Convention::default() },
    ] {
        let [told, right] = [&rough, &exact].map(|run| run.reactions(convention).unwrap());
        let (a, b) = (&told.reactions, &right.reactions);
        let off = |of: fn(&Reaction) -> [ReactionComponent; 3]| {
            let apart = |(a, b): (&Reaction, &Reaction)| {
                Vector3::from_fn(|k, _| of(a)[k].value - of(b)[k].value).norm()
            };
            a.iter().zip(b).map(apart).fold(0.0, f64::max)
        };
        let told = rough.reaction_errors_as_told(&told, convention).unwrap().unwrap();
        for (off, told) in [(off(|r| r.force), told.force), (off(|r| r.moment), told.moment)] {
            assert!(off < 3.0 * told && told < 5.0 * off, "{convention:?}: {off:e}, told {told:e}");
        }
    }
}

/// Where the equations leave reactions open, the smallest are shown: the same however the scene is turned, and nothing across a plane.
#[test]
fn the_smallest_reactions_do_not_depend_on_how_a_scene_lies_in_the_world() {
    let turned = |angle: f64| {
        let turn = nalgebra::Rotation3::from_axis_angle(&Vector3::x_axis(), angle);
        let at = |x: f64, y: f64, z: f64| -> [f64; 3] { (turn * Vector3::new(x, y, z)).into() };
        let rod = |name: &str, from: [f64; 2], to: [f64; 2]| {
            json!({"name": name, "mass": 1.2, "inertia": {"principal": [0.02, 0.1, 0.11]},
                "position": at(0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1]), 0.0),
                "orientation": {"axis": [1, 0, 0], "angle": angle}})
        };
        let points = [[0.0, 0.0], [0.3, 1.0], [2.1, 1.6], [2.5, 0.0]];
        let hinge = |name: &str, i: &str, j: &str, [x, y]: [f64; 2]| json!({"name": name, "type": "revolute", "body_i": i, "body_j": j, "point": at(x, y, 0.0), "axis": at(0.0, 0.0, 1.0)});
        let scene = json!({
            "name": "turned", "gravity": at(0.0, -9.81, 0.0),
            "bodies": [rod("a", points[0], points[1]), rod("b", points[1], points[2]), rod("c", points[2], points[3])],
            "joints": [hinge("A", "ground", "a", points[0]), hinge("B", "a", "b", points[1]),
                hinge("C", "b", "c", points[2]), hinge("D", "c", "ground", points[3])]
        });
        let run = Simulation::new(&Scene::from_json(&scene.to_string()).unwrap()).unwrap();
        run.reactions(Convention { expressed_in: ExpressedIn::Joint, ..Convention::default() }).unwrap()
    };
    for angle in [0.0, 0.5, 1.3, 2.9] {
        for reaction in turned(angle).reactions {
            // x is the axis of the hinge, across the plane.
            let [axial, ..] = reaction.force.map(|component| component.value);
            let [_, y, z] = reaction.moment.map(|component| component.value);
            assert!(axial.abs() < 1e-9 && y.abs() < 1e-9 && z.abs() < 1e-9, "{angle}: {reaction:?}");
        }
    }
}
