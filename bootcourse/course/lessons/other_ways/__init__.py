"""You will write what RLPD, IBRL and jump-start RL take from a teacher, and compare them at equal decisions."""
