"""The pages of studies: tables between marks in pages that a person has written, numbers in their words, and one HTML
page of a user's own runs."""

import base64
import re
from html import escape

from ..version import version_text
from .comparison import markdown_table, words_of

START, END = "<!-- table: made by `make gallery` -->", "<!-- end of the table -->"
NUMBER = re.compile(r"\d+(?:\.\d+)? ± \d+(?:\.\d+)?")
STYLE = """body { font: 16px/1.5 Arial, sans-serif; color: #222; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }
img { max-width: 100%; } table { border-collapse: collapse; font-size: 0.8rem; }
th, td { padding: 0.15rem 0.5rem; border-bottom: 1px solid #ddd; text-align: left; vertical-align: top; }"""


class PageError(ValueError):
    """A page whose marks or numbers are wrong; the message is one line."""


def table_of(rows, independent):
    """The table of a page (str, Markdown) of comparison.Rows, and what its words mean."""
    return f"{markdown_table(rows)}\n\n{words_of(rows, independent)}"


def filled(file, text, rows, independent):
    """The text of a README (str) whose table, between its marks, has the rows that it lists made anew. PageError where
    it lacks the second mark, lists a quantity that no row has, or has a number with an error that no row has."""
    if text.count(START) != 1 or text.count(END) != 1:
        raise PageError(f"{file}: must have the lines {START} and {END} once")
    before, rest = text.split(START)
    table, after = rest.split(END)
    listed = [line.split(" | ")[0].removeprefix("| ") for line in table.splitlines() if line.startswith("| ")][1:]
    known = {row.quantity: row for row in rows}
    for quantity in listed:
        if quantity not in known:
            raise PageError(f"{file}: its table has {quantity}: must be a quantity of comparison.csv")
    require_numbers(file, before + after, [str(row.ours) for row in rows])
    shown = markdown_table([known[quantity] for quantity in listed])
    return f"{before}{START}\n\n{shown}\n\n{words_of(rows, independent)}\n\n{END}{after}"


def require_numbers(file, text, made):
    """PageError where a number with an error in a text (str), '54.0 ± 1.0', is in none of the numbers made ([str]),
    but for its sign."""
    known = {own for number in made for own in NUMBER.findall(number)}
    for number in NUMBER.findall(text):
        if number not in known:
            raise PageError(f"{file}: {number}: no study has this number; must be one of comparison.csv")


def html_page(study, rows, figures, lines):
    """One HTML page (str) that can be sent: the table of a study.Study of comparison.Rows, its figures [(caption, PNG
    file)], which are inside it, and lines that say where the runs come from."""
    # slow to load, and the numbers do without it
    import markdown

    text = "\n\n".join([study.question, table_of(rows, study.independent), "\n".join(f"- {line}" for line in lines)])
    body = markdown.markdown(escape(text, quote=False), extensions=["tables", "sane_lists"])
    for caption, file in figures:
        picture = base64.b64encode(file.read_bytes()).decode("ascii")
        body += f'\n<p><img alt="{escape(caption)}" src="data:image/png;base64,{picture}"><br>{escape(caption)}</p>'
    title = escape(study.title)
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head><meta charset="utf-8"><title>{title}</title>\n'
        f"<style>\n{STYLE}\n</style></head>\n<body>\n<h1>{title}</h1>\n{body}\n"
        f"<p>Version {version_text()}.</p>\n</body>\n</html>\n"
    )
