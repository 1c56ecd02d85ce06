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
# - say what the trap is, and drive it yourself;
# - choose your route through the course.
#
# **Time** 10 minutes; the machine computes for about half of one. **It builds on** nothing.

# %%
import bootcourse as bc
from bootcourse.course import compare_predictions, predict, progress, shipped

progress()

# %% [markdown]
# ## Look first
#
# Both drives below start alike on the same road. Two slow cars are dark red: **trap 1** is ahead of
# the driver, **trap 2** a little ahead in the next lane. One program, labelled *plain SAC*, stays
# behind them; the other, *bootstrapped SAC*, gets out. (Lesson [[the_trap]] says what the names
# mean.) Press play, and turn the road with the mouse.

# %% tags=["nbval-ignore-output"]
escape = bc.shipped_drive("escape")  # by an agent that had help
plain = [agent.as_policy(with_q=True) for agent in bc.shipped_agents("sac")]  # had no help
alone = [bc.record(driver, [escape.seed], label="sac")[0] for driver in plain]  # the same road
trapped = next((drive for drive in alone if not drive.success), alone[0])
bc.recording([shipped.beginning(trapped, 30), shipped.beginning(escape, 30)], height=480)

# %% [markdown]
# Both drivers are **agents**, programs that have learned from their own attempts. The one that gets
# out had help while it learned, from a hand-written controller, the **rule**. We chose these two
# drives because they differ; lesson [[the_trap]] counts how many agents of each kind get out.
#
# A driver is paid for each second: most at {{ max(np.arange(0, 25, 0.5), key=speed_reward) }} m/s,
# little at the traps' {{ DEFAULT.traps.speed }} m/s. An accident costs about what a minute behind
# the traps earns. Why does a program that learns stay behind slow cars, although the left lane is
# free? That is the question of this course.

# %% [markdown]
# ## Drive it yourself
#
# You decide once a second, and the road waits for you: nine buttons, or click on the pad and use
# the arrow keys. The faint car is a **ghost**: it shows how the rule drives the same road. Crash as
# often as you like.
#
# The results that we got are saved below each cell of this course. Those that answer a prediction
# are folded in JupyterLab until you commit to yours; a click on the three dots opens them, too.
# <!-- claim: by_rule(10).success -->
# <!-- claim: N_ACTIONS == 9 -->
#
# > **Predict.** How many attempts do you need until you are ahead of trap 1?

# %%
predict("start.1", "How many attempts until you are ahead of trap 1?", unit="attempts")

# %% tags=["nbval-ignore-output"]
bc.world(road=10)

# %% [markdown] tags=["instructor"] minutes=10
# Open with this page on the wall and let two people drive before you explain anything. Expect
# crashes into trap 2; next they accelerate. Collect on the board what ended each attempt, and keep
# the number of attempts for lesson [[the_barrier]].

# %% [markdown]
# ## What is the same on your machine, and what is not
#
# A road is drawn from a number, its **seed**, so road 10 is the same road everywhere, and results
# that ship with the course are read from files. A training that *you* run is another matter:
# processors round the last digit of a sum in different ways, and such a difference grows while a
# program learns. Where a lesson trains, it says that yours will differ, and draws its conclusions
# from more agents, which ship with the course.
#
# ## Choose a route
#
# *An evening* shows you what happens. In *a week* you learn to do it yourself. *A researcher's*
# route is for readers who know SAC, the learner that lesson [[discrete_sac]] builds, and want to
# know which results hold.
#
# ● the whole lesson · ◐ the text without the exercises · *picture*: the diagram at its
# beginning · *known*: skip it if you know SAC
#
# | lesson | an evening | a week | a researcher's |
# |---|:---:|:---:|:---:|
# | [[the_trap]] · [](the_trap.ipynb) | ● | ● | ◐ |
# | [[values]] · [](values.ipynb) | | ● | known |
# | [[discrete_sac]] · [](discrete_sac.ipynb) | picture | ● | known |
# | [[update_and_loop]] · [](update_and_loop.ipynb) | | ● | known |
# | [[the_barrier]] · [](the_barrier.ipynb) | ● | ● | ● |
# | [[the_rule]] · [](the_rule.ipynb) | | ● | ◐ |
# | [[demonstrations]] · [](demonstrations.ipynb) | | ● | ◐ |
# | [[soft_constraint]] · [](soft_constraint.ipynb) | | ● | ● |
# | [[learning_from_demonstrations]] · [](learning_from_demonstrations.ipynb) | | ● | ● |
# | [[how_many_seeds]] · [](how_many_seeds.ipynb) | | ● | ● |
# | [[found_and_kept]] · [](found_and_kept.ipynb) | | ● | ● |
# | [[imitation]] · [](imitation.ipynb) | | ● | ● |
# | [[offline_learning]] · [](offline_learning.ipynb) | | ● | ● |
# | [[bug_hunt]] · [](bug_hunt.ipynb) | | ● | ● |
# | [[your_teacher]] · [](your_teacher.ipynb) | | ● | ◐ |
# | [[the_second_trap]] · [](the_second_trap.ipynb) | | | ● |
# | [[looking_ahead]] · [](looking_ahead.ipynb) | | | ● |
# | [[other_ways]] · [](other_ways.ipynb) | | | ● |
# | [[your_own_problem]] · [](your_own_problem.ipynb) | | | ● |
# | [[traffic]] · [](traffic.ipynb), for reference | | | |
# | hours, with this page | {{ long('evening') / 60 | .1f }} | {{ long('week') / 60 | .1f }} | {{
#   long('researcher') / 60 | .1f }} |
# <!-- claim: missing('evening') == missing('week') == missing('researcher') == [] -->
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
compare_predictions("start", {1: "what you counted"})
