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
# it need not contradict our 0 of 10.
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
# speak of a difference.
# <!-- claim: fisher(7, 1) < 0.05 -->
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
# **See.** *With ten agents of each, more than half of the studies miss even this large difference.* The soft
# constraint's eight against both aids' seven (p = {{ fisher(8, 7) | .0f }}) shows no difference. It does not show
# that the two are alike.
# <!-- claim: power(0.8, 0.3, 10) < 0.5 < fisher(8, 7) and fisher(8, 3) > 0.05 -->
# <!-- claim: [stats.binom.pmf(range(11), 10, share).argmax() for share in (0.8, 0.3)] == [8, 3] -->
#
# The share of studies that find a difference is the **power** of the comparison. Compute it before you train: say
# which difference would matter to you, the **smallest effect of interest**, and take enough agents for 80 %. For 80
# against 30 % that is {{ enough(0.8, 0.3) }} of each.
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
# **Drag** the number of seeds to 10. How many miss now?

# %%
predicted("how_many_seeds.3")
explorable.intervals()

# %% [markdown]
# **See.** *Of 100 intervals {{ explorable.holding(3) }} contain the mean, not 95, and the shortest miss it.*
#
# **Explain.** Resampling knows only the agents that you trained. In 0.7³ = {{ 100 * 0.7**3 | .0f }} % of studies all
# three do well. They then agree, so their interval is short, and wrong: nothing in it says that three of ten agents
# fail. Ten seeds seldom agree like that; {{ explorable.holding(10) }} of 100 contain the mean.
# <!-- claim: 100 - explorable.holding(3) == round(100 * (0.7**3 + 0.3**3)) and 80 < explorable.holding(10) < 95 -->
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
# ## Round 4: does one number matter?
#
# Many papers compare groups by their **interquartile means** (IQM): leave out the lowest and the highest quarter, and
# take the mean. One odd agent of five moves a mean much and an IQM little. The price: an IQM can hide failures. Round
# 3's ten have the mean {{ of('bootstrapped').scores('returns').mean() | .0f }}, and the IQM {{
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
# luck alone.*
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
# Five of each leave much open: an interval as long as this one may contain 0, or leave it out, by luck. So we trained
# *new* agents, 40 of each, a number decided beforehand.
# <!-- claim: {len(each) for each in shipped_experiment('new-agents').values()} == {40} -->

# %%
new = shipped.shipped_experiment("new-agents")
bc.show(figures.new_agents(new, success, interval_of))

# %% [markdown]
# **See.** *After 150 episodes, without the bonus up to {{ new(40).high | .0f }} points more or {{ -new(40).low | .0f }}
# fewer are believable.* The interval still contains 0: forty of each show neither that the bonus helps nor that it
# harms. (If you changed
# another number, compare only the lengths.)
# <!-- claim: 0.4 < length(40) / length(10) < 0.6 and -5 < new(40).low < 0 < new(40).high < 25 -->
#
# **Explain.** The mean of n agents is off by about their spread divided by √n. So four times as many agents make the
# interval about half as long: from 10 to 40 of each, {{ length(10) | .0f }} to {{ length(40) | .0f }} points. The
# length is itself an estimate: that of five can be far off.

# %% [markdown]
# ## Round 5: which of our sentences would you print?
#
# Seven sentences of lessons [[the_barrier]] to [[how_many_seeds]], and how many agents did what they say, in the first
# group and in the second:

# %%
sentences = counts.sentences()
table(counts.SENTENCES[:2], [row[:2] for row in sentences])

# %% [markdown]
# Write down the numbers of those that you would print.
#
# > **Predict.** Sentences 4 and 5 are about the same forty agents. Which of the two has a p below 0.05?

# %%
which = ["both", "only that more escape", "only that fewer lose it", "neither"]
predict("how_many_seeds.5", "Which sentence about the floor has p below 0.05?", which)

# %%
predicted("how_many_seeds.5")
table(counts.SENTENCES, sentences)

# %% [markdown]
# **See.** *What you count decides what you can see*: of the floor's two sentences the second alone has p < 0.05.
# <!-- claim: fisher(20, 16, 20, 20) > 0.05 > 0.001 > fisher(0, 17, 20, 20) -->
# <!-- claim: [row[1] for row in counts.sentences()] == ['7 and 1 of 10', '18 and 6 of 20', '6 and 1 of 20',
#   '20 and 16 of 20', '0 and 17 of 20', '13 and 20 of 20', '16 and 16 of 20'] -->
#
# **Explain.** Most agents escape without the floor, too, so escapes leave it little to improve. A loss was looked for
# in every window of the training, and most agents without the floor had one.
#
# **Seven tests are seven chances for luck.** Suppose that nothing is behind them, that they are independent, and that
# each errs in 5 % of cases. Then at least one comes out below 0.05 in {{ 100 * (1 - 0.95**7) | .0f }} % of cases.
# (Fisher's tests err less: seven with as many agents as here in at most {{ 100 * family([10] + 6 * [20]) | .0f }} %.)
# This is **multiplicity**. Say beforehand which comparison counts, or correct each p. (We chose these seven; the course
# makes more comparisons.)
#
# *Holm* multiplies the smallest p by 7, the next by 6, and so on (last column; it never falls from one p to the next,
# and ends at 1). Sentences 2, 5 and 6 stay below 0.05: compare them with yours. Sentence 1 does not. New agents bring
# it back: of ten others of each, trained for 4,000 episodes, {{ others_escape('bootstrapped') }} and
# {{ others_escape('sac') }} escape (p = {{ fisher(others_escape('bootstrapped'), others_escape('sac')) | .4f }}).
# <!-- claim: (holm(counts.p_values()) < 0.05).tolist() == [False, True, False, False, True, True, False] and
#   fisher(others_escape('bootstrapped'),
#   others_escape('sac')) < 0.05 / 7 -->

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
        5: which[2],
    },
)

# %% [markdown]
# ## What you now know
#
# 1. The sample is the training: twenty drives of one agent are one sample of a method.
# 2. Compute the power before you train, for the smallest effect of interest.
# 3. What you count decides what you can see.
#
# **Three questions to think about**
# - Can 20 drives of each show that two *agents* differ? That two *methods* do?
# - You may train forty more agents. Ten of each method? Or one in each of forty settings, to report the best?
# - Your sixth change raises the success, p = 0.04. What do you write?
#
# <details><summary>Answers</summary>
#
# - *What can 20 drives show?* Two agents' large difference: they tell 80 from 30 % in
#   {{ 100 * power(0.8, 0.3, 20) | .0f }} of 100 cases, but 80 from 50 % in {{ 100 * power(0.8, 0.5, 20) | .0f }}.
#   Of two methods nothing, with one agent of each.
# - *Forty more agents?* Ten of each method, to compare the methods. The best of forty settings is best partly by the
#   luck of its seed.
# - *The sixth change?* That six were tried; the smallest of six p has to be below 0.05 / 6 (Holm). New seeds have to
#   confirm it.
#
# </details>
#
# **Read on**: Agarwal et al. (arXiv 2108.13264). A rate at the end is a
# photograph. [The next lesson](found_and_kept.ipynb) looks at the film.

# %% [markdown] tags=["instructor"]
# **On the board.** Four rows of ten dots each, dark where the agent escapes; beside each row its exact
# interval.
#
# **To discuss.** You have one figure and one sentence for the press. Which result do you leave out?
