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
# # 1 · The trap
#
# **What you will be able to do**
# - say what a driver sees, what it can do, and what it is paid for;
# - work out by hand what doing nothing earns, and check it on the road;
# - explain why leaving the trap looks like a bad idea, one decision at a time.
#
# **Time** 40 minutes, under a minute of it the machine's. **You need** Python, and no
# reinforcement learning yet.

# %%
import gymnasium as gym
import numpy as np
from bootcourse.drivers import idle_driver, in_words, plan_driver, random_driver, rule_driver
from bootcourse.lessons.figures import reward_curve
from bootcourse.record.drive import record
from bootcourse.road.formulas import centring_reward, speed_reward, steering_reward, weighted_reward
from bootcourse.road.observation import names, scales
from bootcourse.road.state import TRAP_1, TRAP_2, Accident, X
from bootcourse.scenario import ACTION_NAMES, DEFAULT
from bootcourse.study.drawing import show
from bootcourse.study.evaluate import drive_episodes, held_out_seeds
from bootcourse.study.top_view import overtaken, top_view, top_view_over_time
from bootcourse.study.traces import traces

# %% [markdown]
# ## Look first
#
# You drive the car that is labelled **ego**, at 10 m/s. Two dark red cars hold you: **trap 1**
# ahead in your lane, **trap 2** beside it in the next. Both drive 10 m/s, too. The left lane is
# free. Everything else (grey) is traffic that drives up to 12.5 m/s.

# %%
ROAD = 10  # the seed: which road you get
idle = record(idle_driver, [ROAD], label="idle")[0]
show(top_view(idle, time=0, distances=True))

# %% [markdown]
# > **Predict.** You may brake, keep your speed or accelerate, and steer left, straight or right.
# > How would you get to the free lane? Write down a plan before you go on: how many seconds of
# > what?

# %% [markdown]
# ## Round 1: drive it
#
# You decide once a second. There are nine actions: −1, 0 or +1 m/s², times −π/50, 0 or +π/50 rad
# of steering. A plan is a list of actions in words, with the number of seconds. After your plan,
# the car keeps going straight.

# %%
print(ACTION_NAMES)

# %%
my_plan = [("keep left", 2), ("keep right", 2)]  # change it, and run the cell again

mine = record(plan_driver(my_plan), [ROAD], label="you")[0]
ending = Accident(mine.accident).name.lower()
print(f"accident: {ending}, after {len(mine.actions)} s, return {mine.rewards.sum():.2f}")
show(top_view_over_time(mine, times=[0, 1, 2, 3]))

# %% [markdown]
# **See.** The first idea of nearly everybody, "go left now", ends in trap 2: it is 4.06 to 7.43 m
# ahead of you, centre to centre, and a car is 5 m long. On roads where it is a little further
# ahead the same plan ends behind trap 2, at the same 10 m/s. (Try `ROAD = 7`.)
#
# There are three ways to end badly. Each ends the episode at once and pays −10.

# %%
bad_plans = {
    "accelerate at trap 1": [("accelerate straight", 6)],
    "steer off the road": [("keep right", 3)],
    "brake to a stop": [("brake straight", 12)],
}
for name, plan in bad_plans.items():
    drive = record(plan_driver(plan), [ROAD])[0]
    print(f"{name:22} -> {Accident(drive.accident).name.lower():15} after {len(drive.actions):2} s")

# %% [markdown]
# The paper adds all three up and calls them "collision rate". We keep them apart: a policy that
# stops on the motorway and one that hits a car have learned different things.
#
# Is there a way out at all? Here is one, found by a controller that you will meet in the next
# lesson.

# %%
escape = record(rule_driver(DEFAULT), [ROAD], label="rule")[0]
print("the first 15 s in words:", in_words(escape.actions[:15]))
show(top_view_over_time(escape, times=[0, 3, 6, 9, 20, overtaken(escape)]))

# %% [markdown]
# **Explain.** The way out leads *backwards*. You fall behind both cars, change left behind trap
# 2, change left again, and then you are free. Nobody is in your way behind you. It costs speed
# now for speed later, and that is what makes this road a trap for a learner.

# %% [markdown]
# ## Round 2: what you see
#
# A driver that learns does not get a picture. It gets 26 numbers, the **observation**: six about
# itself, then five about each of the four nearest cars within 200 m. A missing car is five zeros.
# Each number is divided by a fixed scale, so that all are of order one. Multiply by the scale,
# and you have metres and metres per second.

# %%
env = gym.make("bootcourse:Trap-v0")
observation, info = env.reset(seed=ROAD)
rows = zip(names(DEFAULT), observation, scales(DEFAULT), strict=True)
for name, number, scale in list(rows)[:16]:
    print(f"{name:15} {number:7.3f}  x {scale:6.0f}  = {number * scale:7.2f}")

# %% [markdown]
# > **Predict.** `car 1` is the nearest car. Which one is it, trap 1 or trap 2? And which sign has
# > its `dy`, if y grows to the *right*?

# %%
start = idle.states[0]
print(f"trap 1 is {start[TRAP_1, X]:.2f} m ahead, trap 2 {start[TRAP_2, X]:.2f} m")

# %% [markdown]
# **See.** The nearest is trap 2, and its `dy` is −4 m: one lane to the left.

# %% [markdown]
# ## Round 3: what you are paid for
#
# Every second pays a weighted mean of three terms:
#
# $$ r = \frac{w_v r_v + w_y r_y + w_\theta r_\theta}{w_v + w_y + w_\theta},
# \qquad w_v = 1.5,\; w_y = w_\theta = 0.05 $$
#
# - $r_v$ pays for speed, see below;
# - $r_y = \exp(-1.5\, d_e^2)$ pays for the middle of the lane ($d_e$ metres off it);
# - $r_\theta = -|\sin\theta|$ charges for steering.

# %%
show(reward_curve())

# %% [markdown]
# **See.** Speed pays little up to 12.5 m/s, a lot up to 15, and nothing above. The road on which
# you earn well is the free one: behind the traps you earn 0.13 of the speed term and never more.
#
# > **Predict.** You do nothing at all for 150 s: 10 m/s, centred, no steering. What do you earn
# > in one second? In 150? Use the formula and the line $r_v = \frac{2}{75} v - \frac{2}{15}$ for
# > 5 < v ≤ 12.5. Pen and paper.

# %%
v, offset, theta = 10.0, 0.0, 0.0
r_v, r_y, r_theta = speed_reward(v), centring_reward(offset), steering_reward(theta)
reward = weighted_reward(r_v, r_y, r_theta, 1.5, 0.05, 0.05)
print(f"r_v = {r_v:.4f}, r_y = {r_y:.0f}, r_theta = {abs(r_theta):.0f}")
print(f"{reward:.5f} a second, {150 * reward:.4f} in 150 s")

# %% [markdown]
# Now let the road say it. The sum of an episode's rewards is its **return**.

# %%
# NBVAL_CHECK_OUTPUT
print(f"return {idle.rewards.sum():.4f}, distance {idle.distance:.0f} m, success {idle.success}")

# %% [markdown]
# **Explain.** (1.5 · 0.1333 + 0.05) / 1.6 = 0.15625 a second, 23.4375 in all, over 1500 m.
# Remember 23.4: a learner that ends there has learned to stay where it is. Doing nothing is a
# *fixed point*: the trap never punishes you for it.

# %% [markdown]
# ## Round 4: why it is a trap
#
# > **Predict.** Compare the escape with doing nothing, second by second. For how long does the
# > escape earn *less* in total: 10 s, 30 s or 60 s?

# %%
show(traces([idle, escape]))

# %%
behind = np.cumsum(escape.rewards) < np.cumsum(idle.rewards)
last_behind = int(np.flatnonzero(behind)[-1]) + 1
ahead = escape.rewards.sum() - idle.rewards.sum()
print(f"the escape is behind until second {last_behind}; at the end it is {ahead:.1f} ahead")
print(f"deepest: {np.min(np.cumsum(escape.rewards) - np.cumsum(idle.rewards)):.2f}")

# %% [markdown]
# So the price of the way out is small. Why is it hard to find, then?
#
# > **Predict.** A driver picks each action at random. In what share of 1,000 episodes does it get
# > out? In what share does it survive?

# %%
episodes = drive_episodes(random_driver(np.random.default_rng(0)), held_out_seeds(1, 1000))
print(f"ahead of trap 1 at the end: {100 * episodes.success.mean():.1f} %")
print(f"no accident in 150 s:       {100 * np.mean(episodes.accident == 0):.1f} %")
print(f"mean return:                {episodes.returns.mean():.2f}")

# %% [markdown]
# **Explain.** A learner begins with random tries and improves in small steps. Nearly every try
# away from "follow trap 1" ends at −10 before it can pay, so the first lesson that the road
# teaches is: stay. The escape needs about ten right decisions in a row, and pays much later. A
# learner that explores at random almost never sees it. That is the problem that the rest of this
# course solves.
#
# **Success** has a definition: the ego is ahead of trap 1 at the end of its episode. A crash
# after overtaking still counts as success, and is counted again as an accident.

# %% [markdown]
# ## What you now know
#
# 1. The scenario is a Markov decision process: 26 numbers in, one of nine actions out, once a
#    second for 150 s.
# 2. Speed pays most near 15 m/s; accidents pay −10 and end the episode.
# 3. Doing nothing earns 23.4375 over 1500 m, for ever behind trap 1.
# 4. The way out goes backwards: slower first, then left behind trap 2.
# 5. The escape pays off late, and one accident on the way costs what 64 s of patience earn (10 /
#    0.15625).
#
# **Three questions to think about**
# - Would the trap still be one if trap 2 drove 0.5 m/s faster than you?
# - Which reward would you change so that a learner leaves at once? What else would that learner
#   then do?
# - The observation contains no memory. Which situation on this road looks the same but is not?
#
# **Read on**: the next lesson takes the controller apart that found the way out. highway-env, the
# simulator under this road: Leurent, *An Environment for Autonomous Driving Decision-Making*
# (2018).
