"""The kinds of run, one module each (parameters, scene, series, estimate); CONTRIBUTING.md says how to add one."""
