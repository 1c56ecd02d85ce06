# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # Start
#
# **What you will be able to do**
# - say what the trap is, and how a car can get out of it;
# - drive it yourself, and compare yourself with two programs that learned to drive;
# - choose your route through the course.
#
# **Time** 10 minutes, the machine computes for half a minute of it. **It builds on** nothing.

# %%
import bootcourse as bc
from bootcourse.course import compare_predictions, predict, shipped, table
from bootcourse.research import report, tables

# %% [markdown]
# ## Look first
#
# Both drives below are on the same road. Two slow cars, dark red, hold the driver: **trap 1** ahead
# of it, **trap 2** beside it. The drivers are **agents**: programs that have learned from their own
# attempts. Both have had the same number of training drives. A rule that somebody wrote by hand
# helped the *bootstrapped* agent while it learned. Press play, and turn the road with the mouse.
# <!-- claim: len({run.curves['success'].shape for method in ('sac', 'bootstrapped') for run in
#   shipped_runs(method)}) == 1 -->

# %% tags=["nbval-ignore-output"]
escape = bc.shipped_drive("escape")  # by a bootstrapped agent
plain = [agent.as_policy(with_q=True) for agent in bc.shipped_agents("sac")]  # on the same road:
alone = [bc.record(driver, [escape.seed], label="sac")[0] for driver in plain]
trapped = next((drive for drive in alone if not drive.success), alone[0])
bc.recording([shipped.beginning(trapped, 30), shipped.beginning(escape, 30)], height=480)

# %% [markdown]
# The same in words:

# %% tags=["hide-input"]
rows = [
    [f"{t} s", bc.words.doing(trapped, t), bc.words.doing(escape, t)]
    for t in (0, 2, 4, 6, 8, 11, 14, 20)
]
names = [bc.display_name(drive.label) for drive in (trapped, escape)]
ends = [
    f"{name} is {bc.words.outcome(drive)}, return {drive.rewards.sum():.0f}"
    for name, drive in zip(names, (trapped, escape), strict=True)
]
table(["", *names], rows, below=f"In the end: {'; '.join(ends)}.")

# %% [markdown]
# The **return** is what a drive has earned: each second pays a little for speed, up to
# {{ max(np.arange(0, 25, 0.5), key=speed_reward) }} m/s. The bootstrapped agent above falls back
# first, which costs speed, and a wrong move on the way can end in a crash. Staying behind the slow
# cars pays a little each second. That makes the place a trap for an agent that learns by trying.
# <!-- claim: shipped_drive('escape').states[6, EGO, SPEED] < DEFAULT.ego.speed -->
# <!-- claim: idle().rewards.min() > 0 and idle().accident == Accident.NONE -->

# %% [markdown]
# ## Drive it yourself
#
# You decide once a second, and the road waits for you: nine buttons, or click on the pad and use
# the arrow keys. The faint car is a ghost: it shows how the rule gets out of the trap on this road.
# <!-- claim: by_rule(10).success -->
# <!-- claim: N_ACTIONS == 9 -->
#
# > **Predict.** How many attempts do you need until you are ahead of trap 1?

# %%
predict("start.1", "How many attempts until you are ahead of trap 1?", unit="attempts")

# %% tags=["nbval-ignore-output"]
bc.panels.drive_panel(seed=10)

# %% [markdown] tags=["instructor"] minutes=10
# Open with this page on the wall and let two people drive before you explain anything. Expect
# crashes into trap 2. Keep the number of attempts on the board for lesson [[the_barrier]].

# %% [markdown]
# ## What the agents do
#
# One drive proves little. We trained {{ len(of('sac')) }} agents of each kind. Agents of one kind
# differ only in their **seed**, the number from which all chance in their training is drawn. After
# training each agent drove the same {{ roads() | , }} roads, which were not used in training. Both
# kinds learn by SAC, *soft actor-critic*. A drive **escapes** if it ends ahead of trap 1. An
# *agent* escapes if at least {{ 100 * ESCAPES | .0f }} % of its drives after training do. This is
# the meaning of the word in the whole course.
# <!-- claim: len(of('sac')) == len(of('bootstrapped')) -->
#
# > **Predict.** How many of the {{ len(of('sac')) }} agents of plain SAC escape? How many of the
# > {{ len(of('bootstrapped')) }} with help? Who has an accident more often: the agents with help,
# > or the rule?

# %%
predict("start.2", "How many agents of plain SAC escape?", unit="of 10")

# %%
predict("start.3", "How many of the agents with help?", unit="of 10")

# %%
predict(
    "start.4",
    "Who has more accidents?",
    ["the agents with help", "the rule", "both about the same"],
)


# %%
study = bc.shipped_results()
rows = []
for method in ("sac", "bootstrapped"):
    mine = study.of(method)
    success = mine.scores("success")
    accidents = 100 * mine.episodes("accident").mean()
    share = tables.bracketed(bc.statistics.escapes(success), 100)
    returns = tables.bracketed(tables.score(study, method, "returns"))
    count = f"{(success >= bc.statistics.ESCAPES).sum()} of {len(mine)}: {share} %"
    rows.append([bc.display_name(method), count, returns, f"{accidents:.0f} %"])
rule = report.rule_results(bc.DEFAULT, study.sizes[0])
accidents = 100 * rule.episodes("accident").mean()
returns = tables.bracketed(tables.score(rule, "rule", "returns"))
not_trained = f"not trained: {100 * rule.scores('success')[0]:.0f} % of its drives escape"
rows.append([bc.display_name("rule"), not_trained, returns, f"{accidents:.0f} %"])
headings = ["", "agents that escape", "return", "drives that end in an accident"]
table(headings, rows)

# %% [markdown]
# **See.** The brackets hold the 95 % *interval*: the range in which the true value may well lie,
# given how few agents (for the rule: {{ roads() | , }} drives) we have measured. The return is that
# of a typical agent: the mean over the middle half of the agents. The share of accidents is the
# mean over all drives of all agents. Read the table with three questions; the course is about them.
# Why do most agents of plain SAC miss a way out that a rule of a few lines finds on each of the {{
# roads() | , }} roads? How many agents does the help bring out, and why not all? Some agents earn
# more than the rule: do they have more accidents, too?
# <!-- claim: escaped('sac') < len(of('sac')) / 2 and of('rule').episodes('success').all() -->
# <!-- claim: escaped('sac') < escaped('bootstrapped') < len(of('bootstrapped')) -->
# <!-- claim: of('bootstrapped').scores('returns').max() > of('rule').scores('returns').max() and
#   accidents('bootstrapped') > accidents('rule') -->
#
# ## What is the same on your machine, and what is not
#
# A road is drawn from its seed, so road 10 is the same road everywhere. The rule drives it in the
# same way, and the results that ship with the course, as in the table above, are read from files.
# Numbers of this kind stand in the text. A training that *you* run is another matter. Processors
# round the last digit of a sum in different ways. Training changes an agent some thousand times,
# and with each change such a difference can grow: with the same seed, your agents will end up
# different from ours. So where a lesson trains, it says that yours will differ, and draws its
# conclusions from results of more agents, which ship with the course.
#
# ## Choose a route
#
# *An evening* shows you what happens. In *a week* you learn to do it yourself. *A researcher's*
# route is for readers who know SAC and want to know which results hold.
#
# | lesson | an evening | a week | a researcher's |
# |---|:---:|:---:|:---:|
# | [[the_trap]] · [](the_trap.ipynb) | ● | ● | |
# | [[traffic]] · [](traffic.ipynb) | | ● | |
# | [[the_rule]] · [](the_rule.ipynb) | | ● | |
# | [[discrete_sac]] · [](discrete_sac.ipynb) | | ● | |
# | [[the_barrier]] · [](the_barrier.ipynb) | ● | ● | ● |
# | [[demonstrations]] · [](demonstrations.ipynb) | | ● | |
# | [[soft_constraint]] · [](soft_constraint.ipynb) | ● | ● | ● |
# | [[learning_from_demonstrations]] · [](learning_from_demonstrations.ipynb) | | ● | ● |
# | [[ablation]] · [](ablation.ipynb) | | ● | ● |
# | [[imitation]] · [](imitation.ipynb) | | ● | ● |
# | [[offline_learning]] · [](offline_learning.ipynb) | | ● | ● |
# | [[exploration]] · [](exploration.ipynb) | | ● | ● |
# | [[bug_hunt]] · [](bug_hunt.ipynb) | | ● | ● |
# | [[your_teacher]] · [](your_teacher.ipynb) | | ● | |
# | [[the_second_trap]] · [](the_second_trap.ipynb) | | | ● |
# | [[beyond_the_paper]] · [](beyond_the_paper.ipynb) | | | ● |
#
# Each lesson opens on its own, says what it builds on, and runs in about a minute. In its
# exercises you write some lines, and a check says what is wrong with them in plain words;
# `check.hint("name")` gives a hint, and `check.solution("name")` shows a right answer. The dots say
# how hard an exercise is, from ●○○ to ●●●.
#
# **Read on**: [the trap](the_trap.ipynb). The paper that the course follows: Zhang, Peng,
# Yurtsever and Redmill, *Bootstrapping Reinforcement Learning with Sub-optimal Policies for
# Autonomous Driving* (2025).

# %%
helped = (study.of("bootstrapped").scores("success") >= bc.statistics.ESCAPES).sum()
alone = (study.of("sac").scores("success") >= bc.statistics.ESCAPES).sum()
who = "the agents with help"
compare_predictions("start", {1: "what you counted", 2: int(alone), 3: int(helped), 4: who})
