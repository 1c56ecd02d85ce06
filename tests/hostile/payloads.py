"""Put a script into every text and number of a rollout, show it in Chromium, and see whether any of it runs.

    python -m tests.hostile.payloads

The exported page, the live replay and the recording in a notebook's page are tried. The fields are set behind the
checks of `Rollout`, so that what makes the pages is tested alone; the same payload in files: test_hostile_files.py.
"""

import dataclasses
import sys
import tempfile
import time
from pathlib import Path

from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.policies import rule_policy
from bootcourse.replay3d import export, recording, replay
from bootcourse.scenario import DEFAULT, Clock
from tests.browser import open_browser

PATIENCE = 90  # seconds; a busy machine draws late
FIRED = "http://fired.invalid/"  # asked for by a payload that became part of a page
PAYLOAD = f"\"'></script><img src={FIRED} onerror=alert(1)><script>alert(2)</script>@PLOTS@{{0.__class__}}$"


def with_payloads() -> Rollout:
    """A short drive with the payload in every field that a page could show as it is."""
    short = dataclasses.replace(DEFAULT, clock=Clock(decisions=4), name=PAYLOAD)
    drive = record(rule_policy(short), [1], short, "rule")[0]
    for field in ("label", "seed"):
        object.__setattr__(drive, field, PAYLOAD)
    object.__setattr__(drive, "provenance", {PAYLOAD: PAYLOAD})
    return drive


class Watched:
    """A page with what ran in it: dialogs, and requests that only a payload makes."""

    def __init__(self, page):
        self.page, self.ran = page.page, []
        self.page.on("dialog", lambda dialog: (self.ran.append(dialog.message), dialog.dismiss()))
        self.page.on("request", lambda request: self.ran.append(request.url) if FIRED in request.url else None)

    def show(self, address: str, number: int | None) -> "Watched":
        """Open an address, and wait until frame `number` shows the label as text (None: do not)."""
        self.page.goto(address, timeout=1000 * PATIENCE)
        if number is not None:
            wait = time.monotonic() + PATIENCE
            while len(self.page.frames) <= number and time.monotonic() < wait:
                self.page.wait_for_timeout(200)
            heading = self.page.frames[number].wait_for_selector(".bc h4", state="attached", timeout=1000 * PATIENCE)
            assert f"<img src={FIRED}" in heading.text_content(), "the label is not shown"
        return self


def shown() -> dict[str, list[str]]:
    """What ran in each page: {page: [...]}. The first page is a control that shows the payload as it is."""
    drive = with_payloads()
    with tempfile.TemporaryDirectory() as folder, open_browser() as new_page:

        def saved(name: str, body: str) -> str:
            path = Path(folder, name)
            path.write_text(f"<!doctype html><meta charset=utf-8><body>{body}</body>")
            return path.as_uri()

        pages = {
            "control": (saved("control.html", PAYLOAD), None),
            "recording": (saved("recording.html", recording(drive)._repr_mimebundle_()["text/html"]), 1),
            "export": (export(drive, Path(folder, "export.html")).as_uri(), 0),
        }
        found = {name: Watched(new_page()).show(*where) for name, where in pages.items()}
        with replay([drive, drive]) as live:
            found["live replay"] = Watched(new_page()).show(live.url, 0)
            found["live replay"].page.wait_for_timeout(2000)  # in which the others run on
    return {name: page.ran for name, page in found.items()}


def main() -> int:
    found = shown()
    for name, ran in found.items():
        print(f"{name:24}{len(ran):3} scripts ran")
    return 0 if found.pop("control") and not any(found.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
