"""An answer as a file, answers/NAME.py: the function or class, with all that it uses of its notebook.

A file is written whole or not at all. It is read by running it: a notebook has to ask for that (`own_code.load`).
"""

import ast
import builtins
import importlib.util
import linecache
import sys
from collections.abc import Callable
from pathlib import Path
from types import FunctionType, ModuleType

from bootcourse.course.names import names_used
from bootcourse.course.notebook import beside_the_notebook
from bootcourse.errors import BootcourseError, described
from bootcourse.files import write_bytes

FOLDER = Path("answers")  # beside the notebooks
PARTS = (  # the exercises whose answers train the agent: see own_code.py
    "soft_value", "critic_target", "critic_loss", "actor_loss", "temperature_loss", "ReplayBuffer",
    "update", "train",
    "soft_constraint", "constrained_loss", "constrained_target", "mixed_batch",
    "imitation_reward", "offline_loss", "advantages", "clipped_loss",
    "rollout_values", "shield", "better_of_two", "guide_shrinks",
)  # fmt: skip
CONSTANTS = (bool, int, float, str, type(None))
HEAD = '"""Your `{0}`, which passed its check. Without this file, the library\'s own is used."""'


def write(name: str, answer: Callable) -> Path:
    """Keep an answer. Returns its file. Raises BootcourseError if it cannot be kept."""
    texts = {}
    collect(answer, texts)
    imports = sorted(text for text in texts.values() if text.startswith(("import ", "from ")))
    rest = [text for text in texts.values() if text not in imports]
    path = file_of(name)
    write_bytes(path, ("\n\n\n".join([HEAD.format(name), "\n".join(imports), *rest]) + "\n").encode())
    return path


def file_of(name: str) -> Path:
    """Where the answer of this name is kept, or would be."""
    return beside_the_notebook() / FOLDER / f"{name}.py"


def collect(answer: Callable, texts: dict[str, str]) -> None:
    """Put the answer's text into `texts`, {name: text}, after the texts of all that it uses of its notebook."""
    text, space = definition(answer), a_function(answer).__globals__
    for name in sorted(names_used(text) - set(vars(builtins)) - set(texts) - {answer.__name__}):
        value = space.get(name)
        if isinstance(value, ModuleType):
            texts[name] = f"import {value.__name__} as {name}".replace(f"import {name} as {name}", f"import {name}")
        elif isinstance(value, (FunctionType, type)) and value.__module__ == answer.__module__:
            collect(value, texts)
        elif callable(value) and hasattr(value, "__name__"):
            texts[name] = f"from {value.__module__} import {value.__name__} as {name}"
        elif isinstance(value, CONSTANTS) and name in space:
            texts[name] = f"{name} = {value!r}"
        else:
            raise BootcourseError(f"`{answer.__name__}` uses `{name}`, which a file cannot hold: compute it inside.")
    texts[answer.__name__] = text


def a_function(answer: Callable) -> FunctionType:
    """The answer itself, or a method of a class. Raises BootcourseError if there is none."""
    inside = [answer, *vars(answer).values()] if isinstance(answer, type) else [answer]
    functions = [each for each in inside if isinstance(each, FunctionType)]
    if not functions:
        raise BootcourseError(f"`{answer.__name__}` has no text: write it with `def` in a cell.")
    return functions[0]


def definition(answer: Callable) -> str:
    """The `def` or `class` of an answer. Raises BootcourseError for a lambda, or where the text is not known."""
    code = a_function(answer).__code__
    text = "".join(linecache.getlines(code.co_filename))
    for node in ast.parse(text).body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)) and node.name == answer.__name__:
            first = min(each.lineno for each in (node, *node.decorator_list))
            if first <= code.co_firstlineno <= node.end_lineno:
                return "\n".join(text.splitlines()[first - 1 : node.end_lineno])
    raise BootcourseError(f"`{answer.__name__}` has no text: write it with `def` in a cell.")


def read(name: str) -> Callable:
    """Run the file of an answer and return its function or class. Raises BootcourseError if it cannot be run."""
    path = file_of(name)
    spec = importlib.util.spec_from_file_location(f"answers_{name}", path)
    module = sys.modules[spec.name] = importlib.util.module_from_spec(spec)  # while it runs: dataclasses look there
    try:
        exec(compile(path.read_text(encoding="utf-8"), str(path), "exec"), vars(module))
        return getattr(module, name)
    except Exception as error:  # whatever the student's file does
        remedy = "Write it again in its lesson, or delete the file."
        raise BootcourseError(f"{path} does not run ({described(error)}). {remedy}") from None
    finally:
        del sys.modules[spec.name]
