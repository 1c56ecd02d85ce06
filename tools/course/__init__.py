"""One source, three products: the student's notebook, the solved one, the instructor's page. See notebooks/source/README.md."""
