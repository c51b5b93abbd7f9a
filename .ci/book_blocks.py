"""Runs the blocks of shell commands and of C of a page that follow a line `<!-- run by CI -->`, one after the other in one folder. What they
print must be the block of text behind a line `<!-- printed -->` that follows; `…` there stands for anything within a line.

    python3 book_blocks.py PAGE [FLAG OF THE C COMPILER]...

A shell block is run line by line by one bash, with `set -euo pipefail`. A block of C is a program: compiled as C99, linked, and run.
"""

import re
import subprocess
import sys
from pathlib import Path

MARKED = re.compile(r"^<!-- run by CI -->\n```(sh|c)\n(.*?)^```\n(?:\s*<!-- printed -->\n```text\n(.*?)^```$)?", re.M | re.S)


def matches(promised, told):
    """Whether a text is what a page promises, line by line."""
    pattern = "".join(".*" if part == "…" else re.escape(part) for part in re.split("(…)", promised.strip()))
    lines = "\n".join(line.rstrip() for line in told.strip().splitlines())
    return re.fullmatch(pattern, lines) is not None


def run(language, block, flags):
    """What a block prints."""
    if language == "sh":
        command = ["bash", "-euo", "pipefail", "-c", block]
    else:
        Path("block.c").write_text(block, encoding="utf-8")
        subprocess.run(["cc", "-std=c99", "-Wall", "-Wextra", "-Werror", "block.c", "-o", "block", *flags], check=True)
        command = ["./block"]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode:
        sys.exit(f"{block}ended with {done.returncode}: {done.stdout}")
    return done.stdout


def main(page, flags):
    # A judge that cannot fail is none.
    assert matches("a … c\nd", "a b c \nd\n") and not matches("a … c", "a\nb c") and not matches("a", "a\nb")
    found = MARKED.findall(Path(page).read_text(encoding="utf-8") + "\n")
    for language, block, promised in found:
        told = run(language, block, flags)
        if promised and not matches(promised, told):
            sys.exit(f"{page}: this block\n{block}printed\n{told}instead of\n{promised}")
    print(f"{page}: {len(found)} blocks")


main(str(Path(sys.argv[1]).resolve()), sys.argv[2:])
