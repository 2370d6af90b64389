"""Is the machine quiet enough to measure speed?"""

import os
import time

LOUD = 0.05  # fraction of the machine, or of its core, that a measurement may lack before the report warns


def fraction_of_others(seconds=1.0):
    """Fraction of all processors' time [0, 1] that other programs use, while this one only waits."""
    before = _busy()
    time.sleep(seconds)
    return max(0.0, (_busy() - before) / (seconds * os.cpu_count()))


def _busy():
    """Processor seconds that anything has used since the machine started: user, nice, system, irq, softirq, steal (proc(5))."""
    ticks = open("/proc/stat").readline().split()[1:]
    return sum(int(ticks[k]) for k in (0, 1, 2, 5, 6, 7)) / os.sysconf("SC_CLK_TCK")
