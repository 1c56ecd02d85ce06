"""The experiments, a file each. How to add one stands in `bootcourse.research.experiment`."""
