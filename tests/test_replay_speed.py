"""How fast the replay is. The tests keep generous bounds; `python -m tests.test_replay_speed` measures and prints.

The viewers here are not browsers but small processes that take every message a browser would take: so
the share of the processor that is reported is the server's own.
"""

import os
import resource
import subprocess
import sys
import threading
import time
import tracemalloc
from dataclasses import replace

import numpy as np

from bootcourse.episodes.record import record
from bootcourse.policies import rule_policy
from bootcourse.replay3d import replay
from tests.browser import missing, open_browser
from tests.replays import TEN_CARS

VIEWER = """
import sys, time, msgspec, viser
from websockets.sync.client import connect
camera = dict(type="ViewerCameraMessage", wxyz=(1, 0, 0, 0), position=(0, 0, 9), fov=1.0, near=0.1, far=100.0,
              image_height=720, image_width=1280, look_at=(9, 0, 0), up_direction=(0, 0, 1))
end, count, size = time.time() + float(sys.argv[2]), 0, 0
with connect(f"ws://127.0.0.1:{sys.argv[1]}", subprotocols=[f"viser-v{viser.__version__}"], max_size=None) as socket:
    socket.send(msgspec.msgpack.encode(camera))
    while time.time() < end:
        try:
            size += len(socket.recv(timeout=1.0)); count += 1
        except TimeoutError:
            pass
print(count, size)
"""


def drives(count: int):
    drive = record(rule_policy(TEN_CARS), [1], TEN_CARS, "rule")[0]
    policy = np.full((len(drive.actions), 9), 1 / 9)
    labels = ("sac", "rule", "bootstrapped", "planner", "my own")[:count]
    return [replace(drive, label=label, policy=policy, q_values=policy) for label in labels]


def play(live, seconds: float, viewers: int) -> dict:
    """Play for a while before so many viewers: frames a second, share of one core, messages and bytes a second."""
    command = [sys.executable, "-c", VIEWER, str(live.port)]
    processes = [
        subprocess.Popen([*command, str(seconds + 2)], stdout=subprocess.PIPE, text=True) for _ in range(viewers)
    ]
    while len(live.server.get_clients()) < viewers:
        time.sleep(0.02)
    live.player.loop = True
    live.player.play()
    time.sleep(0.5)
    wall, cpu, frames = time.perf_counter(), time.process_time(), live.player.frames
    time.sleep(seconds)
    wall, cpu, frames = time.perf_counter() - wall, time.process_time() - cpu, live.player.frames - frames
    received = [[int(number) for number in process.communicate()[0].split()] for process in processes]
    return {
        "frames a second": frames / wall,
        "share of one core": cpu / wall,
        "batches a second and viewer": np.mean([count for count, _ in received]) / (seconds + 2),
        "kB a second and viewer": np.mean([size for _, size in received]) / (seconds + 2) / 1e3,
    }


def openings(drive, times: int) -> list[float]:
    """Seconds from the address to the first picture with all cars, each time, in Chromium without a graphics card."""
    last_car = f"window.__viserMutable?.nodeRefFromName['/drive0/car{drive.scenario.vehicles - 1}/paint']"
    seconds = []
    with open_browser() as new_page:
        for _ in range(times):
            page = new_page().page
            with replay(drive) as live:
                started = time.perf_counter()
                page.goto(live.url, wait_until="commit")
                page.wait_for_function(f"() => {last_car}")
                page.evaluate("() => new Promise(seen => requestAnimationFrame(() => requestAnimationFrame(seen)))")
                seconds.append(time.perf_counter() - started)
            page.close()
    return seconds


def test_a_full_episode_of_ten_cars_is_ready_in_under_two_seconds():
    [drive] = drives(1)
    started = time.process_time()  # not the clock on the wall: other tests run beside this one
    with replay(drive):
        assert time.process_time() - started < 2.0


def test_a_frame_leaves_the_server_in_a_fraction_of_its_thirtieth_of_a_second():
    with replay(drives(5)) as live:
        started = time.process_time()
        for k in range(60):
            live._frame(3.0 + k / 30)
        assert (time.process_time() - started) / 60 < 1 / 30 / 2


def test_memory_does_not_grow_while_it_loops():
    with replay(drives(1)[0]) as live:
        buffer = live.server._websock_server._broadcast_buffer

        def a_loop() -> None:
            for t in np.arange(0.0, 150.0, 3.7):
                live._frame(float(t))

        a_loop()
        tracemalloc.start()
        try:
            a_loop()
            held, messages = tracemalloc.get_traced_memory()[0], len(buffer.message_from_id)
            for _ in range(2):
                a_loop()
            assert len(buffer.message_from_id) == messages
            assert tracemalloc.get_traced_memory()[0] - held < 200_000
        finally:
            tracemalloc.stop()


def main(seconds: float = 20.0) -> None:
    drive = drives(1)[0]
    started = time.perf_counter()
    with replay(drive) as live:
        print(f"{os.cpu_count()} cores; a full episode of ten cars is ready in {time.perf_counter() - started:.2f} s")
        for name, value in play(live, seconds, 2).items():
            print(f"  one drive, two viewers: {name} {value:.2f}")
    if missing():
        print(f"  seen in a browser after: not measured, {missing()}")
    else:
        print(f"  seen in a browser after {', '.join(f'{each:.2f}' for each in sorted(openings(drive, 10)))} s")
    with replay(drives(5)) as live:
        for name, value in play(live, seconds, 2).items():
            print(f"  five drives, two viewers: {name} {value:.2f}")
    with replay(drive) as live:
        live.player.speed = 8.0
        playing = threading.Thread(target=play, args=(live, 4 * seconds, 1))
        playing.start()
        sizes = []
        for _ in range(4):
            time.sleep(seconds)
            sizes.append(f"{_resident():.1f}")
        playing.join()
    print(f"  looping at 8x: resident memory {', '.join(sizes)} MB, {seconds:.0f} s apart")


def _resident() -> float:
    """Resident memory of this process, MB."""
    try:
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * resource.getpagesize() / 1e6
    except OSError:
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else 20.0)
