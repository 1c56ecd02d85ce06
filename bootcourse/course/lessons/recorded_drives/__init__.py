"""You will compare a clone and CQL on one data set, write the term that keeps a critic near its data, choose an agent
without a simulator; further, GAIL's reward.
"""
