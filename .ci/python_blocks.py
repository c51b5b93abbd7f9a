"""Runs the Python blocks of a page that follow a line `<!-- run by CI -->`, one after the other in one program, in an empty folder: what a
line with `print` prints must be what stands behind its `#`. Lines without such a comment may print anything.
"""

import contextlib
import io
import os
import re
import sys
import tempfile


def blocks(text):
    """The marked blocks."""
    return re.findall(r"^<!-- run by CI -->\n```python\n(.*?)^```$", text, re.M | re.S)


def wrong(block, known):
    """Runs a block; each line that printed something else than it says, and what."""
    promised = {n: line.split("# ", 1)[1].strip() for n, line in enumerate(block.splitlines(), 1) if re.match(r"print\(.*\)\s+# ", line)}
    told = {}

    def tell(*values):
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            builtin(*values)
        line = sys._getframe(1).f_lineno
        told[line] = " ".join(out.getvalue().split())
        sys.stdout.write(out.getvalue())

    builtin = print
    known["print"] = tell
    exec(compile(block, "block", "exec"), known)
    return [f"line {n}: {told.get(n)!r} instead of {text!r}" for n, text in promised.items() if told.get(n) != text]


def main(page):
    # A judge that cannot fail is none.
    assert wrong("print(1 + 1)  # 3", {}) == ["line 1: '2' instead of '3'"]
    found = blocks(open(page, encoding="utf-8").read())
    assert found, f"{page} marks no Python block with <!-- run by CI -->"
    known, bad = {}, []
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for block in found:
            bad += wrong(block, known)
        os.chdir("/")
    if bad:
        sys.exit(f"{page}: " + "; ".join(bad))


main(sys.argv[1])
