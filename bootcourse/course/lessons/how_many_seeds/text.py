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
# **Time** 60 minutes; running it takes about one minute. **It builds on** the soft constraint
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
from bootcourse.course.lessons.how_many_seeds import counts, explorable, figures

progress("how_many_seeds")

# %% [markdown]
# ## Look first
#
# Two agents of plain SAC on one road, which differ in the *seed* of their random numbers alone.
# Press play.
# <!-- claim: len({tuple((k, str(v)) for k, v in agent.items() if k != 'seed') for agent in
#   of('sac').agents}) == 1 -->

# %% tags=["nbval-ignore-output"]
drives = []
for seed in (0, 3):
    agent = bc.shipped_agents("sac")[seed]
    drive = bc.record(agent.as_policy(), [10], label=f"sac, seed {seed}")[0]
    drives.append(shipped.beginning(drive, 30))
bc.recording(drives, height=360)

# %% [markdown]
# Had you trained the second one alone, you would write that plain SAC leaves the trap. Of our ten,
# the other nine do not. How many agents do you need to write such a sentence?
# <!-- claim: escaped('sac') == 1 -->
#
# The question matters most in an **ablation**: leave out one part of a method at a time, train
# again, and see what gets worse. Here are four methods: plain SAC, the soft constraint alone,
# demonstrations alone, and both (bootstrapped SAC).

# %% [markdown] tags=["instructor"] minutes=3
# Ask how many of them have published or handed in a figure with one training behind each line.

# %% [markdown]
# ## Round 1: who escapes?
#
# Each agent drives roads that it has never seen, by its most probable action. It *escapes* if it
# ends ahead of trap 1 on at least {{ 100 * ESCAPES | .0f }} % of them.

# %%
study = bc.shipped_results()
methods = ("sac", "soft", "demos", "bootstrapped")  # ten agents of each
bc.show(figures.who_escapes(study, methods))

# %% [markdown]
# Each training but one works or fails: one bootstrapped agent gets out on 92 % of the roads, then
# crashes on most: no escape. So a method's success is a number of agents. Eight of ten with the
# soft constraint alone escape. What does that say about the next agent?
# <!-- claim: escaped('soft') == 8 and len(of('soft')) == 10 -->
# <!-- claim: round(100 * of('bootstrapped').scores('success')[0]) == 92 < 100 * ESCAPES and
#   of('bootstrapped').scores('accident')[0] > 0.6 -->
#
# > **Predict.** How low may the true rate be, so that eight or more of ten still escape in 2.5 % of
# > all studies? (Ten fair coins show eight or more heads in
# > {{ 100 * stats.binom.sf(7, 10, 0.5) | .1f }} % of all throws.)

# %%
predict(
    "how_many_seeds.1",
    "How low may the true rate be, so that 8 or more of 10 escape in 2.5 % of all studies?",
    unit="%",
)

# %% [markdown]
# **Drag** the true rate down until the blue part is 2.5 %, then up until it is so again. Then drag
# the agents: how many make the interval half as wide?

# %%
predicted("how_many_seeds.1")
explorable.certainty()

# %% [markdown]
# **See.** Eight of ten may mean a true rate of 44 or of 97 %. Half the width takes
# {{ half_as_wide() }} agents: four times as many.
# <!-- claim: half_as_wide() == 40 and [round(100 * each) for each in
#   rate(np.arange(10) < 8)[1:]] == [44, 97] -->
#
# This is the **exact interval** of k out of n (Clopper and Pearson's). At its low end, k *or more*
# have a chance of 2.5 %; at its high end, k *or fewer* have.
#
# **Exercise (8 min, ●●○).** Write it. `scipy.stats.beta.ppf(q, a, b)` is where a beta
# distribution reaches q, and solves both: a = k, b = n − k + 1 for the low end, a = k + 1, b = n −
# k for the high one. Mind k = 0 and k = n.
# <!-- claim: rate(np.zeros(10)).low == 0 -->


# %%
def exact_interval(k, n):
    """The exact 95 % interval of a rate, from k of n: two whole numbers -> (2,), low and high."""
    # solution: the exercise's own


check.exact_interval(exact_interval)

# %% [markdown]
# The paper's rates for our four methods are 0, 0, 100 and 100 %: on the middle rows the opposite of
# ours. It does not print how many agents or drives it used; another of its rates,
# {{ PRINTED['gail']['collision'].mean | g }} ± {{ PRINTED['gail']['collision'].sd }} % (standard
# deviation), is exactly what one accident in {{ EPISODES }} drives gives.
# <!-- claim: [PRINTED[m]['success'].mean for m in ('sac', 'soft', 'demos', 'bootstrapped')] == [0,
#   0, 100, 100] -->
# <!-- claim: (lambda x: round(x.mean(), 2) == PRINTED['gail']['collision'].mean and
#   round(x.std(ddof=1), 2) == PRINTED['gail']['collision'].sd)(100.0 * (np.arange(EPISODES) < 1))
#   -->
#
# > **Predict.** Suppose that *one* agent made a row's 20 drives, and all succeed. Where does the
# > exact interval of the method's rate begin? (Of 20 of 20 it begins at 83 %.)
# <!-- claim: round(100 * rate(np.ones(20)).low) == 83 -->

# %%
predict(
    "how_many_seeds.2",
    "All 20 drives of one agent succeed. Where does the interval of the rate of escape begin?",
    ["at 83 %", "at 50 %", "at 2.5 %"],
)

# %%
predicted("how_many_seeds.2")
bc.show(figures.beside_the_paper(study, methods))

# %% [markdown]
# **See.** Twenty drives of one agent are *one* sample, not twenty, of how often training succeeds.
# One success allows every rate above {{ 100 * rate(np.ones(1)).low | .1f }} %: at that rate 1 of 1
# has a chance of 2.5 %. If one agent stands behind each of its rows, even opposite rows need not
# contradict ours.
# <!-- claim: all((lambda ours, theirs: ours.low < theirs.high and theirs.low < ours.high)(
#   escapes(of(m).scores('success')), rate(np.array([PRINTED[m]['success'].mean >= 95]))) for m in
#   ('sac', 'soft', 'demos', 'bootstrapped')) -->

# %% [markdown] tags=["instructor"] minutes=5
# Let them vote before the figure and keep the votes. What is the sample here: a drive, or a
# training? Which sentences of the paper's abstract does this table support?

# %% [markdown]
# ## Round 2: how many agents does it take?
#
# With the soft constraint alone eight of ten agents escape, with both aids seven. *Fisher's exact
# test* deals these fifteen escapes out to the twenty agents at random. Its **p value** is how often
# the split is at least as improbable as the one seen; below 0.05 it counts as a difference.
# <!-- claim: escaped('soft') == 8 and escaped('bootstrapped') == 7 -->

# %%
for second in (7, 3, 2):
    p = scipy.stats.fisher_exact([[8, 2], [second, 10 - second]]).pvalue
    print(f"8 of 10 against {second} of 10: p = {p:.2f}")

# %% [markdown]
# > **Predict.** The true rates are 80 and 30 %. You train ten agents of each. In how many of 100
# > such studies does Fisher's test find the difference?

# %%
predict(
    "how_many_seeds.3",
    "How many of 100 studies, ten against ten, find the difference?",
    unit="of 100",
)

# %% [markdown]
# **Drag** the number of agents. From how many on do at least 80 of 100 studies find the difference?
# And how far do thirty of each get with 80 against 60 %?

# %%
predicted("how_many_seeds.3")
explorable.studies()

# %% [markdown]
# **See.** Ten against ten miss even this large difference in more than half of the studies; with 80
# against 60 % so do thirty. So eight against seven does not show that the two methods are alike.
# <!-- claim: power(0.8, 0.3, 10) < 0.5 and power(0.8, 0.6, 30) < 0.4 and fisher(8, 7) > 0.5 -->
#
# The share of studies that find it is the **power** of the comparison. Compute it before you train:
# say which difference would matter to you, the **smallest effect of interest**, and take enough
# agents for a power of 80 %; here {{ enough(0.8, 0.3) }} of each.
#
# **Exercise (12 min, ●●○).** Write it: add up the filled discs. In each group the number of agents
# that escape is binomial. `shown[k, j]` says whether the test tells k of n from j of n.


# %%
def power(first, second, shown):
    """How often a test finds it: two true rates, shown (n + 1, n + 1) bool -> 0 to 1."""
    # solution: the exercise's own


check.power(power)

# %% [markdown]
# ### Many comparisons
#
# The opposite error is to see a difference where there is none. If each of twelve independent
# comparisons errs so in 5 % of the cases, at least one does with a chance of
# {{ 100 * (1 - 0.95**12) | .0f }} %: **multiplicity**.
#
# Say beforehand which comparison counts, or correct the p values in *Holm's* way: multiply the
# smallest by their number n, the next by n − 1, and so on. No corrected p may be smaller than the
# one before it, or larger than 1.

# %%
# NBVAL_CHECK_OUTPUT
rows, after = [], 0.0
against = {"demonstrations only": 0, "plain SAC": 1, "soft constraint only": 8}  # smallest p first
for times, (name, k) in zip((3, 2, 1), against.items(), strict=True):
    p = scipy.stats.fisher_exact([[7, 3], [k, 10 - k]]).pvalue
    after = min(max(after, times * p), 1)
    rows.append([name, f"{k} of 10", f"{p:.3f}", times, f"{after:.3f}"])
table(["7 of 10 with both aids, against", "", "p", "times", "after Holm"], rows)

# %% [markdown]
# Two of the three survive. Among all six pairs of these methods 7 against 1 would not ({{ 3 *
# fisher(7, 1) | .2f }}): name the *family* beforehand, too.
# <!-- claim: [escaped(m) for m in ('bootstrapped', 'demos', 'sac', 'soft')] == [7, 0, 1, 8] -->
# <!-- claim: 3 * fisher(7, 0) < 0.05 and 2 * fisher(7, 1) < 0.05 and fisher(7, 8) > 0.05 -->
# <!-- claim: sorted(fisher(a, b) for a, b in ((7, 0), (7, 1), (7, 8), (8, 0), (8, 1), (1, 0)))[3] ==
#   fisher(7, 1) and 3 * fisher(7, 1) > 0.05 -->

# %% [markdown] tags=["instructor"] minutes=4
# Let each group name a difference that it would care about, and look up the number of agents.
# `bc.statistics.power(0.8, 0.6, 80)` takes some seconds. Then ask what to do if only ten can be
# trained: choose a change with a larger effect, or a score that is not yes or no.

# %% [markdown]
# ## Round 3: are three seeds enough?
#
# You have time for three agents. Is their mean worth printing? Our ten earn:

# %%
for method in ("bootstrapped", "soft"):
    returns = np.sort(study.of(method).scores("returns"))
    print(f"{method}: {', '.join(f'{each:.0f}' for each in returns)}; mean {returns.mean():.0f}")

# %% [markdown]
# Seven of the ten bootstrapped agents do well, three badly.
# <!-- claim: np.diff(np.sort(of('bootstrapped').scores('returns'))).max() > 40 and
#   (of('bootstrapped').scores('returns') < 60).sum() == 3 -->
#
# How sure is their mean? Draw as many agents as you trained, out of these, *uniformly with
# replacement*: some come twice, others not at all. Take the mean, and repeat this some thousand
# times. The middle 95 % of these means are the **bootstrap interval** (nothing to do with
# bootstrapped SAC).
#
# **Exercise (7 min, ●●○).** Write it. The draws are given.


# %%
def bootstrap_interval(scores, draws):
    """95 % interval of the mean: scores (n,), draws (resamples, n) whole numbers 0..n-1 -> (2,)."""
    # solution: the exercise's own


check.bootstrap_interval(bootstrap_interval)

# %% [markdown]
# > **Predict.** Suppose that our ten are as all agents are: seven of ten do well. Somebody trains
# > three, and computes the interval from these three. In how many of 100 such studies does it hold
# > the mean of all? (How often do all three do well, and where is their interval then?)

# %%
predict(
    "how_many_seeds.4",
    "How many of 100 intervals, of three seeds each, hold the mean of all?",
    unit="of 100",
)

# %% [markdown]
# **Drag** the number of seeds. What do the intervals that miss look like?

# %%
predicted("how_many_seeds.4")
explorable.intervals()

# %% [markdown]
# **See.** In {{ 100 * 0.7**3 | .0f }} of 100 studies all three do well. Resampling knows these
# three alone, so the interval is short, and lies above the mean of all. Of the {{ 100 -
# explorable.holding(3) }} that miss, three lie below. *The shortest intervals miss.* Of ten seeds
# about nine intervals in ten hold it.
# <!-- claim: round(100 * held('bootstrapped', 3)) == explorable.holding(3) == 63 and 88 <=
#   explorable.holding(10) <= 92 -->
# <!-- claim: (lambda low, high, holds: not holds[np.argsort(high - low)[:37]].any() and (low >
#   of('bootstrapped').scores('returns').mean()).sum() == round(100 * 0.7**3) == 34)(
#   *explorable.drawn(3)) -->
#
# It happened to us, too.

# %%
others = shipped.shipped_experiment("stress")
table(counts.MEANS, counts.means(study, others, methods))

# %% [markdown]
# In two of four rows the interval of our first three misses the mean of the ten: with the soft
# constraint all three do well, with plain SAC the one that escapes is not among them. With
# demonstrations only the ten others (lesson [[learning_from_demonstrations]]) lie far outside our
# ten's interval: it speaks of other seeds, not of another learner or more episodes.
# <!-- claim: [first_three_hold(m) for m in ('sac', 'soft', 'demos', 'bootstrapped')] == [False,
#   False, True, True] -->
# <!-- claim: of('soft').scores('returns')[:3].min() > 120 and
#   of('sac').scores('success')[:3].max() < ESCAPES -->

# %% [markdown] tags=["instructor"] minutes=3
# Ask for another way to summarise ten agents in one number, and try it on the bootstrapped ones.

# %% [markdown]
# ## Round 4: better, or by luck?
#
# > **Predict.** You draw one bootstrapped agent and one with the soft constraint alone, at random.
# > How often does the bootstrapped one earn more?

# %%
predict("how_many_seeds.5", "How often does the bootstrapped agent earn more?", unit="%")

# %% [markdown]
# The share of such pairs is the **probability of improvement**; a tie counts half.

# %%
predicted("how_many_seeds.5")
bc.show(figures.pairs(study, "bootstrapped", "soft"))

# %% [markdown]
# **See.** The interval holds 50 %: "the combination is best" is not a result of this
# study. With the ten others it is {{ better(others).value | .0f }} %
# ({{ better(others).low | .0f }} to {{ better(others).high | .0f }}).
# <!-- claim: all(each.low <= 50 <= each.high for each in (better(of), better(others))) -->
#
# ### An ablation of your own
#
# You change one number of the method, and train five agents with it and five without. For that you
# need an interval for a *difference*. The score of a group is its **interquartile mean** (IQM), the
# mean of the middle half: sort, and leave out a quarter, rounded down, at each end. Of five the
# middle three remain, so one outlier does not count, and neither does one failure in five.
# <!-- claim: iqm([-900.0, 1.0, 2.0, 3.0, 4.0]) == iqm([1.0, 2.0, 3.0, 0.0, 900.0]) == 2 -->
#
# **Exercise (15 min, ●●●).** Write it: the difference of two IQMs, and its bootstrap interval. Each
# resample draws both groups anew.


# %%
def difference_interval(x, y, draws_x, draws_y):
    """(difference, low, high): IQM of x less IQM of y, scores (m,) and (n,), with its interval.

    draws_x (resamples, m) and draws_y (resamples, n) are the agents that each resample draws.
    """
    # solution: the exercise's own


check.difference_interval(difference_interval)

# %% [markdown]
# `bonus=0.0` takes the bonus from the demonstrations; other numbers are `xi_multiplier`, `rule_p`,
# `beta_start`, `gamma`. The score is an agent's success on 200 roads after 150 episodes: who learns
# the way out early?

# %%
CHANGE = {"bonus": 0.0}  # yours
settings = {
    "as it is": bc.settings_for("bootstrapped"),
    "changed": bc.settings_for("bootstrapped", **CHANGE),
}
mine = bc.compare(settings, episodes=150, seeds=5, tests=200, learner="compiled", progress=False)
success = {name: mine.scores(name, "success") for name in settings}
table(counts.ABLATION, *counts.ablation(success))

# %% [markdown]
# **Explain.** If the interval holds 0, as in our run, five seeds do not say which group learns
# earlier. If it does not, remember Round 3: there {{ 100 - explorable.holding(5) }} of 100
# intervals of five seeds miss, not 5.
#
# How many agents would say it? Score each yes or no (here: above 20 %?), choose limit and smallest
# effect beforehand, not from this run, and ask `bc.statistics.power`. Then train a *new* set. If
# you add agents until the interval does not hold 0, you err more often than it says.

# %% [markdown] tags=["instructor"] minutes=3
# Give each group another number to change, and collect the results on the board: one row for each
# group, with its interval. If the changes of ten groups have zero effect, the chance that at least
# one interval misses 0 is {{ 100 * (1 - 0.95**10) | .0f }} %. Ask what to do about that (say
# beforehand which comparison counts, or make each interval wider).

# %%
escapes = study.of("soft").scores("success") >= bc.statistics.ESCAPES
both, soft = (study.of(m).scores("returns") for m in ("bootstrapped", "soft"))
compare_predictions(
    "how_many_seeds",
    {
        1: round(100 * bc.statistics.rate(escapes).low),
        2: f"at {100 * bc.statistics.rate(np.ones(1)).low:.1f} %",
        3: round(100 * bc.statistics.power(0.8, 0.3, 10)),
        4: explorable.holding(3),
        5: round(100 * bc.statistics.improvement(both, soft).value, 1),
    },
)

# %% [markdown]
# ## What you now know
#
# 1. The sample is the training: twenty drives of one agent are one sample of a method.
# 2. The exact interval of k out of ten is wide: ask how many agents stand behind a row.
# <!-- claim: all(escapes(of(m).scores('success')).high - escapes(of(m).scores('success')).low > 0.3
#   for m in ('sac', 'soft', 'demos', 'bootstrapped')) -->
# 3. Compute the power before you train, for the smallest effect of interest.
# 4. Of many comparisons some may look good by luck: say beforehand which one counts, or correct p.
# 5. A short interval from three seeds may be luck: resampling knows these three alone.
#
# **Three questions to think about**
# - Which difference between two *agents* can the paper's 20 drives show, and which between two
#   *methods*?
# - Forty more agents: ten of each method, or one of each of forty settings, of which you report the
#   best?
# - Your sixth change raises the success, p = 0.04. What do you write?
#
# **Read on**: [lesson [[found_and_kept]]](found_and_kept.ipynb) asks why our table is not the
# paper's. Agarwal et al. (arXiv 2108.13264); Henderson et al. (arXiv 1709.06560).

# %% [markdown] tags=["instructor"]
# **Model answers.**
#
# - *What can 20 drives show?* Of two agents: with 20 of 20 the interval of the rate begins at
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
