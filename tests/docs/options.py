"""options.py ROOT ACDF: every long option in the help of every command is named on a page: README.md, docs/*.md or an appendix."""
import pathlib
import re
import subprocess
import sys

root, acdf = pathlib.Path(sys.argv[1]), sys.argv[2]


def help_of(*command):
    return subprocess.run([acdf, *command, "--help"], capture_output=True, text=True, check=True).stdout


pages = [root / "README.md", *(root / "docs").glob("*.md"), *(root / "docs/appendix").glob("*.md")]
named = set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", "\n".join(p.read_text(encoding="utf-8") for p in pages)))
commands = re.findall(r"^  ([a-z]+) +[A-Z]", help_of(), flags=re.M)
missing, checked = [], 0
for command in commands:
    for option in re.findall(r"^  (?:-\w,)?(--[a-z][a-z-]*)", help_of(command), flags=re.M):
        checked += 1
        if option not in named:
            missing.append(f"acdf {command} {option}: named in neither README.md nor docs/")
assert len(commands) > 10 and checked > 100, "help has another layout"
print("\n".join(missing) or f"{checked} options of {len(commands)} commands are all named on a page")
sys.exit(bool(missing))
