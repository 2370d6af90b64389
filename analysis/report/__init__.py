"""Reports on runs: their numbers and tables (rows), and the same as text (text)."""
