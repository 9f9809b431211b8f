#!/usr/bin/env python3
"""lines.py PAGE STAND_INS...: whether each line of C++ that the table of PAGE gives stands in one of the stand-ins, which a
test compiles and runs."""
import pathlib
import re
import sys


def lines_of(page):
    """The code of the last column of the table, where it is a statement or a brace."""
    for row in page.splitlines():
        cells = [cell.strip() for cell in re.split(r"(?<!\|)\|(?!\|)", row)[1:-1]] if row.startswith("|") else []
        code = re.fullmatch(r"`(.*)`", cells[-1]) if len(cells) == 2 else None
        if code and re.search(r"[;{}]$", code[1]):
            yield code[1].strip()


page, *stand_ins = (pathlib.Path(path).read_text(encoding="utf-8") for path in sys.argv[1:])
known = {line.strip() for text in stand_ins for line in text.splitlines()}
lines = list(lines_of(page))
missing = [line for line in lines if line not in known]
for line in missing:
    print(f"not compiled by any test: {line}")
if len(lines) < 20:
    sys.exit(f"only {len(lines)} lines of code found in {sys.argv[1]}")
sys.exit(1 if missing else 0)
