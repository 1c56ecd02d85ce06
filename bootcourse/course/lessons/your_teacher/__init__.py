"""You will write a rule controller of your own, train from it and from worse ones, judge when a teacher helps, and
what drives that crash teach.
"""
