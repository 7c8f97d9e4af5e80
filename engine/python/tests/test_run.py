"""Runs against closed forms, and against the numbers of the command line."""

import json
import xml.etree.ElementTree

import numpy as np
import pytest

import triad

G = 9.81


def table(text):
    """The names of the columns and the numbers of a CSV of the program."""
    lines = [line for line in text.splitlines() if line and not line.startswith("#")]
    return lines[0].split(","), np.array([[float(x) for x in line.split(",")] for line in lines[2:]])


def test_a_pendulum_keeps_its_energy_and_its_rod_pulls_with_three_times_the_weight():
    r = triad.run("simple-pendulum", until=3, every=0.01)
    bob = r.body("bob")
    depth = -bob.position[:, 1]
    assert np.allclose(np.linalg.norm(bob.position, axis=1), 1.0, atol=1e-9)
    assert np.allclose((bob.velocity**2).sum(axis=1), 2 * G * depth, atol=1e-7)
    pull = r.reactions("pin")
    assert np.allclose(np.linalg.norm(pull.force, axis=1), 3 * G * depth, atol=1e-6)
    assert pull.unique and pull.on == "bob" and pull.by == "ground"
    assert np.ptp(r.energy) < 1e-7
    assert 0 < r.errors.position.max() < 1e-6
    assert 0 < pull.force_error.max() < 1e-4


def test_a_thrown_body_falls_on_a_parabola():
    r = triad.run("free-fall", until=1.0, every=0.1)
    body = r.body(r.bodies[0])
    t = r.t[:, None]
    g = np.array(r.scene["gravity"])
    assert np.allclose(body.position, body.position[0] + body.velocity[0] * t + 0.5 * g * t**2, atol=1e-12)
    turned = np.einsum("nij,nkj->nik", body.directors, body.directors)
    assert np.allclose(turned, np.eye(3), atol=1e-12)


@pytest.mark.parametrize(
    "scene, words, options",
    [
        ("n-four-bar:2", [], {}),
        ("spatial-slider-crank", ["--integrator", "dop853", "--tolerance", "1e-6"], {"integrator": "dop853", "tolerance": 1e-6}),
        ("bricard", ["--coordinates", "reduced"], {"coordinates": "reduced"}),
        ("governor", ["--no-estimate", "--outputs", "joints,loads,drivers"], {"estimate": False, "outputs": ["joints", "loads", "drivers"]}),
        ("simple-pendulum", ["--step", "0.01", "--integrator", "dopri5"], {"step": 0.01, "integrator": "dopri5"}),
        ("free-body", ["--treatment", "baumgarte", "--no-skip", "all"], {"treatment": "baumgarte", "no_skip": ["all"]}),
    ],
)
def test_numbers_are_those_of_the_command_line_to_the_last_bit(program, scene, words, options):
    names, numbers = table(program("run", scene, "--until", "0.5", "--every", "0.05", "--out", "-", *words))
    r = triad.run(scene, until=0.5, every=0.05, **options)
    assert np.array_equal(r.t, numbers[:, 0])
    assert names[1 : 1 + len(r.columns)] == r.columns[: len(names) - 1]
    assert np.array_equal(r.table[:, : len(names) - 1], numbers[:, 1:], equal_nan=True)


def test_the_body_arrays_are_the_columns_of_the_table_and_are_not_copied():
    r = triad.run("n-four-bar:2", until=0.2, every=0.05)
    name = r.bodies[1]
    assert np.array_equal(r.body(name).position[:, 0], r[f"{name}.rx"])
    assert np.array_equal(r.body(name).directors[:, 0, 1], r[f"{name}.uy"])
    assert np.shares_memory(r.body(name).velocity, r.velocity)
    assert r.body(name).point(0, 0, 0.5) == pytest.approx(r.body(name).position + 0.5 * r.body(name).directors[:, 2])
    assert r.q.flags["C_CONTIGUOUS"] and r.q.shape == (5, len(r.coordinates))


def test_reactions_follow_sides_points_and_frames():
    r = triad.run("spatial-slider-crank", until=0.3, every=0.1)
    joint = next(name for name in r.joints if not {"ground"} & {r.reactions(name).on, r.reactions(name).by})
    one, other = r.reactions(joint), r.reactions(joint, side="i")
    assert (one.on, one.by) == (other.by, other.on)
    assert np.allclose(one.force, -other.force, atol=1e-9)
    along = r.reactions(joint, frame="body")
    assert np.allclose(np.einsum("nk,nkx->nx", along.force, along.axes), one.force, atol=1e-9)
    moved = r.reactions(joint, point=[1.0, 2.0, 3.0])
    arm = one.point_at - np.array([1.0, 2.0, 3.0])
    assert np.allclose(moved.moment, one.moment + np.cross(arm, one.force), atol=1e-9)
    assert np.array_equal(moved.point_at, np.tile([1.0, 2.0, 3.0], (4, 1)))
    assert np.allclose(r.reactions(joint, point="origin").moment, one.moment + np.cross(one.point_at, one.force), atol=1e-9)


def test_reactions_of_redundant_joints_say_so():
    r = triad.run("bricard", until=0.1, every=0.05)
    found = [r.reactions(joint) for joint in r.joints]
    assert not any(reaction.unique for reaction in found)
    assert found[0].redundancies and found[0].redundancies[0]["remedies"]


def test_multipliers_belong_to_rows_and_give_the_accelerations():
    r = triad.run("simple-pendulum", until=0.5, every=0.1)
    assert r.multipliers.shape == (6, len(r.rows)) and r.rows[0][0] == "pin"
    system = triad.System("simple-pendulum")
    for k in range(len(r)):
        acceleration, multipliers = system.solve(r.q[k], r.v[k], r.t[k])
        assert np.allclose(acceleration, r.accelerations[k], atol=1e-8)
        assert np.allclose(multipliers[system.rigid_rows :], r.multipliers[k], atol=1e-8)
    assert r.violations.max() < 1e-9


def test_scenes_are_names_files_texts_and_dicts(tmp_path):
    scene = triad.scene("simple-pendulum")
    scene["gravity"] = np.array([0.0, -1.62, 0.0])
    moon = triad.run(scene, until=1.0)
    path = tmp_path / "moon.json"
    path.write_text(json.dumps({**scene, "gravity": [0.0, -1.62, 0.0]}))
    for same in (path, str(path), path.read_text()):
        assert np.array_equal(triad.run(same, until=1.0).q, moon.q)
    fallen = 0.5 * (moon.body("bob").velocity[-1] ** 2).sum()
    assert fallen == pytest.approx(-1.62 * moon.body("bob").position[-1, 1], rel=1e-9)
    assert set(triad.scenes()) >= {"bricard", "n-four-bar:N"}
    assert "bodies" in triad.scene_schema()["properties"]


def test_one_output_and_numbers_of_numpy_are_taken():
    r = triad.run("simple-pendulum", until=np.int64(1), every=np.float32(0.5), outputs="energy", most_steps=np.int64(1000))
    assert r.columns == ["energy"] and len(r) == 3


def test_what_is_printed_is_a_line():
    r = triad.run("bricard", until=0.1)
    for thing in (r, r.body(r.bodies[0]), r.reactions(r.joints[0]), r.errors):
        assert "\n" not in repr(thing) and repr(thing).startswith("<triad.")
    assert "not all unique" in repr(r.reactions(r.joints[0]))


def test_verification_compares_with_a_second_solution():
    r = triad.run("simple-pendulum", until=0.5, verify=True)
    assert r.verified["found"]["integrator"] == "dop853" and 0 < r.verified["found"]["position"] < 1e-7
    assert triad.run("simple-pendulum", until=0.1).verified is None


def test_pictures_are_svg_and_move():
    r = triad.run("crank-rocker", until=1.0, every=0.05)
    still, moving = r.svg(moving=False), r._repr_svg_()
    for text in (still, moving):
        assert xml.etree.ElementTree.fromstring(text).tag.endswith("svg")
    assert moving.count("<animate ") > len(r.bodies) > still.count("<animate ")


def test_columns_are_looked_up_as_in_a_dict():
    r = triad.run("simple-pendulum", until=0.1, outputs=["energy", "joints"])
    s = triad.sweep("simple-pendulum", {"mass": triad.grid(1, 2, 3)}, until=0.1, outputs="energy", estimate=False)
    assert list(r) == r.keys() == r.columns and s.keys() == list(s) == ["mass", "energy"]
    for found, rows in ((r, len(r)), (s, 3)):
        assert "energy" in found and "energi" not in found and 0 not in found
        assert all(column.shape == (rows,) for column in dict(found).values())
    assert np.array_equal(dict(r)["pin.angle"], r["pin.angle"])
    with pytest.raises(triad.TriadError, match="there is no column 0"):
        r[0]


def test_tables_become_data_frames():
    r = triad.run("simple-pendulum", until=0.1, every=0.05)
    frame = r.to_pandas()
    assert list(frame.columns) == r.columns and np.array_equal(frame["energy"].to_numpy(), r.energy)


@pytest.mark.parametrize("point", ["joint-point", "origin", "center-of-mass", [10.0, 10.0, 10.0]])
@pytest.mark.parametrize("frame", ["world", "body"])
@pytest.mark.parametrize("side", ["i", "j"])
def test_errors_of_reactions_are_those_of_the_point_and_the_axes_that_were_asked_for(point, frame, side):
    rough, fine = (triad.run("spatial-double-pendulum", until=1.0, every=0.1, tolerance=tolerance) for tolerance in (1e-5, 1e-13))
    for joint in [joint["name"] for joint in rough.scene["joints"]]:
        told, right = (r.reactions(joint, point=point, frame=frame, side=side) for r in (rough, fine))
        assert right.unique
        for name in ("force", "moment"):
            off = np.linalg.norm(getattr(told, name) - getattr(right, name), axis=1)[1:]
            assert (off <= 3 * getattr(told, f"{name}_error")[1:] + 1e-12).all(), (joint, name, off)
