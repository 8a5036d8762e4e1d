"""A report as one page: no script, nothing fetched, and valid as XML as well."""

from base64 import b64encode
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any

from pipeline.printable import printable
from pipeline.reporting.plot import plot
from pipeline.reporting.strip import Thumbnail

PLOTS = {
    "triangles": "Triangles",
    "rmse": "rmse [code values]",
    "changes": "Triangles that were not there in the frame before",
}
"""Figures that are drawn, and what is written over them."""

STYLE = """
:root { color-scheme: light dark; --line: #2a6fb0; --cut: #c2410c; --grey: #8888; }
body { font: 15px/1.5 system-ui, sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.4rem; overflow-wrap: anywhere; } h2 { font-size: 1.1rem; margin: 1.8rem 0 .4rem; }
table { border-collapse: collapse; } td { overflow-wrap: anywhere; }
th, td { text-align: left; padding: .1rem 1.2rem .1rem 0; vertical-align: top; }
th { font-weight: normal; opacity: .7; white-space: nowrap; }
.strip { display: flex; margin-top: 1rem; flex-wrap: wrap; gap: .5rem; }
figure { margin: 0; flex: 1 1 6rem; }
figure img { width: 100%; height: auto; display: block; } figcaption { font-size: .8rem; }
svg { width: 100%; height: auto; font-size: 11px; } svg text { fill: currentColor; }
.line { fill: none; stroke: var(--line); stroke-width: 1.2; }
.axis { fill: none; stroke: var(--grey); }
.cut { stroke: var(--cut); stroke-dasharray: 3 3; }
.warning { color: var(--cut); }
"""


def page(told: Mapping[str, Any], strip: Sequence[Thumbnail]) -> str:
    """Write the page.

    Args:
        told: What `Telling.as_dict` gives.
        strip: Pictures of the film.
    """
    title = f"{told['output']}: trimotion {told['command']}"
    parts = [
        "<!DOCTYPE html>",
        '<html lang="en" xmlns="http://www.w3.org/1999/xhtml"><head><meta charset="utf-8"/>',
        '<meta http-equiv="Content-Security-Policy" '
        "content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'\"/>",
        '<meta name="viewport" content="width=device-width"/>',
        f"<title>{_text(title)}</title><style>{STYLE}</style></head><body>",
        f"<h1>{_text(title)}</h1>",
        _table(_summary(told)),
        *_sentences("Warnings", "warning", told["warnings"]),
        *_strip(strip),
        *_plots(told["frames"], told["summary"]["cuts"]),
        *_sentences("Notes", "note", told["notes"]),
        "<h2>Time [s]</h2>",
        _table({"in all": told["summary"]["seconds"], **told["seconds_by_stage"]}),
        "<h2>Work of each stage [s]</h2>",
        "<p>Stages run side by side, in every process, so together they may take longer.</p>",
        _table(told["busy_seconds"]),
        "<h2>Options</h2>",
        _table({f"--{flag}": value for flag, value in told["options"].items()}),
        "<h2>Versions</h2>",
        _table(told["versions"]),
        "</body></html>",
    ]
    return "\n".join(parts) + "\n"


def _summary(told: Mapping[str, Any]) -> dict[str, object]:
    summary, frames = told["summary"], told["frames"]
    spent = {
        "time": f"{summary['seconds']:.1f} s",
        "most memory": _memory(told["peak_memory"]),
    }
    if len(frames) == 1:
        (only,) = frames
        figures = {"triangles": only["triangles"], "rmse": f"{only['rmse']:.3f} code values"}
        return {"source": told["source"], "frame": only["frame"], **figures, **spent}
    return {
        "source": told["source"],
        "frames": summary["frames"],
        "mean rmse": f"{summary['mean_rmse']:.3f} code values",
        **spent,
        "cuts": ", ".join(map(str, summary["cuts"])) or "none",
    }


def _memory(peak: Mapping[str, int | None]) -> str:
    """What the processes had at most."""
    own, apart = (None if one is None else f"{one / 1e6:.0f} MB" for one in peak.values())
    return (
        f"{own or 'unknown'}, {apart} in the largest other process" if apart else own or "unknown"
    )


def _strip(strip: Iterable[Thumbnail]) -> list[str]:
    figures = [
        f'<figure style="max-width: {one.size[0]}px">'
        f'<img width="{one.size[0]}" height="{one.size[1]}" alt="frame {one.frame}" '
        f'src="data:image/jpeg;base64,{b64encode(one.jpeg).decode()}"/>'
        f"<figcaption>frame {one.frame}</figcaption></figure>"
        for one in strip
    ]
    return ['<div class="strip">', *figures, "</div>"] if figures else []


def _plots(frames: Sequence[Mapping[str, Any]], cuts: Sequence[int]) -> list[str]:
    if len(frames) < 2:  # whose figures stand in the summary
        return []
    numbers = [one["frame"] for one in frames]
    found = []
    for key, title in PLOTS.items():
        drawn = plot(title, numbers, [one[key] for one in frames], cuts)
        found += [f"<h2>{_text(title)}</h2>", drawn]
    return found


def _sentences(title: str, kind: str, texts: Sequence[str]) -> list[str]:
    if not texts:
        return []
    lines = [f'<p class="{kind}">{_text(text)}</p>' for text in texts]
    return [f"<h2>{title}</h2>", *lines]


def _table(rows: Mapping[str, object]) -> str:
    lines = [f"<tr><th>{_text(k)}</th><td>{_text(_shown(v))}</td></tr>" for k, v in rows.items()]
    return "\n".join(["<table>", *lines, "</table>"])


def _shown(value: object) -> str:
    """A value as people write it."""
    if isinstance(value, bool) or value is None:
        return {True: "yes", False: "no", None: "-"}[value]
    if isinstance(value, list):
        return ", ".join(map(_shown, value)) or "-"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _text(text: str) -> str:
    """Text of strangers as a part of the page: nothing in it is markup."""
    return escape(printable(text).replace("\n", " "))
