"""You will write the buffer's draw, SAC's update and its loop, test them in worlds whose right Q you know, solve the
pole.
"""
