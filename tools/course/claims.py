"""The claims of the lessons: every number in their text, and where it comes from.

notebooks/claims/NAME.toml lists them in the order of the text (notebooks/source/README.md says how).
`claims_problems` holds a lesson to its file, `claims_page` shows all of them to readers.
"""

import ast
import html
import json
import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from tools.course.instructor import in_table, title
from tools.course.products import solved_file, student_file
from tools.course.prose import Line, Number, digits, in_words, prose, sentences
from tools.course.source import NOTEBOOKS, read, sources

KINDS = ("is", "holds", "shown", "paper", "example")
PLACE = re.compile(r"\b(?:Section|Table|Equation|Algorithm|Figure|arXiv) [IVX\d]")


@dataclass(frozen=True)
class Claim:
    """A piece of a lesson's text and its evidence, of one of the `KINDS`."""

    says: str
    kind: str
    evidence: str

    @property
    def begins(self) -> str:
        return f'The claim "{self.says[:60]}"'


@dataclass(frozen=True)
class Found:
    """A claim, the line of the text that it stands in, and where."""

    claim: Claim
    line: Line
    start: int

    @cached_property
    def numbers(self) -> list[Number]:
        """The numbers that its evidence is for: those that need evidence; an `is` without any is for words."""
        end = self.start + len(self.claim.says)
        inside = [number for number in self.line.numbers if self.start <= number.start and number.end <= end]
        return in_words(self.claim.says) if not inside and self.claim.kind == "is" else inside


def claims_file(path: Path) -> Path:
    return path.parent.parent / "claims" / f"{path.stem}.toml"


def claims_of(path: Path) -> list[Claim]:
    """A lesson's claims; none if it has no file. Raises ValueError for a table of another form."""
    file = claims_file(path)
    entries = tomllib.loads(file.read_text(encoding="utf-8")).get("claim", []) if file.exists() else []
    claims = []
    for entry in entries:
        kinds = [kind for kind in entry if kind != "says"]
        if "says" not in entry or len(kinds) != 1 or kinds[0] not in KINDS:
            raise ValueError(f"A claim has `says` and one of {', '.join(KINDS)}; this one is {entry}")
        claims.append(Claim(" ".join(entry["says"].split()), kinds[0], " ".join(entry[kinds[0]].split())))
    return claims


def claims_problems(path: Path, known: Mapping) -> list[str]:
    """Where a lesson's text and its claims part, as sentences; `known` is what an expression may name."""
    try:
        claims = claims_of(path)
    except ValueError as error:
        return [f"{error}."]
    lines = prose(path)
    found, problems = located(claims, lines)
    for each in found:
        problems += disagreements(each, path, known)
    return problems + uncovered(lines, found)


def located(claims: list[Claim], lines: list[Line]) -> tuple[list[Found], list[str]]:
    """Where each claim stands: at or behind the place of the one before it."""
    found, problems, row, start = [], [], 0, 0
    for claim in claims:
        places = ((i, line.text.find(claim.says, start if i == row else 0)) for i, line in enumerate(lines) if i >= row)
        place = next(((i, at) for i, at in places if at >= 0), None)
        if place is None:
            problems.append(f"{claim.begins} is not in the text, or not behind the claim before it.")
        else:
            (row, start) = place
            found.append(Found(claim, lines[row], start))
    return found, problems


def uncovered(lines: list[Line], found: list[Found]) -> list[str]:
    """The numbers that no claim is about."""
    problems = []
    for line in lines:
        covered = [number for each in found if each.line is line for number in each.numbers]
        for start, end in sentences(line.text):
            lost = [n.printed for n in line.numbers if start <= n.start < end and n not in covered]
            if lost:
                here = line.text[start:end].strip()
                problems.append(f'No claim says where {", ".join(lost)} comes from in "{here}"')
    return problems


# Evidence -------------------------------------------------------------------------------------------


def disagreements(found: Found, path: Path, known: Mapping) -> list[str]:
    """What its own evidence says against a claim."""
    claim = found.claim
    if claim.kind in ("paper", "example"):
        return of_words(found)
    if claim.kind == "shown":
        return of_shown(found, shown_by(path))
    try:
        value = evaluate(claim, known)
    except Exception as error:  # whatever an expression raises is the writer's to see
        return [f"{claim.begins}: `{claim.evidence}` gives no answer ({type(error).__name__}: {error})."]
    return of_truth(found, value) if claim.kind == "holds" else of_value(found, value)


def of_words(found: Found) -> list[str]:
    claim = found.claim
    if not found.numbers or not claim.evidence:
        return [f"{claim.begins}: `{claim.kind}` is for numbers, and says why; this one has none."]
    if claim.kind == "paper" and not PLACE.search(claim.evidence):
        return [f'{claim.begins}: "{claim.evidence}" names no section, table, equation or arXiv number.']
    return []


def evaluate(claim: Claim, known: Mapping):
    return eval(claim.evidence, dict(known))


def of_value(found: Found, value) -> list[str]:
    computed = np.ravel(np.asarray(value, dtype=float)).tolist()
    printed = [number.printed for number in found.numbers]
    agree = len(computed) == len(printed) and all(map(Number.agrees, found.numbers, computed))
    told = ", ".join(f"{each:.6g}" for each in computed)
    return [] if agree else [f"{found.claim.begins} prints {', '.join(printed) or 'no number'}; computed: {told}."]


def of_truth(found: Found, value) -> list[str]:
    """It is true, and the numbers of the text stand in the expression."""
    tree = ast.walk(ast.parse(found.claim.evidence, mode="eval"))
    constants = [node.value for node in tree if isinstance(node, ast.Constant) and type(node.value) in (int, float)]
    lost = [n for n in found.numbers if float(abs(n.value)) not in map(float, constants)]
    problems = [f"{found.claim.begins}: the {n.printed} is not in `{found.claim.evidence}`." for n in lost]
    if not isinstance(value, bool | np.bool):
        return [*problems, f"{found.claim.begins}: `{found.claim.evidence}` is {value!r}, neither true nor false."]
    return problems if value else [*problems, f"{found.claim.begins}: `{found.claim.evidence}` does not hold."]


def of_shown(found: Found, shown: str) -> list[str]:
    text = found.claim.evidence
    if text not in shown:
        return [f"{found.claim.begins}: no cell shows `{text}`."]
    there = [float(number.value) for number in digits(re.sub(r"(?<=\d)_(?=\d)", "", text))]
    lost = [number for number in found.numbers if not any(map(number.agrees, there))]
    return [f"{found.claim.begins}: the {number.printed} is not in `{text}`." for number in lost]


def shown_by(path: Path) -> str:
    """The code and the outputs of a lesson's cells as the solved notebook has them, with single spaces.

    Of pictures and tables in HTML: their text, and what stands for a picture.
    """
    file = solved_file(path) if solved_file(path).exists() else student_file(path)
    if not file.exists():
        return ""
    texts = []
    for cell in json.loads(file.read_text(encoding="utf-8"))["cells"]:
        if cell["cell_type"] == "code":
            texts.append("".join(cell["source"]))
            for output in cell["outputs"]:
                data = output.get("data", {})
                texts += ["".join(output.get("text", "")), "".join(data.get("text/markdown", ""))]
                texts += ["".join(data.get("text/plain", "")), of_html("".join(data.get("text/html", "")))]
    return " ".join(" ".join(texts).split())


def of_html(text: str) -> str:
    text = re.sub(r"<(?:style|script)\b.*?</(?:style|script)>", " ", text, flags=re.S)
    text = re.sub(r'<img\b[^>]*\balt="([^"]*)"[^>]*>', r" \1 ", text)
    text = re.sub(r"</?(?:div|p|pre|br|li|t[rhd])\b[^>]*>", " ", text)
    return html.unescape(re.sub(r"<[^>]*>", "", text))


# The page -------------------------------------------------------------------------------------------

HEAD = """# Where the numbers come from

Every number in the text of a lesson is held to its source by a test. The source is a computation on the
library or on the shipped results, a cell of the lesson that shows the number, a publication that has it, or a
question that invents it. A sentence without a number stands here if what it says can be computed."""


def claims_page(notebooks: Path = NOTEBOOKS) -> str:
    """All claims of all lessons and where each comes from, with what it computes to now, as Markdown."""
    from tools.course import known

    parts = [HEAD]
    for path in sources(notebooks=notebooks):
        rows = [row(claim, vars(known)) for claim in claims_of(path)]
        if rows:
            parts += [
                f"## {title(read(path))}",
                "\n".join(["| the lesson says | how it is known |", "|---|---|", *rows]),
            ]
    return "\n\n".join(parts) + "\n"


def row(claim: Claim, known: Mapping) -> str:
    if claim.kind in ("paper", "example"):
        words = f"{claim.kind}: {claim.evidence}"
    elif claim.kind == "shown":
        words = f"a cell shows it: {code(claim.evidence)}"
    elif claim.kind == "holds":
        words = f"{code(claim.evidence)} is true"
    else:
        values = np.ravel(np.asarray(evaluate(claim, known), dtype=float))
        words = f"{code(claim.evidence)} = {', '.join(f'{value:.6g}' for value in values)}"
    formula = "\\" in claim.says and "$" not in claim.says  # a part of one
    return f"| {in_table(code(claim.says) if formula else claim.says)} | {in_table(words)} |"


def code(text: str) -> str:
    ticks = "``" if "`" in text else "`"
    return f"{ticks}{text}{ticks}"
