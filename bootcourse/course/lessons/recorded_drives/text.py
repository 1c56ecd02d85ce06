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
# # Learning from recorded drives
#
# **What you will be able to do**
# - say what a clone, CQL and GAIL each learn from the same drives;
# - write CQL's loss (and, *Further*, GAIL's reward);
# - say when to believe an estimate from recorded drives.
#
# **Time** 50 minutes, 10 of them voluntary (*Further*). **It builds
# on** lessons [[update_and_loop]], [[demonstrations]] and [[how_many_seeds]].

# %%
import bootcourse as bc
import numpy as np
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
from bootcourse.course.lessons.recorded_drives import choosing, eight_seeds, figures

progress("recorded_drives")

# %% [markdown]
# ## Look first
#
# Three agents learned from the same {{ SETTINGS.demonstration_episodes }} drives of the rule: GAIL
# (*generative adversarial imitation learning*), a clone (BC, behaviour cloning) and CQL (*conservative
# Q-learning*). Which of the three would you let drive? Watch until second 30.

# %% tags=["nbval-ignore-output"]
bc.recording(figures.three_drives(), height=480)

# %% [markdown]
# All get ahead of trap 1. GAIL's car then leaves the road; we chose this road for it.

# %% [markdown] tags=["instructor"] minutes=2
# Let people say which of the three copies the rule and which only looks as if. Ask what each was told, and
# what it had to find out.

# %% [markdown]
# ## Round 1: three agents of one teacher
#
# | | is told the rewards | drives while it learns |
# |---|:---:|:---:|
# | BC | no | no |
# | CQL | yes | no |
# | GAIL | no | yes |
# <!-- claim: [of(m).agents[0]['beta_start'] for m in ('bc', 'cql')] == [1, 1] and 0 <
#   of('gail').agents[0]['beta_start'] < 1 -->
#
# BC and CQL learn **offline**: recorded drives are all they have. CQL learns Q and takes the action whose Q
# is highest. GAIL is paid by a second network: the more GAIL's decision looks like the rule's, the more it pays.
#
# > **Predict.** We trained ten agents of each. The rule's return on the held-out roads is
# > {{ of('rule').scores('returns').mean() | .0f }}. Which of the three earn more?
# <!-- claim: [len(of(m)) for m in ('bc', 'cql', 'gail')] == [10, 10, 10] -->

# %%
choices = ["none", "CQL", "CQL and GAIL", "all three"]
predict("recorded_drives.1", "Which of the three earn more than the rule?", choices)

# %%
predicted("recorded_drives.1")
study = bc.shipped_results()
bc.show(figures.returns(study))

# %% [markdown]
# **See.** *Each CQL agent earns more than its teacher*, each clone a little less, and GAIL's agents much less
# on average. In the recorded seconds CQL's agents would accelerate more often than the rule did, clones less often.
# <!-- claim: min(accelerating('cql')) > did() > max(accelerating('bc')) and of('cql').scores('speed').min() >
#   of('rule').scores('speed').mean() > of('bc').scores('speed').max() -->
# <!-- claim: escaped('cql') == len(of('cql')) == 10 and of('cql').scores('returns').min() >
#   of('rule').scores('returns').max() -->
# <!-- claim: escaped('bc') == len(of('bc')) == 10 and of('bc').scores('returns').max() <
#   of('rule').scores('returns').min() and of('bc').scores('returns').min() > 0.8 *
#   of('rule').scores('returns').max() -->
# <!-- claim: of('gail').scores('returns').mean() < 0.7 * of('rule').scores('returns').mean() -->
#
# One of GAIL's agents *escapes* (lesson [[how_many_seeds]]), and leaves the road in
# {{ 100 * accidents_of_escapers().max() | .0f }} % of its drives: *a success rate that counts who is ahead hides
# later accidents.*
#
# The paper prints a success of 0 % for CQL and for GAIL. Here ten and six of ten escape. (One suspect: CQL with an
# actor, as SAC has one, is called CQL, too. Of {{ len(of('cql_sac')) }} such agents none escapes.)
# <!-- claim: escaped('cql_sac') == 0 -->
# <!-- claim: PRINTED['cql']['success'].mean == PRINTED['gail']['success'].mean == 0 and escaped('gail') == 6 -->
# <!-- claim: (accidents_of_escapers() > 0.5).sum() == 1 and escaped('gail') > 0 -->

# %% [markdown] tags=["instructor"] minutes=3
# Collect the votes before the picture. The class will be tempted to conclude that the paper is wrong. The picture
# shows less: "CQL stays in the trap" is not true of CQL as such. Of our ten agents of CQL *with an actor*, as SAC has
# one, none escapes: one may ask the authors which of the two they trained, and for how long. Is it fair to train all
# methods for as many episodes, updates or seconds, or until each stops improving? It depends on what the table is
# for, but a paper has to say which it took.
# <!-- claim: PRINTED['cql']['success'].mean == 0 == escaped('cql_sac') and len(of('cql_sac')) == 10 -->

# %% [markdown]
# ## Round 2: Q-learning without driving
#
# Two new agents learn Q from the recorded drives alone. Their target is r + γ Q(s', a'), where a' is the action with
# the *highest* Q at s'. Then they drive, and again take the action whose Q is highest. A recorded second shows what
# *one* of nine actions led to, and none of the {{ len(choosing.recorded().actions) | , }} ends in an accident.
# <!-- claim: not choosing.recorded().terminated.numpy().any() -->
#
# > **Predict.** What will the two do?

# %%
ends = ["earn more than the rule", "drive as the rule does", "stay behind trap 1", "crash"]
predict("recorded_drives.2", "What will the two do?", ends)

# %%
predicted("recorded_drives.2")
torch.set_num_threads(1)  # small matrices are faster on one thread


def learn(training):
    """Two agents, 1,000 updates from 200 drives of the rule: nobody drives."""
    generators = [np.random.default_rng(each.seed) for each in training.settings]
    for _ in range(1000):
        training.learner.update(training.replay.sample(64, np.ones(2), generators))
    return training.learner


without = learn(bc.Training(bc.with_seeds(bc.settings_for("cql", cql_weight=0.0), 2)))
bc.show(figures.would_do({"Q-learning": without}))

# %% [markdown]
# **See.** *Both crash on every road.* They would accelerate in nearly every recorded second; the rule did in
# {{ 100 * did() | .0f }} %. At the start of a drive their Q *promises* a gain; what they *earn* from there,
# discounted, is a loss.
# <!-- claim: min(eight("Q-learning", "accelerate")) > 0.9 and
#   set(eight("Q-learning", "crashes")) == {100} -->
# <!-- claim: all(0 < promise < -worth for promise, worth in
#   zip(eight("Q-learning", "promises"), eight("Q-learning", "worth"))) -->
#
# The *highest* of nine Q is used twice: in the target, and when the agent chooses. Which of the two is to blame?
# Now a' in the *target* is what the rule did at s', which was recorded. The choice stays.
# <!-- claim: bool((choosing.recorded().rule_actions == choosing.recorded().actions).all()) -->

# %%
rules_next = learn(eight_seeds.training_of(eight_seeds.RULES_NEXT, seeds=2))
bc.show(figures.would_do({figures.IN_TARGET: rules_next}))

# %% [markdown]
# **See.** *They crash on every road, too: the choice alone leads there.*
# <!-- claim: set(eight(eight_seeds.RULES_NEXT, "crashes")) == {100} and
#   min(eight(eight_seeds.RULES_NEXT, "accelerate")) > 0.9 -->
#
# **Explain.** A critic guesses about the eight actions that were not recorded in a second, and the choice picks the
# friendliest guess: lesson [[discrete_sac]]'s **optimist's error**. Driving would correct it; here nobody drives.
#
# *Why always accelerate?* The guesses seem to continue a trend: in the records faster seconds pay more. We turned
# the sign of all rewards. Then eight such agents *brake* in more than 70 % of the recorded seconds, and crash on
# every road that we tried.
#
# **A story, and its test.** *The rule never crashed, so no critic trained on its drives can know that a crash
# exists.* If this is the whole reason, drives with crashes help. Of the stochastic rule's 200 (lesson [[the_rule]])
# {{ with_accident() }} end in an accident:
# <!-- claim: bool(choosing.recorded().rewards.min() > 0) and with_accident() > 150 -->

# %%
settings = bc.settings_for("cql", cql_weight=0.0, stochastic_demonstrations=True)
crashed = learn(bc.Training(bc.with_seeds(settings, 2)))
bc.show(figures.would_do({figures.CRASHED: crashed}))

# %% [markdown]
# **See.** *It is not the whole reason: these agents crash, too.*
#
# **Explain.** These two hit trap 1 from behind after five seconds, at 15 m/s. Other Q-learners left the road after
# two, or hit a car far ahead at 25 m/s. The stochastic rule was not there at such a speed: in the first ten seconds
# of {{ DROVE }} drives it goes at most {{ fastest(10) | .0f }} m/s, later up to {{ fastest() | .0f }}. A crash
# recorded elsewhere says little about such a place.
# <!-- claim: DEFAULT.ego.speed + 5 * DEFAULT.ego.acceleration == 15 and fastest(10) < 13 and fastest() < 20 -->
#
# **Did the critics learn anything?** Let the two with the rule's a' choose again, but only among *likely* actions:
# those to which a clone of the rule gives at least a tenth of its highest probability, {{ likely() | .1f }} in a
# second on average.
#
# > **Predict.** They take the likely action whose Q is highest. What will they do?

# %%
again = ["crash on every road", "earn about what the clone does", "earn more than the rule"]
predict("recorded_drives.3", "What will they do with the highest Q of the likely actions?", again)

# %%
predicted("recorded_drives.3")
critics = [rules_next.agent(row).as_policy(with_q=True) for row in range(2)]
clone = bc.shipped_agents("bc")[0].as_policy()
table(choosing.CHOICES, choosing.choices(critics, clone))

# %% [markdown]
# **See.** *They rarely crash, and earn more than the rule ({{ of('rule').scores('returns').mean() | .0f }}).* So did
# each of eight that we trained.
#
# **Explain.** Of nine actions, the highest guess crashes, and so do the second and the lowest: each takes what was
# not recorded. Among likely actions the highest Q earns more than the lowest, and than the clone. But a driver that
# takes the *fastest* likely action, without any Q, earns about as much (last row). So what shows here of the
# critics' learning is one thing, *faster pays*: near the data it helps, far from them it crashes. A remedy may keep
# the choice near the data.
# <!-- claim: fastest_likely().returns.mean() > 55 and (fastest_likely().accident > 0).sum() < 3 -->
#
# CQL's is a term in the critic's loss, the mean of
#
# $$ \log \sum_a e^{Q(s,a)} - Q(s, a_\text{data}) $$
#
# The first part, a soft maximum, pushes all nine Q down, and the highest most. The second part pulls up the Q
# of the data's action.
#
# **Exercise (6 min, ●●○).** Write this term, in torch.


# %%
def conservative_loss(q, actions):
    """CQL's term, one number: q (batch, 9), the data's actions (batch,) whole numbers, tensors."""
    # solution
    chosen = q.gather(-1, actions.unsqueeze(-1)).squeeze(-1)
    return (q.logsumexp(-1) - chosen).mean()
    # end solution


check.conservative_loss(conservative_loss)

# %% [markdown]
# This term is −log of the probability that the policy softmax(Q) gives the data's action: the cloning loss of
# lesson [[demonstrations]]. So **CQL is Q-learning and cloning in one.**
# <!-- claim: bool(torch.isclose(conservative_loss(torch.eye(9)[2:3], torch.tensor([4])),
#   torch.nn.functional.cross_entropy(torch.eye(9)[2:3], torch.tensor([4])))) -->
#
# **Exercise (20 min, ●●●).** Write the whole loss of CQL's critic. In the target y the critic, `next_q`, chooses the
# best action a', and `next_target` gives its value (*double Q-learning*). Which part must have no gradient? What is y
# after an accident?


# %%
def offline_loss(q, next_q, next_target, actions, rewards, terminated, gamma, weight):
    """(Q(s,a) − y)² plus weight times CQL's term, a mean over the batch.

    q: the critic at s, (batch, 9); next_q: the critic at s', (batch, 9); next_target: the target
    critic at s' (the smaller of two), (batch, 9).
    actions (batch,) whole numbers; rewards, terminated (batch,); gamma, weight: floats.
    """
    # solution: the exercise's own


check.offline_loss(offline_loss)

# %% [markdown]
# Train two agents with your loss.

# %%
with_term = learn(own_code.training(bc.with_seeds(bc.settings_for("cql"), 2)))
bc.show(figures.would_do({"with CQL's term": with_term}))

# %% [markdown]
# **See.** *With the term agents still crash, but on far fewer roads.* Of eight agents of each kind:
#
# | | γ = 0.8 | γ = 0.01: looks no second ahead |
# |---|---|---|
# | without the term, accidents on | {{ crash_on("Q-learning") }} roads | {{ crash_on("no term, γ = 0.01") }} |
# | with the term | {{ crash_on("with CQL's term") }} | {{ crash_on(CLOSE) }} |
#
# *Here the cloning keeps them on the road; looking ahead is not needed for that.* Round 1's CQL agents, trained
# longer, crash on under 3 % of their drives.
# <!-- claim: max(eight(CLOSE, "crashes")) < max(eight("with CQL's term", "crashes")) and
#   set(eight("no term, γ = 0.01", "crashes")) == {100} -->
# <!-- claim: max(eight("with CQL's term", "crashes")) < 100 / 3 and of('cql').scores('accident').max() < 0.03 -->

# %% [markdown] tags=["instructor"] minutes=7
# Let each group say in one sentence what the term does to an action that is missing from the data, to one
# that is there, and to the car. For the fast: `settings_for("cql", cql_weight=5.0)`; a very large weight is a
# clone.

# %% [markdown]
# ## Round 3: when do you believe an estimate?
#
# You have the recorded drives and three agents of each of five methods. An agent's *worth* is what it earns,
# discounted, from the start of a drive. **Fitted Q evaluation** (FQE) estimates it from the recorded seconds alone:
# it learns Q of a *given* policy π, with the target r + γ Q(s', π(s')).
#
# > **Predict.** Two fits see the same recorded seconds; only their first weights and batches differ. They agree within
# > 0.1. Are both then within 0.1 of the truth?

# %%
agreed = ["always", "for most agents, not for all", "for fewer than half of the agents"]
predict("recorded_drives.4", "Where two fits agree, are both close to the truth?", agreed)

# %%
predicted("recorded_drives.4")
data, sets = choosing.recorded(), [choosing.agents(which) for which in range(3)]
agents = [agent for each in sets for agent in each.values()]  # three sets of five methods
guesses = choosing.fits(agents, data, times=2)  # two fits with different seeds; nobody drives
alike = [choosing.overlap(agent, data) for agent in agents]
truth = [choosing.worth(agent, range(100), gamma=0.8) for agent in agents]
fits = [choosing.by_set(fit) for fit in guesses]
same = choosing.worth(bc.rule_policy(bc.DEFAULT), range(100), gamma=0.8)  # the rule's, as a control
bc.show(figures.estimates([*sets[0]], choosing.by_set(alike), fits, choosing.by_set(truth), same))

# %% [markdown]
# **See.** *Where an agent does what was recorded, both fits are close; elsewhere they can be far off, either way.*
# Two fits agree for {{ agreeing()[0] }} agents; for {{ agreeing()[1] }} of these both are within 0.1.
#
# **Explain.** FQE's target copies the guess about π's action, and where that was not recorded, no row corrects it, in
# either fit: they can agree and be wrong.
# *Before you believe an estimate from recorded drives, count how often the agent does what was recorded.* If it often
# does, you did not need the estimate: for clones, CQL and GAIL a constant (×), the rule's worth, is as close.
# <!-- claim: agreeing() == (12, 9) and (apart()[:, 4] < 0.1).all() and (off()[:, :, 4] < -0.1).all() -->
# <!-- claim: abs(off()[:, :, :2]).max() < 0.1 and overlaps()[:, :2].min() > 0.85 and overlaps()[:, 2:].max() < 0.7 -->
# <!-- claim: ((abs(off()) > 0.3) & (overlaps() < 0.4)).sum((1, 2)).min() > 2 and off().max() > 0.3 -->
# <!-- claim: abs(constant() - truth()[:, :2]).max() < 0.05 and abs(constant() - truth()[:, 2]).max() < 0.1 -->

# %% [markdown] tags=["instructor"] minutes=3
# Ask who would let the agent with the largest estimate drive, and who CQL. Then ask for a second look that
# needs no simulator: overlap, more fits, γ nearer to 1.

# %% [markdown]
# ## Further: a reward that is learned
#
# GAIL's second network, the **discriminator**, learns to tell the rule's pairs (s, a) from the agent's. D is
# its probability that a pair is the rule's. SAC (lesson [[update_and_loop]]) is paid
#
# $$ r(s,a) = -\log (1 - D(s,a)) $$
#
# > **Predict.** Another reward, log D, also grows with D. Let D = ½ at every second. Which reward makes a drive of
# > 150 s worth more than one that crashes after 5 s?

# %%
predict(
    "recorded_drives.5",
    "With which reward is the long drive worth more?",
    ["−log (1 − D)", "log D", "both", "neither"],
)

# %% [markdown]
# The network puts out a **logit** x, any number, and D = σ(x) = 1 / (1 + e⁻ˣ).
# <!-- claim: math.isclose(torch.tensor(0.7).double().sigmoid(), 1 / (1 + math.exp(-0.7)),
#   rel_tol=1e-6) -->
#
# **Exercise (6 min, ●●○).** Write the reward as a function of x.


# %%
def imitation_reward(own_logits):
    """The reward of each decision: the discriminator's logits (batch,), a tensor -> (batch,)."""
    # solution
    return torch.nn.functional.softplus(own_logits)
    # end solution


check.imitation_reward(imitation_reward)

# %%
# NBVAL_CHECK_OUTPUT
predicted("recorded_drives.5")
reward, x = own_code.yours_or_ours("imitation_reward", doing="Paying"), torch.zeros(1)  # D = ½
pays = {"−log (1 − D)": float(reward(x)), "log D": -float(reward(-x))}  # log σ(x) = −r(−x)
weights = [sum(0.8 ** np.arange(n)) for n in (5, 150)]  # γ = 0.8
rows = [[name, *(f"{pay * weight:.2f}" for weight in weights)] for name, pay in pays.items()]
table(["reward at D = ½", "crash after 5 s", "drive of 150 s"], rows)

# %% [markdown]
# **Explain.** *The sign decides.* −log (1 − D) is above 0, so each second pays. log D is below 0, so each second
# costs, and the early crash is cheapest. This is arithmetic, not a test: lesson [[soft_constraint]]'s story had such
# arithmetic, and failed its test. No agent was paid log D here.

# %% [markdown] tags=["instructor"] minutes=3
# Let them say in one sentence what a clone is told in a state that no demonstration holds, and what the
# discriminator tells GAIL there. Ask what it would have to see, so that an accident costs something.

# %%
compare_predictions(
    "recorded_drives",
    {1: "CQL", 2: ends[3], 3: again[2], 4: agreed[1], 5: "−log (1 − D)"},
)

# %% [markdown]
# ## What you now know
#
# 1. Q of an action that the data lack is a guess. Agents that chose among guesses crashed. Kept to likely actions they
#    earned more than the rule; CQL's term keeps the choice near the data.
# 2. Before you believe an estimate from recorded drives, count how often the agent does what was recorded.
#
# **Three questions to think about**
# - The discriminator has found GAIL out: D = 0.1. What does its agent lose by leaving the road?
# - You may record 100 more drives. Whose?
# - How would you choose among the five kinds of agents without driving?
# <!-- claim: of('gail').scores('road_departure').mean() > 0.25 and of('gail').agents[0]['target_entropy'] < 0 -->

# %% [markdown]
# <details><summary>Answers</summary>
#
# - *Off the road?* All that is still to come pays {{ -math.log(0.9) / 0.2 | .2f }} at D = 0.1 and γ = 0.8; at D = ½ it
#   would be {{ math.log(2) / 0.2 | .1f }}. So it loses little. With a larger γ it would lose more.
# - *Whose drives?* Those of a driver who goes where your agent would go, best the agent itself (lesson
#   [[demonstrations]]). Its guesses are about these seconds.
# - *Choose?* The worth of those that often do what was recorded is about the teacher's. The others have to drive.
#
# </details>
#
# **Read on**: CQL: Kumar et al. (arXiv 2006.04779); FQE: Le et al. (arXiv 1903.08738); GAIL: Ho and Ermon
# (arXiv 1606.03476). Here critics promised a gain, and their agents crashed: nothing in the training
# said so.
# How does one find such an error in one's own code? ([The bug hunt](bug_hunt.ipynb).)

# %% [markdown] tags=["instructor"]
# On the first question: five agents with a target entropy that a policy can have leave the road in
# {{ departures(1) }} % of their drives, the same seeds without it in {{ departures(0) }} %. Train again with a larger
# γ, or let the discriminator see what follows an accident (absorbing states, as in Kostrikov et al.), one change at a
# time.
#
# **On the board.** Three agents as rows; columns: sees actions, sees rewards, drives itself. Then Q of nine
# actions as bars: those in the data pulled up, the others pushed down.
#
# **To discuss.** When is it right to be pessimistic about what nobody has tried?
