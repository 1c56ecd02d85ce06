"""You will derive the soft Bellman equation, write SAC's soft value, target and losses, see which target entropy a
thermostat can reach.
"""
