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
# # 5 · The barrier
#
# **What you will be able to do**
# - train plain SAC in the trap, live, and say where it ends;
# - find out whether leaving the trap pays for it, and how likely chance is to find a way out;
# - train agents that get out with the rule's help, and judge both kinds by their seeds.
#
# **Time** 50 minutes, about two of them the machine's. **You need** the trap of lesson 1, the rule
# of lesson 3, SAC of lesson 4.

# %%
import bootcourse as bc
import numpy as np
from bootcourse.lessons import charts, check, figures, source
from bootcourse.study import planner

# %% [markdown]
# ## Look first
#
# How well could anybody drive here? A **planner** is a driver with an unfair advantage: it tries
# out the future before it decides. It continues a drive with all nine actions, keeps the best 50
# drives, and does so {{ DEFAULT.clock.decisions }} times. It knows what the other cars will do, and
# no driver does, so it is a yardstick and not a rival. The yardstick has an error on one side: the
# search can miss the best drive. What it finds is possible; something better may be, too.

# %%
ROAD = 10
plans = planner.plan_episodes([ROAD], search=planner.Search(beam=50))
planned = bc.record(planner.follow(plans), [ROAD], label="planner")[0]
idle = bc.record(bc.idle_policy, [ROAD], label="idle")[0]
by_rule = bc.record(bc.rule_policy(bc.DEFAULT), [ROAD], label="rule")[0]
bc.show(bc.traces([idle, by_rule, planned]))

# %%
for drive in (idle, by_rule, planned):
    passed = bc.overtaken(drive)
    when = "never" if passed is None else f"after {passed:.0f} s"
    print(f"{drive.label:8} return {drive.rewards.sum():6.1f}, ahead of trap 1 {when}")
bc.show(bc.top_view_over_time(planned, times=[0, 2, 4, 6, 8, 12]))

# %% [markdown]
# **See.** On this road the planner's car does not fall back. It changes lane between the two traps,
# with little room to either side, which is possible because the planner knows where they will be.
# The rule takes longer and keeps larger gaps. Both earn more than the car that stays in the trap.

# %% [markdown]
# ## Round 1: let it learn
#
# Six agents learn with SAC, exactly as in lesson 4, from nothing but what they drive themselves.
# Three have the paper's discount, γ = {{ SETTINGS.gamma }}. Three look further ahead, γ = 0.95.
# Each gets the same number of updates. You can stop it at any time (the ■ button), and what was
# learned is kept.
#
# After training each agent drives 200 roads. In this course an agent **escapes** if it ends ahead
# of trap 1 on at least {{ 100 * ESCAPES | .0f }} % of the roads that it is tested on.
#
# > **Predict.** How many of the first three will escape? How many of the three that look further
# > ahead? What will the others do?

# %%
SEEDS, UPDATES = 3, 5000
agents = bc.with_seeds(bc.settings_for("sac"), SEEDS)
agents += bc.with_seeds(bc.settings_for("sac", gamma=0.95), SEEDS)
training = bc.Training(agents, episodes=20_000)
alone = training.run(callback=figures.LiveCurves(), stop=lambda: training.updates > UPDATES)
print(f"{alone.seconds:.0f} s, {training.decisions:,} decisions")


# %%
def table(agents):
    """One row for each agent, on 200 roads that nobody has trained on. Returns their success."""
    print("method            γ  seed  success %  return  accidents %")
    successes = []
    for agent in agents:
        r, s = bc.evaluate(agent.as_policy(), 200, seed=5), agent.settings
        accidents = r.collision.value + r.road_departure.value + r.stoppage.value
        row = f"{s.method:13}{s.gamma:6}{s.seed:6}{100 * r.success.value:11.1f}"
        print(f"{row}{r.returns.value:8.1f}{100 * accidents:13.1f}")
        successes.append(r.success.value)
    return np.array(successes)


escaped_alone = table(alone.agents) >= bc.statistics.ESCAPES
print(f"{escaped_alone.sum()} of {len(agents)} escape")

# %%
driven = training.curves.finished.sum()
ahead = int(np.nansum(alone.curves["success"]))
ended = np.nansum(alone.curves["accident"] > 0)
print(f"In {driven:,} episodes of training, {ahead} ended ahead of trap 1;", end=" ")
print(f"{100 * ended / driven:.0f} % of all ended in an accident.")

# %% [markdown]
# **See.** Compare the returns with {{ idle().rewards.sum() | .1f }}, the return of doing nothing
# (lesson 1). Why do agents stay? There are two explanations, and they ask for different cures.
#
# - **Discount.** An agent with γ = 0.8 hardly counts what comes in 20 s. Perhaps leaving does not
#   *pay* for it, and staying is the right answer to the question that we asked.
# <!-- claim: 0.8 ** 20 < 0.02 and SETTINGS.gamma == 0.8 -->
# - **Exploration.** Leaving pays, also for such an agent, but what it tries hardly ever gets there.

# %% [markdown] tags=["instructor"] minutes=8
# The training takes half a minute on a free machine: have the predictions on the board before it
# starts, and collect explanations for a flat line while it runs. Somebody will say "train longer".
# Let a group do that at home (`UPDATES = 30_000`), and bring the curves.

# %% [markdown]
# ## Round 2: is it the discount?
#
# **Exercise 5.1 (3 min, ●○○).** What a learner maximises is a discounted sum: the reward after t
# seconds counts $\gamma^t$. Write it.


# %%
def discounted_value(rewards, gamma):
    """Σ γ^t r_t. rewards: array (T,), the first one now; gamma: float. Returns a number."""
    # solution
    return float(np.sum(gamma ** np.arange(len(rewards)) * rewards))
    # end solution


check.discounted_value(discounted_value)

# %% [markdown]
# > **Predict.** With γ = 0.8, which share of everything that a learner counts lies more than 5 s
# > ahead? More than 20 s? And with γ = 0.95?
#
# **Exercise 5.2 (3 min, ●○○).** Write that share, for a pay that is the same at every second.


# %%
def share_of_the_future(gamma, seconds):
    """The share of Σ γ^t, t = 0, 1, 2 ..., that comes from t ≥ seconds: in [0, 1]."""
    # solution
    return gamma**seconds
    # end solution


check.share_of_the_future(share_of_the_future)

# %%
for gamma in (0.8, 0.95):
    shares = [f"{100 * gamma**seconds:5.1f} % after {seconds} s" for seconds in (5, 20, 60)]
    print(f"γ = {gamma}: {', '.join(shares)}")

# %% [markdown]
# So an agent with γ = {{ SETTINGS.gamma }} counts little beyond the next seconds. Is that little
# enough to make staying the best choice? Let the planner search for the largest *discounted* sum,
# once with all actions and once without leaving its lane.
#
# > **Predict.** At γ = 0.8, is the best drive worth more than the best one that stays in its lane?
# > And is the *rule's* way worth more than that?

# %%
print("   γ   idle  best in lane  rule's way  best of all  of which leave")
for gamma in (0.8, 0.95):
    s = planner.is_staying_optimal(range(4), gamma=gamma, beam=50)
    row = f"{gamma:4} {s.idle.value:6.2f} {s.keep_lane.value:13.2f} {s.rule.value:11.2f}"
    print(f"{row} {s.best.value:12.2f} {100 * s.leaves.value:13.0f} %")

# %% [markdown]
# **Explain.** On each of these four roads, at both discounts, the best drive that the planner found
# leaves the trap, and it is worth more than the best one that it found in the lane. That is not yet
# an answer for a learner, which sees 26 numbers and not the future.
#
# Trained agents give the answer. In lesson 9's study some learned, with γ = 0.8 and with the rule's
# help, to escape; they see the same 26 numbers. On 200 held-out roads, the
# {{ len(discounted_scores('soft')) }} agents with the soft constraint alone that come with this
# course earn {{ discounted_scores('soft').min() | .2f }} to
# {{ discounted_scores('soft').max() | .2f }} in discounted reward. Doing nothing earns
# {{ discounted(idle(), 0.8) | .2f }}. So leaving can pay at γ = 0.8, and the discount alone does
# not explain why an agent stays.
# <!-- claim: discounted_scores('soft').min() > discounted(idle(), 0.8) -->
# <!-- claim: (of('soft').scores('success')[:len(discounted_scores('soft'))] >= ESCAPES).all() -->
# <!-- claim: all(run.agent.settings.gamma == 0.8 for run in shipped_runs('soft')) -->
#
# But look at the rule's way at γ = 0.8. Falling back costs reward at once, and what it earns comes
# so late that it hardly counts. For such a learner *this* way out is worth **less** than doing
# nothing. A critic that judges the rule's drives by their rewards would advise against them. Lesson
# 8 comes back to that.
# <!-- claim: all(discounted(by_rule(road), 0.8) < discounted(idle(road), 0.8) for road in range(4))
#   -->

# %% [markdown] tags=["instructor"] minutes=10
# The planner's number is a lower bound on the best (a beam of 50 can miss the best drive), so "best
# of all" above "best in lane" is safe; the other way round it would not be. Ask why (`keep_lane` is
# a lower bound, too, but on a much smaller space: with a beam of 200 it hardly moves).
# <!-- claim: planned(200, 0.8, keep_lane=True) - planned(50, 0.8, keep_lane=True) < 0.01 -->

# %% [markdown]
# ## Round 3: is it exploration?
#
# > **Predict.** The planner's way out takes some seconds, and a wrong action can end behind a trap,
# > in a collision, or off the road. Suppose 2 of the 9 actions are right at each of 8 decisions.
# > About how many random tries does it take until one works?
#
# **Exercise 5.3 (5 min, ●●○).** Write the chance that at least one of `tries` works.


# %%
def luck(good, decisions, tries):
    """The chance of a lucky try. good: right actions of 9; decisions: in a row."""
    # solution
    once = (good / 9) ** decisions
    return 1 - (1 - once) ** tries
    # end solution


check.luck(luck)

# %%
for good in (2, 3, 4):
    chances = [1 - (1 - (good / 9) ** 8) ** tries for tries in (100, 1000, 10_000)]
    told = ", ".join(f"{100 * chance:6.2f} %" for chance in chances)
    print(f"{good} of 9 right, 8 times in a row: {told} in 100, 1,000, 10,000 tries")
tried = bc.drive_episodes(bc.random_policy(np.random.default_rng(0)), bc.held_out_seeds(6, 5000))
print(f"5,000 random drives: {tried.success.sum()} end ahead of trap 1", end=", ")
print(f"{100 * np.mean(tried.accident > 0):.1f} % in an accident")

# %% [markdown]
# **See.** Chance is small and not zero: a few random drives do end ahead. But all
# {{ by_chance().success.sum() }} of these {{ len(by_chance().success) | , }} end in an accident
# later, each with a return below zero, which is less than doing nothing earns. So even the lucky
# drives do not show that leaving pays. And a learner does not act at random for long. What does the
# critic of such an agent expect in the first second?
# <!-- claim: (by_chance().accident[by_chance().success] > 0).all() -->
# <!-- claim: by_chance().returns[by_chance().success].max() < 0 < idle().rewards.sum() -->

# %%
start = by_rule.observations[:1]
q = alone.agents[0].q_values(start)[0]
title = "What the critic of plain SAC, seed 0, expects of each action"
bc.show(charts.action_bars({"sac: Q(s, a)": q.tolist()}, title, "value"))

# %%
temperature, policy = alone.agents[0].alpha, alone.agents[0].probabilities(start)[0]
likes, does = int(q.argmax()), int(policy.argmax())
print(f"α has fallen to {temperature:.5f}")
best, likeliest = bc.ACTION_NAMES[likes], bc.ACTION_NAMES[does]
print(f"the critic likes best: {best}, to which the actor gives {policy[likes]:.4f}")
print(f"the actor's likeliest: {likeliest}, with a probability of {policy[does]:.4f}")

# %% [markdown]
# **Explain.** By now the temperature is low and the policy is almost sure of its actions (lesson
# 4). The slope of a softmax is proportional to π: a tiny probability grows slowly, even where the
# critic gives that action the highest value. So the agent tries little that is new, and learns
# little that is new.
#
# A higher temperature alone is no cure: none of the
# {{ len(varied()['target entropy 1'].of('sac')) }} plain SAC agents that were trained with a target
# entropy of 1 escaped. A way out takes several right decisions in a row, and most other tries stay
# behind a trap or end in an accident. That is the **barrier**. An agent that learns from its own
# drives alone seldom gets across: of the study's {{ len(of('sac')) }} plain SAC agents
# {{ escaped('sac') }} escapes.
# <!-- claim: escaped_with('target entropy 1', 'sac') == 0 -->
# <!-- claim: escaped('sac') == 1 -->

# %% [markdown]
# ## Round 4: with the rule's help
#
# The rule escapes on all {{ roads() | , }} held-out roads. It earns
# {{ of('rule').scores('returns').mean() | .0f }} there, much less than the planner's
# {{ bound().mean() | .0f }}. The paper's method uses the rule twice. A **soft constraint** makes
# the agent pay for differing from the rule (lesson 7). **Demonstrations**, drives of the rule with
# a bonus on them, are mixed into what the agent learns from (lesson 8). Both fade.
# <!-- claim: of('rule').scores('success').min() == 1 -->

# %%
bc.show(figures.fading(bc.settings_for("bootstrapped")))

# %% [markdown]
# > **Predict.** Three agents, the same networks, γ = 0.8, the same number of updates, with the
# > rule's help. How many escape? Will they be worse than the rule, as good, or better?

# %%
with_rule = bc.Training(bc.with_seeds(bc.settings_for("bootstrapped"), SEEDS), episodes=20_000)
helped = with_rule.run(callback=figures.LiveCurves(), stop=lambda: with_rule.updates > UPDATES)
print(f"{helped.seconds:.0f} s, {with_rule.decisions:,} decisions")

# %% [markdown] tags=["instructor"] minutes=6
# "So it imitates." Have them compare the return with the rule's after 5,000 updates and again after
# three times as many (`UPDATES = 15_000`, some minutes), and the accidents: the rule has none. What
# does an agent give up when it becomes better than its teacher?
# <!-- claim: accidents('rule') == 0 -->

# %%
escaped_helped = table(helped.agents) >= bc.statistics.ESCAPES
rule_report = bc.evaluate(bc.rule_policy(bc.DEFAULT), 200, seed=5)
success = 100 * rule_report.success.value
print(f"the rule{success:28.1f}{rule_report.returns.value:8.1f}")

# %%
first = {name: values[:SEEDS, :500] for name, values in alone.curves.items()}
both = {"sac": first, "bootstrapped": {n: v[:, :500] for n, v in helped.curves.items()}}
title = f"With the rule's help {escaped_helped.sum()} of {SEEDS} agents escape, "
title += f"alone {escaped_alone[:SEEDS].sum()} of {SEEDS}"
bc.show(bc.training_curves(both, title, constants={"rule": {"return": rule_report.returns.value}}))

# %% [markdown]
# **Explain.** The demonstrations hold a way out from the first update on. The soft constraint keeps
# the agent near the rule while it learns what each second there is worth. So the agent does not
# have to find the way by chance. Afterwards, when both have faded, it may become better than the
# rule, or worse.
#
# > **Predict.** If three of three agents escape, could the true rate still be one in two?
#
# **Exercise 5.4 (5 min, ●●○).** n of n agents have succeeded. Which true rate would make that as
# unlikely as 2.5 %? Lower ones are ruled out: it is the lower end of the 95 % interval.


# %%
def lowest_rate(agents):
    """The lower end of the exact 95 % interval of n out of n. agents: n ≥ 1. Returns a rate."""
    # solution
    return 0.025 ** (1 / agents)
    # end solution


check.lowest_rate(lowest_rate)

# %%
for n in (3, 5, 10, 20):
    lowest = 100 * bc.statistics.rate(np.ones(n, bool)).low
    print(f"{n:2} of {n:2} agents: a true rate of {lowest:.0f} % or more")
for words, escaped in (("alone", escaped_alone[:SEEDS]), ("with the rule", escaped_helped)):
    value, low, high = (100 * number for number in bc.statistics.rate(escaped))
    print(f"{words}: {value:.0f} % of our agents escape, true rate in [{low:.0f}, {high:.0f}] %")

# %% [markdown]
# **See.** Three seeds are few. Suppose that the rule's help makes no difference, and that three of
# the six agents escape. Then chance decides which three. There are {{ math.comb(6, 3) }} ways to
# pick three of six, and in two of them the three are of one kind: even three of three against none
# of three comes about by chance once in {{ math.comb(6, 3) // 2 }} times. The study behind lesson 9
# trains ten agents of each kind.
# <!-- claim: len(of('bootstrapped')) == len(of('sac')) == 10 -->

# %% [markdown]
# ## Round 5: watch both drive
#
# > **Predict.** The same road, seed 0 of each kind. What does the speed of the one that learned
# > alone look like?

# %%
pair = [("sac", alone.agents[0]), ("bootstrapped", helped.agents[0])]
drives = [bc.record(agent.as_policy(with_q=True), [ROAD], label=label)[0] for label, agent in pair]
bc.show(bc.traces([*drives, by_rule]))

# %%
last = drives[1].times[-1]
bc.show(bc.top_view_over_time(drives[1], times=[t for t in (0, 4, 8, 12, 16, 24) if t <= last]))

# %% [markdown]
# **See.** Compare the speeds, and look at the lanes, too. A free lane alone brings no reward: the
# agent must also have learned that speed pays there.
#
# All that the second kind has in addition stands in these lines:

# %% tags=["nbval-ignore-output"]
source("bootcourse.learn.bootstrap", "kl_to_rule", "constraint_strength", "augmented_reward")

# %% [markdown]
# ## Round 6: your turn
#
# Here is the whole method with its numbers. *Train* trains in the background, for real; *Stop*
# keeps what was learned; a second training is drawn over the first; *Watch* replays in 3D what it
# drives.
#
# > **Predict.** Set ξ's multiplier to 0, so that only the demonstrations help. Does it still get
# > out? And with ξ, but without demonstrations (β = 0)?

# %% tags=["nbval-ignore-output"]
bc.panels.train_panel("bootstrapped", seeds=2, episodes=400)

# %% [markdown]
# **See.** Two agents and a few minutes make a guess, not a finding. Write yours down: lesson 9
# trains ten of each for longer, and counts.

# %% [markdown]
# ## What you now know
#
# 1. Most plain SAC agents stay behind trap 1 or crash:
#    {{ len(of('sac')) - escaped('sac') }} of the study's {{ len(of('sac')) }} do not escape, and of
#    their {{ of('sac').curves['success'].shape[1] | , }} training episodes each, at most
#    {{ np.sort(np.nansum(of('sac').curves['success'], 1))[-2] | .0f }} ended ahead.
# <!-- claim: np.nansum(of('sac').curves['success'], 1)[of('sac').scores('success') <
#   ESCAPES].max() == np.sort(np.nansum(of('sac').curves['success'], 1))[-2] -->
# 2. Leaving can pay at γ = 0.8, also for an agent that sees 26 numbers: trained agents escape and
#    earn more, discounted, than doing nothing does.
# 3. The rule's own way out does *not* pay at γ = 0.8: its drives, judged by their rewards, are no
#    reason to leave.
# <!-- claim: all(discounted(by_rule(road), 0.8) < discounted(idle(road), 0.8) for road in range(4))
#   -->
# 4. A random drive rarely ends ahead, and then still crashes; a policy that has become sure tries
#    little that is new.
# 5. With the rule as a constraint and as data, agents get across, and a method is judged over
#    seeds, on held-out roads, with its failures shown.
# <!-- claim: escaped('bootstrapped') > len(of('bootstrapped')) / 2 > escaped('sac') -->
#
# **Three questions to think about**
# - Would more exploration be enough? Raise `alpha_init`, or `target_entropy`: what happens to the
#   accidents?
# - Switch one of the two helps off: `settings_for("soft")` or `settings_for("demos")`. Which one
#   carries more?
# - Train `bootstrapped` for 1,500 episodes (some minutes). Do all seeds keep what they learned?
#   Look at α when one does not.
#
# **Read on**: lessons 6 to 8 take the two helps apart. Ecoffet et al., *First return, then explore*
# (arXiv 2004.12919), on why learners do not return to promising states; Haarnoja et al.,
# *Soft Actor-Critic* (arXiv 1801.01290).
