#!/usr/bin/env python3
"""headline.py [--check]: writes the figures that README.md names, from the tables of docs/appendix/, so that each number is
made in one place. With --check nothing is written: exit code 1 where README.md says something else than the tables."""
import math
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
README = ROOT / "README.md"


def tables(page, first_column, header_of=""):
    """All tables of a page whose header begins with the first text and has the other one: rows as {header: cell}, no markup.
    Of columns with the same header the first counts."""
    found, rows = [], []
    for line in [*(ROOT / "docs/appendix" / page).read_text(encoding="utf-8").splitlines(), ""]:
        if line.startswith("|"):
            rows.append([re.sub("[`*]", "", cell).strip() for cell in line.strip("|").split("|")])
            continue
        if rows and rows[0][0] == first_column and header_of in rows[0]:
            found.append([dict(zip(rows[0][::-1], row[::-1])) for row in rows[2:]])
        rows = []
    if not found:
        sys.exit(f"headline.py: {page} has no table of '{first_column}' with '{header_of}'")
    return found


def numbers(text):
    return [float(x) for x in re.findall(r"\d+(?:\.\d+)?(?:e-?\d+)?", text)]


def span(values, text="{:.0f}"):
    """The least and the largest value: one number where they round to the same."""
    low, high = text.format(min(values)), text.format(max(values))
    return low if low == high else f"{low} to {high}"


class Environment:
    """The first table of times of maps with so many columns, of a file of 64 KiB."""

    def __init__(self, columns):
        page = (ROOT / "docs/appendix/performance-environment.md").read_text(encoding="utf-8")
        match = re.search(rf"\n{columns} x \d+ texels; full table of (\d+) bytes\n"
                          r"- a file of (65536) bytes takes (\d+) more[^\n]*\n.*?\n(\|[^\n]*\|)\n[^\n]*\n\| sample (\|[^\n]*)",
                          page, re.S)
        if not match:
            sys.exit(f"headline.py: no times of 64 KiB with {columns} columns")
        self.full_bytes, self.bytes = int(match[1]), int(match[2]) + int(match[3])
        cells = dict(zip([cell.strip() for cell in match[4].strip("|").split("|")][1:],
                         [cell.strip() for cell in match[5].strip("|").split("|")]))
        self.ns, self.full_ns = numbers(cells["64 KiB"])[0], numbers(cells["full table"])[0]
        self.faster = self.full_ns / self.ns


def gain(page, first_column, header_of, row):
    """Of equal samples, over the full CDF, in the first table of pictures that has the row."""
    for rows in tables(page, first_column, header_of):
        for cells in rows:
            if cells[first_column] == row:
                return numbers(cells[header_of])[0]
    sys.exit(f"headline.py: {page} has no row {row}")


def headline():
    sizes = [float(row["64 KiB"]) for row in tables("accuracy-environment.md", "probe", "64 KiB, zlib")[0]]
    local = [numbers(row["1 MB"])[1] for row in tables("accuracy-local.md", "probe", "1 MB")[0] if "geometric" not in row["probe"]]
    mean = math.exp(sum(map(math.log, local)) / len(local))
    shadows = [numbers(row["gain, equal samples"])[0] for rows in tables("accuracy-local.md", "sampler", "gain, equal samples")[:3]
               for row in rows if row["sampler"] == "local:1MB"]
    wall = gain("accuracy-visibility.md", "sampler", "gain, equal samples", "local:1MB")
    small, large = Environment(1024), Environment(4096)
    brdfs = tables("performance-brdf.md", "", "ns a sample")
    single = [(float(row["ns a sample"]), float(rows[0]["ns a sample"])) for rows in brdfs for row in rows
              if row[""] in ("64 KiB", "128 KiB")]
    return f"""- **Small.** A 64 KiB file, {max(small.bytes, large.bytes) / 1e6:.2f} MB in memory with its tables, replaces a full-resolution CDF of {small.full_bytes / 1e6:.1f} MB. One sample
  of the map's light has a relative variance of {min(sizes):.2g} to {max(sizes):.2g} on
  [six probes](docs/appendix/accuracy-environment.md#sizes) with nearest lookup; that of the full CDF is 0.
- **For each surface normal.** `acdf local` (1 MB) samples light × cosine for any normal. With light samples
  only and nothing hidden, variance is {min(local):.0f} to {max(local):.0f} times lower than with the full-resolution CDF
  ([geometric mean {mean:.0f}](docs/appendix/accuracy-local.md#sizes)). With shadows the gain is smaller:
  [{span(shadows, "{:.1f}")} times](docs/appendix/accuracy-local.md#pictures) in three scenes, and
  [{wall:.1f} times](docs/appendix/accuracy-visibility.md#a-wall) behind a wall. With MIS in pbrt-v4 it is 1.5 times (below).
- **Fast.** Sampling a 64 KiB file takes {span([small.ns, large.ns])} ns, {small.faster:.1f} times faster than a full-resolution CDF at 1024×512 and
  {large.faster:.1f} times at 4096×2048. File and tables made at load take {max(small.bytes, large.bytes) / 1e6:.2f} MB; the full CDF takes {small.full_bytes / 1e6:.1f} and {large.full_bytes / 1e6:.0f} MB
  ([times](docs/performance.md#environment-files)). A measured BRDF is sampled in {span([ns for ns, _ in single])} ns, {span([rgl / ns for ns, rgl in single], "{:.1f}")} times faster than by
  its authors' sampler ([times](docs/performance.md#brdfs))."""


def main():
    text = README.read_text(encoding="utf-8")
    made, count = re.subn(r"(<!-- headline -->\n).*?(<!-- /headline -->)", lambda m: m[1] + headline() + "\n" + m[2], text, flags=re.S)
    if count != 1:
        sys.exit("headline.py: README.md has no headline marks, or more than one pair")
    if made == text:
        return 0
    if "--check" in sys.argv[1:]:
        sys.stderr.write("README.md: figures differ from those of docs/appendix/; run docs/make/headline.py\n")
        return 1
    README.write_text(made, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
