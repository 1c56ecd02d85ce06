"""`import bootcourse as bc`: its names, what they say about themselves, and what the import costs."""

import importlib
import inspect
import pkgutil
import re
import subprocess
import sys
from pathlib import Path

import pytest

import bootcourse as bc
from bootcourse import course

ROOT = Path(__file__).resolve().parent.parent
MOST = 0.3  # seconds that the import may cost


def python(code: str) -> str:
    """What a new interpreter prints."""
    result = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    return result.stdout.strip()


def test_the_import_takes_a_fraction_of_a_second():
    code = "import time; before = time.process_time(); import bootcourse; print(time.process_time() - before)"
    assert min(float(python(code)) for _ in range(3)) < MOST


HEAVY = "torch numba viser ipywidgets highway_env matplotlib pandas scipy"


@pytest.mark.parametrize(
    ("imported", "spared"),
    [
        ("bootcourse", HEAVY),
        ("bootcourse.storage.assets", "bootcourse.research"),  # files are checked without the study's code
        ("bootcourse.policies, bootcourse.episodes.record", "viser"),
    ],
)
def test_an_import_brings_nothing_heavy_that_it_does_not_need(imported, spared):
    assert python(f"import {imported}, sys; print(sorted(set({spared.split()}) & set(sys.modules)))") == "[]"


@pytest.mark.parametrize("name", bc.__all__)
def test_a_public_name_is_there_and_says_what_it_is_and_what_it_raises(name):
    value = getattr(bc, name)
    assert name in dir(bc)
    if inspect.ismodule(value) or inspect.isroutine(value) or inspect.isclass(value):
        words = inspect.getdoc(value)
        assert words and words[0].isupper() and "." in words
    if inspect.isfunction(value) and "raise BootcourseError" in inspect.getsource(value):
        assert re.search(r"\bRaises\s+BootcourseError\b", inspect.getdoc(value))


@pytest.mark.parametrize("package", [bc, course])
def test_no_module_has_the_name_of_a_function_beside_it(package):
    """Loaded later, it would take the function's place in the package: a cell that runs twice would fail."""
    modules = {module.name for module in pkgutil.iter_modules(package.__path__)}
    assert modules & set(package.__all__) <= set(bc.MODULES)


def test_a_name_is_looked_up_where_it_is_defined():
    for name, module in bc.NAMES.items():
        own = getattr(getattr(bc, name), "__module__", module)
        assert own in (module, "builtins"), f"{name} is defined in {own}"


def test_no_name_hides_a_module_of_the_package():
    for path in (ROOT / "bootcourse").iterdir():
        if path.stem in bc.NAMES:
            pytest.fail(f"bc.{path.stem} is a name and a module")
    for name, module in bc.MODULES.items():
        assert getattr(bc, name) is importlib.import_module(module)


def test_a_wrong_name_gets_the_nearest_one():
    with pytest.raises(AttributeError, match="'setings_for' is unknown: did you mean 'settings_for'"):
        bc.setings_for()
