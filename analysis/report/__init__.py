"""Reports on runs: their numbers and tables (rows), the same as text (text), what has become of them (status)."""
