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
# # Your own problem
#
# Does a teacher help elsewhere, too? Each round ends on your own problem.
#
# **What you will be able to do**
# - give an agent a teacher in an environment of your choice, and compare methods fairly;
# - predict from a teacher's errors whether cloning is enough;
# - compute from which bonus on a loop pays more than the goal.
#
# **Time** 45 minutes, without your own problem and the challenge; running it takes about half a
# minute. **It builds on** lessons [[soft_constraint]], [[learning_from_demonstrations]] and
# [[your_teacher]].

# %%
import bootcourse as bc
import gymnasium as gym
from bootcourse.course import (
    check,
    compare_predictions,
    own_code,
    predict,
    predicted,
    progress,
)
from bootcourse.course.lessons.your_own_problem import explorable, figures, loops
from bootcourse.research.problems import PROBLEMS

progress("your_own_problem")

# %% [markdown]
# ## Look first
#
# MountainCar is a car in a valley. It pays −1 per decision until the car reaches the flag, at
# position 0.5, or 200 decisions are over.

# %%
bc.show(figures.climbs())

# %% [markdown]
# **See.** Always pushed to the right, the car stays in the valley: it first has to drive *away* from
# the flag. The reward does not say so: all drives that miss the flag earn the same. Where does the
# other rule push to the left, where to the right?
# <!-- claim: loops.climbed(lambda position, speed: 2).max() < 0 -->
# <!-- claim: loops.climbed(lambda position, speed: 2 if speed >= 0 else 0)[-1] >= 0.5 -->

# %% [markdown]
# ## Round 1: does a teacher help?
#
# **Exercise (8 min, ●●○).** Write the rule of MountainCar. All 20 episodes must reach the flag.


# %%
def climb_rule(position, speed):
    """0: push left, 1: not at all, 2: right. position: flag at 0.5; speed: + to the right."""
    # solution: the exercise's own


check.climb_rule(climb_rule)

# %% [markdown]
# Now your rule is the teacher. `bc.compare` trains five agents of each method and tests them in the
# same episodes. Look for three things:
#
# - *Equal decisions*: with equal episodes, an agent that finds the flag sooner would practise less.
# - *Controls*: plain SAC has no teacher, and the clone has nothing else.
# - *Intervals* over agents, not episodes: of length 0 where all score alike.

# %% tags=["nbval-ignore-output"]
climb = own_code.yours_or_ours("climb_rule", doing="Teaching")
methods = {
    "plain SAC": bc.settings_for("sac", gamma=0.99),
    "clone": bc.settings_for("bc"),
    "soft constraint": bc.settings_for("soft", gamma=0.99),
}
how = {"seeds": 5, "tests": 10, "progress": False}
car, teacher = PROBLEMS["mountain-car"].make_env, loops.teacher(climb)
bc.compare(methods, decisions=1_000, make_env=car, teacher=teacher, **how)

# %% [markdown]
# **See.** After 1,000 decisions, five episodes, hardly any drive without a teacher reaches the flag.
# With one, many do.
# <!-- claim: score('mountain-car', 'good', 'SAC') == 0 and min(score('mountain-car', 'good', m) for
#   m in ('cloning', 'soft')) > 0.9 and abs(score('mountain-car', 'good', 'soft', 'returns') -
#   score('mountain-car', 'good', 'cloning', 'returns')) < 5 -->
#
# **On yours.** Take any gymnasium environment with vector observations of order one and discrete
# actions, and write a rule. Ours is CartPole (balance a pole: 1 per decision, at most 500), with a
# rule that looks at the pole's angle alone. Does your reward tell early drives apart?


# %% tags=["nbval-ignore-output"]
def pole(n):
    return gym.make_vec("CartPole-v1", n, vectorization_mode="sync")


def angle_rule(seen):
    return int(seen[2] > 0)  # push to where the pole leans


my_env, own_rule = pole, angle_rule  # yours
print(f"the rule itself earns {loops.earns(own_rule, my_env):.0f}")
aided = bc.compare(methods, decisions=1_000, make_env=my_env, teacher=own_rule, **how)
print(aided)

# %% [markdown] tags=["instructor"] minutes=5
# Collect problems of their own first: what is the reward, does it tell early drives apart, who can
# write a rule? Then ask of each rule which kind of error it makes. Rules that people write may err
# systematically: they forget a situation.

# %% [markdown]
# ## Round 2: did the agents need the reward?
#
# On CartPole agents with the soft constraint earned far more than their teacher. With γ = 0 they do
# not look ahead, and CartPole pays 1 in each decision, whatever they do: they can learn from their
# teacher alone.
#
# > **Predict.** Five such agents have the soft constraint to the angle rule. We test them after
# > 500, 1,000 and 3,000 decisions. Do they earn more than the rule, and when most?

# %%
choices = ["at most as much", "more, and most after 1,000", "more, and most after 3,000"]
predict("your_own_problem.1", "Do agents without reward earn more than their teacher?", choices)

# %% tags=["nbval-ignore-output"]
blind, budgets = bc.settings_for("soft", gamma=0.0), (500, 1_000, 3_000)
tested = loops.tested_at(budgets, blind, pole, angle_rule)
predicted("your_own_problem.1")
bc.show(figures.edges(tested))

# %% [markdown]
# **Explain.** These agents needed no reward to do better than their teacher: after 1,000 decisions
# they earn about what those with γ = 0.99 did. At first their edge is almost flat: they go by the
# pole's speed. Then it turns towards the teacher's, and passes angle + speed = 0: a rule with that
# edge earns {{ speed_rule_earns() | .0f }}. From there on, the better they copy the teacher, the less
# they earn. *A number at one budget can mislead: test at several.* Why the edge begins flat stays
# open.
# <!-- claim: speed_rule_earns() > 450 -->
#
# **On yours:** the same budgets, the reward set to 0 if it depends on the action; then Round 1's
# table again.

# %% tags=["nbval-ignore-output"]
for decisions, (_, earned) in loops.tested_at(budgets, blind, my_env, own_rule).items():
    print(f"{decisions:,} decisions: return {earned.mean():.0f}")
print(aided)

# %% [markdown]
# ## Round 3: what if the teacher errs?
#
# A **random** teacher takes a wrong action in some states, chosen as if at random, and always the
# same there. On MountainCar it is right in {{ 100 *
# elsewhere_claims.PROBLEMS['mountain-car'].right | .0f }} % of the *states*. A **systematic** one
# errs in one region: on MountainCar at each position above 0.1. A good teacher is the rule without
# errors, not the best: CartPole's heeds the pole's speed a little, and earns {{ score("cartpole",
# "good", "the teacher", "returns") | .0f }}.
# <!-- claim: PROBLEMS['cartpole'].teachers()['good'](np.array([[0, 0, 0.1, -1.0]]))[0] == 0 -->
#
# > **Predict.** On MountainCar our rule, the good teacher, earns {{ earned('good') | .0f }}, and
# > the random one {{ earned('random') | .0f }}. A network clones the random one, and drives by its
# > most probable action. What does the clone earn?

# %%
choices = ["less than its teacher", "about as much as its teacher", "about as much as the good one"]
predict("your_own_problem.2", "What does the clone of the random teacher earn?", choices)

# %%
predicted("your_own_problem.2")
bc.show(figures.returns())

# %% [markdown]
# **See.** The clones of a random teacher earn about what the good one does, or more. Those of a
# systematic one earn about what their teacher does, or less.
#
# *Which way is better depends on the problem*, here after equal episodes, not decisions: with the
# random teacher each agent with the soft constraint beats each clone on CartPole, none on Lunar
# lander.
# <!-- claim: all(cells().scores(p, 'random', low).max() < cells().scores(p, 'random', high).min()
#   for p, low, high in (('cartpole', 'cloning', 'soft'), ('lander', 'soft', 'cloning'))) -->
# <!-- claim: {len(cells().scores(p, t, m)) for p, t in SHOWN for m in (*TWO, 'SAC')} == {10} -->
# <!-- claim: all(score(p, 'random', 'cloning', 'returns') > score(p, 'random', 'the teacher',
#   'returns') + 20 and score(p, 'random', 'cloning', 'returns') > score(p, 'good', 'the teacher',
#   'returns') - (10 if p == 'mountain-car' else 25) for p in THREE) -->
# <!-- claim: all(score(p, 'systematic', 'cloning', 'returns') < score(p, 'systematic', 'the
#   teacher', 'returns') + 10 for p in THREE) -->
#
# **Drag** *reach*: each square does what most squares around it say. The line is a drive, a spiral
# out of the valley. Which errors vanish, and which stay?

# %%
explorable.votes()

# %% [markdown]
# **See.** With reach 1 all drives by the random teacher's map reach the flag. The block of the
# systematic one stays: there the majority is wrong. A clone that has to give alike states one
# action takes the majority's, too.
# <!-- claim: [explorable.reached(t, 70, r) for t, r in (('random', 0), ('random', 1), ('systematic',
#   0), ('systematic', 1))] == [8, 20, 15, 15] -->
#
# **On yours.** In which states does your rule err? Does its clone earn more than it does, after twice
# the decisions, too?

# %% tags=["nbval-ignore-output"]
bc.compare({"clone": methods["clone"]}, decisions=2_000, make_env=my_env, teacher=own_rule, **how)

# %% [markdown] tags=["instructor"] minutes=6
# Ask before the picture: on which problem will a clone be better than an agent with the soft
# constraint? Ask what equal episodes mean on CartPole: there an agent that balances longer also
# practises more. The angle rule errs in one region: where the pole leans to one side and falls to
# the other. After 2,000 decisions its clones earn less than after 1,000: test at several budgets.

# %% [markdown]
# ## Round 4: how large may the bonus be?
#
# In DoorKey an agent fetches a key, opens a door and walks to a goal, in at most 100 decisions. The
# goal pays at most 1, the sooner the more; nothing else pays. Here a random teacher drives:

# %%
bc.show(figures.room(loops.drive_in_a_loop(), "This drive of the random teacher ends in a loop"))

# %% [markdown]
# The teacher errs in a state *whenever it comes back to it*, so some of its drives end in a loop.
# In a demonstration each decision pays the bonus c, in the loop, too.
#
# > **Predict.** Agents learn from this teacher by both aids, soft constraint and demonstrations,
# > with the paper's c = 2. Do they reach the goal more often than agents of plain SAC?

# %%
choices = ["less often than plain SAC", "about as often", "more often"]
predict("your_own_problem.3", "How often do agents with both aids reach the goal?", choices)

# %%
predicted("your_own_problem.3")
bc.show(figures.bonuses())

# %% [markdown]
# **See.** With c = 2 and a flawed teacher hardly any drive reaches the goal; of plain SAC's
# {{ 100 * cells().mean('doorkey', 'none', 'SAC', 'drawn_success') | .0f }} % do. With the good teacher
# nearly all do at each c.
#
# Here the random teacher's clones are no better than it is ({{ 100 * score('doorkey', 'random',
# 'the teacher') | .0f }} %): perhaps the few states are too unlike to outvote an error.
# <!-- claim: all(np.diff(by_bonus(t)).max() < 0 and round(100 * by_bonus(t)[-1]) == 0 for t in
#   ('random', 'systematic')) and by_bonus('good').min() > 0.99 -->
# <!-- claim: (cells().scores('doorkey', 'good', 'demonstrations', 'drawn_success') == [0] *
#   10).all() and max(cells().scores('doorkey', 'random', 'cloning', m).mean() for m in ('success',
#   'drawn_success')) <= score('doorkey', 'random', 'the teacher') and score('doorkey', 'good', 'the teacher') == 1 -->

# %% [markdown]
# **Drag** c until the loop is worth as much as the way to a goal of 1. Does a longer way change
# this c?

# %%
explorable.loop_or_goal()

# %% [markdown]
# **Exercise (15 min, ●●●).** A loop earns `reward` + c in each decision, for ever: the time limit
# is no end for the critic (lesson [[update_and_loop]]). The way to the goal has `decisions`
# decisions. Each earns `reward` + c, too, and the last one also `goal`; then the episode ends. At
# which c are both worth the same, discounted?


# %%
def drowning_bonus(reward, goal, decisions, gamma):
    """The c above which the loop is worth more than the way to the goal."""
    # solution: the exercise's own


check.drowning_bonus(drowning_bonus)

# %% [markdown]
# **Explain.** For a fixed goal your threshold is the same however long the way is: here at most
# {{ drowning_bonus(0, 1, 1, PROBLEMS['doorkey'].gamma) | .2f }}. *It is a warning, not an edge*: in
# training the share of demonstrations fades, and with it the part that is paid c. With the random
# teacher {{ 100 * by_bonus('random')[2] | .0f }} % of drives still reach the goal at c = 0.1.
# <!-- claim: math.isclose(drowning_bonus(0, 1, 1, 0.97), drowning_bonus(0, 1, 90, 0.97)) -->
# <!-- claim: list(BONUSES)[2] == 'c = 0.1' -->
#
# **On yours.** Exchange the numbers, which are MountainCar's. Do states come back? What if there is
# no goal?

# %%
threshold = own_code.yours_or_ours("drowning_bonus", doing="Computing")
threshold(-1, 0, 120, 0.99)  # reward, goal, decisions, gamma

# %% [markdown] tags=["instructor"] minutes=6
# Ask for a bonus that cannot be earned in a circle. A potential (lesson [[the_second_trap]]) is
# one: what a circle gains it gives back.

# %% [markdown]
# **Before you believe a result on yours:**
#
# 1. *Is there a barrier?* Give plain SAC more decisions and η = 0.3 log(actions) first.
# 2. *What taught the agents?* Train without reward, too.
# 3. *Which kind of error?* If it is random and each state has many alike, the clone may be enough.

# %%
compare_predictions(
    "your_own_problem",
    {
        1: "more, and most after 1,000",
        2: "about as much as the good one",
        3: "less often than plain SAC",
    },
)

# %% [markdown]
# ## The challenge
#
# Train drivers for the course's road, with any learner, teacher and training reward.
#
# - **Budget.** Five agents, seeds 0 to 4, one setting. Each makes {{ equal_decisions.BOARD | , }}
#   decisions in training; demonstrations are free.
# - **Test.** 1,000 held-out roads, drawn after everybody has handed in. An agent drives alone, by
#   its most probable actions.
# - **Hand in** the folder that `bc.save_runs(result, "challenge")` writes, and one page: what you
#   changed and why; what you predicted; your table, with intervals, accidents, plain SAC and the
#   clone; one thing that did not work; the decisions of all your tries.
# - **Rank.** By return. Entries that a rank test (lesson [[your_teacher]]) cannot tell from the best
#   share its place; the page decides. An entry with a teacher must beat its teacher's clone.
#
# `enter` trains an example. The board shows untrained drivers.


# %% tags=["nbval-ignore-output"]
def enter(decisions):
    settings = bc.with_seeds(bc.settings_for("ppo_cloned", gamma=0.97, batch=512), 5)  # yours
    entry = bc.Training(settings, episodes=50_000)
    return entry.run(progress=False, stop=lambda: entry.decisions >= decisions * len(settings))


bc.board(block=2026)  # with a tenth of the budget: bc.board(enter(20_000), block=2026)

# %% [markdown]
# ## What you now know
#
# 1. Where no reward tells drives apart, a teacher can show the way. Compare at equal decisions,
#    with controls: plain SAC, the clone.
# 2. To know whether an agent needs the reward, train it without. Test at several budgets.
# 3. A clone can outvote random errors where states are alike; systematic ones stay. Whether it
#    beats the soft constraint depends on the problem.
# 4. A bonus for each decision can make a loop worth more than the goal.
#
# **Three questions to think about**
# - Which systematic error of the course's rule did the agents correct?
# - The course's road has no goal that ends the drive. What then bounds c?
# - On DoorKey, with the good teacher's demonstrations *alone*, {{ 100 * score('doorkey', 'good',
#   'demonstrations, c = 0', 'drawn_success') | .0f }} % of drives reach the goal with c = 0, and none
#   with c = 2. They hold no loop. What could pay c again and again?

# %% [markdown] tags=["instructor"] minutes=5
# Answers to the three questions. (1) Its sight of 200 m keeps it slow behind the traffic; all good
# agents drive faster. (2) The formula gives no threshold there; what counts is which states are
# paid. Staying behind trap 1 pays about 0.16 a decision and never ends, so every c > 0 that is paid
# there for ever would help staying; the demonstrations leave the trap, so they pay for leaving. (3)
# Open. A guess: a step back and forth, if both steps are in demonstrations. How would one test it?

# %% [markdown]
# **Read on**: the report's page *When does a sub-optimal teacher help?*,
# `assets/report/elsewhere.md`. Chevalier-Boisvert et al., *Minigrid & Miniworld* (arXiv
# 2306.13831), where DoorKey is from.

# %% [markdown] tags=["instructor"]
# **On the board.** A table: problems as rows, methods as columns, a colour for the share of the gap
# that is closed; one row left empty for the room's own problem.
#
# **To discuss.** Whose rule errs at random, and whose systematically?
