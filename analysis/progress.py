"""A count of what is done with the time left, on a terminal only."""

import sys
import time


def progress(items, what, stream=sys.stderr):
    """Yield the items (a sequence) and show on a terminal how many are done; silent elsewhere."""
    shown, start, next_drawing = stream.isatty(), time.monotonic(), 0.0
    for done, item in enumerate(items):
        now = time.monotonic()
        if shown and now >= next_drawing:
            next_drawing = now + 0.5
            left = f"{(now - start) / done * (len(items) - done):.0f} s left" if done else ""
            stream.write(f"\r\033[K{what} {done} of {len(items)}  {left}")
            stream.flush()
        yield item
    if shown:
        stream.write("\r\033[K")
        stream.flush()
