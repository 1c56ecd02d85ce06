"""Learn beside Drive: the page's buttons, sliders, curves and addresses, moved in Chromium."""

import json
from urllib.parse import parse_qs

import pytest
from scipy.stats import binomtest

import bootcourse as bc
from bootcourse.course.shipped import shipped_results
from bootcourse.research.report import ABLATION, ablation
from bootcourse.storage.assets import FOLDER
from tests.browser import ARTEFACTS, is_blank, needs_browser

pytestmark = needs_browser
FOUR = ("sac", "soft", "demos", "bootstrapped")


def learned(page, episodes: int) -> None:
    page.page.wait_for_function(f"() => trap.view.learners.every(each => each.episode >= {episodes})", timeout=60_000)


def text(page, place: str) -> str:
    return page.page.locator(place).inner_text()


def test_agents_learn_at_a_press_of_start_and_their_curves_grow(visit):
    with visit("#learn=soft&agents=2&drives=2000") as page:
        assert text(page, "#start") == "Start" and "random networks" in text(page, "#story")
        page.page.click("#start")
        assert text(page, "#start") == "Pause"
        learned(page, 60)
        page.page.wait_for_function(
            "() => document.querySelectorAll('#curves polyline').length >= 15"
        )  # 2 and their mean
        assert len(page.page.query_selector_all("#curves figure")) == 5
        assert "After " in text(page, "#story") or "got out on more than half" in text(page, "#story")
        page.page.wait_for_function("() => document.getElementById('moment-words').textContent.endsWith('drives, now')")
        page.page.wait_for_function("() => trap.view.watch?.drivers.present.label.startsWith('the agent after')")
        page.page.click("#start")
        assert text(page, "#start") == "Go on"
        page.page.wait_for_timeout(400)  # for the turns that had begun
        still = page.page.evaluate("trap.view.learners.map(each => each.episode)")
        page.page.wait_for_timeout(400)
        assert page.page.evaluate("trap.view.learners.map(each => each.episode)") == still
        ARTEFACTS.mkdir(exist_ok=True)
        assert not is_blank(page.page.screenshot(path=ARTEFACTS / "learn.png"))
        assert page.errors == []


def test_a_slider_acts_while_they_learn_and_leaves_a_mark(visit):
    with visit("#learn=bootstrapped&agents=2&drives=400") as page:
        page.page.click("#start")
        learned(page, 5)
        page.page.locator("#dial-xi").press("Home")
        page.page.wait_for_function("() => trap.view.learners.every(each => each.marks.length)")
        marks = page.page.evaluate("trap.view.learners.map(each => each.marks.map(({ changes }) => changes))")
        assert marks == [[{"xi_multiplier": 0}]] * 2
        page.page.wait_for_function("() => trap.view.learners.every(each => each.curves.xi.at(-1) === 0)")
        page.page.wait_for_function("() => document.querySelector('#curves svg').textContent.includes('ξ = 0 α')")


def test_a_click_on_a_curve_lets_the_agent_of_that_moment_drive_and_it_can_be_kept_as_a_ghost(visit):
    with visit("#learn=sac&agents=2&drives=60") as page:
        page.page.click("#start")
        learned(page, 60)
        box = page.page.locator("#curves figure").first.bounding_box()
        page.page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
        moment = page.page.evaluate("trap.view.moment")
        assert 20 <= moment <= 40
        driven = page.page.evaluate("trap.view.snapshot.episode")
        assert driven in page.page.evaluate("trap.view.pointed.agents.map(each => each.episode)")
        assert text(page, "#moment-words") == f"{driven} drives"
        page.page.click("#keep")
        assert page.page.evaluate("[trap.game.state.ghost, trap.game.state.driver]") == ["kept-1", "you"]
        assert page.page.locator("#learn").is_hidden() and "ghost=kept-1" in page.page.url
        page.page.keyboard.press("ArrowUp")
        page.page.wait_for_function("() => trap.game.drive.time > 0")
        assert page.page.evaluate("trap.game.ghosts[0].drive.time") > 0


def test_an_agent_is_saved_for_python_and_loaded_again(visit, tmp_path):
    with visit("#learn=soft&agents=2&drives=30&p=0.8") as page:
        page.page.click("#start")
        learned(page, 30)
        with page.page.expect_download() as saved:
            page.page.click("#save")
        path = tmp_path / saved.value.suggested_filename
        saved.value.save_as(path)
        run = bc.load_run(path)
        assert run.agent.settings.rule_p == 0.8 and len(run.curves["return"]) == 30
        page.page.set_input_files("#load", path)
        page.page.wait_for_function(
            "() => document.getElementById('story').textContent.includes('drives on the road now')"
        )
        assert page.page.evaluate("'loaded' in trap.game.drivers")
        page.page.set_input_files("#load", {"name": "x", "mimeType": "", "buffer": b"no agent at all"})
        page.page.wait_for_function("() => !document.getElementById('fault').hidden")
        assert "is not a file of safetensors" in text(page, "#fault")


ADDRESSES = {
    "#learn=ppo": "The address asks for the method “ppo”: it takes sac, soft,",
    "#learn=soft&speed=3": "The address has “speed”, which is unknown: it takes learn, agents,",
    "#learn=soft&agents=1": "agents = 1: give a whole number from 2 to 10.",
    "#learn=sac&xi=200": "xi_multiplier = 200, but method “sac” is defined by doing without.",
    "#learn=soft&gamma=2": "gamma = 2: give a finite number of 0 or more, at most 1.",
}


@pytest.mark.parametrize("address", ADDRESSES)
def test_what_an_address_asks_for_in_vain_is_said(visit, address):
    with visit(address) as page:
        assert text(page, "#fault").startswith(ADDRESSES[address])


def test_an_address_chooses_and_the_page_gives_it_back(visit):
    given = "#learn=margin_soft&agents=4&drives=250&seed=7&p=0.7&xiFixed=0.5&beta=0.3&eta=0.2&gamma=0.9"
    with visit(given) as page:
        chosen = page.page.evaluate("trap.view.chosen")
        assert chosen["method"] == "margin_soft" and chosen["episodes"] == 250 and chosen["seed"] == 7
        assert (chosen["p"], chosen["xiFixed"], chosen["beta"], chosen["eta"], chosen["gamma"]) == (
            0.7,
            0.5,
            0.3,
            0.2,
            0.9,
        )
        again = page.page.evaluate("trap.view.address")
        assert parse_qs(again[1:]) == parse_qs(given[1:])


def test_the_keys_that_drive_do_nothing_where_agents_learn(visit):
    with visit("#learn=sac") as page:
        page.page.keyboard.press("ArrowUp")
        page.page.keyboard.press("Space")
        page.page.wait_for_timeout(200)
        assert page.page.evaluate("trap.game.drive.time") == 0 and not page.page.evaluate("trap.game.running")


def test_the_ablation_trains_and_tests_twelve_agents_beside_our_numbers_and_the_papers(visit):
    with visit("#learn=bootstrapped") as page:
        page.page.evaluate("runAblation(trap.view, 12)")
        done = "() => document.getElementById('ablation-words').textContent.startsWith('Done')"
        page.page.wait_for_function(done, timeout=120_000)
        rows = page.page.evaluate(
            "[...document.querySelectorAll('#table tbody tr')].map(row => row.innerText.split(/[\\t\\n]+/))"
        )
        assert [row[0] for row in rows] == [
            "plain SAC",
            "the soft constraint",
            "demonstrations",
            "both aids",
        ]
        assert all(row[1] == "0 of 3" and row[2] == "0 to 71 %" for row in rows)  # 12 drives teach nobody
        results = shipped_results()
        for row, method in zip(rows, FOUR, strict=True):
            assert f"{results.escapers(method)} of 10" in row
        assert page.errors == []


def test_the_pages_numbers_are_those_of_the_shipped_study():
    assert json.loads((FOLDER / "report" / ABLATION).read_text(encoding="utf-8")) == ablation(shipped_results())


@pytest.mark.parametrize(("k", "n"), [(0, 3), (1, 3), (3, 3), (7, 10), (0, 10)])
def test_the_pages_interval_is_clopper_and_pearsons(visit, k, n):
    with visit("#learn=sac") as page:
        there = page.page.evaluate("([k, n]) => exactInterval(k, n)", [k, n])
    assert there == pytest.approx([*binomtest(k, n).proportion_ci()], abs=1e-6)


OUT = "got out on more than half of 50 drives"
STORIES = {  # what the agents' drives were, 1 for out of the trap -> how the sentence begins
    ((0,) * 30, (0,) * 30): "Their first drives",
    ((0,) * 100, (0,) * 100): f"After 100 drives none of two agents has {OUT} yet. They stay",
    (
        (0,) * 100,
        (0,) * 80 + (1,) * 20,
    ): f"After 100 drives none of two agents has {OUT} yet. In their last 50 they got out 0 and 20 times.",
    ((0,) * 100, (0,) * 60 + (1,) * 40): f"One of two agents has {OUT}, after 86 drives. It got out on 40",
    (
        (1,) * 300,
        (1,) * 300,
    ): f"Both agents have {OUT}, the first after 50 drives. They got out on 50 and 50 of the last 50.",
    # what failed before an agent found the way out does not say that it has lost it
    (
        (0,) * 150 + (1,) * 31,
        (0,) * 150 + (1,) * 37,
    ): f"Both agents have {OUT}, the first after 176 drives. They got out on 31 and 37",
    (
        (0,) * 100 + (1,) * 26 + (0,) * 49,
        (0,) * 175,
    ): f"One of two agents has {OUT}, after 126 drives. It got out on 1 of",
    (
        (0,) * 100 + (1,) * 26 + (0,) * 50,
        (0,) * 176,
    ): f"One of two agents has {OUT}, after 126 drives. It no longer does: 0",
    (
        (1,) * 200 + (0,) * 100,
        (1,) * 300,
    ): f"Both agents have {OUT}, the first after 50 drives. One of these got out on 50 of "
    "the last 50. One of these no longer does: 0 of the last 50.",
}


@pytest.mark.parametrize("drives", STORIES, ids=range(len(STORIES)))
def test_the_sentence_under_the_curves_says_what_happened(visit, drives):
    with visit("#learn=sac") as page:
        story = page.page.evaluate(
            "drives => storyOf(drives.map(success => ({ curves: { success }, settings: {}, progress: {} })))", drives
        )
    assert story.startswith(STORIES[drives])
