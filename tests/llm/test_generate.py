"""`aidl generate` against a server that speaks the chat protocol: what it asks, writes and says."""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from aidl_lang.tools.reference import guide
from tests.llm.scripted import Says, Scripted

PLATE = """solid plate {
    param width = 60 in 40..90
    outline = rectangle(center: origin, width: width, height: 40)
    hole bore { rim = circle(center: (20, 10), radius: 5) }
    constrain bore.rim.center == outline.top_right - (10, 10)
}
"""
WRONG = PLATE.replace("circle(", "disk_shape(")
"""No fix is offered for a name that is like no other."""
CONFLICT = PLATE.replace(
    "constrain bore.rim.center == outline.top_right - (10, 10)",
    "constrain {\n        bore.left >= outline.right - 12\n        bore.right <= outline.left + 20\n    }",
)
DELETED = CONFLICT.replace("        bore.right <= outline.left + 20\n", "")


def block(program: str) -> str:
    return f"```aidl\n{program}```"


def transcript(name: str = "plate.transcript.json") -> dict[str, Any]:
    found: dict[str, Any] = json.loads(Path(name).read_text("utf-8"))
    return found


def said(server: Scripted, request: int) -> str:
    """What the last message of a request says."""
    return server.requests[request].texts[-1]


# --- Replies as they come ------------------------------------------------------------------------


def test_a_program_that_is_right(generate: Callable[..., Any], capsys: pytest.CaptureFixture[str]) -> None:
    reply = Says(f"A plate, then.\n\n{block(PLATE)}", usage=(6100, 70), cost=0.0125)
    code, server = generate([reply], "-o", "plate.aidl", "-o", "plate.svg", "-o", "plate.json")
    assert code == 0
    assert Path("plate.aidl").read_text("utf-8") == PLATE
    assert Path("plate.svg").read_text("utf-8").startswith("<?xml")
    assert json.loads(Path("plate.json").read_text("utf-8"))["status"] == "solved"
    assert server.requests[0].texts[0] == guide()
    assert said(server, 0).startswith("Write a program that draws this: a plate with a bore\n")
    error = capsys.readouterr().err
    assert "attempt 1: valid\n" in error
    assert re.search(r"valid after 1 attempt, 6,100 tokens in, 70 out, \$0\.0125, \d+\.\d s", error)
    assert transcript()["attempts"][0]["verdict"]["ok"]
    assert [m["role"] for m in transcript()["messages"]] == ["system", "user", "assistant"]


def test_a_reply_cut_off_at_the_limit(generate: Callable[..., Any]) -> None:
    cut = Says("I think long.\n```aidl\nsolid plate {\n    outline =", finish="length")
    code, server = generate([cut, block(PLATE)], "-o", "plate.aidl")
    assert code == 0
    assert said(server, 1) == (
        "Your reply was cut off at the limit on its length, before its program ended. Think less, or write "
        "the program shorter, and answer with the whole of it in one ```aidl block."
    )
    first, second = transcript()["attempts"]
    assert (first["finish"], first["program"], first["verdict"]) == ("cut", None, None)
    assert second["verdict"]["ok"]


def test_no_program_at_all(generate: Callable[..., Any], capsys: pytest.CaptureFixture[str]) -> None:
    code, _ = generate(["No."] * 5, "-o", "plate.aidl")
    assert code == 1
    assert "no reply held a program; the last one begins: 'No.'" in capsys.readouterr().err
    assert not Path("plate.aidl").exists()
    assert len(transcript()["attempts"]) == 5


def test_a_refusal_ends_it(generate: Callable[..., Any]) -> None:
    code, server = generate([Says("I will not.", finish="content_filter")], "-o", "plate.aidl")
    assert code == 1
    assert len(server.requests) == 1
    assert transcript()["attempts"][0]["finish"] == "refused"


# --- Programs that are wrong ----------------------------------------------------------------------


def test_a_wrong_program_mended_on_the_second_try(
    generate: Callable[..., Any], capsys: pytest.CaptureFixture[str]
) -> None:
    code, server = generate([block(WRONG), block(PLATE)], "-o", "plate.aidl", "-o", "plate.png")
    assert code == 0
    told = said(server, 1)
    assert told.startswith(
        "The program is wrong: 1 error, the first of them in the check of types.\n\nerror E0203"
    )
    assert "\n  4 | hole bore { rim = disk_shape(center: (20, 10), radius: 5) }\n" in told
    assert told.endswith("Answer with the whole program in one ```aidl block.")
    assert Path("plate.aidl").read_text("utf-8") == PLATE
    with Image.open("plate.png") as picture:
        assert picture.size[0] > 100
    assert "attempt 1: wrong in types (E0203)\n" in capsys.readouterr().err
    assert [a["verdict"]["stage"] for a in transcript()["attempts"]] == ["types", "done"]


def test_fixes_are_told_with_what_is_left(generate: Callable[..., Any]) -> None:
    code, server = generate(
        [block(WRONG.replace("outline.top", "outlin.top")), block(PLATE)], "-o", "plate.aidl"
    )
    assert code == 0
    assert said(server, 1).startswith(
        "These fixes were made to your program already; keep them: write `outline`. "
        "Lines count as after them.\n"
        "  - constrain bore.rim.center == outlin.top_right - (10, 10)\n"
        "  + 5 | constrain bore.rim.center == outline.top_right - (10, 10)\n\n"
        "The program is wrong: 1 error"
    )


# --- What gets lost -------------------------------------------------------------------------------


def test_a_conflict_is_told_and_what_is_deleted_for_it_asked_for_and_counted(
    generate: Callable[..., Any], capsys: pytest.CaptureFixture[str]
) -> None:
    code, server = generate([block(CONFLICT), *[block(DELETED)] * 4], "-o", "plate.aidl")
    assert code == 0
    told = said(server, 1)
    assert "in the check of solve.\n\nerror E0601" in told
    assert (
        "`bore.left >= outline.right - 12` and `bore.right <= outline.left + 20` cannot hold together" in told
    )
    assert "Degrees of freedom left beside these constraints: " in told
    told = said(server, 2)
    assert "`bore.right <= outline.left + 20`" in told
    assert "Bring each of these back" in told
    assert "The program is valid." in told
    assert len(server.requests) == 4  # asked for twice, and then no more
    assert "still missing: " in (error := capsys.readouterr().err)
    assert "`bore.right <= outline.left + 20`" in error
    assert len(transcript()["result"]["missing"]) == 1


def test_a_constraint_that_comes_back_in_another_way_is_not_missing(
    generate: Callable[..., Any], capsys: pytest.CaptureFixture[str]
) -> None:
    restored = DELETED.replace(
        "bore.left >= outline.right - 12\n",
        "bore.left >= outline.left + 8\n        bore.right <= outline.left + 20\n",
    )
    code, server = generate([block(CONFLICT), block(DELETED), block(restored)], "-o", "plate.aidl")
    assert code == 0
    assert len(server.requests) == 3
    assert "still missing" not in capsys.readouterr().err


# --- Plans, changes, runs ---------------------------------------------------------------------------


def test_a_plan_is_answered_with_boxes_and_a_picture(generate: Callable[..., Any]) -> None:
    plan = "assembly lamp {\n    solid foot { todo }\n    solid shade { todo }\n"
    plan += "    constrain shade.above(foot)\n}\n"
    code, server = generate([block(plan), block(PLATE)], "-o", "plate.aidl", "--attempts", "1")
    assert server.requests[1].messages[-1].images[0].media_type == "image/png"
    picture = Image.open(BytesIO(server.requests[1].messages[-1].images[0].data))
    assert picture.getcolors(2) is None  # not blank
    told = said(server, 1)
    assert told.startswith(
        "So far it compiles. Boxes, in mm, in the frame of the root:\n- assembly `lamp`: x "
    )
    assert "\n- solid `lamp.shade`: x " in told
    assert [a["verdict"]["partial"] for a in transcript()["attempts"]] == [True, False]
    assert code == 0


def test_a_change_is_a_minimal_edit(generate: Callable[..., Any], capsys: pytest.CaptureFixture[str]) -> None:
    before = "// My plate.\n" + PLATE.replace("radius: 5) }", "radius: 5) }  // for M10")
    Path("mine.aidl").write_text(before, "utf-8")
    after = PLATE.replace("radius: 5", "radius: 6").replace("    ", "  ")
    code, server = generate([block(after)], "--edit", "mine.aidl")
    assert code == 0
    assert before in said(server, 0)
    assert Path("mine.aidl").read_text("utf-8") == before
    out = capsys.readouterr().out
    changed = [line for line in out.splitlines()[2:] if line[0] in "+-"]
    assert changed == [
        "-    hole bore { rim = circle(center: (20, 10), radius: 5) }  // for M10",
        "+    hole bore { rim = circle(center: (20, 10), radius: 6) }  // for M10",
    ]


def test_the_best_of_several_runs_is_kept(
    generate: Callable[..., Any], capsys: pytest.CaptureFixture[str]
) -> None:
    steps = [block(WRONG), block(PLATE)]
    arguments = ["-o", "plate.aidl", "--runs", "2", "--attempts", "1", "--seed", "7"]
    code, server = generate(steps, *arguments)
    assert code == 0
    assert [request.body["seed"] for request in server.requests] == [7, 8]
    assert Path("plate.aidl").read_text("utf-8") == PLATE
    assert Path("plate.run-1.aidl").read_text("utf-8") == WRONG
    assert transcript("plate.run-2.transcript.json")["result"]["ok"]
    assert "run 1: not valid after 1 attempt" in capsys.readouterr().err


def test_a_picture_goes_with_the_request(generate: Callable[..., Any]) -> None:
    Image.new("RGB", (8, 8), "red").save("sketch.png")
    _, server = generate([block(PLATE)], "-o", "plate.aidl", "--image", "sketch.png")
    sent = server.requests[0].messages[1]
    assert Image.open(BytesIO(sent.images[0].data)).getpixel((0, 0)) == (255, 0, 0)
    assert sent.text.startswith("The picture shows what is meant.\n\n")
    uri = transcript()["messages"][1]["images"][0]
    assert base64.b64decode(uri.partition(",")[2]) == sent.images[0].data
