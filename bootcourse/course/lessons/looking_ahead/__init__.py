"""You will imagine nine futures before each decision, write the rollouts and a shield, let them drive bad agents
without accidents, find out what a model costs that is wrong, or learned.
"""
