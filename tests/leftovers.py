"""Does a notebook clean up after itself? nbval's kernel is asked before its first cell and after its last."""

import ast
import os
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
# Runs in the notebook's kernel. Linux says which children a process has; a server has a thread.
SURVEY = """
def survey():
    import threading
    from pathlib import Path
    threads = [(type(t).__name__, t.name) for t in threading.enumerate()]
    children, own = [], Path("/proc/self/task")
    for task in own.iterdir() if own.exists() else ():
        children += (task / "children").read_text().split()
    return {"threads": threads, "children": sorted(map(int, children))}
"""
ASK = f"(lambda names: (exec({SURVEY!r}, names), names['survey']())[1])({{}})"
HARMLESS = {"TMonitor", "HistorySavingThread", "GarbageCollectorThread"}  # of tqdm, of IPython, of the kernel's sockets
PATIENCE = 5.0  # s that what was closed has to end


def survey(kernel) -> dict:
    """What the kernel of nbval holds now: threads, also those of a server, and child processes."""
    sent = kernel.kc.execute("", silent=True, store_history=False, user_expressions={"found": ASK})
    kernel.await_idle(sent, 30)
    while True:
        reply = kernel.get_message("shell", timeout=30)
        if reply["parent_header"].get("msg_id") == sent:
            found = reply["content"]["user_expressions"]["found"]
            return ast.literal_eval(found["data"]["text/plain"])


def files() -> set[str]:
    """Every file where a notebook could leave one: beside it, in the assets, at the top."""
    inside = [path for folder in ("notebooks", "assets") for path in (ROOT / folder).rglob("*")]
    return {str(p.relative_to(ROOT)) for p in [*inside, *ROOT.iterdir()] if not hidden(p.relative_to(ROOT))}


def hidden(path: Path) -> bool:
    return any(part.startswith(".") or part in ("__pycache__", "build") for part in path.parts)


def left_behind(before: dict, after: dict) -> list[str]:
    """What is there that was not, as sentences."""
    new = [f"the thread {name} ({kind})" for kind, name in after["threads"]
           if (kind, name) not in before["threads"] and kind not in HARMLESS]  # fmt: skip
    children = [child for child in after["children"] if child not in before["children"] and not serves_checks(child)]
    return new + [f"the process {child}" for child in children]


def serves_checks(process: int) -> bool:
    """Is it the server of multiprocessing that starts the checks' processes? It lives as long as its kernel."""
    try:
        return b"multiprocessing." in Path(f"/proc/{process}/cmdline").read_bytes()
    except OSError:  # it has ended
        return False


def alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


class LeavesNothing(pytest.Item):
    """The last test of a notebook."""

    def runtest(self):
        kernel, before = self.parent.kernel, self.parent.before
        after = survey(kernel)
        until = time.monotonic() + PATIENCE
        while left_behind(before, after) and time.monotonic() < until:  # what was closed may take a moment
            time.sleep(0.2)
            after = survey(kernel)
        found = left_behind(before, after)
        kernel.stop()
        until = time.monotonic() + PATIENCE
        while any(alive(child) for child in after["children"]) and time.monotonic() < until:
            time.sleep(0.2)
        found += [f"the process {child}, after its kernel's end" for child in after["children"] if alive(child)]
        found += [f"the file {name}" for name in sorted(files() - self.parent.files)]
        assert not found, f"the notebook leaves {', '.join(found)} behind"

    def reportinfo(self):
        return self.path, 0, "leaves nothing behind"
