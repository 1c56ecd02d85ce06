"""You will clone, CQL and GAIL on one data set: write the term that keeps a critic near its data; choose an agent
without a simulator; write the judge's loss and the reward that comes of it.
"""
