"""Headless Chromium for tests: software WebGL, a fresh profile, and no network beyond this machine."""

import contextlib
import io
import shutil
import tempfile
from pathlib import Path

import pytest

FLAGS = [
    "--no-sandbox",
    "--disable-gpu",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]


def chromium() -> str | None:
    """The path of Chromium or Chrome on this machine."""
    for name in ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable"):
        if path := shutil.which(name):
            return path
    return None


def missing() -> str | None:
    """Why a browser test cannot run here; None if it can."""
    try:
        import playwright.sync_api  # noqa: F401
    except ImportError:
        return "playwright is not installed"
    return None if chromium() else "Chromium is not installed"


needs_browser = pytest.mark.skipif(missing() is not None, reason=f"{missing()}: no browser to look at the page with")


class Page:
    """A playwright page, with the errors that its console shouted and the addresses that it asked for."""

    def __init__(self, page):
        self.page, self.errors, self.requests = page, [], []
        page.on("console", lambda message: self.errors.append(message.text) if message.type == "error" else None)
        page.on("pageerror", lambda error: self.errors.append(error.stack or str(error)))  # and where it was
        page.on("request", lambda request: self.requests.append(request.url))


@contextlib.contextmanager
def open_browser(width: int = 640, height: int = 360, offline: bool = False):
    """A `new_page()` in a fresh Chromium. offline: every request that leaves the page is cut off."""
    from playwright.sync_api import sync_playwright

    with tempfile.TemporaryDirectory() as profile, sync_playwright() as playwright:
        context = playwright.chromium.launch_persistent_context(
            profile, executable_path=chromium(), headless=True, args=FLAGS, viewport={"width": width, "height": height}
        )
        if offline:
            context.set_offline(True)
        try:
            yield lambda: Page(context.new_page())
        finally:
            context.close()


ARTEFACTS = Path(__file__).resolve().parent / "artefacts"  # pictures of what the tests saw, not in git
ARTEFACTS.mkdir(exist_ok=True)
# Where nodes of a viser page are, in their parent's coordinates.
CARS = """names => Object.fromEntries(names.map(name => {
    const node = window.__viserMutable.nodeRefFromName[name];
    return [name, node ? node.position.toArray() : [NaN, NaN, NaN]];
}))"""


def is_blank(png: bytes, least: int = 200) -> bool:
    """Has the picture fewer colours than any real scene would have?"""
    from PIL import Image

    colours = Image.open(io.BytesIO(png)).convert("RGB").getcolors(maxcolors=1 << 24)
    return len(colours) < least


def close_notice(page) -> None:
    """Close viser's notice that there is no GPU here: it would lie over the picture."""
    from playwright.sync_api import Error

    with contextlib.suppress(Error):
        page.wait_for_selector("text=Software WebGL", timeout=5000)
        page.evaluate("document.querySelectorAll('.mantine-Notification-root button').forEach(b => b.click())")
        page.wait_for_selector("text=Software WebGL", state="detached", timeout=3000)
