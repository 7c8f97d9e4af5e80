"""What is copied, pickled, or comes back from another process."""

import copy
import dataclasses
import inspect
import multiprocessing
import pickle

import numpy as np
import pytest

import triad

MAKERS = {
    "BodyMotion": lambda: triad.run("simple-pendulum", until=0.1).body("bob"),
    "Errors": lambda: triad.run("n-four-bar:2", until=0.2).errors,
    "Reactions": lambda: triad.run("simple-pendulum", until=0.1).reactions("pin"),
    "Run": lambda: triad.run("n-four-bar:2", until=0.2),
    "Sweep": lambda: triad.sweep("simple-pendulum", {"mass": triad.grid(-1, 1, 3)}, until=0.1),
    "System": lambda: triad.System("spatial-slider-crank", coordinates="reduced"),
    "TriadError": lambda: stopped("n-four-bar:2", until=5, most_steps=4),
}
WAYS = {"pickle": lambda thing: pickle.loads(pickle.dumps(thing)), "copy": copy.copy, "deepcopy": copy.deepcopy}


def stopped(scene, **limits):
    """What a run says that comes to no end."""
    with pytest.raises(triad.TriadError) as found:
        triad.run(scene, every=0.1, **limits)
    return found.value


def same(one, other):
    """Whether two values are the same, numbers to the last bit."""
    if isinstance(one, np.ndarray):
        return np.array_equal(one, other, equal_nan=True)
    if dataclasses.is_dataclass(one) or isinstance(one, triad.Run):
        return type(one) is type(other) and same(told(one), told(other))
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(same(part, other[name]) for name, part in one.items())
    return one == other


def told(thing):
    """What an object holds, without its native part."""
    return {name: part for name, part in vars(thing).items() if name not in ("_engine", "_found", "_system")}


def test_each_public_class_is_tried():
    assert {name for name in triad.__all__ if inspect.isclass(getattr(triad, name))} == set(MAKERS)


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("name", MAKERS)
def test_copies_hold_what_was_copied(name, way):
    thing = MAKERS[name]()
    made = WAYS[way](thing)
    assert made is not thing and type(made).__name__ == name and repr(made) == repr(thing)
    assert told(thing) and same(told(thing), told(made))


@pytest.mark.parametrize("way", WAYS)
def test_a_copied_run_answers_as_the_run_does(way):
    run = triad.run("spatial-slider-crank", until=0.3, every=0.1, integrator="dop853", outputs="drivers")
    made = WAYS[way](run)
    assert same(made.reactions(run.joints[0]), run.reactions(run.joints[0]))
    for name in ("accelerations", "multipliers", "violations"):
        assert np.array_equal(getattr(made, name), getattr(run, name)), name
    assert made.svg() == run.svg() and made.doubts == run.doubts


def test_a_deep_copy_shares_no_numbers():
    run = triad.run("simple-pendulum", until=0.1)
    made = copy.deepcopy(run)
    made.q[:] = 0.0
    made.scene["name"] = "other"
    assert np.abs(run.q).max() > 0 and run.scene["name"] == "simple-pendulum"


def test_a_pickled_part_of_a_run_says_that_it_cannot_be_run_again():
    # At once, though its scene takes hours.
    partial = pickle.loads(pickle.dumps(stopped("n-four-bar:40", until=1e5, outputs=[], most_steps=4))).partial
    assert 1 < len(partial) < 51 and np.isfinite(partial.energy).all()
    with pytest.raises(triad.TriadError, match="before it is pickled") as found:
        partial.reactions(partial.joints[0])
    assert found.value.code == "run-without-engine"


def test_a_pickled_run_of_other_numbers_is_not_mistaken_for_the_scene():
    run = pickle.loads(pickle.dumps(triad.run("simple-pendulum", until=0.1)))
    run.scene["gravity"] = [0.0, -1.62, 0.0]
    with pytest.raises(triad.TriadError, match="does not give it again"):
        run.reactions("pin")


def test_a_pickled_sweep_has_its_numbers_and_says_that_it_has_no_pictures():
    found = MAKERS["Sweep"]()
    made = pickle.loads(pickle.dumps(found))
    assert np.array_equal(made["energy"], found["energy"], equal_nan=True) and made.stopped == found.stopped
    assert made._repr_svg_() is None and found._repr_svg_().startswith("<svg")
    with pytest.raises(triad.TriadError, match="no pictures"):
        made.svg("energy")


def test_a_pickled_system_has_the_same_equations(tmp_path):
    path = tmp_path / "scene.json"
    scene = triad.scene("rssr")
    path.write_text(triad._native.scene_json("json", triad._json.as_json(scene)))
    system = triad.System(path, coordinates="reduced")
    told = pickle.dumps(system)
    path.unlink()
    made = pickle.loads(told)
    q, v = system.q0 + 0.01, system.v0 + 0.02
    for one, other in zip(system.solve(q, v, 0.3), made.solve(q, v, 0.3)):
        assert np.array_equal(one, other)


def test_runs_come_back_from_other_processes():
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        found = pool.map(triad.run, ["simple-pendulum", "free-fall"])
    here = triad.run("simple-pendulum")
    assert np.array_equal(found[0].q, here.q) and found[1].scene["name"] == "free-fall"
    assert np.array_equal(found[0].reactions("pin").force, here.reactions("pin").force)
