//! Chosen outputs are what the other questions to a run answer, and choosing them changes no motion.

#![allow(clippy::panic, reason = "tests may panic, and write numbers as they were computed elsewhere")]
#![allow(clippy::unwrap_used)] // a test that cannot go on says so

use serde_json::json;
use triad_engine::prelude::*;
use triad_engine::run::{Moment, Outputs, RowWriter};
use triad_engine::scene::{Output, OutputKind, OutputTimes};

/// The numbers of the current state by the names of their columns.
fn row(run: &Simulation) -> impl Fn(&str) -> f64 + use<> {
    let outputs = Outputs::new(run);
    let mut numbers = Vec::new();
    outputs.write(run, &mut numbers);
    assert_eq!(numbers.len(), outputs.columns().len());
    let names: Vec<String> = outputs.columns().iter().map(|column| column.name.clone()).collect();
    let mut sorted = names.clone();
    sorted.sort();
    sorted.dedup();
    assert_eq!(sorted.len(), names.len(), "each name once: {names:?}");
    move |name| {
        numbers[names.iter().position(|known| known == name).unwrap_or_else(|| panic!("{name}: {names:?}"))]
    }
}

fn all() -> Vec<Output> {
    OutputKind::ALL.map(Output::from).to_vec()
}

/// A motor turns a crank against a damper; a slider hangs on a spring at its tip.
fn machine() -> Scene {
    let mut scene = Scene::new("machine").gravity([0.0, -9.81, 0.0]).duration(3.0);
    let crank = scene.add(Body::rod("crank", 2.0, [0.0; 3], [0.5, 0.0, 0.0]));
    let block =
        scene.add(Body::new("block", 1.0).inertia(Inertia::Principal([0.1; 3])).position([2.0, 0.0, 0.0]));
    let pin = scene.add(Joint::revolute("pin", Ground, &crank).at([0.0; 3]).about([0.0, 0.0, 1.0]));
    let rail = scene.add(Joint::prismatic("rail", Ground, &block).at([2.0, 0.0, 0.0]).about([1.0, 0.0, 0.0]));
    scene.add(Driver::angle("motor", &pin, Motion::ramp(0.0, 7.0)));
    scene.add(Load::torsion("damper", &pin, 0.0, 3.0));
    scene.add(Load::slider("buffer", &rail, 20.0, 0.5));
    scene.add(
        Load::spring("spring", (&crank, [0.25, 0.0, 0.0]), (&block, [0.0; 3]), 50.0, 1.0).free_length(1.5),
    );
    scene.add(Marker::new("tip", &crank, [0.25, 0.0, 0.0]));
    scene.simulation.outputs = all();
    scene
}

fn near(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-9 * (1.0 + a.abs().max(b.abs())), "{a} {b}");
}

#[test]
fn angles_loads_drivers_and_markers_are_those_of_the_mechanism() {
    let mut run = Simulation::new(&machine()).unwrap();
    // More than a turn passes between two looks.
    for time in [0.0, 1.3, 2.9] {
        run.advance_to(time).unwrap();
        let at = row(&run);
        near(at("pin.angle"), 7.0 * time);
        near(at("pin.angle_rate"), 7.0);
        near(at("motor.angle"), 7.0 * time);
        near(at("rail.slide"), at("block.rx") - 2.0);
        near(at("rail.slide_rate"), at("block.v_rx"));
        near(at("buffer.force"), -20.0 * at("rail.slide") - 0.5 * at("rail.slide_rate"));
        near(at("damper.torque"), -3.0 * 7.0);
        near(at("damper.power"), -3.0 * 49.0);
        near(at("tip.px"), 0.5 * libm::cos(7.0 * time));
        near(at("tip.v_py"), 3.5 * libm::cos(7.0 * time));
        let length = libm::hypot(at("block.rx") - at("tip.px"), at("tip.py"));
        near(at("spring.length"), length);
        near(at("spring.force"), -50.0 * (length - 1.5) - at("spring.length_rate"));
        near(at("motor.power"), at("motor.torque") * 7.0);
        // The motor holds against the damper, the weight and the spring: moments about the pin.
        let pull = -at("spring.force") / length;
        let spring =
            pull * (at("tip.px") * (0.0 - at("tip.py")) - at("tip.py") * (at("block.rx") - at("tip.px")));
        near(at("motor.torque"), 21.0 + 2.0 * 9.81 * at("crank.rx") - spring);
        near(at("crank.px"), at("crank.rx"));
        near(at("crank.x_y"), libm::sin(7.0 * time));
        near(at("crank.a_rx"), -49.0 * at("crank.rx"));
        near(
            at("block.a_rx"),
            at("buffer.force") + at("spring.force") * (at("block.rx") - at("tip.px")) / length,
        );
        near(at("energy"), at("kinetic_energy") + at("potential_energy"));
        assert!(at("energy_drift").abs() < 1e-6, "{}", at("energy_drift"));
    }
}

#[test]
fn the_choice_of_outputs_changes_no_bit_of_the_motion_and_rows_repeat_no_solution() {
    for name in ["n-four-bar:2", "spatial-slider-crank", "bricard"] {
        let mut scene = catalogue::scene(name).unwrap();
        let mut plain = Simulation::new(&scene).unwrap();
        scene.simulation.outputs = all();
        let mut chosen = Simulation::new(&scene).unwrap();
        let outputs = Outputs::new(&chosen);
        for step in 1..20 {
            let time = 0.1 * f64::from(step);
            plain.advance_to(time).unwrap();
            chosen.advance_to(time).unwrap();
            let mut numbers = Vec::new();
            outputs.write(&chosen, &mut numbers);
            assert_eq!((plain.q(), plain.q_dot()), (chosen.q(), chosen.q_dot()), "{name}");
            // The solver that is used again finds what a new one finds.
            assert_eq!(chosen.multipliers(), chosen.clone().multipliers(), "{name}");
        }
    }
}

/// Of a machine with a load, a driver and turns, by a series and by a method with a second solution.
#[test]
fn a_row_is_the_same_whenever_it_is_written() {
    let mut scenes = vec![machine()];
    for name in ["n-four-bar:2", "spatial-slider-crank:mbdyn", "spatial-double-pendulum"] {
        scenes.push(catalogue::scene(name).unwrap());
    }
    for scene in &mut scenes {
        scene.simulation.outputs = all();
        for integrator in [IntegratorKind::Taylor, IntegratorKind::Dop853] {
            scene.simulation.integrator = integrator;
            let mut run = Simulation::new(scene).unwrap();
            let outputs = Outputs::new(&run);
            let mut writer = RowWriter::new(&run, &outputs);
            let (mut kept, mut used) = (Vec::new(), Moment::default());
            for step in 0..30 {
                run.advance_to(0.07 * f64::from(step)).unwrap();
                // Before anything has looked at the state, and where another moment was kept.
                outputs.keep(&run, &mut used);
                let mut row = Vec::new();
                outputs.write(&run, &mut row);
                kept.push((used.clone(), row));
            }
            for (moment, now) in kept.iter().rev() {
                let mut later = Vec::new();
                writer.write(moment, &mut later);
                let bits = |row: &[f64]| row.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
                assert_eq!(bits(now), bits(&later), "{} {integrator} at {} s", scene.name, moment.time());
            }
        }
    }
}

#[test]
fn one_element_is_chosen_by_its_name() {
    let mut scene = machine();
    scene.simulation.outputs =
        ["reactions:pin", "loads:spring", "bodies:block"].map(|word| word.parse().unwrap()).to_vec();
    let outputs = Outputs::new(&Simulation::new(&scene).unwrap());
    let elements: Vec<&str> = outputs.columns().iter().filter_map(|c| c.name.split('.').next()).collect();
    assert_eq!((elements.len(), elements[0], elements[6], elements[10]), (28, "pin", "spring", "block"));
    scene.simulation.outputs = vec!["reactions:pim".parse().unwrap()];
    let error = Simulation::new(&scene).unwrap_err();
    assert_eq!((error.code(), error.pointer().as_deref()), ("output-invalid", Some("/simulation/outputs/0")));
    assert_eq!(error.hint(), "Did you mean \"pin\"?", "{error}");
}

/// The columns cannot mark which reactions the equations leave open: what stands before them says that some are.
#[test]
fn a_table_says_where_reactions_are_not_all_unique() {
    let tells = |name: &str, outputs: &[&str]| {
        let mut scene = catalogue::scene(name).unwrap();
        scene.simulation.outputs = outputs.iter().map(|word| word.parse().unwrap()).collect();
        let run = Simulation::new(&scene).unwrap();
        Outputs::new(&run).conventions().iter().any(|sentence| sentence.contains("not all unique"))
    };
    assert!(tells("n-four-bar:2", &["bodies", "reactions:B1"]));
    assert!(!tells("n-four-bar:2", &["bodies"]), "no reactions");
    assert!(!tells("simple-pendulum", &["reactions"]), "all are unique");
}

#[test]
fn rounding_neither_doubles_the_last_time_nor_leaves_it_out() {
    for parts in 1..=60_u32 {
        for end in [0.1, 0.3, 0.7, 0.9, 1.0, 2.1, 10.0] {
            let every = end / f64::from(parts);
            // As it is computed, and as an author writes it.
            let written: f64 = format!("{every:.12}").parse().unwrap();
            for every in [every, written] {
                let times = OutputTimes::new(every, end);
                assert_eq!(times.intervals(), f64::from(parts), "{end} {every}");
                let all: Vec<f64> =
                    (0..=usize::try_from(parts).unwrap()).map(|index| times.at(index)).collect();
                assert_eq!((all[0], all.last()), (0.0, Some(&end)), "{end} {every}");
                assert!(all.windows(2).all(|two| two[1] - two[0] > 0.9 * every), "{all:?}");
                // Whoever goes from one to the next meets the same.
                for two in all.windows(2) {
                    assert_eq!(
                        (times.after(two[0]), times.reached(two[1])),
                        (two[1], two[1]),
                        "{end} {every}"
                    );
                }
            }
        }
    }
    let shorter = OutputTimes::new(0.4, 0.9);
    assert_eq!([0, 1, 2, 3].map(|index| shorter.at(index)), [0.0, 0.4, 0.8, 0.9]);
    assert_eq!((shorter.reached(0.7), shorter.after(0.8)), (0.4, 0.9));
    // Longer than the run, and no interval at all, which is refused elsewhere.
    assert_eq!([0, 1, 2].map(|index| OutputTimes::new(1e9, 1.0).at(index)), [0.0, 1.0, 1.0]);
    assert_eq!(OutputTimes::new(0.0, 1.0).intervals(), 1.0);
}

/// A marker far from its body's centre of mass moves farther than that: its error counts.
#[test]
fn the_error_of_a_marker_far_out_is_told() {
    let scene = |tolerance: f64, marked: bool| {
        let markers =
            if marked { json!([{"name": "tip", "body": "A", "point": [0, 20, 5]}]) } else { json!([]) };
        let scene = json!({
            "name": "flag", "bodies": [{"name": "A", "mass": 2, "inertia": {"principal": [0.1, 0.2, 0.25]},
                "center_of_mass": [0.05, 0, 0], "angular_velocity": [1, 4, 2]}],
            "joints": [{"name": "ball", "type": "spherical", "body_i": "ground", "body_j": "A", "point": [0, 0, 0]}],
            "markers": markers, "simulation": {"duration": 2, "tolerance": tolerance}
        });
        let mut run = Simulation::new(&Scene::from_json(&scene.to_string()).unwrap()).unwrap();
        run.advance_to(2.0).unwrap();
        run
    };
    let (rough, exact) = (scene(1e-4, true), scene(1e-12, true));
    let [a, b] = [&rough, &exact].map(|run| run.frame().markers[0].position);
    let off = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
    let told = rough.error_estimate().unwrap().position;
    let of_center = scene(1e-4, false).error_estimate().unwrap().position;
    assert!(
        off < 3.0 * told && told < 3.0 * off && told > 20.0 * of_center,
        "{off:e}, {told:e}, {of_center:e}"
    );
}

/// A marker that has the name of its body, and a load that has that of its joint, have columns of their own.
#[test]
fn columns_of_elements_with_one_name_are_told_apart() {
    let scene = json!({
        "name": "names", "bodies": [{"name": "a", "mass": 1, "inertia": {"principal": [0.1, 0.1, 0.1]}}],
        "joints": [{"name": "rail", "type": "prismatic", "body_i": "ground", "body_j": "a", "point": [0, 0, 0], "axis": [1, 0, 0]}],
        "loads": [{"name": "rail", "type": "slider", "joint": "rail", "stiffness": 3}],
        "markers": [{"name": "a", "body": "a", "point": [0, 1, 0]}],
        "simulation": {"outputs": ["frames", "joints", "loads", "markers"]}
    });
    let outputs = |words: &[&str]| -> Vec<String> {
        let mut scene = Scene::from_json(&scene.to_string()).unwrap();
        scene.simulation.outputs = words.iter().map(|word| word.parse().unwrap()).collect();
        let outputs = Outputs::new(&Simulation::new(&scene).unwrap());
        outputs.columns().iter().map(|column| column.name.clone()).collect()
    };
    let all = outputs(&["frames", "joints", "loads", "markers"]);
    let mut apart = all.clone();
    apart.sort();
    apart.dedup();
    assert_eq!(apart.len(), all.len(), "{all:?}");
    for name in ["a.px", "marker:a.px", "rail.slide", "load:rail.slide"] {
        assert!(all.iter().any(|column| column == name), "{all:?}");
    }
    assert_eq!(outputs(&["markers"])[0], "a.px", "alone they keep their name");
}
