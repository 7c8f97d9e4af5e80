"""A run in the viewer rerun, in a notebook: turned by hand, with a time line."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from ._errors import refusal

Floats = NDArray[np.float64]
# Colours of bodies, that stay apart for colour-blind eyes too (Okabe and Ito): those of the moving pictures.
COLOURS = [(0, 114, 178), (230, 159, 0), (0, 158, 115), (86, 180, 233), (204, 121, 167), (213, 94, 0)]


class Reaction(Protocol):
    """Where a joint acts, and on what."""

    @property
    def on(self) -> str: ...
    @property
    def point_at(self) -> Floats: ...


class Motion(Protocol):
    """Where a body is."""

    @property
    def position(self) -> Floats: ...
    @property
    def directors(self) -> Floats: ...


class Shown(Protocol):
    """What is shown of a run."""

    scene: dict[str, Any]
    bodies: list[str]
    joints: list[str]
    columns: list[str]
    t: Floats
    position: Floats

    @property
    def energy(self) -> Floats: ...
    def body(self, name: str) -> Motion: ...
    def reactions(self, joint: str, *, side: Literal["i", "j"]) -> Reaction: ...


def points(run: Shown) -> tuple[dict[str, Floats], Floats]:
    """Where the joints hold each body, along its principal axes from its centre, m: (k, 3); and where they hold the ground."""
    found: dict[str, list[Floats]] = {name: [] for name in run.bodies}
    ground: list[Floats] = []
    for joint in run.joints:
        for side in ("i", "j"):
            reaction = run.reactions(joint, side=side)
            at = reaction.point_at[0]
            if reaction.on in found:
                body = run.body(reaction.on)
                found[reaction.on].append(body.directors[0] @ (at - body.position[0]))
            else:
                ground.append(at)
    return {name: np.array(own).reshape(-1, 3) for name, own in found.items()}, np.array(ground).reshape(-1, 3)


def viewer(run: Shown, width: int, height: int) -> Any:
    """The viewer with the run in it."""
    try:
        import rerun as rr
        import rerun_notebook  # noqa: F401 (what rerun itself looks for, and says by an error of its own)
        from rerun.notebook import Viewer
    except ImportError as missing:
        raise refusal(
            "no-viewer", f"the viewer is not installed ({missing})", "pip install 'rerun-sdk[notebook]==0.33.*'; r.svg() needs nothing"
        ) from missing
    recording = rr.RecordingStream(f"triad {run.scene['name']}")
    log(run, rr, recording.log, recording.send_columns)
    return Viewer(recording=recording, width=width, height=height)


def log(run: Shown, rr: Any, write: Callable[..., Any], send: Callable[..., Any]) -> None:
    """Hands the run over, by the functions `log` and `send_columns` of a recording."""
    held, ground = points(run)
    gravity = np.abs(run.scene.get("gravity", [0.0, 0.0, 0.0]))
    up = int(np.argmax(gravity)) if np.any(gravity) else 2
    axes = rr.ViewCoordinates
    write("/", [axes.RIGHT_HAND_X_UP, axes.RIGHT_HAND_Y_UP, axes.RIGHT_HAND_Z_UP][up], static=True)
    size = float(np.ptp(np.concatenate([run.position.reshape(-1, 3), ground]), axis=0).max()) or 1.0
    if len(ground):
        write("ground", rr.Points3D(ground, radii=0.015 * size, colors=(120, 120, 120)), static=True)
    times = [rr.TimeColumn("time", duration=run.t)]
    for k, name in enumerate(run.bodies):
        body, colour = run.body(name), COLOURS[k % len(COLOURS)]
        arms = [[(0.0, 0.0, 0.0), tuple(point)] for point in held[name]]
        write(f"bodies/{name}", rr.LineStrips3D(arms, radii=0.006 * size, colors=colour), static=True)
        centre = rr.Points3D([(0.0, 0.0, 0.0)], radii=0.012 * size, colors=colour, labels=name)
        write(f"bodies/{name}/centre", centre, static=True)
        # Directors are the rows here and the columns of the rotation; rerun takes matrices column after column.
        moved = rr.Transform3D.columns(translation=body.position, mat3x3=body.directors.reshape(-1, 9))
        send(f"bodies/{name}", indexes=times, columns=moved)
        write(f"paths/{name}", rr.LineStrips3D([body.position], radii=0.002 * size, colors=colour), static=True)
    if "energy" in run.columns:
        send("energy", indexes=times, columns=rr.Scalars.columns(scalars=run.energy))
