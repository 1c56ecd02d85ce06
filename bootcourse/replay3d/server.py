"""A viser server that only this machine can reach.

It binds 127.0.0.1 alone, opens no public link when a viewer asks for one, and ends with the kernel. It answers the
pages that it serves itself and no others: a page of another site, open in the same browser, could otherwise connect to
it, and a name that leads to 127.0.0.1 could be that of another site.
"""

import contextlib
import http
import os
import re
import threading

import viser
import websockets.asyncio.server
from rich import get_console

from bootcourse.errors import BootcourseError

HOST = "127.0.0.1"
OWN_NAME = re.compile(r"(127\.0\.0\.1|localhost|\[::1\])(:\d+)?")  # of this machine, also through a tunnel to it
REFUSAL = "This replay answers only the page at its own address: open http://127.0.0.1 with its port.\n"
PLAIN = websockets.asyncio.server.serve


class OwnPagesOnly(PLAIN):
    """A websocket server that refuses foreign requests, of HTTP and of WebSockets, before it does anything else."""

    started = 0  # servers

    def __init__(self, *args, process_request, **options):
        def check_first(connection, request):
            if is_foreign(request.headers):
                return connection.respond(http.HTTPStatus.FORBIDDEN, REFUSAL)
            return process_request(connection, request)

        super().__init__(*args, process_request=check_first, **options)
        OwnPagesOnly.started += 1


def is_foreign(headers) -> bool:
    """Does a request come from another site's page? headers: "Host", and the "Origin" that browsers add.

    Behind a hub, jupyter-server-proxy has checked who asks, and passes the hub's own name on, which we cannot know.
    """
    host, origin = headers.get("Host", ""), headers.get("Origin")
    if origin not in (None, f"http://{host}", f"https://{host}"):
        return True
    return "JUPYTERHUB_SERVICE_PREFIX" not in os.environ and not OWN_NAME.fullmatch(host)


class LocalServer(viser.ViserServer):
    """A viser server on this machine that any of its viewers may use and nobody else.

    Any viewer of a plain viser server can make it open a tunnel to the internet; this one opens none.
    """

    _starting = threading.Lock()

    def __init__(self):
        # viser has no setting for its websocket server and takes the class by this name, once, while it starts.
        with self._starting, quiet():
            websockets.asyncio.server.serve, before = OwnPagesOnly, OwnPagesOnly.started
            try:
                super().__init__(host=HOST, port=0, label="bootcourse replay", verbose=False)
            finally:
                websockets.asyncio.server.serve = PLAIN
        if OwnPagesOnly.started == before:
            self.stop()
            raise BootcourseError(
                "This version of viser starts its server in another way, without our guard against pages of other "
                "sites: install the version that environment.lock names."
            )

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
