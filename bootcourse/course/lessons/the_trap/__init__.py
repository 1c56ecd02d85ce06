"""You will write a planner that finds a way out, count the ways, write the reward, watch a program learn, work out
when an attempt to leave pays, halve the time step.
"""
