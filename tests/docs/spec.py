"""spec.py ROOT: format/SPEC.md is no longer than it may be, and has every section and step that are cited: in itself,
and in the files of ROOT, as "SPEC.md §7.2"."""
import pathlib
import re
import sys

MOST_BYTES = 62500
MOST_BYTES_OF_ENVIRONMENTS = 19000  # up to the heading of part II
SECOND_PART = "\n# Part II. "
NUMBER = r"\d+(?:\.\d+)?"
SECTION = f"§({NUMBER})"
CITATION = rf"SPEC\.md ((?:(?:, | and | to )?§{NUMBER})+)"
IGNORED = {"build", ".git", "node_modules"}
ENDINGS = {".md", ".h", ".c", ".cpp", ".py", ".ts", ".mjs", ".cmake", ".txt"}


def sections(text):
    """The numbered headings, each with the numbers of the steps below it."""
    parts = re.split(rf"^#{{2,3}} ({NUMBER})\.? .*$", text, flags=re.M)
    return {number: set(re.findall(r"^(\d+)\. ", body, flags=re.M)) for number, body in zip(parts[1::2], parts[2::2])}


def faults_of_size(text):
    first = text.partition(SECOND_PART)[0]
    for name, part, most in ("all", text, MOST_BYTES), ("what environments need", first, MOST_BYTES_OF_ENVIRONMENTS):
        if len(part.encode()) > most:
            yield f"{name}: {len(part.encode())} bytes, more than {most}"
    if first == text:
        yield "there is no second part"


def faults_within(text):
    found = sections(text)
    for number in re.findall(SECTION, text):
        if number not in found:
            yield f"there is no §{number}"
    for first, last, number in re.findall(r"\bsteps? (\d+)(?: (?:to|and) (\d+))? of " + SECTION, text):
        for step in filter(None, (first, last)):
            if step not in found.get(number, ()):
                yield f"§{number} has no step {step}"


def cited(text):
    """The sections that a comment or page cites."""
    return [number for citation in re.findall(CITATION, text) for number in re.findall(SECTION, citation)]


def self_test():
    text = "## 1. One\n```\n1. a\n2. b\n```\n### 1.1 Two\nstep 2 of §1\n" + SECOND_PART
    assert sections(text) == {"1": {"1", "2"}, "1.1": set()}
    assert not list(faults_within(text)) and not list(faults_of_size(text))
    assert len(list(faults_within(text + "§2, step 3 of §1, steps 1 to 4 of §1"))) == 3
    assert len(list(faults_of_size("x" * (MOST_BYTES + 1)))) == 3
    assert cited("(SPEC.md §5.1 to §5.3 and §7, §9)") == ["5.1", "5.3", "7", "9"]


def main(root):
    self_test()
    spec = root / "format" / "SPEC.md"
    text = spec.read_text(encoding="utf-8")
    faults = [*faults_of_size(text), *faults_within(text)]
    found, count = sections(text), 0
    for path in sorted(root.rglob("*")):
        if path.suffix not in ENDINGS or path == spec or IGNORED & set(path.relative_to(root).parts[:-1]):
            continue
        lines = path.read_text(encoding="utf-8", errors="replace")
        for number in re.findall(SECTION, lines) if path.parent == root / "format" / "decoder" else cited(lines):
            count += 1
            if number not in found:
                faults.append(f"{path.relative_to(root)} cites §{number}")
    print("\n".join(faults) or f"{len(text.encode())} bytes, {len(found)} sections, {count} citations")
    return bool(faults or count == 0)


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
