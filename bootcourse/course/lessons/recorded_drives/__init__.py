"""You will clone, GAIL and CQL on one data set: write the judge's loss and the reward that comes of it, the term that
keeps a critic near its data; choose a driver without a simulator.
"""
