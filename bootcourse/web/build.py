"""Write the page that drives as one file: `python -m bootcourse.web.build --out trap.html`.

The file holds the compiled road as WebAssembly, the scenarios' numbers, a few trained agents, and the scripts of this
folder one after the other. It asks for nothing else, so it also opens from a memory stick and without a network.
"""

import argparse
import base64
import gzip
import json
from pathlib import Path

import numpy as np
import torch

from bootcourse.colours import OTHER, TRAFFIC, TRAP
from bootcourse.files import read_tensors, write_bytes
from bootcourse.learn.agent import Agent
from bootcourse.methods import DRIVERS, style
from bootcourse.road.branching import future_worth
from bootcourse.road.constants import constants
from bootcourse.road.twin import uniforms_needed
from bootcourse.rule import SENTENCES
from bootcourse.scenario import ACTION_NAMES, DEFAULT, RULE_P, Scenario
from bootcourse.storage.assets import FOLDER
from bootcourse.storage.runs import load_run
from bootcourse.web.wasm import road_module

HERE = Path(__file__).resolve().parent
SCRIPTS = (
    "random", "road", "minds", "drive", "drivers", "words", "view", "thoughts", "summary", "controls", "main",
)  # fmt: skip
# The agents in the page; of plain SAC also the critics, which the compromise between Q and the rule needs.
AGENTS = {
    "sac": FOLDER / "runs/sac-2",
    "bootstrapped": FOLDER / "runs/bootstrapped-4",
    "crashing": FOLDER / "runs/bootstrapped-0",
}
PPO = HERE / "ppo_cloned.safetensors"  # the actor of `bootcourse train --method ppo_cloned --seeds 1`
EXACT, SHORT = 4, 3  # bytes of a float32 that are kept: all for actors; without the last for critics (error 2^-16)


def packed(data: bytes) -> str:
    """Bytes as compressed text, for `unpack` in minds.js."""
    return base64.b64encode(gzip.compress(data, 9, mtime=0)).decode()


def packed_network(parameters: list[torch.Tensor], member: int, kept: int) -> dict:
    """One network of some that are trained together: the sizes of its layers, and its weights for minds.js.

    The weights are sorted by bytes (all first bytes, all second ...), because those with the exponents compress well.
    """
    arrays = [parameter[member].numpy() for parameter in parameters]
    weights = np.concatenate([array.ravel() for array in arrays]).astype("<f4")
    planes = weights.view(np.uint8).reshape(-1, 4)[:, 4 - kept :].T
    return {"sizes": [len(arrays[0]), *(array.shape[1] for array in arrays[::2])], "weights": packed(planes.tobytes())}


def scenario_data(scenario: Scenario) -> dict:
    """What the page needs of a scenario: the record that the compiled code reads, and what the picture shows."""
    return {
        "record": base64.b64encode(constants(scenario).tobytes()).decode(),
        "vehicles": scenario.vehicles,
        "uniforms": uniforms_needed(scenario.vehicles),
        "observation": scenario.sight.numbers,
        "lanes": scenario.road.lanes,
        "laneWidth": scenario.road.lane_width,
        "steps": scenario.clock.steps,
        "dt": scenario.clock.dt,
        "decisions": scenario.clock.decisions,
        "length": scenario.car.length,
        "width": scenario.car.width,
    }


def page_data() -> dict:
    """All that the scripts read, as JSON."""
    agents: dict[str, Agent] = {name: load_run(path).agent for name, path in AGENTS.items()}
    networks = {name: packed_network(agent.actor, 0, EXACT) for name, agent in agents.items()}
    clone = read_tensors(PPO)
    networks["ppo"] = packed_network([torch.from_numpy(clone[name]) for name in sorted(clone)], 0, EXACT)
    for member in range(2):
        networks[f"critic {member}"] = packed_network(agents["sac"].critics, member, SHORT)
    speeds, worth = future_worth(DEFAULT, DEFAULT.clock.decisions, 1.0)[-1]
    return {
        "module": packed(road_module()),
        "scenario": scenario_data(DEFAULT),
        "networks": networks,
        "worth": {"speed": float(speeds[1]), "values": [round(float(value), 6) for value in worth]},
        "actions": list(ACTION_NAMES),
        "reasons": [SENTENCES[reason] for reason in sorted(SENTENCES)],
        "p": RULE_P,
        "alpha": agents["sac"].settings.alpha_init,
        "xi": agents["sac"].settings.alpha_init * agents["bootstrapped"].settings.xi_multiplier,
        "colours": {
            "you": OTHER.colour,
            "rule": DRIVERS["rule"][1].colour,
            "sac": style("sac").colour,
            "bootstrapped": style("bootstrapped").colour,
            "soft": style("soft").colour,
            "ppo": style("ppo_cloned").colour,
            "trap": TRAP,
            "traffic": TRAFFIC,
        },
    }


def page() -> str:
    """The whole page as text."""
    data = json.dumps(page_data(), separators=(",", ":")).replace("<", "\\u003c")
    scripts = "\n".join((HERE / f"{name}.js").read_text(encoding="utf-8") for name in SCRIPTS)
    text = (HERE / "page.html").read_text(encoding="utf-8")
    parts = {"style": (HERE / "style.css").read_text(encoding="utf-8"), "data": data, "script": scripts}
    for name, part in parts.items():
        text = text.replace("{{ " + name + " }}", part)
    return text


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(prog="python -m bootcourse.web.build", description="Write the page that drives.")
    parser.add_argument("--out", type=Path, default=Path("trap.html"), help="the file to write (trap.html)")
    out = parser.parse_args(arguments).out
    content = page().encode()
    write_bytes(out, content)
    print(f"{out.resolve().as_uri()}: {len(content) / 1000:.0f} kB")


if __name__ == "__main__":
    main()
