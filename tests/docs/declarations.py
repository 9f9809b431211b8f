#!/usr/bin/env python3
"""declarations.py [--self-test] HEADER...: fails where a public declaration has no comment.

Public is what stands in a header at the level of a namespace, and in the public part of a class: functions, classes,
structs, enumerations. A comment serves all declarations that follow it without an empty line, and the line that it ends.
Documented elsewhere, and asked for nothing: what is deleted or defaulted, destructors, constructors of views."""
import re
import sys

OPENERS = re.compile(r"^\s*(namespace\b.*|extern \"C\" )\{$")
TYPE = re.compile(r"^\s*(?:typedef\s+)?(class|struct|enum|union)\b(?:\s+class)?\s*(\w+)?")
FUNCTION = re.compile(r"([A-Za-z_]\w*)\s*\(")
TRIVIAL = re.compile(r"= (delete|default)\b|^\s*~")


def uncommented(text):
    """Numbers and names of declarations without a comment."""
    found, depth, public, kinds = [], 0, [True], []
    documented, in_comment, statement, begin = False, False, "", 0
    macro = False
    for number, line in enumerate(text.splitlines(), 1):
        if macro or line.lstrip().startswith("#"):
            macro = line.endswith("\\")
            continue
        code = line
        if in_comment:
            end = code.find("*/")
            if end < 0:
                continue
            code, in_comment = code[end + 2:], False
        had_comment = "//" in code or "/*" in code
        code = re.sub(r"/\*.*?\*/", "", code)
        if "/*" in code:
            code, in_comment = code[:code.index("/*")], True
        code = re.sub(r"//.*", "", re.sub(r'"(\\.|[^"\\])*"', '""', code)).rstrip()
        if had_comment and not statement:
            documented = True
        if not code.strip():
            if not had_comment and not in_comment and not line.strip():
                documented = False
            continue
        if re.match(r"^\s*(public|private|protected):$", code):
            public[-1] = "public" in code
            continue
        if not statement:
            begin = number
        statement += " " + code.strip()
        if not re.search(r"[;{}]$|^\s*[A-Z_]+\(.*\)$", code):
            continue
        visible = all(public) and all(kind in ("space", "class") for kind in kinds)
        head = statement.strip()
        if visible and not documented and not had_comment and not TRIVIAL.search(head):
            kind, name = TYPE.match(head), FUNCTION.search(re.sub(r"__attribute__\(\(.*?\)\)", "", head))
            if kind and "{" in head:
                found.append((begin, kind.group(2) or kind.group(1)))
            elif name and not kind and not re.search(r"\w>?::\w+\s*\(", head.split("(")[0] + "(") and not head.startswith(("using", "static_assert", "ACDF_STATIC_ASSERT", "friend")):
                found.append((begin, name.group(1)))
        for index, mark in enumerate(statement):
            if mark == "{":
                before = statement[:index].strip()
                space = re.match(r"^(inline )?namespace\b|^extern", before)
                kinds.append("space" if space else "class" if re.match(r"^(class|struct)\b", before) and index == len(statement) - 1 else "body")
                public.append(not before.startswith("class"))
            elif mark == "}" and kinds:
                kinds.pop()
                public.pop()
        statement = ""
    return found


COUNTED = """
/// A
class A {
public:
    A() = default;
    /// f
    int f() const { return 1; }
    int g() const;
    int h(); ///< h

    int i(int a,
          int b);
private:
    int j();
};

void k(int);
struct L {
    int m;
};
/* n */
static inline int n(void) {
    if (1) return f();
    return 0;
}
static inline int o(void) { return 1; }

static inline int p(void) { return 2; }
"""


def main(headers):
    if headers[0] == "--self-test":
        names = [name for _, name in uncommented(COUNTED)]
        if names != ["i", "k", "L", "p"]:
            print(f"self-test: {names}")
            return 1
        headers = headers[1:]
    count = 0
    for path in headers:
        with open(path, encoding="utf-8") as file:
            for number, name in uncommented(file.read()):
                print(f"{path}:{number}: {name} has no comment")
                count += 1
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
