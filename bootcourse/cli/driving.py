"""`bootcourse evaluate`, `drive` and `replay`: who drives how well, one drive, and what it looked like."""

import contextlib
import time
import webbrowser
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import typer

from bootcourse.cli.own_files import scenario_at
from bootcourse.cli.places import ask_for
from bootcourse.errors import BootcourseError, did_you_mean

BUILT_IN = ("rule", "idle", "random")  # drivers that need no training
MEASURES = {
    "success": "success %",
    "returns": "return",
    "speed": "speed m/s",
    "distance": "distance m",
    "collision": "collision %",
    "road_departure": "road departure %",
    "stoppage": "stoppage %",
}
SCENARIO = typer.Option("", help="default, calibrated or FILE.py:NAME; by default the scenario that a run trained on.")
TEACHER = typer.Option("", help="The teacher that a run drives with: planner …, or FILE.py:FUNCTION.")
LEARNER = typer.Option("", help="The learner of your own that a run was trained with: FILE.py:CLASS.")
LOOK_AHEAD = typer.Option(0, min=0, help="Decisions to look ahead by rollouts, such as 10; 0: none.")
ACROSS = 4  # columns of `evaluate`'s table side by side in a terminal


def evaluate(
    who: str = typer.Argument(..., help="rule, idle, random, or a folder that `bootcourse train` wrote."),
    episodes: int = typer.Option(1000, min=1, help="Held-out episodes."),
    seed: int = typer.Option(1, min=0, help="The block of held-out roads."),
    scenario: str = SCENARIO,
    teacher: str = TEACHER,
    learner: str = LEARNER,
    lookahead: int = LOOK_AHEAD,
) -> None:
    """Drive held-out episodes and print success, return, speed, distance and accidents with 95 % intervals."""
    from bootcourse.cli.training import learner_from
    from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds, over_seeds, summarise
    from bootcourse.progress import progress_bar

    with learner_from(learner):
        seeds, drivers = held_out_seeds(seed, episodes), drivers_of(who, scenario, seed, teacher, lookahead)
        bar = progress_bar(drivers, shown=bool(lookahead), unit="driver")  # looking ahead takes a minute and more
        summaries = {each.label: summarise(drive_episodes(each.policy, seeds, each.road)) for each in bar}
    means = {name: over_seeds([summaries[label] for label in labels]) for name, labels in alike(drivers).items()}
    columns = {label: vars(each) for label, each in summaries.items()} | means
    ahead = f", looking {lookahead} decisions ahead" if lookahead else ""
    print(f"{episodes} held-out episodes, block {seed}{ahead}: value [95 % interval]; a mean is over training seeds")
    labels = list(columns)
    for first in range(0, len(labels), ACROSS):
        print_table({label: columns[label] for label in labels[first : first + ACROSS]})


class Driver(NamedTuple):
    """Who is evaluated, and on which roads."""

    label: str
    policy: Callable
    road: Any  # a Scenario
    settings: Any = None  # a trained agent's, without its seed


def alike(drivers: list[Driver]) -> dict[str, list[str]]:
    """{name of a mean: labels of the agents that differ in nothing but their training seed}, at least two of them."""
    groups: dict[tuple, list[Driver]] = {}
    for driver in drivers:
        if driver.settings is not None:
            groups.setdefault((driver.settings, driver.road), []).append(driver)
    several = [group for group in groups.values() if len(group) > 1]
    methods = [group[0].settings.method for group in several]
    return {  # where two groups have the same method, each is named after its first agent
        f"mean of {method if methods.count(method) == 1 else f'{group[0].label} ...'}": [each.label for each in group]
        for method, group in zip(methods, several, strict=True)
    }


def drivers_of(who: str, scenario: str, seed: int, teacher: str, horizon: int) -> list[Driver]:
    """A built-in driver, or the agent of each run in a folder; with a horizon above 0, each looks ahead as far.

    Raises BootcourseError for a name that is neither, for an agent that sees another number of cars, for one that
    drives with another teacher, and for a teacher with a built-in driver.
    """
    import numpy as np

    from bootcourse.episodes.lookahead import lookahead
    from bootcourse.policies import idle_policy, random_policy, rule_policy
    from bootcourse.scenario import DEFAULT

    if who in BUILT_IN:
        if teacher:
            raise BootcourseError(f"--teacher {teacher}: {', '.join(BUILT_IN)} drive without a teacher: leave it out.")
        road, rng = scenario_at(scenario) if scenario else DEFAULT, np.random.default_rng(seed)
        built_in = {"rule": rule_policy(road), "idle": idle_policy, "random": random_policy(rng)}
        drivers = [Driver(who, built_in[who], road)]
    elif not Path(who).exists():
        folder = "or give a folder that `bootcourse train` wrote"
        raise BootcourseError(f"Driver {did_you_mean(who, BUILT_IN)}, {folder}.")
    else:
        drivers = agents_in(Path(who), scenario, teacher, with_q=not horizon)
    if not horizon:
        return drivers
    return [driver._replace(policy=lookahead(driver.policy, horizon, driver.road)) for driver in drivers]


def agents_in(folder: Path, scenario: str, teacher: str, with_q: bool) -> list[Driver]:
    """The agent of each run in a folder."""
    from bootcourse.cli.training import teacher_from
    from bootcourse.learn.teachers import teacher_of
    from bootcourse.storage.runs import find_runs, load_run

    drivers, rule = [], teacher_from(teacher)
    for path in find_runs(folder):
        run = load_run(path, rule)
        road = scenario_at(scenario) if scenario else run.scenario
        if road.observation_size != run.scenario.observation_size:
            raise BootcourseError(
                f"{path} sees {run.scenario.observation_size} numbers, and {road.name} shows "
                f"{road.observation_size}: leave out --scenario."
            )
        agent = run.agent.taught_by(teacher_of(rule, road))
        drivers.append(Driver(path.name, agent.as_policy(with_q=with_q), road, replace(run.agent.settings, seed=0)))
    return drivers


def print_table(columns: dict[str, dict]) -> None:
    """Print a table of value [low, high]: one column for each driver, one row for each measure."""
    print("\n" + " " * 18 + "".join(f"{label:>26}" for label in columns))
    for name, heading in MEASURES.items():
        scale = 100 if "%" in heading else 1
        each = [tuple(scale * number for number in column[name]) for column in columns.values()]
        print(f"{heading:18}" + "".join(f"{f'{v:.1f} [{low:.1f}, {high:.1f}]':>26}" for v, low, high in each))


def drive(
    who: str = typer.Argument(..., help="rule, idle, random, or a run's folder."),
    out: Path = typer.Option(..., help="The rollout to write, such as drive.npz."),
    seed: int = typer.Option(0, min=0, help="The road."),
    scenario: str = SCENARIO,
    png: Path | None = typer.Option(None, help="Also draw the road from above to this picture."),
    teacher: str = TEACHER,
    learner: str = LEARNER,
    lookahead: int = LOOK_AHEAD,
) -> None:
    """Record one drive for figures and replays."""
    from bootcourse.cli.training import learner_from
    from bootcourse.episodes.record import record
    from bootcourse.files import check_replaceable

    if out.exists():
        raise BootcourseError(f"{out} exists already: choose another name.")
    for path, ending in ((png, ".png"), (out, ".npz")):
        if path is not None:
            check_replaceable(path, ending)
    ask_for(out, png)
    with learner_from(learner):
        drivers = drivers_of(who, scenario, seed, teacher, lookahead)
        if len(drivers) > 1:
            raise BootcourseError(f"{who} holds {len(drivers)} runs: name one, such as {Path(who) / drivers[0].label}.")
        label, policy, road, _ = drivers[0]
        label = label if label in BUILT_IN else label.rsplit("-", 1)[0]
        rollout = record(policy, [seed], road, label + (f", {lookahead} ahead" if lookahead else ""))[0]
    print(rollout.save(out))
    if png is not None:
        from bootcourse.plots.figure import save
        from bootcourse.plots.top_view import top_view_over_time

        print(save(top_view_over_time(rollout), png))


def replay(
    files: list[Path] = typer.Argument(..., help="Rollouts of `bootcourse drive`; several of one road are compared."),
    export: Path | None = typer.Option(None, help="Write one HTML file that plays anywhere, such as out.html."),
    gif: Path | None = typer.Option(None, help="Write an animation of the road from above, such as out.gif."),
    png: Path | None = typer.Option(None, help="Write one moment from above as a picture, such as out.png."),
    text: bool = typer.Option(False, "--text", help="Print each drive in words."),
    browser: bool = typer.Option(True, help="Open the browser, or print only the address."),
) -> None:
    """Show drives in 3D in the browser until Ctrl-C, or write them to a file, or print them in words."""
    from bootcourse.episodes.rollout import Rollout
    from bootcourse.files import check_replaceable

    for path, ending in ((export, ".html"), (gif, ".gif"), (png, ".png")):
        if path is not None:
            check_replaceable(path, ending)
    ask_for(export, gif, png)
    rollouts = [Rollout.load(file) for file in files]
    if not (export or gif or png or text):
        from bootcourse.replay3d import viewer

        with viewer.replay(rollouts) as shown, contextlib.suppress(KeyboardInterrupt):
            print(f"Replay at {shown.url} (Ctrl-C ends it)", flush=True)
            if browser:
                webbrowser.open(shown.url)
            while True:  # on Windows, Ctrl-C does not end a wait without a limit
                time.sleep(1)
        return
    from bootcourse.episodes.words import transcripts
    from bootcourse.plots.animation import animate, key_frame
    from bootcourse.plots.figure import save
    from bootcourse.replay3d import recorder

    def picture(drives, path):
        return save(key_frame(drives), path)

    for path, write in ((export, recorder.export), (gif, animate), (png, picture)):
        if path is not None:
            print(f"{write(rollouts, path)} ({path.stat().st_size / 1e6:.1f} MB)")
    if text:
        print(transcripts(rollouts))
