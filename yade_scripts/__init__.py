"""What a user runs with yade and yade-batch: short scripts, and the modules that they share."""
