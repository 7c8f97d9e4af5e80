"""Errors, interruptions, sweeps, analyses and grading."""

import inspect
import json
import signal
import threading
import time

import numpy as np
import pytest

import triad


def test_errors_say_what_where_and_what_to_try():
    with pytest.raises(triad.TriadError) as found:
        triad.run("simple-pendulm")
    assert "simple-pendulum" in found.value.hint and str(found.value).count("\n") == 1
    scene = triad.scene("simple-pendulum")
    scene["bodies"][0]["mass"] = -1
    with pytest.raises(triad.TriadError) as found:
        triad.run(scene)
    assert found.value.pointer == "/bodies/0/mass" and "  try: " in str(found.value)
    with pytest.raises(triad.TriadError, match="taylor"):
        triad.run("simple-pendulum", integrator="euler")
    with pytest.raises(triad.TriadError, match="bob"):
        triad.run("simple-pendulum", until=0.1).body("bop")
    with pytest.raises(triad.TriadError, match="did you mean \"pin\""):
        triad.run("simple-pendulum", until=0.1).reactions("pim")
    r = triad.run("simple-pendulum", until=0.1)
    for wrong, hint in [
        ({"frame": "local"}, "world, joint or body"),
        ({"side": "k"}, "j or i"),
        ({"side": 1}, "j or i"),
        ({"point": "com"}, "center-of-mass"),
        ({"point": [1, 2]}, "three numbers"),
        ({"point": [1, 2, float("nan")]}, "three numbers"),
    ]:
        with pytest.raises(triad.TriadError) as found:
            r.reactions("pin", **wrong)
        assert hint in found.value.hint, wrong
    with pytest.raises(triad.TriadError, match="until is nan"):
        triad.run("simple-pendulum", until=float("nan"))
    with pytest.raises(triad.TriadError, match="no file"):
        triad.run("no-such.json")
    with pytest.raises(triad.TriadError, match="would run by"):
        triad.run("simple-pendulum", integrator="taylor", treatment="baumgarte")
    with pytest.raises(TypeError, match="not int"):
        triad.run(5)


WRONG = [
    ("until", "1", "a number"),
    ("until", True, "a number"),
    ("every", [0.1], "a number"),
    ("tolerance", 1j, "a number"),
    ("step", "0.1", "a number"),
    ("integrator", 3, "a text"),
    ("treatment", ["projection"], "a text"),
    ("coordinates", 12, "a text"),
    ("outputs", ["energy", 3], "a text or a list of them"),
    ("no_skip", 3, "a text or a list of them"),
    ("estimate", "no", "True or False"),
    ("verify", 1, "True or False"),
    ("most_steps", 1.5, "a whole number"),
    ("most_seconds", "1", "a number"),
    ("progress", 3, "a function"),
]


@pytest.mark.parametrize("name, given, wanted", WRONG)
def test_an_option_of_the_wrong_kind_is_told_by_its_name(name, given, wanted):
    with pytest.raises(triad.TriadError) as found:
        triad.run("simple-pendulum", **{name: given})
    assert found.value.what.startswith(f"{name} is {given!r}") and found.value.hint == f"give {name} {wanted}"
    assert found.value.code == "not-understood"


def test_each_option_is_tried_with_another_kind():
    options = inspect.signature(triad.run).parameters
    assert {name for name, _, _ in WRONG} == set(options) - {"scene"}


def test_what_is_asked_of_sweeps_systems_and_grading_is_told_by_its_name():
    vary = {"mass": triad.grid(1, 2, 3)}
    system, r = triad.System("simple-pendulum"), triad.run("simple-pendulum", until=0.1)
    for told, action in [
        ("samples is 1.5", lambda: triad.sweep("simple-pendulum", vary, samples=1.5)),
        ("seed is -2", lambda: triad.sweep("simple-pendulum", vary, seed=-2)),
        ("threads is 'all'", lambda: triad.sweep("simple-pendulum", vary, threads="all")),
        ("until is '3'", lambda: triad.sweep("simple-pendulum", vary, until="3")),
        ("vary is ", lambda: triad.sweep("simple-pendulum", [("mass", 1)])),
        ("the name 3 in vary", lambda: triad.sweep("simple-pendulum", {3: [1, 2]})),
        ("mass cannot vary over 3", lambda: triad.sweep("simple-pendulum", {"mass": 3})),
        ("q is ", lambda: system.phi(system.q0 + 1j)),
        ("v is 'still'", lambda: system.gamma(system.q0, "still")),
        ("t is nan", lambda: system.phi(system.q0, float("nan"))),
        ("coordinates is 12", lambda: triad.System("simple-pendulum", coordinates=12)),
        ("joint is 0", lambda: r.reactions(0)),
        ("no body 0", lambda: r.body(0)),
        ("about is 3", lambda: triad.modes("simple-pendulum", about=3)),
        ("keep is 3", lambda: triad.assemble("simple-pendulum", keep=3)),
        ("lesson is 3", lambda: triad.grade(3, {})),
        ("student is 3", lambda: triad.grade("simple-pendulum", {}, student=3)),
        ("answers is ", lambda: triad.grade("simple-pendulum", [1])),
    ]:
        with pytest.raises(triad.TriadError) as found:
            action()
        assert told in found.value.what and found.value.hint and " " not in found.value.code, told


def test_a_run_is_not_given_less_than_a_moment():
    for name, given in (("most_seconds", -1), ("most_seconds", 0.0), ("most_steps", -1)):
        with pytest.raises(triad.TriadError, match=f"{name} is {given:g}") as found:
            triad.run("simple-pendulum", **{name: given})
        assert found.value.code == "out-of-range"
    assert len(triad.run("simple-pendulum", until=0.1, most_seconds=60)) == 11


def test_numbers_of_scenes_and_answers_that_are_not_finite_are_told_with_their_place():
    scene = triad.scene("simple-pendulum")
    scene["bodies"][0]["mass"] = float("nan")
    for given in (scene, json.dumps(scene)):
        with pytest.raises(triad.TriadError, match="nan is no finite number") as found:
            triad.check(given)
        assert (found.value.code, found.value.pointer) == ("not-finite", "/bodies/0/mass")
    scene["bodies"][0]["mass"] = 1
    scene["gravity"] = np.array([0.0, -np.inf, 0.0])
    with pytest.raises(triad.TriadError, match="-inf is no finite number") as found:
        triad.run(scene)
    assert found.value.pointer == "/gravity/1"
    scene.update(gravity=[0, 0, 0], title="NaN and Infinity")
    assert triad.run(scene, until=0.1).scene["title"] == "NaN and Infinity"
    with pytest.raises(triad.TriadError) as found:
        triad.grade("simple-pendulum", {"tension": np.float64("nan")})
    assert found.value.pointer == "/answers/tension/value"


def test_names_that_do_not_exist_have_a_code_and_a_hint():
    r = triad.run("simple-pendulum", until=0.1)
    for code, hint, action in [
        ("unknown-marker", "the scene has none", lambda: r.marker("tip")),
        ("unknown-joint-or-driver", "there are pin", lambda: r.reactions("x")),
        ("unknown-place-for-modes", "there are equilibrium, start, steady", lambda: triad.modes("simple-pendulum", about="x")),
        ("unknown-word-of-no_skip", "there are planar", lambda: triad.run("simple-pendulum", no_skip="x")),
    ]:
        with pytest.raises(triad.TriadError) as found:
            action()
        assert found.value.code == code and found.value.hint.startswith(hint)


def test_what_was_reached_before_an_error_is_kept():
    with pytest.raises(triad.TriadError) as found:
        triad.run("n-four-bar:2", until=5, every=0.1, most_steps=4)
    partial = found.value.partial
    assert found.value.code == "step-limit" and 1 < len(partial) < 51
    whole = triad.run("n-four-bar:2", until=5, every=0.1)
    assert np.array_equal(partial.q[: len(partial) - 1], whole.q[: len(partial) - 1])


def interrupted(action):
    """Does something that would take hours, and sends Ctrl-C after a moment."""
    # Once Python's own handler is asked, the signal has come from outside.
    signal.signal(signal.SIGALRM, lambda *_: signal.default_int_handler(signal.SIGINT, None))
    signal.setitimer(signal.ITIMER_REAL, 0.3)
    try:
        with pytest.raises(KeyboardInterrupt) as found:
            action()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
    return found.value


def test_ctrl_c_ends_a_run_and_keeps_what_was_reached():
    stopped = interrupted(lambda: triad.run("n-four-bar:40", until=1e5, every=0.1, outputs=[]))
    assert 1 < len(stopped.partial) < 1_000_000


def test_ctrl_c_ends_a_sweep():
    interrupted(lambda: triad.sweep("n-four-bar:10", {"/gravity/1": triad.grid(-10, -1, 100_000)}))


def test_progress_is_told_and_may_end_a_run():
    told = []
    triad.run("n-four-bar:4", until=2, progress=lambda t, end: told.append((t, end)))
    assert told[-1] == (2.0, 2.0) and told == sorted(told)

    def stop(done, all):
        raise RuntimeError(f"{done} of {all}")

    with pytest.raises(RuntimeError, match="of 3"):
        triad.sweep("simple-pendulum", {"/gravity/1": triad.grid(-10, -1, 3)}, progress=stop)


def test_other_threads_go_on_while_a_run_computes():
    inside, over, turns = threading.Event(), threading.Event(), []

    def other():
        while not over.is_set():
            if inside.is_set():
                turns.append(1)
            time.sleep(0)

    thread = threading.Thread(target=other)
    thread.start()
    inside.set()
    triad.run("n-four-bar:40", until=10, every=0.01)
    inside.clear()
    over.set()
    thread.join()
    assert len(turns) > 100


def test_a_sweep_is_its_runs_whatever_the_number_of_threads():
    vary = {"/bodies/0/mass": triad.grid(1, 2, 3), "/gravity/1": triad.normal(-9.81, 0.1)}
    options = {"samples": 4, "seed": 7, "until": 0.5, "outputs": ["energy", "joints", "errors"]}
    one, many = (triad.sweep("simple-pendulum", vary, threads=n, **options) for n in (1, 3))
    assert np.array_equal(one.values, many.values) and np.array_equal(one.outputs, many.outputs)
    assert len(one) == 12 and sorted(set(one["/bodies/0/mass"])) == [1.0, 1.5, 2.0]
    scene = triad.scene("simple-pendulum")
    scene["bodies"][0]["mass"], scene["gravity"][1] = one.values[5]
    alone = triad.run(scene, until=0.5, outputs=["energy", "joints", "errors"])
    assert np.array_equal(one.outputs[5], [alone[name][-1] for name in one.columns])
    assert one.svg("energy").startswith("<svg") and not one.stopped
    assert list(one.to_pandas().columns) == [*one.varied, *one.columns]


def test_a_sweep_names_the_runs_that_stopped():
    found = triad.sweep("simple-pendulum", {"/bodies/0/mass": triad.grid(-1, 1, 3)}, until=0.1)
    assert [stop["run"] for stop in found.stopped] == [0, 1] and found.stopped[0]["hint"]
    assert np.isnan(found.outputs[0]).all() and not np.isnan(found.outputs[2]).any()
    # A picture of nothing is none.
    lost = triad.sweep("simple-pendulum", {"/bodies/0/mass": triad.grid(-2, -1, 2)}, until=0.1)
    assert lost._repr_svg_() is None
    with pytest.raises(triad.TriadError, match="no run of this sweep") as refused:
        lost.svg()
    assert refused.value.code == "nothing-to-draw"
    # Three bare numbers could be values, or the ends of a grid and a count.
    for wrong in ((1, 2), (1, 2, 3), (1.0, 1.5, 2.0), triad.normal(1, -0.1), triad.grid(1, float("nan"), 3), [1, 2, 4], np.array([1.0, np.nan]), ["a"], np.ones((2, 2))):
        with pytest.raises(triad.TriadError, match="cannot vary"):
            triad.sweep("simple-pendulum", {"/bodies/0/mass": wrong})


def test_a_sweep_has_its_errors_and_runs_as_it_was_asked_to():
    vary = {"/bodies/0/mass": [1, 2]}
    found = triad.sweep("simple-pendulum", vary, until=1, outputs=["joints"])
    assert (found["position_error"] > 0).all() and (found["position_error"] < 1e-5).all()
    bare = triad.sweep("simple-pendulum", vary, until=1, outputs=["joints"], estimate=False)
    assert bare.columns == ["pin.angle", "pin.angle_rate"]
    for ask in (lambda **options: triad.run("simple-pendulum", **options), lambda **options: triad.sweep("simple-pendulum", vary, **options)):
        with pytest.raises(triad.TriadError, match="no-errors"):
            ask(until=1, outputs=["joints", "errors"], estimate=False)
    scene = triad.scene("simple-pendulum")
    scene["simulation"] = {"duration": 1, "stabilization": {"kind": "baumgarte", "alpha": 5, "beta": 5}}
    with pytest.raises(triad.TriadError, match="would run by dop853"):
        triad.sweep(scene, vary, integrator="taylor")


def test_arrays_of_equally_spaced_values_are_grids():
    options = {"until": 0.1, "outputs": "energy"}
    grid = triad.sweep("simple-pendulum", {"mass": triad.grid(1, 2, 5)}, **options)
    for same in (np.linspace(1, 2, 5), [1, 1.25, 1.5, 1.75, 2]):
        found = triad.sweep("simple-pendulum", {"mass": same}, **options)
        assert np.array_equal(found.values, grid.values) and np.array_equal(found.outputs, grid.outputs)
    # Three values are values, not a grid's two ends and a count.
    assert list(triad.sweep("simple-pendulum", {"mass": [1, 2, 3]}, until=0.1)["mass"]) == [1, 2, 3]


def test_analyses_answer_as_the_command_line_does(program):
    scene = "spatial-double-pendulum"
    for word, found in [
        ("check", triad.check(scene)),
        ("equilibrium", triad.equilibrium(scene)),
        ("modes", triad.modes(scene)),
    ]:
        told = json.loads(program(word, scene, "--json"))
        told.pop("seconds")
        assert found == told, word
    told = json.loads(program("kinematics", "crank-rocker", "--in", "joint", "--json"))
    told.pop("seconds")
    assert triad.kinematics("crank-rocker", frame="joint") == told
    told = json.loads(program("kinematics", "crank-rocker", "--about", "origin", "--json"))
    told.pop("seconds")
    assert triad.kinematics("crank-rocker", point="origin") == told == triad.kinematics("crank-rocker", point=[0, 0, 0])
    assert triad.modes("simple-pendulum")["modes"][0]["frequency"] == pytest.approx(np.sqrt(9.81) / (2 * np.pi))
    assert triad.assemble(scene, keep=triad.run(scene, until=0.01).bodies[:1])["left"] < 1e-9


def test_answers_are_graded_as_by_the_program(program, tmp_path):
    lesson = next(found for found in triad.lessons() if found["slug"] == "simple-pendulum")
    answers = {question: {"value": "29.43", "unit": "N"} for question in lesson["questions"][:1]}
    verdict = triad.grade("simple-pendulum", answers, student="ada")
    (tmp_path / "answers.json").write_text(json.dumps({"student": "ada", "answers": answers}))
    told = json.loads(program("grade", "simple-pendulum", str(tmp_path / "answers.json"), "--json"))
    assert verdict == told and verdict["possible"] > 0
    assert verdict != triad.grade("simple-pendulum", answers, student="grace")
    with pytest.raises(triad.TriadError, match="simple-pendulum"):
        triad.grade("simple-pendulm", {})
    with pytest.raises(triad.TriadError, match="has no question"):
        triad.grade("simple-pendulum", {"nothing": 1})


def test_a_course_of_ones_own_is_taken(program, tmp_path):
    program("lesson", "new", "mine", "--into", str(tmp_path))
    assert [lesson["slug"] for lesson in triad.lessons(tmp_path)] == ["mine"]
    assert triad.grade("mine", {}, course=tmp_path)["passed"] is False
    with pytest.raises(triad.TriadError, match="cannot be read"):
        triad.lessons(tmp_path / "nowhere")


def test_everything_public_is_documented():
    for name in triad.__all__:
        thing = getattr(triad, name)
        if inspect.isclass(thing) or inspect.isfunction(thing):
            assert inspect.getdoc(thing), name
