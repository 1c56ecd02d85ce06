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
# - write a planner that finds a way out;
# - say what a driver is paid for;
# - work out when an attempt to leave pays.
#
# **Time** 55 minutes. **It builds on** lesson [[start]] and Python.

# %%
import bootcourse as bc
import numpy as np
from bootcourse.course import (
    check,
    compare_predictions,
    live_curves,
    own_code,
    predict,
    predicted,
    progress,
)
from bootcourse.course.lessons.the_trap import diagrams, driving, explorable, figures
from bootcourse.road import formulas

progress("the_trap")

# %% [markdown]
# ## Look first
#
# Your car, the **ego**, starts at {{ DEFAULT.ego.speed }} m/s, boxed in by two dark red cars as fast as itself:
# **trap 1** is ahead in its lane, and **trap 2** in the next lane, a few metres ahead. The left lane is free.
# <!-- claim: DEFAULT.traps.speed == DEFAULT.ego.speed -->
# <!-- claim: all(4 < idle(road).states[0, TRAP_2, X] < 7.5 for road in (7, ROAD)) -->
#
# Drive road 7 *without braking*. Can you get ahead of trap 1?

# %% tags=["nbval-ignore-output"]
bc.world(road=7, ghosts=[])

# %% [markdown]
# This is how the **rule**, a hand-written driver, gets out on road {{ ROAD }}:

# %%
ROAD = 10  # the seed: which road you get
idle = bc.record(bc.idle_policy, [ROAD], label="idle")[0]
by_rule = bc.record(bc.rule_policy(bc.DEFAULT), [ROAD], label="rule")[0]
title = "The rule falls back, then changes lane behind trap 2"
bc.show(bc.top_view_over_time(by_rule, times=[0, 3, 6, 9, 20, bc.overtaken(by_rule)], title=title))

# %% [markdown] tags=["instructor"] minutes=4
# Let them drive road 7 for three minutes, and count who got out without braking. Ask those who drove in
# lesson [[start]] what they tried first, and what the rule does instead. Some will say that one has to fall
# back: Round 1 asks whether that is so.

# %% [markdown]
# ## Round 1: do you have to brake?
#
# Once a second you choose one of nine **actions**: you brake or accelerate at {{ DEFAULT.ego.acceleration }}
# m/s², and steer by π/{{ math.pi / DEFAULT.ego.steering }} rad.
# <!-- claim: N_ACTIONS == 9 and DEFAULT.clock.decision_rate == 1 -->
#
# | | left | straight | right |
# |---|---|---|---|
# | **brake** | 0 | 1 | 2 |
# | **keep the speed** | 3 | 4 | 5 |
# | **accelerate** | 6 | 7 | 8 |
#
# <!-- claim: list(ACTION_NAMES) == [f'{a} {b}' for a in ('brake', 'keep', 'accelerate') for b in
#   ('left', 'straight', 'right')] -->
#
# **Exercise (5 min, ●○○).** Turn action numbers into what the car does. The axis y points to the *right*, so
# steering left is negative.


# %%
def decode(actions):
    """Acceleration (m/s²) and steering (rad) of each action: whole numbers (n,) -> (n, 2)."""
    # solution: the exercise's own


check.decode(decode)

# %%
decoded = own_code.yours_or_ours("decode", doing="Steering")(np.arange(9))
bc.show(figures.nine_actions(decoded, seconds=2))

# %% [markdown]
# A drive of at most {{ DEFAULT.clock.decisions / DEFAULT.clock.decision_rate }} s is an **episode**. An
# **accident** (a collision, leaving the road, or almost stopping) ends it at once. A drive *gets out* if it ends
# ahead of trap 1, and *unhurt* if it does so without an accident.
# <!-- claim: len(KINDS) == 3 -->
#
# A **plan** is a list of actions. Take the {{ 3 ** 8 | , }} plans that keep the speed and steer left, straight or right
# in each of eight seconds. All then accelerate for five, and go straight on.
#
# > **Predict.** Each second of steering turns the car by the same angle, and "straight" keeps its direction.
# > {{ straight().sum() | , }} of the plans steer left as often as right.
# <!-- claim: (~straight()).sum() == 5454 -->

# %%
choices = ["none", "about 100", "about 1,000", "most of them"]
predict("the_trap.1", "How many of the other 5,454 plans get out unhurt on road 7?", choices)

# %% [markdown]
# **Exercise (10 min, ●●○).** A **planner** tries out the future before it acts. Ours tries its plans on the road
# itself. Draw plans at random, let them drive, and return one that gets out unhurt.


# %%
def find_plan(gets_out, rng):
    """A plan (8,) of actions 3, 4, 5 (keep left, straight, right) that gets out unhurt.

    gets_out(plans): for plans (n, 8), which of them get out unhurt: (n,) True or False.
    Call it as often as you like.
    rng: a NumPy generator. Few plans get out: draw many at a time.
    """
    # solution: the exercise's own


check.find_plan(find_plan)

# %%
planner = own_code.yours_or_ours("find_plan", doing="Planning")
plan = [bc.ACTION_NAMES[a] for a in planner(driving.on_road(7), np.random.default_rng(0))]
drive = bc.record(bc.plan_policy(plan + [("accelerate straight", 5)]), [7], label="planner")[0]
print("road 7:", ", ".join(plan))
title = "This plan gets out on road 7 without braking"
bc.show(bc.top_view_over_time(drive, times=[0, 2, 4, 6, 8, bc.overtaken(drive)], title=title))

# %%
predicted("the_trap.1")
all_plans = driving.all_plans()
out = driving.on_road(7)(all_plans)
print(f"road 7: {out.sum()} of {len(all_plans):,} plans get out unhurt")
straight = (all_plans == 3).sum(axis=1) == (all_plans == 5).sum(axis=1)
print(f"{out[straight].sum()} of the {straight.sum():,} that steer left as often as right")
print(f"{out[~straight].sum()} of the {(~straight).sum():,} others")
crooked = ["keep left", "keep right", "keep left", "keep straight", "keep left", "keep right"]
crooked += [("keep straight", 2), ("accelerate straight", 5)]
drive = bc.record(bc.plan_policy(crooked), [7], label="planner")[0]
title = "This plan steers left once too often"
bc.show(bc.top_view_over_time(drive, times=[4, 6, 8.5], title=title))

# %% [markdown]
# **Explain.** You need not brake. A car that steers more to one side ends crooked. Ending straight is not enough: of
# the {{ straight().sum() | , }}, {{ (all_drives(7).accident[straight()] == 2).sum() }} leave the road and
# {{ (all_drives(7).accident[straight()] == 1).sum() }} collide.
# <!-- claim: not unhurt_plans(7)[~straight()].any() and set(all_drives(7).accident[~straight()]) == {1, 2} -->
# <!-- claim: bool(all_drives(7).accident[(all_plans() == [3, 5, 3, 4, 3, 5, 4, 4]).all(axis=1)][0] == 2) -->
#
# On road {{ ROAD }} only {{ unhurt_plans(ROAD).sum() }} plans get out unhurt. We take the one that does so on most
# of 200 further roads, the **blind plan**, and drive it on {{ roads() | , }} others. It looks at nothing.
# <!-- claim: best_on_others() == [5, 3, 3, 3, 3, 5, 5, 5] -->
# <!-- claim: unhurt_plans(ROAD)[(all_plans() == [5, 3, 3, 3, 3, 5, 5, 5]).all(axis=1)].all() and ROAD not in
#   held_out_seeds(1, roads()) -->

# %%
blind_plan = ["keep right", ("keep left", 4), ("keep right", 3), ("accelerate straight", 5)]
blind = bc.drive_episodes(bc.plan_policy(blind_plan), bc.held_out_seeds(1, 1000))
hurt = blind.accident > 0
unhurt = np.mean((blind.success > 0) & ~hurt)
early = hurt & (blind.distance < 50)  # within 50 m, which is in second 5
print(f"The blind plan gets out unhurt on {unhurt:.0%}")
print(f"It crashes on {np.mean(hurt):.0%}, most often in second 5: on {np.mean(early):.0%}")
bc.show(figures.early_crashes(driving.trap_2_starts(), early))

# %% [markdown]
# **See.** In second 5 it crashes only where trap 2 starts close. The rule, which looks, crashes on none of these roads,
# but needs {{ overtaken(by_rule()) | .0f }} s on road {{ ROAD }}.
#
# Two ways out, then: a quick one that is dangerous early, and a slow one that is safe. Which is better depends on what
# you are paid, and how you count what comes later.
# <!-- claim: 0.2 < np.mean(blind_plan().accident > 0) < 0.3 and of('rule').episodes('accident').sum() == 0 -->
# <!-- claim: set(by_plan().lasted[crashed_early()]) == {5} and crashed_early().sum() >
#   by_plan().accident.sum() / 2 -->
# <!-- claim: driving.trap_2_starts()[crashed_early()].max() < 4.8 -->

# %% [markdown] tags=["instructor"] minutes=7
# Collect the guesses before anybody runs the planner. If nobody is sure, let them drive "keep left" once, and then
# straight.

# %% [markdown]
# ## Round 2: what are you paid for?
#
# Each second pays a **reward**, most of it for speed along the road:

# %%
bc.show(figures.reward_curve())

# %% [markdown]
# Without an accident the reward is the weighted mean of three terms:
#
# $$ r = \frac{w_v r_v + w_y r_y + w_\theta r_\theta}{w_v + w_y + w_\theta}, \qquad w_v =
# {{ DEFAULT.reward.w_v }},\; w_y = w_\theta = {{ DEFAULT.reward.w_y }} $$
#
# - $r_v$ is the curve above;
# - $r_y = \exp(-{{ -math.log(centring_reward(1.0)) }}\, d_e^2)$ pays for driving near the middle of the lane, $d_e$
#   metres away;
# - $r_\theta = -|\sin\theta|$ charges for steering by an angle $\theta$.
#
# > **Predict.** You do nothing: you drive at 10 m/s in the middle of the lane, without steering.

# %%
predict("the_trap.2", "What does one second of doing nothing earn?", unit="")

# %% [markdown]
# **Exercise (6 min, ●○○).** Write the reward of one second. The terms are `formulas.speed_reward(v_lon)`,
# `formulas.centring_reward(offset)` and `formulas.steering_reward(theta)`. An accident pays
# {{ DEFAULT.reward.accident }} and nothing else.
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
# The **return** is the sum of an episode's rewards. Your `reward` pays two drives:

# %%
# NBVAL_CHECK_OUTPUT
predicted("the_trap.2")
pay = own_code.yours_or_ours("reward", doing="Paying")
print(f"doing nothing, a second: {pay(10, 0, 0, 0):.5f}")
print(f"doing nothing, 150 s: {driving.paid(pay, idle).sum():.1f}")
print(f"the rule's way out, 150 s: {driving.paid(pay, by_rule).sum():.1f}")

# %% [markdown]
# **Explain.** Behind trap 1 a second at 10 m/s pays little; on the free road one at 15 m/s pays six times as much. So
# the rule's way out returns about twice as much as doing nothing, although it gets out late.
# <!-- claim: 5.9 < (1.5 * speed_reward(15) + 0.05) / (1.5 * speed_reward(10) + 0.05) < 6.4 -->
# <!-- claim: -10 <= 4 * idle().rewards[0] + DEFAULT.reward.accident < -9 -->
# <!-- claim: 1.8 < by_rule().rewards.sum() / idle().rewards.sum() < 2.2 -->
# <!-- claim: np.ptp(idle().rewards) < 1e-9 and idle().rewards.min() > 0 -->

# %% [markdown] tags=["instructor"] minutes=4
# Let two or three read their number for one second aloud before the cell is run.
# {{ (1.5 * speed_reward(10) + 0.05) / 1.55 | .3f }} means that the third weight was left out of the mean,
# {{ 1.5 * speed_reward(10) + 0.05 }} that nothing was divided.

# %% [markdown]
# ## Round 3: what does a program learn?
#
# An **agent** is a program that learns from rewards, by trying: this is *reinforcement learning*. Once a second it
# gets an **observation**, numbers about itself and the four nearest cars, and chooses an action.
# <!-- claim: DEFAULT.sight.neighbours == 4 and DEFAULT.observation_size == 26 -->

# %%
bc.show(diagrams.agent_loop(observation="26 numbers", action="one of nine", reward="one number"))

# %% [markdown]
# The agent's **policy**, π ("pi"), gives each action a probability. Each step of learning, an **update**,
# changes these probabilities.
#
# Four agents now learn by *soft actor-critic* (SAC), two alone (*plain SAC*) and two with the rule's help
# (*bootstrapped SAC*): these also learn from its drives, and are pulled towards its actions.

# %% tags=["nbval-ignore-output"]
agents = bc.with_seeds(bc.settings_for("sac"), 2)
agents += bc.with_seeds(bc.settings_for("bootstrapped"), 2)
training = bc.Training(agents, episodes=5000, learner="compiled")  # at most 5,000 drives
live = live_curves.LiveCurves()
learned = training.run(progress=False, callback=live, updates=1500)
live.show(training)

# %% [markdown]
# **See.** The returns begin near −10, because most of the first drives leave the road. With the rule's help *success*
# rises: drives that get out, hurt or unhurt.
# <!-- claim: (at_random().accident == 2).mean() > 0.65 and 35 < np.median(at_random().distance) < 50 and
#   -10 < at_random().returns.mean() < -9 -->

# %% [markdown]
# Here one of your two agents with help drives. Does it get out? Does it crash, and when?

# %% tags=["nbval-ignore-output"]
drive = bc.record(learned.agents[2].as_policy(), [ROAD], label="bootstrapped")[0]
times = [0, 3, 6, 9, bc.overtaken(drive) or drive.times[-1], drive.times[-1]]
title = "Your agent with the rule's help"
bc.show(bc.top_view_over_time(drive, times=sorted(set(times)), title=title))

# %% [markdown]
# This drive takes the most probable action each time. In training actions are drawn, and most drives that get out
# crash after the pass.
#
# In our study {{ len(of('sac')) }} agents of each kind, each with its own **seed** (its source of chance), learned
# for longer. Then each drove {{ roads() | , }} **held-out** roads, not used in training. It **escapes** if it gets
# out on at least {{ 100 * ESCAPES | .0f }} % of these.
# <!-- claim: len(of('sac')) == len(of('bootstrapped')) -->
# <!-- claim: of('sac').curves['success'].shape == of('bootstrapped').curves['success'].shape -->
#
# > **Predict.** A plain agent begins with random actions. An early crash returns about −10, doing nothing
# > {{ idle().rewards.sum() | .0f }}, the rule's way {{ by_rule().rewards.sum() | .0f }}. Few plans get out.

# %%
returns = ["about −10", "about 23", "about 45", "above 100"]
predict("the_trap.3", "What do most of plain SAC's ten agents return after training?", returns)

# %%
predicted("the_trap.3")
study = bc.shipped_results()
bc.show(figures.what_they_learned(study, blind))

# %% [markdown]
# **See.** Eight of plain SAC's ten agents stay behind trap 1. One escapes, and often crashes after the pass. With the
# rule's help {{ escaped('bootstrapped') }} escape, and these earn more than the rule and the blind plan.
# <!-- claim: len(alone_out()) == 1 and alone_out()[0] > 2 * (1 - ESCAPES) -->
# <!-- claim: escaped('sac') == 1 and staying().sum() == 8 and (abs(of('sac').scores('returns') -
#   idle().rewards.sum()) < 3)[staying()].all() -->
# <!-- claim: of('sac').scores('accident')[staying()].max() < 0.05 and of('sac').scores('accident').max() > 0.99 -->
# <!-- claim: len(of('sac')) == len(of('bootstrapped')) == 10 == escaped('bootstrapped') +
#   crash_on_most().sum() and crash_on_most().sum() == 3 and escaped('bootstrapped') == 7 -->
# <!-- claim: of('bootstrapped').scores('returns')[of('bootstrapped').scores('success') >=
#   ESCAPES].min() > max(blind_plan().returns.mean(), of('rule').episodes('returns').mean()) -->

# %% [markdown]
# <details><summary>What the paper reports</summary>
#
# | | success, % | return |
# |---|---|---|
# | plain SAC | {{ printed('sac') }} |
# | pulled towards the rule | {{ printed('soft') }} |
# | with the rule's drives | {{ printed('demos') }} |
# | bootstrapped SAC: both | {{ printed('bootstrapped') }} |
# | CQL | {{ printed('cql') }} |
# | GAIL | {{ printed('gail') }} |
# | the rule | {{ printed('rule') }} |
#
# Our rule returns {{ of('rule').episodes('returns').mean() | .0f }}, the mean of all roads (road {{ ROAD }}:
# {{ by_rule().rewards.sum() | .0f }}). Keep this table: lesson [[your_own_problem]]
# checks it.
#
# </details>

# %% [markdown] tags=["instructor"] minutes=5
# Ask what is missing from the {{ DEFAULT.observation_size }} numbers before they read on: how long ago a car
# considered a lane change, the traffic beyond {{ DEFAULT.sight.distance }} m or beyond the fourth car, the
# seconds that are left. Let somebody read the live curve aloud. Most will say that the agents alone "do not
# learn". Ask what their return says.

# %% [markdown]
# ## Round 4: when does an attempt pay?
#
# The agents of Round 3 **discount** rewards: what is paid t seconds later is multiplied by γᵗ. The paper chooses
# γ ("gamma") = {{ SETTINGS.gamma }}: a reward of 1 that comes ten seconds later counts {{ 0.8 ** 10 | .2f }}. The
# discounted sum is what a drive is **worth**.
# <!-- claim: SETTINGS.gamma == 0.8 -->
#
# > **Predict.** On road {{ ROAD }} the rule drives at 8 to 10 m/s until second 33, and then at 11 to
# > 15 m/s.
# <!-- claim: (lambda v: 8 == v[:34].min() < v[:34].max() == 10 and 11 == v[34:].min() < v[34:].max()
#   == 15)(by_rule().states[::2, EGO, SPEED].round(6)) -->

# %%
choices = ["about twice as much as staying", "a little more than staying", "less than staying"]
predict("the_trap.4", "At γ = 0.8, what is the rule's way out worth?", choices)

# %% [markdown]
# **Drag** γ up to 1. From which γ on is the rule's way out worth more than staying?

# %%
predicted("the_trap.4")
explorable.discount()

# %% [markdown]
# **See.** The rule's way out costs now and pays later. On road {{ ROAD }} it is worth more than staying only from
# γ = {{ pays_from() }} on.
#
# So we have a **riddle**. Counted with the learner's own γ = 0.8, the rule's way is worth *less than the trap*. A
# learner that copied the rule would do better to stay. Yet of ten agents with its help seven escape, and earn more than
# the rule. Lessons [[found_and_kept]] and [[your_teacher]] solve this.
#
# On this road the quicker ways out are worth more than staying. But what if they crash?
# <!-- claim: min(discounted(on_ten(), 0.8), helped_on_ten()) > discounted(idle(), 0.8) > discounted(by_rule(), 0.8) -->
# <!-- claim: all(discounted(by_rule(), percent / 100) < discounted(idle(), percent / 100) for percent
#   in range(50, round(100 * pays_from()))) -->
#
# **Exercise (8 min, ●●○).** Staying is worth `stay`. An attempt to get out crashes with probability q, and is
# then worth `crash`; otherwise it is worth `out`, which is more than `crash`. Up to which q is an attempt, on
# average, worth at least `stay`?


# %%
def bearable_risk(stay, out, crash):
    """The largest q from 0 to 1, and 0 if even a safe way out is worth less than `stay`."""
    # solution: the exercise's own


check.bearable_risk(bearable_risk)

# %% [markdown]
# How often may the blind plan crash in second 5?

# %%
bearable = own_code.yours_or_ours("bearable_risk", doing="Judging attempts")
quick = bc.record(bc.plan_policy(blind_plan), [ROAD])[0]
stay, out = driving.paid(pay, idle), driving.paid(pay, quick)
crash = [*out[:4], -10]  # as `out` for four seconds, then a crash


def worth(rewards):
    return sum(0.8**t * r for t, r in enumerate(rewards))


risk = bearable(worth(stay), worth(out), worth(crash))
print(f"With road 10's worths it could crash in second 5 on {risk:.0%} of the roads.")
print(f"It does on {np.mean(early):.0%} of the 1,000.")
bc.show(figures.worth_with_crashes(driving.worths(pay, blind_plan)))

# %% [markdown]
# These are the first 100 of the 1,000 roads.
#
# **Explain.** **When a crash comes can matter more than how often.** The blind plan crashes less often than the plain
# agent that escapes, but mostly in second 5, where −10 still counts −10 · 0.8⁴ = −{{ 10 * 0.8**4 | .1f }}. The agent's
# first crash on these roads comes in second {{ worths()[ALONE].seconds.min() }}, where −10 counts
# −10 · 0.8²⁷ = −{{ 10 * 0.8**27 | .2f }}.
#
# If crashes paid nothing, both ways would be worth more than staying. With them only the agent's is.
# <!-- claim: worths()['the blind plan'].crashes < worths()[ALONE].crashes and worths()[ALONE].seconds.min() > 20 -->
# <!-- claim: worths()[ALONE].unpaid - worths()[ALONE].worth < 0.01 and
#   worths()['the blind plan'].unpaid - worths()['the blind plan'].worth > 0.5 -->
# <!-- claim: worths()['the blind plan'].seconds.min() == 5 and np.median(worths()['the blind plan'].seconds) == 5 -->
# <!-- claim: worths()['the blind plan'].worth < worths()['staying'].worth < worths()['the blind plan'].unpaid -->
# <!-- claim: worths()[ALONE].seconds.min() == 28 and worths()['staying'].worth < worths()[ALONE].worth -->
# <!-- claim: borne(0.8, on_ten()) < crashed_early().mean() / 3 -->
# <!-- claim: crashed_early().mean() == np.mean((blind_plan().accident > 0) & (blind_plan().distance < 50)) -->
#
# The agent with help is one of the seven. So **a better way is worth more than staying at γ = {{
# SETTINGS.gamma }}, too**. Both agents begin by braking, as the rule does, but accelerate much sooner:
#
# | road {{ ROAD }} | at first | 2 s | 4 s | 6 s | 8 s | 10 s | passes trap 1 |
# |---|---|---|---|---|---|---|---|
# | the rule | {{ speeds(by_rule()) }} |
# | the plain agent | {{ speeds(alone_on_ten()) }} |
# | the agent with help | {{ speeds(helped_drive()) }} |
#
# <!-- claim: all(drive.states[2, EGO, SPEED] < 9.5 for drive in (by_rule(), alone_on_ten(), helped_drive())) -->
# <!-- claim: max(map(overtaken, (alone_on_ten(), helped_drive()))) < overtaken(by_rule()) / 3 -->
# <!-- claim: min(worths()[ALONE].worth, worths()[HELPED].worth) > 1.4 * worths()['staying'].worth -->
# <!-- claim: worths()['staying'].worth > 1.2 * worths()["the rule's way"].worth -->
# <!-- claim: alone_out().tolist() == [of('sac').scores('accident')[3]] and
#   of('bootstrapped').scores('success')[2] >= ESCAPES -->

# %% [markdown] tags=["instructor"] minutes=4
# Let them argue about the exercise before the picture is shown: "the agent is stupid" is a common first
# answer. Ask what would have to change: better attempts (a teacher), another reward, a larger γ, or an agent
# that judges an attempt by its best case.

# %%
compare_predictions(
    "the_trap",
    {1: "none", 2: idle.rewards[0], 3: "about 23", 4: "less than staying"},
)

# %% [markdown]
# ## What you now know
#
# 1. A plan that looks at nothing can get out without braking, but often crashes.
# 2. A second pays for speed. Doing nothing returns about {{ idle().rewards.sum() | .0f }}.
# 3. Of ten agents alone {{ escaped('sac') }} escapes, of ten with help {{ escaped('bootstrapped') }}.
# 4. At γ = {{ SETTINGS.gamma }} an early crash costs much, a late one next to nothing.
# 5. *The riddle*: there the rule's way out is worth less than the trap, yet its help leads agents out.
#
# One plain agent of ten escaped. Did the others never find the way, or find it and not learn? On the road this is hard
# to see. [The next lesson](values.ipynb) shrinks it to five states, where every number can be watched.
#
# <details><summary>Words that later lessons use</summary>
#
# - A drive **gets out** (*success*) if it ends ahead of trap 1, and **unhurt** if without an accident.
# - An agent **escapes** if, after training, it gets out on at least {{ 100 * ESCAPES | .0f }} % of the held-out roads.
# - **Return**: the sum of a drive's rewards. **Worth**: their discounted sum.
#
# </details>
#
# **Three questions to think about**
# - At γ = 1, which of Round 4's ways are worth more than staying, crashes included?
# - If an accident paid −1, how often could the blind plan crash in second 5?
# - An agent's first attempts to get out all end in a crash, before trap 1 is passed. What can it learn from them, and
#   what not?
#
# <details><summary>Answers</summary>
#
# - All: the worth is then the return. The rule's is {{ of('rule').episodes('returns').mean() | .0f }}, the blind plan's
#   {{ blind_plan().returns.mean() | .0f }}.
#   <!-- claim: min(of('rule').episodes('returns').mean(), blind_plan().returns.mean(), of('sac').scores('returns')[3],
#   of('bootstrapped').scores('returns')[2]) > 1.5 * max(idle().rewards.sum(), of('sac').scores('returns')[0]) -->
# - On {{ 100 * borne(0.8, on_ten(), -1) | .0f }} %, and so more often than it does.
#   <!-- claim: borne(0.8, on_ten(), -1) > crashed_early().mean() -->
# - That its actions end in −10, but not what the free road pays: no attempt has been there.
#
# </details>
#
# **Read on**: Sutton and Barto, *Reinforcement Learning* (2018), chapter 3.
#
# <details><summary>Further: is a time step of 0.5 s fine enough?</summary>
#
# The simulation moves the cars in *time steps* of {{ DEFAULT.clock.dt }} s. The table halves them twice, for
# our traffic and for traffic that steers as quickly as in *highway-env*, the simulator that ours follows.
#
# | the blind plan gets out unhurt, with traffic | in steps of 0.5 s | of 0.25 s | of 0.125 s |
# |---|---|---|---|
# | ours | {{ in_steps(time_step.OURS, 0.5) | .0% }} | {{ in_steps(time_step.OURS, 0.25) | .0% }} | {{
# in_steps(time_step.OURS, 0.125) | .0% }} |
# | as quick as highway-env's | {{ in_steps(time_step.HIGHWAY_ENVS, 0.5) | .0% }} | {{
# in_steps(time_step.HIGHWAY_ENVS, 0.25) | .0% }} | {{ in_steps(time_step.HIGHWAY_ENVS, 0.125) | .0% }} |
#
# A step of 0.5 s is fine enough for our traffic. The quicker traffic needs 0.25 s.
# <!-- claim: abs(in_steps(time_step.OURS, 0.5) - in_steps(time_step.OURS, 0.25)) < 0.03 -->
# <!-- claim: in_steps(time_step.HIGHWAY_ENVS, 0.25) > 2 * in_steps(time_step.HIGHWAY_ENVS, 0.5) -->
# <!-- claim: abs(in_steps(time_step.HIGHWAY_ENVS, 0.25) - in_steps(time_step.HIGHWAY_ENVS, 0.125)) < 0.03 -->
#
# </details>

# %% [markdown] tags=["instructor"] minutes=2
# **On the board.** r_v against v, with its bends at 5, 12.5 and 15 m/s; a dot at 10 m/s.
#
# **To discuss.** Who should choose the weights of a reward: the engineer, the passenger, or the law?
