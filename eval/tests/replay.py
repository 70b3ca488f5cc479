"""Answers from recordings: `exec:python eval/tests/replay.py [FOLDER]`.

Recordings lie in FOLDER (default: `recordings` beside this file) as PROMPT/VARIANT/RUN/ATTEMPT.md, each the
raw text of one reply. Prompt and variant are told from the messages, the run is the seed, the attempt follows
from the replies so far; the last recording is repeated when there are no more.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from aidl_eval.plan import VARIANTS
from eval.tests.asked import TEXTS


def main() -> int:
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent / "recordings"
    asked = json.load(sys.stdin)
    messages = asked["messages"]
    system = next(m["content"] for m in messages if m["role"] == "system")
    request = next(m["content"] for m in messages if m["role"] == "user")
    attempt = 1 + sum(m["role"] == "assistant" for m in messages)
    variant = next(name for name, language in VARIANTS.items() if language.guide().strip() == system.strip())
    prompt = max((name for name, text in TEXTS.items() if text in request), key=lambda name: len(TEXTS[name]))
    replies = sorted(
        (folder / prompt / variant / str(asked["sampling"]["seed"])).glob("*.md"), key=lambda p: int(p.stem)
    )
    if not replies:
        print(
            f"there is no recording of {prompt}, {variant}, run {asked['sampling']['seed']}", file=sys.stderr
        )
        return 1
    sys.stdout.write(replies[min(attempt, len(replies)) - 1].read_text(encoding="utf-8"))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
