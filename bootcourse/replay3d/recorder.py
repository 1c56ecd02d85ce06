"""A replay as one HTML file: no server, no network, camera under the mouse, the numbers laid over the scene.

viser records the messages of its scene and packs them with its own page. Its panel is not part of
that, so the head-up display (the very HTML of the live panel) travels as small scripts along the
recording, and a few lines of JavaScript show it in a box over the scene.
"""

import base64
import json
from html import escape
from pathlib import Path

from viser import _messages

from bootcourse.episodes.words import outcome, sentence, transcripts
from bootcourse.errors import BootcourseError
from bootcourse.files import write_bytes
from bootcourse.methods import display_name
from bootcourse.replay3d import hud, scene, server
from bootcourse.replay3d.camera import BIRD, CHASE, SIDE, pose
from bootcourse.replay3d.pictures import png_bytes
from bootcourse.replay3d.stage import Options, Stage
from bootcourse.replay3d.timeline import Timeline

RATES = (30, 20, 15, 10)  # frames a second: the first that fits the budget is taken
CAR_FRAMES = 90_000  # cars x frames: ten cars for 150 s at 30 Hz make half of it, and 1.4 MB
HUD_RATE = 2  # Hz
LINGER = 2.0  # s for which the last moment stays before the replay begins again

OVERLAY = """
<style>
#bc-hud {position:fixed;left:8px;top:8px;width:300px;max-height:calc(100% - 64px);overflow:auto;z-index:500;
border-radius:8px;color:@INK@;background:@PAPER@;box-shadow:0 1px 8px #0003;backdrop-filter:blur(6px)}
#bc-hud summary {cursor:pointer;padding:5px 10px 1px;font:600 12px system-ui,sans-serif}
#bc-hud button {font:11px system-ui,sans-serif;color:inherit;background:none;border:1px solid currentColor;
border-radius:4px;margin:2px 4px 2px 0;padding:1px 7px;cursor:pointer;opacity:.85}
#bc-cameras {padding:2px 10px}
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
  if (window.innerWidth < 480) hud.open = false;
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


def rate_for(cars: int, duration: float) -> int:
    """Frames a second that keep the file small."""
    for rate in RATES:
        if cars * duration * rate <= CAR_FRAMES:
            return rate
    return RATES[-1]


def to_html(rollouts, options: Options | None = None) -> str:
    """The replay as a whole HTML document. Raises BootcourseError if the drives cannot be shown together."""
    options, timelines = options or Options(), scene.timelines_of(rollouts)
    duration = max(timeline.duration for timeline in timelines)
    rate = rate_for(sum(timeline.rollout.scenario.vehicles for timeline in timelines), duration)
    recorder = server.start()
    try:
        stage = Stage(recorder, timelines, options)
        recorder.gui.configure_theme(dark_mode=options.dark, show_logo=False, show_share_button=False)
        recording = recorder.get_scene_serializer()
        stage.unsettle()
        frames = int(round(duration * rate))
        for frame in range(frames + 1):
            t = min(frame / rate, duration)
            stage.show(t)
            if frame % (rate // HUD_RATE) == 0 or frame == frames:
                script = _hud_script(timelines, t, t / duration, options.follow)
                recorder.scene._websock_interface.queue_message(_messages.RunJavascriptMessage(script))
            recording.insert_sleep(1 / rate)
        recording.insert_sleep(LINGER)
        page = recording.as_html(dark_mode=options.dark)
    finally:
        recorder.stop()
    return _with_overlay(page, timelines, options, stage.span)


def _hud_script(timelines: list[Timeline], t: float, part: float, follow: int) -> str:
    """The script that shows the numbers of time t, `part` (0..1) of the way along the plots."""
    numbers = hud.table(timelines, t) if len(timelines) > 1 else ""
    numbers += hud.card(timelines[follow], t)
    return f"window.bootcourseHud&&bootcourseHud({json.dumps(numbers)},{json.dumps(hud.cursor(part))})"


def _with_overlay(page: str, timelines: list[Timeline], options: Options, span: float) -> str:
    drivers = " · ".join(timeline.rollout.label for timeline in timelines)
    title = escape(f"{drivers} on road {timelines[0].rollout.seed}")
    poses = {name: [*pose(name, span).position, *pose(name, span).look_at] for name in (CHASE, BIRD, SIDE)}
    parts = {
        "INK": "#EEF1F4" if options.dark else "#14181C",
        "PAPER": "#10161Ecc" if options.dark else "#FFFFFFd8",
        "STYLE": hud.STYLE,
        "PLOTS": hud.plots(timelines),
        "CAMERAS": json.dumps(poses),
        "TITLE": title,  # last: it comes from a file, and nothing in it is a name to replace
    }
    overlay = OVERLAY
    for part, text in parts.items():
        overlay = overlay.replace(f"@{part}@", text)
    page = page.replace("<title>Viser</title>", f"<title>{title}</title>", 1)
    end = page.rindex("</body>")
    return page[:end] + overlay + page[end:]


def export(rollouts, path: Path, options: Options | None = None) -> Path:
    """Write the replay to `path` (.html), all or nothing. Returns the path. Raises BootcourseError."""
    path = Path(path)
    if path.suffix.lower() not in (".html", ".htm"):
        raise BootcourseError(f"{path} does not end in .html: give the file a name that a browser opens.")
    write_bytes(path, to_html(rollouts, options).encode())
    return path


class Recording:
    """A replay that lives in the notebook itself: it plays without a kernel, in a saved notebook and in a book.

    Where a notebook is not trusted, its scripts are taken out and the picture stays. Below it, for those
    who do not see it, the drives stand in words.
    """

    def __init__(self, html: str, poster: bytes, height: int, alt: str, words: str = ""):
        self.html, self.poster, self.height, self.alt, self.words = html, poster, height, alt, words

    def save(self, path: Path) -> Path:
        write_bytes(path, self.html.encode())
        return Path(path)

    def html_with_poster(self) -> str:
        """The recording over its own picture, as a piece of a page."""
        picture = f"data:image/png;base64,{base64.b64encode(self.poster).decode()}"
        return (
            f'<div style="position:relative;height:{self.height}px;overflow:hidden">'
            f'<img src="{picture}" alt="{escape(self.alt)}" style="width:100%;height:100%;object-fit:cover">'
            f'<iframe title="Replay in 3D" srcdoc="{escape(self.html)}" '
            'style="position:absolute;inset:0;width:100%;height:100%;border:0"></iframe></div>'
        )

    def _repr_mimebundle_(self, include=None, exclude=None) -> dict:
        words = f'<pre style="white-space:pre-wrap">{escape(self.words)}</pre>'
        told = f"<details><summary>In words</summary>{words}</details>" if self.words else ""
        return {"text/html": self.html_with_poster() + told, "text/plain": self.alt}


def recording(
    rollouts, *, height: int = 560, layout: str = scene.ROADS, follow: int = 0, dark: bool = False, rule: bool = False
) -> Recording:
    """The same as `replay`, as a recording that stays in the saved notebook (about 1.5 MB per drive)."""
    options = Options(layout=layout, follow=follow, dark=dark, rule=rule)
    poster = png_bytes(rollouts, options=options, size=(960, 540))
    drives = [timeline.rollout for timeline in scene.timelines_of(rollouts)]
    return Recording(to_html(rollouts, options), poster, height, alt(rollouts), transcripts(drives))


def alt(rollouts) -> str:
    """What somebody who cannot see the replay should know."""
    told = (
        f"{display_name(timeline.rollout.label)}: {outcome(timeline.rollout)}"
        for timeline in scene.timelines_of(rollouts)
    )
    return f"One moment of a replay in 3D. {sentence('; '.join(told))}."
