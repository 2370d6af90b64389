"""The states of a run for other programs: VTK's XML files (ParaView, OVITO, VisIt) and extended XYZ (OVITO, ASE)."""
