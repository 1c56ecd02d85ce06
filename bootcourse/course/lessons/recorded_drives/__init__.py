"""You will compare a clone and CQL on one data set, write the term that keeps a critic near its data, say when to
believe an estimate from recorded drives; further, GAIL's reward.
"""
