"""The world in a notebook: a road to look at and to drive, with anybody at the wheel and ghosts beside.

    world = bc.world(road=7, ghosts=[agent, my_rule])
    world.drive       # what is driven now, as a `Rollout`
    world.attempts    # your own drives so far
    world.on_end(print)

The road, its physics and its picture are those of the page that drives (mount.js); Python is told the actions, and
drives them again on the compiled road. It works where anywidget does: JupyterLab and Notebook, VS Code, Colab.
"""

import base64
import hashlib
import threading
from collections.abc import Callable, Mapping, Sequence

import anywidget
import ipywidgets as widgets
import traitlets

from bootcourse import one_per_cell
from bootcourse.colours import OTHER
from bootcourse.errors import BootcourseError, described, whole
from bootcourse.markup import html
from bootcourse.plots.road import road_svg
from bootcourse.plots.svg import QUIET, drawing, printed, text
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT, N_ACTIONS, Scenario
from bootcourse.web import bundle
from bootcourse.web.guests import KNOWN, Guest, guest

LAST_ROAD = 999_999_999  # as in address.js
VIEWS = {"above": "above", "3d": "3d"}


class Library(widgets.Widget):
    """The module of all worlds of a kernel, so that it goes to the notebook once."""

    name = traitlets.Unicode().tag(sync=True)
    text = traitlets.Unicode().tag(sync=True)


class World(anywidget.AnyWidget):
    """See `world`. `drive` is the present drive (None before its first decision); `attempts` are your own drives."""

    _esm = bundle.script("stub")
    library = traitlets.Instance(Library).tag(sync=True, **widgets.widget_serialization)
    opens = traitlets.Dict().tag(sync=True)  # see `mount` in mount.js
    drivers = traitlets.List().tag(sync=True)  # see `guest` in drivers.js
    closed = False

    def __init__(self, guests: Mapping[str, Guest], opens: dict, scenario: Scenario = DEFAULT):
        self.guests, self.scenario = dict(guests), scenario  # guests: {id: who it is}
        if scenario != DEFAULT:
            from bootcourse.web.packing import scenario_data

            opens = opens | {"scenario": scenario_data(scenario)}
        self._drives, self._ends, self._eye = {}, [], None
        self._one_at_a_time = threading.RLock()  # JupyterLab's messages come in another thread than the cells
        super().__init__(library=library(), opens=opens, drivers=self._told())
        self.on_msg(self._heard)

    @property
    def drive(self):
        """What is driven now, or was driven last: a `Rollout`, driven again by the compiled road from its actions."""
        with self._one_at_a_time:
            return self._drives[list(self._drives)[-1]].rollout() if self._drives else None

    @property
    def attempts(self) -> list:
        """Your own drives on these roads so far, with the present one, each a `Rollout`."""
        with self._one_at_a_time:
            return [drive.rollout() for drive in self._drives.values() if drive.label == "you"]

    def on_end(self, callback: Callable) -> None:
        """Call `callback(rollout)` whenever a drive is over: after 150 s, or by an accident."""
        self._ends.append(callback)

    def show(self, **changes) -> None:
        """Begin a drive with other options: road, driver, ghost, pace, futures or view, as in the page's address."""
        self.opens = self.opens | changes

    def offer(self, **guests: Guest) -> None:
        """Put other drivers in the place of those with the same ids; they drive on from the next decision."""
        self.guests |= guests
        self.drivers = self._told()

    def close(self) -> None:
        """Remove the widget. Closing twice does nothing."""
        if not self.closed:
            self.closed = True
            one_per_cell.forget(self)
            self.layout.close()
            super().close()

    def _told(self) -> list[dict]:
        return [each.told | {"id": name} for name, each in self.guests.items() if each.told]

    def _heard(self, _, message: dict, buffers) -> None:
        """A message of the page."""
        if message.get("kind") == "ask":
            self.send({"kind": "answer", "number": message["number"], **self._answer(message)})
        elif message.get("kind") == "driven" and message["actions"]:
            self._follow(message)

    def _answer(self, asked: dict) -> dict:
        """{"thought": what a driver in Python would do}, or {"error": the sentence that says why it cannot}."""
        import numpy as np
        from gymnasium.vector import AutoresetMode

        from bootcourse.road.vector_env import TrapVectorEnv

        self._eye = self._eye or TrapVectorEnv(1, self.scenario, AutoresetMode.DISABLED)
        policy = self.guests[asked["driver"]].decide
        cars = np.array(asked["cars"]).reshape(self._eye.cars.shape)
        try:
            if asked["time"] == 0 and hasattr(policy, "reset"):
                policy.reset(1)
            self._eye.cars[:] = cars
            output = policy(self._eye.observe(), cars)
            thought = {"action": whole(output.actions[0], "action", N_ACTIONS - 1)}
            if output.policy is not None:
                thought["policy"] = output.policy[0].tolist()
        except BootcourseError as error:
            return {"error": str(error)}
        except Exception as error:  # whatever the reader's function raises
            return {"error": f"{self.guests[asked['driver']].label} raised {described(error)}."}
        return {"thought": thought}

    def _follow(self, told: dict) -> None:
        """Drive what the page has driven since the last message."""
        from bootcourse.episodes.interactive import InteractiveEpisode

        name, driver = told["drive"], told["driver"]
        with self._one_at_a_time:
            if name not in self._drives:
                label = self.guests[driver].label if driver in self.guests else KNOWN[driver]
                self._drives[name] = InteractiveEpisode(told["road"], self.scenario, label)
            drive = self._drives[name]
            for action in told["actions"][len(drive.actions) :]:
                drive.decide(action)
        if told["over"]:
            for callback in self._ends:
                callback(drive.rollout())

    def _repr_mimebundle_(self, **kwargs) -> tuple[dict, dict]:
        """The widget and, for readers without a kernel, a picture; `tools/book.py` puts the page in its place."""
        data, metadata = super()._repr_mimebundle_(**kwargs)
        ghosts = ",".join(name for name in self.opens["ghost"].split(",") if name not in self.guests or name in KNOWN)
        driver = self.opens["driver"] if self.opens["driver"] in KNOWN else "you"
        page = f"road={self.opens['road']}&ghost={ghosts or 'none'}&driver={driver}&view={self.opens['view']}"
        alt = f"Road {self.opens['road']} from above. Where a kernel runs, you drive here."
        return data | self.picture(self._road_from_above(), alt, page), metadata

    def _road_from_above(self) -> bytes:
        """The road as it begins, an SVG."""
        env = TrapVectorEnv(1, self.scenario)
        env.reset(seed=[self.opens["road"]])
        road, height = road_svg(env.cars[0], self.scenario, OTHER.colour, 1000, 8.0)
        words = "A road of three lanes from above: one slow car ahead of the ego, another one beside it."
        live = text(8, height + 18, "Run the cell, and the road moves: you drive the purple car.", fill=QUIET)
        return printed(drawing(1000, height + 28, [*road, live], words))

    @staticmethod
    def picture(svg: bytes, alt: str, page: str = "") -> dict[str, str]:
        """An SVG for readers without a kernel. page: the address of the page that shows the same."""
        source = "data:image/svg+xml;base64," + base64.b64encode(svg).decode()
        live = html(' data-world="{}"', page) if page else ""
        img = html('<img src="{}" alt="{}"{} style="max-width:100%">', source, alt, live)
        return {"text/html": str(img), "text/plain": alt}


_library: list[Library] = []


def library() -> Library:
    """The one of this kernel."""
    if not _library or _library[0].comm is None:
        text = bundle.notebook_module()
        _library[:] = [Library(name=hashlib.sha256(text.encode()).hexdigest()[:12], text=text)]
    return _library[0]


def world(
    road: int = 10,
    driver=None,
    ghosts="rule",
    futures: bool = False,
    view: str = "above",
    details: bool = False,
    height: int = 600,
    scenario: Scenario = DEFAULT,
) -> World:
    """A road to drive: ↑ ↓ ← → while it has the focus, or somebody else at the wheel.

    driver: None for you; or "rule", "sac", "escaping", "crashing", "ppo", "lookahead", "soft", "idle"; or an agent, a
    policy of (observations, cars), a rule of (cars, scenario), a plan (actions, or words as in `plan_policy`), or a
    recorded drive. ghosts: one of these, a list, or {name: who}; [] for none. futures: show where each action leads.
    view: "above" or "3d". details: show also what a driver thinks: π, π̃, the KL. height: pixels. scenario: one in
    which drivers see as many cars as in the default.
    Raises BootcourseError for a road that is not a whole number from 0 to 999,999,999, and for who cannot drive.
    """
    road = whole(road, "road", LAST_ROAD)
    if scenario.observation_size != DEFAULT.observation_size:
        raise BootcourseError(
            f"A driver of this scenario observes {scenario.observation_size} numbers: the world's "
            f"agents observe {DEFAULT.observation_size}, so leave sight.neighbours as it is."
        )
    if view not in VIEWS:
        raise BootcourseError(f"view = {view!r:.80}: choose 'above' or '3d'.")
    beside = ghosts if isinstance(ghosts, Mapping) else _several(ghosts)
    wheel = guest(driver, 0, scenario=scenario)
    guests = {"guest0" if wheel.told else driver or "you": wheel}
    for number, (name, who) in enumerate(beside.items(), start=1):
        each = guest(who, number, name if isinstance(name, str) else "", scenario)
        guests[f"guest{number}" if each.told else who] = each
    names = list(guests)
    opens = {"road": road, "driver": names[0], "ghost": ",".join(names[1:]) or "none", "futures": int(futures)}
    opens |= {"view": view, "details": details, "height": whole(height, "height", 4000, 300)}
    shown = World(guests, opens, scenario)
    one_per_cell.replace_with(shown)
    return shown


def _several(ghosts) -> dict:
    """One ghost or a list of them, numbered. A list of numbers or words of a plan is one ghost."""
    many = isinstance(ghosts, Sequence) and not isinstance(ghosts, str)
    return dict(enumerate(ghosts)) if many else {} if ghosts is None else {0: ghosts}
