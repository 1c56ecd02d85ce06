"""You will train plain SAC in the trap, measure how often chance would find a way out and see what frees agents."""
