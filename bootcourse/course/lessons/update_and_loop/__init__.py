"""You will write the buffer's draw, SAC's update and its loop, train your agent to balance a pole, see a critic
diverge.
"""
