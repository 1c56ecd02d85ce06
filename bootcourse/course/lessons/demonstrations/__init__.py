"""You will drive one yourself, clone it and other drivers, see why agreeing with a driver is not enough, let the clone
drive and the rule correct it.
"""
