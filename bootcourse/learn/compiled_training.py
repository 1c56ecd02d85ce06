"""A whole training of one agent in compiled code: demonstrations, roads, replay, β and curves.

The same as training.py and its replay buffer, for the course's rule and scenarios of the default's size, with random
numbers of its own (SplitMix64). The page runs it as WebAssembly. `train` runs it natively, for tests and comparisons.
Arguments: agent, batch, s, work, plan, run, memory and curves are records of records.py (`AGENT`, `BATCHES`,
`COEFFICIENTS`, `WORK`, `PLAN` ...); c holds the scenario's numbers (constants.py).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bootcourse.errors import require, whole
from bootcourse.learn import records
from bootcourse.learn.agent import Agent
from bootcourse.learn.compiled import follow, forward, policy, strength, update
from bootcourse.learn.curves import NAMES
from bootcourse.learn.records import ACTIONS, BATCH, MOST_DEMONSTRATIONS, MOST_EPISODES, ROADS, SEEN
from bootcourse.learn.settings import Settings
from bootcourse.learn.vectorised import announce, vectorised
from bootcourse.road import twin
from bootcourse.road.constants import constants
from bootcourse.road.formulas import weighted_reward
from bootcourse.road.observation import observe
from bootcourse.road.state import EGO, SPEED, TRAP_1, X
from bootcourse.road.traffic import look_around, sort_by_x
from bootcourse.rule import decide_rule, track
from bootcourse.scenario import DEFAULT, Scenario

DECISIONS = DEFAULT.clock.decisions  # of an episode: 150
LAST = ROADS  # the road of the demonstrations
SUCCESS, RETURN, SPEEDS, DISTANCE, ACCIDENT, ENTROPY, ALPHA, XI, BETA, LENGTH = range(len(NAMES))  # columns of curves
A, R, TERMINATED, MU, NEXT_MU = range(2 * SEEN, 2 * SEEN + 5)  # columns of a row of the replay buffer
GOLDEN, FIRST, SECOND = np.uint64(0x9E3779B97F4A7C15), np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB)
BY_30, BY_27, BY_31, BY_11 = np.uint64(30), np.uint64(27), np.uint64(31), np.uint64(11)
SPACING = 2.0**-53
WATCHED = 50  # decisions on each road between two looks at an agent in training


@vectorised
def uniform(run):
    """A random number in [0, 1) by SplitMix64 (Steele, Lea and Flood 2014), whose state is run.random."""
    run.random += GOLDEN
    z = run.random
    z = (z ^ (z >> BY_30)) * FIRST
    z = (z ^ (z >> BY_27)) * SECOND
    return ((z ^ (z >> BY_31)) >> BY_11) * SPACING


@vectorised
def draw_first(run, weights, rows, columns, inputs):
    """First weights or biases, uniform within ±1/√inputs (torch's default), in the part that is not padding."""
    for i in range(rows):
        for j in range(columns):
            weights.m[i, j] = (2 * uniform(run) - 1) / math.sqrt(inputs)


@vectorised
def draw_network(run, network):
    """The first weights and biases of a network."""
    hidden = network.w_2.m.shape[0]
    draw_first(run, network.w_1, hidden, SEEN, SEEN)
    draw_first(run, network.b_1, 1, hidden, SEEN)
    draw_first(run, network.w_2, hidden, hidden, hidden)
    draw_first(run, network.b_2, 1, hidden, hidden)
    draw_first(run, network.w_3, ACTIONS, hidden, hidden)
    draw_first(run, network.b_3, 1, ACTIONS, hidden)


@vectorised
def place(run, road, c):
    """Set a road to a new start, and what the agent sees and the rule would do there."""
    for i in range(len(run.uniforms)):
        run.uniforms[i] = uniform(run)
    twin.place(run.uniforms, c, run.cars[road])
    look(run, road, c)


@vectorised
def look(run, road, c):
    """Set what the agent sees on a road, s, and what the rule would do there, μ(s)."""
    observe(run.cars[road], c, run.seen[road])
    run.rule_actions[road] = rule_action(run, road, c)


@vectorised
def rule_action(run, road, c):
    """μ(s), the rule's action on a road, as `rule.drive_rule`."""
    sort_by_x(run.cars[road], run.order)
    look_around(run.cars[road], run.order, run.around, c)
    speed, lane, _, _ = decide_rule(run.cars[road], run.around, c)
    return track(run.cars[road], speed, lane, c)


@vectorised
def decide(run, road, action, c):
    """One decision on a road, as `twin.decide`: (reward, accident)."""
    cars = run.cars[road]
    twin.command(cars, action, c)
    sort_by_x(cars, run.order)
    accident = twin.NO_ACCIDENT
    for _ in range(c.steps):
        if accident == twin.NO_ACCIDENT:
            accident = twin.simulate(cars, run.order, run.around, run.directions, c)
    if accident != twin.NO_ACCIDENT:
        return c.accident, accident
    r_v, r_y, r_theta = twin.reward_terms(cars, c)
    return weighted_reward(r_v, r_y, r_theta, c.w_v, c.w_y, c.w_theta), accident


@vectorised
def drive(run, road, action, memory, number, c):
    """One decision on a road, which becomes row `number` of the memory: (reward, accident)."""
    row = memory.rows[number]
    for k in range(SEEN):
        row[k] = run.seen[road, k]
    row[A], row[MU] = action, run.rule_actions[road]
    reward, accident = decide(run, road, action, c)
    look(run, road, c)
    for k in range(SEEN):
        row[SEEN + k] = run.seen[road, k]
    row[R], row[TERMINATED], row[NEXT_MU] = reward, accident != twin.NO_ACCIDENT, run.rule_actions[road]
    return reward, accident


@vectorised
def demonstrate(run, memory, s, plan, c, most):
    """Drive up to `most` more episodes of demonstrations by the rule, or by its stochastic form π̃ (Equation 16)."""
    for _ in range(most):
        if run.demonstrated >= plan.demonstration_episodes:
            return
        place(run, LAST, c)
        for _ in range(DECISIONS):
            action = run.rule_actions[LAST]
            if plan.stochastic_demonstrations > 0 and uniform(run) >= math.exp(s.log_p):
                action = (action + 1 + int(uniform(run) * (ACTIONS - 1))) % ACTIONS
            _, accident = drive(run, LAST, action, memory, run.demonstrations, c)
            run.demonstrations += 1
            if accident != twin.NO_ACCIDENT:
                break
        run.demonstrated += 1


@vectorised
def beta(run, plan):
    """β, the share of demonstrations in a batch: linear from beta_start to 0 (Section IV-B)."""
    return plan.beta_start * min(max(1 - run.finished / plan.beta_episodes, 0.0), 1.0)


@vectorised
def sample(run, memory, batch, plan):
    """Draw a batch: a share β of demonstrations, the rest from the agent's own transitions."""
    demonstrations = int(beta(run, plan) * BATCH + 0.5)
    for i in range(BATCH):
        if i < demonstrations:
            row = memory.rows[int(uniform(run) * run.demonstrations)]
        else:
            row = memory.rows[MOST_DEMONSTRATIONS + int(uniform(run) * run.size)]
        for k in range(SEEN):
            batch.states.m[i, k], batch.next_states.m[i, k] = row[k], row[SEEN + k]
        batch.actions[i], batch.rewards[i], batch.terminated[i] = int(row[A]), row[R], row[TERMINATED]
        batch.rule_actions[i], batch.next_rule_actions[i] = int(row[MU]), int(row[NEXT_MU])
        batch.is_demonstration[i] = i < demonstrations


@vectorised
def draw_action(run, road):
    """An action drawn from π, by inverse transform sampling."""
    left = uniform(run)
    for a in range(ACTIONS - 1):
        left -= run.pi.m[a, road]
        if left < 0:
            return a
    return ACTIONS - 1


@vectorised
def note(agent, run, road, reward, accident, s, plan, curves):
    """Record a decision in the sums of its episode and, at the episode's end, in the curves. Returns whether it ended.

    The last column of `curves` is written last: whoever reads while this runs sees whole rows.
    """
    entropy = 0.0
    for a in range(ACTIONS):
        entropy -= run.pi.m[a, road] * run.log_pi.m[a, road]
    cars = run.cars[road]
    run.decided[road] += 1
    run.earned[road] += reward
    run.speeds[road] += cars[EGO, SPEED]
    run.entropies[road] += entropy
    if accident == twin.NO_ACCIDENT and run.decided[road] < DECISIONS:
        return False
    if run.finished < min(plan.episodes, MOST_EPISODES):
        row, decided, alpha = curves.values[run.finished], run.decided[road], math.exp(agent.log_alpha)
        row[SUCCESS], row[ACCIDENT] = cars[EGO, X] > cars[TRAP_1, X], accident
        row[RETURN], row[DISTANCE] = run.earned[road], cars[EGO, X]
        row[SPEEDS], row[ENTROPY], row[LENGTH] = run.speeds[road] / decided, run.entropies[road] / decided, decided
        row[ALPHA], row[BETA] = alpha, beta(run, plan)
        row[XI] = strength(alpha, s)
    run.finished += 1
    run.decided[road] = 0
    run.earned[road] = run.speeds[road] = run.entropies[road] = 0.0
    return True


@vectorised
def step(agent, batch, s, work, plan, run, memory, curves, c):
    """One decision on every road, and the updates after it, as `Training.step`."""
    for road in range(plan.envs_per_agent):
        for k in range(SEEN):
            run.states.m[k, road] = run.seen[road, k]
    forward(agent.actor, run.states, run.layers)
    policy(run.layers.out, run.pi, run.log_pi)
    for road in range(plan.envs_per_agent):
        action = draw_action(run, road)
        reward, accident = drive(run, road, action, memory, MOST_DEMONSTRATIONS + run.next, c)
        run.next = (run.next + 1) % plan.buffer_size
        run.size = min(run.size + 1, plan.buffer_size)
        if note(agent, run, road, reward, accident, s, plan, curves):
            place(run, road, c)
    run.decisions += plan.envs_per_agent
    if run.decisions >= plan.learning_starts:
        for _ in range(plan.updates):
            sample(run, memory, batch, plan)
            update(agent, batch, s, work)
            run.updates += 1


@vectorised
def begin(agent, plan, run, seed, c):
    """Set an agent with a log α and a run, both zero elsewhere, to the start of a training with this seed."""
    run.random = np.uint64(seed)
    draw_network(run, agent.actor)
    draw_network(run, agent.critic_1)
    draw_network(run, agent.critic_2)
    follow(agent.target_1, agent.critic_1, np.float32(1))
    follow(agent.target_2, agent.critic_2, np.float32(1))
    agent.fade_1 = agent.fade_2 = 1.0
    for i in range(len(run.order)):
        run.order[i] = i
    for road in range(plan.envs_per_agent):
        place(run, road, c)


@vectorised
def advance(agent, batch, s, work, plan, run, memory, curves, c, most):
    """Up to `most` decisions on every road; none after the last episode."""
    for _ in range(most):
        if run.finished >= plan.episodes:
            return
        step(agent, batch, s, work, plan, run, memory, curves, c)


@vectorised
def begin_first(agents, plans, runs, seed, c):
    """`begin` for the first record of each array."""
    begin(agents[0], plans[0], runs[0], seed, c)


@vectorised
def demonstrate_first(runs, memories, settings, plans, c, most):
    """`demonstrate` for the first record of each array."""
    demonstrate(runs[0], memories[0], settings[0], plans[0], c, most)


@vectorised
def advance_first(agents, batches, settings, works, plans, runs, memories, curves, c, most):
    """`advance` for the first record of each array."""
    advance(agents[0], batches[0], settings[0], works[0], plans[0], runs[0], memories[0], curves[0], c, most)


@dataclass(frozen=True)
class Trained:
    """The result of `train`."""

    agent: Agent
    curves: dict[str, np.ndarray]  # each (episodes,): see curves.py


def plan_of(settings: Settings, episodes: int) -> np.ndarray:
    """A `PLAN` record, (1,). Raises BootcourseError for settings or a number of episodes that are not accepted."""
    records.check_accepted(settings)
    sizes = {"envs_per_agent": ROADS, "buffer_size": records.BUFFER, "demonstration_episodes": 200}
    for name, most in sizes.items():
        require(getattr(settings, name) <= most, f"{name} = {getattr(settings, name)}: give at most {most} here.")
    plan = np.zeros(1, records.PLAN)
    for name in records.PLAN.names[2:]:
        plan[name] = np.inf if getattr(settings, name) is None else getattr(settings, name)
    plan["episodes"] = whole(episodes, "episodes", MOST_EPISODES, low=1)
    plan["beta_start"] = settings.beta_start
    return plan


def train(
    settings: Settings,
    episodes: int = 1000,
    scenario: Scenario = DEFAULT,
    watch: Callable[[int, Agent], None] | None = None,
) -> Trained:
    """Train one agent on the trap, taught by the course's rule.

    watch: called before the first update and then every few episodes, with the number of episodes that have ended and
    the agent as it is then; it changes nothing.
    Its curves are not those of `Training` with this seed, whose random numbers are others. With the same random
    numbers on one road both loops drive and learn the same (tests/test_compiled_training.py).
    Raises BootcourseError for settings that the compiled learner does not accept, and for a scenario of another size.
    """
    same = (scenario.vehicles, scenario.road.lanes, scenario.observation_size, scenario.clock.decisions)
    needed = (records.VEHICLES, records.LANES, SEEN, DECISIONS)
    sizes = "cars, lanes, numbers seen and decisions"
    require(same == needed, f"Scenario '{scenario.name}' has {same} {sizes}: the compiled training has {needed}.")
    plan, s, c = plan_of(settings, episodes), records.coefficients(settings), constants(scenario)
    kinds = (records.AGENT, records.BATCHES, records.WORK, records.RUN, records.MEMORY, records.CURVES)
    agents, batches, works, runs, memories, curves = (np.zeros(1, kind) for kind in kinds)
    agents["log_alpha"] = math.log(settings.alpha_init)
    announce(advance_first, 40)
    begin_first(agents, plan, runs, settings.seed, c)
    if settings.needs_demonstrations:
        demonstrate_first(runs, memories, s, plan, c, settings.demonstration_episodes)
    while runs["finished"][0] < episodes:
        if watch:
            watch(int(runs["finished"][0]), records.agent_of(settings, agents, 0))
        most = WATCHED if watch else 1000  # decisions after which an interrupt acts
        advance_first(agents, batches, s, works, plan, runs, memories, curves, c, most)
    values = curves["values"][0, :episodes].T.astype(np.float64)
    return Trained(records.agent_of(settings, agents, 0), dict(zip(NAMES, values, strict=True)))
