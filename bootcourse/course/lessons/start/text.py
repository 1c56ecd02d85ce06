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
# **Time** 10 minutes; the machine computes for half a minute. **It builds on** nothing.

# %%
import bootcourse as bc
from bootcourse.course import compare_predictions, predict, predicted, progress, shipped

# %% [markdown]
# ## Drive first
#
# Two slow cars, dark red, box you in: **trap 1** ahead of you, **trap 2** in the middle lane; the left one is
# free. Get ahead of trap 1. Click on the road and use the arrow keys, or the nine buttons: you decide once a
# second. A drive lasts {{ DEFAULT.clock.decisions // DEFAULT.clock.decision_rate }} s, and an accident ends
# it. Crash as often as you like, and read on once you are ahead. Shift+Enter runs a cell.
# <!-- claim: N_ACTIONS == 9 -->
#
# > **Predict.** How many attempts do you need until you are ahead of trap 1?

# %%
predict("start.1", "How many attempts until you are ahead of trap 1?", unit="attempts")

# %% tags=["nbval-ignore-output"]
(mine := bc.world(road=10, ghosts=[]))

# %% [markdown]
# Not out after five attempts? Choose *the rule* as a **ghost**, a faint car on your road. The **rule**, a
# hand-written controller, knows a slow way.
# <!-- claim: by_rule(10).success -->
#
# ## Your drive, and two others
#
# Run this cell when you have driven. You see your last way out, or last attempt, and two **agents**: programs
# that learned to drive by trying. This *plain SAC* had no help and stays behind; this *bootstrapped SAC* was
# helped by the rule while it learned, and gets out. Turn the road with the mouse.


# %% tags=["nbval-ignore-output"]
def on_this_road(method):
    policies = [agent.as_policy() for agent in bc.shipped_agents(method)]
    return [bc.record(policy, [10], label=method)[0] for policy in policies]


stays = next(drive for drive in on_this_road("sac") if not drive.success)
escapes = next(drive for drive in on_this_road("bootstrapped") if drive.success)
yours = [drive for drive in mine.attempts if drive.success] or mine.attempts
drives = [*yours[-1:], stays, escapes]
end = drives[0].times[-1] if drives[0].accident else bc.overtaken(drives[0]) or 0
seconds = max(30, 5 + int(end))  # long enough to see you out, or your accident
bc.recording([shipped.beginning(drive, seconds) for drive in drives], height=480)

# %% [markdown]
# We chose two drives that differ. On this road one of our five plain agents gets out, and all five
# bootstrapped ones. One road says little: lesson [[the_trap]] counts more.
# <!-- claim: getting_out('sac') == [1, 5] and getting_out('bootstrapped') == [5, 5] -->
#
# A driver is paid for each second: most at {{ max(np.arange(0, 25, 0.5), key=speed_reward) }} m/s, little at
# the traps' {{ DEFAULT.traps.speed }} m/s. An accident is fined what about a minute behind the traps earns,
# and ends the drive. The sum over a drive is its **return**, {{ idle().rewards.sum() | .0f }} for staying
# behind, {{ by_rule(10).rewards.sum() | .0f }} for the rule's slow way out. But staying pays a little at
# once, and to get out you first fall back or risk a crash: that is the **trap**. This course asks two
# questions. Why does a program that learns stay behind slow cars, although the left lane is free? And how can
# an imperfect teacher, such as the rule, help it out, without the learner becoming a copy?
#
# ## An agent of your own
#
# This agent learns with the rule's help, by 2,000 **updates**: each changes it a little. It trains on other
# roads; on yours you watch it *now*, and the ghost is itself, 500 updates ago or more. Watch success and
# return; later lessons explain the other two curves. Training takes less than a minute: then click on the
# beginning of the curve to see how it crashed at first.
# <!-- claim: crashed_at_first() < 10 -->
#
# JupyterLab folds what answers a prediction until you commit to one, run its cell, or click on the three dots. Our
# results are saved below each cell.
#
# > **Predict.** In how many of its last 50 drives does it end ahead of trap 1 (a **success**, even if
# > it crashes afterwards)? The rule gets out on all {{ roads() | , }} test roads; your agent ends some
# > {{ round(drives().mean(), -1) | .0f }} drives while it learns.
# <!-- claim: of('rule').scores('success').min() == 1 -->
# <!-- claim: 200 < drives().min() < drives().max() < 250 -->

# %%
choices = ["in none", "in fewer than half", "in half or more"]
predict("start.2", "In how many of its last 50 drives does it end ahead of trap 1?", choices)

# %% tags=["nbval-ignore-output"]
predicted("start.2")
training = bc.Training([bc.settings_for("bootstrapped")], episodes=5000, learner="compiled")
learned = training.run(updates=2000)

# %% [markdown]
# **See.** *When* yours gets out depends on chance and your machine; the success curve, a mean of 50 drives,
# lags. Five such agents ended ahead in {{ percent(lately('success')) }} % of their last 50 drives. But
# {{ percent(lately('accident')) }} % ended in an accident, and the return was
# {{ between(lately('return')) }}, below staying's {{ idle().rewards.sum() | .0f }}.
# <!-- claim: lately('accident').min() > 0.5 and lately('success').min() > 0.5 and
#   lately('return').max() < idle().rewards.sum() and len(drives()) == 5 -->

# %% [markdown] tags=["instructor"] minutes=10
# Open with this page on the wall and let two people drive before you explain anything. Expect crashes into
# trap 2; next they accelerate. Collect on the board what ended each attempt, and keep the number of attempts
# for lesson [[the_barrier]].

# %% [markdown]
# ## What is the same on your machine, and what is not
#
# A road is drawn from a number, its **seed**, so road 10 is the same everywhere, and shipped results are read
# from files. A training that *you* run differs: processors round the last digit of a sum in different ways,
# and the difference grows while a program learns. So what lessons say about learning rests on agents that
# ship with the course, and not on your run.
#
# ## Choose a route
#
# Each lesson opens on its own and runs in about a minute. In exercises you write some lines, and a check says
# what is wrong with them; `check.hint("name")` gives a hint, `check.solution("name")` a right answer. The
# dots, ●○○ to ●●●, say how hard an exercise is.
#
# Each route's hours include this lesson's ten minutes.
#
# {{ button('evening', 'An evening', 'you see what happens') }}
#
# {{ button('week', 'A week', 'you learn to do it yourself') }}
#
# {{ button('researcher', "A researcher's route", 'you know SAC, and ask which results hold') }}
#
# <!-- claim: missing('evening') == missing('week') == missing('researcher') == [] -->
#
# **Read on**: [the trap](the_trap.ipynb). The course follows Zhang, Peng, Yurtsever and Redmill,
# *Bootstrapping Reinforcement Learning with Sub-optimal Policies for Autonomous Driving* (2025).

# %% tags=["nbval-ignore-output"]
progress()

# %% tags=["nbval-ignore-output"]
out = [drive.success for drive in mine.attempts]
success = [drive for drive in learned.curves["success"][0] if drive >= 0][-50:]  # NaN: not driven
ahead = "none" if not sum(success) else "fewer than half" if sum(success) < 25 else "half or more"
attempts = out.index(True) + 1 if True in out else f"not out yet, after {len(out)} of your drives"
compare_predictions("start", {1: attempts, 2: f"in {ahead}"})

# %% [markdown] tags=["instructor"]
# **On the board.** Three lanes from above: the driver in the right one, trap 1 ahead of it, trap 2 about a
# car's length ahead in the middle one.
#
# **To discuss.** You found a way out by hand. What did you know that a learner does not know at the start?
