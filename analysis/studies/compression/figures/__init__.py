"""The study's figures, one file a subject; K13's formulae stand in them as dashed lines."""
