"""The mutations: slips in the code, as data (*.toml beside this file), that the tests have to notice."""

import tomllib
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
TOP = HERE.parents[1]


@dataclass(frozen=True)
class Mutation:
    """room: the table it stands in; file: where `code`, which stands there once, becomes another; wrong: what a
    physicist would call broken; tests: those expected to fail (files, or as pytest names one); plugin: whether they
    need it compiled anew."""

    room: str
    file: str
    code: str
    becomes: str
    wrong: str
    tests: tuple
    plugin: bool

    def apply(self, top):
        """Change the file in a copy of the repository at `top` (path); ValueError unless the code stands there once."""
        path = Path(top) / self.file
        source = path.read_text()
        if source.count(self.code) != 1:
            raise ValueError(f"{self.file}: has {source.count(self.code)} times, must have once: {self.code.strip()}")
        path.write_text(source.replace(self.code, self.becomes))


def read():
    """[Mutation] of all tables."""
    found = []
    for room in ("kernel", "engine", "run_layer", "analysis"):
        for row in tomllib.loads((HERE / f"{room}.toml").read_text())["mutation"]:
            found.append(Mutation(**{"plugin": room == "engine", **row, "room": room, "tests": tuple(row["tests"])}))
    return found
