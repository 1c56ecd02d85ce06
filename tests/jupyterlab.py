"""A real JupyterLab for tests: its own settings, a notebook made of some cells, seen in headless Chromium."""

import contextlib
import json
import os
import secrets
import socket
import subprocess
import sys
import time
import urllib.request
from pathlib import Path

import nbformat

from tests.browser import Page, open_browser

CALM = {  # nothing that moves or asks while a test looks; cells far away are not drawn, as a student's are not
    "@jupyterlab/apputils-extension:notification": {"fetchNews": "false", "checkForUpdates": False},
    "@jupyterlab/docmanager-extension:plugin": {"autosave": False},
    "@jupyter-widgets/jupyterlab-manager:plugin": {"saveState": True},
}


@contextlib.contextmanager
def running_lab(folder: Path):
    """JupyterLab on `folder`, on 127.0.0.1 with a token. Yields its address and token."""
    token, port = secrets.token_hex(8), _free_port()
    places = {"JUPYTER_CONFIG_DIR": "config", "JUPYTER_DATA_DIR": "data", "JUPYTER_RUNTIME_DIR": "runtime"}
    places |= {"JUPYTERLAB_SETTINGS_DIR": "lab-settings", "JUPYTERLAB_WORKSPACES_DIR": "workspaces"}
    places |= {"IPYTHONDIR": "ipython"}
    own = folder / ".lab"
    environment = os.environ | {name: str(own / place) for name, place in places.items()}
    for name, settings in CALM.items():
        path = own / "lab-settings" / f"{name.replace(':', '/')}.jupyterlab-settings"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(settings))
    command = [sys.executable, "-m", "jupyter", "lab", "--no-browser", "--ServerApp.ip=127.0.0.1"]
    command += [f"--ServerApp.port={port}", "--ServerApp.port_retries=0", f"--ServerApp.root_dir={folder}"]
    command += [f"--IdentityProvider.token={token}", "--LabApp.expose_app_in_browser=True"]
    command += ["--allow-root"] if hasattr(os, "getuid") and os.getuid() == 0 else []
    with open(folder / "lab.log", "w") as log:
        lab = subprocess.Popen(command, env=environment, stdout=log, stderr=log)
        try:
            _wait_for(f"http://127.0.0.1:{port}/api/status?token={token}", lab, folder / "lab.log")
            yield f"http://127.0.0.1:{port}", token
        finally:
            lab.terminate()
            lab.wait(20)


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def _wait_for(address: str, lab: subprocess.Popen, log: Path) -> None:
    for _ in range(300):
        assert lab.poll() is None, log.read_text()[-2000:]
        with contextlib.suppress(OSError), urllib.request.urlopen(address, timeout=2):
            return
        time.sleep(0.2)
    raise AssertionError(f"JupyterLab does not answer: {log.read_text()[-2000:]}")


ON_CELLS = """([command, first, last]) => {
    const cells = jupyterapp.shell.currentWidget.content;
    cells.deselectAll();
    cells.activeCellIndex = first;
    if (last > first) cells.extendContiguousSelectionTo(last);
    jupyterapp.commands.execute(command);
}"""


class Notebook:
    """A notebook open in JupyterLab. `.page` is playwright's, `.folder` is where the kernel works."""

    def __init__(self, shown: Page, folder: Path):
        self.shown, self.page, self.folder = shown, shown.page, folder

    def cell(self, number: int):
        return self.page.locator(".jp-Notebook .jp-Cell").nth(number)

    def begin(self, first: int, last: int) -> None:
        """Run the cells with these numbers, the last one included, and do not wait for them."""
        self._do("notebook:run-cell", first, last)

    def clear(self, first: int, last: int) -> None:
        """Take away what the cells with these numbers show: it moves and draws no more."""
        self._do("notebook:clear-cell-output", first, last)

    def _do(self, command: str, first: int, last: int) -> None:
        self.page.evaluate(ON_CELLS, [command, first, last])

    def run(self, first: int, last: int, timeout: float = 120.0) -> None:
        """Run the cells with these numbers and wait until no cell runs. Fails if a cell raised."""
        self.begin(first, last)
        self.page.wait_for_timeout(300)
        self.page.wait_for_function(
            "() => document.querySelectorAll('.jp-InputPrompt').length > 0 && "
            "![...document.querySelectorAll('.jp-InputPrompt')].some(p => p.textContent.includes('*'))",
            timeout=1000 * timeout,
        )
        errors = self.page.locator('.jp-OutputArea-output[data-mime-type="application/vnd.jupyter.error"]')
        assert errors.count() == 0, errors.first.inner_text()


@contextlib.contextmanager
def open_lab(folder: Path, width: int = 1366, height: int = 900):
    """A real JupyterLab. Yields `open_notebook(*cells)`: a notebook of these code cells, its kernel ready."""
    with running_lab(folder) as (address, token), open_browser(width, height) as new_page:

        @contextlib.contextmanager
        def open_notebook(*cells: str, saved: str = ""):
            """saved: what stands below each cell that begins with `predicted(`, folded as in a lesson's notebook."""
            notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in cells])
            for cell in notebook.cells:
                if saved and cell.source.startswith("predicted("):
                    cell.update(execution_count=1, outputs=[nbformat.v4.new_output("stream", text=f"{saved}\n")])
                    cell.metadata["jupyter"] = {"outputs_hidden": True}
            notebook.metadata["kernelspec"] = {"display_name": "Python 3", "language": "python", "name": "python3"}
            name = f"lesson-{len(list(folder.glob('*.ipynb')))}.ipynb"
            nbformat.write(notebook, folder / name)
            shown = new_page()
            shown.page.goto(f"{address}/doc/tree/{name}?token={token}&reset")
            shown.page.wait_for_function("() => window.jupyterapp", timeout=60_000)
            shown.page.wait_for_selector(".jp-Notebook .jp-Cell", timeout=60_000)
            shown.page.wait_for_function(
                "() => { const w = jupyterapp.shell.currentWidget; "
                "return w && w.sessionContext && w.sessionContext.session?.kernel?.status === 'idle'; }",
                timeout=60_000,
            )
            yield Notebook(shown, folder)
            shown.page.close()

        yield open_notebook
