"""Five visits to the page that learns: a child, a phone, somebody with a keyboard alone, a lecturer and a sceptic."""

import pytest

from tests.browser import ARTEFACTS, is_blank, needs_browser

pytestmark = needs_browser


def driven(page, episodes: int) -> None:
    page.page.wait_for_function(f"() => trap.view.learners.every(each => each.episode >= {episodes})", timeout=60_000)


def focused(page) -> str:
    return page.page.evaluate("document.activeElement.id")


def test_a_child_presses_learn_and_start_and_drives_against_what_it_made(visit):
    with visit() as page:
        page.page.get_by_role("button", name="Learn").click()
        page.page.locator("#drives").fill("60")
        page.page.get_by_role("button", name="Start").last.click()
        driven(page, 60)
        words = page.page.locator("#story").inner_text()
        assert "α" not in words and "nats" not in words and "drives" in words
        page.page.get_by_role("button", name="Drive against it").click()
        page.page.keyboard.press("ArrowDown")
        page.page.wait_for_function("() => trap.game.drive.time > 0")
        assert page.page.evaluate("trap.game.rivals[0].words").startswith("It learned in this page")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_on_a_phone_nothing_is_too_wide_and_a_hidden_page_rests(visit, scheme):
    with visit("#learn=soft&agents=2&drives=3000", width=390, height=800, color_scheme=scheme) as page:
        page.page.click("#start")
        driven(page, 5)
        assert page.page.evaluate("document.documentElement.scrollWidth") <= 390
        ARTEFACTS.mkdir(exist_ok=True)
        assert not is_blank(page.page.screenshot(path=ARTEFACTS / f"learn-phone-{scheme}.png", full_page=True))
        hide = "Object.defineProperty(document, 'hidden', { value: %s, configurable: true });"
        told = "document.dispatchEvent(new Event('visibilitychange'))"
        page.page.evaluate(hide % "true" + told)
        assert page.page.evaluate("trap.view.learners.every(each => each.state === 'paused')")
        page.page.evaluate(hide % "false" + told)
        assert page.page.evaluate("trap.view.busy")


def test_the_keyboard_alone_starts_slides_and_goes_back_to_an_earlier_agent(visit):
    with visit("#learn=sac&agents=2&drives=80") as page:
        page.page.focus("#to-learn")
        reached = []
        while focused(page) != "start":
            page.page.keyboard.press("Tab")
            reached.append(focused(page))
            assert len(reached) < 40, reached
        assert {"method", "agents", "drives", "seed", "dial-gamma"} <= set(reached)
        page.page.keyboard.press("Enter")
        driven(page, 80)
        page.page.focus("#moment")
        page.page.keyboard.press("Home")
        assert page.page.evaluate("trap.view.moment") == 0
        assert page.page.locator("#moment-words").inner_text().endswith("drives")


def test_a_lecturer_shows_ten_agents_large_and_what_one_was_before(visit):
    with visit("#learn=soft&agents=10&drives=40", width=1920, height=1080) as page:
        page.page.click("#start")
        driven(page, 40)
        page.page.wait_for_function(
            "() => document.querySelectorAll('#curves polyline').length === 55"
        )  # 5 x (10 + mean)
        assert page.page.locator("#which option").count() == 10
        page.page.select_option("#which", "7")
        assert page.page.evaluate("trap.view.learners.indexOf(trap.view.pointed)") == 7
        assert page.page.evaluate("document.documentElement.scrollWidth") <= 1920


def test_a_sceptic_finds_no_recording(visit):
    with visit("#learn=sac&agents=2&drives=150&seed=3") as page:
        curves = []
        for gamma in ("0.8", "0.8", "0.5"):
            page.page.evaluate(f"trap.view.choose({{ method: 'sac', gamma: {gamma} }})")
            page.page.click("#start")
            page.page.wait_for_function("() => trap.view.learners[0]?.state === 'done'", timeout=60_000)
            page.page.wait_for_function("() => !trap.view.busy", timeout=60_000)
            curves.append(page.page.evaluate("trap.view.learners.map(each => each.curves.return)"))
        assert curves[0] == curves[1] != curves[2] and curves[0][0] != curves[0][1]
        before, after = page.page.evaluate("trap.view.learners[0].agents.map(each => [...each.layers[0].weights])")[
            ::1
        ][:2]
        assert before != after
        assert {address[:5] for address in page.requests} == {"file:", "blob:"}
