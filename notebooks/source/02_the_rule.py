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
# # 2 · The rule
#
# **What you will be able to do**
# - read a rule controller as three formulas: a target speed, a safety distance, a lane;
# - show with one number why the printed algorithm never changes lane, and what it must say
#   instead;
# - say where the rule wastes time, and what a stochastic rule is good for.
#
# **Time** 40 minutes, under a minute of it the machine's. **You need** lesson 1.

# %%
import dataclasses

import numpy as np
from bootcourse.drivers import in_words, rule_driver, stochastic_rule_driver
from bootcourse.lessons.figures import bars, histogram, reasons_over_time
from bootcourse.record.drive import record
from bootcourse.road.state import EGO, LANE, SPEED, Accident
from bootcourse.rule import SENTENCES, Reason, safety_distance, stochastic_rule, target_speed
from bootcourse.scenario import DEFAULT
from bootcourse.study.drawing import show
from bootcourse.study.evaluate import drive_episodes, held_out_seeds, report
from bootcourse.study.top_view import top_view_over_time
from bootcourse.study.traces import traces

# %% [markdown]
# ## Look first
#
# A *rule controller* is a driver that somebody wrote by hand. This one knows nothing of rewards.
# Watch it leave.

# %%
ROAD = 10
drive = record(rule_driver(DEFAULT), [ROAD], label="rule")[0]
show(top_view_over_time(drive, times=[0, 3, 5, 7, 9, 12]))

# %% [markdown]
# At every second it can say *why* it does what it does.

# %%
for second in range(16):
    reason = SENTENCES[Reason(drive.rule_reasons[second])]
    speed, lane = drive.rule_speeds[second], drive.rule_lanes[second]
    doing = in_words(drive.actions[second : second + 1])[0][0]
    print(f"{second:2} s  {reason:40} wants {speed:5.2f} m/s in lane {lane}: {doing}")

# %%
show(reasons_over_time(drive, "First the rule gets out, then it follows the traffic"))

# %% [markdown]
# ## Round 1: how fast?
#
# The rule picks its **target speed** from five speeds between 6 and 15 m/s: the fastest that is
# *slower* than the car ahead in its lane and the car ahead in the lane that it wants.
#
# $$ v_\text{target} = \max\{ v_i : v_i < \min(v_\text{current}, v_\text{new}) \}, \qquad
# v_i = 6 + \tfrac{i-1}{4}\,(15 - 6) $$
#
# > **Predict.** Both traps drive 10 m/s. Which of the five speeds does it take? And with a free
# > road ahead?

# %%
# NBVAL_CHECK_OUTPUT
rule = DEFAULT.rule
print("the five:", [float(v) for v in np.linspace(rule.v_min, rule.v_max, rule.n)])
print("behind the traps:", target_speed(10.0, 10.0, rule.v_min, rule.v_max, rule.n))
print("with nobody ahead:", target_speed(np.inf, np.inf, rule.v_min, rule.v_max, rule.n))
print("behind traffic at 12.5 m/s:", target_speed(12.5, 12.5, rule.v_min, rule.v_max, rule.n))

# %% [markdown]
# **Explain.** It falls back at 8.25 m/s: always slower than both, so the gap grows, whatever else
# happens. It also means that behind traffic at 12.5 m/s it crawls at 10.5. Keep that in mind.

# %% [markdown]
# ## Round 2: when to change lane?
#
# Falling back, when is the gap behind trap 2 long enough? The **safety distance** asks how far
# you close in during $t_\text{safe}$ seconds:
#
# $$ d_s = (v_e - \min\{v_\text{current}, v_\text{new}\})\, t_\text{safe} $$
#
# The paper prints this with $+\,\Delta x_\text{current} - \Delta x_\text{new}$ at the end, and
# changes lane when $d_s - \Delta x_\text{current} > 0$. Put the first into the second: $\Delta
# x_\text{current}$ drops out, and what is left is
#
# $$ (v_e - v_\text{min})\, t_\text{safe} > \Delta x_\text{new}. $$
#
# > **Predict.** You drive 8.25 m/s, the traps 10 m/s, and trap 2 is 12 m ahead. Is the printed
# > condition true? Will it ever be, while you are slower than the traps?

# %%
v_ego, v_traps, dx_current, dx_new = 8.25, 10.0, 25.0, 12.0
d_s_printed = (v_ego - v_traps) * rule.t_safe + dx_current - dx_new
printed = d_s_printed - dx_current
print(f"printed: d_s - x_current = {printed:.2f} m, so change lane: {printed > 0}")

d_s = safety_distance(v_ego, v_traps, v_traps, rule.t_safe, rule.floor)
gap = dx_new - DEFAULT.car.length  # from bumper to bumper
print(f"corrected: gap {gap:.2f} m, safety distance {d_s:.2f} m, so change lane: {gap > d_s}")

# %% [markdown]
# **Explain.** The sign is the wrong way round. As printed, the left side is negative as soon as
# you are slower than the traps, and you wait for ever. The rule here changes lane when the gap to
# the *new* car ahead is **longer** than the safety distance, measured from bumper to bumper, and
# never shorter than 3 m. Papers have misprints: when a formula and its
# meaning disagree, work an example with numbers.

# %% [markdown]
# ## Round 3: how well does it drive?
#
# Not one road but 1,000, none of which was used for anything else. Every number comes with the
# interval that holds the true value with 95 % confidence.
#
# > **Predict.** The rule escapes at 8.25 m/s, then drives on. Doing nothing earns 23.4 and covers
# > 1500 m in 150 s. How far does the rule get?

# %%
episodes = drive_episodes(rule_driver(DEFAULT), held_out_seeds(1, 1000))
result = report(episodes)
for name, scale in (("success", 100), ("returns", 1), ("distance", 1)):
    value, low, high = (scale * number for number in getattr(result, name))
    print(f"{name:9} {value:7.1f}  [{low:.1f}, {high:.1f}]")
print(f"accidents of any kind: {int((episodes.accident > 0).sum())}")

# %%
title = "The rule always escapes, and is paid very differently for it"
show(histogram(episodes.returns, "return of an episode", title))

# %% [markdown]
# **See.** It always escapes and never crashes. But its return is far from what a free road pays:
# 150 s at 15 m/s are worth up to 145. (The small tower on the right: on a few roads nobody drives
# in the left lane.)

# %%
after = drive.states[:: DEFAULT.clock.steps, EGO]
free = after[:-1, LANE] == 0
speed = after[:-1, SPEED][free].mean()
print(f"in the left lane for {free.sum()} s, at {speed:.1f} m/s on average")
show(traces([drive]))

# %% [markdown]
# **Explain.** Three wastes. It takes only five speeds, so behind traffic at 12.5 it drives 10.5.
# It wants to be slower than a car ahead even if that car is 150 m away. And it never looks for a
# better lane. A learner that starts from this rule has a lot to gain: the rule knows the *way*,
# not the *best* way. Such a teacher is called **sub-optimal**.

# %% [markdown]
# ## Round 4: an unsure rule
#
# Later a learner is pulled towards the rule. For that the rule must give probabilities, not one
# action. So we pretend that it is unsure: it takes its own action with probability $p$ and each
# of the other eight with $(1-p)/8$. Call this $\tilde\pi$, the **stochastic rule**.

# %%
# NBVAL_CHECK_OUTPUT
probabilities = stochastic_rule(np.array(3), p=0.9)
print(probabilities.round(4), "sum", probabilities.sum().round(6))

# %%
show(bars(probabilities, "The stochastic rule with p = 0.9: keep left, and a little of everything"))

# %% [markdown]
# > **Predict.** Let the stochastic rule drive: each second, one chance in ten to do something
# > else. In what share of the episodes does it survive all 150 s? Nearly all, half, or hardly
# > any?

# %%
rng = np.random.default_rng(0)
unsure = drive_episodes(stochastic_rule_driver(DEFAULT, rng), held_out_seeds(2, 1000))
for kind in Accident:
    print(f"{kind.name.lower():15} {100 * np.mean(unsure.accident == kind):5.1f} %")
print(f"escapes {100 * unsure.success.mean():.0f} %")

# %% [markdown]
# **Explain.** A wrong action for one second is a lot on this road: full steering for a second
# turns the car towards the edge. The paper says that it collects its demonstrations with
# $\tilde\pi$ *and* that each of them escapes; at one decision a second both cannot be true. Here
# demonstrations are driven by the rule itself, and $\tilde\pi$ is what the learner is compared
# with. You can have it the other way, too.
#
# What if only p changes?

# %%
for p in (0.5, 0.9, 0.99, 0.999):
    scenario = dataclasses.replace(DEFAULT, rule=dataclasses.replace(DEFAULT.rule, p=p))
    driver = stochastic_rule_driver(scenario, np.random.default_rng(0))
    driven = drive_episodes(driver, held_out_seeds(2, 500), scenario)
    print(f"p = {p:5}: {100 * np.mean(driven.accident == 0):5.1f} % without an accident")

# %% [markdown]
# ## What you now know
#
# 1. The rule is three formulas and a tracker; it can always say why.
# 2. As printed, its lane change never happens. The corrected one compares the gap with the safety
#    distance.
# 3. It escapes every time, without an accident, and earns a third of what a free road pays.
# 4. It is sub-optimal by design: five speeds, no eye for distance, no second thoughts.
# 5. The stochastic rule gives each action a probability. It is a yardstick, not a driver.
#
# **Three questions to think about**
# - Which one number in the rule would you change to earn more? What could go wrong then?
# - The rule reads the true state of all cars, the learner only 26 numbers. Can a learner imitate
#   it perfectly?
# - The rule's steering looks three seconds ahead. What happens with one?
#
# **Read on**: the next lesson lets an agent learn alone, and with this rule at its side. The idea
# of a safety distance that grows with speed is old: Gipps, *A behavioural car-following model*
# (1981).
