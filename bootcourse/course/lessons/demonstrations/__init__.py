"""You will collect them in three ways, clone a driver, see why that is not enough, let the clone drive and the rule
correct it.
"""
