"""A viser server that only this machine can reach.

It binds 127.0.0.1 alone, opens no public link when a viewer asks for one, and ends with the kernel.
"""

import contextlib
import os
import socket

import viser
from rich import get_console

from bootcourse.errors import BootcourseError

HOST = "127.0.0.1"


class LocalServer(viser.ViserServer):
    """In viser any viewer can ask the server to open a tunnel to the internet. This server opens none."""

    def request_share_url(self, verbose: bool = True) -> None:
        """Open nothing, and return None."""
        return None

    def stop(self) -> None:
        with quiet():
            super().stop()


@contextlib.contextmanager
def quiet():
    """Suppress what viser prints when it starts and stops."""
    console = get_console()
    before, console.quiet = console.quiet, True
    try:
        yield
    finally:
        console.quiet = before


def start(port: int = 0) -> LocalServer:
    """A running server. port 0 lets the system choose. Raises BootcourseError if the port is taken."""
    if not 0 <= port <= 65535:
        raise BootcourseError(f"Port {port} does not exist: choose one from 1024 to 65535, or 0 for any that is free.")
    if port:
        _check_free(port)
    with quiet():
        server = LocalServer(host=HOST, port=port, label="bootcourse replay", verbose=False)
    if port and server.get_port() != port:  # taken meanwhile, and viser went on to the next port
        server.stop()
        raise BootcourseError(_taken(port))
    return server


def _check_free(port: int) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as probe:
        if os.name == "posix":  # so that a port that was closed a moment ago counts as free
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((HOST, port))
        except PermissionError:
            raise BootcourseError(f"Port {port} belongs to the system: choose one from 1024 to 65535.") from None
        except OSError:
            raise BootcourseError(_taken(port)) from None


def _taken(port: int) -> str:
    return f"Port {port} is in use: choose another one, or leave it out to take any that is free."
