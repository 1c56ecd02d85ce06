"""Five visits to the page that drives, and how fast it is: `python -m tests.web_visits trap.html FOLDER`.

Each visitor has one way of doing things; what they meet is printed, and pictures are written to the folder.
"""

import sys
import time
from functools import partial
from pathlib import Path

import numpy as np
from gymnasium.vector import AutoresetMode

from bootcourse.road.vector_env import TrapVectorEnv
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
    """Holds the page in one hand and follows the bold trail with a thumb, step by step, for 30 seconds."""
    with visit("#road=3&pace=0&futures=1", width=390, height=844) as page:
        for _ in range(30):
            best = page.page.evaluate("largest(trap.game.futures.map(each => each.value))")
            button = page.page.locator("#pad button").nth([6, 7, 8, 3, 4, 5, 0, 1, 2].index(best))
            button.click()
            page.page.wait_for_function("() => !trap.game.running && trap.game.controls.idle")
        yield page.page.evaluate("`after ${trap.game.drive.time} s: ${stateInWords(trap.game.drive.cars)}`")
        picture(page)


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
        for place in ("0", "6", "9", "13"):
            page.page.locator("#xi").fill(place)
            page.page.keyboard.press("5")
            page.page.locator("#go").click()
            to_the_end(page)
            yield f"ξ = {page.page.locator('#xi-value').inner_text()}: {words(page)}"
        picture(page)
        page.page.keyboard.press("r")


def speed(visit, picture):
    """How fast it opens, draws and decides; numba on the same machine beside it."""
    with visit() as page:
        yield f"{page.page.evaluate('trap.ready'):.0f} ms from opening to the first drivable moment"
        page.page.evaluate("trap.game.setPace(2); trap.game.run(true)")
        frames = page.page.evaluate(
            """() => new Promise(done => {
                let frames = 0; const begin = performance.now();
                const count = now => (now - begin > 5000 ? done(frames / (now - begin) * 1000)
                    : (frames++, requestAnimationFrame(count)));
                requestAnimationFrame(count);
            })"""
        )
        cost = page.page.evaluate("(() => { const t = performance.now(); for (let k = 0; k < 200; k++) trap.game.draw();"
                                  " return (performance.now() - t) / 200 })()")  # fmt: skip
        yield f"{frames:.0f} frames a second; {cost:.2f} ms to draw one"
        rate = page.page.evaluate(
            """() => { const road = trap.game.road, begin = performance.now(); let decisions = 0;
                while (performance.now() - begin < 3000) for (const cars = road.place(decisions); ; decisions++)
                    if (road.decide(cars, 4).accident || decisions % 150 === 149) { decisions++; break; }
                return decisions / (performance.now() - begin) * 1000; }"""
        )
        env, idle = TrapVectorEnv(1, autoreset_mode=AutoresetMode.SAME_STEP), np.array([4])
        env.reset(seed=0)
        many = TrapVectorEnv(256, autoreset_mode=AutoresetMode.SAME_STEP)
        many.reset(seed=0)
        numba = []
        for each, actions in ((env, idle), (many, np.full(256, 4))):
            begin, steps = time.perf_counter(), 0
            while time.perf_counter() - begin < 3:
                each.step(actions)
                steps += len(actions)
            numba.append(steps / (time.perf_counter() - begin))
        yield f"decisions a second: {rate:,.0f} in Chromium; numba {numba[0]:,.0f} with 1 road, {numba[1]:,.0f} with 256"


def main(path: Path, folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    with open_browser(offline=True) as new_page:
        for visitor in (speed, child, phone, keyboard, sceptic, lecturer):
            picture = lambda page, name=visitor.__name__: page.page.screenshot(path=folder / f"{name}.png")  # noqa: E731
            print(f"\n{visitor.__name__}: {visitor.__doc__}", flush=True)
            for line in visitor(partial(opened, new_page, path), picture):
                print(f"- {line}", flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]))
