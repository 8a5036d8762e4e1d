"""The tables of `docs/styles.md` and `docs/moves.md`, as the registries declare what they hold.

python benchmarks/style_tables.py --write
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
PAGE, MOVES_PAGE = ROOT / "docs" / "styles.md", ROOT / "docs" / "moves.md"
BEGIN, END = "<!-- tables: begin -->", "<!-- tables: end -->"
SHARED = ("opacity", "blend")
"""Parameters of every style, told once."""


def tables(moves: bool = False) -> str:
    """Give a heading, a sentence and a table for each style, and for what all styles take.

    Args:
        moves: Whether to give those of moves instead.
    """
    listed = subprocess.run(
        [sys.executable, "-m", "pipeline.cli", "styles", "--json"],
        cwd=ROOT,
        check=True,
        capture_output=True,
        text=True,
    )
    told = json.loads(listed.stdout)
    members = told["--move"] if moves else {k: v for k, v in told.items() if k[:2] != "--"}
    common = () if moves else SHARED
    parts = []
    for name, facts in members.items():
        own = [one for one in facts["parameters"] if one["name"] not in common]
        parts.append(f"### {name}\n\n{facts['summary']}\n" + (f"\n{table(own)}" if own else ""))
    if not moves:
        shared = [one for one in members["flat"]["parameters"] if one["name"] in SHARED]
        parts.append(f"### Every style\n\n{table(shared)}")
    return "\n".join(parts)


def table(parameters: list[dict]) -> str:
    """Put parameters into a table of Markdown."""
    rows = ["| parameter | default | values | what it is |", "|---|---|---|---|"]
    for one in parameters:
        default = one["default"]
        shown = f"{default:g}" if isinstance(default, float) else default
        shown = "" if default is None and "range" in one else f"`{shown}`"
        unit = f" [{one['unit']}]" if "unit" in one else ""
        rows.append(f"| `{one['name']}` | {shown} | {values(one)} | {one['help']}{unit} |")
    return "\n".join(rows) + "\n"


def values(parameter: dict) -> str:
    """What a parameter may be, where the registry says so."""
    if "range" in parameter:
        least, most = parameter["range"]
        return f"{least:g} to {most:g}"
    return ", ".join(f"`{choice}`" for choice in parameter.get("choices", ()))


def renewed(text: str, moves: bool = False) -> str:
    """Give a page with its tables as the registry has them now."""
    before, rest = text.split(BEGIN)
    return f"{before}{BEGIN}\n\n{tables(moves)}\n{END}{rest.split(END)[1]}"


def main() -> int:
    """Write the pages, or tell whether they are up to date."""
    parser = argparse.ArgumentParser(description="The tables of docs/styles.md and docs/moves.md.")
    parser.add_argument("--write", action="store_true", help="renew the pages")
    options = parser.parse_args()
    is_new = True
    for page in (PAGE, MOVES_PAGE):
        text = page.read_text(encoding="utf-8")
        new = renewed(text, page == MOVES_PAGE)
        is_new = is_new and new == text
        if options.write:
            page.write_text(new, encoding="utf-8")
    return 0 if options.write or is_new else 1


if __name__ == "__main__":
    sys.exit(main())
