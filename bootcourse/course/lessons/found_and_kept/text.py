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
# Why is our table not the paper's?
#
# **What you will be able to do**
# - tell an agent that never found the way out from one that found it and lost it;
# - say by which clock an aid ends: episodes or updates;
# - say how likely a table of single agents is.
#
# **Time** 50 minutes; running it takes under one minute. **It builds on** the seeds (lesson
# [[how_many_seeds]]).

# %%
import bootcourse as bc
import numpy as np
from bootcourse.course import (
    check,
    compare_predictions,
    predict,
    predicted,
    progress,
    shipped,
    table,
)
from bootcourse.course.lessons.found_and_kept import counts, explorable, figures
from bootcourse.research.experiments import clocks

progress("found_and_kept")

# %% [markdown]
# ## Look first
#
# One of our ten agents with demonstrations alone, after its training. Press play.

# %% tags=["nbval-ignore-output"]
study = bc.shipped_results()
training = study.of("demos").curves["success"]
best = int(np.argmax(training[:, 700:900].mean(axis=1)))
drive = bc.record(bc.shipped_agents("demos")[best].as_policy(), [10], label="demos")[0]
bc.recording([shipped.beginning(drive, 30)], height=240)

# %% [markdown]
# It stays behind trap 1. Yet in the middle of the training it was the best of the ten:
# <!-- claim: not of_the_agent_shown().success -->

# %%
title = "This agent learned the way out, and lost it"
bc.show(figures.one_agent(study.of("demos"), best, title))
tested = study.of("demos").scores("success")[best]
print(f"after training: ahead of trap 1 on {100 * tested:.0f} % of the held-out roads")

# %% [markdown]
# It lost the way out: first it crashes, then it stays behind. At the end it fails like an agent of
# plain SAC that never found it. One number at the end mixes these two problems, and such numbers
# are what the paper prints:
# <!-- claim: crashing_and_waiting(1000, 1100)[0] > 0.8 and crashing_and_waiting(1700, 2000)[1] > 0.9
#   -->
# <!-- claim: (in_training('sac', 0, 2000) == 0).any() -->

# %%
table(counts.BOTH_TABLES, counts.both_tables(study))

# %% [markdown]
# The orders differ. With one aid alone, the paper's agents get out with demonstrations, and ours
# with the soft constraint. The paper's text says that the soft constraint alone does worse than plain
# SAC; its table gives it the higher return.
# <!-- claim: PRINTED['soft']['returns'].mean > PRINTED['sac']['returns'].mean -->
# <!-- claim: escaped('demos') == 0 < escaped('soft') and PRINTED['demos']['success'].mean == 100
#   and PRINTED['soft']['success'].mean == 0 -->
#
# One agent behind each of its rates could explain the difference (lesson [[how_many_seeds]]). What
# else could?

# %% [markdown] tags=["instructor"] minutes=4
# Ask what could have happened at the fall, and keep the answers for Round 2.

# %% [markdown]
# ## Round 1: found, and kept
#
# From here on these words mean:
#
# - **Found**: in at least one *window*, {{ WINDOW }} training episodes in a row, more than half ended
#   ahead of trap 1. Such a window is *good*.
# - **Lost**: after a window with at least {{ HAD }} ahead comes one that is not good.
# - **Kept**: the agent found the way out and escapes after training: it is ahead on at least
#   {{ 100 * ESCAPES | .0f }} % of the held-out roads.
#
# *Kept* looks at the end only: an agent may have lost the way out in between and found it again.
# *Not ahead* has two forms: the car stays behind trap 1, or it crashes there.
#
# > **Predict.** At the end one of ten agents of plain SAC escapes, and with demonstrations alone
# > none. At first these have the rule's way out in their batches. In which group did more agents
# > *find* the way out?
# <!-- claim: [(escaped(m), len(of(m))) for m in ('sac', 'demos')] == [(1, 10), (0, 10)] -->
# <!-- claim: LOST == WINDOW / 2 -->

# %%
choices = ["plain SAC", "demonstrations alone", "as many in both"]
predict("found_and_kept.1", "In which group did more agents find the way out?", choices)

# %% [markdown]
# **Exercise (12 min, ●●●).** When did an agent find the way out, and until when did it have it?
# Return for each agent the episode that ends its first good window of `window` episodes, and the
# one that ends its last; 0 and 0 if it has none. Episodes are counted from 1. The dots on the first
# curve are such a pair.


# %%
def forgetting(success, window):
    """Ends of the first and last good window: (agents, episodes) 0/1 -> (agents, 2) episodes.

    For example [[0, 1, 1, 0, 1, 0, 0]] has good windows of 3 that end at 3, 4 and 5: [[3, 5]].
    """
    # solution: the exercise's own


check.forgetting(forgetting)

# %%
predicted("found_and_kept.1")
bc.show(figures.found_and_kept({"": study}, figures.IN_THE_STUDY))

# %% [markdown]
# **See.** A low count at the end can mean two things. Of plain SAC one agent finds the way out. With
# demonstrations alone half of the agents find it, and none keeps it. With the soft constraint,
# alone or with demonstrations (bootstrapped SAC), each agent finds it, and most keep it.
# <!-- claim: [way(of_all(), m).found for m in ('sac', 'soft', 'bootstrapped', 'demos')] == [1, 10,
#   10, 5] and way(of_all(), 'demos').kept == 0 and min(way(of_all(), m).kept for m in ('soft',
#   'bootstrapped')) > 5 -->
#
# Of the *ten others* (lesson [[how_many_seeds]]: another learner, twice the episodes) {{
# way(others('demos'), 'demos').found }} find the way out with demonstrations alone and {{
# way(others('demos'), 'demos').kept }} keep it; of plain SAC none finds it.
# <!-- claim: len(others('demos')) == 10 and 0 < way(others('demos'), 'demos').kept <
#   way(others('bootstrapped'), 'bootstrapped').kept and way(others('sac'), 'sac').found == 0 -->

# %% [markdown] tags=["instructor"] minutes=5
# Ask which of the two an exploration bonus could improve, and which a larger replay buffer.

# %% [markdown]
# ## Round 2: what if an aid never ends?
#
# In the study both aids end. The share β of demonstrations in each batch falls to 0 by episode {{
# SETTINGS.beta_episodes | , }}, and the strength ξ of the soft constraint fades to almost 0. When
# do the ten agents with both aids have the way out?
# <!-- claim: max(run.curves['alpha'][999] / run.curves['alpha'][0] for run in
#   shipped_runs('bootstrapped')) < 1e-4 -->

# %%
lost = bc.statistics.lost(study.of("bootstrapped").curves["success"])
title = f"{lost.sum()} of {len(lost)} agents with both aids lose the way out at least once"
bc.show(figures.agent_by_agent(study, "bootstrapped", title))

# %% [markdown]
# **See.** Up to episode {{ LATE }}, when a tenth of β is left, no agent that has found the way out
# loses it. Later each does, where its first bar ends, and most find it again. In the window in
# which each first loses it, every failure is a crash behind trap 1.
# <!-- claim: len(first_losses()) == 10 and all(failed == crashed > 0 for failed, crashed in
#   first_losses()) -->
# <!-- claim: lost_where_the_first_bar_ends('bootstrapped') -->
# <!-- claim: losers().all() and kept_until_late('bootstrapped') and way(of_all(),
#   'bootstrapped').kept > 5 -->
# <!-- claim: abs(demonstration_share(LATE, 1.0, SETTINGS.beta_episodes) - 0.1) < 0.01 -->
#
# **Explain.** A possible reading: while β lasts, each batch shows the critic the rule's way out,
# paid with a bonus. Later the agent learns from its own driving alone, and these values can drift.
# If this is right, agents should not lose the way out if β, with its bonus, never ends.
#
# > **Predict.** If β never ends, each second of the rule's drives in a batch is paid a bonus for
# > ever. Do the agents that keep the way out then earn more, as much, or less than those whose β
# > ends?

# %%
choices = ["more", "about as much", "less"]
predict("found_and_kept.2", "What do they earn if β never ends?", choices)

# %%
predicted("found_and_kept.2")
changed, others = (shipped.shipped_experiment(name) for name in ("ablations", "stress"))
fates = counts.fates(study, changed, others)
table(counts.HEADINGS, fates, "The study's ten; ten others: another learner, twice the episodes.")

# %% [markdown]
# **See.** *In two of three pairs fewer agents lose the way out if the aid stays*: with both aids, if
# β and its bonus stay; with the soft constraint alone, if ξ falls to 0.1 and stays. In the column
# *kept it* these pairs show no clear difference: most that lose the way out find it again.
# <!-- claim: fate(ENDS)[:3] == ['20', '20', '16'] and fate(STAYS)[:3] == ['20', '2', '19'] -->
# <!-- claim: fate(FADES)[:3] == ['20', '17', '16'] and fate(STOPS)[:3] == ['20', '0', '20'] -->
# <!-- claim: min(stats.fisher_exact([[16, 4], [kept, 20 - kept]]).pvalue for kept in (19, 20)) >
#   0.05 -->
#
# *The reading above is not all of it.* With demonstrations alone most that find it lose it although
# β stays; yet {{ fate(ALONE_STAYS)[2] }} keep it, not {{ fate(ALONE_ENDS)[2] }}. With both aids and
# no bonus all of ten lose it although β stays. And without any β none of twenty loses it if ξ stays
# at 0.1. Why agents lose the way out is open.
# <!-- claim: fate(ALONE_ENDS)[:3] == ['12', '10', '5'] and fate(ALONE_STAYS)[:3] == ['17', '13',
#   '14'] and stats.fisher_exact([[5, 15], [14, 6]]).pvalue < 0.05 -->
# <!-- claim: lost(shipped_experiment('ablations')['β for ever, c = 0'].curves['success']).tolist()
#   == [True] * 10 -->
#
# *Those that keep the way out can earn less.* If β never ends they earn little more than half as
# much. Without the bonus five of ten keep it although β stays, and earn {{ without_bonus()[1] | .0f
# }}. If ξ stays at 0.1 they earn little less.
# <!-- claim: without_bonus()[0] == 5 -->
# <!-- claim: 0.5 < int(fate(STAYS)[3]) / int(fate(ENDS)[3]) < 0.6 and int(fate(STOPS)[3]) /
#   int(fate(FADES)[3]) > 0.9 -->

# %% [markdown] tags=["instructor"] minutes=5
# Return to the guesses from the start. Ask why the first two rows may not be quoted as "without
# demonstrations agents forget": β stays there together with its bonus.

# %% [markdown]
# ## Round 3: two clocks
#
# Each aid ends by its own clock. β counts *episodes*. ξ counts *updates*: the paper's target
# entropy cannot be reached with nine actions (lesson [[discrete_sac]]), so each update lowers α,
# and with it ξ = {{ SETTINGS.xi_multiplier | .0f }}α.
# <!-- claim: SETTINGS.target_entropy < 0 -->
#
# How many updates belong to a decision? The paper does not say. In the study an agent drives four
# roads at once, and updates once when all four have decided: ¼ update for a decision. **Drag** the
# updates for a decision. Does ξ then reach 1 % in an earlier or in a later episode?
# <!-- claim: SETTINGS.updates == 1 and SETTINGS.envs_per_agent == 4 -->

# %%
explorable.clocks()

# %% [markdown]
# In an earlier one: by episode {{ fades_by(0.25) }} with ¼ update, by {{ fades_by(2) }} with two.
# <!-- claim: fades_by(4) < fades_by(2) < fades_by(1) < fades_by(0.25) < SETTINGS.beta_episodes -->
#
# The paper also says that π̃, the stochastic rule, drove its demonstrations. In the study μ did, the
# rule itself. We trained two new groups for {{ SHORTER | , }} episodes. They differ in three settings:
# ¼ update, driver μ and four roads at a time; two updates, driver π̃ and one road.
# <!-- claim: {(u, a['envs_per_agent'], a['updates']) for (u, _), r in clocks().items() if u in
#   ('1/4', '2') for a in r.agents} == {('1/4', 4, 1), ('2', 1, 2)} -->
# <!-- claim: {r.curves['success'].shape[1] for r in clocks().values()} == {SHORTER} -->
#
# > **Predict.** The second group has eight times the updates for each decision. So ξ ends in an
# > earlier episode, and β after more updates. With which aid alone do more of its ten agents keep
# > the way out?

# %%
choices = ["the soft constraint alone", "demonstrations alone", "about the same"]
predict("found_and_kept.3", "With which aid alone do more agents keep the way out?", choices)

# %%
predicted("found_and_kept.3")
cells = clocks.choices(shipped.shipped_experiment("clocks"))
panels = {"¼ update, driver μ": cells["1/4", "μ"], "2 updates, driver π̃": cells["2", "π̃"]}
bc.show(figures.found_and_kept(panels, figures.OF_TWO_GROUPS))

# %% [markdown]
# **See.** On the right the order of the two aids is the paper's. Here *kept* means until {{ SHORTER -
# SETTINGS.beta_episodes }} episodes after β has ended, in the study {{ 2000 - SETTINGS.beta_episodes
# | , }}.
# <!-- claim: of_all().curves['success'].shape[1] == 2000 -->
# <!-- claim: [way(clocks()[of], 'soft').kept for of in (('1/4', 'μ'), ('2', 'π̃'))] == [6, 5] and
#   [way(clocks()[of], 'demos').kept for of in (('1/4', 'μ'), ('2', 'π̃'))] == [2, 10] -->
#
# An agent that keeps the way out may drive badly: the one of plain SAC crashes on each held-out
# road.
# <!-- claim: kept_of_sac()[0] == 1 and kept_of_sac()[1] < 0 -->
#
# Which of the three settings does it? How many agents keep the way out in each combination:

# %%
table(counts.SETTINGS, counts.kept_in_each(cells), "One road at a time, with ¼ update four.")

# %% [markdown]
# **See.** With π̃ and ¼ update, or μ and more updates (one road), not all keep it. That it takes
# both is not shown: 6 of ten against 10 has p = {{ stats.fisher_exact([[6, 4], [10, 0]]).pvalue |
# .2f }}. Where fewer than ten were trained, a count says little.
# <!-- claim: counts.kept_in_each(clocks())[0] == ['¼', '6 of 10', '2 of 10', '6 of 10'] and
#   counts.kept_in_each(clocks())[2] == ['2', '5 of 10', '2 of 4', '10 of 10'] -->

# %% [markdown] tags=["instructor"] minutes=5
# Ask for the experiment that would separate the updates from the driver and from the roads: which
# agents, how many of each? (`bc.statistics.power(0.6, 0.4, n)`.)

# %% [markdown]
# ## Round 4: how likely is the paper's table?
#
# On the right of the picture, three rows of four look like the paper's. In the soft constraint's
# row the paper prints 0 %, and half of our agents keep the way out. But the rate of *one* agent is
# mostly near 0 or near 100 %.
# <!-- claim: [way(clocks()['2', 'π̃'], m).kept for m in ('sac', 'soft', 'demos', 'bootstrapped')]
#   == [0, 5, 10, 10] -->
# <!-- claim: (np.abs(clocks()['2', 'π̃'].of('soft').scores('success') - 0.5) > 0.49).sum() == 9 -->
#
# > **Predict.** Draw one agent from each row on the right, and drive 20 held-out roads with it. How
# > often do all four rates read as the paper's?

# %%
how_often = ["in under 1 %", "in 10 to 60 %", "in over 90 %"]
predict("found_and_kept.4", "How often do the four rates read as the paper's?", how_often)

# %% [markdown]
# **Exercise (10 min, ●●○).** Compute it. For each row you get the success rates of its agents, one
# of which is drawn. A row prints 100 % (1) if all of the drawn agent's `episodes` drives succeed,
# and 0 % (0) if none does. The rows are independent.


# %%
def reads_as_printed(rows, printed, episodes):
    """Chance that one agent drawn for each row drives as printed: list of (agents,) rates, 0/1s."""
    # solution: the exercise's own


check.reads_as_printed(reads_as_printed)

# %%
predicted("found_and_kept.4")
rows = [[words, counts.percent(clocks.pattern(agents))] for words, agents in panels.items()]
table(["", "all four rates read as the paper's [95 % over seeds]"], rows)

# %% [markdown]
# **See.** With two updates and π̃ the paper's four rates are an ordinary outcome, and with ¼ update
# and μ a rare one. The interval is wide, and we chose this setting after we had seen the counts.
# <!-- claim: pattern(clocks()['2', 'π̃']).low > 0.05 > pattern(clocks()['1/4', 'μ']).value -->

# %% [markdown]
# ## So why is our table not the paper's?
#
# - *Shown*: the *success rates* of the two tables need not contradict each other. With the paper's
#   driver π̃, and two updates for a decision, which it leaves open, they are an ordinary outcome, if
#   one agent stands behind each row.
# - *Not shown*: that the authors used this setting. The returns differ: our agents with both aids
#   earn {{ clocks()['2', 'π̃'].of('bootstrapped').scores('returns').mean() | .0f }}, and theirs
#   {{ PRINTED['bootstrapped']['returns'].mean | .0f }}.
#
# `bc.settings_for(method, "paper")` has two updates for each decision, and π̃.
# <!-- claim: settings_for('sac', 'paper').updates / settings_for('sac', 'paper').envs_per_agent ==
#   8 * SETTINGS.updates / SETTINGS.envs_per_agent and settings_for('demos',
#   'paper').stochastic_demonstrations -->

# %% [markdown] tags=["instructor"] minutes=4
# Write the two sentences, "shown" and "not shown", on the board before the last paragraph, and let
# the class fill them in. What would the authors have to print so that nobody had to guess? (Updates
# for a decision, agents behind a row, all seeds.)

# %%
finders = [study.found_and_kept(method)[0].sum() for method in ("demos", "sac")]
of_100 = 100 * clocks.pattern(panels["2 updates, driver π̃"]).value
compare_predictions(
    "found_and_kept",
    {
        1: f"demonstrations alone: {finders[0]} against {finders[1]}",
        2: f"less: {fates[1][-1]} instead of {fates[0][-1]}",
        3: "demonstrations alone",
        4: f"in 10 to 60 %: {of_100:.0f} %",
    },
)

# %% [markdown]
# ## What you now know
#
# 1. To find the way out and to keep it are two things, and one rate at the end mixes them.
# 2. If β ends, all twenty of these agents with both aids lose the way out at least once. If β
#    stays, with its bonus, two do, and those that keep the way out earn less.
# 3. The two aids fade by different clocks: ξ by updates, β by episodes.
# 4. With two updates and π̃ ten of ten agents keep the way out with demonstrations, five with the
#    soft constraint; with ¼ update and μ two and six. Which of the changes does it is open.
# 5. A row that is one agent depends on the luck of one training. Print each agent, the updates for
#    a decision, the roads at a time, and the demonstrations' driver.
#
# **Three questions to think about**
# - Would you let β end at 0? What would you watch to decide it?
# - Which of the two problems would a larger target entropy help with?
# - A reviewer asks for "the success rate". Which two numbers do you give, and over what?
#
# **Read on**: [lesson [[your_teacher]]](your_teacher.ipynb) repeats the ablation with a teacher of
# your own. Christodoulou, *Soft Actor-Critic for Discrete Action Settings* (arXiv 1910.07207);
# Ecoffet et al., *First return, then explore* (arXiv 2004.12919).

# %% [markdown] tags=["instructor"] minutes=5
# **Model answers.**
#
# - *Would you let β end?* A reason to end it: the road does not pay the demonstrations' bonus, so
#   while it lasts the critic values imitation. A reason against: once it is gone
#   {{ losers().sum() }} of ten agents lose the way out at least once. Watch the
#   success of each seed, and the Q of the demonstrated actions.
# - *A larger target entropy?* With finding: η = 0.3 nat lies below the entropy of π̃
#   ({{ math.log(rule_actions()) | .2f }} nat), so α and ξ fall more slowly, and an agent goes on
#   trying. η = 1 lies above it: ξ = 200α pulls the policy to π̃, so its entropy stays below η, and
#   α and ξ rise again. Whether a larger η also helps keeping was tried with three agents a row.
# - *The reviewer?* How many trainings found it and how many kept it, each of how many, beside the
#   share of drives of those that kept it.

# %% [markdown] tags=["instructor"]
# **On the board.** Two curves that fall: ξ over updates, β over episodes, and the episode in which
# half of the agents have found the way out.
#
# **To discuss.** An agent that found the way out and lost it: is it a success of the method?
