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
# - write a planner of a few lines that finds a way out;
# - say what a driver sees and is paid for, and watch a program learn to drive;
# - work out when an attempt to leave pays.
#
# **Time** 73 minutes. **It builds on** the drive of lesson [[start]] and on Python.

# %%
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
from bootcourse.course.lessons.the_trap import (
    diagrams,
    driving,
    explorable,
    figures,
    time_step,
)
from bootcourse.road import formulas

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
# **See.** The car falls behind both traps and changes left twice. It gives up speed now to gain it
# later.

# %% [markdown] tags=["instructor"] minutes=3
# Ask those who drove in lesson [[start]] what they tried first, and what the rule does instead.
# Some will say that it has to fall back: Round 1 asks whether that is so.

# %% [markdown]
# ## Round 1: is there another way?
#
# Is there a way out without braking? Once a second you take one of nine
# **actions**: brake or accelerate by {{ DEFAULT.ego.acceleration }} m/s² or keep the speed, and
# steer left or right by π/{{ math.pi / DEFAULT.ego.steering }} rad or go straight.
# <!-- claim: N_ACTIONS == 9 and DEFAULT.clock.decision_rate == 1 -->

# %%
by_speed = ((0, 1, 2), (3, 4, 5), (6, 7, 8))
rows = [[f"{n}: {bc.ACTION_NAMES[n]}" for n in three] for three in by_speed]
table(["left", "straight", "right"], rows)

# %% [markdown]
# **Exercise (5 min, ●○○).** Turn action numbers into what the car does. The axis y points to the
# *right*, so steering left is negative.


# %%
def decode(actions):
    """Acceleration (m/s²) and steering (rad) of each action: whole numbers (n,) -> (n, 2)."""
    # solution: the exercise's own


check.decode(decode)

# %% [markdown]
# Your `decode` draws where the nine lead:

# %%
decoded = own_code.yours_or_ours("decode", doing="Steering")(np.arange(9))
bc.show(figures.nine_actions(decoded, seconds=2))

# %% [markdown]
# **See.** Steering turns the car, so a lane change needs a turn back.
#
# A **plan** is a list of actions, each with its seconds. After it the car goes straight on.

# %%
my_plan = [("keep left", 2), ("keep right", 2)]  # change it, and run the cell again

mine = bc.record(bc.plan_policy(my_plan), [ROAD], label="you")[0]
bc.show(bc.top_view_over_time(mine, times=[0, 1, 2, 3]))

# %% [markdown]
# **See.** "Go left now" ends in trap 2, which drives almost beside you: its middle is less than a
# car's length ahead of yours.
# <!-- claim: idle().states[0, TRAP_2, X] < DEFAULT.car.length -->
# <!-- claim: record(plan_policy([('keep left', 2), ('keep right', 2)]), [ROAD])[0].accident ==
#   Accident.COLLISION -->
#
# A drive, of at most {{ DEFAULT.clock.decisions / DEFAULT.clock.decision_rate }} s, is an
# **episode**. An **accident** ends it at once: a collision, leaving the road, or almost stopping.
# A drive that ends ahead of trap 1 *gets out*. It is a **success**, even if it ends in a crash;
# without an accident it ends **unhurt**.
# <!-- claim: len(KINDS) == 3 -->
#
# Now drive road 7 yourself, without braking. The ghost does nothing.

# %% tags=["nbval-ignore-output"]
bc.world(road=7, ghosts="idle")

# %% [markdown]
# Take the {{ 3 ** 8 | , }} plans that steer left, straight or right in each of eight seconds, and
# then accelerate for five.
#
# > **Predict.** How many of them get out unhurt on road 7? A plan has to bring the car into the
# > left lane, parallel to the road, without leaving the road: {{ into_left_lane().sum() }} plans do.
# > And it has to miss trap 2.
# <!-- claim: not (on_road(7)(all_plans()) & ~into_left_lane()).any() -->

# %%
choices = ["1", "about 10", "about 100", "about 1,000"]
predict("the_trap.1", "How many of the 6,561 plans get out unhurt on road 7?", choices)

# %% [markdown]
# **Exercise (10 min, ●●○).** A **planner** is a program that tries out the future before it acts.
# Ours tries its plans on the road itself, so it knows what the traffic will do. Draw plans at
# random, let them drive, and return one that gets out unhurt.


# %%
def find_plan(gets_out, rng):
    """A plan (8,) of actions 3, 4, 5 (keep left, straight, right) that gets out unhurt.

    gets_out(plans): which of these plans (n, 8) do, (n,) True or False; it can be asked again.
    rng: a NumPy generator. Few plans get out: draw many at a time.
    """
    # solution: the exercise's own


check.find_plan(find_plan)

# %%
planner = own_code.yours_or_ours("find_plan", doing="Planning")
plan = [bc.ACTION_NAMES[a] for a in planner(driving.on_road(7), np.random.default_rng(0))]
drive = bc.record(bc.plan_policy(plan + [("accelerate straight", 5)]), [7], label="planner")[0]
title = "This plan gets out on road 7 without braking"
bc.show(bc.top_view_over_time(drive, times=[0, 2, 4, 6, 8, bc.overtaken(drive)], title=title))

# %% [markdown]
# Now drive all of them:

# %%
predicted("the_trap.1")
all_plans = driving.all_plans()
for road in (7, ROAD, 1):
    out = driving.on_road(road)(all_plans)
    print(f"road {road}: {out.sum()} of {len(all_plans):,} plans get out unhurt")

# %% [markdown]
# **Explain.** There are ways out without braking, but few of these plans find one; on road
# 1 none.
# <!-- claim: 70 < getting_out(7) < 150 and 0 < getting_out(ROAD) < 10 and getting_out(1) == 0 -->
#
# Here one of road {{ ROAD }}'s {{ getting_out(ROAD) }} plans drives {{ roads() | , }} other roads. It
# looks at nothing:
# <!-- claim: on_road(ROAD)(np.array([[5, 3, 3, 3, 3, 5, 5, 5]])).all() and ROAD not in
#   held_out_seeds(1, roads()) -->

# %%
plan = ["keep right", ("keep left", 4), ("keep right", 3), ("accelerate straight", 5)]
blind = bc.drive_episodes(bc.plan_policy(plan), bc.held_out_seeds(1, 1000))
out, hurt = blind.success > 0, blind.accident > 0
print(f"It gets out unhurt on {np.mean(out & ~hurt):.0%} of the roads,")
print(f"crashes ahead of trap 1 on {np.mean(out & hurt):.0%},")
print(f"and behind it on {np.mean(~out & hurt):.0%}.")

# %% [markdown]
# **See.** *Right 1, left 4, right 3* gets out on most roads without looking, but crashes on about
# every fourth. Can a program learn to do better than both?
# <!-- claim: blind_plan().success.mean() > 0.75 and 0.2 < np.mean(blind_plan().accident > 0) < 0.3
#   -->

# %% [markdown] tags=["instructor"] minutes=9
# Let everybody change `my_plan` twice and say what ended the drive. Let them drive road 7 for three
# minutes and count who got out without braking. Then collect the guesses for all plans before
# anybody runs the planner.

# %% [markdown]
# ## Round 2: what are you paid for?
#
# Each second pays a **reward**. Without an accident it is the weighted mean of three terms:
#
# $$ r = \frac{w_v r_v + w_y r_y + w_\theta r_\theta}{w_v + w_y + w_\theta}, \qquad w_v =
# {{ DEFAULT.reward.w_v }},\; w_y = w_\theta = {{ DEFAULT.reward.w_y }} $$
#
# - $r_v$ pays for speed, as the curve below says;
# - $r_y = \exp(-{{ -math.log(centring_reward(1.0)) }}\, d_e^2)$ pays for the middle of the lane,
#   $d_e$ metres away;
# - $r_\theta = -|\sin\theta|$ charges for steering by an angle $\theta$.

# %%
bc.show(figures.reward_curve())

# %% [markdown]
# > **Predict.** You do nothing for 150 s: 10 m/s, centred, no steering. What do you
# > earn? Use pen and paper.

# %%
predict("the_trap.2", "What does doing nothing earn in 150 s?", unit="")

# %% [markdown]
# **Exercise (6 min, ●○○).** Write the reward of one second. The three terms are in
# `bootcourse.road.formulas`. An accident pays {{ DEFAULT.reward.accident }} and nothing else.
# <!-- claim: (Accident.COLLISION, Accident.ROAD_DEPARTURE, Accident.STOPPAGE, Accident.NONE) == (1,
#   2, 3, 0) -->


# %%
def reward(v_lon, offset, theta, accident):
    """r(s, a), a number. v_lon in m/s, offset d_e in m, theta in rad.

    accident: 0 none, 1 collision, 2 road departure, 3 stoppage.
    """
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
# The **return** is the sum of an episode's rewards. Your `reward` pays the drive that does nothing:

# %%
# NBVAL_CHECK_OUTPUT
predicted("the_trap.2")
pay = own_code.yours_or_ours("reward", doing="Paying")
print(f"one second {pay(10, 0, 0, 0):.5f}, 150 seconds {driving.paid(pay, idle).sum():.4f}")

# %% [markdown]
# **Explain.** Staying behind trap 1 returns about {{ idle().rewards.sum() | .0f }}. An accident is
# fined about what a minute of that earns, and it ends the drive: after 3 s it costs {{
# idle().rewards.sum() - DEFAULT.reward.accident - 3 * idle().rewards[0] | .0f }} against staying.
# <!-- claim: np.ptp(idle().rewards) < 1e-9 and idle().rewards.min() > 0 -->
# <!-- claim: 50 < -DEFAULT.reward.accident / second_pays(DEFAULT.traps.speed) < 70 -->

# %% [markdown] tags=["instructor"] minutes=5
# Let two or three read their number for one second aloud before the cell is run. {{ (1.5 *
# speed_reward(10) + 0.05) / 1.55 | .3f }} means that the third weight was left out of the mean, {{
# 1.5 * speed_reward(10) + 0.05 }} that nothing was divided.

# %% [markdown]
# ## Round 3: watch a program learn
#
# An **agent** is a program that learns by trying. Once a second it gets an **observation**, numbers
# that describe what it sees, and chooses an action. A second later it gets the reward.

# %%
bc.show(diagrams.agent_loop(observation="26 numbers", action="one of nine", reward="one number"))

# %% [markdown]
# The observation is six numbers about the ego, then five about each of the four nearest cars within
# {{ DEFAULT.sight.distance }} m:
# <!-- claim: sum(not name.startswith('car') for name in observation.names(DEFAULT)) == 6 -->
# <!-- claim: sum(name.startswith('car 1') for name in observation.names(DEFAULT)) == 5 -->
# <!-- claim: DEFAULT.sight.neighbours == 4 and DEFAULT.observation_size == 26 -->

# %%
env = gym.make("bootcourse:Trap-v0")
seen, info = env.reset(seed=ROAD)
figures.observed(seen, first=11)

# %% [markdown]
# **See.** `car 1`, the nearest car, is trap 2: it is one lane to the left, so its `dy` is negative.
# <!-- claim: idle().states[0, TRAP_2, Y] - idle().states[0, EGO, Y] == -DEFAULT.road.lane_width -->
#
# The road's **state** holds more, such as the cars beyond the four nearest and the seconds that are
# left. The learners of this course treat the observation as the state. With its state the road is a
# *Markov decision process* (MDP): what comes next depends on the present state and the action
# alone.
# <!-- claim: DEFAULT.vehicles - 1 > DEFAULT.sight.neighbours -->
# <!-- claim: not any('time' in name for name in observation.names(DEFAULT)) -->
#
# The agent chooses by its **policy**, π ("pi"): a function that gives each action a probability. At
# first the nine are about equally probable. Each **update** changes the policy a little, so that
# actions from which the agent expects more become more probable. This is *reinforcement learning*.
#
# Four agents learn for about 10 seconds by a method called SAC, *soft actor-critic*. Two learn
# alone (*plain SAC*). Two get help from the rule (*bootstrapped SAC*): they see some of its drives,
# and lose reward for actions that the rule would hardly take, less and less over time. Watch
# success and return; later lessons explain the other two curves.

# %% tags=["nbval-ignore-output"]
agents = bc.with_seeds(bc.settings_for("sac"), 2)
agents += bc.with_seeds(bc.settings_for("bootstrapped"), 2)
training = bc.Training(agents, episodes=5000, learner="compiled")  # SAC as machine code
beginner = training.agent(2).as_policy()
learned = training.run(updates=1500)

# %% [markdown]
# The first agent with help drives, before and after training:

# %% tags=["nbval-ignore-output"]
after = f"After {training.updates:,} updates"
for policy, who in ((beginner, "Untrained"), (learned.agents[2].as_policy(), after)):
    drive = bc.record(policy, [ROAD], label="bootstrapped")[0]
    bc.show(figures.ending(drive, who))

# %% [markdown]
# **See.** A crash in the first seconds returns about −9.5. Which curves have risen from there?
#
# Two agents say little. In our study {{ len(of('sac')) }} agents of each kind learned. Those of a
# kind differ only in their **seed**, from which all chance in training is drawn. Then each drove
# {{ roads() | , }} **held-out** roads, which were not used in training. An agent **escapes** if it
# gets out on at least {{ 100 * ESCAPES | .0f }} % of these.
# <!-- claim: len(of('sac')) == len(of('bootstrapped')) -->
#
# > **Predict.** How many of the ten agents of plain SAC escape?

# %%
predict("the_trap.3", "How many agents of plain SAC escape?", unit="of 10")

# %%
predicted("the_trap.3")
study = bc.shipped_results()
figures.who_escapes(study, blind)

# %% [markdown]
# **See.** Of plain SAC's ten, {{ staying().sum() }} get out on none of the roads, and crash on at
# most {{ 100 * of('sac').scores('accident')[staying()].max() | .0f }} %: they stay. One crashes at
# once, and one escapes. With the rule's help {{ escaped('bootstrapped') }} escape. The other three
# have an accident on most roads or all.
# <!-- claim: escaped('sac') == 1 and staying().sum() == 8 and (abs(of('sac').scores('returns') -
#   idle().rewards.sum()) < 3)[staying()].all() -->
# <!-- claim: sorted(of('bootstrapped').scores('accident'))[-3] > 0.5 and escaped('bootstrapped') == 7
#   and of('bootstrapped').scores('accident')[of('bootstrapped').scores('success') < ESCAPES].min() >
#   0.5 -->
# <!-- claim: sorted(of('sac').scores('accident'))[-1] == 1 and len(of('sac')) == 10 -->
# <!-- claim: escaped('sac') < escaped('bootstrapped') -->
#
# Each of the seven earns more than the rule and than the plan. It crashes on at most {{ 100 *
# of('bootstrapped').scores('accident')[of('bootstrapped').scores('success') >= ESCAPES].max() | .0f
# }} % of the roads: less than the plan, more than the rule.
# <!-- claim: of('bootstrapped').scores('returns')[of('bootstrapped').scores('success') >=
#   ESCAPES].min() > max(blind_plan().returns.mean(), of('rule').episodes('returns').mean()) -->
# <!-- claim: 0 == of('rule').episodes('accident').sum() <
#   of('bootstrapped').scores('accident')[of('bootstrapped').scores('success') >= ESCAPES].min() and
#   of('bootstrapped').scores('accident')[of('bootstrapped').scores('success') >= ESCAPES].max() <
#   np.mean(blind_plan().accident > 0) -->

# %% [markdown] tags=["instructor"] minutes=12
# Ask what is missing from the {{ DEFAULT.observation_size }} numbers before they read on: how long
# ago a car considered a lane change, the traffic beyond {{ DEFAULT.sight.distance }} m or beyond
# the fourth car, the seconds that are left. Draw the loop on the board while the curves grow, and
# let somebody read the live curve aloud. Most will say that the agents alone "do not learn". Ask
# what their return says. If the training is slow on the projector's machine, the saved picture
# tells the same story.

# %% [markdown]
# **Slide.** Press *Train*: two agents learn with help. When half of the episodes are a success,
# take the help away: drag ξ ("xi"), its strength, to its lower end, and β, the share of the rule's
# drives in what they learn from, to 0. Do they still get out? (Lesson [[found_and_kept]] asks this
# of our agents.)

# %%
bc.panels.train_panel("bootstrapped", seeds=2, episodes=600)

# %% [markdown]
# ## Round 4: when does an attempt pay?
#
# > **Predict.** On road {{ ROAD }} the rule drives at 8 to 10 m/s until second 33, and then speeds
# > up to 15 m/s. For how many seconds has it earned less, in all, than doing nothing?
# <!-- claim: (lambda v: v[:34].max() <= 10 and v[:34].min() >= 8 and v[38] == 15)(
#   by_rule().states[::2, EGO, SPEED].round(6)) -->

# %%
choices = ["about 10 s", "about 35 s", "about 60 s", "about 100 s"]
predict("the_trap.4", "For how long has the rule's way earned less than staying?", choices)

# %%
predicted("the_trap.4")
lead = np.cumsum(driving.paid(pay, escape)) - np.cumsum(driving.paid(pay, idle))
behind = np.flatnonzero(lead < 0)[-1] + 1  # the last second in which it has earned less
bc.show(figures.running_lead(lead, int(behind)))

# %% [markdown]
# **See.** The rule loses little in its slow seconds, and earns it back in its first fast ones. But
# what if it had crashed?
# <!-- claim: -1 < (by_rule().rewards - idle().rewards).cumsum().min() < 0 -->
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
# The agents of Round 3 **discount** rewards: one that comes t seconds later counts γᵗ as much, and
# the paper's γ ("gamma") is {{ SETTINGS.gamma }}.
#
# **Drag** γ. From which γ on is the rule's way out worth more than staying? And the plan of Round 1?

# %%
explorable.discount()

# %% [markdown]
# An attempt drives like the rule, or like the plan, or crashes after 3 s. Which risk of a crash is
# bearable?

# %%
bearable, rows = own_code.yours_or_ours("bearable_risk", doing="Judging attempts"), []
quick = bc.record(bc.plan_policy(plan), [ROAD])[0]
each = (idle.rewards, [*escape.rewards[:3], -10], escape.rewards, quick.rewards)
for gamma in (1.0, 0.95, 0.8):
    stay, crash, rule, plan_s = (gamma ** np.arange(len(r)) @ r for r in each)
    risks = [f"{bearable(stay, leave, crash):.0%}" for leave in (rule, plan_s)]
    rows.append([gamma, *(f"{x:.2f}" for x in (stay, crash, rule, plan_s)), *risks])
headings = ["γ", "staying", "a crash after 3 s", "the rule's way out", "the plan"]
table([*headings, "bearable risk: the rule's way", "bearable risk: the plan"], rows)

# %% [markdown]
# **Explain.** At the agents' γ the rule's way out is worth *less* than staying, even without a
# crash: it costs now and pays too late. The plan, out sooner, is worth more on this road. But over
# the {{ roads() | , }} roads, crashes included, staying is worth {{ discounted(idle(), 0.8) | .2f
# }}, the rule's way {{ worth('rule', 0.8) | .2f }} and the plan {{ worth('plan', 0.8) | .2f }}. So at
# this γ neither pays: one is slow, the other is not safe. Is γ what keeps plain SAC behind? Lesson
# [[the_barrier]] asks that.
# <!-- claim: discounted(on_ten(), 0.8) > discounted(idle(), 0.8) > discounted(by_rule(), 0.8) -->
# <!-- claim: discounted(idle(), 0.8) > worth('rule', 0.8) > worth('plan', 0.8) -->
# <!-- claim: SETTINGS.gamma == 0.8 -->

# %% [markdown] tags=["instructor"] minutes=6
# Let them argue about the exercise before the table is shown: "the agent is stupid" is a common
# first answer. Ask what would have to change: better attempts (a teacher), another reward, a larger
# γ, or an agent that judges an attempt by its best case.

# %% [markdown]
# ## Round 5: halve the time step
#
# All that you saw was computed in steps of {{ DEFAULT.clock.dt }} s. Do shorter steps give the
# same? Ask this of any simulation: **halve the time step and compare**. Here are 100 roads, with our
# traffic's time constants and those of highway-env, the simulator under this road (its own step is
# 1/{{ highway_env_rate() }} s).

# %%
rows = []
for name, taus in (("ours", time_step.OURS), ("highway-env's", time_step.HIGHWAY_ENVS)):
    for rate in (2, 4):
        leaves, gets_out, earned = time_step.seen(taus, rate)
        rows.append([name, f"{1 / rate:g} s", f"{leaves:.0%}", f"{gets_out:.0%}", f"{earned:.0f}"])
table(["traffic", "step", "a traffic car leaves the road", "the rule gets out", "earns"], rows)

# %% [markdown]
# **Explain.** With ours little changes. With highway-env's, at 0.5 s, traffic cars leave the road:
# they correct their heading with a time constant of 0.2 s, so a step of 0.5 s multiplies a heading
# error by 1 − 0.5 / 0.2 = {{ 1 - 0.5 / 0.2 | .1f }}. It swings and grows. At 0.25 s the factor is
# {{ 1 - 0.25 / 0.2 | .2f }}, and the error settles. Ours is {{ time_step.OURS[0] }} s. With this one
# alone set to 0.2 s, traffic cars leave the road on {{ 100 * heading_alone().leaves | .0f }} of the
# 100 at 0.5 s.
# <!-- claim: heading_alone().leaves > 0.3 -->
# <!-- claim: time_step.HIGHWAY_ENVS[0] == 0.2 -->
# <!-- claim: all(time_step.seen(time_step.OURS, rate)[:2] == (0, 1) for rate in (2, 4)) -->
# <!-- claim: time_step.seen(time_step.HIGHWAY_ENVS, 2).leaves > 0.3 and
#   time_step.seen(time_step.HIGHWAY_ENVS, 4).leaves == 0 -->

# %% [markdown] tags=["instructor"] minutes=5
# Ask where else a step meets a rate: gradient descent with a learning rate times a curvature above
# 2 diverges with the same alternating signs. Then ask which of the course's numbers they would
# recompute at 0.25 s before they quote them; the report's page of claims says where we did.
# <!-- claim: abs(1 - 1.99) < abs(1 - 2) == 1 < abs(1 - 2.01) -->

# %%
compare_predictions(
    "the_trap",
    {
        1: "about 100",
        2: idle.rewards.sum(),
        3: study.escapers("sac"),
        4: f"for {behind} s",
    },
)

# %% [markdown]
# ## What you now know
#
# 1. The rule falls back to get out. There are other ways: one plan that looks at nothing gets out
#    on most roads, and crashes on about every fourth.
# 2. Doing nothing earns about {{ idle().rewards.sum() | .0f }} and ends behind trap 1.
# <!-- claim: not idle().success -->
# 3. An agent gets an observation, takes an action, and learns from the rewards that follow. Of ten
#    agents of plain SAC {{ escaped('sac') }} escapes, of ten with the rule's help {{
#    escaped('bootstrapped') }}.
# <!-- claim: len(of('sac')) == len(of('bootstrapped')) == 10 -->
# 4. The rule's way out costs now and pays later. At γ = {{ SETTINGS.gamma }} it is worth less than
#    staying. A quicker way out is worth more, if it does not crash.
# 5. What a simulation shows may come from its time step: halve it.
#
# **Three questions to think about**
# - Would it still be a trap if trap 2 drove 0.5 m/s faster than you?
# - Which reward would you change so that a learner leaves at once? What else would it do then?
# - Which two situations on this road give the same observation, but call for different actions?
#
# **Read on**: [the next lesson](values.ipynb) says what a state is worth. MDPs: Sutton and Barto,
# *Reinforcement Learning* (2018), chapter 3. highway-env: Leurent, *An Environment for Autonomous
# Driving Decision-Making* (2018).

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
