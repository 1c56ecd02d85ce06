"""From one source: the student's notebook, the solved one, and the instructor's page.

Both notebooks come from one run. Where a cell holds a solution, the kernel first runs the student's stub
and then the solution, whose check must pass; all other cells run once and serve both.
"""

import hashlib
import re
from collections import Counter
from pathlib import Path

import nbformat
from nbclient import NotebookClient

from bootcourse.course.lessons import LESSONS, stem
from tools.course.claims import filled
from tools.course.instructor import page
from tools.course.numbering import NOTEBOOKS
from tools.course.source import Cell, one_folder_down, read, sources

WIDGET = "application/vnd.jupyter.widget-view+json"
SOLVED_NOTE = (
    "*This notebook is solved: each exercise holds a right answer. The one to work in is [{0}](../{0}.ipynb).*"
)
PYTHON = {
    "kernelspec": {"display_name": "Python 3 (ipykernel)", "language": "python", "name": "python3"},
    "language_info": {"name": "python"},
}
STRICT = "check.strict()  # in this notebook every check must pass"
IMPORTS_CHECK = re.compile(r"^from bootcourse\.course import (?:.*|\([^)]*)\bcheck\b", re.M)


def student_file(path: Path) -> Path:
    return path.parent.parent / f"{stem(path.stem)}.ipynb"


def solved_file(path: Path) -> Path:
    return path.parent.parent / "solved" / f"{stem(path.stem)}.ipynb"


def instructor_file(path: Path) -> Path:
    return path.parent.parent / "instructor" / f"{stem(path.stem)}.md"


def documents(path: Path) -> dict[Path, nbformat.NotebookNode]:
    """The notebooks that a source describes, without outputs; a source without solutions has no solved one."""
    cells = [cell for cell in filled(path) if not cell.for_instructor]
    targets = {student_file(path): notebook([node(cell, cell.student) for cell in cells])}
    if any(cell.is_exercise for cell in cells):
        targets[solved_file(path)] = notebook(solved_nodes(path, cells))
    return targets


def solved_nodes(path: Path, cells: list[Cell]) -> list[nbformat.NotebookNode]:
    """The solved notebook's cells: a note where one is, and strict checks from the import on."""
    nodes = [nbformat.v4.new_markdown_cell(SOLVED_NOTE.format(stem(path.stem)))]
    for cell in cells:
        nodes.append(node(cell, cell.solved if cell.is_code else one_folder_down(cell.solved)))
        if cell.is_code and IMPORTS_CHECK.search(cell.solved):
            nodes.append(nbformat.v4.new_code_cell(STRICT))
    return nodes


def node(cell: Cell, text: str) -> nbformat.NotebookNode:
    new = nbformat.v4.new_code_cell if cell.is_code else nbformat.v4.new_markdown_cell
    return new(text, metadata=cell.metadata)


def notebook(nodes: list[nbformat.NotebookNode]) -> nbformat.NotebookNode:
    """A notebook of these cells. The id of an exercise's cell follows from its name, so that the update of a handout
    finds it when its text has changed; the id of any other cell follows from its text.
    """
    times = Counter()
    for cell in nodes:
        exercise = re.search(r"^check\.(\w+)\(\1\)", cell.source, re.M)
        times[cell.source] += 1
        text = f"{times[cell.source]} {cell.source}"
        cell.id = f"exercise-{exercise[1]}" if exercise else hashlib.sha256(text.encode()).hexdigest()[:12]
    return nbformat.v4.new_notebook(cells=nodes, metadata=PYTHON)


def make(path: Path) -> list[Path]:
    """Execute a source and write all that comes from it. Raises what a cell raises, and where a check fails."""
    targets = documents(path)
    outputs = execute(path)
    for document in targets.values():
        fill_in(document, outputs)
    return write(path, targets)


def execute(path: Path) -> dict[str, list]:
    """Run every code cell, a solution after its stub: text of the cell -> its outputs, one for each time it stands."""
    steps = []
    for cell in read(path):
        if cell.is_code:
            steps.append(cell.student)
            if cell.is_exercise:
                steps += ["check.strict()", cell.solved, "check.strict(False)"]
    if answers := list(path.parent.parent.glob("answers/*.*")):
        raise ValueError(f"Move {answers[0].parent} away: the notebooks would be made with these answers.")
    ran = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(step) for step in steps], metadata=PYTHON)
    NotebookClient(ran, timeout=300, resources={"metadata": {"path": path.parent.parent}}).execute()
    outputs = {STRICT: [[]]}
    for cell in ran.cells:
        outputs.setdefault(cell.source, []).append(tidy(cell.outputs))
    return outputs


def fill_in(document: nbformat.NotebookNode, outputs: dict[str, list]) -> None:
    """Give each code cell its outputs and its number."""
    stood, code = {}, [cell for cell in document.cells if cell.cell_type == "code"]
    for number, cell in enumerate(code, start=1):
        time = stood.get(cell.source, 0)
        stood[cell.source] = time + 1
        cell.execution_count, cell.outputs = number, [nbformat.from_dict(o) for o in outputs[cell.source][time]]
        for output in cell.outputs:
            if output.output_type == "execute_result":
                output.execution_count = number


def tidy(outputs: list) -> list:
    """Without progress bars, which say nothing when they stand still; lines printed one by one as one output.

    A widget that shows a picture as well keeps the picture: it works only while its kernel runs.
    """
    tidied = []
    for output in outputs:
        data = output.get("data", {})
        if "text/html" in data:
            data.pop(WIDGET, None)
        if output.output_type == "stream" and output.name == "stderr" and "%|" in output.text:
            continue
        if WIDGET in data and "%|" in data.get("text/plain", ""):
            continue
        if output.output_type == "stream" and tidied and tidied[-1].get("name") == output.name:
            tidied[-1].text += output.text
        else:
            tidied.append(output)
    return tidied


def write(path: Path, targets: dict[Path, nbformat.NotebookNode]) -> list[Path]:
    for target, document in targets.items():
        target.parent.mkdir(exist_ok=True)
        nbformat.write(document, target)
    instructor_file(path).parent.mkdir(exist_ok=True)
    instructor_file(path).write_text(page(path), encoding="utf-8")
    return [*targets, instructor_file(path)]


def remove_strange() -> list[Path]:
    """Remove what was made of a lesson under another number. A notebook of somebody's own stays. Returns what goes."""
    targets = {file(path) for path in sources() for file in (student_file, solved_file, instructor_file)}
    folders = NOTEBOOKS.glob("*.ipynb"), NOTEBOOKS.glob("solved/*.ipynb"), NOTEBOOKS.glob("instructor/*.md")
    ours = re.compile(rf"\d\d_({'|'.join(LESSONS)})")
    strange = [path for folder in folders for path in folder if path not in targets and ours.fullmatch(path.stem)]
    for path in strange:
        path.unlink()
    return strange


def refresh_prose(path: Path) -> list[Path]:
    """Take over a source's text and keep the outputs. Returns what is written: [] where the code has changed, too."""
    targets = documents(path)
    for target, document in targets.items():
        if not target.exists():
            return []
        old = [cell for cell in nbformat.read(target, as_version=4).cells if cell.cell_type == "code"]
        new = [cell for cell in document.cells if cell.cell_type == "code"]
        if [cell.source for cell in old] != [cell.source for cell in new]:
            return []
        for before, after in zip(old, new, strict=True):
            after.outputs, after.execution_count = before.outputs, before.execution_count
    return write(path, targets)


def out_of_date(path: Path) -> list[Path]:
    """The generated files that are not what their source says, or are missing."""
    targets = documents(path)
    late = [target for target, document in targets.items() if not same_cells(target, document)]
    target = instructor_file(path)
    if not target.exists() or target.read_text(encoding="utf-8") != page(path):
        late.append(target)
    return late + [target for target in (solved_file(path),) if target not in targets and target.exists()]


def same_cells(target: Path, document: nbformat.NotebookNode) -> bool:
    if not target.exists():
        return False
    cells = nbformat.read(target, as_version=4).cells
    return [(c.cell_type, c.source) for c in cells] == [(c.cell_type, c.source) for c in document.cells]
