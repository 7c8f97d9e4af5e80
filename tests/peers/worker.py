"""A Python program among the compared ones, in a process of its own: `worker.py PROGRAM PROBLEM`.

It reads lines `REPEATS FILE NAME=VALUE …` and answers with one line of JSON, as `triad.rs` does.
"""

import importlib
import json
import os
import sys

import numpy as np
from problems import PROBLEMS


BATCH = 0.02
"""Shortest batch of runs, s, so that the clock's own time and resolution do not count."""


def batch(run):
    """Processor seconds of one run: the mean of a batch, after one that warms the caches."""
    spent, count = run.timed(), 1
    if spent >= BATCH:
        return spent
    spent = count = 0
    while spent < BATCH:
        spent += run.timed()
        count += 1
    return spent / count


def answer(program, problem, line):
    """Does what one line asks for."""
    repeats, file, *words = line.split()
    run = program.prepare(problem, dict(word.split("=", 1) for word in words))
    if file != "-":
        times, points = run.sampled()
        table = np.column_stack([times, np.asarray(points).reshape(len(times), -1)])
        table.astype("<f8").tofile(file)
    return {"times": [batch(run) for _ in range(int(repeats))]}


def main():
    """Answers until the input ends."""
    # Some programs print to standard output from compiled code: that goes to standard error.
    replies = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    program = importlib.import_module(f"program_{sys.argv[1]}")
    problem = PROBLEMS[sys.argv[2]]
    for line in sys.stdin:
        try:
            reply = answer(program, problem, line)
        except Exception as error:  # noqa: BLE001: whatever another program throws is its answer
            reply = {"error": f"{type(error).__name__}: {error}"[:300]}
        print(json.dumps(reply), file=replies, flush=True)


if __name__ == "__main__":
    main()
