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
# # The trap
#
# **What you will be able to do**
# - say what a driver sees, what it can do and what it is paid for, and watch a program learn to
#   drive;
# - work out by hand what doing nothing earns, and check it on the road;
# - explain when an attempt to leave pays, and say on one page what SAC is made of.
#
# **Time** 75 minutes, about one of them the machine's. **It builds on** Python. You need not know
# reinforcement learning.

# %%
import bootcourse as bc
import gymnasium as gym
import numpy as np
from bootcourse.course import charts, check, compare_predictions, live_curves, predict, table
from bootcourse.course.lessons.the_trap import figures
from bootcourse.plots import diagrams
from bootcourse.road import formulas, observation

# %% [markdown]
# ## Look first
#
# You drive the car that is labelled **ego**, at {{ DEFAULT.ego.speed }} m/s. Two dark red cars box
# you in: **trap 1** is ahead in your lane, **trap 2** is in the next lane. Both drive
# {{ DEFAULT.traps.speed }} m/s, too. The left lane is free. Everything else (grey) is traffic that
# drives up to {{ DEFAULT.traffic.desired_speed }} m/s.

# %%
ROAD = 10  # the seed: which road you get
idle = bc.record(bc.idle_policy, [ROAD], label="idle")[0]
bc.show(bc.top_view(idle, time=0, distances=True))

# %% [markdown]
# > **Predict.** You may brake, keep your speed or accelerate, and steer left, straight or right.
# > How would you get to the free lane? Write a plan before you go on: how many seconds of what?

# %%
predict("the_trap.1", "Your plan: how many seconds of what?")

# %% [markdown]
# > **Predict.** A controller knows a way out of this trap. What does it do in the first second?

# %%
predict(
    "the_trap.2",
    "What does the controller do in the first second?",
    ["accelerate", "steer", "brake"],
)

# %% [markdown]
# ## Round 1: drive it
#
# Drive first, and think afterwards. In JupyterLab the panel below has nine buttons; click on the
# pad once and the arrow keys work, too. You decide once a second, and the road waits for you. The
# faint car is a **ghost**: it shows how the rule of lesson [[the_rule]] drives the same road.

# %% tags=["nbval-ignore-output"]
bc.panels.drive_panel(seed=ROAD)

# %% [markdown] tags=["instructor"] minutes=8
# Let them crash. Expect them to steer left at once and hit trap 2; next they accelerate. Collect
# on the board what ended each attempt and after how many seconds, and ask who still has a plan.
# They need not succeed here.

# %% [markdown]
# The nine buttons are the nine **actions**. Each combines an acceleration of
# {{ -DEFAULT.ego.acceleration }}, 0 or +{{ DEFAULT.ego.acceleration }} m/s² with a steering angle
# of −π/{{ math.pi / DEFAULT.ego.steering }}, 0 or +π/{{ math.pi / DEFAULT.ego.steering }} rad, and
# is held for one second. A program knows them by their numbers, 0 to {{ N_ACTIONS - 1 }}.
# <!-- claim: N_ACTIONS == 9 -->

# %% tags=["hide-input"]
rows = [
    [f"**{row}**", *(f"{n}: {bc.ACTION_NAMES[n]}" for n in n_s)]
    for row, n_s in (("brake", (0, 1, 2)), ("keep", (3, 4, 5)), ("accelerate", (6, 7, 8)))
]
bc.show(figures.nine_actions(seconds=2))
table(["", "left", "straight", "right"], rows)

# %% [markdown]
# **See.** Two seconds of steering bring you more than half of the way into the next lane, and
# leave the car turned. That is a coarse way to drive: every lane change needs a turn and a turn
# back.
# <!-- claim: np.ptp(record(plan_policy([('keep left', 2)]), [ROAD])[0].states[[0, 4], EGO, Y]) >
#   DEFAULT.road.lane_width / 2 -->
#
# **Exercise (5 min, ●○○).** Turn action numbers into what the car does. The middle action,
# {{ ACTION_NAMES.index('keep straight') }}, is "keep straight"; y grows to the *right*, so steering
# left is negative.


# %%
def decode(actions):
    """Acceleration (m/s²) and steering (rad) of each action: whole numbers (n,) -> (n, 2)."""
    # solution: the exercise's own


check.decode(decode)

# %% [markdown]
# You can also write a plan: a list of actions in words, each with its number of seconds. When the
# plan ends, the car keeps its speed and its direction.

# %%
my_plan = [("keep left", 2), ("keep right", 2)]  # change it, and run the cell again

mine = bc.record(bc.plan_policy(my_plan), [ROAD], label="you")[0]
bc.show(bc.top_view_over_time(mine, times=[0, 1, 2, 3]))

# %% [markdown]
# **See.** "Go left now" is a natural first idea. On this road you hit trap 2, which starts
# {{ idle().states[0, TRAP_2, X] | .2f }} m ahead of you from centre to centre: less than a car's
# length.
# <!-- claim: idle().states[0, TRAP_2, X] < DEFAULT.car.length -->
# <!-- claim: record(plan_policy([('keep left', 2), ('keep right', 2)]), [ROAD])[0].accident ==
#   Accident.COLLISION -->
#
# A drive of at most {{ DEFAULT.clock.decisions / DEFAULT.clock.decision_rate }} s is an
# **episode**. Three kinds of accident end it at once, and each pays {{ DEFAULT.reward.accident }}.
# <!-- claim: len(KINDS) == 3 -->

# %%
bad_plans = {
    "accelerate at trap 1": [("accelerate straight", 6)],
    "steer off the road": [("keep right", 3)],
    "brake to a stop": [("brake straight", 12)],
}
rows = []
for name, plan in bad_plans.items():
    drive = bc.record(bc.plan_policy(plan), [ROAD])[0]
    ending = bc.Accident(drive.accident).name.lower().replace("_", " ")
    rows.append([name, ending, f"{drive.times[-1]:.1f} s"])
table(["plan", "ends with", "after"], rows)

# %% [markdown]
# The paper reports one "collision rate" that includes the other two kinds. We keep the three apart:
# a driver that stops on the motorway and one that hits a car have learned different things.
#
# Here is the controller's way out on this road. We call the controller the **rule**; lesson
# [[the_rule]] takes it apart.

# %%
escape = bc.record(bc.rule_policy(bc.DEFAULT), [ROAD], label="rule")[0]
bc.show(bc.top_view_over_time(escape, times=[0, 3, 6, 9, 20, bc.overtaken(escape)]))
table(
    ["for", "it does"],
    [[f"{n} s", words] for words, n in bc.policies.in_words(escape.actions[:15])],
)

# %% [markdown]
# **Explain.** This way out leads *backwards*. The car falls behind both traps, changes left behind
# trap 2, changes left again, and is free. It gives up speed now to gain speed later.
#
# > **Predict.** Trap 2 starts {{ DEFAULT.traps.d2[0] }} to {{ DEFAULT.traps.d2[1] }} m ahead, one
# > lane to your left. Could you also change lane behind it *without* braking? On every road?

# %%
choices = ["on no road", "on some roads", "on every road"]
predict("the_trap.3", "Where can you change lane behind trap 2 without braking?", choices)

# %% [markdown]
# <details><summary>Answer</summary>
#
# On some. There is a list of {{ len(NO_BRAKING) }} decisions without any braking that takes the car
# behind trap 2 and on to the left lane. It gets out on
# {{ 100 * without_braking()[1].mean() | .0f }} % of {{ roads() | , }} other roads: where trap 2
# starts far enough ahead. In lesson [[the_rule]] you look for it yourself. On road {{ ROAD }} that
# list does not work: trap 2 starts {{ idle().states[0, TRAP_2, X] | .2f }} m ahead there.
# <!-- claim: not any(ACTION_NAMES[action].startswith('brake') for action in NO_BRAKING) -->
# <!-- claim: without_braking()[0][without_braking()[1]].mean() >
#   without_braking()[0][~without_braking()[1]].mean() -->
# <!-- claim: not record(plan_policy([ACTION_NAMES[a] for a in NO_BRAKING]), [ROAD])[0].success -->
#
# You can see the beginning: set `ROAD = 7` in the second code cell, where trap 2 starts further
# ahead, and drive the plan above again. It ends behind trap 2, at the same 10 m/s.
# <!-- claim: idle().states[0, TRAP_2, X] < idle(7).states[0, TRAP_2, X] -->
# <!-- claim: record(plan_policy([('keep left', 2), ('keep right', 2)]), [7])[0].states[-1, EGO,
#   SPEED] == 10 -->
#
# Falling back costs speed for some seconds. The direct way costs none, but the same plan that gets
# out on one road fails on another.
#
# </details>

# %% [markdown]
# ## Round 2: watch a program learn
#
# A program can learn to drive by trying. Once a second it gets an **observation**, numbers that
# describe what it sees. It chooses one of the nine actions. A second later it gets a **reward**,
# one number: a little for speed, {{ DEFAULT.reward.accident }} for an accident. Then the next
# second begins. Such a program is called an *agent*.

# %%
bc.show(diagrams.agent_loop(observation="26 numbers", action="one of nine", reward="one number"))

# %% [markdown]
# The agent chooses by its **policy**: a function that gives each action a probability. At first
# the nine are about equally probable, and the agent drives at random. To *learn* means: the agent
# remembers what it tried and what that paid, and changes the numbers inside its policy a little,
# many times, so that actions with better consequences become more probable. Each such change is an
# **update**. The agent is not told what a lane is. Learning from rewards in this way is
# *reinforcement learning*.
#
# Below, four agents learn for about 20 seconds. Two learn alone (*plain SAC*). Two get help from
# the rule that you have just seen (*bootstrapped SAC*): they see some of its drives, and pay a
# little for actions that the rule would hardly take.

# %% tags=["nbval-ignore-output"]
agents = bc.with_seeds(bc.settings_for("sac"), 2) + bc.with_seeds(
    bc.settings_for("bootstrapped"), 2
)
training = bc.Training(agents, episodes=5000)
beginner = training.agent(2).as_policy()
live = live_curves.LiveCurves(every=2)
learned = training.run(progress=False, callback=live, stop=lambda: training.updates >= 1500)

# %% [markdown]
# Each thin line is one agent. *Success* is the share of its episodes that end ahead of trap 1. The
# **return** is the sum of an episode's rewards; an episode that ends in a crash in the first
# seconds returns about −9.5. Now the first agent with help, before and after its training:

# %% tags=["nbval-ignore-output"]
before = bc.record(beginner, [ROAD], label="bootstrapped")[0]
after = bc.record(learned.agents[2].as_policy(), [ROAD], label="bootstrapped")[0]
bc.show(bc.top_view_over_time(before, title="Before: its first drive"))
bc.show(bc.top_view_over_time(after, title=f"After {training.updates:,} updates"))

# %% [markdown]
# **See.** Your curves will differ from those that were saved here, and from your neighbour's. Which
# lines have risen from −9.5? Which agents have success? An agent whose return
# has risen without success has learned to stay alive behind the traps.
#
# One short training of two agents says little. In our study {{ len(of('sac')) }} agents of each
# kind learned, each on {{ of('sac').curves['success'].shape[1] | , }} roads. Then each drove
# {{ roads() | , }} other roads. We say that an agent *escapes* if it succeeds on at least
# {{ 100 * ESCAPES | .0f }} % of these. Of the agents that learned alone, {{ escaped('sac') }} of
# {{ len(of('sac')) }} escapes; of those with help, {{ escaped('bootstrapped') }} of {{
# len(of('bootstrapped')) }} escape. The rest of this lesson explains what they see and what they
# are paid for. The rest of the course explains the difference.

# %% [markdown] tags=["instructor"] minutes=10
# Draw the loop on the board while the curves grow, and let somebody read the live curve aloud. Most
# will say that the agents alone "do not learn". Ask what their return says. If the training is slow
# on the projector's machine, the saved picture tells the same story.

# %% [markdown]
# ## Round 3: what you see
#
# An agent does not get a picture. Its observation is {{ DEFAULT.observation_size }} numbers: six
# about itself, then five about each of the four nearest cars within {{ DEFAULT.sight.distance }} m.
# A missing car is five zeros. Each number is divided by a fixed scale, so that it is of order one.
# Multiply by the scale, and you have metres and metres per second.
#
# `presence` is 1 for a car that is there. `x` is the ego's place along the road and `y` its place
# across: y is 0 in the middle of the left lane and grows to the *right*. `v_lon` and `v_lat` are
# its speeds along and across the road, and `d_e` is how far it is off the middle of its lane. `dx`,
# `dy`, `dv_lon` and `dv_lat` are places and speeds of another car, measured from the ego.
# <!-- claim: sum(not name.startswith('car') for name in observation.names(DEFAULT)) == 6 -->
# <!-- claim: sum(name.startswith('car 1') for name in observation.names(DEFAULT)) == 5 -->
# <!-- claim: DEFAULT.sight.neighbours == 4 -->
#
# > **Predict.** `car 1` is the nearest car. Which car is that, and is its `dy` positive, negative
# > or zero?

# %%
choices = ["trap 1, and dy is 0", "trap 2, and dy is positive", "trap 2, and dy is negative"]
predict("the_trap.4", "Which car is `car 1`, and what is its dy?", choices)

# %%
env = gym.make("bootcourse:Trap-v0")
seen, info = env.reset(seed=ROAD)
names, scales = observation.names(bc.DEFAULT), observation.scales(bc.DEFAULT)
each = list(zip(names, seen, scales, strict=True))[:16]
rows = [
    [name, f"{number:.3f}", f"{scale:g}", f"{number * scale:.2f}"] for name, number, scale in each
]
table(["number", "observed", "scale", "in m, m/s"], rows, below="(the first 16 of 26)")

# %% [markdown]
# **See.** The nearest is trap 2, and its `dy` is
# {{ idle().states[0, TRAP_2, Y] - idle().states[0, EGO, Y] }} m: one lane to the left.
#
# In a *Markov decision process* (MDP), the next **state** and the reward depend on the present
# state and the action alone. The road is such a process. Its state holds the place, speed and
# heading of all {{ DEFAULT.vehicles }} cars, the lane that each of them wants, how long ago it last
# considered a lane change, and the number of the second.
# <!-- claim: DEFAULT.vehicles == 9 -->
#
# The observation is *not* the state. It leaves out the cars beyond the four nearest, the lanes that
# the cars want, and the seconds that are left. Two moments with the same observation can therefore
# go on differently: such a world is a *partially observed* MDP. The learners of this course, like
# the paper's, treat the observation as if it were the state. The rule of lesson [[the_rule]] reads
# the true places and speeds of the cars.
# <!-- claim: DEFAULT.vehicles - 1 > DEFAULT.sight.neighbours == 4 -->
# <!-- claim: not any('lane' in name or 'time' in name for name in observation.names(DEFAULT)) -->

# %% [markdown] tags=["instructor"] minutes=6
# Ask what is missing from the {{ DEFAULT.observation_size }} numbers before they read on: how long
# ago a car considered a lane change, the traffic beyond {{ DEFAULT.sight.distance }} m or beyond
# the fourth car, the seconds that are left. Then ask which of these would change what *they* do.

# %% [markdown]
# ## Round 4: what you are paid for
#
# A second without an accident pays a weighted mean of three terms:
#
# $$ r = \frac{w_v r_v + w_y r_y + w_\theta r_\theta}{w_v + w_y + w_\theta}, \qquad w_v =
# {{ DEFAULT.reward.w_v }},\; w_y = w_\theta = {{ DEFAULT.reward.w_y }} $$
#
# - $r_v$ pays for speed, see below;
# - $r_y = \exp(-{{ -math.log(centring_reward(1.0)) }}\, d_e^2)$ pays for the middle of the lane
#   ($d_e$ metres off it);
# - $r_\theta = -|\sin\theta|$ charges for steering by an angle $\theta$.

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
# The two cases in the middle are straight lines through (5, 0), (12.5, 0.2) and (15, 1): from 10 to
# 12.5 m/s the speed term grows a little, from 12.5 to 15 m/s it becomes five times as large.
# <!-- claim: math.isclose(speed_reward(15), 5 * speed_reward(12.5)) -->
#
# **Exercise (6 min, ●○○).** Write the whole reward of one second. The three terms are in
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
# > in one second? In 150? Use pen and paper, before you write the function.

# %%
predict("the_trap.5", "What does doing nothing earn in 150 s?", unit="")

# %% [markdown]
# **Exercise (6 min, ●○○).** Write the return of doing nothing: a car drives straight for some
# seconds at one speed, in the middle of its lane.


# %%
def idle_return(speed, seconds):
    """The return of driving centred and straight: speed in m/s, 5 < speed <= 12.5; a number."""
    # solution: the exercise's own


check.idle_return(idle_return)

# %% [markdown]
# And this is what doing nothing earned on road {{ ROAD }}:

# %%
# NBVAL_CHECK_OUTPUT
print(f"return {idle.rewards.sum():.4f}, distance {idle.distance:.0f} m, success {idle.success}")

# %% [markdown]
# <details><summary>The calculation</summary>
#
# At 10 m/s the speed term is 2/75 · 10 − 2/15 = {{ speed_reward(10.0) | .4f }}. The car is centred,
# so $r_y$ = 1, and does not steer, so $r_\theta$ = 0. One second pays (1.5 · {{ speed_reward(10.0)
# | .4f }} + 0.05 · 1) / 1.6 = {{ second_pays(10) | .5f }}, and 150 seconds pay {{ 150 *
# second_pays(10) | .4f }}. An accident costs what {{ -DEFAULT.reward.accident / second_pays(10) |
# .0f }} s of doing nothing earn. On a free road at 15 m/s a second pays {{ second_pays(15) | .5f
# }}, so 150 s pay {{ 150 * second_pays(15) | .0f }}.
#
# </details>
#
# **Explain.** Your calculation, the formula and the road agree. Remember
# {{ idle().rewards.sum() | .1f }}: a learner that ends there has learned to stay where it is. Doing
# nothing is a *fixed point*: each second is like the one before, and it pays a little.
# <!-- claim: np.ptp(idle().rewards) < 1e-9 and idle().rewards.min() > 0 -->

# %% [markdown] tags=["instructor"] minutes=6
# Let two or three read their number for one second aloud before the cell is run.
# {{ (1.5 * speed_reward(10) + 0.05) / 1.55 | .3f }} means that the third weight was left out of the
# mean, {{ 1.5 * speed_reward(10) + 0.05 }} that nothing was divided.

# %% [markdown]
# ## Round 5: why it is a trap
#
# > **Predict.** Add up the rewards of the rule's escape, second by second, and those of doing
# > nothing. For how long is the escape's sum the smaller one?

# %%
choices = ["about 10 s", "about 35 s", "about 60 s", "about 100 s"]
predict("the_trap.6", "For how long has the escape earned less than doing nothing?", choices)

# %%
lead = np.cumsum(escape.rewards) - np.cumsum(idle.rewards)
title = "The escape falls behind first, and earns more later"
words = "return so far, less that of doing nothing"
marks = {"doing nothing": 0.0}
bc.show(charts.lines(np.arange(1, 151), {"rule": lead}, title, "time (s)", words, marks=marks))

# %% tags=["hide-input"]
behind = np.cumsum(escape.rewards) < np.cumsum(idle.rewards)
last_behind = int(np.flatnonzero(behind)[-1]) + 1
ahead = escape.rewards.sum() - idle.rewards.sum()
deepest = np.min(np.cumsum(escape.rewards) - np.cumsum(idle.rewards))
rows = [["until second", f"{last_behind}"], ["at most by", f"{-deepest:.2f}"]]
table(["the escape is behind", ""], rows, below=f"At the end of the 150 s it is {ahead:.1f} ahead.")

# %% [markdown]
# So this way out costs little. Why is it hard to find, then?
#
# > **Predict.** A driver picks each action at random. In what share of 1,000 episodes does it end
# > ahead of trap 1?

# %%
choices = ["about 1 in 200", "about 1 in 50", "about 1 in 10"]
predict("the_trap.7", "How often does a random driver end ahead of trap 1?", choices)

# %%
# NBVAL_CHECK_OUTPUT
episodes = bc.drive_episodes(bc.random_policy(np.random.default_rng(0)), bc.held_out_seeds(1, 1000))
lanes = escape.states[:: bc.DEFAULT.clock.steps, bc.state.EGO, bc.state.LANE]  # each second
rows = [
    ["ends ahead of trap 1", f"{100 * episodes.success.mean():.1f} % of the drives"],
    ["survives 150 s", f"{100 * np.mean(episodes.accident == 0):.1f} % of the drives"],
    ["mean return", f"{episodes.returns.mean():.2f}"],
]
first = np.flatnonzero(lanes == 0)[0]
below = f"The rule, on road {ROAD}, reaches the free lane after {first} decisions."
table(["", "random driver, 1,000 roads"], rows, below)

# %% [markdown]
# **Explain.** A learner begins with random actions and improves in small steps. Each of these 1,000
# random drives ends in an accident, and about one in two hundred is ahead of trap 1 by then. They
# are random for as long as they last, and later attempts are better than that. How often may an
# attempt crash and still pay on average?
# <!-- claim: drive_episodes(random_policy(np.random.default_rng(0)), held_out_seeds(1,
#   1000)).accident.all() -->
# <!-- claim: 0.003 < drive_episodes(random_policy(np.random.default_rng(0)), held_out_seeds(1,
#   1000)).success.mean() < 0.007 -->
#
# **Exercise (8 min, ●●○).** A driver that stays behind the traps earns the return `stay`. An
# attempt to escape ends in an accident with probability q, and then returns `crash`; otherwise it
# returns `escape`, which is more than `crash`. What is the largest q at which an attempt returns,
# on average, at least as much as staying?


# %%
def bearable_risk(stay, escape, crash):
    """The largest q from 0 to 1, and 0 if even a safe escape returns less than `stay`."""
    # solution: the exercise's own


check.bearable_risk(bearable_risk)

# %% [markdown]
# The agents of Round 2 do not add up all rewards alike. They **discount** them: a reward t seconds
# later counts γᵗ as much, and the paper's γ ("gamma") is {{ SETTINGS.gamma }}. What an attempt may
# risk depends on that. Here it is for an attempt that drives like the rule unless it crashes after
# 3 s; the last column is the answer of your exercise:

# %% tags=["hide-input"]
rows = []
for gamma in (1.0, 0.95, 0.8):
    stay, leave = (gamma ** np.arange(150) @ drive.rewards for drive in (idle, escape))
    crash = gamma ** np.arange(4) @ [*idle.rewards[:3], -10]
    risk = max(0.0, (leave - stay) / (leave - crash))
    rows.append([gamma, *(f"{value:.2f}" for value in (stay, leave, crash)), f"{risk:.0%}"])
headings = ["γ", "staying", "the rule's escape", "a crash after 3 s", "may crash in"]
table(headings, rows, below=f"Discounted sums from the start, road {ROAD}.")

# %% [markdown]
# **Explain.** With γ = 1 such an attempt may crash in more than a third of the cases. At the
# agents' γ = {{ SETTINGS.gamma }} it does not pay even if it never crashes: on this road the rule's
# perfect escape is worth *less* than staying, since an attempt costs now and pays later. So an
# agent that stays is not stupid. Is there a way out that pays at γ = {{ SETTINGS.gamma }}, and what
# are an agent's own attempts worth? Lesson [[the_barrier]] measures both.
# <!-- claim: SETTINGS.gamma == 0.8 and discounted(by_rule(), 0.8) < discounted(idle(), 0.8) -->
# <!-- claim: 1 / 3 < (by_rule().rewards.sum() - idle().rewards.sum()) /
#   (by_rule().rewards.sum() + 9.5) < 1 / 2 -->

# %% [markdown] tags=["instructor"] minutes=7
# Let them argue about the exercise before the table is shown: "the agent is stupid" is a common
# first answer. Ask what would have to change: better attempts (a teacher), another reward, a larger
# γ, or an agent that judges an attempt by its best case.

# %% [markdown]
# ## Round 6: success, and what goes wrong
#
# > **Predict.** A driver overtakes trap 1, drives on for a minute and then hits a car. What does
# > the paper count: a success, an accident, or both?

# %%
choices = ["a success", "an accident", "both", "neither"]
predict("the_trap.8", "It overtakes trap 1 and crashes a minute later. What is that?", choices)

# %% [markdown]
# **Success** means: the ego is ahead of trap 1 when its episode ends. A crash after overtaking
# counts as a success, and as an accident as well.
#
# **Exercise (5 min, ●○○).** Summarise some episodes: the share that are a success, and the
# share that end in each kind of accident.


# %%
def outcome_rates(x_ego, x_trap_1, accident):
    """Shares of success, collision (1), road departure (2) and stoppage (3): arrays (n,) -> (4,).

    Places in m at the end of each episode; accident is 0 where there was none.
    """
    # solution: the exercise's own


check.outcome_rates(outcome_rates)

# %%
by_chance = bc.random_policy(np.random.default_rng(0))
drivers = {"idle": bc.idle_policy, "rule": bc.rule_policy(bc.DEFAULT), "random": by_chance}
rows = []
for name, driver in drivers.items():
    drives = bc.record(driver, range(100))
    kinds = [sum(drive.accident == kind for drive in drives) for kind in bc.Accident]
    rows.append([name, sum(drive.success for drive in drives), *kinds])
kinds = [kind.name.lower().replace("_", " ").replace("none", "no accident") for kind in bc.Accident]
table(["of 100 episodes", "success", *kinds], rows)

# %% [markdown]
# **Explain.** In these 100 episodes the idle driver is as safe as the rule, and does not get out
# once. The random driver neither gets out nor survives. So ask two questions about a driver: how
# often does it have an accident, and how often does it succeed?
# <!-- claim: all(d.accident == 0 and not d.success for d in record(idle_policy, range(100))) -->
# <!-- claim: all(d.accident == 0 and d.success for d in record(rule_policy(DEFAULT), range(100)))
#   -->

# %% [markdown]
# ## SAC on one page
#
# The agents that you watched learn by *soft actor-critic* (SAC). Lesson [[discrete_sac]] builds it
# part by part. If you skip that lesson, this page is enough to follow the others.

# %%
bc.show(diagrams.sac_diagram())

# %% [markdown]
# The diagram says *state* for what the agent observes. The *replay buffer* keeps what happened: a
# row for each second, with the observation s, the action a, the reward r and the next observation
# s′. After some seconds a *batch* of rows is drawn from it. The critics, the actor and the
# temperature learn from these rows:
#
# - A *critic* is a network that estimates, for each of the nine actions, the sum of the rewards
#   from here on, where later rewards count less. The estimate is called Q. There are two critics,
#   and the smaller estimate counts, since one that is too high by chance would mislead the agent.
# - A critic learns by comparing one second with the next. Its *target* y is the reward of the
#   second plus V(s′), what is expected from then on. V(s′) comes from the *target critics*, copies
#   that follow the critics slowly: at each update they move a small share τ of the way. So the
#   target stays nearly still while the critics learn.
# - The *actor* is a network that holds the policy, π. It raises the probability of actions with a
#   large Q.
# - The *temperature* α keeps the actor from choosing too early. The *entropy* of a policy says
#   how undecided it is: 0 if it is sure of one action, large if the nine actions are about equally
#   probable. SAC adds α times the entropy to what it maximises. Large α: the agent tries a lot.
#   Small α: it repeats what worked. Entropy is measured in *nats*, so α is the worth of a nat. SAC
#   adjusts α by itself.
#
# *Bootstrapped* SAC adds two aids, and both fade: some rows of each batch come from drives
# of the rule (lesson [[learning_from_demonstrations]]), and a weight ξ makes actions costly that
# the rule would hardly take (lesson [[soft_constraint]]).

# %% [markdown]
# ## What you now know
#
# 1. Once a second for {{ DEFAULT.clock.decisions / DEFAULT.clock.decision_rate }} s, a driver sees
#    {{ DEFAULT.observation_size }} numbers and takes one of nine actions. An agent learns from the
#    rewards that follow.
# 2. Speed pays most near {{ max(np.arange(0, 25, 0.5), key=speed_reward) }} m/s; accidents pay
#    {{ DEFAULT.reward.accident }} and end the episode.
# 3. Doing nothing for the whole episode earns {{ idle().rewards.sum() }} over
#    {{ idle().distance }} m, and ends behind trap 1.
# <!-- claim: not idle().success -->
# 4. The rule falls back and changes lane behind trap 2. On most roads there are plans that get out
#    without braking, too. (Lesson [[the_barrier]] shows a third way, between the traps.)
# <!-- claim: without_braking()[1].mean() > 0.5 -->
# 5. An attempt costs now and pays later: one accident costs what about a minute of doing nothing
#    earns. At γ = {{ SETTINGS.gamma }} even the rule's escape on road {{ ROAD }} is worth less than
#    staying.
# <!-- claim: discounted(by_rule(), SETTINGS.gamma) < discounted(idle(), SETTINGS.gamma) -->
# <!-- claim: 50 < -DEFAULT.reward.accident / second_pays(DEFAULT.traps.speed) < 70 -->
#
# **Three questions to think about**
# - Would it still be a trap if trap 2 drove 0.5 m/s faster than you?
# - Which reward would you change so that a learner leaves at once? What else would it do then?
# - The observation holds nothing of the past. Which two situations on this road give the same
#   observation, but call for different actions?
#
# **Read on**: [the next lesson](discrete_sac.ipynb) builds the learner. On the evening route, go to
# [lesson [[the_barrier]]](the_barrier.ipynb). highway-env, the simulator under this road: Leurent, *An
# Environment for Autonomous Driving Decision-Making* (2018). MDPs from the beginning: Sutton and
# Barto, *Reinforcement Learning* (2nd edition, 2018), chapter 3.

# %%
found = np.flatnonzero(np.cumsum(escape.rewards) < np.cumsum(idle.rewards))[-1] + 1
compare_predictions(
    "the_trap",
    {
        1: "fall back and change lane twice; on many roads without braking, too",
        2: "brake",
        3: "on some roads",
        4: "trap 2, and dy is negative",
        5: idle.rewards.sum(),
        6: f"for {found} s",
        7: "about 1 in 200",
        8: "both",
    },
)

# %% [markdown] tags=["instructor"] minutes=8
# *Model answers to the three questions:*
#
# - **Trap 2 drives 0.5 m/s faster.** After ten seconds it is 5 m further ahead, and the middle lane
#   opens beside you. Then steering left works without braking. Doing nothing still pays the same
#   each second, so it is still a trap, but it should be a weaker one.
# - **Another reward.** If a second behind the traps *cost* something, to stay would not pay. But
#   then an early crash, which ends the cost, may be the best way out for a learner that has not
#   found the escape. A smaller penalty for accidents makes attempts cheaper, and the trained driver
#   may crash more. A bonus for being ahead of trap 1 pays for a crash just after overtaking, too.
# - **Same observation, other action.** A neighbour that is about to change lane looks like one that
#   stays. A fifth car may close the gap that you aim for. The seconds that are left are not among
#   the numbers; the place x along the road hints at them, since it grows with time.
