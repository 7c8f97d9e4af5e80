"""The notebooks run, the README's code does, and the types hold."""

import pathlib
import subprocess
import sys

import nbformat
import numpy as np
import pytest
from nbclient import NotebookClient

import triad

HERE = pathlib.Path(__file__).parent.parent
BOOKS = sorted((HERE / "notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("path", BOOKS, ids=[path.stem for path in BOOKS])
def test_notebooks_run_and_show_pictures(path):
    book = nbformat.read(path, as_version=4)
    assert not any(cell.get("outputs") for cell in book.cells), "notebooks are kept without results"
    done = NotebookClient(book, timeout=300, kernel_name="python3").execute()
    shown = [output for cell in done.cells for output in cell.get("outputs", ())]
    assert any("image/svg+xml" in output.get("data", {}) for output in shown)
    assert len(BOOKS) == 2


def test_the_code_of_the_readme_runs():
    text = (HERE / "README.md").read_text()
    names = {"np": np}
    blocks = text.split("```python\n")[1:]
    assert len(blocks) >= 5
    for block in blocks:
        code = block.split("```")[0]
        if "r.reactions(\"pin\"" in code:
            names["r"] = triad.run("simple-pendulum", until=0.1)
        if "System(" in code:
            system = triad.System("spatial-chain:3")
            names.update(q=system.q0, v=system.v0, t=0.0)
        exec(code.replace("samples=1000", "samples=3"), names)  # noqa: S102
    assert names["pin"].force.shape == (11, 3)


def test_types_hold():
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--ignore-missing-imports", "--cache-dir", "/dev/null", "-p", "triad"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout
