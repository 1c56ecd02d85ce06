"""Does a teacher help learners that we did not write? PPO and DQN of Stable-Baselines3, with the rule and without.

PPO alone and after cloning the rule; DQN alone, with the rule's drives in its replay buffer, and with c on their
reward. Beside each stand agents of ours. With the rule and without, they make the same number of `DECISIONS`, on the
compiled road. For the learners of Stable-Baselines3 a search of `TRIES` went before, on other seeds and roads with half
the decisions. Ours have the settings that were the best of three in `beyond-search`.
"""

import time
from collections.abc import Mapping
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import torch

from bootcourse.episodes.evaluate import Episodes, drive_episodes, held_out_seeds
from bootcourse.learn.demonstrations import collect
from bootcourse.learn.settings import with_seeds
from bootcourse.learn.training import FIRST_SEED
from bootcourse.methods import display_name
from bootcourse.research import equal_decisions
from bootcourse.research.cells import TESTS, results_of, smaller
from bootcourse.research.experiment import Computed, Experiment
from bootcourse.research.jobs import HELD_OUT, Interrupted, orphaned
from bootcourse.research.results import Results
from bootcourse.research.tables import bracketed, escaped, markdown
from bootcourse.statistics import interval

DECISIONS = {"PPO": 60_000, "DQN": 20_000}  # of an agent, beside those of the rule in its 200 demonstrations
KINDS = {  # {cell: (the class in Stable-Baselines3, what it gets of the rule)}
    "PPO alone": ("PPO", "nothing"),
    "PPO after cloning": ("PPO", "clone"),
    "DQN alone": ("DQN", "nothing"),
    "DQN with demonstrations": ("DQN", "demonstrations"),
    "DQN with demonstrations and c": ("DQN", "bonus"),
}
OURS = {"ppo": "PPO", "ppo_cloned": "PPO", "sac": "DQN", "bootstrapped": "DQN"}  # {method: whose decisions it makes}
C = 0.5  # as in `beyond`: at γ = 0.97 the paper's 2 would be worth more than any drive
TRIES = [{"gamma": gamma, "learning_rate": rate} for gamma, rate in ((0.9, 1e-3), (0.97, 1e-3), (0.97, 3e-4))]
SEARCH_SEED, SEARCH_ROADS = 500, equal_decisions.SEARCH_ROADS
NETWORK = {"net_arch": [64, 64]}
FIXED = {  # (roads, settings) of each class; all else is the library's default
    "PPO": (32, {"n_steps": 64, "batch_size": 128}),
    "DQN": (
        8,
        {
            "learning_starts": 1_000,
            "batch_size": 64,
            "gradient_steps": 8,  # after four decisions on each of eight roads
            "target_update_interval": 1_000,
            "buffer_size": 200_000,
            "exploration_fraction": 0.2,
        },
    ),
}


def cells(seeds: int = 10, tests: int = TESTS) -> dict[str, dict]:
    """A learner each, and one cell for each of ours."""
    learners = {kind: (kind, name) for kind, (name, _) in KINDS.items()}
    learners |= {f"ours, {method}": (method, name) for method, name in OURS.items()}
    return {
        cell: {"learner": learner, "decisions": DECISIONS[name], "seeds": seeds, "tests": tests}
        for cell, (learner, name) in learners.items()
    }


def compared(learner: str, decisions: int, seeds: int, tests: int) -> Results:
    """Train agents, after the search if they are not ours, and test them by their most probable actions.

    Measured, (agents,): search_0, search_1 ..., the return of each of `TRIES`, the same for all agents. Raises
    Interrupted.
    """
    roads = held_out_seeds(HELD_OUT, tests)
    if learner not in KINDS:
        settings = equal_decisions.tries(learner)[equal_decisions.CHOSEN[learner]]
        return equal_decisions.trained_and_tested(with_seeds(settings, seeds), [decisions], roads)
    searched = [tested(trained(learner, SEARCH_SEED, decisions // 2, **one), SEARCH_ROADS) for one in TRIES]
    earned = [episodes.returns.mean() for episodes in searched]
    chosen, started = TRIES[int(np.argmax(earned))], time.process_time()
    each = [tested(trained(learner, seed, decisions, **chosen), roads) for seed in range(seeds)]
    seconds = (time.process_time() - started) / seeds
    return Results(
        [{"method": learner, "seed": seed, "teacher": KINDS[learner][1], **chosen} for seed in range(seeds)],
        np.full(seeds, -1),
        {name: smaller(np.stack([getattr(one, name) for one in each])) for name in vars(each[0])},
        seconds=np.full(seeds, seconds),
        measured={f"search_{i}": np.full(seeds, value) for i, value in enumerate(earned)},
    )


def trained(kind: str, seed: int, decisions: int, **changes):
    """A trained model of Stable-Baselines3. changes: of its settings. Raises Interrupted."""
    import stable_baselines3

    from bootcourse.others.stable_baselines3 import TrapVecEnv, add_demonstrations, clone

    name, teacher = KINDS[kind]
    roads, settings = FIXED[name]
    env, learner = TrapVecEnv(roads), getattr(stable_baselines3, name)
    model = learner("MlpPolicy", env, policy_kwargs=NETWORK, seed=seed, device="cpu", **settings, **changes)
    env.seed(FIRST_SEED + 1000 * seed)  # the model seeds it with its own seed
    if teacher == "clone":
        clone(model, demonstrations(), seed=seed)
    elif teacher != "nothing":
        add_demonstrations(model.replay_buffer, demonstrations(), C * (teacher == "bonus"))
    model.learn(decisions, callback=lambda *_: not orphaned())
    if model.num_timesteps < decisions:
        raise Interrupted(kind)
    return model


@cache
def demonstrations() -> torch.Tensor:
    """200 drives of the rule."""
    return collect(200)


def tested(model, roads) -> Episodes:
    """Its drives on these roads."""
    from bootcourse.others.stable_baselines3 import as_policy

    return drive_episodes(as_policy(model), roads)


def obstacle(arguments: Mapping) -> str:
    """Stable-Baselines3 has to be installed."""
    if arguments["learner"] not in KINDS or find_spec("stable_baselines3"):
        return ""
    return "The learners of Stable-Baselines3 are left out: it is not installed. `pip install bootcourse[others]`."


def section(computed: dict[str, Computed], folder: Path) -> list[str]:
    """What theirs and ours reached."""
    return [
        "## Learners that we did not write\n",
        SECTION,
        markdown(*rows(computed["others"])),
        reading(computed["others"]),
    ]


def reading(computed: Computed) -> str:
    """What the table says about the teacher: the agents that escape without it and with it."""
    escape = {cell: f"{results.escapers(results.methods[0])} of {len(results)}" for cell, results in computed.items()}
    crash = {cell: 100 * results.episodes("accident").mean() for cell, results in computed.items()}
    return (
        f"Theirs agree with ours on the teacher: of PPO's agents {escape['PPO alone']} escape alone and "
        f"{escape['PPO after cloning']} after cloning; of DQN's {escape['DQN alone']} alone, "
        f"{escape['DQN with demonstrations']} with the rule's drives in the buffer, and "
        f"{escape['DQN with demonstrations and c']} with c on their rewards. DQN's agents get out and crash: even "
        f"with c {crash['DQN with demonstrations and c']:.0f} % of their drives end in an accident. "
        f"{DECISIONS['DQN']:,} decisions are few, and one seed decided each search.\n"
    )


def rows(computed: Computed) -> tuple[list[str], list[list[str]]]:
    """(headings, rows): the agents that escape, the return and the accidents of each learner."""
    headings = ["learner", "agents that escape", "return [95 %]", "accidents, %", "γ, learning rate", "of the search"]
    lines = []
    for results in computed.values():
        (learner,), first = results.methods, results.agents[0]
        returns, accidents = bracketed(interval(results.scores("returns"))), 100 * results.episodes("accident").mean()
        search = [f"{values[0]:.0f}" for name, values in sorted(results.measured.items()) if name.startswith("search")]
        rate = first.get("learning_rate", first.get("actor_lr"))
        name = learner if learner in KINDS else f"ours: {display_name(learner)}"
        lines.append([name, escaped(results, learner), returns, f"{accidents:.1f}",
                      f"{first['gamma']:g}, {rate:g}", ", ".join(search) or "–"])  # fmt: skip
    return headings, lines


SECTION = f"""PPO and DQN of Stable-Baselines3 on the compiled road, with their library's update and its default
settings where the code names no other. Every agent of PPO, theirs and ours, makes {DECISIONS["PPO"]:,} decisions, every
other {DECISIONS["DQN"]:,}; the 200 drives of the rule that a clone or a buffer begins with are not counted. For each of
their learners three pairs of γ and learning rate were searched, with one other seed, half the decisions and 200 other
roads (the last column: their returns); the best has ten agents here, tested on 1,000 held-out roads by their most
probable actions. c = {C:g} is added to the rewards of the demonstrations. Ours have the settings that were the best of
three at 100,000 decisions.
"""

EXPERIMENT = Experiment("others", cells, results_of(compared), (), section, obstacle=obstacle)
