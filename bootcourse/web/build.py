"""Write the page that drives as one file: `python -m bootcourse.web.build --out trap.html`.

The file holds the compiled road as WebAssembly, the scenarios' numbers, a few trained agents, and the scripts of this
folder one after the other. It asks for nothing else, so it also opens from a memory stick and without a network.
"""

import argparse
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import torch

from bootcourse.colours import OTHER, TRAFFIC, TRAP
from bootcourse.episodes.evaluate import drive_episodes
from bootcourse.episodes.lookahead import HORIZON
from bootcourse.errors import BootcourseError
from bootcourse.files import read_tensors, write_bytes
from bootcourse.learn.agent import Agent
from bootcourse.methods import DRIVERS, style
from bootcourse.policies import Policy, rule_policy
from bootcourse.replay3d import camera
from bootcourse.replay3d import road as stage
from bootcourse.replay3d.car import DARK, LAMPS, LIGHT, car_parts
from bootcourse.road import state
from bootcourse.road.branching import future_worth
from bootcourse.rule import SENTENCES
from bootcourse.scenario import ACTION_NAMES, DEFAULT, IDLE, N_ACTIONS, RULE_P
from bootcourse.storage.assets import FOLDER, shipped
from bootcourse.storage.runs import load_run
from bootcourse.web import bundle
from bootcourse.web.bundle import HERE, module, script, text_of
from bootcourse.web.learning import LEARNABLE, learning_data, worker_as_text
from bootcourse.web.packing import EXACT, SHORT, packed, packed_network, scenario_data
from bootcourse.web.wasm import road_module

# The agents in the page; of plain SAC also the critics, which the compromise between Q and the rule needs.
AGENTS = {
    "sac": FOLDER / "runs/sac-2",
    "bootstrapped": FOLDER / "runs/bootstrapped-4",
    "crashing": FOLDER / "runs/bootstrapped-0",
}
PPO = HERE / "ppo_cloned.safetensors"  # the actor of `bootcourse train --method ppo_cloned --seeds 1`
ROADS = 100  # the first of them, on which each driver is measured
# What a driver's name in the page says of it: it gets out on more roads than this, and has fewer, or more, accidents.
ESCAPING, SAFE, CRASHING, STAYING = 90, 10, 50, 10
FIRST_ROAD = 10  # of the page
# The scripts with which agents learn in the page.
LEARNING = ("run_file", "learner", "learn_words", "learn_charts", "learn_view", "ablation")
PARTS = ("paint", "dark", "light", "lamps")  # of a car, in the order that shaders.js knows


def names() -> str:
    """The numbers that road.js shares with the compiled code, as JavaScript: columns, rows and the first accident."""
    shared = "X Y HEADING SPEED STEERING ACCELERATION LANE TARGET_LANE CRASHED COLUMNS EGO TRAP_1 TRAP_2 TRAFFIC"
    numbers = {name: getattr(state, name) for name in shared.split()}
    numbers |= {"ACTIONS": N_ACTIONS, "IDLE": IDLE, "COLLISION": int(state.Accident.COLLISION), "HORIZON": HORIZON}
    return f"const {', '.join(f'{name} = {number}' for name, number in numbers.items())};"


def measured(drivers: dict[str, Policy]) -> dict[str, dict]:
    """What each driver does on roads 0 to 99: how often it gets out and has an accident, and its mean return.

    Raises BootcourseError if a driver does not do what its name in the page says.
    """
    results = {}
    for name, policy in drivers.items():
        episodes = drive_episodes(policy, range(ROADS))
        results[name] = {
            "out": int(episodes.success.sum()),
            "accidents": int((episodes.accident != 0).sum()),
            "mean": round(float(episodes.returns.mean()), 1),
        }
    said = {
        "sac": results["sac"]["out"] < STAYING,
        "bootstrapped": results["bootstrapped"]["out"] > ESCAPING and results["bootstrapped"]["accidents"] < SAFE,
        "crashing": results["crashing"]["accidents"] > CRASHING,
    }
    if wrong := [name for name, true in said.items() if not true]:
        raise BootcourseError(
            f"On roads 0 to {ROADS - 1}, {wrong} do not drive as their names in the page say: {results}. Choose other "
            "agents in bootcourse/web/build.py."
        )
    return results


def scene_data() -> dict:
    """The car, the road, the colours and the camera of the replay in 3D, for scene.js."""
    parts = car_parts()
    corners, faces, start = [], [], 0
    for number, name in enumerate(PARTS):
        vertices = np.round(parts[name].vertices * 1000)  # mm
        corners.append(np.column_stack([vertices, np.full(len(vertices), number)]))
        faces.append(parts[name].faces + start)
        start += len(vertices)
    pose = camera.pose(camera.CHASE, 0.0)
    return {
        "corners": packed(np.concatenate(corners).astype("<i2").tobytes()),
        "faces": packed(np.concatenate(faces).astype("<u2").tobytes()),
        "parts": [DARK, LIGHT, LAMPS["brake"]],
        "camera": {"from": pose.position, "to": pose.look_at, "angle": camera.FIELD_OF_VIEW},
        "road": {"dash": stage.DASH, "period": stage.PERIOD, "line": stage.LINE, "shoulder": stage.SHOULDER},
        "light": stage.THEMES[False]._asdict(),
        "dark": stage.THEMES[True]._asdict(),
    }


def page_data() -> dict:
    """All that the scripts read, as JSON. Raises BootcourseError where the agents do not ship."""
    shipped()
    agents: dict[str, Agent] = {name: load_run(path).agent for name, path in AGENTS.items()}
    networks = {name: packed_network(agent.actor, 0, EXACT) for name, agent in agents.items()}
    clone = read_tensors(PPO)
    ppo = [torch.from_numpy(clone[name]) for name in sorted(clone)]
    networks["ppo"] = packed_network(ppo, 0, EXACT)
    for member in range(2):
        networks[f"critic {member}"] = packed_network(agents["sac"].critics, member, SHORT)
    drivers = {name: agent.as_policy() for name, agent in agents.items()}
    drivers |= {"rule": rule_policy(DEFAULT), "ppo": replace(agents["sac"], actor=ppo, critics=[]).as_policy()}
    speeds, worth = future_worth(DEFAULT, DEFAULT.clock.decisions, 1.0)[-1]
    return {
        "module": packed(road_module()),
        "scenario": scenario_data(DEFAULT),
        "networks": networks,
        "learning": learning_data(),
        "scene": scene_data(),
        "results": {"roads": ROADS, **measured(drivers)},
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


def content() -> dict[str, str]:
    """See `bundle.content`, which keeps it."""
    data = json.dumps(page_data(), separators=(",", ":")).replace("<", "\\u003c")
    return {"names": names(), "data": data}


def page() -> str:
    """The whole page as text. Raises BootcourseError where no results ship."""
    text = (HERE / "page.html").read_text(encoding="utf-8")
    styles = "".join(map(text_of, ("theme.css", "controls.css", "page.css", "learn.css")))
    numbers = json.loads(shipped("report/ablation.json").read_text(encoding="utf-8"))  # ours and the paper's
    numbers["colours"] = {method: style(method).colour for method in LEARNABLE}
    data = bundle.content()["data"].removesuffix("}") + f',"ablation":{json.dumps(numbers)}}}'
    parts = {"style": styles, "learn": text_of("learn.html"), "data": data}
    worker = worker_as_text(script("imports") + script("learn_worker"))
    parts["script"] = "\n".join([module(), worker, *map(script, LEARNING), script("page")])
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
