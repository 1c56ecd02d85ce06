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
# - say what a clone, CQL and GAIL each learn from the same drives, and what that costs;
# - write CQL's loss, and the two halves of GAIL;
# - say why choosing among trained agents without a simulator can fail.
#
# **Time** 75 minutes; running it takes under one minute. **It builds on** lesson [[demonstrations]].

# %%
import bootcourse as bc
import numpy as np
import torch
import torch.nn.functional as F
from bootcourse.course import (
    check,
    compare_predictions,
    own_code,
    predict,
    predicted,
    progress,
    table,
)
from bootcourse.course.lessons.recorded_drives import choosing, figures

progress("recorded_drives")

# %% [markdown]
# ## Look first
#
# Three agents learned from the same {{ SETTINGS.demonstration_episodes }} drives of the rule: GAIL
# (*generative adversarial imitation learning*), a clone (BC, behaviour cloning) and CQL
# (*conservative Q-learning*). Press play.

# %% tags=["nbval-ignore-output"]
bc.recording(figures.three_drives(), height=480)

# %% [markdown]
# All get ahead of trap 1. Then GAIL's car leaves the road: we chose its drive for that, from 100.

# %% [markdown] tags=["instructor"] minutes=3
# Let people say which of the three copies the rule and which only looks as if. Ask what each was
# told, and what it had to find out.

# %% [markdown]
# ## Round 1: three agents of one teacher
#
# | | learns from | drives while it learns |
# |---|---|:---:|
# | BC | what was seen and done in the rule's drives | no |
# | CQL | the same, with rewards and next states | no |
# | GAIL | the same as BC, and its own driving | yes |
# <!-- claim: [of(m).agents[0]['beta_start'] for m in ('bc', 'cql')] == [1, 1] and 0 <
#   of('gail').agents[0]['beta_start'] < 1 -->
#
# BC and CQL learn **offline**: recorded drives are all they have.
#
# > **Predict.** The rule's return on the held-out roads is
# > {{ of('rule').scores('returns').mean() | .0f }}. Which of the three earn more than that?

# %%
choices = ["none", "CQL", "CQL and GAIL", "all three"]
predict("recorded_drives.1", "Which of the three earn more than the rule?", choices)

# %%
predicted("recorded_drives.1")
study = bc.shipped_results()
bc.show(figures.returns(study))

# %% [markdown]
# **See.** After the study's long training each CQL agent earns more than its teacher, each clone a
# little less, GAIL much less on average. Only CQL is told the reward; that this is the reason, we
# have not tested. All ten clones and all ten CQL agents *escape*: they are ahead of trap 1 on at
# least {{ 100 * ESCAPES | .0f }} % of the roads. So do six of GAIL's, but one of these leaves the
# road in {{ 100 * accidents_of_escapers().max() | .0f }} % of its drives: *a success rate that
# counts who is ahead hides later accidents.*
# <!-- claim: escaped('cql') == len(of('cql')) == 10 and of('cql').scores('returns').min() >
#   of('rule').scores('returns').max() -->
# <!-- claim: escaped('bc') == len(of('bc')) == 10 and of('bc').scores('returns').max() <
#   of('rule').scores('returns').min() and of('bc').scores('returns').min() > 0.8 *
#   of('rule').scores('returns').max() -->
# <!-- claim: of('gail').scores('returns').mean() < 0.7 * of('rule').scores('returns').mean() -->
# <!-- claim: escaped('gail') == len(accidents_of_escapers()) == 6 -->
#
# *The form matters.* Our CQL takes the action with the highest Q. Of ten with SAC's actor and
# entropy together none escapes. The paper reports no success for CQL, and does not print its form.
# <!-- claim: escaped('cql_sac') == 0 and len(of('cql_sac')) == 10 -->
# <!-- claim: PRINTED['cql']['success'].mean == 0 and of('cql_sac').scores('success').max() == 0 -->
#
# *A clone can beat its teacher.* In a second study the teacher is the stochastic rule, which
# earns {{ np.mean([each.rewards.sum() for each in by_stochastic_rule()]) | .0f }}. Its ten clones
# earn {{ of_paper('bc').scores('returns').mean() | .0f }}. A clone takes its likeliest action, the
# teacher another in one second of ten. Is that why? A clone that draws would show it.
# <!-- claim: len(of_paper('bc')) == 10 and
#   of_paper('bc').agents[0]['stochastic_demonstrations'] -->
# <!-- claim: of_paper('bc').scores('returns').min() > 2 * np.mean([each.rewards.sum() for each in
#   by_stochastic_rule()]) -->

# %% [markdown] tags=["instructor"] minutes=4
# Collect the votes before the picture. The class will be tempted to conclude that the paper is
# wrong. The picture shows less: "CQL stays in the trap" is not true of CQL as such. Is it fair to
# train all methods for as many episodes, updates or seconds, or until each stops improving? It
# depends on what the table is for, but a paper has to say which it took.

# %% [markdown]
# ## Round 2: what is an untried action worth?
#
# Q-learning asks of each next state: what is the best action worth? The action with the highest Q
# may be missing from the data, so its value is a guess. An agent that drives would try it; an
# offline agent cannot. CQL adds to the critic's loss the mean of
#
# $$ \log \sum_a e^{Q(s,a)} - Q(s, a_\text{data}) $$
#
# The first part, a soft maximum of the nine Q, pushes all nine down, the highest most. The second
# pulls up the Q of the data's action.
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
# It is the cloning loss of lesson [[demonstrations]] for the policy softmax(Q). So **CQL is
# Q-learning and cloning in one.**
# <!-- claim: bool(torch.isclose(conservative_loss(torch.eye(9)[2:3], torch.tensor([4])),
#   torch.nn.functional.cross_entropy(torch.eye(9)[2:3], torch.tensor([4])))) -->
#
# **Exercise (20 min, ●●●).** Write the whole loss of CQL's critic. The target y is that of *double*
# Q-learning: the critic chooses the next action, and a slower copy of it, the target critic, says
# what that is worth. Which part must have no gradient? What comes after an accident?


# %%
def offline_loss(q, next_q, next_target, actions, rewards, terminated, gamma, weight):
    """(Q(s,a) − y)² plus weight times CQL's term, a mean over the batch.

    q: the critic at s, (batch, 9); next_q, next_target: critic and target critic at s', (batch, 9).
    actions (batch,) whole numbers; rewards, terminated (batch,); gamma, weight: floats.
    """
    # solution: the exercise's own


check.offline_loss(offline_loss)

# %% [markdown]
# Train four agents on the recorded drives, two with the term and two without. In the first 20
# seconds of the rule's drives, the way out, ask their critics: what is the rule's action worth, and
# what the *best other* of the nine?

# %%
torch.set_num_threads(1)  # small matrices are faster on one thread
with_term = bc.with_seeds(bc.settings_for("cql"), 2)
without = bc.with_seeds(bc.settings_for("cql", cql_weight=0.0), 2)
training = own_code.training(with_term + without)
learner, replay, found = training.learner, training.replay, []  # replay: 200 drives of the rule
generators = [np.random.default_rng(each.seed) for each in learner.settings]
for update in range(2001):
    if update % 200 == 0:
        found.append(figures.believed(learner))
    learner.update(replay.sample(64, np.ones(4), generators))  # nobody drives
bc.show(figures.beliefs(found, every=200))

# %% [markdown]
# **See.** Without the term the best other action ends above the rule's, and far above what the
# rule's drive is worth. Each target holds the value of the action that the critic prefers, so the
# rule's action rises, too.
#
# > **Predict.** Now all four drive. What will the two *without* the term do?

# %%
ends = ["earn more than the rule", "drive as the rule does", "stay behind trap 1", "crash"]
predict("recorded_drives.2", "What will the two without the term do?", ends)

# %%
predicted("recorded_drives.2")
bc.show(figures.promises(learner))

# %% [markdown]
# **See.** *Without the term both agents promise most, and crash on every road.* None of the
# recorded drives ends in an accident, so no critic has seen what one costs. With the term both
# promise less, and seldom crash.
# <!-- claim: float(choosing.recorded().terminated.sum()) == 0 -->

# %% [markdown] tags=["instructor"] minutes=7
# Let each group say in one sentence what the term does to an action that is missing from the data,
# to one that is there, and to the car. For the fast: `settings_for("cql", cql_weight=5.0)`; a very
# large weight is a clone.

# %% [markdown]
# ## Round 3: choosing without a simulator
#
# You have seven trained agents, A to G, the recorded drives, and no road to try them on. **Fitted Q
# evaluation** (FQE) estimates what a *given* policy π is worth. It fits Q(s, a) to
# r + γ Q(s', π(s')) over the recorded seconds (none of them an accident). The estimate is
# Q(s, π(s)) where the drives begin. Our eight fits differ in their first weights and batches.

# %%
data, agents = choosing.recorded(), choosing.agents()
fits = choosing.fits(agents.values(), data, times=8)  # (8, 7): nobody drives
alike = [choosing.overlap(agent, data) for agent in agents.values()]
bc.show(figures.estimates("ABCDEFG", alike, fits))

# %% [markdown]
# > **Predict.** **Best of N** takes the agent with the largest estimate (filled). In how many of
# > the eight fits is that estimate larger than the truth on the road?

# %%
counts = ["none", "fewer than half", "more than half", "all"]
predict("recorded_drives.3", "In how many fits is the largest estimate too large?", counts)

# %%
predicted("recorded_drives.3")
truth = [choosing.worth(agent, range(100), gamma=0.8) for agent in agents.values()]
names = [f"{letter}: {name}" for letter, name in zip("ABCDEFG", agents, strict=True)]
bc.show(figures.estimates(names, alike, fits, truth))

# %% [markdown]
# **See.** In most of our fits C or E is taken, and its estimate is too large:
# <!-- claim: len(largest()) == 8 and sum(each in (2, 4) and guesses[each] > truth()[each] for each,
#   guesses in zip(largest(), estimated())) > 4 -->
#
# - *Selection.* E's estimates lie on both sides of the truth. Where E is taken, they are too large.
# - *Bias.* All eight fits put C too high, and F too low: *that fits agree proves nothing.*
# <!-- claim: 1 < (estimated()[:, 4] > truth()[4]).sum() < 7 and min(guesses[4] for each, guesses in
#   zip(largest(), estimated()) if each == 4) > truth()[4] -->
# <!-- claim: min(estimated()[:, 2]) > truth()[2] and max(estimated()[:, 5]) < truth()[5] - 0.2 -->
#
# G is worth most, and seldom acts as the data do (in the rule's states): little overlap means
# *unknown*, not bad. A and B, which act most as the data do, are estimated well; but the rule's own
# worth, the green line, comes about as near.
# <!-- claim: np.argmax(truth()) == 6 and overlap_of(6) < 0.3 -->
# <!-- claim: max(misses()[:2]) < 0.2 and max(abs(choosing.rule_worth() - truth()[:2])) < 0.1 -->
# <!-- claim: overlap_of(0) > 0.85 and overlap_of(1) > 0.8 and max(map(overlap_of, range(2, 7))) <
#   0.7 -->
# <!-- claim: max(estimated()[:, 5]) < truth()[5] - 0.2 and max(estimated()[:, 5]) <
#   choosing.rule_worth() - 0.2 -->
#
# Worth at γ = 0.8 counts about five seconds, not success: C and E stay in the trap, and are worth
# more than B.
# <!-- claim: min(truth()[2], truth()[4]) > truth()[1] and of('cql_sac').scores('success')[0] == 0
#   and of('sac').scores('success')[0] == 0 -->

# %% [markdown] tags=["instructor"] minutes=6
# Ask who would let the agent with the largest estimate drive, and who B. Then ask for a second
# look that needs no road, either: overlap, more fits, γ nearer to 1.

# %% [markdown]
# ## Round 4: a judge instead of a reward
#
# GAIL drives while it learns, so it meets accidents. It aims at the **occupancy measure**: the
# share of the rule's decisions in each state and action. A second network, the **discriminator**,
# is the judge: it gives each pair (s, a) a probability D that it comes from the rule and not from
# the agent. Its loss is a mean over the rule's pairs and one over the agent's own:
#
# $$ -\mathbb{E}_\text{rule}[\log D(s,a)] - \mathbb{E}_\text{own}[\log (1 - D(s,a))] $$
#
# For each pair the network puts out a **logit** x, any number, and D = σ(x) = 1 / (1 + e⁻ˣ). Take
# care: in 32-bit numbers σ(60) is exactly 1, and e¹⁰⁰ is too large.
# <!-- claim: math.isclose(torch.tensor(0.7).double().sigmoid(), 1 / (1 + math.exp(-0.7)),
#   rel_tol=1e-6) -->
# <!-- claim: float(torch.tensor(60.0).sigmoid()) == 1 and
#   bool(torch.tensor(100.0).exp().isinf()) -->
#
# **Exercise (15 min, ●●●).** Write this loss from the logits, right for logits from −100 to 100.
# First work out, on paper, log D and log (1 − D) as functions of x.


# %%
def discriminator_loss(rule_logits, own_logits):
    """The loss, one number: logits of the rule's pairs (n,) and of the agent's (m,)."""
    # solution
    return F.softplus(-rule_logits).mean() + F.softplus(own_logits).mean()
    # end solution


check.discriminator_loss(discriminator_loss)

# %% [markdown]
# The agent learns to get a high D, by the SAC of lesson [[update_and_loop]]. In place of the road's
# reward it is paid
#
# $$ r(s,a) = -\log (1 - D(s,a)) $$
#
# > **Predict.** Other programs pay log D, which also grows with D. Suppose that D = ½ at every
# > second. With which reward is a drive of 150 s worth more than a crash after 5 s?

# %%
predict(
    "recorded_drives.4",
    "With which reward is the long drive worth more?",
    ["−log (1 − D)", "log D", "both", "neither"],
)

# %% [markdown]
# **Exercise (6 min, ●●○).** Write the reward from the logits x, again right from −100 to 100.


# %%
def imitation_reward(own_logits):
    """The reward of each decision: the discriminator's logits (batch,), a tensor -> (batch,)."""
    # solution
    return torch.nn.functional.softplus(own_logits)
    # end solution


check.imitation_reward(imitation_reward)

# %%
# NBVAL_CHECK_OUTPUT
predicted("recorded_drives.4")
rows = []
for d in (0.1, 0.5, 0.9):
    pays = (-np.log(1 - d), np.log(d))
    rows.append([d, *(f"{each * sum(0.8 ** np.arange(n)):.2f}" for each in pays for n in (5, 150))])
headings = ["D", "−log (1 − D): for 5 s", "for 150 s", "log D: for 5 s", "for 150 s"]
table(headings, rows, below="γ = 0.8. A crash ends a drive: 0 from then on.")

# %% [markdown]
# **Explain.** Where D is the same everywhere, the reward's sign decides whether it pays to go on.
# Ours pays for each second; log D charges for it, and an early crash is cheapest. Yet GAIL often
# leaves the road.
# <!-- claim: of('gail').scores('road_departure').mean() > 0.25 -->

# %% [markdown]
# Train two agents by GAIL, briefly, with your code if it has passed its checks, and let them drive.
# Does the judge warn of a crash? (D = ½: it guesses.)

# %%
training = own_code.training(bc.with_seeds(bc.settings_for("gail"), 2), episodes=5000)
training.run(updates=1000, progress=False)
bc.show(figures.judged(training.learner))

# %% [markdown]
# **See.** The judge tells agent from rule, but warns little: before a crash D is not near 0, and
# −log (1 − D) is above 0 for each D. So *each second before a crash is paid*. A crash costs the pay
# of the seconds that would have followed, no more.

# %% [markdown] tags=["instructor"] minutes=8
# Let them say in one sentence what a clone is told in a state that no demonstration holds, and what
# the discriminator tells GAIL there. Draw the loss of one pair against D before they write it. Ask
# what a judge would have to see, so that an accident costs something.

# %%
compare_predictions(
    "recorded_drives",
    {1: "CQL", 2: ends[3], 3: counts[2], 4: "−log (1 − D)"},
)

# %% [markdown]
# ## What you now know
#
# 1. BC and CQL learn without driving; GAIL has to drive. BC and GAIL do not use the road's reward.
# 2. A success rate that counts who is ahead hides later accidents.
# 3. CQL's term is the cloning loss of softmax(Q). Without it our two critics promised far more than
#    their drives were worth.
# 4. An estimate without a simulator rests on seconds in which the agent acts as the data do; about
#    equal shares may give a near one (D) or a far one (C). More fits show its scatter, not its
#    bias.
# <!-- claim: misses()[3] < 0.12 and min(misses()[[2, 5]]) > 0.4 and 0.5 < overlap_of(3) <
#   overlap_of(2) < 0.6 -->
# 5. GAIL is paid by its discriminator; at equal D the reward's sign decides whether going on pays.
#
# **Three questions to think about**
# - Why does GAIL often leave the road, and how would you find out?
# - What would each of the three learn from 200 drives of a bootstrapped agent, accidents included?
# - How would you find out whether the rewards help CQL at all?

# %% [markdown] tags=["instructor"]
# Answers to the three questions. (1) Not settled. Where D is near 0 a second more pays nearly
# nothing: compare 5 s and 150 s at D = 0.1. With γ = 0.8 the agent looks about five seconds ahead.
# Two agents after a short training do not settle it: look at D in more of them. Then train again
# with a larger γ, or let the judge see what follows an accident (absorbing states, as in Kostrikov
# et al.), one change at a time. (2) BC copies the agent's actions, those
# before accidents included, and does not learn that they ended badly; GAIL would pay for them. CQL
# uses the rewards, −10 for each accident included: where good and bad drives pass through the same
# states, it can take the better. (3) Train CQL once more, as long and with the same seeds, with
# all rewards set to 0, and compare the returns over seeds. What is left without rewards is the
# work of cloning.

# %% [markdown]
# **Read on**: on CQL, Kumar et al. (arXiv 2006.04779), and on when it beats a clone (arXiv
# 2204.05618); on FQE, Le et al. (arXiv 1903.08738); on GAIL, Ho and Ermon (arXiv 1606.03476),
# Kostrikov et al. (arXiv 1809.02925) and Orsini et al. (arXiv 2106.00672). Next: [the bug
# hunt](bug_hunt.ipynb).

# %% [markdown] tags=["instructor"]
# **On the board.** Three agents as rows; columns: sees actions, sees rewards, drives itself. Then Q
# of nine actions as bars: those in the data pulled up, the others pushed down.
#
# **To discuss.** When is it right to be pessimistic about what nobody has tried?
