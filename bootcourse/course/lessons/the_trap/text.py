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
# - say what a driver sees, can do and is paid for, and watch a program learn to drive;
# - write a planner of ten lines that finds a way out, and count the ways;
# - work out when an attempt to leave pays, and what the discount has to do with it.
#
# **Time** 82 minutes. **It builds on** the drive of lesson [[start]] and on Python.

# %%
import itertools

import bootcourse as bc
import gymnasium as gym
import numpy as np
from bootcourse.course import (
    check,
    compare_predictions,
    own_code,
    predict,
    predicted,
    progress,
    table,
)
from bootcourse.course.lessons.the_trap import diagrams, explorable, figures, time_step
from bootcourse.research import report, tables
from bootcourse.road import formulas, observation

progress("the_trap")

# %% [markdown]
# ## Look first
#
# This is the road of lesson [[start]]. The driver, **ego**, starts at {{ DEFAULT.ego.speed }} m/s,
# boxed in by two dark red cars as fast as itself: **trap 1** is ahead in its lane, **trap 2** is in
# the next lane. The left lane is free. Grey cars are traffic.
# <!-- claim: DEFAULT.traps.speed == DEFAULT.ego.speed -->
#
# This is how a hand-written driver, the **rule**, gets out:

# %%
ROAD = 10  # the seed: which road you get
idle = bc.record(bc.idle_policy, [ROAD], label="idle")[0]
escape = bc.record(bc.rule_policy(bc.DEFAULT), [ROAD], label="rule")[0]
title = "The rule falls back, then changes lane behind trap 2"
bc.show(bc.top_view_over_time(escape, times=[0, 3, 6, 9, 20, bc.overtaken(escape)], title=title))

# %% [markdown]
# **See.** The car falls behind both traps and changes left twice. It gives up speed now to gain
# speed later.

# %% [markdown] tags=["instructor"] minutes=4
# Ask those who drove in lesson [[start]] what they tried first, and what the rule does instead.
# Some will say that it has to fall back: Round 2 asks whether that is so.

# %% [markdown]
# ## Round 1: nine actions
#
# The nine buttons beside the road are nine **actions**. Each combines an acceleration of
# {{ -DEFAULT.ego.acceleration }}, 0 or +{{ DEFAULT.ego.acceleration }} m/s² with a steering angle
# of −π/{{ math.pi / DEFAULT.ego.steering }}, 0 or +π/{{ math.pi / DEFAULT.ego.steering }} rad, and
# is held for one second.
# <!-- claim: N_ACTIONS == 9 -->

# %% tags=["hide-input"]
rows = [
    [f"**{row}**", *(f"{n}: {bc.ACTION_NAMES[n]}" for n in n_s)]
    for row, n_s in (("brake", (0, 1, 2)), ("keep", (3, 4, 5)), ("accelerate", (6, 7, 8)))
]
bc.show(figures.nine_actions(seconds=2))
table(["", "left", "straight", "right"], rows)

# %% [markdown]
# **See.** After two seconds of steering the car is turned, so a lane change needs a turn back.
#
# **Exercise (5 min, ●○○).** Turn action numbers into what the car does. The axis y points to the
# *right*, so steering left is negative.


# %%
def decode(actions):
    """Acceleration (m/s²) and steering (rad) of each action: whole numbers (n,) -> (n, 2)."""
    # solution: the exercise's own


check.decode(decode)

# %% [markdown]
# A plan is a list of actions, each with its seconds. After it the car keeps its speed and its
# direction.

# %%
my_plan = [("keep left", 2), ("keep right", 2)]  # change it, and run the cell again

mine = bc.record(bc.plan_policy(my_plan), [ROAD], label="you")[0]
bc.show(bc.top_view_over_time(mine, times=[0, 1, 2, 3]))

# %% [markdown]
# **See.** "Go left now" ends in trap 2, which starts less than a car's length ahead of you, from
# centre to centre.
# <!-- claim: idle().states[0, TRAP_2, X] < DEFAULT.car.length -->
# <!-- claim: record(plan_policy([('keep left', 2), ('keep right', 2)]), [ROAD])[0].accident ==
#   Accident.COLLISION -->
#
# A drive, of at most {{ DEFAULT.clock.decisions / DEFAULT.clock.decision_rate }} s, is an
# **episode**. Three kinds of accident end it at once.
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
# A drive is a **success** if it ends ahead of trap 1, even if it ends in a crash. It ends
# **unhurt** if it has no accident.

# %% [markdown] tags=["instructor"] minutes=5
# Let everybody change `my_plan` twice and say what ended the drive. A car that has passed trap 1
# and crashes later is a success with an accident: ask whether the word is well chosen.

# %% [markdown]
# ## Round 2: is there another way?
#
# The rule brakes. Could you get out without braking? Try it on road 7, where the ghost does
# nothing.

# %% tags=["nbval-ignore-output"]
bc.world(road=7, ghosts="idle")

# %% [markdown]
# Take the {{ 3 ** 8 | , }} plans that steer left, straight or right in each of eight seconds at the
# same speed, and then accelerate for five.
#
# > **Predict.** How many of them get out unhurt on road 7? A plan has to leave the car parallel to
# > the road, so it steers left as often as right: {{ balanced().sum() | , }} plans do.

# %%
choices = ["1", "about 10", "about 100", "about 1,000"]
predict("the_trap.1", "How many of the 6,561 plans get out unhurt on road 7?", choices)

# %% [markdown]
# **Exercise (10 min, ●●○).** A **planner** is a program that tries out the future before it acts.
# Ours tries its plans on the road itself, so it knows what the traffic will do. Draw plans at
# random, let them drive, and return one that gets out.


# %%
def find_plan(gets_out, rng):
    """A plan (8,) of actions 3, 4, 5 (keep left, straight, right) that gets out.

    gets_out(plans): which of these plans (n, 8) get out, (n,) True or False; it can be asked again.
    rng: a NumPy generator. Few plans get out: draw many at a time.
    """
    # solution: the exercise's own


check.find_plan(find_plan)


# %%
def on_road(road):
    """gets_out(plans) for one road: each plan, five seconds of acceleration, then as it goes."""

    def gets_out(plans):
        actions = np.vstack([np.asarray(plans).T, np.full((5, len(plans)), 7)])
        policy = bc.policies.PlanPolicy(actions)
        drives = bc.drive_episodes(policy, [road] * len(plans), together=10_000)
        return drives.success & (drives.accident == 0)

    return gets_out


planner = own_code.yours_or_ours("find_plan", doing="Planning")
plan = [bc.ACTION_NAMES[a] for a in planner(on_road(7), np.random.default_rng(0))]
drive = bc.record(bc.plan_policy(plan + [("accelerate straight", 5)]), [7], label="planner")[0]
title = "This plan gets out on road 7 without braking"
bc.show(bc.top_view_over_time(drive, times=[0, 2, 4, 6, 8, bc.overtaken(drive)], title=title))

# %% [markdown]
# Now drive all {{ 3 ** 8 | , }} plans:

# %%
predicted("the_trap.1")
all_plans = np.array(list(itertools.product((3, 4, 5), repeat=8)))
rows = []
for road in (7, ROAD):
    plans = all_plans[on_road(road)(all_plans)]
    words = ", ".join(bc.ACTION_NAMES[action].removeprefix("keep ") for action in plans[0])
    rows.append([str(road), f"{len(plans)} of {len(all_plans):,}", words])
table(["road", "plans that get out unhurt", "the first of them"], rows)

# %% [markdown]
# **Explain.** There are ways out without braking on both roads, but few plans find one. On other
# roads trap 2 starts elsewhere. Here are three plans on 400 roads; on "far" ones trap 2 starts a
# car's length ahead or more.

# %%
after = [("accelerate straight", 5)]
three = {
    "left 2, straight 2, right 2": [("keep left", 2), ("keep straight", 2), ("keep right", 2)],
    "right 1, left 4, right 3": ["keep right", ("keep left", 4), ("keep right", 3)],
    "left 2, right 2": [("keep left", 2), ("keep right", 2)],
}
rows = []
for name, plan in three.items():
    starts, unhurt = figures.d2_and_unhurt(plan + after)
    far = starts >= bc.DEFAULT.car.length
    shares = (unhurt.mean(), unhurt[far].mean(), unhurt[~far].mean())
    rows.append([name, *(f"{100 * share:.0f} %" for share in shares)])
table(["then accelerate", "gets out unhurt", "on far roads", "on the others"], rows)

# %% [markdown]
# **See.** Each of the first two plans gets out on most roads, without braking and without looking.
# So why should a learner stay?
# <!-- claim: all(0.5 < unhurt(turns).mean() for turns in (STRAIGHT_BETWEEN, RIGHT_FIRST)) -->

# %% [markdown] tags=["instructor"] minutes=6
# Let them drive road 7 for three minutes and count who got out without braking. Then collect the
# guesses for all plans before anybody runs the planner. Ask afterwards why the same plan fails on
# the next road: it does not look.

# %% [markdown]
# ## Round 3: what you see
#
# An agent learns to drive by trying. Once a second it gets an **observation**, numbers that
# describe what it sees, and chooses an action. A second later it gets a **reward**: a little for
# speed, {{ DEFAULT.reward.accident }} for an accident.

# %%
bc.show(diagrams.agent_loop(observation="26 numbers", action="one of nine", reward="one number"))

# %% [markdown]
# The observation is {{ DEFAULT.observation_size }} numbers: six about the ego, then five about each
# of the four nearest cars within {{ DEFAULT.sight.distance }} m. `x` and `y` are the ego's place
# along and across the road: y is 0 in the middle of the left lane and grows to the *right*. `v_lon`
# and `v_lat` are its speeds, `d_e` is how far it is off the middle of its lane. `dx`, `dy`,
# `dv_lon` and `dv_lat` are another car's place and speed, measured from the ego; `presence` is 1
# for a car that is there.
# <!-- claim: sum(not name.startswith('car') for name in observation.names(DEFAULT)) == 6 -->
# <!-- claim: sum(name.startswith('car 1') for name in observation.names(DEFAULT)) == 5 -->
# <!-- claim: DEFAULT.sight.neighbours == 4 -->
#
# > **Predict.** `car 1` is the nearest car. Which one is it, and what is the sign of its `dy`?

# %%
choices = ["trap 1, and dy is 0", "trap 2, and dy is positive", "trap 2, and dy is negative"]
predict("the_trap.2", "Which car is `car 1`, and what is its dy?", choices)

# %%
predicted("the_trap.2")
env = gym.make("bootcourse:Trap-v0")
seen, info = env.reset(seed=ROAD)
names, scales = observation.names(bc.DEFAULT), observation.scales(bc.DEFAULT)
each = list(zip(names, seen, scales, strict=True))[:16]
rows = [
    [name, f"{number:.3f}", f"{scale:g}", f"{number * scale:.2f}"] for name, number, scale in each
]
table(["number", "observed", "scale", "in m, m/s"], rows, below="(the first 16 of 26)")

# %% [markdown]
# **See.** The nearest is trap 2, and its `dy` is {{ idle().states[0, TRAP_2, Y] - idle().states[0,
# EGO, Y] }} m: one lane to the left.
#
# The observation leaves out a part of the road's **state**: the cars beyond the four nearest,
# the lanes that cars want, and the seconds that are left. The learners of this course treat it as
# the state. The field calls the road a *Markov decision process* (MDP): the next state and the
# reward depend on the present state and the action alone.
# <!-- claim: DEFAULT.vehicles == 9 -->
# <!-- claim: DEFAULT.vehicles - 1 > DEFAULT.sight.neighbours == 4 -->
# <!-- claim: not any('lane' in name or 'time' in name for name in observation.names(DEFAULT)) -->

# %% [markdown] tags=["instructor"] minutes=6
# Ask what is missing from the {{ DEFAULT.observation_size }} numbers before they read on: how long
# ago a car considered a lane change, the traffic beyond {{ DEFAULT.sight.distance }} m or beyond
# the fourth car, the seconds that are left. Then ask which of these would change what *they* do.

# %% [markdown]
# ## Round 4: what you are paid for
#
# A second without an accident pays the weighted mean of three terms:
#
# $$ r = \frac{w_v r_v + w_y r_y + w_\theta r_\theta}{w_v + w_y + w_\theta}, \qquad w_v =
# {{ DEFAULT.reward.w_v }},\; w_y = w_\theta = {{ DEFAULT.reward.w_y }} $$
#
# - $r_v$ pays for speed;
# - $r_y = \exp(-{{ -math.log(centring_reward(1.0)) }}\, d_e^2)$ pays for the middle of the lane;
# - $r_\theta = -|\sin\theta|$ charges for steering by an angle $\theta$.

# %%
bc.show(figures.reward_curve())

# %% [markdown]
# **See.** Speed pays most at 15 m/s, and next to nothing from 17 m/s on:
# <!-- claim: speed_reward(15) == 1 and speed_reward(17) < 0.02 -->
#
# $$ r_v = \begin{cases} \exp(-(v - 15)^2) & v > 15 \\ \frac{8}{25} v - \frac{19}{5} & 12.5 < v \le
# 15 \\ \frac{2}{75} v - \frac{2}{15} & 5 < v \le 12.5 \\ 0 & v \le 5 \end{cases} $$
# <!-- claim: all(math.isclose(speed_reward(v), r) for v, r in {16: math.exp(-(16 - 15) ** 2), 15: 8
#   / 25 * 15 - 19 / 5, 12.6: 8 / 25 * 12.6 - 19 / 5, 12.5: 2 / 75 * 12.5 - 2 / 15, 5.1: 2 / 75 *
#   5.1 - 2 / 15, 5: 0}.items()) -->
#
# > **Predict.** You do nothing at all for 150 s: 10 m/s, centred, no steering. What do you
# > earn? Use pen and paper.

# %%
predict("the_trap.3", "What does doing nothing earn in 150 s?", unit="")

# %% [markdown]
# **Exercise (6 min, ●○○).** Write the reward of one second. The three terms are in
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
# The **return** is the sum of an episode's rewards. Doing nothing on road {{ ROAD }} returns:

# %%
# NBVAL_CHECK_OUTPUT
predicted("the_trap.3")
print(f"return {idle.rewards.sum():.4f}, distance {idle.distance:.0f} m, success {idle.success}")

# %% [markdown]
# <details><summary>The calculation</summary>
#
# At 10 m/s $r_v$ = 2/75 · 10 − 2/15 = {{ speed_reward(10.0) | .4f }}; $r_y$ = 1 and $r_\theta$ = 0.
# One second pays (1.5 · {{ speed_reward(10.0) | .4f }} + 0.05) / 1.6 = {{ second_pays(10) | .5f }},
# and 150 seconds {{ 150 * second_pays(10) | .4f }}.
#
# </details>
#
# **Explain.** A learner that ends near {{ idle().rewards.sum() | .1f }} has probably learned to
# stay where it is.
# <!-- claim: np.ptp(idle().rewards) < 1e-9 and idle().rewards.min() > 0 -->

# %% [markdown] tags=["instructor"] minutes=6
# Let two or three read their number for one second aloud before the cell is run. {{ (1.5 *
# speed_reward(10) + 0.05) / 1.55 | .3f }} means that the third weight was left out of the mean, {{
# 1.5 * speed_reward(10) + 0.05 }} that nothing was divided.

# %% [markdown]
# ## Round 5: watch a program learn
#
# The agent chooses by its **policy**, π ("pi"): a function that gives each action a probability. At
# first the nine are about equally probable. The agent remembers what its actions paid. Again and
# again it changes its policy a little, so that actions with better consequences become more
# probable. Each change is an **update**. This is *reinforcement learning*.
#
# Four agents learn for about 20 seconds by a method called SAC, *soft actor-critic*. Two learn
# alone (*plain SAC*). Two get help from the rule (*bootstrapped SAC*): they see some of its drives,
# and lose reward for actions that the rule would hardly take, less and less over time.
#
# Of the four curves, watch success and return. The *entropy* of π says how undecided the agent is,
# and ξ ("xi") how much it pays for leaving the rule.

# %% tags=["nbval-ignore-output"]
agents = bc.with_seeds(bc.settings_for("sac"), 2) + bc.with_seeds(
    bc.settings_for("bootstrapped"), 2
)
training = bc.Training(agents, episodes=5000)
beginner = training.agent(2).as_policy()
learned = training.run(updates=1500)

# %% [markdown]
# Now the first agent with help drives, before and after its training. Each second it takes its most
# probable action:

# %% tags=["nbval-ignore-output"]
before = bc.record(beginner, [ROAD], label="bootstrapped")[0]
after = bc.record(learned.agents[2].as_policy(), [ROAD], label="bootstrapped")[0]
for drive, who in ((before, "Untrained"), (after, f"After {training.updates:,} updates")):
    passed, end = bc.overtaken(drive), f"crashes after {drive.times[-1]:.0f} s"
    ending = f"is ahead of trap 1 after {passed:.0f} s" if passed else "stays behind"
    ending = (f"{ending} and {end}" if passed else end) if drive.accident else ending
    times = [0, 3, passed or drive.times[-1]]
    bc.show(bc.top_view_over_time(drive, times=times, title=f"{who}, it {ending}"))

# %% [markdown]
# **See.** A crash in the first seconds returns about −9.5. Which curves have risen from there?
#
# Two agents say little. In our study {{ len(of('sac')) }} agents of each kind learned. They differ
# only in their **seed**, the number from which all chance in training is drawn. Then each drove
# {{ roads() | , }} **held-out** roads, which were not used in training. An agent **escapes** if it
# succeeds on at least {{ 100 * ESCAPES | .0f }} % of these.
# <!-- claim: len(of('sac')) == len(of('bootstrapped')) -->
#
# > **Predict.** How many of the {{ len(of('sac')) }} agents of plain SAC escape?

# %%
predict("the_trap.4", "How many agents of plain SAC escape?", unit="of 10")

# %%
predicted("the_trap.4")
study, rows = bc.shipped_results(), []
for method in ("sac", "bootstrapped"):
    mine = study.of(method)
    returns = mine.scores("returns")
    mean = tables.bracketed(bc.statistics.interval(returns, np.mean))
    each = " ".join(f"{earned:.0f}" for earned in sorted(returns))
    accidents = f"{100 * mine.episodes('accident').mean():.0f} %"
    rows.append([bc.display_name(method), tables.escaped(study, method), mean, each, accidents])
rule = report.rule_results(bc.DEFAULT, study.sizes[0])
returns, accidents = (rule.episodes(measure)[0] for measure in ("returns", "accident"))
mean = tables.bracketed(bc.statistics.mean(returns))
crashes = f"{100 * accidents.mean():.0f} %"
rows.append(["rule (no agent)", "succeeds on all roads", mean, "", crashes])
plan = bc.plan_policy([*three["right 1, left 4, right 3"], ("accelerate straight", 5)])
blind = bc.drive_episodes(plan, bc.held_out_seeds(1, 1000))
mean = tables.bracketed(bc.statistics.mean(blind.returns))
succeeds, crashes = (f"{100 * np.mean(x > 0):.0f} %" for x in (blind.success, blind.accident))
rows.append(
    ["the plan right 1, left 4, right 3", f"succeeds on {succeeds} of the roads", mean, "", crashes]
)
below = "In brackets: 95 % intervals, over agents; of rule and plan over roads."
headings = ["", "who gets out", "mean return", "each agent's", "drives that end in an accident"]
table(headings, rows, below)

# %% [markdown]
# **See.** Look at each agent before the mean. Of plain SAC's ten, {{ near_staying() }} stay: they
# return {{ stayers().min() | .0f }} to {{ stayers().max() | .0f }}. One crashes at once, and one
# gets out. The mean of the ten describes none of these three. With the rule's help more agents get
# out; the others with help crash in {{ 100 *
# of('bootstrapped').scores('accident')[of('bootstrapped').scores('success') < ESCAPES].min() | .0f
# }} % of their drives or more. In brackets is the 95 % *interval*: the mean over very many such
# agents probably lies in it.
# <!-- claim: escaped('sac') == 1 and near_staying() == 8 -->
# <!-- claim: sorted(of('sac').scores('accident'))[-1] == 1 and len(of('sac')) == 10 -->
# <!-- claim: escaped('sac') < escaped('bootstrapped') -->
#
# The plan of Round 2 looks at nothing. Each helped agent that escapes earns more than this plan,
# gets out on more roads and has fewer accidents.
# <!-- claim: of('bootstrapped').scores('returns')[of('bootstrapped').scores('success') >=
#   ESCAPES].min() > blind_plan().returns.mean() -->
# <!-- claim: of('bootstrapped').scores('success')[of('bootstrapped').scores('success') >=
#   ESCAPES].min() > blind_plan().success.mean() and np.mean(blind_plan().accident > 0) >
#   of('bootstrapped').scores('accident')[of('bootstrapped').scores('success') >= ESCAPES].max() -->

# %% [markdown] tags=["instructor"] minutes=9
# Draw the loop on the board while the curves grow, and let somebody read the live curve aloud. Most
# will say that the agents alone "do not learn". Ask what their return says. If the training is slow
# on the projector's machine, the saved picture tells the same story.

# %% [markdown]
# **Slide.** Press *Train*: two agents learn with help. When half of the episodes are a success,
# take the help away: drag ξ to its lower end, and β, the share of the rule's drives in what they
# learn from, to 0. Until when do they need the help, and what becomes of the return? The curve
# shows the slider's ξ times α, a number of the learner that falls.

# %%
bc.panels.train_panel("bootstrapped", seeds=2, episodes=600)

# %% [markdown]
# ## Round 6: when does an attempt pay?
#
# > **Predict.** On road {{ ROAD }} the rule drives at 8 to 10 m/s until second 33, and then speeds
# > up to 15 m/s within five seconds. For how many seconds has it earned less, in all, than doing
# > nothing?
# <!-- claim: (lambda v: v[:34].max() <= 10 and v[:34].min() >= 8 and v[38] == 15)(
#   by_rule().states[::2, EGO, SPEED].round(6)) -->

# %%
choices = ["about 10 s", "about 35 s", "about 60 s", "about 100 s"]
predict("the_trap.5", "For how long has the escape earned less than doing nothing?", choices)

# %%
predicted("the_trap.5")
lead = np.cumsum(escape.rewards) - np.cumsum(idle.rewards)
behind = np.flatnonzero(lead < 0)[-1] + 1  # the last second in which it has earned less
bc.show(figures.running_lead(lead, int(behind)))

# %% [markdown]
# **See.** The escape loses {{ -(by_rule().rewards - idle().rewards).cumsum().min() | .1f }} in its
# slow seconds, and earns it back in its first fast ones.
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
# The agents of Round 5 **discount** rewards: one that comes t seconds later counts γᵗ as much, and
# the paper's γ ("gamma") is {{ SETTINGS.gamma }}.
#
# **Drag** γ. From which γ on is the rule's way out worth more than staying? And the plan *right 1,
# left 4, right 3*, which is out sooner?

# %%
explorable.discount()

# %% [markdown]
# Suppose that an attempt drives like the rule, or crashes after 3 s. What may it risk? Your
# exercise answers in the last column:

# %% tags=["hide-input"]
bearable, rows = own_code.yours_or_ours("bearable_risk", doing="Judging attempts"), []
quick = bc.record(plan, [ROAD])[0]
for gamma in (1.0, 0.95, 0.8):
    drives = (idle, quick, escape)
    stay, sooner, leave = (gamma ** np.arange(150) @ drive.rewards for drive in drives)
    crash = gamma ** np.arange(4) @ [*escape.rewards[:3], -10]
    risk = bearable(stay, leave, crash)
    rows.append([gamma, *(f"{value:.2f}" for value in (stay, sooner, leave, crash)), f"{risk:.0%}"])
headings = ["γ", "staying", "the plan", "the rule's escape", "a crash after 3 s"]
headings.append("bearable share of the rule's crashes")
table(headings, rows, below=f"Discounted sums from the start, road {ROAD}.")

# %% [markdown]
# **Explain.** On this one road, at the agents' γ = {{ SETTINGS.gamma }}, the rule's escape is worth
# *less* than staying, even without a crash: it costs now and pays too late. The plan is worth more
# than staying: at this γ leaving pays for a driver that knows a quick way.
# <!-- claim: discounted(on_ten(), 0.8) > discounted(idle(), 0.8) > discounted(by_rule(), 0.8) -->
# <!-- claim: SETTINGS.gamma == 0.8 and discounted(by_rule(), 0.8) < discounted(idle(), 0.8) -->

# %% [markdown] tags=["instructor"] minutes=6
# Let them argue about the exercise before the table is shown: "the agent is stupid" is a common
# first answer. Ask what would have to change: better attempts (a teacher), another reward, a larger
# γ, or an agent that judges an attempt by its best case.

# %% [markdown]
# ## Round 7: halve the time step
#
# All that you saw was computed in steps of {{ DEFAULT.clock.dt }} s. Do shorter steps give the
# same? Ask this of any simulation: **halve the time step and compare**. Here are 100 roads, with
# our traffic and with that of highway-env, the simulator under this road.

# %%
rows = []
for name, taus in (("ours", time_step.OURS), ("highway-env's", time_step.HIGHWAY_ENVS)):
    for rate in (2, 4, 10):
        leaves, gets_out, earned = time_step.seen(taus, rate)
        rows.append([name, f"{1 / rate:g} s", f"{leaves:.0%}", f"{gets_out:.0%}", f"{earned:.0f}"])
table(["traffic", "step", "a traffic car leaves the road", "the rule gets out", "earns"], rows)

# %% [markdown]
# **Explain.** With our traffic the rule gets out with each of the three steps, and earns as much.
# But the plan *left 2, straight 2, right 2* gets out unhurt on {{ 100 * unhurt_at(2).mean() | .0f
# }} % of 200 roads at 0.5 s and on {{ 100 * unhurt_at(10).mean() | .0f }} % at 0.1 s.
#
# With highway-env's traffic, at 0.5 s, undisturbed cars leave the road. They correct their heading
# in 0.2 s, three times as fast as ours. So a step of 0.5 s multiplies a heading error by
# 1 − 0.5 / 0.2 = {{ 1 - 0.5 / 0.2 | .1f }}: it swings and grows. At 0.25 s the factor is
# {{ 1 - 0.25 / 0.2 | .2f }}, and the error settles.
# <!-- claim: round(time_step.OURS[0] / time_step.HIGHWAY_ENVS[0], 6) == 3 -->
# <!-- claim: all(time_step.seen(time_step.OURS, rate)[:2] == (0, 1) for rate in (2, 4, 10)) -->
# <!-- claim: unhurt_at(2).mean() > 0.6 and unhurt_at(10).mean() < 0.02 -->
# <!-- claim: time_step.seen(time_step.HIGHWAY_ENVS, 2).leaves > 0.3 and
#   time_step.seen(time_step.HIGHWAY_ENVS, 4).leaves == 0 -->

# %% [markdown] tags=["instructor"] minutes=7
# Ask where else a step meets a rate: gradient descent with a learning rate times a curvature above
# 2 diverges with the same alternating signs. Then ask which of the course's numbers they would
# recompute at 0.25 s before they quote them; the report's page of claims says where we did.
# <!-- claim: abs(1 - 1.99) < abs(1 - 2) == 1 < abs(1 - 2.01) -->

# %%
compare_predictions(
    "the_trap",
    {
        1: "about 100",
        2: "trap 2, and dy is negative",
        3: idle.rewards.sum(),
        4: study.escapers("sac"),
        5: f"for {behind} s",
    },
)

# %% [markdown]
# ## What you now know
#
# 1. Once a second a driver sees {{ DEFAULT.observation_size }} numbers and takes one of nine
#    actions. An agent learns from the rewards that follow.
# 2. Speed pays most near {{ max(np.arange(0, 25, 0.5), key=speed_reward) }} m/s. An accident costs
#    {{ -DEFAULT.reward.accident }}, about what a minute of doing nothing earns, and ends the
#    episode.
# <!-- claim: 50 < -DEFAULT.reward.accident / second_pays(DEFAULT.traps.speed) < 70 -->
# 3. Doing nothing earns {{ idle().rewards.sum() }} and ends behind trap 1. Of ten agents of plain
#    SAC {{ escaped('sac') }} escapes, of ten with the rule's help {{ escaped('bootstrapped') }}.
# <!-- claim: not idle().success and len(of('sac')) == len(of('bootstrapped')) == 10 -->
# 4. The rule falls back and changes lane behind trap 2. There are other ways: one plan without
#    braking gets out unhurt on most roads.
# <!-- claim: unhurt(RIGHT_FIRST).mean() > 0.5 -->
# 5. The rule's escape costs now and pays later. At γ = {{ SETTINGS.gamma }} it is worth less than
#    staying on road {{ ROAD }}, while a quicker way out is worth more.
# 6. What a simulation shows may be its time step's doing: halve it and compare.
#
# **Three questions to think about**
# - Would it still be a trap if trap 2 drove 0.5 m/s faster than you?
# - Which reward would you change so that a learner leaves at once? What else would it do then?
# - The observation holds nothing of the past. Which two situations on this road give the same
#   observation, but call for different actions?
#
# **Read on**: [the next lesson](values.ipynb) says what a state is worth. highway-env: Leurent, *An
# Environment for Autonomous Driving Decision-Making* (2018). MDPs: Sutton and Barto, *Reinforcement
# Learning* (2nd edition, 2018), chapter 3.

# %% [markdown] tags=["instructor"] minutes=4
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

# %% [markdown] tags=["instructor"]
# **On the board.** r_v against v, with its bends at 5, 12.5 and 15 m/s; a dot at 10 m/s.
#
# **To discuss.** Who should choose the weights of a reward: the engineer, the passenger, or the law?
