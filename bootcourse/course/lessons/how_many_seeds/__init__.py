"""You will leave out one aid at a time, put intervals on ten seeds, compute how many agents a comparison needs, run
an ablation of your own.
"""
