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
# # 3 · The escape
#
# **What you will be able to do**
# - train eight agents live, four alone and four with the rule's help, and read their curves;
# - explain the two ways in which the rule helps: a *soft constraint* and *demonstrations with a
#   bonus*;
# - judge a result by its seeds and its held-out episodes, the failures included.
#
# **Time** 45 minutes, about two of them the machine's. **You need** lessons 1 and 2.

# %%
from bootcourse.drivers import rule_driver
from bootcourse.learn.curves import by_method
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.train import Training
from bootcourse.lessons import source
from bootcourse.lessons.figures import fading
from bootcourse.lessons.live import LiveCurves
from bootcourse.record.drive import record
from bootcourse.scenario import DEFAULT
from bootcourse.study.drawing import show
from bootcourse.study.evaluate import drive_episodes, held_out_seeds, over_seeds, report
from bootcourse.study.figures import traces, training_curves
from bootcourse.study.top_view import top_view_over_time

# %% [markdown]
# ## Look first
#
# Here is the learner's objective, **discrete soft actor-critic** (SAC), as the library computes
# it. An *actor* holds a probability for each of the nine actions, $\pi(a|s)$. A *critic* guesses
# what each action is worth from here on, $Q(s,a)$. The *soft value* of a state is what the actor
# can expect, plus a little for staying undecided (its entropy).

# %%
source("bootcourse.learn.sac", "soft_value", "critic_target", "actor_loss")

# %% [markdown]
# The critic learns from what happens; the actor moves towards what the critic likes. Nobody tells
# either about the way out. They try things.
#
# > **Predict.** Four agents learn alone, from four different random starts, 400 episodes each.
# > How many of the four find the way out of the trap?

# %% [markdown]
# ## Round 1: what the rule adds
#
# **A soft constraint.** The actor pays for differing from the stochastic rule $\tilde\pi$. The
# price is the Kullback-Leibler divergence, in nats, times a strength $\xi$:
#
# $$ D_\mathrm{KL}(\pi \,\|\, \tilde\pi) = \sum_a \pi(a|s) \log \frac{\pi(a|s)}{\tilde\pi(a|s)} $$

# %%
source("bootcourse.learn.bootstrap", "kl_to_rule", "constraint_strength")

# %% [markdown]
# **Demonstrations.** The rule drives 200 episodes. A share β of every batch that the agent learns
# from comes from them, and each demonstrated action is paid a bonus of c = 2. So the critic
# hears, from the first update on, what it is worth to fall back and change lane.

# %%
source("bootcourse.learn.bootstrap", "demonstration_share", "augmented_reward")

# %% [markdown]
# Both fade, so that the agent can become better than its teacher: β falls to zero over 1,000
# episodes, and ξ = 200 α shrinks with the temperature α.

# %%
show(fading(settings_for("bootstrapped")))

# %% [markdown]
# ## Round 2: train
#
# Eight agents at once: seeds 0 to 3 learn alone (`sac`), seeds 0 to 3 learn with the rule
# (`bootstrapped`). They share nothing but the machine, and each gets the same number of
# decisions. This takes about a minute; stop it whenever you like (the ■ button), and what was
# learned so far is kept.

# %%
SEEDS, DECISIONS = 4, 50_000
agents = with_seeds(settings_for("sac"), SEEDS) + with_seeds(settings_for("bootstrapped"), SEEDS)
training = Training(agents, episodes=2000)
enough = DECISIONS * len(agents)
result = training.run(callback=LiveCurves(), stop=lambda: training.decisions >= enough)
print(f"{result.seconds:.0f} s, {training.decisions:,} decisions")
print("episodes of each agent:", training.curves.finished.tolist())

# %% [markdown]
# **See.** Each thin line is one agent, each thick one the interquartile mean of its method's
# seeds.

# %%
leaves = training.curves.recent("success", 50) > 0.5
title = f"With the rule {leaves[SEEDS:].sum()} of {SEEDS} agents leave the trap; "
title += f"alone {leaves[:SEEDS].sum()} of {SEEDS} do"
show(training_curves(by_method(agents, result.curves), title))

# %% [markdown]
# ## Round 3: test
#
# Curves come from training, where an agent still tries things. A test uses roads that nobody has
# trained on, and the actor's most probable action. Every agent is shown, also the ones that
# failed: we never pick the best.

# %%
seeds = held_out_seeds(3, 300)
reports = {"sac": [], "bootstrapped": []}
print("method        seed   success %   return   distance m   accidents %")
for agent in result.agents:
    method, seed = agent.settings.method, agent.settings.seed
    r = report(drive_episodes(agent.driver(), seeds))
    reports[method].append(r)
    accidents = r.collision.value + r.road_departure.value + r.stoppage.value
    numbers = f"{100 * r.success.value:12.1f}{r.returns.value:9.1f}{r.distance.value:13.0f}"
    print(f"{method:14}{seed:4}{numbers}{100 * accidents:14.1f}")

# %%
for method, each in reports.items():
    escaped = sum(r.success.value >= 0.95 for r in each)
    returns = over_seeds(each)["returns"].value
    print(
        f"{method:12}: {escaped} of {len(each)} agents escape in 95 % of the episodes or more;",
        end=" ",
    )
    print(f"return {returns:.1f}")
rule_report = report(drive_episodes(rule_driver(DEFAULT), seeds))
print(f"the rule    : return {rule_report.returns.value:.1f}")

# %% [markdown]
# **Explain.** Alone, an agent that brakes or changes lane at random crashes, and crashes cost 10.
# The safest thing that it can find is to follow trap 1, at a return of 23.4. With the rule, the
# way out is in the data from the start. The agent does not copy it: after a few hundred episodes
# it is about as good as the rule or better, and still improving.
#
# Look at the thin blue lines again. An agent that finds the way out alone, by luck, can lose it
# again: its critic has seen many more accidents than escapes, and nothing reminds it.
#
# Four seeds are few. If all four escape, the true rate can still be below one half (the exact 95
# % interval of 4 out of 4 begins at 40 %). And "escapes now" is not "escapes for ever": see the
# second question below.

# %% [markdown]
# ## Round 4: watch both drive
#
# > **Predict.** Same road, seed 0 of each method. What does the speed of the agent that learned
# > alone look like?

# %%
ROAD = 10
alone = record(result.agents[0].driver(with_q=True), [ROAD], label="sac")[0]
helped = record(result.agents[SEEDS].driver(with_q=True), [ROAD], label="bootstrapped")[0]
show(traces([alone, helped]))

# %%
show(top_view_over_time(helped, times=[0, 4, 8, 12, 16, 24]))

# %% [markdown]
# ## What you now know
#
# 1. Plain SAC learns to stay in the trap, or does worse; what it finds by luck it can lose.
# 2. The rule helps in two ways: the actor pays for leaving it (ξ · KL), and its drives are in the
#    data, with a bonus c.
# 3. Both fade, so the teacher's faults need not be the student's.
# 4. A method is judged over seeds, on held-out roads, with its failures shown.
# 5. Everything that you saw was trained here, in about a minute. Nothing was canned.
#
# **Three questions to think about**
# - Switch one of the two helps off: `settings_for("soft")` or `settings_for("demos")`. Which one
#   carries more?
# - Train `bootstrapped` for 1,500 episodes (three to four minutes). Returns pass 100. Do all
#   seeds keep what they learned? Look at α and at the entropy when one does not.
# - The bonus pays for *demonstrated* actions only. What would happen if it were paid for the
#   agent's own, too?
#
# **Read on**: Haarnoja et al., *Soft Actor-Critic* (arXiv 1801.01290); Christodoulou, *SAC for
# Discrete Action Settings* (arXiv 1910.07207); Hester et al., *Deep Q-learning from
# Demonstrations* (arXiv 1704.03732); Reddy et al., *SQIL* (arXiv 1905.11108), where the bonus
# comes from.
