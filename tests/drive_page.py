"""The page that drives, opened in Chromium without a network: for tests, pictures and visits."""

import base64
import contextlib
from pathlib import Path

import numpy as np

# Drives episodes in the page: of each decision the cars, the observation before it, reward, accident, and the rule's
# action before it, as bytes.
DRIVE = """({ scenario, seeds, plans }) => {
    const road = new Road(trap.compiled, scenario), numbers = [];
    seeds.forEach((seed, i) => {
        const cars = road.place(seed);
        numbers.push(...cars);
        for (const action of plans[i]) {
            const seen = [...road.observe(cars)], taught = road.rule(cars).action;
            const { reward, accident } = road.decide(cars, action);
            for (const number of cars) numbers.push(number);
            numbers.push(...seen, reward, accident, taught);
            if (accident) break;
        }
    });
    const bytes = new Uint8Array(Float64Array.from(numbers).buffer);
    let text = "";
    for (let i = 0; i < bytes.length; i += 30000) text += String.fromCharCode(...bytes.subarray(i, i + 30000));
    return btoa(text);
}"""


@contextlib.contextmanager
def opened(new_page, path: Path, address: str = "", width: int = 1280, height: int = 720, **media):
    """A `tests.browser.Page` at this address ("#road=7"), ready to drive. media: see playwright's `emulate_media`."""
    page = new_page()
    page.page.set_viewport_size({"width": width, "height": height})
    page.page.emulate_media(**media)
    page.page.goto(path.as_uri() + address)
    page.page.wait_for_function("() => window.trap?.ready")
    yield page
    page.page.close()


def drive_in_page(page, scenario: dict, seeds, plans) -> np.ndarray:
    """The numbers that DRIVE returns, in one row."""
    text = page.page.evaluate(DRIVE, {"scenario": scenario, "seeds": list(seeds), "plans": plans})
    return np.frombuffer(base64.b64decode(text))
