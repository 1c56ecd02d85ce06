"""What the page needs to let agents learn: the layout of the learner's records, the methods' settings and their limits.

learn_worker.js reads and writes the records by it; learner.js checks settings by it. All of it is the library's.
"""

import json
from dataclasses import asdict, fields
from typing import get_args

import numpy as np

from bootcourse.episodes.place import TRAP_ID
from bootcourse.learn import records
from bootcourse.learn.curves import NAMES
from bootcourse.learn.settings import MAX_SEED, Settings, settings_for
from bootcourse.limits import NO_LIMITS, in_words
from bootcourse.methods import METHODS
from bootcourse.scenario import DEFAULT, LARGEST_P, N_ACTIONS
from bootcourse.web.entries import RECORDS

LEARNABLE = ("sac", "soft", "demos", "bootstrapped", "margin", "margin_soft")  # the paper's ablation
# Settings that the page's training takes at these values at most.
MOST = {"envs_per_agent": records.ROADS, "buffer_size": records.BUFFER, "demonstration_episodes": 200}
FIXED = ("method", "hidden", "batch", "cql_weight")  # the page's training has one value of each
READ = {  # the fields that the worker reads or writes by name
    "agent": ("log_alpha",),
    "coefficients": records.COEFFICIENTS.names,
    "plan": records.PLAN.names,
    "run": ("decisions", "updates", "finished", "demonstrated"),
    "curves": ("values",),
}


def place_of(record: np.dtype, name: str) -> list:
    """[offset, kind, count] of a field: the offset in bytes, the kind as "f4", how many numbers."""
    field, offset = record.fields[name]
    return [offset, field.base.str[1:], int(np.prod(field.shape, dtype=int))]


def layers() -> list[dict]:
    """The layers of a network: inputs, outputs, the offsets of weights and biases, the length of a padded row."""
    sizes = (records.SEEN, records.HIDDEN, records.HIDDEN, records.ACTIONS)
    offset, made = records.NETWORK.fields, []
    for layer in (1, 2, 3):
        weights = offset[f"w_{layer}"]
        made.append(
            {
                "inputs": sizes[layer - 1],
                "outputs": sizes[layer],
                "weights": weights[1],
                "biases": offset[f"b_{layer}"][1],
                "padded": weights[0]["m"].shape[1],
            }
        )
    return made


def limits() -> dict[str, dict]:
    """What each setting may be: numbers or None for no limit, and the same in words."""
    made = {}
    for f in fields(Settings):
        if f.name in FIXED:
            continue
        low, high, above = f.metadata.get("limits", NO_LIMITS)
        kinds = get_args(f.type) or (f.type,)
        if f.name == "rule_p":
            low, high = 1 / N_ACTIONS, LARGEST_P
        high = min(high, MOST.get(f.name, high), MAX_SEED if f.name == "seed" else high)
        low = max(low, records.BATCH) if f.name == "buffer_size" else low
        truth, whole, empty = f.type is bool, int in kinds, type(None) in kinds
        kind = "true or false" if truth else f"a {'whole' if whole else 'finite'} number{in_words(low, high, above)}"
        numbers = {"low": low, "high": high, "above": above}
        made[f.name] = {name: value if np.isfinite(value) else None for name, value in numbers.items()}
        made[f.name] |= {"whole": whole, "truth": truth, "empty": empty, "words": kind + " or null" * empty}
    return made


def learning_data() -> dict:
    """All that learner.js, run_file.js and learn_worker.js read."""
    without = {m: [name for name, value in METHODS[m].settings.items() if value == 0] for m in LEARNABLE}
    for names in without.values():
        names += ["xi_fixed", "xi_min"] * ("xi_multiplier" in names)
    networks = ("actor", "critic_1", "critic_2", "target_1", "target_2")
    return {
        "names": list(NAMES),
        "actions": N_ACTIONS,
        "episodes": records.MOST_EPISODES,
        "sizes": {name: record.itemsize for name, record in RECORDS.items()},
        "fields": {name: {field: place_of(RECORDS[name], field) for field in READ[name]} for name in READ},
        "networks": {name: records.AGENT.fields[name][1] for name in networks},
        "layers": layers(),
        "methods": {method: asdict(settings_for(method)) for method in LEARNABLE},
        "without": without,
        "limits": limits(),
        "scenario": asdict(DEFAULT),
        "environment": TRAP_ID,
    }


def worker_as_text(script: str) -> str:
    """The worker's script as a constant of the page's script, which makes workers out of it."""
    return f"const LEARN_WORKER = {json.dumps(script)};".replace("<", "\\u003c")
