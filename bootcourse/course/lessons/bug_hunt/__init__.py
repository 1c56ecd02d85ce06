"""You will find six silent bugs from curves, probes and drives, write a probe, test a target without training."""
