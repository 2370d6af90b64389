"""What every kind of run shares: parameters, scene, recorder, run folder, checkpoints, the loop over steps."""
