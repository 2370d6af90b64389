"""run.json from the start of a run to its end, and the line that says how it ended."""
import os
import sys
import time

import contact_law
import numpy as np
import yade.config

from yade_scripts.run_folder import closing_line, hardware


class Report:
    """Writes run.json at the start (outcome "running", which a killed run keeps) and at the end."""

    def __init__(self, folder, values, derived, start):
        self.folder, self.start = folder, start
        self.run = {
            'parameters': values, 'derived': derived,
            'versions': {'yade': yade.config.version, 'python': sys.version.split()[0],
                         'numpy': np.__version__, 'contact_law': contact_law.__version__},
            'commit': contact_law.commit, 'seed': values['seed'], 'hardware': hardware(),
        }
        self._write('running')

    def end(self, outcome):
        """Write the outcome and, if the run came to its planned end, the mark of that; print one line."""
        self._write(outcome)
        if outcome == 'completed':
            self.folder.write_ended()
        if outcome.startswith('failed'):
            sys.stderr.write(f'{os.path.basename(sys.argv[0])}: {outcome}\n')
        print(closing_line(self.folder.path, outcome, time.monotonic() - self.start), flush=True)

    def _write(self, outcome):
        self.folder.write_run({**self.run, 'wallTime': time.monotonic() - self.start, 'outcome': outcome})
