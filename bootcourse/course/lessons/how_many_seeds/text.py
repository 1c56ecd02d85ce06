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
# # How many seeds?
#
# **What you will be able to do**
# - put an interval on "eight of ten agents escape", and on their mean return;
# - say how many agents a comparison needs, before you train them;
# - run an ablation of your own, and say what five seeds show.
#
# **Time** 75 minutes, of which the machine needs about one. **It builds on** the soft constraint
# (lesson [[soft_constraint]]) and learning from demonstrations ([[learning_from_demonstrations]]).

# %%
import bootcourse as bc
import numpy as np
import scipy.stats
from bootcourse.course import (
    check,
    compare_predictions,
    predict,
    predicted,
    progress,
    shipped,
    table,
)
from bootcourse.course.lessons.how_many_seeds import explorable
from bootcourse.course.lessons.how_many_seeds import figures as figures_seeds
from bootcourse.research import figures, paper, tables

progress("how_many_seeds")

# %% [markdown]
# ## Look first
#
# Here are two agents of plain SAC on one road. They differ in the *seed* of their random numbers
# alone.
# <!-- claim: len({tuple((k, str(v)) for k, v in agent.items() if k != 'seed') for agent in
#   of('sac').agents}) == 1 -->

# %%
for agent in (bc.shipped_agents("sac")[i] for i in (0, 3)):
    drive = bc.record(agent.as_policy(), [10], label=f"sac, seed {agent.settings.seed}")[0]
    end, passed = drive.times[-1], bc.overtaken(drive)
    words = f"is ahead of trap 1 after {passed:.0f} s" if passed else "stays behind trap 1"
    words += f" and earns {drive.rewards.sum():.0f}"
    title = f"Plain SAC, seed {agent.settings.seed}, {words}"
    bc.show(bc.top_view_over_time(drive, times=[passed or end], title=title))

# %% [markdown]
# Had you trained the second one alone, you would write that plain SAC leaves the trap. Of our ten,
# the other nine do not. How many agents do you need before such a sentence is worth printing?
# <!-- claim: escaped('sac') == 1 -->
#
# The question matters most in an **ablation**: leave out one part of a method at a time, train
# again, and see what gets worse. The paper's method has two parts, the soft constraint and the
# demonstrations, so there are four methods: neither (plain SAC), each alone, and both.
#
# > **Predict.** Eight of ten agents with the soft constraint alone escape. Suppose that each agent
# > escapes with the same probability p. What is the smallest p with which eight or more of ten
# > escape in at least 2.5 % of all studies? `scipy.stats.binom.sf(7, 10, p)` is this share: try.
# <!-- claim: escaped('soft') == 8 and len(of('soft')) == 10 -->

# %%
predict(
    "how_many_seeds.1",
    "What is the smallest p with which 8 or more of 10 escape in 2.5 % of all studies?",
    unit="%",
)

# %% [markdown] tags=["instructor"] minutes=4
# Ask how many of them have published or handed in a figure with one training behind each line.

# %% [markdown]
# ## Round 1: who escapes?
#
# Each agent drives roads that it has never seen, by its most probable action. It *escapes* if it
# ends ahead of trap 1 on at least {{ 100 * ESCAPES | .0f }} % of them.

# %%
predicted("how_many_seeds.1")
methods = ("sac", "soft", "demos", "bootstrapped")
study = bc.shipped_results()
agents, episodes = len(study.of("sac")), study.curves["success"].shape[1]
roads = study.tested["success"].shape[1]
print(f"{agents} agents of each method, {episodes:,} training episodes, {roads:,} held-out roads")
bc.show(figures_seeds.who_escapes(study, methods))

# %% [markdown]
# Training works or fails, so a method's success is a number of agents. Eight of ten with the soft
# constraint escape: what does that say about agents that nobody has trained yet?
# <!-- claim: escaped('soft') == 8 and [round(100 * each) for m in ('sac', 'soft', 'demos',
#   'bootstrapped') for each in of(m).scores('success') if 0.1 < each < 0.95] == [92] -->
#
# **Drag** the number of agents. How many of them make the interval half as wide as ten do?

# %%
explorable.certainty()

# %% [markdown]
# About {{ half_as_wide() }} do: four times as many.
# <!-- claim: half_as_wide() == 40 -->
#
# The **exact interval** (Clopper and Pearson's) of k out of n holds every rate with which the
# observed k would not be too improbable. At its low end, k *or more* out of n have a chance of
# 2.5 %; at its high end, k *or fewer* have.
#
# **Exercise (8 min, ●●○).** Write it. `scipy.stats.beta.ppf(q, a, b)` is where a beta
# distribution reaches q, and solves both: a = k, b = n − k + 1 for the low end, a = k + 1, b = n −
# k for the high one. Mind k = 0 and k = n.
# <!-- claim: rate(np.zeros(10)).low == 0 -->
#
# <details><summary>Why a beta distribution?</summary>
#
# Draw n numbers between 0 and 1 uniformly, and call a number at or below p a success. Then k or
# more successes means that the k-th smallest number is at or below p. That number has the beta
# distribution with a = k and b = n − k + 1, so its value at 2.5 % is the low end.
#
# </details>


# %%
def exact_interval(k, n):
    """The exact 95 % interval of a rate, from k of n: two whole numbers -> (2,), low and high."""
    # solution: the exercise's own


check.exact_interval(exact_interval)

# %% [markdown]
# The paper does not print how many test drives stand behind its rates, or how many agents. For
# one method it prints accidents of {{ PRINTED['gail']['collision'].mean }} ± {{
# PRINTED['gail']['collision'].sd }} %: what one accident in {{ EPISODES }} drives gives. Take each
# row as *one* agent that drove {{ EPISODES }} times:
# <!-- claim: (lambda x: round(x.mean(), 2) == PRINTED['gail']['collision'].mean and
#   round(x.std(ddof=1), 2) == PRINTED['gail']['collision'].sd)(100.0 * (np.arange(EPISODES) < 1))
#   -->

# %%
rows = []
for method in methods:
    won = study.of(method).scores("success") >= bc.statistics.ESCAPES
    printed = paper.PRINTED[method]["success"].mean
    one = np.array([printed >= 100 * bc.statistics.ESCAPES])  # does the one agent escape?
    low, high = scipy.stats.binomtest(int(one.sum()), 1).proportion_ci()  # the exact interval
    theirs = f"{one.sum()} of 1 ({100 * low:.0f} to {100 * high:.0f} %)"
    rows.append([bc.display_name(method), tables.k_of_n(won), f"{printed:g} %", theirs])
drives = f"the paper's success, {paper.EPISODES} drives"
table(["", "agents that escape (95 %)", drives, "if one agent drove them all"], rows)

# %% [markdown]
# **See.** Two rows look opposite: the soft constraint alone, and the demonstrations alone. Neither
# has to contradict the paper: with one agent of the paper behind it, its two intervals overlap.
# Twenty drives of one agent are *one* sample, not twenty, of how often training succeeds.
# <!-- claim: escaped('soft') == 8 and escaped('demos') == 0 -->
# <!-- claim: all((lambda ours, theirs: ours.low < theirs.high and theirs.low < ours.high)(
#   escapes(of(m).scores('success')), rate(np.array([PRINTED[m]['success'].mean >= 95]))) for m in
#   ('sac', 'soft', 'demos', 'bootstrapped')) -->

# %% [markdown] tags=["instructor"] minutes=6
# Let them vote before the figure and keep the votes. What is the sample here: a drive, or a
# training? Which sentences of the paper's abstract does this table support?

# %% [markdown]
# ## Round 2: how many agents does it take?
#
# Suppose that the paper's agents and ours do differ. One possible reason is where the KL of the
# soft constraint enters. Our learner subtracts it in the critic's target, too (lesson
# [[soft_constraint]], round 4). Ten more agents of both methods had it in the actor's loss alone:

# %%
elsewhere = shipped.shipped_experiment("ablations")["KL in the actor only"]
kinds = {"in target and actor": study, "in the actor only": elsewhere}
rows = [
    [bc.display_name(m), *(tables.escaped(agents_of, m) for agents_of in kinds.values())]
    for m in ("soft", "bootstrapped")
]
table(["agents that escape, the KL ...", *kinds], rows)

# %% [markdown]
# These counts show no effect of the place. Would ten agents against ten show one? *Fisher's exact
# test* compares two such counts. Its **p value** is the probability of a split at least as
# improbable as the observed one, if both groups escape equally often, given how many of all agents
# escaped. A p below 0.05 counts as a difference.
#
# > **Predict.** The true rates are 80 and 30 %. You train ten agents of each. In how many of 100
# > such studies does Fisher's test find the difference? It tells 8 of ten from 2 of ten,
# > p = {{ fisher(8, 2) | .2f }}, but not from 3 of ten, p = {{ fisher(8, 3) | .2f }}.
# <!-- claim: max(p_changed(m) for m in ('soft', 'bootstrapped')) > 0.5 -->

# %%
predict(
    "how_many_seeds.2",
    "How many of 100 studies, ten against ten, find the difference?",
    unit="of 100",
)

# %% [markdown]
# This share is the **power** of the comparison. You can compute it before you train anything.
#
# **Exercise (12 min, ●●○).** Write it. The number of agents that escape has a binomial
# distribution in each group. `shown[k, j]` says whether the test tells k of n from j of n.


# %%
def power(first, second, shown):
    """How often a test finds it: two true rates, shown (n + 1, n + 1) bool -> 0 to 1."""
    # solution: the exercise's own


check.power(power)

# %%
predicted("how_many_seeds.2")
bc.show(figures_seeds.powers(((0.8, 0.3), (0.8, 0.6)), (3, 5, 8, 10, 12, 15, 20, 25, 30)))

# %% [markdown]
# **See.** Ten against ten find even this large difference in {{ 100 * power(0.8, 0.3, 10) | .0f }}
# % of the studies. A power of 80 % needs {{ enough(0.8, 0.3) }} agents of each.
# <!-- claim: power(0.8, 0.3, 10) < 0.5 -->
# Fisher's test is cautious: where both rates are 80 %, it errs in {{ 100 * power(0.8, 0.8, 10) |
# .1f }} % of these studies, not in 5. `scipy.stats.boschloo_exact` finds 80 against 30 % in
# {{ 100 * boschloo(0.8, 0.3, 10) | .0f }} %, and needs {{ enough_by_boschloo(0.8, 0.3) }} of each.
# <!-- claim: power(0.8, 0.8, 10) < boschloo(0.8, 0.8, 10) < 0.05 -->
#
# So what does our table say? The KL's place does not bring the rate near the paper's 0 %: with the
# KL in the actor's loss only, nine of ten agents with the soft constraint escape, and their exact
# interval begins at {{ 100 * in_actor_only().low | .0f }} %. A moderate effect, such as 80 against
# 60 %, ten agents would rarely show.
# <!-- claim: in_actor_only().value == 0.9 and in_actor_only().low > 0.5 and
#   PRINTED['soft']['success'].mean == 0 and
#   power(0.8, 0.6, 10) < 0.4 -->
#
# ### Many comparisons
#
# The opposite error is to see a difference where there is none. If twelve independent comparisons
# have no true difference behind them, and each test errs in 5 % of the cases, at least one p is
# below 0.05 with a chance of {{ 100 * (1 - 0.95**12) | .0f }} %. This is **multiplicity**. Say
# beforehand which comparison counts; or multiply each p by the number of comparisons (Bonferroni).
# *Holm's* way finds more:
#
# 1. Sort the p values, the smallest first.
# 2. Multiply the first by their number n, the second by n − 1, and so on.
# 3. If one comes out below the one before it, replace it by that one; if above 1, by 1.

# %%
# NBVAL_CHECK_OUTPUT
p, times = np.sort([0.024, 0.004, 0.030]), np.array([3, 2, 1])  # of three comparisons
after = np.minimum(np.maximum.accumulate(p * times), 1)
rows = [
    [f"{a:.3f}", t, f"{b:.3f}", f"{min(3 * a, 1):.3f}"]
    for a, t, b in zip(p, times, after, strict=True)
]
table(["p", "times", "after Holm", "after Bonferroni"], rows)

# %% [markdown] tags=["instructor"] minutes=6
# Let each group name a difference that it would care about, and look up the number of agents.
# `bc.statistics.power(0.8, 0.6, 80)` takes some seconds. Then ask what to do if only ten can be
# trained: choose a change with a larger effect, or a score that is not yes or no.

# %% [markdown]
# ## Round 3: one number, and how sure it is
#
# > **Predict.** Seven of ten agents earn about the same, and three do badly. Which number changes
# > most if one more does badly: the mean, the median, or the mean of the middle six?

# %%
choices = ["mean", "median", "mean of the middle six"]
predict("how_many_seeds.3", "What changes most if one more does badly?", choices)

# %% [markdown]
# The mean of the middle half is called **interquartile mean** (IQM). It leaves out the highest and
# the lowest quarter and uses half of the agents, a median one or two.
#
# **Exercise (5 min, ●○○).** Write it. A quarter is rounded down: of ten scores, six are left.


# %%
def interquartile_mean(scores):
    """The mean without the lowest and the highest quarter: (agents,) -> a number."""
    # solution: the exercise's own


check.interquartile_mean(interquartile_mean)

# %%
predicted("how_many_seeds.3")
returns = np.sort(study.of("bootstrapped").scores("returns"))
worse = np.append(returns[:-1], returns[0])  # the best agent earns what the worst one earns
numbers = {"mean": np.mean, "median": np.median, "IQM": bc.statistics.iqm}
falls = {name: float(f(returns) - f(worse)) for name, f in numbers.items()}
rows = [
    [name, f"{f(returns):.1f}", f"{f(worse):.1f}", f"{falls[name]:.1f}"]
    for name, f in numbers.items()
]
below = "The agents' returns: " + ", ".join(f"{each:.0f}" for each in returns) + "."
headings = ["bootstrapped agents", "return", "if the best crashed, too", "falls by"]
table(headings, rows, below=below)

# %% [markdown]
# **See.** The IQM falls most. It leaves out two agents at each end, so the third low agent counts
# already, and a fourth takes the place of a high one. An IQM resists an outlier or two; it does not
# resist a second group. So our tables also count agents.
# <!-- claim: (lambda r, w: iqm(r) - iqm(w) > r.mean() - w.mean() > np.median(r) - np.median(w))(
#   np.sort(of('bootstrapped').scores('returns')),
#   np.sort(of('bootstrapped').scores('returns'))[[0, *range(9)]]) -->
# <!-- claim: np.diff(np.sort(of('bootstrapped').scores('returns'))).max() > 40 and
#   (of('bootstrapped').scores('returns') < 60).sum() == 3 -->
#
# > **Predict.** Somebody repeats the study of the bootstrapped agents with ten other seeds. By how
# > much might their mean return differ from ours: by 2, by 10, by 50?

# %%
predict(
    "how_many_seeds.4", "By how much may a repetition differ, in 95 of 100 cases?", unit="of return"
)

# %% [markdown]
# The computer imitates a repetition. Draw ten agents out of our ten *uniformly with replacement*:
# some come twice or more, and others are left out. Take their mean. Do this some thousand times.
# The middle 95 % of these means are the **bootstrap interval**. Bootstrapped SAC has nothing to do
# with it.
#
# **Exercise (7 min, ●●○).** Write it. The draws are given. Every usual way to interpolate a
# percentile is right.


# %%
def bootstrap_interval(scores, draws):
    """95 % interval of the mean: scores (n,), draws (resamples, n) whole numbers 0..n-1 -> (2,)."""
    # solution: the exercise's own


check.bootstrap_interval(bootstrap_interval)

# %% tags=["hide-input"]
predicted("how_many_seeds.4")
others, rows = shipped.shipped_experiment("stress"), []
for method in methods:
    earned = study.of(method).scores("returns")
    groups = (earned[:3], earned[:5], earned, others[method].scores("returns"))
    some = [bc.statistics.interval(group, np.mean) for group in groups]
    whole = [f"{each.value:.0f} [{each.low:.0f}, {each.high:.0f}]" for each in some]
    rows.append([bc.display_name(method), *whole])
table(["mean of the return", "3 seeds", "5 seeds", f"{agents} seeds", "ten others"], rows)

# %%
title = "The two methods with the soft constraint earn most"
bc.show(figures.final_scores(study, methods, title=title))

# %% [markdown]
# **Explain.** The interval says how far our mean may lie from the mean of very many agents: with
# both aids about {{ half_interval('bootstrapped') | .0f }} to either side. A *repetition* has an
# error of its own, as large as ours. Two independent errors add up to $\sqrt2$ as much, so two
# studies of ten agents differ, in 95 of 100 cases, by at most about {{ 2**0.5 *
# half_interval('bootstrapped') | .0f }}, if our ten show how agents spread.
#
# The ten others repeat the study with other seeds, another implementation of the learner, and twice
# the episodes. With both aids they differ by {{ apart('bootstrapped') | .0f }}. With demonstrations
# alone they differ by {{ apart('demos') | .0f }}, where our ten allow about {{ 2**0.5 *
# half_interval('demos') | .0f }}. Of these, {{ succeeding_by_then(0.85)[1] }} already succeed in
# over 85 % of training episodes 1,800 to 2,000, of ours {{ succeeding_by_then(0.85)[0] or 'none'
# }}. Do not trust a short interval from few seeds,
# ten included: resampling draws from the agents that were trained, and from no others.
# <!-- claim: apart('bootstrapped') < 2**0.5 * half_interval('bootstrapped') and apart('demos') > 2
#   * 2**0.5 * half_interval('demos') and succeeding_by_then(0.05)[0] == 0 -->

# %% [markdown] tags=["instructor"] minutes=5
# Ask for a fifth way to summarise ten agents in one number, and try it on the bootstrapped ones.

# %% [markdown]
# ## Round 4: better, or different?
#
# > **Predict.** You draw one bootstrapped agent and one with the soft constraint alone, at random.
# > How often does the bootstrapped one earn more?

# %%
predict("how_many_seeds.5", "How often does the bootstrapped agent earn more?", unit="%")

# %% [markdown]
# This is the **probability of improvement**: the share of all pairs of one agent of each method in
# which the first earns more. A tie counts half.

# %%
predicted("how_many_seeds.5")
four = study.pick(i for i, a in enumerate(study.agents) if a["method"] in methods)
table(*tables.improvement_rows(four))

# %% [markdown]
# **Explain.** At 50 % neither method is ahead. The interval of both aids against the soft
# constraint alone contains 50 %, and so does that of the ten others, {{ others_improve() }} %. The
# two need not be equal, but ten seeds show no difference: "the combination is best" is not a result
# of this study.
# <!-- claim: 100 * improvement([1.0, 1.0], [1.0, 1.0]).value == 50 -->
# <!-- claim: (lambda p: p.low <= 0.5 <= p.high)(improvement(of('bootstrapped').scores('returns'),
#   of('soft').scores('returns'))) -->
# <!-- claim: (lambda p: p.low <= 0.5 <= p.high)(improvement(others('bootstrapped')
#   .scores('returns'), others('soft').scores('returns'))) -->

# %% [markdown] tags=["instructor"] minutes=3
# Ask what would have to be measured to decide it: more seeds, or another question, such as how
# *early* an agent escapes.

# %% [markdown]
# ## Round 5: an ablation of your own
#
# What does one number of the method do? You train five agents as they are and five with that number
# changed. For that you need an interval for a *difference*.
#
# **Exercise (15 min, ●●●).** Write it: the IQM of one group less the IQM of the other, and the
# 95 % bootstrap interval of that difference. Each resample draws both groups anew.


# %%
def difference_interval(x, y, draws_x, draws_y):
    """(difference, low, high): IQM of x less IQM of y, scores (m,) and (n,), with its interval.

    draws_x (resamples, m) and draws_y (resamples, n) are the agents that each resample draws.
    """
    # solution: the exercise's own


check.difference_interval(difference_interval)

# %% [markdown]
# Choose what to change. `bonus=0.0` takes the bonus from the demonstrations; other numbers are
# `xi_multiplier`, `rule_p`, `beta_start`, `gamma`: `bootcourse.learn.settings.Settings` lists them.
# The score is an agent's success on 200 roads after 150 episodes, by its most probable actions: who
# learns the way out early?
#
# > **Predict.** By how many points of success does your change raise or lower the IQM?

# %%
predict("how_many_seeds.6", "By how many points does my change move the success?", unit="points")

# %%
predicted("how_many_seeds.6")
CHANGE = {"bonus": 0.0}  # yours
settings = {
    "as it is": bc.settings_for("bootstrapped"),
    "changed": bc.settings_for("bootstrapped", **CHANGE),
}
training = {"episodes": 150, "learner": "compiled"}
mine = bc.compare(settings, seeds=5, tests=200, progress=False, **training)
bc.show(mine.figure("Their training, with drawn actions"))

# %%
as_it_is, changed = (100 * mine.scores(name, "success") for name in settings)
effect = bc.statistics.difference(changed, as_it_is)
rows = [
    [name, f"{bc.statistics.iqm(group):.0f}", ", ".join(f"{each:.0f}" for each in sorted(group))]
    for name, group in (("as it is", as_it_is), ("changed", changed))
]
words = f"Changed less unchanged: {tables.bracketed(effect)} points. The interval "
words += "holds 0." if effect.low <= 0 <= effect.high else "does not hold 0."
table(["success, %", "IQM", "the agents, sorted"], rows, below=words)

# %% [markdown]
# **Explain.** In our run the agents without the bonus were ahead more often, and the interval
# contains 0. The result covers these settings and 150 episodes. It says which group learned
# earlier, not whether the bonus is needed in a longer training.
#
# How many agents would settle it? Do not compute it from the difference that you have just seen: if
# the interval holds 0, that difference may have either sign. Say first which difference would
# matter to you, the **smallest effect of interest**. Choose the number of agents whose power for it
# is enough, and train a *new* set. Adding agents because an interval only just holds 0, and testing
# again, makes the test err more often than it says.

# %% [markdown] tags=["instructor"] minutes=4
# Give each group another number to change, and collect the results on the board: one row for each
# group, with its interval. If the changes of ten groups have zero effect, the chance that at least
# one interval misses 0 is {{ 100 * (1 - 0.95**10) | .0f }} %. Ask what to do about that (say
# beforehand which comparison counts, or make each interval wider).

# %%
escapes = bc.statistics.ESCAPES
both, soft = (study.of(m).scores("returns") for m in ("bootstrapped", "soft"))
spread = np.ptp(bc.statistics.interval(both, np.mean)[1:]) / 2
compare_predictions(
    "how_many_seeds",
    {
        1: round(100 * bc.statistics.rate(study.of("soft").scores("success") >= escapes).low),
        2: round(100 * bc.statistics.power(0.8, 0.3, 10)),
        3: {"IQM": choices[2]}.get(most := max(falls, key=falls.get), most),
        4: round(2**0.5 * spread, 1),
        5: round(100 * bc.statistics.improvement(both, soft).value, 1),
        6: round(effect.value, 1),
    },
)

# %% [markdown]
# ## What you now know
#
# 1. The sample is the training: twenty drives of one agent are one sample of a method.
# 2. The exact interval of k out of ten is wide: ask of a table how many agents are behind a row.
# <!-- claim: all(escapes(of(m).scores('success')).high - escapes(of(m).scores('success')).low > 0.3
#   for m in ('sac', 'soft', 'demos', 'bootstrapped')) -->
# 3. Compute the power before you train. By Fisher's test ten against ten find 80 against 30 % in
#    fewer than half of the studies.
# <!-- claim: power(0.8, 0.3, 10) < 0.5 -->
# 4. Of many comparisons some look good by luck: say beforehand which one counts, or correct p.
# 5. An interval over seeds says how far a mean may be off, as far as these seeds show it. Two
#    studies may differ by $\sqrt2$ as much, or more.
#
# **Three questions to think about**
# - The paper tests 20 episodes. Which difference between two *agents* can 20 episodes show, and
#   which between two *methods*?
# - You may train 40 more agents. Ten more seeds for each of four methods, or one seed for each of
#   forty settings, of which you report the best?
# - Your change raises the success of five agents, p = 0.04, and it is the sixth that you tried.
#   What do you write?
#
# **Read on**: [lesson [[found_and_kept]]](found_and_kept.ipynb) asks why our table is not the
# paper's. Agarwal et al., *Deep Reinforcement Learning at the Edge of the Statistical Precipice*
# (arXiv 2108.13264); Henderson et al., *Deep Reinforcement Learning that Matters* (arXiv
# 1709.06560).

# %% [markdown] tags=["instructor"]
# **Model answers.**
#
# - *What can 20 episodes show?* Of two agents: with 20 of 20 the interval of the rate begins at
#   {{ 100 * rate(np.ones(20)).low | .0f }} %, so a difference of 30 points or more, roughly, shows.
#   Of two methods: with one agent behind each row, nothing beyond these two agents.
# - *40 more agents?* Ten more seeds for each method, if the question is whether the methods differ:
#   the intervals above overlap. Forty settings, if a better one is looked for: the best came out
#   best partly by the luck of its seed, so report it with ten new ones.
# - *The sixth change?* After Holm the smallest of six p values has to be below 0.05 / 6. Write that
#   six changes were tried, which one looked best, and that new seeds have to confirm it.

# %% [markdown] tags=["instructor"]
# **On the board.** Four rows of ten dots each, dark where the agent escapes; beside each row its
# exact interval.
#
# **To discuss.** You have one figure and one sentence for the press. Which result do you leave out?
