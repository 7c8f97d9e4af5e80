//! Robots described in URDF: a small arm, its loop closed by a side-car, and what is wrong with others.

#![allow(clippy::unwrap_used, clippy::panic)] // a test that cannot go on says so

use serde_json::{Value, json};
use triad_engine::run::{Outputs, Simulation};
use triad_engine::scene::OutputKind;
use triad_tests::program::{Server, assert_problem, run, run_json};
use triad_tests::root;

fn data(name: &str) -> String {
    root().join("tests/data").join(name).display().to_string()
}

/// What an import leaves out: lines, and what they belong to (`of`) or what is missing (`what`).
fn left_out<'a>(told: &'a Value, key: &str) -> Vec<(u64, &'a str)> {
    let items = told["left_out"].as_array().unwrap();
    items.iter().map(|item| (item["line"].as_u64().unwrap(), item[key].as_str().unwrap())).collect()
}

/// What is told of the import of a robot with a side-car, both as text.
fn imported(robot: &str, side_car: &str) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let [urdf, with] = ["r.urdf", "with.json"].map(|name| folder.path().join(name));
    std::fs::write(&urdf, robot).unwrap();
    std::fs::write(&with, side_car).unwrap();
    run_json(&["import", urdf.to_str().unwrap(), "--with", with.to_str().unwrap()]).1
}

#[test]
fn an_arm_becomes_a_scene_that_runs_and_what_is_left_out_is_told_with_its_line() {
    let (code, told) = run_json(&["import", &data("arm.urdf")]);
    assert_eq!(code, 0, "{told:#}");
    let names = |list: &Value| -> Vec<String> {
        list.as_array().unwrap().iter().map(|entry| entry["name"].as_str().unwrap().to_owned()).collect()
    };
    assert_eq!(
        names(&told["scene"]["bodies"]),
        ["upper", "lower"],
        "the base is the ground, the tool a part"
    );
    assert_eq!(names(&told["scene"]["joints"]), ["shoulder", "elbow"]);
    assert_eq!(told["check"]["degrees_of_freedom"], 2);
    let left = left_out(&told, "of");
    assert_eq!(left, [(9, "link upper"), (12, "joint shoulder"), (31, "robot")], "{:#}", told["left_out"]);
    // The elbow stands 1 m above the shoulder, which stands 0.2 m above the ground.
    let lower = &told["scene"]["bodies"][1];
    let at: Vec<f64> = lower["position"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    assert!((at[0]).abs() < 1e-12 && (at[2] - 1.2).abs() < 1e-12, "{at:?}");
    // Friction of the shoulder is a load.
    assert_eq!(told["scene"]["loads"][0]["friction"]["viscous"], 0.5);
}

#[test]
fn a_side_car_turns_joints_and_closes_a_loop_on_a_part_of_a_body() {
    let folder = tempfile::tempdir().unwrap();
    let side = folder.path().join("side.json");
    // Turned by 90°, the upper arm lies along x: the elbow at (1, 0, 0.2), the tool's tip at (1, 0, 1.0).
    let with = json!({
        "positions": {"shoulder": std::f64::consts::FRAC_PI_2, "elbow": -std::f64::consts::FRAC_PI_2},
        "joints": [{"name": "closing", "type": "spherical", "body_i": "tool", "point_i": [0, 0, 0],
            "body_j": "ground", "point_j": [1.0, 0.0, 1.0]}]
    });
    std::fs::write(&side, with.to_string()).unwrap();
    let out = folder.path().join("arm.json");
    let done =
        run(&["import", &data("arm.urdf"), "--with", side.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let scene: Value = serde_json::from_str(&std::fs::read_to_string(&out).unwrap()).unwrap();
    let closing =
        scene["joints"].as_array().unwrap().iter().find(|joint| joint["name"] == "closing").unwrap();
    assert_eq!((&closing["body_i"], &closing["point_i"]), (&json!("lower"), &json!([0.0, 0.0, 0.8])));
    let (code, report) = run_json(&["check", out.to_str().unwrap()]);
    assert_eq!((code, &report["degrees_of_freedom"]), (0, &json!(0)), "{report:#}");
}

/// The last of two positions counted, and nobody was told.
#[test]
fn a_joint_that_a_side_car_gives_twice_is_refused() {
    let arm = std::fs::read_to_string(data("arm.urdf")).unwrap();
    for list in ["positions", "velocities"] {
        let told = imported(&arm, &format!(r#"{{"{list}": {{"elbow": 1, "shoulder": 2, "elbow": 1}}}}"#));
        let detail = told["detail"].as_str().unwrap();
        assert!(detail.contains("duplicate field `elbow` at line 1"), "{told:#}");
        let told = imported(&arm, &format!(r#"{{"{list}": {{"elbow": 1, "shoulder": 2}}}}"#));
        assert!(told["scene"].is_object(), "{told:#}");
    }
}

#[test]
fn what_is_wrong_is_named_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(folder.path());
    let arm = std::fs::read_to_string(data("arm.urdf")).unwrap();
    let import = |urdf: String, with: Value| {
        let reply = server.post("/api/v1/import/urdf", &json!({ "urdf": urdf, "with": with }));
        (reply.status, reply.json())
    };
    let (status, good) = import(arm.clone(), json!({}));
    assert_eq!(status, 200, "{good:#}");
    let many = (0..200).map(|k| format!(" a{k}=\"1\"")).collect::<Vec<_>>().concat();
    let ruler = format!("<!-- {} -->\n<robot", "=".repeat(300));
    assert_eq!(import(arm.replacen("<robot", &ruler, 1), json!({})).0, 200);
    let cases = [
        (arm.replacen("<mass", &format!("<mass{many}"), 1), "not-a-robot", "line=6"),
        (arm.replace("<mass value=\"2\"/>", "<mass value=\"heavy\"/>"), "not-a-robot", "line=6"),
        (arm.replace("type=\"continuous\"", "type=\"spherical\""), "not-a-robot", "line=17"),
        (arm.replace("</robot>", ""), "not-xml", ""),
        (arm.replace("<child link=\"lower\"/>", "<child link=\"upper\"/>"), "not-a-robot", "line=17"),
        (arm.replace("<mass value=\"1\"/>", "<mass value=\"0\"/>"), "not-a-robot", "line=14"),
        (arm.replace("<mass value=\"2\"/>", "<mass value=\"-2\"/>"), "not-a-robot", "line=6"),
        (
            arm.replace("<mass value=\"2\"/>", "<mass value=\"2\"/><mass value=\"3\"/>"),
            "not-a-robot",
            "line=6",
        ),
        (arm.replacen("izz=", "izx=", 1), "not-a-robot", ""),
        (arm.replace("name=\"lower\"", "name=\"upper\""), "not-a-robot", ""),
    ];
    for (urdf, code, place) in cases {
        let (status, problem) = import(urdf, json!({}));
        assert_eq!(status, 422, "{problem:#}");
        assert_problem(&problem, code, place);
    }
    let (_, problem) = import(arm, json!({"positions": {"ellbow": 1.0}}));
    assert_problem(&problem, "unknown-in-side-car", "");
    assert!(problem["hint"].as_str().unwrap().contains("elbow"), "{problem:#}");
    server.stop();
}

#[test]
fn angles_and_displacements_count_from_the_zero_of_the_robot() {
    // What a table says at the start and after a second.
    let told = |urdf: &str, with: Value, column: &str| -> [f64; 2] {
        let imported = triad_urdf::import(urdf, &serde_json::from_value(with).unwrap()).unwrap();
        let mut scene = imported.scene;
        scene.simulation.outputs = vec![OutputKind::Joints.into()];
        let mut run = Simulation::new(&scene).unwrap();
        [0.0, 1.0].map(|time| {
            run.advance_to(time).unwrap();
            let (outputs, mut row) = (Outputs::new(&run), Vec::new());
            outputs.write(&run, &mut row);
            row[outputs.columns().iter().position(|known| known.name == column).unwrap()]
        })
    };
    let near = |[a, b]: [f64; 2], [c, d]: [f64; 2]| assert!((a - c).abs() + (b - d).abs() < 1e-9, "{a} {b}");
    let mimic = std::fs::read_to_string(data("problems/mimic/mimic.urdf")).unwrap();
    let mut with = json!({ "positions": {"lead": 0.3}, "velocities": {"lead": -1.5}, "gravity": [0, 0, 0] });
    near(told(&mimic, with.clone(), "lead.angle"), [0.3, -1.2]);
    near(told(&mimic, with.clone(), "follow.angle"), [1.1, -1.9]);
    // Drivers count likewise.
    let motion = json!({"kind": "ramp", "start": 0.3, "rate": -1.5});
    with["drivers"] = json!([{"name": "motor", "type": "angle", "joint": "lead", "motion": motion}]);
    near(told(&mimic, with, "follow.angle"), [1.1, -1.9]);
    // A slide, which starts 0.2 m from the robot's zero.
    let inertia = "<inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/>";
    let rail = format!(
        "<robot name=\"rail\"><link name=\"base\"/><link name=\"cart\"><inertial><mass value=\"1\"/>{inertia}</inertial></link>\
         <joint name=\"rail\" type=\"prismatic\"><parent link=\"base\"/><child link=\"cart\"/><origin xyz=\"0 0 2\"/>\
         <axis xyz=\"1 0 0\"/></joint></robot>"
    );
    let with = json!({"positions": {"rail": 0.2}, "velocities": {"rail": 0.5}, "gravity": [0, 0, 0]});
    near(told(&rail, with, "rail.slide"), [0.2, 0.7]);
}

#[test]
fn a_joint_that_follows_another_stands_where_multiplier_and_offset_put_it() {
    let folder = tempfile::tempdir().unwrap();
    let side = folder.path().join("side.json");
    let import = |with: Value| {
        std::fs::write(&side, with.to_string()).unwrap();
        run_json(&["import", &data("problems/mimic/mimic.urdf"), "--with", side.to_str().unwrap()])
    };
    // The follower turns about z by 2 · 0.3 + 0.5 rad, and twice as fast.
    let (code, told) = import(json!({"positions": {"lead": 0.3}, "velocities": {"lead": -1.5}}));
    assert_eq!(code, 0, "{told:#}");
    let follower = &told["scene"]["bodies"][1];
    let half: Vec<f64> = follower["orientation"]["quaternion"]
        .as_array()
        .unwrap()
        .iter()
        .map(|part| part.as_f64().unwrap())
        .collect();
    assert!((2.0 * libm::atan2(half[3], half[0]) - 1.1).abs() < 1e-14, "{half:?}");
    assert_eq!(follower["angular_velocity"], json!([0.0, 0.0, -3.0]));
    // Without a word of the side-car the offset remains.
    let (_, told) = import(json!({}));
    let half = &told["scene"]["bodies"][1]["orientation"]["quaternion"];
    assert!((half[3].as_f64().unwrap() - libm::sin(0.25)).abs() < 1e-14, "{half}");
    // What contradicts the leader is refused with both numbers.
    let (code, problem) = import(json!({"positions": {"lead": 0.3, "follow": -2.0}}));
    assert_eq!(code, 3, "{problem:#}");
    let detail = problem["detail"].as_str().unwrap();
    assert!(detail.contains("-2") && detail.contains("1.1") && detail.contains("line 7"), "{detail}");
    let (code, _) = import(json!({"positions": {"lead": 0.3, "follow": 1.1}}));
    assert_eq!(code, 0, "the same number twice is no contradiction");
}

/// A fixed joint has no position, and one number does not place a floating one: what a side-car gives of them is told as left out.
#[test]
fn starts_of_joints_that_one_number_does_not_place_are_told() {
    let robot = r#"<robot name="r">
<link name="base"/>
<link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="b"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="fl" type="floating"><parent link="base"/><child link="a"/></joint>
<joint name="fx" type="fixed"><parent link="a"/><child link="b"/></joint>
</robot>"#;
    let told = imported(robot, r#"{"positions": {"fl": 0.3, "fx": 1}, "velocities": {"fl": 2}}"#);
    let left = left_out(&told, "what");
    let starts: Vec<&str> =
        left.iter().map(|(_, what)| *what).filter(|what| what.contains("at the start")).collect();
    assert_eq!(left.iter().filter(|(line, _)| *line == 5).count(), 2, "{left:?}");
    assert!(starts.len() == 3 && starts[2].contains("a fixed joint has none"), "{starts:?}");
}

#[test]
fn the_inertia_of_a_part_without_mass_is_told_to_be_left_out() {
    let robot = r#"<robot name="r">
<link name="base"/>
<link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="rotor"><inertial><mass value="0"/><inertia ixx="5" iyy="5" izz="5" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="j" type="revolute"><parent link="base"/><child link="a"/><axis xyz="0 1 0"/></joint>
<joint name="k" type="fixed"><parent link="a"/><child link="rotor"/></joint>
</robot>"#;
    let told = imported(robot, "{}");
    assert!(left_out(&told, "what").contains(&(4, "it has no mass: its inertia is left out")), "{told:#}");
}

#[test]
fn attributes_that_mean_nothing_are_told_and_quaternions_turn() {
    let robot = r#"<robot name="r">
<link name="base"/>
<link name="a"><inertial><origin xyz="0.1 0 0" quat_xyzw="0 0 0.6 0.8"/><mass value="1"/>
<inertia ixx="1" iyy="2" izz="2.5" iyx="0.3"/></inertial></link>
<joint name="j" type="revolute"><parent link="base"/><child link="a"/><axis xyz="0 0 1" rpy="0 1 0"/><dynamics damp="3"/></joint>
<link name="f"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>
<joint name="free" type="floating"><parent link="a"/><child link="f"/><dynamics damping="3"/></joint>
</robot>"#;
    let told = imported(robot, "{}");
    let left = left_out(&told, "what");
    for (line, what) in [
        (4, "\"iyx\" of <inertia>"),
        (5, "\"rpy\" of <axis>"),
        (5, "\"damp\" of <dynamics>"),
        (7, "<dynamics>"),
    ] {
        assert!(
            left.iter().any(|(at, said)| *at == line && said.starts_with(what)),
            "{line} {what}: {left:?}"
        );
    }
    // A turn of 2 atan(3/4) about z, of c = 0.28 and s = 0.96.
    let tensor = &told["scene"]["bodies"][0]["inertia"]["tensor"];
    let found: Vec<f64> = [(0, 0), (0, 1), (1, 1)].map(|(i, j)| tensor[i][j].as_f64().unwrap()).into();
    for (found, right) in found.iter().zip([1.0 + 0.96 * 0.96, -0.28 * 0.96, 2.0 - 0.96 * 0.96]) {
        assert!((found - right).abs() < 1e-12, "{tensor}");
    }
}

#[test]
fn loads_and_drivers_act_on_parts_of_bodies() {
    let robot = r#"<robot name="r">
<link name="base"/>
<link name="arm"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>
<link name="tool"/>
<joint name="j" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/></joint>
<joint name="k" type="fixed"><parent link="arm"/><child link="tool"/><origin xyz="0 0 2" rpy="0 0 1.5707963267948966"/></joint>
</robot>"#;
    let side_car = json!({ "loads": [
        { "name": "push", "type": "force", "body": "tool", "point": [0.5, 0, 0.1], "force": [0, 0, 5] },
        { "name": "thrust", "type": "force", "body": "tool", "force": [3, 0, 0], "frame": "body" },
        { "name": "rope", "type": "spring", "body_i": "ground", "point_i": [0, 0, 9], "body_j": "tool", "point_j": [1, 0, 0],
          "stiffness": 10 } ],
        "drivers": [{ "name": "look", "type": "vector", "body": "tool", "vector": [1, 0, 0], "motion": [0, 1, 0] }] });
    let scene = &imported(robot, &side_car.to_string())["scene"];
    let near = |found: &Value, right: [f64; 3]| {
        let off = (0..3).map(|k| (found[k].as_f64().unwrap() - right[k]).abs()).fold(0.0, f64::max);
        assert!(off < 1e-12, "{found} instead of {right:?}");
    };
    assert!(scene["loads"].as_array().unwrap()[..2].iter().all(|load| load["body"] == "arm"), "{scene:#}");
    near(&scene["loads"][0]["point"], [0.0, 0.5, 2.1]);
    near(&scene["loads"][0]["force"]["vector"], [0.0, 0.0, 5.0]);
    near(&scene["loads"][1]["force"]["vector"], [0.0, 3.0, 0.0]);
    near(&scene["loads"][2]["point_j"], [0.0, 1.0, 2.0]);
    near(&scene["drivers"][0]["vector"], [0.0, 1.0, 0.0]);
    assert_eq!((&scene["loads"][2]["body_j"], &scene["drivers"][0]["body"]), (&json!("arm"), &json!("arm")));
}
