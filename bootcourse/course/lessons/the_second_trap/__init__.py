"""You will watch another learner, find out what pays for what it does, put PPO together, clone the rule first."""
