"""You will write a planner that finds a way out, count the ways, write the reward, see what programs learn,
work out when an attempt to leave pays.
"""
