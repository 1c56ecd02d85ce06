"""You will count who finds the way out and who keeps it, watch two aids fade by two clocks, compute how likely a
table of single agents is.
"""
