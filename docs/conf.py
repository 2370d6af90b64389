"""The site that make docs builds: Sphinx with MyST, inside YADE, whose Python alone has the plugin's classes.

The source folder is the repository's top, so that the documents are pages where they stand.
"""

import re
import shlex
import subprocess
import sys
from pathlib import Path

from docutils import nodes
from docutils.parsers.rst import Directive

TOP = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TOP))

import analysis
import contact_law  # noqa: F401 (JKRMat and the others, for autodoc)

project, release = "Cohesive dust aggregates in YADE", analysis.__version__
extensions = [
    "myst_parser",
    "nbsphinx",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "IPython.sphinxext.ipython_console_highlighting",
]
root_doc = "docs/index"
include_patterns = [
    "docs/*",
    "CHANGELOG.md",
    "*/*.md",
    "analysis/gallery/*.md",
    "analysis/gallery/*/*.md",
    "analysis/atlas/adapters/*.md",
    "contact_law/engine/*.md",
    "tests/conformance/*.md",
]
exclude_patterns = ["build", "runs", ".pytest_cache"]
myst_heading_anchors = 3
html_theme = "furo"
html_title = project
html_static_path, html_css_files = ["site.css"], ["site.css"]
html_show_sphinx = html_show_copyright = False
nbsphinx_execute = "always"
nbsphinx_timeout = 600  # s, of a cell: runs take longer on a busy machine
autodoc_member_order = "bysource"
autodoc_typehints = "none"
suppress_warnings = ["myst.header"]
YADES_ROLES = {"yref": r"``\1``", "ydefault": r"Default: \1;", "yattrtype": r"type: \1."}
YADES_GREETING = re.compile(r"(Welcome to|Using python|XMLRPC|TCP python|Running script).*\n")


class Help(Directive):
    """What a command prints with --help, word by word, and a section for each of its own commands."""

    required_arguments, final_argument_whitespace = 1, True

    def run(self):
        command = shlex.split(self.arguments[0])
        text = help_of(command)
        own = re.findall(r"^    (\w+)  ", text.partition("\n  command\n")[2], re.M)
        return [block(text), *(section(f"{command[-1]} {name}", help_of([*command, name])) for name in own)]


def help_of(command):
    done = subprocess.run([*command, "--help"], cwd=TOP, capture_output=True, text=True, check=True)
    return YADES_GREETING.sub("", done.stdout).strip()


def section(title, text):
    return nodes.section("", nodes.title(text=title), block(text), ids=[nodes.make_id(title)])


def block(text):
    return nodes.literal_block(text, text, language="none")


def readable(app, what, name, thing, options, lines):
    """Docstrings of Python are plain text with examples; those of YADE's classes have roles of YADE's own documents."""
    text = "\n".join(lines)
    if name.startswith(("analysis", "yade_scripts")):
        text = text.partition("\nParameters, as name=value")[0]  # of a script: in its --help
        text = "\n\n".join(map(_paragraph, text.split("\n\n")))
    for role, found in YADES_ROLES.items():
        text = re.sub(f":{role}:`([^`]*)`", found, text)
    lines[:] = [*text.split("\n"), ""]


def _paragraph(text):
    if text.startswith("    "):
        return "::\n\n" + text
    text, example, code = text.partition(">>>")
    return re.sub(r"([\\*`|_])", r"\\\1", text) + example + code


def setup(app):
    app.add_directive("help", Help)
    app.connect("autodoc-process-docstring", readable, priority=400)  # before napoleon reads the sections
