"""The contact sheet as a page: one file that asks for nothing, with the knobs as filters.

Values are strangers' text: the page is filled by its script, which sets texts and never markup, and its
policy lets no other script run.
"""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Sequence
from hashlib import sha256
from html import escape
from pathlib import Path
from typing import Any

from aidl_lang.tools.sweeping.rows import Columns, Row, as_mapping

_HERE = Path(__file__).parent


def page(title: str, columns: Columns, rows: Sequence[Row]) -> bytes:
    """Returns the page."""
    script = (_HERE / "page.js").read_text(encoding="utf-8")
    style = (_HERE / "page.css").read_text(encoding="utf-8")
    data = {
        "title": title,
        "given": columns.given,
        "columns": columns.names,
        "rows": [_entry(columns, row) for row in rows],
    }
    policy = f"default-src 'none'; img-src data:; style-src {_hash(style)}; script-src {_hash(script)}"
    told = [
        "<!doctype html>",
        '<html lang="en"><head><meta charset="utf-8">',
        f'<meta http-equiv="Content-Security-Policy" content="{escape(policy)}">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>{escape(title)}</title><style>{style}</style></head><body>",
        '<header><h1></h1><p id="count" role="status"></p></header>',
        '<form id="filters" autocomplete="off"></form><main id="cards"></main>',
        f'<script type="application/json" id="data">{_json(data)}</script>',
        f"<script>{script}</script></body></html>\n",
    ]
    return "\n".join(told).encode("utf-8", "backslashreplace")


def _entry(columns: Columns, row: Row) -> dict[str, Any]:
    cells = dict(as_mapping(columns.names, columns.cells(row)))
    return {
        "cells": cells,
        "ok": row.ok,
        "message": row.message,
        "picture": b64encode(row.outcome.picture).decode(),
    }


def _json(data: object) -> str:
    """Returns JSON as it may stand in a script: nothing in it ends the element or begins a comment."""
    return (
        json.dumps(data, ensure_ascii=True, allow_nan=False).replace("<", "\\u003c").replace(">", "\\u003e")
    )


def _hash(text: str) -> str:
    return f"'sha256-{b64encode(sha256(text.encode()).digest()).decode()}'"
