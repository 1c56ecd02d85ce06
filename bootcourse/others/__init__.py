"""The road for other people's code: one car as fast as many, and adapters for other libraries."""
