"""You will compute what a state is worth by the Bellman equation, write Q-learning, find out what gets a learner
across a barrier.
"""
