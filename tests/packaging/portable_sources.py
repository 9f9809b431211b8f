#!/usr/bin/env python3
"""portable_sources.py ROOT: whether what embeds and installs the libraries keeps to CMake 3.16 - no command, property or
generator expression that came later - and the libraries to what any C++17 compiler knows: nothing of GNU's that is not in the
scope of an #if which asks for it. Fails with the lines that do not."""
import pathlib
import re
import sys

# What is newer, and since when: https://cmake.org/cmake/help/latest/release/.
NEWER = {
    r"\bcmake_language\s*\(": "3.18", r"\bcmake_path\s*\(": "3.20", r"\bblock\s*\(": "3.25",
    r"\bcmake_pkg_config\s*\(": "3.31", r"\bcmake_diagnostic\s*\(": "4",
    r"\bfile\s*\(\s*(CONFIGURE|ARCHIVE_CREATE|ARCHIVE_EXTRACT)\b": "3.18", r"\bfile\s*\(\s*(CHMOD|CHMOD_RECURSE|REAL_PATH)\b": "3.19",
    r"\bfile\s*\(\s*COPY_FILE\b": "3.21", r"\bstring\s*\(\s*JSON\b": "3.19", r"\bstring\s*\(\s*HEX\b": "3.18",
    r"\blist\s*\(\s*TRANSFORM\b.*\bREGEX\b.*MATCHALL": "4", r"\bZIP_LISTS\b": "3.17", r"\bFILE_SET\b": "3.23",
    r"\bRUNTIME_DEPENDENC": "3.21", r"\bIMPORTED_RUNTIME_ARTIFACTS\b": "3.21", r"\bCOMMAND_ERROR_IS_FATAL\b": "3.19",
    r"\bfind_(program|library|file|path)\s*\([^)]*\bREQUIRED\b": "3.18", r"\breturn\s*\(\s*PROPAGATE\b": "3.25",
    r"\bPATH_EQUAL\b": "3.24", r"\bCMAKE_CURRENT_FUNCTION": "3.17", r"\bPROJECT_IS_TOP_LEVEL\b": "3.21",
    r"\bNO_CMAKE_INSTALL_PREFIX\b": "3.24", r"\bCXX_MODULE": "3.28", r"\bDEPFILE\b": "3.20", r"\bDEFER\b": "3.19",
    r"\bLINK_LIBRARY_OVERRIDE\b": "3.24", r"\bCMAKE_(C|CXX)_COMPILER_LAUNCHER_": "3.27", r"\bSOURCES_FROM": "3.25",
    r"\$<(LINK_LIBRARY|LINK_GROUP|PATH|BUILD_LOCAL_INTERFACE|LIST|COMPILE_ONLY|DEVICE_LINK|HOST_LINK|TARGET_RUNTIME_DLLS)\b":
        "3.18 to 3.27",
    r"\$<(TARGET_OBJECTS|TARGET_NAME_IF_EXISTS):[^>]*,": "3.28",
    r"\bcxx_std_26\b": "3.25", r"\bcxx_std_23\b": "3.20",
}
FILES = ["CMakeLists.txt", "lib/CMakeLists.txt", "lib/install.cmake", "lib/acdfConfig.cmake.in", "lib/packages.cmake",
         "lib/reader/CMakeLists.txt", "lib/arrays/CMakeLists.txt", "lib/batch/CMakeLists.txt", "lib/curves/CMakeLists.txt",
         "lib/indexed/CMakeLists.txt", "lib/visibility/CMakeLists.txt", "lib/product/CMakeLists.txt", "lib/shader/CMakeLists.txt",
         "lib/compress/CMakeLists.txt", "lib/build/CMakeLists.txt", "lib/python/CMakeLists.txt"]


def newer(text):
    """(line, what, since) of what CMake 3.16 does not know."""
    code = re.sub(r"#[^\n]*", "", text)
    for pattern, since in NEWER.items():
        for match in re.finditer(pattern, code):
            yield code.count("\n", 0, match.start()) + 1, match.group(0).split("\n")[0], since


# What only some compilers know, and what asks for it.
FOREIGN = re.compile(r"\b__builtin_\w+|\b__attribute__|#pragma GCC|\b__int128\b|\b__asm|\btypeof\b|\bssize_t\b|<(unistd|sys/\w+)\.h>")
ASKED = re.compile(r"__GNUC__|__clang__|__SSE2__|ACDF_SSE2|__CUDA|__HIP|_WIN32|__linux__")


def foreign(text):
    """(line, what) outside of the #if that asks for it."""
    asked = []
    for number, line in enumerate(text.splitlines(), 1):
        directive = re.match(r"\s*#\s*(if\w*|elif|else|endif)\b(.*)", line)
        if directive and directive.group(1).startswith("if"):
            asked.append(bool(ASKED.search(line)))
        elif directive and directive.group(1) == "elif":
            asked[-1] = asked[-1] or bool(ASKED.search(line))
        elif directive and directive.group(1) == "endif":
            asked.pop()
        found = FOREIGN.search(re.sub(r"//.*|/\*.*?\*/", "", line))
        if found and not any(asked):
            yield number, found.group(0)


def main(root):
    assert list(foreign("#if defined(__GNUC__)\n__builtin_x();\n#else\n#endif\n__builtin_y();")) == [(5, "__builtin_y")]
    assert [since for _, _, since in newer('a()\ncmake_path (GET x)\n# block()\nstring(JSON "b")\n')] == ["3.20", "3.19"]
    root, count = pathlib.Path(root), 0
    minimum = re.search(r"cmake_minimum_required\(VERSION (\d+\.\d+)", (root / "CMakeLists.txt").read_text()).group(1)
    if minimum != "3.16":
        print(f"CMakeLists.txt: asks for CMake {minimum}")
        count += 1
    for name in FILES:
        for line, what, since in newer((root / name).read_text()):
            print(f"{name}:{line}: {what} came with CMake {since}")
            count += 1
    for room in ("reader", "arrays", "batch", "curves", "indexed", "visibility", "product", "compress", "build"):
        for path in sorted((root / "lib" / room).rglob("*.*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            for line, what in foreign(path.read_text()):
                print(f"{path.relative_to(root)}:{line}: {what}, whatever the compiler")
                count += 1
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
