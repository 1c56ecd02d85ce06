"""Ruff, over every file of the course and every cell of its notebooks."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def ruff(*arguments: str) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, "-m", "ruff", *arguments], cwd=ROOT, capture_output=True, text=True)


def test_ruff_has_nothing_to_say():
    result = ruff("check", ".")
    assert result.returncode == 0, f"`ruff check --fix` mends some of this:\n{result.stdout}{result.stderr}"


def test_every_file_is_formatted():
    result = ruff("format", "--check", ".")
    assert result.returncode == 0, f"run `ruff format`:\n{result.stdout}{result.stderr}"
