"""The tables of `docs/styles.md`: every style with its parameters, as the registry declares them.

python benchmarks/style_tables.py --write
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "styles.md"
BEGIN, END = "<!-- tables: begin -->", "<!-- tables: end -->"
SHARED = ("opacity", "blend")
"""Parameters of every style, told once."""


def tables() -> str:
    """Give a heading, a sentence and a table for each style, and for what all styles take."""
    listed = subprocess.run(
        [sys.executable, "-m", "pipeline.cli", "styles", "--json"],
        cwd=ROOT,
        check=True,
        capture_output=True,
        text=True,
    )
    styles = json.loads(listed.stdout)
    parts = []
    for name, facts in styles.items():
        own = [one for one in facts["parameters"] if one["name"] not in SHARED]
        parts.append(f"### {name}\n\n{facts['summary']}\n" + (f"\n{table(own)}" if own else ""))
    shared = [one for one in styles["flat"]["parameters"] if one["name"] in SHARED]
    parts.append(f"### Every style\n\n{table(shared)}")
    return "\n".join(parts)


def table(parameters: list[dict]) -> str:
    """Put parameters into a table of Markdown."""
    rows = ["| parameter | default | values | what it is |", "|---|---|---|---|"]
    for one in parameters:
        default = one["default"]
        shown = f"{default:g}" if isinstance(default, float) else default
        unit = f" [{one['unit']}]" if "unit" in one else ""
        rows.append(f"| `{one['name']}` | `{shown}` | {values(one)} | {one['help']}{unit} |")
    return "\n".join(rows) + "\n"


def values(parameter: dict) -> str:
    """What a parameter may be, where the registry says so."""
    if "range" in parameter:
        least, most = parameter["range"]
        return f"{least:g} to {most:g}"
    return ", ".join(f"`{choice}`" for choice in parameter.get("choices", ()))


def renewed(text: str) -> str:
    """Give the page with its tables as the registry has them now."""
    before, rest = text.split(BEGIN)
    return f"{before}{BEGIN}\n\n{tables()}\n{END}{rest.split(END)[1]}"


def main() -> int:
    """Write the page, or tell whether it is up to date."""
    parser = argparse.ArgumentParser(description="The tables of docs/styles.md.")
    parser.add_argument("--write", action="store_true", help="renew the page")
    options = parser.parse_args()
    text = PAGE.read_text(encoding="utf-8")
    new = renewed(text)
    if options.write:
        PAGE.write_text(new, encoding="utf-8")
    return 0 if options.write or new == text else 1


if __name__ == "__main__":
    sys.exit(main())
