"""The page that drives: the compiled road, the agents and the game in Chromium."""

import base64
import gzip
import json
import os
import re
import subprocess
import sys

import numpy as np
import pytest
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode

from bootcourse.episodes.lookahead import rollout_values
from bootcourse.errors import BootcourseError
from bootcourse.panels.policy_numbers import policy_numbers
from bootcourse.policies import rule_policy
from bootcourse.road.state import HEADING, SPEED, TARGET_LANE, TRAP_1, TRAP_2, X, Y
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.rule import rule
from bootcourse.scenario import ACTION_NAMES, CALIBRATED, DEFAULT, IDLE, Clock, Road, Scenario, Sight, Traffic
from bootcourse.storage.runs import load_run
from bootcourse.web import build, bundle, wasm
from bootcourse.web.entries import ENTRIES
from tests.browser import ARTEFACTS, is_blank, needs_browser
from tests.drive_page import drive_in_page

pytestmark = needs_browser
EPISODES = 40  # of each scenario
SCENARIOS = {
    "default": DEFAULT,
    "calibrated": CALIBRATED,
    "no traffic": Scenario(traffic=Traffic(cars=0)),
    "five lanes, dense traffic": Scenario(road=Road(lanes=5), traffic=Traffic(cars=12, headway=24.0)),
    "other clock, sight and exponent": Scenario(
        clock=Clock(simulation_rate=4), sight=Sight(neighbours=6), traffic=Traffic(delta=3.5)
    ),
}


@pytest.fixture(scope="module")
def module(web_page):
    """The compiled road, out of the page."""
    data = re.search(r'<script type="application/json" id="data">(.*?)</script>', web_page.read_text(encoding="utf-8"))
    return gzip.decompress(base64.b64decode(json.loads(data[1])["module"]))


@pytest.fixture(scope="module")
def page(visit):
    with visit() as page:
        yield page


def driven(scenario: Scenario, episodes: int, first_seed: int = 0):
    """Drives by the rule, by the rule with noise, and at random: (plans, rows as in `drive_page.DRIVE`)."""
    env, rng = TrapVectorEnv(episodes, scenario, AutoresetMode.DISABLED), np.random.default_rng(first_seed)
    seen, _ = env.reset(seed=first_seed)
    noise = np.array([0.0, 0.03, 0.2, 1.0])[np.arange(episodes) % 4]
    plans, rows = [[] for _ in range(episodes)], [[cars.ravel().copy()] for cars in env.cars]
    for _ in range(scenario.clock.decisions):
        awake, taught = ~env.asleep, rule(env.cars, scenario).actions
        actions = np.where(rng.random(episodes) < noise, rng.integers(9, size=episodes), taught)
        before = seen
        seen, rewards, _, _, infos = env.step(actions)
        for i in np.flatnonzero(awake):
            plans[i].append(int(actions[i]))
            rows[i].append([*env.cars[i].ravel(), *before[i], rewards[i], infos["accident"][i], taught[i]])
    return plans, np.concatenate([np.ravel(row) for episode in rows for row in episode])


@pytest.mark.parametrize("name", SCENARIOS)
def test_the_page_drives_as_the_compiled_road_does(page, name):
    scenario = SCENARIOS[name]
    plans, expected = driven(scenario, EPISODES)
    numbers = drive_in_page(page, build.scenario_data(scenario), range(EPISODES), plans)
    assert numbers.shape == expected.shape  # so every drive ends at the same decision
    assert np.abs(numbers - expected).max() < 1e-9


CRAFTED = {  # states that random drives do not reach: (column, the values of cars 3 to 8)
    "cars beside each other": (X, [60.0, 60.0, 60.0, 90.0, 90.0, 130.0]),
    "negative remainders": (HEADING, [-7.0, -3.2, 3.2, 7.0, -np.pi, np.pi]),
    "lanes that two cars want": (TARGET_LANE, [1, 1, 1, 1, 1, 1]),
}


@pytest.mark.parametrize("name", CRAFTED)
def test_the_page_agrees_on_crafted_states(page, name):
    env = TrapVectorEnv(1, autoreset_mode=AutoresetMode.DISABLED)
    env.reset(seed=3)
    column, values = CRAFTED[name]
    env.cars[0, 3:, column] = values
    cars = env.cars[0].copy()
    for _ in range(5):
        env.step(np.array([IDLE]))
    there = page.page.evaluate(
        """cars => {
            const state = Float64Array.from(cars), road = trap.game.road;
            for (let k = 0; k < 5; k++) road.decide(state, 4);
            return [...state];
        }""",
        cars.ravel().tolist(),
    )
    assert np.abs(env.cars.ravel() - there).max() < 1e-9


def test_a_road_has_the_same_number_as_in_python(page):
    seeds = [*range(300), 2**31, 2**32 - 1, 2**32, 2**40 + 7, 999_999_999]
    drawn = page.page.evaluate("seeds => seeds.map(seed => [...uniforms(seed, 19)])", seeds)
    assert np.array_equal(drawn, [seeding.np_random(seed)[0].random(19) for seed in seeds])


@pytest.mark.parametrize("name", build.AGENTS)
def test_an_agent_decides_in_the_page_as_in_python(page, name):
    agent, env = load_run(build.AGENTS[name]).agent, TrapVectorEnv(20)
    seen, _ = env.reset(seed=50)
    states = [seen]
    for _ in range(100):
        states.append(env.step(agent.probabilities(states[-1]).argmax(-1))[0])
    states = np.concatenate(states)
    policy = page.page.evaluate(
        "([name, states]) => states.map(state => softmax(forward(trap.networks[name], state)))",
        [name, states.tolist()],
    )
    probabilities = agent.probabilities(states)
    assert np.abs(policy - probabilities).max() < 1e-3  # float32 there, float64 here
    sure = np.diff(np.sort(probabilities)[:, -2:])[:, 0] > 1e-3
    assert sure.mean() > 0.99
    assert np.array_equal(np.argmax(policy, -1)[sure], probabilities.argmax(-1)[sure])


@pytest.mark.parametrize("p, xi, alpha", [(0.9, 0.2, 0.01), (0.5, 0.0, 0.1)])
def test_the_compromise_is_that_of_the_soft_constraint(page, p, xi, alpha):
    rng = np.random.default_rng(1)
    q, policy = rng.normal(size=9), rng.dirichlet(np.ones(9))
    expected = policy_numbers(policy, q, 3, p, xi, alpha)
    optimum, shares = page.page.evaluate(
        """([q, policy, p, xi, alpha]) => [
            regularisedPolicy(q, stochasticRule(3, p), alpha, xi), klShares(policy, stochasticRule(3, p))]""",
        [q.tolist(), policy.tolist(), p, xi, alpha],
    )
    assert np.allclose(optimum, expected.optimum, atol=1e-12)
    assert np.allclose(shares, expected.shares, atol=1e-12)


def test_what_ships_is_made_of_the_files_as_they_are():
    made_of = json.loads(bundle.SHIPPED.read_text(encoding="utf-8"))["made_of"]
    assert made_of == bundle.fingerprint(), "make it anew: python -m bootcourse.web.bundle"


def test_the_installed_numba_compiles_a_function_to_webassembly(tmp_path):
    one = "from bootcourse.web import entries, wasm; entries.ENTRIES = {'observe': entries.ENTRIES['observe']}"
    write = "import pathlib, sys; pathlib.Path(sys.argv[1]).write_bytes(wasm.compile_entries())"
    command = [sys.executable, "-c", f"{one}; {write}", str(tmp_path / "one.wasm")]
    subprocess.run(command, check=True, env={**os.environ, **wasm.PLAIN, "NUMBA_CACHE_DIR": str(tmp_path)})
    wasm.check((tmp_path / "one.wasm").read_bytes(), {"observe"})


def test_the_build_fails_if_numba_passes_other_arguments():
    text = "define i32 @f(ptr %retptr, ptr %excinfo, i64 %arg.x) local_unnamed_addr #0 {\n  ret i32 0\n}\n"
    assert "@place(ptr %retptr, ptr %excinfo, i64 %arg.x)" in wasm.for_wasm(text, "f", "place", 3)
    assert '"wasm-export-name"="place"' in wasm.for_wasm(text, "f", "place", 3)
    with pytest.raises(BootcourseError, match="expected one function of 4 arguments"):
        wasm.for_wasm(text, "f", "place", 4)


def test_the_build_fails_if_the_module_imports_exports_or_holds_something_else(module, monkeypatch):
    wasm.check(module, set(ENTRIES))
    with pytest.raises(BootcourseError, match=r"lacks the exports \['land'\]"):
        wasm.check(module, {*ENTRIES, "land"})
    with pytest.raises(BootcourseError, match="imports .*'tanh'"):
        wasm.check(module.replace(b"\x03env\x03tan", b"\x03env\x04tanh"), set(ENTRIES))
    end = wasm.data_end(module)
    monkeypatch.setattr(wasm, "FREE", end - 1)
    with pytest.raises(BootcourseError, match=f"constants up to byte {end} .* begin at {end - 1}"):
        wasm.check(module, set(ENTRIES))


def test_the_build_fails_if_a_driver_does_not_do_what_its_name_says(monkeypatch):
    monkeypatch.setattr(build, "ROADS", 10)
    monkeypatch.setattr(build, "ESCAPING", 8)
    escapes = rule_policy(DEFAULT)
    with pytest.raises(BootcourseError, match=r"\['sac', 'crashing'\] do not drive as their names"):
        build.measured({"sac": escapes, "bootstrapped": escapes, "crashing": escapes})


def test_the_nine_futures_are_worth_as_much_as_in_python(page):
    env = TrapVectorEnv(3, autoreset_mode=AutoresetMode.DISABLED)
    env.reset(seed=20)
    there = page.page.evaluate(
        """states => states.map(cars => imagine(
            trap.game.road, Float64Array.from(cars), (road, now) => road.rule(now), trap.data.worth))""",
        env.cars.reshape(3, -1).tolist(),
    )
    values = [[future["value"] for future in futures] for futures in there]
    assert np.abs(values - rollout_values(env.cars, rule_policy(DEFAULT))).max() < 1e-5  # worths have six digits


def test_the_page_is_one_file_that_asks_for_nothing_and_is_under_400_kb(web_page, page):
    assert web_page.stat().st_size < 400_000
    assert page.requests == [web_page.as_uri()]
    assert page.errors == []


def state(page) -> dict:
    """What the game knows: its number, its ghost, whether the clock runs, and the actions so far."""
    return page.page.evaluate(
        """() => ({ number: trap.game.number, ghostName: trap.game.ghostName, running: trap.game.running,
            actions: trap.game.drive.actions })"""
    )


def drive_to_the_end(page) -> None:
    """Let the game's clock run to the end of the drive, however slow this machine draws."""
    page.page.evaluate("() => { while (!trap.game.finished) trap.game.advance(0.1); }")


def test_an_arrow_key_starts_the_clock_and_is_the_next_decision(visit):
    with visit("#road=7&ghost=sac") as page:
        assert state(page)["number"] == 7 and state(page)["ghostName"] == "sac"
        latest = "action => trap.game.drive.actions.at(-1) === action"  # a slow machine decides between two keys
        page.page.keyboard.down("ArrowDown")
        page.page.wait_for_function("() => trap.game.drive.time > 0")
        assert state(page)["actions"][0] == ACTION_NAMES.index("brake straight")
        page.page.keyboard.down("ArrowLeft")
        page.page.wait_for_function(latest, arg=ACTION_NAMES.index("brake left"), timeout=20_000)
        page.page.keyboard.up("ArrowDown")
        page.page.keyboard.up("ArrowLeft")
        page.page.wait_for_function(latest, arg=IDLE, timeout=20_000)
        page.page.keyboard.press("Space")
        assert not state(page)["running"]
        assert page.errors == []


def test_step_by_step_each_press_is_one_decision(visit):
    with visit(reduced_motion="reduce") as page:  # with reduced motion the page opens step by step
        for key, action in (("ArrowUp", "accelerate straight"), ("ArrowRight", "keep right"), ("s", "brake straight")):
            page.page.keyboard.press(key)
            page.page.wait_for_function("() => !trap.game.running && trap.game.controls.idle")
            assert state(page)["actions"][-1] == ACTION_NAMES.index(action)
        assert len(state(page)["actions"]) == 3


def test_step_by_step_a_key_pressed_while_a_step_is_shown_is_the_next_one(visit):
    with visit() as page:
        page.page.get_by_role("button", name="step").click()
        page.page.keyboard.press("ArrowDown")
        page.page.wait_for_function("() => trap.game.running && trap.game.controls.idle")
        page.page.keyboard.press("ArrowLeft")
        page.page.wait_for_function("() => !trap.game.running && trap.game.controls.idle && trap.game.drive.time > 1")
        assert [ACTION_NAMES[a] for a in state(page)["actions"]] == ["brake straight", "keep left"]


def test_a_finger_on_the_pad_drives_and_the_page_fits_a_phone(visit):
    with visit(width=390, height=844, color_scheme="dark") as page:
        assert page.page.evaluate("document.documentElement.scrollWidth") == 390
        page.page.get_by_role("button", name="brake straight").click()
        page.page.wait_for_function("() => trap.game.drive.time > 0")
        assert state(page)["actions"][0] == ACTION_NAMES.index("brake straight")
        lowest = page.page.get_by_role("button", name="Pause").bounding_box()
        assert lowest["y"] + lowest["height"] <= 844  # the road, the pad and the clock are on the first screen
        assert not is_blank(page.page.screenshot(path=ARTEFACTS / "web-phone.png"))
        shade = page.page.evaluate("getComputedStyle(document.body).backgroundColor")
        assert sum(map(int, shade[4:-1].split(","))) < 380, "dark, as the reader's system is"


def test_the_end_of_a_drive_is_one_picture_and_one_sentence(visit):
    with visit("#road=10&ghost=sac&driver=escaping") as page:
        page.page.get_by_role("button", name="Start").click()
        drive_to_the_end(page)
        end = page.page.locator("#end")
        assert "Out after" in end.inner_text() and "gained" in end.inner_text()
        assert "plain SAC: still in the trap" in end.inner_text()
        assert end.locator("svg polyline").count() == 4  # two drivers in two plots
        assert page.page.evaluate("trap.game.root.activeElement.id") == "end"
        page.page.keyboard.press("r")
        assert not end.is_visible() and state(page)["actions"] == []


def test_a_ghost_that_is_at_the_wheel_too_is_not_reported_twice(visit):
    with visit("#road=7&ghost=soft&driver=soft&pace=5") as page:
        page.page.get_by_role("button", name="Start").click()
        drive_to_the_end(page)
        end = page.page.locator("#end")
        assert end.locator("svg polyline").count() == 2 and "ghost" not in end.inner_text()


def test_the_third_failure_brings_a_hint(visit):
    with visit() as page:
        for attempt in range(3):
            page.page.keyboard.press("ArrowRight")
            page.page.wait_for_function("() => trap.game.running")
            drive_to_the_end(page)
            page.page.locator("#end").wait_for()  # after a look at the accident
            assert page.page.locator("#hint").is_visible() == (attempt == 2)
            page.page.get_by_role("button", name="The same road again").first.click()


def driven_by_the_hint(road: int, speed, gap, steer, wait, fast, apart) -> bool:
    """Drives as the third hint says, a decision a second: is the ego out at the end, without an accident?"""
    env, plan = TrapVectorEnv(1, autoreset_mode=AutoresetMode.DISABLED), None
    env.reset(seed=[road])
    brake, left, right, accelerate = map(
        ACTION_NAMES.index, ("brake straight", "keep left", "keep right", "accelerate straight")
    )
    for _ in range(DEFAULT.clock.decisions):
        ego, others = env.cars[0, 0], env.cars[0, 1:]
        ahead = others[(others[:, X] > ego[X]) & (abs(others[:, Y] - ego[Y]) < DEFAULT.road.lane_width / 2)]
        nearest = min(ahead, key=lambda car: car[X], default=None)
        if plan is None and env.cars[0, TRAP_2, X] - ego[X] >= gap:
            plan = [left] * steer + [IDLE] * wait + [right] * steer
        if plan:
            action = plan.pop(0)
        elif plan is None:
            action = brake if ego[SPEED] > speed + 0.5 else IDLE
        elif nearest is not None and nearest[X] - ego[X] < apart:
            action = brake if ego[SPEED] > nearest[SPEED] else IDLE
        else:
            action = accelerate if ego[SPEED] < fast - 0.5 else IDLE
        _, _, _, _, infos = env.step(np.array([action]))
        if infos["accident"][0]:
            return False
    return bool(env.cars[0, 0, X] > env.cars[0, TRAP_1, X])


@pytest.mark.parametrize("late", [0, 1])
def test_who_follows_the_third_hint_to_the_letter_or_a_second_late_gets_out_on_20_roads(page, late):
    way = page.page.evaluate("WAY_OUT")
    way |= {"wait": way["wait"] + late, "gap": way["gap"] + 3 * late}  # trap 2 draws ahead by 3 m in a second
    assert all(driven_by_the_hint(road, **way) for road in range(20))
    assert not driven_by_the_hint(0, **way | {"wait": 0})  # less steering does not: the hint matters


def test_xi_does_what_the_page_says_of_0_and_5_and_100(visit):
    with visit() as page:
        ends = page.page.evaluate(
            """strengths => strengths.map(xi => {
                trap.game.settings.xi = xi;
                const drives = Array.from({ length: 10 }, (_, seed) => (
                    new Drive(trap.game.road, seed).finish(trap.game.drivers.soft)));
                return { out: drives.filter(drive => drive.outAfter !== null && !drive.accident).length,
                    accidents: drives.filter(drive => drive.accident).length };
            })""",
            [0, 5, 100],
        )
        assert ends == [{"out": 0, "accidents": 0}, {"out": 0, "accidents": 10}, {"out": 10, "accidents": 0}]
        page.page.locator("#xi").fill("12")
        assert state(page)["ghostName"] == "soft"  # whoever moves the slider sees what it does
        assert "π" in page.page.locator("#thoughts").inner_text()


WRONG = {  # address -> what the sentence says
    "#road=minus": "“minus” is not a road: give a whole number from 0 to 999999999.",
    "#ghost=nobody-we-know": "“ghost” cannot be “nobody-we-know”, so it is rule: choose none, rule, sac,",
    "#driver=%3Cb%3Ex": "“driver” cannot be “<b>x”, so it is you: choose you, rule, sac,",
    "#pace=3": "“pace” cannot be “3”, so it is 1: choose 0, 1, 2 or 5.",
    "#futures=yes": "“futures” cannot be “yes”, so it is 0: choose 0 or 1.",
    "#view=side": "“view” cannot be “side”, so it is above: choose above or 3d.",
    "#raod=7": "The address has “raod”, which is unknown: it takes road, ghost,",
}


def test_each_wrong_part_of_an_address_is_answered_with_a_sentence(visit):
    with visit() as page:
        for address, sentence in WRONG.items():
            page.page.evaluate("address => { location.hash = address; }", address)
            page.page.wait_for_function(
                "words => ['message', 'live'].every(id => trap.find(id).textContent.startsWith(words))",
                arg=sentence,
            )
            assert state(page)["number"] == 10 and state(page)["ghostName"] == "rule"
    with visit("#road=7&ghost=ghost&view=side") as page:  # when the page opens, and all that is right is done
        words = page.page.locator("#message").inner_text()
        assert "“ghost” cannot be" in words and "“view” cannot be" in words and state(page)["number"] == 7


COLOURS = """() => {
    const gl = trap.game.scene.gl, { width, height } = gl.canvas, pixels = new Uint8Array(4 * width * height);
    trap.game.draw();
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    return new Set(new Uint32Array(pixels.buffer)).size;
}"""


def test_a_key_shows_the_road_in_3d_and_from_above_again_also_after_the_graphics_card_was_lost(visit):
    with visit("#road=10", width=390, height=844) as page:
        assert not page.page.locator("#scene").is_visible()
        page.page.keyboard.press("v")
        assert page.page.locator("#scene").is_visible() and "view=3d" in page.page.url
        assert page.page.get_by_role("button", name="In 3D", pressed=True).is_visible()
        page.page.evaluate("() => trap.game.scene.gl.getExtension('WEBGL_lose_context').loseContext()")
        page.page.wait_for_function("() => trap.find('message').textContent.startsWith('The graphics card gave up')")
        assert not page.page.locator("#scene").is_visible()
        page.page.keyboard.press("v")
        assert page.page.locator("#scene").is_visible() and page.page.evaluate(COLOURS) > 1000
        page.page.keyboard.press("ArrowUp")
        page.page.wait_for_function("() => trap.game.drive.time > 0")
        page.page.get_by_role("button", name="In 3D").click()
        assert not page.page.locator("#scene").is_visible() and "view" not in page.page.url
        assert page.errors == [] and len(page.requests) == 1


def test_without_webgl_a_sentence_says_so_and_the_road_is_drawn_from_above(visit):
    with visit() as page:
        page.page.evaluate(
            """() => {
                const real = HTMLCanvasElement.prototype.getContext;
                HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
                    return kind === "webgl2" ? null : real.call(this, kind, ...more);
                };
            }"""
        )
        page.page.keyboard.press("v")
        assert "3D needs WebGL 2" in page.page.locator("#message").inner_text()
        assert not page.page.locator("#scene").is_visible()
        page.page.keyboard.press("ArrowDown")
        page.page.wait_for_function("() => trap.game.drive.time > 0")
        assert page.errors == []


def test_a_road_that_was_taken_out_of_its_page_hears_late_calls_in_silence(visit):
    with visit() as page:
        page.page.evaluate(
            """() => {
                const { game } = trap;
                game.close();
                for (const late of ["run", "announce", "setPace", "open", "offer", "again", "fit"]) game[late]({});
            }"""
        )
        page.page.wait_for_timeout(100)
        assert page.errors == []
