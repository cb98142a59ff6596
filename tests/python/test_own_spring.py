"""The page on a spring of one's own, docs/own-spring.md: what it says is printed is what its commands print."""

import re
import runpy
from decimal import Decimal
from pathlib import Path

import pytest

from component import ROOT
from relay_contact.command import main


def alike(told: str, printed: str) -> bool:
    """Return whether two texts differ by no more than the last digits of their numbers, as machines may."""
    number = re.compile(r"\d+(?:\.\d+)?")
    pairs = zip(*(map(Decimal, number.findall(text)) for text in (told, printed)), strict=False)
    last = all(abs(one - other) <= Decimal(1).scaleb(int(one.as_tuple().exponent)) for one, other in pairs)
    return last and number.sub("#", told) == number.sub("#", printed)


def test_the_commands_of_own_spring_print_what_the_page_says(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """What has the same name in the table; the page shows fewer of its columns."""
    page = (ROOT / "docs/own-spring.md").read_text(encoding="utf-8")
    spring, script, forces, relay, verdicts = re.findall(r"(?s)```\w+\n(.*?)```", page)
    monkeypatch.chdir(tmp_path)
    for name, text in (("my-spring.toml", spring), ("my_spring.py", script), ("my-relay.toml", relay)):
        Path(name).write_text(text, encoding="utf-8")
    runpy.run_path("my_spring.py", run_name="__main__")
    assert alike(forces, capsys.readouterr().out)
    assert main(["qualify", "my-relay.toml", "--standard", "MIL-PRF-28776", "--quick"]) == 0
    tables = verdicts, capsys.readouterr().out
    told, printed = ([re.split(" {2,}", line) for line in text.splitlines()] for text in tables)
    for own, row in zip(told, printed[: len(told)], strict=True):
        found = dict(zip(printed[0], row, strict=True))
        assert [name for name, cell in zip(told[0], own, strict=True) if not alike(cell, found[name])] == []
