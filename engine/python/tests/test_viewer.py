"""What a notebook's viewer is shown."""

import sys

import numpy as np
import pytest

import triad
from triad import _viewer


@pytest.mark.parametrize("scene", ["simple-pendulum", "n-four-bar:2", "rssr"])
def test_arms_lead_to_the_joints_at_all_times(scene):
    r = triad.run(scene, until=1, every=0.1)
    held, ground = _viewer.points(r)
    assert len(ground) > 0 and all(len(own) > 0 for own in held.values())
    for joint in r.joints:
        for side in ("i", "j"):
            reaction = r.reactions(joint, side=side)
            if reaction.on == "ground":
                assert np.abs(ground - reaction.point_at[0]).sum(axis=1).min() < 1e-12
                continue
            own = [r.body(reaction.on).point(*point) for point in held[reaction.on]]
            assert min(np.abs(path - reaction.point_at).max() for path in own) < 1e-9, joint


def test_without_the_viewer_it_is_told_how_to_get_it(monkeypatch):
    r = triad.run("simple-pendulum", until=0.1)
    monkeypatch.setitem(sys.modules, "rerun", None)
    with pytest.raises(triad.TriadError, match=r"pip install .rerun-sdk\[notebook\]"):
        r.viewer()


def test_the_viewer_gets_every_body_at_all_times():
    rr = pytest.importorskip("rerun", reason="pip install rerun-sdk[notebook]")
    r = triad.run("rssr", until=1, every=0.1)
    logged, sent = [], {}
    _viewer.log(
        r,
        rr,
        lambda path, *parts, static: logged.append((path, static)),
        lambda path, indexes, columns: sent.update({path: [len(column.as_arrow_array()) for column in columns]}),
    )
    for name in r.bodies:
        assert (f"bodies/{name}", True) in logged
        assert set(sent[f"bodies/{name}"]) == {len(r)}


def test_the_viewer_is_made():
    pytest.importorskip("rerun_notebook", reason="pip install rerun-sdk[notebook]")
    assert type(triad.run("simple-pendulum", until=0.1).viewer()).__name__ == "Viewer"
