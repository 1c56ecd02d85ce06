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
# # Learning from demonstrations
#
# **What you will be able to do**
# - mix the rule's drives into a learner's batches, and pay a bonus for them;
# - train the paper's whole method in your own code, and say what demonstrations bring;
# - write the large-margin loss, and see what it does.
#
# **Time** 48 minutes. **It builds on** lesson [[demonstrations]], and on your parts of lessons
# [[discrete_sac]], [[update_and_loop]] and [[soft_constraint]].

# %%
import inspect

import bootcourse as bc
import torch
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
from bootcourse.course.lessons.learning_from_demonstrations import explorable, figures, measures

progress("learning_from_demonstrations")

# %% [markdown]
# ## Look first
#
# A learner is to learn from the rule's drives, the **demonstrations**. The paper pays it for them:
# a **bonus** c on top of the reward of each demonstrated second.
#
# **Drag** c to 0. In which seconds is the rest of the rule's drive worth less than staying behind?

# %%
bc.panels.bonus_panel()

# %% [markdown]
# *At its start alone, and a small bonus is enough to change that.* The paper's c = {{
# SETTINGS.bonus | g }} is more than thirty times the one in the title. If each second were paid, it would add
# c + γ c + γ² c + … = c / (1 − γ) = {{ SETTINGS.bonus / (1 - SETTINGS.gamma) | .0f }} at γ = {{
# SETTINGS.gamma }}, as much as an accident costs. The learner's own seconds are not paid.
# What does so large a bonus do to it?
# <!-- claim: discounted(by_rule(), SETTINGS.gamma) < discounted(idle(), SETTINGS.gamma) -->
# <!-- claim: SETTINGS.bonus > 30 * 0.06 -->
# <!-- claim: math.isclose(SETTINGS.bonus / (1 - SETTINGS.gamma), -DEFAULT.reward.accident) -->

# %% [markdown] tags=["instructor"] minutes=3
# Let them drag γ towards 1 as well: the rule's drive needs no bonus then. Ask why the learner does
# not take such a γ (lesson [[the_trap]]).

# %% [markdown]
# ## Round 1: how does the bonus reach the policy?
#
# For each update a learner draws a batch of {{ SETTINGS.batch }} rows from its replay buffer. Now a
# share β ("beta") of them comes from a table of the rule's drives.

# %%
bc.show(figures.batches(bc.settings_for("bootstrapped"), (0, 500, 1000)))

# %% [markdown]
# > **Predict.** Leave the soft constraint out for now. The actor's loss has no term for the action
# > of a row. How can the rule's *actions* in these rows change the policy?

# %%
choices = ["not at all: a term is missing", "through the critics' Q", "through the temperature α"]
predict("learning_from_demonstrations.1", "How can the rule's actions change the policy?", choices)

# %%
predicted("learning_from_demonstrations.1")
for loss in (bc.sac.critic_loss, bc.sac.actor_loss, bc.sac.temperature_loss):
    print(f"{loss.__name__} reads {', '.join(inspect.signature(loss).parameters)}")

# %% [markdown]
# **Explain.** Through the critics' Q: only their loss reads a row's action (`q_taken`) and its
# reward (`target`), in which the bonus is. An action that they value more becomes more probable.
#
# The soft constraint adds a second way: in each row, demonstrated or not, its KL (`constraint`)
# pulls the policy towards the rule's action.
#
# With $a_E$ for the demonstrated action, the reward with the bonus is
#
# $$ r'(s, a_E) = r(s, a_E) + c $$
#
# **Exercise (20 min, ●●●).** Write the mixed batch. Draw `round(beta * size)` rows from the table
# of demonstrations, each with the same chance, and the others from your own replay buffer,
# `own.sample(n, rng)`. Raise each demonstration's reward by the bonus, but do not change the table.
# Return the rows, and a mark for each: 1 for a demonstration, else 0.

# %%
REWARD = -4  # the column of a row that holds the reward


def mixed_batch(own, demonstrations, size, beta, bonus, rng):
    """(rows (size, n), marks (size,)), tensors. rng: a NumPy generator.

    demonstrations: a tensor (m, n), a row is (s, s', a, r, terminated, μ(s), μ(s')).
    """
    # solution: the exercise's own


check.mixed_batch(mixed_batch)

# %% [markdown] tags=["instructor"] minutes=5
# SQIL (Reddy et al.) pays 1 for demonstrations, 0 for everything else, and does not use the road's
# reward. Ask how much of its argument applies here: with c = 2 and rewards below 1, most of it. A
# good question is what a bonus on *all* rows would do: it pays for each second without an accident.
# <!-- claim: SETTINGS.bonus == 2 and max(map(second_pays, np.arange(0, 25, 0.1))) < 1 -->

# %% [markdown]
# ## Round 2: what do demonstrations bring?
#
# > **SAC with a rule's help.** Take the algorithm of lesson [[update_and_loop]] and change six
# > lines:
# >
# > 1. *Before the first decision:* the rule drives {{ SETTINGS.demonstration_episodes }} episodes.
# >    Their rows are the demonstrations.
# > 2. *Batch:* a share β of the rows, falling to 0, are demonstrations.
# > 3. *Bonus:* in demonstrated rows r becomes r + c.
# > 4. *Target:* subtract ξ D_KL(π ‖ π̃), in **s'**, from V(s').
# > 5. *Actor:* add the mean of ξ D_KL(π ‖ π̃), in **s**, to the loss.
# > 6. *Fading:* at each update ξ is {{ SETTINGS.xi_multiplier | g }} α.
#
# Lines 2 and 3 are your `mixed_batch`, line 4 is `constrained_target`, line 5 `constrained_loss`:

# %%
own_code.load()

# %%
own_code.compare()

# %% [markdown]
# If a part differs, mend it and run both cells again. Then train two agents with the soft
# constraint: one with demonstrations, one without.
#
# > **Predict.** Counted in its own episodes, does an agent find the way out sooner with
# > demonstrations? After a whole training, do clearly more agents escape?

# %%
choices = ["sooner, and clearly more escape", "sooner, but not clearly more escape"]
choices += ["no sooner, but clearly more escape", "neither"]
predict("learning_from_demonstrations.2", "What do demonstrations bring?", choices)

# %%
predicted("learning_from_demonstrations.2")
both = [bc.settings_for("bootstrapped"), bc.settings_for("soft")]
yours = own_code.training(both, episodes=20_000).run(updates=2700).agents

# %%
drive = bc.record(yours[0].as_policy(), [10], label="bootstrapped")[0]
bc.recording([shipped.beginning(drive, 60)], height=480)

# %% [markdown]
# **See.** In our run the agent with demonstrations has found the way out; you see it drive. The
# other has not found it yet.
#
# And after a whole training? The study has ten agents of each kind. Ten others of each have other
# seeds, another implementation of the learner and twice the episodes:
# <!-- claim: others('soft').sizes[1] == 2 * of('soft').sizes[1] -->

# %%
changed, others = (shipped.shipped_experiment(name) for name in ("ablations", "stress"))
kinds = measures.kinds(bc.shipped_results(), changed, others)
below = "Found: more than half of 50 episodes in a row succeed."
table(measures.FOUND, measures.found_and_escaped(kinds), below)

# %% [markdown]
# **See.** *With demonstrations these agents found the way out after about {{
# round(np.median(found('none')) - np.median(found('c = 2')), -1) | .0f }} fewer episodes of their
# own*; with the rule's {{ SETTINGS.demonstration_episodes }} counted, about {{
# round(np.median(found('c = 2')) + SETTINGS.demonstration_episodes - np.median(found('none')), -1)
# | .0f }} later. Without the bonus most of this lead remains.
# <!-- claim: np.median(found('none')) - np.median(found('c = 0')) > 3 *
#   (np.median(found('c = 0')) - np.median(found('c = 2'))) > 0 -->
# <!-- claim: found('c = 2').max() < found('none').min() and
#   (found('c = 0') < found('none').min()).sum() >= 19 -->
#
# *That more escape in the end is not shown.* Nor do demonstrations replace the soft constraint
# here: without it {{ alone('c = 2') }} escape with c = 2. (In lesson [[found_and_kept]], with other
# settings, they do.)
# <!-- claim: in_all('c = 2') == in_all('c = 0') == in_all('none') == '16 of 20' -->
# <!-- claim: all(stats.mannwhitneyu(earned('none'), earned(name)).pvalue > 0.1 for name in
#   ('c = 2', 'c = 0', 'margin')) -->
# <!-- claim: escapers(clocks()['2', 'π̃'], 'demos') == 10 -->
# <!-- claim: alone('c = 2') == '5 of 20' and stats.fisher_exact([[16, 4], [5, 15]]).pvalue < 0.01
#   -->

# %% [markdown] tags=["instructor"] minutes=4
# Put the box on the wall. While the agents train, ask of each of its six lines: what happens without
# it? Some of these are experiments of the study (lesson [[found_and_kept]]).

# %% [markdown]
# ## Round 3: what does the bonus cost?
#
# > **Predict.** Near episode 400 the way out is found, and more than a third of each batch is still
# > the rule's. Agents with demonstrations train with c = {{ SETTINGS.bonus | g }} or with c = 0.
# > Which earn more on the road then, the bonus not counted?
# <!-- claim: demonstration_share(400, SETTINGS.beta_start, SETTINGS.beta_episodes) > 1 / 3 -->
# <!-- claim: max(found('c = 2').max(), found('c = 0').max()) < 400 -->

# %%
choices = ["those with c = 2", "those with c = 0", "about the same"]
predict("learning_from_demonstrations.3", "Which earn more near episode 400?", choices)

# %%
predicted("learning_from_demonstrations.3")
bc.show(figures.returns(kinds))

# %% [markdown]
# **See.** *From episode 300 to 600 the bonus holds the return back*: over these episodes each of the
# ten agents with c = 0 earns more than each with c = 2. Perhaps because each second of the rule's
# moderate speed is paid, too.
# <!-- claim: training('c = 0', 'return', 300, 600).min() > training('c = 2', 'return', 300,
#   600).max() -->
# <!-- claim: abs(training('c = 2', 'return', 300, 550).mean() -
#   of('rule').scores('returns').mean()) < 5 -->
#
# *As β reaches 0, the mean with c = 2 falls*, from {{ training('c = 2', 'return', 800, 900).mean() |
# .0f }} (episodes 800 to 900) to {{ training('c = 2', 'return', 1000, 1100).mean() | .0f }} (1,000 to
# 1,100); that with c = 0 does not. Lesson [[found_and_kept]] is about this fall.
# <!-- claim: training('c = 0', 'return', 1000, 1100).mean() >
#   training('c = 0', 'return', 800, 900).mean() -->
# <!-- claim: training('c = 2', 'return', 1000, 1100).mean() < 0.7 * training('c = 2', 'return', 800,
#   900).mean() -->
#
# At the end {{ of_the_study('c = 2') }} escape with c = 2 and {{ of_the_study('c = 0') }} with c = 0;
# of the ten others {{ of_the_others('c = 2') }} and {{ of_the_others('c = 0') }}. Of all twenty of
# each kind, neither is shown to earn more then. What are counts of ten worth (lesson
# [[how_many_seeds]])?
# <!-- claim: stats.mannwhitneyu(earned('c = 2'), earned('c = 0')).pvalue > 0.1 -->
#
# **Slide.** Train. When the success is near 100 %, set c to 0. Does the return pass 80 before the
# panel ends? The figure's with c = 2 does near episode {{ round(passes(80), -1) | d }}.

# %%
bc.panels.train_panel("bootstrapped", seeds=2, episodes=600)

# %% [markdown] tags=["instructor"] minutes=4
# The bonus buys some {{ round(np.median(found('c = 0')) - np.median(found('c = 2')), -1) | .0f }}
# episodes at the start, and costs return for the hundreds of episodes after it. Ask for a schedule
# of c that has both, and let a group try it in the panel.

# %% [markdown]
# ## Round 4: the other way to use demonstrations
#
# Without the soft constraint the policy prefers the action that **comes first**: that with the
# largest Q. A demonstration shows *one* action in its state. The Q of the other eight comes from
# other rows. Where none is like it, it is a guess, and its error an **extrapolation error**.
#
# Look at a critic of the agent that you trained with demonstrations:

# %%
by_rule = bc.record(bc.rule_policy(bc.DEFAULT), [10], label="rule")[0]
explorable.nine_values(yours[0], by_rule, seconds=20)

# %% [markdown]
# **Drag** the second. In which does another action come first? A wrong guess, or an action that is
# worth more? Q alone does not say.
#
# *In place of the bonus* the paper also tries a loss that asks the demonstrated action to lead every
# other by a **margin** of {{ settings_for('margin').margin | .0f }}. Drag the margin: the loss is
# the distance between the dashed lines.
#
# $$ J_E(Q) = \max_a \big[ Q(s,a) + l(a_E, a) \big] - Q(s,a_E), \qquad
# l = 0 \text{ for } a_E, \text{ else } 1 $$
#
# It pushes the coloured bar up and the *best other action's* bar down, until the demonstrated
# action leads by the whole margin.
# <!-- claim: bool(bootstrap.large_margin_loss(torch.tensor([[3.0, 2.0, 0.0]]), torch.tensor([0]))
#   == 0) -->
#
# **Exercise (8 min, ●●○).** Write the loss of each state.


# %%
def large_margin_loss(q, expert_action):
    """J_E, margin 1. q: (batch, actions); expert_action: (batch,) int64. Returns (batch,), ≥ 0."""
    # solution
    is_expert = torch.arange(q.shape[-1]) == expert_action.unsqueeze(-1)
    q_expert = q.gather(-1, expert_action.unsqueeze(-1)).squeeze(-1)
    return (q + (~is_expert)).amax(-1) - q_expert
    # end solution


check.large_margin_loss(large_margin_loss)

# %% [markdown] tags=["instructor"] minutes=2
# Three bars for Q on the board, the margin on top of two of them. Let the class say for each of the
# three actions as the expert's which bar is pushed, and in which direction.

# %% [markdown]
# The paper's **Q-filter** counts the loss only where the demonstrated action comes first already.
# With the margin, this filter and the soft constraint {{ in_all('margin') }} agents of the study
# escape. With neither margin nor bonus {{ of_the_study('c = 0') }} do, with the bonus instead {{
# escaped('bootstrapped') }}, with the soft constraint alone {{ escaped('soft') }}. So it is not
# shown that the margin helps.
# <!-- claim: settings_for('margin_soft').bonus == 0 and settings_for('margin_soft').paper_q_filter
#   and settings_for('margin_soft').xi_multiplier == settings_for('soft').xi_multiplier > 0 -->
# <!-- claim: in_all('margin') == '10 of 10' and all(stats.fisher_exact([[10, 0], [escaped(m), 10 -
#   escaped(m)]]).pvalue > 0.1 for m in ('bootstrapped', 'soft')) -->

# %%
compare_predictions(
    "learning_from_demonstrations",
    {1: "through the critics' Q", 2: "sooner, but not clearly more escape", 3: "those with c = 0"},
)

# %% [markdown]
# ## What you now know
#
# 1. A share β of each batch is the rule's, and falls to 0. The rule's actions reach the policy
#    through the critics' Q, and through the soft constraint.
# 2. With the soft constraint, these agents with demonstrations found the way out after fewer
#    episodes of their own. It is not shown that more of them escape in the end.
# 3. On the road above a far smaller bonus than the paper's makes the rule's drive worth more than
#    staying. In the study's ten the paper's held the return back from episode 300 to 600, and the
#    mean return fell as β reached 0.
# 4. The demonstrated action need not come first in a critic. The margin loss, unfiltered, pushes
#    its Q up and the largest other Q down.

# %% [markdown]
# **Three questions to think about**
# - Which c would you choose for γ = 0.95, and by which argument?
# - Where would you pay the bonus, so that it does not hold an agent back?
# - The paper's filter asks for $Q(s,a_E) \ge \max_a Q(s,a)$. What can the loss still teach there?
#   The usual filter (`paper_q_filter=False`) asks that $Q(s,a_E)$ exceed the mean Q of the policy's
#   actions. What does that change?
#
# **Read on**: [the next lesson](how_many_seeds.ipynb) asks what counts of ten agents are worth.
# Hester et al. (arXiv 1704.03732), for margins; Nair et al. (arXiv 1709.10089), for the usual
# Q-filter; Reddy et al. (arXiv 1905.11108), for the bonus; Ball et al. (arXiv 2302.02948), for
# demonstrations alone.

# %% [markdown] tags=["instructor"] minutes=2
# *Answers to the three questions.* **c for γ = 0.95:** the rule's drive has to be worth more than
# staying behind, at each second; the first panel shows the smallest such c when you drag γ. A
# little more than that is enough. And c / (1 − γ) should stay below what an accident costs, or a
# demonstrated drive that crashes may be worth more than one without bonus and accident: with γ =
# 0.95, c below 0.5. **Where to pay:** on the free road the rule keeps its moderate speed and is
# paid c for it, so the critic values the rule's speed above a higher one by up to c / (1 − γ), more
# than a higher speed can earn there. A bonus for the way out alone (until trap 1 is passed) would
# not have this effect. **The filter:** an action's Q is at most the largest Q, so ≥ means =. The
# filter is on only where the demonstrated action comes first already; there the loss widens a lead
# of less than 1. The usual filter (Nair et
# al.) is on also where another action comes first and the demonstrated one is above the mean. No
# agent of the study uses it.
# <!-- claim: 0.5 / (1 - 0.95) <= -DEFAULT.reward.accident + 1e-9 -->
# <!-- claim: bootstrap.paper_q_filter(torch.tensor([[1, 2, 3]] * 3), torch.arange(3)).tolist()
#   == [0, 0, 1] -->
# <!-- claim: settings_for('margin').paper_q_filter and settings_for('margin_soft').paper_q_filter
#   -->

# %% [markdown] tags=["instructor"]
# **On the board.** One batch of 64 as a row of boxes, the demonstrated ones shaded, and how many
# are shaded after 0, 500 and 1,000 episodes.
#
# **To discuss.** The bonus pays for *who* acted, not for what happened. Where else do rewards do
# that?
