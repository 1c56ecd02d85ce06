"""The answers in a student's notebook, as texts, without running anything.

An answer is what the notebook's last check of an exercise was given; without a check, it is the last definition of the
exercise's function. With it come the top-level statements that make or change what it uses, in the notebook's order, so
that such a text can be judged by itself. IPython's own transformer reads cells that have `%time`, `!ls` or `x?`.
"""

import ast
import json
import os
import re
import time
from bisect import bisect_left
from collections import defaultdict
from itertools import accumulate
from pathlib import Path
from typing import Any

import msgspec
from IPython.core.inputtransformer2 import TransformerManager
from msgspec import Raw, Struct

from bootcourse.course.lessons import registry
from bootcourse.course.names import names_changed, names_made, names_used, root_of
from bootcourse.course.verdict import MARKS
from bootcourse.errors import BootcourseError
from bootcourse.files import decoding, open_regular

LARGEST = 2**28  # bytes of a notebook with its outputs
LONGEST = 50_000  # characters of a cell, and of an answer
SECONDS = 10.0  # of the processor, however busy it is with other work, that reading a student's notebooks may take
NO_PYTHON = (SyntaxError, ValueError, RecursionError, MemoryError, RuntimeError)  # of a text that cannot be parsed
RUNS_ITS_CELL = re.compile(r"\s*%%(time|capture|prun)\b.*\n")  # other %%magics hand the text to something else
SURE = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef, ast.Import, ast.ImportFrom, ast.Assign, ast.AnnAssign)


class Data(Struct, frozen=True, rename={"text": "text/plain"}):
    text: Any = ""  # a text, or its lines


class Output(Struct):
    data: Data = Data()

    @property
    def says_right(self) -> bool:
        text = self.data.text
        return "".join(map(str, text) if isinstance(text, list) else str(text)).startswith(MARKS["passed"])


class Cell(Struct):
    cell_type: str
    source: str | list[str]  # a text, or its lines
    outputs: Raw = Raw(b"[]")  # whatever they are, and however large: an answer does not depend on them

    def __post_init__(self):
        if self.cell_type == "code" and len(self.text) > LONGEST:
            raise ValueError(f"a cell has more than {LONGEST:,} characters")

    @property
    def text(self) -> str:
        return self.source if isinstance(self.source, str) else "".join(self.source)

    @property
    def says_right(self) -> bool:
        """Does the check, as its output shows, say that the answer is right?"""
        try:
            return any(output.says_right for output in msgspec.json.decode(self.outputs, type=list[Output]))
        except msgspec.MsgspecError:  # outputs of another kind
            return False


class Notebook(Struct):
    """What is read of a notebook's file."""

    cells: list[Cell]

    @property
    def code(self) -> list[Cell]:
        return [cell for cell in self.cells if cell.cell_type == "code"]


def read_notebook(path: Path, remedy: str) -> Notebook:
    """The notebook of a file, also of one that an editor saved in UTF-16, or whose outputs are no standard JSON.

    remedy: for a file that is damaged. Raises BootcourseError if it cannot be read.
    """
    with open_regular(path) as file, decoding(path, remedy):
        if (size := os.fstat(file.fileno()).st_size) > LARGEST:
            most = f"{size:,} bytes, and at most {LARGEST:,} are read"
            raise BootcourseError(f"{path} has {most}: clear the outputs of all its cells, and save it again.")
        data = file.read()
        try:
            return msgspec.json.decode(data, type=Notebook)
        except msgspec.ValidationError:
            raise
        except (msgspec.DecodeError, UnicodeDecodeError):
            value = json.loads(data.decode(json.detect_encoding(data), "replace"), parse_constant=str)  # NaN, as a text
            text = json.dumps(value, ensure_ascii=False).encode("utf-8", "replace")  # half a letter becomes "?"
            return msgspec.json.decode(text, type=Notebook)


class Clock(TransformerManager):
    """IPython's transformer, and the processor's time it may take: it reads a cell again for each `%`, `!`, `?`."""

    def __init__(self, seconds: float = SECONDS):
        super().__init__()
        self.end = time.thread_time() + seconds

    def look(self) -> None:
        """Raises BootcourseError when the time is over."""
        if time.thread_time() > self.end:
            raise BootcourseError("the notebooks take too long to read, so not all of them is graded.")

    def do_one_token_transform(self, lines):
        self.look()
        return super().do_one_token_transform(lines)


# Statements -----------------------------------------------------------------------------------------


class Statement:
    """A top-level statement of a cell. node: None for a whole cell that is not Python, of which little is known."""

    def __init__(self, text: str, node: ast.stmt | None = None):
        self.text, self.node = text, node
        self.is_function = isinstance(node, SURE[:3])
        self.takes_over = "own_code.yours_or_ours(" in text  # answers of other lessons, or ours: none is given here
        self.uses, self.changes, self.checks = set(), set(), {}
        self.later: set[str] = set()  # what a function changes when it is called
        self.at_once: set[str] = set()  # what a function uses when it is defined: in its defaults and decorators
        if node is None:
            self.makes = set(re.findall(r"^[ \t]*(?:def|class) (\w+)", text, re.M))
            return
        self.makes, self.uses, self.changes = names_made(text), names_used(text), names_changed(text)
        if self.is_function:
            outside = {name for each in ast.walk(node) if isinstance(each, ast.Global) for name in each.names}
            self.later, self.changes = outside | self.changes & self.uses, set()
            self.at_once = names_used(text, at_once=True)
        elif "check" in self.uses:
            calls = [each for each in ast.walk(node) if isinstance(each, ast.Call) and each.args]
            named = [(each.func, each.args[0]) for each in calls if isinstance(each.func, ast.Attribute)]
            self.checks = {func.attr: ast.unparse(first) for func, first in named if root_of(func) == "check"}

    def defines(self, name: str, any_value: bool) -> bool:
        """Is it a definition of that function or class, also under `if` and the like, or a lambda of that name?

        any_value: or any other assignment to it.
        """
        if name not in self.makes or self.node is None:
            return False
        if any_value and isinstance(self.node, ast.Assign):
            return True
        parts = [self.node] if self.is_function else ast.walk(self.node)
        return any(isinstance(each, ast.Lambda) or getattr(each, "name", "") == name for each in parts)


def statements_of(text: str, clock: Clock) -> list[Statement]:
    """The top-level statements of a cell; of a cell that is not Python, its text without the check."""
    text = re.sub(r"\r\n?", "\n", text)
    try:
        try:
            nodes = ast.parse(text).body
        except NO_PYTHON:
            magic = RUNS_ITS_CELL.match(text)
            text = clock.transform_cell(text[magic.end() :] if magic else text)
            nodes = ast.parse(text).body
        pairs = zip(segments(text, nodes), nodes, strict=True)
        return [one for pair in pairs for one in (statements_of(behind_time(pair[1]), clock) or [Statement(*pair)])]
    except NO_PYTHON:
        return [Statement(re.sub(r"^check\..*$", "", text, flags=re.M))]


def behind_time(node: ast.stmt) -> str:
    """The statement that `%time` runs, in a cell that IPython has transformed; "" for every other statement."""
    match node:
        case ast.Expr(ast.Call(ast.Attribute(attr="run_line_magic"), [ast.Constant("time"), ast.Constant(str(text))])):
            return text
    return ""


def segments(text: str, nodes: list[ast.stmt]) -> list[str]:
    """The text of each statement with the comment behind it. A line ends as Python sees it, at "\\n" alone."""
    whole = text.encode()
    lines = whole.split(b"\n")
    starts, texts = [0, *accumulate(len(line) + 1 for line in lines)], []
    for node in nodes:
        first = min((node, *getattr(node, "decorator_list", ())), key=lambda part: part.lineno)
        begin = starts[first.lineno - 1] + (node.col_offset if first is node else 0)
        rest = lines[node.end_lineno - 1][node.end_col_offset :]
        comment = len(rest) if rest.lstrip().startswith(b"#") else 0
        texts.append(whole[begin : starts[node.end_lineno - 1] + node.end_col_offset + comment].decode())
    return texts


# Answers --------------------------------------------------------------------------------------------


class Answers:
    """What a notebook answers. Raises BootcourseError if it takes longer to read than the clock allows."""

    def __init__(self, notebook: Notebook, clock: Clock):
        self.clock, self.statements = clock, []
        self.right: set[str] = set()  # the exercises whose check, when it last ran there, said that the answer is right
        for cell in notebook.code:
            clock.look()
            mine = statements_of(cell.text, clock)
            checks = [name for one in mine for name in one.checks]
            self.right -= set(checks)
            if cell.says_right:
                self.right |= set(checks[-1:])  # a cell shows what its last line says
            self.statements += mine
        self.touched = self._touched()

    def _touched(self) -> dict[str, list[int]]:
        """name -> the places of the statements that make or change it."""
        imported = {name for one in self.statements if isinstance(one.node, SURE[3:5]) for name in one.makes}
        later = {name: one.later for one in self.statements if one.later for name in one.makes}
        touched = defaultdict(list)
        for place, one in enumerate(self.statements):
            called = () if one.is_function else later.keys() & one.uses
            for name in one.makes.union(one.changes - imported, *(later[name] for name in called)):
                touched[name].append(place)
        return touched

    def texts(self) -> dict[str, str]:
        """Exercise -> the text of its answer, stubs included, for every exercise that the notebook defines.

        An answer that its check has seen goes before one that no check has seen, and this before a broken cell.
        """
        texts, checked = {}, {name: place for place, one in enumerate(self.statements) for name in one.checks}
        for name in registry():
            self.clock.look()
            ways = [self.checked(name, checked[name])] if name in checked else []
            touching = [place for place in self.touched.get(name, []) if not self.statements[place].takes_over]
            defined = [place for place in touching if self.statements[place].defines(name, name in checked)]
            defined = defined or [place for place in touching if self.statements[place].defines(name, True)]
            ways += [self.text_of({name}, self.end_of(name, place)) for place in defined[-1:]]
            broken = [self.statements[place] for place in touching if self.statements[place].node is None]
            ways = [way for way in (*ways, *(one.text for one in broken[-1:])) if way.strip()]
            if ways:
                texts[name] = next((way for way in ways if not unfinished(way)), ways[0])
        return texts

    def end_of(self, name: str, place: int) -> int:
        """Where what is made here stops to change, such as `f.n = 9` below `f`: the place behind it."""
        below = [later for later in self.touched[name] if later > place]
        return next((later for later in below if name in self.statements[later].makes), max([place, *below]) + 1)

    def checked(self, name: str, place: int) -> str:
        """The answer that the check at this place was given; "" if the notebook does not say what it was."""
        given = self.statements[place].checks[name]
        text = self.text_of(names_used(given), place + 1)
        if given == name:
            return text
        if name in names_used(given):  # what it was is not what it becomes
            given = f"(lambda {name}: {given})({name})"
        return f"{text}\n{name} = {given}\n" if text or not given.isidentifier() else ""

    def text_of(self, names: set[str], end: int) -> str:
        """The statements that make these names as they are before a place, and what these statements use."""
        taken, walked = set(self.touched.get("*", [])), set()
        todo = [(name, end) for name in names] + [(name, 0) for place in taken for name in self.statements[place].uses]
        while todo:
            name, before = todo.pop()
            places = self.touched.get(name, [])
            last = bisect_left(places, before) or len(places)  # what is made below only is as it is at the end
            for place in (places[k] for k in range(last - 1, -1, -1)):
                one = self.statements[place]
                if (name, place) in walked:
                    break
                walked.add((name, place))
                if place not in taken:
                    taken.add(place)
                    todo += [(used, end if one.is_function else place) for used in one.uses]
                    todo += [(used, place) for used in one.at_once]
                if name in one.makes and isinstance(one.node, SURE):
                    break
        return "".join(f"{self.statements[place].text}\n\n" for place in sorted(taken))[:-1]


def unfinished(text: str) -> bool:
    """Does a `...` still stand on a line of its own, where an answer should?"""
    return re.search(r"^[ \t]*\.\.\.[ \t]*(#.*)?$", text, re.M) is not None
