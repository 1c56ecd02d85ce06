"""A replay as one HTML file, without a server or a network; the mouse turns the camera.

viser records the messages of its scene and packs them with its own page, but without its panel. So the head-up
display (the same HTML as in the live panel) is recorded as small scripts, and a few lines of JavaScript show it in a
box over the scene.
"""

import base64
import json
from collections.abc import Sequence
from pathlib import Path

from viser import _messages

from bootcourse.episodes.rollout import Rollout
from bootcourse.episodes.words import transcripts
from bootcourse.files import check_replaceable, write_bytes
from bootcourse.markup import Markup, html
from bootcourse.methods import display_name
from bootcourse.plots.animation import key_frame
from bootcourse.plots.figure import png
from bootcourse.policies import Policy
from bootcourse.replay3d import hud, scene, server
from bootcourse.replay3d.camera import BIRD, CHASE, SIDE, pose
from bootcourse.replay3d.stage import Stage
from bootcourse.replay3d.timeline import Timeline

RATES = (30, 20, 15, 10)  # frames a second; the first that fits CAR_FRAMES is taken
CAR_FRAMES = 90_000  # cars x frames, at most: ten cars for 150 s at 30 Hz are half of it, and make 1.4 MB
HUD_RATE = 2  # Hz
LINGER = 2.0  # s for which the last frame stays before the replay starts again

OVERLAY = """
<style>
#bc-hud {position:fixed;right:8px;top:8px;width:324px;max-height:calc(100% - 64px);overflow:auto;z-index:500;
border-radius:8px;color:@INK@;background:@PAPER@;box-shadow:0 1px 8px #0003;backdrop-filter:blur(6px)}
#bc-hud summary {cursor:pointer;padding:5px 10px 1px;font:600 12px system-ui,sans-serif}
#bc-hud button {font:11px system-ui,sans-serif;color:inherit;background:none;border:1px solid currentColor;
border-radius:4px;margin:2px 4px 2px 0;padding:1px 7px;cursor:pointer;opacity:.85}
#bc-cameras {padding:2px 10px}
@media (max-height:620px) {#bc-hud .plot svg, #bc-hud .cursor {height:30px}}
@media (max-height:520px) {#bc-plots, #bc-cursor {display:none} #bc-hud .bc {line-height:1.2}}
@media (max-height:420px) {#bc-hud tr:not(.on):has(td.bar) {display:none}}
@media (max-width:640px) {#bc-hud {width:210px} #bc-hud .plot, #bc-hud table {display:none}}
</style>
@STYLE@
<details id="bc-hud" open><summary>@TITLE@</summary>
<div id="bc-cameras"></div><div id="bc-numbers"></div><div id="bc-plots">@PLOTS@</div>
<div id="bc-cursor"></div></details>
<script>
(function () {
  var next = null;
  window.bootcourseHud = function (numbers, cursor) {
    if (next === null) requestAnimationFrame(function () {
      document.getElementById("bc-numbers").innerHTML = next[0];
      document.getElementById("bc-cursor").innerHTML = next[1];
      next = null;
    });
    next = [numbers, cursor];
  };
  var hud = document.getElementById("bc-hud"), cameras = @CAMERAS@;
  requestAnimationFrame(function () {  // before that, the width of a frame inside a page may still be 0
    if (window.innerWidth < 480) hud.open = false;
  });
  hud.addEventListener("wheel", function (e) { e.stopPropagation(); });
  Object.keys(cameras).forEach(function (name) {
    var button = document.createElement("button"), p = cameras[name];
    button.textContent = name;
    button.onclick = function () {  // three.js counts (x, y, z) as (-y, z, -x)
      var control = window.__viserMutable && window.__viserMutable.cameraControl;
      if (control) control.setLookAt(-p[1], p[2], -p[0], -p[4], p[5], -p[3], true);
      button.blur();
    };
    document.getElementById("bc-cameras").appendChild(button);
  });
})();
</script>
"""


def to_html(
    rollouts: Rollout | Sequence[Rollout], dark: bool = False, futures: Policy | None = None, details: bool = False
) -> str:
    """The replay as an HTML document. Raises BootcourseError if the drives cannot be shown together.

    futures, details: see `viewer.replay`.
    """
    timelines = scene.timelines_of(rollouts, futures)
    duration = max(timeline.duration for timeline in timelines)
    cars = sum(timeline.rollout.scenario.vehicles for timeline in timelines)
    rate = next((rate for rate in RATES if cars * duration * rate <= CAR_FRAMES), RATES[-1])
    recorder = server.LocalServer()
    try:
        stage = Stage(recorder, timelines, dark)
        recording = recorder.get_scene_serializer()
        stage.unsettle()
        frames = int(round(duration * rate))
        for frame in range(frames + 1):
            t = min(frame / rate, duration)
            stage.show(t)
            if frame % (rate // HUD_RATE) == 0 or frame == frames:
                shown = (hud.page(timelines, t, details), hud.cursor(t / duration))
                script = f"window.bootcourseHud&&bootcourseHud({','.join(map(json.dumps, shown))})"
                recorder.scene._websock_interface.queue_message(_messages.RunJavascriptMessage(script))
            recording.insert_sleep(1 / rate)
        recording.insert_sleep(LINGER)
        page = recording.as_html(dark_mode=dark)
    finally:
        recorder.stop()
    plots = hud.plots(timelines) if details else Markup("")
    return _with_overlay(page, timelines, dark, stage.span, plots)


def _with_overlay(page: str, timelines: list[Timeline], dark: bool, span: float, plots: Markup) -> str:
    drivers = " · ".join(display_name(timeline.rollout.label) for timeline in timelines)
    title = html("{} on road {}", drivers, timelines[0].rollout.seed)
    poses = {name: [*pose(name, span).position, *pose(name, span).look_at] for name in (CHASE, BIRD, SIDE)}
    parts = {
        "INK": "#EEF1F4" if dark else "#14181C",
        "PAPER": "#10161Ecc" if dark else "#FFFFFFd8",
        "STYLE": hud.STYLE,
        "PLOTS": plots,
        "CAMERAS": json.dumps(poses),
        "TITLE": title,  # last, since it comes from a file and nothing in it may be replaced
    }
    overlay = OVERLAY
    for part, text in parts.items():
        overlay = overlay.replace(f"@{part}@", text)
    page = page.replace("<title>Viser</title>", f"<title>{title}</title>", 1)
    end = page.rindex("</body>")
    return page[:end] + overlay + page[end:]


def export(
    rollouts: Rollout | Sequence[Rollout],
    path: Path,
    dark: bool = False,
    futures: Policy | None = None,
    details: bool = False,
) -> Path:
    """Write the replay as a whole file. Returns the path. Raises BootcourseError if it does not end in .html."""
    path = check_replaceable(path, ".html")
    write_bytes(path, to_html(rollouts, dark, futures, details).encode())
    return path


class Recording:
    """A replay that is saved in the notebook: it plays without a kernel, also in the book.

    In a notebook that is not trusted Jupyter removes the scripts, and the picture `poster` (PNG) stays: the drives from
    above at one moment. Below it the drives are described in words, for readers who cannot see it.
    """

    def __init__(self, html: str, poster: bytes, height: int, alt: str, words: str):
        self.html, self.poster, self.height, self.alt, self.words = html, poster, height, alt, words

    def html_with_poster(self) -> Markup:
        """The recording over its poster, as HTML to put into a page."""
        page = (
            '<div style="position:relative;height:{}px;overflow:hidden">'
            '<img src="data:image/png;base64,{}" alt="{}" style="width:100%;height:100%;object-fit:contain">'
            '<iframe title="Replay in 3D" sandbox="allow-scripts" srcdoc="{}" '
            'style="position:absolute;inset:0;width:100%;height:100%;border:0"></iframe></div>'
        )
        return html(page, self.height, base64.b64encode(self.poster).decode(), self.alt, self.html)

    def _repr_mimebundle_(self, include=None, exclude=None) -> dict:
        page = '<details><summary>In words</summary><pre style="white-space:pre-wrap">{}</pre></details>'
        shown = self.html_with_poster() + html(page, self.words)
        # The first line is what JupyterLab shows of a folded output.
        return {"text/html": f"<!-- a replay -->\n{shown}", "text/plain": self.alt}


def recording(
    rollouts: Rollout | Sequence[Rollout],
    *,
    height: int = 560,
    dark: bool = False,
    futures: Policy | None = None,
    details: bool = False,
) -> Recording:
    """Like `replay`, but as a recording that is saved in the notebook (about 1.5 MB for each drive)."""
    drives = [timeline.rollout for timeline in scene.timelines_of(rollouts)]
    picture = key_frame(drives)
    alt = f"A replay in 3D; where it cannot play, one moment of it from above. {picture.alt}"
    return Recording(to_html(drives, dark, futures, details), png(picture), height, alt, transcripts(drives))
