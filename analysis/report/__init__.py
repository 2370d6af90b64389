"""What is said of runs: the summary of one (summary.py), how far many are (status.py), and a PDF of a page (pdf.py)."""
