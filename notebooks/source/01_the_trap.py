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
# **Time** 60 minutes, under a minute of it the machine's. **It builds on** nothing but Python: no
# reinforcement learning yet.

# %%
import bootcourse as bc
import gymnasium as gym
import numpy as np
from bootcourse.lessons import check, figures
from bootcourse.road import formulas, observation

# %% [markdown]
# ## Look first
#
# You drive the car that is labelled **ego**, at {{ DEFAULT.ego.speed }} m/s. Two dark red cars hold
# you: **trap 1** ahead in your lane, **trap 2** beside it in the next. Both drive
# {{ DEFAULT.traps.speed }} m/s, too. The left lane is free. Everything else (grey) is traffic that
# drives up to {{ DEFAULT.traffic.desired_speed }} m/s.

# %%
ROAD = 10  # the seed: which road you get
idle = bc.record(bc.idle_policy, [ROAD], label="idle")[0]
bc.show(bc.top_view(idle, time=0, distances=True))

# %% [markdown]
# > **Predict.** You may brake, keep your speed or accelerate, and steer left, straight or right.
# > How would you get to the free lane? Write down a plan before you go on: how many seconds of
# > what?

# %% [markdown]
# ## Round 1: drive it
#
# Drive first, and think afterwards. In JupyterLab the panel below has nine buttons; click on the
# pad once and the arrow keys work, too. You decide once a second, and the road waits for you. The
# faint car is a **ghost**: it shows how the rule of lesson 3 drives the same road.

# %% tags=["nbval-ignore-output"]
bc.panels.drive_panel(seed=ROAD)

# %% [markdown] tags=["instructor"] minutes=8
# Let them crash. Expect them to steer left at once and hit trap 2, and then to accelerate. Collect
# on the board what ended each attempt and after how many seconds, and ask who still has a plan.
# They need not succeed here.

# %% [markdown]
# The nine buttons are the nine **actions**: {{ -DEFAULT.ego.acceleration }}, 0 or
# +{{ DEFAULT.ego.acceleration }} m/s², times −π/{{ math.pi / DEFAULT.ego.steering }}, 0 or
# +π/{{ math.pi / DEFAULT.ego.steering }} rad of steering. Each is held for one second. A program
# knows them by their numbers, 0 to {{ N_ACTIONS - 1 }}.
# <!-- claim: N_ACTIONS == 9 -->

# %%
print(dict(enumerate(bc.ACTION_NAMES)))
bc.show(figures.nine_actions(seconds=2))

# %% [markdown]
# **See.** Two seconds of steering bring you more than half of the way into the next lane, and
# leave the car turned. That is a coarse way to drive: every lane change needs a turn and a turn
# back.
# <!-- claim: np.ptp(record(plan_policy([('keep left', 2)]), [ROAD])[0].states[[0, 4], EGO, Y]) >
#   DEFAULT.road.lane_width / 2 -->
#
# **Exercise 1.1 (5 min, ●○○).** Turn action numbers into what the car does. The middle action,
# {{ ACTION_NAMES.index('keep straight') }}, is "keep straight"; y grows to the *right*, so steering
# left is negative.


# %%
def decode(actions):
    """Acceleration (m/s²) and steering (rad) of each action: whole numbers (n,) -> (n, 2)."""
    # solution
    acceleration = actions // 3 - 1
    steering = (actions % 3 - 1) * np.pi / 50
    return np.stack([acceleration, steering], axis=-1)
    # end solution


check.decode(decode)

# %% [markdown]
# Without a panel, a plan is a list of actions in words, with the number of seconds. After your
# plan, the car keeps going straight.

# %%
my_plan = [("keep left", 2), ("keep right", 2)]  # change it, and run the cell again

mine = bc.record(bc.plan_policy(my_plan), [ROAD], label="you")[0]
ending = bc.Accident(mine.accident).name.lower()
print(f"accident: {ending}, after {mine.times[-1]:g} s, return {mine.rewards.sum():.2f}")
near, far = bc.DEFAULT.traps.d2
print(f"trap 2 starts {near} to {far} m ahead; a car is {bc.DEFAULT.car.length:g} m long")
bc.show(bc.top_view_over_time(mine, times=[0, 1, 2, 3]))

# %% [markdown]
# **See.** "Go left now" is a natural first idea. On this road it ends in trap 2, which starts
# {{ idle().states[0, TRAP_2, X] | .2f }} m ahead of you from centre to centre: less than a car's
# length. On road 7 trap 2 starts further ahead, and the same plan ends behind it, at the same
# 10 m/s. (Try `ROAD = 7`.)
# <!-- claim: idle().states[0, TRAP_2, X] < DEFAULT.car.length -->
# <!-- claim: idle().states[0, TRAP_2, X] < idle(7).states[0, TRAP_2, X] -->
# <!-- claim: record(plan_policy([('keep left', 2), ('keep right', 2)]), [ROAD])[0].accident ==
#   Accident.COLLISION -->
# <!-- claim: record(plan_policy([('keep left', 2), ('keep right', 2)]), [7])[0].states[-1, EGO,
#   SPEED] == 10 -->
#
# There are three ways to end badly. Each ends the episode at once and pays
# {{ DEFAULT.reward.accident }}.
# <!-- claim: len(KINDS) == 3 -->

# %%
bad_plans = {
    "accelerate at trap 1": [("accelerate straight", 6)],
    "steer off the road": [("keep right", 3)],
    "brake to a stop": [("brake straight", 12)],
}
for name, plan in bad_plans.items():
    drive = bc.record(bc.plan_policy(plan), [ROAD])[0]
    ending = bc.Accident(drive.accident).name.lower()
    print(f"{name:22} -> {ending:15} after {drive.times[-1]:4.1f} s")

# %% [markdown]
# The paper adds up all three and calls the sum "collision rate". We keep them apart: a driver that
# stops on the motorway and one that hits a car have learned different things.

# %% [markdown]
# > **Predict.** The way out exists. Does its first second accelerate, steer, or brake?
#
# Is there a way out at all? Here is one, found by a controller that you will meet in lesson 3.

# %%
escape = bc.record(bc.rule_policy(bc.DEFAULT), [ROAD], label="rule")[0]
print("the first 15 s in words:", bc.policies.in_words(escape.actions[:15]))
bc.show(bc.top_view_over_time(escape, times=[0, 3, 6, 9, 20, bc.overtaken(escape)]))

# %% [markdown]
# **Explain.** This way out leads *backwards*. The car falls behind both traps, changes left behind
# trap 2, changes left again, and is free. That costs speed now for speed later.
#
# > **Predict.** Trap 2 starts {{ DEFAULT.traps.d2[0] }} to {{ DEFAULT.traps.d2[1] }} m ahead, one
# > lane to your left. Could you also change lane behind it *without* braking? On every road?

# %%
NO_BRAKING = [("keep left", 2), "keep right", "keep left", ("keep right", 3), "keep left"]
NO_BRAKING += [("accelerate straight", 5)]
direct = bc.record(bc.plan_policy(NO_BRAKING), [7], label="plan")[0]
bc.show(bc.top_view_over_time(direct, times=[0, 2, 4, 6, 9, bc.overtaken(direct)]))

# %% [markdown]
# **See.** These {{ len(NO_BRAKING) }} decisions take the car behind trap 2 and on to the left lane,
# and none of them brakes. The same list gets out on
# {{ 100 * without_braking()[1].mean() | .0f }} % of {{ roads() }} other roads: on all of those
# where trap 2 starts 4.85 m ahead or more, and on few of the others. On road {{ ROAD }} it starts
# {{ idle().states[0, TRAP_2, X] | .2f }} m ahead, so there the car has to fall back first.
# <!-- claim: not any(ACTION_NAMES[action].startswith('brake') for action in NO_BRAKING) -->
# <!-- claim: without_braking()[1][without_braking()[0] >= 4.85].all() -->
# <!-- claim: without_braking()[1][without_braking()[0] < 4.85].mean() < 0.1 -->
#
# **Explain.** Falling back takes patience, the direct way takes precision: an agent that tries
# actions at random would have to draw these eight turns of the wheel in this order, or others as
# exact. Both ways are hard to find by chance. That makes this road a trap for a learner.

# %% [markdown]
# ## Round 2: what you see
#
# A driver that learns does not get a picture. It gets {{ DEFAULT.observation_size }} numbers, the
# **observation**: six about itself, then five about each of the four nearest cars within
# {{ DEFAULT.sight.distance }} m. A missing car is five zeros. Each number is divided by a fixed
# scale, so that all are of order one. Multiply by the scale, and you have metres and metres per
# second.
# <!-- claim: sum(not name.startswith('car') for name in observation.names(DEFAULT)) == 6 -->
# <!-- claim: sum(name.startswith('car 1') for name in observation.names(DEFAULT)) == 5 -->
# <!-- claim: DEFAULT.sight.neighbours == 4 -->

# %%
env = gym.make("bootcourse:Trap-v0")
seen, info = env.reset(seed=ROAD)
names, scales = observation.names(bc.DEFAULT), observation.scales(bc.DEFAULT)
rows = zip(names, seen, scales, strict=True)
for name, number, scale in list(rows)[:16]:
    print(f"{name:15} {number:7.3f}  x {scale:6.0f}  = {number * scale:7.2f}")

# %% [markdown]
# > **Predict.** `car 1` is the nearest car. Which one is it, trap 1 or trap 2? And which sign has
# > its `dy`, if y grows to the *right*?

# %%
start = idle.states[0]
trap_1, trap_2 = start[[bc.state.TRAP_1, bc.state.TRAP_2], bc.state.X]
print(f"trap 1 is {trap_1:.2f} m ahead, trap 2 {trap_2:.2f} m")

# %% [markdown]
# **See.** The nearest is trap 2, and its `dy` is
# {{ idle().states[0, TRAP_2, Y] - idle().states[0, EGO, Y] }} m: one lane to the left.
#
# In a *Markov decision process* (MDP), what comes next and what it pays depends on the present
# **state** and the action alone. The road is such a process. Its state holds the place, speed and
# heading of all {{ DEFAULT.vehicles }} cars, the lane that each of them wants, how long ago it last
# considered a lane change, and the number of the second. The observation is *not* the state. It
# leaves out every car but the four nearest, the lanes that they want, and the seconds that are
# left. Two moments with the same observation can therefore go on differently: such a world is a
# *partially observed* MDP. The learners of this course, like the paper's, treat the observation as
# if it were the state. The rule of lesson 3 reads the true places and speeds of the cars.
# <!-- claim: DEFAULT.vehicles - 1 > DEFAULT.sight.neighbours == 4 -->
# <!-- claim: not any('lane' in name or 'time' in name for name in observation.names(DEFAULT)) -->
#
# A **policy** turns an observation into an action, or into a probability for each of the nine.

# %% [markdown] tags=["instructor"] minutes=6
# Ask what is missing from the {{ DEFAULT.observation_size }} numbers before they read on: how long
# ago a car considered a lane change, the traffic beyond {{ DEFAULT.sight.distance }} m or beyond
# the fourth car, the seconds that are left. Then ask which of these would change what *they* do.

# %% [markdown]
# ## Round 3: what you are paid for
#
# Every second pays a weighted mean of three terms:
#
# $$ r = \frac{w_v r_v + w_y r_y + w_\theta r_\theta}{w_v + w_y + w_\theta}, \qquad w_v =
# {{ DEFAULT.reward.w_v }},\; w_y = w_\theta = {{ DEFAULT.reward.w_y }} $$
#
# - $r_v$ pays for speed, see below;
# - $r_y = \exp(-{{ -math.log(centring_reward(1.0)) }}\, d_e^2)$ pays for the middle of the lane
#   ($d_e$ metres off it);
# - $r_\theta = -|\sin\theta|$ charges for steering.

# %%
bc.show(figures.reward_curve())

# %% [markdown]
# **See.** Speed pays little up to 12.5 m/s, a lot more from there to 15, and next to nothing from
# 17 on. At the traps' {{ DEFAULT.traps.speed }} m/s the speed term is
# {{ speed_reward(DEFAULT.traps.speed) | .2f }}; at 15 m/s, on a free road, it is 1.
# <!-- claim: speed_reward(12.5) < 0.25 and speed_reward(15) == 1 and speed_reward(17) < 0.02 -->
#
# $$ r_v = \begin{cases} \exp(-(v - 15)^2) & v > 15 \\ \frac{8}{25} v - \frac{19}{5} & 12.5 < v \le
# 15 \\ \frac{2}{75} v - \frac{2}{15} & 5 < v \le 12.5 \\ 0 & v \le 5 \end{cases} $$
# <!-- claim: all(math.isclose(speed_reward(v), r) for v, r in {16: math.exp(-(16 - 15) ** 2), 15: 8
#   / 25 * 15 - 19 / 5, 12.6: 8 / 25 * 12.6 - 19 / 5, 12.5: 2 / 75 * 12.5 - 2 / 15, 5.1: 2 / 75 *
#   5.1 - 2 / 15, 5: 0}.items()) -->
#
# **Exercise 1.2 (6 min, ●○○).** Write it.


# %%
def speed_reward(v_lon):
    """r_v at a speed along the road (m/s), a number; no unit."""
    # solution
    if v_lon > 15:
        return np.exp(-((v_lon - 15) ** 2))
    if v_lon > 12.5:
        return 8 / 25 * v_lon - 19 / 5
    if v_lon > 5:
        return 2 / 75 * v_lon - 2 / 15
    return 0.0
    # end solution


check.speed_reward(speed_reward)

# %% [markdown]
# **Exercise 1.3 (6 min, ●○○).** Now the whole reward of one second. The three terms are in
# `bootcourse.road.formulas`. An accident (1 collision, 2 road departure, 3 stoppage; 0 none) pays
# {{ DEFAULT.reward.accident }} and nothing else.
# <!-- claim: (Accident.COLLISION, Accident.ROAD_DEPARTURE, Accident.STOPPAGE, Accident.NONE) == (1,
#   2, 3, 0) -->


# %%
def reward(v_lon, offset, theta, accident):
    """r(s, a), a number. v_lon in m/s, offset d_e in m, theta in rad, accident 0 to 3."""
    # solution
    if accident:
        return -10.0
    r_v = formulas.speed_reward(v_lon)
    r_y = formulas.centring_reward(offset)
    r_theta = formulas.steering_reward(theta)
    return (1.5 * r_v + 0.05 * r_y + 0.05 * r_theta) / (1.5 + 0.05 + 0.05)
    # end solution


check.reward(reward)

# %% [markdown]
# > **Predict.** You do nothing at all for 150 s: 10 m/s, centred, no steering. What do you earn
# > in one second? In 150? Pen and paper, before you write the function.
#
# The sum of an episode's rewards is its **return**.
#
# **Exercise 1.4 (6 min, ●○○).** What does doing nothing earn, behind traps of some speed, in some
# seconds?


# %%
def idle_return(speed, seconds):
    """The return of driving centred and straight: speed in m/s, 5 < speed <= 12.5; a number."""
    # solution
    r_v, r_y, r_theta = 2 / 75 * speed - 2 / 15, 1.0, 0.0
    return seconds * (1.5 * r_v + 0.05 * r_y + 0.05 * r_theta) / 1.6
    # end solution


check.idle_return(idle_return)

# %% [markdown]
# Now let the road say it.

# %%
# NBVAL_CHECK_OUTPUT
print(f"return {idle.rewards.sum():.4f}, distance {idle.distance:.0f} m, success {idle.success}")

# %% [markdown]
# %%
# NBVAL_CHECK_OUTPUT
r_v, r_y = formulas.speed_reward(10.0), formulas.centring_reward(0.0)
each = formulas.weighted_reward(r_v, r_y, 0.0, 1.5, 0.05, 0.05)
print(f"(1.5 · {r_v:.4f} + 0.05 · {r_y:.0f}) / 1.6 = {each:.5f}, in 150 s {150 * each:.4f}")
print(f"an accident costs what {10 / each:.0f} s of doing nothing earn")
free = formulas.weighted_reward(1.0, 1.0, 0.0, 1.5, 0.05, 0.05)
print(f"a free road at 15 m/s: {free:.5f} a second, {150 * free:.1f} in 150 s")

# %% [markdown]
# **Explain.** Your calculation, the formula and the road agree. Remember
# {{ idle().rewards.sum() | .1f }}: a learner that ends there has learned to stay where it is. Doing
# nothing is a *fixed point*: each second is like the one before, and each pays a little.
# <!-- claim: np.ptp(idle().rewards) < 1e-9 and idle().rewards.min() > 0 -->

# %% [markdown] tags=["instructor"] minutes=6
# Let two or three read their number for one second aloud before the cell is run.
# {{ (1.5 * speed_reward(10) + 0.05) / 1.55 | .3f }} means that the third weight was left out of the
# mean, {{ 1.5 * speed_reward(10) + 0.05 }} that nothing was divided.

# %% [markdown]
# ## Round 4: why it is a trap
#
# > **Predict.** Compare the escape with doing nothing, second by second. For how long does the
# > escape earn *less* in total: 10 s, 30 s or 60 s?

# %%
bc.show(bc.traces([idle, escape]))

# %%
behind = np.cumsum(escape.rewards) < np.cumsum(idle.rewards)
last_behind = int(np.flatnonzero(behind)[-1]) + 1
ahead = escape.rewards.sum() - idle.rewards.sum()
print(f"the escape is behind until second {last_behind}; at the end it is {ahead:.1f} ahead")
print(f"deepest: {np.min(np.cumsum(escape.rewards) - np.cumsum(idle.rewards)):.2f}")

# %% [markdown]
# So this way out costs little. Why is it hard to find, then?
#
# > **Predict.** A driver picks each action at random. In what share of 1,000 episodes does it get
# > out? In what share does it survive?

# %%
# NBVAL_CHECK_OUTPUT
episodes = bc.drive_episodes(bc.random_policy(np.random.default_rng(0)), bc.held_out_seeds(1, 1000))
print(f"ahead of trap 1 at the end: {100 * episodes.success.mean():.1f} %")
print(f"no accident in 150 s:       {100 * np.mean(episodes.accident == 0):.1f} %")
print(f"mean return:                {episodes.returns.mean():.2f}")
lanes = escape.states[:: bc.DEFAULT.clock.steps, bc.state.EGO, bc.state.LANE]  # each second
free_from = int(np.flatnonzero(lanes == 0)[0])
print(f"on road {ROAD} the escape takes {free_from} decisions to reach the free lane")

# %% [markdown]
# **Explain.** A learner begins with random tries and improves in small steps. All of these 1,000
# random drives end in an accident, which pays {{ DEFAULT.reward.accident }}, and about one in two
# hundred is ahead of trap 1 when it does. A learner that has seen such drives has good reason to
# stay where it is. The escape needs several right decisions in a row, and pays later. The rest of
# this course is about that problem.

# %% [markdown]
# ## Round 5: success, and what goes wrong
#
# **Success** has a definition: the ego is ahead of trap 1 at the end of its episode. A crash
# after overtaking still counts as success, and is counted again as an accident.
#
# > **Predict.** A driver overtakes trap 1, drives on for a minute and then hits a car. Is that a
# > success, an accident, or both?
#
# **Exercise 1.5 (5 min, ●○○).** Summarise some episodes: the share that succeeds, and the share
# that ends in each kind of accident.


# %%
def outcome_rates(x_ego, x_trap_1, accident):
    """Shares of success, collision (1), road departure (2) and stoppage (3): arrays (n,) -> (4,).

    Places in m at the end of each episode; accident is 0 where there was none.
    """
    # solution
    success = np.mean(x_ego > x_trap_1)
    kinds = [np.mean(accident == kind) for kind in (1, 2, 3)]
    return np.array([success, *kinds])
    # end solution


check.outcome_rates(outcome_rates)

# %%
by_chance = bc.random_policy(np.random.default_rng(0))
drivers = {"idle": bc.idle_policy, "rule": bc.rule_policy(bc.DEFAULT), "random": by_chance}
for name, driver in drivers.items():
    drives = bc.record(driver, range(100))
    ahead = np.mean([drive.success for drive in drives])
    kinds = [sum(drive.accident == kind for drive in drives) for kind in bc.Accident]
    counted = ", ".join(f"{n} {k.name.lower()}" for n, k in zip(kinds, bc.Accident, strict=True))
    print(f"{name:7} success {100 * ahead:5.1f} %   of 100 episodes: {counted}")

# %% [markdown]
# **Explain.** In these 100 episodes the idle driver has no accident and no success. The random
# driver has no success either, and each of its episodes ends in an accident. The rule succeeds each
# time without an accident. So ask two questions about a driver: how often does it have an accident,
# and how often does it succeed?

# %% [markdown]
# ## What you now know
#
# 1. Once a second for {{ DEFAULT.clock.decisions / DEFAULT.clock.decision_rate }} s, a driver sees
#    {{ DEFAULT.observation_size }} numbers and takes one of nine actions. The numbers are an
#    observation: they do not hold the whole state of the road.
# 2. Speed pays most near {{ max(np.arange(0, 25, 0.5), key=speed_reward) }} m/s; accidents pay
#    {{ DEFAULT.reward.accident }} and end the episode.
# 3. Doing nothing for the whole episode earns {{ idle().rewards.sum() }} over
#    {{ idle().distance }} m, and ends behind trap 1.
# <!-- claim: not idle().success -->
# 4. The way out leads left behind trap 2. Where trap 2 starts far enough ahead, exact steering is
#    enough; elsewhere the car has to fall back first.
# 5. The escape pays off late, and one accident costs what about a minute of doing nothing earns.
# <!-- claim: 50 < -DEFAULT.reward.accident / second_pays(DEFAULT.traps.speed) < 70 -->
#
# **Three questions to think about**
# - Would the trap still be one if trap 2 drove 0.5 m/s faster than you?
# - Which reward would you change so that a learner leaves at once? What else would that learner
#   then do?
# - The observation holds nothing of the past. Which two situations on this road give the same
#   observation, but call for different actions?
#
# **Read on**: the next lesson is about the other cars, and
# [the one after it](03_the_rule.ipynb) explains the controller that found the way out.
# highway-env, the simulator under this road: Leurent, *An Environment for Autonomous Driving
# Decision-Making* (2018). MDPs from the beginning: Sutton and Barto, *Reinforcement Learning*
# (2nd edition, 2018), chapter 3.
