"""You will give an agent a teacher in an environment of your choice, compare methods with five seeds, find out when a
clone is enough and when a bonus drowns the goal.
"""
