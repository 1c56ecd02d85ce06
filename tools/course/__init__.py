"""One text, three products: a student's notebook, a solved one, an instructor's page (course/lessons/README.md)."""
