"""Which code made a result: a hash of the sources that it depends on.

Comments, docstrings and blank lines do not count: better words make no result older.
"""

import ast
import hashlib
import io
import tokenize
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import bootcourse
from bootcourse.errors import BootcourseError

ROOT = Path(bootcourse.__file__).parent


def sources_hash(parts: Sequence[str]) -> dict[str, str]:
    """{part: hash}; a part is a module or a package of bootcourse: "rule", "road", "episodes/evaluate"."""
    return {part: _part_hash(part) for part in parts}


@cache
def _part_hash(part: str) -> str:
    files = sorted((ROOT / part).glob("*.py")) if (ROOT / part).is_dir() else [ROOT / f"{part}.py"]
    if not files or not all(path.is_file() for path in files):
        raise BootcourseError(f"'{part}' is not a part of bootcourse: it was moved or renamed since.")
    code = "".join(f"# {path.name}\n{code_only(path.read_text(encoding='utf-8'))}" for path in files)
    return hashlib.sha256(code.encode()).hexdigest()[:16]


def code_only(source: str) -> str:
    """The source without comments, docstrings and blank lines."""
    lines = source.splitlines()
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            row, column = token.start
            lines[row - 1] = lines[row - 1][:column]
    for node in ast.walk(ast.parse(source)):
        body = getattr(node, "body", None)
        first = body[0] if isinstance(body, list) and body else None
        if isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant) and isinstance(first.value.value, str):
            lines[first.lineno - 1 : first.end_lineno] = [""] * (first.end_lineno - first.lineno + 1)
    return "".join(line.rstrip() + "\n" for line in lines if line.strip())
