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
# - write the large-margin loss;
# - train the paper's whole method in your own code, and say what demonstrations bring.
#
# **Time** 68 minutes, 20 of them voluntary (*Further*). **It builds on** lesson [[demonstrations]],
# and on your parts of lessons [[discrete_sac]], [[update_and_loop]] and [[soft_constraint]].
# <!-- claim: work('paper_q_filter', 'margin_loss') + 2 == 20 -->

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
from bootcourse.course.lessons.learning_from_demonstrations import figures, measures

progress("learning_from_demonstrations")

# %% [markdown]
# ## Look first
#
# What is the rest of a drive worth at γ = {{ SETTINGS.gamma }}, from each second on?

# %%
by_rule = bc.record(bc.rule_policy(bc.DEFAULT), range(20), label="rule")
stays = bc.record(bc.idle_policy, range(20), label="idle")
bc.show(figures.worth(by_rule[10], stays[10]))

# %% [markdown]
# At its start the rule's drive is worth less than staying behind. How can it help a learner?
# <!-- claim: discounted(by_rule(), SETTINGS.gamma) < discounted(idle(), SETTINGS.gamma) -->

# %% [markdown] tags=["instructor"] minutes=3
# Ask what the two lines of the figure would look like with γ = 1, and why a learner cannot wait for
# their crossing.

# %% [markdown]
# ## Round 1: how do demonstrations get into a batch?
#
# For each update a learner draws a batch of {{ SETTINGS.batch }} rows from its replay buffer. Now a
# share β ("beta") comes from a table of the rule's drives. It falls in a straight line, to 0 at
# episode {{ SETTINGS.beta_episodes | , }}.
# <!-- claim: demonstration_share(SETTINGS.beta_episodes, SETTINGS.beta_start,
#   SETTINGS.beta_episodes) == 0 -->

# %%
rows = []
for episode in (0, 250, 500, 1000):
    beta = bc.bootstrap.demonstration_share(episode, 0.6, 1000)
    rows.append([f"{episode:,}", f"{beta:.2f}", round(64 * beta)])
table(["episode", "β", "of 64 rows are the rule's"], rows)

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
# **Explain.** Through the critics' Q: only their loss reads a row's action (`q_taken`) and reward
# (`target`). An action that they value more becomes more probable.
#
# The soft constraint adds a second way: in each row, demonstrated or not, its KL (`constraint`)
# pulls the policy towards the rule's action.

# %% [markdown] tags=["instructor"] minutes=3
# Draw a batch as a row of 64 boxes. Shade the rule's after 0, 500 and 1,000 episodes.

# %% [markdown]
# ## Round 2: how large must the bonus be?
#
# If the critics give the rule's actions a low value, the actor learns to avoid them. So the paper
# adds a **bonus** c to the reward of each demonstrated second.
#
# > **Predict.** The paper takes c = {{ SETTINGS.bonus | g }}. If each second from now on is
# > demonstrated, by how much does that raise the discounted return?

# %%
predict(
    "learning_from_demonstrations.2",
    "By how much does c = 2 in each second raise the discounted return?",
    ["2", "4", "10", "300"],
)

# %%
predicted("learning_from_demonstrations.2")
table(measures.PAID, measures.paid(by_rule[10], stays[10], bonuses=(0, 1, 2)))

# %% [markdown]
# **See.** Paid in each second, a bonus adds c + γ c + γ² c + … = c / (1 − γ). With c = {{
# SETTINGS.bonus | g }} that is {{ SETTINGS.bonus / (1 - SETTINGS.gamma) | .0f }}, as much as an
# accident costs.
# <!-- claim: round(SETTINGS.bonus / (1 - SETTINGS.gamma)) == 10 -->
# <!-- claim: math.isclose(SETTINGS.bonus / (1 - SETTINGS.gamma), -DEFAULT.reward.accident) -->
#
# > **Predict.** From which c on is the rule's drive worth more than staying, in each second, on each
# > of 20 roads?

# %%
predict(
    "learning_from_demonstrations.3",
    "From about which bonus c on is the rule's drive worth more?",
    ["0.005", "0.05", "0.5", "5"],
)

# %%
predicted("learning_from_demonstrations.3")
print(f"from c = {measures.smallest_bonus(by_rule, stays):.3f} on")

# %% [markdown]
# **Drag** c, on one road. In the lower picture, in which seconds does the rule's drive need a bonus?

# %%
bc.panels.bonus_panel()

# %% [markdown]
# **Explain.** It needs a small one, at its start alone. The paper's c is more than thirty times as
# large. But the sum takes each second as paid, and the learner's own rows are not.
# <!-- claim: SETTINGS.bonus > 30 * 0.06 -->
#
# With $a_E$ for the demonstrated action:
#
# $$ r'(s, a_E) = r(s, a_E) + c $$
#
# **Exercise (20 min, ●●●).** Write the mixed batch. Draw `round(beta * size)` rows from the table of
# demonstrations, each with the same chance, and the others from your own replay buffer,
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
# ## Round 3: does the demonstrated action come first?
#
# The policy prefers the action with the largest Q. A demonstration shows *one* action in its state.
# The critics' Q of the other eight is a guess from other rows. Its error is an **extrapolation
# error**.
#
# Train four learners with demonstrations, without the KL, and with β fixed: two with c = {{
# SETTINGS.bonus | g }}, two with c = 0. Then ask their critics about the first 20 seconds of the
# rule's drives.
# <!-- claim: settings_for('demos').xi_multiplier == 0 and settings_for('demos').xi_fixed is None
#   -->
#
# > **Predict.** If the drive goes on as the rule's, another action misses one bonus. But the critics
# > guess its value. By how much does c = {{ SETTINGS.bonus | g }} raise the lead of the demonstrated
# > action over the best other one?

# %%
predict(
    "learning_from_demonstrations.4",
    "By how much does c = 2 raise the lead over the best other action?",
    ["by about five bonuses, 10", "by about one bonus, 2", "by less than 1, or it falls"],
)

# %%
predicted("learning_from_demonstrations.4")
learners = []
for c in (2, 0):
    learners += bc.with_seeds(bc.settings_for("demos", beta_episodes=None, bonus=c), 2)
training = bc.Training(learners, episodes=20_000, learner="compiled")  # the same, faster
result = training.run(updates=4000)
critics = measures.opinions(result.agents, by_rule, seconds=20)
bc.show(figures.critics(critics))

# %% [markdown]
# **See.** *The bonus raises the best other action's Q, too.* In our two pairs of learners the lead
# over the others' *mean* grew by about one bonus. Over the best of them it grew by less than 1, or
# fell. Perhaps because that is the largest of eight guesses, which no demonstration corrects.
#
# *In place of the bonus* the paper also tries a loss, so that the Q of the demonstrated action leads
# every other by a **margin** of {{ settings_for('margin').margin | .0f }}:
#
# $$ J_E(Q) = \max_a \big[ Q(s,a) + l(a_E, a) \big] - Q(s,a_E), \qquad
# l = 0 \text{ for } a_E, \text{ else } 1 $$

# %%
q = [0.2, 1.1, 0.3, 0.6, 0.9, 0.4, 0.5, 1.4, 0.1]
bc.show(figures.margin_bars(q, bc.ACTION_NAMES.index("brake straight")))

# %% [markdown]
# The loss is the distance from the coloured bar to the upper line. It pushes that bar up and that of
# the *best other action* down, and is 0 once the demonstrated action leads by the whole margin.
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

# %% [markdown]
# Where another action has a larger Q, the paper's **Q-filter** switches this loss off (*Further*).

# %% [markdown] tags=["instructor"] minutes=3
# Three bars for Q on the board, the margin on top of two of them. Let the class say for each of the
# three actions as the expert's which bar is pushed, and in which direction.

# %% [markdown]
# ## Round 4: what do demonstrations bring?
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
# >
# > *Variant:* instead of 3, add the margin loss of the demonstrated rows, with the paper's filter,
# > to the critics' loss.
#
# Lines 2 and 3 are your `mixed_batch`, line 4 is `constrained_target`, line 5 `constrained_loss`.
# Load all your parts:

# %%
own_code.load()

# %%
own_code.compare()

# %% [markdown]
# If a part differs, mend it and run both cells again. Train four agents with the KL: two with the
# bonus, one with the margin, one without demonstrations.
#
# > **Predict.** Is the way out found sooner with demonstrations? After a whole training, do clearly
# > more agents escape?

# %%
choices = ["sooner, and clearly more escape", "sooner, but not clearly more escape"]
choices += ["no sooner, but clearly more escape", "neither"]
predict("learning_from_demonstrations.5", "What do demonstrations bring?", choices)

# %%
predicted("learning_from_demonstrations.5")
four = bc.with_seeds(bc.settings_for("bootstrapped"), 2)
four += [bc.settings_for("margin_soft"), bc.settings_for("soft")]
yours = own_code.training(four, episodes=20_000).run(updates=2700).agents
table(measures.DRIVEN, measures.driven(yours))

# %% [markdown]
# **See.** Our agents with demonstrations have found the way out, and the one without has not.
# We stopped between the medians of the next table. The study has ten of each kind, trained for {{
# of('soft').sizes[1] | , }} episodes, and ten others with other seeds, another implementation of the
# learner and twice the episodes:
# <!-- claim: others('soft').sizes[1] == 2 * of('soft').sizes[1] -->

# %%
changed, others = (shipped.shipped_experiment(name) for name in ("ablations", "stress"))
kinds = measures.kinds(bc.shipped_results(), changed, others)
below = "Found: more than half of 50 episodes succeed. Return: the mean of all. –: no such others."
table(measures.FOUND, measures.found_and_escaped(kinds), below)

# %% [markdown]
# **See.** *With demonstrations these agents needed about {{ round(np.median(found('none')) -
# np.median(found('c = 2')), -1) | .0f }} episodes fewer of their own*; the rule's {{
# SETTINGS.demonstration_episodes }} are not counted. The bonus saved some {{
# round(np.median(found('c = 0')) - np.median(found('c = 2')), -1) | .0f }}, the margin about as
# many.
# <!-- claim: round(np.median(found('c = 0')) - np.median(found('c = 2')), -1) ==
#   round(np.median(found('c = 0')) - np.median(found('margin')), -1) -->
#
# *That more escape in the end, or earn more, is not shown*: {{ in_all('none') }} escape with c = 2,
# with c = 0 and without demonstrations; the margin's {{ in_all('margin') }} against {{
# escaped('soft') }} of the study's ten without can be chance. Without the KL at most half do here.
# <!-- claim: [alone(name, 0) for name in ('c = 2', 'c = 0', 'margin')] == ['0 of 10'] * 3 and
#   alone('c = 2', 1) == '5 of 10' -->
# <!-- claim: in_all('c = 2') == in_all('c = 0') == in_all('none') == '16 of 20' -->
# <!-- claim: all(stats.mannwhitneyu(earned('none'), earned(name)).pvalue > 0.1 for name in
#   ('c = 2', 'c = 0', 'margin')) -->
# <!-- claim: stats.fisher_exact([[10, 0], [escaped('soft'), 10 - escaped('soft')]]).pvalue > 0.1
#   -->
# <!-- claim: np.median(found('none')) - np.median(found('c = 0')) > 3 *
#   (np.median(found('c = 0')) - np.median(found('c = 2'))) > 0 -->
# <!-- claim: max(found('c = 2').max(), found('margin').max()) < found('none').min() and
#   (found('c = 0') < found('none').min()).sum() >= 19 -->

# %%
bc.show(figures.returns(kinds))

# %% [markdown]
# **See.** *From episode 300 to 600 the bonus holds the return back*: each of the ten agents with
# c = 0 earns more than each with c = 2. Near episode 1,000, as β runs out, the curve of c = 2 alone
# falls; the cause is open.
# <!-- claim: training('c = 0', 'return', 300, 600).min() > training('c = 2', 'return', 300,
#   600).max() -->
# <!-- claim: abs(training('c = 2', 'return', 300, 550).mean() -
#   of('rule').scores('returns').mean()) < 5 -->
# <!-- claim: training('c = 2', 'return', 950, 1000).mean() < training('c = 2', 'return', 800,
#   850).mean() - 30 -->
# <!-- claim: all(training(name, 'return', 950, 1000).mean() > training(name, 'return', 800,
#   850).mean() for name in ('c = 0', 'none')) -->
#
# **Slide.** Train. When the success is near 100 %, set c to 0. Does the return rise sooner than the
# figure's with c = 2 (80 near episode {{ round(passes(80), -1) | d }})? What does the success do?

# %%
bc.panels.train_panel("bootstrapped", seeds=2, episodes=600)

# %% [markdown]
# One of your agents, and one of the study's that escapes:

# %%
here = bc.record(yours[0].as_policy(), [10], label="bootstrapped, here")
longer = bc.shipped_agents("bootstrapped")[1].as_policy()
study = bc.record(longer, [10], label="bootstrapped, study")
drives = [shipped.beginning(drive, 60) for drive in (*here, *study)]
bc.recording(drives, height=480, details=True)

# %% [markdown]
# **See.** *Most of the study's ten earn far more after their whole training*: seven escape and earn
# {{ escapers_earn().min() | .0f }} or more. The other three lost the way out: in episodes 500 to 600
# all ten succeed nearly always.
# <!-- claim: len(of('bootstrapped')) == 10 and len(escapers_earn()) == 7 -->
# <!-- claim: in_training('bootstrapped', 500, 600).min() > 0.98 -->
# <!-- claim: of('bootstrapped').scores('success')[1] >= ESCAPES -->

# %% [markdown] tags=["instructor"] minutes=4
# Put the box on the wall. While the agents train, let somebody name for each of its six lines what
# happens if it is left out; some of these are experiments of the study (lesson [[found_and_kept]]).

# %%
raised = measures.raised(critics)
size = "by less than 1, or it falls" if max(raised) < 1 else "by about one bonus, 2"
compare_predictions(
    "learning_from_demonstrations",
    {1: "through the critics' Q", 2: "10", 3: "0.05"}
    | {4: f"{size}: {raised[0]:.1f} and {raised[1]:.1f}", 5: "sooner, but not clearly more escape"},
)

# %% [markdown]
# ## What you now know
#
# 1. A share β of each batch is the rule's, and falls to 0. The rule's actions reach the policy
#    through the critics' Q, and through the KL.
# 2. On our 20 roads a small bonus makes the rule's drive worth more than staying. The paper's is
#    far larger.
# 3. In our critics the bonus raises the best other action's Q, too. A margin pushes that Q down, the
#    paper's only where the demonstrated action comes first already.
# 4. With the KL, agents with demonstrations find the way out after fewer episodes of their own. Once
#    β has run out, it is not shown that more of them escape.
# 5. In the study's ten the bonus held the return back from episode 300 to 600. Later most earned
#    far more, and some lost the way out.

# %% [markdown]
# **Three questions to think about**
# - Which c would you choose for γ = 0.95, and by which argument?
# - Where would you pay the bonus, so that it does not hold an agent back?
# - What would you plot to see when a critic has unlearned the bonus?
#
# **Read on**: [the next lesson](how_many_seeds.ipynb) asks what counts of ten agents are worth.
# Hester et al. (arXiv 1704.03732), for margins; Nair et al. (arXiv 1709.10089), for the Q-filter;
# Reddy et al. (arXiv 1905.11108), for the bonus; Ball et al. (arXiv 2302.02948), for demonstrations
# alone.

# %% [markdown] tags=["instructor"] minutes=2
# *Answers to the three questions.* **c for γ = 0.95:** the rule's drive has to be worth more than
# staying behind, at each second; the panel of Round 2 shows the smallest such c when you drag γ. A
# little more than that is enough. And c / (1 − γ) should stay below what an accident costs, or a
# demonstrated drive that crashes may be worth more than one without bonus and accident: with γ =
# 0.95, c below 0.5. **Where to pay:** on the free road the rule keeps its moderate speed and is
# paid c for it, so the critic values the rule's speed above a higher one by up to c / (1 − γ), more
# than a higher speed can earn there. A bonus for the way out alone (until trap 1 is passed) would
# not have this effect. **When it is unlearned:** the mean Q of the demonstrated actions on the way
# out, as in Round 3, against the updates, with a line where β reaches 0; beside it the discounted
# return that these drives really earn. Where the two meet, it is unlearned.
# <!-- claim: 0.5 / (1 - 0.95) <= -DEFAULT.reward.accident + 1e-9 -->

# %% [markdown] tags=["instructor"]
# **On the board.** One batch of 64 as a row of boxes, the demonstrated ones shaded, and how many are
# shaded after 0, 500 and 1,000 episodes.
#
# **To discuss.** The bonus pays for *who* acted, not for what happened. Where else do rewards do
# that?

# %% [markdown]
# ## Further: where should the margin act?
#
# Where the rule may be wrong, a Q-filter switches the margin loss off. The usual one is on where
# $Q(s,a_E)$ exceeds the mean Q of the policy's own actions, the paper's where
#
# $$ Q(s,a_E) \ge \max_a Q(s,a). $$
#
# **Exercise (3 min, ●○○).** Write the filter as the paper prints it.


# %%
def paper_q_filter(q, expert_action):
    """1 where the loss counts, else 0, (batch,). q: (batch, actions); expert_action: (batch,)."""
    # solution
    q_expert = q.gather(-1, expert_action.unsqueeze(-1)).squeeze(-1)
    return (q_expert >= q.amax(-1)).to(q.dtype)
    # end solution


check.paper_q_filter(paper_q_filter)

# %% [markdown]
# An action's Q is at most the largest Q, so ≥ means =. *The paper's filter is on only where the
# demonstrated action comes first already.* There the loss widens a lead of less than 1.
# <!-- claim: bootstrap.paper_q_filter(torch.tensor([[1, 2, 3]] * 3), torch.arange(3)).tolist()
#   == [0, 0, 1] -->
# <!-- claim: settings_for('margin').paper_q_filter and settings_for('margin_soft').paper_q_filter
#   -->
#
# **Exercise (15 min, ●●●).** Write what the margin adds to the critics' loss: for each critic, the
# margin loss of the demonstrated rows, switched by the paper's filter of the *same* critic. Take its
# mean over the whole batch, other rows count as 0, and add the two means.


# %%
def margin_loss(q_pair, action, is_demonstration):
    """A scalar tensor. q_pair: (2, batch, actions); action, is_demonstration (1 or 0): (batch,)."""
    # solution: the exercise's own


check.margin_loss(margin_loss)

# %% [markdown]
# Run Round 4 again: its agent with the margin trains with your loss.

# %% [markdown] tags=["instructor"] minutes=2
# Mean and sum in the last exercise are our choice: the paper does not print the loss's weight.
#
# `settings_for("margin")` and `settings_for("margin", paper_q_filter=False)` train the two filters.
# Let the class guess the success of both, then let two groups find out. No agent of the study uses
# the usual one.
