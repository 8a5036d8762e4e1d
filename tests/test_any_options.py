"""Options of any value: a job, or a `TrimotionError` of plain words, and nothing else."""

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.fuzz.watch import Watch
from pipeline.options.build import build_job
from pipeline.options.command_line import Option, job_options
from pipeline.options.presets import read_preset
from warp_kernels.errors import TrimotionError

PIECES = (
    *("", "0", "-1", "1e999", "nan", "inf", "0.5", "1/0", "9" * 400, "0x10", "1_0", "٣", "½"),
    *("none", "auto", "all", "true", ":", ",", "=", "@", "#", "#fff", "%", "..", "/", "~", "-"),
    *("A-B", "3-1", "0-5x0", "-5", "0:00:01", "99:99", "1x", "x1", "0x0", "99999x99999", "4k"),
    *("strength=2", "width=1,width=2", "file=", "mode=nearest", "amount=2", "\t", "\n", "\0", "é"),
)
"""Texts at which readers of values go wrong."""


def values_for(option: Option) -> st.SearchStrategy[object]:
    """Values that somebody may give to an option: its own words, pieces of texts, other kinds."""
    own = [*(option.choices or ()), *(option.registry or ()), *PIECES]
    text = st.one_of(
        st.sampled_from(own),
        st.lists(st.sampled_from(own), min_size=2, max_size=5).map(":".join),
        st.lists(st.sampled_from(own), min_size=2, max_size=4).map("".join),
        st.text(max_size=12),
    )
    numbers = st.one_of(st.integers(-(10**6), 10**12), st.floats())
    one = st.one_of(text, text, numbers, st.booleans(), st.none())
    return st.one_of(one, st.lists(one, max_size=3)) if option.is_repeatable else one


OPTIONS = [option for option in job_options() if option.flag not in ("device", "track")]
CHOSEN = st.lists(
    st.sampled_from(OPTIONS).flatmap(lambda option: st.tuples(st.just(option), values_for(option))),
    min_size=1,
    max_size=4,
)


@settings(max_examples=120)
@given(CHOSEN)
def test_any_options_make_a_job_or_an_error(chosen: list[tuple[Option, object]]) -> None:
    """As presets and programs give them, several at once."""

    def make() -> None:
        values = {option.dest: option.value(value, option.flag) for option, value in chosen}
        build_job({**values, "source": "in.mp4", "output": "out.mp4"})

    watch = Watch("options")
    watch.attempt(str([(option.flag, value) for option, value in chosen]), make)
    assert not watch.bad, watch.bad


@settings(max_examples=60)
@given(st.one_of(st.text(max_size=60), st.lists(st.sampled_from(PIECES), max_size=9).map("".join)))
def test_any_text_is_a_preset_or_an_error(tmp_path_factory, text: str) -> None:
    """A file of anything at all."""
    path = Path(tmp_path_factory.getbasetemp()) / "any.toml"
    path.write_text(f"triangles = 5\n{text}", "utf-8", "surrogatepass")
    watch = Watch("presets")
    watch.attempt(text, lambda: read_preset(str(path)))
    assert not watch.bad, watch.bad


def test_a_preset_of_deep_brackets_is_told(tmp_path: Path) -> None:
    """TOML's own reader stops at them."""
    path = tmp_path / "deep.toml"
    path.write_text(f"triangles = {'[' * 100_000}")
    with pytest.raises(TrimotionError, match="not a TOML file"):
        read_preset(str(path))
