#!/usr/bin/env python3
"""single.py WORK SINGLE CC DUMP environments|whole samples|all CXX FILE.acdf...: checks acdf.h and acdf.cpp in the folder SINGLE.

samples: compiles them by CXX with -DACDF_ENVIRONMENT_ONLY or without, as C++17 without exceptions and RTTI and
with warnings as errors; what they print of the files must be what DUMP, the library's program, does. A C program includes the
header and is linked by CC, without a runtime library of C++.
all: that, and the same without zlib; and prints, and bounds, lines of the sources that the preprocessor leaves, and bytes of
programs that open a file and sample it once: `size` of a stripped program, less that of an empty one. zlib and the C library
are not in it.
"""
import pathlib
import re
import struct
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
CONSUMER = HERE.parents[2] / "packaging" / "consumer" / "consumer.c"
STRICT = ["-std=c++17", "-fno-exceptions", "-fno-rtti", "-Wall", "-Wextra", "-Werror"]
SMALL = ["-ffunction-sections", "-fdata-sections"]
ENVIRONMENTS = "-DACDF_ENVIRONMENT_ONLY"
# What the profile of environments and the whole, of four kinds, take at most:
# lines, bytes.
MOST_LINES = {"environments": 2400, "whole": 4500}
MOST_BYTES = {"environments": 23000, "environments of the whole": 42500, "all kinds": 69000}
OPEN_AND_SAMPLE = """
#include "acdf.h"
int main(int count, char** names) {
    acdf::File file;
    if (count != 2 || !acdf::File::open(names[1], file).ok()) return 1;
    const float up[3] = {0.0f, 0.0f, 1.0f};
    float pdf = -1.0f;
    if (file.kind() == ACDF_KIND_ENVIRONMENT) pdf = file.environment().sample(0.3, 0.4).pdf;
#ifdef ALL_KINDS
    double u[ACDF_MAX_AXES] = {0.3}, x[ACDF_MAX_AXES];
    const std::uint32_t index[ACDF_MAX_AXES] = {};
    if (file.kind() == ACDF_KIND_LOCAL) pdf = file.local().sample(up, 0.3, 0.4).pdf;
    if (file.kind() == ACDF_KIND_BRDF) pdf = file.brdf().sample(up, 0.3, 0.4).pdf;
    if (file.kind() == ACDF_KIND_TABLE) pdf = static_cast<float>(file.table().sample(index, u, x));
#endif
    return pdf > 0.0f && up[2] > 0.0f ? 0 : 2;
}
"""


def run(*command, **options):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, **options)
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, command))}\nended with {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def is_of_the_profile(path):
    """Whether a file is an environment by halvings."""
    data = pathlib.Path(path).read_bytes()
    kind, = struct.unpack_from("<I", data, 24)
    chunks, = struct.unpack_from("<I", data, 36)
    return kind == 1 and any(data[64 + 48 * i:68 + 48 * i] == b"HALV" for i in range(chunks))


def lines_of(output):
    """What is printed: (file, 'hostile' or not) -> the line."""
    return {(line.split()[0], line.split()[1] == "hostile"): line for line in output.splitlines()}


def check(work, single, cc, dump, flags, cxx, files, level):
    run(cxx, *STRICT, *SMALL, level, "-ffp-contract=off", *flags, "-c", single / "acdf.cpp", "-o", work / "acdf.o")
    run(cxx, *STRICT[:3], level, "-ffp-contract=off", *flags, "-DSINGLE", f"-I{single}", HERE / "dump.cpp", work / "acdf.o",
        "-lz", "-o", work / "dump")
    options = ["--environments"] if flags else []
    ours, theirs = (lines_of(run(program, *options, *files)) for program in (work / "dump", dump))
    compared = 0
    for path in files:
        name = pathlib.Path(path).name
        if flags and not is_of_the_profile(path):
            code, rule = ours[name, False].split()[1:3]
            if code != "6" or rule not in ("2006", "3005", "5002"):
                raise SystemExit(f"{name} is to be refused as unsupported: {ours[name, False]}")
            continue
        for hostile in (False, True):
            if ours[name, hostile] != theirs[name, hostile]:
                raise SystemExit(f"the two files differ from the library:\n{ours[name, hostile]}\n{theirs[name, hostile]}")
            compared += 1
    if compared < 6:
        raise SystemExit(f"only {compared} lines were compared")
    # From C, by the header alone.
    (work / "acdf").mkdir(exist_ok=True)
    for name in ("acdf.h", "sample.h"): # which the consumer includes
        (work / "acdf" / name).write_text(f'#include "{single}/acdf.h"\n')
    run(cc, "-std=c99", "-Wall", "-Wextra", "-Werror", "-O1", "-ffp-contract=off", *flags, f"-I{work}", CONSUMER, work / "acdf.o",
        "-lz", "-lm", "-o", work / "consumer")
    of_profile = next(path for path in files if is_of_the_profile(path))
    if not run(work / "consumer", of_profile).startswith("total "):
        raise SystemExit("the C program samples nothing")


def check_without_zlib(work, single, cc, flags, cxx, files):
    """What is deflated is refused by its name, and the rest is read."""
    run(cxx, *STRICT, "-O0", *flags, "-DACDF_ZLIB=0", "-c", single / "acdf.cpp", "-o", work / "without.o")
    run(cc, "-std=c99", "-O0", *flags, f"-I{work}", CONSUMER, work / "without.o", "-lm", "-o", work / "without")
    for path in files:
        if not is_of_the_profile(path):
            continue
        deflated = "zlib" in pathlib.Path(path).name
        done = subprocess.run([work / "without", path], capture_output=True, text=True)
        if done.returncode != int(deflated) or deflated and ("4003" not in done.stderr or not flags and "zlib" not in done.stderr):
            raise SystemExit(f"without zlib, {path}: {done.returncode} {done.stdout[:80]}{done.stderr}")


def count_lines(single, cxx, flags):
    """Lines of the two files that the preprocessor leaves something of."""
    left, at = set(), None
    for line in run(cxx, "-std=c++17", "-E", *flags, single / "acdf.cpp").splitlines():
        marker = re.match(r'# (\d+) "([^"]*)"', line)
        if marker:
            at = [marker.group(2), int(marker.group(1))]
        else:
            if line.strip() and at[0].endswith(("/acdf.h", "/acdf.cpp")):
                left.add(tuple(at))
            at[1] += 1
    return len(left)


def text_bytes(program):
    return int(run("size", program).splitlines()[1].split()[0])


def measure(work, single, profile, flags, cxx):
    """Of the object that check() compiled."""
    small = [*STRICT[:3], *SMALL, "-O2"]
    link = ["-Wl,--gc-sections", "-no-pie", "-s", "-lz"]
    (work / "empty.cpp").write_text("int main() {}\n")
    run(cxx, *small, work / "empty.cpp", *link, "-o", work / "empty")
    (work / "program.cpp").write_text(OPEN_AND_SAMPLE)
    too_many = []
    lines = count_lines(single, cxx, flags)
    print(f"{profile}: {lines} lines")
    if lines > MOST_LINES[profile]:
        too_many.append(profile)
    programs = {"environments": {"environments": flags},
                "whole": {"environments of the whole": [], "all kinds": ["-DALL_KINDS"]}}
    for what, defines in programs[profile].items():
        run(cxx, *small, *defines, f"-I{single}", work / "program.cpp", work / "acdf.o", *link, "-o", work / "program")
        size = text_bytes(work / "program") - text_bytes(work / "empty")
        print(f"{what}: {size} bytes of text")
        if size > MOST_BYTES[what]:
            too_many.append(f"{what}, in bytes")
    if too_many:
        raise SystemExit(f"more than was reached before: {too_many}")


def main(work, single, cc, dump, profile, what, cxx, *files):
    single = pathlib.Path(single).resolve()
    work = pathlib.Path(work) / f"{profile}_{pathlib.Path(cxx).name}"
    work.mkdir(parents=True, exist_ok=True)
    flags = [ENVIRONMENTS] if profile == "environments" else []
    check(work, single, cc, dump, flags, cxx, files, "-O2" if what == "all" else "-O0")
    if what == "all":
        check_without_zlib(work, single, cc, flags, cxx, files)
        measure(work, single, profile, flags, cxx)


if __name__ == "__main__":
    main(*sys.argv[1:])
