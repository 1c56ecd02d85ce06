"""`bootcourse train`: agents of one method, side by side, with a checkpoint now and then.

    DIR/unfinished/checkpoint.npz   while they train
    DIR/unfinished/saving           while their runs are written
    DIR/unfinished/complete         when all are written, until each is moved to
    DIR/METHOD-SEED

A training that is stopped by Ctrl-C (exit status 130) or killed goes on with --resume.
"""

import ast
import os
import shlex
import shutil
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from pkgutil import resolve_name

import typer

from bootcourse.cli.own_files import loaded, scenario_at
from bootcourse.cli.places import ask_for
from bootcourse.errors import BootcourseError, check_known, did_you_mean
from bootcourse.methods import METHODS, Method, method_of, own_method
from bootcourse.rooms import added

INTERRUPTED = 130  # exit status
UNFINISHED, CHECKPOINT, SAVING, COMPLETE = "unfinished", "checkpoint.npz", "saving", "complete"  # see above
SECONDS_BETWEEN = 20.0  # of checkpoints
# Fixed by the start of a training:
BEGINNING = ("method", "seeds", "first_seed", "episodes", "scenario", "setting", "p", "xi", "c", "change")


def train(
    context: typer.Context,
    method: str = typer.Option("bootstrapped", help=", ".join(METHODS) + "."),
    seeds: int = typer.Option(4, min=1, max=64, help="How many agents, side by side, each with its own seed."),
    first_seed: int = typer.Option(0, min=0, help="The first training seed."),
    episodes: int = typer.Option(0, min=0, help="Training episodes of each agent; 0: the method's own number."),
    out: Path = typer.Option(..., help="A new folder for the runs."),
    scenario: str = typer.Option("default", help="default, calibrated, or one of your own, FILE.py:NAME."),
    setting: str = typer.Option("quick", help="quick or paper: a quarter of an update per decision, or two."),
    teacher: str = typer.Option(
        "",
        help="Who teaches: random-50, random-25, mirrored, timid, late, rule, rule-rollouts or planner, or a rule of "
        "your own: FILE.py:FUNCTION.",
    ),
    learner: str = typer.Option(
        "",
        help="compiled, which is faster for one agent; or a learner of your own, FILE.py:CLASS, which starts from the "
        "method's settings.",
    ),
    p: float | None = typer.Option(None, help="Probability of the rule's action in the stochastic rule."),
    xi: float | None = typer.Option(None, help="Strength of the soft constraint: ξ = XI times α."),
    c: float | None = typer.Option(None, help="Bonus on a demonstration's reward."),
    change: list[str] = typer.Option([], help="Another setting, NAME=VALUE, such as tau=0.01; give it several times."),
    device: str = typer.Option("cpu", help="Where the networks learn: cpu, or cuda if torch finds a GPU."),
    resume: bool = typer.Option(False, "--resume", help="Resume a training that was interrupted or killed."),
    quiet: bool = typer.Option(False, "--quiet", help="No progress bar."),
) -> None:
    """Train agents and write a run of each."""
    from bootcourse.learn.settings import settings_for, with_seeds
    from bootcourse.storage.work import locked

    check_known("Method", method, METHODS)
    compiled = learner == "compiled"
    with learner_from("" if compiled else learner, METHODS[method]) as own:
        method = own or method
        given = {"rule_p": p, "xi_multiplier": xi, "bonus": c}
        changes = changes_of(change) | {name: value for name, value in given.items() if value is not None}
        settings = with_seeds(settings_for(method, setting, **changes), seeds, first_seed)
        asked = settings, episodes or METHODS[method].episodes, scenario_at(scenario)
        rule = teacher_from(teacher)
        if resume and not is_unfinished(out) and any(out.glob("*/provenance.json")):
            with locked(out / UNFINISHED, "training"):  # removes what a training left that was killed at its very end
                print(f"{out} is finished: there is nothing to resume.")
            return
        check_folder(out, resume)
        ask_for(out)
        make = {"device": device, "learner": "compiled" if compiled else "torch"}
        training = None if resume else begun(asked, rule, make, quiet)
        with locked(out / UNFINISHED, "training"):
            check_folder(out, resume)  # another training may have ended before this one had the lock
            training = resumed(out, rule, device) if resume else kept(training, out)
            if resume and training is not None:
                check_resumed(training, asked, given_options(context))
                if compiled and training.learner_name != "compiled":
                    raise BootcourseError("--learner compiled: this training began without it; leave it out to go on.")
            status = finish_training(training, out, progress=not quiet)
    if status == INTERRUPTED:
        print(f"Interrupted. To continue, run `{command_to_continue(context)}`.", file=sys.stderr)
    elif not quiet:
        words = ["bootcourse", "evaluate", str(out)]
        for option, place in (("--teacher", teacher), ("--learner", "" if compiled else learner)):
            words += [option, place] if place else []
        print(f"To test these agents on 1,000 other roads, run `{shlex.join(words)}`.")
    raise typer.Exit(status)


def changes_of(words: list[str]) -> dict[str, object]:
    """Settings from words such as "tau=0.01" and "hidden=(32, 32)". Raises BootcourseError for other words."""
    changes = {}
    for word in words:
        name, equals, value = (part.strip() for part in word.partition("="))
        if not equals or name in ("method", "seed"):
            raise BootcourseError(
                f"--change {word}: give NAME=VALUE, such as tau=0.01; --method and --first-seed apart."
            )
        try:
            changes[name] = ast.literal_eval(value)
        except (ValueError, SyntaxError):
            changes[name] = value  # a word, which the settings refuse or take
    return changes


def begun(asked: tuple, rule, make: dict, quiet: bool):
    """A new training, after the demonstrations that it needs.

    asked: its settings, episodes and scenario. make: further arguments of `Training`.
    """
    from bootcourse.learn.teachers import marked
    from bootcourse.learn.training import Training

    if marked(rule).is_slow and asked[0][0].needs_demonstrations and not quiet:
        print("First this teacher drives the demonstrations. It is a slow one: that may take minutes.", file=sys.stderr)
    return Training(*asked, rule, **make)


def kept(training, out: Path):
    """The training, after its first checkpoint, which fails now and not at the end if the disk is full."""
    from bootcourse.storage.checkpoint import save_checkpoint

    save_checkpoint(training, out / UNFINISHED / CHECKPOINT)
    return training


def resumed(out: Path, rule, device: str):
    """The training that goes on, None if it is over and its runs are complete. Raises BootcourseError for damage."""
    from bootcourse.storage.checkpoint import DamagedCheckpoint, load_checkpoint

    work = out / UNFINISHED
    if (work / COMPLETE).exists():
        return None
    try:
        return load_checkpoint(work / CHECKPOINT, rule, device)
    except DamagedCheckpoint as error:
        raise BootcourseError(f"{error} Delete {work}, and start again without --resume.") from None


def check_folder(out: Path, resume: bool) -> None:
    """Raise BootcourseError unless a training can begin, or be resumed, in this folder."""
    unfinished = is_unfinished(out)
    if resume and not unfinished:
        raise BootcourseError(f"{out} has no unfinished training: leave out --resume to start one.")
    if not resume and unfinished:
        raise BootcourseError(
            f"{out} has an unfinished training: add --resume to continue it, or choose another folder."
        )
    if not resume and out.exists() and (not out.is_dir() or any(path.name != UNFINISHED for path in out.iterdir())):
        raise BootcourseError(f"{out} exists already and is not empty: choose another folder.")


def is_unfinished(out: Path) -> bool:
    """Does the folder hold a training that can be resumed?"""
    return any((out / UNFINISHED / name).exists() for name in (CHECKPOINT, COMPLETE))


def given_options(context: typer.Context) -> dict[str, object]:
    """The options of `bootcourse train` that stand on the command line, by name."""
    typed = [name for name in context.params if context.get_parameter_source(name).name == "COMMANDLINE"]
    return {name: context.params[name] for name in typed}


def command_to_continue(context: typer.Context) -> str:
    """The command that continues a training: with all options of this one."""
    words = ["bootcourse", "train"]
    for name, value in given_options(context).items():
        for one in value if isinstance(value, (list, tuple)) else [value]:
            if name != "resume":
                words += [f"--{name.replace('_', '-')}", *([] if one is True else [shlex.quote(str(one))])]
    return " ".join([*words, "--resume"])


def check_resumed(training, asked: tuple, given: dict) -> None:
    """Raise BootcourseError if options were given that are not those that the training began with.

    asked: the settings, episodes and scenario that the whole command stands for.
    """
    chosen = {name: value for name, value in given.items() if name in BEGINNING}
    if chosen and asked != (training.settings, training.episodes, training.scenario):
        first, began = training.settings[0], {"seeds": len(training.settings), "episodes": training.episodes}
        began |= {"method": first.method, "first_seed": first.seed, "scenario": training.scenario.name}
        began |= {"p": first.rule_p, "xi": first.xi_multiplier, "c": first.bonus}
        other = {name: f" (not {began[name]})" for name, value in chosen.items() if began.get(name, value) != value}
        chosen |= {name: " ".join(value) for name, value in chosen.items() if isinstance(value, (list, tuple))}
        words = ", ".join(f"--{name.replace('_', '-')} {value}{other.get(name, '')}" for name, value in chosen.items())
        raise BootcourseError(
            f"{words}: this training began with other options. Give the same ones as at first, or none of them, or "
            "choose another folder."
        )


@contextmanager
def learner_from(place: str, like: Method | None = None) -> Iterator[str]:
    """The learner "FILE.py:CLASS", which is a method within the block, under the name of its class; "" for "".

    like: the method whose settings it starts from; None to read a run that has settings of its own. Raises
    BootcourseError if it is not there, does not load or is no learner, and for a name that a method has.
    """
    if not place:
        yield ""
        return
    kind = loaded(place, "--learner", "class")
    if not isinstance(kind, type) or not hasattr(kind, "driving_policy"):
        raise BootcourseError(f"--learner {place}: give a class with the methods of bootcourse.learn.protocol.Learner.")
    name = kind.__name__
    if name in METHODS:
        raise BootcourseError(f"--learner {place}: a method is called '{name}' already: give your class another name.")
    with own_method(name, method_of(kind, like)):
        yield name


def teacher_from(place: str):
    """The rule "FILE.py:FUNCTION", or the teacher of a name, such as "planner"; the course's rule for "".

    Raises BootcourseError if it is not there or does not load.
    """
    from bootcourse.learn.teachers import course_rule

    if not place:
        return course_rule
    if ":" not in place:
        tables = map(resolve_name, added("TEACHERS").values())  # slow: it loads the planner
        teachers = {name: teacher for table in tables for name, teacher in table.items()}
        if place not in teachers:
            own = "or give a rule of your own, FILE.py:FUNCTION"
            raise BootcourseError(f"Teacher {did_you_mean(place, teachers)}, {own}.")
        return teachers[place].rule
    return loaded(place, "--teacher", "function")


def finish_training(training, out: Path, progress: bool) -> int:
    """Train, with a checkpoint every 20 s, and move the runs to their places. Returns the exit status.

    training: None if it is over and its runs are complete, but not all in their places.
    """
    try:
        return _finish(training, out, progress)
    except KeyboardInterrupt:  # before the first decision, or after the last: the checkpoint is there
        return INTERRUPTED


def _finish(training, out: Path, progress: bool) -> int:
    from bootcourse.storage.checkpoint import save_checkpoint
    from bootcourse.storage.runs import save_runs
    from bootcourse.storage.work import Checkpoints

    work = out / UNFINISHED
    if training is not None:
        result = training.run(progress, Checkpoints(work / CHECKPOINT, SECONDS_BETWEEN))
        if result.interrupted:
            save_checkpoint(training, work / CHECKPOINT)
            return INTERRUPTED
        if not training.updates:
            print("No update was made: the agents drive as at first. Train for more --episodes.", file=sys.stderr)
        shutil.rmtree(work / SAVING, ignore_errors=True)
        save_runs(result, work / SAVING)
        os.rename(work / SAVING, work / COMPLETE)
    for run in sorted((work / COMPLETE).iterdir()):
        if (out / run.name).exists():
            raise BootcourseError(f"{out / run.name} exists already: move it away, and add --resume.")
        print(run.rename(out / run.name))
    (work / CHECKPOINT).unlink(missing_ok=True)
    (work / COMPLETE).rmdir()
    return 0
