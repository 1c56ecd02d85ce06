"""You will price every action by the rule, derive the best compromise, write the KL and both losses that it enters,
watch the pull fade.
"""
