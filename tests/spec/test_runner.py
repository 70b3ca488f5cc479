"""The runner itself: it sees what differs, says where, and accepts what comes."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.spec.parts import Case, read
from tests.spec.running import Problem, run

PROGRAM = """
# Heading

```aidl
drawing d {
    c = circle(center: (0, 0), radius: 15)EXPECTED
    constrain c.radius == 16
}
```
"""
NOTE = "note[N0601]: `d.c.radius` was written 15 and became 16"


def cases(tmp_path: Path, text: str) -> list[Case]:
    path = tmp_path / "spec.md"
    path.write_text(text, encoding="utf-8")
    return read(path)


def problems(tmp_path: Path, text: str) -> list[Problem]:
    return [problem for case in cases(tmp_path, text) for problem in run(case).problems]


def test_unexpected_diagnostic_is_told_with_its_line(tmp_path: Path) -> None:
    assert problems(tmp_path, PROGRAM.replace("EXPECTED", "")) == [Problem(6, f"comes unexpected: {NOTE}")]


@pytest.mark.parametrize(
    ("claim", "told"),
    [
        ("d.c.radius == 17", "`d.c.radius == 17`, but it is 16"),
        ("d.c.radius <= 15.9", "`d.c.radius <= 15.9`, but it is 16"),
        ("d.c.radius == 16.00002", "`d.c.radius == 16.00002`, but it is 16"),
        ("d.c.center == (0, 1)", "`d.c.center == (0, 1)`, but it is (0, 0)"),
        ("d.e.radius == 16", "`d.e.radius == 16`: nothing tells e of Node d"),
        ("dof: 3", "`dof: 3`, but it is `2`"),
        ("changed: nothing", "`changed: nothing`, but it is `d.c.radius 15 -> 16`"),
        ("status: failed", "`status: failed`, but it is `solved`"),
    ],
)
def test_wrong_claim_is_told(tmp_path: Path, claim: str, told: str) -> None:
    text = PROGRAM.replace("EXPECTED", f"  // {NOTE}") + f"\n```expect\n{claim}\n```\n"
    assert problems(tmp_path, text) == [Problem(12, told)]


def test_fix_and_canonical_form_are_compared(tmp_path: Path) -> None:
    program = "```aidl\ndrawing d { c = circle(radius: 3) }\n```\n"
    fixed = "\n```fixed\ndrawing d { c = circle(radius: 3) }\n```\n"
    assert [p.text for p in problems(tmp_path, program + fixed)] == ["the program above offers no fix"]
    text = "```aidl\ndrawing d{c=circle(radius:3)}\n```\n\n```formatted\ndrawing d {}\n```\n"
    assert [p.line for p in problems(tmp_path, text)] == [6]


def test_messages_are_compared_to_the_letter(tmp_path: Path) -> None:
    program = "```aidl\ndrawing d { c = circle(radius: 3); constrain c.radius == -1 }\n```\n"
    assert [p.text[:16] for p in problems(tmp_path, program)] == ["comes unexpected"]
    (case,) = cases(tmp_path, f"{program}\n```message\n```\n")
    ((place, lines),) = run(case).accepted.items()
    assert place == (6, 6)
    assert lines[0] == "error[E0601]: `c.radius == -1` cannot hold"
    shown = "".join(f"{line}\n" for line in lines)
    assert problems(tmp_path, f"{program}\n```message\n{shown}```\n") == []
    assert len(problems(tmp_path, f"{program}\n```message\n{shown.replace('hold', 'stand')}```\n")) == 1


def test_accepting_leads_to_agreement(tmp_path: Path) -> None:
    path = tmp_path / "spec.md"
    text = PROGRAM.replace("EXPECTED", "") + "\n```expect\nd.c.radius == ?\ndof: 0\n```\n"
    (case,) = cases(tmp_path, text)
    lines = text.splitlines()
    for (start, end), new in sorted(run(case).accepted.items(), reverse=True):
        lines[start - 1 : end - 1] = new
    (case,) = cases(tmp_path, "\n".join(lines))
    assert run(case).problems == []
    assert "d.c.radius == 16" in path.read_text(encoding="utf-8")
