"""`bootcourse replay FILE…`: open recorded drives in the browser, write them as a file, or tell them in words."""

import contextlib
import threading
import webbrowser
from pathlib import Path


def replay_command(
    files: list[Path],
    export: Path | None = None,
    gif: Path | None = None,
    png: Path | None = None,
    text: bool = False,
    port: int = 0,
    browser: bool = True,
) -> None:
    """Show drives of the same seed together, until Ctrl-C; or write what is asked for, and show nothing.

    Raises BootcourseError: one sentence about the file, the comparison, the port or the path.
    """
    from bootcourse.record.rollout import Rollout

    rollouts = [Rollout.load(Path(file)) for file in files]
    if export or gif or png or text:
        _write(rollouts, export, gif, png)
        if text:
            from bootcourse.study.transcript import in_words

            print(in_words(rollouts))
        return
    from bootcourse.replay3d.viewer import replay

    with replay(rollouts, port=port) as shown, contextlib.suppress(KeyboardInterrupt):
        print(f"Replay at {shown.url} (Ctrl-C ends it)", flush=True)
        if browser:
            webbrowser.open(shown.url)
        threading.Event().wait()


def _write(rollouts, export: Path | None, gif: Path | None, png: Path | None) -> None:
    from bootcourse.replay3d import pictures
    from bootcourse.replay3d.recorder import export as write_html

    for path, write in ((export, write_html), (gif, pictures.write_gif), (png, pictures.write_png)):
        if path is not None:
            print(f"{write(rollouts, path)} ({Path(path).stat().st_size / 1e6:.1f} MB)")
