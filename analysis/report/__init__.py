"""Reports on runs: rows (numbers and tables), text, plot (figures of many runs), status, and a PDF of a page."""
