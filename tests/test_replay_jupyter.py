"""The replay where people meet it: in a cell of a real JupyterLab, in headless Chromium."""

import time

import pytest

from tests.browser import ARTEFACTS, close_notice, is_blank, needs_browser
from tests.jupyterlab import open_notebook

DRIVE = """from bootcourse.policies import rule_policy
from bootcourse.episodes.record import record
from bootcourse.scenario import DEFAULT
from bootcourse.replay3d import recording, replay
drive = record(rule_policy(DEFAULT), [1], DEFAULT, "rule")[0]"""


@pytest.fixture(scope="module")
def notebook(tmp_path_factory):
    with open_notebook(tmp_path_factory.mktemp("lab"), DRIVE, "shown = replay(drive)\nshown", "recording(drive)") as it:
        it.run_all()
        yield it


def in_frame(notebook, number: int):
    """The page inside the output of a cell."""
    element = notebook.page.wait_for_selector(f".jp-Cell:nth-of-type({number}) iframe", timeout=30_000)
    element.scroll_into_view_if_needed()
    frame = element.content_frame()
    frame.wait_for_selector("canvas", timeout=30_000)
    frame.wait_for_function("() => window.__viserMutable?.nodeRefFromName?.['/drive0/car0/paint']")
    return element, frame


@needs_browser
def test_a_live_replay_plays_in_its_cell(notebook):
    element, frame = in_frame(notebook, 2)
    close_notice(frame)
    time.sleep(2)
    picture = element.screenshot(path=str(ARTEFACTS / "replay-in-jupyterlab.png"))
    assert not is_blank(picture)


@needs_browser
def test_a_recording_plays_in_its_cell_without_a_server(notebook):
    element, _ = in_frame(notebook, 3)
    time.sleep(2)
    assert not is_blank(element.screenshot(path=str(ARTEFACTS / "recording-in-jupyterlab.png")))
