#!/usr/bin/env python3
"""Triad beside SUNDIALS' IDA and a Radau method of order 5 on the squeezer, the governor, the car axis and the heavy top.

    python3 tests/peers/dae.py                 some minutes
    python3 tests/peers/dae.py --rounds 7

Needed: numpy (that of run.py's virtual environment will do), cargo, a C++17 compiler and SUNDIALS 6 (Debian: libsundials-dev).
"""

import argparse
import csv
import json
import os
import sys
import tempfile
from pathlib import Path

import numpy as np
import reference
from compare import TARGETS, Program, alternate, cheapest
from run import PLACE, ROOT, build_triad, command

DATA = ROOT / "tests" / "data" / "problems"
TOLERANCES = [f"{10 ** (-k / 2):.3g}" for k in range(3, 25)]
PATIENCE = 60.0


def rows(file, columns):
    """Columns of a reference, by number."""
    with file.open() as lines:
        table = [row for row in csv.reader(lines) if row and not row[0].startswith(("#", "t["))]
    return np.array([[float(row[k]) for k in columns] for row in table])


def squeezer():
    """Direction of the crank; its angle is β."""
    beta = rows(DATA / "squeezer" / "reference-ivp.csv", [1])[:, 0]
    return np.stack([np.cos(beta), np.sin(beta)], axis=1)


def governor():
    """Height of the slider, and the sine of the arms' angle."""
    table = rows(DATA / "governor" / "reference.csv", [1, 4])
    return np.stack([table[:, 0], np.sin(table[:, 1])], axis=1)


def car_axis():
    """Places of the wheels."""
    return rows(DATA / "car-axis" / "reference.csv", [1, 2, 3, 4])


def top():
    """Centre and rim, every 0.01 s."""
    points, change = reference.Top().reference(5)
    if not change < 1e-10:
        sys.exit(f"error: the top's reference is not converged: {change:.0e} m")
    return points.reshape(len(points), -1)[:: round(0.01 / reference.GRID)]


PROBLEMS = {
    "squeezer": (DATA / "squeezer" / "ivp.json", 0.05, squeezer, ["ida-1", "ida-2", "radau"]),
    "governor": (DATA / "governor" / "scene.json", 10, governor, ["ida-1", "radau"]),
    "car-axis": (DATA / "car-axis" / "scene.json", 3, car_axis, ["ida-1", "ida-2", "radau"]),
    "top": ("heavy-top", 5, top, ["ida-1", "radau"]),
}


def build():
    """Compiles the program around IDA and Radau; returns its path."""
    program = PLACE / "dae-peer"
    PLACE.mkdir(parents=True, exist_ok=True)
    here = Path(__file__).resolve().parent
    words = ["g++", "-std=c++17", "-O3", "-march=x86-64-v3", here / "dae.cpp", "-o", program]
    words += [f"-lsundials_{part}" for part in ("ida", "nvecserial", "sunlinsoldense", "sunmatrixdense")]
    command(words, "compiling dae-peer", "install g++ and SUNDIALS (Debian: libsundials-dev)")
    return program


def sweep(program, settings, truth):
    """Error and time at each tolerance."""
    found = []
    for setting in settings:
        row = {"setting": setting, "error": None, "seconds": None}
        try:
            row["seconds"] = min(program.ask(2, {**setting, "samples": len(truth) - 1}, program.file))
            table = np.fromfile(program.file).reshape(-1, 1 + truth.shape[1])
            if len(table) == len(truth):
                row["error"] = float(np.abs(table[:, 1:] - truth).max())
        except RuntimeError as failure:
            row["failure"] = str(failure)
        found.append(row)
        if row["error"] is not None and row["error"] < 0.3 * TARGETS[-1]:
            break
    return found


def compare(name, triad, peer, rounds, folder):
    """One problem: lines of the table."""
    scene, duration, truth, solvers = PROBLEMS[name]
    truth = truth()
    ours = Program([triad, scene, duration], folder, PATIENCE)
    own = sweep(ours, [{"integrator": "auto", "tolerance": t} for t in TOLERANCES], truth)
    result = {"triad": own}
    theirs = Program([peer, name], folder, PATIENCE)
    for solver in solvers:
        result[solver] = sweep(theirs, [{"solver": solver, "tolerance": t} for t in TOLERANCES], truth)
    for target in TARGETS:
        mine, cells = cheapest(own, target), []
        for label, wanted in (("IDA", ["ida-1", "ida-2"]), ("Radau", ["radau"])):
            found = cheapest([row for solver in wanted for row in result.get(solver, [])], target)
            if not mine or not found:
                cells.append("not reached" if not found else f"{found['seconds'] * 1e3:.3g} ms")
                continue
            times = alternate(ours, theirs, mine, found, rounds)
            mine |= {"seconds": times["triad"]["median"], "bare": times["bare"]["median"]}
            note = f", {found['setting']['solver']}" if label == "IDA" else ""
            ratios = [times[kind]["median"] for kind in ("ratio", "bare_ratio")]
            cells.append(f"{times['other']['median'] * 1e3:.3g} ms (× {ratios[0]:.2g}; {ratios[1]:.2g} without{note})")
        shown = f"{mine['seconds'] * 1e3:.3g} ms" if mine else "not reached"
        shown += f" ({mine['bare'] * 1e3:.3g} without)" if mine and "bare" in mine else ""
        print(f"| {name} | {target:.0e} | {shown} | " + " | ".join(cells) + " |", flush=True)
    ours.stop()
    theirs.stop()
    return result


def main():
    """Compares, and prints."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--problems", metavar="A,B", default=",".join(PROBLEMS), help=f"of {', '.join(PROBLEMS)}")
    parser.add_argument("--rounds", type=int, metavar="N", default=5, help="alternate rounds (5)")
    options = parser.parse_args()
    triad, peer = os.environ.get("TRIAD_PEER") or build_triad(), build()
    print("| problem | error | Triad | IDA | Radau |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        names = options.problems.split(",")
        results = {name: compare(name, triad, peer, options.rounds, folder) for name in names}
    (PLACE / "dae.json").write_text(json.dumps(results, indent=1))


if __name__ == "__main__":
    main()
