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
# - say what "eight of ten agents escape" tells you about the method;
# - compute how many agents a comparison needs;
# - run an ablation of your own, and say what five seeds show.
#
# **Time** 48 minutes. **It builds on** lessons [[soft_constraint]] and [[learning_from_demonstrations]].

# %%
import bootcourse as bc
import numpy as np
import scipy.stats
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
from bootcourse.course.lessons.how_many_seeds import counts, explorable, figures

progress("how_many_seeds")

# %% [markdown]
# ## Look first
#
# Watch two agents of plain SAC on one road, trained alike except for the *seed* of their random numbers.
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
# The second one alone would tell you that plain SAC leaves the trap. The other nine of our ten got out on none of
# the {{ roads() | , }} held-out roads.
# <!-- claim: np.sort(of('sac').scores('success'))[:-1].max() == 0 and escaped('sac') == 1 -->
#
# Here are all ten, and thirty with one or both aids: an **ablation**, in which one leaves out parts of a method and
# trains again. An agent *escapes* if it ends ahead of trap 1 on at least {{ 100 * ESCAPES | .0f }} % of these roads.

# %%
study = bc.shipped_results()
bc.show(figures.who_escapes(study, ("sac", "soft", "demos", "bootstrapped")))

# %% [markdown]
# One bootstrapped agent gets out on {{ 100 * just_below() | .0f }} %; a line at 90 % would count it. Draw the line
# before you look.
# <!-- claim: 0.9 < just_below() < ESCAPES and (of('bootstrapped').scores('success') >= 0.9).sum() == 8 and
#   all((of(m).scores('success') >= 0.9).sum() == escaped(m) for m in ('sac', 'soft', 'demos')) -->

# %% [markdown] tags=["instructor"] minutes=2
# Ask how many of them have published or handed in a figure with one training behind each line.

# %% [markdown]
# ## Round 1: what does eight of ten say?
#
# With the soft constraint alone, eight of ten agents escape. If you trained thousands, the share that escapes
# would be the *true rate*. Suppose that it is 30 %, and imagine many studies of ten agents. In {{
# explorable.blue_part(30, 8, 10) | .1f }} % of them eight *or more* escape. If that share is below 2.5 %, the
# rate is *too low*. A rate is *too high* if it gives eight *or fewer* in less than 2.5 % of studies. All others are
# *believable*.
# <!-- claim: escaped('soft') == 8 and len(of('soft')) == 10 -->
#
# **Drag** the true rate. Which are believable?

# %%
explorable.certainty()

# %% [markdown]
# **See.** *Rates from 44 to 97 % are believable.* This is the **exact 95 % interval** of 8 out of 10.
# <!-- claim: [round(100 * each) for each in
#   rate(np.arange(10) < 8)[1:]] == [44, 97] -->
#
# With demonstrations alone the paper prints a success of 100 %; of our ten agents none escapes. The paper does not
# say how many agents drove.
# <!-- claim: PRINTED['demos']['success'].mean == 100 and escaped('demos') == 0 -->
# <!-- claim: fitting(*PRINTED['gail']['collision']) == [(1, EPISODES)] -->
#
# > **Predict.** Suppose that *one* agent got out in all {{ EPISODES }} drives. Where does the exact interval of the
# > *method's* true rate begin?

# %%
predict(
    "how_many_seeds.1",
    "One agent of one escapes. Where does the interval of the method's rate begin?",
    ["at 83 %", "at 50 %", "at 2.5 %"],
)

# %%
predicted("how_many_seeds.1")
for k, n in ((20, 20), (1, 1), (0, 10)):
    _, low, high = bc.statistics.rate(np.arange(n) < k)
    print(f"{k} of {n}: {100 * low:.1f} to {100 * high:.1f} %")

# %% [markdown]
# **See.** *Twenty drives of one agent are one sample of how often training succeeds.* At a true rate of 2.5 % one
# agent of one escapes in 2.5 % of studies: there its interval begins. If one agent stands behind the paper's 100 %,
# it need not contradict our 0 of 10: at a true rate of 10 % each comes in more than 2.5 % of studies.
# <!-- claim: min(0.1, 0.9**10) > 0.025 and fisher(1, 0, 1, 10) > 0.05 -->

# %% [markdown] tags=["instructor"] minutes=3
# Let them vote before the three intervals and keep the votes. What is the sample here: a drive, or a
# training?

# %% [markdown]
# ## Round 2: how many agents does it take?
#
# With both aids seven of ten agents escape, with plain SAC one. Suppose that the methods are alike. Then it is
# chance which eight of the twenty agents escape. How often would chance split the eight at least as unevenly as
# seven to one? That is the **p value**. *Fisher's exact test* computes it: {{ fisher(7, 1) | .3f }}. Below 0.05 we
# speak of a difference. (The exact intervals, {{ percent(7) }} and {{ percent(1) }} %, overlap; that decides nothing.)
# <!-- claim: rate(np.arange(10) < 7).low < rate(np.arange(10) < 1).high and fisher(7, 1) < 0.05 -->
# <!-- claim: [escaped(m) for m in ('bootstrapped', 'demos', 'sac', 'soft')] == [7, 0, 1, 8] -->
#
# > **Predict.** The true rates are 80 and 30 %. You train ten agents of each. On average eight and three escape,
# > and 8 against 3 has p = {{ fisher(8, 3) | .2f }}. In how many of 100 such studies does Fisher's test find the
# > difference?

# %%
predict(
    "how_many_seeds.2",
    "How many of 100 studies, ten against ten, find the difference?",
    unit="of 100",
)

# %% [markdown]
# **Drag** the number of agents. From how many on do at least 80 of 100 studies find the difference?

# %%
predicted("how_many_seeds.2")
explorable.studies()

# %% [markdown]
# **See.** *With ten agents of each, more than half of the studies miss even this large difference.* (As counts are
# whole, 14 agents can do worse than 13: {{ 100 * power(0.8, 0.3, 14) | .0f }} % after
# {{ 100 * power(0.8, 0.3, 13) | .0f }} %.) The soft constraint's eight against both aids' seven
# (p = {{ fisher(8, 7) | .0f }}) shows no difference. It does not show that the two are alike.
# <!-- claim: power(0.8, 0.3, 10) < 0.5 < fisher(8, 7) and fisher(8, 3) > 0.05 -->
# <!-- claim: [stats.binom.pmf(range(11), 10, share).argmax() for share in (0.8, 0.3)] == [8, 3] -->
#
# The share of studies that find a difference is the **power** of the comparison. Compute it before you train: say
# which difference would matter to you, the **smallest effect of interest**, and take enough agents for a power of
# 80 %. For 80 against 30 % that is {{ enough(0.8, 0.3) }} of each.
# <!-- claim: min(power(0.8, 0.3, n) for n in range(enough(0.8, 0.3), 31)) >= 0.8 -->
#
# **Exercise (12 min, ●●○).** Write the power: add up the chances of the filled discs. In each group the
# number of agents that escape is binomial. `shown[k, j]` is True where the test finds a difference between k
# of n and j of n.


# %%
def power(first, second, shown):
    """How often a test finds it: two true rates, shown (n + 1, n + 1) bool -> 0 to 1."""
    # solution: the exercise's own


check.power(power)

# %% [markdown] tags=["instructor"] minutes=3
# Let each group name a difference that it would care about, and look up the number of agents.
# `bc.statistics.power(0.8, 0.6, 80)` takes some seconds. Then ask what to do if only ten can be trained:
# choose a change with a larger effect, or a score that is not yes or no.

# %% [markdown]
# ## Round 3: are three seeds enough?
#
# Our ten bootstrapped agents earn:

# %%
returns = np.sort(study.of("bootstrapped").scores("returns"))
print(f"{', '.join(f'{each:.0f}' for each in returns)}; mean {returns.mean():.0f}")

# %% [markdown]
# <!-- claim: np.diff(np.sort(of('bootstrapped').scores('returns'))).max() > 40 and
#   (of('bootstrapped').scores('returns') < 60).sum() == 3 -->
#
# From the agents *you trained* draw as many again, *uniformly with replacement*: some come twice, others not
# at all. Take the mean, and repeat this thousands of times. The middle 95 % of these means are the
# **bootstrap interval** (nothing to do with bootstrapped SAC).
#
# > **Predict.** Suppose that each training yields one of these ten agents by chance; seven of them do well. A study
# > trains three. In how many of 100 such studies does their bootstrap interval contain
# > {{ of('bootstrapped').scores('returns').mean() | .0f }}, the mean of all ten?

# %%
predict(
    "how_many_seeds.3",
    "How many of 100 intervals, of three seeds each, contain the mean of all?",
    unit="of 100",
)

# %% [markdown]
# **Drag** the number of seeds to 10. How many miss now, and are they still the shortest?

# %%
predicted("how_many_seeds.3")
explorable.intervals()

# %% [markdown]
# **See.** *Of 100 intervals {{ explorable.holding(3) }} contain the mean, not 95, and the shortest miss it.* All three
# agents do well in 0.7³ = {{ 100 * 0.7**3 | .0f }} % of studies, all three badly in 0.3³ =
# {{ 100 * 0.3**3 | .0f }} %: resampling cannot know the other agents. With ten seeds {{ explorable.holding(10) }} of
# 100 contain the mean. Seven of the misses are the shortest of all; three are long, but too low.
# Print every agent beside the interval.
# <!-- claim: missing(10) == ([0, 1, 2, 3, 4, 5, 6], 3) -->
# <!-- claim: 100 - explorable.holding(3) == round(100 * (0.7**3 + 0.3**3)) and explorable.holding(10) < 95 -->
# <!-- claim: round(100 * held('bootstrapped', 3)) == explorable.holding(3) == 63 -->
# <!-- claim: (lambda low, high, holds: not holds[np.argsort(high - low)[:37]].any() and (low >
#   of('bootstrapped').scores('returns').mean()).sum() == round(100 * 0.7**3) == 34)(
#   *explorable.drawn(3)) -->
#
# **Exercise (7 min, ●●○).** Write the interval. The draws are given.


# %%
def bootstrap_interval(scores, draws):
    """95 % interval of the mean: scores (n,), draws (resamples, n) whole numbers 0..n-1 -> (2,)."""
    # solution: the exercise's own


check.bootstrap_interval(bootstrap_interval)

# %% [markdown] tags=["instructor"] minutes=3
# Ask for another way to summarise ten agents in one number, and try it on the bootstrapped ones.

# %% [markdown]
# ## Round 4: what do your five seeds show?
#
# We compare groups by their **interquartile means** (IQM): sort, leave out the lowest and the highest quarter, and
# take the mean. One odd agent decides little. But the IQM can hide failures: Round 3's ten have the mean
# {{ of('bootstrapped').scores('returns').mean() | .0f }}, and the IQM {{
# iqm(of('bootstrapped').scores('returns')) | .0f }}.
#
# **Exercise (15 min, ●●●).** Write the difference of two IQMs, and its bootstrap interval. Each resample
# draws both groups anew.


# %%
def difference_interval(x, y, draws_x, draws_y):
    """(difference, low, high): IQM of x less IQM of y, scores (m,) and (n,), with its interval.

    draws_x (resamples, m) and draws_y (resamples, n) are the agents that each resample draws.
    A quarter is rounded down.
    """
    # solution: the exercise's own


check.difference_interval(difference_interval)

# %% [markdown]
# > **Predict.** Now *nothing* is changed. A study draws five of our ten bootstrapped agents, then five again, and
# > compares the two groups. In how many of 100 such studies does the 95 % interval leave out 0?

# %%
left_out = ["none", "1 to 10", "11 to 50", "over 50"]
predict("how_many_seeds.4", "Nothing is changed: how many of 100 intervals leave out 0?", left_out)

# %%
predicted("how_many_seeds.4")
bc.show(figures.nothing_changed(study))

# %% [markdown]
# **See.** *In {{ sum(map(counts.leaves_out_0, twice())) }} of these 100 studies the interval leaves out 0, by
# luck alone.* An exact 95 % interval would in 5; the bootstrap is not exact.
# <!-- claim: 1 < sum(map(counts.leaves_out_0, twice())) <= 10 -->
#
# Train five agents with one number changed and five without. `bonus=0.0` pays no bonus for demonstrated seconds.
# The score is an agent's success on 200 roads after 150 episodes.

# %%
# Yours: you may also change rule_p (now 0.9), beta_start (0.6), gamma (0.8) or xi_multiplier (200).
CHANGE = {"bonus": 0.0}
settings = {
    "as it is": bc.settings_for("bootstrapped"),
    "changed": bc.settings_for("bootstrapped", **CHANGE),
}
mine = bc.compare(settings, episodes=150, seeds=5, tests=200, learner="compiled", progress=False)
success = {name: mine.scores(name, "success") for name in settings}
interval_of = own_code.yours_or_ours("difference_interval", doing="Comparing")
table(counts.ABLATION, *counts.ablation(success, interval_of))

# %% [markdown]
# An interval that contains 0 does not say that both learn alike; one that leaves out 0 may be luck. So we trained
# *new* agents without the bonus and with it: 40 each, a number decided beforehand.
# <!-- claim: {len(each) for each in shipped_experiment('new-agents').values()} == {40} -->

# %%
new = shipped.shipped_experiment("new-agents")
bc.show(figures.new_agents(new, success, interval_of))

# %% [markdown]
# **See.** *By forty of each, a difference above {{ new(40).high | .0f }} points is not believable*: was yours larger?
# Four times as many agents, about half the length. The first five's interval is {{ fives()[0] | .0f }} points long,
# those of the other seven fives {{ fives()[1:].min() | .0f }} to {{ fives()[1:].max() | .0f }}: an interval of five is
# itself a guess.
# <!-- claim: len(fives()) == 8 and 0.4 < length(40) / length(10) < 0.6 and length(10) / length(5) > 0.85 and
#   fives()[0] == length(5) < fives()[1:].min() -->
#
# Forty of each differ by {{ bracketed(new(40)).replace('-', '−') }} points. A doubling of the IQM is still believable:
# changed over unchanged is {{ ratio(iqm) }}. A doubling of the *mean* is just outside: {{ ratio(np.mean) }}. Say first
# which counts.
# <!-- claim: -10 < new(40).low < 0 < new(40).high < 25 and ratios(iqm).high > 2.5 and
#   1.9 < ratios(np.mean).high < 2 -->

# %% [markdown]
# ### If you try many changes
#
# Even at 5 %, at least one of twenty independent comparisons leaves out 0 in {{ 100 * (1 - 0.95**20) | .0f }} %
# of cases. This is **multiplicity**. Say beforehand which comparison counts, or multiply each p by their number
# (*Bonferroni*). For all six pairs of our four methods Round 2's p of {{ fisher(7, 1) | .3f }} would become
# {{ 6 * fisher(7, 1) | .2f }}, and no longer count. Eight against none would:
# 6 × {{ fisher(8, 0) | .4f }} = {{ 6 * fisher(8, 0) | .3f }}.
# <!-- claim: fisher(7, 1) < 0.05 < 6 * fisher(7, 1) and 6 * fisher(8, 0) < 0.05 -->

# %% [markdown] tags=["instructor"] minutes=3
# Give each group another number to change, and collect the results on the board: one row for each group, with
# its interval. How many leave out 0, and how many would if the changes did nothing? Ask what to do about that
# (choose the one that counts, or make each interval wider).

# %%
compare_predictions(
    "how_many_seeds",
    {
        1: f"at {100 * bc.statistics.rate(np.ones(1)).low:.1f} %",
        2: round(100 * bc.statistics.power(0.8, 0.3, 10)),
        3: explorable.holding(3),
        4: left_out[1],
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
# 4. A short interval of three seeds may be luck. Half the length takes about four times as many agents.
# 5. Of 100 comparisons without a change {{ sum(map(counts.leaves_out_0, twice())) }} showed a difference. Name
#    beforehand the one that counts, or correct each p.
#
# **Three questions to think about**
# - Can 20 drives of each show that two *agents* differ? That two *methods* do?
# - You may train forty more agents. Ten of each method? Or one in each of forty settings, to report the best?
# - Your sixth change raises the success, p = 0.04. What do you write?
#
# **Read on**: [the next lesson](found_and_kept.ipynb). Agarwal et al. (arXiv 2108.13264); Henderson et al.
# (arXiv 1709.06560).

# %% [markdown] tags=["instructor"]
# **Model answers.**
#
# - *What can 20 drives show?* Of two agents: with 20 of 20 the interval of the rate begins at
#   {{ 100 * rate(np.ones(20)).low | .0f }} %, so a difference of 30 points or more, roughly, shows. Of two
#   methods: with one agent behind each row, nothing beyond these two agents.
# - *40 more agents?* Ten more seeds for each method, if the question is whether the methods differ: eight
#   against seven of ten does not say. Forty settings, if a better one is looked for: the best came out best
#   partly by the luck of its seed, so report it with ten new ones.
# - *The sixth change?* After Bonferroni a p value of six has to be below 0.05 / 6. Write that six changes
#   were tried, which one looked best, and that new seeds have to confirm it.

# %% [markdown] tags=["instructor"]
# **On the board.** Four rows of ten dots each, dark where the agent escapes; beside each row its exact
# interval.
#
# **To discuss.** You have one figure and one sentence for the press. Which result do you leave out?
