"""A text that is drawn again in the same place of a terminal."""

import shutil
import sys
import time

EVERY = 1.0  # s
SHARE = 0.05  # of the time, at most, that goes into making texts


class Screen:
    """draw(text) replaces what was drawn before; nothing happens when the stream is no terminal (.shown)."""

    def __init__(self, stream=sys.stderr):
        self.stream, self.shown = stream, stream.isatty()
        self._lines = 0
        self._next = 0.0

    def draw_if_due(self, text):
        """draw(text()), unless that was done a moment ago; whether it was."""
        begun = time.monotonic()
        if not self.shown or begun < self._next:
            return False
        self.draw(text())
        took = time.monotonic() - begun
        self._next = begun + max(EVERY, took / SHARE)
        return True

    def draw(self, text):
        if not self.shown:
            return
        size = shutil.get_terminal_size()
        lines = [line[: size.columns - 1] for line in text.splitlines()[: size.lines - 1]]
        self._erase()
        self.stream.write("\n".join(lines) + "\n")
        self.stream.flush()
        self._lines = len(lines)

    def close(self):
        """Remove the drawing."""
        if self.shown:
            self._erase()
            self.stream.flush()
            self._lines = 0

    def _erase(self):
        if self._lines:
            self.stream.write(f"\033[{self._lines}A\033[J")
