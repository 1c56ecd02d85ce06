"""You will clone, CQL and GAIL on one data set: write the term that keeps a critic near its data; choose an agent
without a simulator; write GAIL's reward.
"""
