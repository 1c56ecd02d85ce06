"""Panels for the notebooks: one call each, which returns a widget. Everything that they show is computed elsewhere."""
