"""You will mix in a teacher's drives, find out what the bonus changes, write a margin, meet two Q-filters, train the
whole method in your own code.
"""
