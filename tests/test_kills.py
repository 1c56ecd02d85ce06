"""A slice of tests/hostile/kills.py: commands that are killed, or whose disk is full, go on to the same end."""

import os
import subprocess
import sys
from pathlib import Path

import pytest


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
def test_a_command_that_is_killed_or_whose_disk_is_full_goes_on_to_the_same_files():
    program = [sys.executable, "-m", "tests.hostile.kills", "--every", "15", "train"]
    result = subprocess.run(program, cwd=Path(__file__).parent.parent, capture_output=True, text=True)
    assert result.returncode == 0 and "attempts, 0 went wrong" in result.stdout, result.stdout + result.stderr
