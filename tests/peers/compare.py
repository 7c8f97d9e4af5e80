"""The comparison itself; `run.py` starts it inside the virtual environment."""

import argparse
import datetime
import importlib.metadata
import json
import os
import platform
import selectors
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import reference
from problems import PROBLEMS
from settings import FAMILIES

HERE = Path(__file__).resolve().parent
TARGETS = [1e-3, 1e-6, 1e-9]
NEAR = 1e-2
"""With a greater error, m, a run has little to do with the motion."""

TRUSTED = 1e-10
"""Largest difference between a reference and the one with steps twice as long, m."""
REPEATS = 3
"""Batches of each program in a round; the median counts."""

ENOUGH = 5e-10
"""A family of settings is not refined beyond this error, m."""


class Program:
    """One program with one problem in a process of its own, which is started anew if it fails or takes too long."""

    def __init__(self, words, folder, patience):
        self.words, self.patience = [str(word) for word in words], patience
        self.file = Path(folder) / "points"
        self.process = None

    def start(self):
        """Starts the process unless it runs."""
        if self.process is None or self.process.poll() is not None:
            pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
            self.process = subprocess.Popen(self.words, text=True, bufsize=1, cwd=HERE, **pipes)

    def stop(self):
        """Ends the process."""
        if self.process is not None:
            self.process.kill()
            self.process.wait()
            self.process = None

    def ask(self, repeats, setting, file="-"):
        """Times of some repeats; raises RuntimeError with the reason if there are none."""
        self.start()
        words = [f"{name}={value}" for name, value in setting.items()]
        try:
            print(repeats, file, *words, file=self.process.stdin, flush=True)
        except BrokenPipeError:
            self.stop()
            raise RuntimeError("the program ended") from None
        with selectors.DefaultSelector() as waiting:
            waiting.register(self.process.stdout, selectors.EVENT_READ)
            if not waiting.select(self.patience):
                self.stop()
                raise RuntimeError(f"longer than {self.patience:.0f} s")
        line = self.process.stdout.readline()
        if not line:
            self.stop()
            raise RuntimeError("the program ended")
        answer = json.loads(line)
        if "error" in answer:
            raise RuntimeError(answer["error"])
        return answer["times"]

    def error(self, setting, truth):
        """Largest distance from the reference, m, and the time of one run, s."""
        seconds = self.ask(1, setting, self.file)[0]
        if seconds < 0.1:
            # Short runs are easily disturbed, also as batches.
            seconds = min(seconds, *self.ask(2, setting))
        table = np.fromfile(self.file, dtype="<f8").reshape(-1, 1 + truth[0].size)
        if table[-1, 0] < (len(truth) - 1) * reference.GRID - 1e-6:
            raise RuntimeError(f"stopped at {table[-1, 0]:.3f} s")
        points = table[:, 1:].reshape(-1, *truth.shape[1:])
        distance = np.linalg.norm(points - reference.between(truth, table[:, 0]), axis=-1).max()
        return float(distance), seconds


def sweep(program, families, truth, options):
    """Tries families of settings from coarse to fine; returns what was found."""
    found = []
    left = options.budget
    for family, settings in families.items():
        begin = time.monotonic()
        best, worse = np.inf, 0
        for setting in settings[:: 2 if options.quick else 1]:
            row = {"family": family, "setting": setting, "error": None, "seconds": None, "failure": None}
            try:
                row["error"], row["seconds"] = program.error(setting, truth)
            except RuntimeError as failure:
                row["failure"] = str(failure)
            found.append(row)
            gained = row["error"] is not None and np.isfinite(row["error"]) and row["error"] < 0.9 * best
            best, worse = (row["error"], 0) if gained else (best, worse + 1)
            spent = time.monotonic() - begin
            row["last"] = spent > left or (row["seconds"] or 0) > options.limit
            # What was near and became worse three times will not become better; what never was near gets more patience.
            if best < ENOUGH or worse > (2 if best < NEAR else 8) or row["last"]:
                break
        left -= time.monotonic() - begin
        if left <= 0:
            break
    return found


def cheapest(rows, target):
    """The fastest setting with at most an error."""
    reached = [row for row in rows if row["error"] is not None and row["error"] <= target]
    return min(reached, key=lambda row: row["seconds"], default=None)


def quartiles(values):
    """Median, lower and upper quartile."""
    low, middle, high = np.percentile(values, [25, 50, 75])
    return {"median": float(middle), "low": float(low), "high": float(high)}


BARE = {"estimate": "false"}
"""Triad without the estimate of its errors, which the others do not make."""


def alternate(ours, theirs, our_row, their_row, rounds):
    """Rounds of Triad, Triad without its estimate and the other, in turns; medians of each round's repeats."""
    own, other = our_row["setting"], their_row["setting"]
    runs = {"triad": (ours, own), "bare": (ours, own | BARE), "other": (theirs, other)}
    times = {name: [] for name in runs}
    for _ in range(rounds):
        for name, (program, setting) in runs.items():
            times[name].append(statistics.median(program.ask(REPEATS, setting)))
    found = {name: quartiles(list_) for name, list_ in times.items()}
    for name, own in (("ratio", times["triad"]), ("bare_ratio", times["bare"])):
        found[name] = quartiles([b / a for a, b in zip(own, times["other"], strict=True)])
    return found


def duel(ours, theirs, our_rows, rows, rounds):
    """The three errors: who needs how long."""
    results = []
    for target in TARGETS:
        our_row, their_row = cheapest(our_rows, target), cheapest(rows, target)
        result = {"target": target, "triad_setting": our_row, "other_setting": their_row}
        if our_row and their_row:
            try:
                result |= alternate(ours, theirs, our_row, their_row, rounds)
            except RuntimeError as failure:
                result["failure"] = str(failure)
        results.append(result)
    return results


def compare(name, options, folder):
    """One problem with all programs."""
    problem = PROBLEMS[name]
    say(f"{name}: reference")
    truth, change = problem.reference()
    if not change < TRUSTED:
        say(f"{name}: left out: its reference is not converged, steps twice as long change it by {change:.0e} m")
        return None
    patience = 6 * options.limit + 20
    ours = Program([options.triad, problem.scene, problem.duration], folder, patience)
    say(f"{name}: triad")
    our_rows = sweep(ours, FAMILIES["triad"](problem), truth, options)
    result = {"reference_change": change, "triad": our_rows, "others": {}}
    for other in options.only:
        say(f"{name}: {other}")
        if other == "pinocchio":
            words = [options.pinocchio, problem.kind, problem.size, problem.duration]
        else:
            words = [sys.executable, HERE / "worker.py", other, name]
        theirs = Program(words, folder, patience)
        rows = sweep(theirs, FAMILIES[other](problem), truth, options)
        duels = duel(ours, theirs, our_rows, rows, options.rounds)
        result["others"][other] = {"rows": rows, "duels": duels}
        theirs.stop()
    ours.stop()
    return result


def say(text):
    """Progress, apart from the results."""
    print(text, file=sys.stderr, flush=True)


def circumstances(options):
    """What the figures depend on."""
    model = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    if info.exists():
        lines = [line for line in info.read_text().splitlines() if line.startswith("model name")]
        model = lines[0].split(":", 1)[1].strip() if lines else model
    packages = {"pinocchio": "pin", "mujoco": "mujoco", "exudyn": "exudyn", "drake": "drake"}
    return {
        "date": datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d %H:%M UTC"),
        "machine": f"{model}, {os.cpu_count()} processors",
        "load": os.getloadavg()[0],
        "versions": {name: importlib.metadata.version(packages[name]) for name in options.only},
        "rounds": options.rounds,
    }


def cell(found):
    """One program's answer for one error."""
    if found["other_setting"] is None:
        return "not reached"
    if "ratio" not in found:
        return f"{found['other_setting']['seconds'] * 1e3:.3g} ms"
    setting, ratio, bare = found["other_setting"], found["ratio"]["median"], found["bare_ratio"]["median"]
    return f"{found['other']['median'] * 1e3:.3g} ms (× {ratio:.2g}; {bare:.2g} without, {setting['family']})"


def table(results, options):
    """Everything as one table in Markdown; "without" is without the estimate of errors."""
    head = ["problem", "error, m", "Triad", *options.only]
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    for name, result in results.items():
        for index, target in enumerate(TARGETS):
            duels = [result["others"][other]["duels"][index] for other in options.only]
            own, bare = ([d[kind]["median"] for d in duels if kind in d] for kind in ("triad", "bare"))
            row = cheapest(result["triad"], target)
            own = own or ([row["seconds"]] if row else [])
            triad = f"{statistics.median(own) * 1e3:.3g} ms" if own else "not reached"
            triad += f" ({statistics.median(bare) * 1e3:.3g} without)" if bare else ""
            cells = []
            for other, found in zip(options.only, duels, strict=True):
                rows = result["others"][other]["rows"]
                errors = [r["error"] for r in rows if r["error"] is not None and np.isfinite(r["error"])]
                best = f" (best {min(errors):.0e})" if errors else " (no run ended)"
                cells.append(cell(found) + (best if found["other_setting"] is None else ""))
            lines.append(f"| {name} | {target:.0e} | {triad} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def main():
    """Compares, and prints."""
    parser = argparse.ArgumentParser()
    for name in ("triad", "pinocchio", "place", "only", "problems", "out"):
        parser.add_argument(f"--{name}")
    for name in ("limit", "budget"):
        parser.add_argument(f"--{name}", type=float)
    parser.add_argument("--rounds", type=int)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    options.only = options.only.split(",")
    document, results = {"circumstances": circumstances(options)}, {}
    document["problems"] = results
    out = Path(options.out or Path(options.place) / "results.json")
    out.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        for name in options.problems.split(","):
            result = compare(name, options, folder)
            if result is None:
                continue
            results[name] = result
            # What is there is kept, whatever happens later.
            out.write_text(json.dumps(document, indent=1))
    if options.json:
        print(json.dumps(document, indent=1))
    else:
        print(json.dumps(document["circumstances"]))
        print(table(results, options))
        say(f"all runs: {out}")


if __name__ == "__main__":
    main()
