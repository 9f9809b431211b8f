#!/usr/bin/env python3
"""make_single.py OUT: the reader as two files, OUT/acdf.h and OUT/acdf.cpp, for renderers that copy them.

Every line is one of the reader's sources. Files follow one another in the order in which they include each other, each once.
Include guards, own #includes and the `extern "C"` of each header go; the standard headers stand at the top. What files need
that environments of halvings do not is left out where ACDF_ENVIRONMENT_ONLY is defined: a file that no #include outside
`#ifndef ACDF_ENVIRONMENT_ONLY` leads to from SMALL and the public headers of environments.
"""
import pathlib
import re
import sys

READER = pathlib.Path(__file__).resolve().parent.parent
FOLDERS = (READER, READER.parent.parent / "format")
PUBLIC = ("acdf/acdf.h", "acdf/reader.h", "acdf/environment_view.h", "acdf/views.h")
PUBLIC_SMALL = PUBLIC[:3]
SMALL = ("c_api.cpp", "file.cpp", "check/check.cpp", "check/partner.cpp", "check/description.cpp",
         "check/halvings.cpp", "halved_tree.cpp", "inflate.cpp", "payloads.cpp", "memory.cpp", "message.cpp",
         "input_file.cpp")
BANNER = """// The reader of .acdf files, made by lib/reader/single/make_single.py from lib/reader: change that, not this. The licence
// is that of the project (LICENSE). {what}
"""
HEADER = BANNER.format(what="""
//
// Copy acdf.h and acdf.cpp into a renderer, compile acdf.cpp as C++17 and link zlib. Neither needs exceptions or RTTI. C
// programs include acdf.h, too. Compile both with -ffp-contract=off, so that all processors sample the same directions.
//   ACDF_ENVIRONMENT_ONLY  defined wherever either is compiled: environments of fit `variance` alone, a small part of it
//   ACDF_ZLIB=0            for acdf.cpp: no zlib; only files that were made with `--compress none` are read""")
SOURCE = BANNER.format(what="It goes with acdf.h.")

OWN = re.compile(r'#include (?:"([^"]+)"|<(acdf/[^>]+)>)\n')
STANDARD = re.compile(r"#include <[^>]+>\n")
GUARD = re.compile(r"#ifndef (ACDF_\w+_H)\n#define \1\n(.*)#endif\n\Z", re.S)
OPEN_C = '#ifdef __cplusplus\nextern "C" {\n#endif\n'
CLOSE_C = "#ifdef __cplusplus\n}\n#endif\n"
SMALL_ONLY = "ACDF_ENVIRONMENT_ONLY"


def read(name):
    for folder in FOLDERS:
        if (folder / name).is_file():
            return (folder / name).read_text()
    raise SystemExit(f"make_single.py: there is no {name}")


def lines_with_conditions(text):
    """(line, the conditions that it stands in)"""
    conditions = []
    for line in text.splitlines(keepends=True):
        if re.match(r"#\s*endif", line):
            conditions.pop()
        elif re.match(r"#\s*el", line):
            conditions[-1] = "not " + conditions[-1]
        yield line, tuple(conditions)
        if re.match(r"#\s*if", line):
            conditions.append(line.strip())


def body(name):
    """A file without guard, `#pragma once` and `extern "C"`; whether it had the last."""
    text = read(name).replace("#pragma once\n", "")
    guarded = GUARD.search(text)
    if guarded:
        text = text[:guarded.start()] + guarded.group(2)
    in_c = OPEN_C in text
    return text.replace(OPEN_C, "").replace(CLOSE_C, "") if in_c else text, in_c


def included(name, small):
    """What a file includes of ours; `small`: of the environment profile."""
    for line, conditions in lines_with_conditions(body(name)[0]):
        own = OWN.match(line)
        if own and not (small and f"#ifndef {SMALL_ONLY}" in conditions):
            yield own.group(1) or own.group(2)


def ordered(roots, small, done=()):
    """All that roots lead to, and they, each behind what it includes."""
    out = list(done)

    def visit(name, open_files):
        if name in out:
            return
        if name in open_files:
            raise SystemExit(f"make_single.py: {name} includes itself")
        for other in included(name, small):
            visit(other, open_files | {name})
        out.append(name)

    for root in roots:
        visit(root, frozenset())
    return out[len(done):]


def without_empty(text):
    """Without conditions around nothing, and with single empty lines."""
    while True:
        shorter = re.sub(r"^#if[^\n]*\n\s*#endif[^\n]*\n", "", text, flags=re.M)
        if shorter == text:
            return re.sub(r"\n{3,}", "\n\n", text).strip() + "\n"
        text = shorter


def placed(name, standard):
    """What is left of a file where it is put; standard headers that it asks for in any case go to `standard`."""
    out = []
    for line, conditions in lines_with_conditions(body(name)[0]):
        if OWN.match(line):
            continue
        if STANDARD.match(line) and not conditions:
            standard.add(line)
        else:
            out.append(line)
    return without_empty("".join(out))


def joined(names, small, standard):
    """Files one after the other, those that are not `small` within #ifndef."""
    out, inside = [], False
    for name in names:
        if inside == (name in small):
            out.append("#endif\n" if inside else f"#ifndef {SMALL_ONLY}\n")
            inside = not inside
        text = placed(name, standard)
        if name in names and body(name)[1] and name.endswith(".h") and name in IN_SOURCE:
            text = f'extern "C" {{\n{text}}}\n'
        out.append(f"// ---- {name} ----\n\n{text}\n" if not name.endswith(".h") or not is_c(name)
                   else f"/* ---- {name} ---- */\n\n{text}\n")
    if inside:
        out.append("#endif\n")
    return "".join(out)


def is_c(name):
    return "#pragma once" not in read(name)


IN_SOURCE = set()


def main(out):
    sources = sorted(str(path.relative_to(READER)) for path in READER.rglob("*.cpp"))
    small = set(ordered(PUBLIC_SMALL + SMALL, small=True))
    public = ordered(PUBLIC, small=False)
    internal = ordered(list(SMALL) + [name for name in sources if name not in SMALL], False, public)
    IN_SOURCE.update(internal)

    in_c, in_cpp = set(), set()
    c_part = joined([name for name in public if is_c(name)], small, in_c)
    cpp_part = joined([name for name in public if not is_c(name)], small, in_cpp)
    header = (HEADER.replace("// ", "/* ", 1).replace("\n//", "\n *").rstrip("\n") + " */\n"
              "#ifndef ACDF_H\n#define ACDF_H\n\n" + "".join(sorted(in_c)) + "\n" + OPEN_C + "\n" + c_part + "\n" +
              CLOSE_C + "\n#ifdef __cplusplus\n" + "".join(sorted(in_cpp)) + "\n" + cpp_part + "#endif\n#endif\n")
    asked = set()
    source = joined(internal, small, asked)
    source = (SOURCE + '#include "acdf.h"\n\n' + "".join(sorted(asked)) + "\n" + source)
    out.mkdir(parents=True, exist_ok=True)
    (out / "acdf.h").write_text(without_empty(header))
    (out / "acdf.cpp").write_text(without_empty(source))


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
