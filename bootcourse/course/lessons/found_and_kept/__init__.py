"""You will count who finds the way out and who keeps it, see what an aid that never ends costs, compute how likely a
table of single agents is.
"""
