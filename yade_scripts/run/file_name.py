"""Names of files and folders from descriptions and parameters."""

import hashlib

LONGEST = 200  # bytes; Linux has 255, and temporary files and logs add to a name


def file_name(text, others="-_.,=+"):
    """text as the name of one file: letters, digits and `others`, the rest as _; a long one ends in a hash of the text."""
    name = "".join(c if c.isalnum() or c in others else "_" for c in text)
    if len(name.encode()) <= LONGEST:
        return name
    end = "-" + hashlib.sha256(text.encode()).hexdigest()[:12]
    return name.encode()[: LONGEST - len(end)].decode(errors="ignore") + end
