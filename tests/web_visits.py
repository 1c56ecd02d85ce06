"""Five visits to the page that drives, and how fast it is: `python -m tests.web_visits trap.html FOLDER [VISIT ...]`.

Each visitor has one way of doing things; what they meet is printed, and pictures are written to the folder.
"""

import sys
import time
from functools import partial
from pathlib import Path

import numpy as np

from bootcourse.road import twin
from bootcourse.road.constants import constants
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT
from tests.browser import open_browser
from tests.drive_page import opened


def words(page) -> str:
    return " | ".join(page.page.locator(f"#{name}").inner_text() for name in ("verdict-title", "verdict", "hint"))


def to_the_end(page) -> None:
    page.page.wait_for_function("() => trap.game.finished", timeout=120_000)


def child(visit, picture):
    """Presses left, and nothing else, on four drives."""
    with visit() as page:
        for _ in range(4):
            while not page.page.evaluate("trap.game.finished"):
                page.page.keyboard.press("ArrowLeft")
                page.page.wait_for_timeout(300)
            yield words(page)
            picture(page)
            page.page.keyboard.press("r")


def phone(visit, picture):
    """Holds the page in one hand and follows the bold trail with a thumb, step by step, until the drive ends."""
    with visit("#road=3&pace=0&futures=1", width=390, height=844, reduced_motion="reduce") as page:
        touch(page, page.page.locator("#view"))
        yield f"in 3D: {page.page.locator('#scene').is_visible()}"
        for second in range(150):
            if page.page.evaluate("trap.game.finished"):
                break
            best = page.page.evaluate("largest(trap.game.futures.map(each => each.value))")
            touch(page, page.page.locator("#pad button").nth([6, 7, 8, 3, 4, 5, 0, 1, 2].index(best)))
            page.page.wait_for_function(f"() => trap.game.drive.time === {second + 1} && !trap.game.running")
            if second == 29:
                yield page.page.evaluate("`after ${trap.game.drive.time} s: ${stateInWords(trap.game.drive.cars)}`")
                picture(page, "-3d")
                touch(page, page.page.locator("#view"))
                picture(page, "-above")
        yield words(page)
        picture(page)
        touch(page, page.page.locator("#end-again"))
        yield f"again: {page.page.evaluate('trap.game.drive.time')} s driven, errors: {page.errors}"


def touch(page, element) -> None:
    """Touch the middle of an element with a finger, as a phone does."""
    box, session = element.bounding_box(), page.page.context.new_cdp_session(page.page)
    point = {"x": box["x"] + box["width"] / 2, "y": box["y"] + box["height"] / 2}
    session.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [point]})
    session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    session.detach()


def keyboard(visit, picture):
    """Goes from control to control with Tab, changes each with keys, and listens to what is read out."""
    with visit("#pace=0") as page:
        order = []
        for _ in range(40):
            page.page.keyboard.press("Tab")
            order.append(page.page.evaluate("document.activeElement.id || document.activeElement.ariaLabel || ''"))
        yield "Tab: " + ", ".join(dict.fromkeys(order))
        page.page.locator("#pad button").nth(7).focus()
        page.page.keyboard.press("Enter")
        page.page.wait_for_function("() => trap.game.drive.time === 1")
        yield page.page.locator("#live").inner_text()
        page.page.locator("#ghost").focus()
        page.page.keyboard.press("ArrowDown")
        yield f"ghost: {page.page.evaluate('trap.game.ghostName')}"
        picture(page)


def sceptic(visit, picture):
    """Wants to see SAC fail."""
    with visit() as page:
        page.page.get_by_role("button", name="A road on which SAC never gets out").click()
        page.page.wait_for_timeout(3000)
        picture(page)
        to_the_end(page)
        yield words(page)


def lecturer(visit, picture):
    """Shows on a projector what ξ does: moves the slider, and lets the compromise drive."""
    with visit("#road=10&driver=soft&ghost=sac", width=1920, height=1080) as page:
        for place in ("0", "6", "12", "16"):
            page.page.locator("#xi").fill(place)
            page.page.keyboard.press("5")
            page.page.locator("#go").click()
            to_the_end(page)
            yield f"ξ = {page.page.locator('#xi-value').inner_text()}: {words(page)}"
        picture(page)
        page.page.keyboard.press("r")


FRAMES = """() => new Promise(done => {
    let frames = 0;
    const begin = performance.now(), game = trap.game;
    const count = now => (now - begin > 5000 ? done(frames / 5) : (frames++, requestAnimationFrame(count)));
    game.setPace(2);
    game.run(true);
    requestAnimationFrame(count);
})"""
DRAWING = """() => {
    const begin = performance.now();
    for (let k = 0; k < 200; k++) trap.game.draw();
    return (performance.now() - begin) / 200;
}"""
DRAWING_3D = """() => {
    const begin = performance.now(), { gl } = trap.game.scene, pixel = new Uint8Array(4);
    for (let k = 0; k < 20; k++) {
        trap.game.draw();
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel); // waits until the picture is there
    }
    return (performance.now() - begin) / 20;
}"""
DECIDING = """() => {
    const road = trap.game.road, start = road.place(1), cars = road.place(1), begin = performance.now();
    for (let drive = 0; drive < 1000; drive++) {
        cars.set(start);
        for (let k = 0; k < 150; k++) road.decide(cars, 4);
    }
    return 150000 / (performance.now() - begin) * 1000;
}"""


def with_numba(roads: int) -> float:
    """Decisions a second of the compiled road, without the environment around it."""
    env, actions = TrapVectorEnv(roads), np.full(roads, 4)
    env.reset(seed=[1] * roads)
    rest = np.zeros(roads, dtype=bool), constants(DEFAULT), np.zeros(roads), np.zeros((roads, 3)), np.zeros(roads, int)
    begin = time.perf_counter()
    for k in range(150_000 // roads):
        if k % 150 == 0:
            cars = env.cars.copy()
        twin.decide(cars, actions, *rest, twin.NO_TRACE)
    return 150_000 // roads * roads / (time.perf_counter() - begin)


def speed(visit, picture):
    """How fast the page opens, draws and decides; numba on the same machine beside it."""
    with visit() as page:
        yield f"{page.page.evaluate('trap.ready'):.0f} ms from opening to the first drivable moment"
        yield f"{page.page.evaluate(FRAMES):.0f} frames a second, {page.page.evaluate(DRAWING):.2f} ms to draw one"
        page.page.keyboard.press("v")
        frames, drawing = page.page.evaluate(FRAMES), page.page.evaluate(DRAWING_3D)
        yield f"in 3D: {frames:.0f} frames a second, {drawing:.1f} ms to draw one"
        here, one, many = page.page.evaluate(DECIDING), with_numba(1), with_numba(256)
        yield f"decisions a second: {here:,.0f} in Chromium; numba {one:,.0f} with 1 road, {many:,.0f} with 256"


def photograph(folder: Path, name: str, page, moment: str = "") -> None:
    page.page.screenshot(path=folder / f"{name}{moment}.png")


VISITS = (speed, child, phone, keyboard, sceptic, lecturer)


def main(path: Path, folder: Path, *names: str) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    with open_browser(offline=True) as new_page:
        for visitor in (each for each in VISITS if not names or each.__name__ in names):
            picture = partial(photograph, folder, visitor.__name__)
            print(f"\n{visitor.__name__}: {visitor.__doc__}", flush=True)
            for line in visitor(partial(opened, new_page, path), picture):
                print(f"- {line}", flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]), *sys.argv[3:])
