"""One source, three products (notebooks/source/README.md): a student's notebook, a solved one, an instructor's page."""
