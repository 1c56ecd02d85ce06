"""The live replay: it starts, serves, stops, frees its port, stays on this machine, and shows what was driven."""

import gc
import http.client
import importlib.util
import socket
import threading
import time
import urllib.request
from asyncio.base_events import Server
from dataclasses import replace

import msgspec
import numpy as np
import pytest
import viser
import viser._viser
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from bootcourse import one_per_cell
from bootcourse.episodes.record import record
from bootcourse.errors import BootcourseError
from bootcourse.policies import idle_policy, rule_policy
from bootcourse.replay3d import replay, scene, server, viewer
from bootcourse.replay3d.camera import BIRD, SIDE, point, pose
from tests.browser import ARTEFACTS, CARS, close_notice, is_blank, needs_browser, open_browser
from tests.replays import SHORT, TEN_CARS, thinking
from tests.waiting import until


@pytest.fixture(scope="module")
def drives():
    return [
        record(driver, [1], SHORT, label)[0] for driver, label in ((idle_policy, "sac"), (rule_policy(SHORT), "rule"))
    ]


@pytest.fixture
def shown(drives):
    with replay(drives[1]) as live:
        yield live


def is_open(port: int, host: str = "127.0.0.1") -> bool:
    with socket.socket() as probe:
        probe.settimeout(1.0)
        return probe.connect_ex((host, port)) == 0


def ask(port: int, message: dict) -> None:
    """Speak to the server as a viewer's page does."""
    with connect(f"ws://127.0.0.1:{port}", subprotocols=[f"viser-v{viser.__version__}"], max_size=None) as socket:
        socket.send(msgspec.msgpack.encode(message))
        time.sleep(0.5)


def test_it_starts_serves_stops_and_frees_its_port_several_times_in_a_row(drives, capfd):
    threads = threading.active_count()
    for _ in range(5):
        with replay(drives[1]) as live:
            with urllib.request.urlopen(live.url, timeout=10) as page:
                assert page.status == 200 and b"<html" in page.read()
            port = live.port
        assert not is_open(port)
        live.close()  # closing twice does nothing
    assert capfd.readouterr() == ("", ""), "viser's banner is not shown"
    assert not one_per_cell.running() and until(lambda: threading.active_count() <= threads + 1)


def test_a_viser_that_does_not_take_the_guard_is_stopped_with_a_sentence(drives, monkeypatch):
    class Unguarded(server.PLAIN):
        started = 0

    threads = threading.active_count()
    monkeypatch.setattr(server, "OwnPagesOnly", Unguarded)
    with pytest.raises(BootcourseError, match="without our guard against pages of other sites"):
        replay(drives[1])
    assert until(lambda: threading.active_count() <= threads + 1)


def test_it_listens_on_this_machine_only(shown):
    assert shown.server.get_host() == "127.0.0.1" and is_open(shown.port)
    bound = [s.getsockname()[0] for s in _listening(shown.server)]
    assert bound == ["127.0.0.1"]
    shown.player.play()
    time.sleep(0.2)
    assert shown.player.t == 0.0, "without viewers the clock waits"


def _listening(live):
    loop = live._websock_server._background_event_loop
    servers = [thing for thing in gc.get_objects() if issubclass(type(thing), Server)]  # isinstance would wake torch
    return [each for thing in servers if thing.get_loop() is loop for each in thing.sockets]


def answer(port: int, **headers: str) -> int:
    """The status of the page, asked for with these headers."""
    asked = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
    asked.request("GET", "/", headers=headers)
    return asked.getresponse().status


def opens(port: int, host: str, **options) -> bool:
    """Does a WebSocket to host:port open? It reaches 127.0.0.1, as a rebound name would."""
    with socket.create_connection(("127.0.0.1", port)) as sock:
        try:
            connect(f"ws://{host}", sock=sock, subprotocols=[f"viser-v{viser.__version__}"], **options).close()
        except InvalidStatus as error:
            assert error.response.status_code == 403
            return False
    return True


def test_a_page_of_another_site_cannot_connect(shown):
    here = f"127.0.0.1:{shown.port}"
    assert opens(shown.port, here) and opens(shown.port, here, origin=f"http://{here}")
    assert opens(shown.port, "localhost:8080", origin="http://localhost:8080"), "through a tunnel such as ssh's"
    for origin in ("http://evil.example", "http://127.0.0.1:1", "null", ""):
        assert not opens(shown.port, here, origin=origin), origin


def test_a_name_of_another_site_that_leads_here_is_refused(shown):
    for host in (f"evil.example:{shown.port}", "127.0.0.1.evil.example", "localhost.evil.example", "[::ffff"):
        assert answer(shown.port, Host=host) == 403, host
    assert not opens(shown.port, f"evil.example:{shown.port}", origin=f"http://evil.example:{shown.port}")
    assert answer(shown.port, Host=f"localhost:{shown.port}") == 200


def test_behind_a_hub_the_hubs_own_page_may_connect_and_no_other(shown, monkeypatch):
    monkeypatch.setenv("JUPYTERHUB_SERVICE_PREFIX", "/user/ada/")
    assert answer(shown.port, Host="hub.example") == 200
    assert opens(shown.port, "hub.example", origin="https://hub.example")
    assert not opens(shown.port, "hub.example", origin="https://evil.example")


@pytest.mark.parametrize("plain", [False, True])
def test_a_viewer_cannot_make_it_open_a_public_link_as_plain_viser_would(plain, shown, monkeypatch):
    opened = []

    class NoTunnel:
        """It notes that it was reached for, and opens nothing."""

        get_status, get_url = (lambda self: "failed"), (lambda self: None)

        def __init__(self, *place):
            opened.append(place)

        def __getattr__(self, name):
            return lambda callback=None: callback

    monkeypatch.setattr(viser._viser, "ViserTunnel", NoTunnel)
    with server.quiet():
        live = viser.ViserServer(host="127.0.0.1", port=0, verbose=False) if plain else shown.server
    ask(live.get_port(), {"type": "ShareUrlRequest"})
    assert until(lambda: opened) if plain else not opened and shown.server._share_tunnel is None
    if plain:
        live.stop()
    else:
        assert shown.server.request_share_url() is None and not opened


def test_behind_a_hub_it_goes_through_the_proxy_or_says_what_to_do(monkeypatch):
    monkeypatch.setenv("JUPYTERHUB_SERVICE_PREFIX", "/user/ada/")
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    address, advice = viewer.address_for_browser(4321)
    assert address is None and "install jupyter-server-proxy" in advice
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: object())
    assert viewer.address_for_browser(4321)[0] == "/user/ada/proxy/4321/"


def test_running_a_cell_again_replaces_its_replay(drives, monkeypatch):
    monkeypatch.setattr(one_per_cell, "this_cell", lambda: "cell 1")
    first, second = replay(drives[1]), replay(drives[0])
    assert first.closed and one_per_cell.running() == [second]
    monkeypatch.setattr(one_per_cell, "this_cell", lambda: "cell 2")
    third = replay(drives[1])
    with pytest.raises(BootcourseError):  # a refused replay leaves the old one alone
        replay([])
    assert one_per_cell.running() == [second, third] and is_open(third.port)
    second.close(), third.close()


@needs_browser
def test_in_a_browser_the_cars_are_where_they_were_and_move(drives):
    with replay(drives) as live, open_browser() as new_page:
        page = new_page()
        page.page.goto(live.url)
        assert until(lambda: live.server.get_clients(), 20), "no viewer arrived"
        assert until(lambda: live.player.t > 0.3), "it did not start to play by itself"
        live.player.pause()
        live.player.seek(7.3)
        views = [scene.view(timeline, 7.3) for timeline in live.timelines]
        expected = {f"/drive{k}/car{car}": (views[k].x[car], views[k].y[car]) for k in (0, 1) for car in range(9)}

        def off() -> float:
            placed = page.page.evaluate(CARS, list(expected))
            return max(abs(np.array(placed[name][:2]) - place).max() for name, place in expected.items())

        assert until(lambda: off() < 2e-3, 15), off()
        first, second = live.server.get_clients()[0], new_page()
        second.page.goto(live.url)
        assert until(lambda: len(live.server.get_clients()) == 2, 20)
        point(first.camera, SIDE, live.stage.span)
        other = live.server.get_clients()[1].camera
        assert until(lambda: np.allclose(first.camera.position, pose(SIDE, live.stage.span).position, atol=0.1))
        assert not np.allclose(other.position, first.camera.position, atol=1.0), "a camera is each viewer's own"
        point(first.camera, BIRD, live.stage.span)
        close_notice(page.page)
        page.page.wait_for_timeout(1000)
        picture = page.page.screenshot(path=ARTEFACTS / "test_live_compare.png")
        assert not is_blank(picture)
        assert "rule" in page.page.inner_text("body") and page.errors == [] and second.errors == []


@needs_browser
def test_in_a_browser_the_buttons_and_the_slider_work(drives):
    with replay(drives[1], futures=idle_policy) as live, open_browser() as new_page:
        page = new_page().page
        page.goto(live.url)
        assert until(lambda: live.player.playing, 20)
        page.get_by_role("button", name="Pause").click()
        assert until(lambda: not live.player.playing)
        now = live.player.t
        page.get_by_role("button", name="▸", exact=True).click()
        assert until(lambda: live.player.t > now) and live.player.t % 0.5 == 0.0
        track = page.locator(".mantine-Slider-root").first.bounding_box()
        page.mouse.click(track["x"] + 0.5 * track["width"], track["y"] + track["height"] / 2)
        assert until(lambda: abs(live.player.t - 10.0) < 1.0), live.player.t
        assert until(lambda: f"{live.player.t:.1f}" in page.inner_text("body"))
        page.keyboard.press("f")
        assert until(lambda: not live.stage.drives[0].futures[0].visible), "key F"
        futures = page.get_by_label("Nine futures")
        assert until(lambda: not futures.is_checked()), "the box follows the key"
        futures.click()
        assert until(lambda: live.stage.drives[0].futures[0].visible)
        page.get_by_label("Dark", exact=True).click()
        assert until(lambda: live.stage.dark)


# How fast, in time of the processor: other tests run beside these


def test_ten_cars_are_ready_in_two_seconds_and_a_frame_of_five_drives_in_half_of_a_thirtieth():
    drive = thinking(record(rule_policy(TEN_CARS), [1], TEN_CARS, "rule")[0])
    started = time.process_time()
    with replay(drive):
        assert time.process_time() - started < 2.0
    five = [replace(drive, label=label) for label in ("sac", "rule", "bootstrapped", "planner", "my own")]
    with replay(five) as live:
        started = time.process_time()
        for k in range(60):
            live._frame(3.0 + k / 30)
        assert (time.process_time() - started) / 60 < 1 / 30 / 2
