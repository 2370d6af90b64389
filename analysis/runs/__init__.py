"""Run folders: their format, reading them, and where they come from."""
