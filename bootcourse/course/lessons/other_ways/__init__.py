"""You will write what RLPD, IBRL and jump-start RL take from a teacher, train with it, compare them at equal
decisions.
"""
