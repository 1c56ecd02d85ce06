"""The page that learns: the compiled update and training in Chromium, and the files that it saves."""

import base64
import json

import numpy as np
import pytest

import bootcourse as bc
from bootcourse.errors import BootcourseError
from bootcourse.learn import compiled, records
from bootcourse.learn.settings import Settings, settings_for
from bootcourse.web import build, learning
from tests.browser import needs_browser
from tests.test_learn_learner import batches

pytestmark = needs_browser

UPDATE = """given => {  // one update on records given as bytes; its time, and the records' bytes after it
    const memory = new WebAssembly.Memory({ initial: 32 }), { free } = trap.data.scenario;
    const code = new WebAssembly.Instance(trap.compiled, importsOf(memory, free)).exports;
    let end = free;
    const places = given.map(text => {
        const bytes = Uint8Array.from(atob(text), letter => letter.charCodeAt(0)), place = end;
        new Uint8Array(memory.buffer, place).set(bytes);
        end += Math.ceil(bytes.length / 16) * 16;
        return [place, bytes.length];
    });
    const update = () => code.update(end, end + 16, ...places.map(([place]) => place));
    const status = update();
    const bytes = places.map(([place, size]) => Array.from(new Uint8Array(memory.buffer, place, size)));
    let ms = Infinity; // the best of many short turns, so that other programs do not count
    for (let turn = 0; turn < 40; turn++) {
        const time = performance.now();
        for (let i = 0; i < 10; i++) update();
        ms = Math.min(ms, (performance.now() - time) / 10);
    }
    return { status, ms, after: bytes.map(each => btoa(each.map(byte => String.fromCharCode(byte)).join(""))) };
}"""


@pytest.fixture(scope="module")
def page(visit):
    with visit() as page:
        yield page


def learn(page, **settings):
    return page.page.evaluate("settings => trap.learn(settings)", settings)


def close(ours, theirs):
    """Within 1e-4 of the largest. (Two browsers' exponentials differ in the last digit.)"""
    return np.abs(ours - theirs).max() <= 1e-4 * np.abs(theirs).max()


@pytest.mark.parametrize("method", ["bootstrapped", "margin_soft"])
def test_an_update_in_the_page_is_the_one_of_python(page, method):
    settings, batch = settings_for(method), np.zeros(1, records.BATCHES)
    records.fill(batch, batches([settings])[0])
    agent, work = records.first_agents([settings]), np.zeros(1, records.WORK)
    given = [agent, batch, records.coefficients(settings), work]
    there = page.page.evaluate(UPDATE, [base64.b64encode(each.tobytes()).decode() for each in given])
    compiled.update_all(*given)
    after = [bytearray(base64.b64decode(text)) for text in there["after"]]
    decoded = [np.frombuffer(data, each.dtype) for data, each in zip(after, given, strict=True)]
    assert there["status"] == 0
    print(f"\n{there['ms']:.2f} ms an update in Chromium")
    for name in ("actor_slopes", "critic_1_slopes", "critic_2_slopes"):
        for ours, theirs in zip(*(records.parameters(each[name]) for each in (decoded[3], work)), strict=True):
            assert theirs.abs().max() > 0 and close(ours.numpy(), theirs.numpy())
    for name in records.LOSSES:
        assert decoded[3][name] == pytest.approx(work[name], rel=1e-5)
    for name in ("actor", "critic_1", "critic_2", "target_1", "target_2"):
        for ours, theirs in zip(*(records.parameters(each[name]) for each in (decoded[0], agent)), strict=True):
            assert (ours - theirs).abs().mean() < 1e-3 * settings.actor_lr  # a step is about as long as the rate
    assert decoded[0]["log_alpha"] == pytest.approx(agent["log_alpha"], abs=1e-6)


def test_a_bootstrapped_agent_learns_in_the_page_to_get_out_and_no_request_leaves_it(page):
    curves = learn(page, method="bootstrapped", seed=0, episodes=330)
    assert {len(values) for values in curves.values()} == {330}
    assert sum(curves["escaped"][:100]) < 50 and sum(curves["escaped"][-50:]) >= 40
    assert np.mean(curves["returns"][-50:]) > np.mean(curves["returns"][:100]) + 5
    assert np.allclose(curves["xi"], 200 * np.array(curves["alpha"])) and curves["alpha"][-1] < curves["alpha"][0]
    assert page.errors == []
    assert [address[:5] for address in page.requests] == ["file:", "blob:"]  # the worker is a part of the page


def test_the_same_seed_learns_the_same_and_sliders_act_while_it_learns(page):
    one, again, other = (learn(page, method="soft", episodes=12, seed=seed) for seed in (1, 1, 2))
    assert one == again and one["returns"] != other["returns"]
    changed = page.page.evaluate(
        """async () => {
            const learner = new Learner(trap, { method: "soft", episodes: 3000 });
            const when = test => new Promise(go => { learner.on.curves = () => test() && go(); });
            await when(() => learner.episode >= 8);
            learner.set({ xiFixed: 0.5, p: 0.7 });
            await when(() => learner.marks.length && learner.episode >= learner.marks[0].episode + 30);
            learner.stop();
            return { xi: learner.curves.xi, marks: learner.marks };
        }"""
    )
    (mark,) = changed["marks"]
    assert mark["changes"] == {"xi_fixed": 0.5, "rule_p": 0.7} and mark["episode"] >= 8
    assert min(changed["xi"][: mark["episode"]]) > 1 and changed["xi"][-1] == 0.5


def test_a_training_pauses_goes_on_gives_its_agent_and_stops(page):
    seen = page.page.evaluate(
        """async () => {
            const learner = new Learner(trap, { method: "sac", episodes: 3000 });
            const rest = ms => new Promise(go => setTimeout(go, ms));
            const grown = () => new Promise(go => {
                const before = learner.episode;
                learner.on.curves = () => learner.episode > before && go();
            });
            await grown();
            learner.pause();
            await rest(150);
            const paused = learner.episode;
            await rest(300);
            const still = learner.episode, { episode, layers } = await learner.agent();
            learner.go();
            await grown();
            learner.stop();
            const stopped = learner.episode, refused = await learner.agent().catch(error => error.message);
            await rest(200);
            const shapes = layers.map(each => [each.inputs, each.outputs, each.weights.length]);
            return { paused, still, episode, shapes, stopped, later: learner.episode, refused,
                policy: softmax(forward(layers, new Float32Array(26))) };
        }"""
    )
    assert seen["paused"] == seen["still"] <= seen["episode"] < seen["stopped"] == seen["later"]
    assert seen["shapes"] == [[26, 64, 26 * 64], [64, 64, 64 * 64], [64, 9, 64 * 9]]
    assert sum(seen["policy"]) == pytest.approx(1) and max(seen["policy"]) < 1
    assert seen["refused"] == "This agent has stopped learning."


SAVE = """async settings => {
    const learner = new Learner(trap, settings);
    await learner.finished;
    learner.set({ p: 0.8 });
    const file = await learner.file(), again = readRun(trap.data.learning, file);
    const { layers } = await learner.agent(), second = new Learner(trap, settings, {}, again);
    second.pause();
    const seen = Float32Array.from({ length: 26 }, (_, i) => Math.sin(i)), begun = (await second.agent()).layers;
    return { file: btoa(Array.from(file, byte => String.fromCharCode(byte)).join("")), curves: learner.curves,
        read: again.curves, policies: [layers, again.layers, begun].map(each => softmax(forward(each, seen))) };
}"""


@pytest.fixture(scope="module")
def saved(page, tmp_path_factory):
    """What the page saved: (the file, the page's own numbers)."""
    there = page.page.evaluate(SAVE, {"method": "margin_soft", "seed": 5, "episodes": 30, "gamma": 0.9})
    path = tmp_path_factory.mktemp("saved") / "agent.safetensors"
    path.write_bytes(base64.b64decode(there["file"]))
    return path, there


def test_load_run_reads_what_the_page_saved_and_so_does_the_page(saved):
    path, there = saved
    run = bc.load_run(path)
    assert run.agent.settings == settings_for("margin_soft", seed=5, gamma=0.9) and len(run.agent.critics) == 6
    for name, values in there["curves"].items():
        np.testing.assert_array_equal(run.curves[name], values)
        assert there["read"][name] == values
    seen = np.sin(np.arange(26)).astype(np.float32)[None]
    np.testing.assert_allclose(there["policies"], np.repeat(run.agent.probabilities(seen), 3, 0), atol=1e-5)
    assert run.agent.alpha == pytest.approx(run.curves["alpha"][-1], rel=0.05)
    assert run.provenance["marks"] == [{"episode": 30, "changes": {"rule_p": 0.8}}] and run.provenance["seed"] == 5
    assert bc.record(run.agent.as_policy(with_q=True), [3])[0].q_values is not None


@pytest.mark.parametrize("place", [0, 30, 400, -300_000, -1])
def test_a_damaged_file_of_the_page_is_answered_with_a_sentence(saved, place, tmp_path):
    whole = saved[0].read_bytes()
    cut = tmp_path / "agent.safetensors"
    cut.write_bytes(whole[:place] if place < 400 else whole[:place] + b"\0" * 40 + whole[place + 40 :])
    with pytest.raises(BootcourseError, match="save it from the page again"):
        bc.load_run(cut)


def test_another_file_of_safetensors_is_answered_with_a_sentence(tmp_path):
    other = tmp_path / "weights.safetensors"
    other.write_bytes((build.AGENTS["sac"] / "weights.safetensors").read_bytes())
    with pytest.raises(BootcourseError, match="is no agent of the page that learns"):
        bc.load_run(other)


WRONG = {  # what is asked for -> what is said
    '{"method": "ppo"}': "“ppo” is not a method of this page: choose sac, soft, demos, bootstrapped, margin",
    '{"p": 1}': "p = 1: give a finite number of 0.111111 or more, at most 0.999999940395.",
    '{"method": "sac", "xi": 200}': "xi_multiplier = 200, but method “sac” is defined by doing without.",
    '{"gamma": "a"}': "gamma = a: give a finite number of 0 or more, at most 1.",
    '{"episodes": 0}': "episodes = 0: give a whole number from 1 to 5000.",
    '{"seed": 1.5}': "seed = 1.5: give a whole number of 0 or more, at most 8,000,000.",
    '{"roads": 5}': "roads = 5: give a whole number of 1 or more, at most 4.",
    '{"kl_in_target": 1}': "kl_in_target = 1: give true or false.",
    '{"hidden": 8}': "“hidden” is not a setting: choose p, xi,",
    '{"c": null}': "c = null: give a finite number.",
}


@pytest.mark.parametrize("asked", WRONG)
def test_a_wrong_setting_is_answered_with_a_sentence(page, asked):
    said = page.page.evaluate("asked => { try { trap.learn(asked); } catch (error) { return error.message; } }",
                              json.loads(asked))  # fmt: skip
    assert said.startswith(WRONG[asked])


def test_what_is_set_when_an_agent_begins_cannot_change_while_it_learns(page):
    said = page.page.evaluate(
        """() => {
            const learner = new Learner(trap, { episodes: 5 });
            let said = "";
            try { learner.set({ p: 0.5, roads: 2 }); } catch (error) { said = error.message; }
            learner.stop();
            return [said, learner.settings.rule_p];
        }"""
    )
    assert said == ["envs_per_agent is set when an agent begins: start another one.", 0.9]


def test_the_page_refuses_what_the_library_refuses():
    """The limits in the page are those of `Settings`: just inside is accepted there, just outside is not."""
    for name, limit in learning.limits().items():
        if limit["truth"]:
            continue
        step = 1 if limit["whole"] else 1e-6
        for side, away in (("low", -step), ("high", step), ("above", 0.0)):
            if limit[side] is not None and name not in learning.MOST:
                with pytest.raises(BootcourseError):
                    Settings(**{name: limit[side] + away})
                Settings(**{name: limit[side] + (step if side == "above" else 0)})
