"""What every test shares."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))  # so that `tests.agreement` is found under plain pytest


def drive_road_3(driver, label: str):
    from bootcourse.record.drive import record
    from bootcourse.scenario import DEFAULT

    return record(driver, [3], DEFAULT, label)[0]


@pytest.fixture(scope="module")
def escape():
    """The rule gets out."""
    from bootcourse.drivers import rule_driver
    from bootcourse.scenario import DEFAULT

    return drive_road_3(rule_driver(DEFAULT), "rule")


@pytest.fixture(scope="module")
def idle():
    """Nothing is done."""
    from bootcourse.drivers import idle_driver

    return drive_road_3(idle_driver, "idle")


@pytest.fixture(scope="module")
def crash():
    """Into trap 1, by hand."""
    from bootcourse.drivers import plan_driver

    return drive_road_3(plan_driver([("accelerate straight", 30)]), "you")
