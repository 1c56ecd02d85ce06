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
# # Found and kept
#
# Why do agents lose a way out that they had found?
#
# **What you will be able to do**
# - tell an agent that never found the way out from one that found it and lost it;
# - say what a way out is worth to an agent while it learns, and two ways to lose it;
# - compute how likely a table of single agents is.
#
# **Time** 41 minutes; running it takes under one minute. **It builds on** lessons [[the_trap]],
# [[learning_from_demonstrations]] and [[how_many_seeds]].

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
    table,
)
from bootcourse.course.lessons.found_and_kept import counts, explorable, figures

progress("found_and_kept")

# %% [markdown]
# ## Look first
#
# Below an agent learns with demonstrations alone (one of thirty, chosen because it gives up the way out for good just
# when the demonstrations end). **Drag** through its training. When does it drive out, and when not any more?

# %%
explorable.training()

# %% [markdown]
# *It finds the way out near episode {{ round(first_had(), -1) }}, loses it near {{ round(first_lost(), -1) }}, while
# demonstrations still come, and finds it again. After {{ ENDS | , }}, when they have ended, it stays behind trap 1.*
# Why?
# <!-- claim: 500 < first_had() < 560 and 840 <= first_lost() < 855 and 1000 < gone() < 1100 -->
#
# | | looks at | counts if |
# |---|---|---|
# | **found** | the training | more than half of a *window* of {{ WINDOW }} episodes in a row end ahead of trap 1 |
# | **lost** | the training | {{ HAD }} or more of a window are ahead, and at any time later {{ LOST }} or fewer |
# | **kept** | the test | found, and *escapes* (ahead on {{ 100 * ESCAPES | .0f }} % of the roads or more) |
#
# An agent can lose the way out, find it again, and keep it.
# <!-- claim: LOST == WINDOW / 2 -->

# %% [markdown]
# ## Round 1: who finds it, who keeps it?
#
# The study's four methods, ten agents of each:

# %%
study = bc.shipped_results()
bc.show(figures.found_and_kept(study))

# %% [markdown]
# *One rate at the end would not tell the five that find it and do not keep it from the five that never find it.* (Of
# ten others with demonstrations alone, trained twice as long, {{ way(others('demos'), 'demos').found }} find it and
# {{ way(others('demos'), 'demos').kept }} keep it.)
# <!-- claim: [way(of_all(), m).found for m in ('sac', 'soft', 'bootstrapped', 'demos')] == [1, 10,
#   10, 5] and way(of_all(), 'demos').kept == 0 and min(way(of_all(), m).kept for m in ('soft',
#   'bootstrapped')) > 5 -->
# <!-- claim: len(others('demos')) == 10 and 0 < way(others('demos'), 'demos').kept <
#   way(others('bootstrapped'), 'bootstrapped').kept and way(others('sac'), 'sac').found == 0 -->

# %% [markdown] tags=["instructor"] minutes=3
# Ask what could have happened to the agent of the first picture, and keep the answers for Round 2.

# %% [markdown]
# ## Round 2: what is the way out worth?
#
# An agent learns what makes its drives *worth* most: the sum of the rewards, discounted by its γ = 0.8 (lesson
# [[the_trap]]). While β, the share of demonstrations, falls to 0, a demonstrated second pays the bonus, too. From
# episode {{ ENDS | , }} on only the road pays.
# <!-- claim: SETTINGS.gamma == 0.8 -->
#
# {{ len(watched('demos')) }} more agents with demonstrations alone drove {{ ways.ROADS }} roads after every
# {{ ways.EVERY }} training episodes. Just before episode {{ ENDS | , }}, {{ len(before('demos')) }} of them get ahead
# on most roads. We follow these.
# <!-- claim: SETTINGS.beta_start > 0 -->
#
# > **Predict.** What are their ways out worth, the bonus not counted? Staying behind is worth {{ stays() | .2f }}. The
# > rule, whom they imitate, needs {{ rule_ahead() }} s to get ahead of trap 1, and at γ = 0.8 the first ten seconds
# > have nine tenths of the weight.

# %%
worth = ["most are worth less than staying", "about half are", "most are worth more"]
predict("found_and_kept.1", "What are their ways out worth?", worth)

# %%
predicted("found_and_kept.1")
bc.show(figures.worths("demos"))

# %% [markdown]
# **See.** *Less than staying*: {{ (before('demos') < stays()).sum() }} of {{ len(before('demos')) }}. Without discount
# {{ (undiscounted() > stays(1)).sum() }} of them earn more than staying. But in the first ten seconds, which count
# most, all fall back, on the first picture's road by {{ falls_back().min() | .0f }} to
# {{ falls_back().max() | .0f }} m; a car that stays does not.
# <!-- claim: (undiscounted() > stays(1)).sum() == 14 and abs(undiscounted() - stays(1)).min() > 3 -->
# <!-- claim: falls_back().min() > 2 and len(falls_back()) == 16 and abs(stays_back()) < 1 and
#   (falls_back(True) < falls_back().mean() - 5).all() -->
#
# By episode 2,000 {{ rise('demos') }} have gained: seven are ahead on ways worth more than 1, and seven are back behind
# trap 1.
# <!-- claim: stays() - 0.01 < before('demos').max() < stays() -->
# <!-- claim: fates('demos') == (8, 7, 1) and rise('demos') == 14 -->
# <!-- claim: (ends('demos', True) > 1).sum() == 7 and (ends('demos', False) >= before('demos').max()).sum() == 7 -->
# <!-- claim: (ends('demos', True) < before('demos').min()).sum() == 1 and (ends('demos', False) < 0).sum() == 1 -->

# %% [markdown] tags=["instructor"] minutes=5
# Let the class say, before the picture, what an agent gains that goes back to staying, with the
# bonus and without it. An agent need not be forgetful: it follows its objective, and the
# objective has changed.

# %% [markdown]
# > **Predict.** For {{ len(watched('demos')) }} others β never ends: their demonstrations, and the bonus, go on.
# > What becomes of their ways out?
# <!-- claim: len(watched('demos, β for ever')) == len(watched('demos')) -->

# %%
becomes = [
    "most are behind at the end, too: staying is worth more",
    "most are ahead at the end, on ways worth less than staying",
    "most are ahead at the end, on ways worth more than staying",
]
predict("found_and_kept.2", "What becomes of their ways out?", becomes)

# %%
predicted("found_and_kept.2")
bc.show(figures.worths("demos, β for ever"))

# %% [markdown]
# **See.** *All {{ len(before('demos, β for ever')) }} are ahead at the end, on ways worth less than staying.* After
# episode {{ ENDS | , }} six of them lose the way out, mostly by crashing, and find it again. Of those whose β ended,
# {{ fates('demos')[0] }} of {{ len(before('demos')) }} are ahead at the end (p = {{ fisher_of_fates() | .3f }}).
# <!-- claim: lost_later('demos, β for ever').sum() == 6 and crashes_of_losers() > 0.7 -->
# <!-- claim: fates('demos, β for ever')[0] == len(before('demos, β for ever')) and
#   (ends('demos, β for ever', True) < stays()).all() -->

# %% [markdown]
# ## Round 3: the demonstrations or their bonus?
#
# With β two things end, the demonstrations and their bonus. Which of them holds the agents out? Four groups of ten
# part the two: β ends or never ends, and the bonus is paid or is 0. These agents have the soft constraint, too, and
# all of them find the way out.
# <!-- claim: [(each.agents[0]['beta_episodes'], each.agents[0]['bonus']) for each in
#   groups().values()] == [(1000, 2), (None, 2), (1000, 0), (None, 0)] and SETTINGS.beta_episodes ==
#   1000 and {len(each) for each in groups().values()} == {10} and
#   {each.found_and_kept('bootstrapped')[0].sum() for each in groups().values()} == {10} -->
#
# **Exercise (12 min, ●●●).** With `had` for {{ HAD }} and `limit` for {{ LOST }}, which agents ever lose the
# way out? Windows overlap: one ends at each episode from the {{ WINDOW }}th on. The next panel counts with your
# function.


# %%
def ever_lost(success, had, limit):
    """After a window of 50 with at least `had` ahead, does one with `limit` or fewer ever follow?

    success: (agents, episodes) 0/1, at least 50 episodes; limit < had. Returns (agents,) bool.
    """
    # solution: the exercise's own


check.ever_lost(ever_lost)

# %% [markdown]
# > **Predict.** In one group β never ends, but no bonus is paid. How many of its ten agents lose the way out?

# %%
losers = ["none", "about half", "all"]
predict("found_and_kept.3", "How many lose it with endless demonstrations, but no bonus?", losers)

# %% [markdown]
# **Drag** the limit, at or below which the way out counts as lost.

# %%
predicted("found_and_kept.3")
explorable.losing()

# %% [markdown]
# **See.** *At {{ LOST }} all ten lose it*: demonstrations without the bonus do not hold them. With the endless bonus
# none of the ten loses it, at any limit up to 30.
# <!-- claim: [each.lost.sum() for each in map(group, groups())] == [10, 0, 8, 10] and
#   lost_least_if_both(5, 35) and lost_if_both(30) == 0 -->
#
# *Agents lose it by crashing, too.* The seven of these groups that get ahead on fewer than half of their test
# drives crash on most of them.
# <!-- claim: len(accidents_of_those_behind()) == 7 and accidents_of_those_behind().min() > 0.5 -->
#
# *If β ends, all ten escape without the bonus, seven with it* (p = {{ fisher(10, 7) | .1f }}; the returns:
# p = {{ p_of_returns() | .3f }}). But of ten others of each, trained twice as long,
# {{ escapers_of_others('bootstrapped, c = 0') }} escape without and {{ escapers_of_others('bootstrapped') }} with it:
# whether the bonus helps is open.
# <!-- claim: group('β ends, no bonus').escapes.sum() == 10 and group('β ends, bonus').escapes.sum() == 7 and
#   p_of_returns() < 0.05 -->
# <!-- claim: group('β ends, no bonus').earned.mean() > max(group(each).earned.mean() for each in groups() if each !=
#   'β ends, no bonus') + 20 and escapers_of_others('bootstrapped, c = 0') < escapers_of_others('bootstrapped') -->
#
# *The endless bonus has a price.* With it all ten escape, as slow as the rule, and earn
# {{ earned_by_escapers('β never ends, bonus') }}. Without it, the five that escape if β never ends earn
# {{ earned_by_escapers('β never ends, no bonus') }}; the other five crash.
# <!-- claim: all(group('β never ends, bonus').escapes) and group('β never ends, no bonus').escapes.sum() == 5 and
#   (accidents_of_rest('β never ends, no bonus') > 0.5).all() -->
# <!-- claim: abs(speed('β never ends, bonus') - of('rule').scores('speed').mean()) < 1.5 -->

# %% [markdown] tags=["instructor"] minutes=4
# Return to the guesses from the start. Ask why the picture may not be quoted as "without demonstrations
# agents forget": without the bonus, all ten lose the way out if β never ends, and all ten escape in the test
# if it ends. Then ask for a γ at which the rule's way pays more than staying (lesson
# [[learning_from_demonstrations]]'s first panel), and what should happen there when β ends.

# %% [markdown]
# ## Round 4: how likely is the paper's table?
#
# The paper prints a success of {{ PRINTED['soft']['success'].mean | .0f }} % for the soft constraint alone and
# {{ PRINTED['demos']['success'].mean | .0f }} % for demonstrations alone. Of our ten agents of each
# {{ escaped('soft') }} and {{ escaped('demos') }} escape. The paper does not say how many updates it makes for a
# decision, or how many agents stand behind a rate.
#
# Round 1's agents drive on four roads at once, make one update for four decisions, and learn from the rule's
# demonstrations. We trained others for {{ SHORTER | , }} episodes on one road, with 2 updates for each decision and,
# as in the paper, the stochastic rule's demonstrations.
# <!-- claim: SETTINGS.updates == 1 and SETTINGS.envs_per_agent == 4 -->
# <!-- claim: (STUDY, ENDS) == (2000, 1000) -->
# <!-- claim: {(u, a['envs_per_agent'], a['updates']) for (u, _), r in clocks().items() for a in
#   r.agents} == {('1/4', 4, 1), ('1', 1, 1), ('2', 1, 2), ('4', 1, 4)} and [sum(by == each for _, by in clocks())
#   for each in ('μ', 'π̃')] == [4, 4] -->
# <!-- claim: {r.curves['success'].shape[1] for r in clocks().values()} == {SHORTER} and
#   {a['beta_episodes'] for r in clocks().values() for m in ('demos', 'bootstrapped') for a in
#   r.of(m).agents} == {ENDS} -->

# %%
cells = counts.by_updates("the stochastic rule")
bc.show(figures.found_and_kept(cells["2"], counts.printed()))

# %% [markdown]
# **See.** *Here demonstrations alone do better than the soft constraint alone, as in the paper*: ten of ten
# agents keep the way out, against five (p = {{ fisher(10, 5) | .2f }}; chosen afterwards from eight settings: times
# eight, {{ 8 * fisher(10, 5) | .2f }}).
# <!-- claim: [way(clocks()['2', 'π̃'], m).kept for m in ('sac', 'soft', 'demos', 'bootstrapped')]
#   == [0, 5, 10, 10] -->
#
# > **Predict.** Draw a *single* agent from each row of the picture, and drive 20 held-out roads with it. How often do
# > the four rates read as the paper's: 0, 0, 100 and 100 %? (A rate of 95 % gives 20 of 20 in
# > {{ 100 * 0.95**20 | .0f }} % of cases.)
# <!-- claim: [PRINTED[m]['success'].mean for m in ('sac', 'soft', 'demos', 'bootstrapped')] == [0,
#   0, 100, 100] -->

# %%
how_often = ["in about 5 %", "in about a third", "in about 90 %"]
predict("found_and_kept.4", "How often do the four rates read as the paper's?", how_often)

# %% [markdown]
# **Exercise (10 min, ●●○).** Compute it. For each row you get the success rates of its agents, one of which
# is drawn. `printed` is what the paper prints for each row: 1 for 100 % (the agent gets out on all `episodes`
# drives), 0 for 0 % (on none). The rows are independent.


# %%
def reads_as_printed(rows, printed, episodes):
    """Chance that one agent drawn for each row drives as printed: list of (agents,) rates, 0/1s."""
    # solution: the exercise's own


check.reads_as_printed(reads_as_printed)

# %%
predicted("found_and_kept.4")
chance_of = own_code.yours_or_ours("reads_as_printed", doing="Computing")
methods = ["sac", "soft", "demos", "bootstrapped"]


def in_words(agents):
    """In how many % of the draws single agents give the paper's four rates."""
    rates = [agents.of(method).scores("success") for method in methods]
    few = counts.how_many(rates)  # agents of each method, if not ten
    return f"{100 * chance_of(rates, [0, 0, 1, 1], 20):.0f} %{few}"


rows = [[name, *map(in_words, counts.by_updates(name).values())] for name in counts.SYMBOLS]
below = "In brackets: how many agents of each method, where not ten."
table(["demonstrations by; updates for a decision:", "¼", "1", "2", "4"], rows, below)

# %% [markdown]
# **See.** *With 2 updates and the stochastic rule a third of the draws give the paper's four rates; from Round 1's
# agents none does.* Resampling the ten agents of each row
# gives {{ resampled()[0] | .0f }} to {{ resampled()[1] | .0f }} %. So another training and single agents,
# together, could give its rates, but not its returns: with demonstrations alone or both aids it prints
# {{ PRINTED['demos']['returns'].mean | .0f }} and {{ PRINTED['bootstrapped']['returns'].mean | .0f }}; these agents
# earn over {{ lowest() }}.
# <!-- claim: resampled()[0] < 15 and resampled()[1] > 50 -->
# <!-- claim: 0.3 < pattern(clocks()['2', 'π̃']).value < 0.36 and pattern(of_all()).value == 0 -->
# <!-- claim: {len(clocks()['2', 'π̃'].of(m)) for m in ('sac', 'soft', 'demos', 'bootstrapped')} == {10} and
#   len(clocks()) == 8 -->
# <!-- claim: (settings_for('demos', 'paper').updates, settings_for('demos', 'paper').envs_per_agent,
#   settings_for('demos', 'paper').stochastic_demonstrations) == (2, 1, True) -->

# %% [markdown] tags=["instructor"] minutes=4
# Before they read this section, let the class write on the board what could explain the paper's table: lost ways
# out, single agents, another training, other traffic (not tested). Then ask for the experiment that would separate
# the updates from the driver and from the roads: which agents, how many of each? (`bc.statistics.power(0.6, 0.4, n)`.)
# The paper's text says that the soft constraint alone does worse than plain SAC; its table gives it the higher return.
# <!-- claim: PRINTED['soft']['returns'].mean > PRINTED['sac']['returns'].mean -->

# %%
compare_predictions(
    "found_and_kept",
    {1: worth[0], 2: becomes[1], 3: losers[2], 4: f"in about a third: {in_words(cells['2'])}"},
)

# %% [markdown]
# ## What you now know
#
# 1. Finding the way out and keeping it are two things, and one rate at the end mixes them.
# 2. Just before the bonus ended, the ways out were worth less than staying. Afterwards most of these agents drove what
#    was worth more than their way out had been, half of them behind trap 1, half ahead.
# 3. If the bonus never ended, agents were ahead at the end, and as slow as the rule. Demonstrations without it did
#    not hold them.
# 4. Agents lost the way out by crashing, too.
# 5. Single agents, drawn from another training, can give the paper's rates by chance. You can compute how often.
#
# **Three questions to think about**
# - Would you let β end at 0? What would you watch to decide it?
# - How would you test the setting of Round 4 fairly?
# - A reviewer asks for "the success rate". Which two numbers do you give, and over what?
#
# **Read on**: [the next lesson](recorded_drives.ipynb). Christodoulou (arXiv 1910.07207); Ecoffet et al. (arXiv
# 2004.12919).

# %% [markdown] tags=["instructor"] minutes=3
# **Model answers.**
#
# - *Would you let β end?* A reason to end it: the road does not pay the demonstrations' bonus, so while it
#   lasts the critic values imitation. A reason against: once it is gone
#   {{ group('β ends, bonus').lost.sum() }} of ten agents lose the way out at least once. Watch what each seed's
#   way out is worth without the bonus: end β when it is worth more than staying.
# - *A fair test?* Fix the setting and the number of agents now, train new seeds with it, and count once.
# - *The reviewer?* How many trainings found it and how many kept it, each of how many, beside the share of
#   drives of those that kept it.

# %% [markdown] tags=["instructor"]
# **On the board.** One row of bars for each group, and beside it who keeps it and what these earn.
#
# **To discuss.** An agent that found the way out and lost it: is it a success of the method?
