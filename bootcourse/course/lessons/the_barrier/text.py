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
# - test five explanations of why most agents do not escape, and say what is still open;
# - compute how often chance would end ahead, and what an attempt is worth.
#
# **Time** 37 minutes; running it takes about one minute. **It builds on** the trap of lesson
# [[the_trap]], and on the picture at the beginning of lesson [[discrete_sac]].

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
    shipped,
    table,
)
from bootcourse.course.lessons.the_barrier import (
    attempts,
    easier,
    estimates,
    explorable,
    figures,
)
from bootcourse.research import planner, report

progress("the_barrier")

# %% [markdown]
# ## Look first
#
# How well can one drive here? A planner knows the future: each second it tries all nine actions,
# and keeps the best drives.
# <!-- claim: DEFAULT.clock.decision_rate == 1 and N_ACTIONS == 9 -->

# %%
ROAD = 10
plans = planner.plan_episodes([ROAD], search=planner.Search(beam=50))
planned = bc.record(planner.follow(plans), [ROAD], label="planner")[0]
idle = bc.record(bc.idle_policy, [ROAD], label="idle")[0]
earned = f"{planned.rewards.sum():.0f}, staying {idle.rewards.sum():.0f}"
title = f"The planner goes through between the traps and earns {earned}"
bc.show(bc.top_view_over_time(planned, times=[0, 2, 4, 6, 8, 12], title=title))

# %% [markdown]
# **See.** To **end ahead** of trap 1 pays much more here than staying. Does plain SAC learn it?
# <!-- claim: planned(50, 1.0) > 5 * idle().rewards.sum() -->

# %% [markdown] tags=["instructor"] minutes=3
# Point to the picture after two seconds and ask who would dare to steer between the two cars. What
# does the planner know that a driver does not?

# %% [markdown]
# ## Round 1: does plain SAC escape?
#
# Four agents learn by SAC from their own drives, with {{ easier.UPDATES | , }} updates each. Two
# have the paper's discount, γ = {{ SETTINGS.gamma }}; two look further ahead, γ = 0.95.
# %%
SEEDS, UPDATES = 2, 2000
agents = bc.with_seeds(bc.settings_for("sac"), SEEDS)
agents += bc.with_seeds(bc.settings_for("sac", gamma=0.95), SEEDS)
labels = ["sac, γ = 0.8"] * SEEDS + ["sac, γ = 0.95"] * SEEDS
training = bc.Training(agents, episodes=20_000, learner="compiled")  # SAC as machine code
doing_nothing = {"idle": {"return": idle.rewards.sum()}}
live = live_curves.LiveCurves(labels, measures=("return",), constants=doing_nothing)
alone = training.run(progress=False, callback=live, stop=lambda: training.updates >= UPDATES)
live.show(training)

# %%
tests = [bc.evaluate(agent.as_policy(), 200, seed=5) for agent in alone.agents]
figures.how_they_drive(alone.agents, tests)

# %% [markdown]
# **See.** An agent **escapes** if it ends ahead on {{ 100 * ESCAPES | .0f }} % of the roads or
# more, crashed or not. Of twenty agents like these {{ easy('as it is').escapers('sac') }} escapes.
# <!-- claim: easy('as it is').escapers('sac') == 1 and len(easy('as it is')) == 20 -->
#
# **What keeps most agents from it?** We test five explanations.
#
# - **Staying is best.** At γ = 0.8 a reward in 20 s hardly counts.
# <!-- claim: 0.8 ** 20 < 0.02 and SETTINGS.gamma == 0.8 -->
# - **γ is too small.** To end ahead is best, but it takes a larger γ to learn it.
# - **Luck.** To end ahead takes a rare sequence of actions.
# - **Price.** Most attempts fail, and each costs 10.
# - **Steering.** The way to the free lane takes seconds of steering, which are hard to learn.

# %% [markdown] tags=["instructor"] minutes=8
# The training takes 7 seconds on a free machine: collect explanations for a flat line while it
# runs. Somebody will say "train longer". Let a group do that at home (`UPDATES = 30_000`) and bring
# the curves.

# %% [markdown]
# ## Round 2: is it the discount, or luck?
#
# A learner maximises a discounted sum: the reward after t seconds counts $\gamma^t$. Let the
# planner search for the largest such sum, once with all actions and once in its lane.
#
# > **Predict.** At γ = 0.8, the best drive of all is worth how many times the best one in its lane?
# > (A second behind trap 1 earns {{ idle().rewards[0] | .2f }}, one at 15 m/s up to {{
# tested(THE_PLAN).rewards.max() | .2f }}.)

# %%
choices = ["as much: it stays in the lane", "1.1 times", "2 to 3 times", "about 10 times"]
asked = "The best drive of all is worth how many times the best one in its lane?"
predict("the_barrier.1", asked, choices)

# %%
predicted("the_barrier.1")
rows = []
for gamma in (0.8, 0.95):
    s = planner.is_staying_optimal(range(4), gamma=gamma, beam=50)
    values = [f"{each.value:.2f}" for each in (s.idle, s.keep_lane, s.best)]
    times = f"{s.best.value / s.keep_lane.value:.1f} times"
    rows.append([gamma, *values, times, f"{100 * s.leaves.value:.0f} % of roads"])
headings = ["γ", "doing nothing", "best in lane", "best found", "ratio", "it ends ahead on"]
table(headings, rows, below="Discounted sums from the start, means of four roads.")

# %% [markdown]
# **Explain.** To a planner that knows the future, ending ahead *quickly* pays at γ = 0.8, too. And a
# larger γ is not enough: {{ farther().sum() }} of {{ len(farther())
# }} agents with γ from 0.9 to 0.99 escapes.
# <!-- claim: 2 < times_the_lane(0.8) < 3 -->
# <!-- claim: len(farther()) > 50 and farther().sum() == 1 -->

# %% [markdown] tags=["instructor"] minutes=8
# The planner's number is a lower bound on the best (a beam of 50 can miss the best drive). So "best
# found" above "best in its lane" could be an artefact of a poor search in the lane. Ask how to
# find out: search harder there. With a beam of 200 that value hardly moves.
# <!-- claim: planned(200, 0.8, keep_lane=True) - planned(50, 0.8, keep_lane=True) < 0.01 -->

# %% [markdown]
# So is it luck? Lesson [[the_trap]]'s plan *right 1, left 4, right 3* steers for {{ easier.LATER
# }} s, and then accelerates. Suppose that at each of these decisions `good` of the nine actions are
# right. If one rare sequence is needed, `good` is 1.
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
# Let 5,000 drives take each action at random, for 150 s or until they crash:

# %%
tried = bc.drive_episodes(bc.random_policy(np.random.default_rng(0)), bc.held_out_seeds(6, 5000))
chance_of = own_code.yours_or_ours("luck", doing="Computing")
rows = [[good, f"{5000 * chance_of(good, 8, 1):.1f}"] for good in range(1, 6)]
on_the_road = f"On the road {tried.success.sum()} of 5,000 random drives end ahead of trap 1, "
on_the_road += f"and {100 * np.mean(tried.accident > 0):.0f} % of all end in an accident."
headings = ["right actions of 9, at each of 8 decisions", "of 5,000 drives these end ahead"]
table(headings, rows, below=on_the_road)

# %% [markdown]
# **See.** *Not one rare sequence*: it is as if 4 to 5 of nine actions were right each time.
# <!-- claim: easier.LATER == 8 and 4 < 9 * by_chance().success.mean() ** (1 / 8) < 5 -->
# <!-- claim: (by_chance().accident > 0).all() and len(by_chance().accident) == 5000 -->
#
# > **Predict.** An agent of Round 1 drives about {{ round(np.median(driven()), -2) | .0f }} times
# > while it learns, at first nearly at random. How many of twenty such agents ended ahead at least
# > once? (18 of 5,000, 400 times: your `luck` tells what chance does.)

# %%
choices = ["none or 1", "2 to 5", "about 10", "13 to 18"]
predict("the_barrier.2", "How many of twenty ended ahead at least once?", choices)

# %%
predicted("the_barrier.2")
trained, study = shipped.shipped_experiment("easier"), bc.shipped_results()
by_chance = chance_of(9 * tried.success.mean(), 1, 400)  # one decision: right so often
figures.while_they_learned(trained["as it is"], study.of("sac"), by_chance)

# %% [markdown]
# **Explain.** *{{ once_ahead('as it is') }} of twenty ended ahead at least once, and {{
# easy('as it is').escapers('sac') }} escapes.*
# So most do not lack the luck to end ahead *once*.
# <!-- claim: abs(20 * (1 - np.exp(-400 * by_chance().success.mean())) -
#   once_ahead('as it is')) < 3 -->
# <!-- claim: len(easy('as it is')) == 20 and len(of('sac')) == 10 and
#   once_ahead('as it is') > 15 -->

# %% [markdown]
# ## Round 3: is it the price of attempts?
#
# Lesson [[the_trap]]'s plan crashes on about every fourth road. **Drag** the number of accidents.
# How many in a hundred can it afford before staying is worth more? And at γ = 0.95?
# <!-- claim: 0.2 < tested(THE_PLAN).accident.mean() < 0.3 and attempts.PLAN[:9] == [5] + 4 * [3] +
#   3 * [5] + [7] -->

# %%
explorable.price()

# %% [markdown]
# **See.** At γ = 0.8 it pays with up to {{ may_crash(0.8) }} accidents, at γ = 0.95 with up to {{
# may_crash(0.95) }}. (Lesson [[the_trap]] had {{ may_crash_there(0.8) | .0f }} and {{
# may_crash_there(0.95) | .0f }}, on one road, with an earlier crash.)

# %% [markdown]
# What is an attempt worth? Here are four kinds, and the rule's way:
#
# - *random for 150 s*: one of the nine actions each second;
# - *4 random actions, then accelerates*: to 15 m/s; a *lane keeper* steers;
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
predict("the_barrier.3", "Which of the four kinds are worth more than staying?", choices)

# %%
predicted("the_barrier.3")
TESTED, outcomes = bc.held_out_seeds(7, 500), {}
for name, driver in attempts.kinds(len(TESTED)).items():
    outcomes[name] = attempts.drive(driver, TESTED)
bc.show(figures.worth(outcomes))

# %% [markdown]
# **Explain.** An attempt costs now and pays later. This is part of the **barrier**:
#
# - *A crash costs 10 and ends the drive.* At γ = 0.8 the plan's unhurt drives are worth {{
#   unhurt_plan().mean() | .2f }}, more than staying. With those that crash it is {{
#   tested(THE_PLAN).values(0.8).mean() | .2f }}.
# <!-- claim: (unhurt_plan() > tested('stays').values(0.8)[~tested(THE_PLAN).accident]).all() -->
# <!-- claim: all(tested(kind).values(0.95).mean() < 0 and tested(kind).accident.mean() > 0.85 for
#   kind in UNSKILLED) -->
# - *The reward comes late.* The rule's way has no accident, but falls back first.
#
# *Quick and safe driving pays even at γ = 0.8*: {{ len(helped_better()) }} of {{ len(helped()) }}
# helped agents (five of lesson [[soft_constraint]], five with demonstrations, too) are worth more
# than staying, without knowing the future.
# <!-- claim: all(tested(kind).values(0.8).mean() < tested('stays').values(0.8).mean() for kind in
#   KINDS_OF_ATTEMPTS) -->
# <!-- claim: not tested("the rule's way").accident.any() -->
# <!-- claim: all(tested(kind).values(0.95).mean() > tested('stays').values(0.95).mean() for kind in
#   (THE_PLAN, "the rule's way")) -->

# %% [markdown] tags=["instructor"] minutes=5
# Let them write the worth of each attempt by guesses before the figure is drawn; the guess to
# discuss is that the plan pays at both discounts. Then ask which row an agent resembles at the
# start of its training, and which one in the end.

# %% [markdown]
# ## Round 4: the way, the price, or both?
#
# Twenty agents learn on each of two easier roads, for as long as in Round 1:
#
# - *Mid-lane*, without the steering, wait and risk of the plan's first {{ easier.LATER }} s: an
#   episode begins in the middle of the free lane, behind the traps and as fast as they are.
# - *Accidents cost 1* in place of 10.

# %%
few, rows = bc.held_out_seeds(7, 100), []
for name, driver in easier.drivers(easier.MIDDLE).items():
    mid = attempts.drive(driver, few, easier.MidLaneStart)
    worth = [f"{mid.values(gamma).mean():.2f}" for gamma in (0.8, 0.95, 1.0)]
    shares = [f"{100 * each.mean():.0f} %" for each in (mid.ahead, mid.accident)]
    rows.append([name, *shares, *worth])
headings = ["the drive", "ends ahead", "accidents", "worth at γ = 0.8", "at γ = 0.95", "return"]
table(headings, rows, below=f"Mid-lane, {len(few)} roads each.")

# %% [markdown]
# **See.** One acceleration ends ahead unhurt on each of these roads, and is worth more than
# staying.
# <!-- claim: not easier_outcome(MIDDLE, ONCE).accident.any() and
#   easier_outcome(MIDDLE, ONCE).ahead.all() -->
# <!-- claim: all(worth_of(MIDDLE, ONCE, g) > worth_of(MIDDLE, 'stays', g) for g in (0.8, 0.95)) -->
#
# > **Predict.** How many of the twenty agents escape from *mid-lane*?

# %%
choices = ["none", "about 5: a crash still costs 10", "about 12", "nearly all: one action will do"]
predict("the_barrier.4", "How many of the twenty agents escape from mid-lane?", choices)

# %%
predicted("the_barrier.4")
bc.show(figures.escapes(trained, easier.SHOWN))

# %% [markdown]
# **Explain.** {{ easy(MIDDLE).escapers('sac') }} of twenty agents escape from mid-lane. {{
# straight_on() }} of these drive at {{ straight_speed() | .0f }} m/s and earn less than staying. {{
# as_fast_as_the_traps() }} others stay behind at about 10 m/s, {{ slow(MIDDLE)
# }} drive *slower* than 8 m/s. Where accidents
# cost 1, {{ easy(CHEAP).escapers('sac') }} escape, and crash.
# <!-- claim: easy(MIDDLE).escapers('sac') == straight_on() + 2 and
#   straight_return() < easier.staying(MIDDLE) -->
# <!-- claim: max(second_pays(v) for v in np.arange(17, 26)) < second_pays(15) / 15 and
#   max(np.arange(8, 26), key=second_pays) == 15 -->
# <!-- claim: (easy(CHEAP).scores('accident')[easy(CHEAP).scores('success') >= ESCAPES] > 0.95).all() -->

# %% [markdown]
# Why not faster? One possible reason: a share of a learner's actions is random. **Drag** each number
# alone. Which of them makes the first m/s above 10 pay?

# %%
explorable.landscape()

# %% [markdown]
# **See.** *With half of its actions random, this driver pays for speed*: each m/s from 6 to 12
# costs, as the crash comes sooner. Without random actions this **dip** is gone. A price of 1 makes it
# small, γ = 0.95 does not.
# <!-- claim: (np.diff(worths(0.5)[:7]) < -0.1).all() -->
# <!-- claim: (np.diff(ends_after(0.5)[:7]) < 0).all() and (np.diff(worths(0))[:9] > 0).all() -->
# <!-- claim: costs(0.5, 10, 0.8) and costs(0.5, 10, 0.95) and slope(0.5, 10, 0.95)[0] < -0.5 and
#   abs(slope(0.5, 1, 0.8)[0]) < 0.2 -->
# <!-- claim: explorable.SPEEDS[[0, 4, 6]].tolist() == [6, 10, 12] and
#   slow(MIDDLE) == 6 -->
#
# Do trained agents expect this dip? Four with γ = 0.8 learn from mid-lane:

# %%
bc.show(figures.expectations(estimates.from_mid_lane()))

# %% [markdown]
# **See.** Those that do not escape expect speed to cost, some even where their own drives
# would be worth more.
#
# > **Predict.** Four agents with γ = 0.8 begin mid-lane *and* pay 1 for an accident. How many
# > escape?

# %%
choices = ["none: γ is too small", "1: each change helps few", "3 or 4: the dip is small"]
predict("the_barrier.5", "How many of four escape with both changes?", choices)

# %%
predicted("the_barrier.5")
road = easier.costing(1.0, easier.MidLaneStart)
training = bc.Training(
    bc.with_seeds(bc.settings_for("sac"), 4), episodes=20_000, make_env=road, learner="compiled"
)
both = training.run(progress=False, stop=lambda: training.updates >= UPDATES)
tests = [bc.evaluate(agent.as_policy(), 200, seed=5, make_env=road) for agent in both.agents]
figures.how_they_drive(both.agents, tests)

# %% [markdown]
# **Explain.** *Begin mid-lane or pay 1, and few agents escape. Do both, and most do*: {{
# easy(BOTH).escapers('sac') }} of our twenty. {{ too_fast() }} of these earn less than staying.
# <!-- claim: freed_and_slower().min() > easier.staying(BOTH) -->
#
# **The verdict**
#
# | what could keep agents in | verdict | evidence |
# |---|---|---|
# | at γ = 0.8 staying is best | no | a planner ends ahead; {{ len(helped_better()) }} of {{
#   len(helped()) }} helped agents do better |
# | γ is too small | a larger one is not enough | {{ farther().sum() }} of {{ len(farther())
#   }} agents escapes |
# | luck | to end ahead once: not for most; often, or unhurt: open | {{ once_ahead('as it is')
#   }} of twenty did once |
# | the price of attempts | easing it is not enough | {{ easy(CHEAP).escapers('sac')
#   }} of twenty escape at a price of 1 |
# | the steering | a start beyond it is not enough | {{ easy(MIDDLE).escapers('sac')
#   }} of twenty escape from mid-lane |
# | price, and the way to mid-lane | easing both is enough for most to escape | {{
#   easy(BOTH).escapers('sac') }} of twenty do; {{ easy(BOTH).escapers('sac') - too_fast()
#   }} earn more than staying |
# <!-- claim: len(easy(BOTH)) == 20 and all(stats.fisher_exact([[easy(kind).escapers('sac'), 20 -
#   easy(kind).escapers('sac')] for kind in (one, BOTH)]).pvalue < 0.001 for one in (MIDDLE, CHEAP)) -->
# <!-- claim: all(easy(stressed(one)).escapers('sac') < 10 for one in (MIDDLE, CHEAP)) and
#   len(easy(stressed(BOTH))) == 20 < 2 * easy(stressed(BOTH)).escapers('sac') -->
# <!-- claim: len(easy(CHEAP)) == len(easy(MIDDLE)) == 20 and DEFAULT.reward.accident == -10 and
#   easy(CHEAP).escapers('sac') <= 2 and easy(MIDDLE).escapers('sac') <= 6 -->

# %% [markdown]
# *Still open*: what keeps these estimates low? The dip needs random actions, but in the end the
# study's ten hardly act at random (entropy {{ last_entropy() | .2f }} nats or less).

# %% [markdown] tags=["instructor"] minutes=3
# Ask why free accidents would be a poor control (at γ = 0.8 a crash then pays more than staying),
# and which run would test the temperature. Free accidents, a later start at the road's edge, a
# lane keeper and η = 1 were tried, too: `bootcourse study easier` makes all eight.
# <!-- claim: worth_of('free accidents', RAM, 0.8) > worth_of('free accidents', 'stays', 0.8) and
#   len(easier.KINDS) == 8 -->

# %% [markdown]
# **What helps agents escape?** In the paper it is the rule, as a **soft constraint** (lesson
# [[soft_constraint]]) and by **demonstrations** (lesson [[demonstrations]]):

# %%
curves = {method: study.of(method).curves for method in ("sac", "bootstrapped")}
of_ten = {m: study.of(m).scores("success") >= bc.statistics.ESCAPES for m in curves}
won_alone, won_helped = (each.sum() for each in of_ten.values())
title = f"With the rule's help {won_helped} of 10 agents escape, alone {won_alone} of 10"
level = {"return": report.rule_results(bc.DEFAULT, 200).scores("returns")[0]}
bc.show(bc.training_curves(curves, title, constants={"rule": level}))

# %% [markdown]
# **Slide.** Train plain SAC for a minute, then *soft constraint only*, and move ξ. After how many
# episodes do half of the drives end ahead?

# %%
bc.panels.train_panel("sac", seeds=3, episodes=600)

# %%
compare_predictions(
    "the_barrier",
    {
        1: "2 to 3 times",
        2: f"13 to 18: {figures.once_ahead(trained['as it is']).sum()}",
        3: "the plan at γ = 0.95 alone",
        4: f"about 5: {trained[easier.MIDDLE].escapers('sac')}",
        5: f"3 or 4: {sum(test.success.value >= bc.statistics.ESCAPES for test in tests)}",
    },
)

# %% [markdown]
# ## What you now know
#
# 1. {{ len(of('sac')) - escaped('sac') }} of the study's {{ len(of('sac')) }} agents of plain SAC
#    do not escape.
# 2. It is not the discount alone: at γ = 0.8 quick and safe driving is worth more than staying. With
#    a larger γ, {{ farther().sum() }} of our {{ len(farther()) }} agents escapes.
# 3. Most agents ended ahead at least once, {{ once_unhurt() }} of the study's ten unhurt. At
#    γ = 0.8 our attempts and the rule's way are worth less than staying.
# <!-- claim: all(tested(kind).values(0.8).mean() < tested('stays').values(0.8).mean() for kind in
#   KINDS_OF_ATTEMPTS) -->
# 4. From mid-lane, or with cheap accidents, few agents escape; with both {{
#    easy(BOTH).escapers('sac') }} of twenty do, and {{ easy(BOTH).escapers('sac') - too_fast() }}
#    earn more than staying.
# 5. With the rule as a constraint and as data, most agents of the study escape.
# <!-- claim: escaped('bootstrapped') > len(of('bootstrapped')) / 2 > escaped('sac') -->
#
# **Three questions to think about**
# - With both changes most agents escape. Which of the two could a demonstration replace?
# - How would you test whether random actions keep agents slow?
# - Where would you let each drive begin, so that an agent learns what a free road is worth?
#
# **Read on**: [the rule](the_rule.ipynb). Ecoffet et al., *First return, then explore*
# (arXiv 2004.12919).

# %% [markdown] tags=["instructor"] minutes=5
# **Model answers.**
#
# - *A demonstration* can replace the steering: it shows states ahead of the traps. The price stays.
# - *Random actions.* Let agents begin with a smaller α, or end with a larger target entropy, and
#   count the slow ones. The study's agents begin with actions that are nearly all random; in their
#   last 100 episodes {{ decided() }} of its ten agents of plain SAC have an entropy of 0.01 nat or
#   less. Look at the entropy before you train for longer.
# - *Where to begin.* Near the end of a drive that ends ahead, and then earlier and earlier: a value
#   comes back from states that were visited. It needs a simulator that can begin anywhere.
# <!-- claim: decided() >= 4 -->
# <!-- claim: of('sac').curves['entropy'][:, 0].min() > 2.18 -->

# %% [markdown] tags=["instructor"]
# **On the board.** A hill: value against progress on the way out, with the dip that the learner has
# to cross.
#
# **To discuss.** How would you recognise in your own project that a learner sits behind such a hill?
