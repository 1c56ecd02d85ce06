"""The figures of the course: data in, a matplotlib `Figure` with a title and an alt text out.

from bootcourse.plots import save, show, top_view_over_time, traces
show(top_view_over_time(rollout))                # in a notebook
save(traces([one, other]), "traces.pdf")         # for print
"""

from bootcourse.plots.figure import save, show
from bootcourse.plots.top_view import top_view, top_view_over_time
from bootcourse.plots.traces import traces
from bootcourse.plots.training_curves import training_curves

__all__ = ["save", "show", "top_view", "top_view_over_time", "traces", "training_curves"]
