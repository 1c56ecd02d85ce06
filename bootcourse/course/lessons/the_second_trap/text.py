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
# # The second trap
#
# **What you will be able to do**
# - find out from a drive what its reward pays for;
# - write PPO, its advantages and its loss, and train an agent with it;
# - bend a reward, and say what that does.
#
# **Time** 55 minutes; running it takes about one minute. **It builds on** the reward (lesson
# [[the_trap]]), the barrier ([[the_barrier]]) and demonstrations ([[demonstrations]]).

# %%
import bootcourse as bc
import torch
from bootcourse.course import (
    check,
    compare_predictions,
    own_code,
    predict,
    predicted,
    progress,
    table,
)
from bootcourse.course.lessons.the_second_trap import explorable, figures, ppo_kinds, second_trap
from bootcourse.learn import ppo

progress("the_second_trap")

# %% [markdown]
# ## Look first
#
# Here is another learner: PPO, *proximal policy optimisation*, with γ = {{
# settings_for('ppo').gamma }} in place of SAC's {{ SETTINGS.gamma }}. Ten agents were trained without
# a rule or demonstrations. On {{ len(ppo_kinds.ROADS) }} new roads they earn {{
# ppo('alone')['returns'].mean() | .0f }} on average. Keeping straight behind the traps earns {{
# idle().rewards.sum() | .0f }}; the rule, which gets out, earns {{ drivers()['the rule'][0] |
# .0f }}.
# <!-- claim: settings_for('ppo_cloned').gamma == settings_for('ppo').gamma and
#   settings_for('sac').gamma == SETTINGS.gamma -->
# <!-- claim: ppo_agents() == 10 and drivers()['the rule'][1] == 1 and
#   drivers()['keeping straight'][1] == 0 -->
#
# > **Predict.** On how many of these roads does a PPO agent end ahead of trap 1?

# %%
choices = ["on almost all", "on about half", "on none"]
predict("the_second_trap.1", "On how many roads does a PPO agent end ahead of trap 1?", choices)

# %% [markdown]
# Press play. What does it do to earn this?

# %% tags=["nbval-ignore-output"]
predicted("the_second_trap.1")
ROAD = 10
drive = bc.record(ppo_kinds.agent_of("alone").as_policy(), [ROAD], label="PPO alone")[0]
bc.recording([drive], height=360)

# %%
title = "These ten agents of PPO alone earn about what the rule earns, and none gets out"
bc.show(figures.plane(ppo_kinds.compared({"PPO alone": "alone"}), title))

# %% [markdown]
# **See.** None ends ahead. Yet they earn twice what keeping straight (the *first trap*) earns: this
# is the **second trap**.
# <!-- claim: (ppo('alone')['success'] == 0).all() and not ppo_drive().success -->
# <!-- claim: ppo('alone')['returns'].mean() > 1.8 * idle().rewards.sum() and
#   abs(ppo('alone')['returns'].mean() / of('rule').scores('returns')[0] - 1) < 0.25 -->

# %% [markdown] tags=["instructor"] minutes=3
# Ask what a car that cannot pass trap 1 may still choose, before anybody says "the speed".

# %% [markdown]
# ## Round 1: what pays for it

# %%
title = "This agent sprints and falls back, again and again, and does not pass trap 1"
bc.show(bc.traces(drive, title=title, what=("speed", "distance")))

# %% [markdown]
# Behind trap 1 it cannot be faster than trap 1 *on average*, apart from the first few metres. But
# it chooses how its speed is spread.
# <!-- claim: ppo_gap().min() < -40 and ppo_speeds().max() > 13.5 and ppo_speeds()[40:].min() < 7
#   -->
# <!-- claim: ppo_drive().states[-1, EGO, X] < ppo_drive().states[-1, TRAP_1, X] and
#   ppo_speeds().mean() < DEFAULT.traps.speed + 20 / DEFAULT.clock.decisions -->
#
# > **Predict.** The speed reward r_v is 0 up to 5 m/s, {{ speed_reward(12.5) | .1f }} at 12.5 and 1
# > at 15, with straight lines between. Somebody drives 5 m/s half of the time and 15 m/s the other
# > half. How much r_v does that earn, compared with a steady 10 m/s?
# <!-- claim: all(abs(speed_reward(v) - np.interp(v, [5, 12.5, 15], [0, 0.2, 1])) < 1e-9 for v in
#   np.linspace(0, 15, 601)) -->

# %%
choices = ["about half", "the same", "about twice as much", "almost four times as much"]
predict("the_second_trap.2", "What does changing between 5 and 15 m/s earn?", choices)

# %% [markdown]
# **Drag** the swing. From where on does changing pay more than a steady 10 m/s?

# %%
predicted("the_second_trap.2")
explorable.sprints()

# %% [markdown]
# **See.** Up to a swing of 2.5 m/s it pays nothing more: r_v is straight from 5 to 12.5 m/s.
# At 5 it pays almost four times as much. Up to 15 m/s r_v is **convex**: its slope grows. The mean
# of a convex function is at least the function of the mean (*Jensen's inequality*). The difference
# is **Jensen's gap**. How large is it in the agent's drive?
# <!-- claim: 3.5 < np.divide(*explorable.paid(speed_reward, 5)) < 4 and
#   abs(np.divide(*explorable.paid(speed_reward, 2.5)) - 1) < 1e-9 <
#   np.divide(*explorable.paid(speed_reward, 3)) - 1 -->
# <!-- claim: (lambda r: all(r[i - 1] + r[i + 1] >= 2 * r[i] - 1e-12 for i in range(1, len(r) -
#   1)))([speed_reward(v) for v in np.linspace(0, 15, 601)]) -->

# %%
speeds = second_trap.speeds(drive)
steady, gap = bc.formulas.speed_reward(speeds.mean()), second_trap.jensen_gap(speeds)
print(f"mean speed {speeds.mean():.1f} m/s; if it were steady, it would pay {steady:.2f} a second")
print(f"this drive's speed pays {steady + gap:.2f} a second: Jensen's gap is {gap:.2f}")

# %% [markdown]
# **Explain.** Sprints pay, but late: at γ = {{ SETTINGS.gamma }} this drive would be worth less than
# keeping straight. How does PPO learn it?
# <!-- claim: np.mean([speed_reward(v) for v in ppo_speeds()]) > 2.2 * speed_reward(10) -->
# <!-- claim: discounted(ppo_drive(), SETTINGS.gamma) < 0.6 * discounted(idle(), SETTINGS.gamma) and
#   discounted(ppo_drive(), settings_for('ppo').gamma) > 1.8 * discounted(idle(),
#   settings_for('ppo').gamma) -->

# %% [markdown] tags=["instructor"] minutes=3
# Ask for everyday payments that are convex: bonuses above a threshold, overtime at a higher rate.
# Who finds a way to earn them by irregular work? Then ask what a *concave* one would do, before
# round 3 does it.

# %% [markdown]
# ## Round 2: build PPO
#
# SAC asks its critic which action is best. A **policy gradient** does without: drive, see what
# follows, and make likelier what went well. For one decision that pays R, and a policy with
# parameters θ,
#
# $$ \nabla_\theta\, \mathrm{E}[R] = \mathrm{E}\big[\nabla_\theta \log \pi(a)\; R\big] $$
#
# since ∇π = π ∇log π: a mean over *drawn* actions. Subtracting what was expected before the action
# leaves that mean, as E[∇log π] = 0. PPO takes this **advantage** A: how much more came than was
# expected. It expects V(s), which it learns. The surprise of one second is the temporal difference
#
# $$ \delta_t = r_t + \gamma V(s_{t+1}) - V(s_t) $$
#
# A decision may pay later. So the advantage adds the surprises that follow, each a little less:
#
# $$ A_t = \delta_t + \gamma\lambda\, \delta_{t+1} + (\gamma\lambda)^2 \delta_{t+2} + \dots $$
#
# With λ = 0 it trusts V after one second; with λ = 1 it trusts what happened. This is GAE,
# *generalised advantage estimation*.
#
# **Two endings need care.** After an accident nothing follows: V is 0. If the time is over,
# the last state still has its value. There the sum stops, as it does after the last row.
#
# **Exercise (15 min, ●●●).** Write the advantages, in torch.


# %%
def advantages(rewards, values, next_values, terminated, ended, gamma, lam):
    """A_t of each decision: all arguments but the last two and the answer are (horizon, roads).

    values: V(s_t); next_values: V(s_{t+1}); where an episode ended, of its last state.
    terminated: 1 after an accident; ended: 1 after an accident or when the time is over. For
    example rewards 1, 2, 4 of one road give 1.75, 3, 4 with V = 0 everywhere and γ = λ = ½.
    """
    # solution
    delta = rewards + gamma * (1 - terminated) * next_values - values
    found, following = torch.zeros_like(delta), torch.zeros_like(delta[0])
    for t in reversed(range(len(delta))):
        found[t] = following = delta[t] + gamma * lam * (1 - ended[t]) * following
    return found
    # end solution


check.advantages(advantages)

# %% [markdown]
# **When does a decision stop pushing?** PPO drives {{ settings_for('ppo').envs_per_agent }} roads at
# once for {{ settings_for('ppo').horizon }} seconds and takes several passes over these decisions of
# the old policy. The **ratio** $\rho = \pi(a|s) / \pi_\text{old}(a|s)$ says how much likelier an
# action has become since it was taken. A good action (A > 0) pushes until it is ε = {{ 100 *
# settings_for('ppo').clip | .0f }} % likelier, a bad one until it is ε rarer; other decisions may
# push further:
#
# $$ L = -\,\mathrm{mean}\big[\min(\rho A,\ \mathrm{clip}(\rho, 1 - ε, 1 + ε)\, A)\big] $$
#
# At ρ = 1, ∇ρ = ∇log π: the policy gradient.
#
# > **Predict.** An action turned out badly, A = −2, but has become likelier, ρ = 1.5. Does this
# > decision still change the policy?

# %%
choices = ["yes, it makes the action rarer", "yes, likelier", "no, it is clipped"]
predict("the_second_trap.3", "Does it still change the policy?", choices)

# %% [markdown]
# **Exercise (8 min, ●●○).** Write the loss.


# %%
def clipped_loss(ratio, advantage, clip):
    """PPO's loss, one number: ratio, advantage (batch,) tensors; clip: ε."""
    # solution
    clipped = ratio.clamp(1 - clip, 1 + clip)
    return -torch.minimum(ratio * advantage, clipped * advantage).mean()
    # end solution


check.clipped_loss(clipped_loss)

# %%
predicted("the_second_trap.3")
bc.show(figures.hinges(ppo.clipped_loss, 0.2))

# %% [markdown]
# Train one agent with your parts, for fewer decisions than the ten. **It will differ** from a
# neighbour's: the result depends on the processor.

# %% tags=["nbval-ignore-output"]
MOST = 100_000  # episodes; the number of decisions ends each training
training = own_code.training([ppo_kinds.settings_of("alone")], MOST)
mine = ppo_kinds.train(training, 500_000)
your_drive = bc.record(mine.agent.as_policy(), [ROAD], label="your agent")[0]
gap = second_trap.jensen_gap(second_trap.speeds(your_drive))
print(f"{training.decisions:,} decisions in {training.seconds:.0f} s; Jensen's gap {gap:.2f}")
title = "The return pauses at about what keeping straight earns, then rises again"
bc.show(figures.learning(mine, title))

# %% [markdown]
# Does your agent sprint? The gap says what that pays.
# <!-- claim: (lambda curve: (abs(curve[:, 6] / idle().rewards.sum() - 1) < 0.2).all() and (curve[:,
#   -1] > 1.3 * idle().rewards.sum()).all())(ppo('alone')['curve']) -->

# %% [markdown] tags=["instructor"] minutes=7
# The two endings are the hard part. Draw two rows, one that ends in an accident and one
# that runs out of time, and fill in δ and the sum for both. Who thinks that clipping is a limit on
# the policy? It takes the payment away, and other rows of the batch can push the policy further.

# %% [markdown]
# ## Round 3: change the reward
#
# The reward pays for sprints, so bend it. **Drag** what it pays at 12.5 m/s: from where on do
# sprints pay nothing more?

# %%
explorable.bends()

# %% [markdown]
# From 0.75 on, where it is a straight line. Above, it is **concave**: of all drives from 5 to 15 m/s
# with the same mean speed, the steady one's speed pays most. Ten agents were trained with a concave
# one, √((v − 5) / 10).
# <!-- claim: (lambda sprints: abs(sprints(0.75)) < 1e-9 < sprints(0.7) and sprints(0.8) < 0)(lambda
#   knee: np.subtract(*explorable.paid(explorable.bent(knee), 5))) -->
# <!-- claim: [float(second_trap.concave_speed_reward(np.float64(v))) for v in (5, 15)] == [0, 1]
#   and len(ppo('concave')['success']) == 10 -->
#
# > **Predict.** What does PPO alone do with this reward?

# %%
choices = ["it leaves", "it drives steadily behind trap 1", "it falls back and sprints as before"]
predict("the_second_trap.4", "What does PPO do with the concave reward?", choices)

# %%
predicted("the_second_trap.4")
concave = bc.record(ppo_kinds.agent_of("concave").as_policy(), [ROAD])[0]
bc.show(figures.two_speeds({"the road's reward": drive, "the concave one": concave}))

# %% [markdown]
# **See.** The sprints are gone, and none of the ten agents escapes: this is the first trap.
# <!-- claim: all(9 <= drive_episodes(ppo_kinds.agent_of('concave', i).as_policy(),
#   ppo_kinds.ROADS).speed.mean() <= 10.05 for i in range(ppo_agents())) and
#   np.sort(ppo('concave')['accident'])[-2] < 0.01 -->
# <!-- claim: ppo_escapes('concave') == 0 and abs(ppo('concave')['returns'].mean() /
#   idle().rewards.sum() - 1) < 0.15 -->
# <!-- claim: all(ppo_speeds('concave', i)[20:].std() < 0.3 * ppo_speeds()[20:].std() for i in
#   range(ppo_agents())) -->
#
# **Explain.** Two things changed: sprints do not pay, and a steady 10 m/s pays five times as much.
# Yet the concave reward pays more for the rule's drive on this road, which gets out, than for the
# agent's: {{ paid_concavely(by_rule()) | .0f }} and {{ paid_concavely(ppo_drive('concave')) | .0f
# }}. Does PPO stay since 10 m/s pays more than before, or for the price of attempts (lesson
# [[the_barrier]])?
#
# Now add to the road's reward a *shaping reward*, which leaves the best policy as it is (Ng, Harada
# and Russell 1999): γ Φ(s') − Φ(s). The *potential* Φ is {{ second_trap.PER_LANE | .0f }} for each
# lane to the left, and 0 after an accident. Ten agents were trained with this guide.
# <!-- claim: 5 < second_trap.concave_speed_reward(np.float64(10)) / speed_reward(10) < 5.5 -->
# <!-- claim: paid_concavely(by_rule(), settings_for('ppo').gamma) >
#   paid_concavely(ppo_drive('concave'), settings_for('ppo').gamma) and by_rule().success -->

# %%
kinds = {"the road's": "alone", "the concave one": "concave", "the road's and the guide": "shaped"}
table(*figures.of_rewards(kinds, ROAD))

# %% [markdown]
# **See.** *The guide does not lead out either*; but here sprints still pay, so it does not decide
# between the two. An accident takes back what the guide paid: a failed attempt costs as much as
# before. This fits the price of attempts; it is no proof.
# <!-- claim: ppo_escapes('shaped') == 0 and len(ppo('shaped')['success']) == ppo_agents() -->
# <!-- claim: abs(sum(settings_for('ppo').gamma ** t * second_trap.shaping_reward(20 * t, 20 * t + 20,
#   t == 2, settings_for('ppo').gamma) for t in range(3))) < 1e-9 -->

# %% [markdown] tags=["instructor"] minutes=3
# Let them propose other rewards that need no sprints, and say for each what a driver who has never
# been ahead learns from it about the way out. Then let them add up the guide's payments over a
# drive: with γ = 1 only its two ends are left.

# %% [markdown]
# ## Round 4: start as a clone
#
# The stochastic rule drives {{ settings_for('ppo_cloned').demonstration_episodes }} roads, and the
# actor learns the rule's actions there: it is *cloned* (lesson [[demonstrations]]). Then PPO
# begins, with the road's own reward, and the rule is not asked again.
# <!-- claim: settings_for('ppo_cloned').xi_multiplier == 0 ==
#   settings_for('ppo_cloned').beta_start -->
#
# > **Predict.** What does such an agent do after PPO?

# %%
leaves = "it leaves, and earns"
choices = ["it stays behind trap 1", f"{leaves} what the rule earns", f"{leaves} far more"]
predict("the_second_trap.5", "What does it do after PPO?", choices)

# %% tags=["nbval-ignore-output"]
predicted("the_second_trap.5")
training = own_code.training([ppo_kinds.settings_of("cloned")], MOST)
start = ppo_kinds.driven(training.agent(0).as_policy())
yours = ppo_kinds.train(training, 200_000).agent
named = {"PPO alone": "alone", "PPO after cloning": "cloned"}
own = start, ppo_kinds.driven(yours.as_policy())
bc.show(figures.plane(ppo_kinds.compared(named), figures.AFTER_CLONING, own))

# %% [markdown]
# **See.** All ten cloned agents escape. But {{ 100 * ppo('cloned')['accident'].mean() | .1f }} % of
# their drives end in an accident, none of the rule's. Watch yours:
# <!-- claim: ppo_escapes('cloned') == ppo_agents() and 1.8 < ppo('cloned')['returns'].mean() /
#   of('rule').scores('returns')[0] < 2.4 and ppo('cloned')['accident'].mean() > 0 -->
# <!-- claim: not drive_episodes(rule_policy(DEFAULT), ppo_kinds.ROADS).accident.any() -->

# %% tags=["nbval-ignore-output"]
fast = bc.record(yours.as_policy(), [ROAD], label="ppo_cloned")[0]
bc.recording([drive, fast], height=360)

# %% [markdown]
# **Explain.** Getting out *and driving fast* pays over twice what sprinting pays (on our road at
# PPO's γ, too). So the reward does not prefer the second trap; if it did, this would be *reward
# hacking*. Before PPO your clone got out on some roads, and on average earned less than sprints.
# *Perhaps* PPO makes its good drives likelier.
# <!-- claim: ppo('cloned')['returns'].mean() > 2 * ppo('alone')['returns'].mean() and
#   discounted(ppo_drive('cloned'), settings_for('ppo').gamma) > 2 * discounted(ppo_drive(),
#   settings_for('ppo').gamma) -->

# %% [markdown] tags=["instructor"] minutes=3
# Ask which of the course's figures would have looked the same for the second trap: those that
# show returns. Then ask for one sentence for an abstract about PPO alone that is true, and does
# not mislead.

# %% [markdown]
# ## If you have time: the whole loss
#
# V learns by squared error, from $\hat V_t = A_t + V(s_t)$ (`returns` in the code), with the old V.
# A little entropy H is paid for:
#
# $$ L + \tfrac12\, \mathrm{mean}\big[(V - \hat V)^2\big] - c_H\, \mathrm{mean}[H] $$
#
# Each pass takes the decisions in *minibatches*. Scale the advantages of each to mean 0 and
# deviation 1 (`advantage.std()`): then the rewards' size does not count.
#
# **Exercise (10 min, ●●○).** Put PPO together. `ppo.clipped_loss`, or your own, is L.


# %%
def ppo_loss(log_pi, values, actions, old_log_pi, advantage, returns, clip, entropy_weight):
    """PPO's loss of a minibatch, one number. log_pi (batch, 9): log π of every action, now.

    actions (batch,): those taken; old_log_pi (batch,): their log π when they were taken. values:
    V(s) now; advantage, returns: all (batch,). entropy_weight: c_H.
    """
    # solution: the exercise's own


check.ppo_loss(ppo_loss)

# %%
compare_predictions(
    "the_second_trap",
    {
        1: "on none",
        2: "almost four times as much",
        3: "yes, it makes the action rarer",
        4: "it drives steadily behind trap 1",
        5: f"{leaves} far more",
    },
)

# %% [markdown]
# ## What you now know
#
# 1. After {{ ppo_kinds.KINDS['alone'].decisions | , }} decisions the ten agents of PPO alone earn
#    twice what keeping straight earns, and none gets out. So look at success, and a drive.
# 2. Where a reward is convex, a changing speed can earn more than a steady one.
# 3. PPO makes likelier what went better than V expected. A good action pushes until it is ε likelier.
# 4. With the concave reward the ten agents stay, though on our road the rule's drive would pay more.
#    With a guide to the left, none gets out either.
# 5. After a short cloning of the rule the ten agents ({{ ppo_kinds.KINDS['cloned'].decisions | , }}
#    decisions) escape and earn more than the rule, but crash in {{ 100 *
#    ppo('cloned')['accident'].mean() | .1f }} % of their drives.
#
# **Three questions to think about**
# - Which number would have shown the second trap to somebody who does not know the goal?
# - With the concave reward the agents stay in the first trap. Is that better than the second?
# - Could cloning `racer` or `timid` of lesson [[your_teacher]] work as well?

# %% [markdown] tags=["instructor"] minutes=3
# Answers to the three questions. (1) The largest speed beside the mean speed: it shows the sprints.
# Or one drive that is looked at. The return does not show it. (2) In one respect: their return is
# that of the idle driver, so it shows that something is missing, where the return of the second
# trap looks like the rule's. For the road both are the same: the agents stay behind trap 1. (3) The
# racer leads past the traps and crashes later, as a clone of the quarter-random teacher does: try
# it. From `timid` {{ cloned_escape('timid') }} of ten escape.

# %% [markdown]
# **Read on**: Schulman et al., *Proximal Policy Optimization Algorithms* (arXiv 1707.06347) and
# *High-Dimensional Continuous Control Using Generalized Advantage Estimation* (arXiv 1506.02438).
#
# Next: [looking ahead](looking_ahead.ipynb).

# %% [markdown] tags=["instructor"]
# **On the board.** r_v against v with a chord from 5 to 15 m/s; below it the speed of an agent that
# lives on the difference.
#
# **To discuss.** You read only a table of returns. Which number beside it would have shown that the
# agent is in a trap?
