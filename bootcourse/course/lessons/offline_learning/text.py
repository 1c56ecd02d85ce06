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
# # Offline learning
#
# **What you will be able to do**
# - write CQL's loss, and say what its term bounds, and from which side;
# - tell two methods apart that are both called CQL;
# - say how far a method is from what is possible, by a planner's bound.
#
# **Time** 60 minutes; running it takes about one minute. **It builds on** demonstrations (lesson
# [[demonstrations]]) and imitation ([[imitation]]).

# %%
import bootcourse as bc
import numpy as np
import torch
from bootcourse.colours import OTHER
from bootcourse.course import (
    charts,
    check,
    compare_predictions,
    own_code,
    predict,
    predicted,
    progress,
    shipped,
    table,
)
from bootcourse.course.lessons.imitation import figures as figures_baselines
from bootcourse.course.lessons.imitation.reachable_entropy import by_entropy
from bootcourse.course.lessons.offline_learning import figures
from bootcourse.research import paper, report, tables

progress("offline_learning")

# %% [markdown]
# ## Look first
#
# Two agents drive on the same road. Both learned from the same {{ SETTINGS.demonstration_episodes
# }} drives of the rule, without driving themselves, and both are called **CQL**, *conservative
# Q-learning*. The first follows its critic; the second, *CQL with an actor*, has an actor, as SAC
# has. Press play.

# %% tags=["nbval-ignore-output"]
road, pupils = bc.shipped_drive("escape").seed, {}
for method in ("cql", "cql_sac"):
    agent = bc.shipped_agents(method)[0]
    pupils[method] = bc.record(agent.as_policy(), [road], label=method)[0]
bc.recording([shipped.beginning(drive, 30) for drive in pupils.values()], height=360)

# %% [markdown] tags=["instructor"] minutes=4
# Ask what an agent can learn that never drives, and what it cannot find out. Collect what people
# believe about untried actions before round 1 asks.

# %% tags=["hide-input"]
rows = []
for method, drive in pupils.items():
    end, earned = bc.words.outcome(drive), f"{drive.rewards.sum():.1f}"
    rows.append([bc.display_name(method), end, earned])
table(["", "in the end", "return"], rows)

# %% [markdown]
# The paper prints a row for CQL. Divide its distance by its speed:

# %%
# NBVAL_CHECK_OUTPUT
print(paper.arithmetic("cql"))

# %% [markdown]
# The paper's CQL drives like a car that does nothing. The paper's explanation is too little
# exploration. But an offline learner does not explore at all, and it need not: by the paper's own
# words, each of its demonstrations gets out. All ten of *our* CQL agents escape (lesson
# [[imitation]]). So **the question** is: why does a critic that never drives take the way out,
# and what may have been different in the paper's CQL?
# <!-- claim: escaped('cql') == len(of('cql')) -->

# %% [markdown]
# ## Round 1: what is an action worth that nobody tried?
#
# Q-learning asks of each next state: what is the best action worth? Offline, the action with the
# highest Q may be one that is missing from the data, so its value is a guess. An agent that drives
# would try it and see what it pays. An offline agent keeps its guess. CQL adds a term to the
# critic's loss, the mean over the batch of
#
# $$ \log \sum_a e^{Q(s,a)} - Q(s, a_\text{data}) $$
#
# The first part is a soft maximum: at least the highest Q of the nine, and at most log 9 ≈ 2.2
# above it. Its gradient in each Q(s, a) is softmax(Q): it pushes all nine down, the highest most.
# The second is the Q of the action that the data hold, and is pulled up.
#
# **Exercise (6 min, ●●○).** Write it, in torch.


# %%
def conservative_loss(q, actions):
    """CQL's term, one number: q (batch, 9), the data's actions (batch,) whole numbers, tensors."""
    # solution
    chosen = q.gather(-1, actions.unsqueeze(-1)).squeeze(-1)
    return (q.logsumexp(-1) - chosen).mean()
    # end solution


check.conservative_loss(conservative_loss)

# %% [markdown]
# Why is that *conservative*? Take one state. The data hold each action a with a positive share
# $\hat\pi(a)$, the *policy of the data*, so a mean over the data counts a with that weight. Its
# target y(a) is given. The loss is the mean of (Q − y)² over the data, plus w times the term. Which
# Q makes it smallest?
#
# <details><summary>The answer</summary>
#
# With $\pi = \mathrm{softmax}(Q)$, the derivative of the loss with respect to Q(a) is 0 where
#
# $$ 2 \hat\pi(a) \big(Q(a) - y(a)\big) + w \big(\pi(a) - \hat\pi(a)\big) = 0,
# \qquad\text{so}\qquad Q(a) = y(a) - \frac{w}{2} \Big(\frac{\pi(a)}{\hat\pi(a)} - 1\Big). $$
#
# An action that π prefers more than the data do is valued below its target, one that π prefers less
# above it. Weigh the bracket by π: its mean is $\sum_a (\pi - \hat\pi)^2 / \hat\pi$, which
# is 0 or more. So the *value of the policy*, Σ π Q, is at most Σ π y. The bound holds for the
# policy's value, and not for each Q(a).
#
# </details>

# %%
# NBVAL_CHECK_OUTPUT
data, y, w = torch.tensor([0.8, 0.15, 0.05]), torch.tensor([1.0, 1.2, 3.0]), 1.0
q = torch.zeros(3, requires_grad=True)
for _ in range(20_000):
    terms = [bc.sac.conservative_loss(q[None], torch.tensor([action])) for action in range(3)]
    loss = (data * (q - y) ** 2).sum() + w * (data * torch.stack(terms)).sum()
    q = (q - 0.05 * torch.autograd.grad(loss, q)[0]).detach().requires_grad_()
pi = q.softmax(0).detach()
cells = [[f"{x:.2f}" for x in values] for values in (data, y, q.detach(), pi)]
names = ("share in the data, π̂", "target, y", "conservative Q", "π = softmax(Q)")
below = (
    f"Value of π: {(pi * y).sum():.2f} by the targets, {(pi * q).sum():.2f} by the conservative Q."
)
table(["", *"abc"], [[n, *row] for n, row in zip(names, cells, strict=True)], below=below)

# %% [markdown]
# Action c is rare in the data, and its target looks best. That may be true, or luck. The
# conservative Q of c lies far below its target, and the highest Q is that of a, which the data hold
# most often.
#
# <details><summary>Two limits of the formula</summary>
#
# An action that the data do not hold has π̂ = 0, and for it the formula gives no smallest Q: the
# term pushes it down at each update, ever more weakly, since the push is w π(a). The rule's drives
# hold one action in a state, so this happens to the eight others. Watch it in the figure below.
#
# And the bound is for the policy softmax(Q), against the *targets*, which contain values of Q
# themselves. The action with the highest Q can lie *above* its target: look at action a.
#
# </details>
#
# The bound is for softmax(Q), and our agent takes the action with the highest Q, which is another
# policy. Whether the critic is careful for that agent has to be measured, and will be.
#
# **Exercise (20 min, ●●●).** Write the whole loss that trains CQL's critic, from a batch of
# the data. The target is that of *double* Q-learning: the critic itself chooses the next action,
# and a slower copy of it, the target critic, says what that action is worth. Which part must have
# no gradient? What comes after an accident?


# %%
def offline_loss(q, next_q, next_target, actions, rewards, terminated, gamma, weight):
    """(Q(s,a) − y)² plus weight times CQL's term, a mean over the batch.

    q: the critic at s, (batch, 9); next_q, next_target: critic and target critic at s', (batch, 9).
    actions (batch,) whole numbers; rewards, terminated (batch,); gamma, weight: floats.
    """
    # solution: the exercise's own


check.offline_loss(offline_loss)

# %% [markdown]
# Now train six learners side by side: two with the term, two without, and two with the term whose
# rewards are set to 0. They learn with your `offline_loss` if it has passed its check. We ask the
# critics about the first 20 seconds of the rule's drives, the way out. What is the rule's action
# worth, and what is the best of the other eight worth, the *best untried action*?
#
# > **Predict.** Take the two learners *without* the term, which is Q-learning on the 200 drives,
# > offline. How will they value the best untried action?

# %%
choices = ["lower than the rule's action", "about as high", "higher than the rule's action"]
predict("offline_learning.1", "How does Q-learning value the best untried action?", choices)

# %%
torch.set_num_threads(1)  # small matrices are faster on one thread
SEEDS, UPDATES = 2, 3000
with_term = bc.with_seeds(bc.settings_for("cql"), SEEDS)
without = bc.with_seeds(bc.settings_for("cql", cql_weight=0.0), SEEDS)
by_rule = bc.record(bc.rule_policy(bc.DEFAULT), range(20), label="rule")
way = np.concatenate([drive.observations[:20] for drive in by_rule])
did = np.concatenate([drive.actions[:20] for drive in by_rule])

# %%
predicted("offline_learning.1")
training = own_code.training(with_term + without + with_term)
learner, replay = training.learner, training.replay  # which holds 200 drives of the rule
paid = torch.tensor([1.0] * (2 * SEEDS) + [0] * SEEDS)[:, None]  # the last hear of no rewards
generators = [np.random.default_rng(s.seed) for s in learner.settings]
asked, found = range(0, UPDATES + 1, 200), []
for update in range(UPDATES + 1):
    if update:
        batch = replay.sample(64, np.ones(3 * SEEDS), generators)  # only demonstrations
        learner.update(batch._replace(rewards=paid * batch.rewards))
    if update in asked:
        found.append(figures_baselines.believed(figures_baselines.agents_of(learner), way, did))

# %%
mine, rival = np.array(found).transpose(1, 2, 0)
plain = slice(SEEDS, 2 * SEEDS)
named = {"with: the rule's": mine[:SEEDS], "with: best other": rival[:SEEDS]}
named |= {"without: the rule's": mine[plain], "without: best other": rival[plain]}
looks = [charts.Style(c, line) for c in ("#999933", OTHER.colour) for line in ("-", "--")]
more = [(rival - mine)[agents, -1].mean() for agents in (plain, slice(SEEDS))]  # of both seeds
likes = ["an untried action" if each > 0 else "the rule's" for each in more]
title = f"Without CQL's term the critic prefers {likes[0]}; with it, {likes[1]}"
gamma = learner.settings[0].gamma
most, weights = paper.earned_at(15, 1) / (1 - gamma), gamma ** np.arange(150)
earned = np.mean([d.rewards[t:] @ weights[: 150 - t] for d in by_rule for t in range(20)])
words = {f"no drive is worth more than {most:.1f}": most, f"the rule earns {earned:.1f}": earned}
label = "mean Q(s,a) on the way out, of the rule's action and of the best other"
bc.show(charts.lines(asked, named, title, "update", label, marks=words, looks=looks))

# %%
agents, rows = figures_baselines.agents_of(learner), []
kinds_of = ["with the term"] * SEEDS + ["without"] * SEEDS + ["with it, no rewards"] * SEEDS
for words, agent in zip(kinds_of, agents, strict=True):
    r = bc.evaluate(agent.as_policy(), 200, seed=10)
    kinds = [r.success, r.collision, r.road_departure, r.stoppage]
    cells = [f"{100 * kind.value:.0f}" for kind in kinds]
    rows.append([f"{words}, seed {agent.settings.seed}", *cells, f"{r.returns.value:.1f}"])
headings = ["200 roads", "success, %", "collisions, %", "road departures, %", "stops, %", "return"]
table(headings, rows)

# %%
rows = []
for words, agent in zip(kinds_of[: 2 * SEEDS], agents, strict=False):
    promised, paid = [], []
    for drive in bc.record(agent.as_policy(with_q=True), range(20)):
        seconds = np.arange(min(20, len(drive.actions)))
        promised.append(drive.q_values[seconds, drive.actions[seconds]].mean())
        weights = gamma ** np.arange(len(drive.rewards))
        to_go = [drive.rewards[t:] @ weights[: len(weights) - t] for t in seconds]
        paid.append(np.mean(to_go))
    cells = [f"{np.mean(values):.2f}" for values in (promised, paid)]
    rows.append([f"{words}, seed {agent.settings.seed}", *cells])
headings = ["own drives, first 20 s", "Q of the action taken", "what it then earned, discounted"]
table(headings, rows)

# %% [markdown]
# **See.** (These six were trained on your machine: your numbers will differ from ours.) Without the
# term Q-learning values the best untried action highest, and promises far more than it then earns:
# each target contains a guess that was chosen because it is high, and the guesses raise each other.
# (The figure asks about the rule's states, the last table where the agents drive.) With the term
# both agents promise less than they earn. Data, network and number of updates are the same: in
# these four agents one term makes the difference.
#
# **Explain.** What does the term do to the car? Compare it with the cloning loss of lesson
# [[demonstrations]]:

# %%
# NBVAL_CHECK_OUTPUT
q = torch.tensor([[0.2, 1.1, 0.3, 0.6, 0.9, 0.4, 0.5, 1.4, 0.1]])
rows = []
for action in (1, 7, 8):
    taken = torch.tensor([action])
    pair = (bc.sac.conservative_loss(q, taken), torch.nn.functional.cross_entropy(q, taken))
    rows.append([action, *(f"{each:.4f}" for each in pair)])
table(["action in the data", "CQL's term", "cloning loss of softmax(Q)"], rows)

# %% [markdown]
# The term *is* the cloning loss of softmax(Q). So **CQL is Q-learning and cloning in one.** In one
# state the data hold one action. But states that look alike to the network hold several, and
# between them the rewards can decide. Look at the two agents whose rewards are 0: at γ =
# {{ settings_for('cql').gamma }} the rewards do not speak for the way out at its *start*, where the
# rule's drive is worth less than staying (lesson [[the_barrier]]); later in the drive they do. How
# far does cloning alone take them?
# <!-- claim: discounted(by_rule(), 0.8) < discounted(idle(), 0.8) and settings_for('cql').gamma ==
#   0.8 -->

# %% [markdown] tags=["instructor"] minutes=12
# Let each group say in one sentence what the term does to an action that is missing from the data,
# to one that is there, and to the car. Who says "it makes Q a lower bound"? Ask: of which policy,
# and against what.

# %% [markdown]
# ## Round 2: what the rewards add, and what an actor changes
#
# > **Predict.** The clone learns from the rule's actions, CQL from their rewards, too. Where the
# > rule brakes, which of the two brakes more often?

# %%
choices = ["the clone", "CQL", "both equally often"]
predict("offline_learning.2", "Where the rule brakes, who brakes more often?", choices)

# %% tags=["hide-input"]
predicted("offline_learning.2")
groups = {bc.display_name(m): bc.shipped_agents(m) for m in ("bc", "cql")}
groups |= {"just trained, with rewards": agents[:SEEDS], "without rewards": agents[-SEEDS:]}
headings, rows = figures_baselines.followers(groups, bc.held_out_seeds(11, 24))
table(headings, rows)

# %% [markdown]
# **See.** The clones brake nearly always where the rule does, and do about half of its
# accelerations (24 drives of each agent). CQL's agents leave out a good part of the braking and do
# most of the accelerations. Do they learn that from the rewards? Compare the last two rows (yours
# will differ): if the agents without rewards brake more, that speaks for the rewards as the cause;
# two seeds cannot show it. (**Try** `SEEDS = 5` above.)
#
# There is also more than one CQL. This one is a critic alone: the agent takes the action with the
# highest Q. You can also put the same term on the critics of SAC and keep the actor. Both are
# called CQL in papers. The study has ten agents of both.
#
# > **Predict.** You saw one agent with an actor stay behind trap 1. Of ten such agents, how many
# > escape?

# %%
of_ten = ["none", "1 to 5", "6 or more"]
predict("offline_learning.3", "How many of ten agents of CQL with an actor escape?", of_ten)

# %%
predicted("offline_learning.3")
study, rows = bc.shipped_results(), []
for method in ("cql", "cql_sac"):
    its, success = study.of(method), study.of(method).scores("success")
    count = f"{(success >= bc.statistics.ESCAPES).sum()} of {len(success)}"
    each = ", ".join(f"{r:.0f}" for r in np.sort(its.scores("returns")))
    rows.append([bc.display_name(method), count, f"{its.episodes('speed').mean():.1f} m/s", each])
table(["", "agents that escape", "mean speed", "returns of the agents, sorted"], rows)

# %% [markdown]
# **See.** No agent of the second kind escapes. Six of the ten stay behind trap 1 at the traps'
# speed, as the paper's CQL does. The other four have an accident in all of their drives.
# <!-- claim: escaped('cql_sac') == 0 and np.allclose(np.sort(of('cql_sac').scores('returns'))[4:],
#   idle().rewards.sum(), atol=1) and (of('cql_sac').scores('accident') == 1).sum() == 4 -->
#
# **Explain.** So the paper's CQL may have had an actor: a strong suspect, not a proof. Two more
# suspects are cleared: behind faster traps, and with the setting of lesson
# [[found_and_kept]], CQL without an actor escapes as well (at least {{ min(escaped('cql', s) for s
# in ('calibrated', 'paper')) }} of ten agents each).
# <!-- claim: min(escaped('cql', s) for s in ('calibrated', 'paper')) >= 9 -->
#
# Why does the actor make this difference? One idea is that α falls too early, so that the actor
# settles on one action before the critic knows which: all ten have the paper's target entropy, η =
# {{ settings_for('cql_sac').target_entropy | g }} nat, which nine actions cannot reach (lesson
# [[discrete_sac]]). So ten more were trained for {{ UPDATES | , }} updates, five with η = −1, and
# five, with the same seeds, with η = 0.3 log 9:

# %% tags=["hide-input"]
rows = []
for eta, its in by_entropy(shipped.shipped_experiment("reachable-entropy")["cql_sac"]).items():
    ahead = ", ".join(f"{100 * share:.0f}" for share in np.sort(its.scores("success")))
    each = ", ".join(f"{earned:.0f}" for earned in np.sort(its.scores("returns")))
    rows.append([f"{eta:.2f}", tables.escaped(its, "cql_sac"), ahead, each])
headings = ["η, nat", "agents that escape", "success of the five agents, %", "their returns"]
table(headings, rows)

# %% [markdown]
# **See.** The target entropy is not the whole reason. With the reachable η the agents no longer
# settle on keeping straight, but only one of the five takes the way out: three brake to a stop in
# all of their test drives, and one leaves the road in nearly all. Five agents each do not show that
# η changes how many escape. So why the actor makes the difference stays open.
# <!-- claim: with_entropy(-1.0).escapers('cql_sac') == 0 and
#   with_entropy(REACHABLE).escapers('cql_sac') == 1 -->
# <!-- claim: (with_entropy(REACHABLE).scores('stoppage') == 1).sum() == 3 and
#   (with_entropy(REACHABLE).scores('road_departure') > 0.9).sum() == 1 -->

# %% [markdown] tags=["instructor"] minutes=5
# Ask who expected offline Q-learning to do *something* sensible with {{
# SETTINGS.demonstration_episodes }} good drives. A question for the fast: what does the term's
# weight do at both ends? (0 is Q-learning, a very large one is a clone. Let them try
# `settings_for("cql", cql_weight=5.0)`.)

# %% [markdown]
# ## Round 3: how far from what is possible?
#
# As a yardstick take the planner, which tries actions in a copy of the road, other cars included.
# On each of the {{ roads() | , }} roads we know the best return that it found, the **bound**. An
# agent's *share of the bound* is its mean return on these roads, divided by the planner's.
#
# > **Predict.** The rule, CQL's teacher, earns {{ of('rule').scores('returns')[0] | .0f }} in a
# > drive of 150 s, and a second pays at most about 1. Which share of the bound does it earn?

# %%
predict("offline_learning.4", "Which share of the bound does the rule earn?", unit="%")

# %%
predicted("offline_learning.4")
rule = report.rule_results(bc.DEFAULT, study.tested["returns"].shape[1])
bound = shipped.shipped_bound()
print(f"the planner's return: {bound.mean():.1f}, from {bound.min():.1f} to {bound.max():.1f}")
rows, compared = [], ("bc", "cql", "gail", "sac", "bootstrapped")
for method in compared:
    returns = study.of(method).scores("returns")
    above = returns > rule.scores("returns")[0]
    share = bc.statistics.interval(100 * returns / bound.mean(), np.mean)
    typical = "{:.0f} [{:.0f}, {:.0f}]".format(*share)
    rows.append([bc.display_name(method), typical, f"{above.sum()} of {len(above)}"])
table(["", "share of the bound, mean of ten agents, % [95 %]", "agents above the rule"], rows)

# %%
marks = {"doing nothing": paper.earned_at(10), "the rule": rule.scores("returns")[0]}
marks = {words: 100 * earned / bound.mean() for words, earned in marks.items()}
near = (study.of("bootstrapped").scores("returns") > 0.8 * bound.mean()).sum()
title = f"CQL stays near its teacher; {near} of 10 bootstrapped agents come near the bound"
bc.show(figures.shares_of_the_bound(study, compared, bound, marks | {"the planner": 100.0}, title))

# %% [markdown]
# **See.** Ten clones earn nearly the same, and so do ten CQL agents: one agent of each could not
# show that. GAIL's and the bootstrapped agents differ much more.
# <!-- claim: max(np.ptp(of(m).scores('returns')) for m in ('bc', 'cql')) < 6 -->
# <!-- claim: min(np.ptp(of(m).scores('returns')) for m in ('gail', 'bootstrapped')) > 30 -->
# <!-- claim: (of('bootstrapped').scores('returns') > 1.5 *
#   of('cql').scores('returns').max()).mean() > 0.5 and of('bootstrapped').scores('collision').max()
#   > 0.9 -->
#
# **Explain.** CQL earns a little more than its teacher, which is slow by our choice of its sight
# (lesson [[the_rule]]), and no more: it may use the rewards, but its term lowers the value of
# whatever was not demonstrated. None of the ten clones earns more than the rule. The bootstrapped
# agents also try other actions. Most of them come much nearer to the bound, and some crash.
# <!-- claim: of('bc').scores('returns').max() < of('rule').scores('returns')[0] -->
# <!-- claim: of('cql').scores('returns').min() > of('rule').scores('returns')[0] -->
# <!-- claim: of('cql').scores('returns').max() < bound().mean() / 2 -->
#
# <details><summary>What 0 and 100 % mean</summary>
#
# Mind the zero of the scale. A share of 0 is a return of 0, less than doing nothing earns; an agent
# that crashes at once has a negative share. And 100 % is what the planner found, not the most that
# is possible. The planner sees the future and an agent does not, so we expect agents to stay below
# 100 %, and all agents of this study do.
#
# </details>
#
# <!-- claim: 0 / bound().mean() == 0 < idle().rewards.sum() -->
# <!-- claim: 100 * max(shipped_results().scores('returns')) / bound().mean() < 100 -->

# %% [markdown] tags=["instructor"] minutes=9
# Collect the guesses of the share before the table, and let them name what the rule loses on the
# way to the bound. Then have them write the one sentence about baselines that they would put into
# the paper's abstract, given our table, and let their neighbours cross out what ten seeds do not
# show.

# %%
agree = [
    figures_baselines.as_the_rule_would(
        [
            d
            for a in bc.shipped_agents(m)
            for d in bc.record(a.as_policy(), bc.held_out_seeds(11, 24))
        ]
    )[1]
    for m in ("bc", "cql")
]
more = "higher" if rival[plain, -1].mean() > mine[plain, -1].mean() else "lower"
compare_predictions(
    "offline_learning",
    {
        1: f"{more} than the rule's action",
        2: "the clone" if agree[0] > agree[1] else "CQL",
        3: "none",
        4: round(100 * rule.scores("returns")[0] / bound.mean()),
    },
)

# %% [markdown]
# ## What you now know
#
# 1. CQL's term is the cloning loss of softmax(Q). Ten of our ten CQL agents take the way out and
#    earn a little more than their teacher.
# <!-- claim: len(of('cql')) == escaped('cql') == 10 and of('cql').scores('returns').min() >
#   of('rule').scores('returns')[0] -->
# 2. Without the term, offline Q-learning trusts guesses about actions that the data do not hold,
#    and promises far more than it earns. With it, our agents promised less than they
#    earned.
# 3. Two methods have the name CQL. Of one, ten of our ten agents escape, and of the other none; a
#    target entropy that can be reached freed one of five.
# <!-- claim: with_entropy(REACHABLE).escapers('cql_sac') == 1 -->
# <!-- claim: escaped('cql') == len(of('cql')) == 10 and escaped('cql_sac') == 0 -->
# 4. A bound gives returns a scale. It is what a planner found, not the most that is possible.
# 5. Before you believe a baseline, ask how it was trained, and which of the methods with its name
#    it was.
#
# **Three questions to think about**
# - You may write one letter to the authors of a paper whose baseline drives like an idle car. Which
#   three things do you ask for?
# - What would CQL learn from 200 drives of a bootstrapped agent, accidents included?
# - CQL's bound holds for the value of softmax(Q). Why is a bound on each Q(a) not needed for that?

# %% [markdown] tags=["instructor"] minutes=4
# Answers to the three questions. (1) The learner's code or its settings in full (which CQL, which
# weight, how many updates); the number of training seeds, with the result of each; a drive of the
# baseline, or its curve, that shows that it learned something. (2) The frequent actions of those
# drives, and where good and bad drives pass through the same states, the better ones: CQL uses the
# rewards, −10 for each accident included. The rule's drives could not tell it what an accident
# costs; these can. (3) The agent follows the policy, so what it will earn is the policy's value. An
# action whose Q is too high does not matter as long as the policy does not take it. An action that
# the policy takes more often than the data do is pushed below its target.

# %% [markdown]
# **Read on**: Kumar et al., *Conservative Q-Learning for Offline Reinforcement Learning* (arXiv
# 2006.04779); Kumar et al., *When Should We Prefer Offline Reinforcement Learning Over Behavioral
# Cloning?* (arXiv 2204.05618). Next: [the bug hunt](bug_hunt.ipynb).
