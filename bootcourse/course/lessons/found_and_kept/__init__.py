"""You will tell who finds the way out from who keeps it, see what a way out is worth while an agent learns, compute how
likely a table of single agents is.
"""
