"""You will give an agent a teacher in an environment of your choice, compare methods at equal decisions, find out when
a clone is enough and when a bonus drowns the goal, enter a challenge.
"""
