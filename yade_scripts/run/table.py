"""yade-batch's tables read and written without YADE, by the rules of its TableParamReader; beside them a cell in quotes
may hold blanks and #."""

import re
from dataclasses import dataclass

from analysis.runs.files import write_file
from yade_scripts.parameters import InputError

CELL = re.compile(r"""#.*|"[^"]*"(?![^\s#])|'[^']*'(?![^\s#])|[^\s#]+""")


@dataclass(frozen=True)
class Row:
    """One line of a table: its number from 1, its description, {column: text} of its cells."""

    line: int
    description: str
    cells: dict


def own(cells):
    """The cells of parameters, without yade-batch's columns."""
    return {name: text for name, text in cells.items() if name[0] != "!"}


def read(path):
    """[Row] of a table: = repeats the cell above, cells with * are left out. Raises InputError when the file can't be
    read, a row has another number of cells than the header, two columns have one name, or there are no rows."""
    try:
        with open(path, encoding="utf-8-sig") as file:  # some editors begin a file with a byte order mark
            lines = [[_plain(cell) for cell in CELL.findall(line) if cell[0] != "#"] for line in file]
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "has bytes that are not UTF-8"
        raise InputError(f"{path}: {reason}; must be a table of parameters") from None
    used = [(number, cells) for number, cells in enumerate(lines, 1) if cells]
    if len(used) < 2:
        raise InputError(f"{path}: no rows; must be a line of names, then rows of values")
    header = used[0][1]
    names = [name.rstrip("!") for name in header]
    if any("," in name for name in header):
        raise InputError(f"{path}: line {used[0][0]} has commas; names and values must be parted by blanks")
    for name in names:
        if not name or names.count(name) > 1:
            raise InputError(f"{path}: has the column {name or '!'} {names.count(name)} times; must be a name, once")
    marked = [name for name in header if name.endswith("!")] or header
    rows, above, descriptions = [], {}, set()
    for number, cells in used[1:]:
        if len(cells) != len(header):
            raise InputError(f"{path}: line {number} has {len(cells)} cells; must be {len(header)}, one for each name")
        above = {name: above.get(name, "=") if cell == "=" else cell for name, cell in zip(header, cells)}
        if "=" in above.values():
            raise InputError(f"{path}: line {number}: = has no row above; must be a value")
        plain = {name.rstrip("!"): cell for name, cell in above.items() if cell != "*"}
        description = plain.pop("description", None)
        if not description:
            description = ",".join(f'{name.rstrip("!")}={above[name]}' for name in marked)
            description = description.replace("'", "").replace('"', "")
        if "description" not in header and description in descriptions:
            description += f"__line={number}__"
        descriptions.add(description)
        rows.append(Row(number, description, plain))
    return rows


def write(path, rows, comment=""):
    """Write [{column: text}] as a table, * where a row has no such column; comment: lines for its head."""
    columns = list(dict.fromkeys(name for row in rows for name in row))
    cells = [columns] + [[quoted(str(row.get(name, "*"))) for name in columns] for row in rows]
    widths = [max(map(len, column)) for column in zip(*cells)]
    text = "".join(f"# {line}\n" for line in comment.splitlines())
    text += "".join("  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip() + "\n" for line in cells)
    write_file(path, text)


def quoted(text):
    """A cell's text as it stands in a table; None where it cannot."""
    if not text.isprintable():
        return None
    if not re.search(r"[\s#]", text):
        return text
    mark = next((mark for mark in "\"'" if mark not in text), None)
    return mark and f"{mark}{text}{mark}"


def _plain(cell):
    return cell[1:-1] if cell[0] in "\"'" and re.search(r"[\s#]", cell) else cell
