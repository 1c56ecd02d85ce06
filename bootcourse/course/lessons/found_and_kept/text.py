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
# **What you will be able to do**
# - tell an agent that never found the way out from one that lost it;
# - say what a way out is worth to an agent, and what becomes of it when the bonus ends;
# - compute how likely a table of single agents is.
#
# **Time** 41 minutes. **It builds on** lessons [[the_trap]],
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
# An agent learns with demonstrations alone (one of thirty, chosen because it gives up the way out just when they end).
# **Drag** through its training. When does it drive out, and when not any more?

# %%
explorable.training()

# %% [markdown]
# *It finds the way out near episode {{ round(first_had(), -1) }}. After {{ ENDS | , }}, when the demonstrations have
# ended, it stays behind trap 1.* Why?
# <!-- claim: 500 < first_had() < 560 and 1000 < gone() < 1100 -->
#
# Take a *window* of {{ WINDOW }} training episodes in a row. An agent has **found** the way out if more than half of
# one end ahead of trap 1. It has **lost** it if {{ HAD }} or more did, and later {{ LOST }} or fewer. It has **kept**
# it if it found it and *escapes* in the test.
# <!-- claim: LOST == WINDOW / 2 -->

# %% [markdown]
# ## Round 1: who finds it, who keeps it?
#
# The study's four methods, ten agents of each:

# %%
study = bc.shipped_results()
bc.show(figures.found_and_kept(study))

# %% [markdown]
# *With demonstrations alone five find the way out and do not keep it.* One rate at the end would not tell them from
# the five that never find it. Of the ten unfilled squares five stay behind trap 1, and five crash on most roads (⊠).
# <!-- claim: [way(of_all(), m).found for m in ('sac', 'soft', 'bootstrapped', 'demos')] == [1, 10,
#   10, 5] and way(of_all(), 'demos').kept == 0 and min(way(of_all(), m).kept for m in ('soft',
#   'bootstrapped')) > 5 -->
# <!-- claim: crashes_of_not_kept().size == 10 and [(crashes_of_not_kept() == 0).sum(), (crashes_of_not_kept() >
#   0.6).sum()] == [5, 5] -->

# %% [markdown] tags=["instructor"] minutes=3
# Ask what could have happened to the agent of the first picture, and keep the answers for Round 2.

# %% [markdown]
# ## Round 2: what is the way out worth?
#
# An agent learns what makes its drives *worth* most: the sum of the rewards, discounted by its γ = 0.8 (lesson
# [[the_trap]]). Up to episode {{ ENDS | , }} a demonstrated second pays the bonus, too, then only the road pays. Just
# before, {{ len(before('demos')) }} of thirty more agents with demonstrations alone get ahead on most roads.
# <!-- claim: SETTINGS.gamma == 0.8 and SETTINGS.beta_start > 0 -->
# <!-- claim: len(watched('demos')) == len(watched('demos, β for ever')) == 30 -->
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
# **See.** *All {{ len(before('demos')) }} ways out are worth less than staying*: in the first ten seconds, which count
# most, the agents fall back to make room. From episode 1,500 on, nine are on faster ways out and seven back at staying.
# On the way there {{ crashing('demos') }} of the sixteen crash, at some look, on most of the roads.
# <!-- claim: (before('demos') < stays()).all() and len(before('demos')) == 16 and falls_back().min() > 2 -->
# <!-- claim: fates('demos') == (9, 7) and rise('demos') == 16 and crashing('demos') == 15 -->
# <!-- claim: ends('demos', True).min() > 0.85 and (abs(ends('demos', False) - stays()) < 0.06).all() -->
#
# **Explain. Both are uphill.** We read it so: an agent changes its drive a little, and keeps a change that pays. So
# which changes of a slow way out pay? Take the rule's way. Do *one thing* for the first k seconds, and then what the
# rule does:

# %%
bc.show(figures.two_hills())

# %% [markdown]
# **See.** *From the rule's way, two directions pay.*
#
# - *Keep straight*: each further second pays a little, and the end is staying.
# - *Accelerate*: the first three seconds pay more, and the third ends above staying. With a fourth second all
#   {{ walks.TRIED }} drives crash: beside the fast hill is a **cliff**.
# <!-- claim: all(np.diff(walks.means(IDLE)) > 0) and min(walks.gains(IDLE, k) for k in walks.KEPT[1:]) > 35 and
#   stays() - 0.01 < walks.means(IDLE)[-1] < stays() -->
# <!-- claim: [walks.gains(walks.FASTER, k) for k in (1, 2, 3)] == 3 * [walks.TRIED] and walks.means(walks.FASTER)[2] <
#   stays() < walks.means(walks.FASTER)[3] and walks.worths(walks.FASTER, 4).max() < -2 and
#   walks.means(walks.FASTER)[1] > walks.means(IDLE)[1] -->
#
# **This solves half of lesson [[the_trap]]'s riddle.** *How can a teacher help whose way is worth less than the trap?*
# Learning is a walk, not a choice. From the trap a faster drive is some eight right decisions away (lesson
# [[the_barrier]]), and most attempts crash. From the rule's way a better one is one changed decision away. This teacher
# put the learner on a slope. Which teachers do is the other half (lesson [[your_teacher]]).

# %% [markdown] tags=["instructor"] minutes=8
# Let the class say, before the picture, what an agent gains that goes back to staying, with the
# bonus and without it. An agent need not be forgetful: it follows its objective, and the
# objective has changed. Then ask which hill an agent takes. A story: the better its way out, the higher the hill. It
# fails: the ways out of the nine and of the seven had been worth about the same (p = {{ p_of_hills() | .1f }}).
# <!-- claim: p_of_hills() > 0.5 and abs(np.median(before_of('demos', True)) - np.median(before_of('demos', False))) <
#   0.05 -->

# %% [markdown]
# > **Predict.** For thirty others β never ends: their demonstrations, and the bonus, go on. What becomes of their ways
# > out?

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
# **See.** *All {{ len(before('demos, β for ever')) }} are ahead at the end, on ways worth less than staying.* They
# crash, too: {{ crashing('demos, β for ever') }} of them at some look on most of the roads.
# <!-- claim: fates('demos, β for ever') == (len(before('demos, β for ever')), 0) and
#   (ends('demos, β for ever', True) < stays()).all() and fisher_of_fates() < 0.05 -->
# <!-- claim: abs(ends('demos, β for ever', True) - before('demos, β for ever')).max() < 0.1 -->
#
# **Explain.** While β lasts they are on lesson [[learning_from_demonstrations]]'s **leash**: it holds them near the
# rule's drive.
#
# Of the four gates this is **Keep**: when the help ends, the way out *should* be worth more than staying. In the first
# picture it was not, and yet nine of sixteen stayed ahead: they had climbed to a faster way. Seven did not pass.

# %% [markdown]
# ## Round 3: what does the leash cost?
#
# With β two things end, the demonstrations and their bonus. Lesson [[learning_from_demonstrations]] found that the
# bonus holds, not the demonstrations. What does it *cost*? Four groups of ten separate the two. They have the soft
# constraint, too, and all of them find the way out.
# <!-- claim: [(each.agents[0]['beta_episodes'], each.agents[0]['bonus']) for each in
#   groups().values()] == [(1000, 2), (None, 2), (1000, 0), (None, 0)] and SETTINGS.beta_episodes ==
#   1000 and {len(each) for each in groups().values()} == {10} and
#   {each.found_and_kept('bootstrapped')[0].sum() for each in groups().values()} == {10} -->
#
# **Exercise (12 min, ●●●).** With `had` for {{ HAD }} and `limit` for {{ LOST }}, which agents ever lose the
# way out? Windows overlap: one ends at each episode from the {{ WINDOW }}th on.


# %%
def ever_lost(success, had, limit):
    """After a window of 50 with at least `had` ahead, does one with `limit` or fewer ever follow?

    success: (agents, episodes) 0/1, at least 50 episodes; limit < had. Returns (agents,) bool.
    """
    # solution: the exercise's own


check.ever_lost(ever_lost)

# %% [markdown]
# > **Predict.** In one group no bonus is ever paid, and β ends at episode {{ ENDS | , }}. Eight of its ten agents lose
# > the way out at least once. How many of the ten escape in the test?

# %%
escaping = ["two", "five", "all ten"]
predict("found_and_kept.3", "How many escape that are never paid a bonus, if β ends?", escaping)

# %% [markdown]
# **Drag** the limit, at or below which the way out counts as lost.

# %%
predicted("found_and_kept.3")
explorable.losing()

# %% [markdown]
# **See.** *Eight lose it, yet all ten escape*, and they earn the most of the four groups. With the endless bonus none
# loses it, but the ten drive at {{ speed('β never ends, bonus') | .1f }} m/s, little faster than the rule
# ({{ of('rule').scores('speed').mean() | .1f }}); the third group drives at {{ speed('β ends, no bonus') | .1f }}. If β
# never ends and no bonus is paid (last group), all ten lose it at the limit {{ LOST }}.
#
# If β ends, ten escape without the bonus and seven with it. That the bonus harms does not follow: with ten others of
# each, trained for 4,000 episodes, it is {{ escapes_of_twenty()[0] }} of twenty and {{ escapes_of_twenty()[1] }}.
# <!-- claim: escapes_of_twenty() == (16, 16) and [group(each).escapes.sum() for each in ('β ends, no bonus', 'β ends,
#   bonus')] == [10, 7] and earned('β ends, no bonus') == max(map(earned, groups())) -->
# <!-- claim: [each.lost.sum() for each in map(group, groups())] == [10, 0, 8, 10] and
#   lost_least_if_both(5, 35) and lost_if_both(30) == 0 -->
# <!-- claim: all(group('β never ends, bonus').escapes) and
#   0 < speed('β never ends, bonus') - of('rule').scores('speed').mean() < 1 and speed('β ends, no bonus') > 14 -->
#
# **Explain.** *The leash keeps the way out, and costs speed.* A demonstrated second pays {{ SETTINGS.bonus | .0f }}
# more than the road does, and no second on the road pays more than 1. So in the demonstrated rows the rule's way is
# worth more than either hill. Of the last group, without pay, half escape; the others crash on over two thirds of the
# roads. Why, this experiment does not say.
# <!-- claim: group('β never ends, no bonus').escapes.sum() == 5 and
#   crashes_in('β never ends, no bonus')[~group('β never ends, no bonus').escapes].min() > 2 / 3 -->
# <!-- claim: SETTINGS.bonus > 1 -->

# %% [markdown] tags=["instructor"] minutes=4
# Return to the guesses from the start. Ask why the picture may not be quoted as "without demonstrations
# agents forget": without the bonus, all ten lose the way out if β never ends, and all ten escape in the test
# if it ends. Then ask for a γ at which the rule's way pays more than staying (lesson
# [[learning_from_demonstrations]]'s first panel), and what should happen there when β ends.

# %% [markdown]
# ## Round 4: how likely is the paper's table?
#
# The paper prints a success of {{ PRINTED['soft']['success'].mean | .0f }} % for the soft constraint alone and
# {{ PRINTED['demos']['success'].mean | .0f }} % for demonstrations alone; of our ten of each {{ escaped('soft') }}
# and {{ escaped('demos') }} escape. We trained others with 2 updates for each decision in place of ¼, on one road at
# a time, from the stochastic rule's demonstrations, as in the paper, and for {{ SHORTER | , }} episodes, not
# {{ STUDY | , }}.
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
# *Here demonstrations alone do better, as in the paper.* Success of the soft row: {{ of_soft_row() }} %; of both rows
# with demonstrations: over 95 % each.
# <!-- claim: min(clocks()['2', 'π̃'].of(m).scores('success').min() for m in ('demos', 'bootstrapped')) > 0.95 -->
# <!-- claim: [way(clocks()['2', 'π̃'], m).kept for m in ('sac', 'soft', 'demos', 'bootstrapped')]
#   == [0, 5, 10, 10] -->
#
# > **Predict.** Draw a *single* agent from each row of the picture, and drive 20 held-out roads with it. How often do
# > the four rates read as the paper's? (A rate of 95 % gives 20 of 20 in {{ 100 * 0.95**20 | .0f }} % of cases.)
# <!-- claim: [PRINTED[m]['success'].mean for m in ('sac', 'soft', 'demos', 'bootstrapped')] == [0,
#   0, 100, 100] -->

# %%
how_often = ["in about 5 %", "in about a third", "in about 90 %"]
predict("found_and_kept.4", "How often do the four rates read as the paper's?", how_often)

# %% [markdown]
# **Exercise (10 min, ●●○).** Compute it. Each row has the success rates of its agents, one of which is drawn.
# `printed` is what the paper prints for it: 1 for 100 % (the agent gets out on all `episodes` drives), 0 for 0 % (on
# none). The rows are independent.


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
    words = f"{100 * chance_of(rates, [0, 0, 1, 1], 20):.0f} %{few}"
    return words.replace(" ", "\N{NO-BREAK SPACE}")  # on one line


rows = [[name, *map(in_words, counts.by_updates(name).values())] for name in counts.SYMBOLS]
below = "All for 1,200 episodes. In brackets: how many agents of each method, where not ten."
table(["demonstrations by", "updates for a decision: ¼", "1", "2", "4"], rows, below)

# %% [markdown]
# **See.** *With 2 updates and the stochastic rule a third of the draws give the paper's four rates; from Round 1's
# agents none does.* So another training and single agents, together, could give its rates, but not its returns: with
# both aids it prints {{ PRINTED['bootstrapped']['returns'].mean | .0f }}; these agents earn over {{ lowest() }}.
# (Four updates read higher still, but with three agents of each method.)
# <!-- claim: {len(clocks()['4', by].of(m)) for by in ('μ', 'π̃') for m in ('sac', 'soft', 'demos', 'bootstrapped')} ==
#   {3} and min(pattern(clocks()['4', by]).value for by in ('μ', 'π̃')) > 0.36 -->
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
    {1: worth[0], 2: becomes[1], 3: escaping[2], 4: f"in about a third: {in_words(cells['2'])}"},
)

# %% [markdown]
# ## What you now know
#
# 1. When the bonus ended, nine of sixteen agents found a faster way out, and seven went back to staying.
# 2. A teacher can help whose way is worth less than the trap: from the rule's way, small changes pay.
# 3. The bonus is a leash: while it lasted none of ten lost the way out, and they drove little faster than the rule.
# 4. Single agents of another training can give the paper's rates by chance.
#
# **Three questions to think about**
# - Would you let β end at 0? What would you watch?
# - How would you test the setting of Round 4 fairly?
# - A reviewer asks for "the success rate". Which two numbers do you give, and over what?
#
# <details><summary>Answers</summary>
#
# - *Let β end?* The bonus holds you near the rule's speed, and to wait for a better way did not help: with an endless
#   bonus none of {{ len(before('demos, β for ever')) }} got above staying. End β, watch each agent's worth and crashes,
#   and keep the agent of the best look.
# - *A fair test?* Fix the setting and the number of agents, and count new seeds once. We chose it from eight.
# <!-- claim: len(clocks()) == 8 -->
# - *The reviewer?* How many trainings found the way out, and how many kept it, each of how many.
#
# </details>
#
# **Read on**: Christodoulou (arXiv 1910.07207). So far the learner could drive.
# Suppose that it may not: all you have is the rule's records ([the next lesson](recorded_drives.ipynb)).

# %% [markdown] tags=["instructor"]
# **On the board.** One row of bars for each group, and beside it who keeps it and what these earn.
#
# **To discuss.** An agent that found the way out and lost it: is it a success of the method?
