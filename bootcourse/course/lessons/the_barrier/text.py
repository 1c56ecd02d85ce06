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
# - test four explanations of why it stays, and say what is still open;
# - compute how often chance would end ahead, and what an attempt is worth.
#
# **Time** 37 minutes; running it takes about one minute. **It builds on** the trap of lesson
# [[the_trap]], and on the picture at the beginning of lesson [[discrete_sac]].

# %%
import itertools

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
    shipped,
    table,
)
from bootcourse.course.lessons.the_barrier import (
    attempts,
    easier,
    explorable,
    figures,
)
from bootcourse.research import planner, report

progress("the_barrier")

# %% [markdown]
# ## Look first
#
# How well can one drive here? A planner gives a lower bound: each second it extends its drives by
# each of the nine actions, and keeps the best 50. It knows the future.
# <!-- claim: DEFAULT.clock.decision_rate == 1 and N_ACTIONS == 9 -->

# %%
ROAD = 10
plans = planner.plan_episodes([ROAD], search=planner.Search(beam=50))
planned = bc.record(planner.follow(plans), [ROAD], label="planner")[0]
idle = bc.record(bc.idle_policy, [ROAD], label="idle")[0]
by_rule = bc.record(bc.rule_policy(bc.DEFAULT), [ROAD], label="rule")[0]
returns = [f"{drive.rewards.sum():.0f}" for drive in (planned, by_rule, idle)]
title = "The planner earns {} on this road, the rule {}, staying {}".format(*returns)
bc.show(bc.traces([idle, by_rule, planned], title, what=("speed", "return")))

# %%
title = "The planner goes through between the two traps"
bc.show(bc.top_view_over_time(planned, times=[0, 2, 4, 6, 8, 12], title=title))

# %% [markdown]
# **See.** The rule falls back first. The planner does not: it accelerates.
# <!-- claim: planned(50, 1.0) > by_rule().rewards.sum() > idle().rewards.sum() -->

# %% [markdown] tags=["instructor"] minutes=3
# Stop the picture after two seconds and ask who would dare to steer between the two cars. What does
# the planner know that a driver does not?

# %% [markdown]
# ## Round 1: does plain SAC escape?
#
# Six agents learn by SAC from their own drives, with {{ easier.UPDATES | , }} updates each. Three
# have the paper's discount, γ = {{ SETTINGS.gamma }}; three look further ahead, γ = 0.95.
# %%
SEEDS, UPDATES = 3, 2000
agents = bc.with_seeds(bc.settings_for("sac"), SEEDS)
agents += bc.with_seeds(bc.settings_for("sac", gamma=0.95), SEEDS)
labels = ["sac, γ = 0.8"] * SEEDS + ["sac, γ = 0.95"] * SEEDS
training = bc.Training(agents, episodes=20_000, learner="compiled")  # SAC as machine code
doing_nothing = {"idle": {"return": idle.rewards.sum()}}
live = live_curves.LiveCurves(labels, measures=("return",), constants=doing_nothing)
alone = training.run(progress=False, callback=live, stop=lambda: training.updates >= UPDATES)
live.show(training)


# %%
def shown(agents, reports):
    """A table of how the agents drive, and how many of them escape."""
    rows = []
    for s, r in zip((agent.settings for agent in agents), reports, strict=True):
        accidents = r.collision.value + r.road_departure.value + r.stoppage.value
        shares = [f"{100 * share:.0f}" for share in (r.success.value, accidents)]
        rows.append([bc.display_name(s.method), s.gamma, s.seed, *shares, f"{r.returns.value:.1f}"])
    headings = ["", "γ", "seed", "success, %", "accidents, %", "return"]
    won = sum(r.success.value >= bc.statistics.ESCAPES for r in reports)
    below = f"{won} of {len(agents)} agents escape. They take their most probable actions."
    return table(headings, rows, below=below)


tests = [bc.evaluate(agent.as_policy(), 200, seed=5) for agent in alone.agents]
shown(alone.agents, tests)

# %% [markdown]
# **See.** On average both kinds earn less than doing nothing. An agent **escapes** if it ends ahead
# on {{ 100 * ESCAPES | .0f }} % of the roads or more, crashed or not. Of twenty trained like yours,
# ten with each γ, {{ easy('as it is').escapers('sac') }} escapes: it crashes on {{ 100 *
# the_escaper('accident') | .0f }} % of the roads, and returns about what doing nothing does. {{
# crashing('as it is') }} crash in more than nine of ten drives, and {{ safe('as it is') }} have
# hardly an accident. Of those {{ safe('as it is') }}, {{ stay_well() }} earn more than 20; the
# others have not learned to stay well yet. Of lesson [[the_trap]]'s ten, trained for longer, {{
# stayed() }} stay.
# <!-- claim: 0 < stay_well() < safe('as it is') -->
# <!-- claim: all(easy('as it is').scores('returns')[[agent['gamma'] == g for agent in
#   easy('as it is').agents]].mean() < 0.6 * idle().rewards.sum() for g in easier.GAMMAS) -->
# <!-- claim: escaped('sac') == easy('as it is').escapers('sac') == 1 and len(of('sac')) == 10 and
#   stayed() / len(of('sac')) > safe('as it is') / 20 and len(easy('as it is')) == 20 -->
# <!-- claim: abs(the_escaper('returns') - idle().rewards.sum()) < 0.5 -->
#
# **What keeps most agents in?** We test four explanations.
#
# - **Staying is best.** At γ = 0.8 a reward in 20 s hardly counts.
# <!-- claim: 0.8 ** 20 < 0.02 and SETTINGS.gamma == 0.8 -->
# - **γ is too small.** To end ahead is best, but it takes a larger γ to learn it.
# - **Luck.** To end ahead takes a rare sequence of actions that an agent does not hit.
# - **Price.** To end ahead pays, but most attempts fail, and each of these costs 10.

# %% [markdown] tags=["instructor"] minutes=8
# The training takes 10 seconds on a free machine: collect explanations for a flat line while it
# runs. Somebody will say "train longer". Let a group do that at home (`UPDATES = 30_000`) and bring
# the curves.

# %% [markdown]
# ## Round 2: is it the discount?
#
# A learner maximises a discounted sum: the reward after t seconds counts $\gamma^t$.
#
# > **Predict.** Each second pays the same, and γ = 0.8. Which share of the discounted sum comes
# > from the seconds that are 5 s ahead or more?

# %%
predict(
    "the_barrier.1", "What share of the sum comes from 5 s ahead or later, at γ = 0.8?", unit="%"
)

# %%
predicted("the_barrier.1")

# %% [markdown]
# **See.** The weights from second n on are $\gamma^n\,(1 + \gamma + \dots)$, so their share of the
# whole sum is $\gamma^n$: {{ 100 * 0.8**5 | .0f }} % from 5 s on; with γ = 0.95, {{ 100 * 0.95**5 |
# .0f }} %.
#
# On road {{ ROAD }} the *rule's* drive is worth less than staying. Is every drive that ends ahead?
# Let the planner search for the largest *discounted* sum.
#
# > **Predict.** At γ = 0.8, does a drive that ends ahead beat the best drive in the lane?

# %%
choices = ["on none of four roads", "on some of them", "on all four"]
predict("the_barrier.2", "On which roads does the best drive end ahead at γ = 0.8?", choices)

# %%
predicted("the_barrier.2")
rows = []
for gamma in (0.8, 0.95):
    s = planner.is_staying_optimal(range(4), gamma=gamma, beam=50)
    values = [f"{each.value:.2f}" for each in (s.idle, s.keep_lane, s.rule, s.best)]
    rows.append([gamma, *values, f"{100 * s.leaves.value:.0f} % of roads"])
headings = [
    "γ",
    "doing nothing",
    "best in lane",
    "the rule's way",
    "best found",
    "the best ends ahead on",
]
table(headings, rows, below="Discounted sums from the start, means of four roads.")

# %% [markdown]
# **Explain.** To end ahead *quickly* pays at γ = 0.8: on each of these four roads the planner's
# best drive ends ahead.

# %% [markdown] tags=["instructor"] minutes=8
# The planner's number is a lower bound on the best (a beam of 50 can miss the best drive). So "best
# found" above "best in its lane" could be an artefact of a poor search in the lane. Ask how to
# find out: search harder there. With a beam of 200 that value hardly moves.
# <!-- claim: planned(200, 0.8, keep_lane=True) - planned(50, 0.8, keep_lane=True) < 0.01 -->

# %% [markdown]
# ## Round 3: is it luck, or the price of attempts?
#
# The plan of lesson [[the_trap]] steers right for 1 s, left for 4 s and right for 3 s, and then
# accelerates. **Drag** the number of accidents. How many in a hundred attempts can it afford before
# staying is worth more, at γ = 0.8, and at γ = 0.95?
# <!-- claim: tested(THE_PLAN).accident.any() and attempts.PLAN[:9] == [5] + 4 * [3] + 3 * [5] + [7]
#   and easier.LATER == 8 -->

# %%
explorable.price()

# %% [markdown]
# If it took one rare sequence to end ahead, how often would chance hit it? The plan steers for {{
# easier.LATER }} s. Suppose that at each of these decisions `good` of the nine actions are right;
# for a single sequence `good` is 1.
#
# **Exercise (5 min, ●●○).** Write the chance that at least one of `tries` random attempts ends
# ahead.


# %%
def luck(good, decisions, tries):
    """The chance that at least one of `tries` attempts is right at each of its decisions.

    good: how many of the 9 actions are right at each decision; all 9 are equally likely.
    """
    # solution: the exercise's own


check.luck(luck)

# %% [markdown]
# > **Predict.** 5,000 drives take each action at random, for 150 s or until they crash. How many are
# > ahead of trap 1 at their end?

# %%
choices = ["none", "about 20", "about 200", "about 1,000"]
predict("the_barrier.3", "How many of 5,000 random drives end ahead of trap 1?", choices)

# %%
predicted("the_barrier.3")
tried = bc.drive_episodes(bc.random_policy(np.random.default_rng(0)), bc.held_out_seeds(6, 5000))
chance_of, rows = own_code.yours_or_ours("luck", doing="Computing"), []
for good in range(1, 6):
    chance = chance_of(good, easier.LATER, 5000)
    rows.append([good, f"{100 * chance:.2f} %", f"{5000 * (good / 9) ** easier.LATER:.2g}"])
headings = ["right actions of 9, at each of 8 decisions", "chance to end ahead", "expected number"]
on_the_road = f"On the road {tried.success.sum()} of 5,000 random drives end ahead of trap 1, "
on_the_road += f"and {100 * np.mean(tried.accident > 0):.1f} % of all end in an accident."
table(headings, rows, below=f"In 5,000 attempts. {on_the_road}")

# %% [markdown]
# **See.** To end ahead does not take one rare sequence: {{ by_chance().success.sum() }} drives do,
# as many as four to five right actions of nine would give. But each of the 5,000 crashes, so this
# test cannot show how rare it is to end ahead *unhurt*.
# <!-- claim: (4 / 9) ** 8 < by_chance().success.mean() < (5 / 9) ** 8 and easier.LATER == 8 -->
# <!-- claim: 1 - (1 - (1 / 9) ** 8) ** 5000 < 0.001 -->
# <!-- claim: (by_chance().accident > 0).all() and len(by_chance().accident) == 5000 -->
#
# What is an attempt worth? Take four kinds, and the rule's way for comparison:
#
# - *random for 150 s*: one of the nine actions each second;
# - *4 random actions, then accelerates*: to 15 m/s, while a *lane keeper*, a few lines of code,
#   steers to the middle of its lane;
# - *random lanes and speeds*: a random wish each second; a lane keeper steers;
# - *one plan, then accelerates*: the plan above.
#
# > **Predict.** Which of these four kinds are worth more, on average, than staying?

# %%
choices = [
    "none at either γ",
    "the plan at γ = 0.95 alone",
    "the plan at both",
    "all but pure chance at γ = 0.95",
]
predict("the_barrier.4", "Which of the four kinds are worth more than staying?", choices)

# %%
predicted("the_barrier.4")
TESTED, outcomes = bc.held_out_seeds(7, 500), {}
for name, driver in attempts.kinds(len(TESTED)).items():
    outcomes[name] = attempts.drive(driver, TESTED)
title = "At γ = 0.8 none of these is worth as much as staying; "
title += "at γ = 0.95 the plan and the rule's way are worth more"
bc.show(figures.worth(outcomes, title))

# %% [markdown]
# **Explain.** A **barrier** is what has to be crossed before anything is gained. In lesson [[values]]
# it was a rare sequence, here it is a loss: at γ = 0.8 the four kinds and the rule's way are worth
# less than staying.
#
# - *A crash ends the drive.* Even if it cost nothing, {{ sum(free(kind) < free('stays') for kind in
#   UNSKILLED) }} of the four kinds would be worth less than staying ({{ min(map(free, UNSKILLED)) |
#   .2f }} to {{ max(map(free, UNSKILLED)) | .2f }}; staying {{ free('stays') | .2f }}).
# <!-- claim: all(free(kind) < free('stays') for kind in UNSKILLED) and free(THE_PLAN) >
#   free('stays') -->
# - *It costs 10.* Unhurt, the plan's drives are worth {{ unhurt_plan().mean() | .2f }}, more than
#   staying; with the {{ 100 * tested(THE_PLAN).accident.mean() | .0f }} % that crash, {{
#   tested(THE_PLAN).values(0.8).mean() | .2f }}. (In the panel it pays up to {{ may_crash(0.8) }} %
#   at γ = 0.8, {{ may_crash(0.95) }} % at 0.95.)
# <!-- claim: (unhurt_plan() > tested('stays').values(0.8)[~tested(THE_PLAN).accident]).all() -->
# <!-- claim: all(tested(kind).values(0.95).mean() < 0 and tested(kind).accident.mean() > 0.85 for
#   kind in UNSKILLED) -->
# - *The gain comes late.* The rule's way has no accident, but falls back first.
# <!-- claim: all(tested(kind).values(0.8).mean() < tested('stays').values(0.8).mean() for kind in
#   KINDS_OF_ATTEMPTS) -->
# <!-- claim: not tested("the rule's way").accident.any() -->
# <!-- claim: all(tested(kind).values(0.95).mean() > tested('stays').values(0.95).mean() for kind in
#   (THE_PLAN, "the rule's way")) -->
#
# Other attempts are as blind: the first six actions of the planner's best drive on one road, then
# the lane keeper. The roads 0 to 11 give {{ len(openings()) }} different openings. Two are clearly
# worth more than staying, one about as much, two less. The best, *{{ in_words(1) }}*, is worth {{
# openings()[0].values(0.8).mean() | .2f }}, crashes on {{ 100 * openings()[0].accident.mean() |
# .1f }} % of the roads, and returns {{ openings()[0].values(1.0).mean() | .0f }}: as much as the
# planner on road 10. With steps of 0.1 s (lesson [[the_trap]]) it crashes on {{ 100 * six_actions(1,
# 0.1).accident.mean() | .0f }} %, and is still worth {{ six_actions(1, 0.1).values(0.8).mean() | .2f
# }}. So there is a way out that needs no look at the road, and our agents do not hit it.
# <!-- claim: abs(openings()[0].values(1.0).mean() - planned(50, 1.0)) < 5 -->
# <!-- claim: [above_staying(each) for each in openings()] == [1, 1, 0, -1, -1] -->
# <!-- claim: above_staying(six_actions(1, 0.1)) == 1 and DEFAULT.clock.dt == 0.5 and
#   six_actions(1).values(0.8).mean() == openings()[0].values(0.8).mean() -->

# %% [markdown] tags=["instructor"] minutes=5
# Let them write the worth of each attempt by guesses before the figure is drawn; the guess to
# discuss is that the plan pays at both discounts. Then ask which row an agent resembles at the
# start of its training, and which one in the end.

# %% [markdown]
# ## Round 4: do agents escape from an easier trap?
#
# {{ easier.UPDATES | , }} updates are short: most of Round 1's twenty have not even learned to
# stay. So this tests who escapes early, not who never would. Two changes make the road easier:
# <!-- claim: below_staying('as it is') > 10 and len(easy('as it is')) == 20 -->
#
# - *mid-lane*: an episode begins after the plan's {{ easier.LATER }} seconds of steering, in the
#   middle of the free lane, behind the traps and as fast as they are;
# - *accidents cost 1* in place of 10.

# %%
few, rows, staying = bc.held_out_seeds(7, 100), [], {"as it is": idle.rewards.sum()}
drives = {road: dict(easier.drivers(road)) for road in (easier.MIDDLE, easier.CHEAP)}
straight_on = drives[easier.CHEAP]["accelerates into trap 1"]
drives[easier.MIDDLE]["accelerates straight on"] = straight_on
for road, drivers in drives.items():
    for name, driver in drivers.items():
        outcome = attempts.drive(driver, few, easier.KINDS[road][0])
        worth = [f"{outcome.values(gamma).mean():.2f}" for gamma in (0.8, 0.95, 1.0)]
        rows.append([road.split(", ")[-1], name, f"{100 * outcome.accident.mean():.0f} %", *worth])
        staying[road] = outcome.values(1.0).mean() if name == "stays" else staying[road]
headings = ["the road", "the drive", "accidents", "worth at γ = 0.8", "worth at γ = 0.95", "return"]
table(headings, rows, below=f"{len(few)} roads each.")

# %% [markdown]
# **See.** From mid-lane one acceleration ends ahead unhurt on each road and is worth more than
# staying, at both discounts, if nothing after it goes wrong.
# <!-- claim: not easier_outcome(MIDDLE, ONCE).accident.any() and
#   easier_outcome(MIDDLE, ONCE).ahead.all() -->
# <!-- claim: all(worth_of(MIDDLE, ONCE, g) > worth_of(MIDDLE, 'stays', g) for g in (0.8, 0.95)) -->
#
# > **Predict.** Twenty agents learn on each of these roads, as in Round 1. How many escape from
# > *mid-lane* and earn more than staying?

# %%
choices = ["none", "1 to 4", "about 10", "nearly all"]
predict("the_barrier.5", "How many of the twenty escape from mid-lane and earn more?", choices)

# %%
predicted("the_barrier.5")
trained = shipped.shipped_experiment("easier")
panels = {f"γ = {gamma}": {} for gamma in easier.GAMMAS}
for gamma, road in itertools.product(easier.GAMMAS, staying):
    ends = figures.ends(trained[road], gamma, staying[road])
    panels[f"γ = {gamma}"][road.split(", ")[-1]] = ends
paying = {road: figures.paying(trained[road], staying[road]).sum() for road in staying}
title = f"After {easier.UPDATES:,} updates at most {max(paying.values())} of 20 "
title += "escape and earn more than staying"
bc.show(figures.squares(panels, title, figures.AGENTS, "has an accident on most roads"))

# %% [markdown]
# **Explain.** {{ easy(MIDDLE).escapers('sac') }} of twenty agents escape from mid-lane. (Staying
# returns {{ staying_return(MIDDLE) | .1f }}.)
#
# | | return | worth at their γ |
# |---|---|---|
# | {{ len(going_straight(0.8)) }} with γ = 0.8, straight on to {{ straight_speed() | .0f
#   }} m/s | {{ straight_return() | .1f }} | {{ going_straight(0.8)[0] | .2f }} (staying: {{
#   worth_of(MIDDLE, 'stays', 0.8) | .2f }}) |
# | {{ len(going_straight(0.95)) }} with γ = 0.95, straight on | {{
#   straight_return() | .1f }} | {{ going_straight(0.95)[0] | .2f }} ({{
#   worth_of(MIDDLE, 'stays', 0.95) | .2f }}) |
# | {{ len(slower()) }} with γ = 0.95, slower | {{ slower()[0] | .1f }}, {{ slower()[1] | .1f
#   }} | not measured |
#
# From 17 m/s on speed pays next to nothing: those that go straight on rush through the best pay and
# stay too fast. The discounted sum, which agents maximise, counts the first seconds most: at γ =
# 0.8 this drive is above staying.
# <!-- claim: paying(MIDDLE) == len(slower()) == 2 and paying('as it is') == 0 and
#   easy(MIDDLE).escapers('sac') == straight_on() + len(slower()) -->
# <!-- claim: straight_on() == len(going_straight(0.8) + going_straight(0.95)) and
#   going_straight(0.8)[0] > worth_of(MIDDLE, 'stays', 0.8) and going_straight(0.95)[0] <
#   worth_of(MIDDLE, 'stays', 0.95) and straight_return() < staying_return(MIDDLE) -->
# <!-- claim: max(second_pays(v) for v in np.arange(17, 26)) < second_pays(15) / 15 and
#   max(np.arange(8, 26), key=second_pays) == 15 -->
#
# **Try.** If 5 % of an agent's later actions are random, how many accelerations in a row does it
# take until they pay at γ = 0.8?

# %%
ACCELERATIONS = 1  # yours: 2, 3, 4, 5
many, rows = bc.held_out_seeds(7, 2000), []
for share in (0, 0.05, 0.1, 0.2, 0.5, 1):
    two = attempts.stays_and_accelerates(ACCELERATIONS, share, many, easier.MidLaneStart)
    more = [two[1].values(gamma) - two[0].values(gamma) for gamma in easier.GAMMAS]
    adds = [f"{each.mean():+.2f} ± {each.std() / np.sqrt(len(many)):.2f}" for each in more]
    rows.append([f"{100 * share:.0f} %", *adds])
below = f"Mid-lane, 2,000 roads: what {ACCELERATIONS} × accelerating adds to doing nothing, ± its "
below += "standard error. Each action after these is random with this probability."
table(["random actions", "adds at γ = 0.8", "adds at γ = 0.95"], rows, below=below)

# %% [markdown]
# **Explain.** It takes three. At γ = 0.8:
#
# | accelerations | add at 5 % of random actions | at 50 % | at 100 % |
# |---|---|---|---|
# | 1 | {{ adds(1) }} |
# | 2 | {{ adds(2) }} |
# | 3 | {{ adds(3) }} |
# | 4 | {{ adds(4) }} |
# | 5 | {{ adds(5) }} |
# <!-- claim: costs(1, 0.05, 0.8) and not gains(2, 0.05, 0.8) and gains(3, 0.05, 0.8) -->
#
# One acceleration buys 1 m/s and little pay; from 12.5 m/s on, speed pays steeply. *Four in a row
# pay even if each later action is random*, and one to three cost: the accident comes sooner. An
# agent begins near the last column, and takes four in a row once in {{ 9**4 | , }} drives.
# <!-- claim: second_pays(11) - second_pays(10) < 0.03 and second_pays(12.5) - second_pays(10) < 0.1
#   and second_pays(15) - second_pays(12.5) > 0.7 -->
# <!-- claim: all(costs(times, share, g) for times in (1, 2) for share in (0.5, 1) for g in (0.8,
#   0.95)) and costs(3, 0.5, 0.8) and costs(3, 1, 0.8) and all(gains(times, share, g) for times in
#   (4, 5) for share in (0.5, 1) for g in (0.8, 0.95)) -->
# <!-- claim: sooner() > 1 and of('sac').curves['entropy'][:, 0].min() > 2.18 -->

# %% [markdown]
# **The verdict**
#
# | what could keep agents in | verdict | evidence |
# |---|---|---|
# | at γ = 0.8 staying is best | ruled out | even six fixed actions, then a lane keeper, are worth {{
#   six_actions(1).values(0.8).mean() | .2f }}, staying {{ tested('stays').values(0.8).mean() | .2f
#   }} |
# | γ is too small | not by itself | none of {{ len(farther()) }} agents with a larger γ escapes |
# | missing one rare sequence | to end ahead: ruled out | {{ by_chance().success.sum()
#   }} of 5,000 random drives end ahead |
# | the same, to end ahead unhurt | open; with a lane keeper ruled out | none of 5,000; {{ unhurt(FOUR)
#   }} of 500 after 4 random actions, then with a lane keeper |
# | the price of failed attempts | in part: it keeps agents from trying | at a price of 1, {{
#   crash_mostly(CHEAP) }} of twenty agents crash on most roads, at 10, {{ crash_mostly('as it is')
#   }}; {{ often_ahead(CHEAP) }} and {{ often_ahead('as it is') }} end ahead on 10 % or more; {{
#   easy(CHEAP).escapers('sac') }} and {{ easy('as it is').escapers('sac') }} escape |
# <!-- claim: len(farther()) > 20 and not farther().any() -->
# <!-- claim: stats.fisher_exact([[often_ahead(kind), 20 - often_ahead(kind)] for kind in (CHEAP,
#   'as it is')]).pvalue < 0.01 and len(easy(CHEAP)) == 20 and DEFAULT.reward.accident == -10 -->
# <!-- claim: hurt_ahead(CHEAP) > 0.5 and hurt_ahead('as it is') > 0.5 and
#   easy(CHEAP).escapers('sac') <= easy('as it is').escapers('sac') + 1 -->

# %% [markdown]
# We have *not* shown what else keeps agents in. Two suspects:
#
# - *Luck and price together.* While most actions are random, four accelerations in a row pay, but
#   each shorter beginning of them costs.
# - *The thermostat.* SAC lowers its temperature α, so that the agent soon acts hardly at random
#   (with the paper's η = −1 down to 0, lesson [[discrete_sac]]). With η = 1 {{
#   often_ahead('a later start, η = 1') }} of twenty agents that begin at the free lane's edge end
#   ahead on 10 % of the roads or more, with η = −1 {{ often_ahead('a later start') }}: a hint (p =
#   {{ hint() | .2f }}). But {{ len(larger_entropy()) }} agents of the study have η = 0.3 or 1, and
#   stay.
# <!-- claim: hint() > 0.05 and not often_ahead('a later start') -->
# <!-- claim: (abs(larger_entropy() - idle().rewards.sum()) < 3).all() -->

# %% [markdown] tags=["instructor"] minutes=3
# Ask why free accidents would be a poor control (at γ = 0.8 a crash then pays more than staying),
# and which run would test the two suspects. Free accidents, a later start at the road's edge, a
# lane keeper and η = 1 were tried, too: `bootcourse study easier` makes all seven.
# <!-- claim: worth_of('free accidents', RAM, 0.8) > worth_of('free accidents', 'stays', 0.8) and
#   len(easier.KINDS) == 7 -->

# %% [markdown]
# ## What helps agents escape?
#
# In the paper the rule helps, as a **soft constraint** (lesson [[soft_constraint]]) and by
# **demonstrations** (lesson [[demonstrations]]):

# %%
study = bc.shipped_results()
curves = {method: study.of(method).curves for method in ("sac", "bootstrapped")}
of_ten = {m: study.of(m).scores("success") >= bc.statistics.ESCAPES for m in curves}
won_alone, won_helped = (each.sum() for each in of_ten.values())
title = f"With the rule's help {won_helped} of 10 agents escape, alone {won_alone} of 10"
level = {"return": report.rule_results(bc.DEFAULT, 200).scores("returns")[0]}
bc.show(bc.training_curves(curves, title, constants={"rule": level}))

# %% [markdown]
# **See.** A thick line is the mean of the middle half: it hides agents that end low. Near
# episode 1,000 helped agents end ahead less often: lesson [[found_and_kept]] asks why.

# %% [markdown]
# **Slide.** Train plain SAC for a minute, then *soft constraint only*, and move ξ. After how many
# episodes do half of the drives end ahead? (In the study from about episode {{
# half_ahead('soft') }} on.)

# %%
bc.panels.train_panel("sac", seeds=3, episodes=600)

# %%
compare_predictions(
    "the_barrier",
    {
        1: round(100 * 0.8**5, 1),
        2: "on all four",
        3: f"{tried.success.sum()}: about 20",
        4: "the plan at γ = 0.95 alone",
        5: f"1 to 4: {paying[easier.MIDDLE]}",
    },
)

# %% [markdown]
# ## What you now know
#
# 1. {{ len(of('sac')) - escaped('sac') }} of the study's {{ len(of('sac')) }} agents of plain SAC
#    do not escape.
# 2. At γ = 0.8 our four kinds of attempts and the rule's way are worth less than staying: they
#    crash, or gain late. Two other blind ones are worth more.
# <!-- claim: all(tested(kind).values(0.8).mean() < tested('stays').values(0.8).mean() for kind in
#   KINDS_OF_ATTEMPTS) -->
# 3. With a larger γ alone none of {{ len(farther()) }} agents escapes. Where accidents cost 1, more
#    end ahead; there and from mid-lane few escape and earn more than staying in {{
#    easier.UPDATES | , }} updates. What else keeps them in is open.
# <!-- claim: all(paying(kind) <= 2 and len(easy(kind)) == 20 for kind in ('as it is', MIDDLE,
#   CHEAP)) and often_ahead(CHEAP) > often_ahead('as it is') and not farther().any() -->
# 4. With the rule as a constraint and as data, most agents of the study escape.
# <!-- claim: escaped('bootstrapped') > len(of('bootstrapped')) / 2 > escaped('sac') -->
#
# **Three questions to think about**
# - Which of the four explanations would you test next, and by which run?
# - In which row of the table of random actions does an agent begin, in which does it end? Where
#   does one acceleration cost although five gain?
# - Where would you let each drive begin, so that an agent learns what a free road is worth?
#
# **Read on**: [the rule](the_rule.ipynb). Ecoffet et al., *First return, then explore*
# (arXiv 2004.12919).

# %% [markdown] tags=["instructor"] minutes=5
# **Model answers.**
#
# - *On the road.* The rule's drives show a way that is worth less than staying at γ = 0.8, states
#   are 26 numbers and rarely come twice, and the networks carry an error from one state to the
#   next.
# - *Where to begin.* Near the end of a drive that ends ahead, and then earlier and earlier: a value
#   comes back from states that were visited. It needs a simulator that can begin anywhere.
# - *From the last row to the first.* It begins near the last. In their last 100 episodes {{
#   decided() }} of the study's ten agents of plain SAC have an entropy of 0.01 nat or less, so they
#   draw one action again and again: the first row. From 5 % of random actions on
#   one acceleration costs and five in a row gain. For an agent that stays afterwards, Q compares
#   one acceleration with none, so it can learn that accelerating costs. More training alone shows a
#   decided agent nothing new: look at the entropy first.
# <!-- claim: decided() >= 4 -->
# <!-- claim: all(costs(1, share, 0.8) and gains(5, share, 0.8) for share in (0.05, 0.1, 0.2, 0.5,
#   1)) -->

# %% [markdown] tags=["instructor"]
# **On the board.** A hill: value against progress on the way out, with the dip that the learner has
# to cross.
#
# **To discuss.** How would you recognise in your own project that a learner sits behind such a hill?
