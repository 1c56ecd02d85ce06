"""An invented class, to grade: `python -m tests.classroom [--students 40] [FOLDER]` makes it, grades it, says how long.

Most students answer every exercise, rightly or wrongly, each in a text of their own; some hand in nothing, damaged
files, endless loops, or attacks.
"""

import argparse
import inspect
import json
import random
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import nbformat

from bootcourse.course.classroom.answers import names_in, pieces, with_needs
from bootcourse.course.classroom.submission import FORMAT, fingerprint
from bootcourse.course.lessons import registry
from tests.answers import IMPORTS, RIGHT, WRONG

ATTACKS = {
    "exits": "import os\nos._exit(0)",
    "kills": "import os\nfor process in (os.getppid(), {pid}, 1):\n    os.kill(process, 9)",
    "calls home": "import socket\nsocket.create_connection(('127.0.0.1', {port}), 2)",
    "writes": "open({target!r}, 'w').write('mine')",
    "deletes": "import shutil\nshutil.rmtree({folder!r}, ignore_errors=True)\nshutil.rmtree({folder!r})",
    "spies": "print(open('/proc/{pid}/environ').read())\nraise ValueError('seen')",
    "fills": "x = bytearray(10**12)",
    "recurses": "def f():\n    return f()\nf()",
    "scribbles": "print('<script>alert(1)</script>' * 10**5)\nraise ValueError('<script>alert(1)</script>')",
    "detaches": "import os\nif os.fork() == 0:\n    os.setsid()\n    while True:\n        pass\n1 / 0",
    "cheats": "import os, sys\nsys.stdout.write('{{\"kind\": \"passed\"}}')\nos.write(1, b'passed')",
}


def sources(name: str, functions: list) -> list[str]:
    """The texts of test answers, each with what it needs and under the exercise's name."""
    found = []
    for function in functions:
        text = re.search(r"^def .*", inspect.getsource(function), re.M | re.S)
        if text is None or "solution(" in text[0]:
            continue
        statements = pieces(IMPORTS) + pieces(inspect.getsource(sys.modules[function.__module__]))
        statements.append(text[0].rstrip().replace(f"def {function.__name__}(", f"def {name}(", 1))
        found.append(with_needs(len(statements) - 1, statements, [names_in(text) for text in statements]))
    return found


def texts_of(name: str) -> tuple[list[str], list[str]]:
    """(right answers, wrong answers) to an exercise."""
    return sources(name, RIGHT[name]), sources(name, [function for function, _ in WRONG[name]])


def body(name: str, lines: str) -> str:
    """An answer that does something else instead."""
    return f"def {name}({', '.join(registry()[name].arguments)}):\n" + "\n".join(
        f"    {line}" for line in lines.splitlines()
    )


def submission(answers: dict[str, str], name: str, **more) -> str:
    """A submission as `bootcourse submit` writes it."""
    told = {"format": FORMAT, "name": name, "answers": answers, "exercises": fingerprint(), "made": "2030-01-01"}
    return json.dumps(told | more)


def notebook(answers: dict[str, str]) -> str:
    """The same answers in a notebook."""
    cells = [nbformat.v4.new_code_cell(f"{text}\n\n\ncheck.{name}({name})") for name, text in answers.items()]
    return nbformat.writes(nbformat.v4.new_notebook(cells=cells))


def make(folder: Path, students: int, exercises: list[str], attacks: dict[str, str], seed: int = 0) -> None:
    """Write a class: `students` honest ones, then one of each special kind. Every honest text differs."""
    rng, texts = random.Random(seed), {name: found for name in exercises if (found := texts_of(name))[0]}
    folder.mkdir(parents=True)
    for number in range(students):
        skill, answers = rng.random(), {}
        for name, (right, wrong) in texts.items():
            chosen = rng.choice(right if rng.random() < skill or not wrong else wrong)
            answers[name] = f"# by student {number}\n{chosen}"
        made = {"5.1": {"question": "How many?", "answer": rng.choice(["none", "one", "two"])}}
        if number % 4:
            (folder / f"student-{number:02}.json").write_text(
                submission(answers, f"Student {number}", predictions=made)
            )
        else:
            (folder / f"student-{number:02}").mkdir()
            (folder / f"student-{number:02}" / "all.ipynb").write_text(notebook(answers))
    first = {name: min(right, key=lambda text: ("import" in text, len(text))) for name, (right, _) in texts.items()}
    (folder / "empty").mkdir()
    (folder / "damaged.json").write_text(submission(first, "Damaged")[:200])
    (folder / "nested.json").write_text("[" * 100_000)
    (folder / "other-version.json").write_text(submission(first, "=1+1", exercises="older"))
    (folder / "twin-1.json").write_text(submission(first, "Twin 1"))
    (folder / "twin-2.json").write_text(submission({n: t.replace("\n", "\n\n") for n, t in first.items()}, "Twin 2"))
    (folder / "endless.json").write_text(submission({exercises[0]: body(exercises[0], "while True:\n    pass")}, "E"))
    for number, (what, lines) in enumerate(attacks.items()):
        name = exercises[number % len(exercises)]
        (folder / f"it-{what.replace(' ', '-')}.json").write_text(submission({name: body(name, lines)}, "<b>Mallory"))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path, default=Path(tempfile.mkdtemp()) / "class")
    parser.add_argument("--students", type=int, default=40)
    given = parser.parse_args()
    filled = {what: lines.format(pid=1, port=9, target="/tmp/bootcourse-attack", folder=str(given.folder))
              for what, lines in ATTACKS.items()}  # fmt: skip
    special = 7 + len(filled)
    make(given.folder, max(1, given.students - special), list(registry()), filled)
    started = time.monotonic()
    out = given.folder.parent / "grades.csv"
    subprocess.run([sys.executable, "-m", "bootcourse", "grade", str(given.folder), "--out", str(out)], check=True)
    print(f"{len(list(given.folder.iterdir()))} submissions, {len(registry())} exercises: "
          f"{(time.monotonic() - started) / 60:.1f} minutes.")  # fmt: skip


if __name__ == "__main__":
    main()
