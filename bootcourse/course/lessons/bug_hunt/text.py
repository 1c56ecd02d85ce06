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
# # The bug hunt
#
# **What you will be able to do**
# - find a silent bug in a learner from curves, probes and drives, without reading its code;
# - write a probe: ask a part of a learner something whose right answer you know;
# - test a target and a value in milliseconds, without training.
#
# **Time** 60 minutes; running it takes under one minute. **It builds on** the losses of lesson
# [[discrete_sac]], the update of lesson [[update_and_loop]], the soft constraint
# ([[soft_constraint]]) and learning from demonstrations ([[learning_from_demonstrations]]).

# %%
import bootcourse as bc
import numpy as np
import torch
from bootcourse.course import (
    charts,
    check,
    compare_predictions,
    predict,
    predicted,
    progress,
    shipped,
    table,
)
from bootcourse.course.lessons.bug_hunt import bugs

hunt = bugs.Hunt()
print(f"{len(hunt.names)} agents, 2 seeds each, {bugs.UPDATES:,} updates of each")

progress("bug_hunt")

# %% [markdown]
# ## Look first
#
# Seven agents were trained with the paper's method. One is healthy. Each of the others, A to F, has
# one **silent bug**: a line that is wrong, raises nothing and prints nothing. So early in its
# training the healthy agent earns about what the rule does.
# <!-- claim: abs(hunt().at_the_end('return')['healthy'].mean() /
#   of('rule').scores('returns')[0] - 1) < 0.1 -->
# <!-- claim: len(bugs.LEARNERS) == 7 -->

# %% tags=["nbval-ignore-output"]
ROAD = 10
named = {"healthy": hunt.agent("healthy"), "agent E, with a bug": hunt.agent("E")}
drives = [bc.record(agent.as_policy(), [ROAD], label=name)[0] for name, agent in named.items()]
bc.recording([shipped.beginning(drive, 50) for drive in drives], height=360)

# %% tags=["hide-input"]
rows = [[d.label, bc.words.outcome(d), f"{d.rewards.sum():.0f}"] for d in drives]
table(["in 150 s", "in the end", "return"], rows)

# %% [markdown]
# Both leave the trap, and after these {{ bugs.UPDATES | , }} updates the agent with a bug earns
# more. A bug need not look like one.
# <!-- claim: (lambda h: record(h.agent('E').as_policy(), [ROAD])[0].rewards.sum() >
#   record(h.agent('healthy').as_policy(), [ROAD])[0].rewards.sum())(hunt()) -->
#
# > **Predict.** With how many of these six bugs do the agents still *succeed* in training, that is,
# > end ahead of trap 1 in more than 80 % of the last 30 episodes, in the mean of two seeds? Say
# > which, before you count.
# >
# > - `flipped_kl`: the KL divergence is taken the other way round;
# > - `no_end`: (1 − terminated) is missing in the critic's target;
# > - `sampled`: one drawn action stands for the expectation over all nine;
# > - `no_stop`: the stop-gradient on Q is missing in the actor's loss;
# > - `bonus_for_all`: the bonus c is paid for the agent's own driving as well;
# > - `shifted_labels`: the rule was asked after the step, so each label is one second late.

# %%
choices = ["none", "one or two", "three or four", "five", "all six"]
predict("bug_hunt.1", "How many of the broken agents still succeed in training?", choices)

# %% [markdown] tags=["instructor"] minutes=2
# Collect the names on the board. If somebody names all six, ask why. Come back to the list at the
# end of Round 1, and again after the verdict.

# %% [markdown]
# ## Round 1: the curves
#
# Grey lines are the healthy agent's two seeds, violet lines those of the agent whose letter stands
# above the panel. An agent that crashes early drives more episodes in as many updates, so the axis
# is logarithmic.

# %%
predicted("bug_hunt.1")
episode, share = "training episode (logarithmic)", "success in the last 30 episodes (%)"
curves = {name: (x, 100 * each) for name, (x, each) in hunt.curves("success").items()}
title = "Most of the agents with a bug succeed in training"
bc.show(charts.many(curves, title, episode, share, reference="healthy", x_scale="log"))

# %%
late, last = hunt.at_the_end("success"), hunt.at_the_end("return")
crashed, rows = hunt.at_the_end("accident"), []
for n in hunt.names:
    columns = (100 * late[n], last[n], 100 * crashed[n])
    rows.append([n, *(" and ".join(f"{x:.0f}" for x in seeds) for seeds in columns)])
table(["at the end of training, two seeds", "success, %", "return", "accidents, %"], rows)

# %% [markdown]
# **See.** Code can be wrong although its curve looks right. A, C and D succeed at the end as often
# as the healthy one, E in over 80 %. E has the highest return, in both seeds, and more accidents
# than the healthy agent. (A healthy agent can look ill, too: in the study three of ten of this
# method do not escape.)
# <!-- claim: {n for n in 'ABCDEF' if hunt().at_the_end('success')[n].mean() >=
#   hunt().at_the_end('success')['healthy'].mean()} == set('ACD') -->
# <!-- claim: hunt().at_the_end('accident')['E'].min() > hunt().at_the_end('accident')['healthy'].max()
#   and len(of('bootstrapped')) - escaped('bootstrapped') == 3 -->
# <!-- claim: sum(hunt().at_the_end('success')[n].mean() > 0.8 for n in 'ABCDEF') == 4 -->
# <!-- claim: (lambda last: last['E'].min() > max(v.max() for n, v in last.items() if n !=
#   'E'))(hunt().at_the_end('return')) -->
#
# The curves show that two agents are ill, and name no bug. To judge one part of a learner, ask that
# part alone.

# %% [markdown] tags=["instructor"] minutes=3
# Fill in the board's table: what did each predict, and which curve could be any of the six? Ask
# which agent they would have published.

# %% [markdown]
# ## Round 2: ask the critic what you know
#
# A **probe** asks a network something whose answer is known. We know the right Q where an accident
# ends the episode: there $y = r = -{{ -DEFAULT.reward.accident }}$, without a guess of the next
# value.
#
# > **Predict.** Two of the six bugs change the target exactly there. Which one pulls Q *below*
# > {{ DEFAULT.reward.accident }}?

# %%
names = list(bugs.BUGS)
predict("bug_hunt.2", "Which bug pulls Q below −10 at accidents?", names)

# %% [markdown]
# **Exercise (6 min, ●●○).** Write the probe: by how much is Q above r, on average, where an
# accident ended the drive?


# %%
def end_error(q, actions, rewards, terminated):
    """Mean of Q(s, a) - r over rows with terminated 1, or 0. q: (batch, 9); others: (batch,)."""
    # solution: the exercise's own


check.end_error(end_error)

# %% [markdown]
# During training each agent was asked this about its own accidents, every {{ bugs.EVERY }} updates.
# The picture shows Q itself.
# <!-- claim: set(np.diff(hunt().updates)) == {bugs.EVERY} -->

# %% tags=["hide-input"]
predicted("bug_hunt.2")
probes = hunt.probes("end")
title = "One agent values its own accidents far below −10"
bc.show(
    charts.many(
        probes, title, "updates", "Q where an accident followed (dotted: −10)", "healthy", level=-10
    )
)

# %% [markdown]
# **See.** Even the healthy critics stay above {{ DEFAULT.reward.accident }}. (We think that similar
# seconds without an accident raise it.) So a probe is a comparison, with the healthy agent after as
# many updates: which agent leaves the grey lines, and in which direction?
# <!-- claim: (hunt().probe('healthy', 'end')[:, -1] > DEFAULT.reward.accident + 1).all() -->
#
# > **Predict.** The road pays at most about 1 a second, and γ = {{ SETTINGS.gamma }}. The value
# > that a critic gives to a state is what it *promises*. What is the most that a correct critic may
# > promise if it counts the road's rewards alone, without a bonus?

# %%
predict("bug_hunt.3", "What is the most that such a critic may promise?", unit="")

# %%
predicted("bug_hunt.3")
gamma, c = 0.8, 2.0
print(f"honest: {1 / (1 - gamma):.0f}; with the bonus in every second: {(1 + c) / (1 - gamma):.0f}")
probes = hunt.probes("promise")
title = "Two agents promise far more than the healthy one"
bc.show(
    charts.many(
        probes,
        title,
        "updates",
        "promise Σ π Q, cut off at 20 (dotted: 5)",
        "healthy",
        limits=(-2, 20),
        level=1 / (1 - gamma),
    )
)

# %% [markdown]
# **Explain.** For the road's rewards alone 5 is the limit. The critics of this method count more:
# part of each batch is demonstrations, which do get the bonus (lesson
# [[learning_from_demonstrations]]), the entropy is paid for, and ignoring the rule costs. So the
# healthy promise may lie a little over 5, and the grey lines are the measure. It is what the
# critics promise in seconds that the rule drove. In two panels it is far above that: one rises
# slowly past 10, in the other both seeds leave the axes.
# <!-- claim: {n for n in 'ABCDEF' if hunt().probe(n, 'promise').max() > 10} == {'E', 'F'} and
#   (hunt().probe('F', 'promise').max(axis=1) > 20).all() -->

# %% [markdown] tags=["instructor"] minutes=3
# Ask which of the two probes one should watch during training: Q at accidents, or the promise. A
# wrong promise shows without an accident.

# %% [markdown]
# ## Round 3: ask the actor about the rule
#
# The next probes look at the policy, on the same seconds that the *rule* drove.
#
# - **entropy** of π, in nats: 0 is sure of one action, log {{ N_ACTIONS }} ≈ {{ math.log(N_ACTIONS)
#   | .1f }} is the same probability for each action;
# - **agreement**: the share of seconds in which the most probable action is what the rule does now,
#   or *one second later*;
# - **rarest**: the logarithm of the smallest of the nine probabilities.

# %% tags=["hide-input"]
probes = hunt.probes("entropy")
title = "One agent stays far more undecided than the healthy one"
bc.show(charts.many(probes, title, "updates", "entropy of π (nats)", reference="healthy"))

# %%
early, rows = slice(2, 6), []  # after 500 to 1,250 updates
for name in hunt.names:
    now, later = (100 * hunt.probe(name, what)[:, early].mean(1) for what in ("alike", "late"))
    columns = (now, later, now - later)
    rows.append([name, *(" and ".join(f"{x:.0f}" for x in seeds) for seeds in columns)])
table(["early, two seeds", "as the rule now, %", "as one second later, %", "difference"], rows)

# %% [markdown]
# > **Predict.** KL(π‖π̃) charges the policy for going where the rule would not. The flipped one
# > charges it for *not* going where the rule might, and the rule's noise gives each action a little
# > probability. What does the flipped KL, compared with the right one, do to an action that the
# > rule would hardly ever take?

# %%
choices = ["it drops it as fast", "it drops it more slowly", "it makes it the favourite"]
predict("bug_hunt.4", "What does the policy do to such an action, with the flipped KL?", choices)

# %% tags=["hide-input"]
predicted("bug_hunt.4")
probes = hunt.probes("rarest")
title = "Two agents keep their rarest action likelier than the healthy one"
bc.show(charts.many(probes, title, "updates", "log of the rarest action's probability", "healthy"))

# %% [markdown]
# **Explain.** The stochastic rule gives one in eighty to each action that the rule does not take.
# With the right KL dropping such an action costs little. The flipped KL grows without bound when
# one of the nine probabilities goes to zero, so each falls more slowly. It falls as ξ fades: log π
# = −16 is 10⁻⁷. *Two* agents keep their rarest action likelier than the healthy one; Round 4 tells
# them apart.
# <!-- claim: math.isclose((1 - RULE_P) / (N_ACTIONS - 1), 1 / 80) -->
# <!-- claim: round(-16 / math.log(10)) == -7 -->
# <!-- claim: {n for n in 'ABCDEF' if hunt().probe(n, 'rarest')[:, -1].min() > -20} == {'A', 'B'}
#   and (hunt().probe('healthy', 'rarest')[:, -1] < -30).all() -->

# %% [markdown] tags=["instructor"] minutes=2
# Ask for the limit of both divergences as one probability of π goes to zero, before anybody looks
# at the last picture.

# %% [markdown]
# ## Round 4: watch them drive
#
# In training the agents draw their actions from π. Here the first seed of each agent drives both
# by its most probable action and by drawn ones, on 200 roads that it has not seen.

# %%
rows = []
for name in hunt.names:
    agent = hunt.agent(name)
    greedy = bc.evaluate(agent.as_policy(), 200, seed=12)
    drawn = bc.evaluate(agent.as_policy(np.random.default_rng(0)), 200, seed=12)
    accidents = greedy.collision.value + greedy.road_departure.value + greedy.stoppage.value
    shares = [f"{100 * share:.1f}" for share in (greedy.success.value, drawn.success.value)]
    rows.append([name, *shares, f"{greedy.returns.value:.1f}", f"{100 * accidents:.1f}"])
headings = ["200 roads", "success, most probable, %", "success, drawn, %", "return", "accidents, %"]
table(headings, rows)

# %% [markdown]
# **See.** In these 200 drives one agent succeeds nearly always with its most probable action, and
# in less than half of the drives with drawn ones. (F crashes in every drive, also where it was
# ahead before. One seed of each: small differences mean little.) Which part of the learner seems to
# have taught it nothing?
# <!-- claim: drive_episodes(hunt().agent('B').as_policy(), held_out_seeds(12, 200)).success.mean()
#   > 0.9 -->
# <!-- claim: drive_episodes(hunt().agent('B').as_policy(np.random.default_rng(0)),
#   held_out_seeds(12, 200)).success.mean() < 0.5 -->
#
# **Exercise (15 min, ●●●).** The verdict. For each agent one of the six names. The check
# judges the six together. Find a picture that decides each.


# %%
def diagnose(agent):
    """The bug of an agent, "A" to "F": flipped_kl, no_end, sampled, no_stop, bonus_for_all, ..."""
    # solution: the exercise's own


check.diagnose(diagnose)

# %% [markdown]
# <details><summary>After your verdict: which picture decides which agent</summary>
#
# - **A**: the last picture of Round 3 *and* Round 4. A and B keep their rarest action likelier than
#   the healthy agent. By drawn actions A succeeds about as often as the healthy agent, so Q reaches
#   its policy: only the KL is left.
# - **B**: Round 4. It often fails when its actions are drawn, and its entropy stays far above the
#   healthy one's: it has learned from the rule, and next to nothing from Q.
# - **C**: the table of Round 3. Early it agrees with the rule of *now* less often than all but F,
#   whose critic has left all bounds. The difference to one second later is small.
# - **D**: the first probe of Round 2. In these {{ bugs.UPDATES | , }} updates its Q falls below {{
#   DEFAULT.reward.accident }} at accidents.
# - **E**: the promise, which rises past 10, together with the highest return. At accidents its Q
#   lies above the grey lines, too. Why does it earn more? We think because a bonus for everything
#   no longer prefers the demonstrations: E does what the rule does in {{ 100 * as_the_rule('E')[0]
#   | .0f }} % of its seconds, the healthy agent in {{ 100 * as_the_rule('healthy')[0] | .0f }} %,
#   and drives {{ as_the_rule('E')[1] | .1f }} m/s on average instead of {{
#   as_the_rule('healthy')[1] | .1f }}.
# - **F**: the promise, which leaves the axes.
#
# So `flipped_kl`, `shifted_labels`, `no_end` and `bonus_for_all` still succeed in training.
#
# </details>
# <!-- claim: abs(drawn_success('A') - drawn_success('healthy')) < 0.05 -->
# <!-- claim: early('F') < early('C') < min(early(n) for n in ('A', 'B', 'D', 'E', 'healthy')) and
#   early('C', 'late') / early('C') > 0.85 > 0.75 > early('healthy', 'late') / early('healthy') -->
# <!-- claim: (hunt().probe('D', 'end')[:, -1] < DEFAULT.reward.accident).all() -->
# <!-- claim: all((hunt().probe('E', 'end')[:, t] > hunt().probe('healthy',
#   'end')[:, t].max()).all() for t in range(8, len(hunt().updates))) and {n for n in 'ABCDEF' if
#   hunt().at_the_end('success')[n].mean() > 0.8} == set('ACDE') -->

# %% [markdown] tags=["instructor"] minutes=3
# The order that works: F (promise leaves the scale), B (undecided, fails when drawn), D
# (accidents), E (promise too high, the *best* return), C (slow start, nearly as often later as
# now), A (what is left: the rarest action). Let each group defend its verdict with a single
# picture. If a group is stuck on A and C, ask which of the two is like the healthy agent in the
# first thousand updates.

# %% [markdown]
# ## Round 5: repairs
#
# Each piece of code is shown with its bugs.
#
# ### The target
#
# ```python
# target = reward + bonus + gamma * next_value
# ```
#
# Two of the six bugs are in that line: the bonus belongs to demonstrations alone, and after an
# accident there is no next value. Without the factor (1 − terminated), the target of an accident
# contains the value of a car that has just crashed. That state looks like the seconds before an
# accident, so its value is low, and the {{ DEFAULT.reward.accident }} is counted again and again.
# <!-- claim: any((hunt().probe(n, 'end')[:, -1] < DEFAULT.reward.accident).all() for n in
#   'ABCDEF') -->
#
# ### The value of a state
#
# The buggy learner draws one of its nine actions, and no gradient passes through a choice among
# nine:
#
# ```python
# action = torch.multinomial(log_pi.exp(), 1)
# value = (q - alpha * log_pi).gather(-1, action).squeeze(-1)
# ```
#
# In the critic's target the draw adds noise and leaves the mean as it is. In the actor's loss it is
# fatal: the gathered Q is a constant, so only −α log π has a gradient, and its mean is 0. The next
# cell is the test that finds it: the mean gradient has to be that of the expectation.

# %%
torch.manual_seed(0)
logits = torch.zeros(1, 9, requires_grad=True)
q = torch.tensor([[0.0, 0, 0, 0, 0, 0, 0, 5, 0]])
gradients = {name: torch.zeros(9) for name in ("the expectation", "one drawn action")}
for _ in range(1000):
    log_pi = logits.log_softmax(-1)
    action = torch.multinomial(log_pi.exp(), 1)
    drawn = (q - 0.01 * log_pi).gather(-1, action).sum()
    expected = bc.sac.soft_value(log_pi, q, torch.tensor(0.01)).sum()
    for name, value in zip(gradients, (expected, drawn), strict=True):
        gradients[name] += torch.autograd.grad(value, logits, retain_graph=True)[0][0] / 1000
rows = [[name, f"{abs(gradient[7]):.2f}"] for name, gradient in gradients.items()]
table(
    ["the actor's value is", "size of the mean gradient of action 7, which is worth 5 more"], rows
)

# %% [markdown]
# ### The actor's loss
#
# Two bugs:
#
# ```python
# pi, rule = log_pi.exp(), log_rule.exp()
# kl = (rule * (log_rule - log_pi)).sum(-1)
# loss = -((pi * (q - alpha * log_pi)).sum(-1) - xi * kl).mean()
# ```
#
# One of them lets the actor's loss change the critic, since here one optimiser step serves both: Q
# rises wherever the policy likes an action. In which panel of Round 2 did the promise leave the
# axes?
#
# The repairs are `q.detach()`, and a KL that is weighed by π: Σ π (log π − log π̃).
#
# ### The labels
#
# After a drive the rule was asked about its T + 1 states, in order, and the buggy version took
# `asked[1:]` as the labels of the T decisions: one second late.
#
# ### A probe without training
#
# The target can be tested in a millisecond, without training, with a few transitions whose right y
# you work out by hand.
#
# **Exercise (20 min, ●●●).** Write that test. You are given a function
# `target(reward, demo, bonus, end, next_value, gamma)`, of which you do not see the code. It takes
# NumPy arrays of shape (batch,), and two floats: bonus and gamma. Say whether it is wrong. The
# check gives it three right functions and twelve that are wrong, each in another way.
# <!-- claim: (lambda e: len(e.TARGETS) - len(e.RIGHT_TARGETS) == 12 and len(e.RIGHT_TARGETS) ==
#   3)(__import__('bootcourse.course.lessons.bug_hunt.target_probe', fromlist=['x'])) -->


# %%
def unmasks(target):
    """True if target(reward, demo, bonus, end, next_value, gamma) is not y, False if it is."""
    # solution: the exercise's own


check.unmasks(unmasks)

# %% [markdown]
# **Explain.** Here four of six bugs leave success high. A teacher may hide them: its demonstrations
# and the soft constraint lead the policy out of the trap even if another part of the learner is
# wrong. We did not train the bugs without a teacher. And a bug that raises the return is dangerous,
# since few people search for a mistake in a good result.

# %% [markdown] tags=["instructor"] minutes=4
# Let pairs write the test of the labels on paper. Then ask which of the six their own programs
# test for today.

# %%
fine = sum(late[name].mean() > 0.8 for name in "ABCDEF")
compare_predictions(
    "bug_hunt",
    {
        1: f"three or four: {fine} of six, in more than 80 % of the last episodes",
        2: "no_end",
        3: round(1 / (1 - gamma), 1),
        4: "it drops it more slowly",
    },
)

# %% [markdown]
# ## What you now know
#
# 1. A curve can look right with a broken part behind it: three of six agents with a bug succeeded
#    as often as the healthy one, and the one with the highest return had a bug.
# 2. A probe asks one part of a learner something whose answer is known. Compare with a healthy
#    agent, during training: after {{ bugs.UPDATES | , }} updates each of the six bugs shows in a
#    probe or in the drives.
# 3. On this road, without a bonus, a promise far above {{ 1 / (1 - SETTINGS.gamma) | .0f }} is
#    wrong. A promise below it acquits nobody.
# 4. No gradient passes through a draw among nine actions. Without the stop-gradient, the actor's
#    loss changes the critic.
# 5. Small functions with hand-worked cases find in milliseconds what training can hide.
#
# **Three questions to think about**
# - You may run one probe during your trainings from now on. Which, and at what value does it warn?
# - Two bugs at once: which pair could hide each other in the pictures above?
# - A bug raises the return of your method in a paper's table. How would a reader find out?

# %% [markdown] tags=["instructor"] minutes=2
# Answers to the three questions. (1) The promise: it costs one pass through the networks, needs
# neither accidents nor a teacher, and its bound is known, the largest reward of a second divided by
# 1 − γ, here 5 (7 with room for the bonus). (2) For example `no_end` and `bonus_for_all`: at
# accidents one pulls Q down and the other up. Ask for more pairs that move the same probe in
# opposite directions. (3) From the printed text hardly; from the code, if it ships, with tests of
# single functions; or when somebody else's program of the same method earns less.

# %% [markdown]
# **Read on**: Henderson et al., *Deep Reinforcement Learning that Matters* (arXiv 1709.06560);
# Engstrom et al., *Implementation Matters in Deep Policy Gradients* (arXiv 2005.12729). Next: [your
# teacher](your_teacher.ipynb).

# %% [markdown] tags=["instructor"]
# **On the board.** A table: six agents as rows, probes as columns, a cross where a probe is off.
#
# **To discuss.** How long would each of these bugs have lived in your last project?
