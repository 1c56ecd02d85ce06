"""You will write what IBRL and jump-start RL take from a teacher, and compare five methods at equal decisions."""
