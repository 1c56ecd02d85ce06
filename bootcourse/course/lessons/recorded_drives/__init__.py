"""You will clone, CQL and GAIL on one data set: write the term that keeps a critic near its data, and GAIL's reward;
choose an agent without a simulator.
"""
