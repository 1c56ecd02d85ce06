"""Kernels for the notebooks' tests, forked from one warm process (Linux): each has what every lesson imports already.

`begin` starts that process, before pytest's workers. `launch` takes the place of `launch_kernel` in `jupyter_client`. A
forked kernel shares nothing with the others but what was loaded before the first.
"""

import gc
import importlib
import json
import os
import select
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
from pathlib import Path

from jupyter_client import launcher

ADDRESS = "BOOTCOURSE_TESTS_KERNELS"  # the environment's name for the socket on which kernels are asked for
IMPORTED = (
    "ipykernel.kernelapp", "matplotlib_inline.backend_inline", "scipy.stats", "bootcourse.replay3d",
    "bootcourse.course.preloaded",
)  # fmt: skip
WORDS = 2**16  # bytes of a question, at most: an environment, and where the kernel's ports are


def begin() -> subprocess.Popen:
    """The warm process. It ends when its stdin is closed, and its kernels with it."""
    path = Path(tempfile.mkdtemp(prefix="kernels-")) / "socket"
    with socket.socket(socket.AF_UNIX) as asked:
        asked.bind(str(path))
        asked.listen()
        command = [sys.executable, "-m", "tests.warm_kernels", str(asked.fileno())]
        process = subprocess.Popen(command, stdin=subprocess.PIPE, pass_fds=[asked.fileno()])
    os.environ[ADDRESS] = str(path)
    return process


def launch(command: list[str], env=None, cwd=None, **others):
    """A kernel, as `subprocess.Popen` gives one: forked if it is this Python's and the warm process is there."""
    if ADDRESS not in os.environ or command[:2] != [sys.executable, "-m"]:
        return launcher.launch_kernel(command, env=env, cwd=cwd, **others)
    return Forked(command[3:], dict(env or os.environ), cwd)


class Forked:
    """What `jupyter_client` uses of `subprocess.Popen`, for a process that is no child of this one."""

    stdin = stdout = stderr = None

    def __init__(self, arguments: list[str], env: dict[str, str], cwd: str | None):
        with socket.socket(socket.AF_UNIX) as asked:
            asked.connect(os.environ[ADDRESS])
            asked.sendall(json.dumps([arguments, env, str(cwd or Path.cwd())]).encode())
            asked.shutdown(socket.SHUT_WR)
            self.pid = int(asked.recv(WORDS))

    def poll(self) -> int | None:
        """None while it runs."""
        try:
            os.kill(self.pid, 0)
        except ProcessLookupError:
            return 0

    def wait(self) -> int:
        return 0  # is called after `poll` has said that it ended

    def send_signal(self, number: int) -> None:
        os.kill(self.pid, number)

    def terminate(self) -> None:
        self.send_signal(signal.SIGTERM)

    def kill(self) -> None:
        self.send_signal(signal.SIGKILL)


def serve(asked: socket.socket) -> None:
    """Fork a kernel for each question until stdin is closed."""
    load()
    sys.path.remove(os.getcwd())  # a notebook's kernel does not have it
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # who ends leaves nothing
    while sys.stdin not in select.select([asked, sys.stdin], [], [])[0]:
        connection, _ = asked.accept()
        if os.fork() == 0:
            asked.close()
            become_kernel(connection)
        connection.close()
    shutil.rmtree(Path(asked.getsockname()).parent)


def load() -> None:
    """What most lessons import, and the compiled road and learner."""
    for name in IMPORTED:
        importlib.import_module(name)
    import bootcourse as bc

    bc.Training([bc.settings_for("sac")], learner="compiled").run(False, updates=1)
    gc.collect()
    gc.freeze()  # the kernels' garbage collectors leave alone what all share


def become_kernel(connection: socket.socket) -> None:
    """Run a kernel in this process, as `python -m ipykernel_launcher` does."""
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    os.setsid()
    with connection, connection.makefile() as question:
        arguments, env, cwd = json.load(question)
        nothing = os.open(os.devnull, os.O_RDWR)
        for stream in (0, 1, 2):
            os.dup2(nothing, stream)
        os.chdir(cwd)
        os.environ.clear()
        os.environ.update(env | {"JPY_PARENT_PID": str(os.getppid())})
        connection.sendall(str(os.getpid()).encode())
    from ipykernel import kernelapp

    try:
        kernelapp.launch_new_instance(arguments)
    finally:
        os._exit(0)


if __name__ == "__main__":
    serve(socket.socket(fileno=int(sys.argv[1])))
