"""bootcourse: a trap on the highway, and how an imperfect driver pulls a learner out of it.

The front door: `import bootcourse as bc` gives every name in `NAMES` and every module in `MODULES`, each loaded when
it is first used. The parts, each of which uses only those above it; all but the last two are the small library:

errors             the exception for mistakes that a user can mend
rooms              what the last two parts add to the front door, the command line and the studies
files              reading and writing files, whole or not at all
markup             text as HTML: the one place that escapes
progress           a progress bar, or lines where no terminal shows one
scenario           the numbers of the road, the cars, the reward and the rule
colours            the colours of figures, panels and 3D
methods            every method: its settings, its learner, its name, its style
road               the trap in simulation: formulas, the compiled road, highway-env, what the agent observes
rule               the rule controller and its stochastic form
policies           who can drive: the rule, a plan, a random or an idle policy
statistics         means, rates, intervals
episodes           driving: one recorded drive, many evaluated episodes, a drive in words
learn              discrete SAC, the rule's help, the baselines, the training loop
storage            runs, checkpoints and shipped results on disk
plots              figures: the road from above, a drive over time, training curves
others             the road for other people's code: one fast car, and adapters for other libraries
comparison         some trainings side by side, in any environment: curves, intervals, a table
one_per_cell       a notebook cell that runs again replaces what it showed
replay3d           drives in 3D: in a notebook, in a browser, as one file
web                the road to look at and to drive: in a notebook, and as a page without a network
panels             widgets for notebooks: train, look into one decision
doctor             what is wrong with an installation, and what to do about it
cli                the command line
research           the paper's experiments and ours: jobs, tables, planner, checks against published figures
course             exercises and their judge, the lessons, a class: handing out, collecting, grading
"""

import importlib
import os
import sys

if sys.argv[:1] == ["-m"] and sys.path[:1] == [os.getcwd()] != [os.path.dirname(os.path.dirname(__file__))]:
    del sys.path[0]  # `python -m bootcourse` in a class's folder: import nothing that was handed in

from bootcourse.errors import did_you_mean
from bootcourse.rooms import added

__version__ = "0.1.0"

NAMES = added("NAMES") | {  # name -> where it is defined
    # the road
    "DEFAULT": "bootcourse.scenario",
    "CALIBRATED": "bootcourse.scenario",
    "Scenario": "bootcourse.scenario",
    "ACTION_NAMES": "bootcourse.scenario",
    "Accident": "bootcourse.road.state",
    # who drives
    "rule_policy": "bootcourse.policies",
    "stochastic_rule_policy": "bootcourse.policies",
    "idle_policy": "bootcourse.policies",
    "random_policy": "bootcourse.policies",
    "plan_policy": "bootcourse.policies",
    "PolicyOutput": "bootcourse.policies",
    "lookahead": "bootcourse.episodes.lookahead",
    # to drive
    "record": "bootcourse.episodes.record",
    "Rollout": "bootcourse.episodes.rollout",
    "evaluate": "bootcourse.episodes.evaluate",
    "drive_episodes": "bootcourse.episodes.evaluate",
    "held_out_seeds": "bootcourse.episodes.evaluate",
    "summarise": "bootcourse.episodes.evaluate",
    "overtaken": "bootcourse.episodes.words",
    # to train
    "Settings": "bootcourse.learn.settings",
    "settings_for": "bootcourse.learn.settings",
    "with_seeds": "bootcourse.learn.settings",
    "Training": "bootcourse.learn.training",
    "teacher_policy": "bootcourse.learn.teachers",
    "collect": "bootcourse.learn.demonstrations",
    "demonstrate": "bootcourse.learn.demonstrations",
    "Demonstrations": "bootcourse.learn.demonstrations",
    "ReplayBuffer": "bootcourse.learn.replay_buffer",
    "learner_for": "bootcourse.learn.learner",
    "Agent": "bootcourse.learn.agent",
    "compare": "bootcourse.comparison",
    "Success": "bootcourse.episodes.success",
    "save_runs": "bootcourse.storage.runs",
    "load_run": "bootcourse.storage.runs",
    # to look at it
    "world": "bootcourse.web.widget",
    "show": "bootcourse.plots.figure",
    "top_view_over_time": "bootcourse.plots.top_view",
    "traces": "bootcourse.plots.traces",
    "training_curves": "bootcourse.plots.training_curves",
    "replay": "bootcourse.replay3d.viewer",
    "recording": "bootcourse.replay3d.recorder",
    "display_name": "bootcourse.methods",
    "BootcourseError": "bootcourse.errors",
}
MODULES = {  # name -> module; `bc.panels.train_panel()`
    "formulas": "bootcourse.road.formulas",
    "state": "bootcourse.road.state",
    "rule": "bootcourse.rule",
    "policies": "bootcourse.policies",
    "words": "bootcourse.episodes.words",
    "statistics": "bootcourse.statistics",
    "sac": "bootcourse.learn.sac",
    "bootstrap": "bootcourse.learn.bootstrap",
    "panels": "bootcourse.panels",
}
__all__ = [*NAMES, *MODULES]

try:
    import gymnasium as _gym
except ModuleNotFoundError:  # `bootcourse doctor` says what is missing, and needs nothing else from here
    pass
else:
    for _name, _entry_point in (
        ("Trap-v0", "bootcourse.road.trap_env:TrapEnv"),
        ("FastTrap-v0", "bootcourse.others.fast_env:FastTrapEnv"),
    ):
        _gym.register(_name, _entry_point, vector_entry_point="bootcourse.road.vector_env:TrapVectorEnv")


def __getattr__(name: str):
    """Load a public name when it is first used."""
    if name in MODULES:
        return importlib.import_module(MODULES[name])
    if name in NAMES:
        value = globals()[name] = getattr(importlib.import_module(NAMES[name]), name)
        return value
    if name.startswith("__"):
        raise AttributeError(name)
    raise AttributeError(f"In bootcourse, {did_you_mean(name, __all__)}.")


def __dir__() -> list[str]:
    return sorted(__all__)
