#!/usr/bin/env python3
"""style.py [--self-test] [--program ACDF] [--counts] FILE... [--messages FOLDER...]: fails where a text is hard to read,
and lists where.

Reads Markdown pages (.md), comments of C and C++ headers (.h) and, with --program, what `acdf help` and `acdf COMMAND
--help` print. Tables and code are exempt from the limits of length, and code from the words, but not from old options.
With --messages it also reads the string literals of all C++ sources of folders, for the words alone."""
import pathlib
import re
import subprocess
import sys

MOST_WORDS = 30         # of a sentence
MOST_CHARACTERS = 6 * 120  # of a paragraph: six lines, however they are broken
FEWEST_WORDS = 2        # of a string literal that is a message, not a name

# What is searched, what to write instead, an example of it, and one that is right.
WORDS = [
    (r"compan(y|ies)", "MIS partner", "Files made for a company", "an accompanying file"),
    (r"waves?|wavefronts?", "batch", "BRDFs in waves", "of all wavelengths"),
    (r"rivals?", "baseline", "the best rival", "a rivalry"),
    (r"draws?|drawn|drawing|drew", "sample", "It draws directions", "One draw call serves both"),
    (r"densit(y|ies)", "pdf", "Draw and densities of a file", "a probability density over the sphere"),
    (r"places?", "position, direction, offset; visibility cells", "at each place", "It is used in place"),
    (r"lights beside", "bright tiles", "lights beside rows", "lights and rows"),
    (r"tells?|told|telling", "store, report, print", "as its cell tells", "a teller"),
    (r"(cells?|rows?|files?|maps?|samplers?|trees?|bins?)\s+knows?", "store, take into account",
     "the file knows normals", "a renderer knows normals"),
    (r"walk(s|ed|ing)?", "traversal", "the walk of a tree", "a random walk"),
    (r"what\s+(is|was|are)\s[^.?!:;,|]{1,80}?\b(is|are|was)(?=\s)[^.?!|]*(?![^.?!]*\?)", "a noun",
     "What is left is noise", "What is left? It is noise"),
]
# Right uses of those words.
ALLOWED = re.compile(
    r"\b(in\s+(its\s+|their\s+)?place|takes?\s+place|place\s+of|decimal\s+places|draw\s+calls?|random\s+walks?|"
    r"(probability|constant|log|logarithmic)\s+densit(y|ies)|density\s+functions?|wavefront\s+(path\s+trac\w+|renderers?)|"
    r"Wavefront\s+OBJ)\b", re.I)
# Options and names that are gone, in code too.
OLD_NAMES = re.compile(r"(?<![\w-])--(places?|with|rivals|windows)(?![\w-])|\bneeds_?[cC]ompany\b|\brecommended_?[sS]hare\b")
ABBREVIATION = re.compile(r"\b(e\.g|i\.e|et al|Figs?|[Ee]q|cf|vs|ibid|approx|No|Sec)\.")


def masked(text):
    """The prose of Markdown: code is one word, links are their texts, pictures nothing. Lines stay."""
    lines = lambda match: "\n" * match.group().count("\n")
    text = re.sub(r"<!--.*?-->|</?\w+[^>]*>", lines, text, flags=re.S)
    text = re.sub(r"(`+)[^`]+?\1", lambda match: "CODE" + lines(match), text)
    text = re.sub(r"!\[[^\]]*\]\([^)]*\)", lines, text)
    return re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", text)


def page_blocks(text):
    """(line, text, kind) of each paragraph and item of a list (prose), and of each heading and row of a table (row)."""
    text = re.sub(r"<!--.*?-->", lambda match: "\n" * match.group().count("\n"), text, flags=re.S)
    block, begin, fence = [], 0, False
    for number, line in enumerate(text.splitlines() + [""], 1):
        bare = line.strip().lstrip("> ")
        edge = bare.startswith("```")
        row = bare.startswith(("|", "#"))
        if block and (edge or fence or row or not bare or re.match(r"([-*]|\d+\.) ", bare)):
            yield begin, "\n".join(block), "prose"
            block = []
        if edge:
            fence = not fence
        elif row and not fence:
            yield number, bare, "row"
        elif bare and not fence:
            begin = begin if block else number
            block.append(bare)


def header_blocks(text):
    """The same of the comments of a header: what stands on lines without code between is one block."""
    block, begin, within = [], 0, False
    for number, line in enumerate(text.splitlines() + [""], 1):
        starts = re.search(r"/\*|//", re.sub(r'"(\\.|[^"\\])*"', lambda match: "_" * len(match.group()), line))
        comment = line if within else line[starts.start():] if starts else None
        alone = within or bool(starts and not line[:starts.start()].strip())
        if comment is not None:
            within = "*/" not in comment and (within or comment.startswith("/*"))
            comment = re.sub(r"\*/.*", "", re.sub(r"^\s*(//[/!]*<?|/\*+<?|\*(?!/))", "", comment))
        words = comment is not None and comment.strip() and not re.match(r"\s{3,}\S", comment)
        if block and not (words and alone):
            yield begin, "\n".join(block), "prose"
            block = []
        if words:
            begin = begin if block else number
            block.append(comment.strip())


def help_blocks(text):
    """The same of what --help prints: descriptions of options, and paragraphs, without examples and usage."""
    block, begin, examples = [], 0, False
    for number, line in enumerate(text.splitlines() + [""], 1):
        option = re.match(r"  \S.*?(?:\s{2,}|$)", line)
        if block and (option or not line.strip() or not line.startswith(" ") and block[0] == line):
            yield begin, "\n".join(block), "help"
            block = []
        if re.match(r"(Examples|Usage):", line):
            examples = True
        elif not line.strip():
            examples = False
        elif not examples and not re.match(r"[A-Z][\w ]*:$", line):
            words = line[option.end():] if option else line
            if words.strip():
                begin = begin if block else number
                block.append(words.strip())


# Comments, characters and includes, which hold no messages; and literals, raw or not.
TOKENS = re.compile(r"//[^\n]*|/\*.*?\*/|'(?:\\.|[^'\\\n])'|^#include[^\n]*|"
                    r'R"(?P<mark>\w*)\((?P<raw>.*?)\)(?P=mark)"|"(?P<plain>(?:\\.|[^"\\\n])*)"', re.S | re.M)


def message_blocks(text):
    """The same of the string literals of C++ that have some words; those that nothing separates are one."""
    parts, begin, end = [], 0, None
    for match in [*TOKENS.finditer(text), None]:
        literal = match and (match["raw"] if match["raw"] is not None else match["plain"])
        follows = match and end is not None and not text[end:match.start()].strip()
        if parts and not (literal is not None and follows):
            message = "".join(parts)
            if len(re.findall(r"[A-Za-z]{2,}", message)) >= FEWEST_WORDS:
                yield text.count("\n", 0, begin) + 1, message, "row"
            parts = []
        if literal is not None:
            begin = begin if parts else match.start()
            parts.append(re.sub(r"\\[nt]", " ", literal))
            end = match.end()


def faults(blocks):
    """(line, what is wrong) of blocks. In help, where values of an option are listed, ; and : end a sentence, too."""
    for begin, raw, kind in blocks:
        text = masked(raw)
        line = lambda offset: begin + text.count("\n", 0, offset)
        right = [match.span() for match in ALLOWED.finditer(text)]
        for pattern, instead, _, _ in WORDS:
            for match in re.finditer(rf"\b(?:{pattern})(?!\w)", text, re.I):
                if not any(first <= match.start() < last for first, last in right):
                    yield line(match.start()), f"“{' '.join(match.group().split())[:50]}”: write {instead}"
        if kind == "row":
            continue
        if len(text) > MOST_CHARACTERS:
            yield begin, f"a paragraph of {len(text)} characters, more than 6 lines"
        sentences = ABBREVIATION.sub(lambda match: match.group()[:-1] + "_", text)
        offset = 0
        ends = r"[.!?][\"”)*_]*\s+(?![a-z])" + (r"|[.!?;:]\s" if kind == "help" else "")
        for end in [*re.finditer(ends, sentences), None]:
            sentence = sentences[offset:end.end() if end else len(sentences)]
            count = len(re.findall(r"\S*\w\S*", sentence))
            if count > MOST_WORDS:
                yield line(offset), f"a sentence of {count} words: “{' '.join(sentence.split())[:60]} …”"
            offset = end.end() if end else 0


def examine(name, text, blocks, counts):
    found = list(faults(blocks(text)))
    for number, raw in enumerate(text.splitlines(), 1):
        found += [(number, f"“{match.group()}” is gone") for match in OLD_NAMES.finditer(raw)]
    for number, fault in sorted(found):
        print(f"{name}:{number}: {fault}")
    counts[name] = len(found)


def program_texts(program):
    """(command, help) of the program and each of its commands."""
    text = lambda *words: subprocess.run([program, *words], capture_output=True, text=True, check=True).stdout
    yield "acdf help", text("help")
    for command in re.findall(r"^  ([a-z]+) +[A-Z]", text("help"), flags=re.M):
        yield f"acdf {command} --help", text(command, "--help")


def self_test():
    """Each rule finds its example, and nothing in what is right."""
    count = lambda text, blocks=page_blocks: len(list(faults(blocks(text))))
    long_sentence, thirty = "One two, three " * 11 + "end.", "One two three " * 10 + "\n"
    paragraph = "One short sentence. " * 40
    for pattern, _, wrong, right in WORDS:
        assert count(wrong), f"not found: {wrong}"
        assert not count(right), f"found: {right}"
    for option in ("acdf local --places", "`--with cosine`", "view.needs_company()", "recommendedShare()"):
        assert OLD_NAMES.search(option), f"not found: {option}"
    assert not OLD_NAMES.search("git log --with-tree, --place-holder")
    assert count(long_sentence) == 1 and not count(thirty) and not count("Good. " + thirty)
    assert count("Short. " + long_sentence) == 1 and count("- " + long_sentence + "\n- " + long_sentence) == 2
    assert not count("| " + long_sentence + " |") and not count("```\n" + long_sentence + "\nit draws\n```")
    assert count("| it draws |") == 1 and not count("`it draws` [text](places.md)") and count("[places](x.md)") == 1
    assert count(paragraph) == 1 and not count(paragraph[:600] + "\n\n" + paragraph[600:])
    assert [line for line, _ in faults(page_blocks("# Title\n\nText\nthat draws.\n"))] == [4]
    assert not count("int draw; const char* s = \"// draws\";\n", header_blocks)
    assert count("int a; // It draws.\n/* A\n * place */ int b;\n/// Rivals.\n", header_blocks) == 3
    assert count("// " + long_sentence.replace(", ", "\n// "), header_blocks) == 1
    assert not count("// Text:\n//   draw(a, places);\n", header_blocks)
    assert count("  --draw NAME [a]  How it draws,\n        at places\n\nExamples:\n  acdf draw\n", help_blocks) == 2
    assert not count("  -q  " + thirty[:-2] + ": " + thirty.lower(), help_blocks)
    assert count("  -q  " + long_sentence + "\n  -v  " + thirty, help_blocks) == 1
    assert count('say("it draws "\n    "a wave"); // it draws\nint draw; char c = \'"\'; say("draws");', message_blocks) == 2
    assert count('say("it\\ndraws", R"x(at a "place")x", "the file \\"company\\"");', message_blocks) == 3
    assert [line for line, _ in faults(message_blocks('#include "a/draw wave.h"\n\n"it is", "it draws"'))] == [3]


def main(arguments):
    counts = {}
    if "--self-test" in arguments:
        self_test()
    if "--program" in arguments:
        at = arguments.index("--program")
        for name, text in program_texts(arguments[at + 1]):
            examine(name, text, help_blocks, counts)
        del arguments[at:at + 2]
    if "--messages" in arguments:
        at = arguments.index("--messages")
        for folder in arguments[at + 1:]:
            found = {}
            for path in sorted(path for path in pathlib.Path(folder).rglob("*") if path.suffix in (".c", ".cpp", ".h")):
                examine(str(path), path.read_text(encoding="utf-8"), message_blocks, found)
            counts[f"messages of {folder}"] = sum(found.values())
        del arguments[at:]
    for path in (argument for argument in arguments if not argument.startswith("--")):
        with open(path, encoding="utf-8") as file:
            examine(path, file.read(), page_blocks if path.endswith(".md") else header_blocks, counts)
    for name, count in counts.items() if "--counts" in arguments else ():
        print(f"{count:5} {name}")
    print(f"{sum(counts.values())} faults in {len(counts)} texts")
    return 1 if sum(counts.values()) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
