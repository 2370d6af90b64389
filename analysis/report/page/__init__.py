"""A study's results as one HTML page that can be sent: figures inside, nothing to download; and a PDF of it."""
