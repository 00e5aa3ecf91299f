# SPDX-License-Identifier: MIT
"""CHANGELOG.md as Debian's policy wants a changelog, compressed. usage: debian_changelog.py CHANGELOG.md NAME MAINTAINER OUTPUT.gz"""
import gzip
import re
import subprocess
import sys
import textwrap
from datetime import datetime, timezone
from email.utils import format_datetime
from pathlib import Path


def last_change(path):
    """When the repository changed last, or where it is none, the file."""
    git = subprocess.run(["git", "-c", "safe.directory=*", "-C", path.parent, "log", "-1", "--format=%ct"], capture_output=True, text=True, check=False)
    return datetime.fromtimestamp(int(git.stdout or path.stat().st_mtime), timezone.utc)


def entries(text):
    """(version, date or 'unreleased', bullets) of each heading; paragraphs count as bullets, and ### as their group."""
    for part in re.split(r"^## ", text, flags=re.MULTILINE)[1:]:
        head, _, body = part.partition("\n")
        version, date = re.fullmatch(r"\[(\S+)\] - (\S+)", head).groups()
        bullets, group = [], ""
        for block in re.split(r"\n(?=\* |###|\n)", body):
            block = " ".join(block.split())
            if block.startswith("###"):
                group = block.strip("# ") + ": "
            elif block:
                bullets.append(group + block.removeprefix("* "))
        yield version, date, bullets


def main():
    source, name, maintainer, output = Path(sys.argv[1]), *sys.argv[2:]
    lines = []
    for version, date, bullets in entries(source.read_text(encoding="utf-8")):
        released = last_change(source) if date == "unreleased" else datetime.fromisoformat(date).replace(tzinfo=timezone.utc)
        lines += [f"{name} ({version}) {'UNRELEASED' if date == 'unreleased' else 'unstable'}; urgency=medium", ""]
        for bullet in bullets:
            lines += textwrap.wrap(bullet, 78, initial_indent="  * ", subsequent_indent="    ", break_long_words=False, break_on_hyphens=False)
        lines += ["", f" -- {maintainer}  {format_datetime(released)}", ""]
    Path(output).write_bytes(gzip.compress("\n".join(lines).encode(), 9, mtime=0))


if __name__ == "__main__":
    main()
