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
# - say what a way out is worth to an agent while it learns, and why some are not kept;
# - compute how likely a table of single agents is.
#
# **Time** 47 minutes; running it takes under one minute. **It builds on** lessons [[the_trap]],
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
# Below an agent learns with demonstrations alone, without the soft constraint (one of thirty, chosen because it
# gives up the way out just when the demonstrations end). **Drag** through its training. When does it drive out?
# What does it do at the end?

# %%
explorable.training()

# %% [markdown]
# *It finds the way out near episode {{ round(first_had(), -1) }}. After the demonstrations have ended, it stays
# behind trap 1.* At the end it drives like an agent that never found the way out. *Why does it give it up?*
# <!-- claim: 500 < first_had() < 560 and 1000 < gone() < 1100 -->
#
# | | looks at | counts if |
# |---|---|---|
# | **found** | the training | more than half of a *window* of {{ WINDOW }} episodes in a row end ahead of trap 1 |
# | **lost** | the training | {{ HAD }} or more of a window are ahead, and at any time later {{ LOST }} or fewer |
# | **kept** | the test | found, and *escapes* (ahead on {{ 100 * ESCAPES | .0f }} % of the roads or more) |
#
# So an agent can lose the way out, find it again, and count as kept.
# <!-- claim: LOST == WINDOW / 2 -->

# %% [markdown]
# ## Round 1: who finds it, who keeps it?
#
# The study's four methods, ten agents of each:

# %%
study = bc.shipped_results()
bc.show(figures.found_and_kept(study))

# %% [markdown]
# *With demonstrations alone half of the ten find the way out, and none keeps it.* Of the *ten others* of lesson
# [[learning_from_demonstrations]], trained twice as long, {{ way(others('demos'), 'demos').found }} find it and
# {{ way(others('demos'), 'demos').kept }} keep it. One rate at the end mixes the two.
# <!-- claim: [way(of_all(), m).found for m in ('sac', 'soft', 'bootstrapped', 'demos')] == [1, 10,
#   10, 5] and way(of_all(), 'demos').kept == 0 and min(way(of_all(), m).kept for m in ('soft',
#   'bootstrapped')) > 5 -->
# <!-- claim: len(others('demos')) == 10 and 0 < way(others('demos'), 'demos').kept <
#   way(others('bootstrapped'), 'bootstrapped').kept and way(others('sac'), 'sac').found == 0 -->

# %% [markdown] tags=["instructor"] minutes=4
# Ask what could have happened to the agent of the first picture, and keep the answers for Round 2.

# %% [markdown]
# ## Round 2: what is the way out worth?
#
# An agent learns what makes its drives *worth* most: the sum of the rewards, discounted by its γ = 0.8 (lesson
# [[the_trap]]). While demonstrations last, a demonstrated second pays the bonus, too. From episode
# {{ ENDS | , }} on only the road pays.
#
# {{ len(watched('demos')) }} agents with demonstrations alone (the *ten others*, and more like them) drove
# {{ ways.ROADS }} roads after every {{ ways.EVERY }} training episodes. Take those that get ahead on most roads
# just before the bonus ends.
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
# **See.** *Less than staying*: {{ (before('demos') < stays()).sum() }} of {{ len(before('demos')) }}, one of them
# by a hair. So without the bonus the road gives an agent no reason to keep such a way. By episode 2,000 the
# {{ len(before('demos')) }} have gone two ways. {{ fates('demos')[0] }} are still ahead, all but one on ways that
# are worth more than 1: they are faster now. {{ fates('demos')[1] }} stay behind, unhurt, and one crashes.
#
# Who keeps it? Worth does not tell: {{ at_look('worth', True).mean() | .2f }} on average for those who end ahead,
# {{ at_look('worth', False).mean() | .2f }} for the others. Accidents do (we looked afterwards): at the dots
# those who end ahead crashed on {{ 100 * at_look('accident', True).max() | .0f }} % of the roads or fewer, six of
# the eight others on 20 % or more.
# <!-- claim: (at_look('accident', False) > 0.19).sum() == 6 and len(at_look('accident', False)) == 8 and
#   at_look('accident', True).max() < 0.19 and stats.mannwhitneyu(at_look('worth', True), at_look('worth',
#   False)).pvalue > 0.2 -->
# <!-- claim: (before('demos') < stays()).sum() >= len(before('demos')) - 1 and fates('demos') == (8, 7, 1) -->
# <!-- claim: (still('demos') > 1).sum() == 7 == len(still('demos')) - 1 -->
#
# So the agent of the first picture need not have *forgotten* its way out. At episode 1,000 it was worth
# {{ of_first(1000) | .2f }}; what the agent did instead was worth {{ of_first(1100) | .2f }} at episode 1,100 and
# {{ of_first(2000) | .2f }} at the end. (It is the only one of the seven that goes back without many crashes.)
# <!-- claim: crash_on_the_way_back() == 6 -->
# <!-- claim: of_first(1000) < of_first(1100) < of_first(2000) -->

# %% [markdown] tags=["instructor"] minutes=6
# Let the class say, before the picture, what an agent gains that goes back to staying, at each side of the dotted
# line: with the bonus, and without it. An agent need not be forgetful: it follows its objective, and the
# objective has changed.

# %% [markdown]
# > **Predict.** For as many more agents β never ends: their demonstrations, and the bonus, go on. What becomes of their
# > ways out?

# %%
becomes = [
    "most lose it, too: staying is worth more",
    "most keep it, and it stays worth less than staying",
    "most keep it, and it becomes worth more than staying",
]
predict("found_and_kept.2", "What becomes of their ways out?", becomes)

# %%
predicted("found_and_kept.2")
bc.show(figures.worths("demos, β for ever"))

# %% [markdown]
# **See.** *Most keep it, and it stays worth less than staying.* Of the {{ len(before('demos, β for ever')) }}
# that have one before episode 1,000, {{ fates('demos, β for ever')[0] }} are ahead at episode 2,000; of those
# whose β ended, {{ fates('demos')[0] }} of {{ len(before('demos')) }} were (p = {{ fisher_of_fates() | .3f }}).
# At the end {{ (at_the_end('demos, β for ever') < stays()).sum() }} of {{ len(at_the_end('demos, β for ever')) }}
# ways out are worth less than staying.
#
# With β two things end, the demonstrations and their bonus. Which of them holds the agents out? Round 3 parts the
# two.

# %% [markdown]
# ## Round 3: and with both aids?
#
# Now agents with the soft constraint, too. All of them find the way out, and we ask who loses it on the way: four
# groups of ten, in which β ends or never ends, and the bonus is paid or is 0.
# <!-- claim: [(each.agents[0]['beta_episodes'], each.agents[0]['bonus']) for each in
#   groups().values()] == [(1000, 2), (None, 2), (1000, 0), (None, 0)] and SETTINGS.beta_episodes ==
#   1000 and {len(each) for each in groups().values()} == {10} and
#   {each.found_and_kept('bootstrapped')[0].sum() for each in groups().values()} == {10} -->
#
# **Exercise (12 min, ●●●).** With `had` for {{ HAD }} and `limit` for {{ LOST }}, which agents ever lose the
# way out? The next panel counts with your function.


# %%
def ever_lost(success, had, limit):
    """After a window of 50 with at least `had` ahead, does one with `limit` or fewer ever follow?

    success: (agents, episodes) 0/1, at least 50 episodes; limit < had. Returns (agents,) bool.
    """
    # solution: the exercise's own


check.ever_lost(ever_lost)

# %% [markdown]
# > **Predict.** Take the group in which β never ends, but no bonus is paid. How many of the ten lose the way out?

# %%
losers = ["none", "about half", "all"]
predict("found_and_kept.3", "How many lose it with endless demonstrations, but no bonus?", losers)

# %% [markdown]
# **Drag** the limit, at or below which the way out counts as lost.

# %%
predicted("found_and_kept.3")
explorable.losing()

# %% [markdown]
# **See.** *All ten lose it*: endless demonstrations are not enough. Only where β never ends *and* the bonus is
# paid none does. So the bonus holds them.
# <!-- claim: [each.lost.sum() for each in map(group, groups())] == [10, 0, 8, 10] and
#   lost_least_if_both(5, 35) -->
#
# *These agents lose it in another way than Round 2's*: in the test each that gets ahead on fewer than half of its
# drives crashes on most of them. So there are two ways to lose it: to go back to what is worth more, and to
# crash.
# <!-- claim: all((group_scores(g, 'accident')[group_scores(g, 'success') < 0.5] > 0.5).all() for g in groups()) -->
#
# *Never to lose it has a price.* With the endless bonus agents drive as slowly as the rule, and all ten earn
# {{ group('β never ends, bonus').earned.mean() | .0f }}; the two groups whose β ends earn more.
#
# *Does a bonus that ends help?* Here the ten without it earn more
# ({{ group('β ends, no bonus').earned.mean() | .0f }} against {{ group('β ends, bonus').earned.mean() | .0f }}).
# Ten others of each kind, trained twice as long, turn the order round:
# {{ others_earn('bootstrapped, c = 0') | .0f }} without it, {{ others_earn('bootstrapped') | .0f }} with it (and
# {{ others_earn('bootstrapped, β for ever') | .0f }} with the endless bonus). So that stays open. That agents
# lose the way out least with the endless bonus is seen in both: {{ group('others: never').lost.sum() }} of the
# ten others lose it, and all ten of each of the other two kinds.
# <!-- claim: group('others: never').lost.sum() == 2 and group('others: ends').lost.all() and
#   lost(shipped_experiment('stress')['bootstrapped, c = 0'].curves['success']).all() -->
# <!-- claim: others_earn('bootstrapped, c = 0') < others_earn('bootstrapped') and group('β ends, no
#   bonus').earned.mean() > group('β ends, bonus').earned.mean() -->
# <!-- claim: others_earn('bootstrapped, β for ever') < min(others_earn('bootstrapped'), others_earn('bootstrapped, c =
#   0')) -->
# <!-- claim: group('β never ends, bonus').earned.mean() + 20 < min(group(g).earned.mean() for g in ('β ends, bonus', 'β
#   ends, no bonus')) -->
# <!-- claim: abs(of_both('β never ends, bonus', 'speed') - of('rule').scores('speed').mean()) < 1.5 -->
# <!-- claim: earn('others: never') + 20 < earn('others: ends') -->
#
# Round 2's picture for ten agents with both aids, and β that ends:

# %%
bc.show(figures.worths("bootstrapped"))

# %% [markdown]
# **See.** *All ten have a way out at episode 500, and it becomes worth more as β falls*:
# {{ early().min() | .2f }} to {{ early().max() | .2f }} then, {{ before('bootstrapped').min() | .2f }} to
# {{ before('bootstrapped').max() | .2f }} just before episode 1,000, and
# {{ at_the_end('bootstrapped').min() | .1f }} to {{ at_the_end('bootstrapped').max() | .1f }} at the end, for the
# nine that have one.
# <!-- claim: len(early()) == 10 and len(at_the_end('bootstrapped')) == 9 and early().max() <
#   before('bootstrapped').min() and before('bootstrapped').max() < at_the_end('bootstrapped').min() -->

# %% [markdown] tags=["instructor"] minutes=5
# Return to the guesses from the start. Ask why the picture may not be quoted as "without demonstrations
# agents forget": without the bonus, all ten lose the way out if β never ends, and all ten escape in the test
# if it ends. Then ask for a γ at which the rule's way pays more than staying (lesson
# [[learning_from_demonstrations]]'s first panel), and what should happen there when β ends.

# %% [markdown]
# ## Round 4: how likely is the paper's table?
#
# Here is the paper's table, beside ours:
# <!-- claim: (in_training('sac', 0, 2000) == 0).any() -->

# %%
table(counts.BOTH_TABLES, counts.both_tables(study))

# %% [markdown]
# With one aid alone, the paper's agents get out with demonstrations, ours with the soft constraint. The paper
# does not say how many updates it makes for a decision, or how many agents stand behind a rate. Its
# demonstrations are driven by the stochastic rule, ours by the rule. Our study trains on four roads at once and
# makes one update for four decisions: ¼. On one road it can make one, two or four.
#
# So we trained {{ SHORTER | , }} episodes with each of these, and with either driver. Here are the four methods
# with 2 updates and the stochastic rule. (We chose this setting *after* seeing all eight, so it suggests an
# explanation, and does not test it.)
# <!-- claim: escaped('demos') == 0 < escaped('soft') and PRINTED['demos']['success'].mean == 100
#   and PRINTED['soft']['success'].mean == 0 -->
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
# agents keep the way out, against five.
# <!-- claim: [way(clocks()['2', 'π̃'], m).kept for m in ('sac', 'soft', 'demos', 'bootstrapped')]
#   == [0, 5, 10, 10] -->
#
# > **Predict.** Draw a *single* agent from each row of the picture, and drive 20 held-out roads with it. How often do
# > the four rates read as the paper's: 0, 0, 100 and 100 %? Which row of the picture departs most from the paper's?
# <!-- claim: [PRINTED[m]['success'].mean for m in ('sac', 'soft', 'demos', 'bootstrapped')] == [0,
#   0, 100, 100] -->

# %%
how_often = ["in about 5 %", "in about a third", "in about half", "in about 90 %"]
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
methods, chance = ["sac", "soft", "demos", "bootstrapped"], {}
for setting, agents in cells.items():
    rates = [agents.of(method).scores("success") for method in methods]
    chance[setting] = chance_of(rates, [0, 0, 1, 1], 20)
bc.show(figures.chances(cells, chance))

# %% [markdown]
# **See.** *With 2 updates a third of the draws give the paper's four rates.* One row decides: five of the soft
# constraint's agents keep the way out, so a draw from it reads as 0 % in only {{ 100 * reads('soft') | .0f }} %.
# With the rule as driver the chances are {{ given_in_words('the rule') }}; those at 4 updates rest on three
# agents of each method.
# <!-- claim: 0.3 < pattern(clocks()['2', 'π̃']).value < 0.36 -->
# <!-- claim: reads('soft') < 0.5 and min(reads(m) for m in ('sac', 'demos', 'bootstrapped')) > 0.8 -->

# %% [markdown] tags=["instructor"] minutes=4
# Ask for the experiment that would separate the updates from the driver and from the
# roads: which agents, how many of each? (`bc.statistics.power(0.6, 0.4, n)`.)

# %% [markdown]
# **So why is our table not the paper's?**
#
# {{ explanations() }}
#
# *The case stays open*: single agents and another training together can give the paper's four *rates*. Its
# *returns* with demonstrations we hardly ever reach, ours are higher: of our agents that escape, here and in the
# report's ablations, {{ inside('demos') }} with demonstrations alone and {{ inside('bootstrapped') }} with both
# aids earn a return inside the paper's interval.
#
# <!-- claim: of('demos').scores('success').max() == 0 == pattern(of_all()).value -->
# <!-- claim: (settings_for('demos', 'paper').updates, settings_for('demos', 'paper').envs_per_agent,
#   settings_for('demos', 'paper').stochastic_demonstrations) == (2, 1, True) -->

# %% [markdown] tags=["instructor"] minutes=3
# Write the four explanations on the board before they read this section. Let the class write beside each what was
# seen of it, and whether that shows it. What must a paper print, so that nobody has to guess? (Updates for a
# decision, episodes, agents behind a row, all seeds.) The paper's text says that the soft constraint alone does
# worse than plain SAC; its table gives it the higher return.
# <!-- claim: PRINTED['soft']['returns'].mean > PRINTED['sac']['returns'].mean -->

# %%
of_100 = 100 * chance["2"]
compare_predictions(
    "found_and_kept",
    {1: worth[0], 2: becomes[1], 3: losers[2], 4: f"in about a third: {of_100:.0f} %"},
)

# %% [markdown]
# ## What you now know
#
# 1. Finding the way out and keeping it are two things, and one rate at the end mixes them.
# 2. Just before the bonus ended, most ways out were worth less than staying. Afterwards half of these agents had a
#    faster one, and most of the others stayed behind.
# 3. If the bonus never ends, agents lose the way out least, and stay as slow as the rule. Others lose it by crashing.
# <!-- claim: 0 < group('others: never').lost.sum() < group('others: ends').lost.sum() -->
# 4. You can compute how likely a table of single agents is.
#
# **Three questions to think about**
# - Would you let β end at 0? What would you watch to decide it?
# - How would you test the setting of Round 4 fairly?
# - A reviewer asks for "the success rate". Which two numbers do you give, and over what?
#
# **Read on**: [the next lesson](recorded_drives.ipynb) learns from recorded drives. Christodoulou (arXiv
# 1910.07207); Ecoffet et al. (arXiv 2004.12919).

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
