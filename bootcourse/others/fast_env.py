"""`gym.make("bootcourse:FastTrap-v0")`: the compiled road for one car.

It drives the same as `Trap-v0` on highway-env, in every number, and is more than fifty times as fast (`make bench`
measures by how much). Its pictures are those of the course's figures, without highway-env's viewer.
"""

import numpy as np

from bootcourse.road import twin
from bootcourse.road.one_car import OneCar
from bootcourse.scenario import DEFAULT, Scenario

WIDTH, DPI = 10.0, 100  # inches, pixels per inch
BEHIND, AHEAD = 30.0, 90.0  # m of road in a picture, from the ego


class FastTrapEnv(OneCar):
    """`OneCar` on the compiled road: the numbers of `TrapEnv` within 1e-9.

    `trace` (steps, vehicles, 10) repeats the last state after an accident.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 1}

    def __init__(self, scenario: Scenario | str | dict = DEFAULT, render_mode: str | None = None):
        """As `OneCar`."""
        super().__init__(scenario, render_mode)
        self._cars = twin.empty_cars(1, self.scenario.vehicles)
        self._action, self._accident, self._asleep = np.zeros(1, np.int64), np.zeros(1, np.int64), np.zeros(1, bool)
        self._reward, self._terms = np.zeros(1), np.zeros((1, 3))

    def _start(self, cars: np.ndarray) -> None:
        self._cars[0] = cars

    def _simulate(self, action: int) -> None:
        self._action[0], trace = action, np.empty((1, self.scenario.clock.steps, *self._cars.shape[1:]))
        twin.decide(
            self._cars, self._action, self._asleep, self.constants, self._reward, self._terms, self._accident, trace
        )
        self.trace, self.accident = trace[0], int(self._accident[0])

    def cars(self) -> np.ndarray:
        """The state of all cars, (vehicles, 10), columns in `bootcourse.road.state`."""
        return self._cars[0].copy()

    def render(self) -> np.ndarray:
        """The road around the ego from above, as in the course's figures: (height, 1000, 3) uint8."""
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        from bootcourse.colours import OTHER
        from bootcourse.plots.canvas import MplAxes
        from bootcourse.plots.road import draw_cars, draw_road, edges_of
        from bootcourse.road.state import EGO, X

        self.check_rendered()
        cars, (top, bottom) = self._cars[0], edges_of(self.scenario.road)
        figure = Figure((WIDTH, WIDTH * (bottom - top) / (BEHIND + AHEAD)), DPI)
        axes, image = figure.add_axes((0, 0, 1, 1)), FigureCanvasAgg(figure)
        axes.set(xlim=(-BEHIND, AHEAD), ylim=(bottom, top))
        axes.axis("off")
        canvas = MplAxes(axes)
        draw_road(canvas, self.scenario, -BEHIND, AHEAD, cars[EGO, X])
        draw_cars(canvas, cars, self.scenario, OTHER.colour, -BEHIND, AHEAD, cars[EGO, X])
        image.draw()
        return np.asarray(image.buffer_rgba())[..., :3].copy()
