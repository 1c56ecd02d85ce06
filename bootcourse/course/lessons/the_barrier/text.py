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
# # The barrier
#
# **What you will be able to do**
# - train plain SAC in the trap, live, and say where it ends;
# - compute how often a car would get out by chance;
# - draw the dip of a plan, and say what frees most agents.
#
# **Time** 29 minutes; running it takes about half a minute. **It builds on** lessons [[the_trap]] to
# [[discrete_sac]].

# %%
import bootcourse as bc
import numpy as np
from bootcourse.course import (
    check,
    compare_predictions,
    own_code,
    predict,
    predicted,
    progress,
    shipped,
    table,
)
from bootcourse.course.lessons.the_barrier import easier, explorable, figures
from bootcourse.research import planner

progress("the_barrier")

# %% [markdown]
# ## Look first
#
# Two cars fill the lanes, and yet there is a way out. At which second, and through which gap? Look at the
# strips before you read the title. The car is driven by a planner: it knows the future, tries all nine
# actions each second, and keeps the best drives.
# <!-- claim: DEFAULT.clock.decision_rate == 1 and N_ACTIONS == 9 -->

# %%
ROAD = 10
plans = planner.plan_episodes([ROAD], search=planner.Search(beam=50))
planned = bc.record(planner.follow(plans), [ROAD], label="planner")[0]
idle = bc.record(bc.idle_policy, [ROAD], label="idle")[0]
earned = f"{planned.rewards.sum():.0f}, staying {idle.rewards.sum():.0f}"
title = f"The planner goes through between the traps and earns {earned}"
bc.show(bc.top_view_over_time(planned, times=[0, 2, 4, 6, 8, 12], title=title))

# %% [markdown] tags=["instructor"] minutes=2
# Point to the picture after two seconds and ask who would dare to steer between the two cars. What does the
# planner know that a driver does not?

# %% [markdown]
# ## Round 1: does plain SAC escape?
#
# Two agents learn by SAC, with {{ easier.UPDATES | , }} updates each: one with the paper's discount, γ =
# {{ SETTINGS.gamma }}, one that looks further ahead, γ = 0.95.

# %%
SEEDS, UPDATES = 1, 2000
agents = bc.with_seeds(bc.settings_for("sac"), SEEDS)
agents += bc.with_seeds(bc.settings_for("sac", gamma=0.95), SEEDS)
training = bc.Training(agents, episodes=20_000, learner="compiled")  # SAC as machine code
live = figures.LiveReturns(idle.rewards.sum())
training.run(progress=False, callback=live, stop=lambda: training.updates >= UPDATES)
live.show(training)

# %% [markdown]
# **See.** While they learn, agents *draw* their actions from π, and one bad draw can end in a crash. So we
# test agents by their most probable action. We trained ten agents like these with each γ. Of these twenty,
# {{ stay('as it is') }} stay behind, {{ ends('as it is')[2] }} crash on most roads, and one escapes. None
# earns more than a car that does nothing.
# <!-- claim: easy('as it is').escapers('sac') == 1 and len(easy('as it is')) == 20 -->
# <!-- claim: ends('as it is')[3] == stay('as it is') == 19 - ends('as it is')[2] -->
# <!-- claim: easy('as it is').scores('returns').max() < easier.staying('as it is') -->
#
# SAC maximises a discounted sum. Is staying best for it? At γ = 0.8 staying is worth
# {{ discounted(idle(), 0.8) | .2f }}.
# <!-- claim: SETTINGS.gamma == 0.8 -->
#
# > **Predict.** A second behind trap 1, at 10 m/s, earns {{ idle().rewards[0] | .2f }}; at 15 m/s it earns up to
# > {{ second_pays(15) | .2f }}. The planner's car reaches 15 m/s after 5 s, which pay {{ on_the_way() }}. What is
# > the best drive of a planner for γ = 0.8 worth, compared with staying?
# <!-- claim: np.allclose(planned_speeds()[[4, 5]], [14, 15]) and
#   abs(until_fast() - until_fast(searches=True)) < 0.05 -->
# <!-- claim: abs(until_fast() + 0.8**5 * second_pays(15) / 0.2 - searched().best.value) < 0.1 -->

# %%
choices = ["less", "up to twice as much", "three to four times as much", "six times as much"]
predict("the_barrier.1", "What is the planner's best drive worth, compared with staying?", choices)

# %%
predicted("the_barrier.1")
found = planner.is_staying_optimal(range(4), gamma=0.8, beam=50)
drives = {"doing nothing": found.idle, "best": found.best}
rows = [[name, f"{drive.value:.2f}"] for name, drive in drives.items()]
below = f"Means of four roads. {100 * found.leaves.value:.0f} % of the best drives get out."
table(["drive", "worth at γ = 0.8"], rows, below=below)

# %% [markdown]
# **Explain.** *To a planner that knows the future, staying is not best, even at γ = 0.8.* The first five
# seconds are worth {{ until_fast() | .2f }}, those at 15 m/s 0.8⁵ · {{ second_pays(15) | .2f }} / 0.2 =
# {{ 0.8**5 * second_pays(15) / 0.2 | .2f }}. Together this is
# {{ until_fast() + 0.8**5 * second_pays(15) / 0.2 | .2f }}. On the table's four roads the planner's own
# drives are worth {{ searched().best.value | .2f }}.
# <!-- claim: 3 < searched().best.value / searched().idle.value < 4 -->
# <!-- claim: searched().leaves.value == 1 -->
#
# What keeps agents in? Three things could:
#
# - **Luck.** To get out may take a rare sequence of actions.
# - **Price.** An attempt can end in an accident, which costs 10.
# - **The way.** From the trap a car must first change lane. In the plan that Round 3 tries, the first
#   seconds pay less than staying.
# <!-- claim: (by_plan_paid()[:4] < idle().rewards[0]).all() -->

# %% [markdown] tags=["instructor"] minutes=5
# The training takes some seconds: collect explanations for a flat line while it runs. Somebody will say
# "train longer". Let a group do that at home (`UPDATES = 30_000`) and bring the curves.
#
# The planner's number is a lower bound on the best: a beam of 50 can miss the best drive. Ask why that does
# not weaken the conclusion. (The best is worth at least so much.)

# %% [markdown]
# ## Round 2: do they lack luck?
#
# Lesson [[the_trap]]'s **blind plan** steers for {{ easier.LATER }} s (right 1 s, left 4 s, right 3 s), and
# then accelerates. Suppose that at each of these {{ easier.LATER }} decisions `good` of the nine actions are
# right.
# <!-- claim: attempts.PLAN[:9] == [5] + 4 * [3] + 3 * [5] + [7] -->
#
# **Exercise (5 min, ●●○).** Write the chance that at least one of `tries` random attempts gets out.


# %%
def luck(good, decisions, tries):
    """The chance that at least one of `tries` attempts is right at each of its decisions.

    good: how many of the 9 actions are right at each decision; all 9 are equally likely.
    """
    # solution: the exercise's own


check.luck(luck)

# %% [markdown]
# Let 5,000 drives take each action at random, for 150 s or until they crash:

# %%
tried = bc.drive_episodes(bc.random_policy(np.random.default_rng(0)), bc.held_out_seeds(6, 5000))
chance_of = own_code.yours_or_ours("luck", doing="Computing")
rows = [["if 1 of 9 actions is right, 8 times", f"{5000 * chance_of(1, 8, 1):.4f}"]]
rows.append(["random drives on the road", tried.success.sum()])
earn = np.sort(tried.returns[tried.success])
below = f"Random drives that end in an accident: {(tried.accident > 0).sum():,}. "
below += f"Those that get out earn {earn[0]:.1f} to {earn[-1]:.1f}, "
below += f"staying {idle.rewards.sum():.1f}."
table(["", "get out, of 5,000 drives"], rows, below=below.replace("-", "−"))

# %% [markdown]
# **See.** *To get out once takes no single rare sequence*: {{ len(lucky()) }} drives get out. But all of them
# crash afterwards, and none earns as much as staying.
# <!-- claim: easier.LATER == 8 and by_luck(1) < 0.01 and lucky().max() < 0 < idle().rewards.sum() -->
# <!-- claim: sum(len(each.accident) for each in by_chance()) == 5000 -->
#
# > **Predict.** Round 1's median agent makes about 400 drives while it learns. Reckon as if each of its actions
# > were random: p = {{ len(lucky()) }} / 5000 a drive. How many of the twenty got out, compared with that?
# <!-- claim: round(np.median(driven()), -2) == 400 -->

# %%
choices = ["at most half as many as by chance", "about as many as by chance", "all twenty"]
predict("the_barrier.2", "How many of twenty got out at least once while they learned?", choices)

# %%
predicted("the_barrier.2")
trained = shipped.shipped_experiment("easier")
by_chance = 1 - (1 - tried.success.mean()) ** 400  # your formula, with p for one attempt
bc.show(figures.while_they_learned(trained["as it is"], by_chance))

# %% [markdown]
# **Explain.** *Most got out at least once*: {{ once_ahead() }} of twenty. Random drives would give 20
# (1 − (1 − p)⁴⁰⁰) = {{ 20 * luck(9 * len(lucky()) / 5000, 1, 400) | .0f }}. Yet only one agent escapes.
# <!-- claim: abs(20 * luck(9 * len(lucky()) / 5000, 1, 400) - once_ahead()) < 3 -->
# <!-- claim: 14 <= once_ahead() <= 18 and len(times_ahead()) == 20 -->

# %% [markdown] tags=["instructor"] minutes=3
# Ask what the marks of an agent that learns look like, and which rows are chance.

# %% [markdown]
# ## Round 3: the price, the way, or both?
#
# Suppose that you have driven t seconds of the blind plan, without an accident. What is the rest of it worth?
#
# **Exercise (6 min, ●●○).** Write this worth: the mean discounted sum of what follows, over
# the drives that still run.


# %%
def going_on(rewards, lasted, gamma, t):
    """What the rest of a drive is worth after t s, the mean of the drives that are longer.

    rewards: what each second of each drive paid, (drives, seconds), 0 after a drive's end.
    lasted: how many seconds each drive took, (drives,). The rest's first reward counts in full.
    """
    # solution: the exercise's own


check.going_on(going_on)

# %% [markdown]
# The plan has driven 1,000 roads. The picture shows what its rest is worth, as a multiple of staying. **Drag**
# the price of an accident and γ. When does the plan pay?

# %%
explorable.barrier()

# %% [markdown]
# **See.** *The plan gets worse before it gets better*: here lesson [[values]]'s barrier is a dip. At a price
# of 10 and γ = 0.8 the whole plan is worth {{ hill(10, 0.8)[0] | .1f }} times as much as staying. It pays
#
# | at γ = | if an accident costs |
# |---|---|
# | 0.8 | 1 or less |
# | 0.85 | 6 or less |
# | 0.9 or 0.95 | any price of the slider |
#
# <!-- claim: hill(1, 0.8)[0] > 1 > hill(2, 0.8)[0] and hill(6, 0.85)[0] > 1 > hill(7, 0.85)[0] and
#   min(hill(15, 0.9)[0], hill(15, 0.95)[0]) > 1 -->
#
# With γ = 0.95 there is no dip, and at a price of 10 the plan is worth {{ hill(10, 0.95)[0] | .1f }} times as
# much as staying. Yet none of Round 1's ten agents with γ = 0.95 escapes; one gets ahead on most
# roads, and crashes on nearly all. *A learner does not know the plan*:
# it begins with nearly random drives, and each of Round 2's 5,000 ended in an accident.
# <!-- claim: hill(10, 0.8).argmin() == 4 and hill(10, 0.8)[4] < 0 -->
# <!-- claim: min(hill(10, 0.95)) > 2 and not hill(10, 0.95).argmin() and len(farther_sighted()) == 10 -->
# <!-- claim: sorted(farther_sighted().scores('success'))[-2:][0] < 0.5 < farther_sighted().scores('success').max() and
#   farther_sighted().scores('accident')[farther_sighted().scores('success').argmax()] > 0.9 -->
# <!-- claim: farther_sighted().escapers('sac') == 0 and all(each.accident.all() for each in by_chance()) -->
#
# What would free a learner? We ease the road in two ways:
#
# - *The price*: an accident costs 1 in place of 10.
# - *The way*: the car starts in the free left lane, behind the traps and as fast as they are.
#   This takes away the steering, its risk and the wait.
#
# > **Predict.** Twenty agents learn with neither change, twenty with each of the two, and twenty with
# > both. What frees more than half of them?

# %%
choices = [
    "cheap accidents, alone",
    "a start in the free lane, alone",
    "both together, neither alone",
    "not even both together",
]
predict("the_barrier.3", "What frees more than half of the agents?", choices)

# %%
predicted("the_barrier.3")
bc.show(figures.escapes(trained, easier.SHOWN))

# %%
bc.show(figures.getting_out(trained, easier.SHOWN, tried.success.mean()))

# %% [markdown]
# **Explain.** *Both together free most agents, and neither does alone.*
#
# **The price decides whether an agent learns from a try.** Take the agents that start in the trap and, when
# tested, get out on less than half of the roads. How many of their drives got out while they learned?
#
# | quarter of the drives | 1st | 2nd | 3rd | 4th |
# |---|---|---|---|---|
# | price 10, {{ failing('as it is') }} agents | {{ of_failing('as it is') }} |
# | as many drives at random | {{ at_random('as it is') }} |
# | price 1, {{ failing(CHEAP) }} agents | {{ of_failing(CHEAP) }} |
# | as many drives at random | {{ at_random(CHEAP) }} |
#
# <!-- claim: out_of_failing('as it is')[3] <= out_of_failing('as it is')[0] and
#   out_of_failing('as it is').max() < 20 -->
# <!-- claim: (np.diff(out_of_failing(CHEAP)) > 0).all() and
#   out_of_failing(CHEAP)[3] > 10 * out_of_failing(CHEAP)[0] -->
#
# At a price of 10 they get out now and then to the end, but in the last quarter not more often than in the
# first. At a price of 1 even the agents that fail get out more and more often. What can such a drive teach?
# Take Round 2's {{ len(lucky()) }} random drives that got out and crashed:
#
# | of these {{ len(lucky()) }}, worth more than staying | price 10 | price 1 |
# |---|---|---|
# | at γ = 0.8 | {{ better_than_staying(10, 0.8) }} | {{ better_than_staying(1, 0.8) }} |
# | at γ = 0.95 | {{ better_than_staying(10, 0.95) }} | {{ better_than_staying(1, 0.95) }} |
#
# At a price of 10 most of these drives look worse than staying, even at γ = 0.8.
# <!-- claim: better_than_staying(10, 0.8) < 5 and better_than_staying(10, 0.95) == 0 -->
# <!-- claim: all(quarters(kind)[0] > 0 == quarters(kind)[1:].max() for kind in ('as it is', MIDDLE)) and
#   all((np.diff(quarters(kind)) > 0).all() for kind in (CHEAP, BOTH)) -->
# <!-- claim: out_of_failing('as it is')[3] <= out_of_failing('as it is')[0] -->
# <!-- claim: stay(MIDDLE) > 10 and stay('as it is') > 10 -->
#
# **The way decides how good the first good tries are.** The smallest try is to accelerate once. From the free
# lane it passes the traps on all 100 roads, without an accident, and is worth
# {{ accelerating(1).values(0.8).mean() | .2f }} at γ = 0.8, where staying is worth
# {{ discounted(idle(), 0.8) | .2f }}. From the trap it hits trap 1 on all of them. There a try first has to
# change lane: the blind plan steers for 8 s.
# <!-- claim: accelerating(1).values(0.8).min() > discounted(idle(), 0.8) -->
# <!-- claim: all(len(each.accident) == 100 for each in (accelerating(1), accelerating(1, TrapVectorEnv))) and
#   accelerating(1).ahead.all() and not accelerating(1).accident.any() and
#   accelerating(1, TrapVectorEnv).accident.all() and not accelerating(1, TrapVectorEnv).ahead.any() -->
#
# The agents from the free lane also drive better in the end. In the tests at a price of 1, of the drives that
# get out from the trap {{ 100 * crash_when_out(CHEAP) | .0f }} % crash later, from the free lane
# {{ 100 * crash_when_out(BOTH) | .0f }} %.
# <!-- claim: crash_when_out(CHEAP) > 0.8 and crash_when_out(BOTH) < 0.4 -->
#
# In this experiment most agents need both: tries that they can afford, and tries that show what a free road
# is worth. These are the first two of lesson [[values]]'s four gates, by which we sort what we see: **Try**
# and **See**.
#
# To escape is not to earn: {{ ends(BOTH)[0] }} of the {{ easy(BOTH).escapers('sac') }} earn more than by
# staying.
# <!-- claim: all(len(easy(kind)) == 20 for kind in (BOTH, CHEAP, MIDDLE)) and
#   DEFAULT.reward.accident == -10 -->
# <!-- claim: all(fisher(easy(one).escapers('sac'), easy(BOTH).escapers('sac'), 20) < 0.001 for one in (MIDDLE,
#   CHEAP)) -->
# <!-- claim: all(easy(stressed(one)).escapers('sac') < 10 for one in (MIDDLE, CHEAP)) and
#   len(easy(stressed(BOTH))) == 20 < 2 * easy(stressed(BOTH)).escapers('sac') -->

# %% [markdown] tags=["instructor"] minutes=4
# To see agents leave, run Round 1's training again on the last road: give `bc.Training` and `bc.evaluate`
# `make_env=easier.costing(1.0, easier.MidLaneStart)`. With *free* accidents {{ easy(FREE).escapers('sac') }}
# of twenty escapes, and all twenty crash on most roads. Ask why this is a poor control: then a crash at once
# may pay more than to stay. `bootcourse study easier` has this road and more. Of twenty agents with a lane
# keeper, which steers for them, none escapes at a price of 10. Why the free lane's middle? The plan's
# steering ends at the road's edge, where a step to the left ends the drive.
# <!-- claim: 0 == easy('a lane keeper').escapers('sac') -->
# <!-- claim: step_to_the_left().accident.all() and step_to_the_left().lasted.max() == 1 -->
# <!-- claim: easy(FREE).escapers('sac') == 1 and crash_on_most(FREE) == 20 -->

# %%
compare_predictions(
    "the_barrier",
    {
        1: f"three to four times as much: {found.best.value / found.idle.value:.1f}",
        2: f"about as many as by chance: {(figures.times_ahead(trained['as it is']) > 0).sum()}",
        3: "both together, neither alone",
    },
)

# %% [markdown]
# ## What you now know
#
# 1. To get out once takes little luck: {{ once_ahead() }} of twenty agents do. To get out and last is rare: none of
#    5,000 random drives did.
# 2. The price decides whether an agent learns from a try. At 10 the agents that fail do not get out more often
#    with time, at 1 they do.
# 3. The way decides how good the first good tries are. From the free lane one acceleration passes the
#    traps.
#
# A demonstration shows the way. Can it make up for a high price, too? In lesson [[your_teacher]] a teacher that
# crashes in every drive answers this.
#
# **Three questions to think about**
# - Which of the two could a demonstration replace, cheap accidents or the free lane?
# - At γ = 0.95 the plan pays. Why may an agent still learn to stay?
# - Where would you let each drive begin, so that an agent learns what a free road is worth?
#
# <details><summary>Answers</summary>
#
# - The free lane: it shows states ahead of the traps. For the price see lesson [[your_teacher]].
# - A learner knows its own drives, not the plan. No random drive that got out is worth more than staying at γ = 0.95.
#   <!-- claim: lucky(0.95).max() < discounted(idle(), 0.95) -->
# - Near the end of a drive that gets out, and then earlier and earlier. A value comes back from visited states.
#
# </details>
#
# **Read on**: Ecoffet et al., *First return, then explore* (arXiv 2004.12919).
#
# It takes affordable tries, and tries that show a free road. Somebody who knows the way could give both.
# [Here](the_rule.ipynb) is somebody who does, if slowly.

# %% [markdown] tags=["instructor"] minutes=4
# **On the board.** Round 3's hill: worth against the seconds of the way out, with the dip that a learner has
# to cross.
#
# **To discuss.** How would you recognise in your own project that a learner sits behind such a hill?
