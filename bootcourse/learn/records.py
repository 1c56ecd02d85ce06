"""The records that the compiled learner works on: one numpy dtype each for an agent, its batch, settings and work.

All shapes stand in these dtypes, so compiled code knows them, and an argument is one pointer. They are those of the
default scenario and settings: 26 numbers seen, two hidden layers of 64, nine actions, batches of 64. Nine and 26 are
padded with zeros to multiples of four; the padding's slopes stay 0.
"""

import math

import numpy as np
import torch

from bootcourse.errors import require
from bootcourse.learn.agent import Agent
from bootcourse.learn.curves import NAMES
from bootcourse.learn.networks import init_mlp
from bootcourse.learn.protocol import generators_of
from bootcourse.learn.replay_buffer import Batch
from bootcourse.learn.settings import Settings
from bootcourse.methods import METHODS, SAC
from bootcourse.road.state import COLUMNS
from bootcourse.road.twin import uniforms_needed
from bootcourse.scenario import DEFAULT, N_ACTIONS

BATCH, HIDDEN = 64, 64
SEEN, PADDED_SEEN = DEFAULT.observation_size, 32  # 26 numbers
ACTIONS, PADDED_ACTIONS = N_ACTIONS, 12  # 9 actions


def matrix(rows: int, columns: int) -> np.dtype:
    """A record with one matrix, `m` (rows, columns) float32, so that its shape is part of its type."""
    return np.dtype([("m", np.float32, (rows, columns))], align=True)


def record(**fields) -> np.dtype:
    """A record with these fields."""
    return np.dtype(list(fields.items()), align=True)


REAL, LONG, WHOLE = np.float32, np.float64, np.int64
OF_STATES, OF_HIDDEN, OF_ACTIONS = (matrix(rows, BATCH) for rows in (PADDED_SEEN, HIDDEN, PADDED_ACTIONS))

NETWORK = record(  # weights (outputs, inputs) and biases of the three layers, y = W x + b
    w_1=matrix(HIDDEN, PADDED_SEEN),
    b_1=matrix(1, HIDDEN),
    w_2=matrix(HIDDEN, HIDDEN),
    b_2=matrix(1, HIDDEN),
    w_3=matrix(PADDED_ACTIONS, HIDDEN),
    b_3=matrix(1, PADDED_ACTIONS),
)
MOMENTS = record(mean=NETWORK, square=NETWORK)  # Adam's moving averages of the slopes and of their squares
AGENT = record(
    actor=NETWORK,
    critic_1=NETWORK,
    critic_2=NETWORK,
    target_1=NETWORK,
    target_2=NETWORK,
    actor_moments=MOMENTS,
    critic_1_moments=MOMENTS,
    critic_2_moments=MOMENTS,
    log_alpha=REAL,
    log_alpha_mean=REAL,  # Adam's
    log_alpha_square=REAL,
    fade_1=LONG,  # 0.9 to the power of the number of updates
    fade_2=LONG,  # 0.999 to that power
)
BATCHES = record(  # as replay_buffer.Batch
    states=matrix(BATCH, PADDED_SEEN),
    next_states=matrix(BATCH, PADDED_SEEN),
    actions=(WHOLE, BATCH),
    rewards=(REAL, BATCH),
    terminated=(REAL, BATCH),
    rule_actions=(WHOLE, BATCH),
    next_rule_actions=(WHOLE, BATCH),
    is_demonstration=(REAL, BATCH),
)
COEFFICIENTS = record(  # of the update: an agent's `Settings`; units and sources stand there
    gamma=REAL,
    target_entropy=REAL,
    xi_multiplier=REAL,
    xi_fixed=REAL,  # NaN: ξ follows α
    xi_min=REAL,
    kl_in_target=REAL,  # 0 or 1
    log_p=REAL,  # log π̃ of the rule's action
    log_others=REAL,  # and of each other
    bonus=REAL,
    margin=REAL,
    paper_q_filter=REAL,  # 0 or 1
    actor_lr=REAL,
    critic_lr=REAL,
    alpha_lr=REAL,
    tau=REAL,
)
LAYERS = record(one=OF_HIDDEN, two=OF_HIDDEN, out=OF_ACTIONS)  # what a network's layers hold: a column is a state's
LOSSES = ("critic_loss", "actor_loss", "temperature_loss", "entropy", "kl", "alpha", "xi")  # as SACLearner.losses
WORK = record(  # room for one update, and the slopes and losses that it leaves behind
    actor=LAYERS,
    critic_1=LAYERS,
    critic_2=LAYERS,
    states=OF_STATES,  # the transpose of the batch's
    pi=OF_ACTIONS,
    log_pi=OF_ACTIONS,
    targets=(REAL, BATCH),
    out_slopes=OF_ACTIONS,  # of a loss in what a network's layers hold
    two_slopes=OF_HIDDEN,
    one_slopes=OF_HIDDEN,
    hidden_across=matrix(BATCH, HIDDEN),  # transposes
    w_2_across=matrix(HIDDEN, HIDDEN),
    w_3_across=matrix(HIDDEN, PADDED_ACTIONS),
    actor_slopes=NETWORK,
    critic_1_slopes=NETWORK,
    critic_2_slopes=NETWORK,
    **dict.fromkeys(LOSSES, REAL),
)

# Of a whole training (compiled_training.py), of one agent:
ROADS, VEHICLES, LANES = 4, DEFAULT.vehicles, DEFAULT.road.lanes  # roads that the agent drives at the same time
BUFFER, MOST_DEMONSTRATIONS, MOST_EPISODES = 50_000, 200 * DEFAULT.clock.decisions, 5_000
ROW = 2 * SEEN + 5  # of the replay buffer: see replay_buffer.py
OF_ROADS, OF_ROADS_HIDDEN, OF_ROADS_ACTIONS = (matrix(rows, ROADS) for rows in (PADDED_SEEN, HIDDEN, PADDED_ACTIONS))

PLAN = record(  # of the training: an agent's `Settings`, and the number of episodes
    episodes=WHOLE,
    beta_start=REAL,
    beta_episodes=REAL,  # infinity: β stays
    demonstration_episodes=WHOLE,
    stochastic_demonstrations=WHOLE,  # 0 or 1
    envs_per_agent=WHOLE,  # at most `ROADS`
    updates=WHOLE,
    learning_starts=WHOLE,
    buffer_size=WHOLE,  # at most `BUFFER`
)
RUN = record(  # the state of the training, and room for one decision
    random=np.uint64,  # of SplitMix64
    decisions=WHOLE,  # of the agent, on all its roads together
    updates=WHOLE,
    finished=WHOLE,  # episodes, as in curves.py
    demonstrations=WHOLE,  # rows of the memory with demonstrations
    demonstrated=WHOLE,  # episodes
    size=WHOLE,  # rows of the memory with the agent's own transitions
    next=WHOLE,  # the row that is written next, counted from the first of these
    cars=(LONG, (ROADS + 1, VEHICLES, COLUMNS)),  # the last road is the demonstrations'
    order=(WHOLE, VEHICLES),
    around=(WHOLE, (LANES, VEHICLES, 2)),
    directions=(LONG, (VEHICLES, 2)),
    uniforms=(LONG, uniforms_needed(VEHICLES)),
    seen=(REAL, (ROADS + 1, SEEN)),
    rule_actions=(WHOLE, ROADS + 1),  # μ(s)
    decided=(WHOLE, ROADS),  # decisions of the running episodes, and their sums of
    earned=(LONG, ROADS),  # rewards
    speeds=(LONG, ROADS),  # m/s
    entropies=(LONG, ROADS),  # nats
    states=OF_ROADS,
    layers=record(one=OF_ROADS_HIDDEN, two=OF_ROADS_HIDDEN, out=OF_ROADS_ACTIONS),
    pi=OF_ROADS_ACTIONS,
    log_pi=OF_ROADS_ACTIONS,
)
MEMORY = record(rows=(REAL, (MOST_DEMONSTRATIONS + BUFFER, ROW)))  # the replay buffer: demonstrations, then its own
CURVES = record(values=(REAL, (MOST_EPISODES, len(NAMES))))  # a row for each finished episode: see curves.py


def refusal(settings: Settings, observation_size: int = SEEN, n_actions: int = ACTIONS) -> str:
    """Why the compiled learner cannot train an agent with these settings, as a sentence; "" if it can."""
    fixed = {"hidden": (HIDDEN, HIDDEN), "batch": BATCH, "cql_weight": 0.0}
    if METHODS[settings.method].learner != SAC:
        return f"The compiled learner has no method '{settings.method}': it knows SAC with what the paper adds."
    for name, value in fixed.items():
        if (given := getattr(settings, name)) != value:
            return f"The compiled learner has {name} = {value!r} only, not {given!r}."
    for name, value, given in (("numbers seen", SEEN, observation_size), ("actions", ACTIONS, n_actions)):
        if given != value:
            return f"The compiled learner has {value} {name} only, not {given}."
    return ""


def check_accepted(settings: Settings, observation_size: int = SEEN, n_actions: int = ACTIONS) -> None:
    """Raise BootcourseError if the compiled learner cannot train an agent with these settings."""
    reason = refusal(settings, observation_size, n_actions)
    require(not reason, f'{reason} Train with learner="torch".')


def coefficients(settings: Settings) -> np.ndarray:
    """A `COEFFICIENTS` record of an agent's settings, (1,)."""
    values = np.zeros(1, COEFFICIENTS)
    for name in COEFFICIENTS.names:
        if name not in ("log_p", "log_others"):
            given = getattr(settings, name)
            values[name] = math.nan if given is None else given
    values["log_p"] = math.log(settings.rule_p)
    values["log_others"] = math.log((1 - settings.rule_p) / (ACTIONS - 1))
    return values


def first_agents(settings: list[Settings]) -> np.ndarray:
    """Agents before their first update, with the first weights of `SACLearner`: `AGENT` records, (agents,)."""
    agents, generators = np.zeros(len(settings), AGENT), generators_of(settings)
    for name in ("actor", "critic_1", "critic_2"):
        set_network(agents[name], init_mlp((SEEN, HIDDEN, HIDDEN, ACTIONS), generators))
    agents["target_1"], agents["target_2"] = agents["critic_1"], agents["critic_2"]
    agents["log_alpha"] = np.log(np.array([s.alpha_init for s in settings], np.float32))
    agents["fade_1"] = agents["fade_2"] = 1.0
    return agents


def fill(batches: np.ndarray, batch: Batch) -> None:
    """Set `BATCHES` records (agents,) to a batch of the replay buffer."""
    for name, values in batch._asdict().items():
        if name in ("states", "next_states"):
            batches[name]["m"][..., :SEEN] = values.numpy()
        else:
            batches[name] = values.numpy()


def parameters(networks: np.ndarray) -> list[torch.Tensor]:
    """The weights and biases of `NETWORK` records (agents,), without padding: views, [(agents, inputs, outputs), ...].

    In the layout of networks.py; what is written into them is written into the records.
    """
    sizes = {"w_1": (HIDDEN, SEEN), "w_3": (ACTIONS, HIDDEN), "b_3": (1, ACTIONS)}
    views = []
    for name in NETWORK.names:
        whole = networks[name]["m"]
        rows, columns = sizes.get(name, whole.shape[1:])
        view = whole[:, :rows, :columns]
        views.append(torch.from_numpy(view if name.startswith("b") else view.swapaxes(1, 2)))
    return views


def set_network(networks: np.ndarray, values: list[torch.Tensor]) -> None:
    """Set `NETWORK` records (agents,) to the weights and biases of networks.py."""
    for view, value in zip(parameters(networks), values, strict=True):
        view.copy_(value.detach())


def agent_of(settings: Settings, agents: np.ndarray, i: int) -> Agent:
    """Agent i of some `AGENT` records, as a copy."""
    actor, one, other = (parameters(agents[name][[i]]) for name in ("actor", "critic_1", "critic_2"))
    critics = [torch.cat(pair) for pair in zip(one, other, strict=True)]
    actor = [parameter.contiguous() for parameter in actor]
    return Agent(settings, actor, critics, float(np.exp(agents["log_alpha"][i])))
