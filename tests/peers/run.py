#!/usr/bin/env python3
"""Triad beside MuJoCo, Exudyn, Drake and Pinocchio: time of integration to reach position errors of 1e-3, 1e-6, 1e-9 m.

    python3 tests/peers/run.py                         everything; about an hour
    python3 tests/peers/run.py --quick                 coarser sweeps, fewer repeats
    python3 tests/peers/run.py --only mujoco,drake --problems pendulum,top
    python3 tests/peers/run.py --json > results.json

The other programs come from PyPI into a virtual environment of their own under target/peers; nothing else is touched.
Needed: Python 3.11 or later, cargo, and a C++17 compiler for Pinocchio.
"""

import argparse
import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")).resolve()
PLACE = TARGET / "peers"
PROGRAMS = ["pinocchio", "mujoco", "exudyn", "drake"]
PROBLEMS = ["pendulum", "four-bar-2", "four-bar-10", "four-bar-40", "chain-10", "top"]
KNOWN = [*PROBLEMS, "chain-100"]


def arguments():
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", metavar="A,B", help=f"programs to compare with, of {', '.join(PROGRAMS)}")
    parser.add_argument("--problems", metavar="A,B", help=f"of {', '.join(KNOWN)}")
    parser.add_argument("--quick", action="store_true", help="no run longer than 3 s, every other setting, 3 rounds")
    parser.add_argument("--limit", type=float, metavar="S", help="longest run that is tried (20 s; with --quick 3 s)")
    parser.add_argument("--budget", type=float, metavar="S", help="time for one program's sweep of a problem (120 s)")
    parser.add_argument("--rounds", type=int, metavar="N", help="alternate rounds (7; with --quick 3)")
    parser.add_argument("--json", action="store_true", help="print JSON instead of the tables")
    parser.add_argument("--out", type=Path, metavar="FILE", help="also write the JSON here")
    found = parser.parse_args()
    found.only = chosen(parser, "program", found.only, PROGRAMS)
    found.problems = chosen(parser, "problem", found.problems, PROBLEMS, KNOWN)
    found.limit = found.limit or (3.0 if found.quick else 20.0)
    found.budget = found.budget or (30.0 if found.quick else 120.0)
    found.rounds = found.rounds or (3 if found.quick else 7)
    return found


def chosen(parser, what, text, default, known=None):
    """A list of names, each of which must be known."""
    known = known or default
    names = text.split(",") if text else default
    for name in names:
        if name not in known:
            parser.error(f'there is no {what} "{name}"; there are {", ".join(known)}')
    return names


def command(words, what, remedy, **options):
    """Runs a command; a failure is told with its last lines and what to try."""
    try:
        done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=False, **options)
    except FileNotFoundError:
        sys.exit(f"error: {what}: there is no {words[0]}; {remedy}")
    if done.returncode != 0:
        sys.exit(f"error: {what} failed; {remedy}\n" + (done.stderr or done.stdout)[-1500:])
    return done.stdout


def environment():
    """Makes the virtual environment, unless it is there already; returns its Python."""
    python = Path(os.environ.get("PEERS_PYTHON", PLACE / "venv" / "bin" / "python"))
    if not python.exists():
        print(f"making a virtual environment in {PLACE / 'venv'} (some minutes, 1 GB)", file=sys.stderr)
        command([sys.executable, "-m", "venv", PLACE / "venv"], "the virtual environment", "install Python's venv")
        pip = [python, "-m", "pip", "install", "-q", "--no-compile", "-r", HERE / "requirements.txt"]
        command(pip, "installing the other programs", "is PyPI reachable, and Python 3.11 or later?")
    return python


def build_triad():
    """Builds the program that runs Triad's engine; returns its path."""
    print("building triad-peer", file=sys.stderr)
    words = ["cargo", "build", "--release", "-q", "-p", "triad-tests", "--example", "triad-peer"]
    command(words, "building triad-peer", "try `cargo build --release`", cwd=ROOT)
    return TARGET / "release" / "examples" / "triad-peer"


def build_pinocchio(python):
    """Compiles the program around Pinocchio's library from its wheel, if it is older than its sources."""
    program = PLACE / "pinocchio-peer"
    sources = [HERE / "pinocchio.cpp", HERE / "dop853.hpp"]
    if program.exists() and all(program.stat().st_mtime > source.stat().st_mtime for source in sources):
        return program
    print("compiling pinocchio-peer (a few minutes)", file=sys.stderr)
    where = "import cmeel, pathlib; print(pathlib.Path(cmeel.__file__).parent.parent / 'cmeel.prefix')"
    prefix = Path(command([python, "-c", where], "finding Pinocchio", "delete target/peers and try again").strip())
    PLACE.mkdir(parents=True, exist_ok=True)
    words = ["g++", "-w", "-std=c++17", "-O2", "-DNDEBUG", "-DPINOCCHIO_ENABLE_TEMPLATE_INSTANTIATION"]
    words += ["-DBOOST_MPL_LIMIT_LIST_SIZE=30", "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS"]
    words += [f"-I{prefix}/include", f"-I{prefix}/include/eigen3", sources[0], "-o", program]
    words += [f"-L{prefix}/lib", "-lpinocchio_default", f"-Wl,-rpath,{prefix}/lib"]
    command(words, "compiling pinocchio-peer", "install g++, or leave Pinocchio out with --only")
    return program


def main():
    """Prepares everything, then hands over to compare.py inside the virtual environment."""
    options = arguments()
    python = environment()
    words = [python, HERE / "compare.py", "--triad", build_triad(), "--place", PLACE]
    if "pinocchio" in options.only:
        words += ["--pinocchio", build_pinocchio(python)]
    words += ["--only", ",".join(options.only), "--problems", ",".join(options.problems)]
    words += ["--limit", options.limit, "--budget", options.budget, "--rounds", options.rounds]
    words += ["--quick"] * options.quick + ["--json"] * options.json
    words += ["--out", options.out.resolve()] if options.out else []
    threads = {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")}
    quiet = {"PYTHONDONTWRITEBYTECODE": "1", **threads}
    # Some programs write logs into the folder that they are started in.
    PLACE.mkdir(parents=True, exist_ok=True)
    sys.exit(subprocess.run([str(w) for w in words], env={**os.environ, **quiet}, cwd=PLACE, check=False).returncode)


if __name__ == "__main__":
    main()
