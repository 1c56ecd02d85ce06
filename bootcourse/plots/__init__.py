"""The figures of the course: data in, a matplotlib `Figure` with a title and an alt text out; and SVG for panels.

from bootcourse import show, top_view_over_time, traces

show(top_view_over_time(rollout))                                   # in a notebook
bootcourse.plots.figure.save(traces([one, other]), "traces.pdf")    # for print
"""
