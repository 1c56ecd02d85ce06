"""From a lesson's text: the student's notebook, and on demand the solved one and the instructor's page.

Where a cell holds a solution, the kernel first runs the student's stub and then the solution, whose check must pass;
all other cells run once. The solved notebook takes its outputs from the student's.
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
from tools.course.source import Cell, lesson_of, one_folder_down, read, sources

WIDGET = "application/vnd.jupyter.widget-view+json"
SOLVED_NOTE = (
    "*This notebook is solved: each exercise holds a right answer. The one to work in is [{0}](../{0}.ipynb).*"
)
PYTHON = {
    "kernelspec": {"display_name": "Python 3 (ipykernel)", "language": "python", "name": "python3"},
    "language_info": {"name": "python"},
}
SAYS_THE_ANSWER = ("**See.**", "**Explain.**")
GOES_ON = re.compile(r"\n\n(?=> \*\*Predict|\*\*Exercise|\*\*Drag\*\*|\*\*Slide\.\*\*|## )")
STRICT = "check.strict()  # in this notebook every check must pass"
WALL_OF_IMPORTS = re.compile(r"(?:import|from) (?:.*\n){3}")  # four lines or more of a cell that begins so
IMPORTS_CHECK = re.compile(r"^from bootcourse\.course import (?:.*|\([^)]*)\bcheck\b", re.M)


def student_file(path: Path) -> Path:
    return path.parents[4] / "notebooks" / f"{stem(lesson_of(path))}.ipynb"


def solved_file(path: Path) -> Path:
    return student_file(path).parent / "solved" / student_file(path).name


def instructor_file(path: Path) -> Path:
    return student_file(path).parent / "instructor" / f"{student_file(path).stem}.md"


def student_notebook(path: Path) -> nbformat.NotebookNode:
    """The notebook that a text describes for the student, without outputs."""
    return notebook(folded([node(cell, cell.student) for cell in filled(path) if not cell.for_instructor]))


def folded(nodes: list[nbformat.NotebookNode]) -> list[nbformat.NotebookNode]:
    """The cells, of which JupyterLab folds what answers a prediction; a form that is committed opens it again.

    That is every output from `predicted(` on, and the text below that says what is to be seen in them, but for its
    first word: JupyterLab shows the first line of what it folds, as it is typed, so this word is plain. Where the text
    goes on with the next question, exercise or round, this part becomes a cell of its own, which stays open. The table
    of all answers is folded, too, and so is a wall of imports.
    """
    shown, answering = [], False
    for cell in nodes:
        if cell.cell_type == "code" and WALL_OF_IMPORTS.match(cell.source):
            cell.metadata["jupyter"] = {"source_hidden": True}
            cell.metadata["tags"] = [*cell.metadata.get("tags", []), "hide-input"]
    for cell in nodes:
        answering = answering or cell.cell_type == "code" and bool(re.search(r"^predicted\(", cell.source, re.M))
        shown.append(cell)
        answers_all = cell.cell_type == "code" and bool(re.search(r"^compare_predictions\(", cell.source, re.M))
        if cell.cell_type == "code" and (answering or answers_all):
            cell.metadata["jupyter"] = {"outputs_hidden": True}
        elif answering:
            said, *goes_on = GOES_ON.split(cell.source, maxsplit=1)
            if said.startswith(SAYS_THE_ANSWER):
                cell.source = re.sub(r"\A\*\*(\w+\.)\*\*\s", r"\1\n", said)
                cell.metadata["jupyter"] = {"source_hidden": True}
                shown += map(nbformat.v4.new_markdown_cell, goes_on)
            answering = not (said.startswith(SAYS_THE_ANSWER) or goes_on or GOES_ON.match("\n\n" + said))
    return shown


def solved_notebook(path: Path) -> nbformat.NotebookNode | None:
    """The one with the solutions, without outputs; None where the lesson has no exercise."""
    cells = [cell for cell in filled(path) if not cell.for_instructor]
    return notebook(solved_nodes(path, cells)) if any(cell.is_exercise for cell in cells) else None


def solved_nodes(path: Path, cells: list[Cell]) -> list[nbformat.NotebookNode]:
    """The solved notebook's cells: a note where one is, and strict checks from the import on."""
    nodes = [nbformat.v4.new_markdown_cell(SOLVED_NOTE.format(stem(lesson_of(path))))]
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


def make(path: Path) -> Path:
    """Execute a text and write the notebook. Raises what a cell raises, and where a solution's check fails."""
    document = student_notebook(path)
    if not student_file(path).exists():
        student_file(path).parent.mkdir(exist_ok=True)
        write(path, document)  # the card of the lesson's progress counts the predictions in this file
    fill_in(document, execute(path))
    return write(path, document)


def make_solved(path: Path) -> list[Path]:
    """Write the solved notebook and the instructor's page. Returns what is written.

    Nothing is executed: what the student's notebook has, too, takes its outputs; a solution has none.
    """
    written = [instructor_file(path)]
    if document := solved_notebook(path):
        ran = nbformat.read(student_file(path), as_version=4).cells
        outputs = {}
        for cell in ran:
            outputs.setdefault(cell.source, []).append(cell.get("outputs", []))
        fill_in(document, outputs)
        solved_file(path).parent.mkdir(exist_ok=True)
        nbformat.write(document, solved_file(path))
        written.append(solved_file(path))
    instructor_file(path).parent.mkdir(exist_ok=True)
    instructor_file(path).write_text(page(path), encoding="utf-8")
    return written


def execute(path: Path) -> dict[str, list]:
    """Run every code cell, a solution after its stub: text of the cell -> its outputs, one for each time it stands."""
    steps = ["from bootcourse.course import check as _check; _check.keep_nothing(); del _check"]
    for cell in read(path):
        if cell.is_code:
            steps.append(cell.student)
            if cell.is_exercise:
                steps += ["check.strict()", cell.solved, "check.strict(False)"]
    notebooks = student_file(path).parent
    if answers := list(notebooks.glob("answers/*.*")):
        raise ValueError(f"Move {answers[0].parent} away: the notebooks would be made with these answers.")
    ran = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(step) for step in steps], metadata=PYTHON)
    NotebookClient(ran, timeout=300, resources={"metadata": {"path": notebooks}}).execute()
    outputs = {}
    for cell in ran.cells:
        outputs.setdefault(cell.source, []).append(tidy(cell.outputs))
    return outputs


def fill_in(document: nbformat.NotebookNode, outputs: dict[str, list]) -> None:
    """Give each code cell its outputs, none where it did not run, and its number."""
    stood, code = {}, [cell for cell in document.cells if cell.cell_type == "code"]
    for number, cell in enumerate(code, start=1):
        time = stood.get(cell.source, 0)
        stood[cell.source] = time + 1
        shown = outputs[cell.source][time] if cell.source in outputs else []
        cell.execution_count, cell.outputs = number, [nbformat.from_dict(output) for output in shown]
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


def write(path: Path, document: nbformat.NotebookNode) -> Path:
    nbformat.write(document, student_file(path))
    return student_file(path)


def remove_strange() -> list[Path]:
    """Remove what was made of a lesson under another number. A notebook of somebody's own stays. Returns what goes."""
    targets = {file(path) for path in sources() for file in (student_file, solved_file, instructor_file)}
    folders = NOTEBOOKS.glob("*.ipynb"), NOTEBOOKS.glob("solved/*.ipynb"), NOTEBOOKS.glob("instructor/*.md")
    ours = re.compile(rf"\d\d_({'|'.join(LESSONS)})")
    strange = [path for folder in folders for path in folder if path not in targets and ours.fullmatch(path.stem)]
    for path in strange:
        path.unlink()
    return strange


def refresh_prose(path: Path) -> Path | None:
    """Take over a lesson's text and keep the outputs. Returns what is written; None where the code has changed, too."""
    document = student_notebook(path)
    if not student_file(path).exists():
        return None
    old = [cell for cell in nbformat.read(student_file(path), as_version=4).cells if cell.cell_type == "code"]
    new = [cell for cell in document.cells if cell.cell_type == "code"]
    if [cell.source for cell in old] != [cell.source for cell in new]:
        return None
    for before, after in zip(old, new, strict=True):
        after.outputs, after.execution_count = before.outputs, before.execution_count
    return write(path, document)


def is_out_of_date(path: Path) -> bool:
    """Is the student's notebook not what the text says, or missing?"""
    if not student_file(path).exists():
        return True
    cells = nbformat.read(student_file(path), as_version=4).cells
    return [(c.cell_type, c.source) for c in cells] != [(c.cell_type, c.source) for c in student_notebook(path).cells]
