"""The replay as a file: one page that needs nothing but a browser; and the command that writes files."""

import io
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from bootcourse import cli
from bootcourse.episodes.record import record
from bootcourse.errors import BootcourseError
from bootcourse.policies import random_policy, rule_policy
from bootcourse.replay3d import export, recording, scene
from bootcourse.replay3d.timeline import Timeline
from bootcourse.road.state import Accident
from bootcourse.scenario import Clock
from tests.browser import ARTEFACTS, CARS, close_notice, is_blank, needs_browser, open_browser
from tests.replays import SHORT, TEN_CARS, thinking
from tests.waiting import until

ROOT = Path(__file__).resolve().parent.parent
BRIEF = replace(SHORT, clock=Clock(decisions=4))
NODES = """names => Object.fromEntries(names.map(name => {
    const node = window.__viserMutable.nodeRefFromName[name];
    return [name, node ? node.visible : null];
}))"""


def replay_command(files, export=None, gif=None, png=None, text=False):
    """`bootcourse replay`, without a browser."""
    cli.replay(files, export, gif, png, text, browser=False)


@pytest.fixture(scope="module")
def rule_drive():
    """Four decisions: enough for a file."""
    return record(rule_policy(BRIEF), [1], BRIEF, "rule")[0]


@pytest.fixture(scope="module")
def crash():
    drives = record(random_policy(np.random.default_rng(0)), range(30), SHORT, "random")
    return next(d for d in drives if d.accident == Accident.COLLISION and len(d.actions) > 3)


@pytest.fixture(scope="module")
def whole_episode(tmp_path_factory):
    """150 s of ten cars, exported."""
    rollout = thinking(record(rule_policy(TEN_CARS), [1], TEN_CARS)[0])
    return rollout, export(rollout, tmp_path_factory.mktemp("export") / "replay.html")


def test_a_whole_episode_of_ten_cars_is_one_file_under_3_mb_that_names_no_server(whole_episode):
    rollout, path = whole_episode
    assert rollout.states.shape[1] == 10 and path.stat().st_size < 3e6
    page = path.read_text()
    assert page.count("</html>") == 1 and "<title>bootstrapped SAC on road 1</title>" in page
    assert '<script src="' not in page and '<link rel="stylesheet" href="http' not in page


def go_to(page, t: float) -> None:
    """Type a time into the page's own time box; that pauses it. A page that plays may write over it: then again."""
    box = page.locator("input").first
    for _ in range(20):
        box.fill(f"{t:g}")
        box.press("Enter")
        page.wait_for_timeout(700)
        if abs(float(box.input_value()) - t) < 0.05:
            return
    raise AssertionError(f"the page stays at {box.input_value()} s instead of {t:g} s")


@needs_browser
def test_the_file_plays_without_a_network_and_every_car_is_where_it_was(whole_episode):
    rollout, path = whole_episode
    timeline = Timeline(rollout)
    cars = [f"/drive0/car{car}" for car in range(10)]
    with open_browser(offline=True) as new_page:
        page = new_page()
        started = time.monotonic()
        page.page.goto(path.as_uri())
        page.page.wait_for_function("() => window.__viserMutable?.nodeRefFromName['/drive0/car9/paint']")
        print(f"opened in {time.monotonic() - started:.2f} s")
        before = page.page.inner_text("#bc-numbers")
        assert until(lambda: page.page.inner_text("#bc-numbers") != before), "it does not play"
        for t in (60.0, 0.0, 33.4):  # forwards and backwards
            go_to(page.page, t)
            frame = round(t * 30)  # the one that the file holds
            near = [scene.view(timeline, (frame + shift) / 30) for shift in (-1, 0, 1)]

            def apart(near=near) -> float:
                """How far the car that is farthest off is from where it was (m); a busy machine draws it late."""
                placed = page.page.evaluate(CARS, cars)
                return min(
                    max(np.hypot(v.x[c] - placed[n][0], v.y[c] - placed[n][1]) for c, n in enumerate(cars))
                    for v in near
                )

            def lag(t=t) -> float:
                """How far the numbers are behind the scene (s)."""
                return abs(float(page.page.inner_text("#bc-numbers .big b >> nth=0")) - t)

            assert until(lambda apart=apart: apart() < 5e-3), (t, apart())
            assert until(lambda lag=lag: lag() <= 0.5), "the numbers lag behind"
            rings = page.page.evaluate(NODES, [f"{car}/ring" for car in cars])
            assert not any(rings.values())
        close_notice(page.page)
        picture = page.page.screenshot(path=ARTEFACTS / "test_export.png")
        road = np.asarray(Image.open(io.BytesIO(picture)).convert("L"))[300:650, 320:]
        assert not is_blank(picture) and (road > 200).sum() > 2000, "no markings on the road"
        page.page.get_by_role("button", name="bird's eye").click()
        height = "window.__viserMutable.cameraControl.camera.position.y"
        assert until(lambda: page.page.evaluate(height) > 50), "the camera does not move"
        assert page.errors == [] and all(url.startswith(("file:", "blob:", "data:")) for url in page.requests)


@needs_browser
def test_a_recording_plays_inside_a_saved_page_and_marks_the_accident(crash, tmp_path):
    shown = recording(crash)
    bundle = shown._repr_mimebundle_()["text/html"]
    assert "data:image/png;base64," in bundle and "<iframe title=" in bundle and "<summary>In words</summary>" in bundle
    page_path = tmp_path / "notebook.html"
    page_path.write_text(f"<!doctype html><meta charset=utf-8><body>{bundle}</body>")
    with open_browser(width=900, offline=True) as new_page:
        page = new_page()
        page.page.goto(page_path.as_uri())
        assert page.page.locator("iframe").get_attribute("sandbox") == "allow-scripts", "it has no access to this page"
        inside = page.page.frames[1]
        inside.wait_for_function("() => window.__viserMutable?.nodeRefFromName['/drive0/car0/paint']")

        def ring() -> bool:
            return inside.evaluate(NODES, ["/drive0/car0/ring"])["/drive0/car0/ring"]

        go_to(inside, Timeline(crash).duration)
        assert until(lambda: "collision" in inside.inner_text("#bc-numbers")), inside.inner_html("#bc-hud")
        assert until(ring)
        go_to(inside, 0.5)
        assert until(lambda: not ring()), "wound back, nothing has happened yet"
        go_to(inside, Timeline(crash).duration)
        assert not is_blank(page.page.screenshot(path=ARTEFACTS / "test_recording_accident.png"))
        assert page.errors == []


def test_the_command_writes_what_is_asked_for(rule_drive, tmp_path, capsys):
    file = rule_drive.save(tmp_path / "drive.npz")
    out = {kind: tmp_path / "new" / f"replay.{kind}" for kind in ("html", "gif", "png")}
    replay_command([file], export=out["html"], gif=out["gif"], png=out["png"], text=True)
    first_bytes = {"html": b"<!doctype html>", "gif": b"GIF89a", "png": b"\x89PNG"}
    assert all(path.read_bytes()[:20].lower().startswith(first_bytes[kind].lower()) for kind, path in out.items())
    printed = capsys.readouterr().out
    assert all(str(path) in printed for path in out.values()) and "In the end: still behind trap 1" in printed
    for kind, wrong in {"export": file / "out.html", "gif": tmp_path / "out.mp4", "png": tmp_path / "out.txt"}.items():
        with pytest.raises(BootcourseError, match="Cannot write" if kind == "export" else f".{kind}"):
            replay_command([file], **{kind: wrong})
        assert not wrong.exists()


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGINT to send")
def test_on_the_command_line_it_prints_its_address_and_ctrl_c_ends_it(rule_drive, tmp_path):
    file = rule_drive.save(tmp_path / "drive.npz")
    command = [sys.executable, "-m", "bootcourse", "replay", str(file), "--no-browser"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT)
    line = process.stdout.readline()
    assert line.startswith("Replay at http://127.0.0.1:")
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=15) == 0
