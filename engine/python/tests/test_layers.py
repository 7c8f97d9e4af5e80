"""Modules of the package import in one direction."""

import ast
from graphlib import TopologicalSorter
from pathlib import Path

import triad


def test_no_module_imports_itself_by_way_of_others():
    found = {}
    for file in Path(triad.__file__).parent.glob("_*.py"):
        if file.stem == "__init__":
            continue
        # Everywhere: for types only and within functions too.
        imports = [node for node in ast.walk(ast.parse(file.read_text("utf-8"))) if isinstance(node, ast.ImportFrom) and node.level == 1]
        named = [node.module for node in imports if node.module] + [a.name for node in imports if not node.module for a in node.names]
        found[file.stem] = {name for name in named if name != "_native"}
    assert found["_run"] >= {"_viewer", "_scene"}
    TopologicalSorter(found).prepare()
