"""What the tests share."""

import os
import pathlib
import subprocess

import pytest

ROOT = pathlib.Path(__file__).parents[3]


@pytest.fixture(scope="session")
def program():
    """Runs the program `triad`, and gives what it printed."""
    path = os.environ.get("TRIAD_PROGRAM", str(ROOT / "target/release/triad"))
    if not os.path.exists(path):
        pytest.skip(f"no program at {path}: `cargo build --release -p triad` makes it, or set TRIAD_PROGRAM")

    def run(*words):
        done = subprocess.run([path, *words], capture_output=True, text=True, check=False)
        assert done.returncode in (0, 1), done.stderr
        return done.stdout

    return run
