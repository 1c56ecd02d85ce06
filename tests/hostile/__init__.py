"""Pages that show what somebody else wrote."""
