"""Results as text: sections (section.py) written for a terminal (text.py), as Markdown (markdown.py) and as JSON
(data.py)."""
