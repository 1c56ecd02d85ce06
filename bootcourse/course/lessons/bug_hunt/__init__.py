"""You will tell six silent bugs apart by curves and probes, write a probe, test labels and targets without training."""
