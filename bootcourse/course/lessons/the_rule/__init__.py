"""You will take a rule controller apart, find a misprint and read it another way, find out why the rule is slow."""
