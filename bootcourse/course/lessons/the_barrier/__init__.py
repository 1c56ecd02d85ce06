"""You will train plain SAC in the trap, measure how often chance would find a way out and what an attempt to leave is
worth.
"""
