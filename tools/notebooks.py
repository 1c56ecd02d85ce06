"""Make the notebooks from their sources: `python tools/notebooks.py [NAME ...] [--prose | --check]`.

notebooks/source/NAME.py is the one that people edit (percent format, readable diffs). Each becomes
notebooks/NAME.ipynb, executed, with its outputs, so that it reads well without being run.
--prose executes nothing where only the text between the code has changed.
--check writes nothing: it fails when a notebook's cells differ from its source.
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
        if cell.cell_type == "code":
            cell.outputs = tidy(cell.outputs)
    notebook.metadata.pop("widgets", None)
    notebook.metadata["language_info"] = {"name": "python"}
    target = NOTEBOOKS / f"{path.stem}.ipynb"
    nbformat.write(notebook, target)
    return target


def refresh_prose(path: Path) -> bool:
    """Take over a source's text and keep the outputs; False where the code has changed, too."""
    target, notebook = NOTEBOOKS / f"{path.stem}.ipynb", read_source(path)
    if not target.exists():
        return False
    old = [cell for cell in nbformat.read(target, as_version=4).cells if cell.cell_type == "code"]
    new = [cell for cell in notebook.cells if cell.cell_type == "code"]
    if [cell.source for cell in old] != [cell.source for cell in new]:
        return False
    for before, after in zip(old, new, strict=True):
        after.outputs, after.execution_count = before.outputs, before.execution_count
    nbformat.write(notebook, target)
    return True


def tidy(outputs: list) -> list:
    """Without progress bars, which say nothing when they stand still; lines printed one by one as one output."""
    kept = []
    for output in outputs:
        if output.output_type == "stream" and output.name == "stderr" and "%|" in output.text:
            continue
        if output.output_type == "stream" and kept and kept[-1].get("name") == output.name:
            kept[-1].text += output.text
        else:
            kept.append(output)
    return kept


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
        if not ("--prose" in arguments and refresh_prose(path)):
            print(make(path))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
