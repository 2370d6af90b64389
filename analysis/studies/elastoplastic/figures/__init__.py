"""The study's figures, one file a subject; A24's numbers stand in them as dashed lines and open stars."""
