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
# - say when a reward pays for a changing speed;
# - write PPO's advantages and its actor's loss, and train an agent with them.
#
# **Time** 45 minutes; running it takes about half a minute. **It builds on** the reward (lesson
# [[the_trap]]), the temporal difference ([[values]]), *terminated* ([[update_and_loop]]) and cloning
# ([[demonstrations]]).

# %%
import bootcourse as bc
import torch
from bootcourse.course import check, compare_predictions, own_code, predict, predicted, progress
from bootcourse.course.lessons.the_second_trap import explorable, figures, ppo_kinds, second_trap
from bootcourse.course.shipped import beginning

progress("the_second_trap")

# %% [markdown]
# ## Look first
#
# Ten agents were trained by another learner, PPO (*proximal policy optimisation*), without a rule or
# demonstrations. On {{ len(ppo_kinds.ROADS) }} new roads they earn {{ ppo('alone')['returns'].mean() | .0f }}.
# Keeping straight behind the traps earns {{ idle().rewards.sum() | .0f }}, and the rule, which gets out, {{
# drivers()['the rule'][0] | .0f }}.
# <!-- claim: ppo_agents() == 10 and drivers()['the rule'][1] == 1 and
#   drivers()['keeping straight'][1] == 0 -->
#
# > **Predict.** What do the PPO agents do to earn twice as much as by keeping straight?

# %%
how = [
    "they get out on almost all roads, and drive slowly",
    "they get out on about half of the roads",
    "they get ahead of trap 1 late, and crash on some roads",
    "they stay behind trap 1, at a changing speed",
    "they stay behind trap 1, at a steady speed",
]
predict("the_second_trap.1", "What do they do to earn twice as much?", how)

# %% tags=["nbval-ignore-output"]
predicted("the_second_trap.1")
ROAD = 10
drive = bc.record(ppo_kinds.agent_of("alone").as_policy(), [ROAD], label="PPO alone")[0]
bc.recording([beginning(drive, 60)], height=360)

# %% [markdown]
# **See.** None of the ten ends ahead of trap 1 on any of these roads. Keeping straight is the first trap; this is
# the **second trap**. The speed of this agent changes again and again.
# <!-- claim: (ppo('alone')['success'] == 0).all() and not ppo_drive().success -->
# <!-- claim: ppo('alone')['returns'].mean() > 1.8 * idle().rewards.sum() and
#   abs(ppo('alone')['returns'].mean() / of('rule').scores('returns')[0] - 1) < 0.25 -->

# %% [markdown] tags=["instructor"] minutes=3
# Ask what a car that cannot pass trap 1 may still choose, before anybody says "the speed".

# %% [markdown]
# ## Round 1: what earns this agent so much?

# %%
bc.show(figures.speed_and_distance(drive))

# %% [markdown]
# > **Predict.** Behind trap 1 the mean speed is at most about {{ DEFAULT.traps.speed | .0f }} m/s. The speed
# > reward r_v is 0 up to 5 m/s, {{ speed_reward(12.5) | .1f }} at 12.5 and 1 at 15, with straight lines
# > between. A car drives 5 and 15 m/s, half of the time each. How much does that earn, compared with a
# > steady 10 m/s?
# <!-- claim: ppo_gap().min() < -40 and ppo_speeds().max() > 13.5 and ppo_speeds()[40:].min() < 7
#   -->
# <!-- claim: ppo_drive().states[-1, EGO, X] < ppo_drive().states[-1, TRAP_1, X] and
#   ppo_speeds().mean() < DEFAULT.traps.speed + 20 / DEFAULT.clock.decisions -->
# <!-- claim: all(abs(speed_reward(v) - np.interp(v, [5, 12.5, 15], [0, 0.2, 1])) < 1e-9 for v in
#   np.linspace(0, 15, 601)) -->

# %%
choices = ["about half", "the same", "about twice as much", "almost four times as much"]
predict("the_second_trap.2", "What does changing between 5 and 15 m/s earn?", choices)

# %% [markdown]
# **Drag** the swing down: where does changing the speed stop paying extra?

# %%
predicted("the_second_trap.2")
explorable.sprints()

# %% [markdown]
# **Explain.** A function whose slope never falls, like r_v up to 15 m/s, is **convex**: the mean of its
# values at several speeds is at least its value at the mean speed (*Jensen's inequality*). How large is the
# difference in the agent's drive? (With a swing of 2.5 m/s or less nothing is gained: between 7.5 and 12.5 m/s
# r_v is a straight line.)
# <!-- claim: all(abs(np.subtract(*explorable.paid(speed_reward, swing))) < 1e-9 for swing in (1, 2, 2.5)) and
#   np.subtract(*explorable.paid(speed_reward, 3)) > 0.05 -->
# <!-- claim: 3.5 < np.divide(*explorable.paid(speed_reward, 5)) < 4 -->
# <!-- claim: (lambda r: all(r[i - 1] + r[i + 1] >= 2 * r[i] - 1e-12 for i in range(1, len(r) -
#   1)))([speed_reward(v) for v in np.linspace(0, 15, 601)]) -->

# %%
speeds = second_trap.speeds(drive)  # m/s, after each second
paid = sum(bc.formulas.speed_reward(v) for v in speeds) / len(speeds)
steady = bc.formulas.speed_reward(speeds.mean())
print(f"r_v of this drive: {paid:.2f} a second; at its mean speed throughout: {steady:.2f}")

# %% [markdown]
# **See.** Changing the speed pays well. But is it the best that a car can do here? The table shows what four drives
# on this road are worth at their start. (`careful` is a rule of lesson [[your_teacher]] that gets out and then drives
# 15 m/s.)
#
# {{ drives_worth() }}
#
# With PPO's γ the sprints are worth twice as much as keeping straight, and even more than the rule's slow way
# out. A fast way out, as `careful`'s, is worth more than twice as much as the sprints, so this agent is in a
# trap. With SAC's γ keeping straight is worth the most: the sprints come too late to pay, and so does leaving
# (compare lesson [[the_barrier]]). Judged by these four drives, a smaller γ trades the second trap for the first.
# <!-- claim: (lambda w: max(w, key=w.get) == 'keeping straight')({d: worth(d, settings_for('sac').gamma)
#   for d in DRIVES}) -->
# <!-- claim: worth('keeping straight', ppo_kinds.GAMMA) < 0.7 * worth('the rule', ppo_kinds.GAMMA) and
#   worth('the rule', ppo_kinds.GAMMA) < 0.9 * worth('this agent', ppo_kinds.GAMMA) -->
# <!-- claim: worth('careful', settings_for('ppo').gamma) > 2 * max(worths()) and
#   min(worths()) > 1.2 * worth('keeping straight', settings_for('ppo').gamma) -->
# <!-- claim: np.mean([speed_reward(v) for v in ppo_speeds()]) > 2.2 * speed_reward(10) -->
# <!-- claim: settings_for('ppo_cloned').gamma == settings_for('ppo').gamma and
#   settings_for('sac').gamma == SETTINGS.gamma -->
# <!-- claim: discounted(ppo_drive(), SETTINGS.gamma) < 0.6 * discounted(idle(), SETTINGS.gamma) and
#   1.8 < discounted(ppo_drive(), settings_for('ppo').gamma) / discounted(idle(),
#   settings_for('ppo').gamma) < 2.2 -->

# %% [markdown] tags=["instructor"] minutes=3
# Ask for everyday payments that are convex: bonuses above a threshold, overtime at a higher rate. Who finds a
# way to earn them by irregular work?

# %% [markdown]
# ## Round 2: when does it give up leaving?
#
# > **Predict.** At first a few training drives get ahead of trap 1. Later none do, and the agent earns more
# > than by keeping straight. Which comes first: giving up, or earning more?

# %%
choices = [
    "it earns more than keeping straight, and then gives up leaving",
    "it gives up leaving, and then earns more than keeping straight",
    "both at about the same time",
]
predict("the_second_trap.3", "What comes first in training?", choices)

# %%
predicted("the_second_trap.3")
bc.show(figures.gives_up(ppo_kinds.reference()["alone"]))

# %% [markdown]
# **See.** At 200,000 decisions {{ 100 * ppo('alone')['escapes'][:, 3].min() | .0f }} to
# {{ 100 * ppo('alone')['escapes'][:, 3].max() | .0f }} % of an agent's drives get ahead, at 300,000 none, later
# 1 % at most, and from 500,000 on none. At 300,000 all ten agents still earn less than a car that keeps
# straight, so they gave up leaving first. (In training the actions are drawn, and some drives crash. This
# costs a little.)
# <!-- claim: all(abs(at[3] - 200_000) < 500 and abs(at[5] - 300_000) < 500 for at in ppo('alone')['at']) and
#   ppo('alone')['escapes'][:, 5].max() == 0 and ppo('alone')['curve'][:, :6].max() < idle().rewards.sum() -->
# <!-- claim: ppo('alone')['curve'][:, 9:].max(axis=1).min() > idle().rewards.sum() + 5 and
#   ppo('alone')['escapes'][:, 5:].max() <= 0.011 and ppo('alone')['escapes'][:, 9:].max() == 0 -->

# %% [markdown] tags=["instructor"] minutes=3
# Let them propose a reward that pays nothing extra for sprints. What would a driver who has never been ahead
# learn from it about the way out?

# %% [markdown]
# ## Round 3: how does PPO see pay that comes late?
#
# PPO drives {{ ppo_kinds.settings_of('alone').horizon }} decisions on each of
# {{ ppo_kinds.settings_of('alone').envs_per_agent }} roads with its present policy, learns from them in a few
# passes over random parts (*minibatches*), throws them away and drives again. Its critic V learns what a state
# is worth. Its actor learns from the **advantage** A of an action: what came of it, less what V expected.
#
# A is a sum of *surprises*. A second's surprise is what came in it, less what V expected of it. Each later
# surprise counts γλ times as much as the one before (λ: 0 to 1).
#
# An example: suppose V has only seen steady driving, and expects 10 m/s for ever, from each state. Then a second's
# surprise is its pay less that of 10 m/s: 0 − {{ speed_reward(10) | .2f }} = −{{ -explorable.surprises()[0] | .2f }}
# while the car falls back, 1 − {{ speed_reward(10) | .2f }} = +{{ explorable.surprises()[-1] | .2f }} while it
# sprints, {{ explorable.HALF }} s each. An outlined bar is one second's surprise, its filled part what counts of it.
# All filled parts together are A of the first second, in which the car begins to fall back.
#
# **Drag** λ down from PPO's {{ settings_for('ppo').gae_lambda }}: where does falling back stop looking good?

# %%
explorable.later()

# %% [markdown]
# **See.** With {{ explorable.HALF }} s of each, falling back looks bad at λ = 0.8, but good at 0.85. What counts is the
# product γλ: with SAC's γ = {{ settings_for('sac').gamma }} it would look bad at every λ.
#
# Round 1's agent falls back for almost 30 s. Now drag the seconds: with 30 s, A is about 0 even at λ =
# {{ settings_for('ppo').gae_lambda }}, and within PPO's {{ ppo_kinds.settings_of('alone').horizon }} decisions it is
# −{{ -explorable.weighted(0.95, 30)[:32].sum() | .1f }}. So this V does not explain such long swings. *A guess*: short
# swings came first, and V learned to expect their pay.
# <!-- claim: abs(explorable.weighted(0.95, 30).sum()) < 0.1 and explorable.weighted(0.95, 30)[:32].sum() < -1.5 and
#   settings_for('ppo').gae_lambda == 0.95 and ppo_kinds.settings_of('alone').horizon == 32 -->
# <!-- claim: 26 <= np.argmax(ppo_speeds() >= 10) <= 31 -->
# <!-- claim: all(explorable.weighted(lam * settings_for('sac').gamma / settings_for('ppo').gamma).sum() < 0 for
#   lam in np.linspace(0, 1, 101)) -->
# <!-- claim: all(ppo_kinds.settings_of(kind).gae_lambda == settings_for('ppo').gae_lambda > 0 for
#   kind in ppo_kinds.KINDS) -->
# <!-- claim: [explorable.weighted(lam).sum() > 0 for lam in (0, 0.5, 0.8, 0.85, 0.95, 1)] ==
#   [False] * 3 + [True] * 3 -->
#
# **In symbols.** A surprise is the temporal difference
#
# $$ \delta_t = r_t + \gamma V(s_{t+1}) - V(s_t) $$
#
# and the advantage adds those that follow, each with less weight (GAE, *generalised advantage estimation*):
#
# $$ A_t = \delta_t + \gamma\lambda\, \delta_{t+1} + (\gamma\lambda)^2 \delta_{t+2} + \dots $$
#
# **Endings need care**. The data end, too, after {{ ppo_kinds.settings_of('alone').horizon }} decisions:
#
# | after decision t comes | `terminated` | `ended` | next V in δ | the sum |
# |---|---|---|---|---|
# | a decision | 0 | 0 | V of the next state | goes on |
# | an accident | 1 | 1 | 0 | stops |
# | the end of the time | 0 | 1 | V of the next state | stops |
# | the end of the data | 0 | 0 | V of the next state | stops: no row follows |
#
# In short: `terminated` sets the next V to 0, `ended` stops the sum. The end of the data has no mark of its own: there
# is no next row.
#
# **Exercise (15 min, ●●●).** Write the advantages, in torch.


# %%
def advantages(rewards, values, next_values, terminated, ended, gamma, lam):
    """A_t of each decision. The answer and all arguments but gamma and lam are (decisions, roads).

    values: V(s_t). next_values: V of the state after decision t, also after an accident: there,
    you set it to 0. For example, with V = 0 everywhere and γ = λ = ½, rewards 1, 2, 4 of one road
    give 1.75, 3, 4; with an accident in the middle (terminated = ended = 0, 1, 0) 1.5, 2, 4.
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
# ## Round 4: how far may one decision push?
#
# In each pass V is trained towards V_old + A: what V expected when these data were driven, and what came on top.
# The actor is trained with the loss below.
#
# Why a special loss? The decisions were driven by the policy π_old. After the first minibatch π is another
# policy, and the further it has moved, the less these decisions say about it. So each decision may move π only
# a little.
#
# The **ratio** $\rho = \pi(a|s) / \pi_\text{old}(a|s)$ says how much likelier an action has become since
# π_old took it. A good decision (A > 0) pushes ρ up, a bad one pushes it down, and
# ε = {{ 100 * settings_for('ppo').clip | .0f }} % limits how far.
#
# > **Predict.** An action turned out badly, A = −2, but has become likelier, ρ = 1.5. Does this
# > decision still change the policy?

# %%
choices = ["yes, it makes the action rarer", "yes, likelier", "no, it is clipped"]
predict("the_second_trap.4", "Does it still change the policy?", choices)

# %%
predicted("the_second_trap.4")
bc.show(figures.hinges(0.2))

# %% [markdown]
# **See.** Where the line is flat, the decision has no gradient. The clipped loss is
#
# $$ L = -\,\mathrm{mean}\big[\min(\rho A,\ \mathrm{clip}(\rho, 1 - ε, 1 + ε)\, A)\big] $$
#
# **Exercise (8 min, ●●○).** Write the loss.


# %%
def clipped_loss(ratio, advantage, clip):
    """The clipped loss, one number: ratio, advantage (batch,) tensors; clip: ε."""
    # solution
    clipped = ratio.clamp(1 - clip, 1 + clip)
    return -torch.minimum(ratio * advantage, clipped * advantage).mean()
    # end solution


check.clipped_loss(clipped_loss)

# %% [markdown] tags=["instructor"] minutes=7
# The endings are the hard part. Draw two rows, one that ends in an accident and one that runs out of time,
# and fill in δ and the sum for both. Then ask who thinks that clipping limits the policy. It only takes the
# payment away: other rows of the batch can push the policy further. The library also brings A to mean 0 and
# deviation 1 in each minibatch, before the loss.

# %% [markdown]
# ## Round 5: start as a clone
#
# The stochastic rule drives {{ settings_for('ppo_cloned').demonstration_episodes }} roads, and the actor is
# *cloned*: it learns the rule's own action in each state of these drives. Then PPO begins, without the rule.
# <!-- claim: ppo_escapes('alone') == 0 -->
# <!-- claim: settings_for('ppo_cloned').xi_multiplier == 0 ==
#   settings_for('ppo_cloned').beta_start -->
#
# > **Predict.** The clone gets out on some roads, but the rule's way out is worth less than sprints (Round 1).
# > What does PPO make of the clone?

# %%
choices = [
    "it learns to sprint behind trap 1",
    "it gets out, and earns what the rule earns",
    "it gets out, and earns far more",
]
predict("the_second_trap.5", "What does PPO make of the clone?", choices)

# %% [markdown]
# Train one with your parts:

# %% tags=["nbval-ignore-output"]
predicted("the_second_trap.5")
settings = ppo_kinds.settings_of("cloned")
training = own_code.training([settings], episodes=100_000)  # ended by the decisions below
clone = ppo_kinds.driven(training.agent(0).as_policy())
yours = ppo_kinds.train(training, decisions=150_000).agent
bc.show(figures.plane(clone, ppo_kinds.driven(yours.as_policy())))

# %% [markdown]
# **See.** The arrow is your training. The ten agents that ship were trained twice as long: all escape, and
# they earn over twice what sprinting earns. But they crash in
# {{ 100 * ppo('cloned')['accident'].mean() | .1f }} % of their drives, PPO alone in none.
# <!-- claim: (ppo('alone')['accident'] == 0).all() -->
# <!-- claim: all(ppo_speeds(seed=i).max() > 14 and ppo_speeds(seed=i).min() < 4 for i in range(ppo_agents())) -->
# <!-- claim: ppo_kinds.KINDS['cloned'].decisions == 2 * 150_000 -->
# <!-- claim: ppo('cloned')['returns'].mean() > 2 * ppo('alone')['returns'].mean() and
#   discounted(ppo_drive('cloned'), settings_for('ppo').gamma) > 2 * discounted(ppo_drive(),
#   settings_for('ppo').gamma) -->
# <!-- claim: ppo_escapes('cloned') == ppo_agents() and 1.8 < ppo('cloned')['returns'].mean() /
#   of('rule').scores('returns')[0] < 2.4 -->
# <!-- claim: ppo('cloned')['accident'].mean() > 0 -->
#
# **Why does PPO get out after cloning, and not alone?** After cloning, at every point of training
# {{ 100 * ppo('cloned')['escapes'].min() | .0f }} % or more of an agent's drives get ahead. Alone this was
# rare, and soon gone (Round 2). *A guess*: PPO learns only from what its own drives do, so it can improve a
# way out only while some of them take it. The guess predicts that more decisions alone do not help. Ten other agents
# of PPO alone, with settings from a search, fit it: 0 of 10 escape after 200,000 decisions, and 0 after 800,000
# (*What these claims survived*).
# <!-- claim: all((shipped_experiment('beyond')[cell].measured[f'success_{n}'] < ESCAPES).all() for cell in
#   ('ppo-0', 'ppo-5') for n in (200_000, 800_000)) -->
# <!-- claim: ppo('cloned')['escapes'].min() > 0.3 > 3 * ppo('alone')['escapes'].max() -->

# %% [markdown] tags=["instructor"] minutes=3
# Ask which of the course's figures would have looked the same for the second trap: those that show returns.
# Then ask for one sentence for an abstract about PPO alone that is true, and does not mislead.

# %%
compare_predictions(
    "the_second_trap",
    {
        1: how[3],
        2: "almost four times as much",
        3: "it gives up leaving, and then earns more than keeping straight",
        4: "yes, it makes the action rarer",
        5: choices[2],
    },
)

# %% [markdown]
# ## What you now know
#
# 1. Ten agents of PPO alone earn twice what keeping straight earns, and none gets out. Look at success, and at a
#    drive. Judged by four drives, a smaller γ trades this trap for the first.
# 2. Where a reward is convex, a changing speed can earn more than a steady one.
# 3. After cloning the rule, all ten escape, and crash in {{ 100 * ppo('cloned')['accident'].mean() | .1f }} % of
#    their drives; alone they crash in none.
#
# **Three questions to think about**
# - Which number, other than success, would have shown the second trap?
# - Could cloning `racer` or `timid` of lesson [[your_teacher]] work as well?
# - Which experiment could refute Round 5's guess?

# %% [markdown] tags=["instructor"] minutes=3
# Answers to the three questions. (1) The largest speed beside the mean speed: it shows the sprints. Or one
# drive that is looked at. The return does not show it. (2) The racer leads past the traps and crashes later,
# as a clone of the quarter-random teacher does: try it. From `timid` {{ cloned_escape('timid') }} of ten
# escape. (3) Let PPO alone train on roads where some drives are already in the free lane, or have room on the
# left at once. If it stays behind trap 1 all the same, too few ways out are not the whole reason. Then ask what
# the drives that get ahead earn: while most of them crash, leaving need not pay. A *shaping reward*
# γ Φ(s') − Φ(s), with a *potential* Φ of {{ second_trap.PER_LANE | .0f }} for each lane to the left and 0 after
# an accident, leaves the best policy as it is (Ng, Harada and Russell 1999), but of ten agents trained so
# {{ ppo_escapes('shaped') }} escape.
# <!-- claim: len(ppo('shaped')['success']) == 10 and second_trap.shaping_reward(20.0, 40.0, True, 0.99) == -20 -->

# %% [markdown]
# **Read on**: Schulman et al., *Proximal Policy Optimization Algorithms* (arXiv 1707.06347) and
# *High-Dimensional Continuous Control Using Generalized Advantage Estimation* (arXiv 1506.02438).
#
# Next: [looking ahead](looking_ahead.ipynb).

# %% [markdown] tags=["instructor"]
# **On the board.** r_v against v with a chord from 5 to 15 m/s; below it the speed of an agent that lives on
# the difference.
#
# **To discuss.** You read only a table of returns. Which number beside it would have shown that the agent is
# in a trap?
