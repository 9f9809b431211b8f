"""links.py ROOT: every relative link of the Markdown pages leads to a file, and to a heading of it where it names one."""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
pages = sorted(p for p in root.rglob("*.md") if not {"build", ".git", "node_modules"} & set(p.relative_to(root).parts[:-1]))


def text_of(page):
    """Without what stands between fences."""
    return re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.S | re.M)


def anchors(page):
    found = set()
    for heading in re.findall(r"^#+ +(.*)$", text_of(page), flags=re.M):
        heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).lower()
        found.add(re.sub(r"[^\w\- ]", "", heading).strip().replace(" ", "-"))
    return found


broken = []
for page in pages:
    for link in re.findall(r"\]\(([^)\s]+)\)", text_of(page)):
        if re.match(r"[a-z]+:", link):
            continue
        path, _, anchor = link.partition("#")
        target = (page.parent / path).resolve() if path else page
        if not target.exists():
            broken.append(f"{page.relative_to(root)}: {link}: no such file")
        elif anchor and target.suffix == ".md" and anchor not in anchors(target):
            broken.append(f"{page.relative_to(root)}: {link}: no such heading")
print("\n".join(broken) or f"{len(pages)} pages, all links lead somewhere")
sys.exit(bool(broken))
