"""You will mix in a teacher's drives, train the whole method in your own code, find out what the bonus costs, write a
margin.
"""
