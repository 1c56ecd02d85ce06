"""`make book`: the lessons as pages in build/book/html that need neither a kernel nor a server nor the network.

The pages of book/, the executed notebooks and what ships with the results are gathered in one folder, and Sphinx makes
the rest (book/conf.py). `make book EDITION=instructor` adds the exam and the instructor's pages, which hold the
solutions, in build/book/instructor.
"""

import contextlib
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))  # so that `tools.course` is found

BUILD = ROOT / "build/book"
INSTRUCTOR = re.compile(r"<!-- instructor -->\n(.*?)<!-- end -->\n", re.S)  # in a page, for this edition only
# lesson -> where it trains, its reader in the book trains in the page: {words: the address of trap.html}
LEARNED = {
    "the_trap": {"both aids": "learn=bootstrapped&agents=2&drives=500", "plain SAC": "learn=sac&agents=2&drives=500"},
    "the_barrier": {
        "plain SAC": "learn=sac&agents=4&drives=600",
        "the same, γ = 0.95": "learn=sac&agents=4&drives=600&gamma=0.95",
    },
    "soft_constraint": {
        "ξ = 200 α": "learn=soft&agents=2&drives=600&xi=200",
        "ξ stays at 2": "learn=soft&agents=2&drives=600&xiFixed=2",
        "ξ = 0": "learn=soft&agents=2&drives=600&xi=0",
    },
    "learning_from_demonstrations": {
        "c = 2": "learn=bootstrapped&agents=2&drives=600&c=2",
        "c = 0": "learn=bootstrapped&agents=2&drives=600&c=0",
    },
}
AFTER = {"soft_constraint": "figures.courses("}  # lesson -> in the code of the cell below which it trains
BEFORE_THE_RULE = ("the_trap", "the_barrier")  # the sliders of the page that learns are of later lessons
BY_HAND = re.compile(r'<div class="bc-by-hand">.*?</div>')  # how to answer a prediction, which takes a kernel
WORLD = re.compile(r'<img [^>]*data-world="([^"]*)"[^>]*>')  # the picture that a world leaves where no kernel runs
SOLVED = re.compile(r"\[([^]]*)\]\(\.\./solved/([^)]*)\)")


def gather(to: Path, edition: str = "student") -> None:
    """Put all that the book is made of into the folder `to`. edition: student, or instructor with the solutions."""
    from bootcourse.web import build as drive_page
    from tools.course import instructor, paper_map
    from tools.course.claims import claims_page, fill_in
    from tools.course.numbering import resolved, text_file

    shutil.rmtree(to, ignore_errors=True)
    shutil.copytree(ROOT / "book", to)
    shutil.copytree(ROOT / "assets/report", to / "report")
    shutil.copytree(ROOT / "assets/readme", to / "pictures")
    shutil.copy(ROOT / "assets/checks.md", to)
    drive_page.main(["--out", str(to / "whole/trap.html")])
    if edition != "instructor":
        (to / "teaching/exam.md").unlink()
    (to / "paper_map.md").write_text(paper_map.page(), encoding="utf-8")
    for page in (*to.glob("*.md"), *to.glob("teaching/*.md")):
        text = INSTRUCTOR.sub(r"\1" if edition == "instructor" else "", page.read_text(encoding="utf-8"))
        up = "" if page.parent == to else "../"
        page.write_text(resolved(fill_in(as_linked_here(text, up)), f"{up}lessons/"), encoding="utf-8")
    (to / "lessons/instructor").mkdir(parents=True)
    for notebook in sorted((ROOT / "notebooks").glob("*.ipynb")):
        as_a_page(notebook, to / "lessons" / notebook.name)
        lesson = notebook.stem.partition("_")[2]
        if lesson in LEARNED:
            add_learning(
                to / "lessons" / notebook.name,
                LEARNED[lesson],
                AFTER.get(lesson, ".run("),
                folded=lesson in BEFORE_THE_RULE,
            )
        if edition != "instructor":
            continue
        # The solved notebooks are not in the book: the page has the solutions itself, and says where they lie.
        text = SOLVED.sub(r"\1 (`make solved` writes `notebooks/solved/\2`)", instructor.page(text_file(lesson)))
        (to / "lessons/instructor" / notebook.with_suffix(".md").name).write_text(text, encoding="utf-8")
    shutil.copy(ROOT / "bootcourse/course/lessons/README.md", to / "add_a_lesson.md")
    (to / "claims.md").write_text(claims_page(), encoding="utf-8")


def as_linked_here(text: str, up: str) -> str:
    """A page of book/, which is read in the repository, too, with its links as they are in the book.

    up: the way from the page to the book's first folder.
    """
    text = re.sub(r"\]\((?:\.\./)*bootcourse/course/lessons/(\w+)/text\.py", rf"]({up}lessons/\1.ipynb", text)
    return re.sub(r"\]\((?:\.\./)*assets/", f"]({up}", text).replace("](paper_map.toml)", "](paper_map.md)")


def frame(address: str, height: int) -> str:
    """The page that drives, within a lesson's page, so many pixels high."""
    page = f'<iframe src="../trap.html#{address}" title="The trap" loading="lazy"'
    return f'{page} style="width: 100%; height: {height}px; border: 0"></iframe>'


def as_a_page(notebook: Path, to: Path) -> None:
    """Copy a notebook as it came, with the page that drives in the place of each world, which needs a kernel, and
    sliders that move on its panels.

    The first word of what JupyterLab folds is bold again. How much of the lesson is done, and how to answer, go.
    """
    from bootcourse.course.predictions import NOTHING
    from tools import draggable

    content, lesson = json.loads(as_it_came(notebook)), notebook.stem.partition("_")[2]
    for cell in content["cells"]:
        moves = draggable.page_of(lesson, "".join(cell["source"])) if cell["cell_type"] == "code" else None
        if is_folded_text(cell):
            cell["source"] = re.sub(r"\A(\w+\.)\n", r"**\1** ", "".join(cell["source"]))
        outputs = [each for each in cell.get("outputs", []) if "bc-progress" not in str(each.get("data"))]
        if cell["cell_type"] == "code":
            cell["outputs"] = outputs
        for output in outputs:
            shown = output.get("data", {})
            for mime in {"text/html", "text/plain"} & {*shown}:
                shown[mime] = BY_HAND.sub("", "".join(shown[mime])).replace(f"{NOTHING} ", "")
            if address := WORLD.search("".join(shown.get("text/html", ""))):
                output["data"] = {"text/html": frame(address[1], 750), "text/plain": shown["text/plain"]}
            elif moves and "data:image/svg+xml" in "".join(shown.get("text/html", "")):
                output["data"] = {"text/html": moves, "text/plain": shown["text/plain"]}
    to.write_text(json.dumps(content), encoding="utf-8")


def is_folded_text(cell: dict) -> bool:
    return cell["cell_type"] == "markdown" and cell["metadata"].get("jupyter", {}).get("source_hidden", False)


def says_what_is_seen(cell: dict) -> bool:
    """Whether a cell is folded, or begins with **See.** or **Explain.**, which are not where no prediction is asked."""
    text = "".join(cell["source"]) if cell["cell_type"] == "markdown" else ""
    return is_folded_text(cell) or text.startswith(("**See.**", "**Explain.**"))


def add_learning(notebook: Path, addresses: dict[str, str], after: str = ".run(", folded: bool = False) -> None:
    """Let agents learn in a lesson's page in the book: one page, several links.

    It stands in the place of the lesson's training panel, which needs a kernel, or below what is said of the first
    training. after: in the code of that cell. folded: its sliders are not explained yet.
    """
    from bootcourse.markup import html

    content = json.loads(notebook.read_text(encoding="utf-8"))
    links = " · ".join(
        html('<a href="../trap.html#{}" target="learn">{}</a>', address, words) for words, address in addresses.items()
    )
    first = next(iter(addresses.values())).replace("&", "&amp;")
    shown = frame(first, 855).replace("<iframe ", '<iframe name="learn" ')
    said = f"<p>Train agents here, in this page, and move the sliders while they learn: {links}</p>{shown}"
    if folded:
        summary = "<summary>Train agents in this page (later lessons explain the sliders)</summary>"
        said = f"<details>{summary}{said}</details>"
    cells = content["cells"]
    code = {i: "".join(cell["source"]) for i, cell in enumerate(cells) if cell["cell_type"] == "code"}
    if panels := [i for i, text in code.items() if "train_panel(" in text]:
        output = {"output_type": "display_data", "metadata": {}, "data": {"text/html": said, "text/plain": ""}}
        cells[panels[0]]["outputs"] = [output]
    else:
        trains = next(i for i, text in code.items() if after in text)
        below = next((i for i in range(trains, len(cells)) if says_what_is_seen(cells[i])), trains)
        cells.insert(below + 1, {"cell_type": "markdown", "id": "learn", "metadata": {}, "source": said})
    notebook.write_text(json.dumps(content), encoding="utf-8")


def build(source: Path, html: Path) -> int:
    """Sphinx's exit status; every warning is an error."""
    from sphinx.cmd.build import main

    return main(["-b", "html", "-q", "-W", "--keep-going", "-d", str(html.parent / "doctrees"), str(source), str(html)])


def as_it_came(notebook: Path) -> bytes:
    """A notebook as git's index holds it, without later work in it; the file itself where there is no git."""
    return from_git(notebook.parent, "show", f":./{notebook.name}") or notebook.read_bytes()


def worked_in() -> list[str]:
    """The lessons' notebooks that differ from the index; none where git does not say."""
    told = from_git(ROOT, "diff", "--name-only", "--", "notebooks/*.ipynb").decode().splitlines()
    return [Path(name).name for name in told if Path(name).parent.name == "notebooks"]


def from_git(folder: Path, *command: str) -> bytes:
    """What a command of git's says in a folder; nothing where git is missing or refuses."""
    with contextlib.suppress(OSError, subprocess.CalledProcessError):
        return subprocess.run(["git", "-C", str(folder), *command], capture_output=True, check=True).stdout
    return b""


def main(edition: str = "student") -> int:
    if edition not in ("student", "instructor"):
        print(f"EDITION={edition}: choose student or instructor.", file=sys.stderr)
        return 2
    html = BUILD / ("html" if edition == "student" else edition)
    if worked := worked_in():
        print(f"The book shows these notebooks as they came, without your work: {', '.join(worked)}.", file=sys.stderr)
        print("To show one as it is now: `git add` it.", file=sys.stderr)
    gather(BUILD / "source", edition)
    status = build(BUILD / "source", html)
    if status == 0:
        print(f"The book: {(html / 'index.html').as_uri()}")
    return status


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
