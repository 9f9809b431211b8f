#!/usr/bin/env python3
"""headline.py [--check]: writes the figures that README.md names, from the tables of docs/accuracy.md and
docs/performance.md, so that each number is made in one place. With --check nothing is written: exit code 1 where
README.md says something else than the tables."""
import math
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
README = ROOT / "README.md"


def table(page, first_column, header_of=""):
    """Rows, lists of cells without markup, of the first table whose header begins with the texts given."""
    rows = []
    for line in (ROOT / "docs" / page).read_text(encoding="utf-8").splitlines():
        if line.startswith("|"):
            rows.append([re.sub("[`*]", "", cell).strip() for cell in line.strip("|").split("|")])
            continue
        if rows and rows[0][0] == first_column and header_of in rows[0]:
            break
        rows = []
    if not rows:
        sys.exit(f"headline.py: {page} has no table of '{first_column}' with '{header_of}'")
    header, body = rows[0], rows[2:]
    return [dict(zip(header, row)) for row in body]


def numbers(text):
    return [float(x) for x in re.findall(r"\d+(?:\.\d+)?(?:e-?\d+)?", text)]


def tables_of_calls():
    """Those of environment files, one a width: {row: {column: text}}."""
    page = (ROOT / "docs/performance.md").read_text(encoding="utf-8")
    found = {}
    for width, body in re.findall(r"\n(\d+) x \d+ texels;[^\n]*\n(?:- [^\n]*\n)*\n((?:\|[^\n]*\n)+)", page):
        lines = [[cell.strip() for cell in line.strip("|").split("|")] for line in body.splitlines()]
        found[int(width)] = {line[0]: dict(zip(lines[0], line)) for line in lines[2:]}
    return found


def ratio(width, row, calls):
    return float(re.search(r"\(([\d.]+)\)", calls[width][row]["64 KiB"]).group(1))


def headline():
    sizes = [float(row["64 KiB"]) for row in table("accuracy.md", "probe", "64 KiB, zlib")]
    local = [numbers(row["1 MB"])[1] for row in table("accuracy.md", "probe", "1 MB") if "×" in row["1 MB"] and "geometric" not in row["probe"]]
    gain = math.exp(sum(map(math.log, local)) / len(local))
    calls = tables_of_calls()
    draws = [numbers(calls[width]["sample"]["64 KiB"])[0] for width in calls]
    waves = [row for row in table("performance.md", "", "ns a sample") if "AVX-512" in row[""]]
    wave_draws = [float(row["ns a sample"]) for row in waves]
    sampling = " to ".join(sorted({f"{draw:.0f}" for draw in (min(draws), max(draws))}))
    return f"""- **Small.** Files of 16 to 64 KiB replace full-resolution tables of megabytes and stay in the cache. At 64 KiB one light sample has a
  relative variance of {min(sizes):.2g} to {max(sizes):.2g} on [six real probes](docs/accuracy.md#sizes).
- **Takes the normal into account.** Where nothing hides the light, `acdf local` at 1 MB has {min(local):.0f} to {max(local):.0f} times less variance than the
  full-resolution CDF (geometric mean {gain:.0f}, [eight probes](docs/accuracy.md#e4-local-environment-maps)). Shadows take most of
  that, as in the picture above and [behind a wall](docs/accuracy.md#what-hides-light).
- **Fast on CPUs.** Sampling a 64 KiB file takes {sampling} ns and 0.7 MB of tables in memory. This is {1 / ratio(1024, "sample", calls):.2g} times faster than the full-resolution CDF at 1024×512,
  {1 / ratio(4096, "sample", calls):.2g} times faster at 4096×2048 ([figures](docs/performance.md#environment-files)). Batches of measured BRDFs take {min(wave_draws):.0f} to
  {max(wave_draws):.0f} ns a sample with AVX-512 ([figures](docs/performance.md#brdfs))."""


def main():
    text = README.read_text(encoding="utf-8")
    made, places = re.subn(r"(<!-- headline -->\n).*?(<!-- /headline -->)", lambda m: m[1] + headline() + "\n" + m[2], text, flags=re.S)
    if places != 1:
        sys.exit("headline.py: README.md has no place for the figures")
    if made == text:
        return 0
    if "--check" in sys.argv[1:]:
        sys.stderr.write("README.md: figures differ from those of docs/accuracy.md and docs/performance.md; run docs/make/headline.py\n")
        return 1
    README.write_text(made, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
