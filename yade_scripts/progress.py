"""A progress bar with the time left, on a terminal only."""

import sys
import time


class Progress:
    """Progress(total).update(done) draws at most twice a second; silent when the stream is no terminal.

    already: how much was done before the clock began.
    """

    def __init__(self, total, stream=sys.stderr, width=40, already=0):
        self.total, self.stream, self.width, self.already = total, stream, width, already
        self.shown = stream.isatty()
        self.start = self.next_drawing = time.monotonic()

    def update(self, done):
        if not self.shown:
            return
        now = time.monotonic()
        if now >= self.next_drawing:
            self.next_drawing = now + 0.5
            self._draw(done, now - self.start)

    def close(self):
        """Leave the line to whatever is written next."""
        if self.shown:
            self.stream.write("\r\033[K")
            self.stream.flush()

    def _draw(self, done, elapsed):
        filled = int(self.width * done / self.total)
        new = done - self.already
        left = duration_text(elapsed / new * (self.total - done)) if new > 0 else "?"
        self.stream.write(
            f'\r\033[K[{"#" * filled}{"." * (self.width - filled)}] ' f'{100 * done / self.total:5.1f} %  {left} left'
        )
        self.stream.flush()


def duration_text(seconds):
    """1:02:03 or 2:03 for a number of seconds."""
    minutes, seconds = divmod(int(round(seconds)), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{seconds:02d}" if hours else f"{minutes}:{seconds:02d}"
