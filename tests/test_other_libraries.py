"""The blocks of the page "With other libraries" run as they stand, where the library is installed."""

import re
from pathlib import Path

import pytest

PAGE = Path(__file__).resolve().parent.parent / "book" / "other_libraries.md"
LIBRARIES = {"Stable-Baselines3": "stable_baselines3", "CleanRL": "gymnasium"}  # heading -> module; others: lower case
SMALLER = {"100_000": "4_096", "20_000": "600", "10_000": "60", "1_000": "30", "1000": "12", "(200)": "(8)"}


def blocks() -> dict[str, str]:
    """{heading: the Python below it}, with smaller numbers."""
    below = r"^## ([^\n]+)\n(?:(?!^## ).)*?^```python\n(.*?)^```"
    numbers = "|".join(map(re.escape, SMALLER))
    parts = re.findall(below, PAGE.read_text(encoding="utf-8"), re.M | re.S)
    return {heading: re.sub(numbers, lambda found: SMALLER[found[0]], code) for heading, code in parts}


def test_every_library_of_the_page_has_a_block():
    assert list(blocks()) == ["Stable-Baselines3", "CleanRL", "tianshou", "d3rlpy", "imitation", "Minari"]


@pytest.mark.parametrize("heading", blocks())
def test_a_block_runs(heading, monkeypatch, tmp_path, capsys):
    pytest.importorskip(LIBRARIES.get(heading, heading.lower()), reason="no part of the lock: see the page")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path))
    exec(compile(blocks()[heading], heading, "exec"), {})
    assert re.search(r"Estimate\(value=|return -?\d|episodes in", capsys.readouterr().out)
