#!/usr/bin/env python3
"""moving_tables.py ACDF ACDF_CLEAR_SKY [WIDTH [BUDGET...]]: tables of docs/moving.md and docs/notes/moving.md, of one day of skies.

One file of 24 hours and three turbidities beside a 64 KiB file of its own for each sky, at its maps and between them; then how much
the variance changes from frame to frame, a frame every two and a half minutes. WIDTH: columns of maps, 256 unless
given. BUDGET: of the file, 16KiB to 256KiB unless given.
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile

HOURS = [4.5 + 15 * i / 23 for i in range(24)]
TURBIDITIES = [2, 4, 6]


def run(*command):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True).stdout


class Day:
    def __init__(self, acdf, clear_sky, width, folder):
        self.acdf, self.clear_sky, self.width, self.folder, self.own = acdf, clear_sky, width, folder, {}

    def map(self, hour, turbidity):
        path = self.folder / f"{hour:.4f}-{turbidity}.pfm"
        if not path.exists():
            run(self.clear_sky, self.width, f"{hour:.6f}", turbidity, path)
        return path

    def file(self, budget, turbidities):
        maps = [self.map(hour, turbidity) for hour in HOURS for turbidity in turbidities]
        axes = ["--axis", "time=" + ",".join(f"{hour:.6f}" for hour in HOURS)]
        if len(turbidities) > 1:
            axes += ["--axis", "turbidity=" + ",".join(map(str, turbidities))]
        out = self.folder / f"{budget}-{len(turbidities)}.acdf"
        run(self.acdf, "env", *maps, "-o", out, *axes, "--budget", budget, "--quiet")
        return out

    def variance(self, file, at, sky):
        told = run(self.acdf, "measure", file, "--against", self.map(*sky), "--at", at, "--json")
        return json.loads(told)["relative_variance"]

    def own_variance(self, sky):
        if sky not in self.own:
            made = run(self.acdf, "env", self.map(*sky), "-o", self.folder / "own.acdf", "--force", "--quiet", "--json")
            self.own[sky] = json.loads(made)["relative_variance"]
        return self.own[sky]

    def ratios(self, file, hours, turbidities):
        out = [self.variance(file, f"{hour:.6f},{t}", (hour, t)) / self.own_variance((hour, t)) for hour in hours for t in turbidities]
        return math.exp(sum(map(math.log, out)) / len(out)), max(out)


def changes(variances):
    """From frame to frame: mean and worst factor."""
    logs = [abs(math.log(b / a)) for a, b in zip(variances, variances[1:])]
    return math.exp(sum(logs) / len(logs)), math.exp(max(logs))


def main():
    width = int(sys.argv[3]) if len(sys.argv) > 3 else 256
    with tempfile.TemporaryDirectory() as name:
        day = Day(sys.argv[1], sys.argv[2], width, pathlib.Path(name))
        between = [(a + b) / 2 for a, b in zip(HOURS[::3], HOURS[1::3])]
        print(f"maps {width}x{width // 2}\n\n| one file of | geometric mean, at maps | worst | geometric mean, between | worst |")
        print("|---|---|---|---|---|")
        for budget in sys.argv[4:] or ["16KiB", "32KiB", "64KiB", "128KiB", "256KiB"]:
            file = day.file(budget, TURBIDITIES)
            cells = [*day.ratios(file, HOURS[::3], TURBIDITIES), *day.ratios(file, between, [2, 3, 5])]
            print(f"| {budget} | " + " | ".join(f"{x:.2g}" for x in cells) + " |", flush=True)
        frames = [9 + i / 24 for i in range(49)]
        one = day.file("64KiB", [3])
        rows = {"one file of the day": [day.variance(one, f"{hour:.6f}", (hour, 3)) for hour in frames],
                "a file for each frame": [day.own_variance((hour, 3)) for hour in frames]}
        print("\n| from frame to frame | mean factor | worst |\n|---|---|---|")
        for what, variances in rows.items():
            print(f"| {what} | " + " | ".join(f"{x:.3g}" for x in changes(variances)) + " |")


main()
