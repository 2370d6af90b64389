"""A text that is drawn again in the same place of a terminal."""

import shutil
import sys


class Screen:
    """draw(text) replaces what was drawn before; nothing happens when the stream is no terminal (.shown)."""

    def __init__(self, stream=sys.stderr):
        self.stream, self.shown = stream, stream.isatty()
        self._lines = 0

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
