"""Make the notebooks from their sources: `python tools/notebooks.py [NAME ...] [--check]`.

notebooks/source/NAME.py is the one that people edit (percent format, readable diffs). Each becomes
notebooks/NAME.ipynb, executed, with its outputs, so that it reads well without being run.
--check executes nothing: it fails when a notebook's cells differ from its source.
"""

import hashlib
import sys
from pathlib import Path

import jupytext
import nbformat
from nbclient import NotebookClient

NOTEBOOKS = Path(__file__).resolve().parent.parent / "notebooks"


def read_source(path: Path) -> nbformat.NotebookNode:
    """The notebook that a source describes, without outputs; a cell's id follows from its place and text."""
    notebook = jupytext.read(path)
    for place, cell in enumerate(notebook.cells):
        cell.id = hashlib.sha256(f"{place} {cell.source}".encode()).hexdigest()[:8]
    kernel = {"display_name": "Python 3 (ipykernel)", "language": "python", "name": "python3"}
    notebook.metadata = {"kernelspec": kernel, "language_info": {"name": "python"}}
    notebook.nbformat, notebook.nbformat_minor = 4, 5
    return notebook


def make(path: Path) -> Path:
    """Execute a source and write its notebook."""
    notebook = read_source(path)
    NotebookClient(notebook, timeout=300, resources={"metadata": {"path": NOTEBOOKS}}).execute()
    for cell in notebook.cells:
        cell.metadata.pop("execution", None)  # times of day would change with every run
    notebook.metadata.pop("widgets", None)
    notebook.metadata["language_info"] = {"name": "python"}
    target = NOTEBOOKS / f"{path.stem}.ipynb"
    nbformat.write(notebook, target)
    return target


def is_current(path: Path) -> bool:
    """Has the notebook the cells that its source describes?"""
    target = NOTEBOOKS / f"{path.stem}.ipynb"
    if not target.exists():
        return False
    cells = nbformat.read(target, as_version=4).cells
    wanted = read_source(path).cells
    return [(c.cell_type, c.source) for c in cells] == [(c.cell_type, c.source) for c in wanted]


def sources(names: list[str]) -> list[Path]:
    found = sorted((NOTEBOOKS / "source").glob("*.py"))
    return [path for path in found if not names or path.stem in names]


def main(arguments: list[str]) -> int:
    names = [a for a in arguments if not a.startswith("--")]
    if "--check" in arguments:
        stale = [path.stem for path in sources(names) if not is_current(path)]
        if stale:
            print(f"Out of date: {', '.join(stale)}. Run: make notebooks")
        return bool(stale)
    for path in sources(names):
        print(make(path))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
