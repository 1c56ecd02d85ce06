"""What stops the learner from being faster: `python -m tests.speed_report` measures and writes tests/SPEED.md.

The comparison, a profile of one update, the cost per agent as agents grow (with a figure), and the
memory that an agent takes. Needs d3rlpy, which `make bench` installs, and a quiet machine.
"""

import platform
import time
from itertools import pairwise
from pathlib import Path

import torch
from torch.profiler import ProfilerActivity, profile

from bootcourse.files import write_bytes
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.replay_buffer import ReplayBuffer
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.plots.figure import INK, TEXT, finish, new_figure, plain_axes, save
from bootcourse.research.tables import markdown
from bootcourse.scenario import DEFAULT, N_ACTIONS
from tests.bench_learn import AGENTS, growth, milliseconds, ours, table

HERE = Path(__file__).resolve().parent
KINDS = {  # what an operation's name begins with: what it does
    "aten::baddbmm": "matrix products", "aten::bmm": "matrix products", "aten::_fused_adam_": "Adam",
    "aten::_foreach_lerp_": "target networks", "aten::index_select": "drawing the batch",
}  # fmt: skip


def profiled(updates: int = 200) -> tuple[list[list[str]], float, int]:
    """(rows of a table: what, its share of the time, calls per update), ms per update, calls per update."""
    update = ours(AGENTS)
    for _ in range(50):
        update()
    with profile(activities=[ProfilerActivity.CPU]) as seen:
        for _ in range(updates):
            update()
    events = [event for event in seen.key_averages() if event.key.startswith("aten::")]
    shares, calls = {}, {}
    for event in events:
        kind = KINDS.get(event.key, "some fifty other small operations")
        shares[kind] = shares.get(kind, 0.0) + event.self_cpu_time_total
        calls[kind] = calls.get(kind, 0) + event.count
    started = time.thread_time()
    for _ in range(updates):
        update()
    spent = 1000 * (time.thread_time() - started) / updates
    whole = sum(shares.values())
    order = sorted(shares, key=shares.get, reverse=True)
    rows = [[kind, f"{100 * shares[kind] / whole:.0f} %", f"{calls[kind] / updates:.0f}"] for kind in order]
    return rows, spent, round(sum(calls.values()) / updates)


def products_alone(calls: int = 200) -> float:
    """ms per agent-update of the matrix products alone: the same shapes, into memory that is there already."""
    settings = settings_for("bootstrapped")
    sizes = (DEFAULT.observation_size, *settings.hidden, N_ACTIONS)
    jobs = []
    for networks, learns in ((AGENTS, True), (AGENTS, False), (2 * AGENTS, True), (2 * AGENTS, False)):
        for layer, (n_in, n_out) in enumerate(pairwise(sizes)):
            x, w = torch.rand(networks, settings.batch, n_in), torch.rand(networks, n_in, n_out)
            y = torch.rand(networks, settings.batch, n_out)
            jobs.append((x, w, torch.empty_like(y)))
            if learns:  # the gradients of the weights, and of what came in from the layer before
                jobs.append((x.mT, y, torch.empty_like(w)))
            if learns and layer:
                jobs.append((y, w.mT, torch.empty_like(x)))

    def every_product():
        for a, b, out in jobs:
            torch.bmm(a, b, out=out)

    return milliseconds({"products": every_product}, turns=10, calls=calls // 10)["products"] / AGENTS


def share_of_the_update(decisions: int = 300) -> float:
    """How much of a training's time is spent in updates, 0..1."""
    training = Training(with_seeds(settings_for("bootstrapped"), AGENTS), 1000)
    for _ in range(100):
        training.step()
    inside, update = [0.0], training.update

    def timed():
        started = time.thread_time()
        update()
        inside[0] += time.thread_time() - started

    training.update = timed
    started = time.thread_time()
    for _ in range(decisions):
        training.step()
    return inside[0] / (time.thread_time() - started)


def memory() -> tuple[float, float]:
    """(networks, their targets and Adam's two moments; what is remembered), MB for each agent."""
    settings = with_seeds(settings_for("bootstrapped"), AGENTS)
    learner = SACLearner(settings, DEFAULT.observation_size)
    weights = sum(parameter.nbytes for parameter in (*learner.actor, *learner.critics))
    targets = sum(parameter.nbytes for parameter in learner.target_critics)
    replay = ReplayBuffer(AGENTS, settings[0].buffer_size, DEFAULT.observation_size)
    return (3 * weights + targets) / AGENTS / 1e6, replay.table.nbytes / AGENTS / 1e6


def growth_figure(agents: list[int], each: list[float], alone: float):
    """Cost of an update for each agent, ms, against the number of agents; `alone` is the plain loop's."""
    figure = new_figure(3.4)
    ax = figure.add_axes((0.08, 0.16, 0.86, 0.6))
    ax.plot(agents, each, "o-", color=INK, linewidth=2)
    ax.axhline(alone, color=INK, linestyle="--", linewidth=1)
    ax.annotate("one agent in a plain eager loop", (agents[-1], alone), xytext=(0, 5), textcoords="offset points",
                fontsize=TEXT, color=INK, ha="right")  # fmt: skip
    for n, value in zip(agents, each, strict=True):
        ax.annotate(f"{value:.2f}", (n, value), xytext=(0, 7), textcoords="offset points", fontsize=TEXT, ha="center")
    plain_axes(ax, "time of one update, for each agent (ms)")
    ax.set_xscale("log", base=2)
    ax.set_xticks(agents, [str(n) for n in agents])
    ax.set_xlabel("agents that train side by side", fontsize=TEXT, color=INK)
    ax.set_ylim(0, 1.15 * max(alone, *each))
    listed = ", ".join(f"{n}: {value:.2f} ms" for n, value in zip(agents, each, strict=True))
    return finish(
        figure, "Side by side, an agent costs a fraction of what it costs alone", f"For each agent, {listed}."
    )


def main() -> None:
    torch.set_num_threads(1)
    compared = [row for row in table() if "grow" not in row.name]
    counts = (1, 2, 4, 8, 16, 32, 64)
    each = [row.value for row in growth(counts)]
    alone = next(row.value for row in compared if "plain" in row.name)
    save(growth_figure(list(counts), each, alone), HERE / "speed.png")
    kinds, spent, calls = profiled()
    networks, remembered = memory()
    floor = products_alone()
    rows = [[row.name, f"{row.value:.3f}", "" if row.ratio is None else f"{row.ratio:.1f} x"] for row in compared]
    text = TEXT_OF_THE_REPORT.format(
        machine=f"{platform.machine()}, Python {platform.python_version()}, torch {torch.__version__}",
        comparison=markdown(["", "ms per agent-update", "ours is faster by"], rows),
        profile=markdown(["what", "share", "calls per update"], kinds),
        spent=f"{spent:.1f}", calls=calls, agents=AGENTS, networks=f"{networks:.2f}", remembered=f"{remembered:.1f}",
        floor=f"{floor:.2f}", most=f"{alone / floor:.0f}", share=f"{100 * share_of_the_update():.0f}",
        growth=", ".join(f"{n}: {value:.2f} ms" for n, value in zip(counts, each, strict=True)),
    )  # fmt: skip
    write_bytes(HERE / "SPEED.md", text.encode())
    print(text)


TEXT_OF_THE_REPORT = """# How fast the learner is, and what stops it

Made by `python -m tests.speed_report` on one thread ({machine}).

{comparison}
One update of {agents} agents takes {spent} ms and makes {calls} calls of torch. Where the time goes:

{profile}
- **The matrix products** alone, with the same shapes and nothing around them, take {floor} ms per agent-update: even
  a learner without any other cost would be {most} x faster than the plain loop, and no more. They are small
  (batches of 64 through layers of 64), and there is no way around them.
- **The calls.** Each of the others costs a few microseconds before it computes anything, however many agents
  there are. This is what the agents' axis shares out, and why one agent alone gains little.
- Adam, as one fused call for all parameters, and the target networks cost next to nothing.

What is left to gain lies in the small calls. Joining them needs a compiler at run time or our own code in C; either
would cost the reader the equations, so neither is here. In a training, updates take {share} % of the time.

![{growth}](speed.png)

An agent takes {networks} MB for its networks, their targets and Adam's two moments, and {remembered} MB for the 50,000
transitions that it remembers.
"""

if __name__ == "__main__":
    main()
